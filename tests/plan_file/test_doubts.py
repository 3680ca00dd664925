"""What changes what one does stands above the process, a line each; where nothing is doubtful there is no line."""

import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon, BRepBuilderAPI_MakeSolid
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.gp import gp_Dir, gp_Pln, gp_Pnt, gp_Vec
from OCP.TopoDS import TopoDS_Shell

from cad_io.kernel import faces
from plan_cutters import Machine, plan
from plan_cutters.domain.machine import Axis
from plan_cutters.domain.placement import Placement
from plan_cutters.library.read import read_library
from plan_cutters.plan_file.words.names import as_fields
from plan_cutters.plan_file.words.notes import doubts
from plan_cutters.plan_file.words.text import text_of
from plan_cutters.report.page.write import page
from tests.support.cad_parts import box, compound, patch, rod

FEW = {"faces": "all", "grid": 5, "area_budget": 0}
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def linear(name, direction, limits):
    return Axis(name, "linear", "tool", direction, limits)


def sheet(z=10.0, half=30.0):
    """A reference plane that cuts a body."""
    return BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(10, 10, z), gp_Dir(0, 0, 1)), -half, half, -half, half).Face()


@pytest.fixture(scope="module")
def block():
    """A closed solid of a usual size whose top is machined with any axis."""
    return plan(box(20, 20, 20), cutters=["D6L60"], **FEW | {"faces": "F6"})


def test_nothing_is_doubtful_of_a_plain_solid(block):
    assert block.plan.process.doubts == []
    assert doubts(block.plan) == []


def test_an_unusual_size_doubts_the_unit_and_is_told_once():
    result = plan(box(5000, 20, 20), cutters=["D6L60"], **FEW)
    (line,) = result.plan.process.doubts
    assert "5,000 mm" in line
    assert "--unit" in line
    lines = " ".join(text_of(result.plan).lines)
    assert lines.index(line[:30]) == 0
    assert "outside 1 to 3000" not in lines
    html = page(result).decode()
    assert as_fields(line) in html
    assert "outside 1 to 3000" not in html[: html.index("<main>")]


@pytest.mark.parametrize("machine", ["4-axis-a", "trunnion-ac"])
def test_a_chuck_across_the_axis_that_turns_it_is_named(machine):
    """A disk with a pin: on a fourth axis nobody stands its chuck along the spindle; on a trunnion it stands on C."""
    how = {"setup": Z, "fixtures": "chuck", "operations": "fastest"}
    placed = plan(rod(20, 30), cutters=["D10L50rc5F30"], feed=1000, machine="trunnion-ac", **FEW | how).plan.process.setups[0]
    how |= {"fixtures": placed.clamping, "machine": machine}
    found = plan(rod(20, 30), cutters=["D10L50rc5F30"], feed=1000, **FEW | how).plan
    process = found.process
    steps = [each.model_copy(update={"angles_deg": {"A": 30.0}}) for each in process.steps]
    turned = doubts(found.model_copy(update={"process": process.model_copy(update={"steps": steps})}))
    upright = [each.model_copy(update={"angles_deg": {"A": 0.0}, "mode": "fixed"}) for each in process.steps]
    assert any("the chuck stands along the spindle" in line for line in turned) == (machine == "4-axis-a")
    assert doubts(found.model_copy(update={"process": process.model_copy(update={"steps": upright})})) == []


def test_what_a_setup_holds_before_any_step_comes_to_it_is_named():
    """A block in its stock: what the second setup grips is machined in the first one, or by none that come before it."""
    how = {"setup": Z, "other_setups": [(0, 0, -1)], "fixtures": "vise", "stock": "box", "machine": "3-axis"}
    found = plan(box(40, 30, 20), cutters=["D10L50F30"], operations="fastest", feed=1000, **FEW | how).plan
    assert doubts(found) == []
    second = found.process.setups[1]
    held, steps = {*second.grips, *second.stands_on}, [each for each in found.process.steps if each.setup == 1]
    # The same faces, all of them in the second setup.
    steps[0] = steps[0].model_copy(update={"faces": [f"F{n}" for n in range(1, 7)]})
    (line,) = doubts(found.model_copy(update={"process": found.process.model_copy(update={"steps": steps})}))
    assert line.startswith("Setup 2 holds raw faces")
    assert {face for face in held if face in line.replace(",", " ").replace(".", " ").split()} == held


def test_a_sheet_beside_a_solid_is_named_with_the_option_that_leaves_it_out():
    part = compound(box(20, 20, 20), sheet())
    line = plan(part, cutters=["D6L60"], **FEW).plan.process.doubts[-1]
    assert line.startswith("F7 stands in no solid, as a construction sheet does: `--ignore F7` ")
    ignored = plan(part, cutters=["D6L60"], ignore="F7", **FEW).plan
    assert ignored.process.doubts == []
    assert ignored.part.loose_faces == []


