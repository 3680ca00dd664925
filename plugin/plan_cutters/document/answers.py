"""The answers after the plan become entries of the plan file here."""

import numpy as np

from cad_io.arrays import SurfaceSamples
from plan_cutters.domain.area import Patch
from plan_cutters.domain.change import Change, Mend, Step, Value
from plan_cutters.domain.least_set import LeastSet
from plan_cutters.domain.radius_map import RadiusMap
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.verdicts import INACCESSIBLE, NO_REASON, REASONS, UNDECIDED
from plan_cutters.plan_file.answers import (
    Beyond,
    ChangeEntry,
    LeastSetEntry,
    LostAreaEntry,
    MendEntry,
    MoveEntry,
    RadiusEntry,
    RunEntry,
    StepEntry,
    StickOutEntry,
)
from plan_cutters.plan_file.frozen import filled, posture, vector
from plan_cutters.plan_file.words.change_text import patch
from plan_cutters.scene.surroundings import Surroundings

#: Of a verdict on what lies just beyond an answer.
_WORDS: dict[int, Beyond] = {INACCESSIBLE: "inaccessible", UNDECIDED: "undecided"}


def stick_out_entry(found: StickOut, samples: SurfaceSamples, around: Surroundings) -> StickOutEntry:
    """A least stick-out."""
    limited, none = found.sample >= 0, np.isnan(found.least)
    return StickOutEntry(
        least_mm=None if none else found.least,
        floor_mm=None if none else found.floor,
        longest_mm=found.longest,
        limited_by=found.why,
        served=found.served,
        beyond_mm=found.beyond if limited else None,
        beyond=_WORDS.get(found.verdict),
        face=f"F{samples.face[found.sample]}" if limited else None,
        point=vector(samples.point[found.sample]) if limited else None,
        posture=None if found.axis is None else posture(found.tilt, found.rotation, found.axis),
        obstacle_face=around.called(found.obstacle_face) if found.obstacle_face else None,
        obstacle_point=None if found.obstacle_point is None else vector(found.obstacle_point),
        doubtful=around.doubtful,
        step_mm=None if found.each is None else found.step,
    )


def radius_entry(found: RadiusMap, samples: SurfaceSamples, *, doubtful: bool = False) -> RadiusEntry:
    """A map of largest radii."""
    row = found.bottleneck
    reason = None if row is None or found.reason[row] == NO_REASON else REASONS[found.reason[row]]
    return RadiusEntry(
        shape=found.shape,
        length_over_radius=found.ratio,
        step=found.step,
        least_mm=found.least,
        most_mm=found.most,
        percentiles_mm={str(q): radius for q, radius in found.percentiles(samples.area).items()},
        below=int(found.less.sum()),
        no_less=int(found.no_less.sum()),
        doubtful=doubtful,
        bottleneck_mm=None if row is None else float(found.radius[row]),
        bottleneck_face=None if row is None else f"F{samples.face[row]}",
        bottleneck_point=None if row is None else vector(samples.point[row]),
        beyond=None if row is None else _WORDS.get(int(found.beyond[row])),
        reason=reason,
    )


def mend_entry(found: Mend) -> MendEntry:
    """Make the entry of a what-if answer: the changes that would make a cutter feasible, and the next steps."""
    return filled(
        MendEntry, found, changes=[_change_entry(each) for each in found.changes], lost_share=found.share,
        steps=[_step_entry(each) for each in found.steps], lost_areas=[_area_entry(each) for each in found.areas],
        more_lost_areas=found.more_areas,
    )  # fmt: skip


def least_set_entry(found: LeastSet, *, doubtful: bool = False) -> LeastSetEntry:
    """The fewest runs."""
    runs = [
        filled(RunEntry, each, cutter=each.cutter.id, area_mm2=each.area, faces=list(each.faces)) for each in found.runs
    ]
    return filled(LeastSetEntry, found, runs=runs, doubtful=doubtful)


def _area_entry(found: Patch) -> LostAreaEntry:
    return filled(LostAreaEntry, found, area_mm2=found.area, faces=list(found.faces), point=found.place, across_mm=found.across,
                  why=patch(found))  # fmt: skip


def _joined(words: list[str]) -> str:
    rest = " for the rest"
    if len(words) > 1 and all(each.endswith(rest) for each in words):
        return " and ".join(each.removesuffix(rest) for each in words) + rest
    return ", and ".join(words)


def _step_entry(found: Step) -> StepEntry:
    return filled(
        StepEntry, found,
        changes=[MoveEntry(thing=each.means, now=each.now, asked=each.asked, why=each.words) for each in found.moves],
        lost_before=found.before, lost_after=found.after, cutters=[each.id for each in found.cutters],
        setups=[vector(each) for each in found.setups], why=_joined([each.words for each in found.moves]),
        remains=[_area_entry(each) for each in found.remains],
    )  # fmt: skip


def _change_entry(found: Change) -> ChangeEntry:
    return filled(
        ChangeEntry, found, now=_plain(found.now), asked=_plain(found.asked), beyond=_plain(found.beyond),
        cutter=None if found.cutter is None else found.cutter.id, lost_before=found.before, lost_after=found.after,
    )  # fmt: skip


def _plain(value: Value) -> Value:
    """JSON has no infinity."""
    return None if isinstance(value, float) and not np.isfinite(value) else value
