"""The order of the stages: part in, plan out. Nothing else knows it."""

import datetime
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from cad_io import Part, read_part
from cad_io.part.patterns import patterns
from cad_io.part.sew import SewnForm
from cad_io.read.read import TIMEOUT
from cad_io.tessellate.triangles import At
from plan_cutters.answers.ask import ask
from plan_cutters.answers.least_set import least_set
from plan_cutters.document.clock import Clock
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.preference import handed, order, wanted
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.errors import OptionError, UnjudgeableError
from plan_cutters.interim import Interim
from plan_cutters.judged_part import Describe, Described, ExplainedIn, JudgedPart, assembled, with_maps, worded
from plan_cutters.judging.judge import CachedJudge, FirstLook, Judge, JudgeOnce, in_setup, judge
from plan_cutters.judging.phases import classify, regions
from plan_cutters.option_table import OF_A_SCENE
from plan_cutters.options import Options
from plan_cutters.outcome import Answers, LeastSet, Operations
from plan_cutters.proposal import Stand, judged_proposed
from plan_cutters.result import Result
from plan_cutters.scene.conditions import Context, contacts_of, warm
from plan_cutters.scene.copied import with_copies
from plan_cutters.scene.faces import choose
from plan_cutters.scene.holes import with_holes
from plan_cutters.scene.inside_material import inside_bodies, inside_material
from plan_cutters.scene.preparation import (
    Prepared,
    affordable,
    conditions_of,
    fixtures_of,
    places,
    refuse_unholdable,
    sampled,
    spacing_key,
    with_setups,
)
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.work import Work, part_of
from plan_cutters_base.forks import Gauge, SideProcess
from plan_cutters_base.stage_cache import NO_CACHE, Cache, RunCache, StageCache

#: Faces from which on they are sampled in a copy of the process, and the processor time that it may take, s.
_MANY_FACES, _SAMPLING = 12, 60.0
#: Processor time after which a copy that plans the operations is given up, s.
_PLANNING = 7200.0
#: Operations, if they were requested, with the seconds and the boxes of each stage so far.
Planned = tuple[Operations | None, Mapping[str, float], Mapping[str, int]]