def test_faces_without_a_solid_are_no_sheets_but_their_side_is_a_guess():
    (line,) = plan(sheet(), cutters=["D6L60"], **FEW).plan.process.doubts
    assert "a guess" in line
    assert "--flip" in line


def test_a_solid_that_crosses_itself_tells_no_side_and_no_option_does():
    wire = BRepBuilderAPI_MakePolygon()
    for x, y in ((0, 0), (40, 30), (40, 0), (0, 30)):
        wire.Add(gp_Pnt(x, y, 0))
    wire.Close()
    outline = BRepBuilderAPI_MakeFace(wire.Wire(), True).Face()
    result = plan(BRepPrimAPI_MakePrism(outline, gp_Vec(0, 0, 10)).Shape(), cutters=["D6L60"], **FEW).plan
    assert not result.part.orientation.confident
    (line,) = result.process.doubts
    assert "material is a guess" in line
    assert "--flip" not in line
    assert line[:40] in " ".join(text_of(result).lines[:3])
    assert "--flip" not in result.notes[result.note_codes.index("side_guessed")]


def test_an_open_solid_tells_no_side_beside_a_sheet_that_can_be_turned():
    shell = TopoDS_Shell()
    BRep_Builder().MakeShell(shell)
    for face in list(faces(box(20, 20, 20)))[:5]:
        BRep_Builder().Add(shell, face)
    solid = BRepBuilderAPI_MakeSolid(shell).Solid()
    (line,) = plan(solid, cutters=["D6L60"], **FEW).plan.process.doubts
    assert "F1, F2, F3 and 2 more is material is a guess" in line
    assert "--flip" not in line
    both = plan(compound(solid, sheet(40.0)), cutters=["D6L60"], **FEW).plan.process.doubts
    assert [("F6 is" in line, "--flip" in line) for line in both[:2]] == [(True, True), (False, False)]


@pytest.mark.parametrize(("long", "short"), [(120.0, 20.0), (100.0, 0.0)])
def test_a_part_that_is_longer_than_the_travel_is_told_by_how_much(long, short):
    machine = Machine("small", axes=(linear("X", X, (-50, 50)), linear("Y", Y, (-50, 50)), linear("Z", Z, None)), fixed=True)
    document = plan(box(20, long, 20), cutters=["D6L60"], machine=machine, **FEW | {"faces": "F6"}).plan
    by_name = {each.name: each for each in document.machine.linear}
    assert by_name["Y"].extent_mm == pytest.approx(long, rel=0.01)
    assert by_name["Z"].limits_mm == (None, None)
    if short:
        (line,) = document.process.doubts
        assert line == "The part does not fit machine small: 120 mm to machine along Y, 20 mm more than the travel."
    else:
        assert document.process.doubts == []


def test_travel_that_postures_exceed_is_told_where_the_part_as_such_would_fit():
    axes = (linear("X", X, (-500, 500)), linear("Y", Y, (-500, 500)), linear("Z", Z, (0, 50)))
    machine = Machine("low", axes=axes, fixed=True)
    placement = Placement(z=(0.0, 0.0, 1.0), origin=(0.0, 0.0, 0.0))
    (line,) = plan(
        box(20, 20, 20), cutters=["D6L60"], machine=machine, setup=placement, **FEW | {"faces": "F6"}
    ).plan.process.doubts
    assert line.startswith("Beyond the travel of low at 25 of 25 postures: Z by up to 30 mm")


def test_steps_from_below_need_something_that_holds_the_part():
    part, under = box(20, 20, 20), {"faces": "F5"}
    free = plan(part, cutters=["D6L60"], machine="trunnion-ac", setup=(0.0, 0.6, 0.8), **FEW | under).plan
    assert free.process.steps[0].below_mm2 == pytest.approx(400.0)
    assert free.process.doubts == ["Nothing holds the part: step 1 comes from below."]
    # A table lies below the part, far below here.
    table = plan(part, cutters=["D6L60"], machine="trunnion-ac", setup=(0.0, 0.6, 0.8), fixtures="table:-90", **FEW | under).plan
    assert table.process.doubts == free.process.doubts
    held = plan(
        part, cutters=["D6L60"], machine="trunnion-ac", setup=(0.0, 0.6, 0.8), fixtures="box:5,5,5@100,0,0", **FEW | under
    )
    assert held.plan.process.steps[0].below_mm2 == pytest.approx(400.0)
    assert held.plan.process.doubts == []
    # Without rotary axes nobody turns the part.
    assert plan(part, cutters=["D6L60"], setup=(0.0, 0.6, 0.8), **FEW | under).plan.process.doubts == []


