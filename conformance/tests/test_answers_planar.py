"""Answers of planar parts and machines, each against the slow twin: points of the exact surface, just inside and just outside."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from conformance.exact import slow
from conformance.made import bodies, holders, machines, slots, walls
from conformance.made.blocks import cuboid
from conformance.made.check import exempt_faces, faces_of
from conformance.made.part import TOUCH, blocked, frame, held
from conformance.tool import Tool

#: Points of the exact surface take minutes for all of them.
pytestmark = pytest.mark.slow
PARTS = {part.name: part for family in (walls, slots, holders, bodies, machines) for part in family.PARTS}
CASES = [(name, i) for name, part in PARTS.items() for i in range(len(part.answers))]

#: The pitch (mm) of the twin's points, how far from an end (deg, mm) is asked, and the depth (mm) that counts as blocked.
PITCH, BESIDE_DEG, BESIDE_MM, DEPTH = 4.0, 0.05, 0.01, 3e-4


def of_kind(kind):
    return [case for case in CASES if PARTS[case[0]].answers[case[1]].kind == kind]


@cache
def part_faces(name):
    return faces_of(PARTS[name], PITCH)


@cache
def own_faces(name, contact):
    return exempt_faces(PARTS[name], part_faces(name), np.array([contact]))[0]


@cache
def fixture_faces(name, setup_name):
    """The setup's boxes as solids; a table as a large box below its height."""
    setup = PARTS[name].setup(setup_name)
    solids = [cuboid(*corners) for corners in setup.boxes]
    if setup.table is not None:
        solids.append(cuboid((-120.0, -120.0, setup.table - 10.0), (120.0, 120.0, setup.table)))
    return [face for solid in solids for face in slow.faces(solid.val().wrapped, 3 * PITCH if setup.table is not None else PITCH)]


def stands(tool, contact, normal, axis, lean):
    axis, normal = np.atleast_2d(axis), np.atleast_2d(normal)
    axis = axis / np.linalg.norm(axis, axis=1)[:, None]
    lean = frame(normal)[0] if lean is None else np.atleast_2d(lean)
    return axis, tool.stands(np.atleast_2d(contact), normal, axis, lean)


def is_blocked(name, tool, setup_name, contact, normal, axis, lean=None):
    """Whether the twin finds material or fixture in the tool, or the axis beyond the limit."""
    setup = PARTS[name].setup(setup_name)
    axis, tip = stands(tool, contact, normal, np.array(axis, float), lean)
    if setup.limit_deg is not None and np.degrees(np.arccos(np.clip(axis[0] @ np.array(setup.axis), -1, 1))) > setup.limit_deg:
        return True
    faces = part_faces(name)
    fixed = fixture_faces(name, setup_name)
    exempt = [*own_faces(name, tuple(contact)), *(False for _ in fixed)]
    quick = [float(np.min(tool.signed(np.vstack([f.points, f.edges]), tip[0], axis[0]))) for f in (*faces, *fixed)]
    for least, face, own in sorted(zip(quick, (*faces, *fixed), exempt, strict=True), key=lambda row: row[0]):
        if least < -DEPTH:
            return True
        # No point is farther from the next one of the grid than half the diagonal of a cell: no depth is possible here.
        if least > 0.75 * (3 * PITCH if setup.table is not None else PITCH):
            break
        value = slow.least(face, tool, tip[0], axis[0], rounds=24)
        if value < -DEPTH:
            return True
        assert own or value > -TOUCH, "neither safe nor blocked by more than the tolerance"
    return False


def form_blocks(name, tool, setup_name, contact, normal, axes, lean=None):
    """Whether the closed forms are blocked at each of the axes."""
    part = PARTS[name]

    def many(v):
        return np.tile(np.array(v, float), (len(axes), 1))

    axis, tip = stands(tool, many(contact), many(normal), np.array(axes, float), many(frame(np.array([normal]))[0][0] if lean is None else lean))
    setup = part.setup(setup_name)
    holds = [held(m, many(contact)) for m in (*part.materials, *setup.fixtures)]
    return blocked(part, tool, setup, holds, axis, tip).tolist()


def tilted(normal, lean, tilt):
    t = np.radians(tilt)
    return np.cos(t) * np.array(normal) + np.sin(t) * np.array(lean)


def expected_tilts(intervals):
    """Tilts with what is expected there: each end from both sides, the middles, and between the intervals."""
    edges = [0.0, *(x for pair in intervals for x in pair), 90.0]
    out = [(0.5 * (a + b), True) for a, b in intervals]
    for a, b in intervals:
        out += [(a + BESIDE_DEG, True), (b - BESIDE_DEG, True)]
        out += [(a - BESIDE_DEG, False)] * (a > 0.0) + [(b + BESIDE_DEG, False)] * (b < 90.0)
    for low, high in zip(edges[::2], edges[1::2], strict=True):
        if high - low > 1.0:
            out += [(low + share * (high - low), False) for share in ((0.02, 0.3, 0.7, 0.98) if not intervals else (0.5,))]
    return out


