"""Conditions of a setup, the context in which they judge one cutter, and the search for a posture that stages share."""

from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record, SurfaceSamples, cross
from plan_cutters.domain.assembly import Assembly, assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.shapes import depth_along_normal
from plan_cutters.domain.verdicts import VerdictBuffer, Verdicts, blank, depths
from plan_cutters.kernels.codes import BALL, BEYOND, TILT_TO
from plan_cutters.kernels.rows import Contacts, Ranges, Rotary, Tool, VerdictArrays
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.scene.work import Progress, Work, in_chunks

#: Where material over a contact proves that it is blocked: shares of the length that the tool holds of the normal, and no nearer
#: than so many blocked depths, for there is the contact's own surface.
_PROVED_AT, _CLEAR = np.array([1.0, 0.3, 0.1, 0.03]), 4.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Conditions(Record):
    """The same for all cutters of a plan, in one setup."""

    machine: Machine
    setup: Floats  #: (3,) float: unit setup axis.
    postures: PostureRange
    surroundings: Surroundings  #: What is, and what may be, in the way.
    tolerance: float  #: Gouge tolerance that is kept, mm.
    jobs: int  #: Threads.
    x: Floats | None = None  #: (3,) float: unit direction of the part along the machine's X, as `Placement` has it.
    #: Of the machine's rotary axes, rad: what is off by no more is upright, or along a wall (`scene.fixed_axis`).
    accuracy: float = 0.0
    #: Everything that may be in the way. It follows from the fields above, as the next three do.
    obstacles: Obstacles = field(init=False, compare=False)
    #: (3, 3) float: the machine's X, Y and Z in part coordinates, as rows, at zero angles.
    frame: Floats = field(init=False, compare=False)
    #: The machine's rotary axes in the part's frame; None where any tool axis within its plain limit is possible.
    kinematics: Kinematics | None = field(init=False, compare=False)
    #: The postures and the limits of the machine, in the form that kernels take.
    ranges: Ranges = field(init=False, compare=False)

    def __post_init__(self) -> None:
        frame = frame_of(self.setup, self.x)
        kinematics = self.machine.kinematics(frame)
        object.__setattr__(self, "obstacles", self.surroundings.possible)
        object.__setattr__(self, "frame", frame)
        object.__setattr__(self, "kinematics", kinematics)
        object.__setattr__(self, "ranges", ranges_of(self.machine, self.setup, self.postures, kinematics))

    def judges(self, cutter: Cutter) -> bool:
        """Whether the tolerance that is kept is fine enough to say anything about a cutter."""
        return cutter.large_enough(self.tolerance)

    def without_machine(self) -> "Conditions":
        """The same without limits of any machine."""
        return replace(self, machine=Machine())

    def allows(self, axis: Floats) -> NDArray[np.bool_]:
        """Which tool axes (n, 3) the machine can hold."""
        return self.machine.holds(axis, self.frame, self.kinematics)

    def upright(self, normal: Floats) -> NDArray[np.bool_]:
        """At which normals (n, 3) the machine can hold the axis along the normal, and tilt 0 was requested."""
        return self.allows(normal) & self.postures.upright


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Context(Record):
    """One cutter under the conditions of one setup: what every judgement of it needs, made once and handed on."""

    cutter: Cutter
    conditions: Conditions
    outer_tool: Assembly  #: A triangle that does not reach into it lets the surface come no deeper than allowed.
    inner_tool: Assembly  #: A triangle that reaches into it proves that a point of the surface is too deep in the cutter.
    #: `outer`, `inner`: the same two in the form that kernels take.
    outer: Tool = field(init=False, compare=False)
    inner: Tool = field(init=False, compare=False)
    #: (k, COLUMNS) float: of the outer tool the pieces that hold it at tilt 0 in every rotation, as `Assembly.dummy`.
    dummy: Floats = field(init=False, compare=False)
    #: (k,) float: distances along the normal, mm, at which material proves that every posture is blocked, those that are tried.
    proved_at: Floats = field(init=False, compare=False)
    #: Whether the tolerance that is kept is fine enough to say anything about the cutter.
    judges: bool = field(init=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "outer", tool_of(self.outer_tool))
        object.__setattr__(self, "inner", tool_of(self.inner_tool))
        object.__setattr__(self, "dummy", self.outer_tool.dummy)
        object.__setattr__(self, "proved_at", self._proved_at())
        object.__setattr__(self, "judges", self.conditions.judges(self.cutter))

    @classmethod
    def of(cls, cutter: Cutter, conditions: Conditions) -> "Context":
        """Make both tools of a cutter, for the tolerance that is kept and the chord error of the obstacles."""
        return cls(cutter, conditions, *tools(cutter, conditions.tolerance, conditions.obstacles.triangles.chord_error))

    def _proved_at(self) -> Floats:
        """Distances that lemma F3 of `docs/proofs.md` allows, farther than what is clear of the contact's own surface."""
        deep = self.conditions.obstacles.depths(self.conditions.tolerance)[1]
        distance = _PROVED_AT * depth_along_normal(self.cutter)
        return np.ascontiguousarray(distance[distance > _CLEAR * deep])


