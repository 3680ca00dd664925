"""A listed tool becomes a cutter, or says why it does not: what is missing is never invented, what is said twice must agree."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, Literal

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import Dimensions
from plan_cutters.domain.drill import Drill, Kind
from plan_cutters.domain.figures import mm
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.domain.shapes import MOST_PIECES, SAME, flute_length, pieces_at_most, top_radius
from plan_cutters.domain.thread import thread_of
from plan_cutters.errors import CutterError, HolderFitError
from plan_cutters.library.cutting import CUTTING, UnfitError, agree_ball, corner_of, note_tapered, slack
from plan_cutters.library.raw_tool import Entry, Listed

#: Digits of lengths and radii, mm; see `listed`.
_DIGITS = 9


def fewer(stages: Sequence[Segment], most: int = 0) -> tuple[tuple[Segment, ...], float]:
    """At most so many sections that enclose the given ones, and by how much they are wider at most, mm.

    Without a number the outline stays the same, with what goes on straight in one section.
    """
    # Each section with what it stands for, so that what is added is measured against the truth.
    merged = [(stage, [stage]) for stage in stages]
    worst = 0.0
    both = [_enclosing([*a, *b]) for (_, a), (_, b) in pairwise(merged)]
    while len(merged) > 1:
        i = min(range(len(both)), key=lambda k: both[k][1])
        stage, added = both[i]
        if added > SAME and (most == 0 or len(merged) <= most):
            break
        worst = max(worst, added)
        merged[i : i + 2] = [(stage, [*merged[i][1], *merged[i + 1][1]])]
        del both[i]
        # Only what it now stands beside is new.
        for k in (i - 1, i):
            if 0 <= k < len(both):
                both[k] = _enclosing([*merged[k][1], *merged[k + 1][1]])
    return tuple(stage for stage, _ in merged), worst if worst > SAME else 0.0


def _enclosing(stages: Sequence[Segment]) -> tuple[Segment, float]:
    """One section around several, a cone or a cylinder, and by how much it is wider at most, mm."""
    length = round(sum(stage.length for stage in stages), _DIGITS)
    corners, at = [], 0.0
    for stage in stages:
        corners += [(at, stage.radius), (at + stage.length, stage.upper_radius)]
        at += stage.length
    wide = max(r for _, r in corners)
    cylinder = Segment(wide, length), wide - min(r for _, r in corners)
    low, high = corners[0][1], corners[-1][1]
    over = [low + (high - low) * z / at - r for z, r in corners]
    if min(over) < -SAME or max(over) >= cylinder[1]:
        return cylinder
    return Segment(low, length, high), max(over)


def up_to(stages: Sequence[Segment], length: float) -> tuple[Segment, ...]:
    """Sections from the bottom up, those beyond a height cut off there."""
    segments, at = [], 0.0
    for stage in stages:
        remaining = length - at
        if remaining <= SAME:
            break
        if stage.length <= remaining + SAME:
            segments.append(stage)
        else:
            upper = stage.radius + stage.slope * remaining
            segments.append(Segment(stage.radius, round(remaining, _DIGITS), round(upper, _DIGITS)))
        at += stage.length
    return tuple(segments)


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
#: Kinds of tools for holes, by their usual names.
_DRILLS: dict[str, Kind] = {
    "drill": "drill", "center drill": "centre drill", "centre drill": "centre drill", "spot drill": "centre drill",
    "reamer": "reamer", "tap": "tap", "tap right hand": "tap", "tap left hand": "tap", "counter sink": "countersink",
    "countersink": "countersink", "counter bore": "counterbore", "counterbore": "counterbore",
}  # fmt: skip
#: Kinds of which the dimensions alone do not say the outline, or no description of them is public.
_OUTLINE = ("form mill", "radius mill", "thread mill", "circle segment barrel", "circle segment lens", "circle segment oval",
            "circle segment taper", "slitting saw", "slittingsaw", "fillet", "radius", "dovetail", "thread-mill", "threadmill",
            "taperedballnose", "taperballnose", "custom")  # fmt: skip
#: Kinds that finish no sculptured surface, by the words that their names have.
_OTHERS = re.compile(
    r"drill|\btap\b|ream|counter|bore|boring|probe|turning|laser|plasma|waterjet|deposit|holder|inspect|broach|weld"
)
#: What a tool may need, in words.
_NEEDED = {
    "DC": "the cutting diameter",
    "LCF": "the length of its flutes",
    "TA": "the angle of its flank from the axis",
    "DN": "the diameter of its neck",
    "LN": "the length of its neck",
    "outline": "points [[z, r], ...] from the tip up",
}
#: Kinds that need more than all others do.
_NEEDS = {"dovetail": ("TA",), "chamfer": ("TA",), "lollipop": ("DN",)}
#: The thread in a tap's name has its diameter, within this, mm.
_NAMED = 0.02
#: Sections between the flutes and the holder that are told apart.
_MOST_ABOVE = 6


@dataclass(frozen=True, slots=True)
class Ask:
    """These values are assumed for tools that do not state them."""

    stickout: float | None = None  #: mm.
    holder: Holder | Literal["none"] | None = None  #: `none`: they are judged without one.


def entry_of(tool: Listed, ask: Ask) -> Entry:
    """The record of a listed tool."""
    if (kind := kind_of_drill(tool)) is not None:
        return _drill(tool, kind, ask)
    try:
        cutter = _cutter(tool, _sort(tool), ask)
    except UnfitError as why:
        return tool.entry(unused=str(why), broken=why.broken, unheld=why.unheld)
    except CutterError as error:
        return tool.entry(unused=cause_of(error), broken=True, unheld=isinstance(error, HolderFitError))
    return tool.entry(cutter=cutter)


def kind_of_drill(tool: Listed) -> Kind | None:
    """Tell what it is where it is a tool for holes."""
    return _DRILLS.get(" ".join((tool.sort or tool.kind).lower().replace("_", " ").split()))


def _drill(tool: Listed, kind: Kind, ask: Ask) -> Entry:
    """The record of a tool for holes: of one that cannot be read nothing depends."""
    if tool.flutes_everywhere and "LPR" not in tool.values and ask.stickout is not None:
        tool.values.setdefault("LCF", ask.stickout)
    elif tool.flutes_everywhere and "LPR" in tool.values:
        tool.values.setdefault("LCF", tool.values["LPR"])
    try:
        body = replace(_cutter(tool, "flat", ask), name=tool.name)
    except (UnfitError, CutterError) as error:
        why = cause_of(error) if isinstance(error, CutterError) else str(error)
        return tool.entry(unused=f"{kind}: {why}")
    pitch, reverse = _pitch(tool, body) if kind == "tap" else (None, False)
    point = math.radians(tool.values["SIG"]) if "SIG" in tool.values else None
    return tool.entry(drill=Drill(kind, body, point, pitch, reverse))


def _pitch(tool: Listed, body: Cutter) -> tuple[float | None, bool]:
    """The pitch of a tap, mm, or that of the thread in its name, and whether it turns to the left."""
    reverse, named = tool.reverse or "left" in tool.kind.lower(), thread_of(tool.name, whole=False)
    if "TP" not in tool.values:
        if named is None or abs(named.diameter - 2.0 * body.radius) > _NAMED:
            tool.notes.append(f"{tool.word('TP')} is missing (the pitch of its thread): it taps no hole")
            return None, reverse
        tool.notes.append(f"no {tool.word('TP')}: the pitch of {named.name}, as its name has it, is taken")
        return named.pitch, reverse or named.left
    return tool.values["TP"], reverse


def cause_of(error: CutterError) -> str:
    """Say the cause of an error without the id of the cutter, because such a cutter cannot exist."""
    head, colon, rest = error.cause.partition(": ")
    return rest if colon and head.startswith("cutter ") else error.cause


def _sort(tool: Listed) -> str:
    if tool.stated is not None:
        return tool.kind
    kind = " ".join((tool.sort or tool.kind).lower().split())
    if kind in MILLS:
        return MILLS[kind]
    if not tool.kind:
        raise UnfitError("its type is missing: add one, as flat end mill")
    text = f'type "{tool.kind}"'
    if kind in _OUTLINE:
        raise UnfitError(f"{text}: its dimensions here do not say its outline; write it as TOML (docs/tool_libraries.md)")
    if _OTHERS.search(kind):
        raise UnfitError(f"{text}: not a mill that finishes surfaces")
    raise UnfitError(f"{text} is unknown; read are {', '.join(MILLS)}")


def _cutter(tool: Listed, sort: str, ask: Ask) -> Cutter:
    if tool.faults:
        raise UnfitError("; ".join(tool.faults), broken=True)
    if tool.doubts:
        raise UnfitError("; ".join(tool.doubts))
    _agree(tool)
    _complete(tool, (*tool.needs, *_NEEDS.get(sort, ())), ask)
    if tool.stated is not None:
        return _as_stated(tool, tool.stated, ask)
    _end_flutes(tool, ask)
    bare = CUTTING[sort](tool)
    widest = max(tool.values["DC"], 2.0 * top_radius(bare))
    if tool.values.get("DCX", 0.0) > widest + slack(widest):
        raise UnfitError(f"{tool.cite('DCX')} is wider than all that its other dimensions say: {widest / tool.scale:.6g}")
    length = _stickout(tool, ask)
    if length < tool.values["LCF"] - slack(length):
        raise UnfitError(f"the assumed stick-out of {length:g} mm is shorter than its flutes, {tool.cite('LCF')}")
    if bare.shape != "lollipop":
        # What is shorter only by rounding ends where its flutes do.
        length = max(length, tool.values["LCF"])
    holder = _holder(tool, ask)
    return _held(tool, _with_length(bare, _above(tool, bare, length), length), holder)


def _complete(tool: Listed, needs: tuple[str, ...], ask: Ask) -> None:
    lacks = [f"{tool.word(key)} is missing ({_NEEDED[key]})" for key in needs if key not in tool.values]
    if "LPR" not in tool.values and ask.stickout is None:
        lacks.append(
            f"{tool.word('LPR')} is missing (the stick-out, from the tip to the holder's nose): add it, or give "
            "--assume-stickout MM"
        )
    if tool.holder is None and ask.holder is None:
        lacks.append("its holder is missing: add it, or give --holder SPEC, as R15L30 (or none)")
    if lacks:
        raise UnfitError("; ".join(lacks))


def _end_flutes(tool: Listed, ask: Ask) -> None:
    """End the flutes of a tool that is all flutes, as its file has it, at the stick-out that is assumed for it."""
    flutes, whole = tool.values.get("LCF", 0.0), tool.values.get("OAL")
    if "LPR" in tool.values or ask.stickout is None or whole is None or flutes < whole - slack(whole):
        return
    if ask.stickout < flutes - slack(flutes):
        tool.notes.append(f"{tool.cite('LCF')} is all of it: its flutes end at the assumed stick-out, {mm(ask.stickout)}")
        tool.values["LCF"] = ask.stickout


def _agree(tool: Listed) -> None:
    """Dimensions that bound each other, or are given twice."""
    v = tool.values
    for low, high in (("LCF", "LPR"), ("LCF", "OAL"), ("LPR", "OAL"), ("LCF", "LN"), ("LN", "LPR"), ("LN", "OAL"), ("TIP", "DC"),
                      ("DC", "DCX")):  # fmt: skip
        if low in v and high in v and v[low] > v[high] + slack(v[high]):
            raise UnfitError(f"{tool.cite(low)} is more than {tool.cite(high)}", broken=True)
    whole = tool.holder is not None and all(key in v for key in ("LF", "LH", "LPR"))
    if whole and abs(v["LF"] - v["LH"] - v["LPR"]) > slack(v["LF"]):
        raise UnfitError(f"{tool.cite('LF')} is not {tool.cite('LH')} and {tool.cite('LPR')} together", broken=True)
    if tool.shaft and "OAL" in v and "LCF" in v:
        top = max(v["LCF"], v.get("LN", 0.0)) + math.fsum(stage.length for stage in tool.shaft)
        if top > v["OAL"] + slack(top):
            raise UnfitError(
                f"its shaft's sections end {top / tool.scale:.10g} over its tip, more than {tool.cite('OAL')}", broken=True
            )


def _stickout(tool: Listed, ask: Ask) -> float:
    own = tool.values.get("LPR")
    if own is not None:
        return own
    assert ask.stickout is not None, "_complete asks for it"
    longest = tool.values.get("OAL")
    if longest is not None and ask.stickout > longest + slack(longest):
        raise UnfitError(f"the assumed stick-out of {ask.stickout:g} mm is longer than the tool, {tool.cite('OAL')}")
    tool.notes.append(f"no {tool.word('LPR')}: the assumed stick-out of {mm(ask.stickout)} is taken")
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


def _above(tool: Listed, bare: Cutter, length: float) -> tuple[Segment, ...]:
    """The sections from the end of the flutes to the holder's nose."""
    # From where what cuts ends, over the tip.
    v, at = tool.values, bare.stages[0][1] if bare.shape == "lollipop" else tool.values["LCF"]
    segments: list[Segment] = []
    neck = 0.5 * v["DN"] if "DN" in v and "LN" not in v else 0.0
    if neck and tool.shaft:
        raise UnfitError(f"{tool.word('LN')} is missing: where its shaft's sections begin over {tool.cite('DN')}")
    shoulder = min(v.get("LN", 0.0), length) - at
    if shoulder > SAME:
        if "DN" not in v:
            tool.notes.append(f"no {tool.word('DN')}: {tool.cite('LN')} as wide as {_widest(tool, bare)}")
        segments.append(Segment(0.5 * v["DN"] if "DN" in v else _wide(bare, v["DC"]), round(shoulder, 9)))
        at += shoulder
    shaft = up_to(tool.shaft, length - at) if length - at > SAME else ()
    segments += shaft
    at += math.fsum(stage.length for stage in shaft)
    if length - at > SAME:
        segments.append(Segment(max(_shank(tool, at, length), neck), round(length - at, 9)))
        if neck:
            tool.notes.append(f"how high {tool.cite('DN')} reaches is not known: what stands above its flutes is no thinner")
        if v["DMM"] < v["DC"] - slack(v["DC"]):
            tool.notes.append(f"{tool.cite('DMM')} is thinner than {tool.cite('DC')}")
        elif v["DMM"] < 2.0 * top_radius(bare) - slack(v["DMM"]):
            wide = 2.0 * top_radius(bare) / tool.scale
            tool.notes.append(f"{tool.cite('DMM')} is thinner than its flutes where they end, {wide:.6g}")
    straight, _ = fewer(segments)
    if len(straight) <= _MOST_ABOVE:
        return straight
    envelope, wider = fewer(segments, _MOST_ABOVE)
    tool.notes.append(
        f"the {len(straight)} sections of its shaft are taken as {len(envelope)} around them, up to {mm(wider)} wider"
    )
    return envelope


