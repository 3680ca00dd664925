"""Regular files alone are read: a pipe may be waited for without end, and a device may never end."""

import os
import stat
from pathlib import Path
from typing import BinaryIO

from plan_cutters.errors import PlanError


class IrregularError(OSError):
    """A path names a folder, a pipe, a socket or a device."""


def open_regular(path: str | os.PathLike[str]) -> BinaryIO:
    """Open a regular file, or a link to one, to read its bytes; nothing else is waited for.

    Raises
    ------
    IrregularError
        It is something else.
    OSError
        It cannot be opened.
    ValueError
        It cannot be the name of a file.
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


def regular_bytes(path: str | os.PathLike[str], most: int) -> bytes | None:
    """Read all bytes of a regular file, or of a link to one; the result is None where there is no such file.

    Parameters
    ----------
    path : path
        Where it should be.
    most : int
        Bytes that it may have.

    Raises
    ------
    PlanError
        It is no regular file, is larger, or cannot be read.

    Examples
    --------
    >>> regular_bytes("not/there", most=10) is None
    True
    """
    name = Path(path).name
    try:
        with open_regular(path) as opened:
            large = os.fstat(opened.fileno()).st_size > most
            data = b"" if large else opened.read(most + 1)
    except (FileNotFoundError, NotADirectoryError):
        return None
    except IrregularError as fault:
        raise PlanError(str(fault), file=name) from None
    except OSError as fault:
        raise PlanError(f"cannot be read: {fault.strerror or fault}", file=name) from None
    except ValueError as fault:
        raise PlanError(f"is no name of a file: {fault}", file=ascii(name)) from None
    if large or len(data) > most:
        raise PlanError(f"is larger than {most} bytes", file=name)
    return data


def _refuse(status: os.stat_result) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise IrregularError("is a folder")
    if not stat.S_ISREG(status.st_mode):
        raise IrregularError("is no regular file, but a pipe or a device")
