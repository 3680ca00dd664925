"""Which faces enclose something? Solids, shells without an open edge, and what is nearly closed.

A skin encloses what is within it, whatever lies there: a void in a solid is a body of its own here, as little to be got
into as the material around it. A skin with openings that is meant to be a body is closed by caps, so that what may lie
within is known to lie there perhaps.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Face
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats
from cad_io.kernel import edges_of, explore, shape_map
from cad_io.part.cap import cap_of, flux_of
from cad_io.part.orient import NEARLY_CLOSED, joined_faces, vector_area, volume
from cad_io.part.part import Part
from cad_io.part.sew import edge_uses, join

#: Caps of loose faces of a file that lost some are believed up to this share of the faces' own area.
_SMALL_CAP = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """Faces that enclose something."""

    #: Face numbers.
    faces: tuple[int, ...]
    #: +1 for a face whose `dS/du x dS/dv` points out of the enclosed volume, else -1.
    sign: tuple[int, ...]
    #: False where edges are open: the enclosed volume is then a guess.
    closed: bool
    #: (t, 3, 3); triangles that close open edges, corners counter-clockwise seen from outside; none where it is closed.
    cap: Floats


def _bodies_of_solid(part: Part, numbers: Any, solid: Any, without: Collection[int]) -> Iterator[Body]:
    """Bodies of one solid; `numbers` is the map of the part's faces."""
    members = [(numbers.FindIndex(f), TopoDS.Face_s(f)) for f in explore(solid, TopAbs_FACE)]
    members = [(n, f) for n, f in members if n and n not in without]
    flags = np.array([-1 if f.Orientation() == TopAbs_REVERSED else 1 for _, f in members], int)
    shapes = [f for _, f in members]
    groups = joined_faces(shapes)
    if not all(_boundless([shapes[i] for i in g.members], flags[g.members]) for g in groups):
        # Faces that lie edge to edge without sharing it: joined as loose ones are.
        shapes = join(shapes, float(np.linalg.norm(part.size))).faces
        groups = joined_faces(shapes)
    for group in groups:
        mine, sign = [shapes[i] for i in group.members], flags[group.members]
        if not _boundless(mine, sign) and group.relative is not None:
            # The solid contradicts itself, or is open: what the edges say counts, to the side that most faces name.
            sign = group.relative.astype(int) * int(np.sign((sign * group.relative).sum()) or 1)
        yield from _body(part, [members[i][0] for i in group.members], mine, sign, solid=True)


def _bodies_of_loose(part: Part, without: Collection[int]) -> Iterator[Body]:
    """Bodies of the faces that belong to no solid."""
    loose = {n: face for n, face in part.sewn.faces.items() if n not in without}
    order = _each_once(loose)
    for group in joined_faces([loose[n] for n in order]):
        if group.relative is not None:
            numbers = [order[i] for i in group.members]
            sign, mine = group.relative.astype(int), [loose[n] for n in numbers]
            yield from _body(part, numbers, mine, sign, solid=False, touching=group.touching)


def bodies(part: Part, *, without: Collection[int] = ()) -> tuple[Body, ...]:
    """Every skin of a part that encloses something, each void and each shell of a solid apart.

    A face between two solids belongs to both. Faces whose shell encloses nothing (sheets) are in none.

    Parameters
    ----------
    part : Part
    without : collection of int
        Face numbers to leave out: a skin that has lost some of its faces is open.
    """
    numbers = shape_map(part.shape, TopAbs_FACE)
    solid = [body for each in part.solid_shapes() for body in _bodies_of_solid(part, numbers, each, without)]
    result = {(body.faces, body.sign): body for body in (*solid, *_bodies_of_loose(part, without))}
    return tuple(result.values())


def _each_once(loose: dict[int, TopoDS_Face]) -> list[int]:
    """Numbers of faces, ascending, without those that have just the edges of an earlier one: bodies that lie in one place."""
    edges = TopTools_IndexedMapOfShape()
    first: dict[frozenset[int], int] = {}
    for number in sorted(loose):
        first.setdefault(frozenset(edges.Add(edge) for edge in edges_of(loose[number])), number)
    return sorted(first.values())


def _body(
    part: Part,
    numbers: Sequence[int],
    shapes: Sequence[TopoDS_Face],
    sign: NDArray[np.int64],
    *,
    solid: bool,
    touching: bool = False,
) -> Iterator[Body]:
    """The body that faces with these signs enclose; none if they are a sheet.

    `solid`: the file calls them one. `touching`: they are open only where other faces meet them at their edges.
    """
    index = [n - 1 for n in numbers]
    measured = [None if n in part.unmeasured else part.measure(n) for n in numbers]
    known = all(m is not None and np.isfinite(m.flux) for m in measured)
    if known and _boundless(shapes, sign):
        outward = -sign if volume(part, index, sign.astype(float)) < 0 else sign
        yield Body(tuple(numbers), tuple(int(s) for s in outward), True, np.zeros((0, 3, 3)))
        return
    area, vector = vector_area(part, index, sign.astype(float))
    sure = solid or touching or float(np.linalg.norm(vector)) < NEARLY_CLOSED * area
    # In a file that lost faces, what is open may have been closed.
    if not (sure or part.lost):
        return
    cap = cap_of(shapes, sign.astype(float), float(np.linalg.norm(part.size)))
    normal = np.cross(cap[:, 1] - cap[:, 0], cap[:, 2] - cap[:, 0])
    if not (sure or 0.5 * float(np.linalg.norm(normal, axis=1).sum()) < _SMALL_CAP * area):
        return
    flux = sum(s * m.flux for s, m in zip(sign, measured, strict=True) if m is not None and np.isfinite(m.flux))
    if flux + flux_of(cap, part.middle) < 0:
        sign, cap = -sign, cap[:, ::-1]
    yield Body(tuple(numbers), tuple(int(s) for s in sign), False, cap)


def _boundless(shapes: Sequence[TopoDS_Face], sign: NDArray[np.int64]) -> bool:
    """Whether each edge is run along as often one way as the other: then windings are whole numbers.

    Unlike two faces an edge, this holds for solids that touch themselves along an edge, too.
    """
    uses = edge_uses(shapes)
    return bool(uses) and all(sum(way * int(sign[i]) for i, way in users) == 0 for _, users in uses)
