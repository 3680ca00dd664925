"""Objects of CadQuery and build123d: what is picked on them, what is around it, and what they are called."""

import math

import build123d as bd
import cadquery as cq
import pytest
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location

from cad_io import ReadError, read_part
from cad_io.kernel import explore, shape_map
from cad_io.kernel.shapes import component_of
from plan_cutters import Cutter, OptionError, plan, posture_map
from plan_cutters.hosts.cadquery import register
from plan_cutters.plan_file.reasons import rgb
from tests.support.cad_parts import moved

FLOOR = cq.selectors.NearestToPointSelector((0, 0, 0))
WIDE, NARROW = "R5L60", "R2L60"
SLOT = {"cutters": [Cutter.parse(WIDE), Cutter.parse(NARROW)], "spacing": 3.0, "tolerance": 0.05, "area_budget": 0}


@pytest.fixture(scope="module")
def slotted():
    """A block with a slot of 6 x 30 mm, 10 mm deep, whose floor lies in the plane z = 0."""
    return cq.Workplane().box(40, 40, 20).faces(">Z").workplane().rect(6, 30).cutBlind(-10)


@pytest.fixture(scope="module")
def milled():
    """The same in build123d."""
    return bd.Box(40, 40, 20) - bd.Pos(0, 0, 5) * bd.Box(6, 30, 10)


def floor_of(shape):
    """The faces of a build123d shape in the plane z = 0."""
    return shape.faces().filter_by(lambda f: abs(f.center().Z) < 1e-6 and f.normal_at().Z > 0.9)


def assert_slot(result):
    """R5 reaches nothing in a slot of 6 mm; R2 does, but not into the corners."""
    wide, narrow = (next(c for c in result.cutters if c.id == name) for name in (WIDE, NARROW))
    assert [f.area_mm2 for f in result.plan.faces if f.target] == pytest.approx([6 * 30])
    assert result.plan.samples.count > 0
    assert wide.inaccessible == result.plan.samples.count
    assert narrow.accessible + narrow.interference_free > 0
    assert result.part.solids == 1
    assert len(result.part.faces) == 11


def test_faces_on_a_stack_are_judged_in_their_solid(slotted):
    register()
    assert_slot(slotted.faces(FLOOR).plan_cutters(**SLOT))


def test_build123d_faces_are_judged_in_the_shape_they_came_from(milled):
    assert_slot(plan(floor_of(milled), **SLOT))
    assert_slot(plan(floor_of(milled)[0], **SLOT))


@pytest.mark.slow("takes shapes of a CAD library", but=("kernel face",))
@pytest.mark.parametrize("how", ["workplane", "list", "face", "kernel face", "build123d", "number"])
def test_targets_are_given_as_objects(slotted, milled, how):
    picked = slotted.faces(FLOOR)
    part, faces = {
        "workplane": (slotted, picked),
        "list": (slotted, picked.vals()),
        "face": (slotted.val(), picked.val()),
        "kernel face": (slotted.val().wrapped, picked.val().wrapped),
        "build123d": (milled, floor_of(milled)),
        "number": (slotted, read_part(picked).picked),
    }[how]
    assert_slot(plan(part, faces=faces, **SLOT))


def test_the_choice_of_faces_beats_what_is_picked(slotted):
    top = plan(slotted.faces(FLOOR), faces=slotted.faces(">Z"), **SLOT)
    assert [f.area_mm2 for f in top.plan.faces if f.target] == pytest.approx([40 * 40 - 6 * 30])
    (number,) = read_part(slotted.faces(FLOOR)).picked
    assert plan(slotted.faces(FLOOR), **SLOT).plan.effective.faces == f"F{number}"
    with pytest.raises(OptionError, match="is ignored"):
        plan(slotted.faces(FLOOR), ignore=slotted.faces(FLOOR), **SLOT)


