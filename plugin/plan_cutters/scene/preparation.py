"""A part that is ready to be judged, cutter by cutter: its samples, how it stands in each setup, and which samples are copies."""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io import Orientation, Part, SurfaceSamples
from cad_io.arrays import Floats, Ints, Record
from cad_io.part.equal_faces import Motion
from cad_io.part.holes import Hole
from cad_io.part.patterns import Pattern
from cad_io.sample import bends, sample
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import STOCK, Fixture
from plan_cutters.domain.placement import Placement, axis_words
from plan_cutters.domain.verdicts import ANOTHER_SETUP, FIXTURE, Verdicts
from plan_cutters.errors import FixtureError, OptionError, TooManySamplesError
from plan_cutters.options import Options
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.faces import Chosen, clamped_faces
from plan_cutters.scene.inside_material import inside_material
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups.clamping import refuse_ungripped
from plan_cutters_base.stage_cache import NO_CACHE, Cache

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Copies(Record):
    """Samples that are images of others under motions of the whole part."""

    master: Rows  #: (n,) int64: the sample whose image each one is; itself where it is none.
    motion: Ints  #: (n,) int32: which motion carries the master onto it, -1 for none.
    motions: tuple[Motion, ...]
    #: Of each setup, whether each motion leaves all that verdicts depend on as it is: limits of axes, fixtures, what is ignored.
    unchanged: tuple[tuple[bool, ...], ...]
    #: (n,) bool: copies whose postures that are searched are the images of those searched at the master.
    frames: NDArray[np.bool_]
    #: (n,) bool: those of `frames` that are judged by themselves as well: a tenth of them, on each face that a motion carries
    #: onto another.
    verified: NDArray[np.bool_]
    group: Rows  #: (n,) int64: the same for copies of one motion on one face, -1 for none.
    setup: int = 0  #: Counted from 0, in which the part is looked at.

    @property
    def copy(self) -> NDArray[np.bool_]:
        """Samples (n,) that are images of others."""
        return np.asarray(self.motion >= 0)

    @property
    def follow(self) -> NDArray[np.bool_]:
        """Copies (n,) of which it may follow that they are not reached, where their master is not."""
        follows = np.append(np.array(self.unchanged[self.setup], bool), False)
        return np.asarray(self.frames & self.copy & follows[self.motion])

    def moved(self, rows: Rows, vector: Floats) -> Floats:
        """Vectors (m, 3) at the masters of copies, as the motions carry them."""
        result = np.full((len(rows), 3), np.nan)
        for k, motion in enumerate(self.motions):
            mine = self.motion[rows] == k
            result[mine] = motion.directions(vector[mine])
        return result


#: Spacing of samples, mm: one, by face number, or none where they are taken on a grid.
Spacing = float | dict[int, float] | None

#: Samples that a plan may take.
MOST_SAMPLES = 5_000_000
#: Environment variable by which whoever runs a service allows fewer.
MOST = "PLAN_CUTTERS_MOST_SAMPLES"
#: Samples that a default plan may take, in all.
BUDGET = 40_000
#: Share of the smallest radius, and turn of the normal (rad), between neighbouring samples.
_SHARE, _TURN = 0.25, 0.2
#: Curvature makes the spacing finer by no more than this.
_FINEST = 4.0


def default_spacing(
    part: Part, orientation: Orientation, faces: Sequence[int], cutters: Sequence[Cutter]
) -> tuple[dict[int, float], float]:
    """Spacing of each target face, mm, and how many times as coarse as it should be, for the budget.

    A quarter of the smallest cutter's radius, finer (up to four times) where the surface bends within it, coarser for
    all faces alike where the budget binds.
    """
    base = _SHARE * min(c.radius for c in cutters)
    scout = bends(part, orientation, faces, 9)
    spacing: dict[int, float] = {}
    for number in faces:
        here = np.nan_to_num(scout.get(number, np.zeros(0)))
        # A median: a point at an apex or a crease says nothing about the face.
        typical = float(np.median(here)) if len(here) else 0.0
        spacing[number] = min(base, max(base / _FINEST, _TURN / typical if typical else base))
    wanted = sum(part.faces[number - 1].area / spacing[number] ** 2 for number in faces)
    coarser = max(1.0, (wanted / BUDGET) ** 0.5)
    return {number: value * coarser for number, value in spacing.items()}, coarser


