"""The order of the stages: part in, plan out. Nothing else knows it."""

import datetime
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Unpack

import numpy as np

from cad_io import Part, read_part
from cad_io.arrays import Ints
from cad_io.copies import SideProcess
from cad_io.part.inside_edges import inside_edges
from cad_io.read.read import TIMEOUT
from cad_io.tessellate.triangles import At
from plan_cutters.answers.ask import ask
from plan_cutters.document.build import cutter_entry
from plan_cutters.document.clock import Clock, Progress
from plan_cutters.document.inside_radii import inside_radius_entries
from plan_cutters.document.notes import noted
from plan_cutters.document.operations_entry import with_motion
from plan_cutters.document.over_setups import OtherSetup, OverSetups
from plan_cutters.document.plan import completed, plan_of, selection
from plan_cutters.document.setup_table import setup_table
from plan_cutters.document.sharp_edges import sharp_edge_entries
from plan_cutters.domain.answers import Answers
from plan_cutters.domain.checks import shown
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.nesting import handed, order
from plan_cutters.domain.over_setups import over_setups
from plan_cutters.domain.preference import wanted
from plan_cutters.domain.signatures import spelled_out
from plan_cutters.domain.verdicts import CONVEX, UNJUDGED, Verdicts
from plan_cutters.errors import OptionError, UnjudgeableError
from plan_cutters.option_types import PlanOptions
from plan_cutters.options import Options
from plan_cutters.plan_file.model import AreaEntry, CutterEntry
from plan_cutters.plan_file.nearest import nearest
from plan_cutters.plan_file.notes import maps_partial
from plan_cutters.plan_file.sharp_edges import SharpEdgeEntry
from plan_cutters.plan_file.words.text import with_text
from plan_cutters.proposal import plan_proposed
from plan_cutters.result import Result
from plan_cutters.scene.conditions import Context, contacts_of, warm
from plan_cutters.scene.faces import choose
from plan_cutters.scene.inside_material import inside_bodies, inside_material
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.question import question
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.setups import conditions_of, for_another_setup, places, with_setups
from plan_cutters.scene.spacing import affordable, sampled
from plan_cutters.scene.threads import part_of
from plan_cutters.scene.work import Work
from plan_cutters.stages.between import in_each
from plan_cutters.stages.classify import classify, regions
from plan_cutters.stages.decompose import march_differs
from plan_cutters.stages.judge import Judge, judge
from plan_cutters.stages.other_setups import in_setup
from plan_cutters.stages.posture_maps import posture_maps
from plan_cutters.stages.reasons import Reasons
from plan_cutters.stages.setups import within_limits
from plan_cutters.stages.sharp_edges import exempt, may_be_at_edge, strips, with_sharp_edges
from plan_cutters.stages.travel import travels
from plan_cutters.stages.witness import witnesses

#: The work between samples, as a share of that of the searches, and so much of it in any case and for each sample: boxes.
_WORK_SHARE, _WORK_LEAST, _WORK_SAMPLE = 0.5, 2e7, 2000.0
#: Faces from which on they are sampled in a copy of the process, and the processor time that it may take, s.
_MANY_FACES, _SAMPLING = 12, 60.0


