"""Parts that hold triangles instead of surfaces, as tessellated AP242 does: said, and the rest planned."""

import json

import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_Plane
from OCP.gp import gp_Ax3, gp_Pln
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Controller
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face

from cad_io import read_part
from cad_io.part.bodies import orient
from tests.support.cad_parts import ball, box, compound, triangulated
from tests.support.commands import assert_one_line, in_lines
from tests.support.forked import run

REASON = "holds only triangles, no surface"


def write_step(shape, path):
    STEPCAFControl_Controller.Init_s()
    before = Interface_Static.CVal_s("write.step.schema")
    try:
        Interface_Static.SetCVal_s("write.step.schema", "AP242DIS")
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_AsIs)
        writer.Write(str(path))
    finally:
        Interface_Static.SetCVal_s("write.step.schema", before)
    assert "TRIANGULATED_FACE" in path.read_text()
    return path


def write_brep(shape, path):
    BRepTools.Write_s(shape, str(path))
    return path


@pytest.mark.parametrize("write", [write_step, write_brep])
def test_faces_of_triangles_say_so(tmp_path, write):
    part = read_part(write(compound(box(at=(30, 0, 0)), triangulated(ball())), tmp_path / "part"))
    assert [face.unjudged for face in part.faces[:6]] == [None] * 6
    assert [REASON in face.unjudged for face in part.faces[6:]] == [True]
    # They have no side, so they take nothing from what is sure.
    assert orient(part).confident


def test_a_part_of_triangles_is_refused_with_its_cause(tmp_path):
    write_step(triangulated(box()), tmp_path / "mesh.step")
    assert_one_line(run("mesh.step", "--cutter", "R3L40", cwd=tmp_path), 3, "mesh.step", REASON)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["mesh.step"]


def test_the_rest_of_a_part_is_planned(tmp_path):
    write_step(compound(box(at=(30, 0, 0)), triangulated(ball())), tmp_path / "some.step")
    done = run("some.step", "--cutter", "R3L40", "--grid", "4", "--area-budget", "0", "--formats", "json,step", cwd=tmp_path)
    assert done.returncode == 4, done.stderr
    assert f"Not judged: F7 ({REASON}" in in_lines(done.stdout)
    plan = json.loads((tmp_path / "some-plan" / "plan.json").read_text())
    assert [bool(face["unjudged"]) for face in plan["faces"]] == [False] * 6 + [True]
    cutter = plan["cutters"][0]
    assert plan["samples"]["count"] == 96
    # The ball of triangles stands in the way of one side, and may be nearer than its triangles: nothing is sure beyond doubt.
    assert (cutter["interference_free"], cutter["inaccessible"], cutter["feasible"]) == (80, 0, None)
    assert [m["stand_in"] for m in plan["missing"]] == ["triangles"]
    written = read_part(tmp_path / "some-plan" / "annotated.step").faces
    assert [face.unjudged is None for face in written] == [True] * 6 + [False]


def test_faces_without_area_or_edges_do_not_stop_the_rest(tmp_path):
    builder, edgeless = BRep_Builder(), TopoDS_Face()
    builder.MakeFace(edgeless, Geom_Plane(gp_Ax3()), TopLoc_Location(), 1e-6)
    speck = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, 1e-6, 0.0, 1e-6).Face()
    write_brep(compound(box(at=(30, 0, 0)), speck, edgeless), tmp_path / "part.brep")
    done = run(
        "part.brep", "--faces", "all", "--cutter", "R3L40", "--grid", "4", "--area-budget", "0", "--formats", "json", cwd=tmp_path
    )
    assert done.returncode == 4, done.stderr
    assert "Not judged: F7 (has no area)." in done.stdout
    assert "Not judged: F8 (has no edges and no end: bound it)." in done.stdout
    plan = json.loads((tmp_path / "part-plan" / "plan.json").read_text())
    assert plan["samples"]["count"] == 96
