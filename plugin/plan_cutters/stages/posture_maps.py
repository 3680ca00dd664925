"""Every free tilt of every sample at every rotation, with certified ends."""

import json
import os
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, SurfaceSamples
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.placement import Placement, frame_of
from plan_cutters.domain.posture import lean
from plan_cutters.domain.verdicts import INACCESSIBLE, INTERFERENCE_FREE, REASONS, UNDECIDED, UNJUDGED, Reach, blank
from plan_cutters.errors import OptionError
from plan_cutters.kernels.rows import Ranges
from plan_cutters.options import machine_given
from plan_cutters.scene.conditions import (
    Conditions,
    contacts_of,
    found_of,
    require_finite,
    rotary_of,
    tool_of,
)
from plan_cutters.scene.threads import Progress, in_chunks

#: Ends are certified to this, rad; where that cannot be, the band left is counted as undecided.
NARROWEST = np.radians(0.1)
#: Ends of ranges this close to those of the maps are these, rad.
_END = 1e-9
#: Free intervals that one rotation may have; more count as undecided.
_ROOM = 8


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
        What was found of each sample without limits of a machine, as in `Reach`.
    tilt : (float, float)
        Tilts that were looked at, rad.
    tolerance : float
        Gouge tolerance that is kept, mm.
    cutter : str
        Its id.
    part : str
        SHA-256 of the part's file; empty where it was no file.

    They hold for any machine and setup: the part's free postures depend on neither.
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

    def within(
        self, machine: Any = None, setup: Any = (0.0, 0.0, 1.0), *, tilt: tuple[float, float] | None = None,
        rotation: tuple[float, float] | None = None, jobs: int = 1, x: Any = None,
    ) -> Reach:  # fmt: skip
        """What the cutter reaches on another machine, or in another setup, without a new search.

        Parameters
        ----------
        machine : Machine or str, optional
            A name or a file will do. No limit by default.
        setup : (float, float, float)
            Direction of the part along the machine's spindle at zero angles.
        tilt, rotation : (float, float), optional
            Ranges within those of the maps, rad; rotations from the first to the second.
        jobs : int
            Threads.
        x : (float, float, float), optional
            Direction of the part along the machine's X, as `Placement` has it.

        Returns
        -------
        Reach
            INACCESSIBLE where the part itself leaves no posture, or the machine holds none of the free ones; UNDECIDED where only
            tilts that the maps leave undecided may serve.

        Raises
        ------
        OptionError
            A range lies beyond that of the maps, or the machine has fewer than two rotary axes: it needs other rotations.
        """
        from plan_cutters.kernels.mask import mask

        machine, place = machine_given(machine), Placement(setup, x)
        axis = np.array(place.z)
        frame = frame_of(axis, None if place.x is None else np.array(place.x))
        if machine.turns and len(machine.rotary) < 2:
            raise OptionError(f"posture maps say nothing of {machine.name}: with fewer than two rotary axes each sample needs "
                              "rotations of its own; plan the part with it")  # fmt: skip
        low, high = self.tilt if tilt is None else tilt
        if not self.tilt[0] - _END <= low <= high <= self.tilt[1] + _END:
            raise OptionError("the tilts asked for lie beyond those of the posture maps")
        turns = np.arange(len(self.rotations))
        if rotation is not None:
            first, last = rotation
            turns = turns[(self.rotations >= first - _END) & (self.rotations <= last + _END)]
        if not len(turns):
            raise OptionError("the posture maps have none of the rotations asked for")
        rotary = rotary_of(machine.kinematics(frame))
        ranges = Ranges(np.cos(self.rotations), np.sin(self.rotations), low, high, axis, machine.limit_cos, rotary)
        reach = blank(len(self.verdict))
        found = found_of(reach)
        judged = self.verdict != UNJUDGED
        lost = judged & (self.verdict == INACCESSIBLE)
        reach.verdict[lost], reach.reason[lost] = INACCESSIBLE, self.reason[lost]
        rows = np.flatnonzero(judged & ~lost)
        maps = self.normal, self.direction_max, ranges, turns, self.offset, self.free, self.undecided
        in_chunks(lambda piece: mask(piece, *maps, found), rows, jobs)
        upright = self.verdict == INTERFERENCE_FREE
        if low <= _END and upright.any():
            upright[upright] = machine.allows(self.normal[upright], frame)
            reach.verdict[upright] = INTERFERENCE_FREE
            reach.axis[upright], reach.lean[upright] = self.normal[upright], self.direction_max[upright]
            reach.tilt[upright], reach.rotation[upright] = 0.0, 0
        axis_lost = judged & ~lost & np.isin(reach.verdict, (INACCESSIBLE, UNDECIDED))
        reach.reason[axis_lost] = REASONS.index("axis_limit")
        return reach

    def held(self, conditions: Conditions) -> "PostureMaps":
        """The maps of one machine and setup: of the free tilts those that it holds. The verdicts stay what they are."""
        from plan_cutters.kernels.mask import held_free

        machine = conditions.machine
        if not machine.limited:
            return self
        rotary = rotary_of(conditions.kinematics)
        ranges = Ranges(
            np.cos(self.rotations), np.sin(self.rotations), *self.tilt, conditions.setup, machine.limit_cos, rotary
        )
        rows, place = np.arange(len(self.normal)), np.zeros(len(self.offset) - 1, np.int64)
        maps = self.normal, self.direction_max, ranges, self.offset, self.free, place
        in_chunks(lambda piece: held_free(piece, *maps, np.zeros((0, 2))), rows, conditions.jobs)
        offset = np.concatenate([[0], np.cumsum(place)])
        kept = np.empty((offset[-1], 2))
        place[:] = offset[:-1]
        in_chunks(lambda piece: held_free(piece, *maps, kept), rows if len(kept) else rows[:0], conditions.jobs)
        return replace(self, offset=offset, free=kept)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> "PostureMaps":
        """Read `postures.npz`.

        Raises
        ------
        OptionError
            The file is none, or is damaged.
        """
        name = Path(path).name
        try:
            with np.load(path, allow_pickle=False) as arrays:
                about = json.loads(str(arrays["about"].reshape(-1)[0]))
                cutter = about["cutter"]
                own = {
                    word: arrays[f"{word}_{cutter}"] for word in ("offset", "free", "undecided", "verdict", "reason")
                }
                low, high = (float(end) for end in about["tilt"])
                return cls(arrays["rotation"], own["offset"], own["free"], own["undecided"], arrays["normal"],
                           arrays["direction_max"], own["verdict"], own["reason"], (low, high), float(about["tolerance"]),
                           str(cutter), str(about["part"]))  # fmt: skip
        except OSError as error:
            raise OptionError(f"cannot be read: {error.strerror or 'no archive of arrays'}", file=name) from None
        except (ValueError, LookupError, TypeError, zipfile.BadZipFile, EOFError):
            raise OptionError(
                "holds no posture maps, or is damaged: write it again with --posture-maps", file=name
            ) from None