@spelled_out(PlanOptions, Options)
def plan(part: Any, *, progress: Progress | None = None, judged: Judge = judge, **options: Unpack[PlanOptions]) -> Result:
    """Judge each cutter on the target faces of a part.

    Parameters
    ----------
    part : Part, Scene, path, TopoDS_Shape, CadQuery or build123d object, or a list of shapes
        An object that holds picked faces stands for the shape that they belong to. A Scene brings its setup, flip, ignored
        faces and tolerance with it.
    progress : callable, optional
        Called with the stage, the number of pieces done, and the number of all pieces.
    judged : callable, optional
        Gives the verdicts of each cutter as `stages.judge.judge` does: `plan_cutters.plan` has `client` and `verdicts` for it.
    **options
        Every attribute of `Options`, by its name: `cutters="R6L80"`, `grid=201`, `machine="tilt:60"`; angles in degrees, too:
        `tilt_deg=(0, 60)`.

    Returns
    -------
    Result

    Raises
    ------
    CadIoError
        The part cannot be read or holds no surface to judge.
    PlanError
        An option has no meaning.

    Notes
    -----
    Measuring and sampling have no time limit here: a face on which the CAD kernel never ends keeps this call waiting, and a
    crash of the kernel ends the process. The command bounds both (`docs/kernel_calls.md`).

    Examples
    --------
    >>> result = plan("samples/v_groove.step", cutters=["R6L80", "R2L30"], grid=9, area_budget=0)
    >>> result.selected
    'R6L80'
    """
    if progress is not None and not callable(progress):
        raise OptionError(f"progress must be a function of (stage, done, total), not {shown(progress)}")
    settings = {**part.options, **options} if isinstance(part, Scene) else options
    return run(part, Options.of(settings), Clock(progress), judged=judged)


def run(
    part: Any, options: Options, clock: Clock, *, read_timeout: float = TIMEOUT, at: At = lambda whose, face: None,
    compiling: Callable[[str], None] = lambda entry: None, excluded: Mapping[int, str] | None = None, judged: Judge = judge,
) -> Result:  # fmt: skip
    """`plan` with its options gathered.

    `read_timeout` is the most seconds that a faulty file may take to read; `at` is told whose work goes on at which face;
    `compiling` waits for the machine code of an entry that is made meanwhile; `excluded` says by number why faces are not
    to be worked on at all; `judged` gives the verdicts of each cutter in each setup, as `judge` does.
    """
    if options.propose:
        again = partial(run, read_timeout=read_timeout, at=at, compiling=compiling, judged=judged)
        return plan_proposed(
            partial(prepare, part, read_timeout=read_timeout, at=at, compiling=compiling, excluded=excluded),
            again,
            options,
            clock,
        )
    started = datetime.datetime.now(datetime.UTC)
    ready = prepare(part, options, clock, read_timeout=read_timeout, at=at, compiling=compiling, excluded=excluded)
    here: dict[Cutter, Verdicts] = {}
    seconds: dict[Cutter, float] = {}
    searched = Work()
    for cutter in order(ready.cutters):
        with clock.stage(cutter.id) as tell:
            # In the order of rank, whatever the order of work.
            earlier = {c: here[c] for c in ready.cutters if c in here}
            began = time.perf_counter()
            here[cutter] = judged(ready, cutter, known=handed(cutter, earlier, len(ready.samples)), progress=tell, work=searched)
            seconds[cutter] = time.perf_counter() - began
    others = [(axis, _in_other_setup(ready, here, k, clock, judged)) for k, axis in enumerate(options.other_setups, 1)]
    ready, reported = _judged(ready, here, others, seconds, clock)
    first = {cutter: each.here for cutter, each in reported.items()}
    answers = ask(ready, first, clock.stage, others)
    if options.operations is not None:
        from plan_cutters.operations.planning import plan_operations

        everywhere = [first, *({c: verdicts_there[c.id] for c in reported} for _, verdicts_there in others)]
        answers = replace(answers, operations=plan_operations(ready, everywhere, answers.least_set, clock.stage))
    result = assemble(ready, reported, clock, started, answers, others, searched, compiling)
    if not options.posture_maps:
        return result
    with clock.stage("maps") as tell:
        compiling("free_map.free_map")
        cutter = next(c for c in ready.cutters if c.id == result.shown)
        verdicts = reported[cutter].here
        if ready.conditions.machine.limited:
            verdicts = judge(replace(ready, conditions=ready.conditions.without_machine()), cutter)
        maps = posture_maps(
            ready.samples, Context.of(cutter, ready.conditions), verdicts, part=ready.scene.part.fingerprint, progress=tell,
            inside=ready.inside_bodies, shut=ready.shut >= 0, about=question(ready, cutter), most=options.map_budget,
        )  # fmt: skip
    document = result.plan
    if maps.unmapped:
        document = noted(document, maps_partial(maps.unmapped, int((maps.verdict != UNJUDGED).sum())))
    if document.operations is not None:
        from plan_cutters.operations.motion import motion

        with clock.stage("motion"):
            moved = motion(maps, ready)
        document = document.model_copy(update={"operations": with_motion(document.operations, moved)})
    return replace(result, plan=clock.stamp(with_text(document)), maps=maps)


