"""The notes of a plan: where each is found; their words stand in `plan_file.words.notes`."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from cad_io import Part
from cad_io.arrays import rows_by_face
from cad_io.graphs import connected
from cad_io.part.edges import folded_faces
from cad_io.part.part import CROSSES
from cad_io.write.step import changed_by_step
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import count, ranges
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.travel import unjudged
from plan_cutters.options import Options
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.words import notes
from plan_cutters.plan_file.words.notes import Note, note
from plan_cutters.scene.faces import clamped_faces, repeated_groups
from plan_cutters.scene.preparation import BUDGET, Prepared, places
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups.workpiece import TOGETHER, material_bodies


def notes_of(ready: Prepared, entries: Sequence[CutterEntry]) -> list[Note]:
    """All notes, in the order in which people read them."""
    scene, options, surroundings = ready.scene, ready.options, ready.conditions.surroundings
    return [
        *_of_cutters(options, ready.cutters),
        note("samples_apart", most_mm=ready.samples.max_gap),
        *([note("not_sampled", *_ids([number for number, _ in ready.samples.empty]))] if ready.samples.empty else []),
        *_of_sides(ready),
        *_of_surfaces(scene),
        *_of_obstacles(scene.part, surroundings),
        *_of_bodies(ready),
        *_of_fixtures(ready),
        *_of_choice(ready),
        *_of_setups(ready),
        *_of_limits(ready),
        *_of_area(entries, doubtful=surroundings.doubtful),
    ]


def noted(plan: Plan, note: Note, **more: Any) -> Plan:
    """The plan with one note more, and with more of its fields."""
    return plan.model_copy(update={**more, "notes": [*plan.notes, note.text], "note_codes": [*plan.note_codes, note.code]})


def noted_coarser(options: Options, plan: Plan) -> Plan:
    """The plan with a note that the density of samples in some options was not taken, for it asks too much of this part."""
    wanted, samples = f"`--spacing {options.spacing:g}`" if options.grid is None else f"`--grid {options.grid}`", plan.samples
    many = count(samples.count, "sample")
    return noted(plan, note("coarser_than_requested", wanted=wanted, samples=many, most_mm=samples.max_gap_mm))


def _ids(numbers: Sequence[int]) -> list[str]:
    return [f"F{number}" for number in numbers]


def _of_cutters(options: Options, cutters: Sequence[Cutter]) -> Iterator[Note]:
    """How the cutters are judged, and the planner's own steps."""
    if not options.cutters and not options.libraries:
        yield note("cutters_built_in")
    if bare := [c.id for c in cutters if c.holder is None]:
        yield note("no_holder", *bare)
    most = options.postures.tilt[1]
    if beyond := [c.id for c in cutters if max(mode.high for mode in modes(c)) > most + 1e-6 > 0.5 * np.pi]:
        yield note("tilts_not_searched", *beyond, most_deg=float(np.degrees(most)))
    if cutters and all(c.holder is None and not c.stages for c in cutters):
        yield note("all_length_cuts")
    if options.process is not None and (rounded := options.process.rounded()):
        yield notes.angles_rounded(rounded)


def _of_sides(ready: Prepared) -> Iterator[Note]:
    """The machine, the side of the material, and how closely triangles follow the surface."""
    scene, tolerance = ready.scene, ready.conditions.tolerance
    if not ready.options.machine.limited:
        yield note("no_machine")
    if scene.part.encoding:
        yield note("names_decoded", encoding=scene.part.encoding)
    if not scene.orientation.confident:
        yield notes.side_guessed(loose=bool(scene.part.sewn.faces))
        if other := scene.turned_faces():
            yield note("side_by_setup", *other)
    if tolerance > 1.001 * scene.asked:
        yield note("tolerance_raised", requested_mm=scene.asked, met_mm=tolerance)
    loose = sorted(ready.conditions.surroundings.loose.items(), key=lambda each: (-each[1], each[0]))
    if loose:
        yield note("faces_loose", *_ids([number for number, _ in loose]), worst_mm=loose[0][1], tolerance_mm=tolerance)


def _of_surfaces(scene: Scene) -> Iterator[Note]:
    """Name surfaces of revolution that cross their axis: they are, or would come back from STEP as, others than were made."""
    part, ignored = scene.part, set(scene.ignored)
    faces = [f for f in part.faces if f.number not in ignored]
    if crossing := [f.number for f in faces if f.unjudged == CROSSES]:
        measured = [part.measure(n) for n in crossing]
        area = sum(each.area for each in measured if each is not None)
        yield notes.crosses_itself(_ids(crossing), CROSSES, area, f"`--ignore {ranges(crossing)}`")
    turned = [f.number for f in faces if f.surface == "revolution" and f.unjudged is None]
    for n, other in sorted(folded_faces(part, turned).items()):
        yield note("folds_back", f"F{n}", neighbour=f"F{other}", size_mm2=part.faces[n - 1].area, option=f"`--ignore F{n}`")
    for n, there in changed_by_step(part).items():
        if n not in ignored:
            yield notes.changed_by_step(f"F{n}", part.faces[n - 1].area, there)


def _of_obstacles(part: Part, surroundings: Surroundings) -> Iterator[Note]:
    """Name the obstacles that enclose no material: only their surface is in the way."""
    closed = {number for body in surroundings.bodies if body.closed for number in body.faces}
    bare = set(np.unique((surroundings.alone or surroundings).possible.triangles.face).tolist()) - closed
    if sheets := [f.id for f in part.faces if f.number in bare]:
        yield note("open_faces", *sheets) if closed else notes.all_faces_open()