class Sampled(NamedTuple):
    """Samples, and what `Prepared` says of their spacing."""

    samples: SurfaceSamples
    spacing: Spacing
    coarser: float


def sampled(
    part: Part, orientation: Orientation, options: Options, faces: Sequence[int], cutters: Sequence[Cutter],
    at: Callable[[int], None] = lambda face: None,
) -> Sampled:  # fmt: skip
    """Sample faces as the options ask; `at` as in `sample`."""
    spacing: Spacing = options.spacing
    coarser = 1.0
    if options.grid is None and options.spacing is None:
        spacing, coarser = default_spacing(part, orientation, faces, cutters)
    return Sampled(sample(part, orientation, grid=options.grid, spacing=spacing, faces=faces, at=at), spacing, coarser)


def spacing_key(options: Options, cutters: Sequence[Cutter]) -> tuple[float | None, ...]:
    """All that samples follow from, beside the part, its faces and their sides."""
    least = min(cutter.radius for cutter in cutters) if options.grid is None and options.spacing is None else None
    return options.grid, options.spacing, least


def affordable(part: Part, faces: Sequence[int], options: Options) -> None:
    """Refuse to sample more than memory holds, before it is tried."""
    stated, wanted = os.environ.get(MOST, "") or str(MOST_SAMPLES), 0.0
    if not stated.isdecimal():
        raise OptionError(f"{MOST} in the environment must be a whole number, not {stated!r}")
    most = min(MOST_SAMPLES, int(stated))
    if options.grid is not None:
        wanted = len(faces) * float(options.grid) ** 2
    elif options.spacing is not None:
        wanted = sum(part.faces[n - 1].area for n in faces) / options.spacing / options.spacing
    if wanted > most:
        raise TooManySamplesError(
            f"that would take about {wanted:.2g} samples, at most {most:.0e} are taken: sample more coarsely, "
            "or choose faces with --faces",
            file=part.file,
        )


