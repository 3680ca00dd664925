"""The checker's own geometry, against points all over the exact surface, closed forms, and the search itself."""

import math
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from cad_io import read_part
from cad_io.kernel import values
from plan_cutters import Cutter, Options
from plan_cutters.domain.outline import outline, points
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.fixed_axis import served_by
from plan_cutters_check.asking import sizes_of
from plan_cutters_check.bench import Bench, Contacts
from plan_cutters_check.question import MachineAxes, Setup, axes_of, other_angles
from plan_cutters_check.surface import FREE, MET, Cells, Clock, Face, met
from plan_cutters_check.tool import tool_of
from tests.support.places import ROOT

PEAKS = str(ROOT / "samples/peaks_and_valleys.step")
CUTTERS = [
    Cutter.parse("R6L60"), Cutter.parse("R6L60rc6"), Cutter.parse("R4L50rc1F14S3HR16L40"), Cutter.parse("R3L40rc1T5F12S3"),
    Cutter.lollipop(radius=4, neck_radius=2, length=40),
    Cutter.barrel(radius=5, flank_radius=40, tip_radius=2, length=40, flutes=12),
    Cutter.barrel(radius=5, flank_radius=40, height=6, length=40, flutes=12),
    Cutter.lens(radius=5, bottom_radius=20, corner_radius=1, length=40, flutes=10),
    Cutter.form([(0, 0), (2, 0), (4, 1), (4, 8)], length=30),
]  # fmt: skip
NAMES = ["flat", "ball", "bull_holder", "tapered", "lollipop", "barrel_tip", "barrel", "lens", "form"]
#: Those of which every run of the tests takes points all over a surface.
_QUICK = ("flat", "bull_holder")
NEVER = Clock(math.inf)


def polyline_distance(border, q, h):
    """Distance of points (n,) from a closed outline, by its chords, and whether they lie within: by brute force."""
    a, b = border[:-1], border[1:]
    side = b - a
    to = np.stack([q, h], axis=1)[:, None] - a
    share = np.clip((to * side).sum(axis=2) / np.maximum((side**2).sum(axis=1), 1e-300), 0.0, 1.0)
    away = np.linalg.norm(to - share[..., None] * side, axis=2).min(axis=1)
    rises = (a[:, 1] <= h[:, None]) != (b[:, 1] <= h[:, None])
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (h[:, None] - a[:, 1]) * side[:, 0] / side[:, 1]
    within = (rises & (at > q[:, None])).sum(axis=1) % 2 == 1
    return away, within


@pytest.mark.parametrize("cutter", CUTTERS, ids=NAMES)
def test_points_lie_within_the_solids_if_they_lie_within_the_outline(cutter):
    """The checker's solids against the outline that the program draws, which is its own."""
    tool = tool_of(sizes_of(cutter))
    border = points(outline(cutter), 1e-4)
    rng = np.random.default_rng(0)
    q, h = rng.uniform(0.0, 1.3 * border[:, 0].max(), 4000), rng.uniform(-3.0, tool.high + 3.0, 4000)
    deep = np.max([solid.depth(q, h)[0] for solid in tool.solids], axis=0)
    away, within = polyline_distance(border, q, h)
    sure = away > 1e-3
    assert ((deep > 0.0) == within)[sure].all()
    # Outside, the depth is less the distance; within, it is no more than that.
    outside = sure & ~within
    assert np.abs(-deep[outside] - away[outside]).max() < 1e-3
    assert (deep[within] <= away[within] + 1e-3).all()


def test_half_a_turn_either_way_is_as_large():
    """A control may show -180 or 180: whichever is written, it is the other solution."""
    machine = MachineAxes(("C", "A"), np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.array([[-400.0, 400.0], [-110.0, 110.0]])
                          * math.pi / 180.0, np.array([0.0, 0.0, 1.0]), math.pi, rates=False)  # fmt: skip
    question = SimpleNamespace(machine=machine, setups=(Setup((0.0, 0.0, 1.0), None, None, (), frozenset()),))
    assert sorted(other_angles(question, 0, np.array([0.0, 30.0]))) == [(-180.0, -30.0), (180.0, -30.0)]
    assert other_angles(question, 0, np.array([90.0, 30.0])) == [(-90.0, -30.0)]


