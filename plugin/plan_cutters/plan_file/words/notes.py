"""The doubts about verdicts, the limits of the tool and the notes of a plan: a code decides who reads them, never a text."""

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from plan_cutters.domain.figures import ROUNDING, consecutive, count, joined, listed, mm, percent, place, ranges, size
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.model import CutterEntry, LibraryEntry, Plan
from plan_cutters.plan_file.notes import NoteCode
from plan_cutters.plan_file.part_info import UnitEntry
from plan_cutters.plan_file.words.names import Line, named
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


#: Notes that say what the first lines say, or in other words; those of the area between samples, where it was looked at.
_STATED_ABOVE: frozenset[NoteCode | None] = frozenset(
    {"samples_apart", "area_proved", "area_left", "setup_proposed", "run_unfinished", "coarser_than_requested"}
)
#: What stands for an obstacle that is not known.
_STAND_IN = {
    "none": "nothing stands for it",
    "box": "the box around it stands for it",
    "triangles": "its own triangles stand for it",
    "edges": "its edges stand for it",
}
#: Tools that are named for each reason why they are not used.
_TOOLS = 3


def notes(plan: Plan) -> Iterator[Line]:
    """The notes of the plan."""
    # Older plans have no codes: all of their notes are shown.
    for code, text in zip_longest(plan.note_codes, plan.notes):
        yield Line(named(plan, text), "Note:", minor=code in _STATED_ABOVE)


def warnings(plan: Plan) -> Iterator[Line]:
    """Warn of the unusual properties of the part."""
    for text in plan.part.warnings:
        yield Line(text if text.endswith(".") else f"{text}.", "Warning:")


def unjudged(plan: Plan) -> Iterator[Line]:
    """Faces that could not be judged, or not all of them."""
    for f in plan.faces:
        if f.target and f.unjudged:
            yield Line(f"{' '.join(filter(None, (f.id, f.name)))} ({f.unjudged}).", "Not judged:")


def missing(plan: Plan) -> Iterator[Line]:
    """Obstacles that are missing, so that no cutter is feasible beyond doubt."""
    for m in plan.missing:
        which = " ".join(filter(None, (m.face or m.entity, m.name))) or "a face of the file"
        yield Line(f"{which} ({m.why}; {_STAND_IN[m.stand_in]}).", "Missing obstacle:")


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
        yield from library_lines(library)


def library_lines(library: LibraryEntry) -> Iterator[Line]:
    """Say how many tools were read from a tool library, and which are not used."""
    unused = len(library.unused)
    more = f"; {unused} {'is' if unused == 1 else 'are'} not used (-v says why)" if unused else ""
    of = f"{library.file} ({library.format}) gives {count(library.cutters, 'cutter')} of {count(library.tools, 'tool')}"
    yield Line(f"{of}{more}.")
    for note in library.notes:
        yield Line(f"  {note}", minor=True)
    places: dict[str, list[str]] = {}
    for tool in library.unused:
        places.setdefault(tool.why, []).append(f'{tool.place} "{tool.name}"' if tool.name else tool.place)
    for why, each in places.items():
        omitted = f" and {len(each) - _TOOLS} more" if len(each) > _TOOLS else ""
        yield Line(f"  Not used: {', '.join(each[:_TOOLS])}{omitted}: {why}.", minor=True)


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
