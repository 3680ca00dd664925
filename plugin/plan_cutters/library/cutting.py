"""The cutting part of a listed tool, by its kind: what its name promises, and what its dimensions say."""

import math
import re
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import SAME
from plan_cutters.library.raw_tool import Entry, FaultError, Listed, name_of, number_of

#: Names of presets for finishing. "Semi-finishing" is none.
_FINISHING = re.compile(r"(?<!semi)(?<!semi[- _])finish|(?<!vor)schlicht", re.IGNORECASE)
#: Feeds that a machine may have, mm/min, as `--feed` has them.
_LEAST, _MOST = 0.1, 1e6


def is_finishing(name: str) -> bool:
    """Whether a preset is for finishing, by its name."""
    return _FINISHING.search(name) is not None


def take_feed(
    tool: Listed, presets: Iterable[tuple[Any, Any]], field: str, number: Callable[[Any, str], float] = number_of
) -> None:
    """Keep the feed of one preset, mm/min; a feed that no machine has is ignored, and noted.

    `tool`: its `scale` turns the feeds into mm/min. `presets`: their names and feeds, as a number or a text, None where it states
    none, in the file's order. `field`: what the file calls the feed. `number`: reads a feed, given it and the field.
    """
    usable = list[tuple[str, float]]()
    for name, stated in presets:
        if stated is None or stated == "":
            continue
        try:
            feed = round(number(stated, field) * tool.scale, 9)
        except (FaultError, OverflowError) as fault:
            tool.notes.append(f"{fault}: no feed")
            continue
        if math.isfinite(feed) and _LEAST <= feed <= _MOST:
            usable.append((name_of(name), feed))
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


#: Dimensions given twice agree up to the rounding of the file, mm and as a share.
_ROUNDED, _SHARE = 1e-3, 1e-5
_CORNER = "the radius of its corner"


class UnfitError(Exception):
    """Why a tool is not used; `broken`: it contradicts itself; `unheld`: it does not fit its holder."""

    def __init__(self, why: str, *, broken: bool = False, unheld: bool = False) -> None:
        super().__init__(why)
        self.broken, self.unheld = broken, unheld


def slack(value: float) -> float:
    """By how much dimensions that are given twice may differ, mm."""
    return _ROUNDED + _SHARE * abs(value)


def must_state(tool: Listed, key: str, what: str) -> None:
    """Refuse a tool whose tip is not known without a dimension; 0 says that it has none."""
    if not tool.states(key):
        raise UnfitError(f"{tool.word(key)} is missing ({what}): add it; 0 says that it has none")


def corner_of(tool: Listed, radius: float, promise: str) -> float:
    """The corner radius, and what the tool then is where its name says otherwise; a flat end has none unless it says so."""
    corner = tool.values.get("RE", 0.0)
    if promise == "ball":
        if not tool.states("RE"):
            tool.notes.append(f"no {tool.word('RE')}: half of {tool.word('DC')}")
            return radius
        if abs(corner - radius) > slack(radius):
            raise UnfitError(
                f'called "{tool.kind}", but {tool.cite("RE")} is not half of {tool.cite("DC")}: correct it, or call it bull nose'
            )
    elif promise in ("bull", "slot", "face", "taper") and tool.kind != "taper":
        must_state(tool, "RE", _CORNER)
    if tool.stated is None and abs(corner - radius) <= slack(radius):
        corner = radius
    is_ = "flat" if not corner else "ball" if corner == radius else "bull"
    if promise in ("flat", "bull", "ball") and is_ != promise:
        what = {"flat": "flat end", "bull": "bull nose", "ball": "ball end"}
        why = tool.cite("RE") if corner else f"no {tool.word('RE')}"
        tool.notes.append(f'called "{tool.kind}", but {why}: read as a {what[is_]}')
    return corner


def note_tapered(tool: Listed) -> None:
    """Note that a mill that is called straight has a half angle."""
    tool.notes.append(f'called "{tool.kind}", but {tool.cite("TA")}: read as tapered')


