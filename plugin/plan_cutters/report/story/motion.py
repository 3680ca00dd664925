"""Put into words what the maps let expect of simultaneous motion, and how few orientations there can be whatever the axes."""

from collections.abc import Iterator

from plan_cutters.document.operations import FewestEntry, ForcedStepEntry, MotionEntry
from plan_cutters.report.story.numbers import some

#: Steps of a rotary axis between two samples that a planner should know of, deg.
_LARGE = 15.0


def whatever_the_axes(few: FewestEntry) -> Iterator[str]:
    """The bound over all axes, where it says something: two at least, and no less than half of what was found."""
    if few.at_least_any < 2 or 2 * few.at_least_any < few.found:
        return
    if few.at_least_any >= few.found:
        yield f"No other axes do with fewer than {few.found} either, candidates or not."
    else:
        yield f"Whatever the axes, no fewer than {few.at_least_any} orientations do."


def motion(found: MotionEntry | None) -> Iterator[str]:
    """What the joined postures let expect: an estimate, and called one."""
    if found is None:
        return
    if not found.components:
        yield f"Of motion nothing can be estimated: {found.cutter} has no free posture in the maps."
        return
    if found.components == 1:
        yield f"Simultaneous motion (an estimate, between samples nothing is looked at): all postures of {found.cutter} hang together."
    else:
        outside = f"; {found.outside} samples lie outside of it" if found.outside else ""
        yield (f"Simultaneous motion (an estimate, between samples nothing is looked at): the postures of {found.cutter} fall into "
               f"{found.components} parts, the largest touches {some(found.largest_share)} of the area{outside}; {_needed(found)}.")  # fmt: skip
    if found.components_strict > found.components:
        yield f"  By stricter joins there are {found.components_strict} parts: some ways are narrower than the maps' rotations tell."
    for each in found.forced_steps:
        yield from _step(found, each)


def _needed(found: MotionEntry) -> str:
    if found.needed == 1:
        return "one touches all that is reached"
    least = "" if found.needed == found.needed_at_least else f" (at least {found.needed_at_least})"
    return f"{found.needed} of them{least} together touch all that is reached"


def _step(found: MotionEntry, each: ForcedStepEntry) -> Iterator[str]:
    """A large step of the rotary axes, and turns of the first one near its own direction."""
    lines = (
        f"grid lines along {each.along}"
        if each.looked_at == each.lines
        else f"{each.looked_at} of {each.lines} grid lines along {each.along}"
    )
    if each.deg >= _LARGE:
        yield (f"  On {lines} a rotary axis must turn by about {each.deg:g} deg (to {found.resolution_deg:g}) from one sample to the "
               f"next, whatever the postures: {each.face}.")  # fmt: skip
    if each.turning_deg >= max(_LARGE, each.deg + found.resolution_deg):
        yield (f"  On {lines} the first rotary axis turns by about {each.turning_deg:g} deg between two samples where the tool stands "
               "along it.")  # fmt: skip
