"""The notes of a plan: what its verdicts do not say."""

from collections.abc import Iterator, Sequence

import numpy as np

from cad_io import Part
from plan_cutters.document.listed import listed
from plan_cutters.document.model import CutterEntry
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.notes import Note
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.travel import unjudged
from plan_cutters.options import Options
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.setups import notes_of_setups
from plan_cutters.scene.spacing import BUDGET
from plan_cutters.scene.surroundings import PlacedFixture, Surroundings


def notes_of(ready: Prepared, entries: Sequence[CutterEntry]) -> list[Note]:
    """All notes, in the order in which people read them."""
    scene, options, around = ready.scene, ready.options, ready.conditions.around
    return [
        *_of_cutters(options, ready.cutters),
        *_of_samples(ready),
        *_of_sides(scene, options, ready.conditions.tolerance),
        *_of_loose_faces(ready),
        *_of_obstacles(scene.part, around),
        *_of_fixtures(around.fixtures, options.shared_fixtures, several=bool(options.other_setups)),
        *_of_other_fixtures(ready),
        *ready.chosen.notes,
        *notes_of_setups(ready),
        *_of_spacing(ready),
        *_of_travel(options),
        *_of_area(entries, doubtful=around.doubtful),
    ]


def _of_samples(ready: Prepared) -> Iterator[Note]:
    samples = ready.samples
    yield Note("samples_apart", "Verdicts are about samples; grid neighbours, and points of a face from its nearest sample, "
               f"are at most {samples.max_gap:.3g} mm apart.")  # fmt: skip
    if samples.empty:
        names = ", ".join(f"F{number}" for number, _ in samples.empty)
        yield Note("not_sampled", f"No verdict is about {names}: no sample could be taken there.")


def _of_sides(scene: Scene, options: Options, kept: float) -> Iterator[Note]:
    if not options.machine.limited:
        yield Note("no_machine", "No machine was given: any tool axis counts as possible.")
    if not scene.orientation.confident:
        yield Note("side_guessed", "Which side is material is a guess; --flip machines the other side.")
        if other := scene.turned_faces():
            yield Note("side_by_setup", f"The setup axis decides the side of open faces: with 0,0,1 as setup {listed(other)} "
                       "would be machined on the other side.")  # fmt: skip
    if kept > 1.001 * scene.asked:
        yield Note("tolerance_raised", f"The tolerance was raised from {scene.asked:g} to {kept:.3g} mm: the obstacle "
                   "triangles could not be made to follow the surface more closely.")  # fmt: skip


def _of_loose_faces(ready: Prepared) -> Iterator[Note]:
    """Which faces triangles do not follow closely, and what that means."""
    loose = sorted(ready.conditions.around.loose.items(), key=lambda each: (-each[1], each[0]))
    if loose:
        names, worst = listed([f"F{number}" for number, _ in loose]), loose[0][1]
        yield Note("faces_loose", f"The obstacle triangles follow {names} only within {worst:.3g} mm. The surface may be "
                   "anywhere within that: what only it may forbid is undecided. All else is judged to "
                   f"{ready.conditions.tolerance:.3g} mm.")  # fmt: skip


def _of_spacing(ready: Prepared) -> Iterator[Note]:
    """Where samples are farther apart than was asked, or than they should be."""
    spacing = ready.spacing
    if ready.coarser > 1.0:
        yield Note("samples_coarser", f"Samples are {ready.coarser:.3g} times as far apart as curvature and the smallest cutter "
                   f"ask, for a default plan takes about {BUDGET:,}: --spacing asks for more, --faces for less.")  # fmt: skip
    if spacing is None:
        return
    step = spacing if isinstance(spacing, dict) else dict.fromkeys(ready.chosen.targets, spacing)
    wide = [f"F{number}" for number, gap in ready.samples.face_gaps if gap > step[number] * (1 + 1e-6)]
    if wide:
        yield Note("samples_wide", f"Samples are farther apart than asked on {listed(wide)}, whose borders no grid follows: "
                   "`gap_mm` of each face in plan.json says how far.")  # fmt: skip


