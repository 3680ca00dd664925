"""The laws by their names: a law is a function of one case that raises where it falls, and how its cases are drawn."""

from collections.abc import Callable
from typing import Any, NamedTuple

from hypothesis import strategies as st


class Law(NamedTuple):
    """A law, its cases, and the seconds of processor time that one of them may take."""

    name: str
    holds: Callable[[Any], None]
    cases: st.SearchStrategy
    seconds: float

    @property
    def words(self):
        return " ".join((self.holds.__doc__ or "").split())


LAWS: dict[str, Law] = {}


def law(cases, *, seconds=60.0):
    """Enter a function among the laws."""

    def entered(function):
        LAWS[function.__name__] = Law(function.__name__, function, cases, seconds)
        return function

    return entered
