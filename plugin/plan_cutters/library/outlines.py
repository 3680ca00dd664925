"""Outlines of holders and shafts with as few sections as enclose them: what is left out is never air where there is steel."""

from collections.abc import Sequence
from itertools import pairwise

from plan_cutters.domain.holder import Segment
from plan_cutters.domain.shapes import SAME

#: Digits of lengths and radii, mm; see `listed`.
_DIGITS = 9


def joined(stages: Sequence[Segment]) -> tuple[Segment, ...]:
    """The same outline, with what goes on straight in one section."""
    return _merged(stages, 0, SAME)[0]


def fewer(stages: Sequence[Segment], most: int) -> tuple[tuple[Segment, ...], float]:
    """At most so many sections that enclose the given ones, and by how much they are wider at most, mm."""
    return _merged(stages, max(1, most), SAME)


def _merged(stages: Sequence[Segment], most: int, free: float) -> tuple[tuple[Segment, ...], float]:
    # Each section with what it stands for, so that what is added is measured against the truth.
    merged = [(stage, [stage]) for stage in stages]
    worst = 0.0
    both = [_enclosing([*a, *b]) for (_, a), (_, b) in pairwise(merged)]
    while len(merged) > 1:
        i = min(range(len(both)), key=lambda k: both[k][1])
        stage, added = both[i]
        if added > free and (most == 0 or len(merged) <= most):
            break
        worst = max(worst, added)
        merged[i : i + 2] = [(stage, [*merged[i][1], *merged[i + 1][1]])]
        del both[i]
        # Only what it now stands beside is new.
        for k in (i - 1, i):
            if 0 <= k < len(both):
                both[k] = _enclosing([*merged[k][1], *merged[k + 1][1]])
    return tuple(stage for stage, _ in merged), worst if worst > free else 0.0


def _enclosing(stages: Sequence[Segment]) -> tuple[Segment, float]:
    """One section around several, a cone or a cylinder, and by how much it is wider at most, mm."""
    length = round(sum(stage.length for stage in stages), _DIGITS)
    corners, at = [], 0.0
    for stage in stages:
        corners += [(at, stage.radius), (at + stage.length, stage.upper_radius)]
        at += stage.length
    wide = max(r for _, r in corners)
    cylinder = Segment(wide, length), wide - min(r for _, r in corners)
    low, high = corners[0][1], corners[-1][1]
    over = [low + (high - low) * z / at - r for z, r in corners]
    if min(over) < -SAME or max(over) >= cylinder[1]:
        return cylinder
    return Segment(low, length, high), max(over)


def up_to(stages: Sequence[Segment], length: float) -> tuple[Segment, ...]:
    """Sections from the bottom up, those beyond a height cut off there."""
    segments, at = [], 0.0
    for stage in stages:
        remaining = length - at
        if remaining <= SAME:
            break
        if stage.length <= remaining + SAME:
            segments.append(stage)
        else:
            upper = stage.radius + stage.slope * remaining
            segments.append(Segment(stage.radius, round(remaining, _DIGITS), round(upper, _DIGITS)))
        at += stage.length
    return tuple(segments)
