"""What a new part has to pass: contacts that are on its skin, and closed forms that agree with points of its exact surface.

`python -m conformance check NAME` writes the part's STEP file aside and reads it back; `confirm` and `answers` ask bounds over the surface.
"""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from conformance.exact import slow
from conformance.forms import Surface
from conformance.made.part import TOUCH, MadePart, held, postures
from conformance.posture import Postures
from conformance.tool import Floats

#: The pitch (mm) of the twin's points, and how far (mm) its margin and the form's may differ.
PITCH, AGREE = 1.0, 2e-3


@dataclass(frozen=True)
class Difference:
    """One posture on which form and twin do not agree."""

    row: int
    form: float
    twin: float


def write_step(part: MadePart, path: Path) -> None:
    """Write the part as STEP, in mm."""
    import cadquery as cq

    shape = part.build()
    cq.exporters.export(shape if isinstance(shape, cq.Workplane) else cq.Workplane(obj=shape.val()), str(path))


def faults(part: MadePart, count: int = 100) -> Iterator[str]:
    """Yield a line for each thing that is wrong with drawn contacts: not on a material's skin, or a normal that is none or points into it.

    A searched surface has no inside: of it only the distance is looked at.
    """
    points, normals = part.contacts(np.random.default_rng(0), count)
    bad = ~np.isfinite(points).all(axis=1) | ~(np.abs(np.linalg.norm(normals, axis=1) - 1.0) < 1e-6)
    if bad.any():
        first = f"the first is {points[bad][0]}, {normals[bad][0]}"
        yield f"contacts: {bad.sum()} of {len(points)} are not finite, or have a normal that is not of length 1; {first}"
        points, normals = points[~bad], normals[~bad]
    on = np.array([held(material, points) for material in part.materials])
    away = ~on.any(axis=0)
    if away.any():
        yield f"contacts: {away.sum()} of {len(points)} lie on no material's skin; the first is {points[away][0]}"
    solid = [k for k, material in enumerate(part.materials) if not isinstance(material, Surface)]
    out = np.array([part.materials[k].height(points + 1e-3 * normals) > 0 for k in solid], bool).reshape(len(solid), len(points))
    inwards = on[solid].any(axis=0) & ~(on[solid] & out).any(axis=0)
    if inwards.any():
        first = f"the first is {points[inwards][0]}, {normals[inwards][0]}"
        yield f"contacts: {inwards.sum()} of {len(points)} have a normal that points into the material; {first}"


def faces_of(part: MadePart, pitch: float = PITCH) -> list[slow.Face]:
    """Return the faces of the part as another program reads them: through STEP."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{part.name}.step"
        write_step(part, path)
        return slow.faces(slow.read(path), pitch)


def exempt_faces(part: MadePart, faces: list[slow.Face], contact: Floats) -> list[list[bool]]:
    """Return for each contact which faces belong to the material that it touches."""
    on = np.array([held(m, contact) for m in part.materials])
    rows = []
    for face in faces:
        some = face.points[:: max(1, len(face.points) // 25)]
        rows.append([len(some) > 0 and bool(np.all(held(m, some))) for m in part.materials])
    belongs = np.array(rows)
    return [[bool(np.any(belongs[f] & on[:, i])) for f in range(len(faces))] for i in range(len(contact))]


def differences(part: MadePart, table: Postures | None = None, count: int = 24, pitch: float = PITCH) -> Iterator[Difference]:
    """Yield the postures on which form and twin differ by more than AGREE; those blocked by limits or fixtures are left out."""
    table = postures(part, count, seed=1) if table is None else table
    faces = faces_of(part, pitch)
    exempt = exempt_faces(part, faces, table.contact)
    for i in range(len(table)):
        if table.reason[i] in ("limit", "fixture"):
            continue
        tool = part.tool(str(table.tool[i]))
        twin = slow.margin(faces, exempt[i], tool, table.tip[i], table.axis[i], TOUCH)
        form = float(table.low[i])
        # Deep in the material its inside counts, too, which has no points; at the border in the contact the clearance is
        # left out.
        agree = abs(twin - form) <= AGREE or (form < -0.5 and twin < -0.2) or (form == 0.0 and twin > -AGREE)
        if not agree:
            yield Difference(i, form, twin)