def _wide(bare: Cutter, diameter: float) -> float:
    """The radius of a shoulder without one, mm: no flute reaches farther out."""
    return round(max(0.5 * diameter, top_radius(bare)), 9)


def _widest(tool: Listed, bare: Cutter) -> str:
    wide = 2.0 * _wide(bare, tool.values["DC"])
    if wide <= tool.values["DC"] + slack(wide):
        return tool.word("DC")
    return f"its flutes where they end, {wide / tool.scale:.6g}"


def _shank(tool: Listed, at: float, length: float) -> float:
    """The radius of the shank that is needed between two heights over the tip, mm."""
    if "DMM" not in tool.values:
        raise UnfitError(
            f"{tool.word('DMM')} is missing: the diameter of the shank between {at / tool.scale:.10g} and "
            f"{length / tool.scale:.10g} {tool.unit} over its tip"
        )
    return 0.5 * tool.values["DMM"]


def _as_stated(tool: Listed, stated: dict[str, Any], ask: Ask) -> Cutter:
    radius, neck, shank = 0.5 * tool.values["DC"], tuple(tool.shaft), None
    if "TA" in tool.values and tool.kind in ("flat", "bull", "ball"):
        note_tapered(tool)
    corner, top = corner_of(tool, radius, tool.kind), stated.get("flutes")
    if tool.kind == "lollipop":
        agree_ball(tool)
        corner, shank = radius, 0.5 * tool.values["DN"]
        top = flute_length(Cutter.lollipop(radius=radius, neck_radius=shank, length=10 * radius))
    elif tool.kind == "form":
        top = stated["outline"][-1][1]
    length, holder = _stickout(tool, ask), _holder(tool, ask)
    if top is not None and not tool.straight:
        rest = length - top - math.fsum(stage.length for stage in neck)
        if rest <= SAME:
            # The neck of a lollipop goes on up to the nose, however much longer it is.
            neck = neck if shank is None else (Segment(shank, length - top),)
        elif shank is None:
            shank = _shank(tool, length - rest, length)
        else:
            neck = (*neck, Segment(_shank(tool, length - rest, length), rest))
    made = Cutter(radius, length, corner, tool.name, neck=neck or None, shank_radius=shank, **stated)
    return _held(tool, made, holder)


