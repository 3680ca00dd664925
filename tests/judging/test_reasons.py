"""Why a sample is not reached, by what would free it; and several setups as one."""

import csv
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter, Holder, Machine, plan
from plan_cutters.command.codes import code_of
from plan_cutters.command.summary import summary
from plan_cutters.domain.figures import size
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.verdicts import AXIS_LIMIT, REASONS, UNDECIDED, over_setups
from plan_cutters.judging import reasons as finding
from plan_cutters.judging.judge import judge
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.plan_file.words.headline import headline
from plan_cutters.plan_file.words.names import short_names
from tests.support.cad_parts import box, cut, rod

HOW = {"faces": "all", "grid": 7, "area_budget": 0, "jobs": 2}


@pytest.fixture(scope="module")
def plate():
    """Pockets on both sides: the walls of the lower one are within a limit of 30 deg, but only through the floor."""
    return read_part(cut(cut(box(40, 40, 20), rod(12, 8, (20, 20, 14))), rod(12, 8, (20, 20, -2))))


def words(reason):
    return {REASONS[code] for code in np.unique(reason).tolist()}


def test_what_turning_the_part_frees_is_kept_by_the_axis_limit(plate):
    """On a plate with features on both sides; told by plans without the limit, and turned over."""
    held = plan(plate, cutters=["R2L30"], machine="tilt:30", **HOW)
    free = plan(plate, cutters=["R2L30"], **HOW).reaches["R2L30"]
    reach, ready = held.reaches["R2L30"], held.ready
    found = judge(ready, Cutter.parse("R2L30"))
    # Verdicts and postures are those of the search.
    assert (reach.verdict == found.verdict).all()
    assert np.array_equal(reach.axis, found.axis, equal_nan=True)
    misled = found.not_reached & free.reached & (found.reason != AXIS_LIMIT)
    assert misled.sum() > 20, "the search books these on rear gouge or collision"
    assert (reach.reason[misled] == AXIS_LIMIT).all()
    # Each is true, both ways.
    assert (reach.reason[reach.not_reached & free.reached] == AXIS_LIMIT).all()
    assert free.reached[reach.reason == AXIS_LIMIT].all()
    entry = held.cutters[0]
    assert sum(entry.axis_limit_with.values()) == misled.sum()
    assert entry.by_reason["axis_limit"] + entry.undecided_by_reason["axis_limit"] == (reach.reason == AXIS_LIMIT).sum()
    assert set(entry.axis_limit_with) == words(found.reason[misled])
    below = plan(plate, cutters=["R2L30"], machine="tilt:30", setup=(0, 0, -1), **HOW).reaches["R2L30"]
    assert below.reached[misled].mean() > 0.9


def test_who_listens_is_told_of_each_search_and_what_is_found_is_the_same():
    part = cut(box(30, 30, 20), rod(8, 8, (15, 15, 14)))
    ready = prepare(part, Options.of({**HOW, "cutters": "R3L30HR12L30", "machine": "tilt:10", "grid": 5}))
    [cutter], told = ready.cutters, []
    verdicts = judge(ready, cutter)
    assert verdicts.not_reached.any()

    def explained(progress):
        reasons = finding.Reasons(ready.samples, ready.setups, ready.finished, ready.machinable)
        return reasons.of(cutter, verdicts, progress)

    listened, alone = explained(lambda done, total: told.append((done, total))), explained(None)
    assert told == [(1, 3), (2, 3), (3, 3)]
    assert np.array_equal(listened.verdicts.reason, alone.verdicts.reason)
    assert np.array_equal(listened.besides, alone.besides)


def test_a_holder_is_the_reason_where_bare_flutes_serve():
    part = read_part(cut(box(60, 60, 40), rod(14, 40, (30, 30, 12))))
    cutter = replace(Cutter.parse("R4L20"), holder=Holder.parse("R25L40"))
    held = plan(part, cutters=[cutter], machine="tilt:50", **HOW)
    reach = held.reaches[cutter.id]
    bare = plan(part, cutters=["R4L20"], machine="tilt:50", **HOW).reaches["R4L20"]
    loose = plan(part, cutters=[cutter], **HOW).reaches[cutter.id]
    both = plan(part, cutters=["R4L20"], **HOW).reaches["R4L20"]
    why = np.where(reach.not_reached, reach.reason, 255)
    told = {word: why == REASONS.index(word) for word in ("axis_limit", "holder", "rear_gouge", "collision")}
    assert told["holder"].sum() > 10
    assert bare.reached[told["holder"]].all()
    assert not loose.reached[told["holder"]].any(), "the axis limit comes first"
    assert not (bare.reached | loose.reached)[told["rear_gouge"] | told["collision"]].any()
    assert (loose.reached | both.reached)[told["axis_limit"]].all()
    assert held.cutters[0].by_reason["holder"] == (told["holder"] & (reach.verdict != UNDECIDED)).sum()


