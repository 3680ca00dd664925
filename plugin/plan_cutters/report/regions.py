"""Tool axis limits by region: `axis_regions.json`, for the cutter shown."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.operations.fixed_axes import fixed_axes
from plan_cutters.operations.labels import pieces
from plan_cutters.plan_file.axis_regions import AxisFound, AxisRegions, FixedAxis, FreeTilts, Region, RegionFace, Rest, Span
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.operations import runs
from plan_cutters.report.protocol import Judged
from plan_cutters.scene.clearance import clearances
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.fixed_axis import at_fixed_axis, held_at

#: Tilts from which ranges are looked for are so far apart, deg.
_STEP = 1.0


def write_regions(result: Judged, _split: object, path: Path) -> None:
    """Write `axis_regions.json`: regions that one fixed axis serves, with the limits in which their axes lie.

    With posture maps also the tilts that are free all over a region, and that the machine holds.
    """
    path.write_text(axis_regions(result).model_dump_json(indent=2) + "\n", encoding="utf-8")


def axis_regions(result: Judged) -> AxisRegions:
    """The regions of a result, for the cutter shown."""
    samples, name, plan = result.samples, result.shown, result.plan
    # Axes are held in the first setup.
    verdicts, cutter, conditions = result.here.get(name, result.reaches[name]), result.judged(name), result.conditions
    operations = result.answers.operations
    axes, number = fixed_axes(samples, cutter, verdicts, conditions, operations.plans[0] if operations else None)
    held = held_at(axes, number, samples, Context.of(cutter, conditions))
    near = clearances(at_fixed_axis(samples, held, conditions.tolerance), cutter, held, conditions).distance
    label = pieces(number, samples.neighbours)
    free = None if result.maps is None else _Free(result.maps.held(conditions))
    parts = [np.flatnonzero(label == k) for k in range(label.max(initial=-1) + 1)]
    parts = sorted(parts, key=lambda rows: (-float(samples.area[rows].sum()), int(rows[0])))
    regions = []
    for i, rows in enumerate(parts):
        point, tilt = samples.point[rows], np.degrees(held.tilt[rows])
        least = float(near[rows].min()) if np.isfinite(near[rows]).all() else None
        regions.append(
            Region(
                id=i,
                axis=int(number[rows[0]]),
                tilt_deg=_span(tilt),
                clearance_mm=least,
                samples=len(rows),
                area_mm2=float(samples.area[rows].sum()),
                low=vector(point.min(axis=0)),
                high=vector(point.max(axis=0)),
                faces=_faces(rows, samples),
                found=_axis_of_region(rows, samples, verdicts),
                free=None if free is None else free.of(rows),
                rows=runs(rows),
            )
        )
    whole = float(samples.area.sum())
    angles = _rotary(result, axes)
    fixed = []
    for k, axis in enumerate(axes):
        mine = number == k
        area = float(samples.area[mine].sum())
        fixed.append(
            FixedAxis(axis=vector(axis), rotary_deg=angles[k], samples=int(mine.sum()), area_mm2=area,
                      share=min(1.0, area / whole) if whole > 0.0 else 0.0,
                      regions=[region.id for region in regions if region.axis == k])
        )  # fmt: skip
    return AxisRegions(
        part=plan.part.file, sha256=plan.part.sha256, cutter=name, machine=plan.effective.machine,
        setup=plan.effective.setup, tolerance_mm=plan.effective.tolerance_mm, axes=fixed, regions=regions,
        rest=_rest(verdicts.reached & (number < 0), samples), not_reached=_rest(~verdicts.reached, samples),
    )  # fmt: skip


def schema() -> dict[str, Any]:
    """JSON Schema of the file (draft 2020-12), made from the model."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **AxisRegions.model_json_schema(mode="serialization")}


def schema_text() -> str:
    return json.dumps(schema(), indent=2) + "\n"


def _span(values: Floats) -> Span:
    return float(values.min()), float(values.max())


def _faces(rows: NDArray[np.int64], samples: Any) -> list[RegionFace]:
    face = samples.face[rows]
    return [
        RegionFace(face=f"F{f}", samples=int((face == f).sum()), area_mm2=float(samples.area[rows][face == f].sum()))
        for f in np.unique(face).tolist()
    ]


def _axis_of_region(rows: NDArray[np.int64], samples: Any, verdicts: Any) -> AxisFound:
    axis, area = verdicts.axis[rows], np.maximum(samples.area[rows], 1e-12)
    mean = (axis * area[:, None]).sum(axis=0)
    length = float(np.linalg.norm(mean))
    # Axes that cancel each other have no mean: any of them is as good.
    mean = mean / length if length > 1e-9 * float(area.sum()) else axis[0]
    apart = 2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(axis - mean, axis=1), 0.0, 1.0))
    return AxisFound(
        mean=vector(mean), half_angle_deg=float(np.degrees(apart.max())), tilt_deg=_span(np.degrees(verdicts.tilt[rows]))
    )


def _rotary(result: Judged, axes: Floats) -> list[dict[str, float] | None]:
    """A position of the rotary axes, deg, that holds each axis."""
    if result.kinematics is None or not len(axes):
        return [None] * len(axes)
    names = [axis.name for axis in result.conditions.machine.rotary]
    angles, taken, _ = result.kinematics.positions(axes)
    chosen = np.degrees(angles[np.arange(len(axes)), np.maximum(taken, 0)]) + 0.0
    return [dict(zip(names, each, strict=True)) for each in chosen.tolist()]


def _rest(mask: NDArray[np.bool_], samples: Any) -> Rest:
    rows = np.flatnonzero(mask)
    return Rest(samples=len(rows), area_mm2=float(samples.area[rows].sum()), rows=runs(rows))


class _Free:
    """Tilts that are free at all of some samples, from posture maps.

    From each tilt of a grid, how far up everything is free: at the best rotation of each sample, and at the worst.
    """

    def __init__(self, maps: Any) -> None:
        n, k = len(maps.verdict), len(maps.rotations)
        low, high = np.degrees(maps.tilt)
        self.start = np.append(np.arange(low, high, _STEP), high)
        self.best, self.worst = np.zeros((2, n, len(self.start)))
        first, last = np.degrees(maps.free).T
        cell = np.repeat(np.arange(n * k), np.diff(maps.offset))
        for i, tilt in enumerate(self.start.tolist()):
            up = np.full(n * k, -np.inf)
            mine = (first <= tilt) & (last >= tilt)
            # Intervals of one cell do not overlap: one at most holds a tilt, but for ends that touch.
            np.maximum.at(up, cell[mine], last[mine])
            by_sample = up.reshape(n, k)
            self.best[:, i], self.worst[:, i] = by_sample.max(axis=1), by_sample.min(axis=1)

    def of(self, rows: NDArray[np.int64]) -> FreeTilts:
        return FreeTilts(leaning_deg=self._widest(self.best[rows]), any_rotation_deg=self._widest(self.worst[rows]))

    def _widest(self, up: Floats) -> Span | None:
        """The widest range that is free at all of some samples."""
        until = up.min(axis=0)
        width = np.where(np.isfinite(until), until - self.start, -1.0)
        best = int(width.argmax())
        return (float(self.start[best]), float(until[best])) if width[best] > 0.0 else None


if __name__ == "__main__":
    (Path(__file__).parent.parent / "axis_regions.schema.json").write_text(schema_text(), encoding="utf-8")
