"""Read a part: STEP, IGES or BREP files, kernel shapes, CadQuery and build123d objects."""

import hashlib
import math
import os
from dataclasses import replace
from numbers import Real
from typing import Any

from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

from cad_io import read_iges, read_step
from cad_io.assembly import Node
from cad_io.errors import ReadError
from cad_io.kernel import silence, translated
from cad_io.objects import from_object
from cad_io.part import Part, unwrapped
from cad_io.read_guarded import Found
from cad_io.read_guarded import guarded as in_copy
from cad_io.sniff import load
from cad_io.units import in_mm

#: Seconds that a guarded reading may take.
TIMEOUT = 120.0
#: As good as no limit, s.
_LONGEST = 1e8


def read_part(source: Any, unit: str | None = None, *, guarded: bool = False, timeout: float = TIMEOUT) -> Part:
    """Read a part; faces are numbered from 1 in the order of the kernel's map of the shape read.

    Parameters
    ----------
    source : path, TopoDS_Shape or object
        Path of a STEP, IGES or BREP file; a kernel shape; a CadQuery or build123d object, an assembly too; a list of
        shapes. Faces on a Workplane's stack, and build123d faces that know the shape which they were taken from, are
        `Part.picked` on that shape. A Part is given back as it is.
    unit : str, optional
        What the numbers in the source are in: one of `um`, `mm`, `cm`, `m`, `km`, `mil`, `in`, `ft`. Default: the unit
        that the file names; mm for BREP files and shapes.
    guarded : bool
        Let a copy of the process read, so that a file that crashes or hangs the CAD kernel is a ReadError. Costs a
        little time; needs a system that can fork (not Windows).
    timeout : float
        Seconds that a guarded reading may take.

    Returns
    -------
    Part
        Lengths in mm, one located shape.

    Raises
    ------
    ReadError
        In one line: what is wrong and what to try.
    """
    silence()
    if unit is not None:
        in_mm(unit)
    if not isinstance(guarded, bool):
        raise ReadError(f"guarded must be True or False, not a {type(guarded).__name__}")
    if not isinstance(timeout, Real) or isinstance(timeout, bool) or math.isnan(timeout):
        raise ReadError(f"timeout must be a number of seconds, not a {type(timeout).__name__}")
    if isinstance(source, Part):
        if unit is not None:
            raise ReadError("the part has been read already: give the unit when it is read", file=source.file)
        return source
    if not guarded:
        return Part(**_find(source, unit))

    def find() -> Found:
        found = _find(source, unit)
        Part(**found)  # which asks the kernel more, better here than outside
        return found

    return Part(
        **in_copy(find, min(timeout, _LONGEST), os.fspath(source) if isinstance(source, str | os.PathLike) else None)
    )


def _find(source: Any, unit: str | None) -> Found:
    """What the part is made of."""
    if isinstance(source, str | os.PathLike):
        return _read_file(os.fspath(source), unit)
    found = from_object(source)
    tree = tuple(_scaled_node(node, unit) for node in found["tree"])
    return found | {"shape": _scaled(found["shape"], unit), "tree": tree}


def _read_file(file: str, unit: str | None) -> Found:
    kind, data = load(file)
    checksum = hashlib.sha256(data).hexdigest()
    with translated("reading the file", error=ReadError, file=file):
        if kind == "step":
            read = read_step.read(file, data, unit)
        elif kind == "iges":
            read = read_iges.read(file, data, unit)
        else:
            read = read_step.Read(_scaled(_read_brep(file, kind), unit))
    return {
        "shape": read.shape, "file": file, "sha256": checksum, "names": read.names, "colours": read.colours,
        "layers": read.layers, "tree": read.tree, "warnings": tuple(read.warnings),
    }  # fmt: skip


def _read_brep(file: str, kind: str) -> TopoDS_Shape:
    from OCP.BinTools import BinTools
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools

    shape = TopoDS_Shape()
    if kind == "brep":
        BRepTools.Read_s(shape, file, BRep_Builder())
    else:
        BinTools.Read_s(shape, file)
    if shape.IsNull():
        raise ReadError("is not a whole BREP file: write it again", file=file)
    return unwrapped(shape)


def _scaled(shape: TopoDS_Shape, unit: str | None) -> TopoDS_Shape:
    """A shape without a unit of its own, in mm."""
    if unit is None or unit == "mm":
        return shape
    scale = gp_Trsf()
    scale.SetScale(gp_Pnt(), in_mm(unit))
    return BRepBuilderAPI_Transform(shape, scale, True).Shape()


def _scaled_node(node: Node, unit: str | None) -> Node:
    """An instance whose place is in a unit, in mm."""
    if unit is None or unit == "mm":
        return node
    move = node.place.Transformation()
    move.SetTranslationPart(gp_Vec(move.TranslationPart() * in_mm(unit)))
    return replace(
        node, place=TopLoc_Location(move), children=tuple(_scaled_node(child, unit) for child in node.children)
    )
