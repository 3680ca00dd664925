"""A check is about a machine, tools and setups, as the user states them in plain numbers, and about the files of a plan."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io import Part
from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives
from plan_cutters.errors import OptionError


@dataclass(frozen=True, slots=True)
class Section:
    """A section above the flutes: its part (`neck`, `shank` or `holder`), height over the tip, length and two radii, mm."""

    part: str
    low: float
    length: float
    radius: float
    upper_radius: float


@dataclass(frozen=True, slots=True)
class ToolSizes:
    """Dimensions of a cutter with its holder, mm and rad, as its notation has them."""

    id: str
    shape: str
    radius: float
    corner_radius: float
    arc_radius: float
    arc_height: float
    outline: tuple[tuple[float, float], ...]
    taper: float
    flutes: float
    sections: tuple[Section, ...]
    allowance: float
    clearance: float


@dataclass(frozen=True, slots=True)
class DrillSizes:
    """A tool for holes: its kind, its body as a cutter with a flat end, its name; and if they are known, the whole angle of its
    point, rad, and its feed, mm/min; of a tap its pitch, mm, and whether it turns to the left.
    """

    kind: str
    sizes: ToolSizes
    point: float | None
    feed: float | None
    name: str
    pitch: float | None = None
    left: bool = False

    @property
    def angle(self) -> float:
        """Whole angle of its point, rad; one that is not known counts as 90 deg."""
        return 0.5 * math.pi if self.point is None else self.point

    @property
    def beyond(self) -> float:
        """How far its tip is beyond the depth that is written, mm: of a cone, a counterbore and a tap not at all."""
        flat = self.kind in ("countersink", "centre drill", "counterbore", "tap")
        return 0.0 if flat else self.sizes.radius / math.tan(0.5 * self.angle)


@dataclass(frozen=True, slots=True, eq=False)
class MachineAxes:
    """The rotary axes of a machine, the one next to the part first, in the machine's frame.

    `direction` (k, 3) of at most 2; `limits` (k, 2), rad, infinite: none; `tool` (3,), from the tip to the spindle at zero
    angles; `tilt_limit`: largest angle of the tool axis from the setup axis, rad, pi: none; `rates`: whether all axes have one.
    """

    names: tuple[str, ...]
    direction: Floats
    limits: Floats
    tool: Floats
    tilt_limit: float
    rates: bool


@dataclass(frozen=True, slots=True)
class Body:
    """A fixture: a word (`box`, `cylinder`, `table`, `prism`) with its sizes, or a file; placed by x, y, z, mm, rx, ry, rz, deg.

    A prism is given by two heights and the corners, x and y, of two polylines of as many points: its outline runs along the first
    one and back along the second one, counter-clockwise. `up`: of stock, the direction (3,) along which what grips it stands.
    """

    name: str
    kind: str
    sizes: tuple[float, ...]
    source: Any
    unit: str | None
    placement: tuple[float, ...]
    up: tuple[float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class Grip:
    """Jaws whose place a plan states, in their own frame, that of `body`: z up, what they hold rests at z = 0. Lengths in mm.

    `jaws`: 2 of a vise that closes along x, of a `width` along y; else those of a chuck, the first along x, each within an angle
    of `width` rad. They reach `grip` over what the part rests on and `below` it to the body, are `apart` (a chuck: the diameter
    of the bore), and support the part on a `ledge` inward. `faces`: what the plan says to be gripped.
    """

    setup: int
    name: str
    body: Body
    jaws: int
    width: float
    grip: float
    below: float
    apart: float
    ledge: float
    faces: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Setup:
    """How the part stands: its directions along the machine's Z and X, its point at the machine's zero, and what holds it."""

    z: tuple[float, float, float]
    x: tuple[float, float, float] | None
    origin: tuple[float, float, float] | None
    fixtures: tuple[Body, ...]
    clamped: frozenset[int]


@dataclass(frozen=True, slots=True, eq=False)
class Question:
    """Everything that is read before a check begins.

    `ignored`: numbers of faces that are no obstacles; `sign` (faces,): side of each face, as `cad_io.Orientation` has it;
    `tolerance`, `asked`: gouge tolerance that the plan keeps, and that the user wants, mm, 0: any; `document`, `operations`,
    `samples`: plan.json, and the arrays of operations.npz and samples.npz; `checksums`: by file, the SHA-256 that plan.json
    states, and the file's own; `grips`: vises and chucks of which the plan alone says where they stand; `stated`: what plan.json
    must say by the user's own command, and by the program's words for the plan's own numbers; `odd`: what of plan.json no plan of
    this version has, empty: nothing; `drills`: by id, the tools for holes of the libraries.
    """

    part: Part
    machine: MachineAxes
    tools: Mapping[str, ToolSizes]
    setups: tuple[Setup, ...]
    ignored: frozenset[int]
    sign: Floats
    tolerance: float
    document: Mapping[str, Any]
    operations: Mapping[str, NDArray[Any]]
    samples: Mapping[str, NDArray[Any]]
    checksums: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    asked: float = 0.0
    grips: tuple[Grip, ...] = ()
    stated: Mapping[str, Any] = field(default_factory=dict)
    odd: str = ""
    drills: Mapping[str, DrillSizes] = field(default_factory=dict)

    def shift(self, name: str) -> Floats:
        """From samples to where a cutter is put down with the postures of its verdicts, (n, 3), mm."""
        shift = self.samples.get(f"shift_{name}")
        return np.zeros((len(self.samples["point"]), 3)) if shift is None else shift

    def surface(self, number: int, uv: Floats) -> tuple[Floats, Floats, Floats]:
        """Points of a face's surface, its outer unit normals, (n, 3), nan where there is none, and its derivatives (n, 2, 3)."""
        d = first_derivatives(self.part.adaptor(number), *uv.T)
        normal = np.cross(d[:, 1], d[:, 2]) * self.sign[number - 1]
        with np.errstate(invalid="ignore", divide="ignore"):
            return d[:, 0], normal / np.linalg.norm(normal, axis=1)[:, None], d[:, 1:]


