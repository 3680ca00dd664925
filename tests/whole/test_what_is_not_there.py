"""Nothing unseen counts as air: obstacles that are missing, a tolerance that is too coarse, numbers that are none."""

import json
import math
import os
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Pnt
from OCP.Poly import Poly_Triangle, Poly_Triangulation
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face

from cad_io import read_part
from cad_io.arrays import Triangles
from cad_io.kernel import faces as faces_of
from cad_io.tessellate import tessellate
from plan_cutters import Cutter, plan, posture_map
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.verdicts import ACCESSIBLE, blank
from plan_cutters.errors import UnjudgeableError
from plan_cutters.kernels.maps import free_tilts
from plan_cutters.kernels.material import sheet
from plan_cutters.kernels.rows import Contacts, Tree
from plan_cutters.kernels.search import search
from plan_cutters.scene.conditions import Conditions, Context, search_postures, tool_of, verdict_arrays_of
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings, surroundings
from tests.support import shapes, waves
from tests.support.bodies import SMALL, judged, lidded, reached, within
from tests.support.cad_parts import ball, box, compound, triangulated
from tests.support.forked import run
from tests.support.reference import random_frame

# --- obstacles that are missing -------------------------------------------------------------------------------------------


def test_a_lid_of_triangles_is_in_the_way_but_not_for_sure():
    real = judged(compound(box(40, 40, 10), box(80, 80, 2, at=(-20, -20, 13))), faces="6", grid=4)
    meshed = judged(lidded(), faces="6", grid=4)
    assert not reached(real).any()
    assert not reached(meshed).any()
    entry = meshed.cutters[0]
    assert (entry.undecided, entry.feasible, meshed.selected) == (16, None, None)
    assert {(m.face, m.stand_in) for m in meshed.plan.missing} == {(f"F{n}", "triangles") for n in range(7, 13)}
    point = posture_map(meshed.part, point=(20, 20, 10), cutter=SMALL, rotations=[0.0])
    assert not point.certified
    assert len(point.free[0]) == 0
    assert len(point.undecided[0])
    assert len(point.missing) == 6


