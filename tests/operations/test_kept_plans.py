"""What plans of small parts say, whole, and what the searches find on the way, as it is kept in `kept`.

The numbers are awkward on purpose: nothing is symmetric, and no two choices take the same time.
"""

import math
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import Machine, operations, plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.placement import Placement
from plan_cutters.operations import canonical, choices, moving_axes, planning, plans
from plan_cutters.operations import choices as companions
from plan_cutters.operations import motion as at_once
from plan_cutters.operations.passes import Extents, Paths
from plan_cutters.operations.task import thinned
from plan_cutters.options import Options
from tests.support.patterns import impeller
from tests.support.shapes import Patch
from tests.support.traced import traced


def wedge():
    """A block with a slanted top, a pocket with round corners, a drafted pad, and a groove in its side."""
    block = cq.Workplane("XY").box(47.0, 33.0, 21.0, centered=False)
    slant = cq.Workplane("XZ").moveTo(29.0, 21.0).lineTo(47.0, 21.0).lineTo(47.0, 12.3).close().extrude(-33.0)
    pocket = cq.Workplane("XY").workplane(offset=13.7).center(12.5, 15.0).rect(15.0, 17.0).extrude(9.0).edges("|Z").fillet(4.3)
    groove = cq.Workplane("YZ").center(16.0, 0.0).circle(4.1).extrude(47.0)
    pad = cq.Workplane("XY").workplane(offset=21.0).center(23.5, 27.5).rect(9.0, 7.0).extrude(5.2, taper=7.0)
    return block.cut(slant).cut(pocket).cut(groove).union(pad)


def patch():
    return Patch.random(np.random.default_rng(5), size=43.0, height=1.1, n=6).face()


def rated(name, *rates):
    """A machine whose rotary axes turn at so many deg/s."""
    machine = Machine.parse(name)
    turning = zip(machine.axes, rates, strict=True)
    return replace(machine, axes=tuple(replace(axis, rate=math.radians(rate)) for axis, rate in turning))


FLAT, BULL, BALL, CONE = "D9L55rc0F17", "D7L50rc1.3F14", "D5L45rc2.5F11", "D4L40rc0.9T7F9"
ALL = {"faces": "all", "area_budget": 0, "spacing": 8.7, "jobs": 1, "scallop": 0.013, "change_time": 11.3}

#: Parts with what they are judged with.
JUDGED = {
    "wedge": (wedge, {"cutters": [FLAT, BULL, BALL], "machine": "trunnion-ac"}),
    "rated": (wedge, {"cutters": [BULL, CONE], "machine": rated("trunnion-ac", 31.0, 17.0), "spacing": 9.7}),
    "two": (
        wedge,
        {
            "cutters": [FLAT, BALL],
            "machine": rated("head-table-bc", 29.0, 23.0),
            "spacing": 9.7,
            "setup": Placement((0.0, 0.0, 1.0), origin=(3.1, -2.2, 5.7), fixtures=(Fixture.parse("box:9,11,12@-9,7,-3"),)),
            "other_setups": [Placement((0.0, -1.0, 0.0), clamped=("F3",))],
        },
    ),
    "tilt": (wedge, {"cutters": [FLAT, BALL], "machine": "tilt:47", "setup": (0.0, 0.0, 1.0), "spacing": 9.7}),
    "patch": (patch, {"cutters": [BALL, "D6L45rc0.7F12"], "machine": "head-head-ca", "holder": "er16", "faces": None}),
    "blades": (
        lambda: impeller(4).rotate((0, 0, 0), (0, 0, 1), 7.3),
        {"cutters": ["D4L30rc2F6S4", "D5L31rc0.8F7"], "machine": "trunnion-ac", "spacing": 13.0, "holder": "er16"},
    ),
    "nearly": (
        lambda: impeller(3, off=0.03).rotate((0, 0, 0), (0, 0, 1), 7.3),
        {"cutters": ["D4L30rc2F3S4"], "machine": rated("trunnion-ac", 210.0, 170.0), "spacing": 13.0, "holder": "er16"},
    ),
}


@cache
def judged(name):
    """What planning is given of a part."""
    shape, options = JUDGED[name]
    seen = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planning, "plan_operations", lambda *given: seen.append(given))
        plan(shape(), **{**ALL, **options}, operations="fewest")
    ((ready, everywhere, least, _, _),) = seen
    return ready, everywhere, least


@contextmanager
def untold(_name):
    yield lambda done, total: None