#: Names of the angles that set a machine that names no rotary axes.
FREE = ("azimuth", "tilt")
#: How far off its circle a tool axis may be that a machine of less than two rotary axes holds, rad.
_ON_CIRCLE = 1e-6


def frame_of(setup: Setup) -> Floats:
    """The machine's X, Y and Z (3, 3), as rows, in the part's coordinates at zero angles."""
    z = np.array(setup.z, float)
    z /= np.linalg.norm(z)
    # Without an x the machine's X is as near to the part's as can be; where that is the spindle's, its Y is the part's.
    wanted = np.array([1.0, 0.0, 0.0] if setup.x is None else setup.x, float)
    x = wanted - (wanted @ z) * z
    if np.linalg.norm(x) < 1e-6:
        x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(z, x), z])


def carried(machine: MachineAxes, setup: Setup, vector: Floats, degrees: Floats) -> Floats:
    """Where vectors that are fixed to the tool point in the part's coordinates, (n, 3), at angles (n, k) in degrees."""
    frame = frame_of(setup)
    vectors = np.broadcast_to(np.asarray(vector, float), (len(degrees), 3))
    for direction, angle in reversed([*zip(machine.direction, np.radians(degrees).T, strict=True)]):
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        along = (vectors @ direction)[:, None] * direction
        vectors = along + c * (vectors - along) + s * np.cross(direction, vectors)
    return np.asarray(vectors @ frame)


def require_operations(document: Mapping[str, Any], file: str | None = None) -> None:
    """See to it that a plan.json has operations to check; an OptionError where it has none."""
    if not isinstance(document.get("operations"), dict):
        raise OptionError("the plan has no operations: make it with --operations", file=file)


def axes_of(machine: MachineAxes, setup: Setup, degrees: Floats) -> Floats:
    """Tool axes (n, 3) in the part's coordinates at angles (n, k) in degrees."""
    return carried(machine, setup, machine.tool, degrees)


def degrees_of(question: Question, each: Mapping[str, Any]) -> Floats:
    """The angles of a fixed operation, (1, k), deg."""
    return np.array([[float(each["angles_deg"][name]) for name in question.machine.names]], float).reshape(1, -1)


def tool_frame(question: Question, number: int, degrees: Floats) -> tuple[Floats, Floats, Floats]:
    """Tool axis and X across it, nan where not known, (3,), of the part, at angles (1, k), deg; X, Y, Z (3, 3) of the machine."""
    machine, setup = question.machine, question.setups[number]
    axis, frame = axes_of(machine, setup, degrees)[0], frame_of(setup)
    x = carried(machine, setup, frame[0] @ frame.T, degrees)[0]
    x = x - (x @ axis) * axis
    size = float(np.linalg.norm(x))
    x = x / size if size > 1e-6 else np.full(3, np.nan)
    return axis, x, np.array([x, np.cross(axis, x), axis]) @ frame.T


def allowed(machine: MachineAxes, setup: Setup, degrees: Floats) -> NDArray[np.bool_]:
    """Which angles (n, k), deg, are within the machine's limits."""
    return _within(machine, degrees) & _tilted(machine, setup, axes_of(machine, setup, degrees))


def _within(machine: MachineAxes, degrees: Floats) -> NDArray[np.bool_]:
    low, high = np.degrees(machine.limits).T
    return np.asarray(((degrees >= low - 1e-6) & (degrees <= high + 1e-6)).all(axis=-1))


