"""Axes that a plan proposes for simultaneous motion: is their form right, does the machine hold them, do tools stand free?"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.bench import Bench
from plan_cutters_check.clash import Clock
from plan_cutters_check.findings import Finding, Tally
from plan_cutters_check.question import Question, held
from plan_cutters_check.reckoned import Reckoned

#: Lengths of unit vectors that differ from 1 by less.
_SAME = 1e-6


def ill_formed(question: Question, reckoned: Reckoned) -> Iterator[Finding]:
    """Axes and pieces that no operation has, that are no unit vectors, that are missing, or that the machine does not hold."""
    for k, plan in enumerate(question.document["operations"]["plans"]):
        label, axis, piece = (reckoned.array(k, name) for name in ("operation", "moving_axis", "moving_piece"))
        turning = [i for i, each in enumerate(plan["operations"]) if each["turning"] is not None]
        if any(plan["operations"][i]["mode"] == "fixed" for i in turning):
            yield Finding(False, f"The {plan['name']} plan: the axis of a fixed operation turns.")
        moving = [i for i, each in enumerate(plan["operations"]) if each["mode"] != "fixed"]
        mine, known, proved = np.isin(label, moving), ~np.isnan(axis).all(axis=1), piece >= 0
        if turning or known.any() or proved.any() or (piece < -1).any():
            wrong = (known & (~mine | ~_unit(axis))) | (proved & ~(known & np.isin(label, turning))) | (piece < -1)
            for i in turning:
                each, rows = plan["operations"][i], np.flatnonzero((label == i) & proved)
                # A piece is named where it has most of the area about a sample: of those that are counted some may have none.
                if len(rows) and not each["turning"]["pieces_mm2"]:
                    wrong[rows] = True
                wrong[rows[~held(question.machine, question.setups[each["setup"]], axis[rows])]] = True
            yield Finding(
                not wrong.any(),
                f"The {plan['name']} plan: axes for simultaneous motion at {int(known.sum())} samples, {int(proved.sum())} of "
                f"them in proved pieces; {int(wrong.sum())} are no axes, of no such operation, or beyond the machine's limits.",
            )


def put_down(question: Question, reckoned: Reckoned, bench: Bench, rng: np.random.Generator, clock: Clock) -> Iterator[Finding]:
    """Each simultaneous operation, put down at the samples of its proved pieces with the axes that are proposed there."""
    for k, plan in enumerate(question.document["operations"]["plans"]):
        tally, label, piece = Tally(), reckoned.array(k, "operation"), reckoned.array(k, "moving_piece")
        for i, each in enumerate(plan["operations"]):
            # In a drawn order, so that what there is no time for is no part of the surface.
            rows = rng.permutation(np.flatnonzero((label == i) & (piece >= 0)))
            axis = reckoned.array(k, "moving_axis")[rows]
            if len(rows):
                where = each["setup"], bench.tools[each["cutter"]], rows, axis, bench.own_tilt_direction(rows, axis)
                tally.add(*bench.put_down(*where, clock), each["id"])
        every = tally.tested + tally.open_
        late = f" of {every} (taken by seed 0)" if tally.open_ else ""
        if every:
            yield tally.finding(
                f"The {plan['name']} plan: tools were put down with the axes for simultaneous motion at {tally.tested} "
                f"samples{late}; at {tally.wrong} the tool is too deep in something, or cannot stand. Between samples the plan "
                f"alone proves them.{tally.some}",
                every,
            )


def _unit(axis: Floats) -> NDArray[np.bool_]:
    return np.asarray(np.abs(np.linalg.norm(axis, axis=1) - 1.0) <= _SAME)