def ranges_of(machine: Machine, setup: Floats, postures: PostureRange, kinematics: Kinematics | None) -> Ranges:
    """Put the postures and the limits of a machine, with its rotary axes in the part's frame, into the form that kernels take."""
    rotations, (low, high) = postures.rotations, postures.tilt
    rotary = rotary_of(kinematics)
    if len(rotary.aim):
        # Each sample leans towards the axes that there are: rotations asked for would miss them.
        rotations = np.zeros(len(rotary.aim))
    return Ranges(np.cos(rotations), np.sin(rotations), max(0.0, low), min(np.pi, high), setup, machine.limit_cos, rotary)


def rotations_of(normal: Floats, direction_max: Floats, tilt_direction: Floats) -> Floats:
    """Rotations (n,) of tilt directions (n, 3), rad from 0 to 2 pi."""
    across = (tilt_direction * cross(normal, direction_max)).sum(axis=-1)
    return np.asarray(np.remainder(np.arctan2(across, (tilt_direction * direction_max).sum(axis=-1)), 2.0 * np.pi))


def tilt_directions(axis: Floats, normal: Floats, otherwise: Floats) -> Floats:
    """Unit directions (n, 3) in which axes (n, 3) lean from normals; `otherwise` where they do not."""
    f = axis - (axis * normal).sum(axis=1)[:, None] * normal
    length = np.linalg.norm(f, axis=1)[:, None]
    return np.asarray(np.where(length > 1e-12, f / np.maximum(length, 1e-300), otherwise))


def rotary_of(kinematics: Kinematics | None) -> Rotary:
    """Rotary axes as kernels take them."""
    if kinematics is None:
        return Rotary(np.zeros((0, 4)), np.zeros((0, 3)), np.zeros((0, 2)), np.zeros(3), np.zeros(3), np.zeros((0, 3)))
    kinematics, _ = kinematics.turning()
    swing = kinematics.swing if len(kinematics.direction) == 2 else (0.0, 1.0, 0.0)
    circle, direction, limit, tool, aim = map(
        np.ascontiguousarray, (kinematics.circles(), kinematics.direction, kinematics.limit, kinematics.tool, kinematics.aims())
    )
    return Rotary(circle, direction, limit, tool, np.array(swing), aim)


def contacts_of(samples: SurfaceSamples) -> Contacts:
    """Samples as kernels take them."""
    return Contacts(samples.point, samples.normal, samples.direction_max, samples.curvature)


@lru_cache(maxsize=64)
def tools(cutter: Cutter, tolerance: float, error: float) -> tuple[Assembly, Assembly]:
    """Make the outer and the inner tool of a cutter, for obstacles with a chord error, mm.

    In the outer tool flutes are smaller by the depth that is safe, in the inner tool by that which is blocked
    (`tolerance.depths`); all else, which may touch nothing, is so for a tolerance of 0.
    """
    (safe, blocked), (safe_rest, blocked_rest) = depths(tolerance, error), depths(0.0, error)
    return assembly(cutter, safe, safe_rest), assembly(cutter, blocked, blocked_rest, kind="inner")


def tool_of(made: Assembly) -> Tool:
    """An assembly as kernels take it."""
    return Tool(made.piece, made.mode, made.reach, made.inner, made.end)


def laid_tool_of(made: Assembly) -> Tool:
    """The same for postures that are known: a straight side may lie along a surface that is not quite at its tilt."""
    mode = made.mode.copy()
    if any(flank.mode == len(mode) - 1 for flank in made.flanks):
        mode[-1, TILT_TO] += BEYOND
    return tool_of(made)._replace(mode=mode)


def verdict_arrays_of(verdicts: VerdictBuffer) -> VerdictArrays:
    """Where kernels write what they find."""
    return VerdictArrays(
        verdicts.verdict, verdicts.axis, verdicts.tilt_direction, verdicts.tilt, verdicts.rotation, verdicts.reason
    )


def require_finite(contacts: Contacts, rows: NDArray[np.int64]) -> None:
    """Refuse contacts that are no points with a normal, a direction and curvatures: kernels say nothing of them.

    Raises ValueError.
    """
    if not all(np.isfinite(column[rows]).all() for column in contacts):
        raise ValueError("contacts to search a posture for must be finite")


