"""Every free tilt of every sample at every rotation, with certified ends."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from cad_io import Part
from cad_io.arrays import Floats, Record, SurfaceSamples
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.checks import pair
from plan_cutters.domain.degrees import in_radians
from plan_cutters.domain.host_axes import Heading, HostPlane, plane_of
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import Placement, frame_of
from plan_cutters.domain.posture import Range, tilt_direction
from plan_cutters.domain.verdicts import INACCESSIBLE, INTERFERENCE_FREE, REASONS, UNDECIDED, UNJUDGED, Verdicts, blank
from plan_cutters.errors import OptionError
from plan_cutters.kernels.rows import Ranges
from plan_cutters.option_types import ANGLES, PlanOptions
from plan_cutters.options import Options, machine_option
from plan_cutters.scene.conditions import Conditions, Context, contacts_of, require_finite, rotary_of, verdict_arrays_of
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.question import checksum, refuse_others, require_side, setup_of, turns_of, words_of
from plan_cutters.scene.threads import Progress, in_chunks
from plan_cutters.stages.map_budget import chosen
from plan_cutters.stages.map_file import arrays_of, require

#: Ends are certified to this, rad; where that cannot be, the band left is counted as undecided.
NARROWEST = np.radians(0.1)
#: Ends of ranges this close to those of the maps are these, rad.
_END = 1e-9
#: Free intervals that one rotation may have; more count as undecided.
_MOST_INTERVALS = 8


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PostureMaps(Record):
    """Free tilts of n samples at k rotations.

    Attributes
    ----------
    rotations : (k,) float
        rad, from each sample's `direction_max`.
    offset : (n * k + 1,) int64
        Sample i has at rotation j the intervals `free[offset[i * k + j]:offset[i * k + j + 1]]`.
    free : (m, 2) float
        Tilts from, to, rad, ascending; every tilt within is safe for the true surface to the tolerance.
    undecided : (n, k) float32
        Tilts that are neither free nor known to be forbidden, rad in all.
    normal, direction_max : (n, 3) float
        The samples' frames, from which tilts and rotations count.
    verdict, reason : (n,) uint8
        What was found of each sample without limits of a machine, as in `Verdicts`.
    tilt : (float, float)
        Tilts that were looked at, rad.
    tolerance : float
        Gouge tolerance that is kept, mm.
    cutter : str
        Its id.
    part : str
        SHA-256 of the part's file; empty where it was no file.
    inside : (n,) bool, optional
        Samples that lie inside another body of the part: no surface of the finished part. Empty: none.
    about : mapping
        What was asked, as `scene.question.question` writes it; empty where that is not known.

    They hold for any machine, and for any setup that turns no side of an open face: the part's free postures depend on neither.

    Raises
    ------
    OptionError
        An array is of the wrong kind or shape, or holds what cannot be; it names array and row.
    """

    rotations: Floats
    offset: NDArray[np.int64]
    free: Floats
    undecided: NDArray[np.float32]
    normal: Floats
    direction_max: Floats
    verdict: NDArray[np.uint8]
    reason: NDArray[np.uint8]
    tilt: tuple[float, float]
    tolerance: float
    cutter: str
    part: str
    inside: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))
    about: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if isinstance(self.inside, np.ndarray) and not self.inside.size:
            object.__setattr__(self, "inside", np.zeros(np.shape(self.verdict)[:1], bool))
        require(self)
        # Compiled code believes what was checked: nobody is to change it afterwards.
        for each in fields(self):
            column = getattr(self, each.name)
            if isinstance(column, np.ndarray) and column.flags.writeable:
                frozen = column.copy()
                frozen.flags.writeable = False
                object.__setattr__(self, each.name, frozen)

    def within(
        self, machine: Machine | str | os.PathLike[str] | None = None,
        setup: Heading | HostPlane = (0.0, 0.0, 1.0), *, tilt: Range | None = None,
        rotation: Range | None = None, jobs: int = 1, x: Heading | None = None,
        tilt_deg: Range | None = None, rotation_deg: Range | None = None,
    ) -> Verdicts:  # fmt: skip
        """Find the verdicts of the cutter on another machine, or in another setup, without a new search.

        Parameters
        ----------
        machine : Machine or str, optional
            A name or a file will do. No limit by default.
        setup : (float, float, float)
            Direction of the part along the machine's spindle at zero angles: a word, a host's axis, or its plane with an X.
        tilt, rotation : (float, float), optional
            Ranges within those of the maps, rad; rotations from the first to the second.
        tilt_deg, rotation_deg : (float, float), optional
            The same in degrees.
        jobs : int
            Threads.
        x : (float, float, float), optional
            Direction of the part along the machine's X, as `Placement` has it.

        Returns
        -------
        Verdicts
            INACCESSIBLE where the part itself leaves no posture, or the machine holds none of the free ones; UNDECIDED where only
            tilts that the maps leave undecided may serve.

        Raises
        ------
        OptionError
            A range lies beyond that of the maps; the machine has fewer than two rotary axes, so that it needs other rotations;
            or the setup would turn the side of open faces.
        """
        bounds = in_radians({"tilt": tilt, "rotation": rotation, "tilt_deg": tilt_deg, "rotation_deg": rotation_deg}, ANGLES)
        tilt, rotation = bounds["tilt"], bounds["rotation"]
        low, high = self.tilt if tilt is None else pair(tilt, "tilt range")
        if not self.tilt[0] - _END <= low <= high <= self.tilt[1] + _END:
            raise OptionError("the requested tilts lie beyond those of the posture maps")
        turns = np.arange(len(self.rotations))
        if rotation is not None:
            first, last = pair(rotation, "rotation range")
            turns = turns[(self.rotations >= first - _END) & (self.rotations <= last + _END)]
        if not len(turns):
            raise OptionError("the posture maps have none of the requested rotations")
        own: Any = plane_of(setup) or (setup, None)
        z, across = own
        return self._laid(machine_option(machine), Placement(z, across if x is None else x), turns, (low, high), jobs)

    def asked(self, part: str | os.PathLike[str] | Part | None = None, **options: Unpack[PlanOptions]) -> Verdicts:
        """Find the verdicts of a plan with these options, as far as the maps tell.

        Parameters
        ----------
        part : path or Part, optional
            The maps must be of it; not looked at by default.
        **options
            As for `plan`. An option that is not given has the value that the maps were made with.

        Returns
        -------
        Verdicts
            As `within` gives it.

        Raises
        ------
        OptionError
            The maps are of another part, or do not answer an option, which it names.
        """
        words = in_radians(options, ANGLES)
        requested, stated = Options.of(words), set(words)
        if part is not None and (not self.part or checksum(part) != self.part):
            name = getattr(part, "file", None) if isinstance(part, Part) else os.fspath(part)
            raise OptionError(f"these maps are of another part than {Path(name or 'this one').name}: plan again")
        refuse_others(self.about, requested, stated, self.cutter)
        low, high = requested.tilt if "tilt" in stated else self.tilt
        if not self.tilt[0] - _END <= low <= high <= self.tilt[1] + _END:
            ends = ":".join(f"{np.degrees(end):.6g}" for end in self.tilt)
            raise OptionError(f"these maps are of tilts {ends} deg, not {np.degrees(low):.6g}:{np.degrees(high):.6g}: plan again")
        turns = turns_of(self.about, self.rotations, requested, stated)
        place = requested.placement or Placement(requested.setup)
        if not {"setup", "placement"} & stated:
            place = setup_of(self.about)
        return self._laid(requested.machine, place, turns, (max(low, self.tilt[0]), min(high, self.tilt[1])), requested.jobs)

    @property
    def missing(self) -> tuple[str, ...]:
        """Obstacles that are missing or only guessed: while there are some, what is reached is so but for them."""
        return words_of(self.about, "missing")

    @property
    def unmapped(self) -> int:
        """Judged samples that were left out: they are undecided at every tilt."""
        unmapped = self.about.get("unmapped", 0)
        return unmapped if type(unmapped) is int else 0

    @property
    def finished(self) -> NDArray[np.bool_]:
        """Judged samples (n,) of the finished part's surface."""
        return np.asarray((self.verdict != UNJUDGED) & ~self.inside)

    @property
    def _lies_flat(self) -> bool:
        """Whether the cutter has a flat tip that may lie on a contact, turned as it likes."""
        first, last = self.about.get("rotation", (0.0, 2.0 * np.pi))
        return bool(self.about.get("flat", True)) and last - first > 2.0 * np.pi - _END

    def _laid(
        self, machine: Machine, place: Placement, turns: NDArray[np.int64], tilt: tuple[float, float], jobs: int
    ) -> Verdicts:
        """Find the verdicts with a machine at some of the rotations, by their numbers, and tilts."""
        from plan_cutters.kernels.limits import any_axis
        from plan_cutters.kernels.maps.mask import mask

        if machine.turns and machine.turning < 2:
            raise OptionError(
                f"posture maps say nothing of {machine.name}: with fewer than two rotary axes each sample needs "
                "rotations of its own; plan the part with it"
            )
        require_side(self.about, place.z)
        axis, (low, high) = np.array(place.z), tilt
        frame = frame_of(axis, None if place.x is None else np.array(place.x))
        rotary = rotary_of(machine.kinematics(frame))
        ranges = Ranges(np.cos(self.rotations), np.sin(self.rotations), low, high, axis, machine.limit_cos, rotary)
        verdicts = blank(len(self.verdict))
        result = verdict_arrays_of(verdicts)
        judged = self.verdict != UNJUDGED
        not_reached = judged & (self.verdict == INACCESSIBLE)
        verdicts.verdict[not_reached], verdicts.reason[not_reached] = INACCESSIBLE, self.reason[not_reached]
        rows = np.flatnonzero(judged & ~not_reached)
        maps = self.normal, self.direction_max, ranges, turns, self.offset, self.free, self.undecided
        in_chunks(lambda piece: mask(piece, *maps, result), rows, jobs)
        upright = self.verdict == INTERFERENCE_FREE
        if low <= _END and upright.any():
            upright[upright] = machine.allows(self.normal[upright], frame)
            verdicts.stand_upright(upright, self.normal, self.direction_max)
        axis_limited = judged & ~not_reached & np.isin(verdicts.verdict, (INACCESSIBLE, UNDECIDED))
        verdicts.reason[axis_limited] = REASONS.index("axis_limit")
        if self._lies_flat and low <= _END and len(turns) == len(self.rotations):
            # Maps are of the edge of the tip: a plan also asks whether the flat can lie on the contact.
            flat = axis_limited & (verdicts.verdict == INACCESSIBLE)
            flat[flat] = machine.allows(self.normal[flat], frame)
            verdicts.verdict[flat] = UNDECIDED
        # What is in doubt without a machine is so with any that holds some posture there.
        doubt, held = axis_limited & (self.verdict == UNDECIDED), np.zeros(len(self.verdict), bool)
        few = ranges._replace(rotation_cos=ranges.rotation_cos[turns], rotation_sin=ranges.rotation_sin[turns])
        any_axis(np.flatnonzero(doubt), self.normal, self.direction_max, few, low, high, held)
        doubt &= held
        verdicts.verdict[doubt], verdicts.reason[doubt] = UNDECIDED, self.reason[doubt]
        return verdicts.freeze()

    def held(self, conditions: Conditions) -> "PostureMaps":
        """The maps of one machine and setup: of the free tilts those that it holds. The verdicts stay what they are."""
        from plan_cutters.kernels.maps.mask import held_free

        machine = conditions.machine
        if not machine.limited:
            return self
        rotary = conditions.ranges.rotary
        ranges = Ranges(np.cos(self.rotations), np.sin(self.rotations), *self.tilt, conditions.setup, machine.limit_cos, rotary)
        rows, place = np.arange(len(self.normal)), np.zeros(len(self.offset) - 1, np.int64)
        maps = self.normal, self.direction_max, ranges, self.offset, self.free, place
        in_chunks(lambda piece: held_free(piece, *maps, np.zeros((0, 2))), rows, conditions.jobs)
        offset = np.concatenate([[0], np.cumsum(place)])
        tilts = np.empty((offset[-1], 2))
        place[:] = offset[:-1]
        in_chunks(lambda piece: held_free(piece, *maps, tilts), rows if len(tilts) else rows[:0], conditions.jobs)
        return replace(self, offset=offset, free=tilts)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> "PostureMaps":
        """Read `postures.npz`.

        Raises
        ------
        OptionError
            The file is none, is damaged or was made by an earlier version; it names array and row.
        """
        try:
            return cls(**arrays_of(path))
        except OptionError as error:
            if error.file:
                raise
            cause = error.cause.removeprefix("these are no posture maps: ")
            raise OptionError(f"holds no posture maps, or is damaged ({cause}): write it again", file=Path(path).name) from None


