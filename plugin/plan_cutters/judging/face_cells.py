"""A face's cells between the samples: which are served, which are still open, and which of them to cut into four next."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from dataclasses import field as dataclasses_field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.verdicts import blank
from plan_cutters.judging.axes import AxisField, angle_between, held_within, roomiest
from plan_cutters.judging.cells import CellContacts, Field, quartered, tensors
from plan_cutters.kernels.codes import NEVER, OFFSET_OF
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Context, probed, search_postures
from plan_cutters.scene.work import CHUNK, Work, in_chunks

if TYPE_CHECKING:
    from plan_cutters.kernels.area.cover import Sweeping

#: Times that a cell is cut into four, at most.
LEVELS = 6
#: Room to the local gouging bound, in sines of tilt, that is asked of other postures, in turn: the smaller a cell, the
#: less is of use.
_MARGINS = ((0.5,), (0.5, 0.2), (0.5, 0.2), (0.5, 0.2, 0.05))
#: A lean with a smaller sine has no direction.
_UPRIGHT = 1e-9
#: Cells are cut together as long as they are worth no less than the best one by this factor.
_ALIKE = 0.25
#: Contacts looked at between two looks at the work done.
_BATCH = 4096
#: Work of a probe: boxes.
_PROBE = 50
#: Work of laying out a contact, and a round of them, beside that of kernels: boxes looked at in the time.
_CONTACT, _ROUND = 110, 11_000
#: The gain is judged over at least so many of the last contacts.
_JUDGED = 4000

#: As `kernels.area.cover` writes them: how often a cell must be halved, `NEVER`, 0: it is served.
CellStatus = NDArray[np.uint8]
#: Of a contact at which no posture is known.
_UNTOLD = 2


@dataclass(frozen=True, slots=True, eq=False)
class Fixed:
    """Tool axes that stay as they are: no other posture is tried.

    `axis` (k, 3) float: unit. `serves` (n, k) bool: at which samples each of them is tried, where the sample's own does not serve
    its cell.
    """

    axis: Floats
    serves: NDArray[np.bool_]


@dataclass(slots=True)
class FaceCells:
    """A face and its cells.

    `work`: what was looked at, for this face and others.
    `fixed`: where postures are not searched.
    `turning`: each contact has its own axis: no other posture is tried.
    `reported`: called as often as contacts were looked at.
    `found`: served.
    `levels`: how often those were cut into four.
    `pools` (list of (CellContacts, outlook)): open, by how often they were cut into four.
    `unseen`: contacts that were not looked at, for the budget was spent.
    `short`, `dropped`: those, and open cells that would be cut if the budget were not spent; and those that are not for the gain
        is too small.
    `seen`, `spent`: contacts looked at, and the work that they took.
    `about` (k, 16) float: what kernels take of the nodes.
    `sweeping`: what they take of the cutter.
    """

    field: Field
    context: Context
    work: Work = dataclasses_field(default_factory=Work)
    fixed: Fixed | None = None
    turning: AxisField | None = None
    reported: Callable[[], None] = lambda: None
    found: list[CellContacts] = dataclasses_field(default_factory=list)
    levels: list[int] = dataclasses_field(default_factory=list)
    pools: list[tuple[CellContacts, CellStatus]] = dataclasses_field(default_factory=list)
    unseen: int = 0
    short: int = 0
    dropped: int = 0
    seen: int = 0
    spent: int = 0
    about: Floats = dataclasses_field(init=False)
    sweeping: "Sweeping" = dataclasses_field(init=False)

    def __post_init__(self) -> None:
        from plan_cutters.kernels.area.cover import Sweeping

        self.about = self.field.about
        context, outer_tool, cutter = self.context, self.context.outer_tool, self.context.cutter
        obstacles, tolerance = context.conditions.obstacles, context.conditions.tolerance
        self.sweeping = Sweeping(context.outer, context.dummy, *outer_tool.noses(cutter.taper, cutter.shape), outer_tool.flutes,
                                 obstacles.depths(tolerance)[0], obstacles.depths(0.0)[1])  # fmt: skip

    @property
    def served(self) -> float:
        """Area that is served, mm2."""
        return float(sum(cells.area.sum() for cells in self.found))

    @property
    def left(self) -> int:
        """Open cells."""
        return self.unseen + sum(len(contacts) for contacts, _ in self.pools)

    def begin(self, contacts: CellContacts, upto: float) -> int:
        """Look at contacts of cells that are not cut yet, in turn, until so much work is done; how many it was."""
        first = 0
        while first < len(contacts):
            if self.work.looked >= upto:
                self.unseen = len(contacts) - first
                return first
            # Where work is limited, few to begin with, to see how much they take.
            some = CHUNK if upto < np.inf and not self.seen else int(min(max(CHUNK, self._enough(upto)), _BATCH))
            self.add(contacts.of(np.arange(first, min(first + some, len(contacts)))), 0, upto)
            first += some
        return len(contacts)

    def _enough(self, upto: float) -> float:
        """As many contacts as the work that is left is likely to be enough for."""
        return (upto - self.work.looked - _ROUND) * max(1, self.seen) / max(1, self.spent)

    def add(self, contacts: CellContacts, level: int, upto: float = np.inf) -> float:
        """Look at contacts of cells of a level, for other postures `upto` some work; the area that is served by them."""
        began = self.work.looked
        self.work.add(_ROUND + _CONTACT * len(contacts))
        status = _served(contacts, self, _MARGINS[min(level, len(_MARGINS) - 1)], upto)
        self.seen, self.spent = self.seen + len(contacts), self.spent + self.work.looked - began
        self.reported()
        good = status == 0
        self.found.append(contacts.of(good))
        self.levels.append(level)
        if level == len(self.pools):
            self.pools.append((contacts.of(np.zeros(0, np.intp)), status[:0]))
        before, known = self.pools[level]
        self.pools[level] = CellContacts.joined(before, contacts.of(~good)), np.concatenate([known, status[~good]])
        return float(contacts.area[good].sum())

    def worth(self, level: int) -> Floats:
        """Area (n,) to be gained for each contact that is spent on an open cell, mm2, if all goes well."""
        if level >= min(len(self.pools), LEVELS):
            return np.zeros(0)
        contacts, status = self.pools[level]
        # Cutting once takes 4 contacts, twice 4 + 16, and so on.
        spent = (4.0 ** (np.minimum(status, LEVELS).astype(float) + 1.0) - 4.0) / 3.0
        return np.where(status == NEVER, 0.0, contacts.area / np.maximum(spent, 4.0))

    def worthy(self, least: float) -> int:
        """Open cells at which more than a least area may be gained for each contact."""
        return sum(int((self.worth(level) > least).sum()) for level in range(LEVELS))

    def _taken(self, level: int, rows: NDArray[np.intp]) -> CellContacts:
        """Take open cells out of a pool."""
        contacts, status = self.pools[level]
        self.pools[level] = contacts.of(np.delete(np.arange(len(contacts)), rows)), np.delete(status, rows)
        return contacts.of(rows)

    def refine(self, budget: int, least: float, upto: float = np.inf) -> int:
        """Cut cells into four, those of the largest worth first; how many contacts were looked at.

        Ends when the budget is spent or so much work is done, when no cell is worth more than `least`, mm2 a contact, or when the
        last contacts gained less than that.
        """
        looked, poor, rounds = 0, False, list[tuple[int, float]]()
        while budget >= 4 and not poor:
            unlooked = self._enough(upto)
            if unlooked < 4.0:
                break
            worth = [self.worth(level) for level in range(LEVELS)]
            every = np.concatenate(worth)
            alike = every >= max(_ALIKE * every.max(initial=0.0), np.nextafter(least, np.inf))
            chosen = best(np.where(alike, every, 0.0), min(int(min(budget, unlooked, _BATCH)) // 4, int(alike.sum())))
            if not chosen.any():
                break
            gained, count = 0.0, 0
            cuts = [np.flatnonzero(part) for part in np.split(chosen, np.cumsum([len(each) for each in worth])[:-1])]
            for level, contacts in [(level, self._taken(level, rows)) for level, rows in enumerate(cuts) if len(rows)]:
                quarters = quartered(contacts, self.field, level, self.context.conditions)
                gained += self.add(quarters, level + 1, upto)
                count += len(quarters)
            looked, budget = looked + count, budget - 4 * int(chosen.sum())
            rounds.append((count, gained))
            poor = _poor(rounds, least)
        cut_short = 0 if poor else self.worthy(least)
        self.short, self.dropped = self.unseen + cut_short, self.worthy(0.0) - cut_short
        return looked


def best(worth: Floats, most: int) -> NDArray[np.bool_]:
    """Which are the at most so many of the largest worth; the first of equal ones."""
    chosen = np.zeros(len(worth), bool)
    chosen[np.argsort(-worth, kind="stable")[: max(0, most)]] = True
    return chosen


def _poor(rounds: Sequence[tuple[int, float]], least: float) -> bool:
    """Whether the last rounds, enough of them to tell, gained less than a least area for each contact."""
    count, gained = 0, 0.0
    for more, area in reversed(rounds):
        count, gained = count + more, gained + area
        if count >= _JUDGED:
            return gained < least * count
    return False


def _served(contacts: CellContacts, face_cells: FaceCells, rooms: Sequence[float], upto: float) -> CellStatus:
    """Outlook of contacts whose posture, or another one, serves their cell (0) or parts of it; the one with the best is kept."""
    context = face_cells.context
    status = np.full(len(contacts), _UNTOLD, np.uint8)
    tensor = tensors(contacts.normal, contacts.direction_max, contacts.curvature)
    if face_cells.turning is not None:
        return _along(face_cells.turning, contacts, tensor, face_cells)
    known = np.isfinite(contacts.axis).all(axis=1) & _whole(contacts)
    rows = np.flatnonzero(known)
    status[rows] = _cover(contacts, tensor, contacts.axis, contacts.flat, face_cells, rows)
    if face_cells.fixed is not None:
        status[~known] = NEVER
        _among(face_cells.fixed, contacts, tensor, status, face_cells, upto)
        return status
    outer_tool, bends = context.outer_tool, 1.0 / context.cutter.radius
    # Whether surely no posture is left is of no interest here: the outer tool stands for both.
    outer_alone = replace(context, inner_tool=outer_tool)
    leant = np.zeros(len(contacts), bool)
    if not (outer_tool.mode[:, OFFSET_OF] > 0.0).any():
        # A ball gouges at every tilt or at none.
        bends = 0.0
    elif len(outer_tool.mode) == 1:  # room is that of one end: a lens or barrel would be laid on another one
        leant = _tilt_more(contacts, tensor, status, np.flatnonzero((status > 0) & known), face_cells, upto)
    for margin in rooms:
        if face_cells.work.looked >= upto:
            break
        # Where there is no posture there is none with more room.
        open_rows = np.flatnonzero((status > 0) & _whole(contacts) & ~contacts.not_reached & ~leant)
        # A posture with room to the local gouging bound: the search is told that the surface is more concave.
        curved = contacts.curvature + margin * bends
        at = Contacts(contacts.point, contacts.normal, contacts.direction_max, curved)
        verdicts = blank(len(contacts))
        search_postures(at, open_rows, outer_alone, verdicts, strict=bends > 0.0, work=face_cells.work)
        rows = open_rows[verdicts.reached[open_rows]]
        if len(rows):
            new = _cover(
                contacts, tensor, verdicts.axis, np.zeros(len(contacts), bool), face_cells, rows, verdicts.tilt_direction
            )
            better = (new <= status[rows]) | ~known[rows]
            rows, new = rows[better], new[better]
            contacts.axis[rows], contacts.flat[rows], status[rows], known[rows] = verdicts.axis[rows], False, new, True
            contacts.side[rows] = verdicts.tilt_direction[rows]
    return status


def _along(turning: AxisField, contacts: CellContacts, tensor: Floats, face_cells: FaceCells) -> CellStatus:
    """Outlook of contacts whose cells are served with every axis that the field has in them, and all between."""
    axis, swing = turning.within(contacts.middle, contacts.span)
    conditions, (low, high) = face_cells.context.conditions, face_cells.context.conditions.postures.tilt
    contacts.axis[:], contacts.flat[:] = axis, False
    tilt = angle_between(axis, contacts.normal)
    known = _whole(contacts) & np.isfinite(axis).all(axis=1) & np.isfinite(swing)
    held = known & held_within(axis, swing, conditions) & (tilt - swing >= low - _UPRIGHT) & (tilt + swing <= high + _UPRIGHT)
    status = np.where(known, np.uint8(1), np.uint8(NEVER))
    rows = np.flatnonzero(held)
    status[rows] = _cover(contacts, tensor, axis, contacts.flat, face_cells, rows, swings=swing)
    return status


def _tilt_more(
    contacts: CellContacts, tensor: Floats, status: CellStatus, rows: NDArray[np.intp], face_cells: FaceCells, upto: float
) -> NDArray[np.bool_]:
    """Try one posture more on cells that their own does not serve, with most room for the contact to move.

    Returns those that keep it: their parts may be served by it, and there is none with more room.
    """
    leant = np.zeros(len(contacts), bool)
    first, last = face_cells.context.conditions.postures.rotation
    # Where rotations are limited the search knows which there are.
    if not len(rows) or face_cells.work.looked >= upto or last - first <= 2.0 * np.pi - 1e-9:
        return leant
    axes, side = contacts.axis.copy(), contacts.side.copy()
    some = contacts.of(rows)
    axes[rows], side[rows] = roomiest(some.normal, some.direction_max, tensor[rows], some.axis, face_cells.context)
    rows = rows[(axes[rows] != contacts.axis[rows]).any(axis=1)]
    rows = rows[_free(contacts, axes, side, face_cells, rows)]
    new = _cover(contacts, tensor, axes, np.zeros(len(axes), bool), face_cells, rows, side)
    better = new <= status[rows]
    rows, new = rows[better], new[better]
    contacts.axis[rows], contacts.side[rows], contacts.flat[rows], status[rows] = axes[rows], side[rows], False, new
    leant[rows] = new != NEVER
    return leant


def _free(
    contacts: CellContacts, axes: Floats, side: Floats, face_cells: FaceCells, rows: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """At which rows of contacts the cutter meets nothing with axes that lean to a side."""
    context = face_cells.context
    face_cells.work.add(_PROBE * len(rows))
    met, _ = probed(rows, contacts.point, contacts.normal, axes, side, context.outer, context.conditions)
    return np.asarray(met[rows] == -1)


def _among(fixed: Fixed, contacts: CellContacts, tensor: Floats, status: CellStatus, face_cells: FaceCells, upto: float) -> None:
    """Try fixed axes in turn on cells that their own does not serve; the one with the best outlook is kept."""
    able = (contacts.sample >= 0)[:, None] & fixed.serves[contacts.sample]
    own = contacts.axis.copy()
    for k, axis in enumerate(fixed.axis):
        if face_cells.work.looked >= upto:
            return
        rows = np.flatnonzero((status > 0) & able[:, k] & np.isfinite(own[:, 0]) & (own != axis).any(axis=1) & _whole(contacts))
        if not len(rows):
            continue
        tried, side = np.broadcast_to(axis, own.shape), contacts.direction_max
        new = _cover(contacts, tensor, np.ascontiguousarray(tried), np.zeros(len(own), bool), face_cells, rows, side)
        better = new < status[rows]
        rows = rows[better]
        contacts.axis[rows], contacts.side[rows], status[rows] = axis, side[rows], new[better]


def _cover(
    contacts: CellContacts, tensor: Floats, axes: Floats, flats: NDArray[np.bool_], face_cells: FaceCells,
    rows: NDArray[np.int64], sides: Floats | None = None, swings: Floats | None = None,
) -> CellStatus:  # fmt: skip
    """Outlook (m,) of rows of contacts with tensors and axes, that may turn; on the sides that they have, or others."""
    from plan_cutters.kernels.area.cover import Patches, cover
    from plan_cutters.kernels.area.zone import Nodes

    field, conditions, sweeping = face_cells.field, face_cells.context.conditions, face_cells.sweeping
    sides, obstacles = contacts.side if sides is None else sides, conditions.obstacles
    patches = Patches(contacts.point, contacts.normal, tensor, axes, flats, sides, contacts.patch, contacts.home,
                      np.zeros(len(contacts)) if swings is None else swings)  # fmt: skip
    nodes, status = Nodes(field.index, field.closed, face_cells.about), np.zeros(len(contacts), np.uint8)
    arrays = patches, nodes, field.number, sweeping, obstacles.tree, obstacles.faces, status
    in_chunks(lambda piece: cover(piece, *arrays), rows, conditions.jobs, counted=face_cells.work)
    # A cell that is served touches no skin with any of its cutters: within a body are all of them or none.
    mine = rows[status[rows] == 0]
    axis, normal = axes[mine], contacts.normal[mine]
    upright = (axis * normal).sum(axis=1)
    across = axis - upright[:, None] * normal
    sine = np.linalg.norm(across, axis=1)
    flat = flats[mine] | (sine < _UPRIGHT)
    tilt_direction = np.where(flat[:, None], sides[mine], across / np.where(flat, 1.0, sine)[:, None])
    tilt = np.where(flat, 0.0, np.arctan2(sine, upright))
    within = obstacles.holds(face_cells.context.outer_tool, contacts.point[mine], normal, tilt_direction, tilt)
    status[mine[within]] = NEVER
    return status[rows]


def _whole(contacts: CellContacts) -> NDArray[np.bool_]:
    """Contacts at which the surface could be evaluated."""
    columns = (contacts.point, contacts.normal, contacts.direction_max, contacts.curvature)
    return np.asarray(np.all([np.isfinite(column).all(axis=1) for column in columns], axis=0))
