"""A listed tool becomes a cutter, or says why it does not: what is missing is never invented, what is said twice must agree."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import Dimensions
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.domain.shapes import MOST_PIECES, SAME, pieces_at_most, top_radius
from plan_cutters.errors import CutterError
from plan_cutters.library.outlines import fewer, joined, up_to
from plan_cutters.library.raw_tool import Listed
from plan_cutters.library.records import Entry

#: Kinds of end mills that are read, by their usual names: what their names promise.
MILLS = {
    "flat end mill": "flat",
    "bull nose end mill": "bull",
    "ball end mill": "ball",
    "tapered mill": "taper",
    "face mill": "face",
    "slot mill": "slot",
    "chamfer mill": "chamfer",
    "dovetail mill": "dovetail",
    "lollipop mill": "lollipop",
}
#: Kinds of which the dimensions alone do not say the outline, or no description of them is public.
_OUTLINE = ("form mill", "radius mill", "thread mill", "circle segment barrel", "circle segment lens", "circle segment oval",
            "circle segment taper", "slitting saw", "slittingsaw", "fillet", "radius", "dovetail", "thread-mill", "threadmill",
            "taperedballnose", "taperballnose", "custom")  # fmt: skip
#: Kinds that finish no sculptured surface, by the words that their names have.
_OTHERS = re.compile(
    r"drill|\btap\b|ream|counter|bore|boring|probe|turning|laser|plasma|waterjet|deposit|holder|inspect|broach|weld"
)
#: Sections between the flutes and the holder that are told apart.
_MOST_ABOVE = 6
#: Dimensions given twice agree up to the rounding of the file, mm and as a share.
_ROUNDED, _SHARE = 1e-3, 1e-5


class UnfitError(Exception):
    """Why a tool is not used; `broken`: it contradicts itself."""

    def __init__(self, why: str, *, broken: bool = False) -> None:
        super().__init__(why)
        self.broken = broken


@dataclass(frozen=True, slots=True)
class Ask:
    """These values are assumed for tools that do not state them.

    stickout : float, optional
        mm.
    holder : Holder, str, optional
        `none`: they are judged without one.
    """

    stickout: float | None = None
    holder: Holder | Literal["none"] | None = None


def entry_of(tool: Listed, ask: Ask) -> Entry:
    """The record of a listed tool."""
    try:
        cutter = _cutter(tool, ask)
    except UnfitError as why:
        return tool.entry(unused=str(why), broken=why.broken)
    except CutterError as error:
        return tool.entry(unused=cause_of(error), broken=True)
    return tool.entry(cutter=cutter)


def cause_of(error: CutterError) -> str:
    """Say the cause of an error without the id of the cutter, because such a cutter cannot exist."""
    head, colon, rest = error.cause.partition(": ")
    return rest if colon and head.startswith("cutter ") else error.cause


def _sort(tool: Listed) -> str:
    """Which mill it is."""
    kind = " ".join((tool.sort or tool.kind).lower().split())
    if kind in MILLS:
        return MILLS[kind]
    said = f'type "{tool.kind}"' if tool.kind else "its type is missing"
    if not tool.kind:
        raise UnfitError(f"{said}: add one, as flat end mill")
    if kind in _OUTLINE:
        raise UnfitError(
            f"{said}: its dimensions here do not say its outline; write it as TOML (docs/tool_libraries.md)"
        )
    if _OTHERS.search(kind):
        raise UnfitError(f"{said}: not a mill that finishes surfaces")
    raise UnfitError(f"{said} is unknown; read are {', '.join(MILLS)}")


def _cutter(tool: Listed, ask: Ask) -> Cutter:
    sort = _sort(tool)
    if tool.faults:
        raise UnfitError("; ".join(tool.faults), broken=True)
    _agree(tool)
    _complete(tool, ask)
    bare = _CUTTING[sort](tool)
    length = _stickout(tool, ask)
    if length < tool.values["LCF"] - _slack(length):
        raise UnfitError(f"the assumed stick-out of {length:g} mm is shorter than its flutes, {tool.said('LCF')}")
    if bare.shape != "lollipop":
        # What is shorter only by rounding ends where its flutes do.
        length = max(length, tool.values["LCF"])
    holder = _holder(tool, ask)
    above = _above(tool, bare, length)
    cutter = _standing(bare, above, length)
    if holder == "none":
        return cutter
    return _held(tool, cutter, holder, own=tool.holder is not None)


def _complete(tool: Listed, ask: Ask) -> None:
    """All that is missing, at once."""
    lacks = [
        f"{tool.word(key)} is missing ({what})"
        for key, what in (("DC", "the cutting diameter"), ("LCF", "the length of its flutes"))
        if key not in tool.values
    ]
    if "LPR" not in tool.values and ask.stickout is None:
        lacks.append(f"{tool.word('LPR')} is missing (the stick-out, from the tip to the holder's nose): add it, or give "
                     "--assume-stickout MM")  # fmt: skip
    if tool.holder is None and ask.holder is None:
        lacks.append("its holder is missing: add it, or give --holder SPEC, as R15L30 (or none)")
    if lacks:
        raise UnfitError("; ".join(lacks))


def _slack(value: float) -> float:
    return _ROUNDED + _SHARE * abs(value)


def _agree(tool: Listed) -> None:
    """Dimensions that bound each other, or are given twice."""
    v = tool.values
    for low, high in (("LCF", "LPR"), ("LCF", "OAL"), ("LPR", "OAL"), ("LCF", "LN"), ("LN", "LPR"), ("LN", "OAL"), ("TIP", "DC"),
                      ("DC", "DCX")):  # fmt: skip
        if low in v and high in v and v[low] > v[high] + _slack(v[high]):
            raise UnfitError(f"{tool.said(low)} is more than {tool.said(high)}", broken=True)
    whole = tool.holder is not None and all(key in v for key in ("LF", "LH", "LPR"))
    if whole and abs(v["LF"] - v["LH"] - v["LPR"]) > _slack(v["LF"]):
        raise UnfitError(f"{tool.said('LF')} is not {tool.said('LH')} and {tool.said('LPR')} together", broken=True)
    if tool.shaft and "OAL" in v and "LCF" in v:
        top = max(v["LCF"], v.get("LN", 0.0)) + math.fsum(stage.length for stage in tool.shaft)
        if top > v["OAL"] + _slack(top):
            raise UnfitError(
                f"its shaft's sections end {top / tool.scale:.10g} over its tip, more than {tool.said('OAL')}",
                broken=True,
            )


def _stickout(tool: Listed, ask: Ask) -> float:
    own = tool.values.get("LPR")
    if own is not None:
        return own
    assert ask.stickout is not None, "_complete asks for it"
    longest = tool.values.get("OAL")
    if longest is not None and ask.stickout > longest + _slack(longest):
        raise UnfitError(f"the assumed stick-out of {ask.stickout:g} mm is longer than the tool, {tool.said('OAL')}")
    tool.notes.append(f"no {tool.word('LPR')}: the assumed stick-out of {ask.stickout:g} mm is taken")
    return ask.stickout


def _holder(tool: Listed, ask: Ask) -> Holder | Literal["none"]:
    if tool.holder is not None:
        return tool.holder
    assert ask.holder is not None, "_complete asks for it"
    if ask.holder == "none":
        tool.notes.append("no holder: it is judged without one, as asked")
        return "none"
    tool.notes.append(f"no holder: the given one is taken, {ask.holder.name or ask.holder.id}")
    return ask.holder


def _ball(tool: Listed, radius: float, promise: str) -> float:
    """The corner radius, and what the tool then is where its name says otherwise."""
    corner = tool.values.get("RE", 0.0)
    if corner > radius + _slack(radius):
        raise UnfitError(f"{tool.said('RE')} is more than half of {tool.said('DC')}", broken=True)
    if not corner and promise == "ball":
        tool.notes.append(f"no {tool.word('RE')}: half of {tool.word('DC')}")
        return radius
    if abs(corner - radius) <= _slack(radius):
        corner = radius
    is_ = "flat" if not corner else "ball" if corner == radius else "bull"
    if promise in ("flat", "bull", "ball") and is_ != promise:
        what = {"flat": "flat end", "bull": "bull nose", "ball": "ball end"}
        why = tool.said("RE") if corner else f"no {tool.word('RE')}"
        tool.notes.append(f'called "{tool.kind}", but {why}: read as a {what[is_]}')
    return corner


def _end(tool: Listed, promise: str) -> Cutter:
    radius, flutes = 0.5 * tool.values["DC"], tool.values["LCF"]
    if "TA" in tool.values:
        tool.notes.append(f'called "{tool.kind}", but {tool.said("TA")}: read as tapered')
        return _leaning(tool, math.radians(tool.values["TA"]))
    if tool.values.get("TIP", 0.0) and abs(tool.values["TIP"] - tool.values["DC"]) > _slack(radius):
        tool.notes.append(f"{tool.said('TIP')} is not used: there is no {tool.word('TA')}")
    return Cutter(radius, flutes, _ball(tool, radius, promise), tool.name, flutes=flutes)


def _leaning(tool: Listed, taper: float) -> Cutter:
    """The diameter of a leaning flank is given at the tip, as if there were no corner."""
    corner, flutes, tip = tool.values.get("RE", 0.0), tool.values["LCF"], tool.values.get("TIP")
    if tip is not None and abs(tip - tool.values["DC"]) > _slack(tip):
        raise UnfitError(
            f"{tool.said('DC')} and {tool.said('TIP')}: which of them is the diameter at its tip? Give that as "
            f"{tool.word('DC')}, and no {tool.word('TIP')}"
        )
    radius = 0.5 * tool.values["DC"] + corner * (1.0 - (1.0 - math.sin(taper)) / math.cos(taper))
    if corner > radius + _slack(radius):
        raise UnfitError(
            f"{tool.said('RE')} does not fit under a flank of {tool.said('TA')} and {tool.said('DC')}", broken=True
        )
    if abs(corner - radius) <= _slack(radius):
        radius = corner = max(radius, corner)
    elif abs(corner - 0.5 * tool.values["DC"]) <= _slack(corner):
        # A half diameter is meant as a ball more often than not: as one it would be given with a smaller diameter.
        ball = 2.0 * corner * (1.0 - math.sin(taper)) / math.cos(taper)
        flat = 2.0 * (radius - corner) / tool.scale
        tool.notes.append(
            f"{tool.said('RE')} is half of {tool.said('DC')}, but its tip keeps a flat {flat:.4g} wide: "
            f"a ball under {tool.said('TA')} deg has {tool.word('DC')} {ball / tool.scale:.6g}"
        )
    return Cutter(radius, flutes, corner, tool.name, flutes=flutes, taper=taper)


def _taper(tool: Listed) -> Cutter:
    if "TA" not in tool.values:
        tool.notes.append(f"no {tool.word('TA')}: read as straight")
        return _end(tool, "taper")
    return _leaning(tool, math.radians(tool.values["TA"]))


def _dovetail(tool: Listed) -> Cutter:
    if "TA" not in tool.values:
        raise UnfitError(f"{tool.word('TA')} is missing: the angle of its flank from the axis")
    return _leaning(tool, -math.radians(tool.values["TA"]))


def _face(tool: Listed) -> Cutter:
    v = tool.values
    leans = "TA" if "TA" in v else "DCX" if v.get("DCX", 0.0) > v["DC"] + _slack(v["DC"]) else ""
    if leans:
        raise UnfitError(f"{tool.said(leans)}: face mills with leaning edges are not read; write its outline as TOML")
    return _end(tool, "face")


def _chamfer(tool: Listed) -> Cutter:
    """A cone from the tip's diameter on, a cylinder where it has become as wide as the tool."""
    v = tool.values
    if "TA" not in v:
        raise UnfitError(f"{tool.word('TA')} is missing: the angle of its flank from the axis")
    if "RE" in v:
        raise UnfitError(
            f"{tool.said('RE')}: chamfer mills with a corner radius are not read; write its outline as TOML"
        )
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
        if radius - wide > _slack(radius):
            tool.notes.append(f"{tool.said('DC')} is not reached: a cone of {tool.said('TA')} deg is {2 * wide / tool.scale:.4g} "
                              f"wide where {tool.said('LCF')} ends")  # fmt: skip
        points.append((min(radius, wide), v["LCF"]))
    return Cutter.form([(round(r, 9), round(h, 9)) for r, h in points], length=v["LCF"], name=tool.name)


