"""The second question about a part: stages that it shares with the first are read, and the answer has the same bytes."""

import json
import re
from pathlib import Path

import cadquery
import numpy as np
import pytest

from cad_io import read_part
from cad_io.part import part
from cad_io.read import read, step
from plan_cutters import plan
from plan_cutters.document.clock import Clock
from plan_cutters.options import Options
from plan_cutters.pipeline import run
from plan_cutters_base import stage_cache
from tests.support.places import real_file

PARTS = {"impeller": "cad/hard/turbo3d_impeller.step", "pump": "cad/hard/gmsh_pump_carter_sup.stp"}
OWN = Path(__file__).parents[2] / "samples" / "blade.step"
COARSE = {"faces": "sculptured", "spacing": 12.0, "tolerance": 0.05}


@pytest.fixture(autouse=True)
def _kept(tmp_path, monkeypatch):
    monkeypatch.setenv(stage_cache.FOLDER, str(tmp_path / "stages"))
    monkeypatch.setattr(stage_cache, "_WORTH", 0.0)


def answered(part, folder, cache=True, **words):
    """The files of an answer, but for times; and the stages that were made in it."""
    made, cached = [], stage_cache.StageCache.cached

    def watched(self, stage, follows_from, make, keep=None):
        return cached(self, stage, follows_from, make if self.folder is None else lambda: (made.append(stage), make())[1], keep)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stage_cache.StageCache, "cached", watched)
        source = part if not isinstance(part, str) else real_file(PARTS[part]) if part in PARTS else OWN
        result = plan(source, cache=cache, **{**COARSE, **words})
    stage_cache.settle()
    result.write(folder, ["json", "npz"])
    document = json.loads((folder / "plan.json").read_text())
    for entry in document["cutters"]:
        entry.pop("seconds", None)
    document.pop("run")
    return document, dict(np.load(folder / "samples.npz", allow_pickle=True)), made


def same(one, other):
    assert one[0] == other[0]
    assert one[1].keys() == other[1].keys()
    assert all(np.array_equal(one[1][name], other[1][name], equal_nan=one[1][name].dtype.kind == "f") for name in one[1])


@pytest.mark.slow("plans a large part twice", but=("blade",))
@pytest.mark.parametrize(("part", "words"), [
    ("impeller", {"cutters": ["R3L40"], "spacing": 4.0}),
    ("pump", {"cutters": ["R3L40", "R3L40rc1"], "fixtures": "table", "machine": "trunnion-ac", "faces": "all", "spacing": 4.0}),
    ("blade", {"cutters": ["R3L40", "R3L40rc1"], "fixtures": "table", "machine": "trunnion-ac"}),
])  # fmt: skip
def test_the_same_question_is_read_and_has_the_same_bytes(tmp_path, part, words):
    without = answered(part, tmp_path / "without", cache=False, **words)
    first = answered(part, tmp_path / "first", **words)
    second = answered(part, tmp_path / "second", **words)
    assert without[2] == []
    # Where the kernel's own form is not what was read to the last bit, the file is read again.
    again = set() if part == "blade" else {"read"}
    assert {"read", "faces", "triangles", "samples", "tree", "bodies", "verdicts", "witnesses"} <= set(first[2])
    assert set(second[2]) <= again
    same(without, first)
    same(first, second)


@pytest.mark.slow("plans parts whole", but=("words2-made2",))
@pytest.mark.parametrize(("words", "made"), [
    ({"cutters": ["R3L40", "R3L40rc1"]}, {"verdicts", "witnesses", "area"}),
    ({"machine": "tilt:60"}, {"verdicts", "witnesses", "area"}),
    ({"answers": ["stick-out"]}, set()),
    ({"spacing": 15.0}, {"samples", "bodies", "coverings", "verdicts", "witnesses", "area"}),
    ({"ignore": ["F1"]}, {"triangles", "holes", "tree", "bodies", "coverings", "samples", "verdicts", "witnesses", "area"}),
    ({"tolerance": 0.1}, {"triangles", "holes", "tree", "bodies", "coverings", "verdicts", "witnesses", "area"}),
])  # fmt: skip
def test_another_question_makes_what_it_does_not_share_and_answers_as_without(tmp_path, words, made):
    answered("blade", tmp_path / "first", cutters=["R3L40"])
    words = {"cutters": ["R3L40"], **words}
    second = answered("blade", tmp_path / "second", **words)
    assert set(second[2]) <= made
    same(answered("blade", tmp_path / "without", cache=False, **words), second)


