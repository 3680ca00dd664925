"""What the scene says of small parts is kept in `kept`: obstacles and fixtures, material, choices of faces, setups."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
import trimesh
from OCP.TopLoc import TopLoc_Location

from cad_io import read_part
from cad_io.arrays import Triangles
from cad_io.errors import CadIoError
from cad_io.kernel import faces
from cad_io.kernel.shapes import Node
from cad_io.part.bodies import orient
from plan_cutters import Cutter, Machine, Scene
from plan_cutters.document.notes import notes_of
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import FIXTURE, INACCESSIBLE
from plan_cutters.judging.judge import judge
from plan_cutters.options import Options
from plan_cutters.scene import covering
from plan_cutters.scene import fixtures as overlapping
from plan_cutters.scene import preparation as spacing
from plan_cutters.scene import surroundings as gathered
from plan_cutters.scene.copied import keeps as keeps_setup
from plan_cutters.scene.copied import some_of, with_copies
from plan_cutters.scene.covering import coverings, sheets
from plan_cutters.scene.faces import choose, face_numbers, grammar, ignored_faces, ignored_words, select_faces
from plan_cutters.scene.fixtures import joined, overlap, overlaps, refuse_overlaps
from plan_cutters.scene.inside_material import cover, inside_bodies, inside_material, voids
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.preparation import for_another_setup, stood_on
from plan_cutters.scene.surroundings import surroundings
from plan_cutters.scene.triangles import divided, thickened
from plan_cutters.scene.work import in_chunks, with_company
from plan_cutters.setups import solids
from plan_cutters.setups.workpiece import clipped, stands
from tests.support.cad_parts import box, compound, cut, rod
from tests.support.kept_parts import part, ready, said_by

UP, DOWN, ASIDE = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.6, 0.0, 0.8)


def of_obstacles(obstacles):
    """Triangles, what they enclose and their tree; numbers of a process are none of it."""
    return {
        "triangles": obstacles.triangles, "weight": obstacles.weight, "boxes": obstacles.open_boxes, "gap": obstacles.gap,
        "near": obstacles.near, "extent": obstacles._extent, "end": obstacles._end,
        "solids": obstacles.solids._replace(key=0), "faces": obstacles.faces,
    }  # fmt: skip


def of_surroundings(around):
    return {
        "possible": of_obstacles(around.possible),
        "certain": of_obstacles(around.certain),
        "bodies": around.bodies,
        "missing": around.missing,
        "on": around.on_bodies,
        "doubts": around.doubts,
        "loose": around.loose,
        "tolerance": [around.tolerance(each) for each in (1e-6, 0.01, 0.3)],
        "one": around.certain is around.possible,
        "called": [around.called(each) for each in (3, *(-1 - k for k in range(len(around.fixtures))))],
        "fixtures": [
            {
                **{
                    name: getattr(each, name)
                    for name in ("number", "name", "body", "missing", "notes", "shown", "hold", "unheld")
                },
                "words": each.fixture.text,
                "obstacles": each.obstacles.triangles,
            }
            for each in around.fixtures
        ],
    }


@pytest.mark.parametrize("name", ["bodies", "open", "hollow", "bracket"])
def test_what_stands_around_a_part(name, keeps):
    of = part(name)
    keeps(f"around_{name}", [of_surroundings(surroundings(of, 0.05)),
                             of_surroundings(surroundings(of, 0.2, ignored=(2, 3), jobs=2))])  # fmt: skip


def half_tube(radius, at):
    tube = cut(rod(radius, 9.3, at), box(99, 99, 99, (at[0], -50, -50)))
    return next(each for each in faces(tube) if cq.Face(each).geomType() == "CYLINDER")


def round_plate(radius, at):
    """With a hole beside its middle."""
    bored = cut(rod(radius, 9.3, at), rod(0.5 * radius, 99, (at[0] + 1, at[1], -9)))
    return next(each for each in faces(bored) if abs(cq.Face(each).Center().z - at[2]) < 1e-6)


def test_sheets_of_many_triangles_on_bodies(keeps):
    """On two rods, nearly on them, more or less than half of them beyond, and in the open."""
    tubes = [half_tube(radius, at) for radius, at in ((9.3, (0, 0, 0.4)), (9.9, (0, 0, 2.1)))]
    plates = [round_plate(5.1, at) for at in ((0, 0, 17.1), (31, 0, 8.2), (35, 0, 0), (38, 1, 0), (70, 0, 0))]
    of = read_part(compound(rod(9.3, 17.1), rod(7.1, 8.2, (31.0, 0.0, 0.0)), *tubes, *plates))
    keeps("sheets", [[around.on_bodies, around.doubts, len(around.certain.triangles)]
                     for around in (surroundings(of, chord) for chord in (0.3, 0.1, 0.02))])  # fmt: skip


@pytest.mark.parametrize("errors", [{2: 0.3}, {1: 0.04, 8: 2.5, 13: 9.9}])
def test_what_stands_around_a_part_with_loose_faces(errors, keeps, monkeypatch):
    real = gathered.tessellate
    monkeypatch.setattr(gathered, "tessellate", lambda *given, **more: replace(real(*given, **more), loose=tuple(errors.items())))
    keeps(f"loose_{len(errors)}", of_surroundings(surroundings(part("bodies"), 0.05)))


def mesh(open_=False):
    whole = trimesh.creation.box((4.2, 5.1, 3.3))
    other = trimesh.creation.box((1.2, 1.1, 1.3), transform=trimesh.transformations.translation_matrix((7.0, 0.3, 0.1)))
    other.invert()
    if open_:
        whole.update_faces(np.arange(len(whole.faces)) > 1)
    return trimesh.util.concatenate([whole, other])


FIXTURES = {
    "words": ["box:7,9,11@18.1,1,-3,0,0,12", "cylinder:3,12@-6,4,-2,20,0,0", "table", "table:-4.5@0,0,-3,10,0,0"],
    "meshes": [mesh(), mesh(open_=True)],
    "vise": ["vise:46x25x65:3:17.3@8.65,6.95,0"],
    "chuck": ["chuck:3x20:3:31@8.65,6.95,-9", "table:-30"],
    "part": [part("open"), "table"],
}


@pytest.mark.parametrize("name", FIXTURES)
def test_fixtures_around_a_part(name, keeps):
    """Placed, joined with the part, for two setups and beside those of another one."""
    words, side = Fixture.each_of(FIXTURES[name]), orient(part("bodies"), towards=UP, flip=False).sign
    alone = surroundings(part("bodies"), 0.05)
    both = [joined(alone, words, 0.05, {}, axis, words[:1], DOWN, sign=side) for axis in (UP, ASIDE)]
    keeps(f"fixtures_{name}", [of_surroundings(both[0]), of_surroundings(both[1])["fixtures"], both[0].alone is alone])


def test_triangles_cut_and_divided(keeps):
    rng = np.random.default_rng(12)
    vertex, face = rng.uniform(-5, 5, (40, 3, 3)), np.arange(40, dtype=np.int32)
    vertex[:6, :2, 2] = 1.0  # just on a limit
    said = {"clipped": [clipped(vertex, face, np.array(axis), low, high) for axis, low, high in
                        (((0.0, 0.0, 1.0), -1.0, 1.0), ((0.6, 0.0, 0.8), 0.3, 9.0))],
            "stands": [stands(low, 3.0) for low in (0.0, 1.5, 1.6)]}  # fmt: skip
    said["divided"] = [divided(vertex, np.full(3, -4.0), np.array([3.0, 4.0, 1.0]), 1.7, most) for most in (None, 30, 40, 41)]
    needle = vertex[:3].copy()
    needle[0, 1] = needle[0, 0]
    needle[1, 2] = 0.5 * (needle[1, 0] + needle[1, 1]) + [0, 0, 1e-12]
    needle[2, 2] = 0.3 * needle[2, 0] + 0.7 * needle[2, 1] + [0, 0, 1e-3]
    said["thickened"] = [thickened(each, error) for each in (vertex[:5], needle, vertex[:0]) for error in (0.0, 0.3)]
    said["sides"] = [
        solids.sides_of(radius, chord) for radius, chord in ((9.0, 0.01), (1.0, 2.0), (1.0, 0.9), (500.0, 1e-6), (7.7, 0.3))
    ]
    said["prisms"] = [solids.cylinder(3.3, 4.1, 9), solids.strip(np.array([[0.0, 0.0], [2.2, 0.1], [3.0, 1.4]]),
                      np.array([[0.1, 2.0], [2.0, 2.2], [2.4, 3.3]]), -1.0, 2.5)]  # fmt: skip
    keeps("cut", said)


def test_cutters_in_what_encloses(keeps):
    """Whether cutters that touch no skin lie in a body, with loose skins and open ones, and among fixtures."""
    rng, said = np.random.default_rng(9), {}
    for name, around in (
        ("bodies", surroundings(part("bodies"), 0.05)),
        ("open", surroundings(part("bodies"), 0.05, ignored=(2,))),
        ("sunk", surroundings(part("sunk"), 0.05)),
        ("fixture", joined(surroundings(part("sunk"), 0.05), Fixture.each_of(["box:40,40,9@-9,-9,15"]), 0.05, {})),
    ):
        tool = assembly(Cutter.parse("D1L3"), 0.0, 0.0)
        point, normal = rng.uniform(-2, 19, (60, 3)), np.tile(UP, (60, 1))
        direction, tilt = np.tile((1.0, 0.0, 0.0), (60, 1)), rng.uniform(0, 1.5, 60)
        said[name] = [
            each.holds(tool, point, normal, direction, tilt, certain=certain)
            for each in (around.possible, around.certain)
            for certain in (False, True)
        ]
        said[name] += [
            around.possible.skin.weight,
            [len(around.certain.skin_of(body).triangles) for body in around.bodies],
            around.possible.wide_tree._asdict(),
        ]
        loose = replace(around.possible, gap=3.0)
        said[name] += [loose.solids._replace(key=0), loose._extent]
    for broken in (
        Triangles(np.zeros((0, 3, 3)), np.zeros(0, np.int32), 0.0, ()),
        Triangles(np.full((1, 3, 3), np.nan), np.ones(1, np.int32), 0.0, ()),
    ):
        said[f"broken {len(broken)}"] = said_by(Obstacles, broken)
    keeps("encloses", said)


def test_fixtures_in_the_part(keeps, monkeypatch):
    monkeypatch.setattr(overlapping, "_APART", 1 / 16)
    alone = surroundings(part("bodies"), 0.05)
    around, said = alone.certain, {}
    for name, word in (("deep", "box:6,5,4@-3,2,1"), ("barely", "box:6,5,4@-5.995,2,1"), ("touching", "box:6,5,4@-6,2,1"),
                       ("far", "box:6,5,4@-60,2,1"), ("round", "cylinder:2.2,9@13.1,3.3,5.5"), ("within", "box:2,2,2@13,1,2"),
                       ("around", "box:60,60,60@-20,-20,-20"), ("vise", "vise:46x25x65:3:16.9@8.65,6.95,0")):  # fmt: skip
        both = joined(alone, Fixture.each_of([word]), 0.05, {})
        mine = both.fixtures[0].obstacles
        said[name] = [overlap(around, mine, 0.01), overlaps(around, mine, 0.01), said_by(refuse_overlaps, both, 0.01)]
    said["sheet"] = overlap(Obstacles(around.triangles), mine, 0.01)
    keeps("overlaps", said)


def test_what_lies_in_material(keeps, monkeypatch):
    said = {}
    for name in ("open", "hollow", "bodies"):
        of = part(name)
        options = Options.of({"cutters": "D3L18", "faces": "all", "spacing": 1.7, "area_budget": 0, "jobs": 2})
        around, side = surroundings(of, 0.05), orient(of, towards=UP, flip=False)
        samples = spacing.sampled(of, side, options, [face.number for face in of.faces], options.judged).samples
        found = inside_material(samples, side, around.bodies, around.certain, 0.01)
        loose = replace(around.certain, triangles=replace(around.certain.triangles, loose=((8, 1.0),)))
        held = joined(around, Fixture.each_of(["box:9,9,4@4,4,6"]), 0.05, {})
        out = [cover(samples.point[k], samples.normal[k], around.certain, body) for k in range(0, len(samples), 9)
               for body in (None, *around.bodies)]  # fmt: skip
        said[name] = {
            "inside": found, "voids": voids(around.bodies, side), "no surface": inside_bodies(found, around.bodies, side),
            "loose": inside_material(samples, side, around.bodies, loose, 0.01),
            "known": inside_material(samples, side, held.enclosing, held.certain, 0.3, 2, known=found), "out": out,
        }  # fmt: skip
    out = [
        cover(np.array(point), np.array(UP), held.certain, body)
        for point in ((5.0, 5.0, 7.0), (8.1, 8.2, 9.9), (12.9, 4.1, 6.2), (5.0, 5.0, 11.0)) for body in (None, *held.enclosing)
    ]  # fmt: skip
    said["out of a fixture"] = out
    made = ready("bodies", cutters=("D3L18",), grid=4)
    said["covers"] = [*coverings(made), sheets(made)]
    # The same as components, of which two have one name.
    rooms = {number: f"a/{'b' if number < 13 else 'c'}" for number in range(1, 19)}
    monkeypatch.setattr(covering, "component_of", lambda tree: rooms)
    monkeypatch.setattr(
        covering, "faces_of", lambda tree, name: {n for n, path in rooms.items() if f"/{path}".endswith(f"/{name}")}
    )
    said["named"] = [*coverings(made)]
    standing = ready("bodies", cutters=("D3L18",), grid=9, patterns=False)
    said["standing"] = [*coverings(standing), sheets(standing)]
    keeps("material", said)


WORD = (
    "sculptured",
    "blends",
    "sculptured,blends",
    "all",
    "F2",
    "2-4,7",
    "!F1-F9",
    "all,3",
    "blends, 5",
    "name:^B",
    "color:#ff0000",
    "!sculptured",
    "F0",
    "3-1",
    "99",
    "",
    "nobody",
    "name:(",
    "component:x",
)


@pytest.mark.parametrize("name", ["bracket", "patch", "drum"])
def test_choices_of_faces(name, keeps):
    of, said = part(name), {}
    for word in WORD:
        said[word] = [said_by(choose, of, word, ignored, ("x",)) for ignored in ((), (2, 3))]
    said["grammar"] = [said_by(grammar, word, "--faces") for word in WORD]
    said["none"] = choose(of, None, (), ())
    said["objects"] = [said_by(face_numbers, of, each) for each in (1, [2, 1], "F1", [of.face(1)], True, 3.5)]
    said["ignored"] = [said_by(ignored_faces, of, ignored_words(of, each)) for each in (None, "F1", ["F1", "blends"], (2,), "x")]
    first, other = Placement(UP, clamped=("F1",)), Placement(DOWN, clamped=("F1-F2",))
    for word in ("all", "F1"):
        said[f"held {word}"] = [said_by(choose, of, word, (), (), first, others, {3: 1} if others else {})
                                for others in ((), (other,), (None,))]  # fmt: skip
    said["repeated"] = [said_by(select_faces, of.faces, word, ignored=(2,), repeated={2: 1}) for word in ("F2", "F1-F2", "all")]
    keeps(f"faces_{name}", said)


def test_choices_of_components(keeps):
    rim, hub = Node("ring", "rim", TopLoc_Location(), faces=(1, 2)), Node("hub", "", TopLoc_Location(), faces=(3,))
    tree = (Node("wheel", "left", TopLoc_Location(), children=(rim, hub)), Node("ring", "", TopLoc_Location(), faces=(4, 5)))
    faces = part("drum").faces
    words = ("left/rim", "rim", "ring", "wheel", "hub", "/left/", "left/", "/", "", "nobody")
    said = {word: said_by(select_faces, faces, f"component:{word}", tree=tree) for word in words}
    said |= {f"no names {word}": said_by(select_faces, faces, f"component:{word}") for word in ("rim", "")}
    keeps("components", said | {"long": said_by(select_faces, faces, "x" * 70), "sixty": said_by(select_faces, faces, "x" * 60)})


def placed():
    """Two setups of a block: jaws and a table, and jaws at other places; what is held differs."""
    first = Placement(UP, clamped=("F1",), fixtures=tuple(map(Fixture.parse, ("box:9,20,11@17.3,-3,-7", "table:-7.5"))))
    other = Placement(ASIDE, x=(0.0, 1.0, 0.0), clamped=("F2",), fixtures=(Fixture.parse("box:5,20,11@-5,-3,-7"),))
    return {"setup": first, "other_setups": (other, DOWN)}


def proposed():
    held = Placement(UP, fixtures=(Fixture.parse("vise"),), stands_on=("F2",), proposed=True)
    return {"setup": held, "other_setups": (Placement(DOWN, fixtures=(Fixture.parse("vise"),)),)}


def standing():
    held = Placement(UP, fixtures=(Fixture.parse("box:9,20,11@17.3,-3,-7"),), stands_on=("F2", "F4"), proposed=True)
    return {"setup": held, "other_setups": (Placement(DOWN, stands_on=("F3",)), ASIDE)}


@pytest.mark.parametrize("name", ["placed", "proposed", "standing", "plain"])
def test_setups_of_a_part(name, keeps):
    how = {
        "placed": placed,
        "proposed": proposed,
        "standing": standing,
        "plain": lambda: {"other_setups": (DOWN,), "fixtures": ("table",)},
    }[name]()
    made = ready("bodies", cutters=("D3L18",), grid=4, **how)
    said = {}
    for k, conditions in enumerate(made.setups):
        there = made.there(k)
        said[f"setup {k}"] = {
            "frame": conditions.frame,
            "tolerance": conditions.tolerance,
            "around": of_surroundings(conditions.surroundings)["fixtures"],
            "inside": there.inside,
            "clamped": there.clamped,
            "shut": there.shut,
            "alike": there.alike,
            "alone": made.alone(k).axes[:1],
            "ranges": conditions.ranges,
        }
    lost = judge(made, made.cutters[0])
    reason = np.where(np.arange(len(lost.reason)) % 2 == 0, FIXTURE, lost.reason).astype(np.uint8)
    lost = replace(lost, verdict=np.where(lost.reached, np.uint8(1), np.uint8(INACCESSIBLE)).astype(np.uint8), reason=reason)
    said |= {
        "axes": made.axes,
        "machinable": made.machinable,
        "somewhere": made.somewhere,
        "finished": made.finished,
        "alike": made.alike,
        "stood on": stood_on(made),
        "another": for_another_setup(made, lost).reason,
        "notes": notes_of(made, ()),
        "under": made.under(tolerance=0.3).others[0].conditions.tolerance,
        "exempt": replace(made, exempt=np.arange(len(made.samples)) % 3 == 0).finished,
    }
    keeps(f"setups_{name}", said)


def test_scenes(keeps):
    of, said = part("bodies"), {}
    scene = Scene.of(of, ignore="F3", tolerance=0.02, fixtures=["table"])
    for name, options in (
        ("same", {"tolerance": 0.02}),
        ("other", {"tolerance": 0.01}),
        ("setup", {"setup": (0, 0, 2)}),
        ("aside", {"setup": "x"}),
        ("flip", {"flip": True}),
        ("unknown", {"grid": 3}),
        ("zero", {"tolerance": 0}),
    ):
        found = said_by(Scene.of, scene if name != "zero" else of, **options)
        said[name] = found if isinstance(found, str) else [found is scene, found.options["tolerance"]]
    for axis in (UP, ASIDE):
        said[str(axis)] = [
            of_surroundings(scene.surround_in(axis, (), (Fixture.parse("table:-2"),)))["fixtures"],
            of_surroundings(scene.surround_held(axis, "table"))["fixtures"],
            scene.same_sides(axis),
        ]
    said["closer"] = scene.surround_closer(0.4).possible.triangles
    double = read_part(compound(box(7.1, 5.2, 3.3), box(7.1, 5.2, 3.3)))
    again = Scene.of(double, setup=ASIDE, flip=True)
    said["repeated"] = [
        said_by(choose, again.part, word, again.ignored, (), repeated=again.repeated) for word in ("all", "F1", "F9")
    ]
    several = Scene.of(read_part(compound(box(7.1, 5.2, 3.3), box(7.1, 5.2, 3.3), box(7.1, 5.2, 3.3, (0, 0, 3.3)))))
    said["several"] = [
        several.ignored,
        several.repeated,
        several.doubles,
        choose(several.part, "all", several.ignored, (), repeated=several.repeated),
    ]
    half = Scene.of(double, ignore=("F1", "F7"))
    said["half"] = [half.ignored, half.repeated, half.doubles, choose(double, "all", half.ignored, (), repeated=half.repeated)]
    bare = scene.clamped(())
    said["clamped"] = [
        scene.clamped(("table",)) is scene,
        len(bare.surround().fixtures),
        bare.surround().tolerance(bare.asked),
        bare.turned_faces(),
        len(bare.surround_closer(0.2).fixtures),
    ]
    said["word"] = said_by(Scene.of, of, setup=Placement(UP))
    said["double"] = [again.ignored, again.repeated, again.doubles, again.turned_faces(), again.turned_to(DOWN).setup]
    said["sheets"] = [Scene.of(part("open"), setup=axis).turned_faces() for axis in (UP, DOWN, (1.0, 0.0, 0.0))]
    keeps("scenes", said)


def test_files_of_fixtures_are_read_once_and_before_any_work(tmp_path):
    mesh().export(tmp_path / "jaw.stl")
    scene = Scene.of(part("bodies"), fixtures=[f"{tmp_path / 'jaw.stl'}@40,0,5", "table"])
    scene.read_fixtures(60.0)
    (tmp_path / "jaw.stl").unlink()
    assert [each.name for each in scene.surround().fixtures] == ["fixture:jaw", "fixture:table"]
    with pytest.raises(CadIoError, match="no such file"):
        Scene.of(part("bodies"), fixtures=[str(tmp_path / "jaw.stl")]).read_fixtures(60.0)


def test_scenes_that_are_asked_and_others_are_equal():
    one, other = (Scene.of(part("bodies"), tolerance=0.02, fixtures=["table"]) for _ in range(2))
    one.surround()
    assert one == other != Scene.of(part("bodies"), tolerance=0.01, fixtures=["table"])


def test_cells_about_a_part_on_a_large_fixture_that_stands_askew(keeps):
    """A triangle across all the cells, and the part's own: what is surely outside, with the part near and with none."""
    large = np.array([[[-90.0, -75.0, -31.0], [110.0, -60.0, 33.0], [3.0, 140.0, 55.0]]])
    block = solids.box(np.array([0.0, 0.0, 20.0]), np.array([7.1, 5.3, 24.2]))
    triangles = Triangles(np.concatenate([block, large]), np.r_[np.full(12, 3), -1].astype(np.int32), 0.01, ())
    said = []
    for near in (None, np.array([[0.0, 0.0, 20.0], [7.1, 5.3, 24.2]])):
        for gap in (0.0, 0.2, 1.1, 40.0):
            for boxes in (np.zeros((0, 2, 3)), np.array([[[6.0, 4.0, 23.0], [9.0, 6.0, 26.0]]])):
                around = Obstacles(triangles, np.r_[np.ones(12), 0].astype(np.int8))
                around = replace(around, near=near, gap=gap, open_boxes=boxes)
                cell, origin, size, whole = around._cells()
                said.append([cell, int(cell.sum()), origin, size, whole, around._end, around._extent])
    keeps("cells_askew", said)


