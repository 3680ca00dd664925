"""Checksums of values: equal values have equal ones in every process, others have others."""

import hashlib
import pickle
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np


def sources(*folders: Path) -> str:
    """A short checksum of all Python sources in some folders, with their names."""
    found = [
        (f"{home.name}/{source.relative_to(home).as_posix()}", source.read_bytes())
        for home in folders
        for source in sorted(home.rglob("*.py"))
    ]
    return digest(found).hex()[:12]


def digest(value: Any) -> bytes:
    """SHA-256 of a value.

    Parameters
    ----------
    value : object
        Numbers, texts, bytes, arrays, and lists, sets, mappings and dataclasses of such. Anything else counts by its pickle:
        where that differs from run to run, something is done again, which is safe.

    Returns
    -------
    bytes
    """
    found = hashlib.sha256()
    _feed(found, value)
    return found.digest()


def _feed(found: Any, value: Any) -> None:
    """Write a value in one way; each piece says what it is and how long, so that no two values are written alike."""
    match value:
        case None | bool() | int() | float() | str():
            text = repr(value).encode()
            found.update(b"%s %d:" % (type(value).__name__.encode(), len(text)) + text)
        case bytes():
            found.update(b"bytes %d:" % len(value) + value)
        case np.generic():
            _feed(found, value.item())
        case np.ndarray() if not value.dtype.hasobject:
            found.update(f"array {value.dtype.str} {value.shape}:".encode())
            found.update(np.ascontiguousarray(value).data)
        case tuple() | list():
            found.update(f"list {len(value)}:".encode())
            for each in value:
                _feed(found, each)
        case set() | frozenset():
            found.update(b"set ")
            _feed(found, sorted(map(digest, value)))
        case Mapping():
            found.update(b"mapping ")
            _feed(found, sorted((digest(name), digest(each)) for name, each in value.items()))
        case _ if is_dataclass(value) and not isinstance(value, type):
            found.update(f"{type(value).__qualname__} ".encode())
            # Trees and the like are made of the fields, and not fields that compare.
            _feed(found, [(each.name, getattr(value, each.name)) for each in fields(value) if each.compare])
        case _:
            _feed(found, pickle.dumps(value, protocol=5))
