"""What a type checker says of calls: mypy checks this file with the package, and an `ignore` that ignores nothing is an error.

Nothing here is run.
"""

from plan_cutters import Cutter, Options, Result, Scene, plan, posture_map


def right(part: Scene) -> Result:
    posture_map(part, point=(0, 0, 0), cutter="R6L80", rotations=[0.0], setup="+z", machine="tilt:60")
    plan("part.step", cutters=["R6L80", Cutter.flat(radius=3, length=40)], grid=9, fixtures="vise.step", tilt=(0, 1))
    return plan(Scene.of("part.step", tolerance=0.02, flip=True), cutters="R6L80", machine=None)


def kept(part: Scene, known: Options) -> None:
    """What `Options` keeps of each option may be given again."""
    plan(
        part, cutters=known.cutters, libraries=known.libraries, holder=known.holder, allowance=known.allowance,
        holder_clearance=known.holder_clearance, machine=known.machine, setup=known.setup, other_setups=known.other_setups,
        faces=known.faces, ignore=known.ignore, grid=known.grid, spacing=known.spacing, tilt=known.tilt,
        rotation=known.rotation, rotation_step=known.rotation_step, tolerance=known.tolerance, jobs=known.jobs, flip=known.flip,
        area_budget=known.area_budget, posture_maps=known.posture_maps, map_budget=known.map_budget, answers=known.answers,
        length_over_radius=known.length_over_radius, unit=known.unit, fixtures=known.fixtures, placement=known.placement,
        other_placements=known.other_placements, propose=known.propose, operations=known.operations, feed=known.feed,
        scallop=known.scallop, stepover=known.stepover, index_step=known.index_step, index_time=known.index_time,
        change_time=known.change_time, setup_time=known.setup_time, overlap=known.overlap,
        most_operations=known.most_operations,
    )  # fmt: skip


def wrong(part: Scene) -> None:
    plan(part, tolerence=0.1)  # type: ignore[call-arg]
    plan(part, tolerance="fine")  # type: ignore[arg-type]
    plan(part, flip=None)  # type: ignore[arg-type]
    Scene.of(part, grid=9)  # type: ignore[call-arg]
    posture_map(part, point=(0, 0, 0), cutter="R6L80", rotations=[0.0], faces="F1")  # type: ignore[call-arg]
    plan(part).no_such_thing  # type: ignore[attr-defined]  # noqa: B018
