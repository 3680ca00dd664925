"""What stands for faces without triangles: it is where they are, and as large."""

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.gp import gp_Pln, gp_Pnt

from cad_io import read_part
from cad_io.tessellate import tessellate
from cad_io.tessellate.proxies import stand_ins
from tests.support.cad_parts import box, compound


def crossing(wide):
    """A flat face whose border crosses itself: what it encloses one way round is as large as what it encloses the other."""
    wire = BRepBuilderAPI_MakePolygon()
    for x, y in ((0, 0), (10, wide), (10, 0), (0, wide)):
        wire.Add(gp_Pnt(x, y, 0))
    wire.Close()
    return BRepBuilderAPI_MakeFace(gp_Pln(), wire.Wire()).Face()


def stood(face):
    part = read_part(compound(box(100, 100, 100), face))
    triangles = tessellate(part, 0.1)
    assert [number for number, _ in triangles.missing] == [7]
    return stand_ins(part, triangles.missing, 0.1)


def test_a_face_without_area_stands_as_its_edges():
    stand = stood(crossing(1e-6))
    assert stand.how == {7: "edges"}
    assert set(stand.face) == {7}
    assert not stand.weight.any()
    ends = {frozenset(map(tuple, np.round(each, 9))) for each in stand.vertex}
    corners = [(0, 0, 0), (10, 1e-6, 0), (10, 0, 0), (0, 1e-6, 0)]
    assert ends == {frozenset(pair) for pair in zip(corners, [*corners[1:], corners[0]], strict=True)}


def test_a_face_whose_area_is_none_because_of_its_sense_stands_as_its_box():
    stand = stood(crossing(10))
    assert stand.how == {7: "box"}
    low, high = stand.vertex.min(axis=(0, 1)), stand.vertex.max(axis=(0, 1))
    assert (low <= (0, 0, 0)).all()
    assert (high >= (10, 10, 0)).all()
    assert (stand.weight == 1).all()
