"""The notes of a plan: where each is found; their words stand in `plan_file.notes`."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from cad_io import Part
from cad_io.part.inside_edges import folded_faces
from cad_io.part.unjudged import CROSSES
from cad_io.write.back import changed_by_step
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import ranges
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.travel import unjudged
from plan_cutters.options import Options
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.words import notes
from plan_cutters.plan_file.words.notes import Note
from plan_cutters.scene.faces import clamped_faces, repeated_groups
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.setups import places
from plan_cutters.scene.spacing import BUDGET
from plan_cutters.scene.surroundings import PlacedFixture, Surroundings


def notes_of(ready: Prepared, entries: Sequence[CutterEntry]) -> list[Note]:
    """All notes, in the order in which people read them."""
    scene, options, surroundings = ready.scene, ready.options, ready.conditions.surroundings
    return [
        *_of_cutters(options, ready.cutters),
        *_of_process(options),
        *_of_samples(ready),
        *_of_sides(scene, options, ready.conditions.tolerance),
        *_of_loose_faces(ready),
        *_of_surfaces(scene),
        *_of_obstacles(scene.part, surroundings),
        *_of_fixtures(surroundings.fixtures, options.shared_fixtures, several=bool(options.other_setups)),
        *_of_other_fixtures(ready),
        *_of_choice(ready),
        *_of_setups(ready),
        *_of_several_setups(ready),
        *_of_spacing(ready),
        *_of_travel(options),
        *_of_area(entries, doubtful=surroundings.doubtful),
    ]


def noted(plan: Plan, note: Note, **more: Any) -> Plan:
    """The plan with one note more, and with more of its fields."""
    return plan.model_copy(update={**more, "notes": [*plan.notes, note.text], "note_codes": [*plan.note_codes, note.code]})


def noted_coarser(options: Options, plan: Plan) -> Plan:
    """The plan with a note that the density of samples in some options was not taken, for it asks too much of this part."""
    wanted = f"--spacing {options.spacing:g}" if options.grid is None else f"--grid {options.grid}"
    return noted(plan, notes.coarser_than_requested(wanted, plan.samples.count, plan.samples.max_gap_mm))


def _of_choice(ready: Prepared) -> Iterator[Note]:
    """Say what the choice of faces leaves out, and that no target is sculptured."""
    chosen = ready.chosen
    if chosen.unshaped:
        yield notes.faces_none_sculptured(len(chosen.targets))
    if named := set(chosen.ignored) - chosen.repeated.keys():
        yield notes.faces_ignored([f"F{n}" for n in sorted(named)])
    bodies, faces = repeated_groups(ready.scene.part, chosen.repeated)
    for body, mine, stays, own in bodies:
        yield notes.repeated_body(body, ranges(mine), stays, ranges(own))
    if faces:
        yield notes.repeated_faces(ranges(faces), ranges({chosen.repeated[n] for n in faces}), len(faces))
    if chosen.clamped:
        yield notes.faces_clamped([f"F{n}" for n in chosen.clamped])


def _of_setups(ready: Prepared) -> Iterator[Note]:
    """Say which faces are held in some setups alone, and which setups hold the part with nothing."""
    if not ready.others or ready.options.held_alike:
        return
    axes = (ready.scene.setup, *ready.options.other_setups)
    for axis, place, conditions in zip(axes, places(ready.options), ready.setups, strict=True):
        held = sorted(clamped_faces(ready.scene.part, place, ready.scene.repeated) & set(ready.chosen.targets))
        if held:
            yield notes.faces_clamped_there([f"F{number}" for number in held], axis_words(axis))
        if not conditions.surroundings.fixtures:
            yield notes.setup_without_fixtures(axis_words(axis))


def _of_process(options: Options) -> Iterator[Note]:
    if options.process is not None and (rounded := options.process.rounded()):
        yield notes.angles_rounded(rounded)


def _of_samples(ready: Prepared) -> Iterator[Note]:
    samples = ready.samples
    yield notes.samples_apart(samples.max_gap)
    if samples.empty:
        yield notes.not_sampled([f"F{number}" for number, _ in samples.empty])


def _of_sides(scene: Scene, options: Options, tolerance: float) -> Iterator[Note]:
    if not options.machine.limited:
        yield notes.no_machine()
    if scene.part.encoding:
        yield notes.names_decoded(scene.part.encoding)
    if not scene.orientation.confident:
        yield notes.side_guessed(loose=bool(scene.part.sewn.faces))
        if other := scene.turned_faces():
            yield notes.side_by_setup(other)
    if tolerance > 1.001 * scene.asked:
        yield notes.tolerance_raised(scene.asked, tolerance)


def _of_loose_faces(ready: Prepared) -> Iterator[Note]:
    """Which faces triangles do not follow closely, and what that means."""
    loose = sorted(ready.conditions.surroundings.loose.items(), key=lambda each: (-each[1], each[0]))
    if loose:
        yield notes.faces_loose([f"F{number}" for number, _ in loose], loose[0][1], ready.conditions.tolerance)


def _of_spacing(ready: Prepared) -> Iterator[Note]:
    """Where samples are farther apart than was asked, or than they should be."""
    spacing = ready.spacing
    if ready.coarser > 1.0:
        yield notes.samples_coarser(ready.coarser, BUDGET)
    if spacing is None:
        return
    step = spacing if isinstance(spacing, dict) else dict.fromkeys(ready.chosen.targets, spacing)
    wide = [f"F{number}" for number, gap in ready.samples.face_gaps if gap > step[number] * (1 + 1e-6)]
    if wide:
        yield notes.samples_wide(wide)


def _of_cutters(options: Options, cutters: Sequence[Cutter]) -> Iterator[Note]:
    """How the cutters are judged."""
    if not options.cutters and not options.libraries:
        yield notes.cutters_built_in()
    if bare := [c.id for c in cutters if c.holder is None]:
        yield notes.no_holder(bare)
    most = options.postures.tilt[1]
    if beyond := [c.id for c in cutters if max(mode.high for mode in modes(c)) > most + 1e-6 > 0.5 * np.pi]:
        yield notes.tilts_not_searched(beyond, float(np.degrees(most)))
    if cutters and all(c.holder is None and not c.stages for c in cutters):
        yield notes.all_length_cuts()


def _of_surfaces(scene: Scene) -> Iterator[Note]:
    """Name surfaces of revolution that cross their axis: they are, or would come back from STEP as, others than were made."""
    part, ignored = scene.part, set(scene.ignored)
    faces = [f for f in part.faces if f.number not in ignored]
    if crossing := [f.number for f in faces if f.unjudged == CROSSES]:
        measured = [part.measure(n) for n in crossing]
        area = sum(each.area for each in measured if each is not None)
        yield notes.crosses_itself([f"F{n}" for n in crossing], CROSSES, area, f"--ignore {ranges(crossing)}")
    turned = [f.number for f in faces if f.surface == "revolution" and f.unjudged is None]
    for n, neighbour in sorted(folded_faces(part, turned).items()):
        yield notes.folds_back(f"F{n}", part.faces[n - 1].area, f"F{neighbour}", f"--ignore F{n}")
    for n, there in changed_by_step(part).items():
        if n not in ignored:
            yield notes.changed_by_step(f"F{n}", part.faces[n - 1].area, there)


def _of_obstacles(part: Part, surroundings: Surroundings) -> Iterator[Note]:
    """Name the obstacles that enclose no material: only their surface is in the way."""
    closed = {number for body in surroundings.bodies if body.closed for number in body.faces}
    bare = set(np.unique((surroundings.alone or surroundings).possible.triangles.face).tolist()) - closed
    if sheets := [f.id for f in part.faces if f.number in bare]:
        yield notes.open_faces(sheets) if closed else notes.all_faces_open()


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
            yield notes.area_unknown(area.left_out)


def _of_several_setups(ready: Prepared) -> Iterator[Note]:
    """What is found in each setup by itself, or in the first one alone."""
    options = ready.options
    if ready.others and "stick-out" in options.answers:
        yield notes.stick_out_each_setup()
    if options.posture_maps and not ready.alike:
        yield notes.maps_first_setup()


def _of_travel(options: Options) -> Iterator[Note]:
    """Why linear travel is not judged, or what it is judged of."""
    why = unjudged(options.machine, options.placement)
    if why:
        yield notes.travel_not_judged(why)
    if why is not None:
        return
    yield notes.travel_of_holder()
    if options.other_setups:
        yield notes.travel_first_setup()


def _of_other_fixtures(ready: Prepared) -> Iterator[Note]:
    """Give the notes on fixtures that stand in other setups than the first alone."""
    first = [(each.name, each.notes) for each in ready.conditions.surroundings.fixtures]
    for conditions in ready.setups[1:]:
        for each in conditions.surroundings.fixtures:
            for how in each.notes if (each.name, each.notes) not in first else ():
                yield notes.fixture(each.name, how, axis_words(conditions.setup.tolist()))


def _of_fixtures(fixtures: Sequence[PlacedFixture], shared: Sequence[Fixture], *, several: bool) -> Iterator[Note]:
    """Give the notes on fixtures that the plan must have; `shared` stand in all setups, of which there are `several`."""
    for each in fixtures:
        for how in each.notes:
            yield notes.fixture(each.name, how)
    if several:
        for each in fixtures:
            if each.fixture.follows_setup and each.fixture in shared:
                yield notes.fixture_stays(each.name)
    meshes = [each.name for each in fixtures if not isinstance(each.source, Part) and each.fixture.clamping is None]
    if meshes:
        yield notes.fixture_not_cad(meshes)