@pytest.mark.parametrize("cutter", CUTTERS, ids=NAMES)
def test_the_depth_lies_below_its_tangent_planes(cutter):
    """What the bound over a cell rests on: the depth in each solid is a concave function of the point."""
    rng = np.random.default_rng(1)
    tool = tool_of(sizes_of(cutter))
    wide = points(outline(cutter), 1e-3)[:, 0].max()
    p, r = (rng.uniform(-1.0, 1.0, (3000, 3)) * [2 * wide, 2 * wide, tool.high] for _ in range(2))
    for solid in tool.solids:
        there, (deep, g_q, g_h) = solid.depth(np.hypot(*r.T[:2]), r[:, 2])[0], solid.depth(np.hypot(*p.T[:2]), p[:, 2])
        unit = p[:, :2] / np.hypot(*p.T[:2])[:, None]
        gradient = np.column_stack([g_q[:, None] * unit, g_h])
        assert (there <= deep + ((r - p) * gradient).sum(axis=1) + 1e-9).all()


@pytest.mark.parametrize("cutter", CUTTERS, ids=NAMES)
def test_a_tool_touches_at_its_contact(cutter):
    """Put down on a plane it touches it at the contact, and is nowhere below it."""
    tool = tool_of(sizes_of(cutter))
    border = points(outline(cutter), 1e-3)
    for degrees in (0.0, 0.5, 20.0, 60.0, 80.0):
        tilt = math.radians(degrees)
        axis, normal = np.array([[math.sin(tilt), 0.0, math.cos(tilt)]]), np.array([[0.0, 0.0, 1.0]])
        tip = tool.tips(np.zeros((1, 3)), normal, axis, np.array([[1.0, 0.0, 0.0]]))
        if not np.isfinite(tip).all():
            assert cutter.shape in ("barrel", "lens", "end", "form")
            continue
        # The lowest point of a circle about the axis, and of them all that of the part that cuts.
        cutting = border[border[:, 1] <= tool.solids[0].high + 1e-9] if cutter.shape != "form" else border[border[:, 1] <= 8.0]
        low = tip[0, 2] + cutting[:, 1] * math.cos(tilt) - cutting[:, 0] * math.sin(tilt)
        assert abs(low.min()) < 2e-3, degrees


@pytest.fixture(scope="module")
def peaks():
    part = read_part(PEAKS)
    cells = Cells()
    return part, cells, cells.add([Face(part, 1, "F1")])


@pytest.mark.slow("checks a plan many times", only=("bull",))
@pytest.mark.parametrize("of", [3, pytest.param(1, marks=pytest.mark.slow("looks at points all over the surface"))])
@pytest.mark.parametrize(
    "cutter",
    [
        pytest.param(each, marks=[pytest.mark.slow("looks at points all over the surface")] * (name not in _QUICK), id=name)
        for each, name in zip(CUTTERS, NAMES, strict=True)
    ],
)
def test_what_is_met_is_what_points_all_over_the_surface_say(peaks, cutter, of):
    """Tools in random places, one of so many, against 250,000 points of the surface."""
    part, cells, root = peaks
    tool, rng = tool_of(sizes_of(cutter)), np.random.default_rng(2)
    u0, u1, v0, v1 = part.trim(1).box
    u, v = (each.ravel() for each in np.meshgrid(np.linspace(u0, u1, 500), np.linspace(v0, v1, 500)))
    exact = values(part.adaptor(1), u, v)
    tip = exact[rng.integers(0, len(exact), 30)] + rng.uniform(-0.3, 2.0, (30, 1)) * [0.0, 0.0, 1.0]
    axis = rng.normal(size=(30, 3)) * 0.3 + [0.0, 0.0, 1.0]
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    found = met(cells, root, tool, tip, axis, (0.01, 0.0), 5e-4, NEVER)
    for k in range(0, 30, of):
        away = exact - tip[k]
        h = away @ axis[k]
        q = np.linalg.norm(away - h[:, None] * axis[k], axis=1)
        over = max(float(solid.depth(q, h)[0].max()) - (0.01 if solid.part == "flutes" else 0.0) for solid in tool.solids)
        if over > 0.0:
            assert found.verdict[k] == MET
        elif over < -0.05:
            # Points are 0.2 mm apart.
            assert found.verdict[k] == FREE
        if found.verdict[k] == MET:
            assert found.depth[k] > 0.0


