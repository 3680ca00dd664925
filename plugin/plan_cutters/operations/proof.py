"""Operations between the samples: their proved share, and in how many pieces; inside one, any path is safe."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.between import between
from plan_cutters.judging.face_cells import Fixed
from plan_cutters.judging.margin import margin
from plan_cutters.judging.nodes import tensors
from plan_cutters.operations.moving_proof import counted_pieces, proved_moving, proved_share
from plan_cutters.option_table import EFFORT
from plan_cutters.outcome import Operation, OperationPlan
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.fixed_axis import held_at
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress, part_of

#: The work of a plan unless a budget was requested: boxes in any case, and this share of those of the searches for verdicts.
_WORK_LEAST, _WORK_SHARE = 5e6, 0.125
#: Contacts for each sample, where that is more than a plan may add between samples.
_CONTACTS = 4


def proved(
    ready: Prepared,
    everywhere: Sequence[Mapping[Cutter, Verdicts]],
    plan: OperationPlan,
    searched: int,
    *,
    progress: Progress | None = None,
) -> OperationPlan:
    """Write into operations which share of their area is proved, and in how many pieces.

    Of the operations of the plan with the same cutter and setup that serve a sample, its cell is tried with the one that has
    most room to the gouging bound, and then with the others, before it is cut into four: its area is proved if one does,
    and counts for the operation of its sample. A simultaneous operation is proved with a field of axes. Where no area between
    samples was requested, nothing is looked at and nothing is written.

    Parameters
    ----------
    ready : Prepared
    everywhere : sequence of mapping
        Of each setup the verdicts by cutter.
    plan : OperationPlan
    searched : int
        Boxes that the searches for verdicts looked at: unless a budget was requested, the proof takes a share of them.
    progress : callable, optional
        Called with how much is done of the most that may be.

    Returns
    -------
    OperationPlan
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
    tell, count = progress or (lambda done, total: None), len(alike) + len(moving)
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
    first = np.where(number < 0, -1, _roomiest(samples, axes, serves, context))
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


def _roomiest(samples: SurfaceSamples, axes: Floats, serves: NDArray[np.bool_], context: Context) -> NDArray[np.int32]:
    """Of axes (k, 3) that serve samples (n, k) the one with most room for the contact to move; -1 where none serves."""
    tensor = tensors(samples.normal, samples.direction_max, samples.curvature)
    remaining = np.array(
        [margin(np.broadcast_to(axis, samples.normal.shape), samples.normal, tensor, context) for axis in axes]
    ).T
    remaining = np.where(serves, np.nan_to_num(remaining, nan=-np.inf, neginf=-1e300), -np.inf)
    return np.where(serves.any(axis=1), remaining.argmax(axis=1), -1).astype(np.int32)
