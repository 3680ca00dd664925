"""Reading in a copy of the process gives the same part, and an error where the kernel crashes or hangs."""

import os
import pickle
import signal
import time
from dataclasses import astuple, replace

import numpy as np
import pytest
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location

from cad_io import Part, ReadError, read_part
from cad_io.arrays import LostFace
from cad_io.kernel import faces
from cad_io.kernel.shapes import Node
from cad_io.part.content import PartContent
from cad_io.read import read
from plan_cutters_base.forks import limited
from tests.support.cad_parts import box, compound, drilled, moved, real

REAL = real("cadquery_red_cube_blue_cylinder.step", "asitus_bolt-colored-faces.stp", "tigl_D150_wing.igs")


def die():
    os.kill(os.getpid(), signal.SIGKILL)


def described(node):
    """A tree's node as plain values."""
    matrix = node.place.Transformation()
    place = [round(matrix.Value(i, j), 9) for i in (1, 2, 3) for j in (1, 2, 3, 4)]
    return node.name, node.instance, place, node.faces, [described(child) for child in node.children]


def assert_same(one, other):
    bare = [[replace(face, area=0.0, carrier=None) for face in part.faces] for part in (one, other)]
    assert bare[0] == bare[1]
    for mine, theirs in zip(*([face.carrier for face in part.faces] for part in (one, other)), strict=True):
        assert (mine is None) == (theirs is None)
        for value, there in zip(*(astuple(each) if each else () for each in (mine, theirs)), strict=True):
            assert value == there or value == pytest.approx(there, rel=1e-9, abs=1e-9)
    assert [face.area for face in one.faces] == pytest.approx([face.area for face in other.faces], rel=1e-12)
    assert one.size == pytest.approx(other.size, rel=1e-9)
    assert (one.solids, one.warnings, one.layers, one.lost) == (other.solids, other.warnings, other.layers, other.lost)
    assert (one.file, one.sha256) == (other.file, other.sha256)
    assert [described(node) for node in one.tree] == [described(node) for node in other.tree]
    for n in range(1, len(one.faces) + 1):
        assert one.measure(n).flux == pytest.approx(other.measure(n).flux, rel=1e-9, abs=1e-9)
        assert one.face(n).Orientation() == other.face(n).Orientation()


@pytest.mark.parametrize("path", REAL, ids=lambda p: p.name)
def test_real_files_come_out_the_same(path):
    assert_same(read_part(path, guarded=True), read_part(path))


def test_shapes_come_out_the_same():
    shape = compound(drilled(), drilled().Moved(TopLoc_Location(moved())).Reversed(), *faces(box(at=(90, 0, 0)))[:3])
    assert_same(read_part(shape, guarded=True, unit="in"), read_part(shape, unit="in"))


def test_a_tree_comes_out_with_its_places(monkeypatch):
    solid = drilled()
    place = TopLoc_Location(moved())
    wheels = tuple(Node("wheel", f"wheel {i}", at, faces=tuple(range(7 * i + 1, 7 * i + 8)))
                   for i, at in enumerate((TopLoc_Location(), place)))  # fmt: skip
    tree = (Node("cart", "", TopLoc_Location(), wheels),)
    found = PartContent(compound(solid, solid.Moved(place)), tree=tree)
    monkeypatch.setattr(read, "_find", lambda *_: found)
    part = read_part("any", guarded=True)
    assert [described(node) for node in part.tree] == [described(node) for node in tree]
    # A leaf's faces stand where its place puts them: equal locations, not only equal numbers.
    second = faces(part.shape)[7]
    assert second.Location().IsEqual(part.tree[0].children[1].place)


def test_what_is_lost_comes_along(tmp_path):
    BRepTools.Write_s(box(), str(tmp_path / "part.brep"))
    lost = LostFace("#7", "lid", "it is gone", 3, ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0)))
    assert Part(read_part(tmp_path / "part.brep").shape, lost=(lost,)).lost == (lost,)
    assert pickle.loads(pickle.dumps(lost)) == lost


def test_errors_are_those_of_reading(tmp_path):
    (tmp_path / "cut.step").write_bytes(b"ISO-10303-21;\nHEADER;\n")
    for guarded in (False, True):
        with pytest.raises(ReadError, match="cut off") as caught:
            read_part(tmp_path / "cut.step", guarded=guarded)
        assert caught.value.file == str(tmp_path / "cut.step")


def test_a_crash_and_a_hang_are_errors(tmp_path, monkeypatch):
    BRepTools.Write_s(box(), str(tmp_path / "part.brep"))
    monkeypatch.setattr(read, "_read_brep", lambda file, kind: die())
    with pytest.raises(ReadError, match="crashed") as caught:
        read_part(tmp_path / "part.brep", guarded=True)
    assert caught.value.file == str(tmp_path / "part.brep")
    monkeypatch.setattr(read, "_read_brep", lambda file, kind: time.sleep(60))
    began = time.monotonic()
    with pytest.raises(ReadError, match=r"not read within 0\.5 s"):
        read_part(tmp_path / "part.brep", guarded=True, timeout=0.5)
    assert time.monotonic() - began < 10


def test_a_copy_may_make_copies():
    assert limited(lambda: limited(lambda: b"inner", 1000.0), 5.0) == b"inner"


def test_what_crashes_while_measuring_is_an_error_too(monkeypatch):
    parent = os.getpid()

    class Crashing(Part):
        def __init__(self, *args, **more):
            if os.getpid() != parent:
                die()
            super().__init__(*args, **more)

    monkeypatch.setattr(read, "Part", Crashing)
    with pytest.raises(ReadError, match="crashed"):
        read_part(box(), guarded=True)
    assert np.isfinite(read_part(box()).size).all()
