"""Which side of each face is out of the material, and which faces enclose something: solids, closed and nearly closed shells.

Solids say their side themselves, unless they are inside out (mirrored placements, reversed solids), which the sign of their
volume tells. Closed shells are turned outward by the same sign. Open shells and loose faces have no inside: they are
made consistent with their neighbours, and the side is guessed towards a direction.

A skin encloses what is within it, whatever lies there: a void in a solid is a body of its own here, as little to be got
into as the material around it. A skin with openings that is meant to be a body is closed by caps, so that what may lie
within is known to lie there perhaps. How a cap runs between its borders is a guess: what follows from it alone is never called
sure.
"""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GCPnts import GCPnts_TangentialDeflection
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face
from OCP.TopTools import TopTools_IndexedMapOfShape
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Orientation
from cad_io.graphs import connected
from cad_io.kernel import edges_of, may_refuse
from cad_io.part.part import Part
from cad_io.part.patterns import doubled
from cad_io.part.sew import edge_uses, join
from plan_cutters_base.forks import Ended, each

#: Deflections of a cap's border, rad, and mm as a share of the part's diagonal.
_ANGLE, _CHORD = 0.2, 1e-4
#: Ends of open edges so near, as a share of the part's diagonal, are one.
_SAME = 1e-5
#: Processor seconds that one edge may take: it takes less than a millisecond.
SECONDS = 5.0


def flux_of(cap: Floats, origin: Floats) -> float:
    """Integral of (S - origin) . N over triangles (t, 3, 3), mm3: three times the volume over the origin."""
    normal = np.cross(cap[:, 1] - cap[:, 0], cap[:, 2] - cap[:, 0])
    return 0.5 * float(((cap[:, 0] - origin) * normal).sum())


def cap_of(shapes: Sequence[TopoDS_Face], sign: Floats, diagonal: float) -> Floats:
    """Triangles (t, 3, 3) that close the openings of faces: each a cone over its border, from the border's middle.

    sign (k,): +1 for a face that is seen from outside with `dS/du x dS/dv` towards the eye, else -1. diagonal: of the part, mm.
    """
    nets = [(edge, sum(way * int(sign[i]) for i, way in users)) for edge, users in edge_uses(shapes)]
    border = [(edge, net) for edge, net in nets if net]
    polylines = each(partial(polyline, chord=_CHORD * diagonal), [edge for edge, _ in border], seconds=SECONDS)
    # An edge that cannot be followed to an end is left out, as one without a curve is.
    pieces = [
        (line, net) for line, (_, net) in zip(polylines, border, strict=True) if not isinstance(line, Ended) and len(line) > 1
    ]
    return coned(pieces, _SAME * diagonal)


def coned(pieces: Sequence[tuple[Floats, int]], near: float) -> Floats:
    """Triangles (t, 3, 3) that close openings, of which ends of pieces so near, mm, belong to one.

    The pieces of the openings' borders are lines (k, 3), each with how often the skin that they border runs along it, negative
    where it does so the other way.
    """
    if not pieces:
        return np.zeros((0, 3, 3))
    lines = [line if net > 0 else line[::-1] for line, net in pieces]
    ends = np.concatenate([line[[0, -1]] for line in lines])
    pairs = cKDTree(ends).query_pairs(near, output_type="ndarray")
    opening = connected(len(ends), np.concatenate([pairs, np.arange(len(ends)).reshape(-1, 2)]))[::2]
    made = []
    for which in range(int(opening.max()) + 1):
        mine = np.flatnonzero(opening == which).tolist()
        apex = np.concatenate([lines[i] for i in mine]).mean(axis=0)
        for i in mine:
            top = np.broadcast_to(apex, (len(lines[i]) - 1, 3))
            made += [np.stack([top, lines[i][1:], lines[i][:-1]], axis=1)] * abs(pieces[i][1])
    return np.concatenate(made)


