"""Whether what was built can be trusted."""

from typing import Any

from OCP.BRep import BRep_Tool
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID

from cad_io.face.uv_region import uv_areas
from cad_io.kernel import explore, shape_map

#: Relative error of a face's parameter area that is still the same area.
_SAME_AREA = 1e-5


def wrong_pieces(face: Any, pieces: list[Any]) -> str:
    """Why pieces do not stand for a face, or nothing.

    Areas are those of the region in the parameter plane, integrated exactly along its boundary: pieces that tile the
    region there tile the face, and the kernel's own areas in mm2 are off by up to 9 % on some surfaces.
    """
    before, *areas = uv_areas([face, *pieces])
    if not all(area * before > 0 for area in areas):
        return "a piece of it has no area"
    if not abs(sum(areas) - before) <= _SAME_AREA * abs(before):
        return "its pieces do not have its area"
    return ""


def wrong_whole(before: Any, after: Any) -> str:
    """Why a shape with other faces does not stand for the one before, or nothing."""
    if _shells(before) != _shells(after):
        return "splitting changes solids or shells"
    return "splitting makes the shape invalid" if not valid(after) and valid(before) else ""


def valid(shape: Any) -> bool:
    """Return whether the kernel's own check finds the shape valid."""
    return bool(BRepCheck_Analyzer(shape).IsValid())


def _shells(shape: Any) -> tuple[int, list[bool]]:
    """Number of solids; closedness of all shells, sorted."""
    closed = [bool(BRep_Tool.IsClosed_s(shell)) for shell in explore(shape, TopAbs_SHELL)]
    return shape_map(shape, TopAbs_SOLID).Extent(), sorted(closed)
