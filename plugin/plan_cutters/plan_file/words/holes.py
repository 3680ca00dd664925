"""A plan says which holes are for drills, and which drills make them."""

import math
from collections import Counter
from collections.abc import Iterator

from plan_cutters.domain.drill import CONES, Why, inch_name
from plan_cutters.domain.figures import count, duration, in_inches, joined, listed, percent, reported, reporting
from plan_cutters.plan_file.holes import DrillingStep, HoleEntry, MissingEntry, ToleranceEntry
from plan_cutters.plan_file.model import Plan

#: Groups that are described; where there are more, their diameters are named: so many of these.
_GROUPS, _DIAMETERS = 3, 10
#: Lengths of drills in inches are whole ones of this; a length that is more than a whole one by less is that.
_STEP = 0.05
_WHOLE = 1e-6


def holes(plan: Plan) -> Iterator[str]:
    """One sentence on all of them; nothing where there are none."""
    if not plan.holes:
        return
    groups: dict[int, list[HoleEntry]] = {}
    for each in plan.holes:
        groups.setdefault(each.group, []).append(each)
    ordered = sorted(groups.values(), key=lambda group: (group[0].diameter_mm, group[0].group))
    if len(groups) <= _GROUPS:
        what = "; ".join(group_words(group) for group in ordered)
    else:
        what = listed([*dict.fromkeys(size(group[0].diameter_mm) for group in ordered)], _DIAMETERS)
    share = drilled_share(plan)
    much = "" if share is None else f", {percent(share, some=True, whole=False)} of the area,"
    number = len(plan.holes)
    yield f"{count(number, 'hole')}{much} {'is for a drill' if number == 1 else 'are for drills'}: {what}."
    if any(library.drills for library in plan.libraries):
        yield _made(plan)


def _made(plan: Plan) -> str:
    """Say how many of them tools of the libraries make, in which time, and what is missing, by its usual size."""
    made = sum(each.drilled for each in plan.holes)
    steps = plan.process.drilling
    times = [None if step.seconds is None else step.seconds + step.link_seconds for step in steps]
    took = f", {duration(math.fsum(each or 0.0 for each in times))}" if times and None not in times else ""
    setups = sorted({step.setup + 1 for step in steps})
    where = f" in setup{'s' if len(setups) > 1 else ''} {joined([*map(str, setups)])}" if setups and len(plan.setups) > 1 else ""
    text = f"Drills of the set make {'all' if made == len(plan.holes) else made if made else 'none'} of them{where}{took}"
    missing = Counter(missing_words(thing) for each in plan.holes for thing in each.missing)
    named = [f"{number} x {words}" if number > 1 else words for words, number in missing.items()]
    return f"{text}; no tool makes {listed(named, _DIAMETERS)}." if missing else f"{text}."


#: Why tools of its size do not make something.
_WHY: dict[Why, str] = {
    "": "", "axis": "no setup has its axis", "short": "flutes are too short", "in_the_way": "something is in the way",
    "bottom": "no mill reaches its bottom",
}  # fmt: skip


def missing_words(missing: MissingEntry) -> str:
    """Name the tool that is missing by its usual size, and say why others of it do not do."""
    if missing.thing == "thread":
        return f"tap {missing.name}{f' ({_WHY[missing.why]})' if missing.why else ''}"
    step = _STEP if in_inches() else 1.0
    deep = "" if missing.depth_mm is None else f" x {step * math.ceil(reported(missing.depth_mm) / step - _WHOLE):.4g}"
    angle = "" if missing.angle_deg is None else f" x {missing.angle_deg:.4g} deg"
    what = "" if missing.thing == "hole" else f"{missing.thing} "
    why = f" ({_WHY[missing.why]})" if missing.why else f" {missing.name}" if missing.name else ""
    return f"{what}{size(missing.diameter_mm)}{deep if missing.thing == 'hole' else ''}{angle}{why}"


def drilling_words(step: DrillingStep) -> str:
    """The tool of a step that drills, with what it leaves."""
    deep = "" if step.kind in CONES else f" x {reported(step.depth_mm):.4g}"
    return f"{step.kind} {step.thread or size(step.diameter_mm)}{deep}"


def group_words(group: list[HoleEntry]) -> str:
    """Equal holes: how many, how wide and how deep.

    The depth is that of the full diameter.
    """
    first, number = group[0], len(group)
    times = f"{number} x " if number > 1 else ""
    ends = ", through" if first.through else ""
    needed = "" if first.tolerance is None else f" {first.tolerance.fit or limits(first.tolerance)}"
    thread = "" if first.thread is None else f", {first.thread.name}"
    sink = "" if first.countersink is None else f", countersink {size(first.countersink.diameter_mm)}"
    bore = "" if first.counterbore is None else f", counterbore {size(first.counterbore.diameter_mm)}"
    return f"{times}{size(first.diameter_mm)}{needed}, {reported(first.depth_mm):.4g} deep{ends}{sink}{bore}{thread}"


def limits(tolerance: ToleranceEntry) -> str:
    """The deviations of a diameter, as `+0.02 -0.01`."""
    both = [each for each in (tolerance.upper_mm, tolerance.lower_mm) if each is not None]
    return " ".join(f"{reported(each):+.4g}" if each else "0" for each in both)


def size(diameter: float) -> str:
    """A diameter as tools are called: of inches with the name of the drill, if there is one of that size."""
    name = inch_name(reported(diameter)) if in_inches() else ""
    return f"D{reported(diameter):.4g}{f' ({name})' if name else ''}"


@reporting(lambda plan: plan.effective.units)
def missing_tools(plan: Plan) -> list[str]:
    """List what no tool of the libraries makes of any hole, each once; nothing where they have no tools for holes."""
    needed = any(library.drills for library in plan.libraries)
    return [*dict.fromkeys(missing_words(each) for hole in plan.holes for each in hole.missing)] if needed else []


def drilled_share(plan: Plan) -> float | None:
    """Share of the area of the finished target faces that is in holes for drills; None where no area is known."""
    sizes = {face.id: face.area_mm2 for face in plan.faces}
    faces = plan.cutters[0].faces
    whole = sum(sizes[name] * (1.0 - each.inside_share) for name, each in faces.items())
    mine = sum(sizes[name] * each.drilled_share for name, each in faces.items())
    return mine / whole if whole > 0.0 else None


def behind_drills(plan: Plan) -> dict[int, list[int]]:
    """Of steps of mills that go down to the bottoms of holes, by their numbers, those of the steps that drill these before: they
    are solid until their drills have been there.
    """
    steps, drilling = plan.process.steps, plan.process.drilling
    floors = [{face for each in bores.holes for face in plan.holes[each.hole].floor} for bores in drilling]
    drilled = list(enumerate(zip(drilling, floors, strict=True), len(steps) + 1))
    behind = {
        k: [number for number, (bores, own) in drilled if bores.setup >= step.setup and own.intersection(step.faces)]
        for k, step in enumerate(steps, 1)
    }
    return {k: drills for k, drills in behind.items() if drills}
