"""Vises and chucks: their words, the sizes in which they are sold, and the bodies that they are made of."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from plan_cutters.domain.figures import text_of
from plan_cutters.errors import FixtureError

#: Self-centring vises for five axes by jaw width, jaw height and largest opening, mm, from the smallest up: round numbers between
#: those of several makers, who sell jaws of about 46, 77 and 125 mm on bases of several lengths.
VISES = ((46.0, 25.0, 65.0), (46.0, 25.0, 120.0), (77.0, 30.0, 120.0), (77.0, 30.0, 200.0), (125.0, 40.0, 205.0),
         (125.0, 40.0, 355.0))  # fmt: skip
#: Diameters of chuck bodies, mm (ISO 3442).
CHUCKS = (80.0, 100.0, 125.0, 160.0, 200.0, 250.0, 315.0, 400.0, 500.0, 630.0)
#: Jaws of a chuck unless a number is requested, and the numbers that chucks have.
_JAWS, _FEWEST, _MOST = 3, 2, 6
#: How deep jaws grip unless it is said, mm.
GRIP = 3.0
#: Jaws support the part from below as far inward as they grip, and never more than this share of what is between them.
_LEDGE_SHARE = 0.25
#: Of a vise, as shares of the jaw width: the thickness of a jaw and the least one, mm; the height of the body and the least one;
#: the side of the riser.
_JAW, _BODY, _RISER = (0.3, 15.0), (0.6, 30.0), 1.2
#: Of a chuck, as shares of its diameter: width, depth and height of a jaw, height of the body, diameter of the riser, and the
#: most that it grips, so that the jaws stay over the body.
_WIDE, _DEEP, _TALL, _CHUCK, _FOOT, _GRIPPED = 0.16, 0.15, 0.25, 0.45, 0.8, 0.7
#: Heights of risers, mm; the table below reaches so far from the middle, and is as thick; drawings show this much of it beyond
#: the riser, and so thick.
_RISER_HIGH, _REACH, _SHOWN, _PLATE = 100.0, 4000.0, 60.0, 20.0
#: Chords of a jaw's bore, at most; steps in which soft jaws rise about half of a cylinder that lies in them.
_MOST_SIDES, _STEPS = 200, 24
#: How far soft jaws stay off that cylinder, mm.
_OFF = 0.01
#: Lengths beyond this, mm, are rather a mistake.
_FARTHEST = 1e6

VISE, CHUCK = "vise", "chuck"
FORMS = {
    VISE: "vise[:JAW_WIDTHxJAW_HEIGHTxOPENING][:GRIP], as vise:77x30x120:3",
    CHUCK: "chuck[:JAWSxHEIGHT][:GRIP], as chuck:3x40:3",
}
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Block:
    """A prism between two polylines of as many points, seen from above, from a height `low` to `high`; mm."""

    #: `inner`, `outer`: x and y; the outline runs along `inner` and back along `outer`, counter-clockwise seen from above.
    inner: tuple[Point, ...]
    outer: tuple[Point, ...]
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Disc:
    """A cylinder about the z axis, mm."""

    radius: float
    low: float
    high: float


Solid = Block | Disc


@dataclass(frozen=True, slots=True)
class Vise:
    """A self-centring vise on a riser, in its own frame: jaws close along x, z is up, and what they hold rests at z = 0."""

    #: `width`, `height`: of the jaws, mm: along y, and from their upper edge down to the vise's body.
    width: float
    height: float
    opening: float  #: The most that the jaws come apart, mm.
    grip: float = GRIP  #: How far the jaws reach above what the part rests on, mm.
    gap: float | None = None  #: How far the jaws stand apart, mm; None: the vise is still to be placed.
    #: They are soft, and bored to a cylinder along y that is as wide and rests at z = 0.
    bored: bool = field(default=False, kw_only=True)

    @property
    def numbers(self) -> tuple[float, ...]:
        """All numbers of its word; of one that is to be placed without the gap."""
        every = (self.width, self.height, self.opening, self.grip)
        return every if self.gap is None else (*every, self.gap, *[self.gap] * self.bored)

    @property
    def word(self) -> str:
        """As on a command line."""
        return _word(VISE, self.numbers[:3], self.numbers[3:])

    @property
    def ledge(self) -> float:
        """How far inward its jaws support the part from below, mm."""
        assert self.gap is not None, "a vise has jaws where it was placed"
        return min(self.grip, _LEDGE_SHARE * self.gap)

    @property
    def turns(self) -> tuple[float, ...]:
        """Directions in which its jaws stand, rad from its x axis."""
        return (0.0, math.pi)

    @property
    def half_width(self) -> float:
        """Half of how wide a jaw is, mm."""
        return 0.5 * self.width

    def solids(self, arc_error: float, *, shown: bool = False) -> tuple[Solid, ...]:
        """Jaws, body, riser, and the table that it stands on; `shown`: of the table, what is drawn."""
        assert self.gap is not None, "a vise has bodies where it was placed"
        half, thick = 0.5 * self.gap, max(_JAW[1], _JAW[0] * self.width)
        body, foot = self.grip - self.height, self.grip - self.height - max(_BODY[1], _BODY[0] * self.width)
        down, long = foot - _RISER_HIGH, self.opening + 2.0 * thick
        riser = _RISER * self.width
        jaws = [
            _box(sign * near, sign * (half + thick), self.width, low, high)
            for sign in (-1.0, 1.0)
            for near, low, high in ((half, 0.0, self.grip), (half - self.ledge, body, 0.0))
        ]
        turns = [0.5 * math.pi * k / _STEPS for k in range(1, _STEPS + 1)] if self.bored else []
        jaws += [
            _box(sign * half * math.sin(one), sign * half * math.sin(other), self.width, 0.0, top)
            for one, other in pairwise(turns)
            if (top := half * (1.0 - math.cos(one)) - _OFF) > 0.0
            for sign in (-1.0, 1.0)
        ]
        below = [_box(-0.5 * long, 0.5 * long, self.width, foot, body), _box(-0.5 * riser, 0.5 * riser, riser, down, foot)]
        return (*jaws, *below, _table(down, 0.5 * riser, shown=shown))


@dataclass(frozen=True, slots=True)
class Chuck:
    """A self-centring chuck on a riser, in its own frame: z is the axis, what it holds rests at z = 0; a jaw stands along x."""

    jaws: int
    height: float  #: Of the jaws over the chuck's face, mm.
    grip: float = GRIP  #: How far the jaws reach above what the part rests on, mm.
    diameter: float | None = None  #: Of what is gripped, mm: the jaws are bored to it. None: the chuck is still to be placed.

    @property
    def numbers(self) -> tuple[float, ...]:
        """All numbers of its word; of one that is to be placed without the diameter."""
        every = (float(self.jaws), self.height, self.grip)
        return every if self.diameter is None else (*every, self.diameter)

    @property
    def word(self) -> str:
        """As on a command line."""
        return _word(CHUCK, self.numbers[:2], self.numbers[2:])

    @property
    def half_angle(self) -> float:
        """Half the angle that a jaw takes of what is gripped, rad."""
        assert self.diameter is not None, "a chuck has jaws where it was placed"
        return min(math.asin(min(0.7, _WIDE * chuck_for(self.diameter) / self.diameter)), 0.9 * math.pi / self.jaws)

    @property
    def ledge(self) -> float:
        """How far inward its jaws support the part from below, mm."""
        assert self.diameter is not None, "a chuck has jaws where it was placed"
        return min(self.grip, _LEDGE_SHARE * 0.5 * self.diameter)

    @property
    def turns(self) -> tuple[float, ...]:
        """Directions in which its jaws stand, rad from its x axis."""
        return tuple(2.0 * math.pi * k / self.jaws for k in range(self.jaws))

    @property
    def half_width(self) -> float:
        """Half of how wide a jaw is where it grips, mm."""
        return 0.5 * (self.diameter or 0.0) * math.sin(self.half_angle)

    def sides(self, arc_error: float) -> int:
        """Chords of a jaw's bore, so that none is farther from the arc than an error, mm, as far as that takes not too many."""
        assert self.diameter is not None, "a chuck has jaws where it was placed"
        step = math.acos(1.0 / (1.0 + max(1e-9, arc_error) / (0.5 * self.diameter)))
        return min(max(2, math.ceil(self.half_angle / step)), _MOST_SIDES)

    def off(self, arc_error: float) -> float:
        """How far the chords are from the bore, mm."""
        assert self.diameter is not None, "a chuck has jaws where it was placed"
        return 0.5 * self.diameter * (1.0 / math.cos(self.half_angle / self.sides(arc_error)) - 1.0)

    def solids(self, arc_error: float, *, shown: bool = False) -> tuple[Solid, ...]:
        """Jaws, body, riser, and the table that it stands on; chords of a jaw are no farther from its bore than an error, mm."""
        assert self.diameter is not None, "a chuck has bodies where it was placed"
        radius, size = 0.5 * self.diameter, chuck_for(self.diameter)
        body = self.grip - self.height
        foot = body - _CHUCK * size
        down = foot - _RISER_HIGH
        jaws = [
            self._jaw(turn, low_radius, radius + _DEEP * size, low, high, arc_error)
            for turn in self.turns
            for low_radius, low, high in ((radius, 0.0, self.grip), (radius - self.ledge, body, 0.0))
        ]
        below = (Disc(0.5 * size, foot, body), Disc(0.5 * _FOOT * size, down, foot))
        return (*jaws, *below, _table(down, 0.5 * size, shown=shown))

    def _jaw(self, turn: float, radius: float, outer: float, low: float, high: float, arc_error: float) -> Block:
        """A jaw that is bored to a radius: its chords lie outside of the bore, by no more than the arc's error."""
        half, sides = self.half_angle, self.sides(arc_error)
        beyond = radius / math.cos(half / sides)
        angles = [half - 2.0 * half * k / sides for k in range(sides + 1)]
        inner = [(beyond * math.cos(a), beyond * math.sin(a)) for a in angles]
        return Block(_turned(inner, turn), _turned([(outer, y) for _, y in inner], turn), low, high)


