"""Check a plan before any tool is put down: files, samples, candidates, labels and times."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives
from plan_cutters_check.findings import Finding
from plan_cutters_check.question import Question, allowed, axes_of
from plan_cutters_check.reckoned import FLOOR, WALL, Reckoned
from plan_cutters_check.strategies import Strategies

#: Parts of unit vectors, and mm, that differ by less are one; share by which areas of a face may differ.
_SAME, _SAME_MM, _SAME_AREA = 1e-6, 1e-5, 0.01
#: What may be missing of what is reached, where something is missing anyway: mm2, and a share of the area.
_SHORT_MM2, _SHORT_SHARE = 0.1, 0.001
#: Tool axes that are tried for a candidate near to them, and how near one must be, deg.
_TRIED, _FARTHEST = 400, 5.0
#: Points that are asked at once whether they lie in a face.
_AT_ONCE = 128


class Paper:
    """The checks of what is written, in their order.

    Parameters
    ----------
    question : Question
    reckoned : Reckoned
    rng : Generator
        Of random axes.
    """

    def __init__(self, question: Question, reckoned: Reckoned, rng: np.random.Generator) -> None:
        self.question, self.reckoned, self.rng = question, reckoned, rng
        self.plans: list[dict[str, Any]] = question.document["operations"]["plans"]

    def findings(self) -> Iterator[Finding]:
        """All of them."""
        yield from self._files()
        yield from self._samples()
        yield from self._candidates()
        for k in range(len(self.plans)):
            yield from self._labels(k)
            yield from self._times(k)
            yield from Strategies(self.question, self.reckoned, self.rng).findings(k)

    def _files(self) -> Iterator[Finding]:
        """The arrays are those that plan.json names."""
        for name, (stated, there) in self.question.checksums.items():
            if stated != there:
                words = f"its SHA-256 is {there[:12]}..., not {stated[:12]}..."
                yield Finding(False, f"{name} is not the file that plan.json names: {words}")

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
            point, s_u, s_v = np.moveaxis(first_derivatives(part.adaptor(number), u, v), 1, 0)
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
            low, high = (1.0 - _SAME_AREA) * whole - _SAME, (1.0 + _SAME_AREA) * whole + _SAME
            if stands > high or (judged and stands < low):
                area_off = f" The samples of F{number} stand for {stands:.6g} mm2 of its {whole:.6g}."
        direction = samples["direction_max"][rows]
        odd += int((np.abs((direction * samples["normal"][rows]).sum(axis=1)) > _SAME).sum())
        holds = far <= _SAME_MM and not odd and not area_off
        yield Finding(
            holds,
            f"{len(rows)} samples lie on the kernel's surface, the farthest {far:.2g} mm away; {odd} have "
            f"another normal than it or lie beyond its border.{area_off}",
        )

    def _candidates(self) -> Iterator[Finding]:
        """Candidates have the axes of their angles, within the limits of the machine, and leave out no part of them."""
        question, arrays = self.question, self.question.operations
        cutter, setup, angle = (arrays[f"candidate_{name}"] for name in ("cutter", "setup", "angle"))
        ids = self.reckoned.ids
        if self.reckoned.without_fewest:
            return
        if not len(cutter) and self.reckoned.reached.any():
            yield Finding(None, "There are no candidates.")
            return
        known = (cutter >= 0) & (cutter < len(ids)) & (setup >= 0) & (setup < len(question.setups))
        known &= np.isfinite(angle).all(axis=1)
        if not known.all():
            unknown = int((~known).sum())
            yield Finding(False, f"{unknown} candidates are of cutters or setups that there are not, or have no angles.")
            return
        wrong = beyond = 0
        for s, each in enumerate(question.setups):
            mine = setup == s
            axis = axes_of(question.machine, each, angle[mine])
            wrong += int((~(np.abs(axis - arrays["candidate_axis"][mine]).max(axis=1, initial=0.0) <= _SAME)).sum())
            beyond += int((~allowed(question.machine, each, angle[mine])).sum())
        yield Finding(
            not wrong and not beyond,
            f"{len(cutter)} candidates: {wrong} have other axes than their angles "
            f"give, {beyond} are beyond the machine's limits.",
        )
        if not wrong and not beyond:
            yield self._complete(cutter, setup, arrays["candidate_axis"])

    def _complete(self, cutter: NDArray[Any], setup: NDArray[Any], axis: Floats) -> Finding:
        """Whether candidates are wherever the machine can be set to and a sample faces: some axes are tried."""
        question, step = self.question, self.question.document["effective"]["index_step_deg"]
        near = max(_FARTHEST, step or 0.0)
        high = math.radians(min(question.document["effective"]["tilt_deg"][1], 180.0) - near)
        normal = question.samples["normal"][self.reckoned.reached]
        low_high = np.clip(np.degrees(question.machine.limits), -180.0, 180.0)
        worst, missing, tried = 0.0, 0, 0
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
                missing, tried = missing + int((away > near).sum()), tried + len(away)
                worst = max(worst, float(away.max(initial=0.0)))
        words = (
            f"Of {tried} tool axes that face a sample, taken by seed 0 for each setup and cutter, {missing} are more than "
            f"{near:g} deg from a candidate; the farthest is {worst:.3g} deg away."
        )
        return Finding(missing == 0, words)

    def _labels(self, k: int) -> Iterator[Finding]:
        """Samples go with operations that there are, and only those that are finished."""
        plan, label, tilt_direction = self.plans[k], self.reckoned.array(k, "operation"), self.reckoned.array(k, "lean")
        bad = (label < -1) | (label >= len(plan["operations"])) | ((label >= 0) & ~self.reckoned.finished)
        if self.reckoned.all_planned:
            # Steps that would be hardly any may be missing, where something is missing anyway.
            missing = (label < 0) & self.reckoned.reached
            area, whole = float(self.reckoned.area[missing].sum()), float(self.reckoned.area.sum())
            complete = not (self.reckoned.finished & ~self.reckoned.reached).any()
            if complete or area >= max(_SHORT_MM2, _SHORT_SHARE * whole):
                bad |= missing
        bad |= (label < 0) & (np.isfinite(tilt_direction).any(axis=1) | self.reckoned.array(k, "exclusive"))
        if bad.any():
            yield Finding(
                False,
                f"The {plan['name']} plan: {int(bad.sum())} of {len(label)} samples go with operations "
                "that there are not, or with none though they are reached.",
            )

    def _times(self, k: int) -> Iterator[Finding]:
        """Seconds of each sample are its path over the feed; on planes a path of a fixed axis is its area over the width."""
        plan, label, assumed = (
            self.plans[k],
            self.reckoned.array(k, "operation"),
            self.question.document["operations"]["assumed"],
        )
        strip, length, seconds = (self.reckoned.array(k, name) for name in ("strip_mm", "path_mm", "seconds"))
        wanted, widest, feeds = np.full(len(label), np.nan), np.zeros(len(label)), assumed["feed_mm_min"]
        walls, floors = (self.reckoned.array(k, "strategy") == each for each in (WALL, FLOOR))
        for i, each in enumerate(plan["operations"]):
            mine = label == i
            if feeds is not None:
                with np.errstate(divide="ignore", invalid="ignore"):
                    wanted[mine] = length[mine] / (feeds[each["cutter"]] / 60.0)
            tool = self.question.tools[each["cutter"]]
            # Along walls the flutes are the limit: `Strategies` compares strips with these.
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
                f"The {plan['name']} plan: seconds of samples in operations.npz are not their path over "
                "the feed, paths on floors not their area over the width, or widths are beyond the step-over.",
            )


def _inside(trim: Any, u: Floats, v: Floats) -> NDArray[np.bool_]:
    """Which parameters (n,) lie in a face, by few at a time."""
    parts = [trim.inside(u[start : start + _AT_ONCE], v[start : start + _AT_ONCE]) for start in range(0, len(u), _AT_ONCE)]
    return np.concatenate([*parts, np.zeros(0, bool)])
