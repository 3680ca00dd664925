"""Sharp inside edges of parts whose edges are known."""

import math

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopoDS import TopoDS

from cad_io import Part
from cad_io.kernel import explore
from cad_io.part.bodies import orient
from cad_io.part.edges import inside_edges
from tests.support.cad_parts import ball, box, cut, drilled, mirror, moved, pocketed, rod
from tests.support.profiles import grooved, slotted


def edges_of(shape):
    part = Part(shape)
    return inside_edges(part, orient(part))


def boxy(x=40.0, y=30.0, depth=12.0):
    return cut(box(60, 50, 20), box(x, y, 20, (10, 10, 20 - depth)))


def test_a_pocket_has_its_floor_and_its_corners():
    edges = edges_of(boxy())
    assert np.allclose(sorted(edge.length for edge in edges), [12] * 4 + [30] * 2 + [40] * 2, atol=1e-3)
    for edge in edges:
        assert np.allclose(edge.angle, math.pi / 2)
        assert not edge.curvature.any()


@pytest.mark.parametrize(
    "shape", [box(), ball(), rod(), drilled(), pocketed()], ids=["box", "ball", "rod", "hole", "round pocket"]
)
def test_outside_edges_and_seams_are_none(shape):
    assert edges_of(shape) == ()


def test_fillets_are_none():
    """Every edge of the pocket is rounded: what is left are edges across which the surface goes on."""
    shape = boxy()
    fillet = BRepFilletAPI_MakeFillet(shape)
    for edge in explore(shape, TopAbs_EDGE):
        fillet.Add(3.0, TopoDS.Edge_s(edge))
    assert edges_of(fillet.Shape()) == ()


@pytest.mark.parametrize("degrees", [10.0, 60.0, 90.0, 150.0, 175.0])
def test_a_groove_has_its_opening_angle(degrees):
    (edge,) = edges_of(grooved(math.radians(degrees)))
    assert np.allclose(np.degrees(edge.angle), degrees, atol=1e-6)
    assert edge.length == pytest.approx(40.0, rel=1e-4)
    # The faces leave the bottom upwards, and their normals point into the air between them.
    assert (edge.inward[:, :, 2] > 0).all()
    assert (edge.normal[:, :, 2] > 0).all()


def test_a_groove_that_is_all_but_flat_is_smooth():
    assert edges_of(grooved(math.radians(178.0), depth=0.5)) == ()


def test_a_dovetail_has_two():
    edges = edges_of(slotted(40, 40 - 2 * 12 / math.tan(math.radians(60))))
    assert [round(float(np.degrees(edge.angle.mean())), 6) for edge in edges] == [60.0, 60.0]


def test_a_sheet_has_none_at_its_border():
    part = Part(Part(boxy()).face(11))
    assert inside_edges(part, orient(part)) == ()


@pytest.mark.parametrize("transform", [moved(), mirror()], ids=["moved", "mirrored"])
def test_the_same_wherever_the_part_stands(transform):
    edges = edges_of(BRepBuilderAPI_Transform(boxy(), transform, True).Shape())
    assert len(edges) == 8
    assert all(np.allclose(edge.angle, math.pi / 2) for edge in edges)


def test_curvature_across_a_hole_at_its_floor():
    """Where the wall of a blind hole meets its floor, both are straight across the edge; in a round pocket with a flat side, the
    round one rises.
    """
    (edge,) = edges_of(cut(box(30, 30, 20), rod(6, 20, (15, 15, 8))))
    assert np.allclose(edge.curvature, 0.0, atol=1e-9)
    assert edge.length == pytest.approx(12 * math.pi, rel=1e-3)
    edges = edges_of(cut(box(30, 30, 20), cut(ball(8, (15, 15, 20)), box(30, 30, 40, (18, 0, 0)))))
    assert sum(edge.length for edge in edges) == pytest.approx(math.sqrt(8**2 - 3**2) * math.pi, rel=1e-3)
    for edge in edges:
        assert np.allclose(np.sort(edge.curvature, axis=0), [[0.0], [1 / 8]], atol=1e-9)
