"""Check a plan by putting tools down: labels, motion, weights, the chosen candidates, clearances, and postures of verdicts."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.bench import Bench, Contacts
from plan_cutters_check.findings import Between, Finding, Tally
from plan_cutters_check.paper import contacts_at
from plan_cutters_check.question import allowed, axes_of, degrees_of, held
from plan_cutters_check.reckoned import REACHED, Planned, Reckoned, Rows
from plan_cutters_check.surface import FREE, MET, OPEN, Clock
from plan_cutters_check.tool import Tool

_UNIT = 1_000_000
#: Pairs of a sample and an axis that are looked at between two looks at the clock; postures of a cutter that are put down.
_AT_ONCE, _POSTURES = 2048, 400
#: How far clearances are reported below the true ones: as a share, and mm; `MOST`: that or more.
_CLEARANCE_SHARE, _CLEARANCE_STEP, _MOST = 0.05, 0.02, 100.0
#: The edges of flutes are grown as square ones: there clearances are reported by up to this share too low.
_EDGE = 0.45
#: Parts of unit vectors that differ by less are one.
_SAME = 1e-6


@dataclass(frozen=True, eq=False)
class Trials:
    """The checks with tools: `rng` draws the order of pairs, `clock` gives that of a check, `tell` is told what is being done."""

    reckoned: Reckoned
    bench: Bench
    rng: np.random.Generator
    clock: Callable[[str], Clock]
    tell: Callable[[str], None]

    def findings(self, entry: dict[str, Any]) -> Iterator[Finding]:
        """All of them; what plan.json must say, as far as it follows from them, is put into `entry`."""
        if self.bench.unread:
            yield Finding(None, f"Nothing is known of what {', '.join(self.bench.unread)} are in the way of.")
        if self.bench.hollow:
            yield Finding(None, f"Whether a tool stands wholly within {', '.join(self.bench.hollow)} is not looked at.")
        yield from self.placed()
        yield from self.moving()
        if not self.reckoned.without_fewest:
            yield self.weights()
            yield from self.covered(entry)
        yield from self.alone()
        self.clearances(entry)
        yield from self.postures()

    def placed(self) -> Iterator[Finding]:
        """Each operation, put down at each of its samples."""
        clock, question = self.clock("placed"), self.reckoned.question
        for plan in self.reckoned.plans:
            tally, wrong_tilts = Tally(), 0
            for i, each in enumerate(plan.operations):
                self.tell(f"{plan.entry['name']}: putting {each['id']} down ({i + 1} of {len(plan.operations)})")
                # In a drawn order, so that what there was no time for is no part of the surface.
                rows, tool = self.rng.permutation(plan.rows(i)), self.bench.tools[each["cutter"]]
                axis, there = self._axes(each, rows, plan["moving_axis"])
                tally.open_ += len(rows) - len(there)
                at = contacts_at(question, plan, each, there, axis)
                wrong_tilts += self._other_tilt_directions(tool, there, axis, plan["lean"][there], at)
                tally.add(*self.bench.put_down(each["setup"], tool, there, axis, at, clock), each["id"])
            text = f" {wrong_tilts} have another tilt direction than their axis has." if wrong_tilts else ""
            every, beyond = tally.tested + tally.open_, tally.beyond
            late = f" of {every} (taken by seed 0)" if tally.open_ > beyond else f" of {every}" if beyond else ""
            more = f" At {beyond} more it is deeper than the {question.asked:g} mm that were wanted." if beyond else ""
            yield tally.finding(
                f"{plan}: its operations were put down at {tally.tested} samples{late}; at {tally.wrong} the "
                f"tool is too deep in something, or cannot stand.{text}{tally.some}{more}",
                every, holds=not wrong_tilts,
            )  # fmt: skip

    def moving(self) -> Iterator[Finding]:
        """Each simultaneous operation, put down at the samples of its proved pieces with the axes that are proposed there."""
        # With draws of its own, as those of postures: those of the other checks stay as they are.
        clock, rng = self.clock("placed"), np.random.default_rng(0)
        for plan in self.reckoned.plans:
            tally = Tally()
            for i, each in enumerate(plan.operations):
                rows = rng.permutation(np.flatnonzero((plan.label == i) & (plan["moving_piece"] >= 0)))
                if len(rows):
                    axis = plan["moving_axis"][rows]
                    at = Contacts(self.bench.point[rows], self.bench.normal[rows], self.bench.own_tilt_direction(rows, axis))
                    put = self.bench.put_down(each["setup"], self.bench.tools[each["cutter"]], rows, axis, at, clock)
                    tally.add(*put, each["id"])
            every = tally.tested + tally.open_
            late = f" of {every} (taken by seed 0)" if tally.open_ else ""
            if every:
                yield tally.finding(
                    f"{plan}: tools were put down with the axes for simultaneous motion at {tally.tested} "
                    f"samples{late}; at {tally.wrong} the tool is too deep in something, or cannot stand. Between samples the "
                    f"plan alone proves them.{tally.some}",
                    every,
                )

    def postures(self) -> Iterator[Finding]:
        """Each cutter, put down with the postures that its verdicts rest on, at some of its samples."""
        question, clock, rng = self.reckoned.question, self.clock("verdicts"), np.random.default_rng(0)
        samples = question.samples
        for name, verdict in self.reckoned.verdict.items():
            axis, tilt_direction = samples[f"axis_{name}"], samples[f"lean_{name}"]
            rows = rng.permutation(np.flatnonzero(self.reckoned.finished & np.isin(verdict, REACHED)))[:_POSTURES]
            setup, tally = samples.get(f"setup_{name}", np.zeros(len(verdict), np.int64)), Tally()
            for s in np.unique(setup[rows]).tolist():
                mine = rows[setup[rows] == s]
                if not 0 <= s < len(question.setups):
                    tally.wrong += len(mine)
                    continue
                point = self.bench.point[mine] + question.shift(name)[mine]
                at = Contacts(point, self.bench.normal[mine], tilt_direction[mine])
                put = self.bench.put_down(s, self.bench.tools[name], mine, axis[mine], at, clock)
                put[0][~held(question.machine, question.setups[s], axis[mine])] = MET
                tally.add(*put)
            if len(rows):
                yield tally.finding(
                    f"{name}: {tally.tested} of the {int(np.isin(verdict, REACHED).sum())} postures of its verdicts (taken by "
                    f"seed 0) were put down; {tally.wrong} are not safe.",
                    len(rows),
                )

    def _axes(self, each: dict[str, Any], rows: Rows, moving: Floats | None = None) -> tuple[Floats, Rows]:
        """The axes of an operation at some of its samples, and which these are: all, unless an axis is not written."""
        question, name = self.reckoned.question, each["cutter"]
        if each["mode"] == "fixed":
            degrees, setup = degrees_of(question, each), question.setups[each["setup"]]
            if not allowed(question.machine, setup, degrees).all():
                raise ValueError(f"the angles of {each['id']} are beyond the machine's limits")
            return np.repeat(axes_of(question.machine, setup, degrees), len(rows), axis=0), rows
        served = question.samples.get(f"setup_{name}")
        there = rows if served is None else rows[served[rows] == each["setup"]]
        own = question.samples[f"axis_{name}"][there]
        return own if moving is None else np.where(np.isfinite(moving[there]), moving[there], own), there

    def _other_tilt_directions(self, tool: Tool, rows: Rows, axis: Floats, tilt_direction: Floats, at: Contacts) -> int:
        """How many written leans are not those of their axes; where an axis is the normal any across it is one, and a shorter one
        if the tool has a flat tip; along a wall twice the axis is, or that of the flutes at the contact that is written.
        """
        normal, accuracy = self.bench.normal[rows], self.bench.accuracy
        passes = (at.normal != normal).any(axis=1)
        own = np.where(passes[:, None], at.tilt_direction, self.bench.own_tilt_direction(rows, axis))
        tilt = np.linalg.norm(np.cross(normal, axis), axis=1)
        same = np.abs(own - tilt_direction).max(axis=1, initial=0.0) <= _SAME
        size = np.linalg.norm(tilt_direction, axis=1)
        across = (np.abs((tilt_direction * axis).sum(axis=1)) <= 1e-3) & (size <= 1.0 + _SAME)
        across &= (np.abs(size - 1.0) <= _SAME) | ((size > 0.0) & (tool.flat > 0.0))
        walls = tool.stands_along(normal, axis, tilt_direction, accuracy)
        return int((~(same | ((tilt <= np.sin(accuracy)) & across) | walls)).sum())

    def weights(self) -> Finding:
        """No candidate serves samples whose weights sum up to more than a million."""
        few, arrays = self.reckoned.question.document["operations"]["fewest"], self.reckoned.question.operations
        if not few["weights"]:
            return Finding(True, "There are no weights.")
        rows, weight = (np.array(column, np.int64) for column in zip(*few["weights"], strict=True))
        cutter, setup, axis = (arrays[f"candidate_{name}"] for name in ("cutter", "setup", "axis"))
        clock, order = self.clock("weights"), self.rng.permutation(len(cutter))
        size, done, most = max(1, _AT_ONCE // len(rows)), 0, 0
        for start in range(0, len(order), size):
            if clock.over:
                break
            some, late = order[start : start + size], False
            carried = np.zeros(len(some), np.int64)
            for c, s in sorted({*zip(cutter[some].tolist(), setup[some].tolist(), strict=True)}):
                mine = np.flatnonzero((cutter[some] == c) & (setup[some] == s))
                pairs, which = np.tile(rows, len(mine)), np.repeat(mine, len(rows))
                tool = self.bench.tools[self.reckoned.ids[c]]
                serves = self.bench.serves(s, tool, pairs, axis[some[which]], clock, surely=False)
                late |= bool((serves == OPEN).any()) and clock.over
                np.add.at(carried, which[serves == FREE], np.tile(weight, len(mine))[serves == FREE])
            if late:
                break
            done, most = done + len(some), max(most, int(carried.max()))
            self.tell(f"weights: {done} of {len(order)} candidates")
        total = int(weight.sum())
        part = "" if done == len(order) else f" (checked {done} of {len(order)}, taken by seed 0)"
        proof = "" if few["proof"] == "weights" else f" ({few['proof']}, which is not checked)"
        words = (
            f"The weights of {len(rows)} samples sum up to {total / _UNIT:.6f}; no candidate{part} carries more than "
            f"{most / _UNIT:.6f}: at least {-(-total // _UNIT)} orientations are needed, the plan says {few['at_least']}"
            f"{proof}."
        )
        return Finding(None if done == 0 else most <= _UNIT, words)

    def covered(self, entry: dict[str, Any]) -> Iterator[Finding]:
        """The chosen candidates serve all samples that are reached, but for those that none does."""
        few, arrays = self.reckoned.question.document["operations"]["fewest"], self.reckoned.question.operations
        chosen, many = arrays["chosen"], len(arrays["candidate_cutter"])
        if len({*chosen.tolist()}) != len(chosen) or not all(0 <= c < many for c in chosen.tolist()):
            yield Finding(False, "The chosen candidates are none, or are chosen twice.")
            return
        fewest = next((plan.operations for plan in self.reckoned.plans if plan.entry["name"] == "fewest"), None)
        used = [each for each in fewest or () if each["mode"] == "fixed"]
        # Other cutters may join where the part stands anyway.
        stands = {(each["setup"], *each["axis"]) for each in used}
        if len(stands) > few["found"]:
            yield Finding(False, f"The fewest orientations are {few['found']} by the plan, and there are {len(stands)}.")
        if fewest is not None and len(used) == len(fewest) and len(used) < few["at_least"]:
            words = f"At least {few['at_least']} orientations are needed by the plan, and it finishes all with {len(used)}."
            yield Finding(False, words)
        clock, rows = self.clock("covered"), np.flatnonzero(self.reckoned.reached)
        self.tell(f"the {len(chosen)} chosen candidates at all samples")
        verdict = self._chosen(chosen, rows, clock, surely=True)
        served, doubt = (verdict == FREE).any(axis=0), (verdict == OPEN).any(axis=0)
        not_served, open_ = int((~served & ~doubt).sum()), int((~served & doubt).sum())
        if not open_:
            # A search may take samples for not served that are by a hair.
            strictly = verdict if few["alone"] == not_served else self._chosen(chosen, rows, clock, surely=False)
            entry["fewest"]["alone"] = Between(not_served, int((strictly != FREE).all(axis=0).sum()))
        late = f"; {open_} were not looked at" if open_ else ""
        words = (
            f"The {len(chosen)} chosen candidates serve {int(served.sum())} of the {len(rows)} samples that are reached"
            f"{late}; {not_served} are left, and the plan says that {few['alone']} need simultaneous motion."
        )
        yield Finding(not_served <= few["alone"], words)

    def _chosen(self, chosen: Rows, rows: Rows, clock: Clock, *, surely: bool) -> NDArray[np.int8]:
        """How each chosen candidate stands at samples: (chosen, m)."""
        arrays, verdict = self.reckoned.question.operations, np.full((len(chosen), len(rows)), MET, np.int8)
        for k, c in enumerate(chosen.tolist()):
            tool = self.bench.tools[self.reckoned.ids[int(arrays["candidate_cutter"][c])]]
            axis = np.repeat(arrays["candidate_axis"][c][None], len(rows), axis=0)
            verdict[k] = self.bench.serves(int(arrays["candidate_setup"][c]), tool, rows, axis, clock, surely=surely)
        return verdict

    def alone(self) -> Iterator[Finding]:
        """Samples that an operation alone serves: no other one of the plan stands free there; at others some other one does."""
        clock = self.clock("alone")
        for plan in self.reckoned.plans:
            rows = self.rng.permutation(np.flatnonzero(plan.label >= 0))
            fixed = [i for i, each in enumerate(plan.operations) if each["mode"] == "fixed"]
            moving = ~np.isin(plan.label, fixed)
            self.tell(f"{plan.entry['name']}: what each operation alone serves")
            wrong, done, size = 0, 0, _AT_ONCE // max(1, len(fixed))
            for start in range(0, len(rows), size):
                some = rows[start : start + size]
                # What a fixed operation serves alone, another one surely does not; what it does not, another one may.
                surely, perhaps = (self._others(plan, fixed, some, proved, clock) for proved in (False, True))
                if clock.over:
                    break
                bad = np.where(plan["exclusive"][some], surely, ~perhaps & ~moving[some])
                wrong, done = wrong + int(bad.sum()), done + len(some)
            part = "" if done == len(rows) else f" of {len(rows)} (taken by seed 0)"
            yield Finding(
                None if len(rows) and not done else wrong == 0,
                f"{plan}: {done} samples{part} go with the only operation that serves them, or with "
                f"one of several, as operations.npz says; {wrong} do not.",
            )

    def _others(self, plan: Planned, fixed: list[int], rows: Rows, surely: bool, clock: Clock) -> NDArray[np.bool_]:
        """At which samples (m,) another fixed operation than theirs stands free; `surely` as for `Bench.stands`."""
        served = np.zeros(len(rows), bool)
        for i in fixed:
            each = plan.operations[i]
            mine = np.flatnonzero((plan.label[rows] != i) & ~served)
            axis, there = self._axes(each, rows[mine])
            # Along a wall a tool may stand free, and yet have no pass there: then it is no operation that serves.
            tool = self.bench.tools[each["cutter"]]
            verdict = self.bench.serves(each["setup"], tool, there, axis, clock, surely=surely, along=surely)
            # What could not be settled may stand free.
            served[mine[(verdict == FREE) | ((verdict == OPEN) & surely)]] = True
        return served

    def clearances(self, entry: dict[str, Any]) -> None:
        """Put into the entry between what the least clearance of each operation must lie."""
        clock, question = self.clock("clearance"), self.reckoned.question
        doubtful = bool(question.document["missing"]) or bool(self.bench.unread)
        for plan in self.reckoned.plans:
            for i, each in enumerate(plan.operations):
                claimed, tool = each["clearance_mm"], self.bench.tools[each["cutter"]]
                into = entry["plans"][plan.number]["operations"][i]
                self.tell(f"{plan.entry['name']}: the clearance of {each['id']}")
                rows = plan.rows(i)
                axis, there = self._axes(each, rows, plan["moving_axis"])
                if not tool.idle():
                    into["clearance_mm"] = None
                    continue
                if len(there) < len(rows) or clock.over or (claimed is None and doubtful):
                    continue
                beyond = (claimed or 0.0) * (1.0 + _EDGE) + _CLEARANCE_STEP + question.tolerance
                at = contacts_at(question, plan, each, there, axis)
                clearance = self.bench.clearance(each["setup"], tool, axis, at, beyond, clock)
                if clearance is None:
                    continue
                true, part = clearance
                share = _EDGE if part == "flutes" else _CLEARANCE_SHARE
                # Triangles lie within their chord error of the surface, and are thickened by it: both within the tolerance.
                least = (true - _CLEARANCE_STEP - 2.0 * question.tolerance) / (1.0 + share) if part else true
                low, high = (max(0.0, min(_MOST, x)) for x in (least, true))
                into["clearance_mm"] = Between(low, high, 2.0 * self.bench.grain)