def _end(tool: Listed, promise: str) -> Cutter:
    radius, flutes = 0.5 * tool.values["DC"], tool.values["LCF"]
    if "TA" in tool.values:
        if promise != "flat":
            must_state(tool, "RE", _CORNER)
        if "RE" in tool.values:
            # With a corner, the axis of the tapered one stands farther from the contact: its shank does not enclose the other's.
            raise UnfitError(
                f'called "{tool.kind}", but {tool.cite("TA")}: is it straight or tapered? '
                f"Leave {tool.word('TA')} out, or call it tapered mill"
            )
        note_tapered(tool)
        return _leaning(tool, math.radians(tool.values["TA"]))
    if tool.values.get("TIP", 0.0) and abs(tool.values["TIP"] - tool.values["DC"]) > slack(radius):
        raise UnfitError(
            f"{tool.cite('TIP')} is not {tool.cite('DC')}, and there is no {tool.word('TA')}: a straight mill has one diameter"
        )
    if tool.values.get("RE", 0.0) > radius + slack(radius):
        raise UnfitError(f"{tool.cite('RE')} is more than half of {tool.cite('DC')}", broken=True)
    return Cutter(radius, flutes, corner_of(tool, radius, promise), tool.name, flutes=flutes)


def _leaning(tool: Listed, taper: float) -> Cutter:
    """The diameter of a leaning flank is given at the tip, as if there were no corner."""
    corner, flutes, tip = tool.values.get("RE", 0.0), tool.values["LCF"], tool.values.get("TIP")
    if tip is not None and abs(tip - tool.values["DC"]) > slack(tip):
        raise UnfitError(
            f"{tool.cite('DC')} and {tool.cite('TIP')}: which of them is the diameter at its tip? Give that as "
            f"{tool.word('DC')}, and no {tool.word('TIP')}"
        )
    radius = 0.5 * tool.values["DC"] + corner * (1.0 - (1.0 - math.sin(taper)) / math.cos(taper))
    if corner > radius + slack(radius):
        raise UnfitError(f"{tool.cite('RE')} does not fit under a flank of {tool.cite('TA')} and {tool.cite('DC')}", broken=True)
    if abs(corner - radius) <= slack(radius):
        radius = corner = max(radius, corner)
    else:
        _no_ball(tool, radius, corner, taper)
    return Cutter(radius, flutes, corner, tool.name, flutes=flutes, taper=taper)


def _no_ball(tool: Listed, radius: float, corner: float, taper: float) -> None:
    """Refuse a tip that keeps a flat where a ball may be meant: its axis stands nearer to the contact, and its shank with it."""
    tip = re.sub(r"[\W_]", "", tool.tapered.lower())
    called = tip == "taperedball"
    if not called and (tip or not corner or abs(corner - 0.5 * tool.values["DC"]) > slack(corner)):
        return
    why = f'called "{tool.tapered}"' if called else f"{tool.cite('RE')} is half of {tool.cite('DC')}, as of a ball"
    ball = 2.0 * corner * (1.0 - math.sin(taper)) / math.cos(taper)
    raise UnfitError(
        f"{why}, but its tip keeps a flat {2.0 * (radius - corner) / tool.scale:.4g} wide: {tool.word('DC')} of a ball of "
        f"{tool.cite('RE')} under {tool.cite('TA')} deg is {ball / tool.scale:.6g}; correct it, or say tapered_bull_nose"
    )


def _taper(tool: Listed) -> Cutter:
    if re.sub(r"[\W_]", "", tool.tapered.lower()) not in ("", "taperedball", "taperedbullnose"):
        raise UnfitError(f'called "{tool.tapered}": tapered_ball and tapered_bull_nose are read')
    must_state(tool, "RE", _CORNER)
    must_state(tool, "TA", "the angle of its flank from the axis")
    if "TA" not in tool.values:
        tool.notes.append(f"{tool.word('TA')} 0: read as straight")
        return _end(tool, "taper")
    return _leaning(tool, math.radians(tool.values["TA"]))


