"""A line of a story."""

from typing import NamedTuple


class Line(NamedTuple):
    """A sentence or two.

    Attributes
    ----------
    text : str
    mark : str
        What kind of line it is, which is set off before it; may be empty.
    typed : str
        What a person may type, as it must be typed.
    minor : bool
        Only for those who ask for all.
    """

    text: str
    mark: str = ""
    typed: str = ""
    minor: bool = False
