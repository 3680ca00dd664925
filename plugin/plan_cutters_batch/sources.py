"""Where parts come from: files, folders, globs, lists and manifests, here or at a URL. Names are made from paths, so they stay.

A manifest has the parts of a batch in a TOML or CSV file, with options of each; or it is a plain list of files, one a line.
"""

import csv
import io
import itertools
import os
import posixpath
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import PurePosixPath
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from plan_cutters.errors import PlanError
from plan_cutters.files.folder import cause, file_system, read
from plan_cutters_batch.row import UNREADABLE, PartRow, failed

#: What files of parts are called.
SUFFIXES = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
MANIFESTS = (".toml", ".csv", ".txt")
_MAGIC = frozenset("*?[")
#: Most bytes of a manifest: a hundred thousand parts with long options.
_LARGEST = 64 << 20
_TABLE = re.compile(r"^[ \t]*\[\[?[ \t]*([\w.-]+)[ \t]*\]\]?", re.MULTILINE)
Value = bool | int | float | str | list[bool | int | float | str]


@dataclass(frozen=True)
class Source:
    """A part as it was requested: its name, and its path or URL."""

    name: str
    file: str
    #: Of this part alone, as the manifest has them.
    options: dict[str, Any] = field(default_factory=dict)
    #: Where that is said, for errors: `parts.csv:7`.
    place: str = ""


def sources(words: Sequence[str], out: str, manifest: Callable[[str], Sequence[Source | PartRow]]) -> list[Source | PartRow]:
    """The parts that are meant, in the order of the words and, within each, of the names; rows of those that cannot be planned.

    Words are files, folders, globs, manifests (which `manifest` reads) and lists of files, as paths or URLs. What lies below the
    output is no part.
    """
    jobs: list[Source | PartRow] = []
    for word in words:
        try:
            jobs += _of(word, out, manifest)
        except PlanError as error:
            jobs.append(failed(word, word, str(error), UNREADABLE))
    return _named_once(jobs)


def _of(word: str, out: str, manifest: Callable[[str], Sequence[Source | PartRow]]) -> Sequence[Source | PartRow]:
    if not word:
        return [failed("?", word, "SRC: a file has no name")]
    fs, path = file_system(word)
    try:
        if _MAGIC & set(word) and not fs.exists(path):
            # The folders of a glob before the first that is none.
            plain = itertools.takewhile(lambda part: not _MAGIC & set(part), PurePosixPath(path).parts[:-1])
            base, files = PurePosixPath(*plain).as_posix(), fs.glob(path)
            nothing = "no STEP, IGES or BREP file matches it"
        elif word.lower().endswith(MANIFESTS):
            try:
                return manifest(word)
            except PlanError as error:
                # A mistake of the command, not a part that cannot be read.
                return [failed(word, word, str(error))]
        elif fs.isdir(path):
            base, nothing = path.rstrip("/"), "the folder holds no STEP, IGES or BREP file"
            there, own = file_system(out)
            mine = f"{own.rstrip('/')}/" if type(there) is type(fs) else None
            # What lies in the folder of a plan, in a hidden one, or below the output is none.
            files = [
                each
                for each in fs.find(path)
                if not any(part.startswith(".") or part.endswith("-plan") for part in PurePosixPath(each[len(base) :]).parts[:-1])
                and not (mine and each.startswith(mine))
            ]
        elif not fs.exists(path):
            raise PlanError(f"no such file{', folder or bucket' if '://' in word else ' or folder'}", file=word)
        else:
            return [Source(PurePosixPath(path).stem, word)]
        files = sorted(each for each in files if each.lower().endswith(SUFFIXES))
    except PlanError:
        raise
    except Exception as error:
        raise PlanError(cause(error, "read"), file=word) from None
    if not files:
        return [failed(word, word, f"{word}: {nothing}")]
    stems = [PurePosixPath(file[len(base) :].lstrip("/")).with_suffix("").as_posix() for file in files]
    if "://" in word:
        places = [fs.unstrip_protocol(file) for file in files]
    else:  # as it was given: reports on a folder of a repository name its files within that
        places = files if os.path.isabs(word) else [os.path.relpath(file) for file in files]
    return [Source(stem, place) for stem, place in zip(stems, places, strict=True)]


def _named_once(sources: Sequence[Source | PartRow]) -> list[Source | PartRow]:
    """Names that are folders, each once; parts that share one are not planned, for neither has a right to the folder."""
    names: dict[str, list[str]] = {}
    for each in sources:
        if isinstance(each, Source):
            names.setdefault(each.name.casefold(), []).append(each.file)
    taken: set[str] = {each.name for each in sources if isinstance(each, PartRow)}
    checked: list[Source | PartRow] = []
    for each in sources:
        if isinstance(each, Source) and (why := _unusable(each, names[each.name.casefold()])):
            short = each.name if len(names[each.name.casefold()]) == 1 else PurePosixPath(each.file).name
            tried = (short, each.file, *(f"{each.file} ({n})" for n in range(2, len(sources) + 2)))
            name = next(name for name in tried if name not in taken)
            each = failed(name, each.file, f"{each.place or each.file}: {why}")
            taken.add(name)
        checked.append(each)
    return checked


def _unusable(source: Source, same: Sequence[str]) -> str:
    """Why a name cannot be a folder's; empty where it can."""
    if len(same) > 1:
        others = [file for file in same if file != source.file] or [source.file]
        other = others[0] + (f" and {len(others) - 1} more" if len(others) > 1 else "")
        return f"has the name {source.name!r}, as {other}: none of them is planned; rename one, or give names in a manifest"
    parts = source.name.split("/")
    if any(part in ("", ".", "..") or part != part.strip() for part in parts) or not source.name.isprintable():
        return f"the name {source.name!r} cannot be a folder's; give another in a manifest"
    if "\\" in source.name or any(part.endswith("-plan") for part in parts[:-1]) or parts[0].startswith("."):
        return f"the name {source.name!r} would lie in the folder of another plan, or in a hidden one; give another"
    return ""


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


