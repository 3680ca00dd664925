"""A part with the verdicts of all cutters in all setups: a plan can be put together of it, whatever is asked besides."""

import datetime
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from cad_io.part.edges import InsideEdge, inside_edges
from plan_cutters.answers.chamfers import chamfer_mill
from plan_cutters.answers.drilling import drilled
from plan_cutters.answers.hole_setups import further_setup
from plan_cutters.answers.means import fitting
from plan_cutters.answers.steps import one_more_setup
from plan_cutters.document.build import cutter_entry
from plan_cutters.document.clock import Clock
from plan_cutters.document.features import inside_radius_entries, pattern_entries, sharp_edge_entries
from plan_cutters.document.holes import hole_entries, with_drilling
from plan_cutters.document.notes import noted
from plan_cutters.document.plan import completed, plan_of, selection
from plan_cutters.document.process import OverSetups, setup_table
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import notation
from plan_cutters.domain.standard_tools import Fit
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import CONVEX, UNJUDGED, Verdicts, over_setups
from plan_cutters.judging.between import in_each
from plan_cutters.judging.judge import GroundDigests, judge
from plan_cutters.judging.limits import travels, within_limits
from plan_cutters.judging.phases import march_differs
from plan_cutters.judging.posture_maps import posture_maps
from plan_cutters.judging.reasons import Explained, Reasons, exempt, may_be_at_edge, strips, with_sharp_edges
from plan_cutters.judging.witness import witnesses
from plan_cutters.operations.entries import with_reasons
from plan_cutters.operations.orientations import index_times
from plan_cutters.option_table import EFFORT
from plan_cutters.outcome import Answers, Operations
from plan_cutters.plan_file.frozen import filled
from plan_cutters.plan_file.model import AreaEntry, CutterEntry, Plan, nearest
from plan_cutters.plan_file.part_info import SharpEdgeEntry
from plan_cutters.plan_file.words.notes import note
from plan_cutters.plan_file.words.text import with_text
from plan_cutters.result import Result
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.preparation import Axis, Prepared, for_another_setup
from plan_cutters.scene.work import Progress, Work, part_of
from plan_cutters_base.stage_cache import NO_CACHE

#: The work between samples: this share of what came before, and so many boxes in any case, fewer among more than so many
#: triangles, where each takes longer. What came before: boxes of searches, and what a triangle and a sample take until judged.
_WORK_SHARE, _WORK_LEAST, _FEW, _TRIANGLE, _SAMPLE = 1 / 3, 2.5e7, 2e5, 15.0, 90.0

#: The reasons of a cutter over all setups, and the setup that serves each sample.
ExplainedIn = tuple[Explained, Ints]


@dataclass(frozen=True, slots=True)
class JudgedCutter:
    """The verdicts of one cutter, over all setups and in the first one, with its line in the plan."""

    verdicts: Verdicts  #: Over all setups, with the reasons that can be acted on.
    which: Ints  #: (n,) int32: the setup that serves each sample, -1 for none.
    here: Verdicts  #: In the first setup alone; the same where there is no other one.
    entry: CutterEntry  #: Its line in the plan.
    strips: list[SharpEdgeEntry]  #: Sharp inside edges at which it leaves a fillet.


