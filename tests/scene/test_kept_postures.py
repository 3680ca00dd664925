"""What the scene says of postures among small parts is kept in `kept`: conditions, axes that stay, flats, flanks, clearance."""

from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import Cutter, Machine, PostureRange
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.machine import Axis
from plan_cutters.domain.verdicts import UNDECIDED, UNJUDGED, blank
from plan_cutters.judging.judge import judge
from plan_cutters.scene.conditions import (
    Conditions,
    Context,
    contacts_of,
    laid_tool_of,
    require_finite,
    rotations_of,
    search_postures,
    tool_of,
    tools,
)
from plan_cutters.scene.distances import clearances, clearances_over, deepest, deepest_of, deepest_on, least_clearance
from plan_cutters.scene.fixed_axis import along, at_fixed_axis, held_at, leaning, served_by
from plan_cutters.scene.flats_and_flanks import _at_angle, _nearest, on_the_flank, on_the_flat, search
from plan_cutters.scene.work import Work
from tests.support.grooves import leaning as leaning_groove
from tests.support.grooves import off_level, tee
from tests.support.kept_parts import ready, ready_of
from tests.support.serving import serves

UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
CUTTERS = {
    "flat": Cutter.parse("D8L40F25S8"), "holder": Cutter.parse("D3.1L23F7N2.7x9S4.4HR9.3L31"), "bull": Cutter.parse("D6L30rc1"),
    "ball": Cutter.parse("D5L30rc2.5"),
    "necked": Cutter.parse("D7L30rc1.1F6N6x10S7"), "taper": Cutter.flat(radius=2, length=40, taper=0.05),
    "barrel": Cutter.barrel(radius=2, flank_radius=20, tip_radius=0.7, length=40, flutes=7.0),
    "lens": Cutter.lens(radius=3, bottom_radius=15, corner_radius=0.5, length=40),
    "lollipop": Cutter.lollipop(radius=2, neck_radius=1, length=40),
    "slot": Cutter.form(((0, 0), (3.7, 0), (3.7, 1.9), (1.5, 1.9)), length=27.0),
}  # fmt: skip
MACHINES = ("unlimited", "tilt:35", "3-axis", "4-axis-a", "trunnion-ac", "head-head-ca", "nutating-bc")


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def among(made, machine="unlimited", setup=UP, tolerance=0.01, accuracy=0.0, **posture):
    """Conditions among the obstacles of a part that is ready."""
    around = made.conditions.surroundings
    return Conditions(Machine.parse(machine), np.array(setup), PostureRange(**posture), around, tolerance, 1, accuracy=accuracy)


def blocks():
    return ready("bodies", cutters=("D3L18",), grid=4)


@pytest.mark.parametrize("name", CUTTERS)
def test_a_cutter_under_conditions(name, keeps):
    said, made = {}, blocks()
    for tolerance in (0.01, 0.2):
        context = Context.of(CUTTERS[name], among(made, tolerance=tolerance))
        said[str(tolerance)] = [context.outer, context.inner, context.dummy, context.proved_at, context.judges,
                                laid_tool_of(context.outer_tool), tools(CUTTERS[name], tolerance, 0.003)[1].mode]  # fmt: skip
    keeps(f"cutter_{name}", said)


def test_limits_of_machines(keeps):
    rng, said = np.random.default_rng(2), {}
    axis = unit(np.concatenate([rng.normal(size=(60, 3)), [UP, DOWN, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]]))
    for machine in MACHINES:
        for setup in (UP, (0.6, 0.0, 0.8)):
            conditions = among(blocks(), machine, setup, tilt=(0.2, 1.4), rotation=(0.3, 3.0))
            said[f"{machine} {setup}"] = [conditions.ranges, conditions.allows(axis), conditions.upright(axis), conditions.frame,
                                          conditions.without_machine().allows(axis).all()]  # fmt: skip
    said["upright"] = among(blocks(), "tilt:35").upright(axis)
    said["rotations"] = rotations_of(axis[:9], unit(rng.normal(size=(9, 3))), unit(rng.normal(size=(9, 3))))
    contacts = contacts_of(blocks().samples)
    for k in range(4):
        bad = contacts._replace(**{contacts._fields[k]: np.where(np.arange(len(contacts[k])) == 3, np.nan, contacts[k].T).T})
        with pytest.raises(ValueError, match="finite"):
            require_finite(bad, np.arange(5))
        require_finite(bad, np.arange(4, 9))
        context, verdicts = Context.of(CUTTERS["ball"], among(blocks())), blank(len(contacts.point))
        with pytest.raises(ValueError, match="finite"):
            search_postures(bad, np.arange(5), context, verdicts)
        assert (verdicts.verdict == UNJUDGED).all()
    keeps("machines", said)


GROOVES = {
    "leaning": lambda: leaning_groove(0.03, 9.3, 9.1),
    "level": lambda: off_level(0.04, 7.0, 6.0),
    "tee": lambda: tee(3.1, 4.4, 19.1, 21.3),
    "bracket": "bracket",
}


