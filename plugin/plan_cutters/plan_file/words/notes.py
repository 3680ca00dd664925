"""Notes of a plan, each with a code by which programs decide and a text for people; its doubts and the limits of the tool.

To add a note, add its code and its text here, and the call where it is found.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple

from plan_cutters.domain.figures import (
    ROUNDING,
    angle,
    area,
    consecutive,
    count,
    joined,
    listed,
    mm,
    percent,
    place,
    plainly,
    ranges,
    size,
)
from plan_cutters.domain.fixture import TABLE, Fixture
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.operations import ProcessSetup
from plan_cutters.plan_file.words.headline import shown_cutter
from plan_cutters.plan_file.words.holes import behind_drills
from plan_cutters.plan_file.words.names import Line, named
from plan_cutters.plan_file.words.operations import of_process

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
    "repeated_body", "crosses_itself", "folds_back", "changed_by_step", "bodies_apart",
]  # fmt: skip


class Note(NamedTuple):
    """A note tells a reader of the plan something that the verdicts do not say."""

    code: NoteCode
    text: str


#: Texts of notes that are filled in: `{names}` are listed, `{all}` are all of them, `{are}`, `{faces}` and `{s}` (a verb) agree
#: with their number; what ends in `_mm`, `_mm2` and `_deg` is written as a length, an area and an angle.
_TEXTS: dict[NoteCode, str] = {
    "cutters_built_in": "The cutters are the built-in set, of usual metric sizes in plain holders: give your own with `--cutter` "
    "or `--cutters`.",
    "no_holder": "{names} {are} judged up to the stated length, without a holder.",
    "tilts_not_searched": "{names} can touch at larger tilts than the {most_deg} searched: `--tilt` asks for more.",
    "all_length_cuts": "All of a cutter's length cuts, unless it says where its flutes end.",
    "samples_apart": "Verdicts are about samples; grid neighbours, and points of a face from its nearest sample, are at most "
    "{most_mm} apart.",
    "samples_coarser": "Samples are {times:.3g} times as far apart as curvature and the smallest cutter ask, for a default "
    "plan takes about {budget:,}: `--spacing` asks for more, `--faces` for less.",
    # Of a part of a batch whose density is for all parts.
    "coarser_than_requested": "Coarser than requested: {wanted} would take too many samples here; judged at {samples}, up to "
    "{most_mm} apart.",
    "samples_wide": "Samples are farther apart than asked on {names}, whose borders no grid follows: `gap_mm` of each face in "
    "plan.json says how far.",
    "not_sampled": "No verdict is about {all}: no sample could be taken there.",
    "maps_partial": "Postures of {unmapped} of {judged} samples were not mapped, for it would take too long: there every tilt "
    "is undecided in postures.npz; sample more coarsely (`--spacing`), or give `--map-budget`.",
    "maps_first_setup": "The posture maps are about the first setup alone: others hold the part differently.",
    "stick_out_each_setup": "With the least stick-outs each setup reaches all that it serves now; if another setup served some "
    "of it, less might do.",
    "no_machine": "No machine was given: any tool axis counts as possible.",
    "names_decoded": "Names in the file are neither ASCII nor UTF-8, and the file does not say what they are: read as "
    "{encoding}.",
    "side_by_setup": "The setup axis decides the side of open faces: with 0,0,1 as setup {names} would be machined on the "
    "other side.",
    "tolerance_raised": "The tolerance was raised from {requested_mm} to {met_mm}: the obstacle triangles could not be made to "
    "follow the surface more closely.",
    "faces_loose": "The obstacle triangles follow {names} only within {worst_mm}. The surface may be anywhere within that: "
    "what only it may forbid is undecided. All else is judged to {tolerance_mm}.",
    "open_faces": "{names} enclose{s} no material: only the surface is in the way, not what may lie behind it.",
    "folds_back": "{names} folds back onto {neighbour}, with {size_mm2}: a surface of revolution that crosses its axis comes "
    "back from STEP as the rest of what was made. Give the shape in Python or as BREP, or leave it out: {option}.",
    "faces_none_sculptured": "No face that can be judged is sculptured: all are targets ({targets}); `--faces` chooses among "
    "them.",
    "faces_ignored": "{faces} {are} ignored, neither targets nor obstacles (nothing is checked against them): {names}.",
    "faces_clamped": "{faces} {are} clamped and left for another setup: {names}.",
    "faces_clamped_there": "{all}: clamped in the setup {setup}, and to be machined in another one.",
    "setup_without_fixtures": "No fixture stands in the setup {setup}: nothing that holds the part there was in the way.",
    "fixture_stays": "{names}: it lies across the axis of the first setup, and stays there in the others.",
    "fixture_not_cad": "Only the GLB model, the review page and pictures show what is no CAD body: {all}.",
    "travel_not_judged": "Linear travel is not judged: {why}.",
    "travel_of_holder": "Linear travel is that of the holder's gauge face at the postures found; it changes no verdict.",
    "travel_first_setup": "Linear travel is judged in the first setup alone.",
    "area_unknown": "The area of {all} is not known: it is not in the share that is served.",
}
_UNITS: dict[str, Callable[[float], str]] = {"mm": mm, "mm2": area, "deg": angle}


def note(code: NoteCode, *names: str, **values: Any) -> Note:
    """A note of `_TEXTS`, about some faces, cutters or fixtures, with its values.

    >>> note("samples_wide", "F1", "F2").text[:53], note("travel_not_judged", why="no limits").text
    ('Samples are farther apart than asked on F1, F2, whose', 'Linear travel is not judged: no limits.')
    """
    one, number = len(names) == 1, len(names)
    texts = {name: _UNITS.get(name.rpartition("_")[2], lambda each: each)(value) for name, value in values.items()}
    agreed = {"are": "is" if one else "are", "s": "s" * one, "faces": f"{number} face{'' if one else 's'}"}
    return Note(code, _TEXTS[code].format(names=listed(names), all=", ".join(names), **agreed, **texts))


def later_stages(
    *, area: bool, answers: Sequence[str], operations: str | None, maps: bool, process: bool = False,
    reasons: Sequence[str] = (), witnesses: bool = False, setups: Sequence[Sequence[float]] = (), proposal: bool = False,
    samples: tuple[int, int] | None = None,
) -> tuple[str, ...]:  # fmt: skip
    """Name what follows the verdicts, in its order, by its options; empty for what was not requested.

    `reasons`: the cutters whose reasons are not found; `witnesses`: theirs, and those of all others, are not either; `setups`:
    axes of those that are not judged; `proposal`: setups were not compared; `samples`: so many were judged, of how many.

    >>> later_stages(area=True, answers=(), operations="fewest", maps=False)
    ('', '', '', '', '', 'the proof between the samples', '', '`--operations fewest`', '')
    """
    return (
        "a setup that was chosen and what holds the part (--setup auto)" if proposal else "",
        f"all but {samples[0]:,} of {samples[1]:,} samples" if samples else "",
        f"what follows in setup {joined([axis_words(each) for each in setups])}" if setups else "",
        f"the reasons of {listed(reasons)}" if reasons else "",
        "witnesses" if witnesses else "",
        "the proof between the samples" if area else "",
        f"`--answers {','.join(answers)}`" if answers else "",
        "your steps (`--process`)" if process else f"`--operations {operations}`" if operations is not None else "",
        "`--posture-maps`" if maps else "",
    )


def run_unfinished(absent: Sequence[str], work: str = "", *, unexplained: bool = False) -> Note:
    """Say what a plan is without; `work`: what the run was doing when it was interrupted; `unexplained`: reasons are missing.

    >>> run_unfinished(["`--answers mend`", "`--operations fewest`"], "planning the operations").text
    'The run was interrupted while planning the operations: this plan is without `--answers mend` and `--operations fewest`.'
    """
    how = f"was interrupted while {work}" if work else "was not done"
    instead = " What it names in their place forbids most tilts, and need not be what helps." if unexplained else ""
    return Note("run_unfinished", f"The run {how}: this plan is without {joined(absent)}.{instead}")


def angles_rounded(steps: Mapping[int, Mapping[str, float]]) -> Note:
    """`steps`: angles as they are judged, deg, by the number of the step in the planner's own file."""
    each = [f"step {k} at {' '.join(f'{name} {plainly(a, 9)}' for name, a in angles.items())}" for k, angles in steps.items()]
    return Note("angles_rounded", f"Angles in the process file have more digits than a control shows: judged is {listed(each)}.")


