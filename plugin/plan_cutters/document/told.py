"""What people are told of a plan, wherever they read it: shares in percent, reasons, the worst faces."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

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
        The deepest there, of that reason where there is one.
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
    there = {word for word in VERDICTS if getattr(counts, word) or getattr(share, word) > 0.0}
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


def worst_faces(plan: Plan, cutter: CutterEntry, most: int = 5) -> tuple[list[WorstFace], int]:
    """The faces of which a cutter loses the largest area, and how many there are in all."""
    faces = {face.id: face for face in plan.faces}
    shares = {
        name: each.area_share.inaccessible + each.area_share.undecided
        for name, each in cutter.faces.items()
        if each.inaccessible + each.undecided
    }
    area = {
        name: shares[name] * each.area_mm2 if math.isfinite(each.area_mm2) else 0.0
        for name, each in faces.items()
        if name in shares
    }
    ranked = sorted(shares, key=lambda name: (-area[name], -shares[name], int(name[1:])))
    found = []
    for name in ranked[:most]:
        mine, share = [w for w in cutter.witnesses if w.face == name], cutter.faces[name].area_share
        reason = main_reason(share) or (mine[0].reason if mine else "")
        unsure = share.undecided > share.inaccessible
        told = "undecided" if unsure else "inaccessible"
        alike = [w for w in mine if w.reason == reason] or mine
        witness = max(alike, key=lambda w: (w.verdict == told, w.depth_mm or 0.0), default=None)
        lot = shares[name] * faces[name].area_mm2
        found.append(WorstFace(faces[name], lot, lost(cutter.faces[name], share), reason, unsure, witness))
    return found, len(ranked)
