"""Check a written plan of operations by means of its own: exact surfaces, an own tool, own kinematics, own sums.

Nothing here is shared with the search that made the plan. What is found is one line for each statement of the plan, whether it
holds, and how much of it was looked at; what no statement covers is listed as unchecked.
"""

import math
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.checker.bench import Bench
from plan_cutters.checker.clash import FREE, MET, OPEN, Clock
from plan_cutters.checker.expected import Reckoned
from plan_cutters.checker.leaves import UNCHECKED, Between, Compared, Loose, compared, pattern
from plan_cutters.checker.question import Question, allowed, axes_of
from plan_cutters.checker.reading import faults
from plan_cutters.errors import OptionError

Rows = NDArray[np.int64]
_UNIT = 1_000_000
#: Seconds that a check takes at most unless it is told, and the share of them by which each of its parts must be done.
SECONDS = 60.0
_PARTS = {"placed": 0.35, "weights": 0.65, "covered": 0.8, "alone": 0.9, "clearance": 1.0}
#: Pairs that are looked at between two looks at the clock.
_AT_ONCE = 2048
#: How far clearances are told below the true ones: as a share, and mm; `MOST`: that or more.
_CLEARANCE_SHARE, _CLEARANCE_STEP, _MOST = 0.05, 0.02, 100.0
#: The edges of flutes are grown as square ones: there clearances are told by up to this share too low.
_EDGE = 0.45
#: Share of an area that a search may count less than stands free.
_DOUBT = 0.02
#: Parts of unit vectors, and mm, that differ by less are one.
_SAME, _SAME_MM = 1e-6, 1e-5
#: Tool axes that are tried for a candidate near to them, and how near one must be, deg.
_TRIED, _FARTHEST = 400, 5.0


@dataclass(frozen=True, slots=True)
class Finding:
    """One statement of the plan, whether it holds, None: it could not be looked at, and in words how it was checked."""

    holds: bool | None
    words: str


@dataclass(frozen=True, slots=True)
class Answer:
    """All findings, and the entries of `operations` in plan.json that agree, that differ and that are unchecked."""

    findings: tuple[Finding, ...]
    entries: Compared

    @property
    def holds(self) -> bool:
        """Whether nothing of what was checked is wrong."""
        return all(each.holds is not False for each in self.findings)

    @property
    def lines(self) -> list[str]:
        """The answer in lines."""
        words = {True: "holds", False: "FAILS", None: "not checked"}
        lines = [f"{words[each.holds]}: {each.words}" for each in self.findings]
        count = Counter(UNCHECKED.get(pattern(each), "they are empty") for each in self.entries.unchecked)
        for why, number in count.items():
            names = dict.fromkeys(
                pattern(each)
                for each in self.entries.unchecked
                if UNCHECKED.get(pattern(each), "they are empty") == why
            )
            lines.append(f"not checked: {', '.join(names)} ({number}): {why}")
        return lines


def check(question: Question, *, seconds: float = SECONDS, tell: Callable[[str], None] = lambda doing: None) -> Answer:
    """Check the operations of a plan.

    Parameters
    ----------
    question : Question
    seconds : float
        What is not done after these is listed as not checked, with how much was; all samples of the labels are looked at in the
        order of a random draw with seed 0.
    tell : callable
        Told what is being done.

    Raises
    ------
    OptionError
        The plan has no operations.
    """
    if not isinstance(question.document.get("operations"), dict):
        raise OptionError("the plan has no operations: make it with --operations")
    wrong = [Finding(False, each) for each in faults(question)]
    if wrong:
        return Answer(tuple(wrong), Compared())
    try:
        return _Check(question, seconds, tell).answer()
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError) as error:
        line = f"The plan contradicts its own form ({type(error).__name__}: {' '.join(str(error).split())})."
        return Answer((Finding(False, line),), Compared())


