"""A tool as its file has it, before it is a cutter, and the records that reading a library gives."""

import os
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal, overload

from plan_cutters.domain.checks import finite, items, shown
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.drill import Drill
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.files.content import Content


@dataclass(frozen=True, slots=True)
class Entry:
    """One tool as a file lists it."""

    place: str  #: Where it stands, for people: `tool 3 (line 52)`.
    number: int | None = None  #: In the machine's tool changer.
    #: `name`, `kind`: as the file words them.
    name: str = ""
    kind: str = ""
    unit: str = ""  #: That its lengths are given in: `mm`, `inch`; empty where the file does not say.
    cutter: Cutter | None = None  #: What can be judged of it. None: it is a `drill`, or `unused` says why.
    unused: str | None = None  #: The field concerned, what is wrong with it and what to add.
    broken: bool = False  #: It contradicts itself or cannot be read; else it is not for finishing, or lacks something.
    notes: tuple[str, ...] = ()  #: How it was understood where that is not plain.
    given: tuple[tuple[str, float], ...] = ()  #: Dimensions that were read, mm and degrees, by their ISO 13399 names.
    feed: float | None = None  #: Of its preset, mm/min. It is none of the cutter's, whose id stays the same.
    preset: str = ""  #: The name of the preset that the feed is of.
    unheld: bool = False  #: It is not used because it does not fit its holder.
    drill: Drill | None = None  #: What it is where it is a tool for holes.

    @property
    def label(self) -> str:
        """Its place, and its name where it has one."""
        return f'{self.place} "{self.name}"' if self.name else self.place


@dataclass(frozen=True, slots=True)
class Library(Sequence[Cutter]):
    """The cutters of a file, each geometry once, in the file's order: `plan(part, cutters=library)`.

    >>> Library("none.toml", "plan-cutters TOML")[0:]
    ()
    """

    #: `file`, `format`: the file's name without its folder, and the name of its format.
    file: str
    format: str
    entries: tuple[Entry, ...] = ()  #: All that the file lists, used or not.
    holders: tuple[Holder, ...] = ()  #: Listed by themselves, without a tool.
    notes: tuple[str, ...] = ()  #: How the file as a whole was understood.
    cutters: tuple[Cutter, ...] = field(init=False)

    def __post_init__(self) -> None:
        cutters: dict[str, Cutter] = {}
        for entry in self.entries:
            if entry.cutter is not None:
                cutters.setdefault(entry.cutter.id, entry.cutter)
        object.__setattr__(self, "cutters", tuple(cutters.values()))

    def __len__(self) -> int:
        return len(self.cutters)

    def __iter__(self) -> Iterator[Cutter]:
        return iter(self.cutters)

    @overload
    def __getitem__(self, at: int) -> Cutter: ...
    @overload
    def __getitem__(self, at: slice) -> tuple[Cutter, ...]: ...
    def __getitem__(self, at: int | slice) -> Cutter | tuple[Cutter, ...]:
        return self.cutters[at]

    @property
    def unused(self) -> tuple[Entry, ...]:
        """Entries that became no cutter, and no tool for holes."""
        return tuple(entry for entry in self.entries if entry.cutter is None and entry.drill is None)

    @property
    def drills(self) -> tuple[Drill, ...]:
        """Its tools for holes, each geometry once, in the file's order."""
        return tuple({entry.drill.id: entry.drill for entry in reversed(self.entries) if entry.drill is not None}.values())[::-1]

    def entries_of(self, cutter: Cutter | str) -> tuple[Entry, ...]:
        """All entries of one geometry; a cutter that was asked for more (allowance, holder) is not known any longer."""
        wanted = cutter if isinstance(cutter, str) else cutter.id
        return tuple(entry for entry in self.entries if entry.cutter is not None and entry.cutter.id == wanted)

    def numbers(self, cutter: Cutter | str) -> tuple[int, ...]:
        """Each tool number of one geometry once, in the file's order."""
        return tuple(dict.fromkeys(e.number for e in self.entries_of(cutter) if e.number is not None))

    def names(self, cutter: Cutter | str) -> tuple[str, ...]:
        """Each name of one geometry once, in the file's order."""
        return tuple(dict.fromkeys(entry.name for entry in self.entries_of(cutter) if entry.name))


