"""How large do faces come back from STEP? Some surfaces of revolution that cross their axis come back as another part of it."""

import json
import os
import tempfile
from collections.abc import Mapping

from OCP.BRepGProp import BRepGProp
from OCP.GeomAbs import GeomAbs_SurfaceOfRevolution, GeomAbs_Torus
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer

from cad_io.kernel import may_refuse, silence
from cad_io.part import Part
from plan_cutters_base.forks import ChildDied, TimeLimit, limited

#: Processor seconds that it may take, and more for each face.
_SECONDS, _A_FACE = 20.0, 0.2
#: Areas that differ by a smaller share are one.
_SAME = 0.01


def changed_by_step(part: Part) -> Mapping[int, float]:
    """Faces whose area is another one once they were written as STEP and read again, with that area, mm2; it is looked for once.

    Only surfaces of revolution and tori are looked at: planes, quadrics and splines come back as they are. A face that does not
    come back at all has the area 0.
    """
    if part.changed_by_step is None:
        part.changed_by_step = _changed(part)
    return part.changed_by_step


def _changed(part: Part) -> dict[int, float]:
    numbers = [
        f.number for f in part.faces if f.area > 0.0 and f.surface in ("revolution", "torus") and _doubtful(part, f.number)
    ]
    if not numbers:
        return {}
    try:
        areas = json.loads(limited(lambda: json.dumps(_areas(part, numbers)).encode(), _SECONDS + _A_FACE * len(numbers)))
    except (TimeLimit, ChildDied):
        return {}
    return {n: there for n, (here, there) in zip(numbers, areas, strict=True) if abs(there - here) > _SAME * here}


def _doubtful(part: Part, number: int) -> bool:
    """Whether the whole surface may cross its axis: a torus does where its tube is wider than the circle about which it lies."""
    adaptor = part.adaptor(number)
    if adaptor.GetType() == GeomAbs_Torus:
        torus = adaptor.Torus()
        return bool(torus.MinorRadius() >= torus.MajorRadius())
    return bool(adaptor.GetType() == GeomAbs_SurfaceOfRevolution)


def _areas(part: Part, numbers: list[int]) -> list[tuple[float, float]]:
    """Areas of faces by the kernel, as they are and as they come back."""
    silence()
    folder, pairs = tempfile.mkdtemp(), list[tuple[float, float]]()
    file = os.path.join(folder, "face.step")
    try:
        for number in numbers:
            here, there = _area(part.face(number)), 0.0
            with may_refuse():
                writer, reader = STEPControl_Writer(), STEPControl_Reader()
                writer.Transfer(part.face(number), STEPControl_AsIs)
                if writer.Write(file) == IFSelect_RetDone and reader.ReadFile(file) == IFSelect_RetDone:
                    reader.TransferRoots()
                    there = _area(reader.OneShape())
            pairs.append((here, there))
    finally:
        if os.path.exists(file):
            os.remove(file)
        os.rmdir(folder)
    return pairs


def _area(shape: object) -> float:
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties)
    return float(properties.Mass())
