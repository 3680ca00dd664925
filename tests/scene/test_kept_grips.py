"""What is said of how vises and chucks hold small parts is kept in `kept`: places, grips, what lies at jaws."""

import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

from cad_io import read_part
from cad_io.arrays import Triangles
from cad_io.part.bodies import orient
from plan_cutters import Scene
from plan_cutters.domain.clamping import Chuck, Vise, requested
from plan_cutters.domain.fixture import Fixture
from plan_cutters.scene.fixtures import body_near
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import surroundings
from plan_cutters.setups import solids
from plan_cutters.setups.clamping import held as placed_by
from plan_cutters.setups.places import chuck_places, vise_places
from plan_cutters.setups.workpiece import (
    PartMesh,
    Workpiece,
    at_jaws,
    held_bodies,
    material_bodies,
    on_ledges,
    rods_of,
    unheld_bodies,
)
from tests.support.cad_parts import box, compound, cut, rod
from tests.support.kept_parts import said_by
from tests.support.vises import stands_in

UP, DOWN, ASIDE = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.6, 0.0, 0.8)


def plate_with_boss():
    return cq.Workplane("XY").box(47.3, 31.1, 9.7).faces(">Z").workplane().rect(13.1, 11.7).extrude(6.2).edges("<Z").chamfer(0.8)


def shaft():
    return (
        cq.Workplane("XY").circle(13.3).extrude(17.2).faces(">Z").workplane().circle(8.1).extrude(11.4).faces("<Z").chamfer(1.9)
    )


GRIPPED = {
    "plate": plate_with_boss,
    "shaft": shaft,
    "hung": lambda: compound(box(31.3, 22.7, 12.2), box(9.1, 7.7, 5.3, (4.4, 6.2, -5.3))),
    "two": lambda: compound(box(11.3, 22.7, 12.2), box(9.1, 21.2, 12.2, (11.3, 0.4, 0.0))),
    "apart": lambda: compound(*(box(11.3, 22.7, 12.2, (14.1 * k, 0, 0)) for k in range(4))),
    "tall": lambda: box(5.1, 4.3, 41.7),
    "thin": lambda: cut(box(3.3, 44.1, 12.2), box(1.1, 40.0, 12.2, (0.0, 2.0, 5.0))),
    "wide": lambda: rod(471.0, 30.0),
    "wedge": lambda: cq.Workplane("XZ").polyline([(0, 0), (31, 0), (22, 15), (3, 15)]).close().extrude(19),
    "odd": lambda: (
        cq.Workplane("XY").circle(14).workplane(offset=22.0).circle(9).loft().cut(cq.Workplane("XY").circle(5.1).extrude(9))
    ),
    "round": lambda: cq.Workplane("XY").box(21.3, 17.7, 14.1, centered=False).edges("|Z").fillet(4.4),
    "flats": lambda: cq.Workplane("XY").circle(15.2).extrude(21.0).intersect(cq.Workplane("XY").rect(24.2, 60).extrude(21.0)),
}
WORDS = ("vise", "vise:20x12x9:2", "vise:46x25x65:5", "vise:20x12x30:2", "chuck", "chuck:4x30:5", "chuck:2x9:8")


@pytest.mark.slow("plans, judges or places a part at length; others of its kind run every time", only=("shaft", "apart"))
@pytest.mark.parametrize("name", GRIPPED)
def test_how_vises_and_chucks_hold_parts(name, keeps):
    scene, said = Scene.of(read_part(GRIPPED[name]()), tolerance=0.3), {}
    scene.surround()
    for axis in (UP, (1.0, 0.0, 0.0), DOWN):
        for word in WORDS if axis == UP else ("vise", "chuck"):
            said[f"{word} {axis}"] = said_by(scene.hold, Fixture.parse(word), axis)
    first = said["vise (0.0, 0.0, 1.0)"]
    others = scene.for_targets(getattr(first, "grips", ())[:1] or (1,))
    said["targets"] = [said_by(others.hold, Fixture.parse(word), UP) for word in ("vise", "chuck")]
    keeps(
        f"held_{name}",
        {
            key: replace(each, fixture=None) if not isinstance(each, str) else each
            for key, each in said.items()
            if key != "targets"
        }
        | {
            "texts": [getattr(getattr(each, "fixture", None), "text", "") for each in said.values()],
            "targets": [getattr(each, "words", each) for each in said["targets"]],
        },
    )


