"""The tools of a whole shop in sentences."""

from collections.abc import Sequence

from plan_cutters.batch.summary import LeastTools, Summary
from plan_cutters.plan_file.numbers import count

#: Tools that a sentence names.
_NAMED = 8


def shop_lines(summary: Summary) -> list[str]:
    """Say which tool finishes most parts, which are the fewest for all parts that are finished, and which are never used."""
    shop, parts = summary.shop, summary.parts
    if not shop.tools:
        return []
    best = shop.tools[0]
    lines = [
        f"{best.tool} finishes {best.alone:,} of {count(parts.count, 'part')} alone, more than any other tool does."
        if best.alone and (len(shop.tools) < 2 or shop.tools[1].alone < best.alone)
        else f"{best.tool} finishes {best.alone:,} of {count(parts.count, 'part')} alone; no tool finishes more."
        if best.alone
        else "No tool finishes a part alone."
    ]
    if shop.least is None:
        lines.append("No tools finish a part together beyond doubt.")
    else:
        lines.append(_least(shop.least))
    if shop.never_used:
        lines.append(f"In no plan: {_listed(shop.never_used)}.")
    return lines


def _least(least: LeastTools) -> str:
    one = len(least.tools) == 1
    parts = "the one part" if least.parts == 1 else f"all {least.parts:,} parts"
    who = "One tool finishes" if one else f"{len(least.tools)} tools finish"
    text = f"{who} {parts} that can be finished beyond doubt: {_listed(least.tools)}"
    if one:
        return f"{text}."
    if least.proven:
        return f"{text}. No fewer do (proved)."
    doubt = f"whether fewer than {len(least.tools)} do, the plans do not state"
    return f"{text}. At least {count(least.at_least, 'tool')} must be there (proved); {doubt}."


def _listed(names: Sequence[str]) -> str:
    rest = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {rest} more" if rest > 0 else "")