def polyline(edge: TopoDS_Edge, chord: float) -> Floats:
    """Points (k, 3) along an edge, chords at most so far from it, mm, the way its curve runs; none where it has none."""
    with may_refuse():
        points = GCPnts_TangentialDeflection(BRepAdaptor_Curve(edge), _ANGLE, chord)
        line = np.array([points.Value(i + 1).Coord() for i in range(points.NbPoints())]).reshape(-1, 3)
        if np.isfinite(line).all():
            return line
    return np.zeros((0, 3))


#: Below this, the mean normal says little about the side.
WEAK = 0.3
#: Volumes below this share of area times diagonal are none.
_FLAT = 1e-6
#: A shell whose vector area is below this share of its area is nearly closed.
NEARLY_CLOSED = 0.05


def orient(part: Part, towards: tuple[float, float, float] = (0.0, 0.0, 1.0), flip: bool = False) -> Orientation:
    """Find the side of every face of a part; `confident` is False where any face's side is a guess.

    towards: direction from which open shells and loose faces are worked on, of any length but zero. flip: turn these the other
    way.
    """
    count = len(part.faces)
    sign = np.zeros(count)
    notes: list[str] = []
    guessed: list[int] = []
    again = doubled(part)
    for solid in part.solid_shapes():
        members = [(n - 1, f) for n, f in part.members(solid) if n and sign[n - 1] == 0]
        if not _orient_solid(part, [each for each in members if each[0] + 1 not in again], sign, notes):
            guessed += [n + 1 for n, _ in members]
        for i, face in members:
            sign[i] = sign[i] or (-1.0 if face.Orientation() == TopAbs_REVERSED else 1.0)
    rest = [i for i in range(count) if sign[i] == 0]
    sure = True
    # What lies where others lie would be joined with them: each time by itself.
    for nth in sorted({again.get(i + 1, 0) for i in rest}):
        these = [i for i in rest if again.get(i + 1, 0) == nth]
        sure = (_orient_rest(part, these, sign, notes, np.asarray(towards, float), flip) or nth > 0) and sure
    return Orientation(sign, "; ".join(dict.fromkeys(notes)), sure and not guessed, tuple(sorted(guessed)))


def _orient_solid(part: Part, members: Sequence[tuple[int, TopoDS_Face]], sign: Floats, notes: list[str]) -> bool:
    """Set the signs of one solid's faces; True if they are sure."""
    flags = np.array([-1.0 if face.Orientation() == TopAbs_REVERSED else 1.0 for _, face in members])
    index = np.array([i for i, _ in members], dtype=int)
    if not len(index):
        return True
    joined = joined_faces([face for _, face in members])
    closed = all(c.closed for c in joined)
    consistent = all(c.relative is not None for c in joined)
    # The flags of one shell must all agree, or all disagree, with what its edges say.
    if closed and consistent and any(np.ptp(flags[c.members] * c.relative) > 0 for c in joined):
        for c in joined:
            flags[c.members] = c.relative * np.sign((flags[c.members] * c.relative).sum() or 1.0)
        notes.append("solids whose faces contradict each other were made consistent")
    enclosed = volume(part, index, flags)
    # Of an open skin the flux says nothing: it depends on where it is taken from.
    if closed and enclosed < 0:
        flags = -flags
        notes.append("solids that were inside out were turned")
    sign[index] = flags
    notes.append("faces of solids as the solid says")
    if not closed:
        notes.append("a solid is not closed, so its side is a guess")
    elif part.unmeasured & set((index + 1).tolist()):
        notes.append("a face of a solid was not measured, so its side is a guess")
    elif not enclosed:
        notes.append("a solid encloses no volume that tells its side, so it is a guess")
    return closed and enclosed != 0


