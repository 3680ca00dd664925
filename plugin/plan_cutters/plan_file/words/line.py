"""A line of a story."""

from typing import NamedTuple


class Line(NamedTuple):
    """A sentence or two.

    Before it stands its kind (`mark`), behind it what a person may type, as it must be typed. `minor`: only for those who ask
    for all.
    """

    text: str
    mark: str = ""
    typed: str = ""
    minor: bool = False
