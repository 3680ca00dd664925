"""Which of the given cutters and setups reach together all that any of them reaches: the fewest, found from what is known."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from plan_cutters.answers.areas import Finished
from plan_cutters.domain.answers import essential_rows
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.preference import NEARLY_ALL, group_of, rank
from plan_cutters.domain.verdicts import ANOTHER_SETUP, FIXTURE, Verdicts
from plan_cutters.outcome import LeastSet, Run
from plan_cutters.plan_file.answers import LeastSetEntry, RunEntry
from plan_cutters.scene.preparation import Prepared, stood_on

#: Seconds that the proof may take; then the best set found so far is told as such.
_SECONDS = 10.0


def least_set(ready: Prepared, everywhere: Sequence[Mapping[Cutter, Verdicts]]) -> LeastSet | None:
    """Find the fewest runs, a cutter in a setup each, that reach all that any of them reaches of the finished surface.

    `everywhere`: what each cutter reaches in each setup, the first one first. None where one cutter was judged in one setup. What
    stands on the table of a proposed setup chooses no kind of cutter that comes later: it is left for another setup.
    """
    cutters = [cutter for cutter in ready.cutters if cutter in everywhere[0]]
    if len(cutters) * len(everywhere) < 2:
        return None
    finished = Finished.of(ready)
    columns = [(s, c) for s in range(len(everywhere)) for c in range(len(cutters))]
    reached = np.stack([everywhere[s][cutters[c]].reached & finished.wanted for s, c in columns], axis=1)
    open_ = _on_a_proposed_table(ready, [[verdicts[cutter] for verdicts in everywhere] for cutter in cutters])
    chosen, proven = by_kind(reached & ~open_[:, None], columns, cutters, ready.chosen.free_form)
    if open_.any() and chosen:
        # What is left goes with more runs, of cutters of kinds no less wanted.
        place = [rank(group_of(cutter), free_form=ready.chosen.free_form) for cutter in cutters]
        worst = max(place[columns[k][1]] for k in chosen)
        usable = [k for k, (_, c) in enumerate(columns) if place[c] <= worst]
        rest = reached[:, usable] & ~np.asarray(reached[:, chosen].any(axis=1))[:, None]
        more, _ = cover(rest, [columns[k][0] for k in usable], [columns[k][1] for k in usable])
        chosen = sorted({*chosen, *(usable[k] for k in more)})
    whole, done = reached[:, chosen], np.zeros(len(reached), bool)
    entries = list[RunEntry]()
    for k, column in enumerate(chosen):
        s, c = columns[column]
        mine = np.flatnonzero(reached[:, column] & ~done)
        done[mine] = True
        entries.append(RunEntry(
            cutter=cutters[c].id, setup=ready.axes[s][0], samples=len(mine), area_mm2=float(finished.area[mine].sum()),
            share=finished.of_rows(mine), faces=[f"F{n}" for n in np.unique(ready.samples.face[mine]).tolist()],
            alone=int((whole[:, k] & (whole.sum(axis=1) == 1)).sum()),
        ))  # fmt: skip
    open_rows = np.flatnonzero(finished.wanted & ~done)
    entry = LeastSetEntry(
        runs=entries, reached=int(done.sum()), left=len(open_rows), share=finished.of_rows(np.flatnonzero(done)),
        left_share=finished.of_rows(open_rows), proven=proven, doubtful=ready.conditions.surroundings.doubtful,
    )  # fmt: skip
    return LeastSet(entry, tuple(Run(cutters[c], s) for s, c in (columns[column] for column in chosen)))


def by_kind(
    reached: NDArray[np.bool_], columns: Sequence[tuple[int, int]], cutters: Sequence[Cutter], free_form: float
) -> tuple[list[int], bool]:
    """The fewest runs of the most wanted kinds, then those of other kinds for what these leave.

    Engraving, chamfer and form cutters come after all others; where nearly all faces are free-form (`free_form` is their share of
    the area), flat ends come after round ones, too.
    """
    place = np.array([rank(group_of(cutters[c]), free_form=free_form) for _, c in columns])
    if free_form < NEARLY_ALL:
        place = np.where(place == rank("last", free_form=free_form), 1, 0)
    chosen, proven = list[int](), True
    for each in np.unique(place).tolist():
        mine, done = np.flatnonzero(place == each).tolist(), np.asarray(reached[:, chosen].any(axis=1))
        more, sure = cover(reached[:, mine] & ~done[:, None], [columns[k][0] for k in mine], [columns[k][1] for k in mine])
        chosen, proven = sorted([*chosen, *(mine[k] for k in more)]), proven and sure
    return chosen, proven


def _on_a_proposed_table(ready: Prepared, verdicts: Sequence[Sequence[Verdicts]]) -> NDArray[np.bool_]:
    """Samples (n,) that some cutter loses in all setups to the table of one that was proposed, on which their face stands.

    That table is not there yet, so these choose no cutter; `verdicts` are those of each cutter in each setup.
    """
    stood, unreached = stood_on(ready), np.zeros(len(ready.samples), bool)
    if stood.any():
        for each in verdicts:
            fixture = np.logical_or.reduce([np.isin(one.reason, (FIXTURE, ANOTHER_SETUP)) for one in each])
            unreached |= fixture & np.logical_and.reduce([one.not_reached for one in each])
    return np.asarray(stood & unreached)


def cover(reached: NDArray[np.bool_], setup: Sequence[int], rank: Sequence[int]) -> tuple[list[int], bool]:
    """The fewest columns that cover every row that any column covers.

    `reached` (n, m) bool: which of n samples each of m runs reaches. `setup`, `rank`: of each run: its setup, and its cutter's
    rank, 0 for the most wanted. Of covers with as few runs that in the fewest setups is taken, and of these the one with the
    least sum of ranks. Returns `chosen`: ascending; `proven`: whether no fewer do.

    >>> cover(np.array([[1, 0, 1], [0, 1, 1], [1, 1, 0]], bool), [0, 0, 0], [0, 1, 2])
    ([0, 1], True)
    >>> cover(np.zeros((3, 2), bool), [0, 0], [0, 1])
    ([], True)
    """
    rows = np.unique(reached[reached.any(axis=1)], axis=0)
    if not len(rows):
        return [], True
    alone = np.flatnonzero(rows.all(axis=0))
    if len(alone):
        return [min(alone.tolist(), key=lambda k: (rank[k], setup[k]))], True
    return _cover(rows[essential_rows(rows)], setup, rank)


def _cover(rows: NDArray[np.bool_], setup: Sequence[int], rank: Sequence[int]) -> tuple[list[int], bool]:
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import csr_array

    m, (places, place) = len(setup), np.unique(np.asarray(setup), return_inverse=True)
    # Runs, then setups that are used; one of either kind less is worth more than all that comes after it.
    least = 1.0 + sum(rank)
    cost = np.concatenate([least * (1.0 + len(places)) + np.array(rank, float), np.full(len(places), least)])
    # A run needs its setup.
    held = np.block([[rows, np.zeros((len(rows), len(places)))], [-np.eye(m), np.eye(len(places))[place]]])
    low = np.repeat([1.0, 0.0], [len(rows), m])
    solution = milp(cost, integrality=np.ones(len(cost)), bounds=Bounds(0, 1),
                    options={"time_limit": _SECONDS, "mip_rel_gap": 0.0},
                    constraints=LinearConstraint(csr_array(held), low, np.inf))  # fmt: skip
    chosen = [] if solution.x is None else np.flatnonzero(solution.x[:m] > 0.5).tolist()
    covers = bool(rows[:, chosen].any(axis=1).all())
    return (chosen, solution.status == 0) if covers else (_greedy(rows, rank), False)


def _greedy(rows: NDArray[np.bool_], rank: Sequence[int]) -> list[int]:
    """A cover, not the least: always the run that covers most of what is left."""
    chosen = list[int]()
    while len(rows):
        chosen.append(int(np.lexsort((rank, -rows.sum(axis=0)))[0]))
        rows = rows[~rows[:, chosen[-1]]]
    return sorted(chosen)
