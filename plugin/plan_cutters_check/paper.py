"""Check a plan before any tool is put down: files, samples, candidates, labels, times, what is claimed of floors and walls."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from plan_cutters_check.bench import Contacts
from plan_cutters_check.findings import Finding, leaves
from plan_cutters_check.question import Question, ToolSizes, allowed, axes_of, degrees_of, held
from plan_cutters_check.reckoned import DRILLED, FLOOR, REACHED, WALL, WORDS, Planned, Reckoned, Rows, suffix
from plan_cutters_check.tool import tool_of

_Arrays = dict[str, tuple[tuple[int, ...], str]]
#: Arrays of operations.npz that are of each plan and of candidates, and those of samples.npz, of all and of each cutter: last
#: axes and kinds.
_OF_PLAN: _Arrays = {
    "operation": ((), "i"), "strip_mm": ((), "f"), "path_mm": ((), "f"), "seconds": ((), "f"), "link_s": ((), "f"),
    "exclusive": ((), "b"), "lean": ((3,), "f"), "strategy": ((), "u"), "contact": ((3,), "f"), "moving_axis": ((3,), "f"),
    "moving_piece": ((), "i"),
}  # fmt: skip
_OF_CANDIDATES: _Arrays = {"candidate_cutter": ((), "i"), "candidate_setup": ((), "i"), "candidate_axis": ((3,), "f")}
_OF_SAMPLES: _Arrays = {"point": ((3,), "f"), "normal": ((3,), "f"), "direction_max": ((3,), "f"), "uv": ((2,), "f"),
                        "face": ((), "i"), "area": ((), "f"), "inside_bodies": ((), "b")}  # fmt: skip
_OF_CUTTERS: _Arrays = {"verdict": ((), "u"), "axis": ((3,), "f"), "lean": ((3,), "f"), "reason": ((), "u")}
#: Parts and lengths of unit vectors, and mm, that differ by less are one; shares by which areas of a face and other numbers may.
_SAME, _SAME_MM, _SAME_AREA, _SHARE = 1e-6, 1e-5, 0.01, 1e-6
#: What may be missing of what is reached, where something is missing anyway: mm2, and a share of the area.
_SHORT_MM2, _SHORT_SHARE = 0.1, 0.001
#: Tool axes that are tried for a candidate near to them, and how near one must be, deg; samples of floors that are looked at.
_TRIED, _FARTHEST, _LOOKED_AT = 400, 5.0, 500


def faults(question: Question) -> Iterator[str]:
    """List what is wrong with the form of the files, a line each: nothing more can be checked then."""
    entry, samples, arrays = question.document["operations"], question.samples, question.operations
    if not isinstance(entry.get("plans"), list) or not entry["plans"]:
        yield "plan.json has no plans of operations"
        return
    if not all(isinstance(plan, dict) and isinstance(plan.get("name"), str) for plan in entry["plans"]):
        yield "plan.json has plans without a name"
        return
    n = len(samples.get("face", ()))
    if n != question.document["samples"]["count"]:
        yield f"samples.npz has {n} samples, and plan.json {question.document['samples']['count']}"
        return
    yield from _shaped("samples.npz", samples, _OF_SAMPLES, n)
    for cutter in question.document["cutters"]:
        yield from _shaped("samples.npz", samples, {f"{k}_{cutter['id']}": v for k, v in _OF_CUTTERS.items()}, n)
    of_candidates = _OF_CANDIDATES | {"candidate_angle": ((len(question.machine.names),), "f")}
    yield from _shaped("operations.npz", arrays, of_candidates, len(arrays.get("candidate_cutter", ())))
    yield from _shaped("operations.npz", arrays, {"chosen": ((), "i")}, len(arrays.get("chosen", ())))
    every = {*of_candidates, "chosen"}
    for k, plan in enumerate(entry["plans"]):
        mine = {f"{name}{suffix(k, plan['name'])}": form for name, form in _OF_PLAN.items()}
        every |= {*mine}
        yield from _shaped("operations.npz", arrays, mine, n)
    if more := sorted({*arrays} - every):
        yield f"operations.npz has arrays that no plan has: {', '.join(more)}"
    for path, value in leaves(entry, "operations"):
        if isinstance(value, float) and not math.isfinite(value):
            yield f"plan.json: {path} is no finite number"


def _shaped(file: str, arrays: Any, wanted: _Arrays, count: int) -> Iterator[str]:
    for name, (last, kind) in wanted.items():
        array = arrays.get(name)
        if array is None:
            yield f"{file} has no array {name}"
        elif array.shape != (count, *last) or array.dtype.kind != kind:
            yield f"{file}: array {name} is {array.dtype} {array.shape}, not {(count, *last)} of the kind {kind}"


@dataclass(frozen=True, eq=False)
class Paper:
    """The checks of what is written, in their order; random axes, and samples of floors, are drawn with `rng`."""

    reckoned: Reckoned
    rng: np.random.Generator

    def findings(self) -> Iterator[Finding]:
        """All of them."""
        for name, (stated, there) in self.reckoned.question.checksums.items():
            if stated != there:
                words = f"its SHA-256 is {there[:12]}..., not {stated[:12]}..."
                yield Finding(False, f"{name} is not the file that plan.json names: {words}")
        yield from self._samples()
        yield from self._holes()
        yield from self._candidates()
        for plan in self.reckoned.plans:
            yield from self._labels(plan)
            yield from self._times(plan)
            yield from self._strategies(plan)

    def _samples(self) -> Iterator[Finding]:
        """Samples lie on the exact surface, with its normal on the side of the tool, and stand for its area."""
        question, rows = self.reckoned.question, np.flatnonzero(self.reckoned.finished)
        samples, part = question.samples, question.part
        face, far, odd = samples["face"][rows], 0.0, 0
        if not len(rows) or not 1 <= face.min() <= face.max() <= len(part.faces):
            yield Finding(False, "The samples are of faces that the part does not have.")
            return
        area_off = ""
        for number in np.unique(face).tolist():
            mine = rows[face == number]
            point, normal, slope = question.surface(number, samples["uv"][mine])
            far = max(far, float(np.abs(point - samples["point"][mine]).max()))
            size = np.linalg.norm(np.cross(slope[:, 0], slope[:, 1]), axis=1)
            # Where the parameters meet in a point the kernel has no normal.
            known = size > 1e-9 * size.max(initial=0.0)
            off = np.abs(normal[known] - samples["normal"][mine][known]).max(axis=1) > _SAME
            trim = part.trim(number)
            beyond = np.zeros(len(mine), bool) if trim is None else ~trim.inside(*samples["uv"][mine].T)
            odd += int(off.sum() + beyond.sum())
            stands, whole = float(self.reckoned.area[mine].sum()), part.faces[number - 1].area
            judged = (samples["face"] == number).sum() == len(mine)
            low, high = (1.0 - _SAME_AREA) * whole - _SAME, (1.0 + _SAME_AREA) * whole + _SAME
            if stands > high or (judged and stands < low):
                area_off = f" The samples of F{number} stand for {stands:.6g} mm2 of its {whole:.6g}."
        direction = samples["direction_max"][rows]
        odd += int((np.abs((direction * samples["normal"][rows]).sum(axis=1)) > _SAME).sum())
        words = f"{len(rows)} samples lie on the kernel's surface, the farthest {far:.2g} mm away; {odd} have another normal"
        yield Finding(far <= _SAME_MM and not odd and not area_off, f"{words} than it or lie beyond its border.{area_off}")

    def _holes(self) -> Iterator[Finding]:
        """Samples are for drills where they lie on the faces of holes that are narrow enough, and nowhere else."""
        document, samples, drilled = self.reckoned.question.document, self.reckoned.question.samples, self.reckoned.drilled
        holes = document.get("holes", [])
        if not holes and not drilled.any():
            return
        on = np.isin(samples["face"], [int(name[1:]) for hole in holes for name in hole["faces"]])
        due = on & ~self.reckoned.unjudged & ~samples["inside_bodies"]
        below = document["effective"].get("drill_below_mm", 0.0)
        wide, wrong = sum(hole["diameter_mm"] >= below for hole in holes), int((due != drilled).sum())
        words = f"{len(holes)} holes are for drills, {wide} of them no narrower than {below:g} mm; {wrong} samples are otherwise."
        yield Finding(not wide and not wrong, words)

    def _candidates(self) -> Iterator[Finding]:
        """Candidates have the axes of their angles, within the limits of the machine, and leave out no part of them."""
        question, arrays = self.reckoned.question, self.reckoned.question.operations
        cutter, setup, angle = (arrays[f"candidate_{name}"] for name in ("cutter", "setup", "angle"))
        if self.reckoned.without_fewest:
            return
        if not len(cutter) and self.reckoned.reached.any():
            yield Finding(None, "There are no candidates.")
            return
        known = (cutter >= 0) & (cutter < len(self.reckoned.ids)) & (setup >= 0) & (setup < len(question.setups))
        known &= np.isfinite(angle).all(axis=1)
        if not known.all():
            unknown = f"{int((~known).sum())} candidates are of cutters or setups that there are not, or have no angles."
            yield Finding(False, unknown)
            return
        wrong = beyond = 0
        for s, each in enumerate(question.setups):
            mine = setup == s
            axis = axes_of(question.machine, each, angle[mine])
            wrong += int((~(np.abs(axis - arrays["candidate_axis"][mine]).max(axis=1, initial=0.0) <= _SAME)).sum())
            beyond += int((~allowed(question.machine, each, angle[mine])).sum())
        words = f"{wrong} have other axes than their angles give, {beyond} are beyond the machine's limits."
        yield Finding(not wrong and not beyond, f"{len(cutter)} candidates: {words}")
        if not wrong and not beyond:
            yield self._complete(cutter, setup, arrays["candidate_axis"])

    def _complete(self, cutter: NDArray[Any], setup: NDArray[Any], axis: Floats) -> Finding:
        """Whether candidates are wherever the machine can be set to and a sample faces: some axes are tried."""
        question, effective = self.reckoned.question, self.reckoned.question.document["effective"]
        near = max(_FARTHEST, effective["index_step_deg"] or 0.0)
        high = math.radians(min(effective["tilt_deg"][1], 180.0) - near)
        normal = question.samples["normal"][self.reckoned.reached]
        low_high = np.clip(np.degrees(question.machine.limits), -180.0, 180.0)
        worst, missing, tried = 0.0, 0, 0
        for s, each in enumerate(question.setups):
            angle = self.rng.uniform(low_high[:, 0], low_high[:, 1], (_TRIED, len(low_high)))
            wanted = axes_of(question.machine, each, angle[allowed(question.machine, each, angle)])
            if not len(wanted) or not len(normal):
                continue
            wanted = wanted[(wanted @ normal.T).max(axis=1) >= math.cos(max(0.0, high))]
            for name in self.reckoned.considered:
                mine = axis[(setup == s) & (cutter == self.reckoned.ids.index(name))]
                cosine = (wanted @ mine.T).max(axis=1, initial=-1.0)
                away = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
                missing, tried = missing + int((away > near).sum()), tried + len(away)
                worst = max(worst, float(away.max(initial=0.0)))
        words = (
            f"Of {tried} tool axes that face a sample, taken by seed 0 for each setup and cutter, {missing} are more than "
            f"{near:g} deg from a candidate; the farthest is {worst:.3g} deg away."
        )
        return Finding(missing == 0, words)

    def _labels(self, plan: Planned) -> Iterator[Finding]:
        """Samples go with operations that there are, and only those that are finished."""
        label = plan.label
        bad = (label < -1) | (label >= len(plan.operations)) | ((label >= 0) & ~self.reckoned.finished)
        if self.reckoned.all_planned:
            # Steps that would be hardly any may be missing, where something is missing anyway.
            missing = (label < 0) & self.reckoned.reached
            area, whole = float(self.reckoned.area[missing].sum()), float(self.reckoned.area.sum())
            complete = not (self.reckoned.finished & ~self.reckoned.reached).any()
            if complete or area >= max(_SHORT_MM2, _SHORT_SHARE * whole):
                bad |= missing
        bad |= (label < 0) & (np.isfinite(plan["lean"]).any(axis=1) | plan["exclusive"])
        if bad.any():
            words = f"{int(bad.sum())} of {len(label)} samples go with operations that there are not, or with none though they"
            yield Finding(False, f"{plan}: {words} are reached.")

    def _times(self, plan: Planned) -> Iterator[Finding]:
        """Seconds are the path over the feed, or more where rotary axes with rates move; on floors a path is area over width."""
        label, assumed = plan.label, self.reckoned.question.document["operations"]["assumed"]
        strip, length, seconds = (plan[name] for name in ("strip_mm", "path_mm", "seconds"))
        wanted, widest, feeds = np.full(len(label), np.nan), np.zeros(len(label)), assumed["feed_mm_min"]
        walls, floors = (plan["strategy"] == each for each in (WALL, FLOOR))
        for i, each in enumerate(plan.operations):
            mine = label == i
            if feeds is not None:
                with np.errstate(divide="ignore", invalid="ignore"):
                    wanted[mine] = length[mine] / (feeds[each["cutter"]] / 60.0)
                if each["axis"] is None and self.reckoned.question.machine.rates:
                    wanted[mine] = np.fmax(wanted[mine], seconds[mine])
            tool = self.reckoned.question.tools[each["cutter"]]
            # Along walls the flutes are the limit: strips are compared with these where walls are.
            # A floor that is no wider than the tip is cut in one pass.
            by_tip = np.where(floors[mine] | (each["axis"] is None), 1.0, assumed["stepover"]) * 2.0 * tool.radius
            widest[mine] = np.where(walls[mine], tool.flutes, by_tip)
        own = label >= 0
        same = np.isclose(seconds[own], wanted[own], rtol=1e-9, atol=1e-12, equal_nan=True).all()
        on_floor, area = own & floors, self.reckoned.area
        same &= np.isclose(length[on_floor] * strip[on_floor], area[on_floor], rtol=1e-9, atol=1e-12, equal_nan=True).all()
        same &= not np.isfinite(seconds[~own]).any() and not np.isfinite(strip[~own]).any()
        fits = (np.isnan(strip[own]) | ((strip[own] > 0.0) & (strip[own] <= widest[own] * (1.0 + _SAME)))).all()
        if not (same and fits):
            yield Finding(
                False,
                f"{plan}: seconds of samples in operations.npz are not their path over "
                "the feed, paths on floors not their area over the width, or widths are beyond the step-over.",
            )

    def _strategies(self, plan: Planned) -> Iterator[Finding]:
        """What is claimed to be cut otherwise than in a point: floors under the flat of a tip, walls along the flutes."""
        question, strategy, known = self.reckoned.question, plan["strategy"], np.isfinite(plan["contact"])
        scallop, accuracy = (float(question.document["effective"][name]) for name in ("scallop_mm", "axis_accuracy_deg"))
        on_wall = strategy == WALL
        # A tool may slide to a contact that is written: then the sample lies on it all the same.
        slid = known.all(axis=1) & (strategy == 0) & (plan.label >= 0)
        off = (strategy > WALL) | ((strategy > 0) & (plan.label < 0)) | (on_wall != (known.all(axis=1) & ~slid))
        odd = int((off | (~on_wall & ~slid & known.any(axis=1))).sum())
        wrong, count = list[str](), {FLOOR: 0, WALL: 0}
        for i, each in enumerate(plan.operations):
            mine = {kind: np.flatnonzero((plan.label == i) & (strategy == kind)) for kind in count}
            if each["axis"] is None:
                odd += sum(map(len, mine.values())) + int(((plan.label == i) & slid).sum())
                continue
            axis = axes_of(question.machine, question.setups[each["setup"]], degrees_of(question, each))[0]
            if (rows := np.flatnonzero((plan.label == i) & slid)).size:
                wrong += [f"{each['id']}: {words}" for words in self._slid(plan, each, rows, axis)]
            for kind, claim in ((FLOOR, self._floor), (WALL, self._wall)):
                count[kind] += len(mine[kind])
                if len(mine[kind]) and not odd:
                    wrong += [
                        f"{each['id']}: {words}" for words in claim(plan, each, mine[kind], axis, scallop, math.radians(accuracy))
                    ]
        if odd:
            wrong.append(f"{odd} samples have a strategy that cannot be, or a contact without one")
        if any(count.values()) or wrong:
            text = f" {'; '.join(wrong[:3])}." if wrong else ""
            yield Finding(
                not wrong,
                f"{plan}: {count[FLOOR]} samples lie under the flat of a tip and {count[WALL]} along flutes, within the "
                f"scallop height; strips are no wider than these.{text}",
            )

    def _slid(self, plan: Planned, each: Mapping[str, Any], rows: Rows, axis: Floats) -> Iterator[str]:
        """What is wrong with samples that lie elsewhere on a tool than its contact."""
        question = self.reckoned.question
        tool, axes = tool_of(question.tools[each["cutter"]]), np.repeat(axis[None], len(rows), axis=0)
        at = contacts_at(question, plan, each, rows, axes)
        away = question.samples["point"][rows] - tool.tips(at.point, at.normal, axes, at.tilt_direction)
        height = (away * axis).sum(axis=1)
        depth = tool.solids[0].depth(np.linalg.norm(away - height[:, None] * axis, axis=1), height)[0]
        keeps = question.tools[each["cutter"]].allowance
        if not (np.abs(depth + keeps) <= question.tolerance + _SAME_MM).all():
            yield "a sample away from its contact does not lie on the flutes"

    def _floor(
        self, plan: Planned, each: Mapping[str, Any], rows: Rows, axis: Floats, scallop: float, accuracy: float
    ) -> Iterator[str]:
        """What is wrong with samples that are said to lie under the flat of the tip."""
        samples, sizes = self.reckoned.question.samples, self.reckoned.question.tools[each["cutter"]]
        flat = 2.0 * (sizes.radius - sizes.corner_radius) if sizes.shape == "end" else 0.0
        if flat <= 0.0:
            yield f"{sizes.id} has no flat tip"
            return
        normal = samples["normal"][rows]
        sine = np.linalg.norm(np.cross(normal, axis), axis=1)
        across = (sine <= math.sin(accuracy) + _SAME_MM) & (normal @ axis > 0.0)
        if not (across & (flat * sine <= scallop + _SAME_MM)).all():
            yield "a floor is not across the axis"
        if not (plan["strip_mm"][rows] <= flat * (1.0 + _SHARE)).all():
            yield "a strip of a floor is wider than the flat"
        looked = self.rng.permutation(rows)[:_LOOKED_AT]
        for face in np.unique(samples["face"][looked]).tolist():
            every = np.flatnonzero((samples["face"] == face) & self.reckoned.finished)
            tree = cKDTree(samples["point"][every])
            for row in looked[samples["face"][looked] == face].tolist():
                near = every[tree.query_ball_point(samples["point"][row], 0.5 * flat)]
                off = np.abs((samples["point"][near] - samples["point"][row]) @ samples["normal"][row])
                if off.max(initial=0.0) > scallop:
                    yield f"F{face} is no plane at sample {row}"
                    return

    def _wall(
        self, plan: Planned, each: Mapping[str, Any], rows: Rows, axis: Floats, scallop: float, accuracy: float
    ) -> Iterator[str]:
        """What is wrong with samples that are said to lie along the flutes."""
        question = self.reckoned.question
        samples, sizes = question.samples, question.tools[each["cutter"]]
        if sizes.shape != "end":
            yield f"{sizes.id} has no straight flutes"
            return
        axes = np.repeat(axis[None], len(rows), axis=0)
        at = contacts_at(question, plan, each, rows, axes)
        normal, point = samples["normal"][rows], samples["point"][rows]
        if not ((normal * at.normal).sum(axis=1) >= math.cos(accuracy) - 1e-9).all():
            yield "a wall is not along the axis"
        # Heights over the tip where the side is straight, and how deep the samples are within it.
        away = point - tool_of(sizes).tips(at.point, at.normal, axes, at.tilt_direction)
        height = (away * axis).sum(axis=1)
        c, s = math.cos(sizes.taper), math.sin(sizes.taper)
        begins = sizes.corner_radius * (1.0 - s)
        side = sizes.radius - sizes.corner_radius + sizes.corner_radius * c + (height - begins) * s / c
        depth = (side - np.linalg.norm(away - height[:, None] * axis, axis=1)) * c
        if not ((height - begins >= -_SAME_MM) & (sizes.flutes - height >= -_SAME_MM)).all():
            yield "a sample of a wall lies below or above the flutes"
        # With an allowance the flutes keep that from the contact, and as much from the sample.
        if not ((depth >= -scallop - sizes.allowance - _SAME_MM) & (depth <= question.tolerance + _SAME_MM)).all():
            yield "a sample of a wall is not at the flutes"
        strip, most = plan["strip_mm"][rows], (sizes.flutes - begins) / c
        above = ((point - at.point) * at.tilt_direction).sum(axis=1)
        if not ((above >= -_SAME_MM) & (above <= strip + _SAME_MM) & (strip <= most + _SAME_MM)).all():
            yield "a strip of a wall does not hold its samples, or is higher than the flutes"
        gap = 2.0 * float(question.document["samples"]["max_gap_mm"]) + _SAME_MM
        for face in np.unique(samples["face"][rows]).tolist():
            mine, whole = samples["face"][rows] == face, samples["point"][samples["face"] == face]
            # Flutes of a taper lean with the wall: along the axis they are as high as it is.
            if float(strip[mine].max()) * c > float(np.ptp(whole @ axis)) + gap:
                yield f"a strip is higher than F{face}"


def contacts_at(question: Question, plan: Planned, each: Mapping[str, Any], rows: Rows, axis: Floats) -> Contacts:
    """Where the tool of an operation of a plan touches as it cuts samples (m,), with axes (m, 3): on walls as is written."""
    point, normal = question.samples["point"][rows].copy(), question.samples["normal"][rows].copy()
    if each["mode"] != "fixed":
        # The posture that was found may touch elsewhere than at the sample; other axes touch there.
        same = (np.abs(axis - question.samples[f"axis_{each['cutter']}"][rows]) <= _SAME).all(axis=1)
        point[same] += question.shift(each["cutter"])[rows[same]]
    tilt_direction = plan["lean"][rows].copy()
    written = np.isfinite(plan["contact"][rows]).all(axis=1)
    point[written] = plan["contact"][rows[written]]
    mine = plan["strategy"][rows] == WALL
    normal[mine], tilt_direction[mine] = _flutes(question.tools[each["cutter"]], normal[mine], axis[mine])
    return Contacts(point, normal, tilt_direction)


def _flutes(sizes: ToolSizes, normal: Floats, axis: Floats) -> tuple[Floats, Floats]:
    """The normals (m, 3) of flutes along faces with normals (m, 3), and the directions in which the tool leans from them."""
    across = normal - (normal * axis).sum(axis=1)[:, None] * axis
    across = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    c, s = math.cos(sizes.taper), math.sin(sizes.taper)
    own = c * across + s * axis
    return own, (axis - s * own) / c


def ill_formed(reckoned: Reckoned) -> Iterator[Finding]:
    """Images of each other that are none; axes for motion of no operation, that are no unit vectors, or that are not held."""
    question = reckoned.question
    for plan in reckoned.plans:
        label, axis, piece = plan.label, plan["moving_axis"], plan["moving_piece"]
        kinds: dict[int, set[Any]] = {}
        for each in (each for each in plan.operations if each.get("orbit") is not None):
            kinds.setdefault(each["orbit"], set()).add((each["cutter"], each["setup"], each["mode"]))
        for orbit in (orbit for orbit, some in kinds.items() if len(some) > 1):
            yield Finding(False, f"{plan}: the operations of orbit {orbit} are no images of each other.")
        turning = [i for i, each in enumerate(plan.operations) if each["turning"] is not None]
        if any(plan.operations[i]["mode"] == "fixed" for i in turning):
            yield Finding(False, f"{plan}: the axis of a fixed operation turns.")
        moving = [i for i, each in enumerate(plan.operations) if each["mode"] != "fixed"]
        mine, known, proved = np.isin(label, moving), ~np.isnan(axis).all(axis=1), piece >= 0
        if turning or known.any() or proved.any() or (piece < -1).any():
            unit = np.abs(np.linalg.norm(axis, axis=1) - 1.0) <= _SAME
            wrong = (known & (~mine | ~unit)) | (proved & ~(known & np.isin(label, turning))) | (piece < -1)
            for i in turning:
                each, rows = plan.operations[i], np.flatnonzero((label == i) & proved)
                # A piece is named where it has most of the area about a sample: of those that are counted some may have none.
                if len(rows) and not each["turning"]["pieces_mm2"]:
                    wrong[rows] = True
                wrong[rows[~held(question.machine, question.setups[each["setup"]], axis[rows])]] = True
            yield Finding(
                not wrong.any(),
                f"{plan}: axes for simultaneous motion at {int(known.sum())} samples, {int(proved.sum())} of "
                f"them in proved pieces; {int(wrong.sum())} are no axes, of no such operation, or beyond the machine's limits.",
            )


def unsound(reckoned: Reckoned) -> Iterator[Finding]:
    """List what no plan has: words that cannot be made, verdicts that contradict their axes, a chord error that nothing has."""
    document = reckoned.question.document
    if reckoned.question.odd:
        yield Finding(False, f"plan.json: {reckoned.question.odd}.")
    for name, verdict in reckoned.verdict.items():
        axis, reached = reckoned.question.samples[f"axis_{name}"], np.isin(verdict, REACHED)
        with np.errstate(invalid="ignore"):
            unit = np.abs(np.linalg.norm(axis, axis=1) - 1.0) <= _SAME
        wrong = int((reached != unit).sum()) + int((~np.isin(verdict, [*WORDS.values(), DRILLED])).sum())
        if wrong:
            words = f"samples.npz: {wrong} verdicts of {name} have no tool axis with which they are reached, or no meaning."
            yield Finding(False, words)
    errors = [each["chord_error_mm"] or 0.0 for each in (*document["faces"], *document["fixtures"])]
    if document["effective"]["chord_error_mm"] > max(errors) + 1e-12:
        yield Finding(False, "effective.chord_error_mm is larger than that of each face and fixture.")