def run(
    part: Any, options: Options, clock: Clock, *, read_timeout: float = TIMEOUT, at: At = lambda whose, face: None,
    compiling: Callable[[str], None] = lambda entry: None, excluded: Mapping[int, str] | None = None,
    interim: Interim | None = None, folder: str = "", cache: StageCache | None = None,
    remark: Describe = lambda plan: plan,
) -> Result:  # fmt: skip
    """`calls.plan` with its options gathered.

    `read_timeout` is the most seconds that a faulty file may take to read; `at` is told whose work goes on at which face;
    `compiling` waits for the machine code of an entry that is made meanwhile; `excluded` says by number why faces are not
    to be worked on at all; `interim` keeps what is found, from the moment on at which the verdicts stand. `folder` is where
    files of setups that are proposed will be, as a command in it is to name them. `cache` keeps what stages make of a part of a
    file. `remark` adds to each plan what its options do not say.
    """
    judged: Judge = judge if cache is None else CachedJudge()
    made = RunCache(cache or NO_CACHE)
    stages = Run(clock, interim or Interim(clock), remark, folder, compiling, judged, read_timeout, at, excluded, made)
    return stages.plan(part, options)


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """A question on its way from a part to its plan: the order of its stages, and what goes with them. Attributes as of `run`."""

    clock: Clock
    interim: Interim
    remark: Describe
    folder: str
    compiling: Callable[[str], None]
    judged: Judge
    read_timeout: float
    at: At
    excluded: Mapping[int, str] | None
    cache: Cache

    def plan(self, part: Any, options: Options) -> Result:
        """Prepare the part, judge all cutters, and do what follows the verdicts; without a setup, propose some first."""
        if options.propose:
            return self.complete(*judged_proposed(self, part, options, self.folder, self.interim.verdicts))

        def stand(made: Callable[[], JudgedPart]) -> None:
            self.interim.verdicts(lambda: (made(), self.remark))

        return self.complete(self.judge(part, options, stand), self.remark)

    def prepare(self, part: Any, options: Options) -> Prepared:
        """Read, sample, classify and surround with obstacles."""
        return prepare(
            part, options, self.clock, read_timeout=self.read_timeout, at=self.at, compiling=self.compiling,
            excluded=self.excluded, cache=self.cache,
        )  # fmt: skip

    def looked(self, ready: Prepared, options: Options) -> None:
        """Let the first setup stand from a first look at it on, until its verdicts do; `options`: as they were requested."""
        started, alone = datetime.datetime.now(datetime.UTC), _first_setup(ready)
        carried = np.zeros((_motions(ready), 3), np.int64)

        def made(look: FirstLook) -> Described:
            few = None if look.samples == look.of else (look.samples, look.of)
            part = JudgedPart.of(look.ready, look.verdicts, [], dict.fromkeys(look.verdicts, 0.0), self.clock, Work(), started,
                                 carried, {}, explain=False)  # fmt: skip
            return replace(part, later=options.other_setups, few=few, proposing=options.propose), self.remark

        self.interim.prepared(alone, made)

    def judge(self, part: Any, options: Options, stand: Stand[JudgedPart]) -> JudgedPart:
        """Judge all cutters in all setups; `stand` is told how the part is made of the verdicts alone, once these stand
        in the first setup, and again once they stand in all.
        """
        started, clock = datetime.datetime.now(datetime.UTC), self.clock
        ready = self.prepare(part, options)
        self.looked(ready, options)
        here: dict[Cutter, Verdicts] = {}
        seconds: dict[Cutter, float] = {}
        once = JudgeOnce(self.judged, _motions(ready))
        searched = Work()
        for cutter in order(ready.cutters):
            with clock.stage(cutter.id) as tell:
                # In the order of rank, whatever the order of work.
                earlier = {c: here[c] for c in ready.cutters if c in here}
                began = time.perf_counter()
                here[cutter] = once(
                    ready, cutter, known=handed(cutter, earlier, len(ready.samples)), progress=tell, work=searched
                )
                seconds[cutter] = time.perf_counter() - began

        def combined(
            of: Prepared, others: list[dict[Cutter, Verdicts]], by_cutter: dict[Cutter, ExplainedIn], explain: bool
        ) -> JudgedPart:
            return JudgedPart.of(of, here, others, seconds, clock, searched, started, once.carried, by_cutter, explain=explain)

        if options.other_setups:
            first = _first_setup(ready)
            stand(lambda: replace(combined(first, [], {}, explain=False), later=options.other_setups))
        others = _in_other_setups(ready, here, clock, once) if options.other_setups else []
        reasons: dict[Cutter, ExplainedIn] = {}
        stand(lambda: combined(ready, others, dict(reasons), explain=False))
        explain = partial(combined, ready, others, reasons, explain=True)
        # What is left with a sharp edge is known by the reasons, and is not planned for.
        return (
            explain() if options.sharp_edges == "left" else replace(combined(ready, others, {}, explain=False), explain=explain)
        )

    def complete(self, part: JudgedPart, describe: Describe) -> Result:
        """Do what follows the verdicts, stage by stage; `describe` adds to each plan how its setups were found.

        The operations are planned beside the rest: neither needs the other, nor keeps all threads at work.
        """
        clock, interim, options = self.clock, self.interim, part.ready.options
        least, planned = least_set(part.ready, part.everywhere()), Gauge()
        with SideProcess(
            lambda: _operations(part, least, Clock(lambda _, *counts: planned.tell(*counts))), _PLANNING,
            worth=options.jobs > 1 and options.operations is not None and bool(options.answers),
        ) as side:  # fmt: skip
            judged = part.explained()
            interim.judged(judged, describe, Answers(least_set=least))
            interim.looked(judged.between(clock, self.compiling))
            try:
                ask(judged.ready, judged.everywhere(), clock.stage, searched=judged.searched.looked, least=least,
                    answered=interim.answered)  # fmt: skip
            except KeyboardInterrupt:
                if (planned_by_now := side.ended()) is not None:
                    interim.planned(judged.reasoned(planned_by_now[0]))
                raise
            interim.planned(judged.reasoned(self._planned(part, least, side, planned)))
        result = assembled(judged, clock, interim.answers, interim.between)
        if options.posture_maps:
            result = with_maps(result, judged, clock, self.compiling)
        return worded(replace(result, plan=describe(result.plan)), clock)

    def _planned(self, part: JudgedPart, least: LeastSet | None, side: SideProcess[Planned], gauge: Gauge) -> Operations | None:
        clock = self.clock
        if not side.works:
            return _operations(part, least, clock)[0]
        with clock.stage("operations") as tell:
            operations, seconds, boxes = side.result(
                lambda: _operations(part, least, Clock(clock.progress)), waiting=lambda: tell(*gauge.counts)
            )
        clock.seconds |= seconds
        clock.boxes |= boxes
        return operations


