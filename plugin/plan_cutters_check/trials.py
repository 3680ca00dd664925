"""Check a plan by putting tools down: at each sample as its operation cuts it, and with the postures of verdicts."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from plan_cutters_check.bench import Bench, Contacts
from plan_cutters_check.findings import Finding, Tally
from plan_cutters_check.paper import contacts_at
from plan_cutters_check.question import Question, allowed, axes_of, degrees_of, held
from plan_cutters_check.reckoned import REACHED, Reckoned, Rows
from plan_cutters_check.surface import FREE, MET, Clock
from plan_cutters_check.tool import Tool

#: Postures of a cutter that are put down.
_POSTURES = 400
#: Parts of unit vectors that differ by less are one.
_SAME = 1e-6


def placed(
    reckoned: Reckoned, bench: Bench, clock: Clock, tell: Callable[[str], None], entry: dict[str, Any]
) -> Iterator[Finding]:
    """Put each operation down at each of its samples, as far off as the plan says: what holds of that is put into `entry`."""
    question, rng = reckoned.question, np.random.default_rng(0)
    for plan in reckoned.plans:
        tally, wrong_tilts, missed = Tally(), 0, 0
        for i, each in enumerate(plan.operations):
            tell(f"{plan.entry['name']}: putting {each['id']} down ({i + 1} of {len(plan.operations)})")
            # In a drawn order, so that what there was no time for is no part of the surface.
            rows, tool = rng.permutation(plan.rows(i)), bench.tools[each["cutter"]]
            axis, there = _axes(question, each, rows, plan["moving_axis"])
            at = contacts_at(question, plan, each, there, axis)
            wrong_tilts += _other_tilt_directions(bench, tool, there, axis, plan["lean"][there], at)
            missed += int(bench.misses(tool, there, axis, at).sum())
            clearance = each["clearance_mm"] or 0.0
            put = bench.put_down(each["setup"], tool, there, axis, at, clock, clearance)
            if each["mode"] != "fixed":
                put[0][~held(question.machine, question.setups[each["setup"]], axis)] = MET
            tally.open_ += len(rows) - len(there)
            tally.add(*put, each["id"])
            if clearance and len(tool.solids) > 1 and len(there) == len(rows) and (put[0] == FREE).all():
                entry["plans"][plan.number]["operations"][i]["clearance_mm"] = each["clearance_mm"]
        every, beyond = tally.tested + tally.open_, tally.beyond
        late = f" of {every} (taken by seed 0)" if tally.open_ > beyond else f" of {every}" if beyond else ""
        text = f" {wrong_tilts} have another tilt direction than their axis has." if wrong_tilts else ""
        text += f" {missed} do not lie on the flutes of their tool." if missed else ""
        text += f" At {beyond} more it is deeper than the {question.asked:g} mm that were wanted." if beyond else ""
        yield tally.finding(
            f"{plan}: its operations were put down at {tally.tested} samples{late}; at {tally.wrong} the tool is too deep in "
            f"something, nearer to it than the plan says, or cannot stand.{tally.some}{text}",
            every, holds=not wrong_tilts and not missed,
        )  # fmt: skip


def postures(reckoned: Reckoned, bench: Bench, clock: Clock) -> Iterator[Finding]:
    """Put each cutter down with the postures that its verdicts rest on, at some of its samples."""
    question, rng = reckoned.question, np.random.default_rng(0)
    samples = question.samples
    for name, verdict in reckoned.verdict.items():
        axis, tilt_direction = samples[f"axis_{name}"], samples[f"lean_{name}"]
        rows = rng.permutation(np.flatnonzero(reckoned.finished & np.isin(verdict, REACHED)))[:_POSTURES]
        setup, tally = samples.get(f"setup_{name}", np.zeros(len(verdict), np.int64)), Tally()
        for s in np.unique(setup[rows]).tolist():
            mine = rows[setup[rows] == s]
            if not 0 <= s < len(question.setups):
                tally.wrong += len(mine)
                continue
            at = Contacts(bench.point[mine] + question.shift(name)[mine], bench.normal[mine], tilt_direction[mine])
            put = bench.put_down(s, bench.tools[name], mine, axis[mine], at, clock)
            put[0][~held(question.machine, question.setups[s], axis[mine])] = MET
            tally.add(*put)
        if len(rows):
            yield tally.finding(
                f"{name}: {tally.tested} of the {int(np.isin(verdict, REACHED).sum())} postures of its verdicts (taken by "
                f"seed 0) were put down; {tally.wrong} are not safe.",
                len(rows),
            )


def _axes(question: Question, each: dict[str, Any], rows: Rows, moving: Floats) -> tuple[Floats, Rows]:
    """The axes of an operation at some of its samples, and which these are: all, unless an axis is not written."""
    name = each["cutter"]
    if each["mode"] == "fixed":
        degrees, setup = degrees_of(question, each), question.setups[each["setup"]]
        if not allowed(question.machine, setup, degrees).all():
            raise ValueError(f"the angles of {each['id']} are beyond the machine's limits")
        return np.repeat(axes_of(question.machine, setup, degrees), len(rows), axis=0), rows
    served = question.samples.get(f"setup_{name}")
    there = rows if served is None else rows[served[rows] == each["setup"]]
    return np.where(np.isfinite(moving[there]), moving[there], question.samples[f"axis_{name}"][there]), there


def _other_tilt_directions(bench: Bench, tool: Tool, rows: Rows, axis: Floats, tilt_direction: Floats, at: Contacts) -> int:
    """How many written leans are not those of their axes; where an axis is the normal any across it is one, and a shorter one
    if the tool has a flat tip; along a wall twice the axis is, or that of the flutes at the contact that is written.
    """
    normal, accuracy = bench.normal[rows], bench.accuracy
    passes = (at.normal != normal).any(axis=1)
    own = np.where(passes[:, None], at.tilt_direction, bench.own_tilt_direction(rows, axis))
    tilt = np.linalg.norm(np.cross(normal, axis), axis=1)
    same = np.abs(own - tilt_direction).max(axis=1, initial=0.0) <= _SAME
    size = np.linalg.norm(tilt_direction, axis=1)
    across = (np.abs((tilt_direction * axis).sum(axis=1)) <= 1e-3) & (size <= 1.0 + _SAME)
    across &= (np.abs(size - 1.0) <= _SAME) | ((size > 0.0) & (tool.flat > 0.0))
    walls = tool.stands_along(normal, axis, tilt_direction, accuracy)
    return int((~(same | ((tilt <= np.sin(accuracy)) & across) | walls)).sum())
