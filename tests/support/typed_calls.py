"""What type checkers say of calls: mypy and pyright check this file, and nothing here is run.

A line that ends in `type: ignore` is a mistake, which both must find: mypy finds an `ignore` that ignores nothing, and
`tests/house/test_types.py` compares the lines on which pyright finds a mistake with these. So a new promise is one more line:
`assert_type` in `right`, or a mistake in `wrong`.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, assert_type

from cad_io import Part, SurfaceSamples, read_part
from cad_io.arrays import Floats
from plan_cutters import (
    Axis,
    Cutter,
    Machine,
    Options,
    Placement,
    Plan,
    PostureRange,
    Result,
    Scene,
    plan,
    plan_many,
    posture_map,
)
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.library import read_library
from plan_cutters.plan_file.model import CutterEntry


def right(part: Scene, axis: Floats) -> Result:
    posture_map(part, point=(0, 0, 0), cutter="R6L80", rotations=[0.0], setup="+z", machine="tilt:60")
    plan("part.step", cutters=["R6L80", Cutter.flat(radius=3, length=40)], grid=9, fixtures="vise.step", tilt=(0, 1))
    plan(Path("part.step"), cutters=read_library("shop.tools"), setup=axis, other_setups=["-z", (0, 1, 0)])
    return plan(Scene.of("part.step", tolerance=0.02, flip=True), cutters="R6L80", machine=None)


def known(result: Result) -> None:
    """Of what is looked at every day the type is known."""
    assert_type(result.plan, Plan)
    assert_type(result.selected, str | None)
    assert_type(result.cutters, list[CutterEntry])
    assert_type(result.cutters[0].by_reason, dict[str, int])
    assert_type(result.cutters[0].feasible, bool | None)
    assert_type(result.part, Part)
    assert_type(result.samples, SurfaceSamples)
    assert_type(result.samples.point, Floats)
    assert_type(result.reaches, dict[str, Verdicts])
    assert_type(result.reaches["R6L80"].axis, Floats)
    assert_type(result.face("F1").reached, float | None)
    assert_type(read_part("part.step", unit="in").faces[0].name, str)
    assert_type(result.scene.tolerance, float)
    assert_type(posture_map("part.step", point=(0, 0, 0), cutter="R6L80", rotations=0.0).free, tuple[Floats, ...])
    assert_type(Cutter.parse("R6L80").id, str)
    for each in plan_many(["part.step"], grid=9):
        assert_type(each.row.cutter, str | None)
        assert_type(each.plan, Plan | None)


def as_given(words: Mapping[str, Any]) -> None:
    """What a constructor takes is more than what it keeps."""
    assert_type(Options(cutters="R6L80", setup="Z", machine="tilt:60", fixtures="vise.step").setup, tuple[float, float, float])
    assert_type(Options(tilt=[0, 1]).tilt, tuple[float, float])
    assert_type(Cutter.ball(radius=4, length=50, holder="er32", neck=[]).holder is None, bool)
    assert_type(Placement("Z", x=[1, 0, 0], clamped="F1").z, tuple[float, float, float])
    assert_type(Options.of(words), Options)


def degrees(part: Scene) -> None:
    """Angles by names that end in `_deg`, and cutters by diameter."""
    Options(tilt_deg=(0, 60), rotation_deg=[0, 90], rotation_step_deg=5, index_step_deg=15)
    plan(part, tilt_deg=(0, 60), rotation_deg=(0, 90), rotation_step_deg=5, index_step_deg=15)
    found = posture_map(part, point=(0, 0, 0), cutter="R6L80", rotations_deg=[0, 45], tilt_deg=(0, 60))
    assert_type(found.axis(0, tilt_deg=30), Floats)
    PostureRange(tilt_deg=(0, 60), step_deg=5)
    Machine("tilting", tilt_limit_deg=30)
    Machine("table", axes=[Axis.rotary("A", "part", (1, 0, 0), limits_deg=(-30, 120), rate_deg=90)])
    Cutter(6, 80, taper_deg=3)
    Cutter.flat(diameter=12, length=80, taper_deg=3)
    Cutter.ball(diameter=12, length=80)
    Cutter.bull(diameter=12, corner_radius=1, length=80)


def wrong(part: Scene, result: Result) -> None:
    plan(part, tolerence=0.1)  # type: ignore[call-arg]
    plan(part, tolerance="fine")  # type: ignore[arg-type]
    plan(part, flip=None)  # type: ignore[arg-type]
    plan(part, setup=3)  # type: ignore[arg-type]
    plan(part, tilt_deg=60)  # type: ignore[arg-type]
    plan(part, answers="stickout")  # type: ignore[arg-type]
    plan(part, operations="all")  # type: ignore[arg-type]
    plan(part, setup="W")  # type: ignore[arg-type]
    plan(part, sharp_edges="none")  # type: ignore[arg-type]
    plan(part).no_such_thing  # type: ignore[attr-defined]  # noqa: B018
    plan_many(["part.step"], tolerence=0.1)  # type: ignore[call-arg]
    Scene.of(part, grid=9)  # type: ignore[call-arg]
    posture_map(part, point=(0, 0, 0), cutter="R6L80", rotations=[0.0], faces="F1")  # type: ignore[call-arg]
    Options(gird=9)  # type: ignore[call-arg]
    Options(grid="9")  # type: ignore[arg-type]
    Options().tollerance  # type: ignore[attr-defined]  # noqa: B018
    Cutter(6, 80, tapr=0.1)  # type: ignore[call-arg]
    Cutter.flat(radus=6, length=80)  # type: ignore[call-arg]
    Cutter.flat(radius=6, length=80, shank=6)  # type: ignore[call-arg]
    Cutter.ball(diameter="12", length=80)  # type: ignore[arg-type]
    Axis.rotary("A", "table", (1, 0, 0))  # type: ignore[arg-type]
    Machine(tilt_limit_degrees=30)  # type: ignore[call-arg]
    result.slected  # type: ignore[attr-defined]  # noqa: B018
    result.plan.cuters  # type: ignore[attr-defined]  # noqa: B018
    result.samples.points  # type: ignore[attr-defined]  # noqa: B018
    read_part("part.step").fases  # type: ignore[attr-defined]  # noqa: B018
