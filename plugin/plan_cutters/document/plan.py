"""How everything found becomes one plan."""

import datetime
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import SurfaceSamples
from plan_cutters.document import build
from plan_cutters.document.notes import notes_of
from plan_cutters.document.process import (
    OverSetups,
    in_colours_of_steps,
    linear_entries,
    placement_entry,
    process_entry,
    travel_entry,
)
from plan_cutters.domain.answers import RadiusMap
from plan_cutters.domain.figures import reporting
from plan_cutters.domain.kinematics import positions
from plan_cutters.domain.operations import INDEX_TIME
from plan_cutters.domain.own_process import cutter_of
from plan_cutters.domain.standard_tools import Fitting
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import CONCAVE, CONVEX, INACCESSIBLE, NO_REASON, REASONS, SADDLE, UNDECIDED, effective_tolerance
from plan_cutters.library.raw_tool import Library
from plan_cutters.options import Options
from plan_cutters.outcome import Answers
from plan_cutters.plan_file import model as schema
from plan_cutters.plan_file.answers import Beyond, RadiusEntry, StickOutEntry
from plan_cutters.plan_file.effective import Effective, LocalTolerance
from plan_cutters.plan_file.frozen import filled, posture, vector
from plan_cutters.plan_file.part_info import InsideRadiusEntry, PatternEntry, SetupEntry, SetupReach, SharpEdgeEntry
from plan_cutters.plan_file.reasons import MEANING, PALETTE
from plan_cutters.plan_file.reasons import REASONS as WORDS
from plan_cutters.plan_file.shares import unreached
from plan_cutters.plan_file.words import headline as words
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.surroundings import Surroundings


def effective(ready: Prepared) -> Effective:
    """Every option after defaults: as `Options` keeps it where nothing more is said here, angles in degrees."""
    scene, options, choice, surroundings = ready.scene, ready.options, ready.chosen, ready.conditions.surroundings
    sources = [*(["given"] if options.cutters else []), *(library.file for library in options.libraries)]
    made: dict[str, Any] = {
        "cutters": [c.id for c in ready.cutters], "cutter_source": " and ".join(sources) or "built-in",
        "holder": options.holder and options.holder.id, "machine": options.machine.name, "units": options.reported_unit,
        "setup": scene.setup, "placement": placement_entry(options.placement),
        "other_placements": [placement_entry(each) for each in options.other_placements],
        "fixtures": [each.text for each in scene.fixtures],
        "faces": choice.asked, "ignore": list(choice.ignore), "target_faces": [f"F{n}" for n in choice.targets],
        "spacing_mm": max(ready.spacing.values()) if isinstance(ready.spacing, dict) else ready.spacing,
        "sampled_by": "grid" if options.grid is not None else "default" if options.spacing is None else "spacing",
        "tolerance_mm": ready.conditions.tolerance, "tolerance_requested_mm": scene.asked, "local_tolerance": _local(ready),
        "chord_error_mm": surroundings.certain.triangles.chord_error,
        "chord_measured_share": surroundings.certain.triangles.measured_share,
        "obstacle_triangles": len(surroundings.possible.triangles),
        "area_budget": options.contacts_between(len(ready.samples)), "process": _process(ready),
        "axis_accuracy_deg": float(np.degrees(options.accuracy)), "rotary_rates_deg_s": options.machine.rates_deg,
        "index_time_s": INDEX_TIME if options.index_time is None else options.index_time,
    }  # fmt: skip
    return Effective(**{name: as_requested(options, name) for name in Effective.model_fields if name not in made}, **made)


def _local(ready: Prepared) -> list[LocalTolerance]:
    faces, targets = ready.scene.part.faces, set(ready.chosen.targets)
    whole = sum(faces[number - 1].area for number in targets)
    changes = [
        filled(LocalTolerance, faces[number - 1], face=f"F{number}", chord_error_mm=error,
               tolerance_mm=effective_tolerance(0.0, error),
               share=faces[number - 1].area / whole if number in targets and whole > 0.0 else 0.0)
        for number, error in ready.conditions.surroundings.loose.items()
    ]  # fmt: skip
    return sorted(changes, key=lambda each: (-each.chord_error_mm, int(each.face[1:])))


