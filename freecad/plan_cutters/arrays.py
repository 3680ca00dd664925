"""Arrays of samples.npz: plain numbers of the size that the file itself has, and nothing that runs.

A document, and the file in it, may come from anybody.
"""

from __future__ import annotations

import math
import zipfile
import zlib
from typing import Any

#: Kinds of numbers that are read: truth values, integers, floats.
KINDS = "buif"
#: Most bytes of one array.
MOST = 2**30


def read(path: str) -> dict[str, Any]:
    """Arrays by their names.

    Raises
    ------
    ImportError
        This FreeCAD has no numpy.
    OSError, ValueError
        The file is missing, torn, or holds something else.
    """
    from numpy.lib import format as npy

    found = {}
    try:
        with zipfile.ZipFile(path) as file:
            for entry in file.infolist():
                with file.open(entry) as stream:
                    if npy.read_magic(stream) != (1, 0):
                        raise ValueError(f"{entry.filename} is of another version")
                    shape, by_columns, kind = npy.read_array_header_1_0(stream)
                    size = kind.itemsize * math.prod(shape)
                    if kind.kind not in KINDS or by_columns or not 0 <= size <= MOST:
                        raise ValueError(f"{entry.filename} holds no plain numbers")
                    data = stream.read(size + 1)
                if len(data) != size:
                    raise ValueError(f"{entry.filename} has another size than it says")
                found[entry.filename[: -len(".npy")]] = _array(data, kind, shape)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError) as error:
        raise ValueError(str(error)) from None
    return found


def _array(data: bytes, kind, shape):
    import numpy

    return numpy.frombuffer(data, kind).reshape(shape)
