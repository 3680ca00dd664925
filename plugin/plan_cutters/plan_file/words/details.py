"""Details of a plan: its part, samples, search and seconds, and how much the cutters that are not taken leave."""

from collections.abc import Iterator

from plan_cutters.domain.figures import angle, capital, count, direction, mm, percent, size
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.nearest import leaves
from plan_cutters.plan_file.shares import unreached
from plan_cutters.plan_file.words.cutters import remaining_text
from plan_cutters.plan_file.words.headline import area
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.notes import machine

#: Cutters that do not reach all and are named one by one; stages that are named.
_OTHERS, _STAGES = 3, 6


def scene(plan: Plan) -> str:
    """Give the faces to machine, the samples and the machine in a sentence or two."""
    targets, ignored = len(plan.effective.target_faces), sum(f.ignored for f in plan.faces)
    also = f", {ignored} ignored" if ignored else ""
    return (
        f"The part has {count(plan.part.faces, 'face')}: {targets} to machine{also}, with "
        f"{count(plan.samples.count, 'sample')}, at most {mm(plan.samples.max_gap_mm)} apart. {machine(plan)}"
    )


def rendered(plan: Plan) -> str:
    """Say whose verdicts a drawing of the part shows, and under which conditions they were found."""
    taken = "is selected" if plan.selected else "is shown because it leaves the least area; none is selected"
    return (
        f"This cutter {taken}. Part {size(plan.part.size_mm)}. Machine {plan.effective.machine}, setup axis "
        f"({direction(plan.effective.setup)}), gouge tolerance {mm(plan.effective.tolerance_mm)}, "
        f"{count(plan.samples.count, 'sample')}."
    )


def unjudged_share(plan: Plan) -> str:
    """Say how much of the area could not be judged for any cutter; empty where all could."""
    share = plan.cutters[0].area_share.unjudged
    if not share and not plan.samples.unjudged:
        return ""
    return f"Besides, {percent(share, some=True, whole=False)} of the area could not be judged, for any cutter."


def others(plan: Plan, *, every: bool = False) -> list[str]:
    """Say how much the cutters before the one to take (or all) do not reach, and why; of many, only the nearest ones."""
    larger: list[CutterEntry] = []
    for c in plan.cutters:
        if c.id == plan.selected:
            break
        if c.not_reached:
            larger.append(c)
    near = larger
    if not every and len(larger) > _OTHERS:
        taken = plan.selected_over_setups or plan.selected_for_setup
        near = sorted(larger, key=lambda c: (c.id != taken, leaves(c)))[:_OTHERS]
    lines = [capital(named(plan, remaining_text(plan, c))) for c in larger if c in near]
    if rest := [c for c in larger if c not in near]:
        ends = [of(rest, key=leaves) for of in (min, max)]
        least, most = (unreached(c, c.area_share) for c in ends)
        which = "more wanted cutter" if plan.selected else "more cutter"
        much = least if least == most else f"{least} to {most}"
        leave = f"{len(rest)} {which}{'s leave' if len(rest) > 1 else ' leaves'}"
        lines.insert(0, f"{leave} {much} of {area(plan)}: -v or plan.json say why.")
    return lines


def details(plan: Plan) -> Iterator[str]:
    """Give what is shown only to users who ask for all of it."""
    e = plan.effective
    yield (f"Part: {size(plan.part.size_mm)}, {count(plan.part.solids, 'solid')}, SHA-256 {plan.part.sha256}.")
    yield named(plan, f"Choice: {plan.selection.why}; by {plan.selection.rule}.")
    yield (
        f"Samples: {plan.samples.convex} convex, {plan.samples.concave} concave, {plan.samples.saddle} saddle, "
        f"{plan.samples.unjudged} not judged, in {count(plan.samples.regions, 'region')}."
    )
    yield (
        f"Searched: tilts {angle(e.tilt_deg[0])} to {angle(e.tilt_deg[1])}, rotations {_turn(e.rotation_deg[0])} to "
        f"{_turn(e.rotation_deg[1])} every {angle(e.rotation_step_deg)}; tolerance {mm(e.tolerance_mm)}, of which "
        f"{mm(e.chord_error_mm)} for {e.obstacle_triangles:,} obstacle triangles."
    )
    for c in plan.cutters:
        if c.area:
            yield (f"Between samples of {c.id}: {c.area.contacts} contacts were looked at, {c.area.left} cells are not proved.")
    yield f"Versions: {', '.join(f'{name} {number}' for name, number in plan.versions.items())}."
    slow = sorted(plan.run.seconds.items(), key=lambda item: -item[1])[:_STAGES]
    yield f"Seconds: {', '.join(f'{name} {seconds:.1f}' for name, seconds in slow)}."


def _turn(degrees: float) -> str:
    """The end of a range of rotations: here a whole turn is one."""
    return "360°" if degrees == 360.0 else angle(degrees)
