"""The plan of operations of a part that was judged: its cutters, and the order of its steps."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import count, duration, percent, reporting
from plan_cutters.domain.operations import Columns, columns_of
from plan_cutters.domain.own_process import OwnResult, cutter_of
from plan_cutters.domain.shapes import top_radius
from plan_cutters.domain.verdicts import INACCESSIBLE, Verdicts
from plan_cutters.operations import choices
from plan_cutters.operations.by_pattern import PlansTimed, Repeated, as_quick, planned_by_pattern, repeated_orientations
from plan_cutters.operations.canonical import canonical
from plan_cutters.operations.entries import operations_entry
from plan_cutters.operations.fastest import against_bound, bounded
from plan_cutters.operations.fewest import FINEST, Search, search_fewest
from plan_cutters.operations.labels import WHOLE_FACE, Seams, flowing_faces
from plan_cutters.operations.motion import chosen_for_others, few_enough, flowing, recommended, with_moved
from plan_cutters.operations.moving_axes import MovingAxes
from plan_cutters.operations.orientations import STEP, Indexing, Orientations, apart, candidates
from plan_cutters.operations.own_steps import own_plan
from plan_cutters.operations.passes import Extents, Paths
from plan_cutters.operations.plans import (
    MINOR_AREA,
    best_area,
    considered,
    costs_with,
    of_wanted_kinds,
    plan_with,
    small_pieces,
    worth_their_turn,
)
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.proof import proved
from plan_cutters.operations.task import Task, at_some, thinned
from plan_cutters.operations.walls import Walls
from plan_cutters.options import Options
from plan_cutters.outcome import LeastSet, OperationPlan, Operations
from plan_cutters.scene.fixed_axis import along_flank
from plan_cutters.scene.preparation import Prepared, held_faces
from plan_cutters.scene.work import Progress, part_of


def comparable(ready: Prepared, least: LeastSet | None) -> list[Cutter]:
    """The cutters with a feed, without kinds that come after all that are needed, if these have feeds."""
    unpriced = without_feed(ready)
    priced, needed = [each for each in ready.cutters if each not in unpriced], [run.cutter for run in least.runs] if least else []
    if not needed or any(each in unpriced for each in needed):
        return priced
    return of_wanted_kinds(priced, needed, ready.chosen.free_form)


def feeds(options: Options, cutters: Sequence[Cutter]) -> Mapping[Cutter, float] | None:
    """The feed of each cutter, mm/min; None where one has none."""
    stated = options.feeds if options.feed is None else dict.fromkeys(cutters, options.feed)
    return {each: stated[each] for each in cutters} if all(each in stated for each in cutters) else None


def without_feed(ready: Prepared) -> tuple[Cutter, ...]:
    """The cutters that no operation is planned with, for times are requested and they have no feed."""
    if ready.options.operations not in ("fastest", "both"):
        return ()
    stated = ready.options.feeds
    return tuple(each for each in ready.cutters if each not in stated)


Rows = NDArray[np.int64]
#: Cutters whose operations are compared, at most: the fewest that reach all, and then by rank.
_CUTTERS = 4
#: Parts of the work whose progress is told as one: what may be repeated, the fewest, the plans, their proof.
_PARTS = 4
#: Samples by which all candidates for the fastest are compared; those that are not dropped then are compared by more.
_PRICED = 200
#: How often canonical orientations are sought by some samples, with so many more of what they leave, before it is by all.
_AGAIN, _AT_ONCE = 4, 200
#: Faces that are named in a note, at most.
_NAMED = 6


@reporting(lambda ready: ready.options.reported_unit)
def plan_operations(
    ready: Prepared, everywhere: Sequence[Mapping[Cutter, Verdicts]], least: LeastSet | None,
    stage: Callable[[str], AbstractContextManager[Progress]], searched: int,
) -> Operations:  # fmt: skip
    """Plan the operations that finish together all that the cutters reach.

    `everywhere`: of each setup, the first one first, the verdicts by cutter. `least`: the fewest cutters that reach all that any
    reaches: they are considered before others. `stage`: opens a stage of work by its name; what it gives is told how much of how
    much is done. `searched`: as for `proved`.
    """
    options, task = ready.options, _task(ready, everywhere, least)
    fewest, alone, more, outcomes = None, 0, None, tuple[OwnResult, ...]()
    made: PlansTimed
    with stage("operations") as tell:
        parts = [part_of(tell, k, _PARTS) for k in range(_PARTS)]
        offer = _offer(task, parts[0]) if options.process is None else None
        quick = planned_by_pattern(task, offer) if offer is not None and options.operations == "fastest" else None
        if options.process is not None:
            plan, outcomes = own_plan(task, options.process, partial(_planned_rest, parts=parts))
            made = [plan], None, (), ()
        elif quick is not None:
            made = _in_motion(task, quick)
        elif options.operations == "fastest":
            made, search, some = _plans_by_some(task, offer, parts)
            alone = len(search.alone) * (len(task.rows) // max(1, len(some.rows)))
            task.probes.made += some.probes.made if some is not task else 0
        else:
            finest = FINEST if options.index_step is None else options.index_step
            search = Search(task.probes, _first(task, STEP), task.rows, partial(_stored, task), part_of(parts[1], 0, 2))
            fewest = search_fewest(search, task.orientations, options.index_step or STEP, finest, part_of(parts[1], 1, 2))
            few, alone, some = fewest.columns.of(fewest.cover.chosen), len(fewest.alone), thinned(task)
            made = _plans(task, some, search, few, offer, parts[2])
            more = choices.one_more(task, some, search, made[0][0], _columns_of(task, made[0][0]))
        plans, timed, worth, instead = made
        plans = _proved(task, plans, searched, parts[3])
    notes = () if options.process is not None else (*instead, *_notes(task, least, plans, None if instead else alone))
    few_entry = None if fewest is None else fewest.entry.model_copy(update={"one_more": more})
    entry = operations_entry(task, plans, notes, few_entry, timed, worth)
    columns, chosen = (task.no_columns, np.zeros(0, np.int64)) if fewest is None else (fewest.columns, fewest.cover.chosen)
    return Operations(entry, task.cutters, tuple(plans), columns, chosen, outcomes)


def _plans_by_some(task: Task, offer: Repeated | None, parts: Sequence[Progress]) -> tuple[PlansTimed, Search, Task]:
    """Plans from few orientations among coarse candidates that serve some samples, with the search, and the task of these."""
    some = thinned(task)
    search = Search(some.probes, _first(some, choices.COARSE), some.rows, partial(_stored, some), parts[1], _PRICED)
    return _plans(task, some, search, choices.served(some, search), offer, parts[2]), search, some


def _planned_rest(rest: Task, parts: Sequence[Progress]) -> Columns:
    """The fixed orientations of the best plan for what the steps of the planner's own process leave."""
    if not len(rest.rows):
        return rest.no_columns
    (plans, *_), _, _ = _plans_by_some(rest, _offer(rest, parts[0]), parts)
    return _columns_of(rest, next((each for each in plans if each.name == "fastest"), plans[0]))


