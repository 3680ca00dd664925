"""A table of formats lists those that are read, and those that are only recognised, with advice on the file to give instead."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from plan_cutters.files.content import Content

#: A function of a content, and of what a room adds to it.
Reader = TypeVar("Reader", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class Format(Generic[Reader]):
    """A format that is read: its name, its usual suffixes, and the functions that recognise and read its content."""

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[Any], bool]
    read: Reader


@dataclass(frozen=True, slots=True)
class Foreign:
    """A foreign format is recognised but not read: it has a name, a test of the content, and advice."""

    name: str
    recognises: Callable[[Any], bool]
    instead: str


def recognised(
    content: Content, formats: Sequence[Format[Reader]], foreign: Iterable[Foreign], *, xml: str, json: str,
    archive: str = "", first: Iterable[Foreign] = (),
) -> Format[Reader]:  # fmt: skip
    """The format of a file; what is known and not read is refused by name, some of it `first`.

    `xml`, `json`, `archive`: what to say of a file of these that is of no format.

    Raises
    ------
    PlanError
        The content's own error.
    """
    # But perhaps a byte-order mark.
    if not content.data.strip(b" \t\r\n\0\xef\xbb\xbf\xff\xfe"):
        raise content.error("is empty", file=content.name)
    _refuse(content, first)
    for form in formats:
        if form.recognises(content):
            return form
    _refuse(content, foreign)
    if archive and content.members is not None:
        raise content.error(f"is a zip archive {archive}", file=content.name)
    if content.head[:1] in ("{", "[") and content.json is None:
        raise content.broken_json()
    if content.head.startswith("<"):
        raise content.error(f"is XML, but {xml}", file=content.name)
    if content.json is not None:
        raise content.error(f"is JSON, but {json}", file=content.name)
    names = dict.fromkeys(f"{form.name} ({' '.join(form.suffixes)})" for form in formats)
    raise content.error(f"is no {content.noun} that is known; read are {', '.join(names)}", file=content.name)


def _refuse(content: Content, foreign: Iterable[Foreign]) -> None:
    for each in foreign:
        if each.recognises(content):
            raise content.error(f"is {each.name}, which is not read: {each.instead}", file=content.name)
