"""Cutting: solids of any make stay what they were, hard arrangements tile their faces, the bytes repeat."""

import os
import subprocess
import sys
from collections import Counter

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS
from scipy.interpolate import make_interp_spline

from cad_io.face.trim import uv_areas
from cad_io.kernel import cubic, edges_of, explore, faces
from cad_io.kernel.shapes import children
from cad_io.part import Part
from cad_io.split.border import parameter_curve
from cad_io.split.contour import LabelGrid, smoothed
from cad_io.split.pieces import split
from tests.support.split_parts import labels, patch, waves


def hollow():
    """A box with a ball-shaped void: a solid of two shells."""
    return BRepAlgoAPI_Cut(
        BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 40, 40, 40).Shape(), BRepPrimAPI_MakeSphere(gp_Pnt(20, 20, 20), 12).Shape()
    ).Shape()


def drilled():
    axis = gp_Ax2(gp_Pnt(20, 15, -5), gp_Dir(0, 0, 1))
    return BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(40, 30, 20).Shape(), BRepPrimAPI_MakeCylinder(axis, 8, 40).Shape()).Shape()


def moved():
    turn = gp_Trsf()
    turn.SetTranslation(gp_Vec(100, -50, 7))
    return drilled().Moved(TopLoc_Location(turn))


SOLIDS = {"drilled": drilled, "moved": moved, "turned out": lambda: drilled().Reversed(), "hollow": hollow}


def solid_of(shape):
    return shape if shape.ShapeType() == TopAbs_SOLID else children(shape)[0]


def measured(shape, of):
    found = GProp_GProps()
    of(shape, found)
    return found.Mass()


def sound(part, found, fields):
    """What always holds: nothing left whole, valid, closed as before, pieces tile their faces in the parameter plane."""
    assert found.whole == {}
    assert BRepCheck_Analyzer(found.shape).IsValid()
    after = Part(found.shape)
    assert (after.solids, after.closed) == (part.solids, part.closed)
    for f in fields:
        mine = [p for p in found.pieces if p.face == f.face]
        whole, *areas = uv_areas([part.face(f.face), *(p.shape for p in mine)])
        assert all(area > 0 for area in areas)
        assert sum(areas) == pytest.approx(whole, rel=1e-6)


@pytest.mark.slow("another solid of the same law", only=("moved", "turned out"))
@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_stays_what_it_was(name):
    part = Part(solid_of(SOLIDS[name]()))
    fields = [labels(part, f.number, waves(f.number), n=25) for f in part.faces]
    found = split(part, fields)
    sound(part, found, fields)
    assert found.shape.ShapeType() == TopAbs_SOLID
    assert len(found.pieces) > len(part.faces)
    shells = [Counter(len(faces(shell)) for shell in explore(s, TopAbs_SHELL)) for s in (part.shape, found.shape)]
    assert shells[0].total() == shells[1].total()
    volume = [measured(s, BRepGProp.VolumeProperties_s) for s in (part.shape, found.shape)]
    assert volume[1] == pytest.approx(volume[0], rel=5e-3)  # the kernel's integrals are that far off


def on(x, y, cx, cy):
    return np.degrees(np.arctan2(y - cy, x - cx))


HARD = {
    # Labels 1 and 3 with a little of 2 between: two curves a third of a cell apart.
    "beside each other": lambda x, y: np.where(x < 0.5, 0, 2) + ((np.abs(x - 0.5) < 0.02) & (np.sin(40 * y) > 0.9)),
    # Several curves from one place of the border, and from a corner.
    "a fan from the border": lambda x, y: np.digitize(on(x, y, 0.5, -1e-3), [40, 70, 110, 150]),
    "a fan from a corner": lambda x, y: np.digitize(on(x, y, 0, 0), [20, 45, 70]),
    # Islands that touch the border, or all but.
    "touching the border": lambda x, y: sum(np.hypot(x - c, y - 0.1 - 0.02 * c) < 0.1 for c in (0.15, 0.5, 0.85)),
    "along the border": lambda x, y: (y < 0.018) + 2 * (y > 1 - 0.018),
    "stripes of a cell": lambda x, y: np.floor(x * 30) % 2,
    "a chessboard": lambda x, y: (np.floor(x * 9) + np.floor(y * 9)) % 2,
}


