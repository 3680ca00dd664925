"""Colours of verdicts and operations: Okabe and Ito's set, told apart with any kind of colour vision; obstacles are grey."""

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
    "fixture": "#6E7B8B",
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