def tray(radius):
    """A block with a pocket, made anew."""
    sketch = cadquery.Sketch().rect(30, 20).vertices().fillet(radius)
    return cadquery.Workplane().box(40, 30, 10).faces(">Z").workplane().placeSketch(sketch).cutBlind(-6).val()


def test_a_shape_in_memory_is_known_by_its_own_bytes(tmp_path):
    """A script that makes its part again asks the same question; another radius is another part, and so is a turned one."""
    words = {"cutters": ["R3L40"], "faces": "all", "spacing": 4.0}
    first = answered(tray(4.0), tmp_path / "first", **words)
    second = answered(tray(4.0), tmp_path / "second", **words)
    assert {"faces", "triangles", "samples", "tree", "verdicts"} <= set(first[2])
    assert second[2] == []
    same(first, second)
    same(answered(tray(4.0), tmp_path / "without", cache=False, **words), second)
    for k, other in enumerate((tray(4.5), tray(4.0).rotate((0, 0, 0), (1, 0, 0), 10))):
        assert "samples" in answered(other, tmp_path / f"other{k}", **words)[2]


def test_another_file_shares_nothing(tmp_path):
    source = OWN
    copy = tmp_path / "copy.step"
    text = source.read_bytes()
    copy.write_bytes(text)
    words = {**COARSE, "cutters": ["R3L40"]}
    plan(source, **words)
    stage_cache.settle()
    before = {each.name for each in (tmp_path / "stages").iterdir()}
    plan(copy, **words)
    stage_cache.settle()
    assert {each.name for each in (tmp_path / "stages").iterdir()} == before
    copy.write_bytes(text + b"\n")
    plan(copy, **words)
    stage_cache.settle()
    assert len(list((tmp_path / "stages").iterdir())) > len(before)


def test_a_part_with_faces_set_aside_is_another_one(tmp_path):
    cache, options = stage_cache.StageCache.of_user(), Options.of({**COARSE, "cutters": "R3L40", "faces": "all"})
    whole = run(OWN, options, Clock(), cache=cache)
    stage_cache.settle()
    less = run(OWN, options, Clock(), cache=cache, excluded={1: "it was left out"})
    plain = run(OWN, options, Clock(), excluded={1: "it was left out"})
    assert (less.samples.face != 1).all()
    assert (whole.samples.face == 1).any()
    assert np.array_equal(less.reaches["R3L40"].verdict, plain.reaches["R3L40"].verdict)


def test_a_second_question_reads_no_step_and_sews_nothing(monkeypatch):
    words, shell = {**COARSE, "cutters": ["R3L40"], "area_budget": 0}, OWN.with_name("v_groove.step")
    plan(shell, **words)
    stage_cache.settle()

    def refused(*words, **more):
        raise AssertionError("what is kept is made again")

    monkeypatch.setitem(read._LOADERS, "step", refused)
    monkeypatch.setattr(part, "sew", refused)
    assert plan(shell, **{**words, "cutters": ["R2L40"], "machine": "tilt:60"}).plan.cutters[0].id == "R2L40"


def test_a_file_that_changes_while_it_is_read_is_not_kept(tmp_path, monkeypatch):
    file, loaded = tmp_path / "part.step", step.Loaded
    file.write_bytes(OWN.read_bytes())
    cache = stage_cache.StageCache.of_user()

    def changed(name, data, *words, **more):
        file.write_bytes(OWN.with_name("v_groove.step").read_bytes())
        return loaded(name, data, *words, **more)

    monkeypatch.setitem(read._LOADERS, "step", changed)
    read_part(file, cache=cache)
    stage_cache.settle()
    monkeypatch.setitem(read._LOADERS, "step", loaded)
    file.write_bytes(OWN.read_bytes())
    assert len(read_part(file, cache=cache).faces) == len(read_part(OWN).faces)


def test_a_file_with_faults_is_read_again(tmp_path, monkeypatch):
    file = tmp_path / "part.step"
    file.write_bytes(OWN.read_bytes())
    monkeypatch.setattr(step, "_HUGE", [re.compile(rb"(?<=0)\.")])
    read_part(file, cache=stage_cache.StageCache.of_user())
    stage_cache.settle()
    assert not list(tmp_path.glob("stages/read-*"))
