"""Another cutter may serve: held further out, as far as is usual, a thinner one that is sold, or one with another corner.

Lemmas W3 and W4 of `docs/what_if_proof.md`.
"""

import math
from dataclasses import replace

import numpy as np

from plan_cutters.answers.trial import Case, StillMissed, Trials
from plan_cutters.answers.what_if import Way, WhatIf, none
from plan_cutters.domain.change import NO_USUAL, Change
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import flute_length
from plan_cutters.domain.spec import notation
from plan_cutters.domain.standard_tools import MOST, USUAL, corners, is_standard, slenderness, smaller
from plan_cutters.errors import CutterError
from plan_cutters.plan_file.words import change_text
from plan_cutters.scene.preparation import Prepared

#: Steps of the stick-out, mm.
GRAIN = 0.01


def stick_out(case: Case, trials: Trials) -> WhatIf | Change:
    """Try the least length from the tip to the holder's nose, the flutes as they are; to `GRAIN`."""
    cutter, not_reached = case.cutter, len(trials.not_reached)
    now, how = cutter.length, notation(cutter.name)
    if cutter.holder is None:
        return none("stick_out", now, not_reached, "no holder is stated, and a longer cutter only adds to what is in the way")
    high, usual = highest(case.ready, cutter), MOST * 2.0 * cutter.radius
    if high < now + GRAIN:
        return none("stick_out", now, not_reached, f"its {how.mm(now)} already hold the holder above all obstacles")

    def make(length: float) -> Case | None:
        return _with(case, longer(cutter, length))

    def unusual(rest: StillMissed) -> bool:
        """Whether more is reached with a longer stick-out than any that is usual."""
        beyond = make(high) if usual < high else None
        return beyond is not None and StillMissed.by(beyond, trials.not_reached).count < rest.count

    most = math.floor((min(high, usual) - now) / GRAIN + 1e-6)
    if most < 1:
        rest = StillMissed.by(case, trials.not_reached)
        why = f"{NO_USUAL}: its {how.mm(now)} are {slenderness(cutter):.3g} D, and up to {change_text.usual(cutter)}"
        return none("stick_out", now, rest.count, why if unusual(rest) else f"{rest.words} at every stick-out", rest.looked)
    way = Way(most, lambda at: round(now + at * GRAIN, 6))
    if (end := make(way.value(most))) is None:
        return none("stick_out", now, not_reached, "no shank can go on above it")

    def fails(_: Case, rest: StillMissed) -> str:
        if not rest.count:
            return "where the holder is out of the way, something else is"
        return (
            f"{NO_USUAL}: with {change_text.usual(cutter)} {rest.words}" if unusual(rest) else f"{rest.words} at every stick-out"
        )

    return WhatIf(
        now=now, ways=[way], make=make, ends=[end], nested=True, reads=lambda end: end.cutter.length, fails=fails,
        serves=lambda requested, made: (change_text.stick_out(requested, cutter), {"cutters": (made.cutter,)}),
    )  # fmt: skip


def highest(ready: Prepared, cutter: Cutter) -> float:
    """Give a stick-out with which the nose is above all obstacles wherever the cutter touches them, mm."""
    each = [conditions.obstacles.triangles.vertex for conditions in ready.setups]
    size = max(float(np.linalg.norm(vertex.max(axis=(0, 1)) - vertex.min(axis=(0, 1)))) for vertex in each)
    return size + 2.0 * cutter.radius + flute_length(cutter) + (cutter.clearance or 0.0)


def radius(case: Case, trials: Trials) -> WhatIf | Change:
    """Try the thinner ones of the same kind that are sold, the largest first, each with its own flutes and a usual stick-out."""
    cutter, conditions, not_reached = case.cutter, case.ready.conditions, len(trials.not_reached)
    now, how = cutter.radius, notation(cutter.name)
    sold = [[each for each in smaller(cutter, ratio) if conditions.judges(each)] for ratio in (USUAL, MOST)]
    if not any(sold):
        why = "no thinner one like it is sold in a usual size that fits its holder and could be judged"
        return none("radius", now, not_reached, why)
    ends = [replace(case, cutter=tools[-1]) for tools in sold if tools]
    return WhatIf(
        now=now, make=lambda made: replace(case, cutter=made), ends=ends, reads=lambda end: end.cutter.radius,
        ways=[Way(len(tools), [cutter, *tools].__getitem__, last_resort=k > 0) for k, tools in enumerate(sold)],
        fails=lambda end, rest: f"with {how.size(end.cutter.radius)}, the thinnest tried, {rest.words}" if rest.count else
        f"none of {len(sold[0])} usual sizes down to {how.size(end.cutter.radius)} serves all samples",
        serves=lambda made, _: (change_text.tool(made), {"cutters": (made,)}), value_of=lambda made: made.radius,
    )  # fmt: skip


def corner_radius(case: Case, trials: Trials) -> WhatIf | Change:
    """Try another usual corner on the same: on a bull nose, or in place of a flat end, there a ball, too;
    the nearest that serves is taken."""
    cutter = case.cutter
    now, r, how = cutter.corner_radius, cutter.radius, notation(cutter.name)
    if cutter.shape != "end":
        return none("corner_radius", now, len(trials.not_reached), f"a {cutter.shape} has no corner to change alone")

    if now == r:
        return none("corner_radius", now, len(trials.not_reached), "a ball end stays a ball end")
    if not is_standard(cutter):
        return none("corner_radius", now, len(trials.not_reached), "no cutter of its diameter is sold in a usual size")

    def make(corner: float) -> Case | None:
        return _with(case, made_of(cutter, corner_radius=corner))

    # A bull nose stays one; a flat end asks for a rounder one.
    kinds = {c for c in corners(cutter) if c < r} | (set() if now else {r})
    wanted = sorted(kinds - {now}, key=lambda c: (abs(c - now), c))
    ends = [made for corner in wanted if (made := make(corner)) is not None]
    if not ends:
        return none("corner_radius", now, len(trials.not_reached), "its flutes are too short for any other corner")
    values = [now, *(end.cutter.corner_radius for end in ends)]

    return WhatIf(
        now=now, ways=[Way(len(ends), values.__getitem__)], make=make, ends=ends, reads=lambda end: end.cutter.corner_radius,
        fails=lambda end, rest: f"with {how.mm(end.cutter.corner_radius)}, the best of {len(ends)} tried, {rest.words}"
        if rest.count else f"each of {len(ends)} corner radii tried loses some samples",
        serves=lambda requested, made: (change_text.corner_radius(requested, cutter), {"cutters": (made.cutter,)}),
    )  # fmt: skip


def longer(cutter: Cutter, length: float) -> Cutter | None:
    """Make the same with its nose so far from the tip; what is right below it goes on, and it cuts no higher up than it does."""
    ends = {} if cutter.shape in ("lollipop", "form") else {"flutes": flute_length(cutter)}
    return made_of(cutter, length=length, **ends)


def made_of(cutter: Cutter, **changes: object) -> Cutter | None:
    try:
        return replace(cutter, **changes)  # type: ignore[arg-type]
    except CutterError:
        return None


def _with(case: Case, cutter: Cutter | None) -> Case | None:
    return None if cutter is None else replace(case, cutter=cutter)
