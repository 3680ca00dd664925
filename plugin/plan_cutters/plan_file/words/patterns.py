"""Say which faces are equal, and that they were judged once."""

import re
from collections.abc import Iterator

from plan_cutters.domain.figures import count, ranges
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.patterns import PatternEntry

#: Copies from which on a pattern stands in the summary; faces that are named; patterns that are listed.
_COPIES, _NAMED, _LISTED = 3, 24, 3


def patterns(plan: Plan) -> Iterator[str]:
    """Sentences on the patterns of a plan, those with most faces first."""
    largest = sorted(plan.patterns, key=lambda each: (not each.whole, -sum(map(len, each.faces))))[:_LISTED]
    # The same faces may be equal in two mirrors.
    yield from dict.fromkeys(map(_sentence, largest))
    if len(plan.patterns) > len(largest):
        yield f"{len(plan.patterns) - len(largest)} more patterns of equal faces are in plan.json."


def in_summary(plan: Plan) -> str:
    """The sentence on what was judged once or is repeated; empty where that is not worth a line."""
    whole = [each for each in plan.patterns if each.whole and each.kind == "rotation" and each.order >= _COPIES and each.faces]
    if whole:
        return _sentence(max(whole, key=lambda each: each.order))
    targets = set(plan.effective.target_faces)
    shares = [(len(targets.intersection(_names(each))), each) for each in plan.patterns if not each.whole]
    best = max(shares, key=lambda each: each[0], default=None)
    return _sentence(best[1]) if best is not None and 2 * best[0] >= len(targets) else ""


def _names(each: PatternEntry) -> list[str]:
    """Its faces, one after the other: some may be in several copies."""
    return list(dict.fromkeys(name for copy in each.faces for name in copy))


def _sentence(each: PatternEntry) -> str:
    """One pattern, and what was done with it."""
    names = _names(each)
    few = names if len(names) <= _NAMED else names[:1]
    # A file may have any words there.
    numbered = all(re.fullmatch(r"F\d{1,9}", name) for name in few)
    listed = ranges(int(name[1:]) for name in few) if numbered else ", ".join(few)
    more = f" and {len(names) - 1} more" if len(names) > _NAMED else ""
    per = len(each.faces[0]) if each.faces else 0
    what = "equal faces" if per <= 1 else f"equal groups of {per} faces"
    if each.kind == "mirror":
        text = f"{listed}{more} are equal in a mirror" if names else "The part is its own mirror image"
    elif each.kind == "rotation":
        text = f"{listed}{more} are {each.order} {what}, {360.0 / each.order:.4g} deg apart"
    else:
        text = f"{listed}{more} are {each.order} {what}, shifted"
    return f"{text}{_judged(each)}."


def _judged(each: PatternEntry) -> str:
    if each.moved or each.followed:
        return ": judged once" + (f", verified at {count(each.verified, 'sample')}" if each.verified else "")
    return ""
