"""Fingerprint of a module: its own source and those of all modules of ours that it imports, by what they mean.

The syntax tree counts, without docstrings: a comment, a blank line or a word in a docstring changes nothing. An import counts
wherever it stands, in a function, too. So what a compiled function is made of, its constants and all that it calls, cannot
change without the fingerprint. Modules that are imported by a computed name are not seen.
"""

import ast
import contextlib
import functools
import hashlib
import importlib.util
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

#: Packages whose sources decide what is judged.
PROGRAM = ("cad_io", "plan_cutters", "plan_cutters_base")
#: Level of a relative import (0 for an absolute one), module, and the name taken from it, empty for the module itself.
Import = tuple[int, str, str]


class Parsed(NamedTuple):
    """The meaning of a source: the digest of its syntax tree, and what it imports."""

    digest: str
    imports: tuple[Import, ...]


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def parsed(source: bytes) -> Parsed:
    """Parse a source.

    Raises
    ------
    SyntaxError
        It is none of this version of Python.
    """
    tree, imports = ast.parse(source), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            imports |= {(0, each.name, "") for each in node.names}
        elif isinstance(node, ast.ImportFrom):
            imports |= {(node.level, node.module or "", each.name) for each in node.names}
        elif isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and ast.get_docstring(node):
            del node.body[0]
    return Parsed(_digest(ast.dump(tree).encode()), tuple(sorted(imports)))


@functools.cache
def _dialect() -> str:
    """What a note holds for: how this module parses, and the version of Python."""
    return _digest((_content(__file__) or b"") + sys.version.encode())


@functools.cache
def _noted(source: bytes, notes: Path | None) -> Parsed:
    """Parse a source, or take what an earlier process noted: notes lie by the bytes of sources, so that none is ever out of date.

    A note begins with its own checksum: one that is damaged, or cannot be written, costs time alone.
    """
    if notes is None:
        return parsed(source)
    note = notes / _digest(_dialect().encode() + source)[:32]
    try:
        checksum, text = note.read_text("ascii").split("\n", 1)
        if checksum == _digest(text.encode()):
            digest, imports = json.loads(text)
            return Parsed(digest, tuple((level, module, name) for level, module, name in imports))
    except (OSError, ValueError):
        pass
    result = parsed(source)
    text, unfinished = json.dumps(result), note.with_name(f"{note.name}.{os.urandom(4).hex()}")
    with contextlib.suppress(OSError):
        notes.mkdir(parents=True, exist_ok=True)
        try:
            unfinished.write_text(f"{_digest(text.encode())}\n{text}", "ascii")
            unfinished.replace(note)
        finally:
            unfinished.unlink(missing_ok=True)
    return result


def _content(path: str) -> bytes | None:
    """Bytes of a source, which may lie in an archive that modules are imported from; None where there is none."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        above = os.path.dirname(path)
    while not os.path.isdir(above) and above != os.path.dirname(above):
        archive = sys.path_importer_cache.get(above)
        if archive is not None and hasattr(archive, "get_data"):
            with contextlib.suppress(OSError):
                return bytes(archive.get_data(path))
        above = os.path.dirname(above)
    return None


@functools.cache
def _source(name: str) -> tuple[bytes, str] | None:
    """Source of a module, and the package that its relative imports begin in; None where there is none. Nothing is imported."""
    top, *rest = name.split(".")
    try:
        spec = importlib.util.find_spec(top)
    except ValueError:  # the module that Python was started with
        return None
    if spec is None:
        return None
    for folder in spec.submodule_search_locations or ():
        stem = os.path.join(folder, *rest)
        for path, package in ((os.path.join(stem, "__init__.py"), name), (f"{stem}.py", name.rpartition(".")[0])):
            if (source := _content(path)) is not None:
                return source, package
    return None


def _meant(package: str, imports: tuple[Import, ...], ours: frozenset[str]) -> Iterator[str]:
    """Modules of our packages that imports in a package bring: a name taken from a package may be a module of its own."""
    for level, module, name in imports:
        above = package.split(".")[: package.count(".") + 2 - level] if level else []
        whole = ".".join([*above, *filter(None, [module])])
        parts = whole.split(".")
        if parts[0] in ours:
            # What is imported whole may be looked into at each of its levels.
            names = [whole] if name else [".".join(parts[: k + 1]) for k in range(len(parts))]
            # Only a package holds modules.
            if name and (source := _source(whole)) and source[1] == whole:
                names.append(f"{whole}.{name}")
            yield from filter(_source, names)


@functools.cache
def _direct(name: str, ours: frozenset[str], notes: Path | None) -> tuple[str, tuple[str, ...]]:
    """Digest of a module that there is, and the modules that it imports."""
    source, package = _source(name) or (b"", "")
    digest, imports = _noted(source, notes)
    return digest, tuple(dict.fromkeys(_meant(package, imports, ours)))


def fingerprint(name: str, package: str, file: str, ours: frozenset[str], notes: Path | None = None) -> str | None:
    """Fingerprint of a module and of all modules that it imports, at any distance; None where its source cannot be read.

    Parameters
    ----------
    name, package, file : str
        The module's `__name__`, `__package__` and `__file__`.
    ours : frozenset of str
        Top-level packages: imports of others are not followed.
    notes : Path or None
        Folder where parsed sources are noted for later processes.

    Raises
    ------
    SyntaxError
        One of the sources is none of this version of Python.
    """
    source = _content(file)
    if source is None:
        return None
    digest, imports = _noted(source, notes)
    digests, waiting = {name: digest}, [*_meant(package, imports, ours)]
    while waiting:
        module = waiting.pop()
        if module not in digests:
            digests[module], further = _direct(module, ours, notes)
            waiting += further
    return _digest(json.dumps(digests, sort_keys=True).encode())