def side_guessed(*, loose: bool) -> Note:
    """`loose`: there are faces in no solid, which alone can be turned."""
    return Note("side_guessed", f"Which side is material is a guess{'; `--flip` machines the other side' if loose else ''}.")


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


def changed_by_step(face: str, here_mm2: float, there_mm2: float) -> Note:
    """A face of a shape comes back from STEP with another area."""
    back = f"comes back with {area(there_mm2)} for {area(here_mm2)}" if there_mm2 > 0.0 else f"({area(here_mm2)}) is missing"
    return Note(
        "changed_by_step",
        f"Written as STEP and read again, {face} {back}: its surface of revolution crosses its axis. This plan is of the shape "
        "as it was given; its STEP models, and any other STEP of it, show another part.",
    )


def repeated_body(number: int, faces: str, stays: int, stays_faces: str) -> Note:
    """A body of the part that lies where another one lies; number 0: a shell."""
    name, other = (f"body {n}" if n else "a shell" for n in (number, stays))
    return Note(
        "repeated_body",
        f"{name.capitalize()} ({faces}) is {other} ({stays_faces}) again, in the same place, and is left out; to leave out "
        f"the other one: `--ignore {stays_faces}`.",
    )


def repeated_faces(faces: str, stay: str, count_: int) -> Note:
    are, others = ("is", "other one") if count_ == 1 else ("are", "others")
    return Note(
        "repeated_body",
        f"{faces} {are} {stay} again, in the same place, and left out; to leave out the {others}: `--ignore {stay}`.",
    )