def _of_bodies(ready: Prepared) -> Iterator[Note]:
    """Name bodies with faces to machine that surely do not touch, for their boxes do not: nobody clamps these together."""
    surroundings, targets = ready.conditions.surroundings, set(ready.chosen.targets)
    bodies = [each for each in material_bodies(surroundings.bodies, ready.scene.orientation.sign) if each & targets]
    if len(bodies) < 2:
        return
    triangles = (surroundings.alone or surroundings).certain.triangles
    rows = rows_by_face(triangles.face)
    mine = [[triangles.vertex[rows[n]].reshape(-1, 3) for n in each if n in rows] for each in bodies]
    if not all(mine):
        return
    low = np.array([np.min([each.min(axis=0) for each in faces], axis=0) for faces in mine]) - TOGETHER
    high = np.array([np.max([each.max(axis=0) for each in faces], axis=0) for faces in mine]) + TOGETHER
    touching = [np.column_stack(np.broadcast_arrays(k, np.flatnonzero(((low <= high[k]) & (low[k] <= high)).all(axis=1))))
                for k in range(len(bodies))]  # fmt: skip
    group = connected(len(bodies), np.concatenate(touching))
    if group.max() > 0:
        faces_of = [frozenset[int]().union(*(bodies[i] for i in np.flatnonzero(group == k))) for k in range(group.max() + 1)]
        yield notes.bodies_apart([ranges(sorted(each)) for each in faces_of])


def _of_fixtures(ready: Prepared) -> Iterator[Note]:
    """Fixtures as they were understood: those of the first setup, then those that stand in others alone."""
    options, fixtures = ready.options, ready.conditions.surroundings.fixtures
    yield from (notes.fixture(each.name, how) for each in fixtures for how in each.notes)
    for each in fixtures if options.other_setups else ():
        if each.fixture.follows_setup and each.fixture in options.shared_fixtures:
            yield note("fixture_stays", each.name)
    meshes = [each.name for each in fixtures if not isinstance(each.source, Part) and each.fixture.clamping is None]
    if meshes:
        yield note("fixture_not_cad", *meshes)
    first = [(each.name, each.notes) for each in fixtures]
    for conditions in ready.setups[1:]:
        others = [each for each in conditions.surroundings.fixtures if (each.name, each.notes) not in first]
        for name, how in ((each.name, how) for each in others for how in each.notes):
            yield notes.fixture(name, how, axis_words(conditions.setup.tolist()))


def _of_choice(ready: Prepared) -> Iterator[Note]:
    """Say what the choice of faces leaves out, and that no target is sculptured."""
    chosen = ready.chosen
    if chosen.unshaped:
        yield note("faces_none_sculptured", targets=len(chosen.targets))
    if named := set(chosen.ignored) - chosen.repeated.keys():
        yield note("faces_ignored", *_ids(sorted(named)))
    bodies, faces = repeated_groups(ready.scene.part, chosen.repeated)
    for body, mine, stays, own in bodies:
        yield notes.repeated_body(body, ranges(mine), stays, ranges(own))
    if faces:
        yield notes.repeated_faces(ranges(faces), ranges({chosen.repeated[n] for n in faces}), len(faces))
    if chosen.clamped:
        yield note("faces_clamped", *_ids(chosen.clamped))


def _of_setups(ready: Prepared) -> Iterator[Note]:
    """Say which faces are held in some setups alone, where nothing holds the part, and what is found in the first alone."""
    options = ready.options
    if ready.others and not options.held_alike:
        axes = (ready.scene.setup, *options.other_setups)
        for axis, place, conditions in zip(axes, places(options), ready.setups, strict=True):
            held = sorted(clamped_faces(ready.scene.part, place, ready.scene.repeated) & set(ready.chosen.targets))
            if held:
                yield note("faces_clamped_there", *_ids(held), setup=axis_words(axis))
            if not conditions.surroundings.fixtures:
                yield note("setup_without_fixtures", setup=axis_words(axis))
    if ready.others and "stick-out" in options.answers:
        yield note("stick_out_each_setup")
    if options.posture_maps and not ready.alike:
        yield note("maps_first_setup")


def _of_limits(ready: Prepared) -> Iterator[Note]:
    """Where samples are farther apart than they should be; what linear travel is judged of, or why it is not."""
    spacing, options = ready.spacing, ready.options
    if ready.coarser > 1.0:
        yield note("samples_coarser", times=ready.coarser, budget=BUDGET)
    if spacing is not None:
        step = spacing if isinstance(spacing, dict) else dict.fromkeys(ready.chosen.targets, spacing)
        wide = [number for number, gap in ready.samples.face_gaps if gap > step[number] * (1 + 1e-6)]
        if wide:
            yield note("samples_wide", *_ids(wide))
    why = unjudged(options.machine, options.placement)
    if why:
        yield note("travel_not_judged", why=why)
    elif why is None:
        yield note("travel_of_holder")
        if options.other_setups:
            yield note("travel_first_setup")


def _of_area(entries: Sequence[CutterEntry], *, doubtful: bool) -> Iterator[Note]:
    """How far the area between the samples is served; `doubtful`: obstacles are missing."""
    for entry in entries:
        area = entry.area
        if area is None:
            continue
        if area.share == 1:
            yield notes.area_proved(entry.id, whole=not area.left_out, doubtful=doubtful)
        else:
            unserved = area.left - area.short - area.dropped
            yield notes.area_left(entry.id, unserved=unserved, dropped=area.dropped, short=area.short)
        if area.left_out:
            yield note("area_unknown", *area.left_out)