def _tilted(machine: MachineAxes, setup: Setup, axis: Floats) -> NDArray[np.bool_]:
    tilt = np.arccos(np.clip(np.asarray(axis, float) @ frame_of(setup)[2], -1.0, 1.0))
    return np.asarray(tilt <= machine.tilt_limit + 1e-9)


def held(machine: MachineAxes, setup: Setup, axis: Floats) -> NDArray[np.bool_]:
    """Which tool axes (n, 3), part coordinates, the machine holds with one of its solutions, within its limits."""
    if len(machine.direction) < 2:
        return np.asarray(_held_by_one(machine, np.asarray(axis, float) @ frame_of(setup).T) & _tilted(machine, setup, axis))
    able = [known & _turns_to(b, machine.limits[1]) & (free | _turns_to(a, machine.limits[0]))
            for a, b, known, free in _solutions(machine, setup, axis)]  # fmt: skip
    return np.asarray((able[0] | able[1]) & _tilted(machine, setup, axis))


def _held_by_one(machine: MachineAxes, wanted: Floats) -> NDArray[np.bool_]:
    """Which tool axes (n, 3) of the machine's frame the only rotary axis turns the tool to, or are the tool without any."""
    if not len(machine.direction):
        return np.asarray(np.linalg.norm(wanted - machine.tool, axis=1) <= _ON_CIRCLE)
    about, tool = machine.direction[0], machine.tool
    p, q = tool - (tool @ about) * about, wanted - (wanted @ about)[:, None] * about
    angle = np.arctan2(np.cross(p, q) @ about, q @ p)
    return np.asarray((np.abs(wanted @ about - tool @ about) <= _ON_CIRCLE) & _turns_to(angle, machine.limits[0]))


def _solutions(machine: MachineAxes, setup: Setup, axis: Floats) -> Iterator[tuple[Floats, Floats, NDArray[Any], NDArray[Any]]]:
    """Twice the angles (n,), rad, of both rotary axes with tool axes (n, 3), whether they give these, and whether any first does.

    The axis next to the part changes nothing of the tool axis along itself: that gives the two angles of the second rotary axis,
    and from each the first one's follows.
    """
    (first, second), tool = machine.direction, machine.tool
    wanted = np.asarray(axis, float) @ frame_of(setup).T
    along = (tool @ second) * second
    base, square = tool - along, np.cross(second, tool)
    even, reach = float(first @ along), math.hypot(first @ base, first @ square)
    if reach < 1e-9:
        raise ValueError("the second rotary axis does not turn the tool towards the first one")
    nearest, part = math.atan2(first @ square, first @ base), (wanted @ first - even) / reach
    away = np.arccos(np.clip(part, -1.0, 1.0))
    for b in (nearest + away, nearest - away):
        before = along + np.cos(b)[:, None] * base + np.sin(b)[:, None] * square
        p, q = (v - (v @ first)[:, None] * first for v in (before, wanted))
        a = np.arctan2(np.cross(p, q) @ first, (p * q).sum(axis=1))
        # Where the tool axis lies along the first axis, any angle of that one will do.
        yield a, b, np.abs(part) <= 1.0 + 1e-9, np.linalg.norm(q, axis=1) < 1e-9


def _turns_to(angle: Floats, limits: Floats) -> NDArray[np.bool_]:
    """Which angles, rad, lie within limits, or do after whole turns."""
    # An angle whose cosine is nearly 1 has half as many digits.
    low, high = float(limits[0]) - 1e-7, float(limits[1]) + 1e-7
    if not math.isfinite(low) or not math.isfinite(high):
        return np.ones(len(angle), bool)
    return np.asarray(angle + 2.0 * math.pi * np.ceil((low - angle) / (2.0 * math.pi)) <= high)


def other_angles(question: Question, setup: int, degrees: Floats) -> list[tuple[float, ...]]:
    """The other angles, deg, as a control shows them, with the same axis within limits: several that are as large, or none."""
    machine, others = question.machine, list[tuple[float, ...]]()
    if len(machine.direction) < 2:
        return others
    wanted = axes_of(machine, question.setups[setup], degrees[None])
    for a, b, known, free in _solutions(machine, question.setups[setup], wanted):
        if free[0]:
            return []
        turns = product(*(math.degrees(x[0]) + 360.0 * np.arange(-2, 3) for x in (a, b)))
        for angles in ((round(float(x), 9), round(float(y), 9)) for x, y in turns if known[0]):
            apart = sum(abs((x - y + 180.0) % 360.0 - 180.0) for x, y in zip(angles, degrees.tolist(), strict=True))
            if _within(machine, np.array(angles)) and apart > 0.01:
                others.append(angles)
    least = min((sum(map(abs, each)) for each in others), default=0.0)
    return [tuple(round(x, 3) + 0.0 for x in each) for each in others if sum(map(abs, each)) <= least + 1e-6]
