"""Each answer against branch and bound over the exact surface, just inside and just outside: no closed form and no points are asked."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from conformance.exact.bound import least, numbers
from conformance.exact.slow import read
from conformance.forms import Surface
from conformance.made.check import write_step
from conformance.made.confirm import surroundings
from conformance.made.part import blocked, frame, held, leaning
from conformance.made.parts import PARTS
from conformance.tool import Tool

NAMES = [name for name, part in PARTS.items() if part.twin_of is None]
#: Asked in every run, a part of most families; the others take minutes.
DAILY = {"shank_in_bore", "body_in_body", "closed_hollow", "plate_limit", "cube_five_faces", "three_sides", "opposed_slots",
         "sphere_pocket", "lens", "two_balls", "tube", "cone_boss"}  # fmt: skip
#: Beside an end of an interval (deg), of a length (mm) and of a radius (share); depths (mm) that bounds tell from none.
BESIDE_DEG, BESIDE_MM, BESIDE, SURE = 0.05, 0.01, 0.005, 4e-3


@lru_cache(maxsize=1)
def solid(name):
    """The part as another program reads it, through STEP."""
    with TemporaryDirectory() as folder:
        write_step(PARTS[name], Path(folder) / f"{name}.step")
        return read(Path(folder) / f"{name}.step")


@lru_cache(maxsize=2)
def around(name, setup_name):
    return surroundings(solid(name), PARTS[name].setup(setup_name))


def is_blocked(name, tool, setup_name, contact, normal, axis, lean=None):
    """Whether the bounds find material or a fixture in the tool, or the axis beyond the limit; None where they do not tell."""
    setup = PARTS[name].setup(setup_name)
    contact, normal, axis = (np.array(v, float) for v in (contact, normal, axis))
    axis = axis / np.linalg.norm(axis)
    if setup.limit_deg is not None and np.degrees(np.arccos(np.clip(axis @ np.array(setup.axis), -1, 1))) > setup.limit_deg:
        return True
    lean = frame(normal[None])[0] if lean is None else np.array(lean, float)[None]
    tip = tool.stands(contact[None], normal[None], axis[None], lean)[0]
    shape = around(name, setup_name)
    none = np.zeros(int(shape.cells.face.max()) + 1, bool)
    low, high, _ = least(shape, numbers(tool), tip, axis, none, enough=0.0, deep=-SURE)
    if high < 0.0 or (tool.corner == 0.0 and edge_enters(name, tool, tip, axis, contact)):
        return True
    return False if low >= -SURE else None


def edge_enters(name, tool, tip, axis, contact):
    """Whether points of a flat end's edge near its contact are in the solid: below a bound of curvature they enter by microns only."""
    from OCP.BRepClass3d import BRepClass3d_SolidClassifier
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_IN

    x = (contact - tip) / np.linalg.norm(contact - tip)
    y = np.cross(axis, x)
    inside = BRepClass3d_SolidClassifier(solid(name))
    for turn in np.linspace(-0.3, 0.3, 61):
        inside.Perform(gp_Pnt(*(float(v) for v in tip + tool.flat_radius * (np.cos(turn) * x + np.sin(turn) * y))), 1e-7)
        if inside.State() == TopAbs_IN:
            return True
    return False


def form_blocks(name, tool, setup_name, contact, normal, axis, lean=None):
    """Whether the closed forms are blocked."""
    part, row = PARTS[name], lambda v: np.array(v, float)[None]
    setup, unit = part.setup(setup_name), row(axis) / np.linalg.norm(axis)
    tip = tool.stands(row(contact), row(normal), unit, frame(row(normal))[0] if lean is None else row(lean))
    return bool(blocked(part, tool, setup, [held(m, row(contact)) for m in (*part.materials, *setup.fixtures)], unit, tip)[0])


def agree(name, tool, setup_name, free, *where):
    """Whether bounds say what is expected, and the closed form where it searches no surface; bounds that do not tell do not contradict what is free."""
    told, searched = is_blocked(name, tool, setup_name, *where), any(isinstance(m, Surface) for m in PARTS[name].materials)
    return (told is not True if free else told is True) and (searched or form_blocks(name, tool, setup_name, *where) is not free)


