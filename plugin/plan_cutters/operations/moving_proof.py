"""Simultaneous operations between the samples: where a field of tool axes is proved, and how the machine turns there."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.domain.kinematics import SINGULAR, Kinematics
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.axis_field import angle_between
from plan_cutters.judging.between import Between, between
from plan_cutters.operations.moving_axes import fields
from plan_cutters.outcome import Operation
from plan_cutters.plan_file.operations import TurningEntry
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress

Rows = NDArray[np.int64]
#: Pieces are counted, the largest first, until they hold so much of what is proved.
_MOST_OF = 0.99
#: Ways about a loop whose angles differ by more do not close, rad.
_CLOSED = 1e-6


def proved_moving(
    ready: Prepared, operation: Operation, verdicts: Verdicts, *, budget: int, most: float, progress: Progress | None = None
) -> Operation:
    """Write into a simultaneous operation over which share a field of tool axes is proved, and how the axes turn.

    A cell counts if every axis that the field has in it, and every other one as near to the cell's, serves every contact of the
    cell: so any path inside a piece is safe with the axes of the field (`docs/between_samples.md`, lemma B16).

    Parameters
    ----------
    ready : Prepared
    operation : Operation
    verdicts : Verdicts
        Of its cutter in its setup.
    budget, most
        Contacts and work, as of `between`.
    progress : callable, optional

    Returns
    -------
    Operation
        Unchanged where the rotations are limited, or the machine cannot turn a tool in all directions.
    """
    samples, context = ready.samples, Context.of(operation.cutter, ready.setups[operation.setup])
    first, last = context.conditions.postures.rotation
    kinematics = context.conditions.kinematics
    if last - first < 2.0 * math.pi - 1e-9 or (kinematics is not None and len(kinematics.turning()[1]) < 2):
        return operation
    if operation.moving is None:
        return operation
    axis = operation.moving[0]
    own = np.zeros(len(samples) + 1, bool)
    own[operation.rows] = True
    result = between(
        samples, verdicts, context, ready.scene.part, ready.scene.orientation, budget=budget, most=most,
        covered_samples=ready.not_required, axes=fields(samples, axis), own=own, progress=progress,
    )  # fmt: skip
    whole = float(result.surrounding_area[operation.rows].sum())
    turning, piece = _turning(samples, axis, result, kinematics, [each.name for each in context.conditions.machine.rotary])
    share = proved_share(float(result.cells.area.sum()), whole)
    return operation.with_fields((axis, piece), proved_share=share, approaches_proved=len(turning.pieces_mm2), turning=turning)


def proved_share(proved: float, whole: float) -> float:
    """The share of an area, mm2, that is proved, rounded down: a share of 1 means all of it."""
    return math.floor(1e6 * min(1.0, proved / whole + 1e-9)) / 1e6 if whole > 0.0 else 0.0


def counted_pieces(size: Floats) -> int:
    """How many pieces of some areas (k,), the largest first, hold nearly all of them together."""
    return int((np.cumsum(size) < _MOST_OF * size.sum()).sum()) + 1 if len(size) else 0


def _turning(
    samples: SurfaceSamples, axis: Floats, result: Between, kinematics: Kinematics | None, names: Sequence[str]
) -> tuple[TurningEntry, Ints]:
    """How the axes turn in what was proved, and the piece (n,) about each sample; `names` are those of the rotary axes."""
    cells, n = result.cells, len(samples)
    number, which = np.unique(cells.piece, return_inverse=True)
    size = np.asarray(np.bincount(which, cells.area, len(number)), float)
    order = np.argsort(-size, kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    piece = _pieces(cells.sample, rank[which], cells.area, n)
    sizes = size[order]
    counted = counted_pieces(sizes)
    edge = samples.neighbours.astype(np.int64)
    edge = edge[(piece[edge[:, 0]] == piece[edge[:, 1]]) & (piece[edge[:, 0]] >= 0)]
    turn = np.degrees(angle_between(axis[edge[:, 0]], axis[edge[:, 1]]))
    away = np.linalg.norm(samples.point[edge[:, 0]] - samples.point[edge[:, 1]], axis=1)
    steepest = float((turn / np.maximum(away, 1e-9)).max(initial=0.0))
    about = np.bincount(cells.sample[cells.sample >= 0], cells.area[cells.sample >= 0], n)
    spans, held, both, singular = None, 0.0, 0.0, 0.0
    if kinematics is not None and len(kinematics.direction) == 2:
        low, high, held, both = _held(kinematics, axis, piece, edge, sizes[:counted])
        near = np.linalg.norm(np.cross(axis, kinematics.direction[0]), axis=1) <= math.sin(SINGULAR)
        singular = float(about[near].sum())
        if low is not None and high is not None:
            spans = dict(zip(names, zip(low.tolist(), high.tolist(), strict=True), strict=True))
    return TurningEntry(pieces_mm2=sizes[:counted].tolist(), steepest_deg_mm=steepest, angles_deg=spans, held_share=held,
                        both_share=both, singular_mm2=singular), piece  # fmt: skip


def _pieces(sample: Rows, piece: Rows, area: Floats, n: int) -> Ints:
    """The piece (n,) that has most of the proved area about each sample; -1: none."""
    result = np.full(n, -1, np.int32)
    known = np.flatnonzero(sample >= 0)
    if len(known):
        both = sample[known] * (int(piece.max()) + 1) + piece[known]
        pair, which = np.unique(both, return_inverse=True)
        size = np.bincount(which, area[known])
        order = np.argsort(size, kind="stable")
        mine, of = np.divmod(pair[order], int(piece.max()) + 1)
        result[mine] = of
    return result


def _held(
    kinematics: Kinematics, axis: Floats, piece: Ints, edge: Rows, sizes: Floats
) -> tuple[Floats | None, Floats | None, float, float]:
    """Least and largest angles, deg, over pieces that a solution holds from end to end; shares that one or both hold."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    one = both = 0.0
    for k, area in enumerate(sizes.tolist()):
        rows = np.flatnonzero(piece == k)
        if not len(rows):
            continue
        place = np.full(len(piece), -1, np.int64)
        place[rows] = np.arange(len(rows))
        inner = place[edge[piece[edge[:, 0]] == k]]
        angles = kinematics.angles(axis[rows])
        spans = [span for i in range(2) if (span := _span(angles[:, i], inner, kinematics.limit)) is not None]
        one, both = one + area * (len(spans) > 0), both + area * (len(spans) == 2)
        if spans:
            # The solution that turns least.
            least, most = min(spans, key=lambda each: float((each[1] - each[0]).sum()))
            low, high = np.minimum(low, least), np.maximum(high, most)
    whole = float(sizes.sum())
    if not np.isfinite(low).all() or whole <= 0.0:
        return None, None, 0.0, 0.0
    return np.degrees(low), np.degrees(high), round(one / whole, 9), round(both / whole, 9)


