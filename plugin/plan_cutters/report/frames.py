"""A result as tables of pandas, which is loaded here alone: samples as in `axes.csv`, faces and cutters as in `plan.json`."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from plan_cutters.domain.verdicts import WORDS
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.shares import AreaShare, VerdictCounts
from plan_cutters.report.axes import Column, columns
from plan_cutters.report.protocol import Judged

if TYPE_CHECKING:
    from pandas import DataFrame


def frame(result: Judged, of: str, cutter: str | None) -> "DataFrame":
    """A table of the rows asked for: `samples` or `faces`, both of one cutter, or `cutters`.

    Raises
    ------
    OptionError
        There is no such table, or no such cutter.
    PlanError
        Pandas is not installed.
    """
    if of not in _TABLES:
        raise OptionError(f"there is no table of {of!r}; give one of {', '.join(_TABLES)}")
    if of == "cutters" and cutter is not None:
        raise OptionError("the table of cutters has all of them: leave out cutter=")
    try:
        import pandas
    except ImportError:
        raise PlanError("tables need the package pandas: pip install pandas") from None
    table = pandas.DataFrame(_TABLES[of](result, result.judged(cutter).id))
    # A column of words knows them all, and keeps their order.
    for name, words in _words(result).items():
        if name in table:
            others = [word for word in table[name].dropna().unique() if word not in words]
            table[name] = pandas.Categorical(table[name], categories=[*words, *others])
    if "feasible" in table:
        table["feasible"] = table["feasible"].astype("boolean")  # which knows "not decided"
    return table


def _samples(result: Judged, cutter: str) -> dict[str, Any]:
    """The columns of `axes.csv`."""
    table: dict[str, Any] = {"cutter": [cutter] * len(result.samples)}
    for column in columns(result, cutter):
        table.update(_cells(column))
    return table


def _cells(column: Column) -> dict[str, Any]:
    """A column, or three of a vector; None where a word is empty."""
    if column.words is not None:
        codes, index = np.unique(column.values, return_inverse=True)
        words = np.array([column.words[code] or None for code in codes.tolist()], object)
        return {column.name: words[index]}
    values = column.values + 0.0 if column.values.dtype.kind == "f" else column.values  # -0.0 becomes 0.0
    if values.ndim == 1:
        return {column.name: values}
    return {name: values[:, k] for k, name in enumerate(column.names)}


def _faces(result: Judged, cutter: str) -> list[dict[str, Any]]:
    """Give a row for each face of the part: shares are nan where it was not sampled."""
    entry = next(each for each in result.cutters if each.id == cutter)
    return [_face(face, entry) for face in result.plan.faces]


def _face(face: FaceEntry, cutter: CutterEntry) -> dict[str, Any]:
    about = {"face": face.id, "name": face.name, "component": face.component, "surface": face.surface, "shape": face.shape,
             "target": face.target, "ignored": face.ignored, "area_mm2": face.area_mm2, "samples": face.samples,
             "unjudged_why": face.unjudged, "cutter": cutter.id}  # fmt: skip
    entry = cutter.faces.get(face.id)
    if entry is None:
        return {**about, **_verdicts(VerdictCounts(), None), "reason": None, "depth_mm": np.nan, "obstacle": None}
    deep = [w for w in cutter.witnesses if w.face == face.id and not w.inside_bodies and w.depth_mm is not None]
    worst = max(deep, key=lambda w: w.depth_mm or 0.0, default=None)
    return {**about, **_verdicts(entry, entry.area_share), "reason": _main(entry.area_share),
            "depth_mm": worst.depth_mm if worst else np.nan, "obstacle": worst.obstacle_face if worst else None}  # fmt: skip


def _cutters(result: Judged, _cutter: str) -> list[dict[str, Any]]:
    """Give a row for each cutter, from the most wanted down; `feasible` is missing where it is not decided."""
    return [
        {"cutter": c.id, "name": c.name, "shape": c.shape, "radius_mm": c.radius, "corner_radius_mm": c.corner_radius,
         "length_mm": c.length, "holder": c.holder or None, "selected": c.id == result.selected, "feasible": c.feasible,
         **_verdicts(c, c.area_share), "reason": _main(c.area_share)}
        for c in result.cutters
    ]  # fmt: skip


def _verdicts(counts: VerdictCounts, share: AreaShare | None) -> dict[str, Any]:
    """Counts of samples by verdict, and shares of the area, 0 to 1."""
    words = WORDS.values()
    shares = {f"{word}_share": getattr(share, word) if share else np.nan for word in words}
    return {**{word: counts.of(word) for word in words}, "inside_bodies": counts.inside_bodies, **shares}


def _main(share: AreaShare) -> str | None:
    """The code of the reason for most of what is not reached."""
    return max(share.lost_by, key=lambda name: share.lost_by[name], default=None)


def _words(result: Judged) -> dict[str, Sequence[str]]:
    """The words that columns can have, in their order."""
    plan: Plan = result.plan
    return {
        "verdict": list(WORDS.values()),
        "reason": plan.reasons,
        "surface_class": ["convex", "concave", "saddle", "unjudged"],
        "face": [face.id for face in plan.faces],
        "cutter": [each.id for each in plan.cutters],
    }


_TABLES: dict[str, Callable[[Judged, str], Any]] = {"samples": _samples, "faces": _faces, "cutters": _cutters}
