"""Fixtures where they stand: how far a table reaches, what is drawn of it, and what is said of each kind of fixture."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io import Part
from plan_cutters import Fixture
from plan_cutters.domain.placement import frame_of
from plan_cutters.scene.fixtures import TABLE, joined
from plan_cutters.scene.surroundings import surroundings
from plan_cutters.setups import solids
from tests.support import shapes
from tests.support.cad_parts import box, compound

LOW, HIGH = np.array([0.0, 0.0, 0.0]), np.array([40.0, 30.0, 20.0])
#: What is beside the part: a table below it would be in the way otherwise.
AT = (100.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def block():
    return surroundings(Part(box(*HIGH)), 0.01)


def placed(block, fixture, setup=(0.0, 0.0, 1.0), **more):
    return joined(block, Fixture.each_of([fixture]), 0.01, {}, setup, **more).fixtures[0]


def unit(way):
    return tuple((np.array(way, float) / np.linalg.norm(way)).tolist())


@settings(max_examples=25, deadline=None)
@given(
    way=st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1),
    word=st.sampled_from(["table", "table:-7", "table@3,-2,5", "table:-7@0,0,-1,10,20,30"]),
)
def test_a_table_reaches_as_far_to_all_sides_of_the_part_and_is_drawn_a_tenth_of_its_size(block, way, word):
    """In the directions of the setup, or its own where it is turned: as far beyond the part as is said, its top in place."""
    setup = unit(way)
    made = placed(block, word, setup)
    turned = word.endswith("30")
    frame = made.fixture.rotation.T if turned else frame_of(np.array(setup))
    shift = np.array(made.fixture.shift)
    corners = np.array([[x, y, z] for x in (0, 40) for y in (0, 30) for z in (0, 20)], float) @ frame.T
    for vertex, beyond in ((made.obstacles.triangles.vertex, TABLE), (made.shown, 0.1 * 40.0)):
        local = vertex @ frame.T
        low, high = local.min(axis=(0, 1)), local.max(axis=(0, 1))
        assert low[:2] == pytest.approx(corners.min(axis=0)[:2] - beyond, rel=1e-6, abs=1e-9)
        assert high[:2] == pytest.approx(corners.max(axis=0)[:2] + beyond, rel=1e-6, abs=1e-9)
        # Its shift comes on top, from the origin or from the part's lowest point.
        top = (-7.0 if ":" in word else corners[:, 2].min()) + float(frame[2] @ shift)
        assert high[2] == pytest.approx(top, rel=1e-6, abs=1e-6)
        assert low[2] <= min(corners[:, 2].min() - beyond, top - beyond) + 1e-6
    # Where the words do not say how high its top is, it is said.
    said = "from the part's origin along the setup axis" in " ".join(made.notes)
    assert said == (not turned and (":" not in word or setup != (0.0, 0.0, 1.0)))


def mesh(vertex):
    return trimesh.Trimesh(vertex.reshape(-1, 3), np.arange(3 * len(vertex)).reshape(-1, 3), process=False)


BLOCK = solids.box(np.zeros(3), np.full(3, 5.0))
MIXED = np.concatenate([BLOCK[:4, ::-1], BLOCK[4:]])
OPEN = BLOCK[:-1]
WITHIN = "only the surface is in the way, not what may lie within"
#: By kind of fixture: what is said of it.
SAID = {
    "mesh": (lambda: Fixture(mesh(BLOCK), AT), ["how far it is from what it stands for is not known: it counts as exact"]),
    "mesh with an error": (lambda: Fixture(mesh(BLOCK), AT, chord_error=0.01), []),
    "open": (
        lambda: Fixture(mesh(OPEN), AT, chord_error=0.01),
        ["is not watertight and encloses nothing: only its surface is in the way, not what may lie within"],
    ),
    "some of it open": (
        lambda: Fixture(mesh(np.concatenate([BLOCK, OPEN + 9.0])), AT, chord_error=0.01),
        [f"1 of its 2 skins are not watertight: of these, {WITHIN}"],
    ),
    "turned": (
        lambda: Fixture(mesh(MIXED), AT, chord_error=0.01),
        ["1 of its skins run the wrong way round: what lies within counts as material"],
    ),
    "solid": (lambda: Fixture(box(5, 5, 5), AT), []),
    "sheet": (lambda: Fixture(shapes.plane((0, 5), (0, 5)), AT), ["encloses nothing: only its surface is in the way"]),
    "solid and sheet": (lambda: Fixture(compound(box(5, 5, 5), shapes.plane((8, 9), (0, 5))), AT), []),
    "box": (lambda: "box:5,5,5@100,0,0", []),
    "cylinder": (lambda: "cylinder:5,5@100,0,0", []),
    "vise": (lambda: "vise:46x25x65:3:40@200,0,0", []),
}


@pytest.mark.parametrize("kind", SAID)
def test_what_is_assumed_of_a_fixture_is_said_of_it(block, kind):
    make, said = SAID[kind]
    made = placed(block, make())
    assert [each for each in made.notes if "mm was assumed" not in each] == said
    # A body where something is enclosed, and triangles in their place, by its number.
    assert (made.body is None) == (kind in ("open", "sheet"))
    assert (made.number, made.name) == (-1, f"fixture:{made.fixture.name}")
    assert kind == "vise" or made.obstacles.triangles.vertex[..., 0].min() > 60.0


def test_each_fixture_is_all_there_by_its_number_and_the_part_stays_as_it_was(block):
    words = ["box:5,6,7@100,1,2", "cylinder:5,8@-100,0,0", "box:1,1,1@0,0,90,0,0,45"]
    around = joined(block, Fixture.each_of(words), 0.01, {})
    assert around.alone is block
    assert around.possible is around.certain
    face = around.possible.triangles.face
    assert np.array_equal(around.possible.triangles.vertex[face >= 0], block.possible.triangles.vertex)
    for k, made in enumerate(around.fixtures, 1):
        mine = around.possible.triangles.vertex[face == -k]
        assert np.array_equal(mine, made.obstacles.triangles.vertex)
        assert (around.possible.weight[face == -k] == 1).all()
        assert around.called(-k) == made.name
    assert set(face[face < 0].tolist()) == {-1, -2, -3}
    corners = around.possible.triangles.vertex[face == -1]
    assert (corners.min(axis=(0, 1)), corners.max(axis=(0, 1))) == (pytest.approx([100, 1, 2]), pytest.approx([105, 7, 9]))
    # The errors of all that stands there hold for all of it.
    assert around.certain.triangles.chord_error == max(
        block.certain.triangles.chord_error, *(each.obstacles.triangles.chord_error for each in around.fixtures)
    )
    assert joined(block, [], 0.01, {}) is block


def test_a_fixture_that_is_not_known_well_makes_doubts_but_of_the_part_alone(block):
    """A solid with a hole in its skin encloses perhaps: nothing near it is surely blocked by what lies within."""
    from OCP.BRep import BRep_Builder
    from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid

    from cad_io.kernel import faces

    shell, solid, builder = TopoDS_Shell(), TopoDS_Solid(), BRep_Builder()
    builder.MakeShell(shell)
    for each in list(faces(box(5, 5, 5)))[1:]:
        builder.Add(shell, each)
    builder.MakeSolid(solid)
    builder.Add(solid, shell)
    turn = (100.0, 0.0, 0.0, 0.0, 0.0, 90.0)
    around = joined(block, [Fixture(solid, turn, name="torn")], 0.01, {})
    made = around.fixtures[0]
    assert made.body is None
    assert around.possible is not around.certain
    assert not around.certain.weight[around.certain.triangles.face < 0].any()
    assert around.possible.weight[around.possible.triangles.face < 0].all()
    assert around.certain.weight[around.certain.triangles.face > 0].all()
    # The box about its skin is turned and put where it stands.
    [(low, high)] = around.possible.open_boxes
    assert low == pytest.approx([95.0, 0.0, 0.0], abs=1e-6)
    assert high == pytest.approx([100.0, 5.0, 5.0], abs=1e-6)
