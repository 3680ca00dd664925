"""The answers of a made part against branch and bound over its exact surface, just inside and just outside."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from conformance.exact.bound import least, numbers
from conformance.forms import Surface
from conformance.made.confirm import Around
from conformance.made.part import Answer, blocked, frame, held, leaning
from conformance.tool import Floats, Tool

#: Beside an end of an interval (deg), of a length (mm) and of a radius (share); a depth (mm) that the bounds surely tell from none.
BESIDE_DEG, BESIDE_MM, BESIDE, SURE = 0.05, 0.01, 0.005, 4e-3
#: Directions of a scan.
_SCAN = 500

#: What was looked at with what is expected there, and whether it is so.
Look = tuple[str, bool]


class Asked:
    """A part that can be asked whether a tool is blocked, by bounds and by its closed forms."""

    def __init__(self, around: Around) -> None:
        self.part, self.around = around.part, around
        self.searched = any(isinstance(m, Surface) for m in around.part.materials)

    def bounds(self, tool: Tool, setup_name: str, contact: Any, normal: Any, axis: Any, lean: Any = None) -> bool | None:
        """Whether the bounds find material or a fixture in the tool, or the axis beyond the limit; None where they do not tell."""
        setup = self.part.setup(setup_name)
        contact, normal, axis = (np.array(v, float) for v in (contact, normal, axis))
        axis = axis / np.linalg.norm(axis)
        if setup.limit_deg is not None and np.degrees(np.arccos(np.clip(axis @ np.array(setup.axis), -1, 1))) > setup.limit_deg:
            return True
        tip = tool.stands(contact[None], normal[None], axis[None], frame(normal[None])[0] if lean is None else np.array(lean, float)[None])[0]
        low, high, _ = least(self.around.of(setup_name), numbers(tool), tip, axis, enough=0.0, deep=-SURE)
        if high < 0.0 or (tool.corner == 0.0 and self._edge_enters(tool, tip, axis, contact)):
            return True
        return False if low >= -SURE else None

    def _edge_enters(self, tool: Tool, tip: Floats, axis: Floats, contact: Floats) -> bool:
        """Whether points of a flat end's edge near its contact are in the solid: below a bound of curvature they enter by microns only."""
        from OCP.BRepClass3d import BRepClass3d_SolidClassifier
        from OCP.gp import gp_Pnt
        from OCP.TopAbs import TopAbs_IN

        x = (contact - tip) / np.linalg.norm(contact - tip)
        y = np.cross(axis, x)
        inside = BRepClass3d_SolidClassifier(self.around.shape)
        for turn in np.linspace(-0.3, 0.3, 61):
            inside.Perform(gp_Pnt(*(float(v) for v in tip + tool.flat_radius * (np.cos(turn) * x + np.sin(turn) * y))), 1e-7)
            if inside.State() == TopAbs_IN:
                return True
        return False

    def form(self, tool: Tool, setup_name: str, contact: Any, normal: Any, axis: Any, lean: Any = None) -> bool:
        """Whether the closed forms are blocked."""
        row = lambda v: np.array(v, float)[None]
        setup, unit = self.part.setup(setup_name), row(axis) / np.linalg.norm(axis)
        tip = tool.stands(row(contact), row(normal), unit, frame(row(normal))[0] if lean is None else row(lean))
        return bool(blocked(self.part, tool, setup, [held(m, row(contact)) for m in (*self.part.materials, *setup.fixtures)], unit, tip)[0])

    def look(self, what: str, free: bool, tool: Tool, setup_name: str, *where: Any) -> Look:
        """Return what was looked at, what is expected there, and whether it is so; bounds that do not tell do not contradict what is free.

        A form that searches a surface misses micrometres now and then: it is not asked.
        """
        told = self.bounds(tool, setup_name, *where)
        right = (told is not True if free else told is True) and (self.searched or self.form(tool, setup_name, *where) is not free)
        return f"{what}: {'free' if free else 'blocked'}", right


def doubts(around: Around) -> Iterator[str]:
    """Yield a line for each look at an answer that is not as the answer has it."""
    asked = Asked(around)
    for k, answer in enumerate(asked.part.answers):
        for what, right in _KINDS[answer.kind](asked, answer):
            if not right:
                yield f"answer {k}, {answer.kind} = {answer.value} ({answer.formula}): expected at {what}"


