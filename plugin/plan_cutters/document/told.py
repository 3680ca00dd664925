"""What people are told of a plan, wherever they read it: shares in percent, reasons, the worst faces."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from plan_cutters.document.inside import CoveringBody
from plan_cutters.document.model import CutterEntry, FaceEntry, Plan, WitnessEntry
from plan_cutters.document.shares import AreaShare, Verdicts
from plan_cutters.domain.verdicts import WORDS

#: Verdicts, from best to worst.
VERDICTS = tuple(WORDS.values())
_REACHED, _LOST = ("interference_free", "accessible"), ("inaccessible", "undecided")


@dataclass(frozen=True, slots=True)
class WorstFace:
    """A face on which a cutter loses samples.

    Attributes
    ----------
    face : FaceEntry
    area : float
        That is lost, mm2.
    share : str
        Of the face, in percent.
    reason : str
        By which most of it is lost.
    undecided : bool
        More of that is undecided than inaccessible.
    witness : WitnessEntry, optional
        The deepest there, whatever its reason.
    """

    face: FaceEntry
    area: float
    share: str
    reason: str
    undecided: bool
    witness: WitnessEntry | None


def percent(share: float, *, some: bool, whole: bool) -> str:
    """A share in percent: 100 only where it is the whole, and 0 only where there is nothing of it.

    Examples
    --------
    >>> percent(0.00001, some=True, whole=False), percent(0.99999, some=True, whole=False)
    ('<0.1 %', '>99.9 %')
    >>> percent(0.5, some=True, whole=False), percent(0.0, some=False, whole=False)
    ('50 %', '0 %')
    """
    if whole:
        return "100 %"
    if not some and not share:
        return "0 %"
    text = f"{100.0 * share:.1f}"
    return {"0.0": "<0.1 %", "100.0": ">99.9 %"}.get(text, f"{text.removesuffix('.0')} %")


def figure(number: float) -> str:
    """Three digits of a number, without an exponent where it is large.

    Examples
    --------
    >>> figure(12345.6), figure(0.0456), figure(7.769e6)
    ('12,300', '0.0456', '7,770,000')
    """
    return f"{float(f'{number:.3g}'):,.0f}" if abs(number) >= 100.0 else f"{number:.3g}"


def part_of(counts: Verdicts, share: AreaShare, words: Iterable[str]) -> str:
    """How much of an area has one of some verdicts, in percent."""
    mine = set(words)
    there = {word for word in VERDICTS if counts.of(word) or getattr(share, word) > 0.0}
    return percent(
        sum(getattr(share, word) for word in mine), some=bool(there & mine), whole=bool(there) and there <= mine
    )


def reached(counts: Verdicts, share: AreaShare) -> str:
    """How much of an area is interference-free or accessible, in percent."""
    return part_of(counts, share, _REACHED)


def lost(counts: Verdicts, share: AreaShare) -> str:
    """How much of an area is inaccessible or undecided, in percent."""
    return part_of(counts, share, _LOST)


def main_reason(share: AreaShare) -> str:
    """By which reason the most is lost; empty where nothing is."""
    return max(share.lost_by, key=lambda name: share.lost_by[name], default="")


def reasons(cutter: CutterEntry) -> list[str]:
    """Why a cutter loses what it loses, with shares of the area: the reason with the largest one first."""
    found = []
    for name, share in sorted(cutter.area_share.lost_by.items(), key=lambda item: -item[1]):
        text = f"{name.replace('_', ' ')} {percent(share, some=True, whole=False)}"
        if name == "axis_limit" and cutter.axis_limit_with:
            ranked = sorted(cutter.axis_limit_with.items(), key=lambda item: (-item[1], item[0]))
            others = ", ".join(f"{other.replace('_', ' ')} at {count:,}" for other, count in ranked)
            text += f" (with {others} sample{'' if ranked[-1][1] == 1 else 's'})"
        found.append(text)
    return found


def inside(plan: Plan, most: int = 5) -> list[str]:
    """What lies inside other bodies of the part, in sentences: how much, then the bodies that a planner must look at."""
    found = plan.inside_other_bodies
    if not found.samples:
        return []
    share = percent(found.share, some=True, whole=found.samples == plan.samples.count)
    lines = [f"{share} of the target area ({found.samples:,} of {plan.samples.count:,} samples) lies inside other bodies of the "
             "part: it is no surface of the finished part, and what follows is about the rest."]  # fmt: skip
    standing = sorted((each for each in found.bodies if each.how != "overlaps"), key=lambda each: each.largest)
    lines += [_standing(each) for each in standing[:most]]
    lines += _more(standing[most:], "body covers", "bodies cover")
    over = [each for each in found.bodies if each.how == "overlaps"]
    if over:
        each = "; ".join(
            f"{_called(b)} covers {figure(b.area_mm2)} mm2 of {listed(b.faces, 4)}" for b in over[: most - 2]
        )
        rest = len(over) - (most - 2)
        lines.append(f"Bodies overlap: {each}{f'; {rest} more in plan.json' if rest > 0 else ''}.")
    if found.sheets is not None:
        sheets, area = found.sheets, figure(found.sheets.area_mm2)
        what = "is a construction sheet" if len(sheets.faces) == 1 else "are construction sheets"
        lines.append(f"{listed(sheets.faces)} {what} on the skin of a body: {area} mm2 face into it. {sheets.option} leaves such "
                     "sheets out.")  # fmt: skip
    return lines


def _standing(body: CoveringBody) -> str:
    on, area = listed(body.faces, 4), figure(body.area_mm2)
    verb = "stands on" if body.how == "stands_on" else "touches or overlaps"
    if body.largest:
        touch = "touches" if len(body.faces) == 1 else "touch"
        return f"{_called(body, first=True)} covers {area} mm2 of {on}, which {touch} it."
    return (f"{_called(body, first=True)} {verb} {on} and covers {area} mm2 there. It stays in the way, and what lies under "
            f"it is not planned. To plan that, as for another clamping, leave the body out (nothing is then checked against it): "
            f"{body.option}.")  # fmt: skip


def _called(body: CoveringBody, *, first: bool = False) -> str:
    """A body as it is told: its number, its name, its faces."""
    name = f' "{body.name}"' if body.name else ""
    return f"{'Body' if first else 'body'} {body.number}{name} ({listed(body.own_faces, 2)})"


def _more(bodies: Sequence[CoveringBody], one: str, many: str) -> list[str]:
    if not bodies:
        return []
    area = figure(sum(each.area_mm2 for each in bodies))
    return [f"{len(bodies)} more {one if len(bodies) == 1 else many} {area} mm2: see plan.json."]


def listed(names: Sequence[str], most: int = 8) -> str:
    """Names in a line, the first ones where there are many."""
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def worst_faces(plan: Plan, cutter: CutterEntry, most: int = 5) -> tuple[list[WorstFace], int]:
    """The faces of which a cutter loses the largest area, and how many there are in all."""
    faces = {face.id: face for face in plan.faces}
    shares = {
        name: each.area_share.inaccessible + each.area_share.undecided
        for name, each in cutter.faces.items()
        if each.lost
    }
    seen = {name: 1.0 - each.inside_share for name, each in cutter.faces.items()}
    area = {
        name: shares[name] * seen[name] * each.area_mm2 if math.isfinite(each.area_mm2) else 0.0
        for name, each in faces.items()
        if name in shares
    }
    ranked = sorted(shares, key=lambda name: (-area[name], -shares[name], int(name[1:])))
    found = []
    for name in ranked[:most]:
        mine = [w for w in cutter.witnesses if w.face == name and not w.inside_bodies]
        share = cutter.faces[name].area_share
        reason = main_reason(share) or (mine[0].reason if mine else "")
        unsure = share.undecided > share.inaccessible
        told = "undecided" if unsure else "inaccessible"
        witness = max(mine, key=lambda w: (w.verdict == told, w.depth_mm or 0.0), default=None)
        lot = shares[name] * seen[name] * faces[name].area_mm2
        found.append(WorstFace(faces[name], lot, lost(cutter.faces[name], share), reason, unsure, witness))
    return found, len(ranked)
