"""Fixtures: what holds the part and stands in the way, how it is written on a command line, and where it is placed."""

import math
import re
from dataclasses import dataclass, replace
from pathlib import PurePath, PureWindowsPath
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from cad_io.units import UNITS
from plan_cutters.domain.checks import did_you_mean, name, number, numbers, shown
from plan_cutters.domain.clamping import CHUCK, FORMS, VISE, Clamping, Requested, requested
from plan_cutters.domain.posture import Direction, direction_of
from plan_cutters.domain.stock import Stock
from plan_cutters.errors import FixtureError

#: Simple fixtures by words: what each number is.
WORDS = {"box": "x,y,z", "cylinder": "r,h", "table": "h", "stock": "STOCK", **FORMS}
TABLE, STOCK = "table", "stock"
#: A vise or chuck this near to the setup axis stands along it: cosine.
_ALONG = 0.5
_WORD = re.compile(rf"({'|'.join(WORDS)}):(.*)|({TABLE}|{VISE}|{CHUCK})", re.IGNORECASE | re.DOTALL)
#: Suffixes of files that are known, and what they are.
CAD = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
MESH = (".stl", ".obj", ".ply", ".glb")
_FORM = "FILE[@x,y,z[,rx,ry,rz]][:UNIT], box:x,y,z, cylinder:r,h, table, table:h, vise or chuck"
#: Lengths beyond this, mm, are rather a mistake.
_FARTHEST = 1e6
#: Angles this close to a quarter turn are one, deg: less than what a length of 1 m shows of rounding.
_HAIR = 1e-12
_NOWHERE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def no_format(file: str) -> str:
    """Say that the name of a file is of no format of fixtures, and what to give.

    >>> no_format("visee")
    'its name does not say its format; did you mean vise? Give STEP, IGES, BREP, STL, OBJ, PLY or GLB, or box:, cylinder:, \
table, vise or chuck'
    """
    suffix = PurePath(file).suffix.lower()
    what = f"{suffix!r} is no format of fixtures" if suffix else "its name does not say its format"
    meant = "" if suffix else did_you_mean(file.partition(":")[0], WORDS)
    begun = f"{what}{meant} Give" if meant else f"{what}: give"
    return f"{begun} STEP, IGES, BREP, STL, OBJ, PLY or GLB, or box:, cylinder:, table, vise or chuck"