def _process(ready: Prepared) -> dict[str, Any] | None:
    """The planner's own steps, their cutters by id."""
    process = ready.options.process
    if process is None:
        return None
    words = [*(each.cutter for each in process.steps), *(each.cutter for each in process.forbidden)]
    ids = {word: cutter_of(word, ready.cutters, "process").id for word in words}
    steps = tuple(replace(each, cutter=ids[each.cutter]) for each in process.steps)
    forbidden = tuple(replace(each, cutter=ids[each.cutter]) for each in process.forbidden)
    return replace(process, steps=steps, forbidden=forbidden).written()


def as_requested(options: Options, name: str) -> Any:
    """The option of an entry's name."""
    value = getattr(options, re.sub("_(mm|deg|s|mm_min|cm3_min)$", "", name))
    if value is None or not name.endswith("_deg"):
        return value
    return build.degrees(value) if isinstance(value, tuple) else float(np.degrees(value))


#: Of a verdict on what lies just beyond an answer.
_WORDS: dict[int, Beyond] = {INACCESSIBLE: "inaccessible", UNDECIDED: "undecided"}


def stick_out_entry(stick_out: StickOut, samples: SurfaceSamples, surroundings: Surroundings) -> StickOutEntry:
    """A least stick-out."""
    at = stick_out.sample
    nothing = [
        *(["beyond_mm", "face", "point"] if at < 0 else []),
        *(["least_mm", "floor_mm"] if np.isnan(stick_out.least) else []),
    ]
    limiting = {} if at < 0 else {"face": f"F{samples.face[at]}", "point": vector(samples.point[at])}
    return filled(
        StickOutEntry, stick_out, limited_by=stick_out.why, beyond=_WORDS.get(stick_out.verdict), doubtful=surroundings.doubtful,
        posture=None if stick_out.axis is None else posture(stick_out.tilt, stick_out.rotation, stick_out.axis),
        obstacle_face=surroundings.called(stick_out.obstacle_face) if stick_out.obstacle_face else None,
        obstacle_point=None if stick_out.obstacle_point is None else vector(stick_out.obstacle_point),
        **limiting, **dict.fromkeys(nothing),
    )  # fmt: skip


def radius_entry(radius_map: RadiusMap, samples: SurfaceSamples, *, doubtful: bool = False) -> RadiusEntry:
    """A map of largest radii, and where these are the least."""
    row, bottleneck = radius_map.bottleneck, dict[str, Any]()
    if row is not None:
        bottleneck = {
            "bottleneck_mm": float(radius_map.radius[row]),
            "bottleneck_face": f"F{samples.face[row]}",
            "bottleneck_point": vector(samples.point[row]),
            "beyond": _WORDS.get(int(radius_map.beyond[row])),
            "reason": None if radius_map.reason[row] == NO_REASON else REASONS[radius_map.reason[row]],
        }
    none = dict.fromkeys(("bottleneck_mm", "bottleneck_face", "bottleneck_point", "beyond", "reason"))
    return filled(
        RadiusEntry, radius_map, length_over_radius=radius_map.ratio, doubtful=doubtful, **(none | bottleneck),
        percentiles_mm={str(q): radius for q, radius in radius_map.percentiles(samples.area).items()},
        below=int(radius_map.less.sum()), no_less=int(radius_map.no_less.sum()),
    )  # fmt: skip


