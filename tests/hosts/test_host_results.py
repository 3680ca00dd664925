"""What comes back into CAD hosts: coloured assemblies and compounds with the tool in place, and values on faces."""

import math
import pickle
from dataclasses import replace

import build123d as bd
import cadquery as cq
import numpy as np
import pytest
from ocp_tessellate.convert import tessellate_group, to_ocpgroup

from plan_cutters import Fixture, OptionError, plan
from plan_cutters.answers.stick_out import EXACT
from plan_cutters.domain.verdicts import ACCESSIBLE, INTERFERENCE_FREE, REASONS
from plan_cutters.hosts.build123d import compound
from plan_cutters.hosts.cadquery import assembly, register
from plan_cutters.judging.judge import judge
from plan_cutters.plan_file.reasons import PALETTE, rgb

FLOOR = cq.selectors.NearestToPointSelector((0, 0, 0))
HELD = "R2L14F6S2"


@pytest.fixture(scope="module")
def slotted():
    """A block with a slot of 6 x 30 mm, 10 mm deep, whose floor lies in the plane z = 0; red on its left side."""
    block = cq.Workplane().box(40, 40, 20).faces(">Z").workplane().rect(6, 30).cutBlind(-10)
    whole = cq.Assembly(block, name="slotted")
    return whole.addSubshape(block.faces("<X").val(), name="left", color=cq.Color(1.0, 0.0, 0.0))


@pytest.fixture(scope="module")
def result(slotted):
    """A wide cutter that does not fit into the slot, a narrow one whose holder stays above it; a clamp and a table."""
    clamp = bd.Pos(-15, 0, 10) * bd.Box(6, 40, 5, align=(bd.Align.CENTER, bd.Align.CENTER, bd.Align.MIN))
    clamp.label = "clamp"
    block = slotted.obj
    return plan(slotted, faces=[block.faces(FLOOR), block.faces(">Z")], cutters=["R5L60", HELD], holder="R8L30", spacing=1.5,
                tolerance=0.02, fixtures=[clamp, "table:-10"], area_budget=0)  # fmt: skip


def named(each):
    return getattr(each, "label", None) or each.name


def colour_of(each):
    return tuple(each.color.toTuple() if hasattr(each.color, "toTuple") else each.color)[:3]


def leaves(whole):
    """Group -> name -> colour, of a CadQuery assembly or a build123d compound."""
    return {named(group): {named(each): colour_of(each) for each in group.children} for group in whole.children}


def area(shape):
    return sum(face.Area() for face in cq.Shape.cast(shape.wrapped).Faces())


def test_an_assembly_has_names_and_colours(result):
    whole = assembly(result)
    found = leaves(whole)
    assert whole.name == "slotted"
    assert list(found) == ["targets", "check faces", "fixtures"]
    for name, colour in found["targets"].items():
        verdict = name.split("_", 1)[1].rstrip("0123456789 ")
        assert verdict in PALETTE
        assert colour == pytest.approx(rgb(verdict), abs=1e-5)
    numbers = {int(name[1:].split("_")[0]) for group in ("targets", "check faces") for name in found[group]}
    assert numbers == {face.number for face in result.part.faces}
    # A check face keeps its own colour.
    (left,) = (name for name in found["check faces"] if name.endswith(" left"))
    assert found["check faces"][left] == pytest.approx((1.0, 0.0, 0.0))
    assert list(found["fixtures"]) == ["fixture:clamp", "fixture:table"]
    shown = sum(area(each.obj) for group in whole.children[:2] for each in group.children)
    assert shown == pytest.approx(sum(face.area for face in result.part.faces), rel=1e-6)


