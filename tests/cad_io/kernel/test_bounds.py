"""No call of the CAD kernel runs for ever: what hangs or crashes costs its face alone, and the plan says so."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

from cad_io import read_part
from cad_io.errors import SampleError, WriteError
from cad_io.kernel import faces
from cad_io.part import coincide, sew
from cad_io.part.bodies import orient
from cad_io.part.coincide import TooMany
from cad_io.part.sew import edge_uses
from cad_io.sample import at_point, locate, nearest
from cad_io.split import split
from cad_io.tessellate.triangles import tessellate
from cad_io.write import step
from plan_cutters import plan
from plan_cutters_base.forks import Ended, each
from tests.support.cad_parts import box, compound, loose
from tests.support.places import ROOT

GROOVE = ROOT / "samples" / "v_groove.step"


def spin(*_, **__):
    while True:
        pass


def crash(*_, **__):
    os.kill(os.getpid(), signal.SIGSEGV)


# --- one thing after another -----------------------------------------------------------------------------------------


def test_each_gives_what_the_calls_give_in_their_order():
    assert list(each(lambda n: n * b"x", range(5), seconds=5.0)) == [n * b"x" for n in range(5)]
    assert list(each(lambda n: b"x" * n, [3_000_000, 1], seconds=5.0)) == [b"x" * 3_000_000, b"x"]
    assert list(each(spin, [], seconds=5.0)) == []


@pytest.mark.parametrize(("fault", "said"), [(spin, "does not come to an end within 0.3 s"), (crash, "crashes")])
def test_an_item_that_never_ends_costs_itself_alone(fault, said):
    def call(n):
        return fault() if n == 2 else n

    found = list(each(call, [1, 2, 3, 4], seconds=0.3))
    assert [found[i] for i in (0, 2, 3)] == [1, 3, 4]
    assert isinstance(found[1], Ended)
    assert said in str(found[1])


def test_where_many_items_hang_the_rest_is_not_tried():
    began = time.monotonic()
    found = list(each(spin, range(50), seconds=0.2, hangs=2))
    assert len(found) == 50
    assert all(isinstance(each, Ended) for each in found)
    assert ["not tried" in str(each) for each in found] == 2 * [False] + 48 * [True]
    assert time.monotonic() - began < 20


def test_what_a_call_raises_is_raised():
    def call(n):
        raise SampleError("a cause", file="part.step", face=f"F{n}")

    with pytest.raises(SampleError, match=r"part.step: F7: a cause") as caught:
        list(each(call, [7], seconds=5.0))
    assert caught.value.face == "F7"


# --- each stage, from Python -----------------------------------------------------------------------------------------


def noise(_, t):
    """A curve that is another one however near it is looked at."""
    return np.random.default_rng(0).normal(size=(2, len(t), 3))


def crowded(*_):
    raise TooMany


@pytest.mark.parametrize(
    ("where", "name", "fault"),
    [(coincide, "_places", noise), (coincide, "_places", lambda *_: None), (sew, "coinciding", crowded)],
)
def test_a_shell_that_cannot_be_sewn_stays_as_it_is_and_the_plan_says_so(monkeypatch, where, name, fault):
    monkeypatch.setattr(where, name, fault)
    part = read_part(loose(box(), 1e-3))
    assert (part.sewn.tolerance, part.sewn.open_edges) == (None, 24)
    assert part.sewn.stopped
    assert not orient(part).confident
    result = plan(part, cutters=["R2L40"], grid=5, faces="all", area_budget=0)
    assert any("sewing was stopped" in said for said in result.plan.part.warnings)
    assert not result.plan.part.orientation.confident


def test_a_curve_that_is_never_followed_costs_a_number_of_points(monkeypatch):
    asked = []
    monkeypatch.setattr(coincide, "_places", lambda curve, t: (asked.append(len(t)), noise(curve, t))[1])
    assert not coincide.Curves([edge for edge, _ in edge_uses(faces(box()))[:1]], 1e-9).drawn.any()
    assert 0 < sum(asked) <= 2 * coincide.MOST_PIECES


def test_ends_next_to_each_other_are_counted_before_they_are_compared(monkeypatch):
    monkeypatch.setattr(coincide, "MOST_NEIGHBOURS", 10)
    sewn = read_part(loose(box())).sewn
    assert (sewn.tolerance, sewn.open_edges) == (None, 24)
    assert "more ends of edges" in sewn.stopped


def test_a_rung_that_is_given_up_leaves_what_was_joined_before(monkeypatch):
    join = sew.coinciding
    monkeypatch.setattr(sew, "coinciding", lambda *each: join(*each) if each[-1] < 1e-4 else crowded())
    part = read_part(compound(loose(box()), loose(box(at=(50, 0, 0)), 0.5)))
    edges, sewn = edge_uses(part.sewn.faces.values()), part.sewn
    assert sewn.tolerance is not None
    assert sewn.stopped
    assert 0 < sewn.open_edges < len(edges)


@pytest.mark.parametrize(("fault", "said"), [(spin, "does not come to an end"), (crash, "fails")])
def test_a_file_that_is_never_written_leaves_the_old_one(tmp_path, monkeypatch, fault, said):
    monkeypatch.setattr(step, "_write", fault)
    monkeypatch.setattr(step, "SECONDS", 0.3)
    monkeypatch.setattr(step, "_A_FACE", 0.0)
    path = tmp_path / "annotated.step"
    path.write_text("old")
    pieces = split(read_part(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape()), [])
    with pytest.raises(WriteError, match=said):
        step.write_step(pieces, path, lambda piece: ("name", None), product="box")
    assert path.read_text() == "old"
    assert [each.name for each in tmp_path.iterdir()] == ["annotated.step"]


def test_a_point_that_is_never_projected_names_its_face(monkeypatch):
    monkeypatch.setattr(at_point, "SECONDS", 0.3)
    part = read_part(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape())
    orientation = orient(part)
    on_top = locate(part, orientation, (0.5, 1.0, 3.0))
    monkeypatch.setattr(at_point, "_projected", spin)
    with pytest.raises(SampleError, match=rf"F{on_top.face[0]}: projecting a point .*does not come to an end"):
        locate(part, orientation, (0.5, 1.0, 3.0))
    monkeypatch.setattr(at_point, "_A_FACE", 0.0)
    monkeypatch.setattr(at_point, "BRepExtrema_DistShapeShape", spin)
    with pytest.raises(SampleError, match="does not come to an end"):
        nearest(part, (0.5, 1.0, 4.0))


# --- a face that is set aside ----------------------------------------------------------------------------------------


def test_a_face_set_aside_is_neither_measured_nor_judged_nor_forgotten():
    whole = read_part(BRepPrimAPI_MakeBox(30.0, 20.0, 10.0).Shape())
    part = whole.without({2: "the CAD kernel hangs"})
    assert part.faces[1].unjudged == "the CAD kernel hangs"
    assert part.trim(2) is part.measure(2) is None
    assert [f for f in part.faces if f.number != 2] == [f for f in whole.faces if f.number != 2]
    assert part.size == pytest.approx(whole.size)
    assert orient(whole).confident
    assert not orient(part).confident
    assert 2 in dict(tessellate(part, 0.1).missing)
    result = plan(part, cutters=["R2L40"], grid=5, faces="all", area_budget=0)
    entry = next(f for f in result.plan.faces if f.id == "F2")
    assert entry.unjudged == "the CAD kernel hangs"
    assert result.plan.cutters[0].feasible is None
    assert result.plan.samples.judged > 0


# --- the command -----------------------------------------------------------------------------------------------------

#: Patches a module of the process that does the job, as soon as it is imported.
HOOK = """
import importlib.util, os, signal, sys
MODULE, CODE = {module!r}, {code!r}
class Hook:
    def find_spec(self, name, path=None, target=None):
        if name != MODULE:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        run = spec.loader.exec_module
        def patched(module):
            run(module)
            exec(CODE, vars(module) | {{"module": module}})
        spec.loader.exec_module = patched
        return spec
