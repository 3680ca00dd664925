"""Manifests: the parts of a batch in a TOML or CSV file, with options of each; or a plain list of files, one a line."""

import csv
import io
import posixpath
import re
import tomllib
from collections.abc import Iterator, Sequence
from difflib import get_close_matches
from pathlib import PurePosixPath
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from plan_cutters.errors import PlanError
from plan_cutters.files.folder import file_system, read
from plan_cutters_batch.job import UNREADABLE, USAGE, Fault
from plan_cutters_batch.sources import Source

#: Most bytes of a manifest: a hundred thousand parts with long options.
_LARGEST = 64 << 20
_TABLE = re.compile(r"^[ \t]*\[\[?[ \t]*([\w.-]+)[ \t]*\]\]?", re.MULTILINE)
Value = bool | int | float | str | list[bool | int | float | str]


class Entry(BaseModel):
    """A part: its file, its name, and beside them options that are called as on the command line."""

    model_config = ConfigDict(extra="allow", frozen=True, strict=True)
    __pydantic_extra__: dict[str, Value] = Field(init=False)

    file: str = Field(min_length=1)
    name: str | None = Field(default=None, min_length=1)


class Whole(BaseModel):
    """The tables of a manifest: `[options]` for all of its parts, and a `[[part]]` for each."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    options: dict[str, Value] = {}
    part: list[dict[str, Any]] = Field(min_length=1)


def manifest(file: str, known: Sequence[str]) -> list[Source | Fault]:
    """The parts of a manifest, and what is wrong with some of them.

    Parameters
    ----------
    file : str
        Path or URL; by its suffix TOML, CSV, or a list of files.
    known : sequence of str
        Options that a part may have.

    Raises
    ------
    PlanError
        It cannot be read, or is no manifest: none of its parts is known.
    """
    data = read(file)
    if len(data) > _LARGEST:
        raise PlanError(f"is larger than {_LARGEST >> 20} MB: divide it", file=file)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise PlanError(f"is no text in UTF-8 (byte {error.start}): save it so", file=file) from None
    kind = PurePosixPath(file.lower()).suffix
    entries = _toml(file, text, known) if kind == ".toml" else (_csv if kind == ".csv" else _list)(file, text)
    parts = [_part(file, line, fields, known) for line, fields in entries]
    if not parts:
        raise PlanError("names no part", file=file)
    return parts


def _part(file: str, line: int, fields: dict[str, Any] | str, known: Sequence[str]) -> Source | Fault:
    place = f"{file}:{line}"
    if isinstance(fields, str):
        return Fault(place, "", f"{place}: {fields}", USAGE)
    shown = str(fields.get("name") or fields.get("file") or place)
    try:
        entry = Entry.model_validate(fields)
    except ValidationError as error:
        return Fault(f"{shown} (line {line})", str(fields.get("file", "")), f"{place}: {_why(error)}", USAGE)
    path = entry.file if "://" in entry.file or posixpath.isabs(entry.file) else _relative_to(file, entry.file)
    name = entry.name or _name(entry.file)
    options = dict(entry.model_extra or {})
    for word in options:
        if why := _unknown(word, known):
            there = getattr(line, "fields", {}).get(word, line)
            return Fault(name, path, f"{file}:{there}: {why}", USAGE)
    try:
        fs, there = file_system(path)
        # Elsewhere this would be a question over the network for each part: there it is asked when the part is read.
        if type(fs).__name__ == "LocalFileSystem" and not fs.isfile(there):
            return Fault(name, path, f"{place}: no such file: {path}", UNREADABLE)
    except PlanError as error:
        return Fault(name, path, f"{place}: {error}", UNREADABLE)
    return Source(name, path, options, place)


def _unknown(word: str, known: Sequence[str]) -> str:
    """Why a word is no option of a part; empty where it is one."""
    if word.replace("_", "-") in known:
        return ""
    near = get_close_matches(word.replace("_", "-"), known, 1)
    return f"no option of a part is called {word}{f'; {near[0]}?' if near else ''}"


def _name(file: str) -> str:
    """The name of a part that has none: its path from the manifest without the suffix, or the file's name alone."""
    path = PurePosixPath(file)
    inside = "://" not in file and not path.is_absolute() and ".." not in path.parts
    return path.with_suffix("").as_posix() if inside else path.stem


