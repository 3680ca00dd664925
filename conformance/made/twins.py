"""B-spline twins: every analytic part once more, all its faces converted to B-splines, with the same truth."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from conformance.made.part import MadePart


def _converted(part: MadePart) -> Any:
    """Return the part's shape with B-spline faces."""
    import cadquery as cq
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

    shape = cq.Workplane(obj=part.build().val()).val().wrapped
    return cq.Workplane(obj=cq.Shape.cast(BRepBuilderAPI_NurbsConvert(shape, True).Shape()))


def twin(part: MadePart) -> MadePart:
    """Return the B-spline twin of a part."""
    return replace(part, name=f"{part.name}_bspline", family="twins", title=f"{part.title}: B-spline faces", build=lambda: _converted(part), twin_of=part.name)


def twins(parts: Iterable[MadePart]) -> tuple[MadePart, ...]:
    """Return the twins of all parts that do not consist of freeform faces already."""
    return tuple(twin(part) for part in parts if part.family not in ("freeform", "twins"))