def _motions(ready: Prepared) -> int:
    return sum(len(each.motions) for each in ready.patterns if each.whole)


def _first_setup(ready: Prepared) -> Prepared:
    """The first setup alone; steps of the planner's own may be in the others."""
    return replace(ready.alone(0), options=replace(ready.options, other_setups=(), other_placements=(), process=None))


def _operations(part: JudgedPart, least: LeastSet | None, clock: Clock) -> Planned:
    """Plan the operations, if that was requested; with the seconds and the boxes of each stage so far."""
    if part.ready.options.operations is None:
        return None, {}, {}
    from plan_cutters.operations.planning import plan_operations

    operations = plan_operations(part.ready, part.everywhere(), least, clock.stage, part.searched.looked)
    return operations, clock.seconds, clock.boxes


def _in_other_setups(
    ready: Prepared, here: Mapping[Cutter, Verdicts], clock: Clock, judged: Judge
) -> list[dict[Cutter, Verdicts]]:
    number = len(ready.options.other_setups)
    with clock.stage("setups") as tell:
        done = partial(part_of, tell, parts=number * len(here))
        return [
            {
                cutter: in_setup(ready, cutter, k + 1, verdicts, progress=done(k * len(here) + n), judged=judged)
                for n, (cutter, verdicts) in enumerate(here.items())
            }
            for k in range(number)
        ]


