"""All notes of a plan: each has a code, by which programs decide, and a text for people, which stands here alone.

To add a note, add its code, its function here, and the call where it is found.
"""

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from plan_cutters.domain.figures import angle, area, count, joined, listed, mm, plainly
from plan_cutters.domain.placement import axis_words

#: What a note is about. A text may be reworded; a code stays.
NoteCode = Literal[
    "cutters_built_in", "no_holder", "tilts_not_searched", "all_length_cuts", "samples_apart", "samples_coarser", "samples_wide",
    "coarser_than_requested",
    "not_sampled", "no_machine", "side_guessed", "side_by_setup", "names_decoded",
    "angles_rounded", "tolerance_raised", "open_faces", "fixture", "fixture_stays",
    "fixture_not_cad", "faces_none_sculptured", "faces_ignored", "faces_clamped", "travel_not_judged", "travel_of_holder",
    "travel_first_setup", "faces_clamped_there", "setup_without_fixtures", "setup_proposed",
    "stick_out_each_setup", "maps_first_setup",
    "faces_loose", "area_not_looked_at", "area_proved", "area_left", "area_unknown", "maps_partial", "run_unfinished",
    "repeated_body", "crosses_itself", "folds_back", "changed_by_step",
]  # fmt: skip


class Note(NamedTuple):
    """A note tells a reader of the plan something that the verdicts do not say."""

    code: NoteCode
    text: str


# Of the run.


def later_stages(
    *, area: bool, answers: Sequence[str], operations: str | None, maps: bool, process: bool = False,
    reasons: Sequence[str] = (), witnesses: bool = False, setups: Sequence[Sequence[float]] = (),
) -> tuple[str, ...]:  # fmt: skip
    """Name what follows the verdicts, in its order, by its options; empty for what was not requested.

    `reasons`: the cutters whose reasons are not found; `witnesses`: theirs, and those of all others, are not either; `setups`:
    axes of those that are not judged.

    >>> later_stages(area=True, answers=(), operations="fewest", maps=False)
    ('', '', '', 'the proof between the samples', '', '--operations fewest', '')
    """
    return (
        f"what follows in setup {joined([axis_words(each) for each in setups])}" if setups else "",
        f"the reasons of {listed(reasons)}" if reasons else "",
        "witnesses" if witnesses else "",
        "the proof between the samples" if area else "",
        f"--answers {','.join(answers)}" if answers else "",
        "your steps (--process)" if process else f"--operations {operations}" if operations is not None else "",
        "--posture-maps" if maps else "",
    )


def run_unfinished(absent: Sequence[str], work: str = "", *, unexplained: bool = False) -> Note:
    """Say what a plan is without; `work`: what the run was doing when it was interrupted; `unexplained`: reasons are missing.

    >>> run_unfinished(["--answers mend", "--operations fewest"], "planning the operations").text
    'The run was interrupted while planning the operations: this plan is without --answers mend and --operations fewest.'
    """
    how = f"was interrupted while {work}" if work else "was not done"
    instead = " What it names in their place forbids most tilts, and need not be what helps." if unexplained else ""
    return Note("run_unfinished", f"The run {how}: this plan is without {joined(absent)}.{instead}")


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


# Of the planner's own steps.


def angles_rounded(steps: Mapping[int, Mapping[str, float]]) -> Note:
    """`steps`: angles as they are judged, deg, by the number of the step in the file."""
    each = [f"step {k} at {' '.join(f'{name} {plainly(a, 9)}' for name, a in angles.items())}" for k, angles in steps.items()]
    return Note("angles_rounded", f"Angles in the process file have more digits than a control shows: judged is {listed(each)}.")


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
    return Note("maps_first_setup", "The posture maps are about the first setup alone: others hold the part differently.")


def stick_out_each_setup() -> Note:
    return Note(
        "stick_out_each_setup",
        "With the least stick-outs each setup reaches all that it serves now; if another setup served some of it, less might do.",
    )


# Of the part, its sides and its triangles.


def no_machine() -> Note:
    return Note("no_machine", "No machine was given: any tool axis counts as possible.")


def names_decoded(encoding: str) -> Note:
    return Note(
        "names_decoded",
        f"Names in the file are neither ASCII nor UTF-8, and the file does not say what they are: read as {encoding}.",
    )


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


def crosses_itself(faces: Sequence[str], why: str, areas_mm2: float, option: str) -> Note:
    """Faces that run through themselves, why, and the area that they have so."""
    which, them = (f"{faces[0]} {why}", "it") if len(faces) == 1 else (f"Each of {listed(faces)} {why}", "them")
    return Note(
        "crosses_itself",
        f"{which}, with {area(areas_mm2)}: STEP makes such faces larger than they were, and no verdict is about {them}. Give the "
        f"shape in Python or as BREP, or leave {them} out: {option}.",
    )


def folds_back(face: str, area_mm2: float, neighbour: str, option: str) -> Note:
    return Note(
        "folds_back",
        f"{face} folds back onto {neighbour}, with {area(area_mm2)}: a surface of revolution that crosses its axis comes back "
        f"from STEP as the rest of what was made. Give the shape in Python or as BREP, or leave it out: {option}.",
    )


def changed_by_step(face: str, here_mm2: float, there_mm2: float) -> Note:
    """A face of a shape comes back from STEP with another area."""
    back = f"comes back with {area(there_mm2)} for {area(here_mm2)}" if there_mm2 > 0.0 else f"({area(here_mm2)}) is missing"
    return Note(
        "changed_by_step",
        f"Written as STEP and read again, {face} {back}: its surface of revolution crosses its axis. This plan is of the shape "
        "as it was given; its STEP models, and any other STEP of it, show another part.",
    )


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


def repeated_body(number: int, faces: str, stays: int, stays_faces: str) -> Note:
    """A body of the part that lies where another one lies; number 0: a shell."""
    name, other = (f"body {n}" if n else "a shell" for n in (number, stays))
    return Note(
        "repeated_body",
        f"{name.capitalize()} ({faces}) is {other} ({stays_faces}) again, in the same place, and is left out; to leave out "
        f"the other one: --ignore {stays_faces}.",
    )


def repeated_faces(faces: str, stay: str, count_: int) -> Note:
    return Note(
        "repeated_body",
        f"{faces} {'is' if count_ == 1 else 'are'} {stay} again, in the same place, and left out; to leave out the "
        f"{'other one' if count_ == 1 else 'others'}: --ignore {stay}.",
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