@dataclass(frozen=True, eq=False)
class JudgedPart:
    """A part of which the verdicts stand."""

    ready: Prepared
    cutters: Mapping[Cutter, JudgedCutter]  #: What is known of each cutter.
    other_setups: Sequence[Mapping[Cutter, Verdicts]]  #: What each cutter reaches in each setup but the first.
    travels: dict[str, Travel]  #: Cutter id -> where the linear axes stand; empty where that is not judged.
    searched: Work  #: The work of all searches, which bounds that between the samples unless a budget was requested.
    started: datetime.datetime  #: When the work began.
    carried: NDArray[np.int64]  #: (m, 3) int64: of each motion of the whole part, as `JudgeOnce.carried` counts.
    #: Ids of the cutters whose reasons were not looked for: they are those that the search of postures found. Of a cutter that
    #: reaches all there are none.
    unexplained: tuple[str, ...] = ()
    witnessed: bool = True  #: Whether each cutter has its witnesses.
    later: tuple[Axis, ...] = ()  #: Axes of setups that are judged later, and of which this part knows nothing.
    few: tuple[int, int] | None = None  #: How many samples were looked at, of how many; None: all.
    proposing: bool = False  #: Whether setups are still compared.
    explain: "Callable[[], JudgedPart] | None" = None  #: How its reasons and witnesses are found; None: as far as they are to be.

    @classmethod
    def of(
        cls, ready: Prepared, here: Mapping[Cutter, Verdicts], other_setups: Sequence[Mapping[Cutter, Verdicts]],
        seconds: Mapping[Cutter, float], clock: Clock, searched: Work, started: datetime.datetime,
        carried: NDArray[np.int64], by_cutter: "dict[Cutter, ExplainedIn]", *, explain: bool = True,
    ) -> "JudgedPart":  # fmt: skip
        """Combine the verdicts of each cutter over all setups, find the reasons and what is not required, and make its line.

        `by_cutter` takes the reasons of each cutter as they are found; without `explain`, those that are there have to do, and no
        witnesses are looked for.
        """
        samples, convex, surroundings = ready.samples, ready.surface_class == CONVEX, ready.conditions.surroundings
        reasons = Reasons(samples, ready.setups, ready.somewhere, ready.machinable)
        unexplained: tuple[str, ...] = ()
        with clock.stage("reasons", shown=explain) as tell:
            for k, (cutter, mine) in enumerate(here.items()):
                if cutter in by_cutter:
                    continue
                over, which = over_setups([mine, *(there[cutter] for there in other_setups)])
                if explain:
                    by_cutter[cutter] = reasons.of(cutter, over, part_of(tell, k, len(here))), which
                    continue
                by_cutter[cutter] = Explained.of_search(over), which
                unexplained += (cutter.id,) if over.not_reached.any() else ()
            wanted = any(may_be_at_edge(explained.verdicts, cutter) for cutter, (explained, _) in by_cutter.items())
            edges = _inside_edges(ready) if wanted else ()
        at_edges = {cutter: strips(samples, explained.verdicts, cutter, edges) for cutter, (explained, _) in by_cutter.items()}
        reaches = {c: for_another_setup(ready, with_sharp_edges(by_cutter[c][0].verdicts, each)) for c, each in at_edges.items()}
        ready = replace(ready, exempt=exempt(reaches, ready.inside_bodies) if ready.options.sharp_edges == "left" else None)
        judged, grounds = {}, GroundDigests()
        for (cutter, mine), (explained, which) in zip(here.items(), by_cutter.values(), strict=True):
            at_edge, verdicts = at_edges[cutter], reaches[cutter]
            with clock.stage(cutter.id, shown=False):
                context, part = Context.of(cutter, ready.conditions), ready.scene.part
                ground = grounds.of(ready) if explain and ready.cache is not NO_CACHE else b""
                witness_list = ready.cache.cached(
                    "witnesses", (ground, part.key, replace(cutter, name=""), verdicts),
                    partial(witnesses, samples, verdicts, context, inside=ready.shut, part=part),
                ) if explain else []  # fmt: skip
                marched = march_differs(samples, convex, ready.region, mine.interference_free)
                entry = cutter_entry(
                    cutter, samples, verdicts, witness_list, marched, seconds[cutter], part=part, surroundings=surroundings,
                    slack=context.outer_tool.slack, inside=ready.inside_bodies, exempt=ready.exempt, besides=explained.besides,
                )  # fmt: skip
                fillets = sharp_edge_entries(edges, at_edge, samples, cutter)
                judged[cutter] = JudgedCutter(verdicts, which, mine if other_setups else verdicts, entry, fillets)
        moved = travels(ready.options, samples, {cutter: each.here for cutter, each in judged.items()})
        return cls(ready, judged, other_setups, moved, searched, started, carried, unexplained, explain)

    def explained(self) -> "JudgedPart":
        """Find the reasons and witnesses that are still to be found."""
        return self if self.explain is None else self.explain()

    def reasoned(self, operations: Operations | None) -> Operations | None:
        """Say of plans of operations why samples are left: the reasons of the first cutter."""
        if operations is None:
            return None
        return with_reasons(operations, self.cutters[operations.cutters[0]].verdicts.reason, self.ready.finished)

    @cached_property
    def grounds(self) -> list[bytes]:
        """Checksums of the grounds of all setups, and of what no cutter has to reach; none where nothing is kept."""
        ready = self.ready
        if ready.cache is NO_CACHE:
            return []
        each = [GroundDigests().of(ready.there(k)) for k in range(len(ready.setups))]
        return [*each, ready.not_required.tobytes(), ready.samples.area.tobytes()]

    @property
    def here(self) -> dict[Cutter, Verdicts]:
        """The verdicts in the first setup by cutter."""
        return {cutter: each.here for cutter, each in self.cutters.items()}

    def everywhere(self) -> list[Mapping[Cutter, Verdicts]]:
        """The verdicts by cutter in each setup, the first one first."""
        return [self.here, *self.other_setups]

    def over_setups(self) -> OverSetups:
        """The verdicts of all cutters by their ids, over all setups and in each."""
        by_id = {cutter.id: each for cutter, each in self.cutters.items()}
        reaches, served_in = ({name: getattr(each, word) for name, each in by_id.items()} for word in ("verdicts", "which"))
        each = ({cutter.id: verdicts for cutter, verdicts in there.items()} for there in self.everywhere())
        return OverSetups(reaches, served_in, tuple(zip((axis for axis, _ in self.ready.axes), each, strict=True)))

    @property
    def looks_between(self) -> bool:
        """Whether something is to be proved between the samples: it was requested, and a cutter reaches all that was judged."""
        return self._best is not None and bool(self.ready.options.contacts_between(len(self.ready.samples)))

    @property
    def _best(self) -> Cutter | None:
        """The cutter chosen; where obstacles are missing, none is, but one may reach all that could be judged."""
        ready, entries = self.ready, [self.cutters[c].entry for c in self.ready.cutters]
        best = selection(entries, ready.chosen.free_form)[0] or next((e.id for e in entries if not e.not_reached), None)
        return next((c for c in ready.cutters if c.id == best), None)

    def between(self, clock: Clock, compiling: Callable[[str], None]) -> dict[str, AreaEntry]:
        """Prove what can be proved between the samples, by cutter id: of the best one; empty where nothing is to be."""
        ready, cutter = self.ready, self._best
        if cutter is None or not self.looks_between:
            return {}
        with clock.stage("area") as tell:
            compiling("cover.cover")
            most = np.inf
            if ready.options.area_budget is None:
                triangles = len(ready.conditions.obstacles.triangles)
                made = _TRIANGLE * triangles + _SAMPLE * len(ready.samples)
                most = _WORK_LEAST / max(1.0, triangles / _FEW) + _WORK_SHARE * (self.searched.looked + made)
                most *= EFFORT[ready.options.effort]
            budget = ready.options.contacts_between(len(ready.samples))
            judged = self.cutters[cutter]
            return {cutter.id: ready.cache.cached(
                "area",
                (self.grounds, ready.scene.part.key, replace(cutter, name=""), judged.verdicts, judged.which, budget, most),
                partial(_area, ready, cutter, judged, budget, most, tell),
            )}  # fmt: skip