def libraries_of(value: Any) -> tuple[Library, ...]:
    """One library or a list of such; None is an empty list."""
    if value is None:
        return ()
    libraries = [value] if isinstance(value, Library) else items(value, "libraries", "libraries")
    for each in libraries:
        if not isinstance(each, Library):
            raise LibraryError(f"{shown(each)} is no tool library: read_library reads a file")
    return tuple(libraries)


#: mm in one of each, by the words that formats have for units.
UNITS = {"millimeters": 1.0, "millimetres": 1.0, "mm": 1.0, "metric": 1.0, "inches": 25.4, "inch": 25.4, "in": 25.4}
#: Lengths beyond this, mm, are none of a tool.
_LONGEST = 1e4
#: Digits kept of a length, mm: what is beyond them is the rounding of other programs and of inches.
_DIGITS = 9
_LONG_NAME = 120


class FaultError(Exception):
    """A value that cannot be read, in words that name its field."""


def name_of(value: Any) -> str:
    """A name on one line, without what cannot be shown."""
    text = value if isinstance(value, str) else "" if value is None else shown(value)
    text = " ".join("".join(" " if unicodedata.category(c)[0] in "CZ" else c for c in text).split())
    return text if len(text) <= _LONG_NAME else f"{text[: _LONG_NAME - 3]}..."


def unit_of(value: Any, field: str) -> tuple[str, float]:
    """`mm` or `inch`, and mm in one of it."""
    if value is None or value == "":
        raise FaultError(f"{field} is missing: are its lengths millimeters or inches?")
    scale = UNITS.get(value.strip().lower()) if isinstance(value, str) else None
    if scale is None:
        raise FaultError(f"{field} is {shown(value)}: millimeters or inches are read")
    return ("mm" if scale == 1.0 else "inch"), scale


def whole_of(value: Any, field: str) -> int | None:
    """A tool number; None where there is none."""
    if value is None or value == "":
        return None
    try:
        number = float(value)
        if isinstance(value, bool) or number != int(number) or not 0 <= number < 1e9:
            raise ValueError
    except (TypeError, ValueError, OverflowError):
        raise FaultError(f"{field} is {shown(value)}, which is no tool number") from None
    return int(number)


#: A number written as one: no text, no truth value.
number_of = partial(finite, error=FaultError)


def number_in(text: str, field: str) -> tuple[float, bool]:
    """A number from a text, and whether it has a decimal comma."""
    word, comma = text.strip(), False
    if "," in word:
        if "." in word or word.count(",") > 1:
            raise FaultError(f"{field} is {shown(text)}: a comma and a point, or several commas, can be read in two ways")
        word, comma = word.replace(",", "."), True
    try:
        if "_" in word:
            raise ValueError
        return number_of(float(word), field), comma
    except ValueError:
        raise FaultError(f"{field} must be a number, not {shown(text)}") from None


def mm(value: float, scale: float, field: str, *, exact: bool = False) -> float:
    """A length that may be 0, mm; `exact`: one that is given in mm stays as it is."""
    rounded = round(value * scale, _DIGITS) + 0.0
    if rounded < 0.0:
        raise FaultError(f"{field} is {value:g}: a length cannot be negative")
    if rounded > _LONGEST:
        raise FaultError(f"{field} is {value:g}: no tool is longer than 10 m")
    return value if exact and scale == 1.0 else rounded