@reporting(lambda ready: ready.options.reported_unit)
def plan_of(
    ready: Prepared, entries: Sequence[schema.CutterEntry], selected: str | None, selection: schema.Selection,
    started: datetime.datetime, answers: Answers, over: OverSetups, setups: Sequence[SetupEntry],
    sharp_edges: Sequence[SharpEdgeEntry], inside_radii: Sequence[InsideRadiusEntry], patterns: Sequence[PatternEntry],
    fitting: Fitting,
) -> schema.Plan:  # fmt: skip
    """The plan of a part from the entries of its cutters, and what was answered after them."""
    scene, options, choice, samples = ready.scene, ready.options, ready.chosen, ready.samples
    part, surroundings = scene.part, ready.conditions.surroundings
    faces = build.face_entries(part, samples, choice, dict(surroundings.certain.triangles.errors), scene.orientation)
    remarks = notes_of(ready, entries)
    # Whether a fixture stands, or a target face is clamped, in any setup.
    held = any(each.surroundings.fixtures for each in ready.setups) or not ready.alike
    absent = {*(() if held else ("fixture",)), *(() if ready.inside_bodies.any() else ("inside_bodies",))}
    absent |= set() if ready.for_drills.any() else {"drilled"}
    shown, classes = selected or schema.nearest(entries).id, {"convex": CONVEX, "concave": CONCAVE, "saddle": SADDLE}
    rows = {**{name: ready.surface_class == code for name, code in classes.items()}, "unjudged": samples.unjudged >= 0,
            "inside_bodies": ready.inside_bodies, "drilled": ready.for_drills}  # fmt: skip
    counted: dict[str, Any] = {name: int(mine.sum()) for name, mine in rows.items()}
    counted |= {"count": len(samples), "max_gap_mm": samples.max_gap, "regions": len(np.unique(ready.region))}
    counted["exempt"] = 0 if ready.exempt is None else int(ready.exempt.sum())
    process = process_entry(ready, entries, answers, over, shown, fitting)
    return schema.Plan(
        text=schema.NO_TEXT, process=process, part=build.part_info(scene, surroundings, build.void_faces(ready)),
        effective=effective(ready), versions=build.versions(), samples=schema.SampleCounts(**counted),
        scope=build.scope_of(faces), inside_other_bodies=build.inside_entry(ready, entries[0].faces), faces=faces,
        missing=build.missing_entries(part, surroundings), machine=machine_entry(ready),
        reasons=list(REASONS), reason_words={code: WORDS[code].name for code in REASONS},
        fixtures=[build.fixture_entry(fixture, setups) for fixture, setups in build.fixtures_in(ready)],
        libraries=[_library_entry(each) for each in options.libraries],
        cutters=list(entries), selected=selected, shown=shown, selection=selection,
        selected_over_setups=None if surroundings.doubtful else next((e.id for e in entries if e.lost_in_all == 0), None),
        selected_for_setup=None if selected else for_setup(entries),
        sharp_edges=list(sharp_edges), inside_radii=list(inside_radii), patterns=list(patterns), setups=list(setups),
        least_set=None if answers.least_set is None else answers.least_set.entry,
        operations=None if answers.operations is None else in_colours_of_steps(answers.operations.entry, process),
        largest_radius=[radius_entry(radii, samples, doubtful=surroundings.doubtful) for radii in answers.radius_maps],
        not_mended=list(answers.not_mended), notes=[each.text for each in remarks], note_codes=[each.code for each in remarks],
        legend={word: colour for word, colour in PALETTE.items() if word not in absent},
        legend_words={word: MEANING[word] for word in PALETTE if word not in absent},
        run=schema.Run(time=started.isoformat(timespec="seconds"), seconds={}),
    )  # fmt: skip


def _library_entry(library: Library) -> schema.LibraryEntry:
    return filled(
        schema.LibraryEntry, library, tools=len(library.entries), cutters=len(library), drills=len(library.drills),
        holders=[holder.name or holder.id for holder in library.holders],
        unused=[filled(schema.UnusedEntry, each, why=each.unused or "") for each in library.unused],
    )  # fmt: skip


def machine_entry(ready: Prepared) -> schema.MachineEntry:
    """The machine, its axes in the part's frame."""
    machine, kinematics = ready.options.machine, ready.conditions.kinematics
    rotary = None
    if kinematics is not None:
        rotary = [
            filled(schema.RotaryEntry, axis, direction=vector(direction), limits_deg=axis.limits and build.degrees(axis.limits))
            for axis, direction in zip(machine.rotary, kinematics.direction, strict=True)
        ]
    limit = None if machine.tilt_limit is None else round(float(np.degrees(machine.tilt_limit)), 9)
    return filled(schema.MachineEntry, machine, tilt_limit_deg=limit, rotary=rotary, linear=linear_entries(ready))


