"""Least stick-out: how short a cutter can be held and still reach what it reaches.

A stick-out is tried by the search that judges every cutter. Where a sample is not reached, the postures that it has with a longer
one say exactly how far each lets the holder come down, so that few searches find the least. The result is judged as a plan judges
(Lemma H3 of `docs/proofs.md`).
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.stick_out import StickOut, floor_of, held, outline
from plan_cutters.domain.verdicts import ACCESSIBLE, VerdictBuffer, Verdicts, blank
from plan_cutters.judging.judge import judge
from plan_cutters.kernels.rows import Contacts, Tool
from plan_cutters.scene.conditions import Context, contacts_of, laid_tool_of, rotations_of, verdict_arrays_of
from plan_cutters.scene.distances import deepest_on
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.work import CHUNK, METER, Progress, evenly, in_chunks

#: Stick-outs are found to this, mm; and one this much below the least is too short.
EXACT, BEYOND = 0.005, 0.01
#: Samples all over the part that are looked at first, so that the others meet a stick-out that is nearly enough.
_FIRST = 400
#: Intervals of tilt narrower than this are passed over, rad: as in the search that judges.
_NARROWEST = 1e-5


def least_stick_out(ready: Prepared, cutter: Cutter, verdicts: Verdicts, *, progress: Progress | None = None) -> StickOut:
    """The least stick-out with which a cutter in its holder reaches every sample that it reaches now.

    `verdicts`: what `judge` found for it. `least` is exact to `EXACT` for the rotations of the plan's posture range.
    """
    rows = np.flatnonzero(verdicts.reached)
    longest = cutter.length
    if cutter.holder is None or not len(rows):
        why = "reaches nothing" if cutter.holder else "no holder"
        return StickOut(np.nan, np.nan, longest, why)
    search = _Search(ready, cutter, verdicts, progress or (lambda done, total: None))
    least, limiting = search.all(rows)
    while len(not_reached := search.missed(rows, least)) and least < longest:
        # A holder that is not convex, or an interval of tilts as fine as the search: what is not reached there needs more.
        longer, row = max((search.one(row, least)[0], row) for row in not_reached.tolist())
        least, limiting = min(longest, max(longer, least + EXACT)), row
    least, beyond, limiting = search.lowered(rows, least, limiting)
    stick_out = StickOut(least, search.floor, longest, "floor" if limiting < 0 else "obstacle", served=len(rows))
    return stick_out if limiting < 0 else _limited(ready, cutter, search, stick_out, beyond, limiting)


def _limited(ready: Prepared, cutter: Cutter, search: "_Search", stick_out: StickOut, beyond: float, row: int) -> StickOut:
    """With the posture and the obstacle of the sample that limits it, and the verdict there with a shorter one."""
    shorter = judge(ready, held(cutter, beyond), np.array([row]))
    posture, one = search.found, slice(row, row + 1)
    triangle = int(search.needed(np.array([row]), posture)[1][row])
    obstacles = ready.conditions.obstacles
    axis, normal = posture.axis[row], ready.samples.normal[row]
    face, point = None, None
    if triangle >= 0:
        outer_tool = Context.of(held(cutter, beyond), ready.conditions).outer_tool
        face = obstacles.face(triangle)
        point = deepest_on(
            obstacles.tree.corners(triangle),
            lambda at: outer_tool.depth(
                at, posture.contact(ready.samples.point)[row], normal, posture.tilt_direction[row], float(posture.tilt[row])
            ),
        )
    samples = ready.samples
    turn = float(rotations_of(samples.normal[one], samples.direction_max[one], posture.tilt_direction[one])[0])
    return replace(stick_out, beyond=beyond, verdict=int(shorter.verdict[0]), sample=row, tilt=float(posture.tilt[row]),
                   rotation=turn, axis=axis, tilt_direction=posture.tilt_direction[row], obstacle_face=face,
                   obstacle_point=point)  # fmt: skip


class _Search:
    """Searches of one cutter at any stick-out.

    `found`: a posture of each sample, the shortest one that was looked for. `sure` (n,) float: from this stick-out on a posture
    that was found stays free, with what a cover piece may hold too much and `BEYOND` to spare, mm: so that a judgement finds it,
    or another one. With that or more no search is made. Infinite: none is known.
    """

    def __init__(self, ready: Prepared, cutter: Cutter, verdicts: Verdicts, progress: Progress) -> None:
        conditions = ready.conditions
        self.ready, self.cutter, self.conditions, self.progress = ready, cutter, conditions, progress
        self.contacts: Contacts = contacts_of(ready.samples)
        self.floor = min(cutter.length, floor_of(cutter, conditions.tolerance))
        context = Context.of(cutter, conditions)
        self.outline, self.whole = outline(context.outer_tool, cutter.length), laid_tool_of(context.outer_tool)
        self.found = blank(len(ready.samples))
        self.found.take(slice(None), verdicts)
        self._spare = BEYOND + context.outer_tool.slack
        self.sure = np.full(len(ready.samples), np.inf)
        self._take(np.flatnonzero(verdicts.reached), self.found)

    def _take(self, rows: NDArray[np.int64], posture: VerdictBuffer) -> None:
        """Take postures of some samples where they stay free from a shorter stick-out on than those that are known."""
        needed = self.needed(rows, posture, self.floor - self._spare)[0][rows] + self._spare
        sooner = needed < np.minimum(self.sure[rows], self.cutter.length)
        self.found.take_posture(rows[sooner], posture)
        self.sure[rows[sooner]] = needed[sooner]

    def missed(self, rows: NDArray[np.int64], stick_out: float) -> NDArray[np.int64]:
        """Those of some samples that a judgement does not reach with a stick-out; it is asked where nothing is sure."""
        open_rows = rows[self.sure[rows] > stick_out]
        if not len(open_rows):
            return open_rows
        return np.asarray(open_rows[~judge(self.ready, held(self.cutter, stick_out), open_rows).reached])

    def tool(self, stick_out: float) -> Tool:
        return Context.of(held(self.cutter, stick_out), self.conditions).outer

    def needed(
        self, rows: NDArray[np.int64], posture: VerdictBuffer, floor: float | None = None
    ) -> tuple[Floats, NDArray[np.int32]]:
        """The stick-outs (n,) that known postures of some samples ask for, no less than a floor, and the triangles that are in
        the way."""
        from plan_cutters.kernels.search.stick_out import least_stick_outs

        stick_out = np.full(len(posture.tilt), np.nan)
        triangle = np.full(len(posture.tilt), -1, np.int32)
        samples, tree = self.ready.samples, self.conditions.obstacles.tree
        point = posture.contact(samples.point)
        in_chunks(
            lambda piece: least_stick_outs(piece, point, samples.normal, posture.tilt_direction, posture.tilt, self.whole,
                                           self.outline, self.floor if floor is None else floor, tree, stick_out, triangle),
            rows, self.conditions.jobs,
        )  # fmt: skip
        return np.minimum(stick_out, self.cutter.length), triangle

    def all(self, rows: NDArray[np.int64]) -> tuple[float, int]:
        """The least stick-out that serves all of some samples, and the one that limits it, -1 for the floor."""
        least, limiting, done = self.floor, -1, 0
        for company in (evenly(rows, _FIRST), rows):
            company = company[self.sure[company] > least]
            pieces = [company[i : i + CHUNK] for i in range(0, len(company), CHUNK)]
            at = np.zeros(len(pieces), np.int64)
            while len(open_rows := np.flatnonzero(at < [len(piece) for piece in pieces])):
                not_reached = self._round(pieces, at, open_rows, least)
                for row in not_reached:
                    # What an earlier one of this round asked for may be enough.
                    longer, result = self.one(row, least)
                    if result >= 0:
                        least, limiting = longer, result
                done = int(at.sum())
                self.progress(min(done, len(rows) - 1), len(rows))
        return least, limiting

    def _round(
        self, pieces: list[NDArray[np.int64]], at: NDArray[np.int64], open_rows: NDArray[np.int64], stick_out: float
    ) -> list[int]:
        """Search each piece that is left up to the first sample that is not reached; move `at` on, and return those samples."""
        from plan_cutters.kernels.search.search import until_not_reached

        tool, ranges, solids = self.tool(stick_out), self.conditions.ranges, self.conditions.obstacles.solids
        verdicts = blank(len(self.ready.samples))
        not_reached: dict[int, int] = {}

        def work(which: NDArray[np.int64]) -> None:
            for k in which.tolist():
                piece = pieces[k]
                at[k] = until_not_reached(piece, int(at[k]), self.contacts, ranges, tool, solids, verdict_arrays_of(verdicts))
                row = int(piece[at[k] - 1])
                if verdicts.verdict[row] != ACCESSIBLE:
                    not_reached[k] = row

        in_chunks(work, open_rows, self.conditions.jobs, chunk=1)
        self._take(np.flatnonzero(verdicts.verdict == ACCESSIBLE), verdicts)
        return [not_reached[k] for k in sorted(not_reached)]

    def lowered(self, rows: NDArray[np.int64], least: float, limiting: int) -> tuple[float, float, int]:
        """The same, or less where a judgement some steps of `BEYOND` below it still finds postures everywhere, as it starts
        elsewhere: so many steps, by doubling and halving, that one more is too many.

        Returns it, the stick-out a step shorter that was too short, and the sample that was not reached with that; the floor
        twice and -1 where nothing is too short.
        """
        good, bad, before = 0, 0, limiting

        def after(steps: int) -> float:
            return max(self.floor, least - steps * BEYOND)

        while limiting >= 0 and after(good) > self.floor and bad - good != 1:
            tried = (good + bad) // 2 if bad else 2 * good + 1
            # It is looked for first at the sample that limits.
            reached = judge(self.ready, held(self.cutter, after(tried)), np.array([limiting])).reached[0]
            missed = self.missed(rows, after(tried)) if reached else np.array([limiting])
            if len(missed):
                bad, limiting = tried, int(missed[0])
            else:
                good = tried
        lowest = after(good)
        if limiting < 0 or lowest <= self.floor:
            return lowest, lowest, -1
        if good or limiting != before:
            posture = judge(self.ready, held(self.cutter, lowest), np.array([limiting]))
            if posture.reached[0]:
                self.found.take_posture(limiting, posture, 0)
        return lowest, after(bad), limiting

    def one(self, row: int, not_reached: float) -> tuple[float, int]:
        """The least stick-out of one sample, and the sample; the one given and -1 where that is enough.

        Halving between one at which it is not reached and one at which it has a posture, which then comes down as far as it lets.
        """
        if self._posture(row, not_reached):
            return not_reached, -1
        rows = np.array([row])
        best = min(self.cutter.length, float(self.needed(rows, self.found)[0][row]))
        while best - not_reached > EXACT:
            middle = 0.5 * (best + not_reached)
            if self._posture(row, middle):
                best = min(middle, float(self.needed(rows, self.found)[0][row]))
            else:
                not_reached = middle
        return max(best, not_reached), row

    def _posture(self, row: int, stick_out: float) -> bool:
        """Whether a sample has a posture with a stick-out; it is kept."""
        from plan_cutters.kernels.search.search import posture

        one, samples, ranges = slice(row, row + 1), self.ready.samples, self.conditions.ranges
        contact = Contacts(samples.point[one], samples.normal[one], samples.direction_max[one], samples.curvature[one])
        best, start = blank(1), (max(0, int(self.found.rotation[row])), float(self.found.tilt[row]))
        turns, solids = len(ranges.rotation_cos), self.conditions.obstacles.solids
        tool = self.tool(stick_out)
        free, looked = posture(contact, ranges, tool, _NARROWEST, start, turns, solids, verdict_arrays_of(best))
        METER.add(looked)
        if not free:
            return False
        self.found.take_posture(row, best, 0)
        return True
