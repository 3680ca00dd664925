"""A made part: its shape, its materials in closed form, its tools and setups, and what follows."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from conformance.forms import Material
from conformance.made.planar import unit
from conformance.posture import Postures
from conformance.tool import Floats, Tool

#: A material whose skin is nearer than this (mm) to the contact is the one in contact: a search on a surface ends some 10 nm beside its nearest point.
SKIN = 5e-5
#: Less depth (mm) than this in the material in contact is none.
TOUCH = 1e-6
#: A margin (mm) that stands for "nothing near".
FAR = 1000.0
#: A safe posture from which so small a turn (deg) brings the tool into the surface at its contact has margin 0.
STEADY_DEG = 0.05


@dataclass(frozen=True)
class Setup:
    """How the part is held: the spindle's direction in part coordinates, the largest angle of the tool axis from it, and what clamps it."""

    name: str = "free"
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    limit_deg: float | None = None
    fixtures: tuple[Material, ...] = ()
    #: The same fixtures for programs: boxes (low, high) in part coordinates, and the height of a table along the axis.
    boxes: tuple[tuple[tuple[float, float, float], tuple[float, float, float]], ...] = ()
    table: float | None = None


@dataclass(frozen=True)
class Answer:
    """A number that is proved by hand.

    `kind` is `free_tilts` (value: intervals in degrees, at `contact`, `normal` and `lean`, the direction that the axis leans to), `least_stickout` (mm, of
    `tool` at `contact` along `axis`), `largest_radius` (mm, of a flat or ball end at `contact`, or anywhere on the part) or `orientations` (the
    least number of fixed directions, and `axes` that do). `formula` says how it follows.
    """

    kind: str
    value: Any
    formula: str
    tool: str | None = None
    setup: str = "free"
    given: dict[str, Any] = field(default_factory=dict)


def directions(
    axes: Sequence[Sequence[float]], contacts: Sequence[tuple[Sequence[float], Sequence[float]]], most: float, apart: Sequence[int]
) -> dict[str, Any]:
    """Return the question of an answer about orientations: `axes` that do, `contacts` with their normals, the largest tilt (deg) from the normal that counts.

    `apart` are the numbers of contacts that need a direction each, for none serves two of them.
    """
    return {
        "axes": [unit(a) for a in axes],
        "contacts": [[float(x) for x in c] for c, _ in contacts],
        "normals": [unit(n) for _, n in contacts],
        "max_tilt_deg": most,
        "apart": list(apart),
    }


@dataclass(frozen=True)
class MadePart:
    """A part with known answers.

    `build()` gives a CadQuery Workplane. `materials` are its bodies in closed form: they describe it wherever one of `tools` can reach from a
    contact of `contacts(rng, n) -> (points, normals)`, each (n, 3). `axes(rng, points, normals) -> (n, 3)` draws tool axes, if not all about the normal.
    """

    name: str
    family: str
    title: str
    derivation: str
    build: Callable[[], Any]
    materials: tuple[Material, ...]
    tools: tuple[Tool, ...]
    contacts: Callable[[np.random.Generator, int], tuple[Floats, Floats]]
    setups: tuple[Setup, ...] = (Setup(),)
    answers: tuple[Answer, ...] = ()
    axes: Callable[[np.random.Generator, Floats, Floats], Floats] | None = None
    twin_of: str | None = None

    def tool(self, name: str) -> Tool:
        """Return a tool by name."""
        return next(t for t in self.tools if t.name == name)

    def setup(self, name: str) -> Setup:
        """Return a setup by name."""
        return next(s for s in self.setups if s.name == name)


@dataclass(frozen=True, eq=False)
class Judged:
    """What the closed forms give for postures (n,)."""

    margin: Floats
    limit_deg: Floats
    reason: np.ndarray

    @property
    def blocked(self) -> np.ndarray:
        """Where the material or the limit is in the way (n,)."""
        return (self.margin < 0) | (self.limit_deg < 0)