Clamping = Vise | Chuck


def chuck_for(diameter: float) -> float:
    """Diameter of the smallest chuck, mm, that grips a diameter, mm; of none that is sold, what it would be."""
    return next((size for size in CHUCKS if diameter <= _GRIPPED * size), diameter / _GRIPPED)


def largest_gripped() -> float:
    """The largest diameter that a chuck grips, mm."""
    return _GRIPPED * CHUCKS[-1]


def vises_for(gap: float) -> tuple[Vise, ...]:
    """The vises that open so far, mm, from the smallest up; none where none does."""
    return tuple(Vise(*size) for size in VISES if size[2] >= gap)


def chuck_about(diameter: float, grip: float) -> Chuck:
    """The smallest chuck with three jaws for a diameter, mm."""
    return Chuck(_JAWS, max(_TALL * chuck_for(diameter), 2.0 * grip), grip, diameter)


@dataclass(frozen=True, slots=True)
class Requested:
    """The word of a vise or chuck says this: sizes are None where none were given, the last number where it is to be placed.

    `bored`: the jaws of a vise are bored to what lies between them.
    """

    kind: str
    sizes: tuple[float, ...] | None
    grip: float
    last: float | None
    bored: bool = False

    @property
    def clamping(self) -> Clamping | None:
        """The vise or chuck with these sizes; None where none were given."""
        if self.sizes is None:
            return None
        if self.kind == VISE:
            width, height, opening = self.sizes
            return Vise(width, height, opening, self.grip, self.last, bored=self.bored)
        return Chuck(int(self.sizes[0]), self.sizes[1], self.grip, self.last)

    @property
    def numbers(self) -> tuple[float, ...]:
        """All numbers that are known."""
        if (clamping := self.clamping) is not None:
            return clamping.numbers
        return () if self.grip == GRIP else (self.grip,)


