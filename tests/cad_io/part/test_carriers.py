"""What a face is a part of, against points of the face, and who its neighbours are."""

import cadquery as cq
import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.TopoDS import TopoDS_Compound

from cad_io.part import Part
from cad_io.part.bodies import orient
from cad_io.read import read_part
from cad_io.sample import sample


def solids():
    """One body for each form, and whether its round face is a boss."""
    block = cq.Workplane().box(40, 30, 20)
    return {
        "cylinder": block.cut(cq.Workplane().circle(4).extrude(50, both=True).translate((3, 2, 0))),
        "cone": cq.Workplane(cq.Solid.makeCone(12, 5, 20)),
        "sphere": block.cut(cq.Workplane().sphere(8).translate((3, 2, 12))),
        "torus": cq.Workplane(cq.Solid.makeTorus(20, 5)),
    }


OUTWARD = {"cylinder": False, "cone": True, "sphere": False, "torus": True}
TURNED = ((7.0, -3.0, 11.0), (0.3, 0.5, 0.8), 37.0)


def turned(body):
    shift, axis, angle = TURNED
    return body.rotate((0, 0, 0), axis, angle).translate(shift)


def off(shape, carrier, point):
    """Distances of points (n, 3) from a carrier, by its equation."""
    away = point - np.array(carrier.point)
    if shape == "sphere":
        return np.linalg.norm(away, axis=1) - carrier.radius
    direction = np.array(carrier.direction)
    along = away @ direction
    if shape == "plane":
        return along
    radius = np.linalg.norm(away - np.outer(along, direction), axis=1)
    if shape == "cylinder":
        return radius - carrier.radius
    if shape == "cone":
        return radius * np.cos(carrier.half_angle) - along * np.sin(carrier.half_angle)
    return np.hypot(radius - carrier.radius, along) - carrier.minor_radius


@pytest.mark.parametrize("splines", [False, True])
@pytest.mark.parametrize("shape", list(OUTWARD))
def test_points_of_a_face_lie_on_its_carrier(shape, splines):
    body = turned(solids()[shape])
    part = read_part(cq.Workplane(body.val().toNURBS()) if splines else body)
    samples = sample(part, orient(part), grid=5, faces=[f.number for f in part.faces])
    assert shape in {f.shape for f in part.faces}
    sign = orient(part).sign
    for face in part.faces:
        mine = samples.point[samples.face == face.number]
        assert len(mine)
        assert face.carrier is not None
        assert np.abs(off(face.shape, face.carrier, mine)).max() < 1e-6
        if face.shape == shape:
            assert (face.carrier.side * sign[face.number - 1] > 0) == OUTWARD[shape]


@pytest.mark.parametrize("shape", list(OUTWARD))
def test_splines_have_the_carrier_of_the_closed_form(shape):
    body = turned(solids()[shape])
    closed, free = read_part(body).faces, read_part(cq.Workplane(body.val().toNURBS())).faces
    assert [f.shape for f in closed] == [f.shape for f in free]
    assert {f.surface for f in free} == {"bspline"}
    for one, other in zip(closed, free, strict=True):
        for name in ("point", "direction", "radius", "minor_radius", "half_angle"):
            a, b = getattr(one.carrier, name), getattr(other.carrier, name)
            assert (a is None) == (b is None)
            assert a is None or np.allclose(a, b, atol=1e-6), name


def test_numbers_are_canonical():
    """A plane's point is nearest the origin, a direction's first longest component is positive, and no zero is negative."""
    for face in read_part(cq.Workplane().box(10, 20, 30).translate((5, 6, 7))).faces:
        carrier = face.carrier
        direction = np.array(carrier.direction)
        assert direction[np.abs(direction).argmax()] == 1.0
        assert np.linalg.norm(np.cross(carrier.point, direction)) == 0.0
        assert not np.signbit([*carrier.direction, *(x for x in carrier.point if x == 0.0)]).any()


def test_a_free_form_face_has_none():
    points = [[cq.Vector(x, y, np.sin(x / 4.0) * np.cos(y / 5.0)) for x in range(0, 30, 5)] for y in range(0, 30, 5)]
    part = Part(cq.Face.makeSplineApprox(points).wrapped)
    assert [(f.shape, f.carrier) for f in part.faces] == [("sculptured", None)]


def test_neighbours_are_across_edges():
    part = read_part(cq.Workplane().box(10, 20, 30))
    for face, across in zip(part.faces, part.neighbours, strict=True):
        # All but itself and the one opposite to it.
        opposite = [f.number for f in part.faces if f.carrier.direction == face.carrier.direction]
        assert sorted({*across, *opposite}) == [1, 2, 3, 4, 5, 6]
        assert not set(across) & set(opposite)
    tube = read_part(cq.Workplane().circle(5).extrude(9))
    assert [len(each) for each in tube.neighbours] in ([1, 2, 1], [2, 1, 1], [1, 1, 2])


def test_loose_faces_that_touch_are_neighbours():
    """As IGES has them: no two share an edge in the file."""
    body = cq.Workplane().box(10, 20, 30)
    builder, loose = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(loose)
    for face in body.faces().vals():
        builder.Add(loose, face.copy().wrapped)
    part = Part(loose)
    assert part.solids == 0
    assert {len(each) for each in part.neighbours} == {4}
