"""What is kept of the kernels' answers: each tool among waves, walls and bodies, asked each question there is."""

import math

import numpy as np
import pytest

from cad_io.arrays import Triangles
from plan_cutters import Cutter, plan
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.holder import Segment
from plan_cutters.domain.machine import builtin_machines
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.verdicts import blank
from plan_cutters.kernels import material
from plan_cutters.kernels.limits import any_axis
from plan_cutters.kernels.linear import within as cells
from plan_cutters.kernels.linear.sections import OneFace, extents
from plan_cutters.kernels.maps.free_tilts import free_tilts
from plan_cutters.kernels.rows import Contacts
from plan_cutters.kernels.search import search
from plan_cutters.kernels.search.fixed_axis import served
from plan_cutters.kernels.search.flats_and_flanks import along_flank, upright
from plan_cutters.kernels.search.search import free
from plan_cutters.scene.conditions import rotary_of, tool_of, verdict_arrays_of
from plan_cutters.scene.obstacles import Obstacles
from tests.support import shapes, waves
from tests.support.tool_kinds import TOOLS

KINDS = {
    **TOOLS,
    "flat": Cutter.flat(radius=2.3, length=31.0),
    "necked": Cutter.parse("D6L60F12N5x25S8"),
    "slot": Cutter(
        4.0, 50.0, 0.0, shape="form", outline=((0, 0), (4, 0), (4, 3), (1.5, 3)), neck=Segment(1.5, 30.0), shank_radius=2.0
    ),
    "dovetail": Cutter.flat(
        radius=4.0, length=40.0, flutes=6.0, taper=np.radians(-20.0), neck=Segment(1.6, 15.0), shank_radius=2.0
    ),
    "rounded": Cutter(
        3.0, 40.0, 0.0, shape="form", outline=((0, 0), (1.2, 0), (3, 1.7), (2.6, 4.4)), neck=Segment(1.5, 30.0), shank_radius=3.0
    ),
}  # fmt: skip
#: Turned so that no direction is an axis.
SETUP = np.array([0.31, -0.17, 0.94]) / np.linalg.norm([0.31, -0.17, 0.94])
MACHINES = ("trunnion-ac", "head-table-bc", "4-axis-a")


def soup(rng, count, low, high, size):
    """Triangles (n, 3, 3) anywhere in a box."""
    return rng.uniform(low, high, (count, 1, 3)) + rng.normal(0, size, (count, 3, 3))


def around():
    """Closed bodies over waves, of which one is inside out, as obstacles with what they enclose."""
    rng = np.random.default_rng(2)
    vertex, weight = [waves.triangles(15)], [np.zeros(2 * 14 * 14, np.int8)]
    for i, middle in enumerate([(9.1, 12.3, 9.7), (27.3, 21.9, 12.1), (15.7, 31.1, 6.3)]):
        triangles, counted, _ = waves.hull_of(np.array(middle) + rng.normal(0, 2.1, (14, 3)), inside_out=i == 1)
        vertex.append(triangles)
        weight.append(counted)
    corner = np.ascontiguousarray(np.concatenate(vertex))
    return Obstacles(Triangles(corner, np.ones(len(corner), np.int32), 0.013, ()), np.concatenate(weight))


@pytest.fixture(scope="module")
def obstacles():
    return around()


def ranges(machine):
    """Postures of a machine or within 47 deg of the setup: 9 rotations that are nowhere alike."""
    turns = 2 * np.pi * (np.arange(9) / 9 + 0.013 * np.arange(9) ** 0.5)
    made = waves.ranges(turns, math.cos(0.83) if machine is None else -2.0, (0.02, 1.41))
    kinematics = builtin_machines()[machine].kinematics(frame_of(SETUP)) if machine else None
    return made._replace(setup=SETUP, rotary=rotary_of(kinematics))


