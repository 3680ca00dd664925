"""Read a part: STEP, IGES or BREP files, kernel shapes, CadQuery and build123d objects.

A copy of the process may read, so that a crash or a hang of the kernel becomes an error like any other.
"""

import math
import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from numbers import Real
from typing import Any

from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

from cad_io.arrays import LostFace
from cad_io.errors import CadIoError, ReadError
from cad_io.kernel import explore, faces, silence, translated
from cad_io.kernel.shapes import ENDLESS, Node, bound_naturally, endless, unwrapped
from cad_io.part import Part
from cad_io.part.content import PartContent, comes_back, packed, unpacked
from cad_io.read import iges, step
from cad_io.read.objects import from_object
from cad_io.read.sniff import load
from cad_io.units import in_mm
from plan_cutters_base.forks import ChildDied, TimeLimit, limited
from plan_cutters_base.stage_cache import NO_CACHE, Cache
from plan_cutters_base.user_files import checksum


class Crashed(ReadError):
    """The kernel crashed."""


def in_copy(find: Callable[[], PartContent], timeout: float, file: str | None) -> PartContent:
    """Result of `find()`, which may crash or hang, in a forked copy of this process; where the system cannot fork (Windows),
    here.

    Raises what `find` raised, or ReadError where it did not end in so many seconds; `Crashed` if it crashed. Errors name the
    file.
    """

    try:
        answer = limited(lambda: packed(find()), timeout, passing=(CadIoError,))
    except TimeLimit:
        raise ReadError(
            f"not read within {timeout:g} s: it may be damaged; give more time or export it again", file=file
        ) from None
    except ChildDied as died:
        raise Crashed(f"the CAD kernel cannot read it ({died}): export it again", file=file) from None
    with translated("taking over what it made of the file", error=ReadError, file=file):
        return unpacked(answer)


Loaded = step.Loaded | iges.Loaded
_LOADERS: dict[str, Callable[..., Loaded]] = {"step": step.Loaded, "iges": iges.Loaded}
#: Seconds that a guarded reading may take.
TIMEOUT = 120.0
#: As good as no limit, s.
_LONGEST = 1e8


def read_part(
    source: Any, unit: str | None = None, *, guarded: bool = False, timeout: float = TIMEOUT, cache: Cache = NO_CACHE
) -> Part:
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
        Seconds that a guarded reading may take. A file with faults that may harm the kernel is made into shapes in a
        copy of the process in any case.
    cache : StageCache, optional
        Keeps what was read of a file without faults: the kernel reads its own form of a shape some thirty times as fast as
        STEP.

    Returns
    -------
    Part
        Lengths in mm, one located shape. What a faulty file has lost is in `lost`.

    Raises
    ------
    ReadError
        In one line: the fault and its remedy.

    Notes
    -----
    `guarded` is about reading alone. Faces are measured when first asked for, in this process and without a time limit.

    Examples
    --------
    >>> part = read_part("samples/v_groove.step")
    >>> len(part.faces), part.solids, part.lost
    (3, 0, ())
    >>> read_part("samples/missing.step")
    Traceback (most recent call last):
    cad_io.errors.ReadError: samples/missing.step: no such file
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
    timeout = min(float(timeout), _LONGEST)
    if not guarded:
        return Part.of(replace(_find(source, unit, timeout, cache), unit=unit))

    def find() -> PartContent:
        source_part = _find(source, unit, timeout, cache)
        Part.of(source_part)  # which asks the kernel more, better here than outside
        return replace(source_part, unit=unit)

    return Part.of(in_copy(find, timeout, os.fspath(source) if isinstance(source, str | os.PathLike) else None))


def _find(source: Any, unit: str | None, timeout: float, cache: Cache) -> PartContent:
    if isinstance(source, str | os.PathLike):
        return _read_file(os.fspath(source), unit, timeout, cache)
    content = from_object(source)
    bound_naturally(content.shape)
    tree = tuple(_scaled_node(node, unit) for node in content.tree)
    return replace(content, shape=_scaled(content.shape, unit), tree=tree)


def _read_file(file: str, unit: str | None, timeout: float, cache: Cache) -> PartContent:
    kind, data = load(file)
    known: dict[str, Any] = {"file": file, "sha256": checksum(data)}
    if kind not in _LOADERS:
        with translated("reading the file", error=ReadError, file=file):
            whole = _read_brep(file, kind)
            bound_naturally(whole)
            return replace(_content(PartContent(_scaled(whole, unit))), **known)
    loader = partial(_LOADERS[kind], file, data, unit)
    loaded: Any = None
    content: PartContent | None = None

    def transferred() -> PartContent | None:
        """Return what the kernel makes of the file, packed; None where that may harm it."""
        nonlocal loaded, content
        with translated("reading the file", error=ReadError, file=file):
            loaded = loader()
            content = None if loaded.risky else _transferred(lambda: loaded)
        return content and packed(content)

    stored = cache.cached(
        "read", (kind, known["sha256"], unit), transferred,
        # The kernel opens the file itself: what was written there meanwhile is not of this checksum.
        lambda made: made is not None and comes_back(made) and checksum(load(file)[1]) == known["sha256"],
    )  # fmt: skip
    if stored is not None:
        return replace(content or unpacked(stored), **known)
    # A crash costs no more than a copy: try with less and less.
    again = partial(loader, names=False)
    for reload in (lambda: loaded, again, partial(again, careful=True)):
        try:
            return replace(in_copy(partial(_transferred, reload), timeout, file), **known)
        except Crashed as error:
            crash = error
    raise crash


def _transferred(load_again: Callable[[], Loaded]) -> PartContent:
    loaded = load_again()
    with translated("reading the file", error=ReadError, file=loaded.file):
        return _content(loaded.transfer())


def _content(read: PartContent) -> PartContent:
    reported = {each.face for each in read.lost}
    for n, face in enumerate(faces(read.shape), 1):
        if n not in reported and next(explore(face, TopAbs_EDGE), None) is None:
            read.lost.append(LostFace("", read.names.get(n, ""), f"it {ENDLESS if endless(face) else 'has no edges'}", n))
    return read


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
    return replace(node, place=TopLoc_Location(move), children=tuple(_scaled_node(child, unit) for child in node.children))