def requested(kind: str, text: str | None, scale: float, which: str) -> Requested:
    """Read the numbers behind the word of a vise or chuck.

    `kind`: `vise` or `chuck`. `text`: what stands behind its colon; None: nothing. `scale`: length of their unit, mm. `which`:
    how errors name it. Raises FixtureError.

    >>> requested("vise", "77x30x120:4", 1.0, "fixture").numbers
    (77.0, 30.0, 120.0, 4.0)
    >>> requested("chuck", None, 1.0, "fixture").clamping
    """
    parts = [] if text is None else text.split(":")
    sizes: tuple[float, ...] | None = None
    if parts and "x" in parts[0].lower():
        sizes = _numbers(parts[0].lower().split("x"), kind, which)
        if len(sizes) != (wanted := 3 if kind == VISE else 2):
            raise FixtureError(f"{which}: give {wanted} sizes, not {len(sizes)}: {FORMS[kind]}")
        parts = parts[1:]
        sizes = tuple(size * scale for size in sizes) if kind == VISE else (sizes[0], sizes[1] * scale)
    rest = [each * scale for each in _numbers(parts, kind, which)]
    bored = sizes is not None and kind == VISE and len(rest) == 3 and rest[1] == rest[2]
    if (text is not None and not (sizes or rest)) or len(rest) > (1 if sizes is None else 2 + bored):
        raise FixtureError(f"{which}: give {FORMS[kind]}")
    grip, last = rest[0] if rest else GRIP, rest[1] if len(rest) > 1 else None
    every = [*(sizes or ()), grip, *([] if last is None else [last])]
    if not all(0.0 < each <= _FARTHEST for each in every):
        wrong = next(each for each in every if not 0.0 < each <= _FARTHEST)
        raise FixtureError(f"{which}: its sizes must be positive numbers up to {_FARTHEST:,.0f} mm, not {wrong:g}: {FORMS[kind]}")
    if sizes is not None:
        _check(kind, sizes, grip, last, which)
    return Requested(kind, sizes, grip, last, bored)


