"""The plan file states here how much of the target faces lies inside other bodies of the part."""

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from cad_io.kernel.assembly import component_of, faces_of
from cad_io.part import Part
from cad_io.part.bodies import Body
from plan_cutters.document.frozen import Frozen
from plan_cutters.document.shares import FaceVerdicts, covered
from plan_cutters.scene.covering import Covering, coverings, sheets
from plan_cutters.scene.obstacles import weights
from plan_cutters.scene.preparation import Prepared


class CoveringBody(Frozen):
    """A body of the part, and what of the target faces lies inside it."""

    number: int = Field(description="from 1")
    name: str = Field(description="of its component; empty where it has none of its own")
    own_faces: list[str] = Field(description="runs of them, as `F7-12`")
    faces: list[str] = Field(description="target faces that it covers, some of each at least")
    samples: int
    area_mm2: float
    how: Literal["overlaps", "stands_on", "touches_or_overlaps"] = Field(
        description="stands_on: the skins touch and the volumes do not intersect, as a clamp drawn as a solid"
    )
    largest: bool = Field(default=False, description="no other body is larger")
    option: str = Field(description="of the command, which leaves the body out")


class SheetsEntry(Frozen):
    """Construction sheets on the skin of a body: what of them faces into it."""

    faces: list[str]
    samples: int
    area_mm2: float
    option: str = Field(description="of the command, which leaves them out")


class InsideEntry(Frozen):
    """This much of the target faces lies inside other bodies of the part: it is no surface of the finished part."""

    samples: int = 0
    area_mm2: float = 0.0
    share: float = Field(default=0.0, description="of the target faces' area, 0 to 1")
    bodies: list[CoveringBody] = Field(default=[], description="those that cover the largest area first")
    sheets: SheetsEntry | None = None


def inside_entry(ready: Prepared, faces: Mapping[str, FaceVerdicts]) -> InsideEntry:
    """Sum up the surface that lies inside other bodies, body by body; `faces`: the verdicts of any one cutter."""
    inside, samples, part = ready.inside_bodies, ready.samples, ready.scene.part
    if not inside.any():
        return InsideEntry()
    area, share = covered(faces, samples, part)
    within, lying = float(samples.area[inside].sum()), sheets(ready)

    def of(rows: NDArray[np.int64]) -> float:
        """Area that some samples stand for, so that all of it comes to that of the faces."""
        return area * float(samples.area[rows].sum()) / within if within > 0.0 else 0.0

    sizes = [_volume(ready, body) for body in ready.conditions.around.bodies]
    bodies = [_body(ready, each, of(each.rows), sizes[each.index] >= max(sizes)) for each in coverings(ready)]
    names = ready.conditions.around.on_bodies
    told = None
    if len(lying):
        told = SheetsEntry(faces=[f"F{n}" for n in np.unique(samples.face[lying]).tolist()], samples=len(lying),
                           area_mm2=of(lying), option=f"--ignore {numbers(names)}")  # fmt: skip
    return InsideEntry(samples=int(inside.sum()), area_mm2=area, share=share, bodies=bodies, sheets=told)


def _body(ready: Prepared, found: Covering, area: float, largest: bool) -> CoveringBody:
    bodies, part = ready.conditions.around.bodies, ready.scene.part
    own = sorted(number for number in bodies[found.index].faces if number > 0)
    others = {n for i, body in enumerate(bodies) if i != found.index for n in body.faces}
    name, option = _named(part, own, others)
    return CoveringBody(
        number=1 + found.index,
        name=name,
        own_faces=numbers(own).split(","),
        faces=[f"F{n}" for n in np.unique(ready.samples.face[found.rows]).tolist()],
        samples=len(found.rows),
        area_mm2=area,
        how=found.how,
        largest=largest,
        option=option,
    )


def _volume(ready: Prepared, body: Body) -> float:
    """Volume that a body's triangles enclose, mm3."""
    certain = ready.conditions.around.certain
    triangles, mine = certain.triangles, certain.rows_of(body.faces)
    sign = weights(replace(triangles, vertex=triangles.vertex[mine], face=triangles.face[mine]), [body])
    a, b, c = np.moveaxis(triangles.vertex[mine], 1, 0)
    return abs(float((sign * (np.cross(a, b) * c).sum(axis=1)).sum())) / 6.0


def _named(part: Part, own: Sequence[int], others: set[int]) -> tuple[str, str]:
    """The name of a body's component, and the option that leaves this body out and no other one."""
    components = component_of(part.tree)
    paths = {components.get(number, "") for number in own}
    path = next(iter(paths)).split("/") if len(paths) == 1 else []
    # The shortest end of its path that means no other one.
    for name in ("/".join(path[i:]) for i in reversed(range(len(path)))):
        if name and faces_of(part.tree, name) == set(own) and not others & set(own):
            return name, f"--ignore {shlex.quote(f'component:{name}')}"
    # What two bodies have in common closes the other one.
    return "", f"--ignore {numbers([n for n in own if n not in others] or own)}"


def numbers(faces: Sequence[int]) -> str:
    """Face numbers as the command takes them.

    >>> numbers([7, 8, 9, 12])
    'F7-9,F12'
    """
    return ",".join(_runs(sorted(faces)))


def _runs(faces: Sequence[int]) -> Iterator[str]:
    for _, run in groupby(enumerate(faces), lambda each: each[1] - each[0]):
        mine = [number for _, number in run]
        yield f"F{mine[0]}" if len(mine) == 1 else f"F{mine[0]}-{mine[-1]}"
