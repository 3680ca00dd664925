"""The options of a plan, each with its default, are defined here."""

import inspect
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypedDict, TypeVar, Unpack

from cad_io.units import UNITS
from plan_cutters.domain.answers import answers_of
from plan_cutters.domain.checks import Angle, choice, degrees_too, did_you_mean, flag, not_empty, number, shown, whole
from plan_cutters.domain.clamping import CHUCK, VISE
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import notation
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.operations import operations_of
from plan_cutters.domain.own_process import OwnProcess, operations_requested
from plan_cutters.domain.posture import ROTATIONS, STEP, TILTS, PostureRange
from plan_cutters.domain.shapes import largest_tilt
from plan_cutters.domain.standard_tools import builtin
from plan_cutters.domain.stock import PART, USUAL, Stock
from plan_cutters.errors import OptionError
from plan_cutters.library.cutting import feed_of
from plan_cutters.library.raw_tool import Entry, Library, libraries_of
from plan_cutters.option_table import ATTRIBUTES, OF_A_SCENE, OPTIONS, TAKES, Option
from plan_cutters.setups.requested import MOST_PROPOSED, setups_requested, without

#: Options that are angles, and what each may be in degrees.
ANGLES = {"tilt": TILTS, "rotation": ROTATIONS, "rotation_step": STEP}
ANGLES |= {each.word: Angle(*each.limits[:2]) for each in OPTIONS.values() if each.is_angle and each.limits}
#: What calls take beside options: it may be meant where a name is mistyped.
OF_CALLS = ("part", "progress", "cache")
if TYPE_CHECKING:
    from plan_cutters.option_types import OptionValues, PlanOptions, PointOptions, SceneOptions
else:
    # Who is shown a call reads the words of the table.
    OptionValues = object
    PlanOptions = TypedDict("PlanOptions", TAKES, total=False)
    SceneOptions = TypedDict("SceneOptions", {word: TAKES[word] for word in OF_A_SCENE}, total=False)
    PointOptions = TypedDict("PointOptions", {word: TAKES[word] for word in OF_A_SCENE if word != "tolerance"}, total=False)


def machine_option(value: Any) -> Machine:
    """A machine, or what a text names: a file is read only where it is none of the names."""
    if isinstance(value, str | os.PathLike) and value != "unlimited":
        from plan_cutters.machines.read import machine_of

        return machine_of(value)
    return Machine.of(value)


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):  # Linux only
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


#: Accuracy of rotary axes that state none, rad.
_ACCURACY = math.radians(0.05)
#: Contacts between the samples unless a number is requested: so many for each sample, and at most.
_BETWEEN, _MOST_BETWEEN = 24, 100_000
_Class = TypeVar("_Class")


def _within_limits(value: Any, option: Option) -> float:
    """A number that an option may have."""
    what = option.word.replace("_", " ")
    checked = number(value, what) if option.kind is float else whole(value, what)
    # Angles are rad here, and degrees where they are requested and read.
    shown_value = math.degrees(checked) if option.unit == "deg" else checked
    low, high, *must = option.limits or (-math.inf, math.inf)
    if not low <= shown_value <= high:
        written = shown_value if isinstance(shown_value, int) else f"{shown_value:g}"
        why = must[0] if must else f"must lie between {low:g} and {high:,.9g} {option.unit}"
        raise OptionError(f"{what} {written} {why}")
    return checked


#: Defaults that are none of the command line.
_DEFAULTS: dict[str, Any] = {
    "machine": field(default_factory=Machine), "setup": (0.0, 0.0, 1.0), "faces": None,
    "rotation": (0.0, 2 * math.pi), "jobs": field(default_factory=cores), "answers": (),
}  # fmt: skip


def _own_process(value: Any) -> OwnProcess | None:
    if value is None:
        return None
    # Readers of machine files load pydantic.
    from plan_cutters.machines.process_file import process_of

    return process_of(value)


def _with_attributes(made: type[_Class]) -> type[_Class]:
    """Give a class all options, with these defaults or those of the command line, angles in radians."""
    made.__annotations__ = {word: each.types[1] for word, each in ATTRIBUTES.items()}
    for word, each in ATTRIBUTES.items():
        default = math.radians(each.default) if each.default is not None and each.unit == "deg" else each.default
        setattr(made, word, _DEFAULTS.get(word, default))
    return made


