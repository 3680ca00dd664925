"""Say which faces bend inwards more than the cutter, and which usual size fits."""

from collections.abc import Iterator, Mapping

from plan_cutters.domain.figures import listed, mm
from plan_cutters.plan_file.model import Plan

#: Faces that are named.
_FACES = 3


def inside_radii(plan: Plan, names: Mapping[str, str]) -> Iterator[str]:
    """One sentence on all of them; nothing where no face bends more than the cutter shown."""
    faces = plan.inside_radii
    if not faces or plan.shown is None:
        return
    smallest = faces[0]
    fits = f"the largest usual size that fits is D{smallest.fits_mm:g}" if smallest.fits_mm else "no usual size is that small"
    yield (
        f"The smallest inside radius of {listed([each.face for each in faces], _FACES)} is {mm(smallest.radius_mm)}, and "
        f"{names[plan.shown]} has R{smallest.cutter_radius_mm:.4g}: {fits}."
    )