def _in_other_setup(
    ready: Prepared, here: Mapping[Cutter, Verdicts], setup: int, clock: Clock, judged: Judge
) -> dict[str, Verdicts]:
    """Find the verdicts of each cutter in another setup."""
    by_cutter = {}
    for cutter, verdicts in here.items():
        with clock.stage("setups") as tell:
            by_cutter[cutter.id] = in_setup(ready, cutter, setup, verdicts, progress=tell, judged=judged)
    return by_cutter


def prepare(
    part: Any,
    options: Options,
    clock: Clock | None = None,
    *,
    read_timeout: float = TIMEOUT,
    at: At = lambda whose, face: None,
    compiling: Callable[[str], None] = lambda entry: None,
    excluded: Mapping[int, str] | None = None,
) -> Prepared:
    """Read, sample, classify and surround with obstacles; arguments as for `run`."""
    if options.propose:
        raise OptionError("setup auto is for a whole plan: name the setup")
    clock = clock or Clock()
    with clock.stage("read"):
        stands = _read(part, options, read_timeout)
        if excluded and isinstance(stands, Part):
            stands = stands.without(excluded)
    whole = stands.part if isinstance(stands, Scene) else stands
    with clock.stage("measure"):
        whole.measured(partial(at, "kernel"))
    with clock.stage("sew"):
        _ = whole.sewn
    with clock.stage("orient"):
        scene = Scene.of(
            stands,
            setup=options.setup,
            flip=options.flip,
            tolerance=options.tolerance,
            ignore=options.ignore,
            fixtures=options.fixtures,
        )
    if scene.fixtures:
        with clock.stage("fixtures"):
            scene.read_fixtures(read_timeout)
    with clock.stage("sample"):
        first, *others = places(options)
        chosen = choose(whole, options.faces, scene.ignored, scene.ignore, first, others)
        cutters = tuple(wanted(options.judged, free_form=chosen.free_form))
        affordable(whole, chosen.targets, options)
        job = partial(sampled, whole, scene.orientation, options, chosen.targets, cutters)
    # Sampling and meshing need nothing of each other.
    with SideProcess(job, _SAMPLING, worth=options.jobs > 1 and len(chosen.targets) >= _MANY_FACES) as side:
        with clock.stage("tessellate"):
            surroundings = scene.surround(at, jobs=options.jobs)
        with clock.stage("sample"):
            samples, spacing, coarser = side.result(partial(job, at=partial(at, "kernel")))
    with clock.stage("classify"):
        surface_class = classify(samples, float(np.linalg.norm(whole.size)))
        region = regions(samples, surface_class)
    if not (samples.unjudged < 0).any():
        causes = {reason for _, reason in samples.empty} | set(samples.reasons)
        raise UnjudgeableError(f"no target face can be judged: {'; '.join(sorted(causes)) or 'no samples'}", file=whole.file)
    with clock.stage("tree"):
        conditions, *_ = each = conditions_of(scene, options)
        for one in each:
            one.surroundings.build(options.jobs)
    with clock.stage("compile"):
        compiling("search.search.search_rows")
        warm(contacts_of(samples), Context.of(cutters[0], conditions))
    with clock.stage("bodies"):
        within = inside_material(
            samples, scene.orientation, surroundings.enclosing, surroundings.certain, conditions.tolerance, options.jobs
        )
        inside = inside_bodies(within, surroundings.bodies, scene.orientation)
        ready = with_setups(
            Prepared(
                scene, options, chosen, spacing, samples, surface_class, region, within, inside, conditions, cutters, coarser
            ),
            each,
        )
    if not ready.finished.any():
        raise UnjudgeableError(
            "every target sample lies inside another body of the part, so there is no surface to finish: leave a body out with "
            "--ignore, or choose other faces with --faces",
            file=whole.file,
        )
    return ready