@pytest.mark.parametrize("name", HARD)
def test_hard_arrangements_tile_their_face(name):
    part = Part(patch())
    field = labels(part, 1, HARD[name])
    found = split(part, [field])
    sound(part, found, [field])
    seen = {p.label for p in found.pieces}
    assert seen == set(np.unique(field.label)) - ({1} if name == "beside each other" else set())


#: Seeds whose fields of any size split: the escape below must not hide that nothing splits.
SOUND = range(100)


@pytest.mark.slow("splits a face by many fields; hard arrangements tile theirs in every run")
@settings(max_examples=12, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 9), st.booleans())
@example(3, 4, False)
@example(7, 8, True)
def test_any_field_of_blocks_tiles_its_face(seed, size, closed):
    part = Part(BRepPrimAPI_MakeCylinder(10, 40).Solid() if closed else patch())
    blocks = np.random.default_rng(seed).integers(0, 4, (size, size))

    def field(x, y):
        return blocks[np.minimum((x * size).astype(int), size - 1), np.minimum((y * size).astype(int), size - 1)]

    fields = [labels(part, 1, field, n=45, closed=(closed, False))]
    found = split(part, fields)
    if found.whole:
        # Of about a thousand fields one has a piece that the CAD kernel calls invalid: the face stays as it was, and is named.
        assert found.whole == {1: "a piece of it is not valid"}
        assert seed not in SOUND
        assert [p.face for p in found.pieces].count(1) == 1
        return
    sound(part, found, fields)


@pytest.mark.xfail(strict=True, reason="a piece of this field is not valid for the CAD kernel")
def test_a_field_that_is_left_whole():
    part = Part(patch())
    blocks = np.random.default_rng(2439).integers(0, 4, (6, 6))
    field = labels(part, 1, lambda x, y: blocks[np.minimum((x * 6).astype(int), 5), np.minimum((y * 6).astype(int), 5)], n=45)
    assert split(part, [field]).whole == {}


@pytest.mark.parametrize("at", [0.25, 0.5, 0.8])
def test_a_straight_boundary_is_where_it_should_be(at):
    part = Part(BRepPrimAPI_MakeBox(100, 100, 100).Solid())
    found = split(part, [labels(part, 1, lambda x, y: x > at, n=101)])
    area = {p.label: measured(p.shape, BRepGProp.SurfaceProperties_s) for p in found.pieces if p.face == 1}
    assert area[0] == pytest.approx(100 * 100 * (at + 0.005), abs=1.0)


def test_slivers_join_the_worse_label_around_them_alone():
    part = Part(patch())

    def field(x, y):
        island = ((np.abs(x - 0.25) < 0.01) & (np.abs(y - 0.5) < 0.02), (np.abs(x - 0.75) < 0.01) & (np.abs(y - 0.5) < 0.02))
        return np.where(x < 0.5, 1 + 2 * island[0], 3 - 2 * island[1])

    fields = [labels(part, 1, field, n=61)]
    assert 2 <= (fields[0].label[:20] == 3).sum() <= 3  # an island in the better label, and one in the worse
    stay = split(part, fields)
    assert (sorted(p.label for p in stay.pieces), stay.joined) == ([1, 1, 3, 3], {})
    found = split(part, fields, worst=3)
    sound(part, found, fields)
    assert (sorted(p.label for p in found.pieces), found.joined) == ([1, 3, 3], {1: 1})
    assert sorted(p.label for p in split(part, fields, worst=2).pieces) == [1, 1, 3, 3]
    worse = next(p for p in found.pieces if p.label == 3 and 1 in p.shares)
    assert 0 < worse.shares[1] < 0.01