#: Adds to a plan how its setups came about.
Describe = Callable[[Plan], Plan]
Described = tuple[JudgedPart, Describe]


def assembled(part: JudgedPart, clock: Clock, answers: Answers, between: Mapping[str, AreaEntry]) -> Result:
    """Put the result together: the choice, the area between the samples, what was answered, the plan, without its text.

    `clock`: its seconds are those of the plan.
    `answers`: as far as there are any.
    `between`: of `JudgedPart.between`; empty where that was not looked at.
    """
    ready, judged = part.ready, part.cutters
    within = [within_limits(ready.samples, ready.cutters, conditions) & ready.finished for conditions in ready.setups]
    beyond = ready.somewhere & ~np.logical_or.reduce(within)
    over = part.over_setups()
    entries = completed([judged[c].entry for c in ready.cutters], ready, answers, over, beyond, part.travels, between)
    selected, chosen = selection(entries, ready.chosen.free_form)
    with clock.stage("plan", shown=False):
        shown = selected or nearest(entries).id
        tool, its = next((cutter, each) for cutter, each in judged.items() if cutter.id == shown)
        radii, table = inside_radius_entries(ready, tool, its.verdicts), setup_table(ready, within, over)
        equal = pattern_entries(ready.patterns, part.carried)
        document = plan_of(ready, entries, selected, chosen, part.started, answers, over, table, its.strips, radii, equal,
                           partial(_fitting, part))  # fmt: skip
        plans = answers.operations.plans if answers.operations is not None else ()
        for each in plans if ready.options.process is None else ():
            if each.name == document.process.plan and np.isfinite(each.total):
                process = document.process.model_copy(update={"chamfers": chamfer_mill(ready, each)})
                document = document.model_copy(update={"process": process})
        if ready.holes:
            done = np.logical_or.reduce([each.reached for each in over.reaches.values()])
            made = drilled(ready, done, sorted({step.setup for step in document.process.steps}))
            process = with_drilling(document.process, ready, made, index_times)
            process = process.model_copy(update={"hole_setup": further_setup(ready, made, partial(one_more_setup, ready))})
            document = document.model_copy(update={"holes": hole_entries(ready, made), "process": process})
    return Result(document, ready, over, part.travels, answers)