def test_faces_of_other_shapes_are_refused(slotted, milled):
    for faces in (cq.Workplane().box(1, 1, 1).faces(), floor_of(milled), [cq.Face.makePlane(1, 1)]):
        with pytest.raises(OptionError, match="not a face of the part"):
            plan(slotted, faces=faces, **SLOT)
    with pytest.raises(OptionError, match="in another place"):
        plan(slotted, faces=slotted.faces(FLOOR).val().moved(cq.Location((0, 0, 1))), **SLOT)
    with pytest.raises(OptionError, match="no faces in"):
        plan(slotted, faces=slotted.edges(), **SLOT)


def test_a_place_is_the_same_however_it_was_made(slotted):
    shift = TopLoc_Location(moved(angle=0.0, by=(3, 4, 5)))
    back = TopLoc_Location(moved(angle=0.0, by=(-3, -4, -5)))
    there_and_back = slotted.faces(FLOOR).val().wrapped.Moved(shift).Moved(back)
    assert_slot(plan(slotted, faces=there_and_back, **SLOT))


def test_faces_without_a_solid(slotted):
    face = slotted.faces(FLOOR).val()
    for alone in (cq.Workplane(face), cq.Workplane().add(face), cq.Workplane(cq.Face.makePlane(3, 3))):
        with pytest.raises(ReadError, match="no solid in the chain"):
            read_part(alone)
    for stack in (slotted.edges(), slotted.faces(">Z").workplane(), cq.Workplane()):
        with pytest.raises(ReadError, match="no solid and no face"):
            read_part(stack)
    # Given as such, a face is an open sheet: it is all there is.
    free = bd.Face.make_rect(6, 30)
    for sheet in (face, face.wrapped, [face], free, [free]):
        part = read_part(sheet)
        assert len(part.faces) == 1
        assert part.picked == ()
    with pytest.raises(ReadError, match="topo_parent"):
        read_part(bd.Pos(0, 0, 1) * bd.Box(1, 1, 1).faces()[0])


def test_the_solid_in_the_chain_that_holds_the_faces():
    chain = cq.Workplane().box(10, 10, 10).tag("first").faces(">Z").workplane(offset=50).box(2, 2, 2, combine=False)
    last = read_part(chain.faces(">Z"))
    assert last.size == pytest.approx((2, 2, 2))
    assert last.warnings == ()
    first = read_part(chain.faces("<Z", tag="first"))
    assert first.size == pytest.approx((10, 10, 10))
    assert any("earlier shape" in warning for warning in first.warnings)
    # All that stands on the stack is in the way.
    both = read_part(cq.Workplane().pushPoints([(0, 0), (30, 0)]).box(10, 10, 10).faces(">X"))
    assert both.solids == 2
    assert len(both.picked) == 1


def test_picks_keep_their_faces_in_other_units_and_processes(slotted, milled):
    for picked in (slotted.faces(FLOOR), floor_of(milled)):
        plain, scaled, guarded = read_part(picked), read_part(picked, unit="cm"), read_part(picked, guarded=True)
        (a,), (b,), (c,) = plain.picked, scaled.picked, guarded.picked
        assert plain.faces[a - 1].area == pytest.approx(6 * 30)
        assert scaled.faces[b - 1].area == pytest.approx(6 * 30 * 100)
        assert guarded.faces[c - 1].area == pytest.approx(6 * 30)


def boxes(part):
    """Component -> corner of the box around its faces, and its colours."""
    found = {}
    for number, path in component_of(part.tree).items():
        low, high, colours = found.get(path, ([math.inf] * 3, [-math.inf] * 3, set()))
        face = cq.Face(part.face(number)).BoundingBox()
        low = [min(x, y) for x, y in zip(low, (face.xmin, face.ymin, face.zmin), strict=True)]
        high = [max(x, y) for x, y in zip(high, (face.xmax, face.ymax, face.zmax), strict=True)]
        found[path] = (low, high, colours | {part.faces[number - 1].colour})
    return {
        path: ([round(x, 3) for x in low], [round(x, 3) for x in high], colours) for path, (low, high, colours) in found.items()
    }


RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


@pytest.fixture(scope="module")
def stand():
    """`stand`, itself a plate, holds `pair`, in blue, of `rod` in red and `ball`; without a name, a block."""
    pair = (
        cq.Assembly(name="pair", color=cq.Color(*BLUE))
        .add(cq.Workplane().circle(2).extrude(10), name="rod", color=cq.Color(*RED))
        .add(cq.Workplane().sphere(3), name="ball", loc=cq.Location((20, 0, 3)))
    )
    plate = cq.Workplane().box(60, 20, 2, centered=(True, True, False))
    whole = cq.Assembly(plate, name="stand").add(pair, loc=cq.Location((0, 0, 2)))
    whole.add(cq.Workplane().box(4, 4, 4, centered=(True, True, False)), loc=cq.Location((-20, 0, 2)))
    top = plate.faces(">Z").val()
    whole.addSubshape(top, name="top", color=cq.Color(*BLUE), layer="datum")
    return whole


def test_an_assembly_keeps_names_places_and_colours(stand):
    part = read_part(stand)
    assert boxes(part) == {
        "stand/stand": ([-30, -10, 0], [30, 10, 2], {None, BLUE}),
        "stand/pair/rod": ([-2, -2, 2], [2, 2, 12], {RED}),
        "stand/pair/ball": ([17, -3, 2], [23, 3, 8], {BLUE}),
        "stand": ([-22, -2, 2], [-18, 2, 6], {None}),
    }
    (top,) = [f for f in part.faces if f.name]
    assert (top.name, top.colour, top.area, part.layers) == ("top", BLUE, pytest.approx(1200), {top.number: ("datum",)})
    assert part.solids == 4
    # CadQuery makes up a name for what has none, another in each run.
    assert all(len(path) < 20 for path in component_of(part.tree).values())
    scaled = boxes(read_part(stand, unit="cm"))
    assert scaled["stand/pair/ball"] == ([170, -30, 20], [230, 30, 80], {BLUE})


def test_an_assembly_is_planned_and_written(stand, tmp_path):
    result = plan(stand, faces="component:rod", ignore=["component:stand/stand", "name:top"], cutters="R3L40",
                  spacing=3.0, tolerance=0.1, area_budget=0)  # fmt: skip
    document = result.write(tmp_path, ["step"])
    assert {f.component for f in document.faces if f.target} == {"stand/pair/rod"}
    assert {f.component for f in document.faces if f.ignored} == {"stand/stand"}
    again = read_part(tmp_path / "annotated.step")
    before, after = boxes(result.part), boxes(again)
    for path in before.keys() - {"stand"}:  # the kernel gives a name to what has none
        assert after[path][:2] == (pytest.approx(before[path][0], abs=1e-3), pytest.approx(before[path][1], abs=1e-3))
    component = component_of(again.tree)
    for face in again.faces:
        if component[face.number] == "stand/stand":
            assert "_ignored" in face.name
            assert face.colour == pytest.approx(BLUE if face.name.endswith(" top") else rgb("ignored"), abs=2e-3)
        if component[face.number] == "stand/pair/ball":
            assert face.name.endswith("_check")
            assert face.colour == pytest.approx(BLUE, abs=2e-3)


def test_faces_of_an_assembly_are_picked_where_they_stand(stand):
    everything = stand.toCompound().Faces()
    part = read_part(stand)
    ball = [f for f in everything if f.geomType() == "SPHERE"]
    chosen = plan(part, faces=ball, cutters="R3L40", spacing=4.0, tolerance=0.1, area_budget=0).plan
    assert {f.component for f in chosen.faces if f.target} == {"stand/pair/ball"}
    with pytest.raises(OptionError, match="in another place"):
        plan(part, faces=stand.children[0].children[1].obj.faces(), cutters="R3L40", spacing=4.0)