def _span(angle: Floats, edge: Rows, limit: Floats) -> tuple[Floats, Floats] | None:
    """Least and largest angles (2,), rad, of one solution (m, 2) over a connected piece; None: it must turn back somewhere."""
    if not np.isfinite(angle).all():
        return None
    m, turn = len(angle), 2.0 * math.pi
    graph = coo_array((np.ones(len(edge), np.int8), edge.T), shape=(m, m)).tocsr()
    low, high, seen = np.full(2, np.inf), np.full(2, -np.inf), np.zeros(m, bool)
    for start in range(m):
        if seen[start]:
            continue
        order, before = breadth_first_order(graph, start, directed=False)
        placed = np.full((m, 2), np.nan)
        placed[start] = angle[start]
        for row in order[1:].tolist():
            step = angle[row] - placed[before[row]]
            placed[row] = placed[before[row]] + step - turn * np.round(step / turn)
        seen[order] = True
        inside = edge[np.isfinite(placed[edge[:, 0], 0])]
        if (np.abs(placed[inside[:, 0]] - placed[inside[:, 1]]) > math.pi + _CLOSED).any():
            # About a loop the axis has made a whole turn.
            return None
        least, most = placed[order].min(axis=0), placed[order].max(axis=0)
        for k in range(2):
            # Whole turns that its limits allow; of these that which is nearest to zero.
            fewest = turn * np.ceil((limit[k, 0] - least[k] - _CLOSED) / turn)
            most_turns = turn * np.floor((limit[k, 1] - most[k] + _CLOSED) / turn)
            if fewest > most_turns:
                return None
            shift = np.clip(turn * np.round(-0.5 * (least[k] + most[k]) / turn), fewest, most_turns)
            low[k], high[k] = min(low[k], least[k] + shift), max(high[k], most[k] + shift)
    return low, high
