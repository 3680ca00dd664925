"""The order of the stages: part in, plan out. Nothing else knows it."""

import datetime
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cad_io import Part, SurfaceSamples, read_part
from cad_io.part.orient import orient
from cad_io.read.read import TIMEOUT
from cad_io.sample import sample
from cad_io.tessellate.triangles import At
from plan_cutters.document.build import (
    area_notes,
    cutter_entry,
    degrees,
    face_entries,
    missing_entries,
    notes,
    part_info,
    vector,
    versions,
)
from plan_cutters.document.model import (
    AreaEntry,
    CutterEntry,
    Effective,
    Plan,
    Run,
    SampleCounts,
    Selection,
)  # fmt: skip
from plan_cutters.document.palette import PALETTE
from plan_cutters.domain.checks import shown
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.nesting import handed, order
from plan_cutters.domain.posture import PostureRange, unit
from plan_cutters.domain.verdicts import REASONS, Reach, blank
from plan_cutters.errors import OptionError, UnjudgeableError
from plan_cutters.options import Options
from plan_cutters.result import Result
from plan_cutters.scene.buried import buried
from plan_cutters.scene.conditions import Conditions, contacts_of, found_of
from plan_cutters.scene.faces import choose
from plan_cutters.scene.obstacles import CHORD_ASKED, kept_tolerance
from plan_cutters.scene.spacing import default_spacing
from plan_cutters.scene.surroundings import surroundings
from plan_cutters.stages.access import access, witnesses
from plan_cutters.stages.between import between
from plan_cutters.stages.classify import CONCAVE, CONVEX, SADDLE, classify, regions
from plan_cutters.stages.decompose import decompose
from plan_cutters.stages.posture_maps import posture_maps as all_posture_maps
from plan_cutters.stages.select_cutters import RULE, ranked

#: Told the stage, how much of it is done, of how much.
Progress = Callable[[str, int, int], None]

#: Samples that a plan may take.
MOST_SAMPLES = 5_000_000


def plan(
    part: Any,
    *,
    cutters: Sequence[Cutter | str] | Cutter | str = (),
    machine: Machine | str | None = None,
    setup: tuple[float, float, float] = (0.0, 0.0, 1.0),
    faces: Any = None,
    ignore: Any = (),
    grid: int | None = None,
    spacing: float | None = None,
    tilt: tuple[float, float] = (0.0, np.pi / 2),
    rotation: tuple[float, float] = (0.0, 2 * np.pi),
    rotation_step: float = np.pi / 18,
    tolerance: float = 0.01,
    jobs: int | None = None,
    flip: bool = False,
    area_budget: int = 100_000,
    posture_maps: bool = False,
    unit: str | None = None,
    progress: Progress | None = None,
) -> Result:
    """Judge each cutter on the target faces of a part.

    Parameters
    ----------
    part : Part, path, TopoDS_Shape, CadQuery or build123d object, or a list of shapes
        An object that holds picked faces stands for the shape that they belong to.
    cutters : Cutter, str or sequence of these
        A text as `R6L80`. None given: the built-in flat ends.
    machine : Machine or str, optional
        A text as `tilt:60` (degrees). Default: no axis limit.
    setup : tuple of float
        Direction of the part along the machine's spindle at zero angles.
    faces : str or objects, optional
        Target faces: words as on the command line, numbers, or the faces themselves (a Workplane, a ShapeList, kernel
        faces). Default: the faces picked on the part's object; where none were, `sculptured`.
    ignore : str, list of str or objects
        Faces that are neither targets nor obstacles, in the same words.
    grid, spacing : int, float, optional
        N x N samples a face, or at most `spacing` mm apart; default from curvature, smallest cutter and a budget.
    tilt, rotation : tuple of float
        Posture range, rad.
    rotation_step : float
        rad.
    tolerance : float
        Gouge tolerance, mm.
    jobs : int, optional
        Threads; default all cores.
    flip : bool
        Machine the other side of open shells and loose faces.
    area_budget : int
        Most contacts to look at between the samples for the selected cutter; 0: none.
    posture_maps : bool
        Find every free tilt of every sample, too: `Result.maps`.
    unit : str, optional
        Length unit to take instead of the file's: `um`, `mm`, `cm`, `m`, `km`, `mil`, `in` or `ft`.
    progress : callable, optional
        Told (stage, done, total).

    Returns
    -------
    Result

    Raises
    ------
    CadIoError
        The part cannot be read or holds no surface to judge.
    PlanError
        An option has no meaning.
    """
    more = {} if jobs is None else {"jobs": jobs}
    if progress is not None and not callable(progress):
        raise OptionError(f"progress must be a function of (stage, done, total), not {shown(progress)}")
    options = Options(
        cutters=Cutter.each_of(cutters), machine=Machine.of(machine), setup=setup, faces=faces, ignore=ignore,
        grid=grid, spacing=spacing, postures=PostureRange(tilt, rotation, rotation_step), tolerance=tolerance, flip=flip,
        unit=unit, area_budget=area_budget, posture_maps=posture_maps, **more,
    )  # fmt: skip
    return run(part, options, progress=progress)


