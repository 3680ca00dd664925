"""How cutters are called where people read: in the summary, on the page and on pictures."""

import re
from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plan_cutters.document.model import Plan

#: Numbers in the tool changer that are named of one cutter.
_PLACES = 3


def short_names(plan: "Plan") -> dict[str, str]:
    """How cutters are called in a line, by their ids: as a library does, or without the holder, where that tells them apart."""
    listed, heads = {}, {}
    for c in plan.cutters:
        numbers = dict.fromkeys(f"T{s.number}" for s in c.sources if s.number is not None)
        listed[c.id] = " ".join([*list(numbers)[:_PLACES], c.name]) if c.sources and c.name else c.id
        heads[c.id] = c.id.partition("H")[0]
    said, dimensions = Counter(listed.values()), Counter(heads.values())
    return {
        name: listed[name] if said[listed[name]] == 1 and listed[name] != name
        else heads[name] if dimensions[heads[name]] == 1 else name
        for name in heads
    }  # fmt: skip


def named(plan: "Plan", text: str) -> str:
    """A text with cutters called as in `short_names`."""
    names = short_names(plan)
    # The longest first: an id may begin as another one does.
    ids = "|".join(re.escape(name) for name in sorted(names, key=len, reverse=True))
    # Nor is it the beginning of another cutter's, which is not of this plan.
    return re.sub(rf"(?<!\w)(?:{ids})(?!\w|[.:]\d|\+R)", lambda found: names[found[0]], text)