def test_what_is_missing_far_away_leaves_the_verdict_in_doubt(tmp_path):
    path = tmp_path / "part.brep"
    BRepTools.Write_s(lidded(gap=500.0), str(path))
    done = run(str(path), "--faces", "6", "--grid", "4", "--cutter", "R2L30", "--area-budget", "0", "-o", str(tmp_path / "out"),
               "--formats", "json", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 4
    assert "Missing obstacle: F7 (" in done.stdout
    document = json.loads((tmp_path / "out" / "plan.json").read_text())
    assert [c["feasible"] for c in document["cutters"]] == [None]
    assert document["selected"] is None
    assert document["cutters"][0]["interference_free"] == 16


def test_a_cutter_within_a_box_of_triangles_is_not_free():
    """A skin of triangles that closes up encloses: the cutter does not fit through, but fits within."""
    hood = triangulated(box(80, 80, 60, at=(-20, -20, 9)))
    cutter = Cutter.flat(radius=2, length=10)
    result = judged(compound(box(40, 40, 10), hood), faces="6", grid=4, cutter=cutter)
    assert not reached(result).any()
    one = posture_map(result.part, point=(20, 20, 10), cutter=cutter, rotations=[0.0])
    assert [len(one.free[0]), len(one.buried[0])] == [0, 0]
    assert one.undecided[0][0, 0] == 0.0


def hood(shift=0.0, drop=0, twice=False, size=(40, 40, 40), at=(20, 20, 20)):
    """A box of single triangles, each with nodes of its own, moved at random."""
    mesh = triangulated(box(*size, at=at))
    rng = np.random.default_rng(4)
    made = []
    for face in faces_of(mesh):
        old = BRep_Tool.Triangulation_s(face, TopLoc_Location())
        for k in range(1, old.NbTriangles() + 1):
            one = Poly_Triangulation(3, 1, False)
            for j, node in enumerate(old.Triangle(k).Get(), 1):
                x, y, z = np.add(old.Node(node).Coord(), shift * rng.standard_normal(3))
                one.SetNode(j, gp_Pnt(x, y, z))
            one.SetTriangle(1, Poly_Triangle(1, 2, 3))
            only = TopoDS_Face()
            BRep_Builder().MakeFace(only, one)
            made.append(only)
    made = made[drop:]
    return compound(*made, *([BRepBuilderAPI_Copy(face).Shape() for face in made] if twice else []))


@pytest.mark.parametrize(
    "more", [{}, {"shift": 1e-7}, {"shift": 1e-5}, {"drop": 1}, {"twice": True}],
    ids=["exact", "nodes apart", "nodes farther apart", "a triangle missing", "twice"],
)  # fmt: skip
def test_no_cutter_is_safe_within_a_hood_of_triangles(more):
    result = judged(compound(box(80, 80, 20), hood(**more)), faces="6", grid=9, cutter=Cutter.flat(radius=2, length=12))
    assert within(result, (20, 20, 20), (60, 60, 60)) == []
    assert reached(result).sum() > 40
    assert result.cutters[0].inaccessible == 0


def test_a_face_that_cannot_be_meshed_stands_as_its_box(monkeypatch):
    """Our own start fails on it, and the kernel's mesher never ends."""
    from cad_io.tessellate import mesh, start

    own = start.own_start

    def never(*_):
        while True:
            pass

    monkeypatch.setattr(start, "own_start", lambda part, n, chord: None if n == 7 else own(part, n, chord))
    monkeypatch.setattr(mesh, "under_mesh", never)
    monkeypatch.setattr(start, "_SECONDS", 1.0)
    # The lower face of a lid 3 mm above the plate.
    lid = shapes.plane((-20, 60), (-20, 60), origin=(0, 0, 13))
    result = judged(compound(box(40, 40, 10), lid), faces="6", grid=4)
    assert result.cutters[0].undecided == 16
    assert result.cutters[0].feasible is None
    assert [(m.face, m.stand_in) for m in result.plan.missing] == [("F7", "box")]
    assert "does not end on it" in result.plan.missing[0].why


def test_a_face_without_area_hides_nothing_and_leaves_no_doubt():
    sliver = shapes.plane((0, 30), (0, 1e-12), origin=(0, 0, 30))
    result = judged(compound(box(40, 40, 10), sliver), faces="6", grid=4)
    assert result.part.faces[6].unjudged == "has no area"
    assert result.plan.missing == []
    # It is in the way all the same, as a line.
    found = surroundings(result.part, 0.002)
    assert 7 in found.possible.triangles.face
    assert 7 not in found.certain.triangles.face


# --- tolerance -------------------------------------------------------------------------------------------------------------


def test_a_tolerance_that_was_raised_is_held_against_the_cutter(monkeypatch):
    from plan_cutters.scene import surroundings as gathered

    monkeypatch.setattr(gathered, "tessellate", partial(tessellate, budget=40))
    part, thin = read_part(ball(50)), Cutter.flat(radius=0.5, length=20)
    result = plan(part, cutters=[thin, Cutter.flat(radius=20, length=200)], faces="all", grid=6, area_budget=0)
    assert result.plan.effective.tolerance_mm > 4 * 0.5
    entry = next(c for c in result.cutters if c.id == thin.id)
    assert (entry.interference_free, entry.accessible, entry.inaccessible) == (0, 0, 0)
    assert entry.undecided_by_reason["tolerance"] == entry.undecided > 0
    assert entry.feasible is None
    found = posture_map(part, point=(0, 0, 50), cutter=thin, rotations=[0.0])
    assert not found.certified
    assert len(found.free[0]) == 0
    assert found.undecided[0] == pytest.approx(np.array([[0, math.pi / 2]]))


# --- numbers that are none --------------------------------------------------------------------------------------------------


def scene():
    rng = np.random.default_rng(3)
    vertex = np.ascontiguousarray(rng.uniform(-2, 2, (300, 1, 3)) + rng.normal(0, 0.3, (300, 3, 3)) + (0, 0, 4))
    normal, direction = random_frame(rng)
    return waves.tree_of(vertex), normal, direction


def spoilt(array):
    """The array with each of its numbers replaced by nan in turn."""
    for i in range(array.size):
        bad = np.array(array, float)
        bad.reshape(-1)[i] = np.nan
        yield bad


def test_kernels_take_what_is_no_number_for_a_hit():
    near, n, e1 = scene()
    far = sheet(Tree(near.vertex + 1e6, near.box + np.array([1e6] * 3 + [0.0] * 13), near.depth))
    one, p, straight = np.zeros(1, np.int64), np.zeros(3), np.zeros((1, 2))
    small = assembly(SMALL, 0.01, 0.01)
    tool, inner_tool, dummy = tool_of(small), tool_of(assembly(SMALL, 0.02, 0.02)), small.dummy
    tried = 0
    for point, normal, tilt_direction in [
        *((x, n, e1) for x in spoilt(p)), *((p, x, e1) for x in spoilt(n)), *((p, n, x) for x in spoilt(e1)),
    ]:  # fmt: skip
        free = np.ones(1, bool)
        search.dummy_clear(one, Contacts(point[None], normal[None], tilt_direction[None], straight), dummy, tool, far, free)
        if tilt_direction is e1:
            assert not free[0]
        triangle = np.full(1, -1, np.int32)
        search.probe(
            one, point[None], normal[None], normal[None], tilt_direction[None], tool, far.tree, triangle, triangle.copy()
        )
        # What has no tilt touches nowhere, which is no way clear either.
        assert triangle[0] >= 0 or triangle[0] == -2
        parts = free_tilts.free_tilts(point, normal, tilt_direction, 0.0, 1.5, tool, 0, 1e-3, far.tree, 2000)
        assert not (parts[:, 2] == free_tilts.OPEN).any()
        out = blank(1)
        contact = Contacts(point[None], normal[None], tilt_direction[None], straight)
        search.search(one, contact, waves.ranges(np.zeros(1)), tool, inner_tool, far, far, verdict_arrays_of(out))
        assert out.verdict[0] != ACCESSIBLE
        tried += 1
    assert tried == 9
    # The same calls with good numbers find the way clear: what was seen above is the nan.
    free = np.zeros(1, bool)
    search.dummy_clear(one, Contacts(p[None], n[None], e1[None], straight), dummy, tool, far, free)
    assert free[0]


def test_the_door_refuses_what_is_no_number():
    near, n, e1 = scene()
    good = Triangles(near.vertex, np.ones(len(near.vertex), np.int32), 0.001, ())
    with pytest.raises(UnjudgeableError):
        Obstacles(replace(good, vertex=good.vertex[:0], face=good.face[:0]))
    bad = good.vertex.copy()
    bad[7, 1, 2] = np.nan
    with pytest.raises(UnjudgeableError):
        Obstacles(replace(good, vertex=bad))
    with pytest.raises(UnjudgeableError):
        Obstacles(replace(good, chord_error=math.nan))
    conditions = Conditions(Machine(), np.array([0, 0, 1.0]), PostureRange(), Surroundings.sheet(Obstacles(good)), 0.01, 1)
    context = Context.of(SMALL, conditions)
    contact = Contacts(np.zeros((1, 3)), n[None], e1[None], np.zeros((1, 2)))
    for which in range(4):
        broken = list(contact)
        broken[which] = next(spoilt(contact[which]))
        with pytest.raises(ValueError, match="finite"):
            search_postures(Contacts(*broken), np.zeros(1, np.int64), context, blank(1))
    search_postures(contact, np.zeros(1, np.int64), context, blank(1))


# --- the compiler's cache ----------------------------------------------------------------------------------------------------

_WHERE = """
import os, sys
environment = dict(os.environ)
{first}
{second}
import numba
from plan_cutters.kernels import jit
from plan_cutters.kernels.tool import arcs
mine = numba.njit(cache=True)(len)
assert dict(os.environ) == environment, "the environment was changed"
folders = {{f._cache._impl.locator.get_cache_path() for f in (arcs.point_arc, arcs.local_gouge)}}
assert len(folders) == 1
print(folders.pop())
print(numba.config.CACHE_DIR)
"""


@pytest.mark.parametrize("first", ["import numba", "import plan_cutters.kernels.tool.arcs"])
def test_machine_code_of_other_sources_is_never_run(first, tmp_path):
    """Whoever imports the compiler first, ours lies in the folder of just these sources, and the host's elsewhere."""
    text = _WHERE.replace("mine = numba.njit(cache=True)(len)\n", "").format(
        first=first, second="import plan_cutters.kernels.tool.arcs"
    )
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    environment |= {"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    ours, theirs = done.stdout.splitlines()[:2] if done.stdout.count("\n") > 1 else (done.stdout.strip(), "")
    assert Path(ours).parent == tmp_path / "plan-cutters" / "plan_cutters.kernels.tool.arcs"
    assert theirs == ""