if "PLAN_CUTTERS_ASSIGNMENT" in os.environ:
    sys.meta_path.insert(0, Hook())
"""
HANG, CRASH = "while True: pass", "import os; os.kill(os.getpid(), 11)"
MEASURE = """
def describe(self, number, at, before=module.Part._describe):
    if number == 2 and number not in self.aside:
        at(number)
        {fault}
    return before(self, number, at)
module.Part._describe = describe
"""
SAMPLE = """
def sample(part, number, *more, before=module._sample_face):
    if number == 2:
        {fault}
    return before(part, number, *more)
module._sample_face = sample
"""


@pytest.mark.slow("starts commands and ends them on the way")
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs Linux: a face's processor time is asked of it")
@pytest.mark.parametrize(
    ("module", "code", "fault", "parts", "timeout", "said"),
    [
        ("cad_io.part.part", MEASURE, HANG, ["a.step"], 4, "did not end its measuring of faces within 1 s"),
        ("cad_io.sample.on_grids", SAMPLE, HANG, ["a.step"], 2, "did not end its sampling within 2 s"),
        ("cad_io.sample.on_grids", SAMPLE, CRASH, ["a.step", "b.step"], 60, "crashed (SIGSEGV) at its sampling"),
    ],
    ids=["measure", "sample", "crash"],
)
def test_a_face_that_never_ends_costs_itself_alone(tmp_path, module, code, fault, parts, timeout, said):
    plan(GROOVE, cutters=["R6L80"], grid=9, area_budget=0)  # machine code is at hand then
    (tmp_path / "sitecustomize.py").write_text(HOOK.format(module=module, code=code.format(fault=fault)))
    for name in parts:
        shutil.copy(GROOVE, tmp_path / name)
    paths = (tmp_path, ROOT / "plugin", ROOT)
    ran = subprocess.run(
        [sys.executable, "-m", "plan_cutters", *parts, "--cutter", "R6L80", "--grid", "9", "--area-budget",
         "0", "--formats", "json", "-o", "out", "--read-timeout", str(timeout), "--quiet"],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": os.pathsep.join(map(str, paths))}, capture_output=True, text=True,
        timeout=120, check=False,
    )  # fmt: skip
    plans = [json.loads(path.read_text()) for path in sorted((tmp_path / "out").rglob("plan.json"))]
    assert ran.returncode == 4, ran.stderr
    assert said in ran.stderr
    assert len(plans) == len(parts)
    for found in plans:
        entries = {f["id"]: f for f in found["faces"]}
        assert said in entries["F2"]["unjudged"]
        assert entries["F1"]["unjudged"] is entries["F3"]["unjudged"] is None
        assert found["selected"] is None
        assert found["cutters"][0]["feasible"] is None
        assert found["samples"]["count"] > found["samples"]["unjudged"]
