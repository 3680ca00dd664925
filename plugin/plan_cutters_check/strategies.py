"""Check what a plan claims to cut otherwise than in a point: floors under the flat of a tip, walls along the flutes."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from plan_cutters_check.findings import Finding
from plan_cutters_check.question import Question, ToolSizes, axes_of, degrees_of
from plan_cutters_check.reckoned import FLOOR, WALL, Reckoned
from plan_cutters_check.tool import tool_of

Rows = NDArray[np.int64]
#: Lengths and parts of unit vectors that are the same, mm; a share by which numbers may be off.
_SAME, _SHARE = 1e-5, 1e-6
#: Samples of floors at which the face is compared with the flat of the tip.
_LOOKED_AT = 500


@dataclass(frozen=True, slots=True, eq=False)
class Contacts:
    """Where tools touch: points, unit normals there, and the directions in which the tools lean from these, (m, 3) each."""

    point: Floats
    normal: Floats
    tilt_direction: Floats


def contacts_at(question: Question, reckoned: Reckoned, k: int, each: Mapping[str, Any], rows: Rows, axis: Floats) -> Contacts:
    """Where the tool of an operation of plan k touches as it cuts samples (m,), with axes (m, 3): on walls as is written."""
    point, normal = question.samples["point"][rows].copy(), question.samples["normal"][rows].copy()
    if each["mode"] != "fixed":
        # The posture that was found may touch elsewhere than at the sample; other axes touch there.
        same = (axis == question.samples[f"axis_{each['cutter']}"][rows]).all(axis=1)
        point[same] += question.shift(each["cutter"])[rows[same]]
    tilt_direction = reckoned.array(k, "lean")[rows].copy()
    mine = reckoned.array(k, "strategy")[rows] == WALL
    point[mine] = reckoned.array(k, "contact")[rows[mine]]
    normal[mine], tilt_direction[mine] = flutes(question.tools[each["cutter"]], normal[mine], axis[mine])
    return Contacts(point, normal, tilt_direction)


def flutes(sizes: ToolSizes, normal: Floats, axis: Floats) -> tuple[Floats, Floats]:
    """The normals (m, 3) of flutes along faces with normals (m, 3), and the directions in which the tool leans from them."""
    across = normal - (normal * axis).sum(axis=1)[:, None] * axis
    across = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    c, s = math.cos(sizes.taper), math.sin(sizes.taper)
    own = c * across + s * axis
    return own, (axis - s * own) / c


class Strategies:
    """The checks of what is claimed of floors and walls.

    Parameters
    ----------
    question : Question
    reckoned : Reckoned
    rng : Generator
        Of the samples of floors that are looked at.
    """

    def __init__(self, question: Question, reckoned: Reckoned, rng: np.random.Generator) -> None:
        self.question, self.reckoned, self.rng = question, reckoned, rng
        effective = question.document["effective"]
        self._scallop = float(effective["scallop_mm"])
        self._accuracy = math.radians(float(effective["axis_accuracy_deg"]))

    def findings(self, k: int) -> Iterator[Finding]:
        """A line on the floors and walls of plan k, where it has some."""
        plan, strategy = self.question.document["operations"]["plans"][k], self.reckoned.array(k, "strategy")
        label, contact = self.reckoned.array(k, "operation"), self.reckoned.array(k, "contact")
        on_wall = strategy == WALL
        off = (strategy > WALL) | ((strategy > 0) & (label < 0)) | (on_wall != np.isfinite(contact).all(axis=1))
        odd = int((off | (~on_wall & np.isfinite(contact).any(axis=1))).sum())
        wrong, floors, walls = list[str](), 0, 0
        for i, each in enumerate(plan["operations"]):
            mine = [np.flatnonzero((label == i) & (strategy == number)) for number in (FLOOR, WALL)]
            if each["axis"] is None:
                odd += sum(map(len, mine))
                continue
            setup = self.question.setups[each["setup"]]
            axis = axes_of(self.question.machine, setup, degrees_of(self.question, each))[0]
            floors, walls = floors + len(mine[0]), walls + len(mine[1])
            for rows, claim in zip(mine, (self._floor, self._wall), strict=True):
                if len(rows) and not odd:
                    wrong += [f"{each['id']}: {words}" for words in claim(k, each, rows, axis)]
        if odd:
            wrong.append(f"{odd} samples have a strategy that cannot be, or a contact without one")
        if floors or walls or wrong:
            text = f" {'; '.join(wrong[:3])}." if wrong else ""
            yield Finding(
                not wrong,
                f"The {plan['name']} plan: {floors} samples lie under the flat of a tip and {walls} along flutes, within the "
                f"scallop height; strips are no wider than these.{text}",
            )

    def _floor(self, k: int, each: Mapping[str, Any], rows: Rows, axis: Floats) -> Iterator[str]:
        """What is wrong with samples that are said to lie under the flat of the tip."""
        samples, sizes = self.question.samples, self.question.tools[each["cutter"]]
        flat = 2.0 * (sizes.radius - sizes.corner_radius) if sizes.shape == "end" else 0.0
        if flat <= 0.0:
            yield f"{sizes.id} has no flat tip"
            return
        normal = samples["normal"][rows]
        sine = np.linalg.norm(np.cross(normal, axis), axis=1)
        across = (sine <= math.sin(self._accuracy) + _SAME) & (normal @ axis > 0.0)
        if not (across & (flat * sine <= self._scallop + _SAME)).all():
            yield "a floor is not across the axis"
        strip = self.reckoned.array(k, "strip_mm")[rows]
        if not (strip <= flat * (1.0 + _SHARE)).all():
            yield "a strip of a floor is wider than the flat"
        looked = self.rng.permutation(rows)[:_LOOKED_AT]
        for face in np.unique(samples["face"][looked]).tolist():
            every = np.flatnonzero((samples["face"] == face) & self.reckoned.finished)
            tree = cKDTree(samples["point"][every])
            for row in looked[samples["face"][looked] == face].tolist():
                near = every[tree.query_ball_point(samples["point"][row], 0.5 * flat)]
                off = np.abs((samples["point"][near] - samples["point"][row]) @ samples["normal"][row])
                if off.max(initial=0.0) > self._scallop:
                    yield f"F{face} is no plane at sample {row}"
                    return

    def _wall(self, k: int, each: Mapping[str, Any], rows: Rows, axis: Floats) -> Iterator[str]:
        """What is wrong with samples that are said to lie along the flutes."""
        samples, sizes = self.question.samples, self.question.tools[each["cutter"]]
        if sizes.shape != "end":
            yield f"{sizes.id} has no straight flutes"
            return
        axes = np.repeat(axis[None], len(rows), axis=0)
        stands = contacts_at(self.question, self.reckoned, k, each, rows, axes)
        normal, point = samples["normal"][rows], samples["point"][rows]
        if not ((normal * stands.normal).sum(axis=1) >= math.cos(self._accuracy) - 1e-9).all():
            yield "a wall is not along the axis"
        low, high, depth = _on_flutes(sizes, stands, axes, point)
        if not ((low >= -_SAME) & (high >= -_SAME)).all():
            yield "a sample of a wall lies below or above the flutes"
        # With an allowance the flutes keep that from the contact, and as much from the sample.
        if not ((depth >= -self._scallop - sizes.allowance - _SAME) & (depth <= self.question.tolerance + _SAME)).all():
            yield "a sample of a wall is not at the flutes"
        strip, up = self.reckoned.array(k, "strip_mm")[rows], stands.tilt_direction
        above = ((point - stands.point) * up).sum(axis=1)
        begins = sizes.corner_radius * (1.0 - math.sin(sizes.taper))
        most = (sizes.flutes - begins) / math.cos(sizes.taper)
        if not ((above >= -_SAME) & (above <= strip + _SAME) & (strip <= most + _SAME)).all():
            yield "a strip of a wall does not hold its samples, or is higher than the flutes"
        gap = 2.0 * float(self.question.document["samples"]["max_gap_mm"]) + _SAME
        for face in np.unique(samples["face"][rows]).tolist():
            mine, whole = samples["face"][rows] == face, samples["point"][samples["face"] == face]
            # Flutes of a taper lean with the wall: along the axis they are as high as it is.
            if float(strip[mine].max()) * math.cos(sizes.taper) > float(np.ptp(whole @ axis)) + gap:
                yield f"a strip is higher than F{face}"


def _on_flutes(sizes: ToolSizes, stands: Contacts, axis: Floats, point: Floats) -> tuple[Floats, Floats, Floats]:
    """How far points (m, 3) are over the lower and below the upper end of straight flutes, mm, and how deep within their side."""
    tip = tool_of(sizes).tips(stands.point, stands.normal, axis, stands.tilt_direction)
    away = point - tip
    height = (away * axis).sum(axis=1)
    radius = np.linalg.norm(away - height[:, None] * axis, axis=1)
    c, s = math.cos(sizes.taper), math.sin(sizes.taper)
    begins = sizes.corner_radius * (1.0 - s)
    side = sizes.radius - sizes.corner_radius + sizes.corner_radius * c + (height - begins) * s / c
    return height - begins, sizes.flutes - height, (side - radius) * c
