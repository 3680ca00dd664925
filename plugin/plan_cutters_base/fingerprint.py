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
from importlib.machinery import PathFinder
from pathlib import Path
from zipimport import zipimporter

from plan_cutters_base.user_cache import read_entry, write_entry

#: Packages whose sources decide what is judged.
PROGRAM = ("cad_io", "plan_cutters", "plan_cutters_base")
#: Level of a relative import (0 for an absolute one), module, and the name taken from it, empty for the module itself.
Import = tuple[int, str, str]


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _parsed(source: bytes) -> tuple[str, list[Import]]:
    """The meaning of a source: the digest of its syntax tree, and what it imports."""
    tree, imports = ast.parse(source), set[Import]()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            imports |= {(0, each.name, "") for each in node.names}
        elif isinstance(node, ast.ImportFrom):
            imports |= {(node.level, node.module or "", each.name) for each in node.names}
        elif isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and ast.get_docstring(node):
            del node.body[0]
    return _digest(ast.dump(tree).encode()), sorted(imports)


@functools.cache
def _dialect() -> bytes:
    """What a note holds for: how this module parses, and the version of Python."""
    return (_content(__file__) or b"") + sys.version.encode()


@functools.cache
def _noted(source: bytes, notes: Path | None) -> tuple[str, list[Import]]:
    """Parse a source, or take what an earlier process noted: notes lie by the bytes of sources, so that none is out of date."""
    if notes is None:
        return _parsed(source)
    note = notes / _digest(_dialect() + source)[:32]
    with contextlib.suppress(OSError, ValueError):
        if (content := read_entry(note)) is not None:
            digest, imports = json.loads(content)
            return digest, imports
    result = _parsed(source)
    with contextlib.suppress(OSError):
        notes.mkdir(parents=True, exist_ok=True)
        write_entry(note, [json.dumps(result).encode()])
    return result


def _content(path: str) -> bytes | None:
    """Bytes of a source, which may lie in an archive that modules are imported from; None where there is none."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError:
        with contextlib.suppress(ImportError, OSError):
            return zipimporter(os.path.dirname(path)).get_data(path)
    return None


@functools.cache
def _source(name: str) -> tuple[bytes, str] | None:
    """Source of a module, and the package that its relative imports begin in; None where there is none. Nothing is imported."""
    names = name.split(".")
    try:
        spec = importlib.util.find_spec(names[0])
    except ValueError:  # the module that Python was started with
        return None
    for k in range(1, len(names)):
        if spec is None or spec.submodule_search_locations is None:
            return None
        spec = PathFinder.find_spec(".".join(names[: k + 1]), spec.submodule_search_locations)
    if spec is None or not (spec.origin or "").endswith(".py") or (source := _content(str(spec.origin))) is None:
        return None
    return source, spec.parent or ""


def _meant(package: str, imports: list[Import], ours: frozenset[str]) -> Iterator[str]:
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

    The first three are the module's `__name__`, `__package__` and `__file__`; imports of packages that are not `ours` are not
    followed. `notes`: the folder where parsed sources are noted for later processes. A SyntaxError where one of the sources is
    none of this version of Python.
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