def test_neck_and_shank_are_told_from_the_holder():
    """A pocket into which the flutes go, and the neck, but neither the shank nor the holder."""
    part = read_part(cut(box(60, 60, 60), rod(6, 60, (30, 30, 20))))

    @cache
    def reached(cutter):
        (verdicts,) = plan(part, cutters=[cutter], **{**HOW, "grid": 5, "tilt": (0.0, 0.3), "drill_below": 0}).reaches.values()
        return verdicts

    thin = Cutter.flat(radius=3, length=80, flutes=10, shank_radius=8)
    held = Holder.parse("R20L30")
    slim = Cutter.flat(radius=3, length=30, flutes=10, shank_radius=3, holder=held)
    bare = reached(Cutter.parse("R3L10"))
    for cutter, word in ((thin, "shank"), (replace(thin, holder=held), "shank"), (slim, "holder")):
        reach = reached(cutter)
        told = reach.not_reached & (reach.reason == REASONS.index(word))
        assert told.any(), word
        assert bare.reached[told].all()
        # Of two parts that are in the way the one that has to be away for there to be a posture.
        assert (reached(replace(cutter, holder=None)).reached[told] == (word == "holder")).all()


def test_a_fixture_that_an_axis_limit_could_avoid_comes_second():
    """In the order of what is requested first; each is true by a plan without it."""
    part, wall = read_part(cut(box(40, 40, 20), rod(12, 8, (20, 20, 14)))), ["box:10,60,60@40.5,-10,-10"]
    found = {
        (machine, bool(fixtures)): plan(part, cutters=["R3L40"], machine=machine, fixtures=fixtures, **HOW).reaches["R3L40"]
        for machine in ("tilt:75", "unlimited") for fixtures in (wall, ())
    }  # fmt: skip
    reach = found["tilt:75", True]
    told = {word: reach.not_reached & (reach.reason == REASONS.index(word)) for word in ("axis_limit", "fixture")}
    assert told["fixture"].any()
    assert found["tilt:75", False].reached[told["fixture"]].all()
    assert not found["unlimited", True].reached[told["fixture"]].any()
    assert (reach.reason[reach.not_reached & found["unlimited", True].reached] == AXIS_LIMIT).all()


def test_nothing_is_searched_where_nothing_could_be_taken_away(plate, monkeypatch):
    calls, real = [], finding.search
    monkeypatch.setattr(finding, "search", lambda *given, **more: calls.append(len(given[2])) or real(*given, **more))
    bare = plan(plate, cutters=["R13L40", "R2L30"], **HOW)
    assert bare.reaches["R13L40"].not_reached.any()
    assert not calls
    # With a limit one search of what is not reached, but for what another cutter's tells.
    held = plan(plate, cutters=["R13L40", "R5L30", "R2L30"], machine="tilt:30", **HOW)
    not_reached = [reach.not_reached.sum() for reach in held.reaches.values()]
    assert 0 < sum(calls) < sum(not_reached)


@pytest.mark.slow("judges many samples")
def test_reasons_are_the_same_whatever_other_cutters_there_are(plate):
    together = plan(plate, cutters=["R13L40", "R4L40", "R2L30"], machine="tilt:30", **HOW)
    for name, reach in together.reaches.items():
        alone = plan(plate, cutters=[name], machine="tilt:30", **HOW).reaches[name]
        assert ((reach.reason == AXIS_LIMIT) == (alone.reason == AXIS_LIMIT)).mean() > 0.995


SETUPS = [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]


