"""The posture found at every sample as columns, for the cutter shown: what `axes.csv` and `axes.vtp` have in common."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.clearance import part_words
from plan_cutters.domain.travel import tips
from plan_cutters.domain.verdicts import CONCAVE, CONVEX, NO_REASON, REASONS, SADDLE, UNJUDGED, WORDS
from plan_cutters.report.protocol import Judged
from plan_cutters.scene.conditions import rotations_of

CLASSES = {CONVEX: "convex", CONCAVE: "concave", SADDLE: "saddle", UNJUDGED: "unjudged"}
#: Digits behind the point of lengths, mm, angles, deg, and parts of unit vectors.
_MM, _DEG, _UNIT = 6, 6, 9


@dataclass(frozen=True, slots=True)
class Column:
    """One column, or three of a vector.

    Attributes
    ----------
    name : str
        With its unit at the end where it has one: `tilt_deg`.
    values : (n,) or (n, 3) array
    digits : int
        Behind the point, for text.
    words : dict, optional
        What codes mean, in text.
    """

    name: str
    values: NDArray[Any]
    digits: int = 0
    words: dict[int, str] | None = None

    @property
    def names(self) -> list[str]:
        """One name for each column of text: a vector's parts stand before its unit, as in `point_x_mm`."""
        if self.values.ndim == 1:
            return [self.name]
        stem, dash, unit = self.name.rpartition("_") if self.name.endswith("_mm") else (self.name, "", "")
        return [f"{stem}_{axis}{dash}{unit}" for axis in "xyz"]


def columns(result: Judged, cutter_id: str | None = None) -> list[Column]:
    """The columns, in their order, a row for each sample in the order of `samples.npz`; default of the cutter shown."""
    samples, name = result.samples, cutter_id or result.shown
    verdicts, cutter = result.reaches[name], result.judged(name)
    near = result.clearances if name == result.shown else result.clearances_of(name)
    surroundings = result.conditions.surroundings
    n = len(samples)
    rotation = np.degrees(rotations_of(samples.normal, samples.direction_max, verdicts.tilt_direction))
    rotation[~verdicts.reached] = np.nan
    faces = {number: surroundings.called(number) for number in np.unique(near.face).tolist() if number}
    table = [
        Column("sample", np.arange(n, dtype=np.int32)),
        Column("face", samples.face, words={f: f"F{f}" for f in np.unique(samples.face).tolist()}),
        Column("point_mm", samples.point, _MM),
        Column("normal", samples.normal, _UNIT),
        Column("area_mm2", samples.area, _MM),
        Column("surface_class", result.surface_class, words=CLASSES),
        Column("verdict", verdicts.verdict, words=WORDS),
        Column("reason", verdicts.reason, words=dict(enumerate(REASONS)) | {NO_REASON: ""}),
        Column("axis", verdicts.axis, _UNIT),
        Column("lean", verdicts.tilt_direction, _UNIT),
        Column("tilt_deg", np.degrees(verdicts.tilt), _DEG),
        Column("rotation_deg", rotation, _DEG),
        Column("tip_mm", tips(cutter, samples.point, samples.normal, verdicts), _MM),
        Column("clearance_mm", near.distance, _MM),
        Column("nearest_part", near.part, words={-1: "", **part_words()}),
        Column("nearest_face", near.face, words={0: "", **faces}),
    ]
    if name in result.served_in:
        setups = range(len(result.elsewhere) + 1)
        table.append(Column("setup", result.served_in[name], words={-1: "", **{k: str(k) for k in setups}}))
    return table + _machine(result, name)


def _machine(result: Judged, name: str) -> list[Column]:
    """Positions of the machine's axes: those to take, then the rotary ones of the other solution; linear ones where judged."""
    machine = result.conditions.machine
    if result.kinematics is None:
        return []
    angles, taken = result.rotary(name)
    moved = result.travels.get(name)
    first, rows = np.maximum(taken, 0).astype(np.int64), np.arange(len(taken))
    both = [np.where((taken >= 0)[:, None], np.degrees(angles[rows, way]), np.nan) for way in (first, 1 - first)]
    table = [
        Column(f"{axis.name}{word}_deg", np.ascontiguousarray(each[:, k]), _DEG)
        for word, each in zip(("", "_other"), both, strict=True)
        for k, axis in enumerate(machine.rotary)
    ]
    if moved is not None:
        table += [
            Column(f"{axis.name}_mm", np.ascontiguousarray(moved.position[:, k]), _MM) for k, axis in enumerate(machine.linear)
        ]
    return table
