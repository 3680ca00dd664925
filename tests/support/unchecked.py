"""What the checker may leave unchecked of plan.json, and why: each other entry follows from the files, or from the command."""

import re

#: Why, under which path, and the names there; those that end in `**` with all that is under them.
_LISTED = (
    ("it rests on a bound of the fastest plan", "operations.plans[].", "ratio_at_most"),
    ("why no operation takes them is no question of safety", "operations.plans[].rest.", "short reason_counts**"),
    ("the area between samples is proved by the plan alone", "operations.plans[].", "proved_share approaches_proved"),
    ("the models are not read", "operations.plans[].", "split**"),
    ("widths of passes are taken from operations.npz", "operations.plans[].operations[].", "strip_mm**"),
    ("the area between samples is proved by the plan alone", "operations.plans[].operations[].",
     "proved_share approaches_proved turning**"),
    ("the surroundings are not known, or the time was over", "operations.plans[].operations[].", "clearance_mm"),
    ("the best order of the rotary axes is not looked for", "operations.plans[].operations[].", "index_s index_from"),
    ("regions are compared by their samples", "operations.plans[].operations[].regions[].", "id low** high** rows** faces**"),
    ("times of orientations are not reckoned again", "operations.plans[].", "other_seconds"),
    ("the models are not read", "operations.plans[].operations[].", "colour"),
    ("numbers of orbits are names", "operations.plans[].operations[].", "orbit"),
    ("that there are no fewer orientations is not proved again", "operations.", "fewest**"),
    ("the bound of the fastest plan is not found again", "operations.fastest.",
     "bound_seconds at_best_seconds gap samples candidates"),
    ("the plans without a cutter are not there", "operations.", "cutters**"),
    ("it is what times rest on", "operations.assumed.", "feed_mm_min** index_s index_from"),
    ("it is how much was looked at", "operations.", "probes"),
    ("they are sentences", "operations.", "notes**"),
    ("how long it takes is no question of safety", "process.",
     "cutting_seconds link_seconds index_seconds change_seconds setup_seconds drilling[].link_seconds"),
    ("areas alone are compared", "process.",
     "left[].cause left[].samples left[].faces** left[].place_mm** exempt.faces** exempt.place_mm**"),
    ("what they advise rests on judgements of other tools", "process.", "left[].fits** left[].points** left[].helped**"),
    ("whether jaws are where the plan says is looked at by itself", "process.setups[].",
     "stands_on** held grips** apart_mm grip_mm contact_mm clamping soft"),
    ("they are sentences", "process.setups[].", "text"),
    ("what comes from below is a number of the words", "process.steps[].", "below_mm2"),
    ("the volume of the part is not reckoned again", "process.", "stock**"),
    ("what other orientations would do is not looked for", "process.steps[].", "own** take"),
    ("of repeated, simultaneous and own steps alone it does not follow from the files", "process.steps[].",
     "repeat repeat_deg** alone_mm2 strategy seconds link_seconds clearance_mm angles_deg** axis** g68_2 g53_1 rotary_words"),
    ("the command that checks does not say it", "", "effective.**"),
    ("it is no part of the operations", "cutters[].",
     "axis_limit_with** setups** lost_in_all witnesses** witnesses_untried beyond_setup area** singular travel** "
     "least_stick_out** mend** march_differs slack_mm seen touches_deg** sources** group flutes_mm"),
    ("it is no part of the operations", "",
     "shown selected_for_setup inside_radii** sharp_edges** setups** setup_proposal** largest_radius** least_set** not_mended** "
     "selection** samples.max_gap_mm samples.convex samples.concave samples.saddle samples.regions inside_other_bodies** "
     "missing** patterns**"),
    ("no tool but those of the plan is put down", "operations.plans[].operations[].", "slide**"),
    ("no tool but those of the plan is put down", "process.steps[].", "slide**"),
    ("which other setups would do is not looked for", "process.", "hole_setup**"),
    ("what another tool would save is not reckoned", "process.", "chamfers**"),
    ("holes are not looked for again", "holes[].",
     "faces** floor** depth_mm through bottom cone_deg countersink** counterbore** group"),
    ("which other tools would do is not looked for", "holes[].", "missing**"),
    ("the best order of the rotary axes is not looked for", "process.drilling[].", "index_seconds"),
    ("it describes the input", "scope.", "judged_by_kind** not_judged_by_kind**"),
    ("it describes the input", "faces[].", "kind component carrier** neighbours** centre_mm** gap_mm chord_error_mm unjudged"),
    ("it describes the input", "", "part.** libraries** machine.linear** machine.rotary[].** fixtures**"),
    ("it is about the program and its files", "",
     "legend** legend_words** format_version versions** notes** note_codes** split** files** not_written** run**"),
)  # fmt: skip
UNCHECKED = {f"{under}{name}": why for why, under, names in _LISTED for name in names.split()}


def listed(plain: str) -> bool:
    """Whether the pattern of a path may be unchecked."""
    return any(re.fullmatch(re.escape(each).replace(r"\*\*", ".*"), plain) for each in UNCHECKED)


def of_operations() -> set[str]:
    """The listed patterns below `operations`, without the marks of all that is under them."""
    return {each.removeprefix("operations.").removesuffix("**") for each in UNCHECKED if each.startswith("operations.")}
