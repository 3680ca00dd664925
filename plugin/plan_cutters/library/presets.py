"""Feeds that libraries state beside their tools: of several presets the one for finishing."""

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from plan_cutters.library.raw_tool import FaultError, Listed, name_of, number_of
from plan_cutters.library.records import Entry

#: Names of presets for finishing. "Semi-finishing" is none.
_FINISHING = re.compile(r"(?<!semi)(?<!semi[- _])finish|(?<!vor)schlicht", re.IGNORECASE)
#: Feeds that a machine may have, mm/min, as `--feed` has them.
_LEAST, _MOST = 0.1, 1e6


@dataclass(frozen=True, slots=True)
class Preset:
    """A preset as a file lists it: its name, and its feed as a number or a text; None where it states none."""

    name: str
    feed: Any


def is_finishing(name: str) -> bool:
    """Whether a preset is for finishing, by its name."""
    return _FINISHING.search(name) is not None


def take_feed(tool: Listed, presets: Iterable[Preset], field: str, number: Callable[[Any, str], float] = number_of) -> None:
    """Keep the feed of one preset, mm/min; a feed that no machine has is ignored, and noted.

    Parameters
    ----------
    tool : Listed
        Its `scale` turns the feeds into mm/min.
    presets : iterable of Preset
        In the file's order.
    field : str
        What the file calls the feed.
    number : callable
        Reads a feed, given it and the field.
    """
    usable = list[tuple[str, float]]()
    for preset in presets:
        name = name_of(preset.name)
        if preset.feed is None or preset.feed == "":
            continue
        try:
            feed = round(number(preset.feed, field) * tool.scale, 9)
        except (FaultError, OverflowError) as fault:
            tool.notes.append(f"{fault}: no feed")
            continue
        if math.isfinite(feed) and _LEAST <= feed <= _MOST:
            usable.append((name, feed))
        else:
            tool.notes.append(f"{field} of {feed:g} mm/min is no feed")
    if not usable:
        return
    tool.preset, tool.feed = next((each for each in usable if is_finishing(each[0])), usable[0])
    if len({feed for _, feed in usable}) > 1:
        which = "its finishing preset" if is_finishing(tool.preset) else "the first of its presets"
        tool.notes.append(f'feed of {which}, "{tool.preset}": {tool.feed:g} mm/min')


def feed_of(entries: Sequence[Entry]) -> float | None:
    """The feed of a cutter by all places at which libraries list it, mm/min: of a preset for finishing, else the first."""
    stated = [each for each in entries if each.feed is not None]
    return next((each.feed for each in stated if is_finishing(each.preset)), stated[0].feed if stated else None)