def posture_maps(
    samples: SurfaceSamples, cutter: Cutter, conditions: Conditions, reach: Reach, *, part: str = "",
    progress: Progress | None = None,
) -> PostureMaps:  # fmt: skip
    """Find the free tilts of all judged samples, whatever the machine; the others have none.

    Parameters
    ----------
    samples : SurfaceSamples
    cutter, conditions
        The machine is not looked at.
    reach : Reach
        What the cutter reaches without a machine.
    part : str
        SHA-256 of the part's file.
    progress : callable, optional
        Told how many pieces of the work are done, of how many.
    """
    from plan_cutters.kernels.free_map import free_map

    conditions = conditions.machineless
    rotations, ranges, obstacles = conditions.postures.rotations, conditions.ranges, conditions.obstacles
    tree, wide, light = obstacles.tree, obstacles.wide_tree, conditions.light(cutter)
    tool = tool_of(light)
    contacts = contacts_of(samples)
    n, k = len(samples), len(rotations)
    count = np.zeros((n, k), np.int32)
    undecided = np.zeros((n, k), np.float32)
    free: dict[int, Floats] = {}

    def work(rows: NDArray[np.int64]) -> None:
        # Room for the most intervals only while a piece is worked on: memory grows with what is found.
        part = np.empty((len(rows), k, _ROOM, 2))
        mine, unsure = np.empty((len(rows), k), np.int32), np.empty((len(rows), k))
        free_map(rows, contacts, ranges, tool, NARROWEST, tree, wide, _ROOM, part, mine, unsure)
        count[rows], undecided[rows] = mine, unsure
        if conditions.obstacles.solids.cell.size:
            _leave_bodies(samples, rows, light, conditions, part, mine)
            count[rows] = mine
        free[int(rows[0])] = part[np.arange(_ROOM) < mine[..., None]]

    judged = np.flatnonzero(samples.unjudged < 0)
    require_finite(contacts, judged)
    in_chunks(work, judged, conditions.jobs, progress)
    pieces = [free[first] for first in sorted(free)]
    offset = np.concatenate([[0], np.cumsum(count.ravel(), dtype=np.int64)])
    return PostureMaps(rotations, offset, np.concatenate([np.zeros((0, 2)), *pieces]), undecided, samples.normal,
                       samples.direction_max, reach.verdict, reach.reason, conditions.postures.tilt, conditions.tolerance,
                       cutter.id, part)  # fmt: skip


def _leave_bodies(
    samples: SurfaceSamples, rows: NDArray[np.int64], light: Assembly, conditions: Conditions, part: Floats,
    count: NDArray[np.int32],
) -> None:  # fmt: skip
    """Take out intervals (m, k, room, 2) in which the cutter lies within a body.

    Between the ends of an interval the cutter touches no skin, so it lies within a body all along or nowhere.
    """
    rotations = conditions.postures.rotations
    at = np.argwhere(np.arange(_ROOM) < count[..., None])
    row, turn = rows[at[:, 0]], rotations[at[:, 1]]
    tilt = part[at[:, 0], at[:, 1], at[:, 2]].mean(axis=1)
    inside = conditions.obstacles.holds(
        light,
        samples.point[row],
        samples.normal[row],
        lean(samples.normal[row], samples.direction_max[row], turn),
        tilt,
    )
    for i, j in np.unique(at[inside, :2], axis=0).tolist():
        mine = (at[:, 0] == i) & (at[:, 1] == j)
        kept = part[i, j, : count[i, j]][~inside[mine]]
        part[i, j, : len(kept)], count[i, j] = kept, len(kept)
