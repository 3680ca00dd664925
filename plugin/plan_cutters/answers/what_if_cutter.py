"""Another cutter may serve: held further out, of a smaller radius, with another corner.

Lemmas W3 and W4 of `docs/what_if_proof.md`.
"""

import math
from dataclasses import replace

import numpy as np

from plan_cutters.answers.trial import Case, Trials
from plan_cutters.answers.what_if import Way, WhatIf, none
from plan_cutters.domain.change import Change
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Segment
from plan_cutters.domain.shapes import SAME, flute_length
from plan_cutters.domain.spec import notation
from plan_cutters.errors import CutterError
from plan_cutters.plan_file.words import change_text
from plan_cutters.scene.preparation import Prepared

#: Steps of the stick-out, mm.
GRAIN = 0.01
#: Share of the radius that a step takes.
SHARE = 0.02
#: The radius is no smaller than so many tolerances, below which verdicts say nothing, and than so little of the length: no cutter
#: stands out a hundred times its diameter, and searches with needles take long.
THINNEST, SLIMMEST = 4.0, 0.005
#: Usual corner radii, mm; flat and ball ends are tried, too.
CORNERS = (0.2, 0.3, 0.4, 0.5, 0.8, 1.0, 1.2, 1.5, 1.6, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0)


def stick_out(case: Case, trials: Trials) -> WhatIf | Change:
    """Try the least length from the tip to the holder's nose, the flutes as they are; to `GRAIN`."""
    cutter, not_reached = case.cutter, len(trials.not_reached)
    now, how = cutter.length, notation(cutter.name)
    if cutter.holder is None:
        return none("stick_out", now, not_reached, "no holder is stated, and a longer cutter only adds to what is in the way")
    most = math.ceil((highest(case.ready, cutter) - now) / GRAIN)
    if most < 1:
        return none("stick_out", now, not_reached, f"its {how.mm(now)} already hold the holder above all obstacles")

    def make(length: float) -> Case | None:
        return _with(case, longer(cutter, length))

    way = Way(most, lambda at: round(now + at * GRAIN, 6))
    if (end := make(way.value(most))) is None:
        return none("stick_out", now, not_reached, "no shank can go on above it")
    return WhatIf(
        now=now, ways=[way], make=make, ends=[end], nested=True, reads=lambda end: end.cutter.length,
        fails=lambda end, rest: f"{rest.words} at every stick-out" if rest.count else
        "where the holder is out of the way, something else is",
        serves=lambda requested, made: (change_text.stick_out(requested, cutter), {"cutters": (made.cutter,)}),
    )  # fmt: skip


def highest(ready: Prepared, cutter: Cutter) -> float:
    """Give a stick-out with which the nose is above all obstacles wherever the cutter touches them, mm."""
    vertex = ready.conditions.obstacles.triangles.vertex
    size = float(np.linalg.norm(vertex.max(axis=(0, 1)) - vertex.min(axis=(0, 1))))
    return size + 2.0 * cutter.radius + flute_length(cutter) + (cutter.clearance or 0.0)


def radius(case: Case, trials: Trials) -> WhatIf | Change:
    """Try smaller radii, the largest first, in steps of `SHARE`."""
    cutter, conditions, not_reached = case.cutter, case.ready.conditions, len(trials.not_reached)
    now, how = cutter.radius, notation(cutter.name)
    if cutter.shape == "form":
        return none("radius", now, not_reached, "the outline of a form cutter has no radius to change alone")
    least_radius = max(THINNEST * conditions.tolerance, SLIMMEST * cutter.length)
    most = max(0, math.floor(math.log(least_radius / now) / math.log(1.0 - SHARE)))

    def value(at: int) -> float:
        return float(f"{now * (1.0 - SHARE) ** at:.4g}")

    def make(radius: float) -> Case | None:
        made = thinner(cutter, radius)
        return _with(case, made) if made is not None and conditions.judges(made) else None

    while most and (end := make(value(most))) is None:
        most -= 1
    if not most:
        return none("radius", now, not_reached, "there is no thinner cutter like it that could be judged")
    assert end is not None
    return WhatIf(
        now=now, ways=[Way(most, value)], make=make, ends=[end], reads=lambda end: end.cutter.radius,
        fails=lambda end, rest: f"with {how.size(end.cutter.radius)}, the least tried, {rest.words}" if rest.count else
        f"none of {most} sizes down to {how.size(end.cutter.radius)} serves all samples",
        serves=lambda requested, made: (change_text.radius(requested, cutter), {"cutters": (made.cutter,)}),
    )  # fmt: skip


def corner_radius(case: Case, trials: Trials) -> WhatIf | Change:
    """Try another corner on an end mill of the same radius, from flat to ball; the nearest that serves is taken."""
    cutter = case.cutter
    now, r, how = cutter.corner_radius, cutter.radius, notation(cutter.name)
    if cutter.shape != "end":
        return none("corner_radius", now, len(trials.not_reached), f"a {cutter.shape} has no corner to change alone")

    def make(corner: float) -> Case | None:
        return _with(case, made_of(cutter, corner_radius=corner))

    corners = sorted({0.0, r, *(c for c in CORNERS if c < r)} - {now}, key=lambda c: (abs(c - now), c))
    ends = [made for corner in corners if (made := make(corner)) is not None]
    if not ends:
        return none("corner_radius", now, len(trials.not_reached), "its flutes are too short for any other corner")
    values = [now, *(end.cutter.corner_radius for end in ends)]

    return WhatIf(
        now=now, ways=[Way(len(ends), values.__getitem__)], make=make, ends=ends, reads=lambda end: end.cutter.corner_radius,
        fails=lambda end, rest: f"with {how.mm(end.cutter.corner_radius)}, the best of {len(ends)} tried, {rest.words}"
        if rest.count else f"each of {len(ends)} corner radii tried loses some samples",
        serves=lambda requested, made: (change_text.corner_radius(requested, cutter), {"cutters": (made.cutter,)}),
    )  # fmt: skip


def thinner(cutter: Cutter, radius: float) -> Cutter | None:
    """Make the same of a smaller radius: a ball stays one, another corner stays as it is, and so does what is above; but what was
    no thicker than the flutes stays so. None if there can be none."""

    def slim(own: float) -> float:
        return min(own, radius) if own <= cutter.radius + SAME else own

    changes: dict[str, object] = {"radius": radius}
    if cutter.corner_radius == cutter.radius:
        changes["corner_radius"] = radius
    if cutter.shank_radius is not None and cutter.shape != "lollipop":
        changes["shank_radius"] = slim(cutter.shank_radius)
    changes["neck"] = [Segment(slim(each.radius), each.length, slim(each.upper_radius)) for each in cutter.necks]
    if cutter.shape == "barrel" and cutter.corner_radius:
        # The ball at its tip is tangent to its flank, which stays as round as it is.
        inner, outer = cutter.arc_radius - radius, cutter.arc_radius - cutter.corner_radius
        changes["arc_height"] = cutter.corner_radius + math.sqrt(max(0.0, outer**2 - inner**2))
    return made_of(cutter, **changes)


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