class _Check:
    """The order of a check."""

    def __init__(self, question: Question, seconds: float, tell: Callable[[str], None]) -> None:
        self.question, self.tell, self.start, self.seconds = question, tell, time.monotonic(), seconds
        self.reckoned = Reckoned(question)
        self.plans: list[dict[str, Any]] = question.document["operations"]["plans"]
        self.rng = np.random.default_rng(0)

    def answer(self) -> Answer:
        """All of it."""
        found = [*self._files(), *self._samples(), *self._candidates()]
        entry = self.reckoned.entry()
        if (strange := self._labels()) is not None:
            found.append(strange)
        first = self._compared(found, entry)
        if not first.holds:
            last = Finding(None, "No tool was put down: what is written contradicts itself, or the part, already.")
            return Answer((*first.findings, last), first.entries)
        self.bench = Bench(self.question, self.tell)
        if self.bench.unread:
            found.append(Finding(None, f"Nothing is known of what {', '.join(self.bench.unread)} are in the way of."))
        found += self._placed()
        found.append(self._weights())
        found += self._covered(entry)
        found += self._alone()
        self._clearances(entry)
        return self._compared(found, entry)

    def _clock(self, part: str) -> Clock:
        return Clock(self.start + self.seconds * _PARTS[part])

    def _compared(self, found: list[Finding], entry: dict[str, Any]) -> Answer:
        entries, more = compared(entry, self.question.document["operations"]), [*found]
        for path in entries.unknown:
            more.append(Finding(False, f"operations.{path} is an entry that this checker does not know."))
        for line in entries.differ:
            more.append(Finding(False, f"operations.{line}."))
        if not entries.differ:
            more.append(Finding(True, f"{len(entries.agree)} numbers and words of the plan follow from its samples and labels, "
                                       f"{len(entries.unchecked)} are not checked."))  # fmt: skip
        return Answer(tuple(more), entries)

    def _files(self) -> Iterator[Finding]:
        """The arrays are those that plan.json names."""
        for name, (stated, there) in self.question.checksums.items():
            if stated != there:
                yield Finding(False, f"{name} is not the file that plan.json names: its SHA-256 is {there[:12]}..., not {stated[:12]}...")

    def _samples(self) -> Iterator[Finding]:
        """Samples lie on the exact surface, with its normal on the side of the tool, and stand for its area."""
        samples, part, rows = self.question.samples, self.question.part, np.flatnonzero(self.reckoned.finished)
        face, far, odd = samples["face"][rows], 0.0, 0
        if not len(rows) or not 1 <= face.min() <= face.max() <= len(part.faces):
            yield Finding(False, "The samples are of faces that the part does not have.")
            return
        area_off = ""
        for number in np.unique(face).tolist():
            mine = rows[face == number]
            u, v = samples["uv"][mine].T
            point, s_u, s_v = np.moveaxis(_first(part, number, u, v), 1, 0)
            far = max(far, float(np.abs(point - samples["point"][mine]).max()))
            normal = np.cross(s_u, s_v) * self.question.sign[number - 1]
            size = np.linalg.norm(normal, axis=1)
            # Where the parameters meet in a point the kernel has no normal.
            known = size > 1e-9 * size.max(initial=0.0)
            off = np.abs(normal[known] / size[known, None] - samples["normal"][mine][known]).max(axis=1) > _SAME
            trim = part.trim(number)
            inside = np.ones(len(mine), bool) if trim is None else _inside(trim, u, v)
            odd += int(off.sum() + (~inside).sum())
            stands, whole = float(self.reckoned.area[mine].sum()), part.faces[number - 1].area
            judged = (samples["face"] == number).sum() == len(mine)
            if stands > whole * 1.01 + 1e-6 or (judged and stands < whole * 0.99 - 1e-6):
                area_off = f" The samples of F{number} stand for {stands:.6g} mm2 of its {whole:.6g}."
        direction = samples["direction_max"][rows]
        odd += int((np.abs((direction * samples["normal"][rows]).sum(axis=1)) > _SAME).sum())
        holds = far <= _SAME_MM and not odd and not area_off
        yield Finding(holds, f"{len(rows)} samples lie on the kernel's surface, the farthest {far:.2g} mm away; {odd} have another "
                             f"normal than it or lie beyond its border.{area_off}")  # fmt: skip

    def _candidates(self) -> Iterator[Finding]:
        """Candidates have the axes of their angles, within the limits of the machine, and leave out no part of them."""
        question, arrays = self.question, self.question.operations
        cutter, setup, angle = (arrays[f"candidate_{name}"] for name in ("cutter", "setup", "angle"))
        ids = self.reckoned.ids
        if not len(cutter) and self.reckoned.reached.any():
            yield Finding(None, "There are no candidates.")
            return
        known = (
            (cutter >= 0)
            & (cutter < len(ids))
            & (setup >= 0)
            & (setup < len(question.setups))
            & np.isfinite(angle).all(axis=1)
        )
        if not known.all():
            yield Finding(
                False,
                f"{int((~known).sum())} candidates are of cutters or setups that there are not, or have no angles.",
            )
            return
        wrong = beyond = 0
        for s, each in enumerate(question.setups):
            mine = setup == s
            axis = axes_of(question.machine, each, angle[mine])
            wrong += int((~(np.abs(axis - arrays["candidate_axis"][mine]).max(axis=1, initial=0.0) <= _SAME)).sum())
            beyond += int((~allowed(question.machine, each, angle[mine])).sum())
        words = f"{len(cutter)} candidates: {wrong} have other axes than their angles give, {beyond} are beyond the machine's limits."
        yield Finding(not wrong and not beyond, words)
        if not wrong and not beyond:
            yield self._complete(cutter, setup, arrays["candidate_axis"])

    def _complete(self, cutter: NDArray[Any], setup: NDArray[Any], axis: Floats) -> Finding:
        """Whether candidates are wherever the machine can be set to and a sample faces: some axes are tried."""
        question, step = self.question, self.question.document["effective"]["index_step_deg"]
        near = max(_FARTHEST, step or 0.0)
        high = math.radians(min(question.document["effective"]["tilt_deg"][1], 180.0) - near)
        normal = question.samples["normal"][self.reckoned.reached]
        low_high = np.clip(np.degrees(question.machine.limits), -180.0, 180.0)
        worst, lost, tried = 0.0, 0, 0
        for s, each in enumerate(question.setups):
            angle = self.rng.uniform(low_high[:, 0], low_high[:, 1], (_TRIED, 2))
            wanted = axes_of(question.machine, each, angle[allowed(question.machine, each, angle)])
            if not len(wanted) or not len(normal):
                continue
            wanted = wanted[(wanted @ normal.T).max(axis=1) >= math.cos(max(0.0, high))]
            for name in self.reckoned.considered:
                mine = axis[(setup == s) & (cutter == self.reckoned.ids.index(name))]
                cosine = (wanted @ mine.T).max(axis=1, initial=-1.0) if len(mine) else np.full(len(wanted), -1.0)
                away = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
                lost, tried = lost + int((away > near).sum()), tried + len(away)
                worst = max(worst, float(away.max(initial=0.0)))
        return Finding(lost == 0, f"Of {tried} tool axes that face a sample, drawn by seed 0 for each setup and cutter, {lost} are "
                                  f"more than {near:g} deg from a candidate; the farthest is {worst:.3g} deg away.")  # fmt: skip

    def _labels(self) -> Finding | None:
        """Samples go with operations that there are, and only those that are finished."""
        n = len(self.reckoned.area)
        for k, plan in enumerate(self.plans):
            label, lean = self.reckoned.array(k, "operation"), self.reckoned.array(k, "lean")
            bad = (label < -1) | (label >= len(plan["operations"])) | ((label >= 0) & ~self.reckoned.finished)
            bad |= (label < 0) & self.reckoned.reached
            bad |= (label < 0) & (np.isfinite(lean).any(axis=1) | self.reckoned.array(k, "exclusive"))
            if bad.any():
                return Finding(False, f"The {plan['name']} plan: {int(bad.sum())} of {n} samples go with operations that there are "
                                      "not, or with none though they are reached.")  # fmt: skip
            if (wrong := self._times(k)) is not None:
                return wrong
        return None

    def _times(self, k: int) -> Finding | None:
        """Seconds of each sample are its area over the width of a pass and the feed."""
        plan, label = self.plans[k], self.reckoned.array(k, "operation")
        strip, seconds = self.reckoned.array(k, "strip_mm"), self.reckoned.array(k, "seconds")
        feeds, wanted = self.question.document["operations"]["assumed"]["feed_mm_min"], np.full(len(label), np.nan)
        widest = np.zeros(len(label))
        for i, each in enumerate(plan["operations"]):
            mine = label == i
            if feeds is not None:
                with np.errstate(divide="ignore", invalid="ignore"):
                    wanted[mine] = self.reckoned.area[mine] / (strip[mine] * feeds[each["cutter"]] / 60.0)
            stepover = self.question.document["operations"]["assumed"]["stepover"]
            widest[mine] = stepover * 2.0 * self.question.tools[each["cutter"]].radius
        own = label >= 0
        same = np.isclose(seconds[own], wanted[own], rtol=1e-9, atol=1e-12, equal_nan=True).all()
        same &= not np.isfinite(seconds[~own]).any() and not np.isfinite(strip[~own]).any()
        fits = (np.isnan(strip[own]) | ((strip[own] > 0.0) & (strip[own] <= widest[own] * (1 + 1e-9)))).all()
        if same and fits:
            return None
        return Finding(False, f"The {plan['name']} plan: seconds of samples in operations.npz are not their area over width and "
                              "feed, or widths are beyond the step-over.")  # fmt: skip

    def _placed(self) -> Iterator[Finding]:
        """Each operation, put down at each of its samples."""
        clock = self._clock("placed")
        for k, plan in enumerate(self.plans):
            label, lean, words = self.reckoned.array(k, "operation"), self.reckoned.array(k, "lean"), list[str]()
            tested, wrong, open_, leans = 0, 0, 0, 0
            for i, each in enumerate(plan["operations"]):
                self.tell(
                    f"{plan['name']}: putting {each['id']} down at its samples ({i + 1} of {len(plan['operations'])})"
                )
                # In a drawn order, so that what there was no time for is no part of the surface.
                rows = self.rng.permutation(np.flatnonzero(label == i))
                setup, tool = each["setup"], self.bench.tools[each["cutter"]]
                axis, there = self._axes(each, rows)
                open_ += len(rows) - len(there)
                leans += self._other_leans(there, axis, lean[there])
                found, more = self.bench.looked(setup, tool, there, axis, lean[there], clock)
                wrong, open_ = wrong + int((found == MET).sum()), open_ + int((found == OPEN).sum())
                tested += int((found != OPEN).sum())
                words += [f"{each['id']}, {one}" for one in more]
            said = f" {leans} have another lean than their axis has." if leans else ""
            said += f" {'; '.join(words[:3])}." if words else ""
            late = f" ({open_} more were not looked at; drawn by seed 0)" if open_ else ""
            yield Finding(wrong == 0 and leans == 0, f"The {plan['name']} plan: {tested} samples{late} were put down with their operations; "
                          f"at {wrong} the tool is too deep in something, or cannot stand.{said}")  # fmt: skip

    def _axes(self, each: dict[str, Any], rows: Rows) -> tuple[Floats, Rows]:
        """The axes of an operation at some of its samples, and which these are: all, unless an axis is not written."""
        if each["mode"] == "fixed":
            names = self.question.machine.names
            degrees = np.array([[float(each["angles_deg"][name]) for name in names]])
            setup = self.question.setups[each["setup"]]
            if not allowed(self.question.machine, setup, degrees).all():
                raise ValueError(f"the angles of {each['id']} are beyond the machine's limits")
            return np.repeat(axes_of(self.question.machine, setup, degrees), len(rows), axis=0), rows
        samples, name = self.question.samples, each["cutter"]
        served = samples.get(f"setup_{name}")
        there = rows if served is None else rows[served[rows] == each["setup"]]
        return samples[f"axis_{name}"][there], there

    def _other_leans(self, rows: Rows, axis: Floats, lean: Floats) -> int:
        """How many written leans are not those of their axes; where an axis is the normal any across it is one."""
        own = self.bench.own_lean(rows, axis)
        tilt = np.linalg.norm(np.cross(self.bench.normal[rows], axis), axis=1)
        same = np.abs(own - lean).max(axis=1, initial=0.0) <= _SAME
        across = (np.abs((lean * axis).sum(axis=1)) <= 1e-3) & (np.abs(np.linalg.norm(lean, axis=1) - 1.0) <= _SAME)
        return int((~(same | ((tilt <= 1e-4) & across))).sum())

    def _weights(self) -> Finding:
        """No candidate serves samples whose weights sum up to more than a million."""
        question, few, arrays = self.question, self.question.document["operations"]["fewest"], self.question.operations
        if not few["weights"]:
            return Finding(True, "There are no weights.")
        rows, weight = (np.array(column, np.int64) for column in zip(*few["weights"], strict=True))
        cutter, setup, axis = (arrays[f"candidate_{name}"] for name in ("cutter", "setup", "axis"))
        clock, order = self._clock("weights"), self.rng.permutation(len(cutter))
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
                found = self.bench.serves(s, self.bench.named(c), pairs, axis[some[which]], clock, surely=False)
                late |= bool((found == OPEN).any())
                np.add.at(carried, which[found == FREE], np.tile(weight, len(mine))[found == FREE])
            if late:
                break
            done, most = done + len(some), max(most, int(carried.max()))
            self.tell(f"weights: {done} of {len(order)} candidates")
        total = int(weight.sum())
        part = "" if done == len(order) else f" (checked {done} of {len(order)}, drawn by seed 0)"
        proof = "" if few["proof"] == "weights" else f" ({few['proof']}, which is not checked)"
        words = (f"The weights of {len(rows)} samples sum up to {total / _UNIT:.6f}; no candidate{part} carries more than "
                 f"{most / _UNIT:.6f}: at least {-(-total // _UNIT)} orientations are needed, the plan says {few['at_least']}"
                 f"{proof}.")  # fmt: skip
        return Finding(None if done == 0 else most <= _UNIT, words)

    def _covered(self, entry: dict[str, Any]) -> Iterator[Finding]:
        """The chosen candidates serve all samples that are reached, but for those that none does."""
        few, arrays, chosen = (
            self.question.document["operations"]["fewest"],
            self.question.operations,
            self.question.operations["chosen"],
        )
        if len({*chosen.tolist()}) != len(chosen) or not all(
            0 <= c < len(arrays["candidate_cutter"]) for c in chosen.tolist()
        ):
            yield Finding(False, "The chosen candidates are none, or are chosen twice.")
            return
        fewest = next((plan for plan in self.plans if plan["name"] == "fewest"), None)
        used = [] if fewest is None else [each for each in fewest["operations"] if each["mode"] == "fixed"]
        if len(used) > few["found"]:
            yield Finding(False, f"The fewest operations are {few['found']} by the plan, and there are {len(used)}.")
        if fewest is not None and len(used) == len(fewest["operations"]) and len(used) < few["at_least"]:
            yield Finding(
                False,
                f"At least {few['at_least']} orientations are needed by the plan, and it finishes all with {len(used)}.",
            )
        clock, rows = self._clock("covered"), np.flatnonzero(self.reckoned.reached)
        self.tell(f"the {len(chosen)} chosen candidates at all samples")
        verdict = self._chosen(chosen, rows, clock, surely=True)
        table, doubt = verdict == FREE, (verdict == OPEN).any(axis=0)
        served = table.any(axis=0)
        lost, open_ = int((~served & ~doubt).sum()), int((~served & doubt).sum())
        perhaps = lost if few["alone"] == lost else int(len(rows) - (self._chosen(chosen, rows, clock, surely=False) == FREE).any(axis=0).sum())
        if not open_:
            # A search may take samples for not served that are by a hair.
            entry["fewest"]["alone"] = Between(lost, max(lost, perhaps))
            self._steps(entry, table, self.reckoned.area[rows])
        late = f"; {open_} were not looked at" if open_ else ""
        words = (f"The {len(chosen)} chosen candidates serve {int(served.sum())} of the {len(rows)} samples that are reached{late}; "
                 f"{lost} are left, and the plan says that {few['alone']} need simultaneous motion.")  # fmt: skip
        yield Finding(lost <= few["alone"], words)

    def _chosen(self, chosen: Rows, rows: Rows, clock: Clock, *, surely: bool) -> NDArray[np.int8]:
        """How each chosen candidate stands at samples: (chosen, m)."""
        arrays, verdict = self.question.operations, np.full((len(chosen), len(rows)), MET, np.int8)
        for k, c in enumerate(chosen.tolist()):
            tool, s = self.bench.named(int(arrays["candidate_cutter"][c])), int(arrays["candidate_setup"][c])
            axis = np.repeat(arrays["candidate_axis"][c][None], len(rows), axis=0)
            verdict[k] = self.bench.serves(s, tool, rows, axis, clock, surely=surely)
        return verdict

    def _steps(self, entry: dict[str, Any], table: NDArray[np.bool_], area: Floats) -> None:
        """Raise what each step of the curve must reach at least: what the chosen candidates do, the largest gain first."""
        written, steps = self.question.document["operations"]["curve"], entry["curve"]
        left, have = area.copy(), 0.0
        whole = float(area[table.any(axis=0)].sum())
        if not len(steps) or len(written) != len(steps) or whole <= 0.0:
            return
        for step in steps:
            gain = table @ left
            have += float(gain.max())
            left = left * ~table[int(gain.argmax())]
            # A search may count a little less than stands free.
            least = written[-1]["share"] * have / whole * (1.0 - _DOUBT)
            step["share"] = Loose(max(step["share"].low, least), step["share"].high)

    def _alone(self) -> Iterator[Finding]:
        """Samples that an operation alone serves: no other one of the plan stands free there; at others some other one does."""
        clock = self._clock("alone")
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
                surely, perhaps, late = (
                    self._others(plan, fixed, label, some, proved, clock) for proved in (False, True, None)
                )
                if late.any():
                    break
                bad = np.where(alone[some], surely, ~perhaps & ~moving[some])
                wrong, done = wrong + int(bad.sum()), done + len(some)
            part = "" if done == len(rows) else f" of {len(rows)}, drawn by seed 0,"
            yield Finding(None if rows.size and not done else wrong == 0, f"The {plan['name']} plan: {done} samples{part} go with the only "
                          f"operation that serves them, or with one of several, as operations.npz says; {wrong} do not.")  # fmt: skip

    def _others(
        self, plan: dict[str, Any], fixed: list[int], label: NDArray[Any], rows: Rows, proved: bool | None, clock: Clock
    ) -> NDArray[np.bool_]:
        """At which samples (m,) another fixed operation than theirs stands free: surely, perhaps; None: where the time was over."""
        found = np.zeros(len(rows), bool)
        for i in fixed:
            each = plan["operations"][i]
            mine = np.flatnonzero((label[rows] != i) & ~(found if proved is not None else np.zeros(len(rows), bool)))
            if proved is None:
                found |= clock.over
                continue
            axis, there = self._axes(each, rows[mine])
            tool = self.bench.tools[each["cutter"]]
            verdict = self.bench.serves(each["setup"], tool, there, axis, clock, surely=proved)
            found[mine[verdict == FREE]] = True
        return found

    def _clearances(self, entry: dict[str, Any]) -> None:
        """Put into the entry between what the least clearance of each operation must lie."""
        clock = self._clock("clearance")
        for k, plan in enumerate(self.plans):
            label, lean = self.reckoned.array(k, "operation"), self.reckoned.array(k, "lean")
            for i, each in enumerate(plan["operations"]):
                claimed, tool = each["clearance_mm"], self.bench.tools[each["cutter"]]
                self.tell(f"{plan['name']}: the clearance of {each['id']}")
                rows = np.flatnonzero(label == i)
                axis, there = self._axes(each, rows)
                if not tool.above(2.0 * tool.radius):
                    entry["plans"][k]["operations"][i]["clearance_mm"] = None
                    continue
                doubtful = bool(self.question.document["missing"]) or bool(self.bench.unread)
                if len(there) < len(rows) or clock.over or (claimed is None and doubtful):
                    continue
                beyond = (claimed or 0.0) * (1.0 + _EDGE) + _CLEARANCE_STEP + self.question.tolerance
                found = self.bench.clearance(each["setup"], tool, there, axis, lean[there], beyond, clock)
                if found is None:
                    continue
                true, part = found
                share = _EDGE if part == "flutes" else _CLEARANCE_SHARE
                least = (true - _CLEARANCE_STEP - self.question.tolerance) / (1.0 + share) if part else true
                entry["plans"][k]["operations"][i]["clearance_mm"] = Between(
                    max(0.0, min(_MOST, least)), max(0.0, min(_MOST, true)), 2.0 * self.bench.grain
                )


def _first(part: Any, number: int, u: Floats, v: Floats) -> Floats:
    from cad_io.kernel import first_derivatives

    return first_derivatives(part.adaptor(number), u, v)


def _inside(trim: Any, u: Floats, v: Floats) -> NDArray[np.bool_]:
    """Which parameters (n,) lie in a face, by few at a time."""
    parts = [trim.inside(u[start : start + 128], v[start : start + 128]) for start in range(0, len(u), 128)]
    return np.concatenate([*parts, np.zeros(0, bool)])
