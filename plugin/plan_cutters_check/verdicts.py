"""Reckon anew what plan.json says of each cutter, its verdicts and its faces, and put tools down at postures that were found."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.bench import Bench
from plan_cutters_check.clash import MET, OPEN, Clock
from plan_cutters_check.expected import Reckoned
from plan_cutters_check.findings import Finding
from plan_cutters_check.leaves import Loose
from plan_cutters_check.process import face_areas, weighed
from plan_cutters_check.question import Question, held

#: Verdicts of samples.npz by their words; those that say that a posture was found, and that none was.
_WORDS = {"interference_free": 2, "accessible": 1, "undecided": 3, "inaccessible": 0, "unjudged": 255}
_REACHED, _NOT_REACHED = (1, 2), (0, 3)
#: Entries that count samples.
COUNTS = (*_WORDS, "inside_bodies", "exempt")
#: Postures of a cutter that are put down, at most; lengths of unit vectors that differ from 1 by less.
_POSTURES, _SAME = 400, 1e-6


def cutters(reckoned: Reckoned) -> list[dict[str, Any]]:
    """Reckon what `cutters` must hold, as far as it follows from tools, samples and verdicts."""
    return [_cutter(reckoned, each) for each in reckoned.question.document["cutters"]]


def _cutter(reckoned: Reckoned, written: Mapping[str, Any]) -> dict[str, Any]:
    question, name = reckoned.question, written["id"]
    sizes, samples, document = question.tools[name], question.samples, question.document
    holder = next((each.low for each in sizes.sections if each.part == "holder"), None)
    end = sizes.sections[-1].low + sizes.sections[-1].length if sizes.sections else sizes.flutes
    entry: dict[str, Any] = {
        "id": name, "radius": sizes.radius, "corner_radius": sizes.corner_radius, "shape": sizes.shape,
        "length": end if holder is None else holder, "taper_deg": math.degrees(sizes.taper),
        "allowance_mm": sizes.allowance, "clearance_mm": sizes.clearance,
        "stages": [
            {"part": s.part, "low_mm": s.low, "length_mm": s.length, "radius_mm": s.radius, "upper_radius_mm": s.upper_radius}
            for s in sizes.sections
        ],
    }  # fmt: skip
    if question.names:
        entry["name"], entry["holder"] = question.names[name]
    if len(question.setups) > 1:
        # The verdicts of samples.npz are those over all setups: of the first one is known alone which samples it reaches.
        here = int(samples[f"reached_in_{name}"][:, 0].sum())
        entry |= {
            word: Loose(0, here if word in ("interference_free", "accessible") else len(samples["face"])) for word in _WORDS
        }
        entry["lost_in_all"] = int((reckoned.finished & np.isin(reckoned.verdict[name], _NOT_REACHED)).sum())
        return entry
    verdict, reason = reckoned.verdict[name], samples[f"reason_{name}"]
    entry |= _counts(reckoned, verdict, np.ones(len(verdict), bool))
    for field, code in (("by_reason", 0), ("undecided_by_reason", 3)):
        counts = np.bincount(reason[verdict == code], minlength=256)
        entry[field] = {word: int(counts[k]) for k, word in enumerate(document["reasons"])}
    face = samples["face"]
    faces = {f"F{n}": _face(reckoned, verdict, reason, face == n) for n in np.unique(face).tolist()}
    entry["faces"], entry["area_share"] = faces, _over_faces(question, faces)
    entry["feasible"] = _feasible(entry, document)
    return entry


def _counts(reckoned: Reckoned, verdict: NDArray[Any], mine: NDArray[np.bool_]) -> dict[str, int]:
    samples = reckoned.question.samples
    counts = {word: int((verdict[mine] == code).sum()) for word, code in _WORDS.items()}
    exempt = samples.get("exempt", np.zeros(len(mine), bool))
    return {**counts, "inside_bodies": int(samples["inside_bodies"][mine].sum()), "exempt": int(exempt[mine].sum())}


def _face(reckoned: Reckoned, verdict: NDArray[Any], reason: NDArray[Any], mine: NDArray[np.bool_]) -> dict[str, Any]:
    """The verdicts on a face whose samples are these (n,)."""
    samples = reckoned.question.samples
    inside = samples["inside_bodies"][mine]
    exempt = samples.get("exempt", np.zeros(len(mine), bool))[mine]
    area, seen = weighed(samples["area"][mine]), ~inside & ~exempt
    within = 1.0 if inside.all() else min(1.0, float(area[inside].sum() / area.sum()))
    edges = min(1.0 - within, float(area[exempt].sum() / area.sum())) if seen.any() else 1.0 - within
    shares = _shares(reckoned.question, verdict[mine][seen], reason[mine][seen], weighed(samples["area"][mine][seen]))
    return {**_counts(reckoned, verdict, mine), "area_share": shares, "inside_share": within, "exempt_share": edges}


def _shares(question: Question, verdict: NDArray[Any], reason: NDArray[Any], area: Floats) -> dict[str, Any]:
    words = question.document["reasons"]
    missed = np.isin(verdict, _NOT_REACHED)
    whole = max(float(area.sum()), 1e-300)
    by = {
        words[c]: float(area[missed & (reason == c)].sum() / whole) for c in np.unique(reason[missed]).tolist() if c < len(words)
    }
    return {**{word: float(area[verdict == code].sum() / whole) for word, code in _WORDS.items()}, "lost_by": by}


def _over_faces(question: Question, faces: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Shares of all target faces, by their areas; those without samples are not judged."""
    areas, unseen = face_areas(question), {"area_share": {"unjudged": 1.0, "lost_by": {}}, "inside_share": 0, "exempt_share": 0}
    each = {name: faces.get(name, unseen) for name in areas}
    sizes = {name: areas[name] * (1.0 - one["inside_share"] - one["exempt_share"]) for name, one in each.items()}
    whole = max(sum(sizes.values()), 1e-300)

    def over(of: Any) -> float:
        return sum(sizes[name] * of(one["area_share"]) for name, one in each.items()) / whole

    by = {reason: over(lambda share, r=reason: share["lost_by"].get(r, 0.0)) for reason in question.document["reasons"]}
    shares = {word: over(lambda share, w=word: share.get(w, 0.0)) for word in _WORDS}
    return {**shares, "lost_by": {reason: share for reason, share in by.items() if share > 0.0}}


