"""Make what a process leaves entries of the plan file, by cause, with what is known to help there."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.document.inside_radii import ends_in_a_point
from plan_cutters.document.over_setups import OverSetups
from plan_cutters.domain.change import Step
from plan_cutters.domain.fillet import Fit, Fitting
from plan_cutters.domain.verdicts import COLLISION, LOCAL_GOUGE, NO_REASON, REAR_GOUGE, REASONS
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.model import CutterEntry
from plan_cutters.plan_file.process import (
    NOT_PLANNED,
    UNJUDGED_CAUSE,
    FitEntry,
    HelpEntry,
    PointsEntry,
    ProcessStep,
    RemainingEntry,
)
from plan_cutters.plan_file.words.change_text import typed_size
from plan_cutters.plan_file.words.names import kind
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]

#: Reasons against which a smaller size is tried.
_BY_SIZE = (LOCAL_GOUGE, REAR_GOUGE, COLLISION)
#: A face that has less of an area does not speak for the others, mm2, as long as these have most of it.
_SPEAKS, _MOST = 1.0, 0.5
#: A help that does less of an area is not told.
_HELPS = 0.01


class Reasons(NamedTuple):
    """Why each sample (n,) is left, and for which of some cutters that holds, -1 for none."""

    reason: Ints
    by: Ints
    cutters: list[str]


def reasons(entries: Sequence[CutterEntry], over: OverSetups, steps: Sequence[ProcessStep], done: NDArray[np.bool_]) -> Reasons:
    """Why each sample (n,) is left: by the finest cutter of the process that has a reason, else by any."""
    used = {each.cutter for each in steps}
    finest_first = sorted(entries, key=lambda e: (e.id not in used, e.radius, e.corner_radius))
    reason, by = np.full(len(done), NO_REASON, np.int32), np.full(len(done), -1, np.int32)
    for k, entry in enumerate(finest_first):
        verdicts = over.reaches[entry.id]
        open_ = ~done & (reason == NO_REASON) & verdicts.not_reached
        reason[open_], by[open_] = verdicts.reason[open_], k
    return Reasons(reason, by, [entry.id for entry in finest_first])


def remaining(
    ready: Prepared, done: NDArray[np.bool_], why: Reasons, area: Floats, requested: float, steps: Sequence[Step] = (),
    fitting: Fitting | None = None,
) -> list[RemainingEntry]:  # fmt: skip
    """List what is left by cause, the largest area first.

    Parameters
    ----------
    ready : Prepared
    done : (n,) bool
        Samples that are finished.
    why : Reasons
    area : (n,) float
        mm2, and `requested` that of all.
    steps : sequence of Step
        Next steps that are known, as they stand in the plan file.
    fitting : callable, optional
        Finds the usual sizes that fit.
    """
    samples, entries = ready.samples, list[RemainingEntry]()
    cutters = {cutter.id: cutter for cutter in ready.cutters}
    left = ready.finished & ~done
    for code in np.unique(why.reason[left]).tolist():
        mine = left & (why.reason == code)
        cause = REASONS[code] if code != NO_REASON else NOT_PLANNED
        by_size: dict[str, Any] = {}
        if code in _BY_SIZE:
            rows = _speaking(samples.face, np.flatnonzero(mine), area)
            cutter = cutters[why.cutters[int(np.bincount(why.by[rows], area[rows]).argmax())]]
            fits = None if fitting is None else fitting(cutter, rows, area)
            by_size["points"] = _points(ready, rows, area)
            by_size["fits"] = None if fits is None else [_fit_entry(fit) for fit in fits]
        helped = _helped(steps, mine, area)
        entries.append(remaining_entry(ready, cause, mine, area, requested, helped=helped, **by_size))
    unjudged = samples.unjudged >= 0
    if unjudged.any() or samples.empty:
        empty = [number for number, _ in samples.empty]
        entries.append(remaining_entry(ready, UNJUDGED_CAUSE, unjudged, area, requested, empty))
    return sorted(entries, key=lambda each: (-each.area_mm2, each.cause))


def _fit_entry(fit: Fit) -> FitEntry:
    made = fit.cutter
    across = 2.0 * made.radius
    return FitEntry(cutter=made.id, kind=kind(made), size=typed_size(made), diameter_mm=across, share=fit.share)


def _speaking(face: Ints, rows: Rows, area: Floats) -> Rows:
    """Samples (m,) without those of faces that have hardly any of their area, unless these have most of it."""
    large = np.bincount(face[rows], area[rows])[face[rows]] >= _SPEAKS
    return rows[large] if area[rows[large]].sum() >= _MOST * area[rows].sum() and large.any() else rows


def _points(ready: Prepared, rows: Rows, area: Floats) -> PointsEntry | None:
    """The inside cones with a point among the faces of some samples (m,)."""
    whole = float(area[rows].sum())
    by_face = {number: rows[ready.samples.face[rows] == number] for number in np.unique(ready.samples.face[rows]).tolist()}
    sizes = {number: float(area[mine].sum()) for number, mine in by_face.items() if ends_in_a_point(ready, number, mine)}
    if not sizes:
        return None
    faces = [f"F{number}" for number in sorted(sizes, key=lambda number: (-sizes[number], number))]
    return PointsEntry(faces=faces, share=min(1.0, sum(sizes.values()) / max(1e-300, whole)))


def _helped(steps: Sequence[Step], mine: NDArray[np.bool_], area: Floats) -> list[HelpEntry]:
    """How much of some samples (n,) each step frees, the most first."""
    whole, each = float(area[mine].sum()), list[HelpEntry]()
    for k, step in enumerate(steps):
        freed = step.freed[mine[step.freed]]
        share = min(1.0, float(area[freed].sum()) / max(1e-300, whole))
        if share >= _HELPS:
            each.append(HelpEntry(step=k, share=share))
    return sorted(each, key=lambda entry: (-entry.share, entry.step))


def remaining_entry(
    ready: Prepared, cause: str, mine: NDArray[np.bool_], area: Floats, requested: float, empty: Sequence[int] = (), **more: Any
) -> RemainingEntry:
    """The entry of some samples (n,) that are left for one cause, and of faces without samples; with more of its fields."""
    samples, missing = ready.samples, float(sum(ready.scene.part.faces[number - 1].area for number in empty))
    whole = float(area[mine].sum()) + (missing if np.isfinite(missing) else 0.0)
    faces, place = faces_of(ready, mine, area), None
    if faces:
        rows = np.flatnonzero(mine & (samples.face == int(faces[0][1:])))
        middle = samples.point[rows].mean(axis=0)
        place = vector(samples.point[rows[np.linalg.norm(samples.point[rows] - middle, axis=1).argmin()]])
    share = min(1.0, whole / max(1e-300, requested))
    faces = list(dict.fromkeys([*faces, *(f"F{number}" for number in empty)]))
    return RemainingEntry(cause=cause, area_mm2=whole, share=share, samples=int(mine.sum()), faces=faces, place_mm=place, **more)


def faces_of(ready: Prepared, mine: NDArray[np.bool_], area: Floats) -> list[str]:
    """Ids of the faces of some samples (n,), the one with the most of their area first."""
    face = ready.samples.face[mine]
    each = np.bincount(face, area[mine])
    return [f"F{number}" for number in sorted(np.unique(face).tolist(), key=lambda number: (-each[number], number))]