def test_samples_where_nobody_says_how_many(keeps, monkeypatch):
    of, said = part("bracket"), {}
    side = orient(of, towards=UP, flip=False)
    faces = [face.number for face in of.faces]
    for cutters in (("D3L20",), ("D9L20", "D12L20"), ("D40L60",), ("D0.1L2",)):
        said[str(cutters)] = spacing.default_spacing(of, side, faces, [Cutter.parse(each) for each in cutters])
    monkeypatch.setattr(spacing, "BUDGET", 900)
    said["coarse"] = spacing.default_spacing(of, side, faces[:5], [Cutter.parse("D3L20")])
    for asked in ({"grid": 3}, {"spacing": 2.2}, {}):
        options = Options.of({"cutters": "D9L20", "faces": "all", **asked})
        found = spacing.sampled(of, side, options, faces[:6], options.judged)
        said[str(asked)] = [
            found.samples.point,
            found.samples.area,
            found.spacing,
            found.coarser,
            spacing.spacing_key(options, options.judged),
        ]
    for most in ("100", "x", ""):
        monkeypatch.setenv(spacing.MOST, most)
        for asked in ({"grid": 3}, {"spacing": 0.01}, {"spacing": 9.0}, {}):
            said[f"{most} {asked}"] = said_by(spacing.affordable, of, faces[:6], Options.of({"cutters": "D9L20", **asked}))
    keeps("spacing", said)