def bodies_apart(faces: Sequence[str]) -> Note:
    """`faces`: of each group of bodies that touch."""
    return Note(
        "bodies_apart",
        f"The file has {len(faces)} bodies that do not touch: {listed(faces, 4)}. Each is clamped and machined by itself: plan "
        f"one at a time, the first with `--ignore {','.join(faces[1:])}`.",
    )


def setup_proposed(setups: Sequence[str], why: str) -> Note:
    return Note("setup_proposed", f"Proposed {'setup' if len(setups) == 1 else 'setups'}: {' and '.join(setups)}. {why}")


def fixture(name: str, how: str, setup: str = "") -> Note:
    """How a fixture was understood; in another setup than the first, with that one."""
    return Note("fixture", f"{name}{f' in the setup {setup}' if setup else ''}: {how}.")


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
        why.append(f"the budget was spent with {short} cells open, so a larger `--area-budget` may serve more")
    causes = "; ".join(why) or "some of it has no samples or no closed border"
    return Note(
        "area_left",
        f"{cutter} reaches every judged sample, but not all of the target surface was shown to be served: {causes}. "
        "Finer samples may help, too.",
    )


#: A tolerance that is this many times what was requested was raised; so many faces are named.
_RAISED, _FACES = 1.001, 3
#: Depths are the same within this, mm.
_AS_DEEP = 1e-6
#: Cosine from which on a rotary axis turns about the spindle.
_ALONG = 0.999
#: A part this many times as long as its widest cutter has a wrong unit, rather than so small a cutter.
_LONG = 1000.0
_WRONG = "is its unit wrong? `--unit` gives the right one."
_SHEETS = "stand", "construction sheets do", "them"
#: Notes that are doubts, in the order in which these are listed.
_DOUBTFUL: tuple[tuple[NoteCode, ...], ...] = (
    ("run_unfinished",), ("coarser_than_requested",), ("repeated_body", "crosses_itself", "folds_back", "changed_by_step"),
    ("bodies_apart",),
)  # fmt: skip


def doubts(plan: Plan) -> list[str]:
    """All doubts about a plan with its process, for people: whole sentences; empty where there is none."""
    noted = [*zip(plan.note_codes, plan.notes, strict=False)]
    lines = [text for codes in _DOUBTFUL for code, text in noted if code in codes]
    lines += [
        text
        for doubt in (_unit, _travel, _into_solid, _aslant, _foot, _parallels, _raw, _held, _across, _moving, _unheld, _side)
        for text in doubt(plan)
    ]
    requested, met = plan.effective.tolerance_requested_mm, plan.effective.tolerance_mm
    if requested is not None and met > _RAISED * requested:
        lines.append(
            f"The tolerance had to be raised from {mm(requested)} to {mm(met)}: the triangles follow the surface no closer."
        )
    return [named(plan, line) for line in lines]


def repeated_warnings(plan: Plan) -> set[str]:
    """Warnings on the part that the doubts say in other words."""
    return {text for text in (plan.part.unit_doubt, plan.part.sheets_doubt) if text}