def _relative_to(file: str, path: str) -> str:
    head, slash, _ = file.rpartition("/")
    return f"{head}{slash}{path}"


def _toml(file: str, text: str, known: Sequence[str]) -> Iterator[tuple[int, dict[str, Any]]]:
    try:
        whole = Whole.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise PlanError(f"is no TOML: {error}", file=file) from None
    except ValidationError as error:
        first = str(error.errors()[0]["loc"][0]) if error.errors()[0]["loc"] else ""
        raise PlanError(_why(error), file=f"{file}:{_line(text, first)}") from None
    for word in whole.options:
        if why := _unknown(word, known):
            raise PlanError(why, file=f"{file}:{_line(text, word)}")
    starts = [m for m in _TABLE.finditer(text) if m[1] == "part"]
    line, seen = 1, 0
    for number, fields in enumerate(whole.part):
        if len(starts) == len(whole.part):
            begin = starts[number].start()
            line, seen = line + text.count("\n", seen, begin), begin
            end = next((each.start() for each in starts[number + 1 : number + 2]), len(text))
            yield _at(text, begin, end, fields, line), {**whole.options, **fields}
        else:
            yield line, {**whole.options, **fields}


class _Lines(int):
    """The line of a part, and those of its fields."""

    fields: dict[str, int]


def _at(text: str, begin: int, end: int, fields: dict[str, Any], line: int) -> _Lines:
    lines = _Lines(line)
    lines.fields = {}
    for name in fields:
        key = re.compile(rf"^[ \t]*[\"']?{re.escape(name)}[\"']?[ \t]*=", re.MULTILINE).search(text, begin, end)
        if key:
            lines.fields[name] = line + text.count("\n", begin, key.start())
    return lines


def _line(text: str, word: str) -> int:
    """The line of a table or a key, from 1."""
    match = re.compile(rf"^[ \t]*\[{{0,2}}[ \t]*[\"']?{re.escape(word)}\b", re.MULTILINE).search(text)
    return text.count("\n", 0, match.start()) + 1 if match else 1


def _csv(file: str, text: str) -> Iterator[tuple[int, dict[str, Any] | str]]:
    head = text.partition("\n")[0]
    # Where a comma parts decimals, tables are written with semicolons.
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=";" if ";" in head and "," not in head else ",", strict=True)
    names: list[str] = []
    try:
        for row in rows:
            cells = [cell.strip() for cell in row]
            if not any(cells) or cells[0].startswith("#"):
                continue
            if not names:
                names = cells
                if "file" not in names or len(set(names)) < len(names) or "" in names:
                    raise PlanError(
                        "its first line must name the columns, each once, with `file` among them", file=f"{file}:{rows.line_num}"
                    )
                continue
            if len(cells) > len(names):
                yield (rows.line_num, f"has {len(cells)} cells for {len(names)} columns: a cell with a comma needs quotes")
                continue
            yield rows.line_num, {name: _cell(name, cell) for name, cell in zip(names, cells, strict=False) if cell}
    except csv.Error as error:
        raise PlanError(f"is no CSV: {error}", file=f"{file}:{rows.line_num}") from None


def _cell(name: str, cell: str) -> Any:
    return cell if name in ("file", "name") or "|" not in cell else [each.strip() for each in cell.split("|")]


def _list(file: str, text: str) -> Iterator[tuple[int, dict[str, Any]]]:
    for number, line in enumerate(text.splitlines(), 1):
        if (word := line.strip()) and not word.startswith("#"):
            yield number, {"file": word}


def _why(error: ValidationError) -> str:
    """One line of what is wrong with a table."""
    first = error.errors()[0]
    place = ".".join(str(each) for each in first["loc"] if not isinstance(each, int) and each not in ("bool", "int", "str"))
    word = "is missing" if first["type"] == "missing" else first["msg"][:1].lower() + first["msg"][1:]
    return f"{place}: {word}" if place else word