def _offer(task: Task, tell: Progress) -> Repeated | None:
    """The orientations that may be repeated; None where there are none."""
    result = repeated_orientations(task, _first, partial(_stored, task), tell)
    tell(1, 1)
    return result


def _proved(task: Task, plans: Sequence[OperationPlan], searched: int, tell: Progress) -> list[OperationPlan]:
    """Plans with what is proved between the samples: what was found of a plan is not sought again of others that are the same."""
    result = list[OperationPlan]()
    for k, each in enumerate(plans):
        same = next((other for other in result if each.like(other)), None)
        mine = part_of(tell, k, len(plans))
        if same is None:
            each = proved(task.ready, task.everywhere, each, searched, mine)
        result.append(each if same is None else replace(same, name=each.name))
    return result


def _notes(task: Task, least: LeastSet | None, plans: Sequence[OperationPlan], alone: int | None) -> list[str]:
    """What must be said of plans: small pieces, and cutters and orientations that were left out.

    `alone`: about how many samples no candidate serves; None where nothing is to be said of simultaneous motion.
    """
    ready, options, notes = task.ready, task.ready.options, list[str]()
    for k, each in enumerate(plans):
        if not any(each.like(other) for other in plans[:k]):
            notes += small_pieces(each, ready.samples, options.overlap)
    if unpriced := [each.id for each in without_feed(ready)]:
        has = "has no feed" if len(unpriced) == 1 else "have no feed"
        notes.append(
            f"No operation is planned with what {has}: {', '.join(unpriced)}. Give `--feed MM/MIN`, or ask for the fewest."
        )
    compared = comparable(ready, least)
    if late := [each.id for each in ready.cutters if each.id not in (*unpriced, *(one.id for one in (*compared, *task.cutters)))]:
        kind = "whose kind comes" if len(late) == 1 else "whose kinds come"
        notes.append(f"No operation is planned with {', '.join(late)}, {kind} last on these faces: the others reach all without.")
    moving = max(_moving_for_rest(ready, plan) for plan in plans)
    if options.most_operations is None and alone is not None and moving > alone:
        notes.append(
            f"Orientations that add less than {percent(MINOR_AREA)} of the area each are left out of the plans; "
            "`--most-operations` with a large number takes all."
        )
    return notes