def hurried():
    """The patch, but one of its parameter curves runs along its edge at another speed: up to 5 mm ahead."""
    face = TopoDS.Face_s(BRepBuilderAPI_Copy(patch(), False, False).Shape())
    edge = edges_of(face)[0]
    curve, first, last = parameter_curve(edge, face)
    t = np.linspace(first, last, 41)
    ahead = 0.05 * np.sin(np.pi * (t - first) / (last - first)) * (last - first)
    spline = make_interp_spline(t, np.array([curve.Value(x).Coord() for x in t + ahead]), k=3)
    place = TopLoc_Location()
    surface = BRep_Tool.Surface_s(face, place)
    BRep_Builder().UpdateEdge(edge, cubic(spline.t, spline.c), surface, place, 1e-7)
    return face


def test_an_edge_whose_parameter_curve_runs_at_another_speed():
    part = Part(hurried())
    assert not BRepCheck_Analyzer(part.shape).IsValid()
    fields = [labels(part, 1, lambda x, y: np.hypot(x - 0.5, y - 0.5) > 0.55)]  # cuts all edges, twice
    found = split(part, fields)
    sound(part, found, fields)
    assert sorted(p.label for p in found.pieces) == [0, 1, 1, 1, 1]


def test_an_edge_that_lies_off_its_face_is_said():
    face = TopoDS.Face_s(BRepBuilderAPI_Copy(patch(), False, False).Shape())
    edge = edges_of(face)[0]
    curve, first, last = BRep_Tool.Curve_s(edge, 0.0, 0.0), *BRep_Tool.Range_s(edge)
    t = np.linspace(first, last, 41)
    xyz = np.array([curve.Value(x).Coord() for x in t])
    xyz[:, 2] += 2 * np.sin(np.pi * (t - first) / (last - first))
    spline = make_interp_spline(t, xyz, k=3)
    BRep_Builder().UpdateEdge(edge, cubic(spline.t, spline.c), TopLoc_Location(), 1e-7)
    part = Part(face)
    found = split(part, [labels(part, 1, lambda x, y: np.hypot(x - 0.5, y - 0.5) > 0.55)])
    assert found.whole == {1: "an edge of it lies 2 mm off the face"}


BYTES = """
import io, sys
from OCP.BinTools import BinTools
from tests.support.split_parts import labels, patch, waves
from cad_io.part import Part
from cad_io.split import split
blocks = [bytearray(size) for size in range(1, int(sys.argv[1]), 37)]
part = Part(patch())
del blocks
stream = io.BytesIO()
found = split(part, [labels(part, f.number, waves(f.number), n=21) for f in part.faces], worst=1)
BinTools.Write_s(found.shape, stream)
import hashlib
print(hashlib.sha256(stream.getvalue()).hexdigest(), [(p.face, p.label, sorted(p.shares.items())) for p in found.pieces])
"""


@pytest.mark.slow("works on many faces")
def test_the_bytes_repeat_in_every_process(capsys):
    there = subprocess.run([sys.executable, "-c", BYTES, "70001"], check=True, capture_output=True, text=True, timeout=120,
                           env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "PYTHONHASHSEED": "22"})  # fmt: skip
    exec(BYTES.replace("sys.argv[1]", "2"), {})
    assert capsys.readouterr().out == there.stdout


def test_lines_of_many_grids_are_those_of_each_alone():
    rng = np.random.default_rng(0)
    line = np.arange(12.0)
    grids = [
        LabelGrid((line, line), rng.integers(0, 3, (12 - closed, 12)).astype(np.int32), np.ones((12 - closed, 12), bool),
                  (bool(closed), False))
        for closed in (0, 1, 0)
    ]  # fmt: skip
    together = smoothed(grids)
    assert all(len(lines) > 3 for lines in together)
    for grid, lines in zip(grids, together, strict=True):
        (alone,) = smoothed([grid])
        assert len(alone) == len(lines)
        for one, other in zip(alone, lines, strict=True):
            assert one.closed == other.closed
            assert np.array_equal(one.x, other.x)
    assert smoothed([]) == []