#: Prices go up in steps that follow from each other: after hundreds of them rounding shows in the third digit of a bound. Other
#: functions return how many threads there are.
UNSURE = {"fastest.lagrange", "fastest.Reach.gained", "fastest.Reach.of", "fastest.bounded", "planning.plan_operations",
          "by_pattern.planned_by_pattern", "fastest.against_bound", "plans.orientations_of", "symmetry.symmetry_of"}  # fmt: skip


def planned(name, some=2500, **options):
    """The plans of a part, with what all functions found on the way; choices are compared at about so many samples."""
    ready, everywhere, least = judged(name)
    ready = replace(ready, options=Options.of({**ALL, **JUDGED[name][1], **options}))
    with traced(operations) as seen, pytest.MonkeyPatch.context() as patch:
        for module, word, degrees in COARSE:
            patch.setattr(module, word, math.radians(degrees))
        patch.setattr(choices, "_FINER", (math.radians(11.0),))
        patch.setattr(planning._first, "__defaults__", (math.radians(19.0),))
        patch.setattr(planning, "thinned", lambda task: thinned(task, some))
        result = planning.plan_operations(ready, everywhere, least, untold, 0)
    # of orientations as far from a written one any comes first
    until = None if ready.options.process is None else -1
    if result.entry.fastest is not None:
        unsure = {"bound_seconds": 0.0, "gap": None}
        fastest = result.entry.fastest.model_copy(update=unsure)
        result = replace(result, entry=result.entry.model_copy(update={"fastest": fastest}))
    return {
        "plans": result,
        "seen": {each: sums.told()[:until] for each, sums in seen.items() if sums.calls and each not in UNSURE},
    }


#: Candidates are laid farther apart than plans lay them, deg, so that a plan takes a second.
COARSE = [(planning, "STEP", 17.0), (planning, "FINEST", 4.3), (choices, "COARSE", 23.0)]

FEEDS = {"feed": 870.0, "index_time": 3.7}
CASES = {
    "both": ("wedge", {"operations": "both", **FEEDS}),
    "fewest": ("wedge", {"operations": "fewest"}),
    "few": ("wedge", {"operations": "both", "most_operations": 7, **FEEDS}),
    "locked": ("rated", {"operations": "both", "feed": 870.0, "index_step_deg": 22.5}),
    "moving": ("wedge", {"operations": "fastest", "max_orientations": 2, **FEEDS, "some": 60}),
    "two_of_some": ("two", {"operations": "fastest", "feed": 870.0, "setup_time": 41.0, "some": 40}),
    "rated": ("rated", {"operations": "both", "feed": 870.0}),
    "rated_proved": ("rated", {"operations": "fewest", "feed": 870.0, "area_budget": 900}),
    "tilt": ("tilt", {"operations": "both", **FEEDS}),
    "patch": ("patch", {"operations": "fastest", "max_orientations": 1, "area_budget": 9000, **FEEDS}),
    "patch_as_usual": ("patch", {"operations": "fewest", "max_orientations": 1, "area_budget": None, "most_operations": 1}),
    "blades": ("blades", {"operations": "fastest", **FEEDS, "index_time": 0.3}),
    "nearly": ("nearly", {"operations": "fastest", "feed": 870.0}),
    "own": ("wedge", {"process": {"step": [
        {"cutter": FLAT, "angles": {"C": 0.0, "A": 0.0}, "faces": ["F1", "F2", "F3", "F4", "F5"]},
        {"cutter": BALL, "axis": [0.6, 0.0, 0.8], "faces": ["F6", "F7", "F8"], "take": "share"},
        {"cutter": BULL, "angles": {"C": 90.0, "A": 37.5}, "faces": ["F6", "F7", "F8"], "take": "share"},
        {"cutter": BALL, "mode": "simultaneous", "faces": ["F9", "F10"]},
        {"cutter": BALL, "mode": "simultaneous", "faces": ["F11", "F12"], "take": "share"},
        {"cutter": FLAT, "angles": {"C": 0.0, "A": 125.0}, "faces": ["F13"]},
    ], "rest": "plan", "forbid": [{"cutter": FLAT, "faces": ["F14", "F15"]}]}, **FEEDS}),
    "own_left": ("two", {"process": {"step": [
        {"cutter": FLAT, "setup": 2, "angles": {"B": 5.0, "C": 12.3456}},
        {"cutter": BALL, "angles": {"C": 31.0, "B": 43.21}, "faces": ["F6", "F7", "F8"]},
    ], "rest": "leave"}, "feed": 870.0}),
}  # fmt: skip


def task_of(name, **options):
    """The task of a part."""
    ready, everywhere, least = judged(name)
    return planning._task(replace(ready, options=Options.of({**ALL, **JUDGED[name][1], **options})), everywhere, least)


