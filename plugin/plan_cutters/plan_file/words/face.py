"""Details of a plan, and of a face: why a cutter does not reach it, what is in the way there, and what would help."""

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from plan_cutters.domain.figures import angle, capital, count, direction, mm, percent, size
from plan_cutters.plan_file.answers import MendEntry, StepEntry
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan, WitnessEntry
from plan_cutters.plan_file.nearest import leaves
from plan_cutters.plan_file.shares import FaceVerdicts, by_share, part_of, unreached
from plan_cutters.plan_file.words.cutters import called, reason, remaining_text
from plan_cutters.plan_file.words.headline import area
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.next_steps import effect, is_excluded
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


class InTheWay(NamedTuple):
    """A face, or `fixture:NAME`, that is in the way at the best postures, and how deep in the tool (mm; None: not known)."""

    face: str
    reason: str
    depth_mm: float | None
    places: int


def in_the_way(witnesses: Sequence[WitnessEntry]) -> list[InTheWay]:
    """Obstacles that some witnesses name, the one that most of them name first."""
    places = Counter((w.obstacle_face, w.reason) for w in witnesses if w.obstacle_face)
    depths: dict[tuple[str, str], float] = {}
    for w in witnesses:
        if w.obstacle_face and w.depth_mm is not None:
            key = w.obstacle_face, w.reason
            depths[key] = max(w.depth_mm, depths.get(key, w.depth_mm))
    places_hit = [InTheWay(face or "", code, depths.get((face or "", code)), n) for (face, code), n in places.items()]
    return sorted(places_hit, key=lambda each: (-each.places, -(each.depth_mm or 0.0), each.face))


def helping(advice: MendEntry) -> list[StepEntry]:
    """The steps that gain something."""
    return [step for step in advice.steps if not is_excluded(step) and step.gained]


def face_text(plan: Plan, cutter: CutterEntry, face: FaceEntry, unhelped: str) -> str:
    """Say how much of a face a cutter does not reach, why, what is in the way, and what would help.

    Parameters
    ----------
    plan : Plan
    cutter : CutterEntry
        Of the plan.
    face : FaceEntry
        A target of the plan.
    unhelped : str
        Why no change is known that helps; a clause.

    Returns
    -------
    str
        Sentences, with cutters called as everywhere.
    """
    verdicts = cutter.faces.get(face.id, FaceVerdicts())
    if not verdicts.reached and not verdicts.not_reached:
        inside = "all of it lies inside other bodies of the part" if verdicts.inside_bodies else face.unjudged
        return f"{face.id} could not be judged: {inside or 'it has no sample'}."
    doubt = f" Of {face.id} could not be judged: {face.unjudged}." if face.unjudged else ""
    if not verdicts.not_reached:
        return named(plan, f"{cutter.id} reaches every judged sample of {face.id} ({verdicts.reached:,}).{doubt}")
    text = _loss(cutter, face, verdicts)
    mine = [w for w in cutter.witnesses if w.face == face.id and not w.inside_bodies]
    if way := in_the_way(mine):
        deep = f", up to {mm(way[0].depth_mm)} deep in the tool" if way[0].depth_mm is not None else ""
        text += f" At the best posture {called(way[0].face)} is in the way{deep}."
    changes = helping(cutter.mend) if cutter.mend else []
    text += f" What would help: {_gain(changes[0])}." if changes else f" What would help is not known: {unhelped}."
    return named(plan, text + doubt)


def _loss(cutter: CutterEntry, face: FaceEntry, verdicts: FaceVerdicts) -> str:
    share = verdicts.area_share
    why = ", ".join(f"{reason(code)} {percent(part, some=True, whole=False)}" for code, part in by_share(share.lost_by))
    text = (
        f"{cutter.id} does not reach {unreached(verdicts, share)} of {face.id} ({count(verdicts.not_reached, 'sample')}): "
        f"{why or 'no reason is known'}."
    )
    if verdicts.undecided:
        much = part_of(verdicts, share, ["undecided"])
        text += f" {much} of it is undecided ({verdicts.undecided:,} samples): neither proved safe nor proved blocked."
    return text


def _gain(step: StepEntry) -> str:
    option = f" [{step.option}]" if step.option else ""
    return f"{step.why}: {effect(step)}{option}"


def posture_text(face: str, free: float, undecided: float, forbidden: Sequence[tuple[str, float]], *, certified: bool) -> str:
    """Say how many of the postures at a point are free, or what forbids the most of them; shares are 0 to 1."""
    place = f"At the point, on {face}, "
    if free > 0.0:
        sure = "" if certified else ", provided that no missing obstacle is in the way,"
        return f"{place}{percent(free)} of the postures{sure} are free."
    if undecided > 0.0:
        return f"{place}no posture is surely free; {percent(undecided)} are undecided."
    why = ", ".join(f"{reason(code)} {percent(share)}" for code, share in forbidden[:3])
    return f"{place}no posture that was searched is free ({why or 'no contact'})."


def sample_text(distance_mm: float, verdict: str, code: str | None) -> str:
    """Say what is known of the sample that is nearest to a point."""
    why = f", {reason(code)}" if code else ""
    return f"The nearest sample, {mm(distance_mm)} off, is {verdict.replace('_', '-')}{why}."
