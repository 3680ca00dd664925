"""A face that is no part of a sound surface is refused before it is sampled, and its area counts for nothing."""

import math

import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepPrimAPI import BRepPrimAPI_MakeTorus
from OCP.Geom import Geom_ConicalSurface, Geom_Line, Geom_SurfaceOfRevolution
from OCP.gp import gp_Ax1, gp_Ax3, gp_Circ, gp_Dir, gp_Pln, gp_Pnt

from cad_io import read_part
from cad_io.part.bodies import bodies, orient
from cad_io.part.edges import folded_faces
from cad_io.part.part import CROSSES, ROUND_TWICE
from cad_io.sample import sample
from tests.support.cad_parts import ball, box, compound, cone, ring
from tests.support.turned import elbow, from_step, revolved_arc


def reasons(shape):
    return [face.unjudged for face in read_part(shape).faces]


def test_a_curve_of_revolution_that_crosses_its_axis_crosses_itself(tmp_path):
    part = read_part(from_step(revolved_arc(2.0), tmp_path))
    (face,) = part.faces
    assert face.unjudged == CROSSES
    assert face.area == 0.0
    assert part.measure(1).area == pytest.approx(744.7, rel=1e-3)
    samples = sample(part, orient(part), grid=5, faces=[1])
    assert len(samples) == 0
    assert samples.empty == ((1, CROSSES),)


def test_a_cone_beyond_its_apex_and_a_torus_through_itself_do_so_too():
    surface = Geom_ConicalSurface(gp_Ax3(), 0.5, 2.0)
    both = BRepBuilderAPI_MakeFace(surface, 0.0, 2 * math.pi, -10.0, 10.0, 1e-7).Face()
    assert reasons(both) == [CROSSES]
    torus = BRepBuilderAPI_MakeFace(read_part(ring(5.0, 2.0)).adaptor(1).Torus(), 0.0, 6.0, 0.0, 6.0).Face()
    assert reasons(torus) == [None]


@pytest.mark.parametrize("shape", [ball, cone, ring, lambda: revolved_arc(2.0), lambda: revolved_arc(8.0), elbow,
                                   lambda: BRepPrimAPI_MakeTorus(20.0, 5.0).Shape()])  # fmt: skip
def test_what_ends_on_its_axis_does_not_cross_it(shape):
    assert set(reasons(shape())) == {None}


def test_a_line_that_passes_the_axis_at_a_distance_does_not_cross_it():
    line = Geom_Line(gp_Pnt(2.0, 0.0, 0.0), gp_Dir(0.0, 1.0, 1.0))
    surface = Geom_SurfaceOfRevolution(line, gp_Ax1(gp_Pnt(), gp_Dir(0, 0, 1)))
    assert reasons(BRepBuilderAPI_MakeFace(surface, 0.0, 2 * math.pi, -10.0, 10.0, 1e-7).Face()) == [None]


def test_the_rest_of_an_elbow_folds_back_onto_its_tubes(tmp_path):
    for shape, folds in ((elbow(), False), (from_step(elbow(), tmp_path), True)):
        part = read_part(shape)
        turned = [face.number for face in part.faces if face.surface == "revolution"]
        assert bool(folded_faces(part, turned)) == folds


def disc_bounded_twice():
    face = BRepBuilderAPI_MakeFace(
        gp_Pln(), BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax3().Ax2(), 4.0)).Edge()).Wire()
    ).Face()
    again = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax3().Ax2(), 4.0)).Edge()).Wire()
    BRep_Builder().Add(face, again)
    return face


def test_a_border_that_runs_round_twice_bounds_nothing():
    (face,) = read_part(disc_bounded_twice()).faces
    assert (face.unjudged, face.area) == (ROUND_TWICE, 0.0)


def test_sides_do_not_follow_from_a_face_that_is_not_believed(tmp_path):
    whole = from_step(compound(box(10, 10, 10, (20, 0, 0)), revolved_arc(2.0)), tmp_path)
    part = read_part(whole)
    assert part.unmeasured == {7}
    found = orient(part)
    assert not found.confident
    assert found.sign[:6].tolist() == orient(read_part(box(10, 10, 10, (20, 0, 0)))).sign.tolist()
    assert [7 in body.faces for body in bodies(part) if body.closed] == [False]


def test_no_area_is_negative_or_unknown(tmp_path):
    for shape in (disc_bounded_twice(), from_step(revolved_arc(2.0), tmp_path), from_step(revolved_arc(8.0), tmp_path)):
        areas = np.array([face.area for face in read_part(shape).faces])
        assert np.isfinite(areas).all()
        assert (areas >= 0.0).all()