def _unit(plan: Plan) -> Iterator[str]:
    longest = max(plan.part.size_mm)
    widths = [2.0 * cutter.radius for cutter in plan.cutters]
    for each in plan.part.unit_readings:
        this, other = size(plan.part.size_mm), size(plan.part.size_mm, each.times)
        choose = f": `--unit {each.unit}` takes the latter" if each.unit else ""
        if each.cause == "disagree":
            yield f"The file states two units ({each.stated}): {this} by its flag, judged so, {other} by its name{choose}."
        elif each.cause == "scale":
            yield f"The file states a model space scale of {each.stated}: {this} by it, judged so, {other} without it{choose}."
        else:
            yield f"The file's unit is not sure ({each.stated}): it is taken in {each.taken}; `--unit` gives another one."
    if plan.part.unit_readings:
        return
    if plan.part.unit_doubt:
        yield f"The part is {mm(longest)} long: if that is wrong, `--unit` gives the right unit."
    elif longest < min(widths):
        yield f"The part is smaller than any cutter is wide: {_WRONG}"
    elif longest > _LONG * max(widths):
        yield f"The part is {longest / max(widths):,.0f} times as long as the widest cutter is wide: {_WRONG}"


def _travel(plan: Plan) -> Iterator[str]:
    """The machine's travel: shorter than the surface, or exceeded at the postures found."""
    name = plan.machine.name
    short = sorted((each for each in plan.machine.linear if each.short_mm > 0.0), key=lambda each: (-each.short_mm, each.name))
    if short:
        each_axis = " and ".join(
            f"{mm(each.extent_mm)} to machine along {each.name}, {mm(each.short_mm)} more than the travel" for each in short
        )
        yield f"The part does not fit machine {name}: {each_axis}."
        return
    entry = shown_cutter(plan).travel
    if entry is not None and entry.outside:
        by = " and ".join(f"{each.axis} by up to {mm(each.beyond_mm)}" for each in entry.worst)
        yield f"Beyond the travel of {name} at {entry.outside:,} of {count(entry.judged, 'posture')}: {by}."


def _raw(plan: Plan) -> Iterator[str]:
    """Faces that a setup grips or stands on before any step comes to them, where the part begins as stock."""
    process = plan.process
    if not process.setups or process.setups[0].stands_on != "stock":
        return
    done, every = set[str](), {face for step in process.steps for face in step.faces}
    for setup in process.setups:
        mine = [step for step in process.steps if step.setup == setup.number - 1]
        on = [] if setup.stands_on in (None, "stock") else setup.stands_on
        raw = [face for face in dict.fromkeys([*setup.grips, *on]) if face in every - done]
        if raw and mine:
            yield f"Setup {setup.number} holds raw faces: no step before it machines {listed(raw, _FACES)}."
        done.update(face for step in mine for face in step.faces)


def _into_solid(plan: Plan) -> Iterator[str]:
    """Steps of mills that go down to the bottoms of holes, which are solid until their drills have been there."""
    for k, drills in behind_drills(plan).items():
        which = f"step{'s' * (len(drills) > 1)} {_runs(drills)}"
        yield f"Run step {k} behind {which}: it goes to the bottoms of holes that are drilled there."


def _upright(setup: ProcessSetup) -> bool:
    """Whether what holds the part stands along the spindle."""
    return setup.clamping is None or Fixture.parse(setup.clamping).stands_along(setup.up) == setup.up


def _foot(plan: Plan) -> Iterator[str]:
    """What a first setup gripped of the stock is still below the part where the next one does not turn this over."""
    setups, stock = plan.process.setups, plan.process.stock
    if stock is None or len(setups) < 2 or setups[1].held is None:
        return
    first, second = setups[:2]
    if _upright(first) and sum(one * other for one, other in zip(first.up, second.up, strict=True)) > -_ALONG:
        yield "Cut off what is left of the stock below the part before setup 2, which does not turn the part over."


def _parallels(plan: Plan) -> Iterator[str]:
    """Drills whose points go through the part into the table."""
    for setup in plan.process.setups:
        mine = [step for step in plan.process.drilling if step.setup == setup.number - 1 and setup.held == TABLE]
        through = [(step, plan.holes[stroke.hole]) for step in mine for stroke in step.holes]
        if any(hole.through and abs(step.depth_mm - hole.depth_mm) <= _AS_DEEP for step, hole in through):
            yield f"Put the part on parallels in setup {setup.number}: the points of drills go through it into the table."


