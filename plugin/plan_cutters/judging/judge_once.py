"""A part that motions carry onto itself is judged once: the samples that are no copies first, then their images.

A posture of a sample, moved, is only a candidate at its image, and is tested there among the obstacles as they are: nothing is
called reached without that. That an image is not reached follows where the motion leaves all that verdicts depend on as it is,
and where a tenth of the images on each face, judged by themselves, have the verdicts that follow; if one differs, none follows
(`docs/operations_proof.md`, lemmas P1 and P2).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import ACCESSIBLE, UNJUDGED, VerdictBuffer, Verdicts, blank
from plan_cutters.judging.judge import Judge, judge
from plan_cutters.scene.conditions import Context, contacts_of, free_in_posture, rotations_of
from plan_cutters.scene.copied import some_of
from plan_cutters.scene.copies import Copies
from plan_cutters.scene.ground import made_of, same
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import part_of
from plan_cutters.scene.work import Work

Rows = NDArray[np.int64]
#: A tilt direction that is shorter than 1 by more is that of a contact under the flat of the tip.
_FLAT = 1e-6


class JudgeOnce:
    """Judge as `judge` does, but for samples that are images of others; verdicts are the same, postures may be others.

    Parameters
    ----------
    judged : Judge, optional
        Judges what does not follow.
    motions : int
        How many motions of the whole part there are.

    Attributes
    ----------
    carried : (motions, 3) int64
        Of each motion the images at which the posture of the sample was tested and taken, those called not reached without a
        search, and those that were judged by themselves to verify that: of all cutters and setups so far.
    """

    def __init__(self, judged: Judge = judge, motions: int = 0) -> None:
        self._judged, self.carried = judged, np.zeros((motions, 3), np.int64)
        self._of: tuple[object, ...] = ()
        self._parts: tuple[Rows, Prepared, Rows, Prepared] | None = None

    def __call__(
        self, ready: Prepared, cutter: Cutter, *, known: Verdicts | None = None,
        progress: Callable[[int, int], None] | None = None, work: Work | None = None,
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