def prepare(
    part: Any, options: Options, clock: Clock | None = None, *, read_timeout: float = TIMEOUT,
    at: At = lambda whose, face: None, compiling: Callable[[str], None] = lambda entry: None,
    excluded: Mapping[int, str] | None = None, cache: Cache = NO_CACHE,
) -> Prepared:  # fmt: skip
    """Read, sample, classify and surround with obstacles; arguments as for `run`."""
    if options.propose:
        raise OptionError("setup auto is for a whole plan: name the setup")
    clock, stages = clock or Clock(), cache
    with clock.stage("read"):
        read = part.part if isinstance(part, Scene) else part
        if isinstance(read, Part) and options.unit is not None:
            raise OptionError("the part has been read already: give the unit to read_part", file=read.file)
        stands = part
        if not isinstance(part, Part | Scene):
            stands = read_part(part, unit=options.unit, timeout=read_timeout, cache=cache)
        if excluded and isinstance(stands, Part):
            stands = stands.without(excluded)
    whole: Part = stands.part if isinstance(stands, Scene) else stands
    with clock.stage("measure"):
        whole.recall(**stages.cached("faces", whole.key, lambda: whole.facts(partial(at, "kernel"), jobs=options.jobs)))
    with clock.stage("sew"):
        if whole.solids:
            _ = whole.sewn  # faces that share edges with those of a solid cannot be taken from it
        else:
            whole.recall(
                sewn=stages.cached("sewn", whole.key, lambda: SewnForm.of(whole.sewn), lambda sewn: sewn.rest.stopped is None)
            )
        whole.recall(blends=stages.cached("blends", whole.key, lambda: whole.blends))
    with clock.stage("orient"):
        scene = Scene.of(stands, **{word: getattr(options, word) for word in OF_A_SCENE})
    refuse_unholdable(scene, options)
    if scene.fixtures:
        with clock.stage("fixtures"):
            scene.read_fixtures(read_timeout)
    with clock.stage("sample"):
        first, *others = places(options)
        chosen = choose(whole, options.faces, scene.ignored, scene.ignore, first, others, scene.repeated)
        if any(each.to_place for each in fixtures_of(options)):
            scene = scene.for_targets(chosen.targets)
        cutters = tuple(wanted(options.judged, free_form=chosen.free_form))
        if options.process is not None:
            options.process.check_faces(chosen.targets)
        affordable(whole, chosen.targets, options)
        job = partial(sampled, whole, scene.orientation, options, chosen.targets, cutters)
        of_samples = (whole.key, scene.orientation.sign, spacing_key(options, cutters), chosen.targets)
        many = options.jobs > 1 and len(chosen.targets) >= _MANY_FACES and not stages.holds("samples", of_samples)
    # Sampling and meshing need nothing of each other.
    with SideProcess(job, _SAMPLING, worth=many) as side:
        with clock.stage("tessellate"):
            surroundings = scene.surround(at, jobs=options.jobs, cache=stages)
        with clock.stage("sample"):
            samples, spacing, coarser = stages.cached(
                "samples", of_samples, lambda: side.result(partial(job, at=partial(at, "kernel")))
            )
    with clock.stage("classify"):
        surface_class = classify(samples, float(np.linalg.norm(whole.size)))
        region = regions(samples, surface_class)
    if not (samples.unjudged < 0).any():
        causes = {reason for _, reason in samples.empty} | set(samples.reasons)
        raise UnjudgeableError(f"no target face can be judged: {'; '.join(sorted(causes)) or 'no samples'}", file=whole.file)
    with clock.stage("tree"):
        conditions, *_ = each = conditions_of(scene, options)
        for one in each:
            one.surroundings.build(options.jobs, stages)
    with clock.stage("compile"):
        compiling("search.search.search_rows")
        warm(contacts_of(samples), Context.of(cutters[0], conditions))
    with clock.stage("bodies"):
        among = surroundings.enclosing, surroundings.certain, conditions.tolerance, options.jobs
        follows_from = (whole.key, scene.ignored, samples.point, samples.normal, scene.orientation.sign,
                        surroundings.certain.triangles.vertex, conditions.tolerance)  # fmt: skip
        within = stages.cached("bodies", follows_from, lambda: inside_material(samples, scene.orientation, *among))
        inside = inside_bodies(within, surroundings.bodies, scene.orientation)
        ready = Prepared(scene, options, chosen, spacing, samples, surface_class, region, within, inside, conditions, cutters,
                         coarser, cache=stages)  # fmt: skip
        ready = with_setups(ready, each)
    with clock.stage("holes", shown=False):
        ready = with_holes(ready)
    if options.patterns:
        with clock.stage("patterns"):
            doubles = scene.doubles
            key = (whole.key, doubles)
            equal = stages.cached("patterns", key, lambda: patterns(whole, partial(at, "kernel"), doubles))
            ready = with_copies(ready, equal)
    if not ready.finished.any():
        why = (
            "is in a hole for drills: give --drill-below 0 to mill it"
            if ready.for_drills.any()
            else "lies inside another body of the part, so there is no surface to finish: leave a body out with --ignore"
        )
        raise UnjudgeableError(f"every target sample {why}, or choose other faces with --faces", file=whole.file)
    return ready