def expected_tilts(intervals):
    """Tilts with what is expected there: each end from both sides, the middles, and between the intervals."""
    edges = [0.0, *(x for pair in intervals for x in pair), 90.0]
    out = [(0.5 * (a + b), True) for a, b in intervals]
    for a, b in intervals:
        out += [(a + BESIDE_DEG, True), (b - BESIDE_DEG, True)]
        out += [(a - BESIDE_DEG, False)] * (a > BESIDE_DEG) + [(b + BESIDE_DEG, False)] * (b < 90.0 - BESIDE_DEG)
    for low, high in zip(edges[::2], edges[1::2], strict=True):
        if high - low > 1.0:
            out += [(low + share * (high - low), False) for share in ((0.02, 0.3, 0.7, 0.98) if not intervals else (0.5,))]
    return out


def free_tilts(name, answer):
    tool, at = PARTS[name].tool(answer.tool), answer.given
    normal, lean = np.array(at["normal"]), np.array(at["lean"])
    for tilt, free in expected_tilts(answer.value):
        axis = leaning(normal[None], lean[None], np.radians([tilt]))[0]
        yield f"{tilt} deg", agree(name, tool, answer.setup, free, at["contact"], normal, axis, lean)


def with_stickout(tool, stickout):
    shift = stickout - tool.holder[0][0]
    *lower, (top, radius) = tool.cutter
    return replace(tool, cutter=(*lower, (top + shift, radius)), holder=tuple((h + shift, *r) for h, *r in tool.holder))


def least_stickout(name, answer):
    at = answer.given
    for beside, free in ((-BESIDE_MM, False), (BESIDE_MM, True)):
        tool = with_stickout(PARTS[name].tool(answer.tool), answer.value + beside)
        yield f"{beside:+} mm", agree(name, tool, answer.setup, free, at["contact"], at["normal"], at["axis"])


def largest_radius(name, answer):
    at = answer.given
    for share, free in ((1 - BESIDE, True), (1 + BESIDE, False)):
        radius = answer.value * share
        tool = Tool.flat(2 * radius, at["length"], corner=radius if at["end"] == "ball" else 0.0)
        yield f"{share:g} of it", agree(name, tool, answer.setup, free, at["contact"], at["normal"], at["axis"])


def orientations(name, answer):
    """The axes named serve all contacts; contacts that are apart share no axis of a scan, and without such, none serves too many."""
    tool, at = PARTS[name].tool(answer.tool), answer.given

    def serves(contact, normal, axis):
        tilt = np.degrees(np.arccos(np.clip(np.dot(axis, normal), -1, 1)))
        return tilt <= at["max_tilt_deg"] + 1e-9 and is_blocked(name, tool, answer.setup, contact, normal, axis) is not True

    places = list(zip(at["contacts"], at["normals"], strict=True))
    yield "count", len(at["axes"]) == answer.value
    yield "all served", all(any(serves(*place, np.array(axis)) for axis in at["axes"]) for place in places)
    table = np.array([[serves(*place, axis) for axis in scan(500)] for place in places])
    if at["apart"]:
        yield "apart", len(at["apart"]) == answer.value and np.max(np.sum(table[at["apart"]], axis=0)) == 1
    else:
        yield "too few", np.ceil(len(places) / np.max(np.sum(table, axis=0))) == answer.value


def scan(count):
    """Directions spread over the sphere."""
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (1 + np.sqrt(5.0)) * k
    return np.column_stack([np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z])


KINDS = {"free_tilts": free_tilts, "least_stickout": least_stickout, "largest_radius": largest_radius, "orientations": orientations}


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in DAILY else pytest.mark.slow) for n in NAMES])
def test_bounds_confirm_each_answer(name):
    answers = PARTS[name].answers
    assert [(k, what) for k, answer in enumerate(answers) for what, holds in KINDS[answer.kind](name, answer) if not holds] == []


def test_a_wrong_answer_is_seen():
    part = PARTS["three_sides"]
    right = PARTS["plate_limit"].answers[0]
    assert right.kind == "free_tilts"
    [[low, high]] = right.value
    wrong = replace(right, value=[[low, high - 0.25]])
    assert not all(holds for _, holds in free_tilts("plate_limit", wrong))
    few = next(a for a in part.answers if a.kind == "orientations")
    assert not all(holds for _, holds in orientations("three_sides", replace(few, value=few.value - 1)))


def test_enough_parts_and_answers():
    assert len(NAMES) >= 40
    assert sum(len(PARTS[name].answers) for name in NAMES) >= 100