def _aslant(plan: Plan) -> Iterator[str]:
    """Steps that drill into what leans from being square to them."""
    steps, steep = list[int](), 0.0
    for number, bores in enumerate(plan.process.drilling, len(plan.process.steps) + 1):
        if slopes := [each.slope_deg for each in bores.holes if each.slope_deg is not None]:
            steps.append(number)
            steep = max(steep, *slopes)
    if steps:
        begins = f"step {_runs(steps)} begins" if len(steps) == 1 else f"steps {_runs(steps)} begin"
        yield f"A drill wanders where {begins} on a slope of {angle(steep)}: mill a flat there first."


def _across(plan: Plan) -> Iterator[str]:
    """Chucks that stand along the spindle, where the rotary axis next to the part turns them about another direction, and what
    stands behind those that lie along that axis."""
    process, rotary = plan.process, plan.machine.rotary
    if not rotary or rotary[0].carries != "part" or not process.setups:
        return
    # The axis of the machine is given in the frame of the first setup.
    along = abs(sum(one * other for one, other in zip(rotary[0].direction, process.setups[0].up, strict=True)))
    turned = {step.setup for step in process.steps if step.mode == "simultaneous" or any((step.angles_deg or {}).values())}
    chucks = [each for each in process.setups if each.held == "chuck" and each.clamping]
    upright = [each for each in chucks if _upright(each)]
    numbers = [str(each.number) for each in upright if each.number - 1 in turned]
    if numbers and along < _ALONG:
        yield (
            f"In setup{'s' if len(numbers) > 1 else ''} {listed(numbers)} the chuck stands along the spindle, on a plate that "
            f"{rotary[0].name} turns: `--setup auto` lays a bar along {rotary[0].name}."
        )
    lying = [each for each in chucks if each not in upright]
    out = [f"{mm(each.out_mm)} on {mm(each.apart_mm)} in setup {each.number}" for each in lying if each.out_mm and each.apart_mm]
    if out:
        yield f"Support the far end with a tailstock, once faced and centred: the part stands out of the chuck {listed(out)}."
    if lying:
        where = f"setup{'s' if len(lying) > 1 else ''} {listed([str(each.number) for each in lying])}"
        yield (
            f"What carries the chuck on {rotary[0].name} in {where}, and a tailstock, are no obstacles unless you give them: "
            "`--fixture FILE`."
        )


def _held(plan: Plan) -> Iterator[str]:
    """Steps from below, at rotary angles, in setups in which nothing holds the part."""
    process = plan.process
    if not plan.machine.rotary:
        return
    # A table lies below the part, and holds it against nothing that comes from there.
    holds = {each.number - 1 for each in process.setups if each.held not in (None, "table")}
    below = [k for k, step in enumerate(process.steps, 1) if step.below_mm2 > 0.0 and step.setup not in holds]
    if not below:
        return
    steps = [process.steps[k - 1] for k in below]
    partly = all(step.below_mm2 < step.area_mm2 * (1.0 - ROUNDING) for step in steps)
    which = f"step {below[0]} comes" if len(below) == 1 else f"steps {_runs(below)} come"
    where = f" in setup {steps[0].setup + 1}" if holds and len({step.setup for step in steps}) == 1 else ""
    yield f"Nothing holds the part{where}: {which} {'partly ' if partly else ''}from below."


def _moving(plan: Plan) -> Iterator[str]:
    """Steps of simultaneous motion between whose samples not all is proved."""
    if plan.operations is None:
        return
    made = {each.id: each for each in of_process(plan.operations, plan.process)}
    steps = [(k, made[step.operation]) for k, step in enumerate(plan.process.steps, 1) if step.operation in made]
    moving = [(k, each) for k, each in steps if each.mode == "simultaneous" and (each.proved_share or 0.0) < 1.0]
    if not moving:
        return
    whole, tested = sum(each.area_mm2 for _, each in moving), sum(each.samples for _, each in moving)
    share = 1.0 - sum(each.area_mm2 * (each.proved_share or 0.0) for _, each in moving) / max(1e-300, whole)
    over = f"{count(tested, 'sample')}, {percent(share, whole=share >= 1.0 - ROUNDING)} of its area"
    which = f"step{'s' * (len(moving) > 1)} {_runs([k for k, _ in moving])}"
    yield f"Not proved between samples: simultaneous motion in {which}, at {over}."


