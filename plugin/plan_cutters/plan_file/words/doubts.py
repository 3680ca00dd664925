"""Say what changes what one does, before the process: a line each, the gravest first."""

from collections.abc import Iterator, Sequence

from plan_cutters.domain.figures import ROUNDING, consecutive, count, joined, listed, mm, ranges, size
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.part_info import UnitEntry
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.scope import shown_cutter

#: A tolerance that is this many times what was requested was raised; so many faces are named.
_RAISED, _FACES = 1.001, 3
#: A part this many times as long as its widest cutter has a wrong unit, rather than so small a cutter.
_LONG = 1000.0
_WRONG = "is its unit wrong? --unit gives the right one."


def doubts(plan: Plan) -> list[str]:
    """All doubts about a plan, for people; empty where there is none.

    Parameters
    ----------
    plan : Plan
        With its process, if it has one.

    Returns
    -------
    list of str
        Whole sentences.
    """
    each = (_unfinished, _coarser, _surfaces, _unit, _travel, _held, _bodies, _unheld, _side, _sheets, _tolerance)
    return [named(plan, line) for doubt in each for line in doubt(plan)]


def repeated_warnings(plan: Plan) -> set[str]:
    """Warnings on the part that the doubts say in other words."""
    return {text for text in (plan.part.unit_doubt, plan.part.sheets_doubt) if text}


def _unfinished(plan: Plan) -> Iterator[str]:
    yield from (text for code, text in zip(plan.note_codes, plan.notes, strict=False) if code == "run_unfinished")


def _coarser(plan: Plan) -> Iterator[str]:
    yield from (text for code, text in zip(plan.note_codes, plan.notes, strict=False) if code == "coarser_than_requested")


def _surfaces(plan: Plan) -> Iterator[str]:
    """What is there twice, and what is not the surface that was made."""
    noted = [*zip(plan.note_codes, plan.notes, strict=False)]
    yield from (text for code, text in noted if code in ("repeated_body", "crosses_itself", "folds_back", "changed_by_step"))


def _unit(plan: Plan) -> Iterator[str]:
    longest = max(plan.part.size_mm)
    widths = [2.0 * cutter.radius for cutter in plan.cutters]
    if plan.part.unit_readings:
        yield from (_reading(plan, each) for each in plan.part.unit_readings)
    elif plan.part.unit_doubt:
        yield f"The part is {mm(longest)} long: if that is wrong, --unit gives the right unit."
    elif longest < min(widths):
        yield f"The part is smaller than any cutter is wide: {_WRONG}"
    elif longest > _LONG * max(widths):
        wide = f"{longest / max(widths):,.0f} times as long as the widest cutter is wide"
        yield f"The part is {wide}: {_WRONG}"


def _reading(plan: Plan, each: UnitEntry) -> str:
    """A doubt about what the file says of its unit: sizes by both readings, and how to choose."""
    this, other = size(plan.part.size_mm), size(plan.part.size_mm, each.times)
    choose = f": --unit {each.unit} takes the latter" if each.unit else ""
    if each.cause == "disagree":
        return f"The file states two units ({each.stated}): {this} by its flag, judged so, {other} by its name{choose}."
    if each.cause == "scale":
        return f"The file states a model space scale of {each.stated}: {this} by it, judged so, {other} without it{choose}."
    return f"The file's unit is not sure ({each.stated}): it is taken in {each.taken}; --unit gives another one."


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


def _held(plan: Plan) -> Iterator[str]:
    """Steps from below, at rotary angles, in setups in which nothing holds the part."""
    process = plan.process
    if process is None or not plan.machine.rotary:
        return
    holds = {setup for fixture in plan.fixtures for setup in fixture.setups}
    below = [k for k, step in enumerate(process.steps, 1) if step.below_mm2 > 0.0 and step.setup not in holds]
    if not below:
        return
    steps = [process.steps[k - 1] for k in below]
    partly = all(step.below_mm2 < step.area_mm2 * (1.0 - ROUNDING) for step in steps)
    which = f"step {below[0]} comes" if len(below) == 1 else f"steps {_runs(below)} come"
    setups = {step.setup for step in steps}
    where = f" in setup {setups.pop() + 1}" if holds and len(setups) == 1 else ""
    yield f"No fixture was given{where}: {which} {'partly ' if partly else ''}from below."


def _bodies(plan: Plan) -> Iterator[str]:
    """Bodies of the part that a vise or chuck does not hold."""
    several = len({setup for fixture in plan.fixtures for setup in fixture.setups}) > 1
    for fixture in plan.fixtures:
        if fixture.unheld:
            kind, bodies = (fixture.clamping or fixture.name).partition(":")[0], "body" if len(fixture.unheld) == 1 else "bodies"
            where = f" in setup {fixture.setups[0] + 1}" if several else ""
            yield f"The jaws of the {kind} do not hold the {bodies} of {listed(fixture.unheld, _FACES)}{where}."


def _unheld(plan: Plan) -> Iterator[str]:
    """Tools of a library that do not fit their holders."""
    tools = [(tool.name or tool.place, tool.why) for library in plan.libraries for tool in library.unused if tool.unheld]
    if tools:
        more = f" ({len(tools) - 1} more)" if len(tools) > 1 else ""
        yield f"A tool does not fit its holder and is not used{more}: {tools[0][0]}, {tools[0][1]}."


def _side(plan: Plan) -> Iterator[str]:
    part = plan.part
    # The option turns what stands in no solid.
    turned = [name for name in part.guessed_faces if not part.solids or name in part.loose_faces]
    if turned and len(turned) >= sum(not face.ignored for face in plan.faces):
        yield "An open shell: which side is material is a guess; --flip takes the other one."
    elif turned:
        yield f"Which side of {listed(turned, _FACES)} is material is a guess; --flip takes the other one."
    solid = [name for name in part.guessed_faces if name not in turned]
    if solid:
        faces = listed(solid, _FACES)
        yield f"Which side of {faces} is material is a guess: a solid that is open or crosses itself does not tell it."


def _sheets(plan: Plan) -> Iterator[str]:
    faces = plan.part.loose_faces
    if faces:
        verb = "stands" if len(faces) == 1 else "stand"
        what, them = ("a construction sheet does", "it") if len(faces) == 1 else ("construction sheets do", "them")
        option = f"--ignore {ranges(int(face[1:]) for face in faces)}"
        yield f"{listed(faces, _FACES)} {verb} in no solid, as {what}: {option} leaves {them} out."


def _tolerance(plan: Plan) -> Iterator[str]:
    requested, met = plan.effective.tolerance_requested_mm, plan.effective.tolerance_mm
    if requested is not None and met > _RAISED * requested:
        yield f"The tolerance had to be raised from {mm(requested)} to {mm(met)}: the triangles follow the surface no closer."


def _runs(numbers: Sequence[int]) -> str:
    """Ascending numbers in words.

    >>> _runs([2, 3, 4, 5, 6]), _runs([1, 2]), _runs([1, 3, 4, 5])
    ('2 to 6', '1 and 2', '1 and 3 to 5')
    """
    texts = [text for run in consecutive(numbers) for text in ([f"{run[0]} to {run[-1]}"] if len(run) > 2 else map(str, run))]
    return joined(texts)
