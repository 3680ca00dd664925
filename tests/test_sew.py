"""Joining loose faces: the first tolerance that closes, what stays open, and samples linked across what was joined."""

import math

import numpy as np
import pytest
from cad_parts import box, compound, drilled, loose, patch, real
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.Geom import Geom_SphericalSurface
from OCP.gp import gp_Ax3
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face

from cad_io import read_part
from cad_io.kernel import explore, faces
from cad_io.part.orient import orient
from cad_io.part.sew import MOST, RUNGS, sew
from cad_io.sample import sample

DIAGONAL = 10 * np.sqrt(3)


def rounded():
    solid = box()
    fillet = BRepFilletAPI_MakeFillet(solid)
    for edge in explore(solid, TopAbs_EDGE):
        fillet.Add(2.0, TopoDS.Edge_s(edge))
    return fillet.Shape()


@pytest.mark.parametrize(("gap", "rung"), [(0.0, 0), (1e-4, 1), (1e-3, 2), (0.01, 3)])
def test_the_first_tolerance_that_closes_is_kept(gap, rung):
    part = read_part(loose(box(), gap))
    sewn = part.sewn
    assert sewn.tolerance == sewn.tried == pytest.approx(RUNGS[rung] * np.linalg.norm(part.size))
    assert (sewn.open_edges, sewn.open_length) == (0, 0.0)
    assert orient(part).confident


def test_what_does_not_close_stays_open_and_is_measured():
    apart = read_part(loose(box(), 0.5))
    assert apart.sewn.tried == pytest.approx(RUNGS[-1] * np.linalg.norm(apart.size))
    assert apart.sewn.open_edges > 0
    assert not orient(apart).confident
    lidless = read_part(compound(*faces(loose(box()))[:5])).sewn
    assert (lidless.tolerance, lidless.open_edges) == (pytest.approx(RUNGS[0] * DIAGONAL), 4)
    assert lidless.open_length == pytest.approx(40)
    alone = read_part(patch()).sewn
    assert (alone.tolerance, alone.tried, alone.open_edges) == (None, None, 4)


def test_no_tolerance_is_above_the_most():
    big = loose(box(1000, 1000, 1000), 0.5)
    assert read_part(big).sewn.tried == MOST


def test_solids_and_closed_shells_need_no_joining():
    part = read_part(compound(drilled(), box(at=(50, 0, 0))))
    assert part.sewn == type(part.sewn)({}, None, None, 0, 0.0)
    mixed = read_part(compound(drilled(), loose(box(at=(50, 0, 0)))))
    assert set(mixed.sewn.faces) == set(range(8, 14))
    assert mixed.sewn.open_edges == 0


def test_the_part_is_not_changed_by_joining():
    part = read_part(loose(box(), 0.01))

    def edges():
        return [
            (edge.TShape(), BRep_Tool.Tolerance_s(TopoDS.Edge_s(edge))) for edge in explore(part.shape, TopAbs_EDGE)
        ]

    before = edges()
    assert sew(part.shape, faces(part.shape), math.hypot(*part.size)).open_edges == 0
    assert edges() == before
    assert not part.closed


def test_faces_that_cannot_be_judged_do_not_stop_joining():
    builder = BRep_Builder()
    bare, edgeless = TopoDS_Face(), TopoDS_Face()
    builder.MakeFace(bare)
    builder.MakeFace(edgeless, Geom_SphericalSurface(gp_Ax3(), 3.0), TopLoc_Location(), 1e-6)
    part = read_part(compound(loose(box()), bare, edgeless))
    assert part.sewn.open_edges == 0
    assert set(np.abs(orient(part).sign)) == {1.0}


def links(shape):
    """Pairs of faces with samples linked across their common edge."""
    part = read_part(shape)
    samples = sample(part, orient(part), spacing=1.0, faces=range(1, len(part.faces) + 1))
    pairs = np.sort(samples.face[samples.neighbours], axis=1)
    return {tuple(pair) for pair in pairs[pairs[:, 0] != pairs[:, 1]].tolist()}


def test_samples_are_linked_across_joined_faces_as_in_a_solid():
    assert len(links(rounded())) == 48  # 24 between sides and edges, 24 between edges and corners
    assert links(loose(rounded())) == links(rounded())
    assert links(loose(drilled())) == set()


@pytest.mark.parametrize(
    ("path", "share", "edges"),
    [
        *((path, 1e-4, 0) for path in real("asitus_ANC101-ill.stp")),
        *((path, None, 4) for path in real("bladex_upper.iges", "tigl_nacelle.stp")),
        *((path, None, 0) for path in real("tigl_D150_wing.igs", "asitus_wavy-cube.stp")),
    ],
    ids=lambda x: getattr(x, "name", ""),
)
def test_real_files_on_the_ladder(path, share, edges):
    part = read_part(path)
    assert part.sewn.open_edges == edges
    expected = share and pytest.approx(share * np.linalg.norm(part.size))
    assert part.sewn.tolerance == expected
