"""What the page says of a plan, for planners: short sentences, each number with its unit."""

import math
from collections.abc import Sequence
from typing import Any

#: Reasons, as they stand after "because of", and what is then tried first. Nothing of it is computed.
REASONS = {
    "axis_limit": ("the axis limit", "try another setup or a machine that tilts further"),
    "local_gouge": (
        "local gouging: the surface is more curved than the cutter",
        "try a smaller radius or corner radius",
    ),
    "rear_gouge": ("rear gouging beside the contact", "try a smaller radius or corner radius"),
    "collision": ("collision of the flutes with the part", "try a longer or thinner cutter"),
    "buried": ("another body that covers the surface", "leave that body out with --ignore if it is not there"),
    "tolerance": ("the tolerance, which is too coarse for this cutter", "give a smaller --tolerance"),
    "neck": ("collision of the neck", "try a thinner or longer neck"),
    "shank": ("collision of the shank", "try a thinner shank or a longer stick-out"),
    "holder": ("collision of the holder", "try a longer stick-out or a slimmer holder"),
    "fixture": ("the fixture", "clamp elsewhere, or move the fixture"),
}
VERDICTS = {
    "interference_free": "interference-free",
    "accessible": "accessible with a tilted axis",
    "undecided": "undecided",
    "inaccessible": "not reached",
    "unjudged": "not judged",
}
FEASIBLE = {True: "yes", False: "no", None: "undecided"}


def percent(share: float) -> str:
    """A share so that 0 % is none of it and 100 % is all of it.

    >>> percent(1.0), percent(0.99999), percent(0.5), percent(1e-9), percent(0.0)
    ('100 %', '99.9 %', '50 %', '0.1 %', '0 %')
    """
    if share in (0.0, 1.0):
        return f"{100 * share:.0f} %"
    return f"{min(99.9, max(0.1, round(100 * share, 1))):g} %"


def mm(length: float | None, digits: int = 3) -> str:
    """A length, three digits of it."""
    return "" if length is None else f"{length:.{digits}g} mm"


def place(point: Sequence[float] | None) -> str:
    """A point or direction."""
    return "" if point is None else ", ".join(f"{x:.4g}" for x in point)


def up(length: float | None) -> str:
    """A length that must not be less, rounded up."""
    return "" if length is None else f"{math.ceil(100.0 * length - 1e-9) / 100.0:.2f} mm"


def reason(word: str) -> str:
    """A reason, as it stands after "because of"."""
    return REASONS.get(word, (word.replace("_", " "), ""))[0]


def hint(word: str) -> str:
    """What is tried first against a reason."""
    return REASONS.get(word, ("", ""))[1]


def spot(witness: Any) -> str:
    """A witness in a sentence or two."""
    if witness.reason == "tolerance":
        return "The tolerance is too coarse to say anything about this cutter."
    said = f"The cutter does not reach this point because of {reason(witness.reason)}."
    if witness.depth_mm is not None and witness.best_posture is not None:
        best = witness.best_posture
        said += (f" The best posture found (tilt {best.tilt:.3g} deg, rotation {best.rotation:.3g} deg) is still "
                 f"{mm(witness.depth_mm)} too deep")  # fmt: skip
        said += f" in {witness.obstacle_face}." if witness.obstacle_face else "."
    elif witness.obstacle_face:
        said += f" {witness.obstacle_face} is in the way."
    return said


def headline(plan: Any, names: dict[str, str], shares: dict[str, dict[str, float]], shown: str) -> tuple[str, str]:
    """Which cutter to take, and why: a title and a sentence or two."""
    samples, judged = plan.samples.count, plan.samples.count - plan.samples.unjudged
    reached = {name: each["interference_free"] + each["accessible"] for name, each in shares.items()}
    unjudged = shares[shown]["unjudged"]
    but = f" {percent(unjudged)} of the area could not be judged: see the notes." if unjudged else ""
    if plan.selected:
        what = "all" if judged == samples else f"all {judged} judged"
        return (
            f"Take {names[plan.selected]}.",
            f"It reaches {what} samples of the target faces without gouging or collision; {plan.selection.why}.{but}",
        )
    best = next(c for c in plan.cutters if c.id == shown)
    if plan.selected_over_setups:
        name = names[plan.selected_over_setups]
        return (f"Take {name}, in several setups.", f"{name} reaches every judged sample in one setup or another; none does so in one "
                f"setup.{but}")  # fmt: skip
    if plan.selected_for_setup:
        name, lost = names[plan.selected_for_setup], best.beyond_setup
        return (f"Take {name} for this setup.", f"It reaches all that any cutter can reach in this setup; the axis limit loses {lost} of "
                f"{samples} samples for every cutter, which need another setup.{but}")  # fmt: skip
    if best.feasible is None and not best.undecided:
        return (f"Perhaps {names[shown]}: obstacles are missing.", f"It reaches every judged sample, but something that may be in the "
                f"way is not known: see the notes.{but}")  # fmt: skip
    if best.feasible is None:
        return (f"No cutter is sure; {names[shown]} may do.", f"It reaches {percent(reached[shown])} of the area; "
                f"{percent(shares[shown]['undecided'])} is undecided, nothing is known to be out of reach.{but}")  # fmt: skip
    return (f"No cutter finishes this part alone; {names[shown]} comes nearest.", f"It reaches {percent(reached[shown])} of the area of "
            f"the target faces.{but}")  # fmt: skip
