"""Fixtures in the way: closed forms, the same obstacle as a face of the part, moved together, what they keep off and why."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from cad_io import read_part
from plan_cutters import Cutter, Fixture, FixtureError, Holder, Scene, plan, posture_map
from plan_cutters.domain.verdicts import FIXTURE, REASONS
from plan_cutters.kernels.material import windings
from plan_cutters.scene import surroundings as around_it
from tests.support import shapes, vises
from tests.support.cad_parts import box, compound
from tests.support.moulds import put
from tests.support.places import SAMPLES

CLOSE = 0.05  # deg
FLAT = {"area_budget": 0, "rotation_step": 0.35}


def free(part, cutter, rotations, fixtures, **options):
    found = posture_map(part, point=(0, 0, 0), cutter=cutter, rotations=np.radians(rotations), tolerance=0.0,
                        fixtures=fixtures, **options)  # fmt: skip
    return [np.degrees(i) for i in found.free]


def assert_intervals(found, *expected):
    found = found[(found[:, 1] - found[:, 0]) > 0.02]
    assert len(found) == len(expected), found
    assert found == pytest.approx(np.array(expected, float).reshape(-1, 2), abs=CLOSE)


@pytest.mark.parametrize(("a", "radius", "length"), [(6.0, 5.0, 50.0), (2.0, 5.0, 50.0), (9.0, 5.0, 12.0)])
def test_a_wall_beside_the_contact(a, radius, length):
    """As `test_closed_forms.test_plane_with_a_wall`, the wall a box that is a fixture."""
    part = shapes.shell(shapes.plane((-100, a), (-100, 100)))
    wall = f"box:30,200,100@{a},-100,-20"
    towards, away, along = free(part, Cutter.flat(radius=radius, length=length), [0, 180, 90], wall)
    assert_intervals(towards, (0, math.degrees(math.asin(min(1, a / length)))))
    assert_intervals(away, (math.degrees(math.acos(min(1, a / (2 * radius)))), 90))
    assert_intervals(along, *([(0, 90)] if radius <= a else []))


def test_a_jaw_above_the_part():
    """Its lower edge is at x = b, z = h. Leaning to it, the generator through the contact reaches its side at L sin(tilt) = b,
    above the edge; and all of the cutter is lower than the jaw from 2 R sin(tilt) + L cos(tilt) = h on."""
    part = shapes.shell(shapes.plane((-100, 100), (-100, 100)))
    radius, length, b, h = 5.0, 40.0, 10.0, 15.0
    (towards,) = free(part, Cutter.flat(radius=radius, length=length), [0], f"box:80,200,60@{b},-100,{h}")
    under = math.atan2(2 * radius, length) + math.acos(h / math.hypot(2 * radius, length))
    assert_intervals(towards, (0, math.degrees(math.asin(b / length))), (math.degrees(under), 90))


#: A small plate, and a holder that comes down beside it: R 30 above L 20 of a flat R 5.
TABLE_AT, HELD = -10.0, Cutter.flat(radius=5, length=20, holder=Holder.parse("R30L40"))


def plate(*more):
    return shapes.shell(shapes.plane((-20, 5), (-20, 20)), *more)


def test_a_table_under_a_tilted_holder():
    """The holder's nose comes down to L cos(tilt) - (Rh - R) sin(tilt) over the contact."""
    lowest = math.acos(TABLE_AT / math.hypot(20, 25)) - math.atan2(25, 20)
    for table in (f"table:{TABLE_AT}", f"table:3@0,0,{TABLE_AT - 3}", f"table:0@9,0,{TABLE_AT},0,0,30"):
        (towards,) = free(plate(), HELD, [0], table)
        assert_intervals(towards, (0, math.degrees(lowest)))


