"""Sets of samples, their areas, and what entries of every kind about a set of samples must be."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.question import Question

Rows = NDArray[np.int64]
#: Verdicts of samples.npz by their words; those that say that a posture was found, and that none was; a reason that is none.
WORDS = {"interference_free": 2, "accessible": 1, "undecided": 3, "inaccessible": 0, "unjudged": 255}
#: The verdict on samples in holes for drills, which no mill is asked for.
DRILLED = 4
REACHED, NOT_REACHED, NO_REASON = (1, 2), (0, 3), 255
#: How a sample is cut, in operations.npz, and cutters that are compared, at most, unless more are needed.
FLOOR, WALL, _CUTTERS = 1, 2, 4
#: Areas that differ by less, as a share, are the same.
_SAME_AREA = 1e-9


def suffix(index: int, name: str) -> str:
    """Give the end of the names of a plan's arrays: nothing for the first plan."""
    return f"_{name.replace(' ', '_')}" if index else ""


@dataclass(frozen=True, eq=False)
class Planned:
    """A plan of operations: its `number`, its `entry` in plan.json, and its arrays of operations.npz, by their names."""

    number: int
    entry: Mapping[str, Any]
    arrays: Mapping[str, NDArray[Any]]

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.arrays[f"{name}{suffix(self.number, self.entry['name'])}"]

    def __str__(self) -> str:
        return f"The {self.entry['name']} plan"

    @cached_property
    def label(self) -> NDArray[Any]:
        """The operation of each sample (n,); -1: none."""
        return self["operation"]

    @property
    def operations(self) -> list[dict[str, Any]]:
        """Its operations, as they are written."""
        operations: list[dict[str, Any]] = self.entry["operations"]
        return operations

    def rows(self, i: int) -> Rows:
        """The samples of an operation."""
        return np.flatnonzero(self.label == i)