def _read(part: Any, options: Options, timeout: float) -> Part | Scene:
    read = part.part if isinstance(part, Scene) else part
    if isinstance(read, Part) and options.unit is not None:
        raise OptionError("the part has been read already: give the unit to read_part", file=read.file)
    if isinstance(part, Part | Scene):
        return part
    return read_part(part, unit=options.unit, timeout=timeout)


@dataclass(frozen=True, slots=True)
class Judged:
    """The verdicts of one cutter, over all setups and in the first one, with its line in the plan.

    Attributes
    ----------
    verdicts : Verdicts
        Over all setups, with the reasons that can be acted on.
    which : (n,) int32
        The setup that serves each sample, -1 for none.
    here : Verdicts
        In the first setup alone; the same where there is no other one.
    entry : CutterEntry
        Its line in the plan.
    strips : list of SharpEdgeEntry
        Sharp inside edges at which it leaves a fillet.
    """

    verdicts: Verdicts
    which: Ints
    here: Verdicts
    entry: CutterEntry
    strips: list[SharpEdgeEntry]


def _judged(
    ready: Prepared,
    here: Mapping[Cutter, Verdicts],
    other_setups: Sequence[OtherSetup],
    seconds: Mapping[Cutter, float],
    clock: Clock,
) -> tuple[Prepared, dict[Cutter, Judged]]:
    """Combine the verdicts of each cutter over all setups, find the reasons and what is not required, and make its line."""
    samples, convex, surroundings = ready.samples, ready.surface_class == CONVEX, ready.conditions.surroundings
    reasons = Reasons(samples, ready.setups, ready.somewhere, ready.machinable)
    by_cutter = {}
    with clock.stage("reasons") as tell:
        for k, (cutter, mine) in enumerate(here.items()):
            over, which = over_setups([mine, *(verdicts_there[cutter.id] for _, verdicts_there in other_setups)])
            by_cutter[cutter] = reasons.of(cutter, over, part_of(tell, k, len(here))), which
        wanted = any(may_be_at_edge(explained.verdicts, cutter) for cutter, (explained, _) in by_cutter.items())
        edges = inside_edges(ready.scene.part, ready.scene.orientation) if wanted else ()
    at_edges = {cutter: strips(samples, explained.verdicts, cutter, edges) for cutter, (explained, _) in by_cutter.items()}
    reaches = {c: for_another_setup(ready, with_sharp_edges(by_cutter[c][0].verdicts, each)) for c, each in at_edges.items()}
    ready = replace(ready, exempt=exempt(reaches, ready.inside_bodies) if ready.options.sharp_edges == "left" else None)
    judged = {}
    for (cutter, mine), (explained, which) in zip(here.items(), by_cutter.values(), strict=True):
        at_edge, verdicts = at_edges[cutter], reaches[cutter]
        with clock.stage(cutter.id, shown=False):
            context, part = Context.of(cutter, ready.conditions), ready.scene.part
            witness_list = witnesses(samples, verdicts, context, inside=ready.shut, part=part)
            marched = march_differs(samples, convex, ready.region, mine.interference_free)
            entry = cutter_entry(
                cutter, samples, verdicts, witness_list, marched, seconds[cutter], part=part, surroundings=surroundings,
                slack=context.outer_tool.slack, inside=ready.inside_bodies, exempt=ready.exempt, besides=explained.besides,
            )  # fmt: skip
            fillets = sharp_edge_entries(edges, at_edge, samples, cutter)
            judged[cutter] = Judged(verdicts, which, mine if other_setups else verdicts, entry, fillets)
    return ready, judged


