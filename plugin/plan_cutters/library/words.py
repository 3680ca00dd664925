"""Cutters and holders given by words, as libraries: so that they are shown and drawn as the tools of a file are."""

from collections.abc import Sequence

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.standard_holders import words
from plan_cutters.library.raw_tool import Entry, Library

#: How far a gauge pin stands out of a holder that is drawn, mm.
_PIN = 40.0


def of_words(specs: Sequence[str], holder: Holder | None) -> Library:
    """The cutters of texts such as `D12L80`, each in a holder if one is given.

    Raises
    ------
    CutterError
        A text is none, or the holder does not take the cutter.
    """
    made = [(spec, Cutter.parse(spec).asked(0.0, 0.0, holder)) for spec in specs]
    return Library("--cutter", "words of the command line", tuple(Entry(spec, cutter=each) for spec, each in made))


def standard() -> dict[str, Holder]:
    """The built-in holders by their words."""
    return {word: Holder.parse(word) for word in words()}


def pinned() -> list[Library]:
    """The built-in holders, each with a pin of the largest shank that it takes; a library for each, for some are alike."""
    pins = []
    for word, holder in standard().items():
        bore = holder.bore or 0.0
        pin = Cutter(bore / 2.0, _PIN, name=f"{holder.name} with a pin D{bore:g}", holder=holder)
        pins.append(Library("--list-holders", "built-in holders", (Entry(word, name=pin.name, cutter=pin),)))
    return pins
