"""Find what of a part lies at the jaws of a vise or chuck in its place: what rests on their ledges, which bodies they hold."""

from collections.abc import Iterator, Sequence

import numpy as np

from cad_io.arrays import Floats, Ints, Triangles
from cad_io.part.bodies import Body
from plan_cutters.domain.clamping import Clamping, Vise
from plan_cutters.domain.fixture import Fixture
from plan_cutters.setups.workpiece import TOGETHER, clipped

_UP = np.array([0.0, 0.0, 1.0])


def at_jaws(clamping: Clamping, vertex: Floats, face: Ints, low: float, high: float) -> Iterator[tuple[Ints, Floats]]:
    """Cut triangles to what lies between the jaws, before each of them and between two heights: their faces, and how far each of
    them reaches towards it.

    Parameters
    ----------
    clamping : Vise or Chuck
        In its place.
    vertex : (n, 3, 3) float
        Triangles in its own frame, mm.
    face : (n,) int
        Face numbers of them.
    low, high : float
        mm.

    Yields
    ------
    face : (k,) int
        Of the triangles that lie there at least in part.
    reach : (k,) float
        How far they are from the middle at most: in a vise across the jaws, in a chuck from its axis; mm. Jaws grip at
        `0.5 * gap` or `0.5 * diameter`.
    """
    vertex, face = clipped(vertex, face, _UP, low, high)
    for turn in clamping.turns:
        towards = np.array([np.cos(turn), np.sin(turn), 0.0])
        along = np.array([-towards[1], towards[0], 0.0])
        piece, mine = clipped(vertex, face, along, -clamping.half_width, clamping.half_width)
        piece, mine = clipped(piece, mine, towards, 0.0, 0.5 * clamping.numbers[-1] + TOGETHER)
        away = piece @ towards if isinstance(clamping, Vise) else np.linalg.norm(piece[..., :2], axis=-1)
        yield mine, away.max(axis=1, initial=-np.inf)


def on_ledges(clamping: Clamping, vertex: Floats, face: Ints, flat: float) -> frozenset[int]:
    """Faces of triangles in the frame of a vise or chuck that lie on its ledges: some of their area does, to a height `flat`, mm.

    >>> from plan_cutters.domain.clamping import Vise
    >>> square = np.array([[[15.0, 0, 0], [20, 0, 0], [20, 5, 0]], [[-5, 0, 0], [5, 0, 0], [5, 5, 0]]])
    >>> sorted(on_ledges(Vise(46.0, 25.0, 65.0, gap=40.0), square, np.array([7, 8]), 1e-6))
    [7]
    """
    inner = 0.5 * clamping.numbers[-1] - clamping.ledge + flat
    each = at_jaws(clamping, vertex, face, -flat, flat)
    return frozenset(int(n) for mine, reach in each for n in np.unique(mine[reach > inner]))


def held_bodies(clamping: Clamping, vertex: Floats, face: Ints, bodies: Sequence[frozenset[int]], slack: float) -> frozenset[int]:
    """Which bodies jaws hold, as numbers in `bodies`: all jaws touch them.

    Where no body has all jaws on it, those are held that lie one against the other from jaw to jaw; none where there is a gap
    between them.

    Parameters
    ----------
    clamping, vertex, face
        As for `at_jaws`.
    bodies : sequence of frozenset of int
        The faces of each.
    slack : float
        How far triangles may be off, mm.
    """
    owner = {number: k for k, faces in enumerate(bodies) for number in faces}
    inner = 0.5 * clamping.numbers[-1] - TOGETHER - slack
    touched = [
        {owner[n] for n in np.unique(mine[reach >= inner]).tolist() if n in owner}
        for mine, reach in at_jaws(clamping, vertex, face, 0.0, clamping.grip)
    ]
    if every := set.intersection(*touched):
        return frozenset(every)
    if not all(touched) or (isinstance(clamping, Vise) and not _pressed(clamping, vertex, face, owner, slack)):
        return frozenset()
    return frozenset(set.union(*touched))


def unheld_bodies(
    clamping: Clamping, fixture: Fixture, triangles: Triangles, bodies: Sequence[frozenset[int]]
) -> tuple[int, ...]:
    """Bodies of a part that a vise or chuck in its place does not hold, each by its first face."""
    vertex = (triangles.vertex - fixture.shift) @ fixture.rotation
    held = held_bodies(clamping, vertex, triangles.face, bodies, triangles.chord_error)
    return tuple(sorted(min(faces) for k, faces in enumerate(bodies) if k not in held))


def material_bodies(bodies: Sequence[Body], sign: Floats) -> tuple[frozenset[int], ...]:
    """The faces of each body that is material, without the voids in them; bodies that share a face are one.

    `sign` (faces,): side of each face that is out of the material.
    """
    joined = list[frozenset[int]]()
    for body in bodies:
        if float(np.dot(body.sign, sign[np.array(body.faces) - 1])) > 0.0:
            mine = frozenset(body.faces)
            touching = [each for each in joined if each & mine]
            joined = [each for each in joined if each not in touching] + [mine.union(*touching)]
    return tuple(joined)


def _pressed(vise: Vise, vertex: Floats, face: Ints, owner: dict[int, int], slack: float) -> bool:
    """Whether bodies lie one against the other from jaw to jaw, by the intervals across the jaws that they take between these."""
    vertex, face = clipped(vertex, face, _UP, 0.0, vise.grip)
    vertex, face = clipped(vertex, face, np.array([0.0, 1.0, 0.0]), -vise.half_width, vise.half_width)
    body = np.array([owner.get(n, -1) for n in face.tolist()], np.int64)
    of = {k: vertex[body == k][..., 0] for k in set(body.tolist()) - {-1}}
    spans = sorted((float(x.min()), float(x.max())) for x in of.values())
    reached = -0.5 * (vise.gap or 0.0)
    for low, high in spans:
        if low > reached + TOGETHER + slack:
            return False
        reached = max(reached, high)
    return reached >= 0.5 * (vise.gap or 0.0) - TOGETHER - slack
