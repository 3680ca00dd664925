"""Which cutters a plan of operations had to compare, from the plan and its samples alone."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Cutters that are compared, at most, unless more are needed.
_CUTTERS = 4


def compared(
    document: Mapping[str, Any], ids: list[str], reached: Mapping[str, NDArray[np.bool_]], tried: set[str] | None = None
) -> list[str]:
    """The ids of the cutters that a plan compares: those that its least set and its own steps need, and others by rank.

    A cutter of a kind that comes last on the part's faces may be left out where the others reach all without it.

    Parameters
    ----------
    document : mapping
        plan.json.
    ids : list of str
        All that were judged, by rank.
    reached : mapping
        Samples (n,) that each of them reaches.
    tried : set of str, optional
        Those that have candidates, where the plan has any.
    """
    process, written = document["effective"].get("process"), document["operations"]
    named = (document.get("least_set") or {"runs": []})["runs"]
    named = named if process is None else [*named, *process["step"], *process["forbid"]]
    needed = list(dict.fromkeys(each["cutter"] for each in named))
    wanted = [*needed, *(each for each in ids if each not in needed)][: max(_CUTTERS, len(needed))]
    fed = written["assumed"]["feed_mm_min"]
    kind = {each["id"]: each.get("group") for each in document["cutters"]}
    late = {each for each in ids if tried is not None and each not in tried and kind[each] not in {kind[one] for one in needed}}
    others = [each for each in ids if each in wanted and (each in needed or (each not in late and (not fed or each in fed)))]
    whole = np.logical_or.reduce([reached[each] for each in others]) if others else np.zeros(0, bool)
    spared = [each for each in wanted if each not in others]
    if others and all(not (reached[each] & ~whole).any() for each in spared):
        return others
    return [each for each in ids if each in wanted]