@pytest.mark.slow("plans, judges or places a part at length; others of its kind run every time", only=("tee",))
@pytest.mark.parametrize("name", GROOVES)
def test_flats_and_flanks(name, keeps):
    of = GROOVES[name]
    made = ready(of, cutters=("D3L20",), grid=4) if isinstance(of, str) else ready_of(of(), cutters=("D3L20",), grid=5)
    samples, said = made.samples, {}
    contacts, rows = contacts_of(samples), np.flatnonzero(samples.unjudged < 0)
    for cutter in ("flat", "taper", "slot", "necked"):
        for machine, accuracy, posture in (
            ("3-axis", 0.0, {}),
            ("4-axis-a", 0.002, {}),
            ("tilt:35", 0.0, {"tilt": (0.0, np.pi)}),
            ("trunnion-ac", 0.001, {"rotation": (0.2, 5.0)}),
            ("trunnion-ac", 0.0, {}),
        ):
            conditions = among(made, machine, accuracy=accuracy, **posture)
            context, verdicts, counted = Context.of(CUTTERS[cutter], conditions), blank(len(samples)), Work()
            search(contacts, samples.face, rows, context, verdicts, fixed=True, work=counted)
            said[f"{cutter} {machine} {len(posture)}"] = [verdicts, counted.looked]
    for after in (on_the_flat, lambda contacts, *given: on_the_flank(contacts, samples.face, *given)):
        context, verdicts = Context.of(CUTTERS["flat"], among(made, "3-axis")), blank(len(samples))
        verdicts.verdict[:] = UNDECIDED
        verdicts.reason[::2] = 4
        after(contacts, rows, context, verdicts)
        said[f"alone {len(said)}"] = verdicts
    keeps(f"flats_{name}", said)


@pytest.mark.parametrize("name", ["bracket", "deep"])
def test_axes_that_stay(name, keeps):
    made, said = ready(name, cutters=("D3L20",), grid=5), {}
    samples, rows = made.samples, np.arange(0, len(made.samples), 2)
    axes = unit(np.array([[0.0, 0.0, 1.0], [0.4, 0.1, 0.9], [1.0, 0.0, 0.0], [0.0, -0.7, 0.7], [1e-5, 0.0, 1.0]]))
    for cutter in ("flat", "bull", "ball", "slot"):
        for k, how in enumerate(({}, {"accuracy": 0.01, "tolerance": 0.05}, {"machine": "tilt:35"},
                                 {"rotation": (0.2, 4.0), "tilt": (0.1, 1.2)})):  # fmt: skip
            context, told = Context.of(CUTTERS[cutter], among(made, **how)), []
            free, count = served_by(rows, axes, samples, context, lambda *each, told=told: told.append(each))
            number = np.where(np.arange(len(samples)) % 3 == 0, np.arange(len(samples)) % 5, -1).astype(np.int32)
            held = held_at(axes, number, samples, context)
            taken = at_fixed_axis(samples, held, 0.05)
            said[f"{cutter} {k}"] = {
                "free": free, "count": count, "told": told, "serves": serves(rows, axes[0], samples, context),
                "leaning": leaning(rows, axes[1], samples, context), "held": held, "along": along(held),
                "none": served_by(rows[:0], axes, samples, context)[1],
            } | ({"point": taken.point, "normal": taken.normal} if not k else {})  # fmt: skip
    keeps(f"axes_{name}", said)


@pytest.mark.parametrize("end", [0, 1])
def test_axes_at_the_ends_of_what_was_asked_serve(end):
    """Tilts and rotations that are an end but for rounding serve, those beyond it by 1e-7 do not: nothing else is in the way."""
    made, rng = blocks(), np.random.default_rng(23 + end)
    n = len(made.samples)
    normal = unit(rng.normal(size=(n, 3)))
    direction = unit(np.cross(normal, rng.normal(size=(n, 3))))
    far = made.samples.point.max(axis=0) + 300.0 * unit(rng.normal(size=(n, 3)))
    samples = replace(
        made.samples, point=far + 300.0 * normal, normal=normal, direction_max=direction, curvature=np.zeros((n, 2))
    )
    left, tilts, turns = np.cross(normal, direction), (0.3, 1.1), (0.7, 2.9)
    outward = 2 * end - 1
    for by_tilt, by_turn, serve in (
        (0.0, None, True),
        (None, 0.0, True),
        (0.0, 0.0, True),
        (1e-7, None, False),
        (None, 1e-7, False),
    ):
        tilt = 0.7 if by_tilt is None else tilts[end] + outward * by_tilt
        turn = 1.9 if by_turn is None else turns[end] + outward * by_turn
        lean = np.cos(turn) * direction + np.sin(turn) * left
        axis = np.cos(tilt) * normal + np.sin(tilt) * lean
        context = Context.of(CUTTERS["ball"], among(made, tilt=tilts, rotation=turns))
        free = [serves(np.array([k]), axis[k], samples, context)[0] for k in range(0, n, 5)]
        assert all(free) if serve else not any(free), (by_tilt, by_turn)


