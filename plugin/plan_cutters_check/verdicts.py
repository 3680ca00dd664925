"""Reckon anew what plan.json says of each cutter, its verdicts and its faces, and put tools down at postures that were found."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters_check.bench import Bench
from plan_cutters_check.clash import MET, Clock
from plan_cutters_check.findings import Finding, Tally
from plan_cutters_check.leaves import Exactly, Loose
from plan_cutters_check.question import Question, held
from plan_cutters_check.reckoned import NOT_REACHED, REACHED, WORDS, Reckoned, weighed

#: Postures of a cutter that are put down, at most; lengths of unit vectors that differ from 1 by less.
_POSTURES, _SAME = 400, 1e-6


def cutter(reckoned: Reckoned, name: str) -> dict[str, Any]:
    """Reckon what `cutters` must hold of one, as far as it follows from the tool, the samples and its verdicts."""
    question = reckoned.question
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
        **(dict(zip(("name", "holder"), question.names[name], strict=True)) if question.names else {}),
    }  # fmt: skip
    if len(question.setups) > 1:
        # The verdicts of samples.npz are those over all setups: of the first one is known alone which samples it reaches.
        here = int(samples[f"reached_in_{name}"][:, 0].sum())
        most = {word: here if code in REACHED else len(samples["face"]) for word, code in WORDS.items()}
        missed = int((reckoned.finished & np.isin(reckoned.verdict[name], NOT_REACHED)).sum())
        return entry | {word: Loose(0, count) for word, count in most.items()} | {"lost_in_all": missed}
    verdict, reason, face = reckoned.verdict[name], samples[f"reason_{name}"], samples["face"]
    for field, code in (("by_reason", 0), ("undecided_by_reason", 3)):
        counts = np.bincount(reason[verdict == code], minlength=256)
        entry[field] = Exactly({word: int(counts[k]) for k, word in enumerate(document["reasons"])})
    faces = Exactly({f"F{n}": _face(reckoned, verdict, reason, face == n) for n in np.unique(face).tolist()})
    entry |= {**_counts(reckoned, verdict, np.ones(len(verdict), bool)), "faces": faces, "area_share": _over(reckoned, faces)}
    # Whether it finishes; null where something is undecided, stands on a proposed table, or is missing.
    another = entry["by_reason"].get("another_setup", 0)
    blocked = entry["inaccessible"] - entry["inside_bodies"] - entry["exempt"]
    doubtful = entry["undecided"] or another or document["missing"]
    return entry | {"feasible": False if blocked > another else None if doubtful else True}


def _counts(reckoned: Reckoned, verdict: NDArray[Any], mine: NDArray[np.bool_]) -> dict[str, int]:
    counts = {word: int((verdict[mine] == code).sum()) for word, code in WORDS.items()}
    inside = reckoned.question.samples["inside_bodies"]
    return {**counts, "inside_bodies": int(inside[mine].sum()), "exempt": int(reckoned.exempt[mine].sum())}


def _face(reckoned: Reckoned, verdict: NDArray[Any], reason: NDArray[Any], mine: NDArray[np.bool_]) -> dict[str, Any]:
    """The verdicts on a face whose samples are these (n,)."""
    samples, words = reckoned.question.samples, reckoned.question.document["reasons"]
    inside, exempt, area = samples["inside_bodies"][mine], reckoned.exempt[mine], weighed(samples["area"][mine])
    seen = ~inside & ~exempt
    within = 1.0 if inside.all() else min(1.0, float(area[inside].sum() / area.sum()))
    edges = min(1.0 - within, float(area[exempt].sum() / area.sum())) if seen.any() else 1.0 - within
    counts, verdict, reason, area = (
        _counts(reckoned, verdict, mine),
        verdict[mine][seen],
        reason[mine][seen],
        weighed(samples["area"][mine][seen]),
    )
    missed, whole = np.isin(verdict, NOT_REACHED), max(float(area.sum()), 1e-300)
    by = {
        words[c]: float(area[missed & (reason == c)].sum() / whole) for c in np.unique(reason[missed]).tolist() if c < len(words)
    }
    shares = {word: float(area[verdict == code].sum() / whole) for word, code in WORDS.items()}
    return {**counts, "area_share": {**shares, "lost_by": Exactly(by)}, "inside_share": within, "exempt_share": edges}


def _over(reckoned: Reckoned, faces: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Shares of all target faces, by their areas; those without samples are not judged."""
    unseen = {"area_share": {"unjudged": 1.0, "lost_by": {}}, "inside_share": 0, "exempt_share": 0}
    each = [(size, faces.get(name, unseen)) for name, size in reckoned.face_area.items()]
    sizes = [size * (1.0 - one["inside_share"] - one["exempt_share"]) for size, one in each]
    whole, shares = max(sum(sizes), 1e-300), [one["area_share"] for _, one in each]

    def over(of: list[float]) -> float:
        return sum(size * share for size, share in zip(sizes, of, strict=True)) / whole

    by = {
        reason: over([share["lost_by"].get(reason, 0.0) for share in shares]) for reason in reckoned.question.document["reasons"]
    }
    every = {word: over([share.get(word, 0.0) for share in shares]) for word in WORDS}
    return {**every, "lost_by": Exactly({reason: share for reason, share in by.items() if share > 0.0})}


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
    return named | {"shown": named["selected"] or min(entries, key=_leaves)["id"]}


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
        every = np.flatnonzero(reckoned.finished & np.isin(verdict, REACHED))
        rows = rng.permutation(every)[:_POSTURES]
        setup, tally = samples.get(f"setup_{name}", np.zeros(len(verdict), np.int64)), Tally()
        for s in np.unique(setup[rows]).tolist():
            mine = rows[setup[rows] == s]
            if not 0 <= s < len(question.setups):
                tally.wrong += len(mine)
                continue
            contact = bench.point[mine] + question.shift(name)[mine], bench.normal[mine]
            put = bench.put_down(s, bench.tools[name], mine, axis[mine], tilt_direction[mine], clock, contact)
            put[0][~held(question.machine, question.setups[s], axis[mine])] = MET
            tally.add(*put)
        if len(rows):
            count = int(np.isin(verdict, REACHED).sum())
            text = (
                f"{name}: {tally.tested} of the {count} postures of its verdicts (taken by seed 0) were put down; {tally.wrong}"
            )
            yield tally.finding(f"{text} are not safe.", len(rows))


def without_posture(reckoned: Reckoned) -> Iterator[Finding]:
    """Verdicts that say that a sample is reached with no tool axis, or that it is not with one."""
    for name, verdict in reckoned.verdict.items():
        axis, reached = reckoned.question.samples[f"axis_{name}"], np.isin(verdict, REACHED)
        with np.errstate(invalid="ignore"):
            unit = np.abs(np.linalg.norm(axis, axis=1) - 1.0) <= _SAME
        wrong = int((reached != unit).sum()) + int((~np.isin(verdict, [*WORDS.values()])).sum())
        if wrong:
            words = f"samples.npz: {wrong} verdicts of {name} have no tool axis with which they are reached, or no meaning."
            yield Finding(False, words)
