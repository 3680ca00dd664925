"""Which side of each face is out of the material?

Solids say it themselves, unless they are inside out (mirrored placements, reversed solids), which the sign of their
volume tells. Closed shells are turned outward by the same sign. Open shells and loose faces have no inside: they are
made consistent with their neighbours, and the side is guessed towards a direction.
"""

from collections import defaultdict, deque
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Face

from cad_io.arrays import Floats, Orientation
from cad_io.kernel import explore, shape_map
from cad_io.part.cap import cap_of, flux_of
from cad_io.part.part import Part
from cad_io.part.repeats import doubled
from cad_io.part.sew import edge_uses

#: Below this, the mean normal says little about the side.
WEAK = 0.3
#: Volumes below this share of area times diagonal are none.
_FLAT = 1e-6
#: A shell whose vector area is below this share of its area is nearly closed.
NEARLY_CLOSED = 0.05


def orient(part: Part, towards: tuple[float, float, float] = (0.0, 0.0, 1.0), flip: bool = False) -> Orientation:
    """Find the side of every face of a part.

    Parameters
    ----------
    part : Part
    towards : tuple of float
        Direction from which open shells and loose faces are worked on; any length but zero.
    flip : bool
        Turn open shells and loose faces the other way.

    Returns
    -------
    Orientation
        `confident` is False where any face's side is a guess.
    """
    count = len(part.faces)
    sign = np.zeros(count)
    notes: list[str] = []
    guessed: list[int] = []
    numbers = shape_map(part.shape, TopAbs_FACE)
    again = doubled(part)
    for solid in part.solid_shapes():
        members = [(numbers.FindIndex(f), TopoDS.Face_s(f)) for f in explore(solid, TopAbs_FACE)]
        members = [(n - 1, f) for n, f in members if n and sign[n - 1] == 0]
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
    if closed and all(c.relative is not None for c in joined):
        disagree = False
        for c in joined:
            # The flags of one shell must all agree, or all disagree, with what its edges say.
            ratio = flags[c.members] * c.relative
            disagree |= bool(np.ptp(ratio) > 0)
        if disagree:
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
        area, vector = vector_area(part, index, relative)
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


class Joined:
    """Faces joined by edges.

    `relative` (k,): +1 or -1 so that all point to one side by `dS/du x dS/dv`. `touching`: they are not closed, but open
    only at edges at which more than two faces meet, those of a body that touches this one.
    """

    def __init__(self, members: list[int], relative: Floats | None, closed: bool, touching: bool = False) -> None:
        self.members, self.relative, self.closed, self.touching = members, relative, closed, touching


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
        queue = deque(members)
        while queue:
            i = queue.popleft()
            for j, same in links[i]:
                if not seen[j]:
                    seen[j] = seen[i] * same
                    members.append(j)
                    queue.append(j)
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
    measures = [part.measure(int(i) + 1) for i in index]
    flux = sum(s * m.flux for s, m in zip(sign, measures, strict=True) if m and np.isfinite(m.flux))
    flux += 0.0 if cap is None else flux_of(cap, part.middle)
    area = sum(m.area for m in measures if m and np.isfinite(m.area))
    enough = abs(flux) > 3 * _FLAT * area * float(np.linalg.norm(part.size))
    return float(flux) / 3 if enough else 0.0


def vector_area(part: Part, index: Iterable[int], sign: Floats) -> tuple[float, Floats]:
    """Area and vector area of a set of faces, mm2."""
    area, vector = 0.0, np.zeros(3)
    for i, s in zip(index, sign, strict=True):
        m = part.measure(int(i) + 1)
        if m and np.isfinite(m.area):
            area, vector = area + m.area, vector + s * m.vector
    return area, vector
