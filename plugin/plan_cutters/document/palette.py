"""Colours of the verdicts: Okabe and Ito's set, told apart with any kind of colour vision."""

#: Verdict -> sRGB hex. Their order is that of the labels along which faces are split, from best to worst.
PALETTE = {
    "interference_free": "#009E73",
    "accessible": "#56B4E9",
    "undecided": "#F0E442",
    "inaccessible": "#D55E00",
    "unjudged": "#CC79A7",
    "check": "#BFBFBF",
    "ignored": "#BFBFBF",
    "mixed": "#E69F00",
    "fixture": "#0072B2",
}
LABELS = tuple(PALETTE)


def rgb(verdict: str) -> tuple[float, float, float]:
    """sRGB, 0 to 1."""
    r, g, b = bytes.fromhex(PALETTE[verdict][1:])
    return r / 255, g / 255, b / 255