def test_a_table_askew():
    """Turned by 20 deg about y through the contact's foot: the same fall, seen from the table's normal."""
    turn = math.radians(20)
    (towards,) = free(plate(), HELD, [0], f"table:{TABLE_AT}@0,0,0,0,20,0")
    # The nose's lowest point against the table's normal (sin, 0, cos).
    tilts = np.radians(np.linspace(0, 90, 200001))
    x, z = 25 * np.cos(tilts) + 20 * np.sin(tilts), -25 * np.sin(tilts) + 20 * np.cos(tilts)
    low = x * math.sin(turn) + z * math.cos(turn)
    first = tilts[np.flatnonzero(low < TABLE_AT)]
    assert_intervals(towards, (0, math.degrees(first[0]) if len(first) else 90))


@pytest.mark.parametrize(
    ("cutter", "height", "tilts", "not_reached"),
    [("R5L20", -30, (0.5, 1.2), None), (HELD, -10, (0.9, 1.1), False), (HELD, -6, (0.9, 1.1), True)],
)
def test_a_fixture_and_a_face_of_the_part_give_the_same_verdicts(cutter, height, tilts, not_reached):
    floor = shapes.plane((-300, 300), (-300, 300), (0, 0, height))
    wall = shapes.plane((0, 60), (-40, 40), (8, 0, -5), (-1, 0, 0), (0, 0, 1))
    options = {"cutters": cutter, "faces": "1", "grid": 9, "tilt": tilts, "rotation": (0, 0.5)} | FLAT
    walled = not_reached is None
    faced = plan(plate(floor, *([wall] if walled else [])), **options)
    fixed = plan(plate(), fixtures=[f"table:{height}", *(["box:50,80,60@8,-40,-5"] if walled else [])], **options)
    (one,), (other,) = faced.reaches.values(), fixed.reaches.values()
    assert (one.verdict == other.verdict).all()
    if walled:
        assert one.not_reached.any()
        assert one.reached.any()
    else:
        assert one.not_reached.all() if not_reached else one.reached.all()
    if not one.not_reached.any():
        return
    # What the fixture stops is the holder: a longer stick-out would do, and is requested before another place of the fixture.
    assert {REASONS[r] for r in other.reason[other.not_reached]} == {"fixture" if walled else "holder"}
    assert set(fixed.cutters[0].by_reason) == set(REASONS)
    assert {w.obstacle_face for w in fixed.cutters[0].witnesses} & {"fixture:table", "fixture:box"}


def moved(fixture, angle, by):
    """A fixture turned about x and shifted."""
    x, y, z, rx, ry, rz = fixture.placement
    turned = Fixture("x.stl", (*by, angle, 0, 0))
    assert (ry, rz) == (0, 0)
    return replace(fixture, placement=(*turned.placed(np.array([x, y, z])).tolist(), rx + angle, 0, 0))


@pytest.mark.slow("another motion of the same law", but=("37",))
@pytest.mark.parametrize(("angle", "by"), [(90, (0, 0, 0)), (37, (11, -5, 3)), (-120, (0, 40, 0))])
def test_part_and_fixtures_moved_together_give_the_same_verdicts(angle, by):
    part = read_part(SAMPLES / "pocket_top.step")
    held = Fixture.each_of(["box:20,60,45@60.5,-10,-5", "cylinder:8,50@30,-9,5", Fixture(trimesh.Trimesh(
        *_indexed(vises.vise((60, 40, 20), 12.0))), name="vise")])  # fmt: skip
    options = {"cutters": "R9L30", "spacing": 4.0, "tilt": (0, 0.2)} | FLAT
    one = plan(part, fixtures=held, **options)
    shape = put(part.shape, math.radians(angle), (1, 0, 0), by)
    other = plan(shape, fixtures=[moved(each, angle, by) for each in held], **options)
    (a,), (b,) = one.reaches.values(), other.reaches.values()
    assert len(a.verdict) == len(b.verdict)
    assert (a.verdict == b.verdict).mean() > 0.995
    assert (a.reason == FIXTURE).any()
    assert ((a.reason == FIXTURE) == (b.reason == FIXTURE)).mean() > 0.995


