"""How everything found becomes one plan."""

import datetime
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.document.answers import advice_entry, least_set_entry, radius_entry, stick_out_entry
from plan_cutters.document.build import degrees, face_entries, missing_entries, part_info, scope_of, versions
from plan_cutters.document.effective import effective
from plan_cutters.document.fixtures import fixture_entries
from plan_cutters.document.inside import inside_entry, void_faces
from plan_cutters.document.libraries import library_entry, source_entry
from plan_cutters.document.notes import notes_of
from plan_cutters.document.over_setups import OverSetups
from plan_cutters.document.process import process_entry
from plan_cutters.document.shares import counts
from plan_cutters.document.travel import linear_entries, travel_entry
from plan_cutters.domain.fillet import Fitting
from plan_cutters.domain.lengths import reporting
from plan_cutters.domain.over_setups import positions
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import CONCAVE, CONVEX, REASONS, SADDLE
from plan_cutters.outcome import Answers
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.inside_radii import InsideRadiusEntry
from plan_cutters.plan_file.model import AreaEntry, CutterEntry, MachineEntry, Plan, RotaryEntry, Run, SampleCounts, Selection
from plan_cutters.plan_file.nearest import ANOTHER_SETUP, leaves, nearest
from plan_cutters.plan_file.palette import MEANING, PALETTE
from plan_cutters.plan_file.patterns import PatternEntry
from plan_cutters.plan_file.reasons import REASONS as WORDS
from plan_cutters.plan_file.setups import SetupEntry, SetupReach
from plan_cutters.plan_file.shares import unreached
from plan_cutters.plan_file.sharp_edges import SharpEdgeEntry
from plan_cutters.plan_file.words import choice as words
from plan_cutters.scene.preparation import Prepared


@reporting(lambda ready: ready.options.reported_unit)
def plan_of(
    ready: Prepared,
    entries: Sequence[CutterEntry],
    selected: str | None,
    selection: Selection,
    started: datetime.datetime,
    answers: Answers,
    over: OverSetups,
    setups: Sequence[SetupEntry] = (),
    sharp_edges: Sequence[SharpEdgeEntry] = (),
    inside_radii: Sequence[InsideRadiusEntry] = (),
    patterns: Sequence[PatternEntry] = (),
    fitting: Fitting | None = None,
) -> Plan:
    """The plan of a part from the entries of its cutters, and what was answered after them."""
    scene, options, choice, samples = ready.scene, ready.options, ready.chosen, ready.samples
    part, surroundings = scene.part, ready.conditions.surroundings
    faces = face_entries(part, samples, choice, dict(surroundings.certain.triangles.errors), scene.orientation)
    remarks = notes_of(ready, entries)
    absent = {*(() if _anything_held(ready) else ("fixture",)), *(() if ready.inside_bodies.any() else ("inside_bodies",))}
    shown = selected or nearest(entries).id
    return Plan(
        process=process_entry(ready, entries, answers, over, shown, fitting),
        part=part_info(scene, surroundings, void_faces(ready)),
        effective=effective(ready),
        versions=versions(),
        samples=SampleCounts(
            count=len(samples),
            max_gap_mm=samples.max_gap,
            convex=int((ready.surface_class == CONVEX).sum()),
            concave=int((ready.surface_class == CONCAVE).sum()),
            saddle=int((ready.surface_class == SADDLE).sum()),
            unjudged=int((samples.unjudged >= 0).sum()),
            regions=len(np.unique(ready.region)),
            inside_bodies=int(ready.inside_bodies.sum()),
            exempt=0 if ready.exempt is None else int(ready.exempt.sum()),
        ),
        scope=scope_of(faces),
        inside_other_bodies=inside_entry(ready, entries[0].faces),
        faces=faces,
        missing=missing_entries(part, surroundings),
        reasons=list(REASONS),
        reason_words={code: WORDS[code].name for code in REASONS},
        machine=machine_entry(ready),
        fixtures=fixture_entries([each.surroundings for each in ready.setups]),
        libraries=[library_entry(library) for library in options.libraries],
        cutters=list(entries),
        selected=selected,
        shown=shown,
        selection=selection,
        selected_over_setups=None if surroundings.doubtful else next((e.id for e in entries if e.lost_in_all == 0), None),
        selected_for_setup=None if selected else for_setup(entries),
        sharp_edges=list(sharp_edges),
        inside_radii=list(inside_radii),
        patterns=list(patterns),
        setups=list(setups),
        least_set=None if answers.least_set is None else least_set_entry(answers.least_set, doubtful=surroundings.doubtful),
        operations=None if answers.operations is None else answers.operations.entry,
        not_mended=list(answers.not_mended),
        largest_radius=[radius_entry(radii, samples, doubtful=surroundings.doubtful) for radii in answers.radius_maps],
        notes=[each.text for each in remarks],
        note_codes=[each.code for each in remarks],
        legend={word: colour for word, colour in PALETTE.items() if word not in absent},
        legend_words={word: MEANING[word] for word in PALETTE if word not in absent},
        run=Run(time=started.isoformat(timespec="seconds"), seconds={}),
    )


