"""The same body twice in one place is found, whoever wrote it; what is nearly there, mirrored or overlapping is not."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy, BRepBuilderAPI_Transform
from OCP.BRepTools import BRepTools
from OCP.IGESControl import IGESControl_Writer
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL

from cad_io import read_part
from cad_io.kernel import explore
from cad_io.part.bodies import orient
from cad_io.part.patterns import repeated_faces, repeats
from tests.support.cad_parts import as_nurbs, ball, box, compound, cone, cut, drilled, loose, mirror, moved, ring, rod, write_step

BODIES = {"box": box, "drilled": drilled, "ball": ball, "ring": ring, "cone": cone, "nurbs": lambda: as_nurbs(drilled())}


def copied(shape):
    """The same geometry, and nothing of it shared."""
    return BRepBuilderAPI_Copy(shape).Shape()


def write_iges(shape, file, *, solid):
    writer = IGESControl_Writer("MM", int(solid))
    writer.AddShape(shape)
    writer.ComputeModel()
    writer.Write(str(file))


WRITERS = {
    ".step": write_step,
    ".brep": lambda shape, file: BRepTools.Write_s(shape, str(file)),
    ".igs": lambda shape, file: write_iges(shape, file, solid=False),
    "solid.igs": lambda shape, file: write_iges(shape, file, solid=True),
}


@pytest.mark.parametrize("make", BODIES.values(), ids=BODIES)
@pytest.mark.parametrize("times", [2, 3])
def test_a_solid_again_in_one_place_is_the_first_one_again(make, times):
    body = make()
    part, one = read_part(compound(body, *(copied(body) for _ in range(times - 1)))), read_part(body)
    (found,) = repeats(part)
    assert found.bodies == tuple(range(1, times + 1))
    count = len(one.faces)
    again = repeated_faces(part)
    assert sorted(again) == list(range(count + 1, times * count + 1))
    assert set(again.values()) == set(range(1, count + 1))
    # Each stands for a face that is equal to it.
    for number, stays in again.items():
        assert part.faces[number - 1].area == pytest.approx(part.faces[stays - 1].area, rel=1e-6)
        assert part.centre(number) == pytest.approx(part.centre(stays), abs=1e-6)


@pytest.mark.parametrize(("ending", "write"), WRITERS.items(), ids=WRITERS)
def test_it_is_found_in_files(tmp_path, ending, write):
    body = drilled()
    file = tmp_path / f"twice{ending}"
    write(compound(body, copied(body)), file)
    part = read_part(file)
    assert sorted(repeated_faces(part)) == list(range(8, 15))
    assert set(repeated_faces(part).values()) == set(range(1, 8))
    assert orient(part).confident


def test_a_body_that_is_one_object_has_its_faces_once():
    body = drilled()
    assert len(read_part(compound(body, body)).faces) == 7


def test_turned_inside_out_it_is_the_same_body():
    assert len(repeated_faces(read_part(compound(box(), copied(box()).Reversed())))) == 6


OTHERS = {
    "a little longer": (box, lambda: box(10, 10, 10.001)),
    "overlapping": (box, lambda: box(10, 10, 20)),
    "touching": (box, lambda: box(10, 10, 10, (10, 0, 0))),
    "moved a little": (drilled, lambda: BRepBuilderAPI_Transform(drilled(), moved(0, by=(0.001, 0, 0)), True).Shape()),
    "with a hole more": (box, lambda: cut(box(), rod(2, 30, (5, 5, -5)))),
    "with a thinner hole": (drilled, lambda: drilled(2.999)),
    "mirrored": (lambda: cut(box(), rod(2, 30, (3, 4, -5))), lambda: BRepBuilderAPI_Transform(
        cut(box(), rod(2, 30, (3, 4, -5))), mirror(), True).Shape()),
    "a void instead of nothing": (box, lambda: cut(box(), ball(2, (5, 5, 5)))),
}  # fmt: skip


@pytest.mark.parametrize(("one", "other"), OTHERS.values(), ids=OTHERS)
def test_another_body_is_another_body(one, other):
    part = read_part(compound(one(), other()))
    assert repeats(part) == ()
    assert repeated_faces(part) == {}


def test_loose_faces_and_shells_are_found_and_keep_their_sides():
    sides = orient(read_part(loose(box())))
    assert sides.confident
    shell = next(explore(box(), TopAbs_SHELL))
    for part in (compound(loose(box()), loose(copied(box()))), compound(shell, copied(shell))):
        whole = read_part(part)
        assert repeated_faces(whole) == {n + 6: n for n in range(1, 7)}
        found = orient(whole)
        assert found.confident
        assert found.sign.tolist() == [*sides.sign, *sides.sign]
    one = next(explore(box(), TopAbs_FACE))
    assert repeated_faces(read_part(compound(one, copied(one)))) == {2: 1}


def test_a_solid_and_its_shell_are_one_body():
    shell = next(explore(copied(box()), TopAbs_SHELL))
    (found,) = repeats(read_part(compound(box(), shell)))
    assert found.bodies == (1, 0)


def test_what_is_ignored_says_which_one_stays():
    part = read_part(compound(drilled(), copied(drilled()), copied(drilled())))
    first, second, third = set(range(1, 8)), set(range(8, 15)), set(range(15, 22))
    assert set(repeated_faces(part)) == second | third
    assert set(repeated_faces(part, first)) == third
    assert set(repeated_faces(part, first).values()) == second
    assert repeated_faces(part, first | third) == {}
    # A face alone: another one of the bodies is whole, and stays.
    assert set(repeated_faces(part, {3})) == (first - {3}) | third
    # Of each something is to be left out: what that means, only its author knows.
    assert repeated_faces(part, {3, 9, 20}) == {}


@settings(max_examples=25, deadline=None)
@given(
    size=st.floats(0.5, 500.0), angle=st.floats(0.0, math.pi), by=st.tuples(*[st.floats(-200.0, 200.0)] * 3),
    off=st.sampled_from([0.0, 1e-8, 1e-4, 1e-2]),
)  # fmt: skip
def test_it_is_so_wherever_and_however_large_the_part_is(size, angle, by, off):
    body = BRepBuilderAPI_Transform(box(size, 0.7 * size, 0.4 * size), moved(angle, by=by), True).Shape()
    other = BRepBuilderAPI_Transform(body, moved(0, by=(off * size, 0.0, 0.0)), True).Shape()
    again = repeated_faces(read_part(compound(body, other)))
    assert len(again) == (6 if off < 1e-6 else 0)


def test_many_equal_bodies_side_by_side_are_looked_through_at_once():
    part = read_part(compound(*(box(2, 2, 2, (3 * i, 3 * j, 0)) for i in range(8) for j in range(8))))
    assert repeats(part) == ()
    assert np.isfinite(part.size).all()
