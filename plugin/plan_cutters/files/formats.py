"""A table of formats lists those that are read, and those that are only recognised, with advice on the file to give instead."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from plan_cutters.errors import PlanError
from plan_cutters.files.content import Content

Asked = TypeVar("Asked")
Read = TypeVar("Read")


@dataclass(frozen=True, slots=True)
class Format(Generic[Asked, Read]):
    """A format that is read: its name, its usual suffixes, how its content is recognised, and read with what is asked for."""

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[Any], bool]
    read: Callable[[Any, Asked], Read]


@dataclass(frozen=True, slots=True)
class Foreign:
    """A foreign format is recognised but not read: it has a name, a test of the content, and advice."""

    name: str
    recognises: Callable[[Any], bool]
    instead: str


def refused(content: Content, foreign: Iterable[Foreign]) -> None:
    """Refuse by name what is known and not read.

    Raises
    ------
    PlanError
        The content's own error.
    """
    for each in foreign:
        if each.recognises(content):
            raise content.error(f"is {each.name}, which is not read: {each.instead}", file=content.name)


def is_blank(content: Content) -> bool:
    """Whether a file holds nothing, but perhaps a byte-order mark."""
    return not content.data.strip(b" \t\r\n\0\xef\xbb\xbf\xff\xfe")


def unknown(content: Content, formats: Iterable[Format[Any, Any]]) -> PlanError:
    """Why a file is none of those that are read: all of them by name."""
    names = dict.fromkeys(f"{form.name} ({' '.join(form.suffixes)})" for form in formats)
    return content.error(f"is no {content.noun} that is known; read are {', '.join(names)}", file=content.name)