def judge(part: MadePart, tool: Tool, setup: Setup, contact: Floats, axis: Floats, tip: Floats) -> Judged:
    """Return the margins of postures: contact, axis and tip (n, 3)."""
    n = len(contact)
    worst, reason = np.full(n, FAR), np.full(n, "", dtype="U8")
    for material, fixed in [*((m, False) for m in part.materials), *((m, True) for m in setup.fixtures)]:
        holds = held(material, contact)
        for piece in tool.pieces:
            m = np.asarray(material.margin(piece, tip, axis), float)
            m = np.where(holds & (m > -TOUCH), FAR, m)
            less = m < worst
            worst = np.where(less, m, worst)
            reason = np.where(less, "fixture" if fixed else piece.part, reason)
    limit = _limit(setup, axis)
    reason = np.where(limit < 0, "limit", np.where(worst < 0, reason, ""))
    return Judged(worst, limit, reason)


def held(material: Material, contact: Floats) -> np.ndarray:
    """Whether the contacts (n, 3) lie on the skin of a material."""
    return np.abs(material.height(contact)) < SKIN


def blocked(part: MadePart, tool: Tool, setup: Setup, holds: list[np.ndarray], axis: Floats, tip: Floats, *, contact_only: bool = False) -> np.ndarray:
    """Whether postures are blocked (n,): the sign of the margin alone, which costs one gap and no bisection.

    `holds` says for each material and fixture which contacts lie on its skin; `contact_only` looks at these alone.
    """
    out = np.zeros(len(axis), bool) if contact_only else _limit(setup, axis) < 0
    for material, on_skin in zip((*part.materials, *setup.fixtures), holds, strict=True):
        for piece in tool.pieces:
            rows = np.flatnonzero(~out & on_skin if contact_only else ~out)
            if len(rows):
                gap = np.asarray(material.gap(piece, tip[rows], axis[rows]), float)
                out[rows] = gap < np.where(on_skin[rows], -TOUCH, 0.0)
    return out


def _limit(setup: Setup, axis: Floats) -> Floats:
    """Return the angle (deg) from each axis to the machine's limit; nan where there is none."""
    if setup.limit_deg is None:
        return np.full(len(axis), np.nan)
    up = np.array(setup.axis, float) / np.linalg.norm(setup.axis)
    return setup.limit_deg - np.degrees(np.arctan2(np.linalg.norm(np.cross(axis, up), axis=1), axis @ up))


def frame(normal: Floats) -> tuple[Floats, Floats]:
    """Return two unit vectors (n, 3) across each normal."""
    e1 = np.cross(normal, np.where(np.abs(normal[:, :1]) < 0.7, [[1.0, 0, 0]], [[0, 1.0, 0]]))
    e1 /= np.linalg.norm(e1, axis=1)[:, None]
    return e1, np.cross(normal, e1)


def leaning(normal: Floats, lean: Floats, tilt: Floats) -> Floats:
    """Return the axis (n, 3) at `tilt (n,)` rad from the normal towards the unit vector `lean`."""
    axis = np.cos(tilt)[:, None] * normal + np.sin(tilt)[:, None] * lean
    return axis / np.linalg.norm(axis, axis=1)[:, None]


def postures(part: MadePart, count: int, seed: int = 0) -> Postures:
    """Return about `count` postures of a part: drawn, then moved to the border, balanced between safe and blocked."""
    rng = np.random.default_rng([seed, *part.name.encode()])
    pairs = [(t, s) for t in part.tools for s in part.setups]
    each = max(4, int(np.ceil(count / len(pairs))))
    return Postures.joined(_drawn(part, tool, setup, rng, each) for tool, setup in pairs)