def _anything_held(ready: Prepared) -> bool:
    """Whether a fixture stands, or a target face is clamped, in any setup."""
    return any(each.surroundings.fixtures for each in ready.setups) or not ready.alike


def machine_entry(ready: Prepared) -> MachineEntry:
    """The machine, its axes in the part's frame."""
    machine, kinematics = ready.options.machine, ready.conditions.kinematics
    rotary = None
    if kinematics is not None:
        rotary = [
            RotaryEntry(
                name=axis.name,
                carries=axis.carries,
                direction=vector(direction),
                limits_deg=None if axis.limits is None else degrees(axis.limits),
            )
            for axis, direction in zip(machine.rotary, kinematics.direction, strict=True)
        ]
    limit = None if machine.tilt_limit is None else round(float(np.degrees(machine.tilt_limit)), 9)
    return MachineEntry(
        name=machine.name, tilt_limit_deg=limit, rotary=rotary, linear=linear_entries(ready), notes=list(machine.notes)
    )


def _of_setups(ready: Prepared, name: str, over: OverSetups) -> dict[str, Any]:
    """Count the samples that a cutter reaches in each of several setups, and those that it reaches in none."""
    if not over.elsewhere:
        return {}
    inside, serves = ready.inside_bodies, over.served_in[name]
    entries = [
        SetupReach(axis=axis, serves=int((serves == k).sum()), **counts(verdicts[name].verdict, inside, ready.exempt))
        for k, (axis, verdicts) in enumerate(over.each())
    ]
    return {"setups": entries, "lost_in_all": int((over.reaches[name].not_reached & ready.finished).sum())}


def _singular(ready: Prepared, name: str, over: OverSetups) -> int | None:
    """How many of the postures found lie near the rotary axis next to the part."""
    kinematics = ready.conditions.kinematics
    if kinematics is None or len(kinematics.turning()[1]) < 2:
        return None
    _, _, singular = positions([each.kinematics for each in ready.setups], over.reaches[name].axis, over.served_in[name])
    return int(singular[over.reaches[name].reached].sum())


def completed(
    entries: Sequence[CutterEntry],
    ready: Prepared,
    answers: Answers,
    over: OverSetups,
    beyond: NDArray[np.bool_],
    travels: Mapping[str, Travel],
    between: Mapping[str, AreaEntry],
) -> list[CutterEntry]:
    """The entries of cutters with where they are listed, what the limits lose for all (n,), and what was found after them."""
    completed_entries, sources, samples = [], ready.options.sources, ready.samples
    reached_by_none = int(beyond.sum())
    for entry in entries:
        moved, area = travels.get(entry.id), between.get(entry.id)
        stick_out, mend = answers.stick_outs.get(entry.id), answers.mends.get(entry.id)
        here = over.here[entry.id]
        surroundings = ready.setups[0 if stick_out is None else stick_out.setup].surroundings
        more = {
            **_of_setups(ready, entry.id, over),
            "beyond_setup": reached_by_none,
            "singular": _singular(ready, entry.id, over),
            "travel": None if moved is None else travel_entry(ready.options.machine, moved, here, samples),
            "sources": [source_entry(*place) for place in sources.get(entry.id, ())],
            "least_stick_out": None if stick_out is None else stick_out_entry(stick_out, samples, surroundings),
            "mend": None if mend is None else advice_entry(mend),
            "area": area,
            "seen": entry.seen or (area is not None and area.feasible),
        }
        completed_entries.append(entry.model_copy(update=more))
    return completed_entries


def for_setup(entries: Sequence[CutterEntry]) -> str | None:
    """The first cutter that leaves nothing but what no cutter can reach in this setup, or what stands on its proposed table."""
    for e in entries:
        done, stood = e.interference_free + e.accessible, e.by_reason.get(ANOTHER_SETUP, 0)
        if done and (e.beyond_setup or stood) and not e.undecided and e.blocked == e.beyond_setup + stood:
            return e.id
    return None


def selection(entries: Sequence[CutterEntry], free_form: float) -> tuple[str | None, Selection]:
    """Which cutter wins, of entries from the most wanted down, and why; `free_form`: the share of such faces."""
    feasible, rule = [e for e in entries if e.feasible], words.rule(free_form)
    first = feasible[0] if feasible else None
    before = entries if first is None else entries[: entries.index(first)]
    if stood := next((e for e in before if e.by_reason.get(ANOTHER_SETUP) and not any(leaves(e))), None):
        runner_up = None if first is None else first.id
        return None, Selection(rule=rule, free_form=free_form, runner_up=runner_up, why=words.stands(stood.id))
    if first is None:
        best = nearest(entries)
        text = f"{unreached(best, best.area_share)} of the area"
        why = f"no cutter reaches every sample; {best.id} comes nearest and leaves {text}"
        if not best.not_reached:
            why = f"{best.id} reaches every judged sample, but obstacles are missing: see the notes"
        return None, Selection(rule=rule, free_form=free_form, runner_up=None, why=why)
    runner_up = feasible[1].id if len(feasible) > 1 else None
    why = words.why([e.id for e in before])
    return first.id, Selection(rule=rule, free_form=free_form, runner_up=runner_up, why=why)