def _free_tilts(asked: Asked, answer: Answer) -> Iterator[Look]:
    tool, at = asked.part.tool(str(answer.tool)), answer.given
    normal, lean = np.array(at["normal"]), np.array(at["lean"])
    for tilt, free in expected_tilts(answer.value):
        axis = leaning(normal[None], lean[None], np.radians([tilt]))[0]
        yield asked.look(f"{tilt:.4f} deg", free, tool, answer.setup, at["contact"], normal, axis, lean)


def expected_tilts(intervals: list[list[float]]) -> list[tuple[float, bool]]:
    """Return tilts with what is expected there: each end from both sides, the middles, and between the intervals."""
    edges = [0.0, *(x for pair in intervals for x in pair), 90.0]
    out = [(0.5 * (a + b), True) for a, b in intervals]
    for a, b in intervals:
        out += [(a + BESIDE_DEG, True), (b - BESIDE_DEG, True)]
        out += [(a - BESIDE_DEG, False)] * (a > BESIDE_DEG) + [(b + BESIDE_DEG, False)] * (b < 90.0 - BESIDE_DEG)
    for low, high in zip(edges[::2], edges[1::2], strict=True):
        if high - low > 1.0:
            out += [(low + share * (high - low), False) for share in ((0.02, 0.3, 0.7, 0.98) if not intervals else (0.5,))]
    return out


def with_stickout(tool: Tool, stickout: float) -> Tool:
    """Return the tool with its holder's end face `stickout` mm above the tip."""
    shift = stickout - tool.holder[0][0]
    *lower, (top, *radius) = tool.cutter
    return replace(tool, cutter=(*lower, (top + shift, *radius)), holder=tuple((h + shift, *r) for h, *r in tool.holder))


def _least_stickout(asked: Asked, answer: Answer) -> Iterator[Look]:
    at = answer.given
    for beside, free in ((-BESIDE_MM, False), (BESIDE_MM, True)):
        tool = with_stickout(asked.part.tool(str(answer.tool)), answer.value + beside)
        yield asked.look(f"{answer.value + beside:.4f} mm", free, tool, answer.setup, at["contact"], at["normal"], at["axis"])


def _largest_radius(asked: Asked, answer: Answer) -> Iterator[Look]:
    at = answer.given
    for share, free in ((1 - BESIDE, True), (1 + BESIDE, False)):
        radius = answer.value * share
        tool = Tool.flat(2 * radius, at["length"], corner=radius if at["end"] == "ball" else 0.0)
        yield asked.look(f"radius {radius:.4f} mm", free, tool, answer.setup, at["contact"], at["normal"], at["axis"])


def _orientations(asked: Asked, answer: Answer) -> Iterator[Look]:
    """The axes named serve all contacts; contacts that are apart share no axis of a scan, and without such, none serves too many."""
    tool, at = asked.part.tool(str(answer.tool)), answer.given

    def serves(contact: Any, normal: Any, axis: Any) -> bool:
        tilt = np.degrees(np.arccos(np.clip(np.dot(axis, normal), -1, 1)))
        return bool(tilt <= at["max_tilt_deg"] + 1e-9) and asked.bounds(tool, answer.setup, contact, normal, axis) is not True

    places = list(zip(at["contacts"], at["normals"], strict=True))
    yield "as many axes as the answer says", len(at["axes"]) == answer.value
    yield "each contact is served by one of the axes", all(any(serves(*place, np.array(axis)) for axis in at["axes"]) for place in places)
    table = np.array([[serves(*place, axis) for axis in _scan()] for place in places])
    if at["apart"]:
        apart = len(at["apart"]) == answer.value and np.max(np.sum(table[at["apart"]], axis=0)) == 1
        yield f"no direction of a scan serves two of the contacts {at['apart']}, as many as the answer says", bool(apart)
    else:
        most = int(np.max(np.sum(table, axis=0)))
        yield f"a direction serves at most {most} of {len(places)} contacts: as many as the answer says are needed", -(-len(places) // most) == answer.value


def _scan() -> Floats:
    """Return directions spread over the sphere."""
    k = np.arange(_SCAN) + 0.5
    z, turn = 1 - 2 * k / _SCAN, np.pi * (1 + np.sqrt(5.0)) * k
    return np.column_stack([np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z])


_KINDS = {"free_tilts": _free_tilts, "least_stickout": _least_stickout, "largest_radius": _largest_radius, "orientations": _orientations}