@degrees_too(ANGLES)
@dataclass(frozen=True, slots=True)
@_with_attributes
class Options(OptionValues):
    """Options of a plan: as on the command line, whose help says what each means. Lengths mm, angles rad; degrees as `tilt_deg`,
    `rotation_deg`, `rotation_step_deg`, `index_step_deg`, `axis_accuracy_deg`.

    Attributes
    ----------
    cutters, libraries : tuple of Cutter, tuple of Library
        Those of libraries (`library.read_library`) are judged, too. May be given as one cutter, text such as `R6L80` or library,
        as a list, or by names of your own: `{"Finisher": "R6L80"}`. Neither: the built-in cutters.
    holder : Holder, optional
        Of the cutters that have none, but for those of libraries; may be given as a text such as `R15L30`.
    allowance, holder_clearance : float
        For cutters that do not say so themselves.
    machine : Machine
        May be given as a text: `tilt:60`, the name of a built-in one, or a machine file.
    setup : tuple of float
        Direction of the part along the machine's spindle at zero angles; kept with length 1. May be given as a word (`Z`, `-y`),
        an axis of build123d, a Placement, a setup file, or a plane of build123d or CadQuery, whose normal it is and whose X
        is the machine's: its origin says nothing. Of the last three it is kept as `placement`, too, and fixtures of the first
        two are added to `fixtures`. `auto` proposes setups (`propose`).
    other_setups : tuple of (float, float, float)
        More setup axes, in which every cutter is judged as well; the sides of open faces stay those of `setup`. May be given in
        the same ways, with fixtures and clamped faces of their own.
    faces, ignore : str, list of str or objects
        Target faces, and faces that are neither targets nor obstacles, in the words of the command line, or as numbers, or as
        objects of the kernel or a CAD host. Default: the faces picked on the object that the part was made from; where none
        were, `sculptured,blends`.
    tilt, rotation : tuple of float
        Tilts within 0 to pi, by default to pi/2 or as far as a cutter touches; rotations from the direction of largest curvature.
    answers : tuple of str
        Of `domain.answers.ANSWERS`, or `all`; may be given as one text.
    axis_accuracy : float, optional
        None: that of the machine's least accurate rotary axis, where its file states one, else 0.05 deg.
    border_cost : float
        Seconds a mm, where plans are compared: the border shows as a mark. They are no part of the times that are written.
    effort : str
        How much work advice and proofs after the verdicts may take (`option_table.EFFORT`). Verdicts and the test of each step of
        a plan are the same with any.
    max_orientations : int
        Without effect where `most_operations` is given.
    process : OwnProcess, optional
        The planner's own steps, as a file or a mapping too; the rest is planned by `operations`, else the fastest or the fewest.
    patterns : bool
        Equal faces are judged once and planned once.
    fixtures : tuple of Fixture
        What holds the part: obstacles, never targets. May be given as texts such as `vise.step@0,0,-20` or `table:-5`, as
        trimesh meshes and shapes of a kernel or CAD host, or as one of these. Those that no setup file names stand in all setups.
    placement, other_placements : Placement, optional, and tuple of them
        How the part stands in `setup`, and in each of `other_setups`, where more than the axis is known.
    propose : bool
        The setups are to be proposed: as `setup="auto"` says it.
    stock : str
        What the first setup grips, in the words of the command line, with all its numbers. `part` unless it is given, or a vise
        may be proposed.

    Raises
    ------
    OptionError
        A value has no meaning.

    Examples
    --------
    >>> Options(cutters="R6L80", setup=(0, 0, 5)).setup
    (0.0, 0.0, 1.0)
    >>> [cutter.id for cutter in Options().judged][:3]
    ['R1L20F6N0.95x9S3HR10.5L60', 'R1L20rc1F6N0.95x9S3HR10.5L60', 'R1.5L25F9N1.425x11S3HR10.5L60']
    >>> Options(grid=1)
    Traceback (most recent call last):
    plan_cutters.errors.OptionError: grid 1 must lie between 2 and 5000 samples a side
    """

    if TYPE_CHECKING:

        def __init__(self, **options: Unpack[PlanOptions]) -> None: ...

    def __post_init__(self) -> None:
        self._check_kinds()
        if self.grid is not None and self.spacing is not None:
            raise OptionError("give a grid or a spacing, not both")
        if self.unit is not None and self.unit not in UNITS:
            raise OptionError(f"unit {self.unit!r} is not one of {', '.join(UNITS)}")
        if self.operations is not None or self.process is not None:
            setups = MOST_PROPOSED if self.propose else 1 + len(self.other_setups)
            which = operations_requested(self.operations, self.process, self.judged, self.feeds, self.machine, setups)
            object.__setattr__(self, "operations", which)
        for cutter in self.judged:
            if not cutter.large_enough(self.tolerance):
                raise OptionError(f"tolerance {self.tolerance:g} mm is too coarse for cutter {cutter.typed}")
        object.__setattr__(self, "tilt", (0.0, largest_tilt(self.judged)) if self.tilt is None else self.tilt)

    def _check_kinds(self) -> None:
        """Every value of the type that its attribute says."""

        def take(**values: Any) -> None:
            for word, value in values.items():
                object.__setattr__(self, word, value)

        libraries = libraries_of(self.libraries)
        if isinstance(self.cutters, Library):
            take(libraries=(self.cutters, *libraries), cutters=())
        else:
            take(libraries=libraries, cutters=Cutter.each_of(self.cutters))
        take(machine=machine_option(self.machine))
        stock = None if self.stock is None else Stock.of(self.stock)
        take(**setups_requested(self.setup, self.placement, self.other_setups, self.other_placements, self.fixtures,
                            propose=flag(self.propose, "propose"), stock=stock, chuck_axis=self.machine.chuck_axis))  # fmt: skip
        vise = self.propose and (not self.fixtures or self.fixtures[0].kind in (VISE, CHUCK))
        known = next((each.stock for each in self.fixtures if each.stock), None)
        take(stock=(stock or known or Stock.of(USUAL if vise else PART)).text)
        take(answers=answers_of(self.answers), operations=operations_of(self.operations), process=_own_process(self.process))
        take(holder=None if self.holder is None else Holder.of(self.holder), jobs=cores() if self.jobs is None else self.jobs)
        for word, each in OPTIONS.items():
            value = getattr(self, word)
            if each.kind is bool:
                take(**{word: flag(value, word)})
            elif each.limits is not None and (value is not None or each.default is not None):
                take(**{word: _within_limits(value, each)})
            elif each.choices and word not in ("operations", "unit") and value != each.default and value not in each.choices:
                raise OptionError(f"{word.replace('_', ' ')}: {shown(value)} is none of {', '.join(each.choices)}")
        choice(self.faces, "faces")
        choice(self.ignore, "ignore")
        if self.unit is not None and not isinstance(self.unit, str):
            raise OptionError(f"unit must be one of {', '.join(UNITS)}, not {shown(self.unit)}")
        postures = self.postures
        take(tilt=None if self.tilt is None else postures.tilt, rotation=postures.rotation, rotation_step=postures.step)

    @property
    def accuracy(self) -> float:
        """Accuracy of the rotary axes, rad: that was requested, else that of the machine."""
        if self.axis_accuracy is not None:
            return self.axis_accuracy
        stated = [each.accuracy for each in self.machine.axes if each.accuracy is not None]
        return max(stated, default=_ACCURACY)

    @property
    def shared_fixtures(self) -> tuple[Fixture, ...]:
        """Fixtures that stand in all setups: those that the first setup does not bring itself."""
        own = () if self.placement is None else self.placement.fixtures
        return without(self.fixtures, own)

    @property
    def held_alike(self) -> bool:
        """Whether the part is held by the same fixtures, at the same faces, in all setups."""
        if not self.other_setups:
            return True
        places = (self.placement, *(self.other_placements or (None,) * len(self.other_setups)))
        return not any(place is not None and (place.clamped or place.fixtures) for place in places)

    @classmethod
    def of(cls, words: Mapping[str, Any]) -> "Options":
        """Options from their names; OptionError for a name that is none, and for an empty list of cutters."""
        known = list(inspect.signature(cls).parameters)
        for word in words:
            if word not in known:
                meant = did_you_mean(word, (*known, *OF_CALLS)) or f"; {', '.join(known)}"
                raise OptionError(f"no option is called {word}{meant}")
        not_empty(None if words.get("libraries") else words.get("cutters"), "cutters", "leave it out for the built-in cutters")
        return cls(**words)

    def contacts_between(self, samples: int) -> int:
        """Most contacts to look at between so many samples."""
        return min(_MOST_BETWEEN, _BETWEEN * samples) if self.area_budget is None else self.area_budget

    @property
    def postures(self) -> PostureRange:
        """The posture range to search."""
        tilt = PostureRange().tilt if self.tilt is None else self.tilt
        return PostureRange(tilt, self.rotation, self.rotation_step)

    @property
    def judged(self) -> tuple[Cutter, ...]:
        """The cutters to judge, each id once, with what is asked for the whole plan."""
        built_in = () if self.cutters or self.libraries else builtin()
        cutters = [self._asked(c, self.holder) for c in (*self.cutters, *built_in)]
        listed = [self._asked(c, None) for library in self.libraries for c in library]
        return tuple({c.id: c for c in (*cutters, *listed)}.values())

    @property
    def reported_unit(self) -> Literal["mm", "in"] | None:
        """The unit of lengths in the words; None: mm, and tools as they were given."""
        stated = [notation(each.name).inches for each in self.cutters]
        stated += [entry.unit == "inch" for library in self.libraries for entry in library.entries if entry.cutter is not None]
        return self.units or ("in" if stated and all(stated) else None)

    @property
    def sources(self) -> dict[str, tuple[tuple[Library, Entry], ...]]:
        """By the id of a cutter to judge, where it is listed in the libraries."""
        result: dict[str, list[tuple[Library, Entry]]] = {}
        for library in self.libraries:
            for cutter in library:
                places = result.setdefault(self._asked(cutter, None).id, [])
                places += [(library, entry) for entry in library.entries_of(cutter)]
        return {name: tuple(places) for name, places in result.items()}

    @property
    def feeds(self) -> dict[Cutter, float]:
        """The feed of each cutter to judge that has one, mm/min."""
        if self.feed is not None:
            return dict.fromkeys(self.judged, self.feed)
        sources = self.sources
        stated = {cutter: feed_of([entry for _, entry in sources.get(cutter.id, ())]) for cutter in self.judged}
        return {cutter: feed for cutter, feed in stated.items() if feed is not None}

    def _asked(self, cutter: Cutter, holder: Holder | None) -> Cutter:
        return cutter.asked(self.allowance, self.holder_clearance, holder)