def test_labels_and_colours_of_build123d():
    hub, ball = bd.Cylinder(5, 10), bd.Pos(20, 0, 0) * bd.Sphere(3)
    hub.label, hub.color, ball.label = "hub", bd.Color(*RED), "ball"
    wheel = bd.Compound(label="wheel", children=[hub, ball])
    car = bd.Compound(label="car", children=[bd.Pos(0, 0, 30) * wheel, bd.Pos(50, 0, 0) * bd.Box(2, 2, 2)])
    car.color = bd.Color(*BLUE)
    for whole, x in ((car, 0), (bd.Pos(1, 0, 0) * car, 1)):
        part = read_part(whole)
        assert part.warnings == ()
        assert boxes(part) == {
            "car/wheel/hub": ([x - 5, -5, 25], [x + 5, 5, 35], {RED}),
            "car/wheel/ball": ([x + 17, -3, 27], [x + 23, 3, 33], {BLUE}),
            "car": ([x + 49, -1, -1], [x + 51, 1, 1], {BLUE}),
        }
        assert set(component_of(read_part(whole, guarded=True).tree).values()) == set(boxes(part))
    one = bd.Box(1, 1, 1)
    one.label = "one"
    assert set(component_of(read_part(one).tree).values()) == {"one"}
    picked = one.faces()[:2]
    picked[0].label = "seat"
    assert [f.name for f in read_part(picked).faces if f.number in read_part(picked).picked].count("seat") == 1


def test_children_that_were_moved_later_are_warned_of():
    a, b = bd.Box(2, 2, 2), bd.Pos(5, 0, 0) * bd.Box(2, 2, 2)
    a.label = "a"
    whole = bd.Compound(label="whole", children=[a, b])
    whole.children[0].location = bd.Location((0, 0, 9))
    part = read_part(whole)
    assert any(warning.startswith("a was moved") for warning in part.warnings)
    assert part.size == pytest.approx((7, 2, 2))
    assert read_part(whole.faces()).warnings == part.warnings


def test_lists_and_builders_are_parts(slotted, milled):
    with bd.BuildPart() as builder:
        bd.Box(4, 5, 6)
    assert read_part(builder).size == pytest.approx((4, 5, 6))
    block = bd.Pos(100, 0, 0) * bd.Box(2, 2, 2)
    block.label = "block"
    part = read_part([slotted, (block, slotted.val().moved(cq.Location((0, 100, 0))).wrapped)])
    assert part.solids == 3
    assert sorted(set(component_of(part.tree).values())) == ["", "block"]
    # Picked faces among shapes: the shape once.
    both = read_part([milled, *floor_of(milled)])
    assert (both.solids, len(both.picked)) == (1, 1)
    several = read_part([*floor_of(milled), *block.faces()[:1]])
    assert (several.solids, len(several.picked)) == (2, 2)
    for nothing in ([], [[]], [None], [slotted, "part.step"], cq.Assembly(), bd.Part()):
        with pytest.raises(ReadError):
            read_part(nothing)
    endless = []
    endless.append(endless)
    with pytest.raises(ReadError, match="holds itself"):
        read_part(endless)
    with pytest.raises(OptionError, match="holds itself"):
        plan(slotted, faces=endless)


def test_a_posture_map_sees_the_whole_solid(slotted):
    def free(part):
        found = posture_map(part, point=(0, 0, 0), cutter=WIDE, rotations=[0.0, 1.0], tolerance=0.05)
        return [len(each) for each in found.free]

    assert free(slotted.faces(FLOOR)) == [0, 0]
    assert free(slotted.faces(FLOOR).val()) == [1, 1]


def test_every_solid_and_face_is_there(stand):
    part = read_part(stand)
    assert len(part.faces) == shape_map(stand.toCompound().wrapped, TopAbs_FACE).Extent()
    assert sum(1 for _ in explore(part.shape, TopAbs_SOLID)) == 4
    numbers = [number for root in part.tree for number in root.numbers()]
    assert sorted(numbers) == [f.number for f in part.faces]