def assemble(
    ready: Prepared,
    judged: Mapping[Cutter, Judged],
    clock: Clock | None = None,
    started: datetime.datetime | None = None,
    answers: Answers | None = None,
    other_setups: Sequence[OtherSetup] = (),
    searched: Work | None = None,
    compiling: Callable[[str], None] = lambda entry: None,
) -> Result:
    """The result of all cutters: the choice, the area between the samples for the one chosen, what was answered, the plan.

    `searched`: the work of all searches, which bounds that between the samples unless a budget was requested.
    """
    clock, answers = clock or Clock(), answers or Answers()
    within = [within_limits(ready.samples, ready.cutters, conditions) & ready.finished for conditions in ready.setups]
    beyond = ready.somewhere & ~np.logical_or.reduce(within)
    moved = travels(ready.options, ready.samples, {cutter: each.here for cutter, each in judged.items()})
    over = _over_setups(ready, judged, other_setups)
    entries = completed([judged[c].entry for c in ready.cutters], ready, answers, over, beyond, moved)
    selected, chosen = selection(entries, ready.chosen.free_form)
    # Where obstacles are missing, none is selected, but one may reach all that could be judged.
    best = selected or next((e.id for e in entries if not e.not_reached), None)
    if best and (budget := ready.options.contacts_between(len(ready.samples))):
        with clock.stage("area"):
            compiling("cover.cover")
            cutter = next(c for c in ready.cutters if c.id == best)
            most = np.inf
            if searched is not None and ready.options.area_budget is None:
                most = _WORK_LEAST + _WORK_SHARE * searched.looked + _WORK_SAMPLE * len(ready.samples)
            area = _area(ready, cutter, judged[cutter], budget, most)
        entries = [e.model_copy(update={"area": area, "seen": e.seen or area.feasible}) if e.id == best else e for e in entries]
    with clock.stage("plan", shown=False):
        began = started or datetime.datetime.now(datetime.UTC)
        shown = selected or nearest(entries).id
        tool, its = next((cutter, each) for cutter, each in judged.items() if cutter.id == shown)
        radii, table = inside_radius_entries(ready, tool, its.verdicts), setup_table(ready, within, over)
        document = plan_of(ready, entries, selected, chosen, began, answers, over, table, its.strips, radii)
    return Result(clock.stamp(with_text(document)), ready, over, moved, answers)


def _over_setups(ready: Prepared, judged: Mapping[Cutter, Judged], others: Sequence[OtherSetup]) -> OverSetups:
    reaches = {cutter.id: each.verdicts for cutter, each in judged.items()}
    here = {cutter.id: each.here for cutter, each in judged.items()}
    served_in = {cutter.id: each.which for cutter, each in judged.items()}
    return OverSetups(reaches, here, served_in, ready.scene.setup, tuple((axis, dict(each)) for axis, each in others))


def _area(ready: Prepared, cutter: Cutter, judged: Judged, budget: int, most: float) -> AreaEntry:
    """What is proved between the samples, with so many contacts and so much work."""
    # Where all setups hold the part alike, what is free in one of them is free in all.
    contexts = [Context.of(cutter, each) for each in (ready.setups[:1] if ready.alike else ready.setups)]
    which = np.minimum(judged.which, len(contexts) - 1)
    served = in_each(ready.samples, judged.verdicts, which, contexts, ready.scene.part, ready.scene.orientation,
                     budget=budget, most=most, covered_samples=ready.not_required)  # fmt: skip
    return AreaEntry(share=served.share, feasible=served.feasible, contacts=served.contacts, left=served.left,
                     short=served.short, dropped=served.dropped, left_out=[f"F{n}" for n in served.unknown])  # fmt: skip
