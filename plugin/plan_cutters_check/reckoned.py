"""Sets of samples, their areas, and what entries of every kind about a set of samples must be."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.question import Question

Rows = NDArray[np.int64]
#: Verdicts of samples.npz by their words; those that say that a posture was found, and that none was.
WORDS = {"interference_free": 2, "accessible": 1, "undecided": 3, "inaccessible": 0, "unjudged": 255}
#: The verdict on samples in holes for drills, which no mill is asked for.
DRILLED = 4
REACHED, NOT_REACHED = (1, 2), (0, 3)
#: How a sample is cut, in operations.npz.
FLOOR, WALL = 1, 2


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
        """Entries about samples (m,), by their names: `samples`, `area_mm2`, `share`."""
        area = float(self.area[rows].sum())
        share = min(1.0, area / self.whole) if self.whole > 0.0 else 0.0
        entries = {"samples": len(rows), "area_mm2": area, "share": share}
        return {name: entries[name] for name in names}

    def faces(self, rows: Rows) -> list[str]:
        """Faces of samples, by their numbers."""
        return [f"F{number}" for number in np.unique(self.samples["face"][rows]).tolist()]

    def by_face(self, rows: Rows, written: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """The same with their samples and areas, in the order in which they are written."""
        face, names, own = self.samples["face"][rows], [each["face"] for each in written], self.faces(rows)
        names = names if sorted(names) == sorted(own) else own
        return [{"face": name, **self.of(rows[face == int(name[1:])], "samples", "area_mm2")} for name in names]


class Reckoned:
    """Sets of samples that a plan's entries are about.

    Judged samples of the finished part are `finished` (n,). Areas, mm2: `judged` of these; `required`, in which the samples of a
    face have its area together, as all do in `sampled` (n,); `not_sampled` of target faces without samples (`empty`).
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
        self.area: Floats = np.where(self.finished, np.nan_to_num(samples["area"]), 0.0)
        self.judged = Weights(samples, self.area, float(self.area.sum()))
        sampled = [f"F{n}" for n in np.unique(samples["face"]).tolist()]
        self.empty: list[str] = [name for name in document["effective"]["target_faces"] if name not in sampled]
        # Where no area is known each face, or sample, is as large.
        areas = weighed(np.array([question.part.faces[int(name[1:]) - 1].area for name in sampled + self.empty], float))
        self.sampled = np.zeros(len(self.area))
        for name, area in zip(sampled, areas.tolist(), strict=False):
            mine = samples["face"] == int(name[1:])
            weight = weighed(samples["area"][mine])
            self.sampled[mine] = area * weight / weight.sum()
        self.not_sampled = float(areas[len(sampled) :].sum())
        required = np.where(self.exempt | samples["inside_bodies"] | self.drilled, 0.0, self.sampled)
        self.required = Weights(samples, required, float(required.sum()) + self.not_sampled)


def weighed(area: Floats) -> Floats:
    """Areas as weights: one that is not known weighs nothing; where none is known each weighs as much."""
    known = np.where(np.isfinite(area) & (area > 0.0), area, 0.0)
    return known if known.sum() > 0.0 else np.ones(len(area))


#: Angles that are written to three digits are equal within this, deg.
_WRITTEN = 0.0021


def evenly(by: Mapping[str, float], every: Sequence[Mapping[str, float]]) -> bool:
    """Whether the angles, deg, of all images say by which one a rotary axis turns from one to the next."""
    if len(by) != 1 or not every or not {*by} <= {*every[0]}:
        return False
    for name, first in every[0].items():
        away, turn = np.array([each[name] - first for each in every]), by.get(name)
        near = away if not turn else away - turn * np.rint(away / turn)
        if np.abs((near + 180.0) % 360.0 - 180.0).max() > _WRITTEN * len(every):
            return False
        # It is a whole part of the turn.
        if turn is not None and not (
            turn > 0.0 and abs(360.0 / turn - round(360.0 / turn)) < 1e-2 and len({*away}) == len(every)
        ):
            return False
    return True
