"""All notes of a plan: each has a code, by which programs decide, and a text for people, which stands here alone.

To add a note, add its code, its function here, and the call where it is found.
"""

from collections.abc import Sequence
from typing import Literal, NamedTuple

from plan_cutters.plan_file.numbers import angle, count, listed, mm

#: What a note is about. A text may be reworded; a code stays.
NoteCode = Literal[
    "cutters_built_in", "no_holder", "tilts_not_searched", "all_length_cuts", "samples_apart", "samples_coarser", "samples_wide",
    "coarser_than_requested",
    "not_sampled", "no_machine", "side_guessed", "side_by_setup", "tolerance_raised", "open_faces", "fixture", "fixture_stays",
    "fixture_not_cad", "faces_none_sculptured", "faces_ignored", "faces_clamped", "travel_not_judged", "travel_of_holder",
    "travel_first_setup", "faces_clamped_there", "setup_without_fixtures", "setup_proposed",
    "stick_out_each_setup", "maps_first_setup",
    "faces_loose", "area_not_looked_at", "area_proved", "area_left", "area_unknown", "maps_partial", "run_unfinished",
]  # fmt: skip


class Note(NamedTuple):
    """A note tells a reader of the plan something that the verdicts do not say."""

    code: NoteCode
    text: str


# Of the run.


def later_stages(
    *, area: bool, answers: Sequence[str], operations: str | None, maps: bool, process: bool = False
) -> tuple[str, str, str, str]:
    """Name the stages that follow the verdicts, in their order, by their options; empty for one that was not requested.

    >>> later_stages(area=True, answers=(), operations="fewest", maps=False)
    ('the proof between the samples', '', '--operations fewest', '')
    """
    return (
        "the proof between the samples" if area else "",
        f"--answers {','.join(answers)}" if answers else "",
        "your steps (--process)" if process else f"--operations {operations}" if operations is not None else "",
        "--posture-maps" if maps else "",
    )


def run_unfinished(absent: Sequence[str]) -> Note:
    without = " and ".join(filter(None, (", ".join(absent[:-1]), absent[-1])))
    return Note("run_unfinished", f"The run was not done: this plan is without {without}.")


# Of cutters.


def cutters_built_in() -> Note:
    return Note(
        "cutters_built_in",
        "The cutters are the built-in set, of usual metric sizes in plain holders: give your own with --cutter or --cutters.",
    )


def no_holder(cutters: Sequence[str]) -> Note:
    return Note("no_holder", f"{listed(cutters)} {_are(cutters)} judged up to the stated length, without a holder.")


def tilts_not_searched(cutters: Sequence[str], most_deg: float) -> Note:
    return Note(
        "tilts_not_searched",
        f"{listed(cutters)} can touch at larger tilts than the {angle(most_deg)} searched: --tilt asks for more.",
    )


def all_length_cuts() -> Note:
    return Note("all_length_cuts", "All of a cutter's length cuts, unless it says where its flutes end.")


# Of samples.


def samples_apart(most_mm: float) -> Note:
    return Note(
        "samples_apart",
        "Verdicts are about samples; grid neighbours, and points of a face from its nearest sample, are at most "
        f"{mm(most_mm)} apart.",
    )


def samples_coarser(times: float, budget: int) -> Note:
    return Note(
        "samples_coarser",
        f"Samples are {times:.3g} times as far apart as curvature and the smallest cutter ask, for a default plan "
        f"takes about {budget:,}: --spacing asks for more, --faces for less.",
    )


def coarser_than_requested(wanted: str, samples: int, most_mm: float) -> Note:
    """Of a part of a batch whose density is for all parts: what was requested as an option, and what was taken."""
    return Note(
        "coarser_than_requested",
        f"Coarser than requested: {wanted} would take too many samples here; judged at {count(samples, 'sample')}, "
        f"up to {mm(most_mm)} apart.",
    )


def samples_wide(faces: Sequence[str]) -> Note:
    return Note(
        "samples_wide",
        f"Samples are farther apart than asked on {listed(faces)}, whose borders no grid follows: `gap_mm` of each "
        "face in plan.json says how far.",
    )


def not_sampled(faces: Sequence[str]) -> Note:
    return Note("not_sampled", f"No verdict is about {', '.join(faces)}: no sample could be taken there.")


def maps_partial(unmapped: int, judged: int) -> Note:
    return Note(
        "maps_partial",
        f"Postures of {unmapped} of {judged} samples were not mapped, for it would take too long: there every tilt is "
        "undecided in postures.npz; sample more coarsely (--spacing), or give --map-budget.",
    )


def maps_first_setup() -> Note:
    return Note(
        "maps_first_setup",
        "The posture maps and the estimate of motion are about the first setup alone: others hold the part differently.",
    )


def stick_out_each_setup() -> Note:
    return Note(
        "stick_out_each_setup",
        "With the least stick-outs each setup reaches all that it serves now; if another setup served some of it, less might do.",
    )


# Of the part, its sides and its triangles.


def no_machine() -> Note:
    return Note("no_machine", "No machine was given: any tool axis counts as possible.")


def side_guessed(*, loose: bool) -> Note:
    """`loose`: there are faces in no solid, which alone can be turned."""
    return Note("side_guessed", f"Which side is material is a guess{'; --flip machines the other side' if loose else ''}.")


