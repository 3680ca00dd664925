"""Between the samples: over which share of the target area do the postures found hold, each with its axis kept?

The argument and its assumptions are in `docs/between_samples.md`. Where a contact's posture does not serve its whole cell,
another one with more room to the local gouging bound is tried. Then the cell is cut into four: those cells first at which the
most area may be gained for each contact, until that is too little or a budget of contacts is spent.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from cad_io.arrays import FaceGrid, Floats, Ints, Orientation, Record, SurfaceSamples
from cad_io.graphs import connected as groups
from cad_io.part import Part
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.axes import AxisField
from plan_cutters.judging.cells import CellContacts, Field, laid
from plan_cutters.judging.face_cells import FaceCells, Fixed, best
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.work import Progress, Work, part_of

Indices = NDArray[np.int64]

#: Times that a cell is cut into four, at most; room for that in the numbers of tiles.
_MOST_LEVELS = 10
#: An axis with a smaller sine to the normal is along it, and sides with a smaller difference are one.
_ALONG, _ONE = 1e-9, 1e-9


def connected(field: Field, cells: CellContacts, level: Indices, *, turning: bool = False) -> Indices:
    """Number the pieces of served cells of a face, from 0.

    Cells that lie in the trim altogether are joined across a common side if they have the same axis, and where that is the normal
    in both, the same side. One that the border cuts may fall apart: it goes with one whole neighbour and joins no others.

    `cells`: served, none of them within another. `level` (m,) int64: how often each was cut into four. `turning`: both sides of a
    common side have the axes of one field. Returns (m,) int64.
    """
    m = len(cells)
    tiles, which = np.array(field.index.shape) << _MOST_LEVELS, np.arange(m)
    key = _key(level, cells.tile, tiles)
    order = np.argsort(key, kind="stable")
    known, pairs = key[order], [np.zeros((0, 2), np.int64)]
    for step in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        beyond, count = cells.tile + step, np.array(field.index.shape) << level[:, None]
        beyond = np.where(field.closed, np.remainder(beyond, count), beyond)
        on = ((beyond >= 0) & (beyond < count)).all(axis=1)
        for up in range(int(level.max(initial=0)) + 1):
            # The neighbour is as large, or larger: the smaller of two finds the other one.
            mine = np.flatnonzero(on & (level >= up))
            wanted = _key(level[mine] - up, beyond[mine] >> up, tiles)
            at = np.minimum(np.searchsorted(known, wanted), m - 1)
            there = known[at] == wanted
            pairs.append(np.column_stack([which[mine[there]], order[at[there]]]))
    pair = np.concatenate(pairs)
    a, b = (pair if turning else pair[_alike(cells, pair)]).T
    both, one = cells.whole[a] & cells.whole[b], cells.whole[a] != cells.whole[b]
    # Of a cell that is cut, the first whole neighbour.
    cut, neighbours = np.where(cells.whole[a[one]], b[one], a[one]), np.where(cells.whole[a[one]], a[one], b[one])
    cut, first = np.unique(cut, return_index=True)
    tail, head = np.concatenate([a[both], cut]), np.concatenate([b[both], neighbours[first]])
    return groups(m, np.column_stack([tail, head])).astype(np.int64)


def _key(level: Indices, tile: Indices, tiles: Indices) -> Indices:
    """One number for each tile of each level."""
    return np.asarray((level * tiles[0] + tile[:, 0]) * tiles[1] + tile[:, 1])


def _alike(cells: CellContacts, pair: Indices) -> NDArray[np.bool_]:
    """Pairs whose cutters are the same at a common contact."""
    a, b = pair.T
    same = (cells.axis[a] == cells.axis[b]).all(axis=1)
    across = np.linalg.norm(np.cross(cells.axis, cells.normal), axis=1)
    along = across <= _ALONG
    apart = np.linalg.norm(cells.side[a] - cells.side[b], axis=1)
    return np.asarray(same & (~(along[a] & along[b]) | (apart <= _ONE)))


#: Least gain, as a share of the target area for each contact, for which cells are cut into four.
LEAST_GAIN = 1e-7
#: Steps in which progress is told.
_STEPS = 1000


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Cells(Record):
    """Cells of target faces that are served, each by one tool axis.

    `face` (m,) int32.
    `uv`, `span` (m, 2) float: middle and full extent in surface parameters; what of it lies in the trim counts.
    `axis` (m, 3) float: unit tool axis `a`. At a contact with the normal n the cutter stands on the side that they give: its
        bottom centre lies from the contact along `n - (n.a) a`.
    `side` (m, 3) float: unit tilt direction where the axis is the normal all over the cell: there the bottom centre lies against
        it.
    `whole` (m,) bool: it lies in the trim altogether.
    `area` (m,) float: of what lies in the trim, mm2.
    `sample` (m,) int64: the one that it lies about, -1 for none.
    `piece` (m,) int64: connected cells with one axis have the same number (`connected`).
    """

    face: Ints
    uv: Floats
    span: Floats
    axis: Floats
    side: Floats
    whole: NDArray[np.bool_]
    area: Floats
    sample: NDArray[np.int64]
    piece: NDArray[np.int64]

    @staticmethod
    def joined(parts: Sequence["Cells"]) -> "Cells":
        return Cells(*(np.concatenate([getattr(cells, name) for cells in parts]) for name in Cells.__slots__))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Between(Record):
    """The search between samples proved this part of the target area.

    `served`, `whole`: proved area, mm2, and that of all target faces whose area is known, sampled or not, without what surely
        lies inside other bodies of the part.
    `contacts`: contacts looked at, samples included.
    `left`: contacts whose cells are not proved, when the budget or the levels ended, and samples of faces without cells.
    `short`: those of them for which the budget was spent.
    `dropped`: those of them that were not looked at more closely since too little was to be gained.
    `unknown`: target faces whose area is not known: none of them is proved, and they are not in `share`.
    `around` (n,) float: area of all cells about each sample, served or not, mm2.
    """

    served: float
    whole: float
    contacts: int
    left: int
    short: int
    dropped: int
    unknown: tuple[int, ...]
    cells: Cells
    surrounding_area: Floats

    @property
    def share(self) -> float:
        """Give the share of the area that is proved, 0 to 1, rounded down."""
        share = self.served / self.whole if self.whole > 0 else 0.0
        return float(np.floor(1e6 * min(1.0, share + 1e-9)) / 1e6)

    @property
    def feasible(self) -> bool:
        """All of the target area is served, to one part in a million, and all of it is known."""
        return self.share == 1 and not self.unknown


def between(
    samples: SurfaceSamples, verdicts: Verdicts, context: Context, part: Part, orientation: Orientation, *, budget: int,
    most: float = np.inf, work: Work | None = None, covered_samples: NDArray[np.bool_] | None = None,
    axes: Fixed | Mapping[int, AxisField] | None = None, own: NDArray[np.bool_] | None = None,
    progress: Progress | None = None,
) -> Between:  # fmt: skip
    """Find the share of the target area over which a cutter's postures hold.

    `samples`: the faces in them, `empty` ones included, are the target.
    `verdicts`: of the cutter.
    `budget`: most contacts to add to the samples.
    `most`: most work to do, counted as `Work` does.
    `covered_samples` (n,) bool: samples that are no surface of the finished part: cells about them are left out where all around
        them are such, too.
    `axes`: of a Fixed, each cell keeps the axis of its sample, or takes one of these that serve the sample. Fields by face: each
        contact has the axis that the field has there, cells are served where every axis in them serves all of the cell, and faces
        without a field are not looked at. No other posture is searched.
    `own` (n + 1,) bool: samples whose cells are looked at, and behind them whether those about no sample are; the others are as
        if they were not there, but `share` is of all the same.
    """
    whole, unknown = _areas(samples, part)
    fixed, turning = (axes, None) if axes is None or isinstance(axes, Fixed) else (None, axes)
    covered_samples = np.zeros(len(samples), bool) if covered_samples is None else covered_samples
    own = np.ones(len(samples) + 1, bool) if own is None else own
    counted, short = own[:-1] & ~covered_samples, 0
    looked, unlooked = int((counted & (samples.unjudged < 0)).sum()), int(counted.sum())
    work = Work() if work is None else work
    began, upto = work.looked, work.looked + most
    contacts = budget

    def reported() -> None:
        if progress is not None:
            share = max((work.looked - began) / most, sum(face_cells.seen for face_cells in faces) / max(1, contacts))
            progress(min(int(_STEPS * share), _STEPS), _STEPS)

    faces, nodes, strips = list[FaceCells](), list[CellContacts](), list[CellContacts]()
    for grid in samples.grids:
        trim = part.trim(grid.face)
        if trim is None or not trim.closed or (turning is not None and grid.face not in turning):
            continue  # which part of the surface it uses is not known well enough
        if not own[-1] and not own[grid.index[grid.index >= 0]].any():
            continue  # nothing of it is asked for
        field, mine, bare = laid(part, orientation, samples, grid, verdicts, context.conditions)
        on_grid = grid.index[grid.index >= 0]
        unlooked -= int(counted[on_grid].sum())
        if covered_samples[on_grid].any():
            deep = _covered(field, grid, covered_samples)
            for cells in (mine, bare):
                whole -= float(cells.area[deep[tuple(cells.home.T)]].sum())
            mine, bare = (cells.of(~deep[tuple(cells.home.T)]) for cells in (mine, bare))
        # Row -1, of no sample, is the last.
        mine, bare = (cells.of(own[cells.sample]) for cells in (mine, bare))
        faces.append(FaceCells(field, context, work, fixed, None if turning is None else turning[grid.face], reported))
        nodes.append(mine)
        strips.append(bare)
    contacts = budget + sum(map(len, nodes))
    surrounding_area = _about(nodes, len(samples)) + _about(strips, len(samples))
    # The strips come first, the largest ones where the budget is short.
    chosen = best(np.concatenate([np.zeros(0), *(each.area for each in strips)]), budget)
    short += int((~chosen).sum())
    budget -= int(chosen.sum())
    ends = np.cumsum([len(each) for each in strips])
    laid_out = [
        CellContacts.joined(mine, bare.of(own_chosen))
        for mine, bare, own_chosen in zip(nodes, strips, np.split(chosen, ends[:-1]), strict=True)
    ]
    looked -= sum(len(mine) for mine in nodes)
    # Those with the largest cells first: there each contact may gain most.
    gains = [float(cells.area.sum()) / max(1, len(cells)) for cells in laid_out]
    looked += sum(faces[i].begin(laid_out[i], upto) for i in sorted(range(len(faces)), key=lambda i: -gains[i]))
    looked += _refined(faces, budget, LEAST_GAIN * whole, upto, work)
    unlooked += int((~chosen).sum()) + sum(face_cells.left for face_cells in faces)
    short += sum(face_cells.short for face_cells in faces)
    served, dropped = sum(face_cells.served for face_cells in faces), sum(face_cells.dropped for face_cells in faces)
    return Between(served, whole, looked, unlooked, short, dropped, unknown, _cells(faces), surrounding_area)


def _areas(samples: SurfaceSamples, part: Part) -> tuple[float, tuple[int, ...]]:
    """The area of all target faces, mm2, and those whose area is not known."""
    targets = sorted({*np.unique(samples.face).tolist(), *(number for number, _ in samples.empty)})
    areas = {number: part.faces[number - 1].area for number in targets}
    unknown = tuple(number for number, area in areas.items() if not area > 0)
    return sum(area for area in areas.values() if area > 0), unknown


def _refined(faces: Sequence[FaceCells], budget: int, least: float, upto: float, work: Work) -> int:
    """Cut cells into four, with a fair share of the budget for each face, by how many of its cells are open and worth it."""
    wanted = [face_cells.worthy(least) for face_cells in faces]
    behind, looked = sum(wanted), 0
    for face_cells, share in zip(faces, wanted, strict=True):
        # What one face leaves of the work goes to those after it.
        until = work.looked + max(0.0, upto - work.looked) * share / behind if share else 0.0
        looked += face_cells.refine(budget * share // max(1, sum(wanted)), least, until)
        behind -= share
    return looked


def in_each(
    samples: SurfaceSamples, verdicts: Verdicts, which: Ints, contexts: Sequence[Context], part: Part,
    orientation: Orientation, *, budget: int, most: float = np.inf, covered_samples: NDArray[np.bool_] | None = None,
    progress: Progress | None = None,
) -> Between:  # fmt: skip
    """The same over setups that hold the part differently: each cell among the obstacles of the setup that serves its sample.

    `samples`, `verdicts`, `part`, `orientation`, `budget`, `most`, `covered_samples`, `progress`: as for `between`; the verdicts
    are those over all setups. `which` (n,) int32: the setup that serves each sample, -1 for none: its cells go with the first
    setup, as those about no sample do. `contexts`: of the cutter in each setup, the first one first.
    """
    place = np.append(np.maximum(which, 0), 0)
    cells = []
    for k, context in enumerate(contexts):
        own = place == k
        part_of_all = float(own[:-1].sum()) / max(1, len(samples))
        cells.append(between(
            samples, verdicts, context, part, orientation, budget=int(budget * part_of_all), most=most * part_of_all,
            covered_samples=covered_samples, own=own,
            progress=None if progress is None else part_of(progress, k, len(contexts)),
        ) if own.any() else None)  # fmt: skip
    return _joined([each for each in cells if each is not None])


def _joined(each: Sequence[Between]) -> Between:
    """What was proved of cells that lie apart, in one."""
    pieces, last = [], 0
    for one in each:
        pieces.append(replace(one.cells, piece=one.cells.piece + last))
        last = int(pieces[-1].piece.max(initial=last - 1)) + 1
    return Between(
        sum(one.served for one in each), each[0].whole, sum(one.contacts for one in each), sum(one.left for one in each),
        sum(one.short for one in each), sum(one.dropped for one in each), each[0].unknown,
        Cells.joined(pieces), np.sum([one.surrounding_area for one in each], axis=0),
    )  # fmt: skip


def _about(cells: Sequence[CellContacts], count: int) -> Floats:
    """Area of cells about each of so many samples, mm2."""
    sample = np.concatenate([np.zeros(0, np.int64), *(each.sample for each in cells)])
    area = np.concatenate([np.zeros(0), *(each.area for each in cells)])
    known = sample >= 0
    return np.asarray(np.bincount(sample[known], area[known], count), float)


def _covered(field: Field, grid: FaceGrid, covered_samples: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tiles (nu, nv) of a face about whose node, and about those around it, nothing is surface of the finished part."""
    rows = np.unique(grid.index[grid.index >= 0])
    on = (field.index >= 0) & (field.index < len(rows))
    covered = on & covered_samples[rows[np.where(on, field.index, 0)]]
    square = np.ones((3, 3), bool)
    return np.asarray(ndimage.binary_erosion(covered | ~on, square, border_value=1) & ndimage.binary_dilation(covered, square))


def _cells(faces: Sequence[FaceCells]) -> Cells:
    """The served cells of all faces."""
    none, wide, last = np.zeros(0), np.zeros((0, 3)), 0
    pieces = [Cells(none.astype(np.int32), wide[:, :2], wide[:, :2], wide, wide, none.astype(bool), none, none.astype(np.int64),
                    none.astype(np.int64))]  # fmt: skip
    for face_cells in faces:
        if not face_cells.found:
            continue
        each = CellContacts.joined(*face_cells.found)
        level = np.repeat(np.array(face_cells.levels, np.int64), [len(c) for c in face_cells.found])
        piece = last + connected(face_cells.field, each, level, turning=face_cells.turning is not None)
        last += len(each)
        pieces.append(Cells(np.full(len(each), face_cells.field.number, np.int32), each.middle, each.span, each.axis, each.side,
                            each.whole, each.area, each.sample, piece))  # fmt: skip
    return Cells.joined(pieces)