def _drawn(part: MadePart, tool: Tool, setup: Setup, rng: np.random.Generator, count: int) -> Postures:
    """Return postures of one tool in one setup: a third at the border, the others balanced as far as there are both."""
    contact, normal = part.contacts(rng, 3 * count)
    holds = [held(m, contact) for m in (*part.materials, *setup.fixtures)]
    one, two = _axes(part, rng, contact, normal), _axes(part, rng, contact, normal)
    here, there = (blocked(part, tool, setup, holds, a, tool.stands(contact, normal, a)) for a in (one, two))
    pair = np.flatnonzero(here != there)[: count // 3]
    swap = here[pair, None]
    border = _at_border(
        part,
        tool,
        setup,
        [h[pair] for h in holds],
        contact[pair],
        normal[pair],
        np.where(swap, two[pair], one[pair]),
        np.where(swap, one[pair], two[pair]),
        rng,
    )
    rest = count - len(pair)
    both = np.flatnonzero(~here), np.flatnonzero(here)
    rows = np.concatenate([mine[: max(rest // 2, rest - len(other))] for mine, other in zip(both, both[::-1], strict=True)])
    return _table(part, tool, setup, np.vstack([contact[rows], contact[pair]]), np.vstack([normal[rows], normal[pair]]), np.vstack([one[rows], border]))


def _axes(part: MadePart, rng: np.random.Generator, contact: Floats, normal: Floats) -> Floats:
    """Return axes: the part's own, or tilts up to 90 degrees about the normal, one in twelve along it to a hair."""
    if part.axes is not None:
        return part.axes(rng, contact, normal)
    n = len(contact)
    e1, e2 = frame(normal)
    turn, tilt = rng.uniform(0, 2 * np.pi, n), np.radians(rng.uniform(0.05, 89.0, n))
    tilt[::12] = np.radians(0.01)
    return leaning(normal, np.cos(turn)[:, None] * e1 + np.sin(turn)[:, None] * e2, tilt)


def _at_border(
    part: MadePart, tool: Tool, setup: Setup, holds: list[np.ndarray], contact: Floats, normal: Floats, safe: Floats, hit: Floats, rng: np.random.Generator
) -> Floats:
    """Return axes near the border: between a safe and a blocked one, by bisection, then some thousandths of the way beside it."""
    n = len(contact)
    a, b = np.zeros(n), np.ones(n)

    def between(t: Floats) -> Floats:
        axis = (1 - t)[:, None] * safe + t[:, None] * hit
        return axis / np.linalg.norm(axis, axis=1)[:, None]

    for _ in range(13):
        middle = 0.5 * (a + b)
        axis = between(middle)
        bad = blocked(part, tool, setup, holds, axis, tool.stands(contact, normal, axis))
        a, b = np.where(bad, a, middle), np.where(bad, middle, b)
    return between(np.clip(a + rng.choice([-1.0, 1.0], n) * 10 ** rng.uniform(-4.0, -1.2, n), 0.0, 1.0))


def _table(part: MadePart, tool: Tool, setup: Setup, contact: Floats, normal: Floats, axis: Floats) -> Postures:
    """Return the table of postures with the answers of the closed forms."""
    tip = tool.stands(contact, normal, axis)
    judged = judge(part, tool, setup, contact, axis, tip)
    n = len(contact)
    # A hair from where the tool enters the surface at its contact, the clearance of the rest says nothing: such a posture is at the border.
    holds = [held(m, contact) for m in (*part.materials, *setup.fixtures)]
    e1, e2 = frame(axis)
    border = np.zeros(n, bool)
    for turn in np.arange(4) * 0.5 * np.pi:
        near = leaning(axis, np.cos(turn) * e1 + np.sin(turn) * e2, np.full(n, np.radians(STEADY_DEG)))
        border |= blocked(part, tool, setup, holds, near, tool.stands(contact, normal, near), contact_only=True)
    margin = np.where(border & ~judged.blocked, 0.0, judged.margin)
    word = lambda text: np.full(n, text)
    return Postures(
        word(part.name),
        word(tool.name),
        word(setup.name),
        contact,
        normal,
        axis,
        tip,
        np.where(judged.blocked, "blocked", "safe"),
        margin,
        margin,
        judged.limit_deg,
        judged.reason,
        word("form"),
    )
