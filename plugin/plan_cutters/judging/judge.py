"""One cutter on samples of a part that is ready: the seed's two phases, one after the other; and the same verdicts in other ways.

Verdicts that a cache holds are not searched for again: all that they depend on beside the cutter, the ground, has a checksum.

A part that motions carry onto itself is judged once: the samples that are no copies first, then their images. A posture of a
sample, moved, is only a candidate at its image, and is tested there among the obstacles as they are: nothing is called reached
without that. That an image is not reached follows where the motion leaves all that verdicts depend on as it is, and where a tenth
of the images on each face, judged by themselves, have the verdicts that follow; if one differs, none follows
(`docs/operations_proof.md`, lemmas P1 and P2).
"""

from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import ACCESSIBLE, CONVEX, FIXTURE, INSIDE, UNJUDGED, VerdictBuffer, Verdicts, blank
from plan_cutters.judging.phases import access, decompose
from plan_cutters.scene.conditions import Context, contacts_of, free_in_posture, rotations_of
from plan_cutters.scene.copied import some_of
from plan_cutters.scene.preparation import Copies, Prepared
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.scene.work import Progress, Work, evenly, part_of, with_company
from plan_cutters_base.values import digest

#: Grounds whose checksums are remembered.
_GROUNDS = 8


def made_of(ready: Prepared) -> tuple[object, ...]:
    """Return the objects that the ground of a part follows from: while these are the same ones, so is the ground."""
    return ready.samples, ready.surface_class, ready.inside, ready.held, ready.drilled, ready.conditions