#: Angles of C and A, deg, some of them nearer to each other than the axes are accurate, and their cutters.
WRITTEN = [
    ([(0.0, 5.111), (0.0, 5.151), (90.0, 43.219)], [0, 0, 1]),
    ([(17.317, 31.233), (17.319, 31.241), (179.987, 88.931)], [2, 1, 2]),
    ([(-90.003, 89.997), (44.93, 12.04), (44.95, 12.06), (0.0, 0.0)], [2, 2, 2, 0]),
]


def columns_at(task, angles, cutters):
    angle, axis = task.orientations[0].set_to(np.array(angles))
    return Columns(np.array(cutters, np.int32), np.zeros(len(cutters), np.int32), axis, angle)


@pytest.mark.slow("plans, judges or places a part at length; others of its kind run every time")
def test_choices_of_columns_are_what_they_were(keeps):
    """Written shorter and joined, left to simultaneous motion one by one, with other cutters beside them."""
    found = {}
    for accuracy, how in ((0.03, {}), (0.1, {"feed": 870.0}), (0.5, {"feed": 870.0, "index_time": 0.7, "max_orientations": 1})):
        task = task_of("wedge", axis_accuracy=math.radians(accuracy), operations="both" if how else "fewest", **how)
        for k, written in enumerate(WRITTEN):
            columns = columns_at(task, *written)
            with traced(operations) as seen:
                choices_ = [canonical.canonical(task, columns), at_once.recommended(task, columns),
                            at_once.fewer(task, columns), companions.accompanied(task, columns),
                            plans.worth_their_turn(task, columns), plans.best_area(task, columns, 2),
                            plans.best_area(task, columns, None), plans.plan_with(task, "fewest", columns)]  # fmt: skip
                with pytest.MonkeyPatch.context() as patch:
                    for step in ("_preferred", "_shortened"):
                        patch.setattr(canonical, step, lambda choice, *_: choice)
                    choices_.append(canonical.canonical(task, columns))
            told = [each.angle if isinstance(each, Columns) else [(len(some), total) for some, total in each]
                    for each in choices_ if not hasattr(each, "operations")]  # fmt: skip
            found[f"{accuracy} {k}"] = {"choices": told, "seen": {each: sums.told() for each, sums in seen.items() if sums.calls}}
    keeps("columns", found)


def test_motion_whose_time_is_not_known_is_as_slow_as_the_slowest_column(keeps):
    task = task_of("wedge", feed=870.0, index_time=0.7, operations="both")
    lost = np.arange(len(task.ready.samples)) % 3 == 0
    widest = task.moving.widest

    def partly_known(cutter, setup, rows):
        axis, width = widest(cutter, setup, rows)
        return axis, np.where(lost[rows], np.nan, width)

    task = replace(task, moving=SimpleNamespace(widest=partly_known))
    keeps(
        "unknown",
        [[(len(some), total) for some, total in at_once.fewer(task, columns_at(task, *written))] for written in WRITTEN],
    )


def test_moving_axes_are_what_they_were(keeps):
    """Axes over faces that bend, some of them tried that hit, and some that gouge."""
    ready, everywhere, *_ = judged("wedge")
    samples, rng, found = ready.samples, np.random.default_rng(8), {}
    for cutter in ready.cutters:
        verdicts = everywhere[0][cutter]
        rows = np.flatnonzero(verdicts.reached)
        paths = Paths(0.01, 0.75, None, 1e-3, Extents(samples, ready.conditions.obstacles))
        moving = moving_axes.MovingAxes(samples, ready.cutters, ready.setups, everywhere, paths)
        test, k = moving._test(ready.cutters.index(cutter), 0), ready.cutters.index(cutter)
        tried = verdicts.axis[rows] + 0.5 * rng.normal(size=(len(rows), 3))
        tried[::9] = samples.normal[rows[::9]]
        tried /= np.linalg.norm(tried, axis=1)[:, None]
        axis = moving.smooth(k, 0, rows)
        free = [test.free(rows, each) for each in (tried, verdicts.axis[rows], axis[rows])]
        found[cutter.id] = [axis, test.margin(rows, tried), free, sorted(moving_axes.fields(samples, axis))]
    keeps("axes_moving", found)


@pytest.mark.slow(
    "plans, judges or places a part at length; others of its kind run every time",
    only=("blades", "locked", "nearly", "two_of_some", "tilt", "rated_proved", "both"),
)
@pytest.mark.parametrize("case", CASES)
def test_plans_are_what_they_were(keeps, case):
    name, options = CASES[case]
    keeps(case, planned(name, **options))