#: A unit direction of the part.
Axis = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class OtherSetup(Record):
    """Another setup than the first has its own conditions, and its own samples that no cutter gets to."""

    conditions: Conditions  #: With the obstacles of that setup.
    inside: Ints  #: (n,) int32: the body that each sample lies within there, -1 for none.
    clamped: NDArray[np.bool_]  #: (n,) bool: samples of faces that are held there.


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Prepared(Record):
    """Everything that is needed to judge a cutter."""

    scene: Scene
    options: Options
    chosen: Chosen  #: Target and ignored faces.
    spacing: Spacing  #: Of the samples: one, by face number, or none where they were taken on a grid.
    samples: SurfaceSamples
    surface_class: NDArray[np.uint8]  #: (n,) uint8.
    region: Ints  #: (n,) int32: connected samples of one class.
    inside: Ints  #: (n,) int32: the body that each sample lies within in the first setup, -1 for none.
    #: (n,) bool: samples that lie inside another body of the part (`inside_material.inside_bodies`).
    inside_bodies: NDArray[np.bool_]
    conditions: Conditions
    cutters: tuple[Cutter, ...]  #: From the most wanted down.
    #: How many times as far apart as curvature and cutters ask the samples are, for the budget of a default plan.
    coarser: float = 1.0
    #: (n,) bool: samples of faces that are clamped in the first setup; None: none of them is.
    held: NDArray[np.bool_] | None = None
    others: tuple[OtherSetup, ...] = ()  #: The setups beside the first.
    #: (n,) bool: samples at sharp inside edges that no cutter has to reach (`judging.reasons.exempt`); None: all are required.
    exempt: NDArray[np.bool_] | None = None
    holes: tuple[Hole, ...] = ()  #: Those that are for drills, each with its faces that are.
    drilled: NDArray[np.bool_] | None = None  #: (n,) bool: samples in them, which no mill is asked for; None: there are none.
    patterns: tuple[Pattern, ...] = ()  #: Equal faces of the part, and motions that carry it onto itself.
    #: Samples that these motions carry onto others; None where there are few, or patterns are not to be used.
    copies: Copies | None = None
    cache: Cache = field(default=NO_CACHE, compare=False)  #: What stages make of this part is kept there.

    @property
    def axes(self) -> tuple[tuple[Axis, Axis | None], ...]:
        """Give the setup axis and, where it is known, the direction along the machine's X, of each requested setup."""
        axes = self.scene.setup, *self.options.other_setups
        return tuple((axis, None if at is None else at.x) for axis, at in zip(axes, places(self.options), strict=True))

    @property
    def setups(self) -> tuple[Conditions, ...]:
        """Give the conditions for judging cutters in each requested setup, the first one first."""
        return (self.conditions, *(each.conditions for each in self.others))

    def there(self, setup: int) -> "Prepared":
        """The same as the first setup sees it, for a setup counted from 0: its conditions, and what is held there."""
        if setup == 0:
            return self
        other = self.others[setup - 1]
        copies = None if self.copies is None else replace(self.copies, setup=setup)
        return replace(self, conditions=other.conditions, inside=other.inside, held=other.clamped, copies=copies)

    def alone(self, setup: int) -> "Prepared":
        """One setup, counted from 0, as if there were no other one."""
        return replace(self.there(setup), others=())

    def under(self, **changes: Any) -> "Prepared":
        """The same with other values of the conditions, by their names, in every setup."""
        others = tuple(replace(each, conditions=replace(each.conditions, **changes)) for each in self.others)
        return replace(self, conditions=replace(self.conditions, **changes), others=others)

    @property
    def clamped(self) -> NDArray[np.bool_]:
        """Samples (n,) of faces that are held in this setup: no cutter gets there."""
        return np.zeros(len(self.samples), bool) if self.held is None else self.held

    @property
    def shut(self) -> Ints:
        """The body that each sample (n,) lies within, -1 for none; of a clamped face, one more than there are."""
        if self.held is None or not self.held.any():
            return self.inside
        return np.where(self.held & (self.inside < 0), len(self.conditions.surroundings.enclosing), self.inside).astype(np.int32)

    @property
    def machinable(self) -> tuple[NDArray[np.bool_], ...]:
        """Of each setup the finished samples (n,) that are neither clamped nor inside material there."""
        each = [self.there(k) for k in range(1 + len(self.others))]
        return tuple(self.finished & (one.inside < 0) & ~one.clamped for one in each)

    @property
    def somewhere(self) -> NDArray[np.bool_]:
        """Finished samples (n,) that can be machined in one setup or another, as far as fixtures and clamped faces go."""
        return np.asarray(np.logical_or.reduce(self.machinable))

    @property
    def alike(self) -> bool:
        """Whether the part stands among the same obstacles in all setups, held at the same faces."""
        return not self.clamped.any() and not any(
            each.conditions.surroundings is not self.conditions.surroundings or each.clamped.any() for each in self.others
        )

    @property
    def finished(self) -> NDArray[np.bool_]:
        """Judged samples (n,) that a cutter has to reach: shares, selection, reasons and answers are about these."""
        return (self.samples.unjudged < 0) & ~self.not_required

    @property
    def not_required(self) -> NDArray[np.bool_]:
        """Samples (n,) that no cutter has to reach: inside other bodies of the part, exempt, or for drills."""
        free = self.inside_bodies if self.exempt is None else self.inside_bodies | self.exempt
        return free if self.drilled is None else free | self.drilled

    @property
    def for_drills(self) -> NDArray[np.bool_]:
        """Samples (n,) in holes that are for drills."""
        return np.zeros(len(self.samples), bool) if self.drilled is None else self.drilled


def places(options: Options) -> tuple[Placement | None, ...]:
    """How the part stands in each setup, as far as it is known, the first one first."""
    return options.placement, *(options.other_placements or (None,) * len(options.other_setups))


def fixtures_of(options: Options) -> list[Fixture]:
    """The fixtures of all setups."""
    return [*options.fixtures, *(each for place in places(options) if place is not None for each in place.fixtures)]


def refuse_unholdable(scene: Scene, options: Options) -> None:
    """Refuse what is to grip the part in a setup, if no faces are made for it: before the part is tessellated.

    Raises NothingToGripError.
    """
    part = scene.part
    reach = float(np.linalg.norm(part.middle) + np.linalg.norm(part.size))
    for axis, place in zip((scene.setup, *options.other_setups), places(options), strict=True):
        every = (*options.shared_fixtures, *(() if place is None else place.fixtures))
        # Stock is gripped instead.
        for fixture in () if any(each.kind == STOCK for each in every) else every:
            if fixture.to_place:
                refuse_ungripped(fixture, part.faces, scene.orientation.sign, fixture.stands_along(axis), reach)


