"""The tools of a whole shop: which ones finish how many parts, the fewest for all parts, and those that no plan uses."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from plan_cutters_batch.row import PartTools

#: Seconds that each of the two searches may take; then the best set so far is reported, with the bound that is proved by then.
_SECONDS = 10.0


class Fewest(NamedTuple):
    """The fewest tools that the plans state to finish all parts together."""

    #: Ids, the one that finishes most parts alone first.
    tools: tuple[str, ...]
    #: No fewer finish all of the parts, however they would share faces: a proved lower bound.
    at_least: int

    @property
    def proven(self) -> bool:
        """Whether it is proved that no fewer do."""
        return len(self.tools) <= self.at_least


class _Row(NamedTuple):
    """A condition: the columns, each times its factor, sum up to `least` or more."""

    factors: dict[int, float]
    least: float


def fewest(parts: Sequence[PartTools]) -> Fewest:
    """Find the fewest tools for all parts that are finished.

    A set counts as finishing a part if the plan says so: a tool that does so alone, the tools of its process or of its least set,
    or tools of which one reaches each face whole. Tools that share a face in some other way might do as well; the plans do not
    state it, so the lower bound allows for it: whatever finishes a part has on each face a tool that reaches it whole, or two
    that reach some of it. Parts that are not finished are left out.

    Examples
    --------
    >>> a = PartTools(names={}, finished=True, alone=("D6", "D8"))
    >>> b = PartTools(names={}, finished=True, alone=("D8",))
    >>> fewest([a, b]), fewest([a, b]).proven
    (Fewest(tools=('D8',), at_least=1), True)
    >>> fewest([])
    Fewest(tools=(), at_least=0)
    """
    different = list(
        {_key(part): part for part in parts if part.finished and (part.alone or part.together or part.faces)}.values()
    )
    if not different:
        return Fewest((), 0)
    alone = Counter(name for part in parts for name in part.alone)
    used = Counter(name for part in parts for name in part.used)
    names = alone.keys() | {name for part in different for name in _names(part)}
    tools = sorted(names, key=lambda name: (-alone[name], -used[name], name))
    place = {name: k for k, name in enumerate(tools)}
    rows, columns = _stated(different, place)
    # Of sets of as many, the one of the tools that finish most parts alone.
    cost = [1.0 + k / (1.0 + len(tools) ** 2) for k in range(len(tools))]
    values, _ = _least(cost + [0.0] * (columns - len(tools)), rows)
    chosen = None if values is None else {name for name, k in place.items() if values[k] > 0.5}
    if chosen is None or not all(part.finished_by(chosen) for part in different):
        chosen = _greedy(different)
    _, bound = _least([1.0] * len(tools), [row for part in different for row in _bounding(part, place)])
    return Fewest(tuple(sorted(chosen, key=place.__getitem__)), max(1, math.ceil(bound - 1e-6)))


def _key(part: PartTools) -> tuple[object, ...]:
    return frozenset(part.names), frozenset(part.alone), frozenset(map(frozenset, part.together)), frozenset(part.faces)


def _names(part: PartTools) -> set[str]:
    # Those that the plan states of no set as well: they might be in one.
    return set().union(part.names, part.alone, *part.together, *((*face.whole, *face.partly) for face in part.faces))


def _stated(parts: Sequence[PartTools], place: dict[str, int]) -> tuple[list[_Row], int]:
    """The conditions under which tools finish all parts as their plans state it, and the number of columns.

    After the tools come columns for the sets of a part that are used whole.
    """
    rows, columns = dict[tuple[frozenset[tuple[int, float]], float], _Row](), len(place)

    def add(row: _Row) -> None:
        rows[frozenset(row.factors.items()), row.least] = row

    for part in parts:
        mine: set[int] = set()
        for names in part.together:
            if not set(names) & set(part.alone):
                for name in names:
                    add(_Row({place[name]: 1.0, columns: -1.0}, 0.0))
                mine.add(columns)
                columns += 1
        mine |= {place[name] for name in part.alone}
        for whole in {face.whole for face in part.faces} or {()}:
            add(_Row(dict.fromkeys(mine | {place[name] for name in whole}, 1.0), 1.0))
    return list(rows.values()), columns


def _bounding(part: PartTools, place: dict[str, int]) -> list[_Row]:
    """Conditions that hold for whatever finishes a part: one tool that does all of it, or two that do some."""
    pairs = [(set(part.alone), _names(part)), *((set(face.whole), set(face.partly)) for face in part.faces)]
    return [_Row({place[name]: 2.0 if name in whole else 1.0 for name in sorted(whole | partly)}, 2.0) for whole, partly in pairs]


def _greedy(parts: Sequence[PartTools]) -> set[str]:
    """A set that finishes all parts, not the fewest: for each part the smallest set that its plan states."""
    chosen: set[str] = set()
    for part in parts:
        if not part.finished_by(chosen):
            sets = [{name} for name in part.alone] + [set(each) for each in part.together]
            chosen |= min(sets, key=len) if sets else {face.whole[0] for face in part.faces}
    return chosen


def _least(cost: Sequence[float], rows: Sequence[_Row]) -> tuple[Sequence[float] | None, float]:
    """The values 0 or 1 of least cost under conditions, None where none were found in time; and a proved bound of that cost."""
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import coo_array

    entries = [(i, k, factor) for i, row in enumerate(rows) for k, factor in row.factors.items()]
    i, k, factors = zip(*entries, strict=True)
    table = coo_array((factors, (i, k)), shape=(len(rows), len(cost))).tocsr()
    solution = milp(
        list(cost),
        integrality=[1] * len(cost),
        bounds=Bounds(0, 1),
        options={"time_limit": _SECONDS, "mip_rel_gap": 0.0},
        constraints=LinearConstraint(table, [row.least for row in rows], math.inf),
    )
    bound = solution.fun if solution.status == 0 else solution.mip_dual_bound
    return solution.x, float(bound) if bound is not None and math.isfinite(bound) else 0.0
