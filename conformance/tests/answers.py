"""Answers against the slow twin: what a test of a family calls."""

from functools import lru_cache
from typing import Any

import numpy as np

from conformance.exact import slow
from conformance.made.check import exempt_faces, faces_of
from conformance.made.part import TOUCH, Answer, MadePart, leaning
from conformance.made.parts import PARTS
from conformance.tool import Floats, Tool

#: Beyond the end of an interval, in deg, mm and as a share.
STEP_DEG, STEP_MM, STEP_SHARE = 0.05, 0.01, 0.005


@lru_cache(maxsize=2)
def _faces(name: str) -> list[slow.Face]:
    return faces_of(PARTS[name], 1.5)


@lru_cache(maxsize=2)
def _solid(name: str) -> Any:
    return PARTS[name].build().val().wrapped


def free(part: MadePart, tool: Tool, contact: Floats, normal: Floats, axis: Floats, lean: Floats | None = None) -> bool:
    """Whether no point of the exact surface is within the tool."""
    row = lambda v: np.array(v, float)[None]
    tip = tool.stands(row(contact), row(normal), row(axis), None if lean is None else row(lean))
    faces = _faces(part.name)
    held = exempt_faces(part, faces, row(contact))[0]
    if slow.margin(faces, held, tool, tip[0], np.array(axis, float), TOUCH) <= -TOUCH:
        return False
    return tool.corner > 0 or not edge_enters(part, tool, tip[0], np.array(axis, float), np.array(contact, float))


def edge_enters(part: MadePart, tool: Tool, tip: Floats, axis: Floats, contact: Floats) -> bool:
    """Whether points of a flat end's edge near its contact are in the solid: below a bound of curvature they enter by microns only."""
    from OCP.BRepClass3d import BRepClass3d_SolidClassifier
    from OCP.gp import gp_Pnt
    from OCP.TopAbs import TopAbs_IN

    x = (contact - tip) / np.linalg.norm(contact - tip)
    y = np.cross(axis, x)
    inside = BRepClass3d_SolidClassifier(_solid(part.name))
    for turn in np.linspace(-0.3, 0.3, 61):
        p = tip + tool.flat_radius * (np.cos(turn) * x + np.sin(turn) * y)
        inside.Perform(gp_Pnt(*(float(v) for v in p)), 1e-7)
        if inside.State() == TopAbs_IN:
            return True
    return False


def with_stickout(tool: Tool, value: float) -> Tool:
    """Return the tool with its holder's end face `value` mm above the tip."""
    shift = value - tool.holder[0][0]
    cutter = (*tool.cutter[:-1], (value, *tool.cutter[-1][1:]))
    return Tool(tool.name, cutter, tuple((v[0] + shift, *v[1:]) for v in tool.holder), tool.cutting)


def of_radius(given: dict, radius: float) -> Tool:
    """Return the end that a largest radius is about."""
    return Tool.flat(2 * radius, given["length"], corner=radius if given["end"] == "ball" else 0.0)


def wrong(part: MadePart, answer: Answer) -> list[str]:
    """Return what the slow twin does not confirm."""
    g, out = answer.given, []

    def expect(what: str, want: bool, got: bool) -> None:
        if want != got:
            out.append(f"{what}: {'blocked' if want else 'free'}")

    if answer.kind == "free_tilts":
        contact, normal, lean = (np.array(g[k]) for k in ("contact", "normal", "lean"))

        def at(tilt: float) -> bool:
            axis = leaning(normal[None], lean[None], np.radians([tilt]))[0]
            return free(part, part.tool(answer.tool), contact, normal, axis, lean)

        for low, high in answer.value:
            expect(f"{low} + step", True, at(low + STEP_DEG))
            expect(f"{high} - step", True, at(high - STEP_DEG))
            if low > STEP_DEG:
                expect(f"{low} - step", False, at(low - STEP_DEG))
            if high < 90.0 - STEP_DEG:
                expect(f"{high} + step", False, at(high + STEP_DEG))
    elif answer.kind == "largest_radius":
        for share, want in ((1 - STEP_SHARE, True), (1 + STEP_SHARE, False)):
            expect(f"radius * {share}", want, free(part, of_radius(g, answer.value * share), g["contact"], g["normal"], g["axis"]))
    elif answer.kind == "least_stickout":
        for step, want in ((STEP_MM, True), (-STEP_MM, False)):
            tool = with_stickout(part.tool(answer.tool), answer.value + step)
            expect(f"stick-out {step:+}", want, free(part, tool, g["contact"], g["normal"], g["axis"]))
    else:
        tool, axes = part.tool(answer.tool), np.array(g["axes"])
        serves = np.array([[_serves(part, tool, p, a) for p in g["places"]] for a in np.vstack([axes, _scan()])])
        expect("all axes together", True, bool(serves[: len(axes)].any(axis=0).all()))
        expect("one axis of the scan", False, bool(serves.all(axis=1).any()))
    return out


def _serves(part: MadePart, tool: Tool, place: dict, axis: Floats) -> bool:
    tilt = np.array(place["normal"]) @ axis
    return bool(tilt >= -1e-12) and free(part, tool, place["contact"], place["normal"], axis, None if tilt < 1 - 1e-9 else _across(axis))


def _across(axis: Floats) -> Floats:
    side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    return side / np.linalg.norm(side)


def _scan() -> Floats:
    """Return directions over the sphere."""
    k = np.arange(16) + 0.5
    z, turn = 1 - k / 8, np.pi * (1 + np.sqrt(5.0)) * k
    return np.column_stack([np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z])
