"""Arrays as the page reads them: whole numbers, differences, planes of bytes, one deflate stream.

`docs/review_page_data.md` has the layout for people who want to read it.
"""

import base64
import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats

#: Filters, the simpler ones first: the first of those that come out smallest is taken.
FILTERS = ("", "delta", "delta_z", "delta2_z")
_TYPES = {"u1": np.uint8, "u2": np.uint16, "u4": np.uint32, "i2": np.int16, "i4": np.int32, "f2": np.float16}
_WORD = {np.dtype(kind): word for word, kind in _TYPES.items()}
#: Filters are tried on so many rows.
_TRIED = 4096
_QUICK = 1  # how hard deflate tries then
#: Quantised coordinates run from 0 to this.
MOST = 65535
#: Octahedral coordinates of normals, each from -1 to 1, are counted in these steps.
FINE, COARSE = 32767, 127


def filtered(array: NDArray[Any], name: str) -> bytes:
    """The bytes of an array under a filter: differences by column, columns one after the other, planes of bytes."""
    size = array.dtype.itemsize
    bits: NDArray[Any] = np.ascontiguousarray(array.astype(array.dtype.newbyteorder("<"))).view(f"<u{size}")
    bits = bits.reshape(len(array), math.prod(array.shape[1:]))
    for _ in range({"delta": 1, "delta2": 2}.get(name.removesuffix("_z"), 0)):
        bits = np.concatenate([bits[:1], bits[1:] - bits[:-1]])
    if name.endswith("_z"):
        signed = bits.view(f"<i{size}")
        bits = ((signed << 1) ^ (signed >> (8 * size - 1))).view(f"<u{size}")
    column = np.ascontiguousarray(bits.T).reshape(-1)
    return column.view(np.uint8).reshape(-1, size).T.tobytes()


@dataclass(frozen=True, slots=True)
class Stored:
    """An array as it is put into the stream: how to read it, its bytes, and a piece of deflate stream that ends at a byte."""

    dtype: str
    shape: tuple[int, ...]
    filter: str
    size: int
    piece: bytes

    @classmethod
    def of(cls, array: NDArray[Any]) -> "Stored":
        """An array under the filter with which its beginning comes out smallest."""
        # From the middle: a beginning is often all alike.
        first = max(0, (len(array) - _TRIED) // 2)
        tried = [len(_piece(filtered(array[first : first + _TRIED], each), _QUICK)) for each in FILTERS]
        chosen = FILTERS[int(np.argmin(tried))]
        data = filtered(array, chosen)
        return cls(_WORD[array.dtype], array.shape, chosen, len(data), _piece(data, 6))


def _piece(data: bytes, level: int) -> bytes:
    made = zlib.compressobj(level, zlib.DEFLATED, -15)
    return made.compress(data) + made.flush(zlib.Z_FULL_FLUSH)


def joined(arrays: Mapping[str, Stored]) -> tuple[dict[str, dict[str, Any]], str]:
    """Describe arrays for the page, and join all of them in one raw deflate stream (RFC 1951), as base64."""
    entries, offset = {}, 0
    for name, each in arrays.items():
        entries[name] = {"dtype": each.dtype, "shape": list(each.shape), "filter": each.filter, "offset": offset,
                         "bytes": each.size}  # fmt: skip
        offset += each.size
    end = zlib.compressobj(9, zlib.DEFLATED, -15).flush()
    return entries, base64.b64encode(b"".join(each.piece for each in arrays.values()) + end).decode("ascii")


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


def halves(array: Floats, toward: str = "nearest") -> NDArray[np.float16]:
    """16-bit floats, the nearest ones or none that is larger (`down`); what is too large as the largest one."""
    most = np.finfo(np.float16).max
    clipped = np.clip(array, -float(most), float(most)).astype(np.float16)
    if toward == "down":
        return np.where(clipped > array, np.nextafter(clipped, -most), clipped)
    return clipped