def test_from_above_and_level_is_not_from_below():
    walls = plan(box(20, 20, 20), cutters=["D6L60"], machine="trunnion-ac", **FEW | {"faces": "1-4,6"}).plan
    assert sum(step.below_mm2 for step in walls.process.steps) < walls.process.finished_mm2
    level = plan(box(20, 20, 20), cutters=["D6L60"], machine="tilt:90", **FEW | {"faces": "1-4,6"}).plan
    assert all(step.below_mm2 == 0.0 for step in level.process.steps)


def test_a_tool_that_its_holder_cannot_take_is_told(tmp_path):
    file = tmp_path / "drawer.toml"
    tools = (
        f'[[tool]]\nname = "{name}"\ntype = "flat"\nDC = {size}\nLCF = 10\nLPR = 60\nDMM = {size}\nholder = "er16"\n'
        for name, size in (("thick", 16), ("thin", 6))
    )
    file.write_text('unit = "mm"\n' + "".join(tools))
    library = read_library(file, skip_bad=True)
    (unused,) = library.unused
    assert unused.unheld
    (line,) = plan(box(20, 20, 20), libraries=library, **FEW | {"faces": "F6"}).plan.process.doubts
    assert line.startswith("A tool does not fit its holder and is not used: thick")


def test_a_raised_tolerance_says_from_where_to_where(block):
    effective = block.plan.effective.model_copy(update={"tolerance_mm": 0.064})
    (line,) = doubts(block.plan.model_copy(update={"effective": effective}))
    assert "from 0.01 mm to 0.064 mm" in line


@pytest.mark.parametrize(("size", "cutters", "said"), [
    (4.0, ["D10L60"], "The part is smaller than any cutter is wide: "),
    (4.0, ["D10L60", "D3L60"], ""),
    (600.0, ["D0.5L60"], "The part is 1,200 times as long as the widest cutter is wide: "),
    (600.0, ["D0.5L60", "D6L60"], ""),
])  # fmt: skip
def test_a_part_of_another_size_than_its_cutters_doubts_the_unit(size, cutters, said):
    found = plan(box(size, size, size), cutters=cutters, **FEW | {"faces": "F6"}).plan.process.doubts
    assert [line[: len(said)] for line in found] == ([said] if said else [])
    assert all("--unit" in line for line in found)


@pytest.mark.parametrize(("units", "size"), [("mm", "20 x 20 x 20 mm"), ("in", "0.7874 x 0.7874 x 0.7874 in")])
@pytest.mark.parametrize("faces", ["F6", "all"])
@pytest.mark.parametrize("cutter", ["D6L60", "D6L2"])
def test_the_size_of_the_part_stands_in_the_line_that_names_it(units, size, faces, cutter):
    result = plan(box(20, 20, 20), cutters=[cutter], units=units, machine="3-axis", **FEW | {"faces": faces})
    text = text_of(result.plan)
    said = " ".join([text.headline, *(line.strip() for line in text.lines)])
    assert f"art, {size}" in said
    assert said.count(size) == 1
    assert f"art, {size}" in page(result).decode()


@pytest.mark.parametrize("cutter", ["D6L60rc1", "D6L60rc3"])
def test_motion_between_samples_is_doubted_until_all_of_it_is_proved(cutter):
    step = {"cutter": cutter, "mode": "simultaneous"}
    words = {"cutters": [cutter], "feed": 1000.0, "grid": 9, "machine": "trunnion-ac", "setup": "+z"}
    result = plan(patch(3), **words, process={"step": [step], "rest": "leave"}).plan
    entry = result.operations.plans[0]
    (made,) = entry.operations
    (line,) = [each for each in doubts(result) if "Not proved" in each]
    assert line in result.process.doubts
    assert f"in step 1, at {made.samples} samples, " in line
    left = 100.0 * (1.0 - made.proved_share)
    assert float(line.split("samples, ")[1].split(" %")[0]) == pytest.approx(left, abs=0.06)
    assert (made.proved_share > 0.0) == cutter.endswith("rc3"), "a ball alone"

    def with_share(share):
        one = made.model_copy(update={"proved_share": share})
        plans = [entry.model_copy(update={"operations": [one]})]
        return result.model_copy(update={"operations": result.operations.model_copy(update={"plans": plans})})

    assert any("100 % of its area" in each for each in doubts(with_share(None))), "nothing was looked at"
    assert not any("Not proved" in each for each in doubts(with_share(1.0)))