def _unheld(plan: Plan) -> Iterator[str]:
    """Bodies of the part that a vise or chuck does not hold, and tools of a library that do not fit their holders."""
    several = len({setup for fixture in plan.fixtures for setup in fixture.setups}) > 1
    for fixture in plan.fixtures:
        if fixture.unheld:
            kind, bodies = (fixture.clamping or fixture.name).partition(":")[0], "body" if len(fixture.unheld) == 1 else "bodies"
            where = f" in setup {fixture.setups[0] + 1}" if several else ""
            yield f"The jaws of the {kind} do not hold the {bodies} of {listed(fixture.unheld, _FACES)}{where}."
    tools = [(tool.name or tool.place, tool.why) for library in plan.libraries for tool in library.unused if tool.unheld]
    if tools:
        more = f" ({len(tools) - 1} more)" if len(tools) > 1 else ""
        yield f"A tool does not fit its holder and is not used{more}: {tools[0][0]}, {tools[0][1]}."


def _side(plan: Plan) -> Iterator[str]:
    """Faces whose side of the material is a guess, and construction sheets."""
    part = plan.part
    # The option turns what stands in no solid.
    turned = [name for name in part.guessed_faces if not part.solids or name in part.loose_faces]
    if turned and len(turned) >= sum(not face.ignored for face in plan.faces):
        yield "An open shell: which side is material is a guess; `--flip` takes the other one."
    elif turned:
        yield f"Which side of {listed(turned, _FACES)} is material is a guess; `--flip` takes the other one."
    if solid := [name for name in part.guessed_faces if name not in turned]:
        faces = listed(solid, _FACES)
        yield f"Which side of {faces} is material is a guess: a solid that is open or crosses itself does not tell it."
    if loose := part.loose_faces:
        verb, what, them = ("stands", "a construction sheet does", "it") if len(loose) == 1 else _SHEETS
        option = f"`--ignore {ranges(int(face[1:]) for face in loose)}`"
        yield f"{listed(loose, _FACES)} {verb} in no solid, as {what}: {option} leaves {them} out."


def _runs(numbers: Sequence[int]) -> str:
    """Ascending numbers in words.

    >>> _runs([2, 3, 4, 5, 6]), _runs([1, 2]), _runs([1, 3, 4, 5])
    ('2 to 6', '1 and 2', '1 and 3 to 5')
    """
    texts = [text for run in consecutive(numbers) for text in ([f"{run[0]} to {run[-1]}"] if len(run) > 2 else map(str, run))]
    return joined(texts)


#: Notes that say what the first lines say, or in other words; those of the area between samples, where it was looked at.
_STATED_ABOVE: frozenset[str] = frozenset(
    {"samples_apart", "area_proved", "area_left", "setup_proposed", "run_unfinished", "coarser_than_requested"}
)
#: What stands for an obstacle that is not known.
_STAND_IN = {
    "none": "nothing stands",
    "box": "the box around it stands",
    "triangles": "its own triangles stand",
    "edges": "its edges stand",
}
#: Tools that are named for each reason why they are not used.
_TOOLS = 3


def notes(plan: Plan) -> Iterator[Line]:
    """The notes of the plan."""
    for code, text in zip(plan.note_codes, plan.notes, strict=False):
        yield Line(named(plan, text), "Note:", minor=code in _STATED_ABOVE)


def unsure(plan: Plan) -> dict[str, tuple[Line, ...]]:
    """Causes that make verdicts unsure, by their kind in the plural: while an obstacle is missing, no cutter is feasible."""
    missing = [(" ".join(filter(None, (m.face or m.entity, m.name))) or "a face of the file", m) for m in plan.missing]
    unjudged = [(" ".join(filter(None, (f.id, f.name))), f.unjudged) for f in plan.faces if f.target and f.unjudged]
    return {
        "warnings": tuple(Line(f"{text.removesuffix('.')}.", "Warning:") for text in plan.part.warnings),
        "faces that are not judged": tuple(Line(f"{which} ({why}).", "Not judged:") for which, why in unjudged),
        "missing obstacles": tuple(
            Line(f"{which} ({m.why}; {_STAND_IN[m.stand_in]} for it).", "Missing obstacle:") for which, m in missing
        ),
    }