#: A part of a manifest: its line, its fields or why it has none, and the lines of the fields, where they are not in that.
_Line = tuple[int, dict[str, Any] | str, dict[str, int]]


def manifest(file: str, known: Sequence[str]) -> list[Source | PartRow]:
    """The parts of a manifest (path or URL; by its suffix TOML, CSV, or a list of files), and what is wrong with some of them.

    `known`: options that a part may have. A PlanError where it cannot be read, or is no manifest: none of its parts is known.
    """
    data = read(file)
    if len(data) > _LARGEST:
        raise PlanError(f"is larger than {_LARGEST >> 20} MB: divide it", file=file)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise PlanError(f"is no text in UTF-8 (byte {error.start}): save it so", file=file) from None
    kind = PurePosixPath(file.lower()).suffix
    listed = ((number, line.strip()) for number, line in enumerate(text.splitlines(), 1))
    entries: Iterable[_Line] = ((number, {"file": word}, {}) for number, word in listed if word and not word.startswith("#"))
    if kind in (".toml", ".csv"):
        entries = _toml(file, text, known) if kind == ".toml" else _csv(file, text)
    parts = [_part(file, *each, known) for each in entries]
    if not parts:
        raise PlanError("names no part", file=file)
    return parts


def _part(file: str, line: int, fields: dict[str, Any] | str, lines: dict[str, int], known: Sequence[str]) -> Source | PartRow:
    place = f"{file}:{line}"
    if isinstance(fields, str):
        return failed(place, "", f"{place}: {fields}")
    shown = str(fields.get("name") or fields.get("file") or place)
    try:
        entry = Entry.model_validate(fields)
    except ValidationError as error:
        return failed(f"{shown} (line {line})", str(fields.get("file", "")), f"{place}: {_why(error)}")
    path = entry.file if "://" in entry.file or posixpath.isabs(entry.file) else "".join(file.rpartition("/")[:2]) + entry.file
    named = PurePosixPath(entry.file)
    inside = "://" not in entry.file and not named.is_absolute() and ".." not in named.parts
    # Without a name, its path from the manifest without the suffix, or the file's name alone.
    name = entry.name or (named.with_suffix("").as_posix() if inside else named.stem)
    options = dict(entry.model_extra or {})
    for word in options:
        if why := _unknown(word, known):
            return failed(name, path, f"{file}:{lines.get(word, line)}: {why}")
    try:
        fs, there = file_system(path)
        # Elsewhere this would be a question over the network for each part: there it is asked when the part is read.
        if type(fs).__name__ == "LocalFileSystem" and not fs.isfile(there):
            return failed(name, path, f"{place}: no such file: {path}", UNREADABLE)
    except PlanError as error:
        return failed(name, path, f"{place}: {error}", UNREADABLE)
    return Source(name, path, options, place)


def _unknown(word: str, known: Sequence[str]) -> str:
    """Why a word is no option of a part; empty where it is one."""
    if word.replace("_", "-") in known:
        return ""
    near = get_close_matches(word.replace("_", "-"), known, 1)
    return f"no option of a part is called {word}{f'; {near[0]}?' if near else ''}"


def _toml(file: str, text: str, known: Sequence[str]) -> Iterator[_Line]:
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
    starts = [m.start() for m in _TABLE.finditer(text) if m[1] == "part"]
    ends, line, seen = [*starts[1:], len(text)], 1, 0
    for number, fields in enumerate(whole.part):
        lines: dict[str, int] = {}
        if len(starts) == len(whole.part):
            begin, end = starts[number], ends[number]
            line, seen = line + text.count("\n", seen, begin), begin
            for name in fields:
                key = re.compile(rf"^[ \t]*[\"']?{re.escape(name)}[\"']?[ \t]*=", re.MULTILINE).search(text, begin, end)
                if key:
                    lines[name] = line + text.count("\n", begin, key.start())
        yield line, {**whole.options, **fields}, lines


def _line(text: str, word: str) -> int:
    """The line of a table or a key, from 1."""
    match = re.compile(rf"^[ \t]*\[{{0,2}}[ \t]*[\"']?{re.escape(word)}\b", re.MULTILINE).search(text)
    return text.count("\n", 0, match.start()) + 1 if match else 1


def _csv(file: str, text: str) -> Iterator[_Line]:
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
                yield rows.line_num, f"has {len(cells)} cells for {len(names)} columns: a cell with a comma needs quotes", {}
                continue
            fields: dict[str, Any] = {name: cell for name, cell in zip(names, cells, strict=False) if cell}
            for name, cell in fields.items():
                if name not in ("file", "name") and "|" in cell:
                    fields[name] = [each.strip() for each in cell.split("|")]
            yield rows.line_num, fields, {}
    except csv.Error as error:
        raise PlanError(f"is no CSV: {error}", file=f"{file}:{rows.line_num}") from None


def _why(error: ValidationError) -> str:
    """One line of what is wrong with a table."""
    first = error.errors()[0]
    place = ".".join(str(each) for each in first["loc"] if not isinstance(each, int) and each not in ("bool", "int", "str"))
    word = "is missing" if first["type"] == "missing" else first["msg"][:1].lower() + first["msg"][1:]
    return f"{place}: {word}" if place else word
