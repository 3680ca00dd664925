"""Arrays as the page reads them: whole numbers, differences, planes of bytes, one deflate stream.

`docs/review_page.md` has the layout for people who want to read it.
"""

import base64
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats

#: Filters, the simpler ones first: the first of those that come out smallest is taken.
FILTERS = ("", "delta", "delta_z", "delta2_z")
_TYPES = {"u1": np.uint8, "u2": np.uint16, "u4": np.uint32, "i2": np.int16, "i4": np.int32, "f2": np.float16}
_WORD = {np.dtype(kind): word for word, kind in _TYPES.items()}
#: Quantised coordinates run from 0 to this.
MOST = 65535
#: Octahedral coordinates of normals, each from -1 to 1, are counted in these steps.
FINE, COARSE = 32767, 127


def filtered(array: NDArray[Any], name: str) -> bytes:
    """The bytes of an array under a filter: differences by column, columns one after the other, planes of bytes."""
    size = array.dtype.itemsize
    bits: NDArray[Any] = np.ascontiguousarray(array.astype(array.dtype.newbyteorder("<"))).view(f"<u{size}")
    bits = bits.reshape(len(array), -1)
    for _ in range({"delta": 1, "delta2": 2}.get(name.removesuffix("_z"), 0)):
        bits = np.concatenate([bits[:1], bits[1:] - bits[:-1]])
    if name.endswith("_z"):
        signed = bits.view(f"<i{size}")
        bits = ((signed << 1) ^ (signed >> (8 * size - 1))).view(f"<u{size}")
    column = np.ascontiguousarray(bits.T).reshape(-1)
    return column.view(np.uint8).reshape(-1, size).T.tobytes()


def deflated(data: bytes, level: int = 9) -> bytes:
    """A raw deflate stream (RFC 1951)."""
    made = zlib.compressobj(level, zlib.DEFLATED, -15)
    return made.compress(data) + made.flush()


class Stream:
    """Arrays as they are put one after the other into the stream.

    Attributes
    ----------
    entries : dict
        Name -> where it is and how to read it, for the page.
    """

    def __init__(self) -> None:
        self.entries: dict[str, dict[str, Any]] = {}
        self._sizes: dict[str, int] = {}
        self._bytes = bytearray()

    def add(self, name: str, array: NDArray[Any]) -> None:
        """Put an array in, under the filter with which it comes out smallest."""
        tried = [(filtered(array, each), each) for each in FILTERS]
        sizes = [len(deflated(data, 6)) for data, _ in tried]
        data, chosen = tried[int(np.argmin(sizes))]
        self._sizes[name] = min(sizes)
        self.entries[name] = {
            "dtype": _WORD[array.dtype],
            "shape": list(array.shape),
            "filter": chosen,
            "offset": len(self._bytes),
            "bytes": len(data),
        }
        self._bytes += data

    @property
    def sizes(self) -> Mapping[str, int]:
        """Bytes that each array takes about, deflated."""
        return self._sizes

    def text(self) -> str:
        """All of it as base64 of one deflate stream."""
        return base64.b64encode(deflated(bytes(self._bytes))).decode("ascii")


def placed(point: Floats, low: Floats, high: Floats) -> NDArray[np.uint16]:
    """Points (n, 3) counted in 65535ths of a box."""
    size = np.where(high > low, high - low, 1.0)
    return np.round(np.clip((point - low) / size, 0.0, 1.0) * MOST).astype(np.uint16)


def octahedral(normal: Floats, steps: int) -> NDArray[np.int16]:
    """Unit vectors (n, 3) as two whole numbers from -steps to steps; what is no number as 0, 0."""
    x, y, z = np.nan_to_num(normal).T
    size = np.abs(x) + np.abs(y) + np.abs(z)
    size = np.where(size > 0.0, size, 1.0)
    x, y = x / size, y / size
    folded_x, folded_y = (1 - np.abs(y)) * np.where(x < 0, -1, 1), (1 - np.abs(x)) * np.where(y < 0, -1, 1)
    x, y = np.where(z < 0, folded_x, x), np.where(z < 0, folded_y, y)
    return np.round(np.stack([x, y], axis=1) * steps).astype(np.int16)


def unfolded(stored: NDArray[np.int16], steps: int) -> Floats:
    """Unit vectors (n, 3) of stored ones, in the very steps in which the page finds them: their frames must be the same."""
    x, y = stored[:, 0] / steps, stored[:, 1] / steps
    z = 1.0 - np.abs(x) - np.abs(y)
    folded_x, folded_y = (1.0 - np.abs(y)) * np.where(x < 0, -1, 1), (1.0 - np.abs(x)) * np.where(y < 0, -1, 1)
    x, y = np.where(z < 0, folded_x, x), np.where(z < 0, folded_y, y)
    length = np.sqrt(x * x + y * y + z * z)
    return np.stack([x / length, y / length, z / length], axis=1)


def frame(normal: Floats) -> tuple[Floats, Floats]:
    """Two unit tangents (n, 3) to each normal: t1 = a x n, made unit, with `a` the axis of the least component (the first of
    equal ones), and t2 = n x t1."""
    axis = np.eye(3)[np.abs(normal).argmin(axis=1)]
    first = np.cross(axis, normal)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(normal, first)


def turned(direction: Floats, normal: Floats) -> NDArray[np.int16]:
    """Angles (n,) of directions in the frame of stored normals, of which 32767 are half a turn."""
    first, second = frame(normal)
    direction = np.nan_to_num(direction)
    angle = np.arctan2((direction * second).sum(axis=1), (direction * first).sum(axis=1))
    return np.round(angle / np.pi * FINE).astype(np.int16)


def halves(array: Floats) -> NDArray[np.float16]:
    """16-bit floats; what is too large for them as the largest one."""
    most = float(np.finfo(np.float16).max)
    return np.clip(array, -most, most).astype(np.float16)
