"""Steps that drill in FreeCAD: planes and lines of holes, tool controllers and drilling operations of the job."""

import math

import pytest

from plan_cutters import plan
from tests.support.drills import drill, library_of, tap
from tests.support.freecad_host import CONSOLE, HEAD, run
from tests.support.plates import block, drilled
from tests.support.stated import stated

pytestmark = pytest.mark.slow("needs FreeCAD", together="FreeCAD")

INSIDE = (
    HEAD
    + """
document = macro["run"](FOLDER)
for group in document.Objects:
    if hasattr(group, "Kind"):
        (plane,) = [each for each in group.Group if each.Name.endswith("_plane")]
        (lines,) = [each for each in group.Group if each.Name.endswith("_holes")]
        found[group.Name] = dict(
            label=group.Label, kind=group.Kind, diameter=group.Diameter.Value, depth=group.Depth.Value,
            words=list(group.ControlWords),
            axis=list(plane.Placement.Rotation.multVec(App.Vector(0, 0, 1))), seconds=group.Seconds,
            holes=[[list(edge.Vertexes[k].Point) for k in (0, 1)] for edge in lines.Shape.Edges],
        )
job = document.getObject("Job")
found["tools"] = [[each.Tool.Diameter.Value, each.VertFeed.Value * 60, each.ToolNumber] for each in job.Tools.Group]
found["operations"] = [[each.Label, each.Active, each.ToolController.Tool.Diameter.Value,
                        [each.Base[0][0].Shape.getElement(name).Surface.Radius for name in each.Base[0][1]]]
                       for each in job.Operations.Group]
found["said"] = said
"""
)


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    if CONSOLE is None:
        pytest.skip("FreeCAD is not installed (freecadcmd)")
    folder = tmp_path_factory.mktemp("plan")
    side = drilled(5.0, 9.0).rotate((0, 0, 0), (0, 1, 0), 90).translate((30, 0, -7))
    shape = block(60, 40, 14).pushPoints([(-12, 6), (0, 6)]).hole(3.3).cut(side).val()
    file = stated(folder / "plate.step", shape, {1.65: {"value": 3.3, "notes": ["M4"]}})
    document = plan(
        file, cutters=["D6L40F25S6"], faces="all", grid=3, area_budget=0, machine="trunnion-ac", feed=800, operations="fastest",
        libraries=[library_of(drill(3.3), drill(5.0), tap(4.0, 0.7), feed=240.0)],
    ).write(folder, ("json", "step"))  # fmt: skip
    return document, run([CONSOLE], INSIDE, tmp_path_factory.mktemp("freecad"), PLAN_FOLDER=str(folder))


def test_groups_have_the_numbers_of_the_process(opened):
    document, found = opened
    process = document.process
    for number, step in enumerate(process.drilling, len(process.steps) + 1):
        group = found[f"drill{number}"]
        assert group["label"].startswith(f"step {number} {step.kind} {step.thread or f'D{step.diameter_mm:g}'}")
        assert (group["kind"], group["diameter"], group["seconds"]) == (step.kind, step.diameter_mm, pytest.approx(step.seconds))
        assert group["depth"] == pytest.approx(step.depth_mm)
        assert group["axis"] == pytest.approx(list(step.axis), abs=1e-9)
        assert group["words"] == [step.g68_2, step.g53_1, step.rotary_words]
        for each, (mouth, tip) in zip(step.holes, group["holes"], strict=True):
            assert mouth == pytest.approx(list(each.mouth_mm), abs=1e-6)
            assert tip == pytest.approx(list(each.tip_mm), abs=1e-6)


def test_the_job_drills_with_drills_alone(opened):
    """This FreeCAD has no shape of a tap: no other tool stands in for it. What lies aside needs a work plane."""
    _, found = opened
    drills = [row for row in found["tools"] if row[0] in (3.3, 5.0)]
    assert [(wide, feed) for wide, feed, _ in drills] == [(3.3, pytest.approx(240.0)), (5.0, pytest.approx(240.0))]
    assert len({number for *_, number in found["tools"]}) == len(found["tools"])
    along = [row for row in found["operations"] if math.isclose(row[2], 3.3)]
    assert [(active, radii) for _, active, _, radii in along] == [(False, [pytest.approx(1.65)] * 2)]
    assert all(math.isclose(wide, 2.0 * radius) for _, _, wide, radii in found["operations"] for radius in radii)
    assert any("like tap" in line for line in found["said"]) or any(wide == 4.0 for wide, *_ in found["tools"])