@pytest.mark.parametrize("kind", KINDS)
def test_searches_say_what_is_kept(keeps, kind, obstacles):
    cutter, contacts = KINDS[kind], waves.samples(6)
    rows, solids, found = np.arange(36), obstacles.solids, {}
    outer, inner = (tool_of(assembly(cutter, deep, 0.4 * deep)) for deep in (0.017, 0.029))
    for machine in (None, *MACHINES):
        answers, held = verdict_arrays_of(blank(36)), np.zeros(36, bool)
        looked = search.search(rows, contacts, ranges(machine), outer, inner, solids, solids, answers, deep=0.03)
        reason = np.full(36, 9, np.uint8)
        search.first_reason(rows, contacts, ranges(machine), inner, solids, reason)
        any_axis(rows, contacts.normal, contacts.direction_max, ranges(machine), 0.3, 0.9, held)
        found[str(machine)] = [answers._asdict(), int(looked > 0), reason, held]
    clear = np.zeros(36, bool)
    search.dummy_clear(rows, contacts, assembly(cutter, 0.017, 0.007).dummy, outer, solids, clear)
    keeps(f"search_{kind.replace(' ', '_')}", {"answers": found, "clear": clear})


@pytest.mark.parametrize("kind", KINDS)
def test_postures_and_tilts_say_what_is_kept(keeps, kind, obstacles):
    rng, contacts = np.random.default_rng(7), waves.samples(13)
    n, solids, made = 169, obstacles.solids, assembly(KINDS[kind], 0.017, 0.007)
    tool, rows = tool_of(made), np.arange(169)
    turn, tilt = rng.uniform(0, 2 * np.pi, n), rng.uniform(0, 1.5, n)
    left = np.cross(contacts.normal, contacts.direction_max)
    lean = np.cos(turn)[:, None] * contacts.direction_max + np.sin(turn)[:, None] * left
    axis = np.cos(tilt)[:, None] * contacts.normal + np.sin(tilt)[:, None] * lean
    stands, triangle, which = np.zeros(n, bool), np.zeros(n, np.int32), np.zeros(n, np.int32)
    free(rows, contacts.point, contacts.normal, axis, lean, tool, solids, stands)
    search.probe(rows, contacts.point, contacts.normal, axis, lean, tool, solids.tree, triangle, which)
    fixed = []
    for about in ((0.002, -1.0, False), (0.03, 0.02, True)):
        way, direction = np.zeros(n, np.int8), np.zeros((n, 3))
        for up in ((0.0, 0.0, 1.0), tuple(SETUP), tuple(contacts.normal[40])):
            served(rows, np.array(up), contacts, 0.0, 1.3, about, tool, solids, way, direction)
            fixed.append((way.copy(), np.where(way[:, None] >= 0, direction, 0.0)))
    some = Contacts(*(np.ascontiguousarray(each[::9]) for each in contacts))
    maps = waves.mapped(np.arange(len(some.point)), some, ranges(None), tool, solids.tree)
    tilts = [
        free_tilts(contacts.point[i], contacts.normal[i], lean[i], low, high, tool, mode, 0.002, solids.tree, 64)
        for i in range(0, n, 17)
        for mode, (_, _, low, high, _) in enumerate(made.mode)
    ]
    shown = [part[np.argsort(part[:, 0], kind="stable")] for part in tilts]
    keeps(f"postures_{kind.replace(' ', '_')}", [stands, triangle, which, fixed, maps, np.concatenate(shown)])


@pytest.mark.parametrize("kind", ["flat", "bull", "tapered flat", "holder", "necked", "slot", "dovetail", "rounded"])
def test_places_under_flats_and_along_flanks_say_what_is_kept(keeps, kind):
    rng, made = np.random.default_rng(11), assembly(KINDS[kind], 0.0, 0.0)
    tool, up = tool_of(made), np.array([[0.0, 0.0, 1.0]])
    floor, found = Contacts(np.zeros((1, 3)), up, np.array([[0.8, 0.6, 0.0]]), np.zeros((1, 2))), []
    for _ in range(40):
        corner = soup(rng, int(rng.integers(2, 9)), (-6, -6, 0.4), (6, 6, 20), 2.7)
        corner[:, :, 2] = np.maximum(corner[:, :, 2], 0.1)
        solids = Obstacles(Triangles(corner, np.ones(len(corner), np.int32), 0.0, ())).solids
        result, lean = np.zeros(1, np.int8), np.zeros((1, 3))
        upright(np.zeros(1, np.int64), floor, up, tool, solids, 0.5, 0.13, result, lean)
        found.append([int(result[0]), *lean[0].tolist()])
        for flank in made.flanks:
            corner = soup(rng, int(rng.integers(1, 6)), (0.5, -7, -9), (9, 7, 30), 2.3)
            corner[:, :, 0] = np.maximum(corner[:, :, 0], 0.2)
            solids = Obstacles(Triangles(corner, np.ones(len(corner), np.int32), 0.0, ())).solids
            normal = np.array([[np.sin(flank.tilt), 0.0, np.cos(flank.tilt)]])
            wall = Contacts(np.zeros((1, 3)), normal, np.array([[0.0, 1.0, 0.0]]), np.zeros((1, 2)))
            state, shift, reason = np.zeros(1, np.int8), np.zeros((1, 3)), np.zeros(1, np.uint8)
            along_flank(
                np.zeros(1, np.int64), up, wall, (flank.mode, flank.length), np.array([0.0, 0.04]), tool, solids, 0.5,
                state, shift, reason, np.full(1, -1),
            )  # fmt: skip
            found.append([int(state[0]), int(reason[0]), *shift[0].tolist()])
    keeps(f"places_{kind.replace(' ', '_')}", [np.array(row, float) for row in found])


