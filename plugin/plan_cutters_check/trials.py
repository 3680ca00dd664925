"""Check a plan by putting tools down: labels, weights, the chosen candidates, and clearances."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.bench import Bench
from plan_cutters_check.clash import FREE, MET, OPEN, Clock
from plan_cutters_check.findings import Finding, Tally
from plan_cutters_check.leaves import Between
from plan_cutters_check.moving import put_down
from plan_cutters_check.question import Question, allowed, axes_of, degrees_of
from plan_cutters_check.reckoned import Reckoned, Rows
from plan_cutters_check.strategies import Contacts, contacts_at
from plan_cutters_check.tool import Tool

_UNIT = 1_000_000
#: Pairs of a sample and an axis that are looked at between two looks at the clock.
_AT_ONCE = 2048
#: How far clearances are reported below the true ones: as a share, and mm; `MOST`: that or more.
_CLEARANCE_SHARE, _CLEARANCE_STEP, _MOST = 0.05, 0.02, 100.0
#: The edges of flutes are grown as square ones: there clearances are reported by up to this share too low.
_EDGE = 0.45
#: Parts of unit vectors that differ by less are one.
_SAME = 1e-6


class Trials:
    """The checks with tools.

    Parameters
    ----------
    question : Question
    reckoned : Reckoned
    bench : Bench
    rng : Generator
        Of the order in which pairs are looked at.
    clock : callable
        The clock of a check by its name.
    tell : callable
        Called with what is being done.
    """

    def __init__(
        self,
        question: Question,
        reckoned: Reckoned,
        bench: Bench,
        rng: np.random.Generator,
        clock: Callable[[str], Clock],
        tell: Callable[[str], None],
    ) -> None:
        self.question, self.reckoned, self.bench, self.rng = question, reckoned, bench, rng
        self.clock, self.tell = clock, tell
        self.plans: list[dict[str, Any]] = question.document["operations"]["plans"]

    def findings(self, entry: dict[str, Any]) -> Iterator[Finding]:
        """All of them; what plan.json must say, as far as it follows from them, is put into `entry`."""
        question = self.question
        if self.bench.unread:
            yield Finding(None, f"Nothing is known of what {', '.join(self.bench.unread)} are in the way of.")
        if self.bench.hollow:
            yield Finding(None, f"Whether a tool stands wholly within {', '.join(self.bench.hollow)} is not looked at.")
        yield from self.placed()
        yield from put_down(question, self.reckoned, self.bench, np.random.default_rng(0), self.clock("placed"))
        if not self.reckoned.without_fewest:
            yield self.weights()
            yield from self.covered(entry)
        yield from self.alone()
        self.clearances(entry)

    def placed(self) -> Iterator[Finding]:
        """Each operation, put down at each of its samples."""
        clock = self.clock("placed")
        for k, plan in enumerate(self.plans):
            label, tilt_direction = self.reckoned.array(k, "operation"), self.reckoned.array(k, "lean")
            tally, wrong_tilts = Tally(), 0
            for i, each in enumerate(plan["operations"]):
                self.tell(f"{plan['name']}: putting {each['id']} down ({i + 1} of {len(plan['operations'])})")
                # In a drawn order, so that what there was no time for is no part of the surface.
                rows = self.rng.permutation(np.flatnonzero(label == i))
                setup, tool = each["setup"], self.bench.tools[each["cutter"]]
                axis, there = self._axes(each, rows, self.reckoned.array(k, "moving_axis"))
                tally.open_ += len(rows) - len(there)
                at = contacts_at(self.question, self.reckoned, k, each, there, axis)
                wrong_tilts += self._other_tilt_directions(tool, there, axis, tilt_direction[there], at)
                contact = at.point, at.normal
                tally.add(*self.bench.put_down(setup, tool, there, axis, at.tilt_direction, clock, contact), each["id"])
            text = f" {wrong_tilts} have another tilt direction than their axis has." if wrong_tilts else ""
            every, beyond = tally.tested + tally.open_, tally.beyond
            late = f" of {every} (taken by seed 0)" if tally.open_ > beyond else f" of {every}" if beyond else ""
            more = f" At {beyond} more it is deeper than the {self.question.asked:g} mm that were wanted." if beyond else ""
            yield tally.finding(
                f"The {plan['name']} plan: its operations were put down at {tally.tested} samples{late}; at {tally.wrong} the "
                f"tool is too deep in something, or cannot stand.{text}{tally.some}{more}",
                every, holds=not wrong_tilts,
            )  # fmt: skip

    def _axes(self, each: dict[str, Any], rows: Rows, moving: Floats | None = None) -> tuple[Floats, Rows]:
        """The axes of an operation at some of its samples, and which these are: all, unless an axis is not written."""
        if each["mode"] == "fixed":
            degrees, setup = degrees_of(self.question, each), self.question.setups[each["setup"]]
            if not allowed(self.question.machine, setup, degrees).all():
                raise ValueError(f"the angles of {each['id']} are beyond the machine's limits")
            return np.repeat(axes_of(self.question.machine, setup, degrees), len(rows), axis=0), rows
        samples, name = self.question.samples, each["cutter"]
        served = samples.get(f"setup_{name}")
        there = rows if served is None else rows[served[rows] == each["setup"]]
        own = samples[f"axis_{name}"][there]
        return own if moving is None else np.where(np.isfinite(moving[there]), moving[there], own), there

    def _other_tilt_directions(self, tool: Tool, rows: Rows, axis: Floats, tilt_direction: Floats, at: Contacts) -> int:
        """How many written leans are not those of their axes; where an axis is the normal any across it is one, and a shorter one
        if the tool has a flat tip; along a wall twice the axis is, or that of the flutes at the contact that is written.
        """
        passes = (at.normal != self.bench.normal[rows]).any(axis=1)
        own = np.where(passes[:, None], at.tilt_direction, self.bench.own_tilt_direction(rows, axis))
        accuracy = self.bench.accuracy
        tilt = np.linalg.norm(np.cross(self.bench.normal[rows], axis), axis=1)
        same = np.abs(own - tilt_direction).max(axis=1, initial=0.0) <= _SAME
        size = np.linalg.norm(tilt_direction, axis=1)
        across = (np.abs((tilt_direction * axis).sum(axis=1)) <= 1e-3) & (size <= 1.0 + _SAME)
        across &= (np.abs(size - 1.0) <= _SAME) | ((size > 0.0) & (tool.flat > 0.0))
        walls = tool.stands_along(self.bench.normal[rows], axis, tilt_direction, accuracy)
        return int((~(same | ((tilt <= np.sin(accuracy)) & across) | walls)).sum())

    def weights(self) -> Finding:
        """No candidate serves samples whose weights sum up to more than a million."""
        few, arrays = self.question.document["operations"]["fewest"], self.question.operations
        if not few["weights"]:
            return Finding(True, "There are no weights.")
        rows, weight = (np.array(column, np.int64) for column in zip(*few["weights"], strict=True))
        cutter, setup, axis = (arrays[f"candidate_{name}"] for name in ("cutter", "setup", "axis"))
        clock, order = self.clock("weights"), self.rng.permutation(len(cutter))
        size, done, most = max(1, _AT_ONCE // len(rows)), 0, 0
        for start in range(0, len(order), size):
            if clock.over:
                break
            some = order[start : start + size]
            carried = np.zeros(len(some), np.int64)
            late = False
            for c, s in sorted({*zip(cutter[some].tolist(), setup[some].tolist(), strict=True)}):
                mine = np.flatnonzero((cutter[some] == c) & (setup[some] == s))
                pairs, which = np.tile(rows, len(mine)), np.repeat(mine, len(rows))
                serves = self.bench.serves(s, self.bench.named(c), pairs, axis[some[which]], clock, surely=False)
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
        few, arrays = self.question.document["operations"]["fewest"], self.question.operations
        chosen, many = arrays["chosen"], len(arrays["candidate_cutter"])
        if len({*chosen.tolist()}) != len(chosen) or not all(0 <= c < many for c in chosen.tolist()):
            yield Finding(False, "The chosen candidates are none, or are chosen twice.")
            return
        fewest = next((plan for plan in self.plans if plan["name"] == "fewest"), None)
        used = [] if fewest is None else [each for each in fewest["operations"] if each["mode"] == "fixed"]
        # Other cutters may join where the part stands anyway.
        stands = {(each["setup"], *each["axis"]) for each in used}
        if len(stands) > few["found"]:
            yield Finding(False, f"The fewest orientations are {few['found']} by the plan, and there are {len(stands)}.")
        if fewest is not None and len(used) == len(fewest["operations"]) and len(used) < few["at_least"]:
            words = f"At least {few['at_least']} orientations are needed by the plan, and it finishes all with {len(used)}."
            yield Finding(False, words)
        clock, rows = self.clock("covered"), np.flatnonzero(self.reckoned.reached)
        self.tell(f"the {len(chosen)} chosen candidates at all samples")
        verdict = self._chosen(chosen, rows, clock, surely=True)
        table, doubt = verdict == FREE, (verdict == OPEN).any(axis=0)
        served = table.any(axis=0)
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
        arrays, verdict = self.question.operations, np.full((len(chosen), len(rows)), MET, np.int8)
        for k, c in enumerate(chosen.tolist()):
            tool, s = self.bench.named(int(arrays["candidate_cutter"][c])), int(arrays["candidate_setup"][c])
            axis = np.repeat(arrays["candidate_axis"][c][None], len(rows), axis=0)
            verdict[k] = self.bench.serves(s, tool, rows, axis, clock, surely=surely)
        return verdict

    def alone(self) -> Iterator[Finding]:
        """Samples that an operation alone serves: no other one of the plan stands free there; at others some other one does."""
        clock = self.clock("alone")
        for k, plan in enumerate(self.plans):
            label, alone = self.reckoned.array(k, "operation"), self.reckoned.array(k, "exclusive")
            rows = self.rng.permutation(np.flatnonzero(label >= 0))
            fixed = [i for i, each in enumerate(plan["operations"]) if each["mode"] == "fixed"]
            moving = ~np.isin(label, fixed)
            self.tell(f"{plan['name']}: what each operation alone serves")
            wrong, done = 0, 0
            for start in range(0, len(rows), _AT_ONCE // max(1, len(fixed))):
                some = rows[start : start + _AT_ONCE // max(1, len(fixed))]
                # What a fixed operation serves alone, another one surely does not; what it does not, another one may.
                surely, perhaps = (self._others(plan, fixed, label, some, proved, clock) for proved in (False, True))
                if clock.over:
                    break
                bad = np.where(alone[some], surely, ~perhaps & ~moving[some])
                wrong, done = wrong + int(bad.sum()), done + len(some)
            part = "" if done == len(rows) else f" of {len(rows)} (taken by seed 0)"
            yield Finding(
                None if len(rows) and not done else wrong == 0,
                f"The {plan['name']} plan: {done} samples{part} go with the only operation that serves them, or with "
                f"one of several, as operations.npz says; {wrong} do not.",
            )

    def _others(
        self, plan: dict[str, Any], fixed: list[int], label: NDArray[Any], rows: Rows, surely: bool, clock: Clock
    ) -> NDArray[np.bool_]:
        """At which samples (m,) another fixed operation than theirs stands free; `surely` as for `Bench.stands`."""
        served = np.zeros(len(rows), bool)
        for i in fixed:
            each = plan["operations"][i]
            mine = np.flatnonzero((label[rows] != i) & ~served)
            axis, there = self._axes(each, rows[mine])
            # Along a wall a tool may stand free, and yet have no pass there: then it is no operation that serves.
            place = each["setup"], self.bench.tools[each["cutter"]]
            verdict = self.bench.serves(*place, there, axis, clock, surely=surely, along=surely)
            # What could not be settled may stand free.
            served[mine[(verdict == FREE) | ((verdict == OPEN) & surely)]] = True
        return served

    def clearances(self, entry: dict[str, Any]) -> None:
        """Put into the entry between what the least clearance of each operation must lie."""
        clock = self.clock("clearance")
        for k, plan in enumerate(self.plans):
            label = self.reckoned.array(k, "operation")
            for i, each in enumerate(plan["operations"]):
                claimed, tool = each["clearance_mm"], self.bench.tools[each["cutter"]]
                self.tell(f"{plan['name']}: the clearance of {each['id']}")
                rows = np.flatnonzero(label == i)
                axis, there = self._axes(each, rows, self.reckoned.array(k, "moving_axis"))
                if not tool.above(2.0 * tool.radius):
                    entry["plans"][k]["operations"][i]["clearance_mm"] = None
                    continue
                doubtful = bool(self.question.document["missing"]) or bool(self.bench.unread)
                if len(there) < len(rows) or clock.over or (claimed is None and doubtful):
                    continue
                beyond = (claimed or 0.0) * (1.0 + _EDGE) + _CLEARANCE_STEP + self.question.tolerance
                at = contacts_at(self.question, self.reckoned, k, each, there, axis)
                contact = at.point, at.normal
                clearance = self.bench.clearance(each["setup"], tool, contact, axis, at.tilt_direction, beyond, clock)
                if clearance is None:
                    continue
                true, part = clearance
                share = _EDGE if part == "flutes" else _CLEARANCE_SHARE
                # Triangles lie within their chord error of the surface, and are thickened by it: both within the tolerance.
                least = (true - _CLEARANCE_STEP - 2.0 * self.question.tolerance) / (1.0 + share) if part else true
                entry["plans"][k]["operations"][i]["clearance_mm"] = Between(
                    max(0.0, min(_MOST, least)), max(0.0, min(_MOST, true)), 2.0 * self.bench.grain
                )
