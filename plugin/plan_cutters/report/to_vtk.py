"""The posture found at every sample for ParaView and other readers of VTK: `axes.vtp`, XML PolyData.

An own writer: the VTK package would do it, but takes over a second to load, and the bytes that it writes follow its version. The
format asked for here is small: points, one vertex cell each, arrays deflated and written in base64.
"""

import base64
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.clearance import part_words
from plan_cutters.domain.verdicts import REASONS, WORDS
from plan_cutters.report.axes import CLASSES, columns
from plan_cutters.report.protocol import Judged

_TYPE = {"float64": "Float64", "float32": "Float32", "int64": "Int64", "int32": "Int32", "int8": "Int8", "uint8": "UInt8"}
#: Bytes of a block that is deflated by itself.
_BLOCK = 1 << 20


def write_vtk(result: Judged, _split: object, path: Path) -> None:
    """Write `axes.vtp`: a vertex for each sample, with the columns of `axes.csv` as point data; codes stay numbers.

    What the codes mean stands in the field data, as texts: `verdicts`, `reasons`, `classes`, `parts`, `fixtures`,
    `cutter`, `part`.
    """
    arrays = {column.name: column.values for column in columns(result)}
    point = arrays.pop("point_mm")
    n = len(point)
    about = {
        "cutter": [result.shown],
        "part": [Path(result.part.file).name if result.part.file else ""],
        "verdicts": [f"{code} {word}" for code, word in sorted(WORDS.items())],
        "reasons": [f"{code} {word}" for code, word in enumerate(REASONS)],
        "classes": [f"{code} {word}" for code, word in sorted(CLASSES.items())],
        "parts": [f"{code} {word}" for code, word in sorted(part_words().items())],
        "fixtures": [f"{each.number} {each.name}" for each in result.conditions.surroundings.fixtures],
    }
    text = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" '
        'compressor="vtkZLibDataCompressor">',
        "<PolyData>",
        "<FieldData>",
        *(_texts(name, lines) for name, lines in about.items()),
        "</FieldData>",
        f'<Piece NumberOfPoints="{n}" NumberOfVerts="{n}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">',
        '<PointData Scalars="verdict" Vectors="axis" Normals="normal">',
        *(_array(name, values) for name, values in arrays.items()),
        "</PointData>",
        "<CellData></CellData>",
        "<Points>",
        _array("Points", point),
        "</Points>",
        "<Verts>",
        _array("connectivity", np.arange(n, dtype=np.int64)),
        _array("offsets", np.arange(1, n + 1, dtype=np.int64)),
        "</Verts>",
        "</Piece>",
        "</PolyData>",
        "</VTKFile>",
    ]
    path.write_text("\n".join(text) + "\n", encoding="ascii", errors="xmlcharrefreplace")


def _array(name: str, values: NDArray[Any]) -> str:
    kind = _TYPE[values.dtype.name]
    parts = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    little = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    return f'<DataArray type="{kind}" Name={quoteattr(name)}{parts} format="binary">{_packed(little.tobytes())}</DataArray>'


def _packed(data: bytes) -> str:
    """Blocks that are deflated one by one, behind their sizes: both in base64, each by itself."""
    blocks = [zlib.compress(block, 6) for block in _blocks(data)]
    last = len(data) % _BLOCK
    sizes = np.array([len(blocks), _BLOCK, last, *map(len, blocks)], "<u8")
    return base64.b64encode(sizes.tobytes()).decode() + base64.b64encode(b"".join(blocks)).decode()


def _blocks(data: bytes) -> Iterator[bytes]:
    for start in range(0, len(data), _BLOCK):
        yield data[start : start + _BLOCK]


def _texts(name: str, lines: list[str]) -> str:
    """An array of texts: the codes of their bytes, a zero behind each."""
    codes = b"".join(line.encode() + b"\0" for line in lines)
    numbers = " ".join(map(str, codes))
    return f'<Array type="String" Name={quoteattr(name)} NumberOfTuples="{len(lines)}" format="ascii">{numbers}</Array>'
