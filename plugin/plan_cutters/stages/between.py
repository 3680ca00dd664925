"""Between the samples: over which share of the target area do the postures found hold, each with its axis kept?

The argument and its assumptions are in `docs/between_samples.md`. Where a contact's posture does not serve its whole
cell, another one with more room to the local gouging bound is tried, then the cell is cut into four, until a budget of
contacts is spent.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Orientation, Record, SurfaceSamples
from cad_io.part import Part
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Reach, blank
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Conditions, search_postures
from plan_cutters.scene.threads import in_chunks
from plan_cutters.stages.cells import CellContacts, Field, laid, quartered, tensors

#: Room to the local gouging bound, in sines of tilt, that is asked of other postures, in turn: the smaller a cell, the
#: less is of use.
_ROOM = ((0.5,), (0.5, 0.2), (0.5, 0.2), (0.5, 0.2, 0.05))
#: A lean with a smaller sine has no direction.
_UPRIGHT = 1e-9
#: Times that a cell is cut into four, at most.
_LEVELS = 6


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Cells(Record):
    """Cells of target faces that are served, each by one tool axis.

    Attributes
    ----------
    face : (m,) int32
    uv, span : (m, 2) float
        Middle and full extent in surface parameters; what of it lies in the trim counts.
    axis : (m, 3) float
        Unit tool axis `a`. At a contact with the normal n the cutter stands on the side that they give: its bottom
        centre lies from the contact along `n - (n.a) a`.
    """

    face: Ints
    uv: Floats
    span: Floats
    axis: Floats


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Between(Record):
    """What of the target area is served.

    Attributes
    ----------
    share : float
        Of the area of all target faces whose area is known, sampled or not, 0 to 1, rounded down.
    contacts : int
        Contacts looked at, samples included.
    left : int
        Contacts whose cells are not served, when the budget or the levels ended, and samples of faces without cells.
    short : int
        Those of them for which the budget was spent.
    unknown : tuple of int
        Target faces whose area is not known: none of them is served, and they are not in `share`.
    cells : Cells
    """

    share: float
    contacts: int
    left: int
    short: int
    unknown: tuple[int, ...]
    cells: Cells

    @property
    def feasible(self) -> bool:
        """All of the target area is served, to one part in a million, and all of it is known."""
        return self.share == 1 and not self.unknown


def between(
    samples: SurfaceSamples,
    reach: Reach,
    cutter: Cutter,
    part: Part,
    orientation: Orientation,
    conditions: Conditions,
    *,
    budget: int,
) -> Between:
    """Find the share of the target area over which a cutter's postures hold.

    Parameters
    ----------
    samples : SurfaceSamples
        The faces in them, `empty` ones included, are the target.
    reach : Reach
        Of the cutter.
    cutter : Cutter
    part : Part
    orientation : Orientation
    conditions : Conditions
    budget : int
        Most contacts to add to the samples.
    """
    targets = sorted({*np.unique(samples.face).tolist(), *(number for number, _ in samples.empty)})
    areas = {number: part.faces[number - 1].area for number in targets}
    unknown = tuple(number for number, area in areas.items() if not area > 0)
    whole = sum(area for area in areas.values() if area > 0)
    served, looked, left, short = 0.0, int((samples.unjudged < 0).sum()), len(samples), 0
    found = [Cells(np.zeros(0, np.int32), np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 3)))]
    for grid in samples.grids:
        trim = part.trim(grid.face)
        if trim is None or not trim.closed:
            continue  # which part of the surface it uses is not known well enough
        field, now, strips = laid(part, orientation, samples, grid, reach, conditions)
        # A fair share of the budget for each face, by its samples; where it is short, the largest cells first.
        mine = int((grid.index >= 0).sum())
        allowed = int(budget * mine / max(1, len(samples)))
        left -= mine
        chosen = _largest(strips, allowed)
        left += len(strips) - len(chosen)
        short += len(strips) - len(chosen)
        allowed -= len(chosen)
        looked += len(chosen)
        now = CellContacts.joined(now, strips.of(chosen))
        for level in range(_LEVELS + 1):
            good = _served(now, field, cutter, conditions, _ROOM[min(level, len(_ROOM) - 1)])
            served += float(now.area[good].sum())
            found.append(
                Cells(np.full(int(good.sum()), grid.face, np.int32), now.middle[good], now.span[good], now.axis[good])
            )
            now = now.of(~good)
            chosen = _largest(now, allowed // 4 if level < _LEVELS else 0)
            left += len(now) - len(chosen)
            short += len(now) - len(chosen) if level < _LEVELS else 0
            now = now.of(chosen)
            if not len(now):
                break
            now = quartered(now, field, level, conditions)
            allowed -= len(now)
            looked += len(now)
    share = served / whole if whole > 0 else 0.0
    columns = ([getattr(cells, name) for cells in found] for name in Cells.__slots__)
    return Between(float(np.floor(1e6 * min(1.0, share + 1e-9)) / 1e6), looked, left, short, unknown,
                   Cells(*map(np.concatenate, columns)))  # fmt: skip


def _largest(contacts: CellContacts, most: int) -> NDArray[np.intp]:
    """Rows of at most so many contacts, those of the largest cells, in their order."""
    return np.sort(np.argsort(-contacts.area, kind="stable")[: max(0, most)])


def _served(
    contacts: CellContacts, field: Field, cutter: Cutter, conditions: Conditions, rooms: Sequence[float]
) -> NDArray[np.bool_]:
    """Contacts whose posture, or another one, serves their cell; postures found on the way are kept."""
    good = np.zeros(len(contacts), bool)
    known = np.isfinite(contacts.axis).all(axis=1) & _whole(contacts)
    _cover(contacts, field, cutter, conditions, np.flatnonzero(known), good)
    for room in rooms:
        open_rows = np.flatnonzero(~good & _whole(contacts))
        # A posture with room to the local gouging bound: the search is told that the surface is more concave.
        curved = contacts.curvature + room / cutter.radius
        at = Contacts(contacts.point, contacts.normal, contacts.direction_max, curved)
        found, (safe, _) = blank(len(contacts)), conditions.depths
        search_postures(at, open_rows, cutter, conditions, (safe, safe), found)
        rows = open_rows[found.reached[open_rows]]
        if len(rows):
            contacts.axis[rows], contacts.flat[rows] = found.axis[rows], False
            _cover(contacts, field, cutter, conditions, rows, good)
    return good


def _cover(
    contacts: CellContacts, field: Field, cutter: Cutter, conditions: Conditions, rows: NDArray[np.int64],
    good: NDArray[np.bool_],
) -> None:  # fmt: skip
    from plan_cutters.kernels.cover import Patches, cover
    from plan_cutters.kernels.zone import Nodes

    tensor = tensors(contacts.normal, contacts.direction_max, contacts.curvature)
    obstacles, (safe, _) = conditions.obstacles, conditions.depths
    patches = Patches(
        contacts.point, contacts.normal, tensor, contacts.axis, contacts.flat, contacts.patch, contacts.home
    )
    nodes = Nodes(field.index, field.closed, field.about)
    chord = obstacles.triangles.chord_error

    def work(piece: NDArray[np.int64]) -> None:
        cover(piece, patches, nodes, field.number, cutter.radius, cutter.length, safe, chord, obstacles.tree,
              obstacles.faces, good)  # fmt: skip

    in_chunks(work, rows, conditions.jobs)
    # A cell that is served touches no skin with any of its cutters: within a body are all of them or none.
    mine = rows[good[rows]]
    axis, normal = contacts.axis[mine], contacts.normal[mine]
    upright = (axis * normal).sum(axis=1)
    across = axis - upright[:, None] * normal
    sine = np.linalg.norm(across, axis=1)
    flat = contacts.flat[mine] | (sine < _UPRIGHT)
    lean = np.where(flat[:, None], contacts.direction_max[mine], across / np.where(flat, 1.0, sine)[:, None])
    tilt = np.where(flat, 0.0, np.arctan2(sine, upright))
    good[mine] = ~conditions.obstacles.holds(cutter, contacts.point[mine], normal, lean, tilt)


def _whole(contacts: CellContacts) -> NDArray[np.bool_]:
    """Contacts at which the surface could be evaluated."""
    columns = (contacts.point, contacts.normal, contacts.direction_max, contacts.curvature)
    return np.asarray(np.all([np.isfinite(column).all(axis=1) for column in columns], axis=0))
