"""Put into words what the maps let expect of simultaneous motion."""

from collections.abc import Iterator

from plan_cutters.plan_file.numbers import some
from plan_cutters.plan_file.operations import ForcedStepEntry, MotionEntry

#: Steps of a rotary axis between two samples that a planner should know of, deg.
_LARGE = 15.0


def motion(motion: MotionEntry | None) -> Iterator[str]:
    """Say what the joined postures let expect: an estimate, and called one."""
    if motion is None:
        return
    if not motion.components:
        yield f"Of motion nothing can be estimated: {motion.cutter} has no free posture in the maps."
        return
    yield f"Simultaneous motion with {motion.cutter}, an estimate: {_parts(motion)}."
    if motion.components_strict > motion.components:
        yield f"  By strict joins there are {motion.components_strict} parts: some ways are narrower than the maps tell."
    for each in motion.forced_steps:
        yield from _step(motion, each)


def _parts(motion: MotionEntry) -> str:
    if motion.components == 1:
        return "all its postures hang together"
    outside = f", {motion.outside} samples lie outside of it" if motion.outside else ""
    least = "" if motion.needed == motion.needed_at_least else f", at least {motion.needed_at_least},"
    needed = ("one touches" if motion.needed == 1 else f"{motion.needed} of them{least} together touch") + " all that is reached"
    largest = f"the largest touches {some(motion.largest_share)} of the area{outside}"
    return f"its postures fall into {motion.components} parts; {largest}; {needed}"


def _step(motion: MotionEntry, each: ForcedStepEntry) -> Iterator[str]:
    """A large step of the rotary axes, and turns of the first one near its own direction."""
    lines = f"grid lines along {each.along}"
    if each.looked_at < each.lines:
        lines = f"{each.looked_at} of {each.lines} {lines}"
    exact = f"(to {motion.resolution_deg:g} deg)"
    if each.deg >= _LARGE:
        yield (
            f"  On {lines} a rotary axis must turn by {each.deg:g} deg {exact} from one sample to the next, whatever the "
            f"postures: {each.face}."
        )
    if each.turning_deg >= max(_LARGE, each.deg + motion.resolution_deg):
        yield (
            f"  On {lines} the first rotary axis turns by {each.turning_deg:g} deg {exact} between two samples where the tool "
            "stands along it."
        )
