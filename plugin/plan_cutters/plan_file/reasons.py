"""The reasons for which a sample is not reached: the only table of their words, colours and patterns.

It stands below all who tell of them: the answers in `plan.json`, the terminal, the review page (through its data) and pictures.
To add a reason, add its row here, its place in `verdicts.REASONS`, and the kernel or stage that finds it.
"""

from typing import NamedTuple


class Reason(NamedTuple):
    """A reason has words, a hint, a colour and patterns; the samples for which it holds are not stored here.

    `name` is a label, `noun` stands after "lost to", `hint` is the thing to try first (it is not computed). `colour` is sRGB;
    `pattern`, on the page, and `hatch`, on sheets as matplotlib writes it, show the same without colour.
    """

    code: str
    name: str
    noun: str
    sentence: str
    hint: str
    colour: str
    pattern: str
    hatch: str


_ROWS = (
    Reason("axis_limit", "axis limit", "the limits of axis and tilt",
           "A posture would serve, but the machine cannot hold it as the part is set up.",
           "another setup, or a machine that tilts further", "#9A9A9A", "lines", "--"),
    Reason("local_gouge", "local gouge", "local gouge", "The surface curves more than the cutter, right at the contact.",
           "a smaller radius or corner radius", "#E69F00", "hatch", "//"),
    Reason("rear_gouge", "rear gouge", "rear gouge", "The flutes cut into the part within a cutter's diameter of the contact.",
           "a smaller radius or corner radius", "#D55E00", "back", "\\\\"),
    Reason("collision", "flute collision", "collision", "The flutes meet the part farther away.", "a thinner cutter",
           "#CC79A7", "cross", "xx"),
    Reason("buried", "inside material", "a body around them",
           "The surface lies under or within a body, so nothing can be machined there.",
           "--ignore, if that body is not there when the part is machined", "#5C3A21", "cross", "**"),
    Reason("tolerance", "tolerance", "the tolerance",
           "The tolerance is no smaller than the cutter's own features, or triangles cannot follow the face closely enough.",
           "a smaller --tolerance", "#B8A94A", "dots", ".."),
    Reason("neck", "neck collision", "the neck", "The neck is in the way, the flutes are not.", "a thinner or longer neck",
           "#882255", "bars", "||"),
    Reason("shank", "shank collision", "the shank", "The shank is in the way, the flutes are not.",
           "a thinner shank or a longer stick-out", "#0072B2", "bars", "++"),
    Reason("holder", "holder collision", "the holder", "The holder is in the way, the flutes are not.",
           "a longer stick-out or a slimmer holder", "#332288", "hatch", "oo"),
    Reason("fixture", "fixture", "the fixtures", "Without the fixtures the sample would be reached.",
           "another place for the fixture", "#117733", "lines", "--"),
    Reason("sharp_edge", "sharp inside edge", "sharp inside edges",
           "Two faces meet without a fillet, and the cutter leaves one of its own radius there.",
           "a fillet in the model, or a smaller radius or corner radius", "#44AA99", "dots", ".."),
    Reason("another_setup", "for another setup", "what was proposed to hold the part",
           "The face stands on a table that was proposed, or a vise or chuck grips it; it is left for another setup.",
           "another setup, or a clamping that leaves it free", "#88CCEE", "lines", "--"),
)  # fmt: skip
REASONS = {each.code: each for each in _ROWS}
#: What is said instead of the hint where what is around a surface is the body itself.
CLOSED_VOID = "closed void: no cutter gets in"
#: What a cutter gouges or meets, from its lower end up, and all that forbids tilts in the map of a point: where several forbid
#: one, the first counts.
MET = ("local_gouge", "rear_gouge", "collision", "neck", "shank", "holder")
CAUSES = ("axis_limit", *MET, "buried")
#: Why a posture map has nothing at a tilt where nothing is in the way: that is no reason for a sample.
NO_CONTACT = Reason(
    "no_contact", "no contact", "no contact", "The cutter does not touch at this tilt.", "another tilt", "#E5E5E5", "plain", "."
)
#: Those whose tilts a map of a point lists as intervals: local gouge is a least and a largest tilt.
INTERVALS = (*(cause for cause in CAUSES if cause != "local_gouge"), NO_CONTACT.code)
