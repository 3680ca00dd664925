"""While other setups are compared and judged, something stands: a first look, and then the plan of the first setup."""

from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import Options
from plan_cutters.document.clock import Clock
from plan_cutters.interim import Interim
from plan_cutters.judging import judge as looking
from plan_cutters.judging.judge import first_look, worth_a_look
from plan_cutters.pipeline import prepare, run
from tests.support.cad_parts import box

CUTTERS = ("D8L50F20S8", "D4L40rc2F12S4")


class StoppedError(Exception):
    """The run was ended here."""


def test_the_plan_of_the_first_setup_stands_before_others_are_judged():
    asked = {"cutters": CUTTERS, "grid": 5, "machine": "trunnion-ac", "faces": "all", "area_budget": 0}

    def tell(name, done, total):
        if name == "setups":
            raise StoppedError

    interim = Interim(clock := Clock(tell))
    with pytest.raises(StoppedError):
        run(box(), Options(**asked, other_setups=((0.0, 0.0, -1.0), (0.0, 1.0, 0.0))), clock, interim=interim)
    stood = interim.interrupted("judging in other setups").plan
    alone = run(box(), Options(**asked), Clock()).plan
    assert [(c.id, c.accessible, c.interference_free, c.inaccessible) for c in stood.cutters] == [
        (c.id, c.accessible, c.interference_free, c.inaccessible) for c in alone.cutters
    ]
    (text,) = [text for code, text in zip(stood.note_codes, stood.notes, strict=True) if code == "run_unfinished"]
    assert "without what follows in setup 0,0,-1 and 0,1,0" in text
    assert stood.effective.other_setups == []


def test_while_setups_are_compared_the_plan_of_z_stands():
    """At fewer samples, which say how far apart they are; without what holds the part, which the plan says."""
    asked = {"cutters": CUTTERS, "grid": 21, "machine": "trunnion-ac", "faces": "all", "area_budget": 0}
    begun = []

    def tell(name, done, total):
        if name == "proposal":
            raise StoppedError

    interim = Interim(clock := Clock(tell), begins=lambda: begun.append(True))
    with pytest.raises(StoppedError):
        run(box(), Options(**asked, propose=True, operations="fewest"), clock, interim=interim)
    assert begun
    stood = interim.interrupted("comparing setups").plan
    assert (stood.effective.setup, stood.setup_proposal, stood.operations) == ((0.0, 0.0, 1.0), None, None)
    assert stood.process.asked_mm2 == pytest.approx(sum(face.area_mm2 for face in stood.faces))
    alone = run(box(), Options(**asked), Clock()).plan
    assert stood.process.finished_share == pytest.approx(alone.process.finished_share, abs=0.03)
    (text,) = [text for code, text in zip(stood.note_codes, stood.notes, strict=True) if code == "run_unfinished"]
    assert "without a setup that was chosen and what holds the part (--setup auto), all but 400 of " in text
    assert stood.process.doubts[0] == text


def test_a_first_look_says_about_what_the_verdicts_will(monkeypatch):
    asked = {"cutters": CUTTERS, "grid": 21, "machine": "3-axis", "faces": "all", "area_budget": 0}
    ready = prepare(box(), Options(**asked))
    assert not worth_a_look(ready), "so few samples are judged as soon"
    monkeypatch.setattr(looking, "_WORTH", 0)
    assert worth_a_look(ready)
    look = first_look(ready)
    assert (look.samples, look.of) == (400, int(ready.finished.sum()))
    result = run(box(), Options(**asked), Clock())
    area = np.nan_to_num(ready.samples.area)
    for cutter, share in look.shares:
        reached = result.reaches[cutter.id].reached
        assert share == pytest.approx(float(area[reached].sum() / area.sum()), abs=0.05)
    assert max(share for _, share in look.shares) - 1e-12 <= look.together <= 1.0
    for number, samples in ((10, 200), (50, 100)):
        assert first_look(replace(ready, cutters=ready.cutters * number)).samples == samples
    # How far apart they are, is so: each sample of a face is so near to one that was looked at.
    few, gaps = look.ready.samples, dict(look.ready.samples.face_gaps)
    for number, rows in ready.samples.by_face().items():
        mine = few.point[few.face == number]
        away = np.linalg.norm(ready.samples.point[rows][:, None] - mine, axis=2).min(axis=1)
        assert away.max() <= gaps[number] <= few.max_gap


def test_of_proposed_setups_a_first_look_is_told_before_they_are_compared_and_the_first_one_stands(monkeypatch):
    monkeypatch.setattr(looking, "_WORTH", 0)
    said, stood = [], []

    def tell(name, done, total):
        if name == "setups" and name not in said:
            stood.append(interim.interrupted("judging in other setups").plan)
        said.append(name)

    clock = Clock(tell)
    interim = Interim(clock, looks=said.append)
    options = Options(cutters=CUTTERS, grid=9, machine="trunnion-ac", faces="all", area_budget=0, propose=True)
    whole = run(box(), options, clock, interim=interim).plan
    (place,) = [k for k, each in enumerate(said) if each.startswith("First look with 0,0,1 along the spindle, at 400 of ")]
    assert "proposal" not in said[:place]
    assert "proposal" in said[place:]
    assert len(whole.setup_proposal.setups) > 1
    (first,) = stood
    assert [each.axis for each in first.setup_proposal.setups] == [whole.setup_proposal.setups[0].axis]
    assert first.setup_proposal.promised < whole.setup_proposal.promised
    assert "run_unfinished" in first.note_codes
