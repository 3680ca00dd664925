"""Check a written plan of operations against the part: its labels, angles and weights, with the test that the search uses, too.

It asks three things. Does each operation serve its samples with the orientation that is written down? Does some operation
take each sample that is reached? Do the weights load no candidate with more than 1,000,000, so that they prove the bound?
Whether the tool is free at a sample is judged by `served_by`, as in the search: a fault of that test is found by neither.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.cutter import Cutter
from plan_cutters.errors import OptionError
from plan_cutters.operations.candidates import Orientations
from plan_cutters.scene.fixed_axis import served_by
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.setups import places

_UNIT = 1_000_000
#: Parts of unit axes that differ by less are the same; and where angles are rounded to 0.001 deg.
_SAME, _ROUNDED = 1e-9, 1e-4


@dataclass(frozen=True, slots=True)
class Finding:
    """One statement of the plan, whether it holds, and in words how it was checked."""

    holds: bool
    words: str


def check_operations(ready: Prepared, document: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> list[Finding]:
    """Check the operations of a plan.

    Parameters
    ----------
    ready : Prepared
        The part, with the options that the plan was made with.
    document : mapping
        plan.json as it was read.
    arrays : mapping
        operations.npz as it was read.

    Raises
    ------
    OptionError
        They are not of this part or of these options.
    """
    entry = document.get("operations")
    if not isinstance(entry, dict):
        raise OptionError("the plan has no operations: make it with --operations")
    _fits(ready, document, arrays)
    cutters = {cutter.id: cutter for cutter in ready.cutters}
    orientations = [Orientations.of(conditions) for conditions in ready.setups]
    findings = [_weights(ready, entry, arrays, orientations)]
    for k, plan in enumerate(entry["plans"]):
        label = arrays[f"operation_{plan['name'].replace(' ', '_')}" if k else "operation"]
        findings += _plan(ready, plan, entry["rotary"], label, cutters, orientations)
    return findings


def _fits(ready: Prepared, document: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a plan of another part or of other options."""
    asked, options = document["effective"], ready.options
    pairs = [
        ("part", document["part"].get("sha256"), ready.scene.part.sha256),
        (
            "files that the part refers to",
            [(each["file"], each["sha256"]) for each in document["part"].get("references", [])],
            list(ready.scene.part.references),
        ),
        ("cutters (--cutter, --holder)", asked["cutters"], [cutter.id for cutter in ready.cutters]),
        ("machine (--machine)", asked["machine"], options.machine.name),
        ("setup (--setup)", [round(x, 9) for x in asked["setup"]], [round(x, 9) for x in ready.scene.setup]),
        (
            "other setups (--setup)",
            [round(x, 9) for axis in asked["other_setups"] for x in axis],
            [round(x, 9) for axis in options.other_setups for x in axis],
        ),
        # Not their places: where a fixture stands shows in what it serves.
        (
            "fixtures (--fixture, --setup)",
            [
                [each["name"] for each in document["fixtures"] if s in each.get("setups", [0])]
                for s in range(len(ready.setups))
            ],
            [[each.name for each in one.around.fixtures] for one in ready.setups],
        ),
        (
            "clamped faces (--setup)",
            [
                (place or {}).get("clamped", [])
                for place in (asked["placement"], *(asked["other_placements"] or [None] * len(asked["other_setups"])))
            ],
            [[] if place is None else list(place.clamped) for place in places(options)],
        ),
        ("tolerance (--tolerance)", asked["tolerance_mm"], ready.conditions.tolerance),
        ("number of samples (--grid, --spacing, --faces)", document["samples"]["count"], len(ready.samples)),
    ]
    for what, was, now in pairs:
        if was != now:
            raise OptionError(
                f"the plan of operations does not fit: {what}: {_short(was)} in the plan, {_short(now)} here"
            )
    if any(len(array) != len(ready.samples) for name, array in arrays.items() if name.startswith("operation")):
        raise OptionError("operations.npz is of other samples than the plan")