def _moving_for_rest(ready: Prepared, plan: OperationPlan) -> int:
    """How many samples go with simultaneous motion as the rest of fixed orientations: not those of a face that it takes whole."""
    area, face = np.nan_to_num(ready.samples.area), ready.samples.face
    rows = np.concatenate([np.zeros(0, np.int64), *(each.rows for each in plan.operations if each.mode == "simultaneous")])
    cut, most = plan.label >= 0, int(face.max(initial=0)) + 1
    mine, whole = np.bincount(face[rows], area[rows], most), np.bincount(face[cut], area[cut], most)
    taken = (mine >= WHOLE_FACE * whole) & (whole >= MINOR_AREA * whole.sum())
    return int((~taken[face[rows]]).sum())


def _plans(task: Task, some: Task, search: Search, few: Columns, offer: Repeated | None, tell: Progress) -> PlansTimed:
    """Make the plans that were requested: the fastest is the one of all plans found here that takes the least time.

    Choices are compared by some of the samples; the plan of the one that is taken is made of all.
    """
    which, parts = task.ready.options.operations, [part_of(tell, k, 3) for k in range(3)]
    printed = [] if which == "fastest" else [_capped(task, thinned(task), "fewest", choices.quicker(task, search, few), parts[0])]
    if which == "fewest":
        return printed, None, (), ()
    choice = choices.fastest_choice(task, some, search, few, parts[1])
    compared = [choice.columns.of(each) for each in (choice.safe, *choices.with_and_without(choice.problem, choice.safe))]
    if len(task.cutters) > 1:
        by_size = choices.largest_first_choice(some, search, few, minor=some is not task)
        compared.append(recommended(some, _worth(some, "fastest", by_size)))
    compared += [_columns_of(task, each) for each in printed]
    plans = [plan_with(some, "fastest", _worth(some, "fastest", each), times=True) for each in compared]
    best, words = _recommended(some, plans)
    unmoved = task, some
    if (motion := flowing(some, partial(chosen_for_others, choice=choice), best)) is not None:
        faces, moving = motion
        words = (_why_in_motion(best, moving, faces),)
        best, task, some = moving, with_moved(task, faces), with_moved(some, faces)
    plan = _capped(task, some, "fastest", _columns_of(task, best), parts[2])
    still = [each for each in plans if not each.moves and few_enough(task, each)]
    # Choices do not know how long the rotary axes take on the way.
    if plan.moves and still and task.indexing.speeds is not None:
        best = min(still, key=lambda each: each.price)
        if best.price < plan.price:
            plan, words = _capped(*unmoved, "fastest", _columns_of(task, best), parts[2]), ()
    quickest = min([plan, *(each for each in printed if few_enough(task, each))], key=lambda each: each.price)
    fastest, notes = as_quick(task, offer, (replace(quickest, name="fastest"), words), printed)
    parts[2](1, 1)
    at_best = float(choice.problem.cost.min(axis=1, initial=np.inf).sum())
    bound = bounded(choice.problem, choice.safe)
    timed = against_bound(fastest.total, bound, at_best, len(choice.problem.cost), len(choice.columns))
    return [*printed, fastest], (timed, choice.area), choices.worths(task, plans), notes


def _recommended(task: Task, plans: Sequence[OperationPlan]) -> tuple[OperationPlan, tuple[str, ...]]:
    """The plan that is recommended as the fastest, and what must be said of it.

    It is the one of all plans that takes the least time; of those with more fixed orientations than are recommended the area of
    some is left to simultaneous motion first.
    """
    best = min(plans, key=lambda each: each.price)
    columns = recommended(task, _columns_of(task, best))
    fixed = best.orientations
    if len(columns) == fixed:
        still = [each for each in plans if not each.moves] if best.moves else []
        sentence = (f"{_with_fixed(min(still, key=lambda each: each.price))}.",) if still else ()
        return replace(best, name="fastest"), sentence
    tried = [plan_with(task, "fastest", columns, times=True), *(each for each in plans if few_enough(task, each))]
    chosen = min(tried, key=lambda each: each.price)
    if few_enough(task, best) and best.price <= chosen.price:
        return replace(best, name="fastest"), ()
    many, why = fixed - sum(each.mode == "fixed" for each in chosen.operations), "it takes less time"
    if not few_enough(task, best):
        why = f"more than {task.ready.options.max_orientations} orientations are not recommended (`--max-orientations`)"
    words = (
        f"With fixed orientations alone, {fixed} of them, the fastest plan would take {duration(best.total)}; simultaneous "
        f"motion is recommended in place of {many}, for {why}."
    )
    return replace(chosen, name="fastest"), (words,) if chosen.moves else ()