def _orient_rest(part: Part, rest: Sequence[int], sign: Floats, notes: list[str], towards: Floats, flip: bool) -> bool:
    """Set the signs of faces outside solids; True if all belong to closed shells."""
    direction = towards / np.linalg.norm(towards)
    sure, guessed, weakest = True, False, 1.0
    joined = part.sewn.faces
    for c in joined_faces([joined[i + 1] for i in rest]):
        index = np.array(rest)[c.members]
        relative = c.relative if c.relative is not None else np.ones(len(index))
        enclosed = volume(part, index, relative) if c.closed else 0.0
        if c.touching:
            cap = cap_of([joined[i + 1] for i in index.tolist()], relative, float(np.linalg.norm(part.size)))
            enclosed = volume(part, index, relative, cap)
        if enclosed:
            sign[index] = relative * np.sign(enclosed)
            notes.append("closed shells outward")
            continue
        area, vector, _ = totals(part, index, relative)
        if not area:  # no surface, no side
            sign[index] = relative
            continue
        sure = False
        alignment = float(vector @ direction) / area
        # A shell that is nearly closed faces no direction; what it nearly encloses tells more than chance.
        nearly = float(np.linalg.norm(vector)) < NEARLY_CLOSED * area and (enclosed := volume(part, index, relative))
        side = np.sign(enclosed) if nearly else (-1.0 if alignment < 0 else 1.0)
        sign[index] = relative * side * (-1.0 if flip else 1.0)
        if nearly:
            notes.append("nearly closed shells outward" + (", flipped" if flip else ""))
            continue
        weakest, guessed = min(weakest, abs(alignment)), True
    if guessed:
        text = "open shells and loose faces " + ("away from" if flip else "towards") + " the given direction"
        if weakest < WEAK:
            text += f", a weak guess (a mean normal makes only {weakest:.2f} with it)"
        notes.append(text)
    return sure


class Joined(NamedTuple):
    """Faces joined by edges.

    `relative` (k,): +1 or -1 so that all point to one side by `dS/du x dS/dv`. `touching`: they are not closed, but open
    only at edges at which more than two faces meet, those of a body that touches this one.
    """

    members: list[int]
    relative: Floats | None
    closed: bool
    touching: bool


def joined_faces(shapes: Sequence[TopoDS_Face]) -> list[Joined]:
    """Split faces into groups joined by edges that two of them share.

    Two faces on either side of an edge point to the same side if they run along the edge in opposite directions.
    `relative` is None where the faces of a group cannot be made consistent (a Moebius strip). A group is closed if it
    runs along each of its edges as often one way as the other; other groups may touch it there.
    """
    uses = edge_uses(shapes)
    links: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for _, users in uses:
        if len(users) == 2 and users[0][0] != users[1][0]:
            (i, way_i), (j, way_j) = users
            links[i].append((j, -way_i * way_j))
            links[j].append((i, -way_i * way_j))
    members_of: list[list[int]] = []
    seen, group_of = np.zeros(len(shapes)), np.full(len(shapes), -1)
    consistent: list[bool] = []
    for first in range(len(shapes)):
        if seen[first]:
            continue
        seen[first], members, agree = 1, [first], True
        for i in members:  # which grow meanwhile
            for j, same in links[i]:
                if not seen[j]:
                    seen[j] = seen[i] * same
                    members.append(j)
                agree &= bool(seen[j] == seen[i] * same)
        group_of[members] = len(members_of)
        members_of.append(members)
        consistent.append(agree)
    closed, free = list(consistent), [not agree for agree in consistent]
    for _, users in uses:
        for group in {int(group_of[i]) for i, _ in users}:
            if sum(way * seen[i] for i, way in users if group_of[i] == group):
                closed[group] = False
                free[group] |= len(users) < 3
    return [
        Joined(members, seen[members].copy() if agree else None, shut, not (shut or open_edge) and len(members) > 1)
        for members, agree, shut, open_edge in zip(members_of, consistent, closed, free, strict=True)
    ]


def volume(part: Part, index: Sequence[int] | NDArray[np.int_], sign: Floats, cap: Floats | None = None) -> float:
    """Signed volume of a closed set of faces, mm3, openings closed by a cap (t, 3, 3); 0 if there is none to speak of, or a
    face is not measured: without it, even the sign would be a guess."""
    if part.unmeasured & {int(i) + 1 for i in index}:
        return 0.0
    area, _, flux = totals(part, index, sign)
    flux += 0.0 if cap is None else flux_of(cap, part.middle)
    enough = abs(flux) > 3 * _FLAT * area * float(np.linalg.norm(part.size))
    return float(flux) / 3 if enough else 0.0


