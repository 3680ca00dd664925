"""A plan put into words, once: whoever shows it lays these out."""

from collections.abc import Mapping
from dataclasses import dataclass

from plan_cutters.domain.figures import sentence
from plan_cutters.domain.lengths import reporting
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.nearest import nearest
from plan_cutters.plan_file.words import notes
from plan_cutters.plan_file.words.answers import answers
from plan_cutters.plan_file.words.cutters import CutterStory, cutter_story
from plan_cutters.plan_file.words.headline import Headline, headline
from plan_cutters.plan_file.words.inside import inside
from plan_cutters.plan_file.words.inside_radii import inside_radii
from plan_cutters.plan_file.words.line import Line
from plan_cutters.plan_file.words.names import named, short_names
from plan_cutters.plan_file.words.next_steps import together
from plan_cutters.plan_file.words.operations import in_short, operations
from plan_cutters.plan_file.words.patterns import patterns
from plan_cutters.plan_file.words.process import ProcessStory, process_story
from plan_cutters.plan_file.words.proposal import proposal
from plan_cutters.plan_file.words.scope import not_judged, not_seen
from plan_cutters.plan_file.words.sharp_edges import sharp_edges
from plan_cutters.plan_file.words.undecided import undecided


@dataclass(frozen=True, slots=True)
class Story:
    """A story puts a plan into words, in the order in which people read them.

    Attributes
    ----------
    names : dict
        Id of a cutter -> its name in the texts.
    taken, shown : str
        Ids of the cutter that the headline says to take, if any, and of the one that the models show.
    inside, scope, between : tuple of str
        Surface that does not belong to the finished part, which comes first; what is undecided, which faces were not judged or
        not seen, and how much the cutters reach together; how much is known between the samples.
    process : ProcessStory, optional
        Its steps, what is left and what to do next; None where an older file has none.
    proposal, in_short : tuple of str
        Setups that were proposed; what the plan of operations leaves, and how many orientations it needs.
    setups, operations, answers, notes : tuple of Line
    doubts : dict
        Causes that make verdicts unsure, by their kind in the plural.
    """

    names: Mapping[str, str]
    taken: str | None
    shown: str
    inside: tuple[str, ...]
    headline: Headline
    process: ProcessStory | None
    proposal: tuple[str, ...]
    in_short: tuple[str, ...]
    scope: tuple[str, ...]
    between: tuple[str, ...]
    cutters: tuple[CutterStory, ...]
    setups: tuple[Line, ...]
    operations: tuple[Line, ...]
    answers: tuple[Line, ...]
    doubts: Mapping[str, tuple[Line, ...]]
    notes: tuple[Line, ...]

    def cutter(self, name: str) -> CutterStory:
        """The story of a cutter, by its id."""
        return next(each for each in self.cutters if each.id == name)


@reporting(lambda plan: plan.effective.units)
def story_of(plan: Plan) -> Story:
    """Tell a plan."""
    names, best = short_names(plan), shown(plan)
    cutters = tuple(cutter_story(plan, c, names[c.id]) for c in plan.cutters)
    finished = plan.selected or plan.selected_over_setups
    pair = "" if finished else together(plan)
    return Story(
        names=names,
        taken=finished or plan.selected_for_setup,
        shown=best.id,
        inside=tuple(named(plan, line) for line in inside(plan)),
        headline=headline(plan, names),
        process=process_story(plan, names),
        proposal=proposal(plan),
        in_short=tuple(in_short(plan)),
        scope=(
            *undecided(plan, names),
            *sharp_edges(plan, names),
            *inside_radii(plan, names),
            *not_judged(plan),
            *not_seen(plan, names),
            *([sentence(named(plan, pair))] if pair else []),
        ),
        between=tuple(each.between for each in cutters if each.between),
        cutters=cutters,
        setups=(*notes.setups(plan, best), *notes.travel(plan, best)),
        operations=tuple(operations(plan)),
        answers=tuple(answers(plan)),
        doubts={
            "warnings": tuple(notes.warnings(plan)),
            "faces that are not judged": tuple(notes.unjudged(plan)),
            "missing obstacles": tuple(notes.missing(plan)),
        },
        notes=(notes.side(plan), *map(Line, patterns(plan)), *notes.libraries(plan), *notes.notes(plan)),
    )


def shown(plan: Plan) -> CutterEntry:
    """The cutter that the models show: the selected, else the one that leaves the least area."""
    return next((c for c in plan.cutters if c.id == plan.selected), None) or nearest(plan.cutters)