def test_trees_and_bodies_say_what_is_kept(keeps, obstacles):
    rng, solids = np.random.default_rng(5), obstacles.solids
    points = rng.uniform((0, 0, -8), (40, 40, 20), (700, 3))
    winding, near, inside = np.zeros(700), np.zeros(700, bool), np.zeros(700, bool)
    material.windings(points, solids, winding)
    material.near_shell(points, 0.9, solids, near)
    material.far_inside(points, 0.4, solids, inside)
    cell = np.zeros((17, 19, 13), np.uint8)
    cells.mark_shell(solids.tree.vertex[::5], 0.37, np.array([3.1, 2.3, -6.1]), 1.7, cell)
    trees = [waves.tree_of(soup(rng, count, -9, 9, 1.3)) for count in (1, 7, 8, 9, 200)]
    face = waves.triangles(9)
    own = OneFace(waves.tree_of(face), np.ones(len(face), np.int32), 1)
    point = waves.samples(5).point
    lines = []
    for band in (0.01, 0.4, 2.0):
        low, high = np.zeros(25), np.zeros(25)
        extents(point, np.tile([0.6, 0.8, 0.0], (25, 1)), np.tile([0.0, 0.0, 1.0], (25, 1)), own, band, low, high)
        lines.append((low, high))
    keeps("trees_and_bodies", [solids._replace(key=0), winding, near, inside, cell, trees, lines])


PARTS = {
    "trough": lambda: shapes.trough(7.3, 9.1),
    "bowl": lambda: shapes.bowl(11.3),
    "ridge": lambda: shapes.ridge(6.1, 9.7),
    "waves": lambda: shapes.Patch.random(np.random.default_rng(4), 31.0, 1.1, 6).face(),
}
ASKED = {"grid": 4, "setup": "+z", "faces": "all", "rotation_step_deg": 30, "jobs": 1}


@pytest.mark.parametrize("part", PARTS)
def test_radii_and_stick_outs_say_what_is_kept(keeps, part):
    tools = [KINDS[kind] for kind in ("holder", "necked", "flat", "taper", "barrel", "slot")]
    result = plan(PARTS[part](), cutters=tools, machine="trunnion-ac", answers=("stick-out", "radius"), area_budget=0, **ASKED)
    told = {"reaches": result.reaches, "stick_outs": result.answers.stick_outs, "radii": result.answers.radius_maps}
    keeps(f"radii_{part}", told)


#: Gentle enough that cells are proved, and not all of them.
GENTLE = {
    "trough": lambda: shapes.trough(23.0, 1.1, 0.21),
    "ridge": lambda: shapes.ridge(1.7, 0.9),
    "waves": lambda: shapes.Patch.random(np.random.default_rng(4), 6.1, 0.031, 4).face(),
}


@pytest.mark.parametrize("kind", KINDS)
def test_areas_say_what_is_kept(keeps, kind):
    found = {}
    for part in GENTLE:
        result = plan(GENTLE[part](), cutters=[KINDS[kind]], machine="tilt:70", area_budget=700, **ASKED)
        found[part] = [result.plan.cutters[0].area, *(each.verdict for each in result.reaches.values())]
    keeps(f"areas_{kind.replace(' ', '_')}", found)