def posture_maps(
    samples: SurfaceSamples, context: Context, verdicts: Verdicts, *, part: str = "",
    inside: NDArray[np.bool_] | None = None, shut: NDArray[np.bool_] | None = None, about: Mapping[str, Any] | None = None,
    most: int | None = None, progress: Progress | None = None,
) -> PostureMaps:  # fmt: skip
    """Find the free tilts of judged samples, whatever the machine; the others have none.

    Of samples that are more than the work is worth, as many as that allows, evenly spread: of the others, every tilt is undecided
    and `about["unmapped"]` says how many there are. The same samples get the same maps whatever the machine's speed.

    Parameters
    ----------
    samples : SurfaceSamples
    context : Context
        The machine is not looked at.
    verdicts : Verdicts
        What the cutter reaches without a machine.
    part : str
        SHA-256 of the part's file.
    inside : (n,) bool, optional
        Samples that lie inside another body of the part.
    shut : (n,) bool, optional
        Samples that no cutter gets to, for they are held or lie within a fixture: no tilt is free there, nor in doubt.
    about : mapping, optional
        What was asked, as `scene.question.question` writes it.
    most : int, optional
        Samples to map, at most. None: as many as take `map_budget.WORK`.
    progress : callable, optional
        Called with the number of pieces of work that are done, and the number of all.
    """
    from plan_cutters.kernels.maps.free_map import free_map

    conditions, outer_tool, tool = context.conditions.without_machine(), context.outer_tool, context.outer
    rotations, ranges = conditions.postures.rotations, conditions.ranges
    possible, certain = conditions.obstacles, conditions.surroundings.certain
    contacts = contacts_of(samples)
    n, k = len(samples), len(rotations)
    count = np.zeros((n, k), np.int32)
    undecided = np.zeros((n, k), np.float32)
    free: dict[int, Floats] = {}

    def mapped(rows: NDArray[np.int64], obstacles: Obstacles) -> tuple[Floats, NDArray[np.int32], Floats, int]:
        part = np.empty((len(rows), k, _MOST_INTERVALS, 2))
        mine, unsure = np.empty((len(rows), k), np.int32), np.empty((len(rows), k))
        tree, wide = obstacles.tree, obstacles.wide_tree
        looked = free_map(rows, contacts, ranges, tool, NARROWEST, tree, wide, _MOST_INTERVALS, part, mine, unsure)
        if obstacles.solids.cell.size:
            _leave_bodies(samples, rows, outer_tool, rotations, obstacles, part, mine, certain=obstacles is not possible)
        return part, mine, unsure, looked

    def work(rows: NDArray[np.int64]) -> int:
        # Room for the most intervals only while a piece is worked on: memory grows with what is found.
        part, mine, unsure, looked = mapped(rows, possible)
        if certain is not possible:
            # What is only perhaps in the way forbids nothing for sure.
            perhaps, few, more, again = mapped(rows, certain)
            looked += again
            unsure = np.maximum(unsure, _width(perhaps, few) + more - _width(part, mine))
        count[rows], undecided[rows] = mine, unsure
        free[int(rows[0])] = part[np.arange(_MOST_INTERVALS) < mine[..., None]]
        return int(looked)

    judged = np.flatnonzero(samples.unjudged < 0 if shut is None else (samples.unjudged < 0) & ~shut)
    require_finite(contacts, judged)
    rows = chosen(judged, most, lambda piece: mapped(piece, possible)[3], conditions.jobs)
    in_chunks(work, rows, conditions.jobs, progress)
    remaining = np.setdiff1d(judged, rows)
    undecided[remaining] = conditions.postures.tilt[1] - conditions.postures.tilt[0]
    known = {**(about or {}), "flat": outer_tool.flat > 0.0, **({"unmapped": len(remaining)} if len(remaining) else {})}
    pieces = [free[first] for first in sorted(free)]
    offset = np.concatenate([[0], np.cumsum(count.ravel(), dtype=np.int64)])
    return PostureMaps(rotations, offset, np.concatenate([np.zeros((0, 2)), *pieces]), undecided, samples.normal,
                       samples.direction_max, verdicts.verdict, verdicts.reason, conditions.postures.tilt, conditions.tolerance,
                       context.cutter.id, part, np.zeros(0, bool) if inside is None else inside, known)  # fmt: skip


