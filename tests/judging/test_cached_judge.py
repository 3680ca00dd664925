"""Verdicts that are kept answer the same question alone: whatever they depend on makes another one, and nothing else does."""

from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import Cutter, Machine, Options
from plan_cutters.domain.verdicts import UNJUDGED
from plan_cutters.judging import judge as cached_judge
from plan_cutters.judging.judge import CachedJudge, judge
from plan_cutters.pipeline import prepare
from plan_cutters.scene.work import Work
from plan_cutters_base import stage_cache
from plan_cutters_base.stage_cache import StageCache, settle
from tests.support.places import SAMPLES

PART = SAMPLES / "v_groove.step"
ASKED = {"cutters": ("R6L60", "R3L40"), "grid": 21, "rotation_step": 0.35, "area_budget": 0, "patterns": False}


def prepared(cache, part=PART, **asked):
    return replace(prepare(part, Options.of(ASKED | asked)), cache=cache)


@pytest.fixture(scope="module")
def before(tmp_path_factory):
    cache = StageCache(tmp_path_factory.mktemp("stages"))
    ready, judged = prepared(cache), CachedJudge()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stage_cache, "_WORTH", 0.0)
        for cutter in ready.cutters:
            judged(ready, cutter)
        settle()
    return cache, ready


@pytest.fixture
def told(monkeypatch):
    """Who is judged now; nothing more is kept."""
    names = []
    monkeypatch.setattr(stage_cache, "_WORTH", np.inf)
    monkeypatch.setattr(
        cached_judge,
        "judge",
        lambda ready, cutter, *given, **more: names.append(cutter.id) or judge(ready, cutter, *given, **more),
    )
    return names


@pytest.mark.parametrize(
    ("asked", "again"),
    [
        ({}, []),
        ({"jobs": 1, "area_budget": 9}, []),
        ({"answers": "stick-out", "feed": 100.0, "length_over_radius": 5.0}, []),
        ({"machine": Machine(name="another name")}, []),
        ({"cutters": (replace(Cutter.parse("R6L60"), name="my own"), "R3L40")}, []),
        ({"grid": 22}, ["R3L40", "R6L60"]),
        ({"machine": "tilt:60"}, ["R3L40", "R6L60"]),
        ({"machine": "trunnion-ac"}, ["R3L40", "R6L60"]),
        ({"setup": (0, 0.1, 1)}, ["R3L40", "R6L60"]),
        ({"tilt": (0.0, 1.0)}, ["R3L40", "R6L60"]),
        ({"rotation_step": 0.3}, ["R3L40", "R6L60"]),
        ({"tolerance": 0.02}, ["R3L40", "R6L60"]),
        ({"fixtures": "table"}, ["R3L40", "R6L60"]),
        ({"allowance": 0.1}, ["R3L40", "R6L60"]),
        ({"cutters": ("R6L61", "R3L40")}, ["R6L61"]),
    ],
)  # fmt: skip
def test_only_what_verdicts_depend_on_counts(before, told, asked, again):
    cache, _ = before
    ready, judged = prepared(cache, **asked), CachedJudge()
    for cutter in reversed(ready.cutters):
        assert judged(ready, cutter) == judge(ready, cutter)
    assert [name.partition("F")[0][:5] for name in told] == again


def test_another_part_of_the_same_name_is_another_one(before, told, tmp_path):
    copy = tmp_path / PART.name
    copy.write_bytes((SAMPLES / "peaks_and_valleys.step").read_bytes())
    ready = prepared(before[0], copy)
    CachedJudge()(ready, ready.cutters[0])
    assert len(told) == 1


def test_another_program_and_other_company_judge_again(before, told, monkeypatch):
    _, ready = before
    cutter = ready.cutters[0]
    known = judge(ready, cutter)
    CachedJudge()(ready, cutter, known=known)
    CachedJudge()(ready, cutter)
    assert len(told) == 1
    monkeypatch.setattr(stage_cache, "made_by", lambda: b"a later version")
    CachedJudge()(ready, cutter)
    assert len(told) == 2


def test_verdicts_and_work_are_as_of_judge(before, told):
    _, ready = before
    cutter, one, other = ready.cutters[0], Work(), Work()
    whole = judge(ready, cutter, work=one)
    assert CachedJudge()(ready, cutter, work=other) == whole
    assert told == []
    assert one.looked == other.looked > 0
    assert (whole.verdict != UNJUDGED).any()