def test_pieces_lie_where_their_verdicts_are(result):
    """Every sample well within a piece has the verdict that the piece's name says."""
    words = {INTERFERENCE_FREE: "interference_free", ACCESSIBLE: "accessible"}
    verdict, samples = result.reaches[result.shown].verdict, result.samples
    looked = 0
    for piece in assembly(result).children[0].children:
        number, word = int(piece.name[1:].split("_")[0]), piece.name.split("_", 1)[1].rstrip("0123456789 ")
        rows = np.flatnonzero(samples.face == number)
        for row in rows[:: max(1, len(rows) // 25)].tolist():
            at = cq.Vertex.makeVertex(*samples.point[row])
            border = min(edge.distance(at) for edge in piece.obj.Edges())
            if piece.obj.distance(at) < 1e-6 and border > 1.5:
                assert words.get(int(verdict[row]), "inaccessible") == word
                looked += 1
    assert looked > 10


def test_a_compound_has_the_same_labels_and_colours(result):
    whole, other = leaves(compound(result)), leaves(assembly(result))
    assert list(whole) == list(other)
    for group in whole:
        assert list(whole[group]) == list(other[group])
        assert list(whole[group].values()) == [pytest.approx(colour, abs=1e-5) for colour in other[group].values()]
    # It is a part again: planned like any other compound.
    again = plan(compound(result), faces="component:targets", cutters="R2L14", spacing=5.0, tolerance=0.05, area_budget=0)
    assert again.plan.samples.count > 0


@pytest.mark.parametrize("made", [assembly, compound])
def test_viewers_convert_it(result, made):
    """As ocp_vscode does: groups, names and colours arrive, and every leaf has triangles."""
    whole = made(result, at=int(np.flatnonzero(result.reaches[result.shown].reached)[0]))
    group, instances = to_ocpgroup(whole)
    found, names = {}, []

    def walk(node):
        for each in getattr(node, "objects", ()):
            walk(each)
        if not hasattr(node, "objects"):
            found[node.name] = (node.color.r, node.color.g, node.color.b)
            names.append(node.name)

    walk(group)
    assert len(names) == len(set(names)) == sum(len(each) for each in leaves(whole).values())
    for colours in leaves(whole).values():
        for name, colour in colours.items():
            assert found[name] == pytest.approx(tuple(255 * c for c in colour), abs=1.0)
    meshes = tessellate_group(group, instances)[0]
    assert len(meshes) == len(names)
    assert all(len(mesh["vertices"]) for mesh in meshes)


def test_colours_of_another_cutter(result):
    assert result.shown.startswith("R2")
    wide = next(cutter.id for cutter in result.cutters if cutter.id.startswith("R5"))
    names = leaves(assembly(result, cutter=wide))["targets"]
    floor = result.part.picked or [each.id for each in result.faces() if each.area == pytest.approx(180)]
    assert f"{floor[0]}_inaccessible" in names
    with pytest.raises(OptionError, match="none of this plan's"):
        assembly(result, cutter="R9L9")


def test_the_tool_stands_where_it_was_judged(result):
    """Its solid touches the surface at the sample, has the volume of its outline, and keeps clear of the part."""
    reach, row = result.reaches[result.shown], int(np.flatnonzero(result.reaches[result.shown].reached)[3])
    (tool,) = (group for group in assembly(result, at=row).children if group.name.startswith("tool "))
    assert [each.name for each in tool.children] == ["flutes", "shank", "holder"]
    solids = [each.obj for each in tool.children]
    volumes = [math.pi * 4 * 6, math.pi * 4 * 8, math.pi * 64 * 30]
    assert [solid.Volume() for solid in solids] == pytest.approx(volumes)
    at = cq.Vertex.makeVertex(*result.samples.point[row])
    assert solids[0].distance(at) < 1e-6
    body = cq.Shape.cast(result.part.shape)
    assert sum(solid.intersect(body).Volume() for solid in solids) < 0.02 * 20
    top = np.array(solids[2].Center().toTuple()) - np.array(solids[0].Center().toTuple())
    assert top / np.linalg.norm(top) == pytest.approx(reach.axis[row], abs=1e-6)


def test_the_tool_at_a_witness_is_in_the_obstacle(result):
    wide = next(cutter.id for cutter in result.cutters if cutter.id.startswith("R5"))
    floor = next(each for each in result.faces(cutter=wide) if each.reached == 0.0)
    (tool,) = (group for group in assembly(result, cutter=wide, at=floor.worst).children if group.name.startswith("tool "))
    depth = floor.worst.depth_mm
    assert depth > 0.5
    point = cq.Vertex.makeVertex(*floor.worst.obstacle_point)
    assert min(each.obj.distance(point) for each in tool.children) < 1e-6
    not_reached = int(np.flatnonzero(result.reaches[wide].not_reached)[0])
    for at in (not_reached, len(result.samples), "here", True):
        with pytest.raises(OptionError):
            assembly(result, cutter=wide, at=at)


def test_values_of_a_face_are_those_of_its_samples(result):
    for cutter in result.cutters:
        reach = result.reaches[cutter.id]
        for each in result.faces(cutter=cutter.id):
            mine = result.samples.face == each.number
            assert each.target
            assert each.samples == mine.sum() == sum(each.verdicts.model_dump().values())
            weight = result.samples.area[mine]
            assert each.reached == pytest.approx(weight[reach.reached[mine]].sum() / weight.sum())
            assert sum(each.shares.values()) == pytest.approx(1.0)
            not_reached = reach.not_reached[mine]
            assert (each.reason is None) == (not not_reached.any())
            if not_reached.any():
                most = max(set(reach.reason[mine][not_reached].tolist()), key=lambda r: weight[reach.reason[mine] == r].sum())
                assert each.reason == REASONS[most]
                assert sum(each.reasons.values()) == pytest.approx(1.0 - each.reached)
                assert each.worst.face == each.id
                assert (each.worst.depth_mm or 0.0) == max(w.depth_mm or 0.0 for w in cutter.witnesses if w.face == each.id)
            else:
                assert each.worst is None


def test_a_face_is_asked_for_in_many_ways(result, slotted):
    block = slotted.obj
    floor = block.faces(FLOOR)
    number = next(each.number for each in result.faces() if each.area == pytest.approx(180))
    for which in (number, f"F{number}", str(number), floor, floor.val(), floor.val().wrapped, [floor.val()]):
        assert result.face(which).number == number
    left = result.face("left")
    assert (left.target, left.samples, left.reached, left.reason) == (False, 0, None, None)
    assert "check face" in left.why_unjudged
    assert [each.number for each in result.faces("all")] == [face.number for face in result.part.faces]
    other = cq.Workplane().box(1, 1, 1).faces(">Z")
    for which, words in (("all", "11 faces were given"), (99, "no face F99"), ("nothing", "give sculptured"),
                         (None, "no face of the part"), (other, "not a face of the part")):  # fmt: skip
        with pytest.raises(OptionError, match=words):
            result.face(which)


def test_build123d_faces_ask_as_well():
    part = bd.Box(20, 20, 10)
    found = plan(part, faces=part.faces().sort_by(bd.Axis.Z)[-1], cutters="R3L30", spacing=5.0, area_budget=0)
    top = found.face(part.faces().sort_by(bd.Axis.Z)[-1])
    assert (top.reached, top.area) == (1.0, pytest.approx(400))
    assert [each.target for each in found.faces(part.faces().filter_by(bd.Axis.X))] == [False, False]


def test_the_least_stick_out_of_a_face(result):
    """The narrow cutter's holder (R 8) must stay over the slot of 6 mm, but may come down to the top."""
    floor = next(each.number for each in result.faces() if each.area == pytest.approx(180))
    top = next(each.number for each in result.faces() if each.number != floor)
    unknown = result.face(floor)
    assert unknown.least_stick_out is None
    assert "was not requested" in unknown.why_no_stick_out
    held = {number: result.face(number, stick_out=True).least_stick_out for number in (floor, top)}
    # The slot is 10 mm deep and the holder wider than it: upright it ends at 10 mm; tilted along the slot it may be less.
    assert held[top] < held[floor] <= 10.0 + 2 * EXACT
    # Independently: judged with it, the floor's reached samples are; a little less, one is not reached.
    tool, rows = result.judged(), np.flatnonzero(result.samples.face == floor)
    reached = rows[result.reaches[tool.id].reached[rows]]
    for length, all_of_them in ((held[floor], True), (held[floor] - 0.1, False)):
        assert judge(result.ready, replace(tool, length=length), reached).reached.all() == all_of_them


def test_without_a_holder_no_stick_out_is_known(slotted):
    bare = plan(slotted, faces=slotted.obj.faces(FLOOR), cutters=[HELD], spacing=3.0, tolerance=0.05, area_budget=0)
    (face,) = bare.faces(stick_out=True)
    assert (face.least_stick_out, face.why_no_stick_out) == (None, "the cutter has no holder")


def test_a_result_from_a_pickle_answers_alike(result):
    again = pickle.loads(pickle.dumps(result))
    for face in result.faces():
        assert again.face(face.number) == face
    row = int(np.flatnonzero(result.reaches[result.shown].reached)[0])
    assert leaves(assembly(again, at=row)) == leaves(assembly(result, at=row))
    assert again.judged() == result.judged()


def test_selectors_in_a_chain(slotted):
    register()
    asked = {"cutters": "R2L30", "spacing": 5.0, "tolerance": 0.05, "area_budget": 0}
    for faces in (">Z", cq.selectors.DirectionMinMaxSelector(cq.Vector(0, 0, 1))):
        (top,) = slotted.obj.plan_cutters(faces=faces, **asked).faces()
        assert top.area == pytest.approx(40 * 40 - 180)
    (named,) = slotted.obj.plan_cutters(faces="F3", **asked).faces()
    assert named.id == "F3"


def test_fixtures_have_the_names_of_their_objects():
    jaw = bd.Box(1, 2, 3)
    assert Fixture.of(jaw).name == "fixture"
    jaw.label = "jaw"
    assert Fixture.of(jaw).name == "jaw"
    assert [each.name for each in Fixture.each_of([jaw, bd.Pos(5, 0, 0) * jaw])] == ["jaw", "jaw 2"]
    assert Fixture(jaw, name="left").name == "left"