def test_axes_at_an_angle_to_normals(keeps):
    """Of machines with one axis that turns the tool, square to it and askew, and with none."""
    rng, said = np.random.default_rng(14), []
    normal = unit(np.concatenate([rng.normal(size=(30, 3)), [UP, (1.0, 0.0, 0.0)]]))
    for axes in ([], [Axis("A", "rotary", "part", (1, 0, 0))], [Axis("B", "rotary", "tool", (0.6, 0, 0.8), limits=(-1.0, 2.0))]):
        conditions = replace(among(blocks()), machine=Machine("mine", axes=axes, fixed=True))
        kinematics = conditions.kinematics.turning()[0]
        with np.errstate(invalid="ignore"):
            said += [[*_at_angle(normal, cosine, kinematics)] for cosine in (0.0, 0.3, -0.5)]
        said.append(_nearest(normal, conditions))
    keeps("at_an_angle", said)


def test_searches(keeps):
    made, said = blocks(), {}
    samples, contacts = made.samples, contacts_of(made.samples)
    rows = np.flatnonzero(samples.unjudged < 0)
    for name, cutter in CUTTERS.items():
        for strict, brief in ((False, False), (True, False), (False, True)):
            context, verdicts, counted = Context.of(cutter, among(made, "tilt:35")), blank(len(samples)), Work()
            search_postures(contacts, rows, context, verdicts, strict=strict, brief=brief, fixed=True, work=counted)
            said[f"{name} {strict:d}{brief:d}"] = [
                verdicts.verdict,
                verdicts.axis,
                verdicts.rotation,
                verdicts.reason,
                counted.looked,
            ]
    keeps("searches", said)


@pytest.mark.slow("plans, judges or places a part at length; others of its kind run every time")
def test_clearance(keeps):
    from tests.support.two_setups import two

    made, said = ready("bodies", cutters=("D3L18",), grid=4, fixtures=("box:9,40,50@18.5,-5,3",)), {}
    samples = made.samples
    for name in ("holder", "flat", "barrel", "ball"):
        cutter = CUTTERS[name]
        reach = judge(made, cutter)
        said[name] = [
            clearances(samples, cutter, reach, made.conditions),
            least_clearance(samples, cutter, reach, made.conditions),
        ]
    # Among faces that triangles follow within an error.
    round_ = ready("bracket", cutters=("D3L20",), grid=4)
    found = judge(round_, CUTTERS["holder"])
    said["round"] = [clearances(round_.samples, CUTTERS["holder"], found, round_.conditions),
                     least_clearance(round_.samples, CUTTERS["holder"], found, round_.conditions)]  # fmt: skip
    nothing = replace(reach, verdict=np.full(len(samples), UNJUDGED, np.uint8))
    said["nothing"] = [
        clearances(samples, cutter, nothing, made.conditions),
        least_clearance(samples, cutter, nothing, made.conditions),
    ]
    missing = replace(made.conditions, surroundings=replace(made.conditions.surroundings, missing=((3, "no reason", "box"),)))
    said["guessed"] = clearances(samples, cutter, reach, missing)
    from tests.support.cad_parts import box

    both = two(box())
    (name,) = both.reaches
    [cutter] = both.ready.cutters
    said["setups"] = [
        clearances_over(both.samples, cutter, both.reaches[name], setups, which)
        for setups, which in (
            (both.ready.setups, both.served_in[name]),
            (both.ready.setups[:1], both.served_in[name]),
            (both.ready.setups, None),
        )
    ]
    keeps("clearance", said)


def test_what_is_deepest_in_a_tool(keeps):
    made, rng, said = ready("bracket", cutters=("D3L20",), grid=4), np.random.default_rng(6), {}
    samples, obstacles, part = made.samples, made.conditions.obstacles, made.scene.part
    triangle = rng.normal(size=(3, 3))
    said["on"] = [deepest_on(triangle, lambda points, k=k: -np.linalg.norm(points - triangle[k] - 0.1, axis=1)) for k in range(3)]
    said["of"] = {name: deepest_of(cutter) for name, cutter in CUTTERS.items()}
    for name in ("holder", "flat", "ball"):
        cutter = CUTTERS[name]
        for row in (5, 40, 77, 120, 200):
            n, e1 = samples.normal[row], samples.direction_max[row]
            posture = blank(1)
            posture.tilt[:], posture.tilt_direction[0] = 0.7, e1
            posture.axis[0] = np.cos(0.7) * n + np.sin(0.7) * e1
            for of, guess in ((part, 0.2), (None, 0.02), (None, 3.0)):
                found = deepest(of, obstacles, cutter, samples.point[row], n, posture.freeze() if of is None else posture, guess)
                said[f"{name} {row} {of is None} {guess}"] = found
    said["tool"] = tool_of(assembly(CUTTERS["holder"], 0.1, 0.1))
    keeps("deepest", said)
