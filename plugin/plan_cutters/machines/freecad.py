"""FreeCAD machines, `.fcm`: axes with a role each, and a parent.

What its own solver does with them (Path/Base/Generator/rotation.py) decides how they are meant: positive angles of an axis that
carries the part are those of the table's own motion, by the right-hand rule; of two axes on one side, the one about Z is the
farther from the tool, whichever is the parent. For other pairs on one side the solver and the parents contradict each other.
"""

from typing import Any

from plan_cutters.domain.checks import shown
from plan_cutters.domain.machine import Axis, Carried, Machine
from plan_cutters.errors import MachineError
from plan_cutters.machines import chain
from plan_cutters.machines.chain import Added, Content

_SIDES: dict[str, Carried] = {"table": "part", "head": "tool"}
_TYPES = {"linear": "linear", "rotary": "rotary", "angular": "rotary"}
#: Speeds are given for a minute.
_MINUTE = 60.0
_MOST = 64


def is_fcm(content: Content) -> bool:
    """JSON with axes of a machine."""
    data = content.json
    if not isinstance(data, dict):
        return False
    inner = data.get("machine", data)
    return isinstance(inner, dict) and isinstance(inner.get("axes"), dict)


def read_fcm(content: Content, added: Added) -> Machine:
    """Read it."""
    added.refuse(content.name, sign=True)
    data = content.json.get("machine", content.json)
    axes: dict[str, Any] = data["axes"]
    if len(axes) > _MOST:
        raise MachineError(f"it lists {len(axes)} axes: no machine has as many")
    length = chain.unit(data.get("units"), {"metric": 1.0, "imperial": 25.4}, "its units")
    notes: list[str] = []
    _check_parents(axes)
    own_axes: list[Axis] = []
    for name, each in axes.items():
        kind = _TYPES.get(each.get("type", "")) if isinstance(each.get("type"), str) else None
        if kind is None:
            notes.append(f"{name} is of type {shown(each.get('type'))}, neither linear nor rotary: it is ignored")
            continue
        own_axes.append(_axis(name, each, kind, length))
    heads = data.get("toolheads", [])
    if isinstance(heads, list) and len(heads) > 1:
        notes.append(f"it has {len(heads)} tool heads, which share its axes")
    rotary = _ordered([each for each in own_axes if each.kind == "rotary"], added, notes)
    straight = [each for each in own_axes if each.kind == "linear"]
    sides: tuple[Carried, Carried] = ("part", "tool")
    part, tool = ([each for each in rotary if each.carries == side] for side in sides)
    # Linear axes stand between the rotary ones: how they follow each other does not matter.
    all_axes = [*part, *(each for side in sides for each in straight if each.carries == side), *tool]
    if part:
        notes.append("angles of axes that carry the part are counted as the table turns, which is how FreeCAD solves for them")
    name = data.get("name")
    return chain.machine(name if isinstance(name, str) and name else content.path.stem, all_axes, notes)


def _check_parents(axes: dict[str, Any]) -> None:
    for name, each in axes.items():
        if not isinstance(each, dict):
            raise MachineError(f"axis {name} must be a table, not {shown(each)}")
        seen, at = {name}, each.get("parent")
        while at is not None:
            if not isinstance(at, str) or at not in axes:
                raise MachineError(f"axis {name} stands on {shown(at)}, which is no axis of it: its chain is broken")
            if at in seen:
                raise MachineError(f"axis {name} stands on itself: its chain is a circle through {', '.join(sorted(seen))}")
            seen.add(at)
            above = axes[at]
            at = above.get("parent") if isinstance(above, dict) else None


def _axis(name: str, entry: dict[str, Any], kind: str, length: float) -> Axis:
    role = entry.get("role")
    side, _, of = role.partition("_") if isinstance(role, str) else ("", "", "")
    carries = _SIDES.get(side)
    if carries is None or of != kind:
        raise MachineError(f"axis {name}: its role {shown(role)} is none of a {kind} axis (table_{kind}, head_{kind})")
    point, direction = _joint(entry.get("joint"), name, kind)
    size = chain.ANGLES["deg"] if kind == "rotary" else length
    ends = entry.get("limits") or {}
    if not isinstance(ends, dict):
        raise MachineError(f"axis {name}: its limits must be a table of min and max, not {shown(ends)}")
    low, high = (
        None if ends.get(key) is None else chain.real(ends[key], f"axis {name}: its limit {key}") for key in ("min", "max")
    )
    speed = entry.get("max_velocity")
    rate = 0.0 if speed is None else chain.scaled(chain.real(speed, f"axis {name}: its max_velocity") / _MINUTE, size)
    turned = chain.opposite(direction) if kind == "rotary" and carries == "part" else direction
    place = (point[0] * length, point[1] * length, point[2] * length)
    limits = chain.ranged(low, high, size)
    if kind == "linear":
        return Axis(name, "linear", carries, turned, limits, rate=rate or None)
    return Axis(name, "rotary", carries, turned, limits, place, rate or None)


def _joint(entry: Any, name: str, kind: str) -> tuple[chain.Vector, chain.Vector]:
    """Origin and direction: an object, or both in a list, of which older files of linear axes have the direction first."""
    what = f"axis {name}: its joint"
    if isinstance(entry, dict):
        if entry.get("axis") is None:
            raise MachineError(f"{what} has no axis, the direction")
        return chain.vector(entry.get("origin", [0, 0, 0]), f"{what} origin"), chain.vector(entry["axis"], f"{what} axis")
    if isinstance(entry, list) and len(entry) == 2:
        first, second = chain.vector(entry[0], what), chain.vector(entry[1], what)
        if any(first) and any(second) and kind == "linear":
            raise MachineError(f"{what} is two vectors, either of which may be the direction; name them origin and axis")
        return (first, second) if any(second) else (second, first)
    raise MachineError(f"{what} must be an origin and an axis, not {shown(entry)}")


def _ordered(rotary: list[Axis], added: Added, notes: list[str]) -> list[Axis]:
    """Rotary axes from the part to the tool."""
    rotary = sorted(rotary, key=lambda each: each.carries != "part")
    if len(rotary) == 2 and rotary[0].carries == rotary[1].carries:
        about = [abs(each.direction[2]) > 1.0 - 1e-12 for each in rotary]
        if about[0] == about[1]:
            if sorted(added.order) == sorted(each.name.upper() for each in rotary):
                return sorted(rotary, key=lambda each: added.order.index(each.name.upper()))
            names = ",".join(each.name for each in rotary)
            raise MachineError(
                f"{rotary[0].name} and {rotary[1].name} carry the {rotary[0].carries}, and FreeCAD's parents and its solver "
                f"contradict each other about their order: say it from the part to the tool, as FILE#{names}"
            )
        # The one along the tool is the farther from it: the next to it would only turn the tool about itself.
        rotary.sort(key=lambda each: abs(each.direction[2]) <= 1.0 - 1e-12)
        notes.append(f"{rotary[0].name}, about Z, is next to the part of both, as FreeCAD solves for them, whatever the parents")
    if added.order:
        raise MachineError(f"it says the order of its axes itself: leave out #{added.text}")
    return rotary
