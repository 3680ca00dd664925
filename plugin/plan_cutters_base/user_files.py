"""Files that users name: where they may lie, how they are opened, and which were read.

Every reader of a part, a fixture, a tool library, a machine or a setup opens its files here, those that a file names in turn,
too. So one place knows what an answer depends on, and one place can keep a service within its folders.
"""

import hashlib
import json
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from io import BufferedReader
from pathlib import Path

#: Environment variable: a list in JSON of the only folders in which this process and its children read what users name.
WITHIN = "CAD_IO_READ_WITHIN"
_OUTSIDE = "it lies outside the folders that may be read"

_noted: ContextVar[tuple[dict[str, str | None], ...]] = ContextVar("noted", default=())


class IrregularError(OSError):
    """A path names a folder, a pipe, a socket or a device."""


class OutsideError(PermissionError):
    """A path leads out of the folders that may be read."""


def permitted(path: str | os.PathLike[str]) -> str:
    """Where a path leads, past all links; an OutsideError where that is out of the folders of `WITHIN`."""
    name, within = os.fspath(path), os.environ.get(WITHIN)
    if within is None:
        return name
    there = Path(os.path.realpath(name))
    if not any(there.is_relative_to(os.path.realpath(each)) for each in json.loads(within)):
        raise OutsideError(1, _OUTSIDE, name)
    return str(there)


def open_regular(path: str | os.PathLike[str]) -> BufferedReader:
    """Open a regular file, or a link to one, to read its bytes; nothing else is waited for.

    An IrregularError where it is something else, an OSError where it cannot be opened, a ValueError where that is no file's name.
    """
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)
    # Some devices act when they are opened; what takes the place of the file meanwhile is looked at, too.
    _refuse(os.stat(path))
    opened = os.fdopen(os.open(path, flags), "rb")
    try:
        _refuse(os.fstat(opened.fileno()))
    except BaseException:
        opened.close()
        raise
    return opened


def content(path: str | os.PathLike[str], most: int = -1) -> bytes:
    """Read what a user's file holds, at most so many bytes of it, and note it; it raises as `permitted` and `open_regular`."""
    there = permitted(path)
    try:
        with open_regular(there) as opened:
            data = opened.read(most)
    except (FileNotFoundError, NotADirectoryError):
        note(path, None)
        raise
    note(path, data)
    return data


def is_there(path: str | os.PathLike[str]) -> bool:
    """Whether there is a regular file that may be read; that there is none is noted."""
    try:
        exists = os.path.isfile(permitted(path))
    except (OSError, ValueError):
        return False
    if not exists:
        note(path, None)
    return exists


def note(path: str | os.PathLike[str], data: bytes | None) -> None:
    """Say that a file was read, or, without data, that it was looked for and is not there."""
    for references in _noted.get():
        references[os.fspath(path)] = None if data is None else checksum(data)


@contextmanager
def noted() -> Iterator[dict[str, str | None]]:
    """Note what is read meanwhile in this process: by path, as it was opened, the SHA-256 of it; None: there was none.

    >>> with noted() as files:
    ...     is_there("nowhere.fctb")
    False
    >>> files
    {'nowhere.fctb': None}
    """
    references: dict[str, str | None] = {}
    before = _noted.set((*_noted.get(), references))
    try:
        yield references
    finally:
        _noted.reset(before)


def checksum(data: bytes) -> str:
    """SHA-256 of the content of a file."""
    return hashlib.sha256(data).hexdigest()


def _refuse(status: os.stat_result) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise IrregularError("is a folder")
    if not stat.S_ISREG(status.st_mode):
        raise IrregularError("is no regular file, but a pipe or a device")