def search_postures(
    contacts: Contacts, rows: NDArray[np.int64], context: Context, verdicts: VerdictBuffer, progress: Progress | None = None,
    *, fixed: bool = False, strict: bool = False, work: Work | None = None, brief: bool = False,
) -> None:  # fmt: skip
    """Search a posture for contacts, neighbours in sequence, and write what is found into `verdicts`.

    Raises ValueError: a contact is not a point with a normal and a curvature: nothing can be said of it.

    `rows` (m,) int64: contacts to decide. `fixed`: as for `in_chunks`: each contact starts from what was found at the one before
    it in its piece. `strict`: only postures that curvature at the contact allows, as if there were no tolerance. `brief`: what
    takes long is left undecided: enough for a reason, not for a verdict.
    """
    from plan_cutters.kernels.search.search import search

    require_finite(contacts, rows)
    conditions, deep = context.conditions, context.conditions.obstacles.depths(context.conditions.tolerance)[1]
    arrays = (
        contacts, conditions.ranges._replace(strict=strict), context.outer, context.inner, conditions.obstacles.solids,
        conditions.surroundings.certain.solids, verdict_arrays_of(verdicts),
    )  # fmt: skip
    in_chunks(
        lambda piece: search(piece, *arrays, deep=deep, brief=brief, distance=context.proved_at),
        rows, conditions.jobs, progress, fixed=fixed, counted=work,
    )  # fmt: skip


def under_fixtures(contacts: Contacts, rows: NDArray[np.int64], context: Context) -> NDArray[np.bool_]:
    """Which of some contacts (m,) have so much of a convex body of a fixture over them that every posture is blocked (lemma F3).

    `rows` (m,) int64. Its planes tell in one look at a contact; a search would go through all rotations.
    """
    conditions, under = context.conditions, np.zeros(len(contacts.point), bool)
    radius = BALL * conditions.obstacles.depths(conditions.tolerance)[1]
    # A ball that is within the triangles by their error is within what they stand for.
    every = [
        (plane, radius + fixture.obstacles.triangles.chord_error)
        for fixture in conditions.surroundings.fixtures if fixture.body is not None for plane in fixture.obstacles.convex
    ]  # fmt: skip

    def look(some: NDArray[np.int64]) -> None:
        for plane, deep in every:
            height, rise = contacts.point[some] @ plane[:, :3].T + plane[:, 3], contacts.normal[some] @ plane[:, :3].T
            for distance in context.proved_at:
                under[some] |= (height + distance * rise).max(axis=1) <= -deep

    # A fine sphere has thousands of planes: not all rows at once.
    in_chunks(look, rows if every else rows[:0], conditions.jobs)
    return under[rows]


def free_in_posture(
    contacts: Contacts, rows: NDArray[np.int64], axis: Floats, tilt_direction: Floats, context: Context, work: Work | None = None
) -> NDArray[np.bool_]:
    """Contacts (n,) of some rows (m,) at which the tool stands free in a posture that is known from elsewhere.

    `rows` (m,) int64: contacts with a posture: its axis is one that the machine holds. `axis`, `tilt_direction` (n, 3) float.
    """
    from plan_cutters.kernels.search.search import free

    conditions, stands = context.conditions, np.zeros(len(axis), bool)
    arrays = contacts.point, contacts.normal, axis, tilt_direction, context.outer, conditions.obstacles.solids, stands
    in_chunks(lambda piece: free(piece, *arrays), rows, conditions.jobs, counted=work)
    return stands


def probed(
    rows: NDArray[np.int64], point: Floats, normal: Floats, axis: Floats, tilt_direction: Floats, tool: Tool,
    conditions: Conditions,
) -> tuple[Ints, Ints]:  # fmt: skip
    """Triangles (n,) that reach into a tool at postures of some rows, -1 for none, and into which of its pieces; -2 where it does
    not touch at the tilt. Bodies are not looked at. `point`, `normal`, `axis`, `tilt_direction` (n, 3) float.
    """
    from plan_cutters.kernels.search.search import probe

    tree, (triangle, which) = conditions.obstacles.tree, np.full((2, len(point)), -2, np.int32)
    in_chunks(lambda some: probe(some, point, normal, axis, tilt_direction, tool, tree, triangle, which), rows, conditions.jobs)
    return triangle, which


def over_plane(context: Context, contacts: Contacts, postures: Verdicts | VerdictBuffer, above: float) -> NDArray[np.bool_]:
    """Contacts (n,), of those with a posture, at which nothing of the tool is below a height along the setup axis, mm."""
    conditions, result, rows = context.conditions, np.zeros(len(contacts.point), bool), np.flatnonzero(postures.reached)
    lowest = context.outer_tool.lowest(contacts.point[rows], contacts.normal[rows], postures.of(rows), conditions.setup)
    result[rows] = lowest >= above - conditions.tolerance
    return result


def warm(contacts: Contacts, context: Context) -> None:
    """Load or compile every kernel, so that stage times are those of the work."""
    from plan_cutters.kernels.search import flats_and_flanks as upright
    from plan_cutters.kernels.search import search

    none, verdicts, conditions = np.zeros(0, np.int64), verdict_arrays_of(blank(0)), context.conditions
    solids = conditions.obstacles.solids
    upright.upright(none, contacts, np.zeros((0, 3)), context.outer, solids, 0.0, 0.0, np.zeros(0, np.int8), np.zeros((0, 3)))
    search.dummy_clear(none, contacts, context.dummy, context.outer, solids, np.zeros(0, bool))
    search.search(
        none, contacts, conditions.ranges, context.outer, context.inner, solids, conditions.surroundings.certain.solids, verdicts
    )
