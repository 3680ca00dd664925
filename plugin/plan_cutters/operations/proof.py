"""Operations between the samples: their proved share, and in how many pieces; inside one, any path is safe. A simultaneous
operation is proved with a field of tool axes, and it is found how the machine turns there.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import SINGULAR, Kinematics
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.axes import angle_between, margin
from plan_cutters.judging.between import Between, between
from plan_cutters.judging.cells import tensors
from plan_cutters.judging.face_cells import Fixed
from plan_cutters.operations.moving_axes import fields
from plan_cutters.option_table import EFFORT
from plan_cutters.outcome import Operation, OperationPlan
from plan_cutters.plan_file.operations import TurningEntry
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.fixed_axis import held_at
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.work import Progress, part_of

Rows = NDArray[np.int64]
#: Pieces are counted, the largest first, until they hold so much of what is proved.
_MOST_OF = 0.99
#: Ways about a loop whose angles differ by more do not close, rad.
_CLOSED = 1e-6


def proved_moving(
    ready: Prepared, operation: Operation, verdicts: Verdicts, *, budget: int, most: float, progress: Progress
) -> Operation:
    """Write into a simultaneous operation over which share a field of tool axes is proved, and how the axes turn.

    A cell counts if every axis that the field has in it, and every other one as near to the cell's, serves every contact of the
    cell: so any path inside a piece is safe with the axes of the field (`docs/between_samples.md`, lemma B16).

    `verdicts`: of its cutter in its setup. `budget`, `most`: contacts and work, as of `between`. It is unchanged where the
    rotations are limited, or no axis of the machine turns the tool.
    """
    samples, context = ready.samples, Context.of(operation.cutter, ready.setups[operation.setup])
    first, last = context.conditions.postures.rotation
    kinematics = context.conditions.kinematics
    if last - first < 2.0 * math.pi - 1e-9 or (kinematics is not None and not kinematics.turning()[1]):
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


#: The work of a plan unless a budget was requested: boxes in any case, and this share of those of the searches for verdicts.
_WORK_LEAST, _WORK_SHARE = 5e6, 0.125
#: Contacts for each sample, where that is more than a plan may add between samples.
_CONTACTS = 4


def proved(
    ready: Prepared, everywhere: Sequence[Mapping[Cutter, Verdicts]], plan: OperationPlan, searched: int, tell: Progress
) -> OperationPlan:
    """Write into operations which share of their area is proved, and in how many pieces.

    Of the operations of the plan with the same cutter and setup that serve a sample, its cell is tried with the one that has
    most room to the gouging bound, and then with the others, before it is cut into four: its area is proved if one does,
    and counts for the operation of its sample. A simultaneous operation is proved with a field of axes. Where no area between
    samples was requested, nothing is looked at and nothing is written.

    `everywhere`: of each setup the verdicts by cutter. `searched`: boxes that the searches for verdicts looked at: unless a
    budget was requested, the proof takes a share of them.
    """
    options, n = ready.options, len(ready.samples)
    budget = options.contacts_between(n)
    if not budget:
        return plan
    most = np.inf
    if options.area_budget is None:
        budget, most = max(budget, _CONTACTS * n), EFFORT[options.effort] * (_WORK_LEAST + _WORK_SHARE * searched)
    operations, alike = list(plan.operations), dict[tuple[str, int], list[int]]()
    for k, each in enumerate(operations):
        if each.mode == "fixed":
            alike.setdefault((each.cutter.id, each.setup), []).append(k)
    moving = [k for k, each in enumerate(operations) if each.mode == "simultaneous" and len(each.rows)]
    whole = sum(len(each.rows) for each in operations)
    count = len(alike) + len(moving)
    for number, group in enumerate(alike.values()):
        part = sum(len(operations[k].rows) for k in group) / max(1, whole)
        mine = part_of(tell, number, count)
        for k, each in zip(group, _proved(ready, plan, group, int(budget * part), most * part, mine), strict=True):
            operations[k] = each
    for number, k in enumerate(moving, len(alike)):
        each, part = operations[k], len(operations[k].rows) / max(1, whole)
        operations[k] = proved_moving(
            ready, each, everywhere[each.setup][each.cutter], budget=int(budget * part), most=most * part,
            progress=part_of(tell, number, count),
        )  # fmt: skip
    return replace(plan, operations=tuple(operations))


def _proved(ready: Prepared, plan: OperationPlan, group: list[int], budget: int, most: float, tell: Progress) -> list[Operation]:
    """The operations of one cutter and setup, numbers in the plan, with what is proved of them."""
    samples, chosen = ready.samples, [plan.operations[k] for k in group]
    number = np.full(len(samples), -1, np.int32)
    for i, k in enumerate(group):
        number[plan.label == k] = i
    axes, serves = np.array([each.axis for each in chosen]), plan.serves[:, group]
    context = Context.of(chosen[0].cutter, ready.setups[chosen[0].setup])
    # Of the axes that serve a sample the one with most room for the contact to move comes first.
    normal, tensor = samples.normal, tensors(samples.normal, samples.direction_max, samples.curvature)
    remaining = np.array([margin(np.broadcast_to(axis, normal.shape), normal, tensor, context) for axis in axes]).T
    remaining = np.where(serves, np.nan_to_num(remaining, nan=-np.inf, neginf=-1e300), -np.inf)
    first = np.where((number >= 0) & serves.any(axis=1), remaining.argmax(axis=1), -1).astype(np.int32)
    proved = between(
        samples, held_at(axes, first, samples, context), context, ready.scene.part,
        ready.scene.orientation, budget=budget, most=most, covered_samples=ready.not_required,
        axes=Fixed(axes, serves), own=np.append(number >= 0, False), progress=tell,
    )  # fmt: skip
    cells = proved.cells
    by_sample = np.bincount(cells.sample, cells.area, len(samples))
    result = []
    for i, each in enumerate(chosen):
        mine = number == i
        surrounding_area = float(proved.surrounding_area[mine].sum())
        own = (cells.axis == axes[i]).all(axis=1)
        piece = np.unique(cells.piece[own], return_inverse=True)[1]
        size = np.sort(np.asarray(np.bincount(piece, cells.area[own]), float))[::-1]
        share = proved_share(float(by_sample[mine].sum()), surrounding_area)
        result.append(each.with_fields(proved_share=share, approaches_proved=counted_pieces(size)))
    return result
