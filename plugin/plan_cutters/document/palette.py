"""Colours of the verdicts: Okabe and Ito's set, told apart with any kind of colour vision."""

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