def _of_cutters(options: Options, cutters: Sequence[Cutter]) -> Iterator[Note]:
    """How the cutters are judged."""
    if not options.cutters and not options.libraries:
        yield Note("cutters_built_in", "The cutters are the built-in drawer, of usual metric sizes in plain holders: give "
                   "your own with --cutter or --cutters.")  # fmt: skip
    bare = [c.id for c in cutters if c.holder is None]
    if bare:
        yield Note("no_holder", f"{listed(bare)} {'is' if len(bare) == 1 else 'are'} judged up to the stated length, without a "
                   "holder.")  # fmt: skip
    beyond = [
        c.id for c in cutters if max(mode.high for mode in modes(c)) > options.postures.tilt[1] + 1e-6 > 0.5 * np.pi
    ]
    if beyond:
        yield Note("tilts_not_searched", f"{listed(beyond)} can touch at larger tilts than the "
                   f"{np.degrees(options.postures.tilt[1]):g} deg searched: --tilt asks for more.")  # fmt: skip
    held = [c.id for c in cutters if c.holder is None and not c.stages]
    if held and len(held) == len(cutters):
        yield Note("all_length_cuts", "All of a cutter's length cuts, unless it says where its flutes end.")


def _of_obstacles(part: Part, around: Surroundings) -> Iterator[Note]:
    """Name the obstacles that enclose no material: only their surface is in the way."""
    skins = {number for body in around.bodies if body.closed for number in body.faces}
    bare = set(np.unique((around.alone or around).possible.triangles.face).tolist()) - skins
    sheets = [f.id for f in part.faces if f.number in bare]
    if sheets and skins:
        yield Note("open_faces", f"{listed(sheets)} enclose{'s' if len(sheets) == 1 else ''} no material: only the surface is "
                   "in the way, not what may lie behind it.")  # fmt: skip
    elif sheets:
        yield Note(
            "open_faces", "No face encloses material: only the surfaces are in the way, not what may lie behind them."
        )


def _of_area(entries: Sequence[CutterEntry], *, doubtful: bool) -> Iterator[Note]:
    """How far the area between the samples is served, in words; `doubtful`: obstacles are missing."""
    known = "as far as curvature between grid nodes" + (" and the obstacles are" if doubtful else " is") + " known"
    for entry in entries:
        area = entry.area
        if area is None:
            continue
        if area.share == 1:
            what = "all of the target surface whose area is known" if area.left_out else "all of the target surface"
            yield Note("area_proved", f"{entry.id} serves {what}, {known}.")
        else:
            not_reached = area.left - area.short - area.dropped
            why = (
                [f"no posture was found that serves the cells about {not_reached} contacts, or finer ones"]
                if not_reached > 0
                else []
            )
            if area.dropped:
                why.append(f"{area.dropped} cells were not cut up, for too little of the surface was to be gained")
            if area.short:
                why.append(
                    f"the budget was spent with {area.short} cells open, so a larger --area-budget may serve more"
                )
            causes = "; ".join(why) or "some of it has no samples or no closed border"
            yield Note("area_left", f"{entry.id} reaches every judged sample, but not all of the target surface was shown to "
                       f"be served: {causes}. Finer samples may help, too.")  # fmt: skip
        if area.left_out:
            yield Note("area_unknown", f"The area of {', '.join(area.left_out)} is not known: it is not in the share that is "
                       "served.")  # fmt: skip


def _of_travel(options: Options) -> Iterator[Note]:
    """Why linear travel is not judged, or what it is judged of."""
    why = unjudged(options.machine, options.placement)
    if why:
        yield Note("travel_not_judged", f"Linear travel is not judged: {why}.")
    if why is not None:
        return
    said = "Linear travel is that of the holder's nose at the postures found; it changes no verdict."
    yield Note("travel_of_holder", said)
    if options.other_setups:
        yield Note("travel_first_setup", "Linear travel is judged in the first setup alone.")


def _of_other_fixtures(ready: Prepared) -> Iterator[Note]:
    """Give the notes on fixtures that stand in other setups than the first alone."""
    first = [(each.name, each.notes) for each in ready.conditions.around.fixtures]
    for conditions in ready.setups[1:]:
        for each in conditions.around.fixtures:
            for note in each.notes if (each.name, each.notes) not in first else ():
                there = axis_words(conditions.setup.tolist())
                yield Note("fixture", f"{each.name} in the setup {there}: {note}.")


def _of_fixtures(fixtures: Sequence[PlacedFixture], shared: Sequence[Fixture], *, several: bool) -> Iterator[Note]:
    """Give the notes on fixtures that the plan must have; `shared` stand in all setups, of which there are `several`."""
    for each in fixtures:
        for note in each.notes:
            yield Note("fixture", f"{each.name}: {note}.")
    if several:
        for each in fixtures:
            if each.fixture.follows_setup and each.fixture in shared:
                yield Note("fixture_stays", f"{each.name}: it lies across the axis of the first setup, and stays there in the "
                           "others.")  # fmt: skip
    drawn = [each.name for each in fixtures if not isinstance(each.source, Part)]
    if drawn:
        yield Note("fixture_not_cad", "Only the GLB model, the review page and pictures show what is no CAD body: "
                   f"{', '.join(drawn)}.")  # fmt: skip