def _width(part: Floats, count: NDArray[np.int32]) -> Floats:
    """Width (m, k) of intervals (m, k, room, 2), of each cell so many, rad."""
    # What lies beyond the count was never written.
    there = np.arange(_MOST_INTERVALS) < count[..., None]
    return np.asarray(np.subtract(part[..., 1], part[..., 0], out=np.zeros(there.shape), where=there).sum(axis=-1))


def _leave_bodies(
    samples: SurfaceSamples, rows: NDArray[np.int64], outer_tool: Assembly, rotations: Floats, obstacles: Obstacles, part: Floats,
    count: NDArray[np.int32], *, certain: bool,
) -> None:  # fmt: skip
    """Take out intervals (m, k, room, 2) in which the cutter lies within a body, or may; or only where it surely does.

    Between the ends of an interval the cutter touches no skin, so it lies within a body all along or nowhere.
    """
    at = np.argwhere(np.arange(_MOST_INTERVALS) < count[..., None])
    row, turn = rows[at[:, 0]], rotations[at[:, 1]]
    tilt = part[at[:, 0], at[:, 1], at[:, 2]].mean(axis=1)
    normal = samples.normal[row]
    tilt_directions = tilt_direction(normal, samples.direction_max[row], turn)
    inside = obstacles.holds(outer_tool, samples.point[row], normal, tilt_directions, tilt, certain=certain)
    for i, j in np.unique(at[inside, :2], axis=0).tolist():
        mine = (at[:, 0] == i) & (at[:, 1] == j)
        outside = part[i, j, : count[i, j]][~inside[mine]]
        part[i, j, : len(outside)], count[i, j] = outside, len(outside)