def _check(kind: str, sizes: Sequence[float], grip: float, last: float | None, which: str) -> None:
    if kind == CHUCK and (sizes[0] != int(sizes[0]) or not _FEWEST <= sizes[0] <= _MOST):
        raise FixtureError(f"{which}: a chuck has {_FEWEST} to {_MOST} jaws, not {sizes[0]:g}: {FORMS[kind]}")
    if grip >= sizes[1]:
        raise FixtureError(f"{which}: its jaws are {sizes[1]:g} mm high and cannot grip {grip:g} mm deep; give higher jaws")
    if kind == VISE and last is not None and last > sizes[2]:
        raise FixtureError(f"{which}: its jaws stand {last:g} mm apart, and it opens to {sizes[2]:g} mm; give a larger opening")


def _numbers(words: Sequence[str], kind: str, which: str) -> tuple[float, ...]:
    try:
        numbers = tuple(float(word) for word in words)
    except ValueError:
        raise FixtureError(f"{which}: what follows {kind} are numbers: give {FORMS[kind]}") from None
    if not all(math.isfinite(each) for each in numbers):
        raise FixtureError(f"{which}: its sizes must be finite numbers: {FORMS[kind]}")
    return numbers


def _box(one: float, other: float, width: float, low: float, high: float) -> Block:
    """A box between two x, as wide as said about y = 0."""
    left, right, half = min(one, other), max(one, other), 0.5 * width
    return Block(((left, half), (left, -half)), ((right, half), (right, -half)), low, high)


def _table(top: float, half_width: float, *, shown: bool) -> Block:
    """The table below a height: all of it, or what is drawn about what stands on it."""
    half, thick = (half_width + _SHOWN, _PLATE) if shown else (_REACH, _REACH)
    return _box(-half, half, 2.0 * half, top - thick, top)


def _turned(points: Sequence[Point], turn: float) -> tuple[Point, ...]:
    cosine, sine = math.cos(turn), math.sin(turn)
    return tuple((cosine * x - sine * y, sine * x + cosine * y) for x, y in points)


def _word(kind: str, sizes: Sequence[float], rest: Sequence[float]) -> str:
    return f"{kind}:{'x'.join(map(text_of, sizes))}:{':'.join(map(text_of, rest))}"