def _indexed(vertex):
    return vertex.reshape(-1, 3), np.arange(3 * len(vertex)).reshape(-1, 3)


@pytest.fixture(scope="module")
def pocket():
    return Scene.of(SAMPLES / "pocket_top.step")


def test_what_fixtures_keep_is_what_is_reached_without_them(pocket):
    options = {"cutters": ["R3L25", "R9L30"], "spacing": 3.0} | FLAT
    without, held = plan(pocket, **options), plan(pocket, fixtures=["box:20,50,60@60.5,-5,0"], **options)
    for name, reach in held.reaches.items():
        before, not_reached = without.reaches[name], reach.not_reached
        assert not_reached[before.not_reached].all(), "a fixture opens nothing"
        assert (reach.reason[not_reached & before.reached] == FIXTURE).all()
        assert (reach.reason[not_reached & before.not_reached] == before.reason[not_reached & before.not_reached]).all()
    entry = held.cutters[0]
    assert entry.by_reason["fixture"] + entry.undecided_by_reason["fixture"] > 0
    found = [w for w in entry.witnesses if w.reason == "fixture"]
    assert any(w.obstacle_face == "fixture:box" and w.depth_mm > 0 for w in found)
    assert held.plan.reasons[FIXTURE] == "fixture"


def test_rows_are_judged_alike_with_fixtures(pocket):
    from plan_cutters.judging.judge import judge
    from plan_cutters.options import Options
    from plan_cutters.pipeline import prepare

    ready = prepare(pocket, Options.of({"cutters": "R9L30", "spacing": 1.5, "fixtures": "box:20,50,60@60.5,-5,0"} | FLAT))
    cutter = Cutter.parse("R9L30")
    whole = judge(ready, cutter)
    assert (whole.reason == FIXTURE).any()
    assert len(whole.verdict) > 1024
    for rows in (np.arange(0, 600), np.arange(700, len(whole.verdict)), np.arange(3, len(whole.verdict), 7)):
        assert judge(ready, cutter, rows) == whole.of(rows)


def test_other_fixtures_cost_no_tessellation(monkeypatch):
    calls, real = [], around_it.tessellate
    monkeypatch.setattr(around_it, "tessellate", lambda *given, **more: calls.append(1) or real(*given, **more))
    scene = Scene.of(SAMPLES / "v_groove.step")
    options = {"cutters": "R3L40", "grid": 9} | FLAT
    one = plan(scene, **options)
    two = plan(scene, fixtures="box:4,4,4@0,0,40", **options)
    three = plan(two.scene, fixtures=["box:4,4,4@0,0,40", "cylinder:4,4@0,0,50"], **options)
    assert len(calls) == 1
    assert two.scene.surround().possible is not one.scene.surround().possible
    assert (three.scene.surround().alone, two.scene.surround().alone) == (one.scene.surround(), one.scene.surround())
    again = plan(three.scene, fixtures=[], **options)
    assert len(calls) == 1
    assert again.reaches == one.reaches
    # A fixture of the CAD kind is tessellated once, wherever it stands.
    jaw = box(10, 10, 10)
    first = scene.clamped([Fixture(jaw, (0, 0, 40))])
    _ = first.surround(), first.clamped([Fixture(jaw, (5, 0, 50))]).surround()
    assert len(calls) == 2
    # A scene has the fixtures that it was made with, and a plan of it, too.
    assert [e.name for e in plan(two.scene, **options).plan.fixtures] == ["fixture:box"]