def conditions_of(scene: Scene, options: Options) -> list[Conditions]:
    """The conditions of each setup, the first one first: with the obstacles of each, and one tolerance that all of them keep.

    Raises FixtureError: a fixture stands in the part, or faces of one of another setup could not be read.
    """
    first, shared = scene.surround(), options.shared_fixtures
    axes = (scene.setup, *options.other_setups)
    own = [() if place is None else place.fixtures for place in places(options)]
    each_setup: list[Surroundings] = [first]
    for axis, mine in zip(axes[1:], own[1:], strict=True):
        each_setup.append(scene.surround_in(axis, shared, mine))
        if doubts := [each for each in each_setup[-1].doubts if each not in first.doubts]:
            # What is missing there would have to be told of each setup by itself.
            raise FixtureError(
                f"setup {axis_words(axis)}: {doubts[0]}; give a fixture that can be read whole, or make this setup the first"
            )
    tolerance = max(each.tolerance(scene.asked) for each in each_setup)
    along = [None if place is None or place.x is None else np.array(place.x) for place in places(options)]
    return [
        Conditions(options.machine, np.array(axis), options.postures, each, tolerance, options.jobs, x, options.accuracy)
        for axis, each, x in zip(axes, each_setup, along, strict=True)
    ]


def with_setups(ready: Prepared, conditions: list[Conditions]) -> Prepared:
    """Add what is held in the first setup, and the other setups with what cannot be machined there."""
    held, others = list[NDArray[np.bool_]](), list[OtherSetup]()
    for place, each in zip(places(ready.options), conditions, strict=True):
        # Faces that the setup clamps, or with which the part rests in a vise or chuck.
        rests_on = [number for one in each.surroundings.fixtures if one.hold is not None for number in one.hold.rests_on]
        faces = sorted({*clamped_faces(ready.scene.part, place, ready.scene.repeated), *rests_on})
        held.append(np.isin(ready.samples.face, faces))
    for each, clamped in zip(conditions[1:], held[1:], strict=True):
        inside = ready.inside
        if each.surroundings is not ready.conditions.surroundings:
            inside = inside_material(
                ready.samples, ready.scene.orientation, each.surroundings.enclosing, each.surroundings.certain, each.tolerance,
                each.jobs, inside,
            )  # fmt: skip
        others.append(OtherSetup(each, inside, clamped))
    return replace(ready, held=held[0], others=tuple(others))


def held_faces(ready: Prepared, setup: int) -> set[int]:
    """Faces on which the part stands in a proposed setup, counted from 0, and those that a vise or chuck holds which was placed
    for it."""
    place = places(ready.options)[setup]
    holds = [each.hold.faces for each in ready.setups[setup].surroundings.fixtures if each.hold is not None]
    return {int(name[1:]) for name in (() if place is None else place.stands_on)}.union(*holds)


def stood_on(ready: Prepared) -> NDArray[np.bool_]:
    """Samples (n,) that what was proposed may hide: of faces that stand on a proposed table, or that a vise or chuck holds which
    was placed for a setup; of all faces where nothing but such vises and chucks stands anywhere."""
    faces, clamped = set[int](), True
    for number, (place, conditions) in enumerate(zip(places(ready.options), ready.setups, strict=True)):
        faces |= held_faces(ready, number)
        proposed = place is not None and place.proposed
        for each in conditions.surroundings.fixtures:
            clamped &= each.hold is not None or (proposed and each.fixture.clamping is not None)
    return np.isin(ready.samples.face, sorted(faces)) | (clamped and bool(faces))


def for_another_setup(ready: Prepared, verdicts: Verdicts) -> Verdicts:
    """The same verdicts with a reason of its own where fixtures alone are in the way, on faces that what was proposed holds."""
    mine = stood_on(ready) & verdicts.not_reached & (verdicts.reason == FIXTURE)
    if not mine.any():
        return verdicts
    return replace(verdicts, reason=np.where(mine, ANOTHER_SETUP, verdicts.reason).astype(np.uint8))