def _in_motion(task: Task, quick: PlansTimed) -> PlansTimed:
    """The plan of a part that is a pattern, with free-form faces for simultaneous motion where that costs less."""
    (plan,), timed, worth, words = quick
    columns = _columns_of(task, plan)
    motion = flowing(task, lambda _: columns, plan)
    if motion is None or timed is None:
        return quick
    faces, moving = motion
    made, (entry, area) = plan_with(with_moved(task, faces), plan.name, _columns_of(task, moving)), timed
    if made.price > plan.price:
        return quick
    entry = against_bound(made.total, entry.bound_seconds, entry.at_best_seconds, entry.samples, entry.candidates)
    return [made], (entry, area), worth, (*words, _why_in_motion(plan, made, faces))


def _why_in_motion(fixed: OperationPlan, moving: OperationPlan, faces: Sequence[int]) -> str:
    named = ", ".join(f"F{face}" for face in faces[:_NAMED]) + (f" and {len(faces) - _NAMED} more" if len(faces) > _NAMED else "")
    return (
        f"{named}: simultaneous motion cuts {'it' if len(faces) == 1 else 'each'} as a whole, and the plan takes about "
        f"{duration(moving.total)}. {_with_fixed(fixed)}."
    )


def _with_fixed(plan: OperationPlan) -> str:
    return f"With {count(plan.orientations, 'fixed orientation')} it would take about {duration(plan.total)}"


def _columns_of(task: Task, plan: OperationPlan) -> Columns:
    columns = task.no_columns
    for each in plan.operations:
        if each.axis is not None and each.angle is not None:
            columns = columns.and_(columns_of(each.axis[None], each.angle[None], task.cutters.index(each.cutter), each.setup))
    return columns


def _task(ready: Prepared, everywhere: Sequence[Mapping[Cutter, Verdicts]], least: LeastSet | None) -> Task:
    options = ready.options
    unpriced = without_feed(ready)
    needed = [run.cutter for run in least.runs if run.cutter not in unpriced] if least else []
    barred: dict[Cutter, NDArray[np.bool_]] = {}
    if options.process is not None:
        named = [cutter_of(each.cutter, ready.cutters, f"step {each.number}") for each in options.process.steps]
        named += [cutter_of(each.cutter, ready.cutters, "forbid") for each in options.process.forbidden]
        cutters = considered(
            [each for each in ready.cutters if each not in unpriced], [*dict.fromkeys([*needed, *named])], _CUTTERS
        )
    else:
        cutters = considered(comparable(ready, least), needed, _CUTTERS)
        ready, everywhere = _finished_first(ready, everywhere, cutters)
        if options.operations != "fewest":
            barred = _for_chamfers(ready, [each for each in ready.cutters if each not in (*cutters, *unpriced)])
            cutters = tuple(each for each in ready.cutters if each in cutters or each in barred)
            everywhere = [{c: _without(v, barred[c]) if c in barred else v for c, v in each.items()} for each in everywhere]
    open_ = ready.machinable
    reached = np.logical_or.reduce(
        [open_[s] & verdicts[cutter].reached for s, verdicts in enumerate(everywhere) for cutter in cutters]
    )
    probes = Probes(
        ready.samples, cutters, ready.setups, open_, {cutters.index(each): rows for each, rows in barred.items()}, everywhere
    )
    extents = Extents(ready.samples, ready.conditions.obstacles, ready.conditions.jobs)
    machine = ready.conditions.machine
    paths = Paths(
        options.scallop, options.stepover, feeds(options, cutters), options.accuracy, extents, options.link_time,
        machine.acceleration,
    )  # fmt: skip
    where = tuple(Orientations.of(conditions) for conditions in ready.setups)
    indexing = Indexing(where, options.index_time)
    moving = MovingAxes(ready.samples, cutters, ready.setups, everywhere, paths)
    return Task(
        ready, cutters, where, tuple(everywhere), np.flatnonzero(reached), probes, paths, indexing, Walls(probes, paths),
        moving, Seams.of(ready), flowing_faces(ready),
    )  # fmt: skip