@pytest.mark.parametrize(("name", "number"), of_kind("free_tilts"))
def test_free_tilts(name, number):
    answer = PARTS[name].answers[number]
    tool, at = PARTS[name].tool(answer.tool), answer.given
    expected = expected_tilts(answer.value)
    axes = [tilted(at["normal"], at["lean"], tilt) for tilt, _ in expected]
    for axis, (tilt, free) in zip(axes, expected, strict=True):
        assert is_blocked(name, tool, answer.setup, at["contact"], at["normal"], axis, at["lean"]) is not free, f"{tilt} deg"
    assert form_blocks(name, tool, answer.setup, at["contact"], at["normal"], axes, at["lean"]) == [not free for _, free in expected]


def with_stickout(tool, stickout):
    shift = stickout - tool.holder[0][0]
    *lower, (top, radius) = tool.cutter
    return replace(tool, cutter=(*lower, (top + shift, radius)), holder=tuple((h + shift, r) for h, r in tool.holder))


@pytest.mark.parametrize(("name", "number"), of_kind("least_stickout"))
def test_least_stickout(name, number):
    answer = PARTS[name].answers[number]
    at = answer.given
    for beside, hit in ((-BESIDE_MM, True), (BESIDE_MM, False)):
        tool = with_stickout(PARTS[name].tool(answer.tool), answer.value + beside)
        where = (name, tool, answer.setup, at["contact"], at["normal"])
        assert is_blocked(*where, at["axis"]) is hit
        assert form_blocks(*where, [at["axis"]]) == [hit]


@pytest.mark.parametrize(("name", "number"), of_kind("largest_radius"))
def test_largest_radius(name, number):
    answer = PARTS[name].answers[number]
    at, length = answer.given, PARTS[name].tool(answer.tool).length
    for beside, hit in ((BESIDE_MM, True), (-BESIDE_MM, False)):
        tool = Tool.ball(2 * (answer.value + beside), length)
        where = (name, tool, answer.setup, at["contact"], at["normal"])
        assert is_blocked(*where, at["axis"]) is hit
        assert form_blocks(*where, [at["axis"]]) == [hit]


def directions(step):
    """Unit vectors about `step` degrees apart."""
    out = []
    for low in np.arange(-90.0, 90.1, step):
        turns = np.arange(0.0, 359.9, step / max(np.cos(np.radians(low)), 0.02))
        z = np.full(len(turns), np.sin(np.radians(low)))
        out.append(np.column_stack([np.cos(np.radians(low)) * np.cos(np.radians(turns)), np.cos(np.radians(low)) * np.sin(np.radians(turns)), z]))
    return np.vstack(out)


def may_serve(name, tool, contact, normal, most, axes):
    """Which axes (n,) the twin's points leave: never fewer than those that are free."""
    open_ = axes @ np.array(normal) >= np.cos(np.radians(most)) - 1e-12
    points = np.vstack([face.points for face in part_faces(name)])
    points = points[np.linalg.norm(points - np.array(contact), axis=1) < 30.0]
    for few in (points[::10], points):
        for rows in np.array_split(np.flatnonzero(open_), 40):
            if len(rows):
                axis, tip = stands(
                    tool, np.tile(contact, (len(rows), 1)), np.tile(normal, (len(rows), 1)), axes[rows], np.tile(frame(np.array([normal]))[0], (len(rows), 1))
                )
                open_[rows] = np.min(tool.signed(few[None], tip[:, None], axis[:, None]), axis=1) > -DEPTH
    return open_


@pytest.mark.parametrize(("name", "number"), of_kind("orientations"))
def test_orientations(name, number):
    answer = PARTS[name].answers[number]
    tool, at = PARTS[name].tool(answer.tool), answer.given
    assert len(at["axes"]) == answer.value
    for contact, normal in zip(at["contacts"], at["normals"], strict=True):
        tilts = [np.degrees(np.arccos(np.clip(np.dot(a, normal), -1, 1))) for a in at["axes"]]
        assert any(
            tilt <= at["max_tilt_deg"] and not is_blocked(name, tool, answer.setup, contact, normal, a) for a, tilt in zip(at["axes"], tilts, strict=True)
        ), contact
    axes = directions(2.0)
    serves = np.array([may_serve(name, tool, c, n, at["max_tilt_deg"], axes) for c, n in zip(at["contacts"], at["normals"], strict=True)])
    if at["apart"]:
        assert len(at["apart"]) == answer.value
        assert np.max(np.sum(serves[at["apart"]], axis=0)) == 1
    else:
        assert np.ceil(len(at["contacts"]) / np.max(np.sum(serves, axis=0))) == answer.value


def test_a_wrong_answer_is_seen():
    answer = PARTS["plate_and_wall"].answers[0]
    tool, at = PARTS["plate_and_wall"].tool(answer.tool), answer.given
    [[_, high]] = answer.value
    wrong = [
        is_blocked("plate_and_wall", tool, answer.setup, at["contact"], at["normal"], tilted(at["normal"], at["lean"], t), at["lean"]) is not free
        for t, free in expected_tilts([[0.0, high + 0.2]])
    ]
    assert not all(wrong)


def test_enough_parts_and_answers():
    assert len(PARTS) >= 22
    assert len(CASES) >= 40
