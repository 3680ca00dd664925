"""Colours of verdicts and operations: Okabe and Ito's set, told apart with any kind of colour vision."""

#: Verdict -> sRGB hex. Their order is that of the labels along which faces are split, from best to worst.
PALETTE = {
    "interference_free": "#009E73",
    "accessible": "#56B4E9",
    "undecided": "#F0E442",
    "inaccessible": "#D55E00",
    "unjudged": "#CC79A7",
    "inside_bodies": "#595959",
    "check": "#BFBFBF",
    "ignored": "#BFBFBF",
    "mixed": "#E69F00",
    "fixture": "#0072B2",
}
LABELS = tuple(PALETTE)
#: Colours of operations: the set again. Those come last that are like what is not reached, and black, as a grey on which a
#: form can still be seen.
_OPERATIONS = ("#56B4E9", "#009E73", "#CC79A7", "#E69F00", "#0072B2", "#F0E442", "#D55E00", "#404040")
#: Each time that they come round: what is left of their lightness, and the pattern upon it.
_ROUNDS = ((1.0, "plain"), (0.5, "hatch"), (1.0, "cross"), (0.5, "dots"))
#: What each of them means, in words for people.
MEANING = {
    "interference_free": "interference-free",
    "accessible": "accessible",
    "undecided": "undecided",
    "inaccessible": "inaccessible",
    "unjudged": "could not be judged",
    "inside_bodies": "inside another body: no surface of the finished part",
    "check": "not judged (obstacle only)",
    "ignored": "ignored: neither judged nor an obstacle",
    "mixed": "mixed: could not be split",
    "fixture": "fixture",
}


def label(word: str) -> str:
    """A verdict in a legend: its meaning without what explains it.

    >>> label("inside_bodies"), label("mixed")
    ('inside another body', 'mixed')
    """
    return MEANING[word].partition(":")[0]


def rgb(verdict: str) -> tuple[float, float, float]:
    """sRGB, 0 to 1."""
    r, g, b = bytes.fromhex(PALETTE[verdict][1:])
    return r / 255, g / 255, b / 255


def operation_look(number: int) -> tuple[str, str]:
    """Colour, sRGB hex, and pattern of an operation, counted from 0 for the largest.

    >>> operation_look(0), operation_look(8)
    (('#56B4E9', 'plain'), ('#2B5A74', 'hatch'))
    """
    turn, k = divmod(number, len(_OPERATIONS))
    light, pattern = _ROUNDS[turn % len(_ROUNDS)]
    return "#" + "".join(f"{round(light * each):02X}" for each in bytes.fromhex(_OPERATIONS[k][1:])), pattern