@dataclass
class _Clock:
    """Seconds by stage, and whom to tell."""

    progress: Progress | None
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[Callable[[int, int], None]]:
        def tell(done: int, total: int) -> None:
            if self.progress:
                self.progress(name, done, total)

        tell(0, 1)
        began = time.perf_counter()
        yield tell
        self.seconds[name] = time.perf_counter() - began
        tell(1, 1)


def run(
    part: Any, options: Options, *, progress: Progress | None = None, read_timeout: float = TIMEOUT,
    at: At = lambda whose, face: None,
) -> Result:  # fmt: skip
    """`plan` with its options gathered.

    `read_timeout` is the most seconds that a faulty file may take to read; `at` is told whose work goes on at which face.
    """
    clock = _Clock(progress)
    started = datetime.datetime.now(datetime.UTC)
    with clock.stage("read"):
        if isinstance(part, Part) and options.unit is not None:
            raise OptionError("the part has been read already: give the unit to read_part", file=part.file)
        whole = part if isinstance(part, Part) else read_part(part, unit=options.unit, timeout=read_timeout)
    chosen_faces = choose(whole, options.faces, options.ignore)
    targets = chosen_faces.targets
    setup = unit(options.setup, "setup axis")
    cutters = ranked(options.judged)
    with clock.stage("sample"):
        orientation = orient(whole, towards=options.setup, flip=options.flip)
        spacing: float | dict[int, float] | None = options.spacing
        if options.grid is None and options.spacing is None:
            spacing = default_spacing(whole, orientation, targets, cutters)
        _affordable(whole, targets, options)
        samples = sample(whole, orientation, grid=options.grid, spacing=spacing, faces=targets)
        surface_class = classify(samples, float(np.linalg.norm(whole.size)))
        region = regions(samples, surface_class)
    if not (samples.unjudged < 0).any():
        causes = {reason for _, reason in samples.empty} | set(samples.reasons)
        raise UnjudgeableError(
            f"no target face can be judged: {'; '.join(sorted(causes)) or 'no samples'}", file=whole.file
        )
    with clock.stage("tessellate"):
        around = surroundings(whole, CHORD_ASKED * options.tolerance, ignored=chosen_faces.ignored, at=at)
        triangles = around.surely.triangles
        tolerance = kept_tolerance(options.tolerance, triangles.chord_error)
    with clock.stage("compile"):
        conditions = Conditions(options.machine, setup, options.postures, around, tolerance, options.jobs)
        _warm(samples, cutters[0], conditions)
    with clock.stage("bodies"):
        within = buried(samples, orientation, around.bodies, around.surely, tolerance)
    missing = missing_entries(whole, around)
    by_id: dict[str, CutterEntry] = {}
    reaches: dict[str, Reach] = {}
    for cutter in order(cutters):
        with clock.stage(cutter.id) as tell:
            began = time.perf_counter()
            decomposition = decompose(samples, surface_class == CONVEX, region, cutter, conditions, buried=within)
            known = handed(cutter, {c: reaches[c.id] for c in cutters if c.id in reaches}, len(samples))
            reach = access(samples, decomposition.free, cutter, conditions, buried=within, known=known, progress=tell)
            seconds = time.perf_counter() - began
            found = witnesses(samples, reach, cutter, conditions, buried=within)
        reaches[cutter.id] = reach
        by_id[cutter.id] = cutter_entry(
            cutter, samples, reach, found, decomposition.march_differs, seconds, doubtful=bool(missing)
        )
    entries = [by_id[c.id] for c in cutters]
    selected, selection = _select(entries)
    # Where obstacles are missing, none is selected, but one may reach all that could be judged.
    best = selected or next((e.id for e in entries if not (e.inaccessible or e.undecided)), None)
    if best and options.area_budget:
        with clock.stage("area"):
            chosen = next(c for c in cutters if c.id == best)
            served = between(samples, reaches[best], chosen, whole, orientation, conditions,
                             budget=options.area_budget)  # fmt: skip
        area = AreaEntry(share=served.share, feasible=served.feasible, contacts=served.contacts, left=served.left,
                         short=served.short, left_out=[f"F{n}" for n in served.unknown])  # fmt: skip
        entries = [e.model_copy(update={"area": area}) if e.id == best else e for e in entries]
    document = Plan(
        part=part_info(whole, orientation, around),
        effective=Effective(
            cutters=[c.id for c in cutters],
            cutter_source="given" if options.cutters else "built-in",
            unit=options.unit,
            machine=options.machine.name,
            setup=vector(setup),
            faces=chosen_faces.asked,
            ignore=list(chosen_faces.ignore),
            target_faces=[f"F{n}" for n in targets],
            grid=options.grid,
            spacing_mm=max(spacing.values()) if isinstance(spacing, dict) else spacing,
            tilt_deg=degrees(options.postures.tilt),
            rotation_deg=degrees(options.postures.rotation),
            rotation_step_deg=float(np.degrees(options.postures.step)),
            tolerance_mm=tolerance,
            chord_error_mm=triangles.chord_error,
            obstacle_triangles=len(around.may_be.triangles),
            flip=options.flip,
            area_budget=options.area_budget,
            posture_maps=options.posture_maps,
        ),
        versions=versions(),
        samples=SampleCounts(
            count=len(samples),
            max_gap_mm=samples.max_gap,
            convex=int((surface_class == CONVEX).sum()),
            concave=int((surface_class == CONCAVE).sum()),
            saddle=int((surface_class == SADDLE).sum()),
            unjudged=int((samples.unjudged >= 0).sum()),
            regions=len(np.unique(region)),
        ),
        faces=face_entries(whole, samples, chosen_faces),
        missing=missing,
        reasons=list(REASONS),
        cutters=entries,
        selected=selected,
        selection=selection,
        notes=[
            *notes(whole, orientation, options, tolerance, samples, around),
            *chosen_faces.notes,
            *area_notes(entries, doubtful=bool(missing)),
        ],
        legend=PALETTE,
        run=Run(time=started.isoformat(timespec="seconds"), seconds=clock.seconds),
    )
    result = Result(document, whole, samples, surface_class, reaches, options.postures)
    if options.posture_maps:
        with clock.stage("maps") as tell:
            shown = next(c for c in cutters if c.id == result.shown)
            result = replace(result, maps=all_posture_maps(samples, shown, conditions, progress=tell))
    return result