def side_by_setup(faces: Sequence[str]) -> Note:
    return Note(
        "side_by_setup",
        f"The setup axis decides the side of open faces: with 0,0,1 as setup {listed(faces)} would be machined on the "
        "other side.",
    )


def tolerance_raised(requested_mm: float, kept_mm: float) -> Note:
    return Note(
        "tolerance_raised",
        f"The tolerance was raised from {mm(requested_mm)} to {mm(kept_mm)}: the obstacle triangles could not be made to "
        "follow the surface more closely.",
    )


def faces_loose(faces: Sequence[str], worst_mm: float, tolerance_mm: float) -> Note:
    return Note(
        "faces_loose",
        f"The obstacle triangles follow {listed(faces)} only within {mm(worst_mm)}. The surface may be anywhere "
        f"within that: what only it may forbid is undecided. All else is judged to {mm(tolerance_mm)}.",
    )


def open_faces(faces: Sequence[str]) -> Note:
    """Faces that enclose nothing among others that do."""
    return Note(
        "open_faces",
        f"{listed(faces)} enclose{'s' if len(faces) == 1 else ''} no material: only the surface is in the way, not "
        "what may lie behind it.",
    )


def all_faces_open() -> Note:
    return Note("open_faces", "No face encloses material: only the surfaces are in the way, not what may lie behind them.")


# Of targets.


def faces_none_sculptured(targets: int) -> Note:
    return Note(
        "faces_none_sculptured",
        f"No face that can be judged is sculptured: all are targets ({targets}); --faces chooses among them.",
    )


def faces_ignored(faces: Sequence[str]) -> Note:
    return Note(
        "faces_ignored",
        f"{_number(faces)} {_are(faces)} ignored, neither targets nor obstacles (nothing is checked against them): "
        f"{listed(faces)}.",
    )


def faces_clamped(faces: Sequence[str]) -> Note:
    return Note("faces_clamped", f"{_number(faces)} {_are(faces)} clamped and left for another setup: {listed(faces)}.")


def faces_clamped_there(faces: Sequence[str], setup: str) -> Note:
    return Note("faces_clamped_there", f"{', '.join(faces)}: clamped in the setup {setup}, and to be machined in another one.")


# Of setups and fixtures.


def setup_proposed(setups: Sequence[str], why: str) -> Note:
    return Note("setup_proposed", f"Proposed {'setup' if len(setups) == 1 else 'setups'}: {' and '.join(setups)}. {why}")


def setup_without_fixtures(setup: str) -> Note:
    return Note(
        "setup_without_fixtures", f"No fixture stands in the setup {setup}: nothing that holds the part there was in the way."
    )


def fixture(name: str, how: str, setup: str = "") -> Note:
    """How a fixture was understood; in another setup than the first, with that one."""
    return Note("fixture", f"{name}{f' in the setup {setup}' if setup else ''}: {how}.")


def fixture_stays(name: str) -> Note:
    return Note("fixture_stays", f"{name}: it lies across the axis of the first setup, and stays there in the others.")


def fixture_not_cad(names: Sequence[str]) -> Note:
    return Note(
        "fixture_not_cad", f"Only the GLB model, the review page and pictures show what is no CAD body: {', '.join(names)}."
    )


# Of linear travel.


def travel_not_judged(why: str) -> Note:
    return Note("travel_not_judged", f"Linear travel is not judged: {why}.")


def travel_of_holder() -> Note:
    return Note(
        "travel_of_holder", "Linear travel is that of the holder's gauge face at the postures found; it changes no verdict."
    )


def travel_first_setup() -> Note:
    return Note("travel_first_setup", "Linear travel is judged in the first setup alone.")


# Of the area between the samples.


def area_proved(cutter: str, *, whole: bool, doubtful: bool) -> Note:
    """`whole`: the area of no face is unknown; `doubtful`: obstacles are missing."""
    what = "all of the target surface" if whole else "all of the target surface whose area is known"
    known = "as far as curvature between grid nodes" + (" and the obstacles are" if doubtful else " is") + " known"
    return Note("area_proved", f"{cutter} serves {what}, {known}.")


def area_left(cutter: str, *, unserved: int, dropped: int, short: int) -> Note:
    """Cells for which no posture was found, that were not cut up, and for which the budget was spent."""
    why = [f"no posture was found that serves the cells about {unserved} contacts, or finer ones"] if unserved > 0 else []
    if dropped:
        why.append(f"{dropped} cells were not cut up, for too little of the surface was to be gained")
    if short:
        why.append(f"the budget was spent with {short} cells open, so a larger --area-budget may serve more")
    causes = "; ".join(why) or "some of it has no samples or no closed border"
    return Note(
        "area_left",
        f"{cutter} reaches every judged sample, but not all of the target surface was shown to be served: {causes}. "
        "Finer samples may help, too.",
    )


def area_unknown(faces: Sequence[str]) -> Note:
    return Note("area_unknown", f"The area of {', '.join(faces)} is not known: it is not in the share that is served.")


def _are(names: Sequence[str]) -> str:
    return "is" if len(names) == 1 else "are"


def _number(faces: Sequence[str]) -> str:
    return f"{len(faces)} face{'' if len(faces) == 1 else 's'}"
