"""What is judged once has the verdicts of what is judged sample by sample, and each posture is safe in its own place."""

from functools import cache, partial

import numpy as np
import pytest

from cad_io import Part, read_part
from plan_cutters import plan
from plan_cutters.domain.verdicts import ACCESSIBLE, FIXTURE
from plan_cutters.judging.judge import JudgeOnce, judge
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.distances import least_clearance
from plan_cutters.scene.preparation import Prepared
from tests.support.patterns import impeller, plate

BALL, FINE = "D6L40rc3F20S6", "D3L25rc1.5F10S6"
PARTS = {"impeller": impeller, "fillets": partial(impeller, fillet=1.5), "off": partial(impeller, off=0.02), "plate": plate}


@cache
def part(name: str) -> Part:
    return read_part(PARTS[name]())


def ready(name: str, **options) -> Prepared:
    words = {"cutters": [BALL], "holder": "er16", "faces": "all", "spacing": 3.0, "jobs": 2, **options}
    return prepare(part(name), Options.of(words))


def both(ready: Prepared, judged=judge):
    """Verdicts with patterns and without, of the first cutter, and what was counted."""
    once = JudgeOnce(judged, 0 if ready.copies is None else len(ready.copies.motions))
    return once(ready, ready.cutters[0]), judge(ready, ready.cutters[0]), once.carried.sum(axis=0)


@pytest.mark.slow("plans a part of repeated steps", but=("impeller-options4",))
@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("impeller", {}),
        ("fillets", {"cutters": [FINE]}),
        ("plate", {"cutters": [FINE], "spacing": 2.5}),
        ("impeller", {"machine": "trunnion-ac"}),
        ("impeller", {"machine": "tilt:60", "fixtures": ["table"]}),
        ("impeller", {"cutters": ["D12L60rc1F26S12"], "holder": "er32", "tilt_deg": (0, 40)}),
    ],
)
def test_verdicts_are_those_of_every_sample_by_itself(name, options):
    part_ = ready(name, **{"spacing": 2.0, **options})
    mine, plain, (moved, followed, verified) = both(part_)
    assert np.array_equal(mine.verdict, plain.verdict)
    assert moved + followed > 0
    assert verified >= 40


def test_postures_that_are_moved_are_safe_in_their_own_place():
    part_ = ready("impeller", machine="trunnion-ac")
    mine, _, (moved, *_) = both(part_)
    assert moved > 0
    copies = part_.copies.copy & ~part_.copies.verified & (mine.verdict == ACCESSIBLE)
    assert part_.conditions.allows(mine.axis[copies]).all()
    # The axis is what tilt and tilt direction make of the normal.
    leans = copies & (mine.tilt > 0)
    made = (
        np.cos(mine.tilt[leans])[:, None] * part_.samples.normal[leans]
        + np.sin(mine.tilt[leans])[:, None] * mine.tilt_direction[leans]
    )
    assert np.abs(made - mine.axis[leans]).max() < 1e-5
    assert least_clearance(part_.samples, part_.cutters[0], mine, part_.conditions) >= -1e-9


@pytest.mark.slow("searches long", only=("options2", "options3"))
@pytest.mark.parametrize(
    "options",
    [
        {"fixtures": ["box:10,60,30@45,0,-10"]},
        {"machine": "trunnion-ac", "setup": "x"},
        {"machine": "tilt:60", "setup": "x"},
        {"fixtures": ["table:-12@0,0,0,0,10,0"]},
    ],
)
def test_what_breaks_the_pattern_is_judged_for_each(options):
    part_ = ready("impeller", **options)
    mine, plain, counted = both(part_)
    assert part_.copies is None or not part_.copies.follow.any()
    assert not counted.any()
    assert all(
        np.array_equal(getattr(mine, name), getattr(plain, name), equal_nan=True) for name in ("verdict", "axis", "reason")
    )


@pytest.mark.slow("judges many samples")
def test_ignored_faces_must_be_carried_onto_ignored_ones():
    (pattern,) = ready("impeller").patterns
    blade = pattern.faces[0]
    for ignored, follows in ((f"F{blade[0]}", False), (",".join(f"F{number}" for number in blade), True)):
        part_ = ready("impeller", ignore=ignored)
        mine, plain, _ = both(part_)
        assert (part_.copies is not None and part_.copies.follow.any()) == follows
        assert np.array_equal(mine.verdict, plain.verdict)


def test_a_blade_that_is_off_has_no_copies():
    assert ready("off").copies is None


def test_without_patterns_there_are_none():
    part_ = ready("impeller", patterns=False)
    assert part_.copies is None
    assert part_.patterns == ()


def test_one_verified_sample_with_another_verdict_ends_it():
    part_ = ready("impeller")
    plain = judge(part_, part_.cutters[0])
    tenth = np.flatnonzero(part_.copies.verified & plain.not_reached)[:1]

    def lies(ready, cutter, rows=None, known=None, *, progress=None, work=None):
        verdicts = judge(ready, cutter, rows, known, progress=progress, work=work)
        at = np.flatnonzero((ready.samples.point == part_.samples.point[tenth]).all(axis=1))
        verdict = verdicts.verdict.copy()
        verdict[at] = ACCESSIBLE
        return type(verdicts)(
            verdict, *(getattr(verdicts, each) for each in ("axis", "tilt_direction", "tilt", "rotation", "shift", "reason"))
        )

    mine, _, (_, followed, verified) = both(part_, lies)
    assert verified > 0
    assert followed == 0
    others = np.setdiff1d(np.arange(len(plain.verdict)), tenth)
    assert np.array_equal(mine.verdict[others], plain.verdict[others])


def test_a_plan_says_what_followed():
    words = {"cutters": [BALL], "holder": "er16", "faces": "all", "spacing": 3.0, "area_budget": 0}
    result = plan(part("impeller"), **words)
    (pattern,) = result.plan.patterns
    assert (pattern.kind, pattern.order, pattern.whole) == ("rotation", 6, True)
    assert len(pattern.faces) == 6
    assert pattern.moved + pattern.followed > 0
    assert any("60 deg apart: judged once" in line for line in result.plan.text.lines)
    plain = plan(part("impeller"), patterns=False, **words)
    assert plain.plan.patterns == []
    assert plain.plan.effective.patterns is False
    mine, others = result.cutters[0], plain.cutters[0]
    assert (mine.accessible, mine.inaccessible, mine.undecided) == (others.accessible, others.inaccessible, others.undecided)


def test_a_clamped_blade_says_nothing_of_the_others():
    from plan_cutters.domain.placement import Placement

    name = part("impeller").faces
    blade = next(f.id for f in name if f.surface == "cylinder" and 300 < f.area < 600)
    part_ = ready("impeller", setup=Placement(z=(0.0, 0.0, 1.0), clamped=(blade,)))
    mine, plain, _ = both(part_)
    assert np.array_equal(mine.verdict, plain.verdict)
    held = part_.samples.face == int(blade[1:])
    assert (mine.reason[held] == FIXTURE).all()
