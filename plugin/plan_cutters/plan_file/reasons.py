"""Why samples are not reached, in one table, and the colours of verdicts."""

from typing import NamedTuple

#: Of each verdict its colour in sRGB, and what it means, in words for people. Their order is that of the labels along which faces
#: are split, from best to worst.
_VERDICTS = {
    "interference_free": ("#009E73", "interference-free"),
    "accessible": ("#56B4E9", "accessible"),
    "undecided": ("#F0E442", "undecided"),
    "inaccessible": ("#D55E00", "inaccessible"),
    "unjudged": ("#CC79A7", "could not be judged"),
    "inside_bodies": ("#595959", "inside another body: no surface of the finished part"),
    "drilled": ("#0072B2", "drilled: in a hole for a drill, which no mill has to reach"),
    "check": ("#BFBFBF", "not judged (obstacle only)"),
    "ignored": ("#BFBFBF", "ignored: neither judged nor an obstacle"),
    "mixed": ("#E69F00", "mixed: could not be split"),
    "fixture": ("#6E7B8B", "fixture"),
}
PALETTE, MEANING = ({word: each[k] for word, each in _VERDICTS.items()} for k in (0, 1))
LABELS = tuple(PALETTE)
_DARK = "#404040"
#: Colours of operations, the first ones first: Okabe and Ito's, with a dark grey for their black, which hides the form. That of
#: what is not reached, which stands beside operations, comes last.
OPERATIONS = ("#0072B2", "#009E73", "#E69F00", "#56B4E9", "#CC79A7", "#F0E442", _DARK, "#D55E00")


def operation_colour(number: int) -> str:
    """sRGB hex of an operation by its place in its plan, from 0: eight colours, the same at half lightness, and again.

    >>> operation_colour(0), operation_colour(8), operation_colour(16), operation_colour(14)
    ('#0072B2', '#003959', '#0072B2', '#7F7F7F')
    """
    colour = OPERATIONS[number % len(OPERATIONS)]
    if number // len(OPERATIONS) % 2 == 0:
        return colour
    # Half of the dark grey is nearly black: half of white stands for it.
    half = [127] * 3 if colour == _DARK else [each // 2 for each in bytes.fromhex(colour[1:])]
    return "#" + bytes(half).hex().upper()


def label(word: str) -> str:
    """A verdict in a legend: its meaning without what explains it.

    >>> label("inside_bodies"), label("mixed")
    ('inside another body', 'mixed')
    """
    return MEANING[word].partition(":")[0]


def rgb(verdict: str) -> tuple[float, float, float]:
    """sRGB, 0 to 1."""
    return parts(PALETTE[verdict])


def parts(colour: str) -> tuple[float, float, float]:
    """sRGB, 0 to 1, of a hex colour."""
    r, g, b = bytes.fromhex(colour[1:])
    return r / 255, g / 255, b / 255


class Reason(NamedTuple):
    """A reason has words, a hint, a colour and patterns; the samples for which it holds are not stored here."""

    code: str
    name: str  #: A label.
    sentence: str
    #: The things to try first (they are not computed), each with the changes of an answer (`domain.answers.MEANS`) that are this:
    #: none where no answer tries it.
    tries: tuple[tuple[str, tuple[str, ...]], ...]
    colour: str  #: sRGB.
    pattern: str  #: On the page; it shows the same without colour.
    hatch: str  #: The same on sheets, as matplotlib writes it.

    @property
    def hint(self) -> str:
        """All that is to be tried first, in a clause."""
        return ", or ".join(words for words, _ in self.tries)


_SMALLER = (("a smaller radius or corner radius", ("radius", "corner_radius", "cutter")),)
_ANOTHER_SETUP = ("another setup", ("setup", "second_setup"))
_LONGER = ("a longer stick-out", ("stick_out",))

_ROWS = (
    Reason("axis_limit", "axis limit",
           "A posture would serve, but the machine cannot hold it as the part is set up.",
           (_ANOTHER_SETUP, ("a machine that tilts further", ("tilt_limit",))), "#9A9A9A", "lines", "--"),
    Reason("local_gouge", "local gouge", "The surface curves more than the cutter, right at the contact.",
           _SMALLER, "#E69F00", "hatch", "//"),
    Reason("rear_gouge", "rear gouge", "The flutes cut into the part within a cutter's diameter of the contact.",
           _SMALLER, "#D55E00", "back", "\\\\"),
    Reason("collision", "flute collision", "The flutes meet the part farther away.",
           (("a thinner cutter", ("radius", "cutter")),), "#CC79A7", "cross", "xx"),
    Reason("buried", "inside material",
           "The surface lies under or within a body, so nothing can be machined there.",
           (("`--ignore`, if that body is not there when the part is machined", ()),), "#5C3A21", "cross", "**"),
    Reason("tolerance", "tolerance",
           "The tolerance is no smaller than the cutter's own features, or triangles cannot follow the face closely enough.",
           (("a smaller `--tolerance`", ("tolerance",)),), "#B8A94A", "dots", ".."),
    Reason("neck", "neck collision", "The neck is in the way, the flutes are not.",
           (("a thinner or longer neck", ()),), "#882255", "bars", "||"),
    Reason("shank", "shank collision", "The shank is in the way, the flutes are not.",
           (("a thinner shank", ()), _LONGER), "#0072B2", "bars", "++"),
    Reason("holder", "holder collision", "The holder is in the way, the flutes are not.",
           (_LONGER, ("a slimmer holder", ("holder",))), "#332288", "hatch", "oo"),
    Reason("fixture", "fixture", "Without the fixtures the sample would be reached.",
           (("another place for the fixture", ()),), "#117733", "lines", "--"),
    Reason("sharp_edge", "sharp inside edge",
           "Two faces meet without a fillet, and the cutter leaves one of its own radius there.",
           (("a fillet in the model", ()), *_SMALLER), "#44AA99", "dots", ".."),
    Reason("another_setup", "for another setup",
           "The face stands on a table that was proposed, or a vise or chuck grips it; it is left for another setup.",
           (("a clamping that leaves the face free", _ANOTHER_SETUP[1]),), "#88CCEE", "lines", "--"),
)  # fmt: skip
REASONS = {each.code: each for each in _ROWS}


def reason(code: str) -> str:
    """Give the name of a reason: it is empty where there is none, and the code where a newer plan has an unknown reason."""
    return REASONS[code].name if code in REASONS else code.replace("_", " ")


#: What is said instead of the hint where what is around a surface is the body itself.
CLOSED_VOID = "closed void: no cutter gets in"
#: What a cutter gouges or meets, from its lower end up, and all that forbids tilts in the map of a point: where several forbid
#: one, the first counts.
MET = ("local_gouge", "rear_gouge", "collision", "neck", "shank", "holder")
CAUSES = ("axis_limit", *MET, "buried")
#: Why a posture map has nothing at a tilt where nothing is in the way: that is no reason for a sample.
NO_CONTACT = Reason(
    "no_contact", "no contact", "The cutter does not touch at this tilt.", (("another tilt", ()),), "#E5E5E5",
    "plain", "."
)  # fmt: skip
#: Those whose tilts a map of a point lists as intervals: local gouge is a least and a largest tilt.
INTERVALS = (*(cause for cause in CAUSES if cause != "local_gouge"), NO_CONTACT.code)