def test_a_check_that_has_no_time_decides_nothing(peaks):
    _, cells, root = peaks
    tool = tool_of(sizes_of(CUTTERS[0]))
    found = met(
        cells, root, tool, np.zeros((3, 3)), np.tile([0.0, 0.0, 1.0], (3, 1)), (0.01, 0.0), 5e-4, Clock(time.monotonic() - 1.0)
    )
    assert not np.isin(found.verdict, (FREE, MET)).any()


@pytest.mark.slow("checks a plan many times", but=("words2",))
@pytest.mark.parametrize("words", [
    {"part": "samples/pocket_top.step", "cutters": ["R3L40rc1F12S3"], "holder": "er16",
     "fixtures": ["table", "box:10,10,25@-12,5,0"], "faces": "all", "grid": 5},
    {"part": "samples/peaks_and_valleys.step", "cutters": ["R6L60"], "grid": 9, "holder_clearance": 0.5},
    {"part": "samples/peaks_and_valleys.step", "cutters": ["R6L40rc2F15S4HR20L30"], "grid": 9, "allowance": 0.2},
])  # fmt: skip
def test_the_search_and_the_checker_agree(words):
    """At random samples and tilted axes: what the search serves is free, and what is free by more than its triangles are off is
    served.

    The two share no line: a fault of either shows here.
    """
    part = str(ROOT / words["part"])
    options = Options(machine="trunnion-ac", **{name: each for name, each in words.items() if name != "part"})
    ready = prepare(part, options)
    samples, cutter = ready.samples, ready.cutters[0]
    from plan_cutters_check.asking import bodies_of
    from plan_cutters_check.question import MachineAxes, Question

    machine = MachineAxes(
        ("C", "A"), np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.array([[-math.inf, math.inf], np.radians([-30.0, 120.0])]),
        np.array([0.0, 0.0, 1.0]), math.pi, False,
    )  # fmt: skip
    setup = Setup((0.0, 0.0, 1.0), None, None, tuple(body for each in options.fixtures for body in bodies_of(each)), frozenset())
    arrays = {"point": samples.point, "normal": samples.normal, "direction_max": samples.direction_max, "face": samples.face}
    # Verdicts with a contact elsewhere than at the sample are none of this.
    arrays[f"axis_{cutter.id}"] = np.full_like(samples.point, np.nan)
    document = {"effective": {"tilt_deg": [0.0, 90.0], "rotation_deg": [0.0, 360.0]}}
    question = Question(
        read_part(part), machine, {cutter.id: sizes_of(cutter)}, (setup,), frozenset(), np.zeros(0), 0.01, document, {}, arrays
    )
    # A search may refuse what is deeper than a part of the tolerance, or nearer than another part of it, as not proved.
    sizes = replace(question.tools[cutter.id], clearance=question.tools[cutter.id].clearance + 0.6 * question.tolerance)
    near = replace(question, tools={cutter.id: sizes}, tolerance=0.25 * question.tolerance)
    benches = [Bench(each, lambda doing: None) for each in (question, near)]
    rng = np.random.default_rng(3)
    angle = np.column_stack([rng.uniform(-180.0, 180.0, 40), rng.uniform(-30.0, 90.0, 40)])
    axes = axes_of(machine, setup, np.vstack([angle, [[0.0, 0.0], [90.0, 90.0], [0.0, 90.0]]]))
    rows = np.arange(len(samples))
    served = served_by(rows, axes, samples, Context.of(cutter, ready.conditions))[0]
    free = both = 0
    for axis, search in zip(axes, served, strict=True):
        turned = np.repeat(axis[None], len(rows), axis=0)
        tilted = np.abs(samples.normal @ axis - 0.5) < 0.495
        at = Contacts(samples.point, samples.normal, benches[0].own_tilt_direction(rows, turned))
        surely, strictly = (bench.put_down(0, bench.tools[cutter.id], rows, turned, at, NEVER)[0] == FREE for bench in benches)
        inside = ready.inside >= 0
        assert not (search & ~surely & tilted).any()
        assert not (strictly & ~search & ~inside & tilted).any()
        free, both = free + int((search & tilted).sum()), both + int((~search & ~surely & tilted).sum())
    assert free > 100
    assert both > 100