def totals(part: Part, index: Iterable[int], sign: Floats) -> tuple[float, Floats, float]:
    """Area and vector area, mm2, and flux about the part's middle, mm3, of a set of faces, of those that are measured."""
    area, vector, flux = 0.0, np.zeros(3), 0.0
    for i, s in zip(index, sign, strict=True):
        m = part.measure(int(i) + 1)
        if m and np.isfinite(m.area):
            area, vector, flux = area + m.area, vector + s * m.vector, flux + s * m.flux
    return area, vector, flux


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


def _bodies_of_solid(part: Part, solid: Any, without: Collection[int]) -> Iterator[Body]:
    members = [(n, f) for n, f in part.members(solid) if n and n not in without]
    flags = np.array([-1 if f.Orientation() == TopAbs_REVERSED else 1 for _, f in members], int)
    shapes = [f for _, f in members]
    groups = joined_faces(shapes)
    if not all(_boundless([shapes[i] for i in g.members], flags[g.members]) for g in groups):
        # Faces that lie edge to edge without sharing it: joined as loose ones are.
        shapes = [*join(dict(enumerate(shapes)), float(np.linalg.norm(part.size))).faces.values()]
        groups = joined_faces(shapes)
    for group in groups:
        mine, sign = [shapes[i] for i in group.members], flags[group.members]
        if not _boundless(mine, sign) and group.relative is not None:
            # The solid contradicts itself, or is open: what the edges say counts, to the side that most faces name.
            sign = group.relative.astype(int) * int(np.sign((sign * group.relative).sum()) or 1)
        yield from _body(part, [members[i][0] for i in group.members], mine, sign, True)


def _bodies_of_loose(part: Part, without: Collection[int]) -> Iterator[Body]:
    """Bodies of the faces that belong to no solid."""
    loose = {n: face for n, face in part.sewn.faces.items() if n not in without}
    # Without those that have just the edges of an earlier one: bodies that lie in one place.
    edges, first = TopTools_IndexedMapOfShape(), dict[frozenset[int], int]()
    for number in sorted(loose):
        first.setdefault(frozenset(edges.Add(edge) for edge in edges_of(loose[number])), number)
    order = sorted(first.values())
    for group in joined_faces([loose[n] for n in order]):
        if group.relative is not None:
            numbers = [order[i] for i in group.members]
            sign, mine = group.relative.astype(int), [loose[n] for n in numbers]
            yield from _body(part, numbers, mine, sign, group.touching)


def bodies(part: Part, *, without: Collection[int] = ()) -> tuple[Body, ...]:
    """Every skin of a part that encloses something, each void and each shell of a solid apart.

    A face between two solids belongs to both. Faces whose shell encloses nothing (sheets) are in none. Without some faces, by
    their numbers, a skin that has lost them is open.
    """
    solid = [body for each in part.solid_shapes() for body in _bodies_of_solid(part, each, without)]
    result = {(body.faces, body.sign): body for body in (*solid, *_bodies_of_loose(part, without))}
    return tuple(result.values())


def _body(
    part: Part, numbers: Sequence[int], shapes: Sequence[TopoDS_Face], sign: NDArray[np.int64], sure: bool
) -> Iterator[Body]:
    """The body that faces with these signs enclose; none if they are a sheet.

    `sure`: the file calls them one, or they are open only where other faces meet them at their edges.
    """
    index = [n - 1 for n in numbers]
    measured = [None if n in part.unmeasured else part.measure(n) for n in numbers]
    known = all(m is not None and np.isfinite(m.flux) for m in measured)
    if known and _boundless(shapes, sign):
        outward = -sign if volume(part, index, sign.astype(float)) < 0 else sign
        yield Body(tuple(numbers), tuple(int(s) for s in outward), True, np.zeros((0, 3, 3)))
        return
    area, vector, _ = totals(part, index, sign.astype(float))
    sure = sure or float(np.linalg.norm(vector)) < NEARLY_CLOSED * area
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
