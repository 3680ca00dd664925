"""What is undecided is said first, with its share and cause, and only then; nothing is sought where no change can decide it."""

import pytest

import plan_cutters.scene.surroundings as surroundings
from plan_cutters import plan
from plan_cutters.answers import ask as asking
from plan_cutters.domain.percent import percent
from plan_cutters.report.story.story import story_of
from plan_cutters.report.story.undecided import undecided
from tests.support.places import ROOT

SAMPLES = ROOT / "samples"


def said(found):
    return undecided(found, story_of(found).names)


@pytest.fixture
def coarse(monkeypatch):
    """As if triangles could not be made to follow a part more closely than a tolerance of 5 mm needs."""
    monkeypatch.setattr(surroundings.Surroundings, "tolerance", lambda self, asked: 5.0)


def test_nothing_undecided_nothing_said():
    found = plan(SAMPLES / "peaks_and_valleys.step", cutters=["R1L40"], grid=9, area_budget=0).plan
    assert found.cutters[0].undecided == 0
    assert said(found) == []


def test_share_and_faces_are_the_plans(coarse):
    found = plan(SAMPLES / "peaks_and_valleys.step", cutters=["R1L40"], grid=9, area_budget=0).plan
    entry = found.cutters[0]
    assert entry.undecided == found.samples.judged
    first, cause = said(found)
    assert f"{percent(entry.area_share.undecided, whole=True)} of the area undecided" in first
    assert all(name in first for name in entry.faces)
    assert "too coarse for this cutter" in cause
    assert story_of(found).scope[:2] == (first, cause)


def test_nothing_is_sought_that_no_change_decides(coarse, monkeypatch):
    calls = []
    monkeypatch.setattr(asking, "mend", lambda *given, **words: calls.append(given))
    monkeypatch.setattr(asking, "steps", lambda *given, **words: calls.append(given))
    found = plan(SAMPLES / "peaks_and_valleys.step", cutters=["R1L40"], grid=9, area_budget=0, answers="mend").plan
    mended = found.cutters[0].mend
    assert not calls
    assert "was not asked" in mended.why
    assert mended.lost == found.cutters[0].not_reached
    assert mended.lost_share == pytest.approx(found.cutters[0].area_share.undecided)