def _short(value: Any) -> str:
    text = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _weights(
    ready: Prepared, entry: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]], orientations: list[Orientations]
) -> Finding:
    """The weights on samples, added up for each candidate."""
    few = entry["fewest"]
    rows = np.array([row for row, _ in few["weights"]], np.int64)
    weight = np.array([w for _, w in few["weights"]], np.int64)
    cutter, setup, angle = arrays["candidate_cutter"], arrays["candidate_setup"], arrays["candidate_angle"]
    if len(rows) and (rows.min() < 0 or rows.max() >= len(ready.samples) or weight.min() < 0 or weight.max() > _UNIT):
        return Finding(False, "The weights name samples that there are not, or are negative or above 1,000,000.")
    most, served = 0, np.zeros(len(rows), bool)
    for c, s in sorted({*zip(cutter.tolist(), setup.tolist(), strict=True)}):
        axes = orientations[s].kinematics.axis(np.radians(angle[(cutter == c) & (setup == s)]))
        free, _ = served_by(rows, axes, ready.samples, ready.cutters[c], ready.setups[s])
        free &= ready.machinable[s][rows]
        most, served = max(most, int((free @ weight).max(initial=0))), served | free.any(axis=0)
    if not served.all():
        # A sample that no candidate serves would make any number of orientations too few.
        return Finding(False, f"{int((~served).sum())} of the samples with weights are served by no candidate.")
    total = int(weight.sum())
    proved = -(-total // _UNIT)
    claimed = few["at_least"] if few["proof"] == "weights" else min(few["at_least"], proved)
    used = sum(
        each["mode"] == "fixed" for plan in entry["plans"] if plan["name"] == "fewest" for each in plan["operations"]
    )
    if used > few["found"]:
        return Finding(False, f"The fewest operations are said to be {few['found']}, and there are {used}.")
    words = (f"The weights of {len(rows)} samples sum up to {total / _UNIT:.6f}; none of {len(angle)} candidates carries more "
             f"than {most / _UNIT:.6f}: at least {proved} orientations are needed, the plan says {few['at_least']}"
             f"{' (by branch and bound, which is not checked)' * (few['proof'] == 'branch and bound')}.")  # fmt: skip
    return Finding(most <= _UNIT and proved >= claimed and few["at_least"] <= few["found"], words)


def _plan(
    ready: Prepared, plan: Mapping[str, Any], names: list[str], label: NDArray[Any],
    cutters: Mapping[str, Cutter], orientations: list[Orientations],
) -> list[Finding]:  # fmt: skip
    """Each operation at its own samples, with the axis that its angles give."""
    wrong, tested, loose, strange = 0, 0, 0, int(((label < -1) | (label >= len(plan["operations"]))).sum())
    at_odds = []
    for k, operation in enumerate(plan["operations"]):
        rows = np.flatnonzero(label == k)
        if operation["samples"] != len(rows) or operation["setup"] not in range(len(ready.setups)):
            at_odds.append(operation["id"])
            continue
        if not np.array_equal(rows, _of_regions(operation, len(label))):
            return [Finding(False, f"The {plan['name']} plan: the regions of {operation['id']} do not have the samples that "
                                   "operations.npz gives it.")]  # fmt: skip
        if operation["mode"] != "fixed":
            loose += len(rows)
            continue
        every = [operation["angles_deg"], *filter(None, [operation["other_angles_deg"]])]
        turned = orientations[operation["setup"]].kinematics.axis(
            np.radians([[one[name] for name in names] for one in every])
        )
        # Of other angles as they are rounded for a control; nan is near nothing.
        away = np.abs(turned - operation["axis"]).max(axis=1)
        if not (away <= [_SAME, *[_ROUNDED] * (len(every) - 1)]).all():
            at_odds.append(operation["id"])
        axis = turned[:1]
        free, _ = served_by(rows, axis, ready.samples, cutters[operation["cutter"]], ready.setups[operation["setup"]])
        free &= ready.machinable[operation["setup"]][rows]
        wrong += int((~free[0]).sum())
        tested += len(rows)
    each = len([operation for operation in plan["operations"] if operation["mode"] == "fixed"])
    served = Finding(wrong == 0, f"The {plan['name']} plan: each of {each} fixed operations was put down at its samples, "
                                 f"{tested} in all; {wrong} of them are not served."
                                 f"{f' {loose} of simultaneous motion were not put down.' if loose else ''}")  # fmt: skip
    if at_odds:
        served = Finding(False, f"The {plan['name']} plan contradicts itself in the axis, the angles, the setup or the number of "
                                f"samples of {', '.join(map(str, at_odds))}.")  # fmt: skip
    rest = int((ready.finished & ((label < 0) | (label >= len(plan["operations"])))).sum())
    whole = Finding(rest == plan["rest"]["samples"] and not strange,
                    f"The {plan['name']} plan leaves {rest} judged samples, and says {plan['rest']['samples']}"
                    f"{f'; {strange} go with operations that there are not' if strange else ''}.")  # fmt: skip
    return [served, whole]


def _of_regions(operation: Mapping[str, Any], count: int) -> NDArray[np.int64]:
    """The samples of an operation's regions, in order, where there are `count`: what a planner cuts."""
    runs = [(int(first), int(last) + 1) for region in operation["regions"] for first, last in region["rows"]]
    if any(first < 0 or end > count for first, end in runs):
        raise ValueError(f"regions of {operation['id']} name samples that there are not")
    return np.sort(np.concatenate([np.zeros(0, np.int64), *(np.arange(*run) for run in runs)]))