def side(plan: Plan) -> Line:
    """How the side of the material was found, how sure that is, and what is open."""
    orientation, sewing = plan.part.orientation, plan.part.sewing
    sure = " (sure)" if orientation.confident else "" if "guess" in orientation.method else " (a guess)"
    text = f"{orientation.method}{sure}."
    if sewing and sewing.tolerance_mm is not None:
        text += f" Faces were joined at {mm(sewing.tolerance_mm)}."
    if sewing and sewing.open_edges:
        text += f" Open edges: {sewing.open_edges}, {mm(sewing.open_length_mm, 4)} long."
    return Line(text, "Side of the material:", minor=orientation.confident)


def libraries(plan: Plan) -> Iterator[Line]:
    """Say how many tools were read from tool libraries, and which are not used, reason by reason."""
    for library in plan.libraries:
        unused = len(library.unused)
        more = f"; {unused} {'is' if unused == 1 else 'are'} not used (-v says why)" if unused else ""
        of = f"{library.file} ({library.format}) gives {count(library.cutters, 'cutter')} of {count(library.tools, 'tool')}"
        yield Line(f"{of}{more}.")
        yield from (Line(f"  {remark}", minor=True) for remark in library.notes)
        places: dict[str, list[str]] = {}
        for tool in library.unused:
            places.setdefault(tool.why, []).append(f'{tool.place} "{tool.name}"' if tool.name else tool.place)
        for why, each in places.items():
            yield Line(f"  Not used: {listed(each, _TOOLS)}: {why}.", minor=True)


def machine(plan: Plan) -> str:
    """Say which machine limits the tool axis, and how the part stands."""
    along = f"spindle points along {axis_words(plan.effective.setup)} of the part"
    if plan.effective.other_setups:
        along += f", in other setups along {'; '.join(map(axis_words, plan.effective.other_setups))}"
    if plan.machine.name == "unlimited":
        return f"No machine limits the tool axis; the {along}."
    return f"The machine is {plan.machine.name}; its {along}."


def setups(plan: Plan, best: CutterEntry) -> Iterator[Line]:
    """Say how much no cutter can reach in this setup, which cutter does the rest, and the area within the limit in others."""
    number, samples = 1 + len(plan.effective.other_setups), plan.samples
    if number > 1:
        each = "; ".join(f"{s.interference_free + s.accessible:,} with {axis_words(s.axis)}" for s in best.setups)
        what = f"leaves {best.lost_in_all:,}" if best.lost_in_all else "reaches all"
        yield Line(named(plan, f"Over the {number} setups {best.id} {what} of {samples.finished:,} samples. It reaches {each}."))
    not_reached = max((c.beyond_setup for c in plan.cutters), default=0)
    if not not_reached:
        return
    here = "this setup" if number == 1 else "these setups"
    yield Line(f"Beyond {here}: the axis limit loses {not_reached} of {samples.finished} samples for every cutter.")
    if plan.selected_for_setup:
        yield Line(named(plan, f"For {here}: {plan.selected_for_setup}, which leaves nothing else."), minor=True)
    if not plan.setups:  # no machine: the range of tilts is the limit
        return
    within = [(s, percent(s.share, some=bool(s.within), whole=s.within == samples.judged)) for s in plan.setups]
    now = [f"{axis_words(s.axis)} {share}" for s, share in within if s.reached is not None]
    others = ", ".join(f"{axis_words(s.axis)} {share}" for s, share in within if s.reached is None)
    yield Line(f"Area within the limit by setup axis: {within[0][1] if number == 1 else ', '.join(now)} now; {others}.")


def travel(plan: Plan, best: CutterEntry) -> Iterator[Line]:
    """Whether the machine's linear axes reach what a cutter reaches."""
    entry = best.travel
    if entry is None:
        return
    if entry.outside:
        each = "; ".join(f"{w.axis} by up to {mm(w.beyond_mm, 4)}, at ({place(w.point)}) on {w.face}" for w in entry.worst)
        yield Line(named(plan, f"Beyond the travel: at {entry.outside} of {entry.judged} samples reached by {best.id} the "
                         f"posture found needs more than the machine's: {each}."))  # fmt: skip
    elif entry.judged:
        text = f"Within the travel: all {entry.judged} postures found for {best.id} whose positions are known."
        yield Line(named(plan, text), minor=True)
    if entry.unknown:
        text = f"Travel of {best.id} is not known at {entry.unknown} samples: linear axes are in one plane there."
        yield Line(named(plan, text))