@pytest.mark.slow("another machine of the same law", only=("trunnion-ac",))
@pytest.mark.parametrize("machine", ["tilt:60", "trunnion-ac"])
def test_several_setups_are_one_answer(plate, machine, tmp_path):
    """Union is or: verdicts, choice, shares, files; each posture is held in the setup that is told."""
    how = HOW | {"cutters": ["R2L30"], "machine": machine}
    both = plan(plate, setup=SETUPS[0], other_setups=SETUPS[1:], **how)
    alone = [plan(plate, setup=axis, **how).reaches["R2L30"] for axis in SETUPS]
    reach, entry = both.reaches["R2L30"], both.cutters[0]
    together = np.logical_or.reduce([each.reached for each in alone])
    assert together.sum() > max(each.reached.sum() for each in alone)
    assert (reach.reached == together).all()
    assert entry.interference_free + entry.accessible == together.sum()
    assert entry.lost_in_all == entry.not_reached == (~together).sum()
    assert both.selected == both.plan.selected_over_setups
    assert entry.feasible is bool(together.all())
    share = entry.area_share.interference_free + entry.area_share.accessible
    assert share == pytest.approx(both.samples.area[together].sum() / both.samples.area.sum(), abs=1e-6)
    assert [each.reached for each in both.plan.setups[:2]] == [each.reached.sum() for each in alone]
    assert [each.reached for each in both.plan.setups[2:]] == [None] * 4
    assert sum(each.serves for each in entry.setups) == together.sum()
    both.write(tmp_path, ["npz", "csv"])
    with (tmp_path / "axes.csv").open(newline="") as file:
        told = [row["setup"] for row in csv.DictReader(file)]
    assert told == ["" if k < 0 else str(k) for k in both.served_in["R2L30"].tolist()]
    with np.load(tmp_path / "samples.npz") as arrays:
        which = arrays["setup_R2L30"]
        assert ((which >= 0) == together).all()
        assert (which[alone[0].reached] == 0).all()
        for k, axis in enumerate(arrays["setups"]):
            rows = which == k
            assert rows.any()
            assert arrays["reached_in_R2L30"][rows, k].all()
            assert Machine.of(machine).allows(arrays["axis_R2L30"][rows], frame_of(axis)).all()
            if "rotary_R2L30" in arrays:
                taken = arrays["rotary_taken_R2L30"][rows]
                angles = np.radians(arrays["rotary_R2L30"][rows][np.arange(rows.sum()), taken])
                machine_axes = Machine.of(machine).kinematics(frame_of(axis))
                assert np.abs(machine_axes.axis(angles) - arrays["axis_R2L30"][rows]).max() < 1e-6


def test_what_no_setup_reaches_has_the_reason_of_one_that_may_serve():
    ready = prepare(box(20, 20, 6), Options.of(HOW | {"cutters": "R3L30", "machine": "tilt:20"}))
    reach = judge(ready, Cutter.parse("R3L30"))
    assert (reach.reason == AXIS_LIMIT).any()
    verdict = reach.verdict.copy()
    verdict[np.flatnonzero(reach.not_reached)[0]] = UNDECIDED
    other = replace(reach, reason=np.where(reach.not_reached, np.uint8(2), reach.reason), verdict=verdict)
    found, which = over_setups([reach, other])
    assert (found.reached == reach.reached).all()
    assert (which[reach.not_reached] == -1).all()
    assert (found.reason[reach.not_reached] == 2).all()
    assert (found.verdict == UNDECIDED).sum() == 1


def test_the_headline_is_that_of_the_union(capsys):
    """Two setups do together what none does alone; where one does, that one is told."""
    top = read_part(box(20, 20, 6))
    how = HOW | {"cutters": ["R3L30"], "machine": "tilt:60"}
    both = plan(top, setup=(0, 0, 1), other_setups=[(0, 0, -1)], **how)
    assert (both.selected, code_of(both.plan)) == ("R3L30", 0)
    summary(both.plan, verbose=True)
    said = " ".join("".join(capsys.readouterr()).split())
    head = "Take flat end D6 x 30: it finishes all 1,280 mm². For the part"
    assert said.startswith(f"{head}, {size(both.plan.part.size_mm)}, in 2 setups")
    assert "over 2 setups" in said
    below = plan(top, setup=(0, 0, 1), other_setups=[(0, 0, -1)], **how | {"faces": "5"})
    assert not below.over_setups.each[0][1]["R3L30"].reached.any()
    summary(below.plan)
    said = " ".join("".join(capsys.readouterr()).split())
    part = f"the part, {size(below.plan.part.size_mm)}"
    head = "Take flat end D6 x 30: it finishes all 400 mm². For the face asked for"
    assert said.startswith(f"{head} of {part} (31.2 % of the area), in setup 0,0,-1:")
    names = short_names(both.plan)
    assert headline(both.plan, names).about.startswith(f"For {part}, in 2 setups: ")
    assert headline(below.plan, names).why == "It reaches every sample there, and needs no other setup."
