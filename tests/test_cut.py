"""Cutting: a solid by its skin as the kernel cuts it whole, threads change no byte, nothing is tried twice."""

import io
from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Solid
from split_parts import block, labels, patch, waves

from cad_io.kernel import faces
from cad_io.kernel.components import children
from cad_io.kernel.limited import KERNEL_THREADS
from cad_io.part import Part
from cad_io.split import cut as module
from cad_io.split import cut_faces
from cad_io.split.contour import LabelGrid, smoothed
from cad_io.split.cut import Cut, Fault
from cad_io.split.pieces import split


def hollow():
    """A box with a ball-shaped void: a solid of two shells."""
    return BRepAlgoAPI_Cut(
        BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 40, 40, 40).Shape(), BRepPrimAPI_MakeSphere(gp_Pnt(20, 20, 20), 12).Shape()
    ).Shape()


def drilled():
    axis = gp_Ax2(gp_Pnt(20, 15, -5), gp_Dir(0, 0, 1))
    return BRepAlgoAPI_Cut(
        BRepPrimAPI_MakeBox(40, 30, 20).Shape(), BRepPrimAPI_MakeCylinder(axis, 8, 40).Shape()
    ).Shape()


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


def summary(part, found):
    """What must not depend on how a solid was cut."""
    pieces = sorted((p.face, p.label, round(measured(p.shape, BRepGProp.SurfaceProperties_s), 6)) for p in found.pieces)
    shells = Counter(len(faces(shell)) for shell in module.explore(found.shape, TopAbs_SHELL))
    return pieces, shells, found.whole, round(measured(found.shape, BRepGProp.VolumeProperties_s), 4)


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_is_cut_by_its_skin_as_the_kernel_cuts_it_whole(name, monkeypatch):
    part = Part(solid_of(SOLIDS[name]()))
    fields = [labels(part, f.number, waves(f.number), n=25) for f in part.faces]
    by_skin = split(part, fields)
    assert module._skin(part.shape) is not None
    assert by_skin.shape.ShapeType() == TopAbs_SOLID
    assert BRepCheck_Analyzer(by_skin.shape).IsValid()
    assert len(by_skin.pieces) > len(part.faces)
    monkeypatch.setattr(module, "_skin", lambda shape: None)
    assert summary(part, by_skin) == summary(part, split(part, fields))


def test_what_is_no_plain_solid_has_no_skin():
    shell = children(solid_of(drilled()))[0]
    assert module._skin(shell) is None
    assert module._skin(patch()) is None
    builder, twice = BRep_Builder(), TopoDS_Solid()
    builder.MakeSolid(twice)
    for each in (shell, shell.Reversed()):
        builder.Add(twice, each)
    assert module._skin(twice) is None


def test_threads_of_the_kernel_change_no_byte():
    part = Part(block(2))
    fields = [labels(part, f.number, lambda x, y: x > 0.45) for f in part.faces]

    def written(threads):
        token = KERNEL_THREADS.set(threads)
        try:
            stream = io.BytesIO()
            BinTools.Write_s(split(part, fields).shape, stream)
        finally:
            KERNEL_THREADS.reset(token)
        return stream.getvalue()

    assert written(1) == written(2)


@pytest.mark.parametrize("spoilers", [(), (3,), (2, 5), (1, 2, 3, 4, 5, 6)])
def test_no_cut_is_tried_twice_and_only_spoilers_are_left(spoilers, monkeypatch):
    """On a pretended kernel that fails as soon as a spoiler is among the faces."""
    part = Part(BRepPrimAPI_MakeBox(10, 10, 10).Solid())
    drawn = {n: SimpleNamespace(edges=[n], draw=lambda fit: "", differs=lambda pieces: "") for n in range(1, 7)}
    asked = []

    def cut(jobs, seconds):
        asked.extend((id(job.shape), frozenset(job.edges), frozenset(job.rough.items())) for job in jobs)
        bad = [set(job.edges) & set(spoilers) for job in jobs]
        return [
            Fault("spoilt") if b else Cut(job.shape, {n: [f] for n, f in job.faces.items()})
            for b, job in zip(bad, jobs, strict=True)
        ]

    monkeypatch.setattr(cut_faces, "cut", cut)
    faces_of = {info.number: part.face(info.number) for info in part.faces}
    _, _, failed = cut_faces.cut_faces(part.shape, faces_of, drawn, 10, cut_faces.Effort(work=10**9))
    assert failed == dict.fromkeys(spoilers, "spoilt")
    # Alone, a face is tried with every fit of its curves.
    most = Counter(asked)
    assert all(count <= len(cut_faces.FITS) for count in most.values())
    assert all(count == 1 for (_, edges, _), count in most.items() if not edges & set(spoilers))


def test_lines_of_many_grids_are_those_of_each_alone():
    rng = np.random.default_rng(0)
    line = np.arange(12.0)
    grids = [
        LabelGrid(line, line, rng.integers(0, 3, (12 - closed, 12)).astype(np.int32), np.ones((12 - closed, 12), bool),
                  bool(closed), False)
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