def completed(
    entries: Sequence[schema.CutterEntry], ready: Prepared, answers: Answers, over: OverSetups, beyond: NDArray[np.bool_],
    travels: Mapping[str, Travel], between: Mapping[str, schema.AreaEntry],
) -> list[schema.CutterEntry]:  # fmt: skip
    """The entries of cutters with where they are listed, what the limits lose for all (n,), and what was found after them."""
    completed_entries, sources, samples, inside = [], ready.options.sources, ready.samples, ready.inside_bodies
    kinematics, frames = ready.conditions.kinematics, [each.kinematics for each in ready.setups]
    for entry in entries:
        name, reach, serves = entry.id, over.reaches[entry.id], over.served_in[entry.id]
        moved, area = travels.get(name), between.get(name)
        stick_out, mend = answers.stick_outs.get(name), answers.mends.get(name)
        surroundings = ready.setups[0 if stick_out is None else stick_out.setup].surroundings
        more: dict[str, Any] = {
            "beyond_setup": int(beyond.sum()), "area": area, "seen": entry.seen or (area is not None and area.feasible),
            "travel": moved and travel_entry(ready.options.machine, moved, over.each[0][1][name], samples),
            "sources": [filled(schema.SourceEntry, each, file=file.file) for file, each in sources.get(name, ())],
            "least_stick_out": stick_out and stick_out_entry(stick_out, samples, surroundings), "mend": mend and mend.entry,
        }  # fmt: skip
        # How many of the postures found lie near the rotary axis next to the part.
        if kinematics is not None and len(kinematics.turning()[1]) > 1:
            _, _, singular = positions(frames, reach.axis, serves)
            more["singular"] = int(singular[reach.reached].sum())
        if len(over.each) > 1:
            more["setups"] = [
                SetupReach(
                    axis=axis, serves=int((serves == k).sum()), **build.counts(verdicts[name].verdict, inside, ready.exempt)
                )
                for k, (axis, verdicts) in enumerate(over.each)
            ]
            more["lost_in_all"] = int((reach.not_reached & ready.finished).sum())
        completed_entries.append(entry.model_copy(update=more))
    return completed_entries


def for_setup(entries: Sequence[schema.CutterEntry]) -> str | None:
    """The first cutter that leaves nothing but what no cutter can reach in this setup, or what stands on its proposed table."""
    for e in entries:
        done, stood = e.interference_free + e.accessible, e.by_reason.get(schema.ANOTHER_SETUP, 0)
        if done and (e.beyond_setup or stood) and not e.undecided and e.blocked == e.beyond_setup + stood:
            return e.id
    return None


def selection(entries: Sequence[schema.CutterEntry], free_form: float) -> tuple[str | None, schema.Selection]:
    """Which cutter wins, of entries from the most wanted down, and why; `free_form`: the share of such faces."""
    feasible = [e for e in entries if e.feasible]
    before = entries[: entries.index(feasible[0])] if feasible else entries
    selected, runners_up, best = None, feasible, schema.nearest(entries)
    if stood := next((e for e in before if e.by_reason.get(schema.ANOTHER_SETUP) and not any(schema.leaves(e))), None):
        why = words.stands(stood.id)
    elif feasible:
        selected, runners_up, why = feasible[0].id, feasible[1:], words.why([e.id for e in before])
    elif best.not_reached:
        share = unreached(best, best.area_share)
        why = f"no cutter reaches every sample; {best.id} comes nearest and leaves {share} of the area"
    else:
        why = f"{best.id} reaches every judged sample, but obstacles are missing: see the notes"
    runner_up = runners_up[0].id if runners_up else None
    return selected, schema.Selection(rule=words.rule(free_form), free_form=free_form, runner_up=runner_up, why=why)