def _lollipop(tool: Listed) -> Cutter:
    v = tool.values
    radius, flutes = 0.5 * v["DC"], v["LCF"]
    if "RE" in v and abs(v["RE"] - radius) > _slack(radius):
        raise UnfitError(f"{tool.said('RE')} is not half of {tool.said('DC')}", broken=True)
    if "DN" not in v:
        raise UnfitError(f"{tool.word('DN')} is missing: the diameter of its neck")
    neck = 0.5 * v["DN"]
    if neck >= radius - SAME:
        raise UnfitError(
            f"{tool.said('DN')} is no less than {tool.said('DC')}: a lollipop's neck is thinner", broken=True
        )
    if flutes <= radius:
        raise UnfitError(f"{tool.said('LCF')} ends below the middle of its ball, {tool.said('DC')}", broken=True)
    cut = math.sqrt(max(0.0, radius**2 - (flutes - radius) ** 2))
    if cut > neck + _slack(neck):
        tool.notes.append(
            f"{tool.said('LCF')} cuts the ball off above its middle: so far up its neck is taken that wide"
        )
        neck = round(cut, 9)
    return Cutter.lollipop(radius=radius, neck_radius=neck, length=10 * radius, name=tool.name)


_CUTTING: dict[str, Callable[[Listed], Cutter]] = {
    "flat": lambda tool: _end(tool, "flat"),
    "bull": lambda tool: _end(tool, "bull"),
    "ball": lambda tool: _end(tool, "ball"),
    "slot": lambda tool: _end(tool, "slot"),
    "face": _face,
    "taper": _taper,
    "chamfer": _chamfer,
    "dovetail": _dovetail,
    "lollipop": _lollipop,
}


