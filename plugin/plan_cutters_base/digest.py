"""Checksums of values: equal values have equal ones in every process, others have others."""

import hashlib
import pickle
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np


def sources(*folders: Path) -> bytes | None:
    """A checksum of all files in some folders, with their names, but for what Python makes of them; None where there are none."""
    files = {
        f"{home.name}/{file.relative_to(home).as_posix()}": file.read_bytes()
        for home in folders
        for file in home.rglob("*")
        if "__pycache__" not in file.parts and file.is_file()
    }
    return digest(files) if files else None


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
    state = hashlib.sha256()
    _feed(state, value)
    return state.digest()


def _feed(state: Any, value: Any) -> None:
    """Write a value in one way; each piece says what it is and how long, so that no two values are written alike."""
    match value:
        case None | bool() | int() | float() | str():
            text = repr(value).encode()
            state.update(b"%s %d:" % (type(value).__name__.encode(), len(text)) + text)
        case bytes():
            state.update(b"bytes %d:" % len(value) + value)
        case np.generic():
            _feed(state, value.item())
        case np.ndarray() if not value.dtype.hasobject:
            state.update(f"array {value.dtype.str} {value.shape}:".encode())
            state.update(np.ascontiguousarray(value).data)
        case tuple() | list():
            state.update(f"list {len(value)}:".encode())
            for each in value:
                _feed(state, each)
        case set() | frozenset():
            state.update(b"set ")
            _feed(state, sorted(map(digest, value)))
        case Mapping():
            state.update(b"mapping ")
            _feed(state, sorted((digest(name), digest(each)) for name, each in value.items()))
        case _ if is_dataclass(value) and not isinstance(value, type):
            state.update(f"{type(value).__qualname__} ".encode())
            # Trees and the like are made of the fields, and not fields that compare.
            _feed(state, [(each.name, getattr(value, each.name)) for each in fields(value) if each.compare])
        case _:
            _feed(state, pickle.dumps(value, protocol=5))