@dataclass(slots=True)
class Listed:
    """A tool as a file lists it, filled by the readers of formats."""

    place: str
    number: int | None = None
    name: str = ""
    kind: str = ""  #: As the file words it; `sort`, if given, is what that is among `milling.MILLS`.
    sort: str = ""
    tapered: str = ""  #: Which tip a tapered mill has, as the file words it: its dimensions can mean a ball and a bull nose.
    unit: str = ""
    scale: float = 1.0
    #: By ISO 13399 name, mm and degrees; what is missing or 0 is not there. DC cutting diameter, RE corner radius, LCF flute
    #: length, LPR stick-out, OAL overall length, DMM shank diameter, LN height over the tip at which the shoulder ends and DN its
    #: diameter, TA half angle, SIG angle of a drill's point, TP pitch of a tap, TIP diameter at the tip, LF gauge length of the
    #: assembly, LH of its holder, DCX largest diameter.
    values: dict[str, float] = field(default_factory=dict)
    words: dict[str, str] = field(default_factory=dict)  #: What the file calls each.
    shaft: list[Segment] = field(default_factory=list)  #: Sections that the file gives above LN (or LCF), from there up.
    holder: Holder | Literal["none"] | None = None  #: `none`: the file says that there is none.
    zeros: set[str] = field(default_factory=set)  #: Dimensions that the file states as 0: it does not lack them.
    faults: list[str] = field(default_factory=list)  #: What could not be read.
    doubts: list[str] = field(default_factory=list)  #: Fields that can mean different tools.
    notes: list[str] = field(default_factory=list)
    needs: tuple[str, ...] = ("DC", "LCF")  #: Dimensions without which there is no cutter.
    reverse: bool = False  #: A tap of a left-hand thread.
    flutes_everywhere: bool = False  #: Its drawing is as wide everywhere: what states no flutes has them up to its holder.
    #: Of our own format alone: attributes of the cutter, as in `Dimensions`, that no dimension here says. With them, lengths in
    #: mm are taken to the last digit, and sections as they are.
    stated: dict[str, Any] | None = None
    straight: bool = False  #: No shank is requested: what is below it goes on.
    feed: float | None = None  #: mm/min, and the name of the `preset` that it is of.
    preset: str = ""

    def tried(self, make: Callable[[], Any], otherwise: Any) -> Any:
        """Make a part of the tool; where it cannot be read, record the fault and return `otherwise` in its place."""
        try:
            return make()
        except (FaultError, CutterError) as fault:
            self.faults.append(str(fault))
            return otherwise

    def word(self, key: str) -> str:
        """Give the name that the file has for a dimension."""
        return self.words.get(key, key)

    def states(self, key: str) -> bool:
        """Whether the file has a dimension, be it 0."""
        return key in self.values or key in self.zeros

    def cite(self, key: str) -> str:
        """A dimension as the file has it."""
        value = self.values.get(key, 0.0)
        return f"{self.word(key)} {value if key in ('TA', 'SIG') else value / self.scale:.10g}"

    def take(self, key: str, value: Any, field: str, number: Any = number_of) -> None:
        """Keep a dimension, if there is one, or what is wrong with it."""
        self.words[key] = field
        if value is None or value == "":
            return
        try:
            result = number(value, field)
            if key == "TA":
                if not 0.0 <= result < 90.0:
                    raise FaultError(f"{field} is {result:g}: a half angle lies between 0 and 90 degrees")
            elif key == "SIG":
                if not 0.0 <= result <= 180.0:
                    raise FaultError(f"{field} is {result:g}: the angle of a point lies between 0 and 180 degrees")
            else:
                result = mm(result, self.scale, field, exact=self.stated is not None)
            if result:
                self.values[key] = result
            else:
                self.zeros.add(key)
        except FaultError as fault:
            self.faults.append(str(fault))

    def entry(self, **more: Any) -> Entry:
        """As a record."""
        return Entry(
            self.place, self.number, self.name, self.kind, self.unit, notes=tuple(dict.fromkeys(self.notes)),
            given=tuple(self.values.items()), feed=self.feed, preset=self.preset, **more,
        )  # fmt: skip


@dataclass(slots=True)
class LibraryContent:
    """A reader finds these tools, holders and notes in a file."""

    tools: list[Listed | Entry] = field(default_factory=list)
    holders: list[Holder] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    #: Holders that cannot be read, as entries.
    faulty: list[Entry] = field(default_factory=list)


def sections(rows: Iterable[tuple[float, float, float]], what: str) -> list[Segment]:
    """Stages from (height, lower diameter, upper diameter), mm; those without a height are steps.

    Raises FaultError: a diameter is 0.
    """
    result = []
    for i, (height, lower, upper) in enumerate(rows, 1):
        if height == 0.0:
            continue
        if not (lower > 0.0 and upper > 0.0):
            raise FaultError(f"{what} {i} has a diameter of 0")
        result.append(Segment(0.5 * lower, height, 0.5 * upper))
    return result


#: Tools that a file may list: more take more memory than a planner's computer has.
MOST_TOOLS = 50_000


def opened(path: str | os.PathLike[str]) -> Content:
    """Read a file that may be a tool library."""
    return Content.of(path, "tool library", LibraryError)


def too_many(file: str) -> LibraryError:
    return LibraryError(f"lists more than {MOST_TOOLS} tools; split it", file=file)