def _top(bare: Cutter, tool: Listed) -> float:
    """Where what cuts ends, mm over the tip."""
    return bare.stages[0][1] if bare.shape == "lollipop" else tool.values["LCF"]


def _above(tool: Listed, bare: Cutter, length: float) -> tuple[Segment, ...]:
    """The sections from the end of the flutes to the holder's nose."""
    v, at = tool.values, _top(bare, tool)
    found: list[Segment] = []
    shoulder = min(v.get("LN", 0.0), length) - at
    if shoulder > SAME:
        if "DN" not in v:
            tool.notes.append(f"no {tool.word('DN')}: {tool.said('LN')} as wide as {tool.word('DC')}")
        found.append(Segment(0.5 * v.get("DN", v["DC"]), round(shoulder, 9)))
        at += shoulder
    shaft = up_to(tool.shaft, length - at) if length - at > SAME else ()
    found += shaft
    at += math.fsum(stage.length for stage in shaft)
    if length - at > SAME:
        if "DMM" not in v:
            raise UnfitError(f"{tool.word('DMM')} is missing: the diameter of the shank between {at / tool.scale:.10g} and "
                             f"{length / tool.scale:.10g} {tool.unit} over its tip")  # fmt: skip
        found.append(Segment(0.5 * v["DMM"], round(length - at, 9)))
        if v["DMM"] < v["DC"] - _slack(v["DC"]):
            tool.notes.append(f"{tool.said('DMM')} is thinner than {tool.said('DC')}")
        elif v["DMM"] < 2.0 * top_radius(bare) - _slack(v["DMM"]):
            wide = 2.0 * top_radius(bare) / tool.scale
            tool.notes.append(f"{tool.said('DMM')} is thinner than its flutes where they end, {wide:.6g}")
    straight = joined(found)
    if len(straight) <= _MOST_ABOVE:
        return straight
    around, wider = fewer(found, _MOST_ABOVE)
    tool.notes.append(
        f"the {len(straight)} sections of its shaft are taken as {len(around)} around them, up to {wider:.3g} mm wider"
    )
    return around


