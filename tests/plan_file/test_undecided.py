"""What is undecided is said first, with its share and cause, and only then; nothing is sought where no change can decide it."""

from types import SimpleNamespace

import numpy as np
import pytest

import plan_cutters.scene.surroundings as surroundings
from plan_cutters import plan
from plan_cutters.answers import ask as mending
from plan_cutters.answers.ask import undecidable
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import percent
from plan_cutters.domain.verdicts import INACCESSIBLE, UNDECIDED, blank
from plan_cutters.plan_file.effective import LocalTolerance
from plan_cutters.plan_file.model import MissingEntry
from plan_cutters.plan_file.words.headline import undecided
from plan_cutters.plan_file.words.names import short_names
from plan_cutters.plan_file.words.text import story_of
from tests.support.places import ROOT
from tests.support.plan_files import cutter, face, made, verdicts

SAMPLES = ROOT / "samples"


def said(found):
    return undecided(found, short_names(found))


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


def test_what_the_process_finishes_with_another_cutter_is_not_undecided():
    face_entry, entry = face(1), cutter("R1L40", {"F1": verdicts(undecided=1.0)})
    found = made([face_entry], [entry])
    left = [each.model_copy(update={"faces": ["F2"]}) for each in found.process.left]
    process = found.process.model_copy(update={"left": left})
    assert said(found) != []
    assert said(found.model_copy(update={"process": process})) == []


def test_nothing_is_sought_that_no_change_decides(coarse, monkeypatch):
    calls = []
    monkeypatch.setattr(mending, "steps", lambda *given, **words: calls.append(given))
    found = plan(SAMPLES / "peaks_and_valleys.step", cutters=["R1L40"], grid=9, area_budget=0, answers="mend").plan
    mended = found.cutters[0].mend
    assert not calls
    assert "was not asked" in mended.why
    assert mended.lost == found.cutters[0].not_reached
    assert mended.lost_share == pytest.approx(found.cutters[0].area_share.undecided)


def of_counts(unsure, *, effective=None, **more):
    """What is said of a cutter that leaves so many samples of 1000 undecided on F1, F2 and so on."""
    on = {f"F{k}": verdicts(undecided=number) for k, number in enumerate(unsure, 1)}
    faces = [face(k, area=100.0) for k in range(1, len(unsure) + 1)]
    return said(made(faces, [cutter("R6L80", on)], effective=effective).model_copy(update=more))


def test_worst_faces_first_and_the_rest_counted():
    first, cause = of_counts([10, 400, 0, 30, 20, 5])
    assert "40 % of F2, 3 % of F4, 2 % of F5 and 2 more" in first
    assert "7.8 % of the area undecided (465 samples)" in first
    assert "--tolerance 0.005" in cause
    assert of_counts([0, 0]) == []


def test_a_loose_face_is_named_with_its_error():
    loose = LocalTolerance(face="F2", chord_error_mm=0.3, tolerance_mm=1.2, area_mm2=100.0, share=0.5)
    _, cause = of_counts([0, 400], effective={"local_tolerance": [loose]})
    assert "follow F2 only within 0.3 mm, 50 % of the area to be machined" in cause
    assert of_counts([0, 0], effective={"local_tolerance": [loose]}) == []


def test_a_missing_obstacle_is_named():
    gone = MissingEntry(face="F9", entity=None, name="", why="unreadable", stand_in="none")
    _, cause = of_counts([1], missing=[gone])
    assert "missing or only guessed (F9)" in cause


def test_a_finer_tolerance_is_not_promised_where_none_can_be_kept():
    _, cause = of_counts([1], note_codes=["tolerance_raised"])
    assert "--tolerance 0.005" not in cause
    assert "had to be raised" in cause


@pytest.mark.parametrize(
    ("faces", "verdict", "asked"), [((2, 2), UNDECIDED, False), ((2, 3), UNDECIDED, True), ((2, 2), INACCESSIBLE, True)]
)
def test_only_what_lies_on_loose_faces_alone_is_not_asked(faces, verdict, asked):
    around = SimpleNamespace(loose={2: 0.3})
    conditions = SimpleNamespace(tolerance=0.01, surroundings=around, judges=lambda cutter: True)
    ready = SimpleNamespace(finished=np.ones(2, bool), conditions=conditions, scene=SimpleNamespace(asked=0.01),
                            samples=SimpleNamespace(face=np.array(faces)))  # fmt: skip
    found = blank(2)
    found.verdict[:] = (UNDECIDED, verdict)
    why = undecidable(ready, Cutter.parse("R6L80"), found.freeze())
    assert ("F2" in why) != asked
    assert bool(why) != asked