def with_maps(result: Result, part: JudgedPart, clock: Clock, compiling: Callable[[str], None]) -> Result:
    """Add the posture maps of the cutter shown, whatever the machine."""
    ready = part.ready
    with clock.stage("maps") as tell:
        compiling("free_map.free_map")
        cutter = next(c for c in ready.cutters if c.id == result.shown)
        verdicts = part.cutters[cutter].here
        if ready.conditions.machine.limited:
            verdicts = judge(replace(ready, conditions=ready.conditions.without_machine()), cutter)
        maps = posture_maps(
            ready.samples, Context.of(cutter, ready.conditions), verdicts, part=ready.scene.part.sha256 or "", progress=tell,
            inside=ready.inside_bodies, shut=(ready.shut >= 0) | ready.for_drills,
            missing=tuple(ready.conditions.surroundings.doubts), most=ready.options.map_budget,
        )  # fmt: skip
    document = result.plan
    if maps.unmapped:
        document = noted(document, note("maps_partial", unmapped=maps.unmapped, judged=int((maps.verdict != UNJUDGED).sum())))
    return replace(result, plan=document, maps=maps)


def worded(result: Result, clock: Clock) -> Result:
    """The result with the text of its plan, once that has all else, and with the seconds so far."""
    with clock.stage("plan", shown=False):
        document = with_text(result.plan)
    return replace(result, plan=clock.stamp(document))


def _inside_edges(ready: Prepared) -> tuple[InsideEdge, ...]:
    """The sharp inside edges of the part, which no cutter or setup changes."""
    part, orientation, doubles = ready.scene.part, ready.scene.orientation, ready.scene.doubles
    key = (part.key, orientation.sign, doubles)
    return ready.cache.cached("inside_edges", key, lambda: inside_edges(part, orientation, doubles))


def _fitting(part: JudgedPart, cutter: Cutter, rows: NDArray[np.int64], area: Floats) -> tuple[Fit, ...] | None:
    ready = part.ready
    follows_from = part.grounds, ready.scene.part.key, replace(cutter, name=""), rows, area[rows]
    # A name says whether it was given in inches.
    inches = notation(cutter.name).inches
    return ready.cache.cached("fits", (*follows_from, inches), partial(fitting, ready, cutter, rows, area))


def _area(ready: Prepared, cutter: Cutter, judged: JudgedCutter, budget: int, most: float, tell: Progress) -> AreaEntry:
    """What is proved between the samples, with so many contacts and so much work."""
    # Where all setups hold the part alike, what is free in one of them is free in all.
    contexts = [Context.of(cutter, each) for each in (ready.setups[:1] if ready.alike else ready.setups)]
    which = np.minimum(judged.which, len(contexts) - 1)
    served = in_each(ready.samples, judged.verdicts, which, contexts, ready.scene.part, ready.scene.orientation,
                     budget=budget, most=most, covered_samples=ready.not_required, progress=tell)  # fmt: skip
    return filled(AreaEntry, served, left_out=[f"F{n}" for n in served.unknown])