def test_nothing_lies_safe_within_a_fixture(pocket):
    """The target faces on a table, or under a jaw: every posture would stand in it."""
    block = box(40, 30, 20)
    options = {"cutters": "R4L12", "faces": "all", "spacing": 6.0} | FLAT
    part, solid = read_part(block), ["table:0", "box:300,200,90@-100,-80,20"]
    bare = plan(part, **options)
    assert bare.cutters[0].feasible
    held = plan(part, fixtures=solid, **options)
    (reach,) = held.reaches.values()
    z = held.samples.normal[:, 2]
    for rows, name in ((z < -0.9, "fixture:table"), (z > 0.9, "fixture:box")):
        assert reach.not_reached[rows].all()
        assert (reach.reason[rows] == FIXTURE).all()
        assert name in {w.obstacle_face for w in held.cutters[0].witnesses}
    # The same as triangles with the inside out, or that run both ways.
    mesh = vises.block((-100, -80, 20), (200, 120, 110))
    mixed = mesh.copy()
    mixed[::3] = mixed[::3, ::-1]
    for vertex in (mesh, mesh[:, ::-1], mixed):
        other = plan(part, fixtures=["table:0", trimesh.Trimesh(*_indexed(vertex), process=False)], **options)
        assert (next(iter(other.reaches.values())).not_reached == reach.not_reached).all()
        assert other.plan.fixtures[1].watertight
    # An open one: only its surface is in the way.
    sheet = plan(part, fixtures=[trimesh.Trimesh(*_indexed(mesh[:-1]), process=False)], **options).plan.fixtures[0]
    assert not sheet.watertight
    assert any("only its surface" in note for note in sheet.notes)


def test_cells_that_are_outside_are_so(pocket):
    """The grid about the part against the winding numbers, among fixtures that reach far beyond it."""
    around = pocket.clamped(
        ["table:-3", "box:30,90,60@61,-20,-2", "cylinder:9,20@30,-10,1", "box:9,9,9@300,0,0,0,0,40"]
    ).surround()
    obstacles = around.possible
    assert not obstacles.solids.whole
    assert 0.05 < obstacles.solids.cell.mean() < 0.95
    rng = np.random.default_rng(4)
    low, high = obstacles.near
    points = rng.uniform(low - 0.6 * (high - low), high + 0.6 * (high - low), (20000, 3))
    points = np.concatenate([points, rng.uniform(-400, 400, (2000, 3))])
    ours, truth = np.zeros(len(points)), np.zeros(len(points))
    windings(points, obstacles.solids, ours)
    windings(points, obstacles._everywhere, truth)
    assert ((ours > 0.5) == (truth > 0.5)).all()
    assert (ours == 0).mean() > 0.2


@pytest.mark.parametrize(
    ("fixture", "depth"),
    [("box:50,30,10@5,5,-8.5", 1.5), ("box:1,1,80@20,15,-30", 10), ("box:200,200,200@-100,-100,-100", 100), ("table:4", 4.0),
     ("cylinder:3,50@0,15,5", 3.0)],
)  # fmt: skip
def test_a_fixture_in_the_part_is_refused_with_its_depth(fixture, depth):
    part = read_part(box(40, 30, 20))
    with pytest.raises(FixtureError, match=r"fixture:\w+ and the part stand .* mm deep in each other at") as error:
        plan(part, cutters="R4L12", fixtures=fixture, **FLAT)
    told = float(str(error.value).split("stand ")[1].split(" mm")[0])
    assert told == pytest.approx(depth, rel=0.02)


@pytest.mark.slow("another gap of the same law", but=("0.0", "-0.009"))
@pytest.mark.parametrize("gap", [0.0, 1e-9, -0.009, 0.5])
def test_fixtures_may_touch_the_part(gap):
    part = read_part(box(40, 30, 20))
    jaws = [f"box:10,30,15@{-10 - gap},0,0", f"table:{-gap}", f"cylinder:5,10@20,15,{20 + gap}"]
    result = plan(part, cutters="R4L12", faces="all", spacing=6.0, fixtures=jaws, **FLAT)
    assert len(result.plan.fixtures) == 3