def test_copies(keeps):
    made = ready("plate", cutters=("D5.3L17F6S9",), spacing=2.1, machine="tilt:47", other_setups=(DOWN, (1.0, 0.0, 0.0)))
    rows = np.arange(0, len(made.samples), 7)
    some, copies = some_of(made, rows), made.copies
    motions = copies.motions
    held = replace(
        made.conditions, surroundings=joined(made.conditions.surroundings, Fixture.each_of(["box:1,1,1@70,0,0"]), 0.05, {})
    )
    moved = copies.moved(np.flatnonzero(copies.copy)[:40], made.samples.normal[copies.master[copies.copy][:40]])
    keeps(
        "copies",
        {
            "copies": replace(copies, motions=()),
            "follow": [replace(copies, setup=k).follow for k in range(3)],
            "moved": moved,
            "linear": np.array([each.linear for each in motions]),
            "shift": np.array([each.shift for each in motions]),
            "some": [some.samples, some.surface_class, some.inside, some.shut],
            "keeps": [
                [keeps_setup(made, conditions, each, made.patterns) for each in motions] for conditions in (*made.setups, held)
            ],
        },
    )
    machines = ("tilt:20", "trunnion-ac", "head-head-ca", "nutating-bc")
    limits = [made.under(machine=Machine.parse(each)).setups for each in machines]
    by_machine = [[keeps_setup(made, each, motion, made.patterns) for each in setups for motion in motions] for setups in limits]
    ignoring = ready("plate", cutters=("D5.3L17F6S9",), grid=3, ignore="F1,F8")
    left_out = [keeps_setup(ignoring, ignoring.conditions, motion, made.patterns) for motion in motions]
    keeps("copies_limits", {"machines": by_machine, "ignored": left_out})
    buried = with_copies(replace(made, inside=np.zeros(len(made.samples), np.int32)), made.patterns).copies
    # Points that are nearly where a motion carries others, and some that are not.
    size = np.linalg.norm(part("plate").size)
    off = (
        np.random.default_rng(1).normal(size=made.samples.point.shape)
        * size
        * np.where(made.samples.face % 2, 3e-6, 2e-5)[:, None]
    )
    nearly = with_copies(replace(made, samples=replace(made.samples, point=made.samples.point + off)), made.patterns).copies
    keeps("copies_nearly", [nearly.master, nearly.motion, nearly.frames])
    keeps("copies_inside", [buried.master, buried.motion, buried.frames, buried.verified, buried.group])
    shut = ready("plate", cutters=("D5.3L17F6S9",), spacing=2.1, setup=Placement(UP, clamped=("F1", "F3", "F7-F9")))
    keeps("copies_shut", [replace(shut.copies, motions=()), shut.shut, shut.alike, shut.clamped, shut.machinable, shut.somewhere])
    coarse = ready("plate", cutters=("D5.3L17F6S9",), grid=3)
    assert coarse.copies is None


def test_work_in_pieces(keeps):
    rows = np.array([0, 5, 99, 100, 101, 250, 511, 512, 513, 1024, 1300])
    pieces, told = [], []

    def work(piece):
        pieces.append(piece)
        return int(piece.sum())

    totals = [in_chunks(work, rows, 1, lambda *each: told.append(each), chunk, fixed=fixed) for chunk in (3, 11, 100, 512)
              for fixed in (False, True)]  # fmt: skip
    none = [in_chunks(work, rows[:0], 1, lambda *each: told.append(each), fixed=fixed) for fixed in (False, True)]
    totals += [*none, in_chunks(work, rows[:1], 2, chunk=100, fixed=True)]
    keeps("pieces", {"pieces": pieces, "told": told, "totals": totals, "company": with_company(rows[:5], 1400)})