@dataclass(frozen=True, slots=True, eq=False)
class Fixture:
    """A body that is in the way: a vise, a clamp, a table, the rest of the stock. Never a target.

    Attributes
    ----------
    source : str or object
        Path of a STEP, IGES, BREP, STL, OBJ, PLY or GLB file; `box:x,y,z` (its least corner at the origin), `cylinder:r,h` (it
        stands on the origin, along z), `table` (all that is below the part along the setup axis, as far as any cutter goes) or
        `table:h` (all below the height h along it, from the part's origin); `vise` or `chuck`, with sizes or without, which grip
        the part in the setup (`domain.clamping`); or an object: a kernel shape, a CadQuery or build123d object, a
        `cad_io.Part`, a trimesh mesh.
    placement : tuple of float
        x, y, z, mm, and rx, ry, rz, degrees, in part coordinates: turned about the part's fixed x axis, then about its y axis,
        then about its z axis, all through the origin, then shifted. Three numbers are a shift alone. A table with angles lies
        across the part's z, so turned, whatever the setup. A vise or chuck has a place of its own only where all its numbers
        are given, as plans write them.
    unit : str, optional
        What lengths in the source are in, one of `cad_io.units.UNITS`. Default: what the format says; mm for STL, OBJ, PLY and
        words. A placement is in mm always.
    name : str
        For people and plans; default the file's stem, the word, an object's label, or `fixture`.
    up : (float, float, float), optional
        Unit direction of the part along which a vise or chuck that is to be placed stands; None: the setup axis.
    chord_error : float
        How far a mesh may be from what it stands for, mm. No file says so, so it is 0 unless it is given.

    Raises
    ------
    FixtureError
        A number has no meaning, or the source is nothing that can be a fixture.

    Examples
    --------
    >>> vise = Fixture.parse("jaws/vise.stl@0,-30,5,0,0,90:in")
    >>> vise.name, vise.unit, vise.placement
    ('vise', 'in', (0.0, -30.0, 5.0, 0.0, 0.0, 90.0))
    >>> Fixture.parse("box:40,20,0")
    Traceback (most recent call last):
    plan_cutters.errors.FixtureError: fixture 'box:40,20,0': its sizes x,y,z must be positive numbers, not 0
    """

    source: Any
    placement: tuple[float, ...] = _NOWHERE
    unit: str | None = None
    name: str = ""
    chord_error: float = 0.0
    up: Direction | None = None

    def __post_init__(self) -> None:
        if isinstance(self.source, PurePath):
            object.__setattr__(self, "source", str(self.source))
        if self.source is None or isinstance(self.source, bool | int | float) or self.source == "":
            raise FixtureError(f"{shown(self.source)} is no fixture: give {_FORM}, or a body")
        placement = numbers(self.placement, "a fixture's placement")
        if len(placement) not in (3, 6):
            raise FixtureError(f"{self}: a placement is x,y,z or x,y,z,rx,ry,rz, not {len(placement)} numbers")
        if not all(abs(each) <= _FARTHEST for each in placement):
            raise FixtureError(f"{self}: a placement must be finite numbers of mm and degrees, up to {_FARTHEST:g}")
        object.__setattr__(self, "placement", (*placement, 0.0, 0.0, 0.0)[:6])
        if self.unit is not None and self.unit not in UNITS:
            raise FixtureError(f"{self}: no length unit is called {shown(self.unit)}; give one of {', '.join(UNITS)}")
        label = name(self.name, "a fixture's name", error=FixtureError)
        error = number(self.chord_error, "a fixture's chord error", error=FixtureError)
        if not 0.0 <= error < math.inf:
            raise FixtureError(f"{self}: its chord error must be 0 or a positive number of mm, not {error:g}")
        object.__setattr__(self, "chord_error", error)
        object.__setattr__(self, "name", label or name(self._named(), "a fixture's name"))
        _ = self.sizes
        if self.to_place and any(self.placement):
            raise FixtureError(
                f"{self}: a {self.kind} is placed for the setup; leave its placement out, or give all its numbers, as plans "
                "write them"
            )

    def __str__(self) -> str:
        text = self.source if isinstance(self.source, str) else type(self.source).__name__
        return f"fixture {text!r}"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fixture) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @property
    def _key(self) -> tuple[Any, ...]:
        source = self.source if isinstance(self.source, str) else id(self.source)
        return source, self.placement, self.unit, self.name, self.chord_error, self.up

    def stands_along(self, setup: Direction) -> Direction:
        """The direction along which a vise or chuck stands in a setup, or is to: the setup axis, or one across it."""
        up = self.up if self.clamping is None else direction_of(self.rotation[:, 2])
        return setup if up is None or float(np.dot(up, setup)) > _ALONG else up

    def _named(self) -> str:
        if not isinstance(self.source, str):
            label = getattr(self.source, "label", "")
            return (isinstance(label, str) and label.strip()) or "fixture"
        # A path of Windows is one on every system: its slashes are in no other name.
        return self.kind or PureWindowsPath(self.source).stem or self.source

    @property
    def kind(self) -> str:
        """The word that it is given by; empty for files and objects."""
        match = _WORD.fullmatch(self.source) if isinstance(self.source, str) else None
        return (match[1] or match[3]).lower() if match else ""

    @property
    def follows_setup(self) -> bool:
        """Whether where it lies depends on the setup axis: a table that is not turned by angles, or what is to be placed."""
        return self.to_place or self.kind == STOCK or (self.kind == TABLE and not any(self.placement[3:]))

    @property
    def grips(self) -> Requested | None:
        """Read what the word of a vise or chuck says; None for all else. Raises FixtureError: it has no meaning."""
        if self.kind not in FORMS:
            return None
        _, colon, numbers = self.source.partition(":")
        return requested(self.kind, numbers if colon else None, UNITS[self.unit or "mm"], str(self))

    @property
    def stock(self) -> Stock | None:
        """Read the stock that the first setup grips; None where it is no stock. Raises OptionError."""
        return Stock.of(self.source.partition(":")[2]) if self.kind == STOCK else None

    @property
    def to_place(self) -> bool:
        """Whether it is a vise or chuck that is to be placed for the setup."""
        grips = self.grips
        return grips is not None and grips.last is None

    @property
    def clamping(self) -> Clamping | None:
        """The vise or chuck that it is, in its own frame; None for all else, and for one that is to be placed."""
        grips = self.grips
        return None if grips is None or grips.last is None else grips.clamping

    @property
    def sizes(self) -> tuple[float, ...]:
        """Numbers of a word, mm; none for files, objects and a table right below the part."""
        if (grips := self.grips) is not None:
            return grips.numbers
        if (stock := self.stock) is not None:
            return stock.margins
        match = _WORD.fullmatch(self.source) if isinstance(self.source, str) else None
        if match is None or match[1] is None:
            return ()
        kind, form = match[1].lower(), WORDS[match[1].lower()]
        sizes = _numbers(match[2], f"{self}: its {'height' if kind == 'table' else 'sizes'}", form)
        if len(sizes) != form.count(",") + 1:
            raise FixtureError(f"{self}: {kind} takes {form}, not {len(sizes)} number{'s'[: len(sizes) != 1]}")
        for size in sizes:
            if size <= 0.0 and kind != "table":
                raise FixtureError(f"{self}: its sizes {form} must be positive numbers, not {size:g}")
            if abs(size) * UNITS[self.unit or "mm"] > _FARTHEST:
                raise FixtureError(f"{self}: {size:g} is beyond {_FARTHEST:g} mm; is its unit right?")
        return tuple(size * UNITS[self.unit or "mm"] for size in sizes)

    @property
    def shift(self) -> Floats:
        """(3,) mm."""
        return np.array(self.placement[:3])

    @property
    def rotation(self) -> Floats:
        """Matrix (3, 3): a point of the source goes to `rotation @ point + shift`."""
        (a, b), (c, d), (e, f) = map(_cosine_and_sine, self.placement[3:])
        about_x = np.array([[1, 0, 0], [0, a, -b], [0, b, a]])
        about_y = np.array([[c, 0, d], [0, 1, 0], [-d, 0, c]])
        about_z = np.array([[e, -f, 0], [f, e, 0], [0, 0, 1]])
        return np.asarray(about_z @ about_y @ about_x)

    @property
    def text(self) -> str:
        """As on a command line; of an object, what it is instead of a file."""
        what = self.source if isinstance(self.source, str) else f"<{type(self.source).__name__}>"
        used = self.placement if any(self.placement[3:]) else self.placement[:3]
        at = "@" + ",".join(f"{each:.10g}" for each in used) if any(used) else ""
        return f"{what}{at}{f':{self.unit}' if self.unit else ''}"

    @classmethod
    def parse(cls, text: str) -> "Fixture":
        """Read a text as on the command line. Whether a file exists is seen when it is read.

        What follows the last `@` is the placement, unless it holds a slash or ends as a file that is known; a word of letters
        after the last `:` is the unit. A file whose own name looks like that is given with a placement and a unit. Raises
        FixtureError.
        """
        if not isinstance(text, str):
            raise FixtureError(f"{shown(text)} is no fixture: give a Fixture or a text {_FORM}")
        rest, unit = text.strip(), None
        head, colon, tail = rest.rpartition(":")
        drive = len(head) == 1 and head.isalpha()
        if colon and not drive and head.lower() not in WORDS and (tail.isalpha() or not tail):
            if tail not in UNITS:
                raise FixtureError(f"fixture {text!r}: no length unit is called {tail!r}; give one of {', '.join(UNITS)}")
            rest, unit = head, tail
        head, at, tail = rest.rpartition("@")
        if not at or re.search(r"[/\\]", tail) or tail.lower().endswith((*CAD, *MESH)):
            return cls(rest, unit=unit)
        if not head:
            raise FixtureError(f"fixture {text!r}: there is nothing before the @; give {_FORM}")
        return cls(head, _numbers(tail, f"fixture {text!r}: its placement", "x,y,z or x,y,z,rx,ry,rz"), unit)

    @classmethod
    def of(cls, given: Any) -> "Fixture":
        """A fixture, or what `parse` makes of a text, or an object where it is."""
        if isinstance(given, cls):
            return given
        if isinstance(given, str):
            return cls.parse(given)
        return cls(given)

    @classmethod
    def each_of(cls, given: Any) -> tuple["Fixture", ...]:
        """One fixture, text or object, or a list of such, each with a name of its own.

        Raises FixtureError: a fixture has no meaning, or one that is to be placed on the part stands beside another that grips
        it.
        """
        if given is None:
            return ()
        fixtures = [cls.of(each) for each in (given if isinstance(given, list | tuple) else [given])]
        gripping = [each for each in fixtures if each.grips is not None]
        if len(gripping) > 1 and any(each.to_place for each in gripping):
            raise FixtureError(
                f"{' and '.join(map(str, gripping[:2]))}: one vise or chuck is placed on a part; leave the others out, "
                "or give all numbers of each, as plans write them"
            )
        names: list[str] = []
        for each in fixtures:
            # The later ones of the same name have a number.
            name, count = each.name, 2
            while name in names:
                name, count = f"{each.name} {count}", count + 1
            names.append(name)
        return tuple(replace(each, name=name) for each, name in zip(fixtures, names, strict=True))

    def placed(self, points: Floats) -> Floats:
        """Points (..., 3) of the source in part coordinates, mm."""
        return np.ascontiguousarray(points @ self.rotation.T + self.shift)


def _numbers(text: str, what: str, form: str) -> tuple[float, ...]:
    try:
        sizes = tuple(float(word) for word in text.split(","))
    except ValueError:
        raise FixtureError(f"{what} {text!r} is not of the form {form}") from None
    if not all(math.isfinite(each) for each in sizes):
        raise FixtureError(f"{what} {text!r} must be finite numbers {form}")
    return sizes


def _cosine_and_sine(angle: float) -> tuple[float, float]:
    """Of an angle, deg; exact at quarter turns, up to rounding, so that a fixture turned by 90 degrees keeps its planes."""
    quarters = round(angle / 90.0)
    if abs(angle - 90.0 * quarters) <= _HAIR:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[quarters % 4]
    turn = math.radians(angle)
    return math.cos(turn), math.sin(turn)