def _with_length(bare: Cutter, above: tuple[Segment, ...], length: float) -> Cutter:
    """A cutter with what stands above its flutes: the last straight section is its shank, the others are its neck."""
    if bare.shape == "lollipop":
        plain = all(stage.radius == stage.upper_radius == bare.shank_radius for stage in above)
        return replace(bare, length=length, neck=None if plain else above)
    if not above or above[-1].slope:
        return replace(bare, length=length, neck=above or bare.neck)
    return replace(bare, length=length, neck=above[:-1], shank_radius=above[-1].radius)


def _held(tool: Listed, cutter: Cutter, holder: Holder | Literal["none"]) -> Cutter:
    """With its holder, of as many sections as can be judged."""
    if holder == "none":
        return cutter
    plain = holder if tool.stated is not None else Holder(fewer(holder.stages)[0], holder.name)
    values = {word: getattr(cutter, word) for word in Dimensions.__slots__}

    def fits(holder: Holder) -> bool:
        # The same dimensions with a holder, not yet checked to be a cutter.
        return pieces_at_most(Dimensions(**{**values, "holder": holder})) <= MOST_PIECES

    # A section has three pieces at least: no more than a third of them is worth a trial.
    most = min(len(plain.stages) - 1, MOST_PIECES // 3)
    while not fits(plain) and most > 0:
        stages, wider = fewer(holder.stages, most)
        plain, most = Holder(stages, holder.name), most - 1
        if fits(plain):
            tool.notes.append(
                f"its holder's {len(holder.stages)} sections are taken as {len(stages)} around them, up to {mm(wider)} wider"
            )
    try:
        return replace(cutter, holder=plain)
    except CutterError as error:
        unheld = isinstance(error, HolderFitError)
        raise UnfitError(cause_of(error), broken=tool.holder is not None, unheld=unheld) from None
