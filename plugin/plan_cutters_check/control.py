"""Make what an entry with fixed angles must say: axis, frame, and words of the control, whose turns are made one by one."""

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from plan_cutters_check.findings import Exactly, about
from plan_cutters_check.question import FREE, MachineAxes, Question, degrees_of, other_angles, tool_frame

_NUMBER = r"(-?\d+(?:\.\d+)?)"
_PLANE = re.compile(rf"G68\.2 P0 Q313 X0 Y0 Z0 I{_NUMBER} J{_NUMBER} K{_NUMBER}")
_TURN = re.compile(r"G53\.1 P([012])")
#: Parts of unit vectors that are one, for a plane's angles have six digits; digits of an angle that a control shows, deg.
_SAME, _SHOWN = 1e-6, 0.00051
#: By how much angles may be off that are rounded for a control, deg.
_ROUNDED = 0.0015
#: Angles of the second axis that are one: then the first one may have any, deg.
_ONE = 0.01


def orientation(question: Question, each: Mapping[str, Any], within: float) -> dict[str, Any]:
    """Give what an entry with fixed angles must say: its words as they are written where these are right, else what they must do.

    `within`: by how much parts of unit axes may be off.
    """
    setup, machine, degrees = question.setups[each["setup"]], question.machine, degrees_of(question, each)
    axis, x, plane = tool_frame(question, each["setup"], degrees)
    # Of other angles that are as large any may be written.
    stated, others = each.get("other_angles_deg") or {}, other_angles(question, each["setup"], degrees[0])
    near = min(others, key=lambda one: math.dist(one, [float(stated.get(name, 0.0)) for name in machine.names]), default=None)
    other = None if near is None else dict(zip(machine.names, near, strict=True))
    free = machine.names == FREE or not {*machine.names} <= {"A", "B", "C"}
    words = {
        "g68_2": (not machine.names, _turned(str(each.get("g68_2")), plane), "words that turn the plane to the tool axis"),
        "g53_1": (not machine.names, _taken(machine, each, stated or other), "words that take these angles"),
        "rotary_words": (free, _positions(machine, each), "words with these angles"),
    }
    across = {"x": about(x.tolist(), within)} if np.isfinite(x).all() else {}
    return {
        "axis": about(axis.tolist(), within), "angles_deg": Exactly(zip(machine.names, degrees[0].tolist(), strict=True)),
        "other_angles_deg": None if other is None else Exactly({name: about(a, _ROUNDED) for name, a in other.items()}),
        "frame": {"origin": list(setup.origin or (0.0, 0.0, 0.0)), "z": about(axis.tolist(), within), **across},
        **{name: None if none else each.get(name) if good else text for name, (none, good, text) in words.items()},
    }  # fmt: skip


def _turned(words: str, plane: Floats) -> bool:
    read = _PLANE.fullmatch(words)
    if read is None:
        return False
    i, j, k = (math.radians(float(x)) for x in read.groups())
    about_z = [np.array([[math.cos(t), -math.sin(t), 0.0], [math.sin(t), math.cos(t), 0.0], [0.0, 0.0, 1.0]]) for t in (i, k)]
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, math.cos(j), -math.sin(j)], [0.0, math.sin(j), math.cos(j)]])
    x, _, z = (about_z[0] @ about_x @ about_z[1]).T
    known = bool(np.isfinite(plane[0]).all())
    return bool(np.abs(z - plane[2]).max() <= _SAME and (not known or np.abs(x - plane[0]).max() <= _SAME))


def _taken(machine: MachineAxes, each: Mapping[str, Any], other: Mapping[str, Any] | None) -> bool:
    """Whether a control whose axes are at zero takes the angles that are written, and not the other ones, by the word's P."""
    read = _TURN.fullmatch(str(each.get("g53_1")))
    if read is None:
        return False
    if machine.names == FREE or other is None:
        return read[1] == "0"
    name = machine.names[0]
    way = {"0": lambda a: min(a % 360.0, -a % 360.0), "1": lambda a: a % 360.0, "2": lambda a: 360.0 - a % 360.0}[read[1]]
    if all(abs(float(each["angles_deg"][one]) - float(other[one])) <= _ONE for one in machine.names[1:]):
        return read[1] == "0"
    mine, others = (way(float(angles[name])) for angles in (each["angles_deg"], other))
    return mine <= others + _SHOWN


def _positions(machine: MachineAxes, each: Mapping[str, Any]) -> bool:
    words = str(each.get("rotary_words")).split(" ")
    if not machine.names:
        return words == ["G54"]
    if words[:2] != ["G54", "G0"] or not all(re.fullmatch(rf"[ABC]{_NUMBER}", word) for word in words[2:]):
        return False
    read = {word[0]: float(word[1:]) for word in words[2:]}
    same = {*read} == {*machine.names} and len(read) == len(words) - 2
    return same and all(abs(read[name] - float(each["angles_deg"][name])) <= _SHOWN for name in machine.names)