def test_a_fixture_through_a_sheet_has_no_depth_but_one_around_it_has():
    sheet = shapes.shell(shapes.plane((-20, 20), (-20, 20)))
    assert plan(sheet, cutters="R4L12", grid=5, fixtures="box:5,5,5@0,0,0", **FLAT).plan.fixtures
    with pytest.raises(FixtureError, match=r"stand 2\.5 mm deep"):
        plan(sheet, cutters="R4L12", grid=5, fixtures="box:5,5,5@0,0,-2.5", **FLAT)


def test_the_chord_error_is_the_larger_one(pocket):
    own = pocket.surround().certain.triangles.chord_error
    rod = pocket.clamped("cylinder:8,30@30,-9,5").surround().certain.triangles.chord_error
    assert own <= rod <= 0.2 * 0.01 * (1 + 1e-9)
    block = trimesh.Trimesh(*_indexed(vises.block((61, 0, 0), (70, 9, 9))))
    scene = pocket.clamped(Fixture(block, chord_error=0.01))
    assert scene.surround().certain.triangles.chord_error == 0.01
    assert scene.surround().tolerance(scene.asked) == pytest.approx(0.04)


def test_objects_of_the_kernel_and_hosts(pocket):
    import cadquery

    held = [box(10, 10, 10, (61, 0, 0)), cadquery.Workplane().box(9, 9, 9), read_part(box(9, 9, 9))]
    result = plan(pocket, cutters="R3L25", spacing=5.0, fixtures=[Fixture(held[0]), Fixture(held[1], (80, 0, 0)),
                  Fixture(held[2], (80, 30, 0, 0, 0, 45), name="post")], **FLAT)  # fmt: skip
    assert [(e.name, e.file, e.triangles >= 12, e.watertight) for e in result.plan.fixtures] == [
        ("fixture:fixture", None, True, True), ("fixture:fixture 2", None, True, True), ("fixture:post", None, True, True),
    ]  # fmt: skip
    again = pickle.loads(pickle.dumps(result))
    assert again.plan == result.plan
    assert plan(again.scene, cutters="R3L25", spacing=5.0, **FLAT).reaches == result.reaches


def test_a_compound_holds_its_part_by_its_own_solids():
    """A fixture of several solids that touch: each encloses."""
    held = compound(box(10, 30, 15, (-10, 0, 0)), box(10, 30, 15, (-20, 0, 0)))
    result = plan(read_part(box(40, 30, 20)), cutters="R4L12", spacing=6.0, faces="all", fixtures=held, **FLAT)
    assert result.plan.fixtures[0].watertight


@pytest.mark.slow("searches long")
def test_a_vise_of_many_triangles_adds_little_to_the_search(pocket):
    """Boxes and triangles that the search of 20 samples looks at, with 50,000 triangles more around 20,000 of the part."""
    from plan_cutters.judging.judge import judge
    from plan_cutters.options import Options
    from plan_cutters.pipeline import prepare
    from tests.support.counted import counted

    found = vises.vise((60, 40, 24), 15.5, longest=2.0)
    assert len(found) > 50_000
    calls = []
    for fixtures in ([], [Fixture(trimesh.Trimesh(*_indexed(found), process=False))]):
        ready = prepare(pocket, Options.of({"cutters": "R6L60", "spacing": 1.0, "fixtures": fixtures} | FLAT))
        few = np.zeros_like(ready.samples.unjudged)
        few[1250:1270] = -1
        some = replace(ready, samples=replace(ready.samples, unjudged=few))
        with counted() as each:
            reach = judge(some, Cutter.parse("R6L60"))
        assert reach.reached.sum() == 20
        calls.append(each)
    alone, held = calls
    assert alone["alive"] > 300
    assert held["alive"] <= 1.4 * alone["alive"]
    assert held["triangle_hit"] <= 1.25 * alone["triangle_hit"]
    assert held["_solid_angle"] == 0
