"""How much of the target faces lies inside other bodies of the part becomes an entry of the plan file here."""

import shlex
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plan_cutters.document.shares import covered
from plan_cutters.plan_file.inside import CoveringBody, InsideEntry, SheetsEntry
from plan_cutters.plan_file.shares import FaceVerdicts
from plan_cutters.scene.covering import coverings, numbers, sheets
from plan_cutters.scene.inside_material import voids
from plan_cutters.scene.preparation import Prepared


def inside_entry(ready: Prepared, faces: Mapping[str, FaceVerdicts]) -> InsideEntry:
    """Sum up the surface that lies inside other bodies, body by body; `faces`: the verdicts of any one cutter."""
    inside, samples = ready.inside_bodies, ready.samples
    if not inside.any():
        return InsideEntry()
    area, share = covered(faces, samples, ready.scene.part)
    within, lying = float(samples.area[inside].sum()), sheets(ready)

    def of(rows: NDArray[np.int64]) -> float:
        """Area that some samples stand for, so that all of it comes to that of the faces."""
        return area * float(samples.area[rows].sum()) / within if within > 0.0 else 0.0

    def on(rows: NDArray[np.int64]) -> list[str]:
        return [f"F{n}" for n in np.unique(samples.face[rows]).tolist()]

    bodies = [
        CoveringBody(
            number=1 + each.index,
            name=each.name,
            own_faces=numbers(each.faces).split(","),
            faces=on(each.rows),
            samples=len(each.rows),
            area_mm2=of(each.rows),
            how=each.how,
            largest=each.largest,
            option=f"--ignore {shlex.quote(each.selection)}",
        )
        for each in ready.cache.cached("coverings", _follows_from(ready), lambda: coverings(ready))
    ]
    names = ready.conditions.surroundings.on_bodies
    on_bodies = None
    if len(lying):
        on_bodies = SheetsEntry(faces=on(lying), samples=len(lying), area_mm2=of(lying), option=f"--ignore {numbers(names)}")
    return InsideEntry(samples=int(inside.sum()), area_mm2=area, share=share, bodies=bodies, sheets=on_bodies)


def void_faces(ready: Prepared) -> list[str]:
    """Ids of the faces whose samples inside material all lie in a closed void: no body that could be absent is around them."""
    bodies = ready.conditions.surroundings.bodies
    hollow, within = np.array([*voids(bodies, ready.scene.orientation), False]), ready.inside >= 0
    in_void = within & hollow[np.minimum(ready.inside, len(bodies))]
    shut, others = np.unique(ready.samples.face[in_void]), np.unique(ready.samples.face[within & ~in_void])
    return [f"F{number}" for number in np.setdiff1d(shut, others).tolist()]


def _follows_from(ready: Prepared) -> tuple[object, ...]:
    """All that bodies over samples follow from."""
    scene, samples, certain = ready.scene, ready.samples, ready.conditions.surroundings.certain.triangles
    inside = ready.inside, ready.inside_bodies, samples.point, samples.face, samples.area
    return scene.part.key, scene.ignored, certain.vertex, certain.chord_error, ready.conditions.tolerance, inside
