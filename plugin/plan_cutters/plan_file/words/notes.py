"""Give the doubts about verdicts, the limits of the tool and the notes of a plan: a code decides who reads them, never a text."""

from collections.abc import Iterator
from itertools import zip_longest

from plan_cutters.domain.figures import count, mm, percent, place
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.model import CutterEntry, LibraryEntry, Plan
from plan_cutters.plan_file.notes import NoteCode
from plan_cutters.plan_file.words.line import Line
from plan_cutters.plan_file.words.names import named

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