def _standing(bare: Cutter, above: tuple[Segment, ...], length: float) -> Cutter:
    """A cutter with what stands above its flutes: the last straight section is its shank, the others are its neck."""
    if bare.shape == "lollipop":
        plain = all(stage.radius == stage.upper_radius == bare.shank_radius for stage in above)
        return replace(bare, length=length, neck=None if plain else above)
    if not above:
        return replace(bare, length=length)
    last = above[-1]
    if last.slope:
        return replace(bare, length=length, neck=above)
    return replace(bare, length=length, neck=above[:-1], shank_radius=last.radius)


def _held(tool: Listed, cutter: Cutter, holder: Holder, *, own: bool) -> Cutter:
    """With its holder, of as many sections as can be judged."""
    plain = Holder(joined(holder.stages), holder.name)
    fits: Any = lambda made: pieces_at_most(_with(cutter, made)) <= MOST_PIECES  # noqa: E731
    # A section has three pieces at least: no more than a third of them is worth a trial.
    most = min(len(plain.stages) - 1, MOST_PIECES // 3)
    while not fits(plain) and most > 0:
        stages, wider = fewer(holder.stages, most)
        plain, most = Holder(stages, holder.name), most - 1
        if fits(plain):
            tool.notes.append(
                f"its holder's {len(holder.stages)} sections are taken as {len(stages)} around them, up to {wider:.3g} mm wider"
            )
    try:
        return replace(cutter, holder=plain)
    except CutterError as error:
        raise UnfitError(cause_of(error), broken=own) from None


def _with(cutter: Cutter, holder: Holder) -> Dimensions:
    """The same dimensions with a holder, not yet checked to be a cutter."""
    kept = {word: getattr(cutter, word) for word in Dimensions.__slots__}
    return Dimensions(**{**kept, "holder": holder})
