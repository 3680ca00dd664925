"""The tools of a whole shop in sentences."""

from collections.abc import Sequence

from plan_cutters.domain.figures import count
from plan_cutters_batch.summary import LeastTools, Summary

#: Tools that a sentence names.
_NAMED = 8


def shop_lines(summary: Summary) -> list[str]:
    """Say which tools finish most parts, which are the fewest for all parts that are finished, and which are never used."""
    shop, parts = summary.shop, summary.parts
    if not shop.tools:
        return []
    best = [each.tool for each in shop.tools if each.alone == shop.tools[0].alone]
    lines = [
        f"Finishes most parts alone: {_listed(best)}, {shop.tools[0].alone:,} of {parts.count:,}{' each' * (len(best) > 1)}."
        if shop.tools[0].alone
        else "No tool finishes a part alone."
    ]
    lines.append("No tools finish a part together beyond doubt." if shop.least is None else _least(shop.least))
    if shop.never_used:
        lines.append(f"In no plan: {_listed(shop.never_used)}.")
    return lines


def _least(least: LeastTools) -> str:
    parts = "the one part" if least.parts == 1 else f"all {least.parts:,} parts"
    names = _listed(least.tools)
    if len(least.tools) == 1:
        return f"One tool finishes {parts} that can be finished beyond doubt: {names}."
    text = f"Fewest tools for {parts} that can be finished beyond doubt, {len(least.tools)}: {names}"
    if least.proven:
        return f"{text}. No fewer do (proved)."
    doubt = f"whether fewer than {len(least.tools)} do, the plans do not state"
    return f"{text}. At least {count(least.at_least, 'tool')} must be there (proved); {doubt}."


def _listed(names: Sequence[str]) -> str:
    rest = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {rest} more" if rest > 0 else "")
