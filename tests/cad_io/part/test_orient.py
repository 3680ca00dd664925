"""Which side is out of the material: solids, shells, loose faces, inside-out and mirrored ones."""

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy, BRepBuilderAPI_Transform
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_IN, TopAbs_SHELL
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location

from cad_io import read_part
from cad_io.kernel import faces, first_derivatives
from cad_io.part.bodies import orient
from tests.support.cad_parts import ball, box, compound, cut, drilled, mirror, moved, patch, pocketed, real, ring


def normals(part, orientation):
    """A point inside each face and the normal there, out of the material."""
    points, out = [], []
    for face in part.faces:
        trim = part.trim(face.number)
        u = np.linspace(trim.box[0], trim.box[1], 23)[1:-1]
        v = np.linspace(trim.box[2], trim.box[3], 23)[1:-1]
        i, j = np.argwhere(trim.inside_grid(u, v))[7]
        d = first_derivatives(part.adaptor(face.number), u[[i]], v[[j]])[0]
        normal = np.cross(d[1], d[2]) * orientation.sign[face.number - 1]
        points.append(d[0])
        out.append(normal / np.linalg.norm(normal))
    return np.array(points), np.array(out)


def assert_outward(part, orientation, solid):
    """The kernel's own classifier, on a solid known to be right way out, finds material behind every face only."""
    for point, normal in zip(*normals(part, orientation), strict=True):
        for side, inside in ((-1e-3, True), (1e-3, False)):
            at = gp_Pnt(*(point + side * normal).tolist())
            assert (BRepClass3d_SolidClassifier(solid, at, 1e-7).State() == TopAbs_IN) == inside


def hollow():
    return cut(box(30, 30, 30, (-15, -15, -15)), ball())


SOLIDS = {"ball": ball, "ring": ring, "drilled": drilled, "pocketed": pocketed, "hollow": hollow}


@pytest.mark.parametrize("make", SOLIDS.values(), ids=SOLIDS.keys())
def test_solids_however_they_are_turned(make):
    solid = make()
    for shape in (solid, solid.Reversed()):
        part = read_part(shape)
        found = orient(part)
        assert found.confident
        assert_outward(part, found, solid)
    assert "inside out" in orient(read_part(solid.Reversed())).method


@pytest.mark.parametrize("make", SOLIDS.values(), ids=SOLIDS.keys())
def test_mirrored_and_moved_placements(make):
    for place in (mirror(), moved(), mirror().Multiplied(moved())):
        right = BRepBuilderAPI_Transform(make(), place, True).Shape()
        part = read_part(make().Moved(TopLoc_Location(place)))
        found = orient(part)
        assert found.confident
        assert_outward(part, found, right)


def test_flip_does_not_touch_solids_and_closed_shells():
    part = read_part(pocketed())
    assert (orient(part, flip=True).sign == orient(part).sign).all()
    shell = read_part(TopExp_Explorer(box(), TopAbs_SHELL).Current())
    assert shell.solids == 0
    assert (orient(shell, flip=True).sign == orient(shell).sign).all()


def test_a_closed_shell_is_turned_outward():
    shell = TopExp_Explorer(pocketed(), TopAbs_SHELL).Current()
    for shape in (shell, shell.Reversed()):
        part = read_part(shape)
        found = orient(part)
        assert found.confident
        assert "closed shells" in found.method
        assert_outward(part, found, pocketed())


@pytest.mark.parametrize("turned", range(6))
def test_loose_faces_that_close_are_joined_and_turned_outward(turned):
    copies = [BRepBuilderAPI_Copy(face).Shape() for face in faces(drilled())]
    copies = [face.Reversed() if (i * 7 + turned) % 3 == 0 else face for i, face in enumerate(copies)]
    part = read_part(compound(*copies))
    assert not part.closed
    found = orient(part)
    assert found.confident
    assert_outward(part, found, drilled())


def test_open_shells_face_the_given_direction():
    face = patch()
    for shape in (face, face.Reversed()):
        part = read_part(shape)
        up, down = orient(part), orient(part, towards=(0, 0, -3))
        assert not up.confident
        assert normals(part, up)[1][0, 2] > 0
        assert normals(part, down)[1][0, 2] < 0
        assert (orient(part, flip=True).sign == -up.sign).all()
        assert "towards" in up.method
        assert "weak" not in up.method
        assert "weak" in orient(part, towards=(1, 0, 0)).method


def test_a_box_without_lid_is_consistent():
    open_box = compound(*faces(box())[:5], faces(box(at=(50, 0, 0)))[5])
    part = read_part(open_box)
    found = orient(part, towards=(0, 0, 1))
    assert not found.confident
    points, out = normals(part, found)
    # The lid is missing, so the bottom faces up, and with it all sides face inward; the single face stands alone.
    inward = (5, 5, 5) - points[:5]
    assert ((out[:5] * inward).sum(axis=1) > 0).all()
    assert out[5] @ (0, 0, 1) > 0


@pytest.mark.parametrize("path", real("asitus_wavy-cube.stp", "tigl_D150_wing.igs"), ids=lambda p: p.name)
def test_real_closed_shells_are_sure(path):
    part = read_part(path)
    found = orient(part)
    assert found.confident
    flux = sum(s * part.measure(n + 1).flux for n, s in enumerate(found.sign))
    assert flux > 0


@pytest.mark.parametrize("path", real("tigl_nacelle.stp", "bladex_upper.iges"), ids=lambda p: p.name)
def test_real_open_shells_are_a_guess(path):
    found = orient(read_part(path))
    assert not found.confident
    assert set(np.abs(found.sign)) == {1.0}