@dataclass(frozen=True, slots=True, eq=False)
class Weights:
    """Samples of samples.npz stand for areas (n,), mm2, 0 of those that do not count; shares are of the `whole`, mm2."""

    samples: Mapping[str, NDArray[Any]]
    area: Floats
    whole: float

    def of(self, rows: Rows, *names: str) -> dict[str, Any]:
        """Entries about samples (m,), each by the kind that its name says."""
        return {name: _KINDS[name](self, rows) for name in names}

    def faces(self, rows: Rows, written: Sequence[str]) -> list[str]:
        """Faces of samples, the one with the most of their area first; of equal ones, as they are written."""
        size = np.bincount(self.samples["face"][rows], self.area[rows], 1)
        ordered = [f"F{n}" for n in sorted(np.unique(self.samples["face"][rows]).tolist(), key=lambda n: (-size[n], n))]
        same = sorted(written) == sorted(ordered)
        return list(written) if same and falling([size[int(name[1:])] for name in written]) else ordered

    def by_face(self, rows: Rows, written: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """The same with their samples and areas."""
        face = self.samples["face"][rows]
        names = self.faces(rows, [each["face"] for each in written])
        return [{"face": name, **self.of(rows[face == int(name[1:])], "samples", "area_mm2")} for name in names]


def falling(sizes: Sequence[float]) -> bool:
    """Whether sizes fall, but for rounding."""
    return all(a >= b * (1.0 - _SAME_AREA) for a, b in pairwise(sizes))


_KINDS: dict[str, Callable[[Weights, Rows], Any]] = {
    "samples": lambda by, rows: len(rows),
    "area_mm2": lambda by, rows: float(by.area[rows].sum()),
    "share": lambda by, rows: min(1.0, float(by.area[rows].sum()) / by.whole) if by.whole > 0.0 else 0.0,
}


class Reckoned:
    """Sets of samples that a plan's entries are about.

    Judged samples of the finished part are `finished` (n,), those that a cutter that was compared (`considered`, ids) reaches are
    `reached` (n,). Areas, mm2: `judged` of the finished samples; `required` of those that are, so that the samples of a face have
    its area together, as all do in `sampled` (n,); `not_sampled` of target faces without samples (`empty`).
    """

    def __init__(self, question: Question) -> None:
        self.question = question
        document, samples = question.document, question.samples
        self.plans = [Planned(k, plan, question.operations) for k, plan in enumerate(document["operations"]["plans"])]
        self.ids: list[str] = [each["id"] for each in document["cutters"]]
        self.verdict = {name: samples[f"verdict_{name}"] for name in self.ids}
        self.unjudged = np.logical_and.reduce([each == WORDS["unjudged"] for each in self.verdict.values()])
        self.exempt = samples.get("exempt", np.zeros(len(self.unjudged), bool))
        self.drilled = np.logical_and.reduce([each == DRILLED for each in self.verdict.values()])
        self.finished = ~self.unjudged & ~samples["inside_bodies"] & ~self.exempt & ~self.drilled
        process = document["effective"].get("process")
        self.own = None if process is None else process["step"]
        fastest_alone = document["effective"]["operations"] == "fastest" and document["operations"]["fewest"] is None
        self.without_fewest = self.own is not None or fastest_alone
        #: Whether each sample that is reached must go with an operation.
        self.all_planned = process is None or (process["rest"] == "plan" and not process["forbid"])
        reached = {name: self.finished & np.isin(self.verdict[name], REACHED) for name in self.ids}
        index = question.operations.get("candidate_cutter", np.zeros(0, int))
        tried = {name for k, name in enumerate(self.ids) if (index == k).any()}
        self.considered = considered(document, self.ids, reached, None if self.without_fewest else tried)
        self.reached_by = {name: reached[name] for name in self.considered}
        self.reached = np.logical_or.reduce([*self.reached_by.values()])
        self.area: Floats = np.where(self.finished, np.nan_to_num(samples["area"]), 0.0)
        self.judged = Weights(samples, self.area, float(self.area.sum()))
        sampled = [f"F{n}" for n in np.unique(samples["face"]).tolist()]
        self.empty: list[str] = [name for name in document["effective"]["target_faces"] if name not in sampled]
        # Where no area is known each face, or sample, is as large.
        areas = weighed(np.array([question.part.faces[int(name[1:]) - 1].area for name in sampled + self.empty], float))
        self.face_area: dict[str, float] = dict(zip(sampled + self.empty, areas.tolist(), strict=True))
        self.sampled = np.zeros(len(self.area))
        for name in sampled:
            mine = samples["face"] == int(name[1:])
            weight = weighed(samples["area"][mine])
            self.sampled[mine] = self.face_area[name] * weight / weight.sum()
        self.not_sampled = float(sum(self.face_area[name] for name in self.empty))
        required = np.where(self.exempt | samples["inside_bodies"] | self.drilled, 0.0, self.sampled)
        self.required = Weights(samples, required, float(required.sum()) + self.not_sampled)


def considered(
    document: Mapping[str, Any], ids: list[str], reached: Mapping[str, NDArray[np.bool_]], tried: set[str] | None = None
) -> list[str]:
    """The ids of the cutters that a plan compares: those that its least set and its own steps need, and others by rank.

    A cutter of a kind that comes last on the part's faces may be left out where the others reach all without it. `ids`: all that
    were judged, by rank; `reached`: samples (n,) that each of them reaches; `tried`: those that have candidates, where the plan
    has any.
    """
    process, written = document["effective"].get("process"), document["operations"]
    named = (document.get("least_set") or {"runs": []})["runs"]
    named = named if process is None else [*named, *process["step"], *process["forbid"]]
    needed = list(dict.fromkeys(each["cutter"] for each in named))
    wanted = [*needed, *(each for each in ids if each not in needed)][: max(_CUTTERS, len(needed))]
    fed = written["assumed"]["feed_mm_min"]
    kind = {each["id"]: each.get("group") for each in document["cutters"]}
    late = {each for each in ids if tried is not None and each not in tried and kind[each] not in {kind[one] for one in needed}}
    others = [each for each in ids if each in wanted and (each in needed or (each not in late and (not fed or each in fed)))]
    whole = np.logical_or.reduce([reached[each] for each in others]) if others else np.zeros(0, bool)
    if others and all(not (reached[each] & ~whole).any() for each in wanted if each not in others):
        return others
    return [each for each in ids if each in wanted]


def weighed(area: Floats) -> Floats:
    """Areas as weights: one that is not known weighs nothing; where none is known each weighs as much."""
    known = np.where(np.isfinite(area) & (area > 0.0), area, 0.0)
    return known if known.sum() > 0.0 else np.ones(len(area))


#: Angles that are written to three digits are equal within this, deg.
_WRITTEN = 0.0021


def evenly(by: Mapping[str, float], every: Sequence[Mapping[str, float]]) -> Any:
    """Give the angle, deg, by which a rotary axis turns from one image to the next, if the angles of all images say so."""
    if len(by) != 1 or not every or not {*by} <= {*every[0]}:
        return "what one rotary axis turns by"
    for name, first in every[0].items():
        away, turn = np.array([each[name] - first for each in every]), by.get(name)
        near = away if not turn else away - turn * np.rint(away / turn)
        if np.abs((near + 180.0) % 360.0 - 180.0).max() > _WRITTEN * len(every):
            return "what the angles of its operations turn by"
        # It is a whole part of the turn.
        if turn is not None and not (
            turn > 0.0 and abs(360.0 / turn - round(360.0 / turn)) < 1e-2 and len({*away}) == len(every)
        ):
            return "a whole part of the turn"
    return dict(by)
