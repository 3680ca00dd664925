"""Which faces enclose something? Solids, shells without an open edge, and what is nearly closed.

A skin encloses what is within it, whatever lies there: a void in a solid is a body of its own here, as little to be got
into as the material around it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Face

from cad_io.kernel import explore, shape_map
from cad_io.orient import NEARLY_CLOSED, joined_faces, vector_area, volume
from cad_io.part import Part
from cad_io.sew import edge_uses


@dataclass(frozen=True, slots=True)
class Body:
    """Faces that enclose something.

    Attributes
    ----------
    faces : tuple of int
        Face numbers.
    sign : tuple of int
        +1 for a face whose `dS/du x dS/dv` points out of what is enclosed, else -1.
    closed : bool
        False where edges are open: what is within is then a guess.
    """

    faces: tuple[int, ...]
    sign: tuple[int, ...]
    closed: bool


def bodies(part: Part) -> tuple[Body, ...]:
    """Every skin of a part that encloses something, each void and each shell of a solid apart.

    A face between two solids belongs to both. Faces whose shell encloses nothing (sheets) are in none.
    """
    found: list[Body] = []
    numbers = shape_map(part.shape, TopAbs_FACE)
    for solid in part.solid_shapes():
        members = [(numbers.FindIndex(f), TopoDS.Face_s(f)) for f in explore(solid, TopAbs_FACE)]
        members = [(n, f) for n, f in members if n]
        flags = np.array([-1 if f.Orientation() == TopAbs_REVERSED else 1 for _, f in members], int)
        for group in joined_faces([f for _, f in members]):
            mine = [members[i] for i in group.members]
            sign = flags[group.members]
            if not _boundless([f for _, f in mine], sign) and group.relative is not None:
                # The solid contradicts itself: what the edges say counts, to the side that most of its faces name.
                sign = group.relative.astype(int) * int(np.sign((sign * group.relative).sum()) or 1)
            found += _body(part, [n for n, _ in mine], [f for _, f in mine], sign, always=True)
    loose = part.sewn.faces
    order = sorted(loose)
    for group in joined_faces([loose[n] for n in order]):
        if group.relative is not None:
            mine_numbers = [order[i] for i in group.members]
            found += _body(
                part, mine_numbers, [loose[n] for n in mine_numbers], group.relative.astype(int), always=False
            )
    return tuple(dict.fromkeys(found))


def _body(
    part: Part, numbers: Sequence[int], shapes: Sequence[TopoDS_Face], sign: np.ndarray, *, always: bool
) -> Iterator[Body]:
    """The body that faces with these signs enclose; none if it is nothing to speak of. `always`: it was called a solid."""
    index = [n - 1 for n in numbers]
    known = all((m := part.measure(n)) is not None and np.isfinite(m.flux) for n in numbers)
    enclosed = volume(part, index, sign)
    closed = known and _boundless(shapes, sign)
    if not closed and not always:
        area, vector = vector_area(part, index, sign)
        if not float(np.linalg.norm(vector)) < NEARLY_CLOSED * area:
            return
    if not enclosed and (closed or not always):
        return
    outward = sign if enclosed >= 0 else -sign
    yield Body(tuple(numbers), tuple(int(s) for s in outward), closed)


def _boundless(shapes: Sequence[TopoDS_Face], sign: np.ndarray) -> bool:
    """Whether each edge is run along as often one way as the other: then windings are whole numbers.

    Unlike two faces an edge, this holds for solids that touch themselves along an edge, too.
    """
    uses = edge_uses(shapes)
    return bool(uses) and all(sum(way * int(sign[i]) for i, way in users) == 0 for _, users in uses)
