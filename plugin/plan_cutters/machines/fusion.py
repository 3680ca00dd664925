"""Fusion machines, `.mch`: a tree of parts, from static ones over linear and rotary ones to the table and the head.

Directions are those in which a part itself moves, by the right-hand rule for rotary ones. The files at hand say so of linear axes
that carry the part; of rotary ones it is not documented, so that it must be said where it matters.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

from plan_cutters.domain.checks import shown
from plan_cutters.domain.machine import Axis, Carried, Machine
from plan_cutters.errors import MachineError
from plan_cutters.machines import chain
from plan_cutters.machines.chain import TABLE, TOOL, Added, Content

_MOST = 200
#: Keys of a part that are understood, or that say nothing of where it can go.
_KEYS = {
    "attach_frame", "axis_of_rotation", "control", "direction", "display_name", "id", "name", "offset", "parts", "spindle",
    "step_size", "tool_station", "type", "max", "min", "range", "limits", "physical_range", "home_position", "model", "solids",
}  # fmt: skip
_RANGES = ("range", "limits", "physical_range")
_SUSPECT = ("min", "max", "range", "limit")


class Frame(NamedTuple):
    """Where a part of the tree stands: the parts above it, from the bed outward, and itself."""

    parts: list[dict[str, Any]]
    end: dict[str, Any]


def is_mch(content: Content) -> bool:
    """JSON with the kinematics of a machine."""
    return isinstance(_tree(content.json, "kinematics").get("parts"), list)


def _tree(entry: Any, key: str) -> dict[str, Any]:
    """What a file says by a word, as default if it has several; empty where that is no table."""
    inner = entry.get(key) if isinstance(entry, dict) else None
    default = inner.get("default", inner) if isinstance(inner, dict) else None
    return default if isinstance(default, dict) else {}


def read_mch(content: Content, added: Added) -> Machine:
    """Read it."""
    added.refuse(content.name, order=True)
    entry = _tree(content.json, "kinematics")
    units = entry.get("units")
    if not isinstance(units, dict):
        raise MachineError("its kinematics have no units")
    length = chain.unit(units.get("length"), chain.LENGTHS, "its unit of lengths")
    angle = chain.unit(units.get("angle"), chain.ANGLES, "its unit of angles")
    hand = (entry.get("conventions") or {}).get("rotation", "right-handed")
    if hand not in ("right-handed", "left-handed"):
        raise MachineError(f"its convention of rotation {shown(hand)} is not known")
    frames = _frames(entry["parts"])
    table, head = (_only(frames, kind) for kind in ("table", "head"))
    notes: list[str] = []
    settings = _tree(content.json, "controller").get("parts")
    control = {key: each for key, each in settings.items() if isinstance(each, dict)} if isinstance(settings, dict) else {}
    reading = _Reading(length, angle, hand == "left-handed", added.sign, control, notes)
    axes = [*reading.axes(table.parts, "part")[::-1], *reading.axes(head.parts, "tool")]
    for each in table.parts:
        # A part above both moves both, so that it moves neither against the other.
        if any(each is other for other in head.parts) and each.get("type") in ("linear", "rotary"):
            raise MachineError(f"axis {shown(each.get('name', each.get('id')))} carries both the table and the head")
    tool = chain.ISO["Z"]
    frame = head.end.get("attach_frame")
    if isinstance(frame, dict) and frame.get("z_direction") is not None:
        tool = chain.vector(frame["z_direction"], "the z_direction of its head")
    if any(control.values()):
        notes.append("its speeds are not used: their units are not documented")
    if not any(each.kind == "rotary" and each.carries == "part" for each in axes):
        added.refuse(content.name, sign=True)
    general = content.json.get("general")
    words = [general.get(key) for key in ("vendor", "model")] if isinstance(general, dict) else []
    name = " ".join(word for word in words if isinstance(word, str) and word) or content.path.stem
    return chain.machine(name, axes, notes, tool=tool)


def _frames(parts: list[Any]) -> list[Frame]:
    """All parts of the tree, those nearest to the bed first."""
    frames: list[Frame] = []
    waiting: list[tuple[Any, list[dict[str, Any]]]] = [(each, []) for each in parts]
    while waiting:
        each, above = waiting.pop(0)
        if not isinstance(each, dict):
            raise MachineError(f"a part of its kinematics must be a table, not {shown(each)}")
        frames.append(Frame(above, each))
        if len(frames) > _MOST:
            raise MachineError(f"its kinematics have more than {_MOST} parts: no machine has")
        inner = each.get("parts", [])
        if not isinstance(inner, list):
            raise MachineError(f"part {shown(each.get('id'))}: its parts must be a list")
        waiting += [(child, [*above, each]) for child in inner]
    return frames


def _only(frames: list[Frame], kind: str) -> Frame:
    matches = [frame for frame in frames if frame.end.get("type") == kind]
    if len(matches) != 1:
        count = f"{len(matches)} parts" if matches else "no part"
        ids = ", ".join(shown(frame.end.get("id")) for frame in matches)
        raise MachineError(f"its kinematics have {count} of type {kind}{f' ({ids})' if ids else ''}: machines of one are read")
    return matches[0]


@dataclass(slots=True)
class _Reading:
    length: float
    angle: float
    left: bool
    sign: str
    control: dict[str, Any]  #: The controller's settings of each part, by its id.
    notes: list[str]

    def axes(self, parts: list[dict[str, Any]], carries: Carried) -> list[Axis]:
        """The axes among the parts above a table or a head, the one next to the bed first."""
        axes = []
        for part in parts:
            name = part.get("name") or part.get("display_name") or part.get("id")
            kind = part.get("type")
            if kind in ("linear", "rotary"):
                axes.append(self.axis(part, str(name), kind, carries))
            elif kind != "static":
                self.notes.append(f"part {shown(name)} of type {shown(kind)} is neither linear nor rotary: it is ignored")
        return axes

    def axis(self, part: dict[str, Any], name: str, kind: str, carries: Carried) -> Axis:
        for key in part:
            if key not in _KEYS and any(word in key.lower() for word in _SUSPECT):
                raise MachineError(
                    f"axis {name}: its {shown(key)} is not understood, and may be a limit; write the machine as "
                    "TOML (docs/machines.md)"
                )
        if part.get("control", "driven") != "driven":
            self.notes.append(f"{name} is {shown(part['control'])}, not driven: it is taken as one that can be set")
        limits = self.limits(part, name, self.angle if kind == "rotary" else self.length)
        if kind == "linear":
            direction = chain.vector(part.get("direction"), f"axis {name}: its direction")
            return Axis(name, "linear", carries, chain.opposite(direction) if carries == "part" else direction, limits)
        about = part.get("axis_of_rotation")
        if not isinstance(about, dict):
            raise MachineError(f"axis {name} has no axis_of_rotation")
        direction = chain.vector(about.get("direction"), f"axis {name}: its direction")
        point = chain.vector(about.get("point", [0, 0, 0]), f"axis {name}: its point")
        place = (point[0] * self.length, point[1] * self.length, point[2] * self.length)
        if self.left != ((carries == "part") and self.sign != TOOL):
            direction = chain.opposite(direction)
        axis = Axis(name, "rotary", carries, direction, limits, place)
        self.check(part, axis)
        return axis

    def check(self, part: dict[str, Any], axis: Axis) -> None:
        control = self.control.get(str(part.get("id")), {})
        turned, zero = control.get("reversed") is True, control.get("zero_position_offset", 0)
        if chain.even(axis.limits):
            if axis.carries == "part" and not self.sign:
                self.notes.append(
                    f"{axis.name}: whether its positive angles are those of the table or of the tool is not stated; that of the "
                    f"table is taken, and with its limits it allows the same either way"
                )
        elif turned or (zero and axis.limits is not None):
            why = "reversed" if turned else f"offset by {shown(zero)}"
            raise MachineError(
                f"axis {axis.name} is {why} in the controller, and whether that is so of its limits is not known; "
                "write the machine as TOML (docs/machines.md)"
            )
        elif axis.carries == "part" and not self.sign:
            raise MachineError(
                f"axis {axis.name} carries the part, and whether its limits count the table's own motion is not stated: use "
                f"FILE#{TABLE}, or FILE#{TOOL} (ISO 841)"
            )

    def limits(self, part: dict[str, Any], name: str, size: float) -> tuple[float, float] | None:
        limits = []
        for key in _RANGES:
            result = part.get(key)
            if result is None:
                continue
            if isinstance(result, list) and len(result) == 2:
                result = dict(zip(("min", "max"), result, strict=True))
            if not isinstance(result, dict) or not set(result) <= {"min", "max"}:
                raise MachineError(f"axis {name}: its {key} must be min and max, not {shown(result)}")
            limits.append(self._ends(result, name, size))
        limits.append(self._ends(part, name, size))
        return chain.narrowed(limits, f"axis {name}")

    def _ends(self, entry: dict[str, Any], name: str, size: float) -> tuple[float, float] | None:
        low, high = (
            None if entry.get(key) is None else chain.real(entry[key], f"axis {name}: its {key}") for key in ("min", "max")
        )
        return chain.ranged(low, high, size)