def _feasible(entry: Mapping[str, Any], document: Mapping[str, Any]) -> bool | None:
    """Whether a cutter finishes; None where something is undecided, stands on a proposed table, or is missing."""
    another = entry["by_reason"].get("another_setup", 0)
    blocked = entry["inaccessible"] - entry["inside_bodies"] - entry["exempt"]
    doubtful = entry["undecided"] or another or document["missing"]
    return False if blocked > another else None if doubtful else True


def chosen(document: Mapping[str, Any], entries: list[dict[str, Any]]) -> dict[str, Any]:
    """Which cutters must be named as those that finish; not where several setups hide the verdicts of the first one."""
    over = [each["id"] for each in entries if each.get("lost_in_all") == 0]
    named: dict[str, Any] = {"selected_over_setups": over[0] if over and not document["missing"] else None}
    if any("feasible" not in each for each in entries):
        return named
    feasible = [each["id"] for each in entries if each["feasible"]]
    named["selected"] = document["selected"] if document["selected"] in [None, *feasible[:1]] else "a cutter that finishes"
    stood = any(each["by_reason"].get("another_setup") for each in entries)
    if feasible and named["selected"] is None and not stood:
        named["selected"] = feasible[0]
    named["shown"] = named["selected"] or min(entries, key=_leaves)["id"]
    return named


def _leaves(entry: Mapping[str, Any]) -> tuple[float, int]:
    """What a cutter leaves, but what stands on a proposed table: share of the area, and samples."""
    share, another = entry["area_share"], entry["by_reason"].get("another_setup", 0)
    left = share["inaccessible"] + share["undecided"] - share["lost_by"].get("another_setup", 0.0)
    return round(left, 9) + 0.0, entry["inaccessible"] - entry["inside_bodies"] - entry["exempt"] + entry["undecided"] - another


def postures(question: Question, reckoned: Reckoned, bench: Bench, rng: np.random.Generator, clock: Clock) -> Iterator[Finding]:
    """Each cutter, put down with the postures that its verdicts rest on, at some of its samples."""
    samples = question.samples
    for name, verdict in reckoned.verdict.items():
        axis, tilt_direction = samples[f"axis_{name}"], samples[f"lean_{name}"]
        rows = rng.permutation(np.flatnonzero(reckoned.finished & np.isin(verdict, _REACHED)))[:_POSTURES]
        setup = samples.get(f"setup_{name}", np.zeros(len(verdict), np.int64))
        met, tested, open_, beyond = 0, 0, 0, 0
        for s in np.unique(setup[rows]).tolist():
            mine = rows[setup[rows] == s]
            if not 0 <= s < len(question.setups):
                met += len(mine)
                continue
            able = held(question.machine, question.setups[s], axis[mine])
            contact = bench.point[mine] + question.shift(name)[mine], bench.normal[mine]
            verdicts, some, _ = bench.put_down(s, bench.tools[name], mine, axis[mine], tilt_direction[mine], clock, contact)
            verdicts[~able] = MET
            met, open_ = met + int((verdicts == MET).sum()), open_ + int((verdicts == OPEN).sum())
            tested, beyond = tested + int((verdicts != OPEN).sum()), beyond + some
        if len(rows):
            every = int(np.isin(verdict, _REACHED).sum())
            words = (
                f"{name}: {tested} of the {every} postures of its verdicts (taken by seed 0) were put down; {met} are not safe."
            )
            holds = None if not met and (beyond or not tested) else met == 0
            yield Finding(holds, words, open_, beyond, len(rows))


def without_posture(reckoned: Reckoned) -> Iterator[Finding]:
    """Verdicts that say that a sample is reached with no tool axis, or that it is not with one."""
    for name, verdict in reckoned.verdict.items():
        axis, reached = reckoned.question.samples[f"axis_{name}"], np.isin(verdict, _REACHED)
        with np.errstate(invalid="ignore"):
            unit = np.abs(np.linalg.norm(axis, axis=1) - 1.0) <= _SAME
        wrong = int((reached != unit).sum()) + int((~np.isin(verdict, [*_WORDS.values()])).sum())
        if wrong:
            yield Finding(
                False, f"samples.npz: {wrong} verdicts of {name} have no tool axis with which they are reached, or no meaning."
            )