def _dovetail(tool: Listed) -> Cutter:
    must_state(tool, "RE", _CORNER)
    return _leaning(tool, -math.radians(tool.values["TA"]))


def _face(tool: Listed) -> Cutter:
    v = tool.values
    taper_word = "TA" if "TA" in v else "DCX" if v.get("DCX", 0.0) > v["DC"] + slack(v["DC"]) else ""
    if taper_word:
        raise UnfitError(f"{tool.cite(taper_word)}: face mills with leaning edges are not read; write its outline as TOML")
    if not tool.states("DCX"):
        must_state(tool, "TA", "the angle of its edges from the axis")
    return _end(tool, "face")


def _chamfer(tool: Listed) -> Cutter:
    """A cone from the tip's diameter on, a cylinder where it has become as wide as the tool."""
    v = tool.values
    if "RE" in v:
        raise UnfitError(f"{tool.cite('RE')}: chamfer mills with a corner radius are not read; write its outline as TOML")
    must_state(tool, "TIP", "the diameter at its tip")
    radius, tip, slope = 0.5 * v["DC"], 0.5 * v.get("TIP", 0.0), math.tan(math.radians(v["TA"]))
    height = (radius - tip) / slope
    points = [(0.0, 0.0), (tip, 0.0)] if tip else [(0.0, 0.0)]
    if not tip:
        tool.notes.append(f"no {tool.word('TIP')}: its tip is a point, which finishes nothing")
    if tip >= radius - SAME:
        points.append((radius, v["LCF"]))
    elif height < v["LCF"] - SAME:
        points += [(radius, height), (radius, v["LCF"])]
    else:
        wide = tip + v["LCF"] * slope
        if radius - wide > slack(radius):
            tool.notes.append(
                f"{tool.cite('DC')} is not reached: a cone of {tool.cite('TA')} deg is {2 * wide / tool.scale:.4g} "
                f"wide where {tool.cite('LCF')} ends"
            )
        points.append((min(radius, wide), v["LCF"]))
    return Cutter.form([(round(r, 9), round(h, 9)) for r, h in points], length=v["LCF"], name=tool.name)


def agree_ball(tool: Listed) -> None:
    """Refuse a lollipop whose corner radius is not that of its ball."""
    v = tool.values
    if "RE" in v and abs(v["RE"] - 0.5 * v["DC"]) > slack(0.5 * v["DC"]):
        raise UnfitError(f"{tool.cite('RE')} is not half of {tool.cite('DC')}", broken=True)


def _lollipop(tool: Listed) -> Cutter:
    v = tool.values
    radius, flutes = 0.5 * v["DC"], v["LCF"]
    agree_ball(tool)
    for key in ("TA", "TIP"):
        if key in v:
            raise UnfitError(f"{tool.cite(key)}: a lollipop has neither a cone nor a flat; write its outline as TOML")
    neck = 0.5 * v["DN"]
    if neck >= radius - SAME:
        raise UnfitError(f"{tool.cite('DN')} is no less than {tool.cite('DC')}: a lollipop's neck is thinner", broken=True)
    if flutes <= radius:
        raise UnfitError(f"{tool.cite('LCF')} ends below the middle of its ball, {tool.cite('DC')}", broken=True)
    cut = math.sqrt(max(0.0, radius**2 - (flutes - radius) ** 2))
    if cut > neck + slack(neck):
        tool.notes.append(f"{tool.cite('LCF')} cuts the ball off above its middle: so far up its neck is taken that wide")
        neck = round(cut, 9)
    return Cutter.lollipop(radius=radius, neck_radius=neck, length=10 * radius, name=tool.name)


CUTTING: dict[str, Callable[[Listed], Cutter]] = {
    "flat": partial(_end, promise="flat"),
    "bull": partial(_end, promise="bull"),
    "ball": partial(_end, promise="ball"),
    "slot": partial(_end, promise="slot"),
    "face": _face,
    "taper": _taper,
    "chamfer": _chamfer,
    "dovetail": _dovetail,
    "lollipop": _lollipop,
}
