"""Every stage judges a cutter under these conditions; several of them use the search for a posture that is here, too."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, SurfaceSamples
from plan_cutters.domain.assembly import Assembly, assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.verdicts import VerdictBuffer, blank
from plan_cutters.kernels.rows import Contacts, Ranges, Rotary, Tool, VerdictArrays
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.scene.threads import Progress, in_chunks
from plan_cutters.scene.work import Work


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Conditions(Record):
    """The same for all cutters of a plan.

    Attributes
    ----------
    machine : Machine
    setup : (3,) float
        Unit setup axis.
    postures : PostureRange
    around : Surroundings
        What is, and what may be, in the way.
    tolerance : float
        Gouge tolerance that is kept, mm.
    jobs : int
        Threads.
    x : (3,) float, optional
        Unit direction of the part along the machine's X, as `Placement` has it.
    """

    machine: Machine
    setup: Floats
    postures: PostureRange
    surroundings: Surroundings
    tolerance: float
    jobs: int
    x: Floats | None = None

    @property
    def obstacles(self) -> Obstacles:
        """Everything that may be in the way."""
        return self.surroundings.possible

    def judges(self, cutter: Cutter) -> bool:
        """Whether the tolerance that is kept is fine enough to say anything about a cutter."""
        return cutter.large_enough(self.tolerance)

    def outer_tool(self, cutter: Cutter) -> Assembly:
        """Make the outer tool of a cutter: a triangle that does not reach into it lets the surface come no deeper than
        allowed.
        """
        return tools(cutter, self.tolerance, self.obstacles.triangles.chord_error)[0]

    def inner_tool(self, cutter: Cutter) -> Assembly:
        """Make the inner tool of a cutter: a triangle that reaches into it proves that a point of the surface is too deep in
        the cutter.
        """
        return tools(cutter, self.tolerance, self.obstacles.triangles.chord_error)[1]

    @property
    def ranges(self) -> Ranges:
        """Give the postures and the limits of the machine, in the form that kernels take."""
        return ranges_of(self.machine, self.setup, self.postures, self.x)

    @property
    def machineless(self) -> "Conditions":
        """The same without limits of any machine."""
        return replace(self, machine=Machine())

    @property
    def kinematics(self) -> Kinematics | None:
        """The machine's rotary axes in the part's frame; None where any tool axis within its plain limit is possible."""
        return self.machine.kinematics(frame_of(self.setup, self.x))

    def upright(self, normal: Floats) -> NDArray[np.bool_]:
        """At which normals (n, 3) the machine can hold the axis along the normal, and tilt 0 was requested."""
        return self.machine.allows(normal, frame_of(self.setup, self.x)) & self.postures.upright


def ranges_of(machine: Machine, setup: Floats, postures: PostureRange, x: Floats | None = None) -> Ranges:
    """Put the postures and the limits of a machine into the form that kernels take."""
    rotations, (low, high) = postures.rotations, postures.tilt
    rotary = rotary_of(machine.kinematics(frame_of(setup, x)))
    if len(rotary.aim):
        # Each sample leans towards the axes that there are: rotations asked for would miss them.
        rotations = np.zeros(len(rotary.aim))
    return Ranges(
        np.cos(rotations), np.sin(rotations), max(0.0, low), min(np.pi, high), setup, machine.limit_cos, rotary
    )


def rotations_of(normal: Floats, direction_max: Floats, tilt_direction: Floats) -> Floats:
    """Rotations (n,) of tilt directions (n, 3), rad from 0 to 2 pi."""
    across = (tilt_direction * np.cross(normal, direction_max)).sum(axis=-1)
    return np.asarray(np.remainder(np.arctan2(across, (tilt_direction * direction_max).sum(axis=-1)), 2.0 * np.pi))


def rotary_of(kinematics: Kinematics | None) -> Rotary:
    """Rotary axes as kernels take them."""
    if kinematics is None:
        return Rotary(np.zeros((0, 4)), np.zeros((0, 3)), np.zeros((0, 2)), np.zeros(3), np.zeros(3), np.zeros((0, 3)))
    kinematics, _ = kinematics.turning()
    swing = kinematics.swing if len(kinematics.direction) == 2 else (0.0, 1.0, 0.0)
    circle, direction, limit, tool, aim = map(
        np.ascontiguousarray,
        (kinematics.circles(), kinematics.direction, kinematics.limit, kinematics.tool, kinematics.aims()),
    )
    return Rotary(circle, direction, limit, tool, np.array(swing), aim)


def contacts_of(samples: SurfaceSamples) -> Contacts:
    """Samples as kernels take them."""
    return Contacts(samples.point, samples.normal, samples.direction_max, samples.curvature)


@lru_cache(maxsize=64)
def tools(cutter: Cutter, tolerance: float, error: float) -> tuple[Assembly, Assembly]:
    """Make the outer and the inner tool of a cutter, for obstacles with a chord error, mm.

    Every point of the surface has a point of the triangles within that error, and the reverse. The outer tool has flutes that are
    smaller by the tolerance less the error, and all else is larger by the error. The inner tool has flutes that are smaller by
    the tolerance and the error, and all else is smaller by the error.
    """
    return assembly(cutter, tolerance - error, -error), assembly(cutter, tolerance + error, error, kind="inner")


def tool_of(made: Assembly) -> Tool:
    """An assembly as kernels take it."""
    return Tool(made.piece, made.mode, made.reach, made.inner, made.end)


def verdict_arrays_of(verdicts: VerdictBuffer) -> VerdictArrays:
    """Where kernels write what they find."""
    return VerdictArrays(
        verdicts.verdict, verdicts.axis, verdicts.tilt_direction, verdicts.tilt, verdicts.rotation, verdicts.reason
    )


def require_finite(contacts: Contacts, rows: NDArray[np.int64]) -> None:
    """Refuse contacts that are no points with a normal, a direction and curvatures: kernels say nothing of them.

    Raises
    ------
    ValueError
    """
    if not all(np.isfinite(column[rows]).all() for column in contacts):
        raise ValueError("contacts to search a posture for must be finite")


def search_postures(
    contacts: Contacts, rows: NDArray[np.int64], outer_tool: Assembly, inner_tool: Assembly, conditions: Conditions,
    verdicts: VerdictBuffer, progress: Progress | None = None, *, fixed: bool = False, strict: bool = False,
    work: Work | None = None,
) -> None:  # fmt: skip
    """Search a posture for contacts, neighbours in sequence, and write what is found into `verdicts`.

    Parameters
    ----------
    contacts : Contacts
    rows : (m,) int64
        Contacts to decide.
    outer_tool, inner_tool : Assembly
        As `Conditions.outer_tool` and `Conditions.inner_tool` make them of a cutter.
    conditions : Conditions
    verdicts : VerdictBuffer
    fixed : bool
        As for `in_chunks`: each contact starts from what was found at the one before it in its piece.
    strict : bool
        Only postures that curvature at the contact allows, as if there were no tolerance.
    progress : callable, optional
        Called with the number of pieces of work that are done, and the number of all.
    work : Work, optional
        Where what is looked at is counted.

    Raises
    ------
    ValueError
        A contact is not a point with a normal and a curvature: nothing can be said of it.
    """
    from plan_cutters.kernels.search.search import search

    require_finite(contacts, rows)
    ranges, surroundings = conditions.ranges._replace(strict=strict), conditions.surroundings
    possible, certain = surroundings.possible.solids, surroundings.certain.solids
    tools, buffer = (tool_of(outer_tool), tool_of(inner_tool)), verdict_arrays_of(verdicts)

    def searched(piece: NDArray[np.int64]) -> int:
        return int(search(piece, contacts, ranges, *tools, possible, certain, buffer))

    looked = in_chunks(searched, rows, conditions.jobs, progress, fixed=fixed)
    if work is not None:
        work.add(looked)


def warm(contacts: Contacts, cutter: Cutter, conditions: Conditions) -> None:
    """Load or compile every kernel, so that stage times are those of the work."""
    from plan_cutters.kernels.search import search

    none, verdicts = np.zeros(0, np.int64), verdict_arrays_of(blank(0))
    outer_tool, inner_tool = conditions.outer_tool(cutter), conditions.inner_tool(cutter)
    search.dummy_clear(
        none, contacts, outer_tool.dummy, tool_of(outer_tool), conditions.obstacles.solids, np.zeros(0, bool)
    )
    search.search(none, contacts, conditions.ranges, tool_of(outer_tool), tool_of(inner_tool), conditions.obstacles.solids,
                  conditions.surroundings.certain.solids, verdicts)  # fmt: skip