def _finished_first(
    ready: Prepared, everywhere: Sequence[Mapping[Cutter, Verdicts]], cutters: Sequence[Cutter]
) -> tuple[Prepared, Sequence[Mapping[Cutter, Verdicts]]]:
    """Leave what a setup grips and stands on to the setups before it, as far as the cutters reach it there: nobody closes jaws on
    half a face."""
    open_, others, left = ready.machinable, list(ready.others), list(everywhere)
    for k in range(1, len(left)):
        before = np.logical_or.reduce([open_[s] & everywhere[s][cutter].reached for s in range(k) for cutter in cutters])
        before &= np.isin(ready.samples.face, list(held_faces(ready, k))) | ready.others[k - 1].clamped
        for s in range(k, len(left)) if before.any() else ():
            others[s - 1] = replace(others[s - 1], clamped=others[s - 1].clamped | before)
            left[s] = {cutter: _without(each, before) for cutter, each in left[s].items()}
    return replace(ready, others=tuple(others)), left


def _without(verdicts: Verdicts, rows: NDArray[np.bool_]) -> Verdicts:
    """Verdicts that reach none of some samples (n,)."""
    return replace(verdicts, verdict=np.where(rows & verdicts.reached, INACCESSIBLE, verdicts.verdict).astype(np.uint8))


def _for_chamfers(ready: Prepared, cutters: Sequence[Cutter]) -> dict[Cutter, NDArray[np.bool_]]:
    """The chamfer cutter with the widest flank that lies along some chamfers of the part as this stands, with the samples (n,)
    at which it is not to be planned, which are all others: a shop cuts nothing else with it."""
    for cutter in sorted((c for c in cutters if c.shape == "end" and c.taper > 0.0), key=top_radius, reverse=True):
        along = np.logical_or.reduce([along_flank(ready.samples.normal, each.setup, cutter) for each in ready.setups])
        if (along := along & ready.finished).any():
            return {cutter: ~along}
    return {}


def _first(task: Task, spacing: float = STEP) -> Columns:
    """The first candidates of all cutters and setups, with a grid of a spacing, rad."""
    columns = task.no_columns
    for s, where in enumerate(task.orientations):
        angle, axis = candidates(where, task.ready.samples, task.ready.options.index_step, spacing)
        for c in range(len(task.cutters)):
            columns = columns.and_(columns_of(axis, angle, c, s))
    return columns


def _stored(task: Task, rows: Rows) -> Columns:
    """Columns of the postures that were found for samples, rounded as a control shows them."""
    columns = task.no_columns
    if task.ready.options.index_step is not None:
        return columns
    for s, verdicts in enumerate(task.everywhere):
        for c, cutter in enumerate(task.cutters):
            mine = rows[verdicts[cutter].reached[rows]]
            angle, axis = task.orientations[s].near(verdicts[cutter].axis[mine])
            distinct = apart(axis)
            columns = columns.and_(columns_of(axis[distinct], angle[distinct], c, s))
    return columns


def _capped(task: Task, some: Task, name: str, columns: Columns, tell: Progress) -> OperationPlan:
    """The plan of columns that are worth an orientation; by some samples first, so that few columns are tested at all."""
    if not len(columns):
        return plan_with(task, name, columns)
    columns = _worth(task, name, _canonical(task, some, _worth(some, name, columns), tell))
    if name == "fewest":
        return plan_with(task, name, choices.accompanied(task, columns))
    return plan_with(
        task, name, choices.instead_of_motion(task, columns, lambda rows: _first(task, choices.COARSE).and_(_stored(task, rows)))
    )


def _canonical(task: Task, some: Task, columns: Columns, tell: Progress) -> Columns:
    """Canonical orientations in place of columns, by some samples, and by those that these leave and the columns do not."""
    for k in range(_AGAIN if some is not task else 0):
        tried = canonical(some, columns, progress=part_of(tell, k, _AGAIN + 1))
        rest = task.rows[~np.isfinite(costs_with(task, tried)[1]).any(axis=1)]
        unserved = rest[np.isfinite(costs_with(at_some(task, rest), columns)[1]).any(axis=1)]
        if not len(unserved):
            return tried
        some = at_some(task, np.union1d(some.rows, unserved[:: 1 + len(unserved) // _AT_ONCE]))
    return canonical(task, columns, progress=part_of(tell, _AGAIN, _AGAIN + 1))


def _worth(task: Task, name: str, columns: Columns) -> Columns:
    """Those columns that are worth an orientation, as many as were requested at most."""
    most = task.ready.options.most_operations
    timed = most is None and name != "fewest"
    selected = worth_their_turn(task, columns) if timed else best_area(task, columns, most)
    return selected if len(selected) < len(columns) else columns
