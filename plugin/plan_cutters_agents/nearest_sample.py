"""The sample of a plan that is nearest to a point: its arrays stand beside the plan."""

from pathlib import Path

from plan_cutters.plan_file.model import Plan
from plan_cutters_agents.answers import Sample, Vector
from plan_cutters_agents.limits import CallError
from plan_cutters_agents.requests import ExplainQuestion
from plan_cutters_agents.words import Permissions


def nearest_sample(file: str, plan: Plan, cutter: str, question: ExplainQuestion, permissions: Permissions) -> Sample:
    """Look up the sample that is nearest to the point in question.

    Raises
    ------
    CallError
        There are no arrays, or no sample is near enough.
    """
    import numpy as np

    from plan_cutters.domain.verdicts import NO_REASON, WORDS
    from plan_cutters.files.arrays import Archive

    if "npz" not in plan.files:
        raise CallError(
            "has no samples.npz in its folder, so a point cannot be looked up: give a face, or plan with the format npz",
            file=file,
        )
    npz = str(Path(file).parent / plan.files["npz"].name)
    with Archive(permissions.file(npz), "samples", CallError) as archive:
        names = ("point", "face", f"verdict_{cutter}", f"reason_{cutter}", f"axis_{cutter}")
        if any(name not in archive.headers for name in names):
            raise archive.fault(f"without {cutter}")
        points, faces, verdicts, reasons, axes = (archive.read(name) for name in names)
    if (
        points.ndim != 2
        or points.shape[1:] != (3,)
        or not len(points)
        or any(len(a) != len(points) for a in (faces, verdicts, reasons, axes))
    ):
        raise CallError("its arrays do not belong together: plan the part again", file=npz)
    off = np.linalg.norm(points - np.array(question.point), axis=1)
    row = int(np.nanargmin(off))
    most, face = max(question.within_mm, plan.samples.max_gap_mm or 0.0), f"F{int(faces[row])}"
    if not off[row] <= most:
        raise CallError(
            f"the nearest sample is {off[row]:.4g} mm from the point, on {face}; give a point within {most:.3g} mm "
            "of one, or a face",
            file=file,
        )
    axis: Vector | None = tuple(axes[row].tolist()) if np.isfinite(axes[row]).all() else None
    code = int(reasons[row])
    return Sample(
        point=tuple(points[row].tolist()),
        distance_mm=float(off[row]),
        face=face,
        verdict=WORDS.get(int(verdicts[row]), "unknown"),
        axis=axis,
        reason=None if code == NO_REASON or code >= len(plan.reasons) else plan.reasons[code],
    )