@pytest.mark.parametrize("name", ["plate", "shaft", "hung", "two", "flats"])
def test_places_of_vises_and_chucks(name, keeps):
    made = read_part(GRIPPED[name]())
    side, around = orient(made, towards=UP, flip=False).sign, surroundings(made, 0.05)
    triangles = around.certain.triangles
    planes = [face.number for face in made.faces if face.shape == "plane"]
    bodies = material_bodies(around.bodies, side)
    said = {"bodies": bodies}
    for axis, targets in ((UP, ()), (ASIDE, (1, 2)), (DOWN, (3,))):
        mesh = PartMesh.of(triangles.vertex, triangles.face, side)
        piece = Workpiece.of(mesh, planes, targets, axis, bodies, rods=rods_of(made.faces))
        said[str(axis)] = {
            "piece": {
                each: getattr(piece, each) for each in ("frame", "lowest", "normal", "area", "middle", "flat", "lowest_rows")
            },
            "outline": len(piece.outline),
            "level": [piece.level(height) for height in (0.0, piece.flat, 5.3, 9.7)],
        }
        for kind, text in (("vise", None), ("vise", "46x25x65:1"), ("chuck", None), ("chuck", "5x11:2")):
            asked = requested(kind, text, 1.0, kind)
            places, refused = (vise_places if kind == "vise" else chuck_places)(piece, asked)
            said[str(axis)][f"{kind} {text}"] = [
                len(places),
                places[:3],
                [[each.rank, each.thin, each.firm, each.apart] for each in places[:5]],
                refused[:4],
            ]
    keeps(f"places_{name}", said)


def so_often(count, asked, which):
    """What says yes so many times, and notes each."""
    return lambda *given: asked.append(which) or asked.count(which) <= count


def test_places_that_are_searched(keeps):
    """Ribs with many walls: of the places some are in the way at once, of others that comes out by a search."""
    ribs = [solids.box(np.array([8.3 * k, 0.3 * k, 0.0]), np.array([8.3 * k + 3.1, 21.0 - k, 9.4])) for k in range(5)]
    face = np.concatenate([6 * k + np.tile(np.arange(1, 7), 2) for k in range(5)]).astype(np.int32)
    bodies = [frozenset(range(1 + 6 * k, 7 + 6 * k)) for k in range(5)]
    said = {}
    for few, first, second in ((5, 0, 0), (5, 3, 2), (5, 0, 99), (5, 99, 0), (2, 0, 0), (0, 0, 12), (0, 0, 13), (0, 4, 11)):
        piece = Workpiece.of(PartMesh.of(np.concatenate(ribs), face, np.ones(30)), range(1, 31), (2, 9), UP, bodies[:few])
        for word in ("vise", "vise:46x25x65:2"):
            asked = []
            found = said_by(placed_by, Fixture.parse(word), piece, so_often(first, asked, 0), so_often(second, asked, 1), 0.01)
            said[f"{few} {first} {second} {word}"] = [
                found if isinstance(found, str) else [found.fixture.text, found.words],
                asked,
            ]
    keeps("searched", said)


def test_what_lies_at_jaws(keeps):
    rng = np.random.default_rng(4)
    boxes = [
        ((-9.2, -7.1, 0.0), (3.1, 5.2, 8.3)),
        ((3.1, -6.0, 0.0), (9.2, 6.6, 7.7)),
        ((-2.0, -2.0, 8.3), (2.2, 3.1, 12.0)),
        ((-9.195, 7.0, 0.0), (9.19, 9.0, 2.0)),
    ]
    vertex = np.concatenate([solids.box(*np.array(each)) for each in boxes])
    face = np.repeat(np.arange(1, 5), 12).astype(np.int32)
    bodies = tuple(frozenset({k}) for k in range(1, 5))
    said = {}
    for name, clamping in (
        ("vise", Vise(14.2, 25.0, 65.0, 3.0, 18.4)),
        ("narrow", Vise(4.0, 9.0, 30.0, 2.0, 18.4)),
        ("wide", Vise(30.0, 9.0, 30.0, 2.0, 18.43)),
        ("chuck", Chuck(3, 20.0, 3.0, 18.4)),
        ("four", Chuck(4, 20.0, 3.0, 18.2)),
    ):
        said[name] = {
            "at": list(at_jaws(clamping, vertex, face, 0.0, clamping.grip)),
            "ledges": on_ledges(clamping, vertex, face, 1e-6),
            "held": [
                sorted(held_bodies(clamping, vertex, face, bodies[:some], slack))
                for some in (1, 2, 3, 4)
                for slack in (0.0, 0.02, 0.3)
            ],
            "entered": [stands_in(clamping, rng.uniform(-30, 30, (50, 3)) * [1, 1, 0.7], deep) for deep in (0.01, 2.0, 9.0)],
            "triangles": [
                solids.triangles_of(clamping, chord, shown=shown, above=above)
                for chord, shown, above in (
                    (0.05, False, -math.inf),
                    (0.4, True, -math.inf),
                    (0.05, False, -2.0),
                    (0.05, False, 99.0),
                )
            ],
        }
        fixture = Fixture(clamping.word, (1.0, 0.5, -2.0, 0.0, 0.0, 15.0))
        triangles = Triangles(fixture.placed(vertex), face, 0.01, ())
        said[name]["unheld"] = unheld_bodies(clamping, fixture, triangles, bodies)
        said[name]["near"] = body_near(clamping, fixture, 0.05, Obstacles(triangles)).triangles
    keeps("jaws", said)
