"""What the page says of a plan, for planners: short sentences, each number with its unit."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from plan_cutters.document.answers import ChangeEntry, StickOutEntry
from plan_cutters.document.judged import judged, not_judged, not_seen
from plan_cutters.document.model import AreaEntry, CutterEntry, Plan, WitnessEntry
from plan_cutters.document.names import kind, named
from plan_cutters.document.next_steps import cures, first_step, step_told, together
from plan_cutters.document.told import figure, part_of, percent, reached


class _Reason(NamedTuple):
    """A reason, as it stands after "because of"; what it is; and what is tried first against it: nothing of that is computed."""

    said: str
    what: str
    hint: str


REASONS = {
    "axis_limit": _Reason("the axis limit", "A posture would serve, but the machine cannot hold it as the part is set up.",
                          "another setup, or a machine that tilts further"),
    "local_gouge": _Reason("local gouge", "The surface curves more than the cutter, right at the contact.",
                           "a smaller radius or corner radius"),
    "rear_gouge": _Reason("rear gouge", "The flutes cut into the part within a cutter's diameter of the contact.",
                          "a smaller radius or corner radius"),
    "collision": _Reason("collision of the flutes", "The flutes meet the part farther away.",
                         "a thinner cutter"),
    "buried": _Reason("another body", "It covers the surface, so nothing can be machined there.",
                      "--ignore, if that body is not there when the part is machined"),
    "tolerance": _Reason("too coarse a tolerance", "It is no smaller than the cutter's own features.",
                         "a smaller --tolerance"),
    "neck": _Reason("collision of the neck", "The neck is in the way, the flutes are not.", "a thinner or longer neck"),
    "shank": _Reason("collision of the shank", "The shank is in the way, the flutes are not.",
                     "a thinner shank or a longer stick-out"),
    "holder": _Reason("collision of the holder", "The holder is in the way, the flutes are not.",
                      "a longer stick-out or a slimmer holder"),
    "fixture": _Reason("the fixture", "Without the fixtures the sample would be reached.", "another place for the fixture"),
}  # fmt: skip
#: Stick-outs that differ by less are the same, mm.
SAME = 0.02
#: Verdicts, and what they say of a sample.
VERDICTS = {
    "interference_free": ("interference-free", "The tool can stand along the surface normal, in every rotation."),
    "accessible": ("accessible", "A posture (tilt and rotation) was found that neither gouges nor collides."),
    "undecided": ("undecided", "Neither a safe posture was found nor a proof that there is none."),
    "inaccessible": ("inaccessible", "None of the postures that were searched is safe."),
    "unjudged": ("could not be judged", "The surface could not be sampled, or it has no normal there."),
}
FEASIBLE = {True: "yes", False: "no", None: "undecided"}


def mm(length: float | None) -> str:
    """A length, three digits of it."""
    return "" if length is None else f"{length:.3g} mm"


def angle(degrees: float) -> str:
    """An angle, to a tenth of a degree."""
    return f"{round(degrees, 1) + 0.0:g}°"


def area(mm2: float) -> str:
    """An area, three digits of it.

    >>> area(12345.6), area(0.0456), area(float("nan"))
    ('12,300 mm²', '0.0456 mm²', 'not known')
    """
    if not math.isfinite(mm2):
        return "not known"
    return f"{figure(mm2)} mm²"


def place(point: Sequence[float] | None) -> str:
    """A point or direction."""
    return "" if point is None else ", ".join(f"{x + 0.0:.4g}" for x in point)


def up(length: float | None) -> str:
    """A length that must not be less, rounded up."""
    return "" if length is None else f"{math.ceil(100.0 * length - 1e-9) / 100.0:.2f} mm"


def down(radius: float | None) -> str:
    """A radius that must not be more, rounded down to three digits.

    >>> down(6.2399), down(0.0)
    ('6.23 mm', '0 mm')
    """
    if not radius:
        return "0 mm"
    digit = 10.0 ** (math.floor(math.log10(radius)) - 2)
    return f"{math.floor(radius / digit + 1e-9) * digit:.4g} mm"


def count(number: int, word: str) -> str:
    """So many things.

    >>> count(1, "face"), count(1200, "sample")
    ('1 face', '1,200 samples')
    """
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def reason(word: str) -> str:
    """What a reason is called."""
    return REASONS[word].said if word in REASONS else word.replace("_", " ")


def sentence(text: str) -> str:
    """A clause as a sentence of its own.

    >>> sentence("nothing helps")
    'Nothing helps.'
    """
    return f"{text[:1].upper()}{text[1:]}."


def hint(word: str) -> str:
    """What is tried first against a reason."""
    return REASONS[word].hint if word in REASONS else ""


def called(obstacle: str | None) -> str:
    """What is in the way, as it is told.

    >>> called("fixture:table"), called("F12"), called(None)
    ('fixture table', 'F12', '')
    """
    return (obstacle or "").replace("fixture:", "fixture ", 1)


def share(part: float) -> str:
    """A share that is neither nothing nor all, in percent."""
    return percent(part, some=part > 0.0, whole=False)


def spot(witness: WitnessEntry) -> str:
    """A witness in a sentence."""
    if witness.reason == "tolerance":
        return "The tolerance is too coarse to say anything about this cutter."
    said, best, obstacle = reason(witness.reason), witness.best_posture, called(witness.obstacle_face)
    said = said[0].upper() + said[1:]
    unsure = witness.verdict == "undecided"
    said += ", undecided" * unsure
    if witness.depth_mm is not None and best is not None:
        there, where = (
            f"tilt {angle(best.tilt)}, rotation {angle(best.rotation)}",
            f" in {obstacle}" if obstacle else "",
        )
        if unsure:
            what = obstacle or "the part"
            return f"{said}. At the best posture found ({there}) {what} may reach {mm(witness.depth_mm)} into the tool."
        return f"{said}. The best posture found ({there}) is still {mm(witness.depth_mm)} too deep{where}."
    if obstacle:
        return f"{said}. {obstacle[0].upper() + obstacle[1:]} {'may be' if unsure else 'is'} in the way."
    return f"{said}. No posture is {'sure' if unsure else 'left'}."


def tool(entry: CutterEntry) -> str:
    """A cutter in words: its end, its lengths, its holder."""
    what = kind(entry)
    corner = f" with corner radius {entry.corner_radius:g} mm" if what == "bull nose" else ""
    said = [f"{what}{corner}, diameter {2.0 * entry.radius:g} mm"]
    if entry.taper_deg:
        said.append(f"taper {entry.taper_deg:g}°")
    if entry.flutes_mm is not None and entry.flutes_mm < entry.length:
        said.append(f"flutes {entry.flutes_mm:g} mm")
    holder = [stage for stage in entry.stages if stage.part == "holder"]
    if holder:
        widest = 2.0 * max(max(stage.radius_mm, stage.upper_radius_mm) for stage in holder)
        named = f" {entry.holder}" if entry.holder else ""
        said.append(f"stick-out {entry.length:g} mm, holder{named} of up to {widest:g} mm diameter")
    else:
        said.append(f"judged up to {entry.length:g} mm over the tip, without a holder")
    return ", ".join(said)


def headline(plan: Plan, names: Mapping[str, str], shown: CutterEntry) -> tuple[str, str]:
    """Which cutter to take, and why: a title, and some sentences."""
    title, why = _choice(plan, names, shown)
    unjudged = part_of(shown, shown.area_share, ["unjudged"])
    if unjudged != "0 %":
        why += f" {unjudged} of the target area could not be judged (see Notes)."
    why = " ".join([why, *scope(plan), *not_seen(plan, names)])
    taken = plan.selected or plan.selected_over_setups or plan.selected_for_setup
    told = next((c for c in plan.cutters if c.id == taken), shown)
    return title, " ".join([why, *_together(plan), *_held(told), *_mended(plan, told)])


def _together(plan: Plan) -> list[str]:
    """Where no cutter finishes: which of those given do most together, in a sentence."""
    said = "" if plan.selected or plan.selected_over_setups else together(plan)
    return [f"{named(plan, said)}."] if said else []


def scope(plan: Plan) -> list[str]:
    """Which faces were judged, where not all were, and which were not: sentences."""
    left = not_judged(plan)
    return [f"Judged: {judged(plan)}.", *left] if left else []


def _held(entry: CutterEntry) -> list[str]:
    """How far a cutter stands out of which holder, in a sentence."""
    if not any(stage.part == "holder" for stage in entry.stages):
        return ["It was judged without a holder."]
    least = entry.least_stick_out.least_mm if entry.least_stick_out else None
    held = f"It stands {entry.length:g} mm out of {entry.holder or 'its holder'}"
    if least is None:
        return [f"{held}."]
    if entry.length - least < SAME:
        return [f"{held}, and cannot be held shorter."]
    return [f"{held}. It can be held shorter: {up(least)} are enough for what it reaches."]


def _mended(plan: Plan, entry: CutterEntry) -> list[str]:
    """What would help a cutter most, in a sentence."""
    if (step := first_step(entry)) is not None:
        return [f"Next: {named(plan, step_told(step))}."]
    helping = [each.why for each in cures(entry.mend) if each.helps] if entry.mend else []
    return [f"It would finish with {named(plan, helping[0])}."] if helping else []


def _choice(plan: Plan, names: Mapping[str, str], shown: CutterEntry) -> tuple[str, str]:
    found, name = plan.samples, names[shown.id]
    # Of several setups one may do by itself.
    alone = next((setup.axis for setup in shown.setups if not setup.lost), plan.effective.setup)
    several = bool(shown.setups) and all(setup.lost for setup in shown.setups)
    much = f"It reaches {reached(shown, shown.area_share)} of the target area"
    if plan.selected and not several:
        every = f"all {count(found.judged, 'sample')}" + (" that could be judged" if found.unjudged else "")
        return (
            f"Take {name}." if alone == plan.effective.setup else f"Take {name}, in setup {place(alone)}.",
            f"It reaches {every} of the target faces without gouging or collision. {_why(plan, names)}",
        )
    if plan.selected_over_setups:
        name = names[plan.selected_over_setups]
        return (
            f"Take {name}, in several setups.",
            "It reaches every judged sample in one setup or another, but not in one alone.",
        )
    if plan.selected_for_setup:
        c = next(c for c in plan.cutters if c.id == plan.selected_for_setup)
        return (
            f"Take {names[c.id]} for {'these setups' if shown.setups else 'this setup'}.",
            f"It reaches {reached(c, c.area_share)} of the target area: all that any of these cutters can reach here. The axis "
            f"limit loses {count(c.beyond_setup, 'sample')} of {found.finished:,} for every cutter: machine these in another "
            "setup.",
        )
    if shown.feasible is None and not shown.undecided:
        return (
            f"{name} may do, but obstacles are missing.",
            f"{much}. Something that may be in the way is not known (see Notes).",
        )
    if shown.feasible is None:
        unsure = part_of(shown, shown.area_share, ["undecided"])
        return f"No cutter is sure to finish this part; {name} comes nearest.", f"{much}; {unsure} is undecided."
    if not shown.interference_free + shown.accessible:
        return "No cutter reaches any of the target faces.", "The lists below say why."
    return (
        f"No single cutter finishes this part; {name} comes nearest.",
        f"{much}; the lists below say what it leaves, and why.",
    )


def _why(plan: Plan, names: Mapping[str, str]) -> str:
    """Why the selected cutter, and no other one."""
    first = next(c for c in plan.cutters if c.id == plan.selected)
    larger = [names[c.id] for c in plan.cutters if c.radius > first.radius]
    if not larger:
        return "It has the largest radius of the cutters given."
    listed = ", ".join(larger[:4]) + (f" and {len(larger) - 4} more" if len(larger) > 4 else "")
    verb = "is" if len(larger) == 1 else "are"
    return f"It has the largest radius of the feasible ones: {listed} {verb} larger, but not feasible."


#: What stands for an obstacle that is not known.
STAND_IN = {
    "none": "Nothing stands for it.",
    "box": "The box around it stands for it.",
    "triangles": "Its own triangles stand for it.",
    "edges": "Its edges stand for it.",
}


def limit(found: StickOutEntry) -> str:
    """What limits a stick-out."""
    if found.least_mm is None:
        return f"It was not looked for: {found.limited_by}."
    if found.limited_by == "floor" or found.face is None:
        return "Its flutes and neck are that long."
    met = found.obstacle_face or "the part"
    return f"Held shorter, the holder meets {met} when the tool stands at {place(found.point)} mm on {found.face}."


#: What `mend` changes, as the subject of a sentence.
THINGS = {
    "tolerance": "A finer tolerance",
    "tilt_range": "A wider range of tilts",
    "stick_out": "Another stick-out",
    "setup": "Another setup axis",
    "corner_radius": "Another corner radius",
    "radius": "A smaller radius",
    "tilt_limit": "A machine that tilts further",
    "faces": "Leaving out faces",
}


def change(found: ChangeEntry) -> tuple[str, str]:
    """What is changed, and whether that helps: subject and rest of a sentence."""
    subject = THINGS.get(found.thing, found.thing.replace("_", " "))
    if found.helps:
        return subject, f"helps: {found.why}."
    if found.asked is not None and not found.why.startswith("is not decided"):
        return subject, f"may help: {found.why}."
    return subject, f"{found.why}."


def between(found: AreaEntry) -> str:
    """What is known between the samples."""
    if found.share == 1.0:
        return "all of the area is proved safe, too, with the tool axes found."
    share = percent(found.share, some=found.share > 0.0, whole=False)
    return f"{share} of the area is proved safe with the tool axes found; the rest is not proved, which does not mean unsafe."
