"""The answers after the plan become entries of the plan file here."""

import numpy as np

from cad_io.arrays import SurfaceSamples
from plan_cutters.domain.area import Patch
from plan_cutters.domain.change import Advice, Step
from plan_cutters.domain.least_set import LeastSet
from plan_cutters.domain.radius_map import RadiusMap
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.verdicts import INACCESSIBLE, NO_REASON, REASONS, UNDECIDED
from plan_cutters.plan_file.answers import (
    Beyond,
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


def stick_out_entry(stick_out: StickOut, samples: SurfaceSamples, surroundings: Surroundings) -> StickOutEntry:
    """A least stick-out."""
    limited, none = stick_out.sample >= 0, np.isnan(stick_out.least)
    return StickOutEntry(
        least_mm=None if none else stick_out.least,
        floor_mm=None if none else stick_out.floor,
        longest_mm=stick_out.longest,
        limited_by=stick_out.why,
        served=stick_out.served,
        beyond_mm=stick_out.beyond if limited else None,
        beyond=_WORDS.get(stick_out.verdict),
        face=f"F{samples.face[stick_out.sample]}" if limited else None,
        point=vector(samples.point[stick_out.sample]) if limited else None,
        posture=None if stick_out.axis is None else posture(stick_out.tilt, stick_out.rotation, stick_out.axis),
        obstacle_face=surroundings.called(stick_out.obstacle_face) if stick_out.obstacle_face else None,
        obstacle_point=None if stick_out.obstacle_point is None else vector(stick_out.obstacle_point),
        doubtful=surroundings.doubtful,
    )


def radius_entry(radius_map: RadiusMap, samples: SurfaceSamples, *, doubtful: bool = False) -> RadiusEntry:
    """A map of largest radii."""
    row = radius_map.bottleneck
    reason = None if row is None or radius_map.reason[row] == NO_REASON else REASONS[radius_map.reason[row]]
    return RadiusEntry(
        shape=radius_map.shape,
        length_over_radius=radius_map.ratio,
        step=radius_map.step,
        least_mm=radius_map.least,
        most_mm=radius_map.most,
        percentiles_mm={str(q): radius for q, radius in radius_map.percentiles(samples.area).items()},
        below=int(radius_map.less.sum()),
        no_less=int(radius_map.no_less.sum()),
        doubtful=doubtful,
        bottleneck_mm=None if row is None else float(radius_map.radius[row]),
        bottleneck_face=None if row is None else f"F{samples.face[row]}",
        bottleneck_point=None if row is None else vector(samples.point[row]),
        beyond=None if row is None else _WORDS.get(int(radius_map.beyond[row])),
        reason=reason,
    )


def advice_entry(advice: Advice) -> MendEntry:
    """Make the entry of what to do next with a cutter."""
    return filled(
        MendEntry,
        advice,
        lost_share=advice.share,
        steps=[_step_entry(each) for each in advice.steps],
        lost_areas=[_area_entry(each) for each in advice.areas],
        more_lost_areas=advice.more_areas,
    )


def least_set_entry(least: LeastSet, *, doubtful: bool = False) -> LeastSetEntry:
    """The fewest runs."""
    runs = [filled(RunEntry, each, cutter=each.cutter.id, area_mm2=each.area, faces=list(each.faces)) for each in least.runs]
    return filled(LeastSetEntry, least, runs=runs, doubtful=doubtful)


def _area_entry(area: Patch) -> LostAreaEntry:
    return filled(
        LostAreaEntry, area, area_mm2=area.area, faces=list(area.faces), point=area.place, across_mm=area.across, why=patch(area)
    )


def _joined(words: list[str]) -> str:
    rest = " for the rest"
    if len(words) > 1 and all(each.endswith(rest) for each in words):
        return " and ".join(each.removesuffix(rest) for each in words) + rest
    return ", and ".join(words)


def _step_entry(step: Step) -> StepEntry:
    return filled(
        StepEntry,
        step,
        changes=[MoveEntry(thing=each.means, now=each.now, asked=each.asked, why=each.words) for each in step.moves],
        lost_before=step.before,
        lost_after=step.after,
        cutters=[each.id for each in step.cutters],
        setups=[vector(each) for each in step.setups],
        why=_joined([each.words for each in step.moves]),
        remains=[_area_entry(each) for each in step.remains],
    )