def _affordable(part: Part, targets: Sequence[int], options: Options) -> None:
    """Refuse to sample more than memory holds, before it is tried."""
    wanted = 0.0
    if options.grid is not None:
        wanted = len(targets) * float(options.grid) ** 2
    elif options.spacing is not None:
        wanted = sum(part.faces[n - 1].area for n in targets) / options.spacing**2
    if wanted > MOST_SAMPLES:
        raise OptionError(
            f"that would take about {wanted:.2g} samples, at most {MOST_SAMPLES:.0e} are taken: sample more coarsely, "
            "or choose faces with --faces",
            file=part.file,
        )


def _warm(samples: SurfaceSamples, cutter: Cutter, conditions: Conditions) -> None:
    """Build the tree and load or compile every kernel, so that stage times are those of the work."""
    from plan_cutters.kernels import search

    none, contacts, found = np.zeros(0, np.int64), contacts_of(samples), found_of(blank(0))
    search.dummy_free(none, contacts, cutter.radius, cutter.length, conditions.tolerance,
                      conditions.obstacles.solids, np.zeros(0, bool))  # fmt: skip
    search.search(none, contacts, conditions.ranges, cutter.radius, cutter.length, *conditions.depths,
                  conditions.obstacles.solids, conditions.around.surely.solids, found)  # fmt: skip


def _select(entries: Sequence[CutterEntry]) -> tuple[str | None, Selection]:
    feasible = [e for e in entries if e.feasible]
    if not feasible:
        best = min(entries, key=lambda e: e.inaccessible + e.undecided)
        left = best.inaccessible + best.undecided
        why = f"no cutter reaches every sample; {best.id} comes nearest, {left} not reached"
        if not left:
            why = f"{best.id} reaches every judged sample, but obstacles are missing: see the notes"
        return None, Selection(rule=RULE, runner_up=None, why=why)
    first = feasible[0]
    larger = [e.id for e in entries if e.radius > first.radius]
    why = f"{', '.join(larger)} {'is' if len(larger) == 1 else 'are'} larger but not feasible" if larger else (
        "no larger cutter was given"
    )  # fmt: skip
    return first.id, Selection(rule=RULE, runner_up=feasible[1].id if len(feasible) > 1 else None, why=why)