def same(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    """Whether two grounds are made of the same objects, which no copy of an equal one is."""
    return len(one) == len(other) and all(mine is theirs for mine, theirs in zip(one, other, strict=True))


@dataclass(slots=True)
class GroundDigests:
    """Checksums of grounds, each taken once while the part that it is of is at hand."""

    _known: list[tuple[tuple[object, ...], bytes]] = field(default_factory=list)

    def of(self, ready: Prepared) -> bytes:
        """The checksum of the ground of a part; names, threads and what is told of obstacles change nothing."""
        made = made_of(ready)
        for other, known in self._known:
            if same(made, other):
                return known
        samples = replace(
            ready.samples, uv=np.zeros((0, 2)), area=np.zeros(0), neighbours=np.zeros((0, 2), np.int32), reasons=(),
            grids=(), empty=(), face_gaps=(),
        )  # fmt: skip
        machine = replace(ready.conditions.machine, name="", notes=())
        conditions = replace(ready.conditions, jobs=1, machine=machine, surroundings=_bare(ready.conditions.surroundings))
        result = digest((samples, ready.surface_class, ready.inside, ready.shut, ready.clamped, ready.drilled, conditions))
        # One part of many setups and of patterns is asked for in turn.
        self._known = [(made, result), *self._known[: _GROUNDS - 1]]
        return result


def _bare(surroundings: Surroundings) -> Surroundings:
    """The same obstacles without what is told of them."""
    alone = None if surroundings.alone is None else _bare(surroundings.alone)
    return replace(surroundings, missing=(), on_bodies=(), lost=(), fixtures=(), alone=alone)


class Judge(Protocol):
    """`judge` at all samples, and whatever gives the same verdicts in another way."""

    def __call__(
        self, ready: Prepared, cutter: Cutter, *, known: Verdicts | None = None,
        progress: Progress | None = None, work: Work | None = None,
    ) -> Verdicts: ...  # fmt: skip


def judge(
    ready: Prepared, cutter: Cutter, rows: NDArray[np.int64] | None = None, known: Verdicts | None = None, *,
    progress: Progress | None = None, work: Work | None = None,
) -> Verdicts:  # fmt: skip
    """Find the verdicts of a cutter on some samples, or on all; nothing else is looked at or changed.

    `rows` (m,) int64: samples, ascending. However they are divided, each gets the same answer, bit for bit: the search of its
    neighbours is repeated. `known`: verdicts that follow from other cutters (`nesting.handed`), for all samples. The result is
    that of the m samples.
    """
    samples, context = ready.samples, Context.of(cutter, ready.conditions)
    whole = None if rows is None else with_company(rows, len(samples))
    convex = (ready.surface_class == CONVEX) & ~ready.for_drills
    free = decompose(samples, convex, context, inside=ready.shut, rows=whole, work=work)
    verdicts = access(
        samples, free, context, inside=ready.shut, known=known, rows=whole, drilled=ready.drilled, progress=progress, work=work
    )
    # What is clamped is lost to what holds it, if nothing was found that loses it all the same.
    held = ready.clamped & (ready.inside < 0) & (verdicts.reason == INSIDE)
    if held.any():
        verdicts = replace(verdicts, reason=np.where(held, FIXTURE, verdicts.reason).astype(np.uint8))
    return verdicts if rows is None else verdicts.of(rows)


class CachedJudge:
    """Judge as `judge` does, but for what a part's cache holds for this ground, cutter, and what was known from others."""

    def __init__(self) -> None:
        self._grounds = GroundDigests()

    def __call__(
        self, ready: Prepared, cutter: Cutter, *, known: Verdicts | None = None,
        progress: Progress | None = None, work: Work | None = None,
    ) -> Verdicts:  # fmt: skip
        """Find the verdicts of a cutter; parameters and result as of `judge`. The work is that of the run that judged."""

        def searched() -> tuple[Verdicts, int]:
            counted = Work()
            return judge(ready, cutter, known=known, progress=progress, work=counted), counted.looked

        follows_from = (self._grounds.of(ready), replace(cutter, name=""), known)
        verdicts, looked = ready.cache.cached("verdicts", follows_from, searched)
        if work is not None:
            work.add(looked)
        return verdicts


Rows = NDArray[np.int64]
#: A tilt direction that is shorter than 1 by more is that of a contact under the flat of the tip.
_FLAT = 1e-6


class JudgeOnce:
    """Judge as `judge` does, but for samples that are images of others; verdicts are the same, postures may be others.

    `judged`: judges what does not follow. `motions`: how many motions of the whole part there are. `carried` (motions, 3) int64:
    of each motion the images at which the posture of the sample was tested and taken, those called not reached without a search,
    and those that were judged by themselves to verify that: of all cutters and setups so far.
    """

    def __init__(self, judged: Judge = judge, motions: int = 0) -> None:
        self._judged, self.carried = judged, np.zeros((motions, 3), np.int64)
        self._of: tuple[object, ...] = ()
        self._parts: tuple[Rows, Prepared, Rows, Prepared] | None = None

    def __call__(
        self, ready: Prepared, cutter: Cutter, *, known: Verdicts | None = None,
        progress: Progress | None = None, work: Work | None = None,
    ) -> Verdicts:  # fmt: skip
        """Find the verdicts of a cutter; parameters and result as of `judge`."""
        copies = ready.copies
        if copies is None or not copies.follow.any():
            return self._judged(ready, cutter, known=known, progress=progress, work=work)
        first, some, rest, others = self._split(ready, copies)
        n = len(ready.samples)
        known = blank(n).freeze() if known is None else known
        result = blank(n)
        tell = (None, None) if progress is None else (part_of(progress, 0, 2), part_of(progress, 1, 2))
        _put(result, first, self._judged(some, cutter, known=known.of(first), progress=tell[0], work=work))
        follows = blank(n)
        follows.take(rest, known)
        self._moved(ready, cutter, copies, rest, result, follows, work)
        self._carry(ready, copies, rest, result, follows)
        _put(result, rest, self._judged(others, cutter, known=follows.freeze().of(rest), progress=tell[1], work=work))
        return result.freeze()

    def _split(self, ready: Prepared, copies: Copies) -> tuple[Rows, Prepared, Rows, Prepared]:
        """Samples that are judged first and those that follow, each with the part that has these alone."""
        of = made_of(ready)
        if self._parts is None or not same(of, self._of):
            early = ~copies.copy | copies.verified
            first, rest = np.flatnonzero(early), np.flatnonzero(~early)
            self._of, self._parts = of, (first, some_of(ready, first), rest, some_of(ready, rest))
        return self._parts

    def _moved(
        self, ready: Prepared, cutter: Cutter, copies: Copies, rest: Rows, result: VerdictBuffer, follows: VerdictBuffer,
        work: Work | None,
    ) -> None:  # fmt: skip
        """Take the postures of masters, moved, where the cutter stands free in them."""
        samples, conditions = ready.samples, ready.conditions
        context = Context.of(cutter, conditions)
        rows = rest[(follows.verdict[rest] == UNJUDGED) & (result.verdict[copies.master[rest]] == ACCESSIBLE)]
        # Along a flank a tool is put down elsewhere than at the sample: its copies are searched.
        rows = rows[~result.shift[copies.master[rows]].any(axis=1)]
        if not len(rows) or not context.judges:
            return
        master = copies.master[rows]
        axis, direction = np.full((2, len(samples), 3), np.nan)
        rotation, direction[rows], axis[rows] = _posture(
            ready, rows, copies.moved(rows, result.tilt_direction[master]), result.tilt[master]
        )
        good = free_in_posture(contacts_of(samples), rows[conditions.allows(axis[rows])], axis, direction, context, work)[rows]
        taken, own = rows[good], master[good]
        follows.verdict[taken], follows.axis[taken], follows.tilt_direction[taken] = ACCESSIBLE, axis[taken], direction[taken]
        follows.tilt[taken], follows.rotation[taken] = result.tilt[own], rotation[good]
        self._count(copies, taken, 0)

    def _carry(self, ready: Prepared, copies: Copies, rest: Rows, result: VerdictBuffer, follows: VerdictBuffer) -> None:
        """Take over that images are not reached, where all that were verified have the verdicts of their masters."""
        # What is clamped, or lies in a body, in this setup says nothing of what does not.
        shut = ready.shut >= 0
        may = copies.follow & (shut == shut[copies.master])
        tenth = np.flatnonzero(copies.verified & may)
        master = copies.master[tenth]
        self._count(copies, tenth, 2)
        missed = result.not_reached
        if (missed[tenth] != missed[master]).any() or (result.verdict[tenth] != result.verdict[master])[missed[tenth]].any():
            return
        may &= np.isin(copies.group, copies.group[tenth])
        rows = rest[may[rest] & (follows.verdict[rest] == UNJUDGED) & missed[copies.master[rest]]]
        master = copies.master[rows]
        follows.verdict[rows], follows.reason[rows] = result.verdict[master], result.reason[master]
        self._count(copies, rows, 1)

    def _count(self, copies: Copies, rows: Rows, what: int) -> None:
        """Book samples on the motions whose images they are."""
        self.carried[:, what] += np.bincount(copies.motion[rows], minlength=len(self.carried))[: len(self.carried)]


def _posture(ready: Prepared, rows: Rows, moved: Floats, tilt: Floats) -> tuple[NDArray[np.int32], Floats, Floats]:
    """The searched rotation (m,) next to each moved tilt direction (m, 3), and the tilt direction and axis there at a tilt."""
    rotations, normal, first = ready.conditions.postures.rotations, ready.samples.normal[rows], ready.samples.direction_max[rows]
    away = np.abs((rotations_of(normal, first, moved)[:, None] - rotations + np.pi) % (2.0 * np.pi) - np.pi)
    nearest = away.argmin(axis=1).astype(np.int32)
    turn = rotations[nearest][:, None]
    direction = np.cos(turn) * first + np.sin(turn) * np.cross(normal, first)
    flat = np.linalg.norm(moved, axis=1) < 1.0 - _FLAT
    # Under the flat it says how far the contact is from the axis, and whereto.
    direction[flat] = (moved - (moved * normal).sum(axis=1)[:, None] * normal)[flat]
    return nearest, direction, np.cos(tilt)[:, None] * normal + np.sin(tilt)[:, None] * direction


def _put(result: VerdictBuffer, rows: Rows, verdicts: Verdicts) -> None:
    """Write the verdicts (m,) of some samples."""
    whole = np.full(len(result.verdict), -1, np.int64)
    whole[rows] = np.arange(len(rows))
    result.take(rows, verdicts, whole[rows])


def in_setup(
    ready: Prepared, cutter: Cutter, setup: int, verdicts: Verdicts, *, progress: Progress | None = None, judged: Judge = judge
) -> Verdicts:
    """Find the verdicts of a cutter in another setup.

    `setup`: its number, from 1. The side of open faces stays as it is. `verdicts`: its verdicts in the setup of `ready`.
    `judged`: gives verdicts as `judge` does.
    """
    there = ready.there(setup)
    conditions, known = there.conditions, blank(len(ready.samples))
    machine = conditions.machine
    # Among other fixtures, nothing is known of a posture.
    rows = np.flatnonzero(verdicts.reached & (conditions.surroundings is ready.conditions.surroundings))
    # Where fewer than two axes turn the tool, rotations are numbered by the axes that there are in a setup.
    few = machine.turns and machine.turning < 2
    rows = rows[:0] if few else rows[conditions.allows(verdicts.axis[rows])]
    known.verdict[rows] = ACCESSIBLE
    known.take_posture(rows, verdicts)
    return judged(there, cutter, known=known.freeze(), progress=progress)


#: Samples that are looked at, fewer with many cutters, at least so many; where all cutters at all samples are fewer pairs than
#: the last, their verdicts come as soon.
_LOOKED_AT, _PAIRS, _LEAST, _WORTH = 400, 4_000, 100, 40_000


@dataclass(frozen=True, eq=False)
class FirstLook:
    """A first look has the verdicts of all cutters at some samples of the first setup."""

    ready: Prepared  #: With those samples alone.
    verdicts: dict[Cutter, Verdicts]  #: In the order of the request.
    of: int  #: How many samples there are.

    @property
    def samples(self) -> int:
        """How many were looked at."""
        return len(self.ready.samples)

    @property
    def shares(self) -> tuple[tuple[Cutter, float], ...]:
        """The share of area that each cutter reaches of them."""
        return tuple((cutter, self._share(each.reached)) for cutter, each in self.verdicts.items())

    @property
    def together(self) -> float:
        """The share that they reach together."""
        return self._share(np.logical_or.reduce([each.reached for each in self.verdicts.values()]))

    def _share(self, reached: NDArray[np.bool_]) -> float:
        area = np.nan_to_num(self.ready.samples.area)
        return float(reached @ area) / max(1e-300, float(area.sum()))


def worth_a_look(ready: Prepared) -> bool:
    """Whether verdicts at some samples come much sooner than those at all."""
    return int(ready.finished.sum()) * len(ready.cutters) >= _WORTH


def first_look(ready: Prepared) -> FirstLook:
    """Judge all cutters at some samples of the first setup.

    Its verdicts are those of the plan in this setup, but for what is nothing beside the whole: copies, and cutters that
    others decide. There is one on each face at least, and they say how far apart they are.
    """
    every, by_face, samples = np.flatnonzero(ready.finished), ready.samples.by_face(), ready.samples
    few = min(_LOOKED_AT, max(_LEAST, _PAIRS // len(ready.cutters)), len(every))
    rows = evenly(every, few)
    unseen = [mine[len(mine) // 2] for number, mine in by_face.items() if number not in np.unique(samples.face[rows])]
    some = some_of(ready, np.unique(np.append(rows, np.array(unseen, np.int64))))
    gaps, mine = dict(samples.face_gaps), some.samples.by_face()
    for number, gap in gaps.items():
        near = cKDTree(some.samples.point[mine[number]]).query(samples.point[by_face[number]])[0]
        gaps[number] = gap + float(near.max())
    apart = replace(some.samples, face_gaps=tuple(gaps.items()), max_gap=max(gaps.values(), default=samples.max_gap))
    some = replace(some, samples=apart)
    return FirstLook(some, {cutter: judge(some, cutter) for cutter in ready.cutters}, len(every))
