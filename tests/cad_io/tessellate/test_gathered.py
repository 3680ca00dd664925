"""What of the triangles of a face is taken, and what stands for faces without any: what is not finite covers nothing."""

from types import SimpleNamespace

import numpy as np
import pytest

import cad_io.tessellate.triangles as triangles
from cad_io import read_part
from cad_io.tessellate.meridian import _grown
from cad_io.tessellate.proxies import _edges
from cad_io.tessellate.start import _CELLS, _axes
from cad_io.tessellate.triangles import _gathered
from tests.support import shapes
from tests.support.cad_parts import box, compound


def mesh_of(point=0.0, off=0.001, *, whole=True):
    """Two triangles, of whose corners the last one is as given."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, point]])
    return SimpleNamespace(point=points, corner=np.array([[0, 1, 2], [0, 2, 3]]), off=off, whole=whole, area=1.0)


@pytest.mark.parametrize(
    ("mesh", "why"),
    [
        (mesh_of(), None),
        (mesh_of(np.nan), "its surface cannot be evaluated everywhere"),
        (mesh_of(np.inf), "its surface cannot be evaluated everywhere"),
        (mesh_of(off=np.inf), "its surface cannot be evaluated everywhere"),
        (mesh_of(off=np.nan), "its surface cannot be evaluated everywhere"),
        (mesh_of(np.nan, np.inf), "its surface cannot be evaluated everywhere"),
        (mesh_of(whole=False), "it takes more triangles than the budget allows"),
    ],
)
def test_a_face_is_covered_only_where_all_of_it_is_finite_and_made(monkeypatch, mesh, why):
    monkeypatch.setattr(triangles, "_uncovered", lambda part, number, area, chord: 0.0)
    laid = [mesh_of(), mesh]
    patches = [SimpleNamespace(number=3), SimpleNamespace(number=7)]
    vertex, whole, off, missing = _gathered(None, patches, laid, np.array([0, 2, 4]), 0.01)
    assert off == ({3: 0.001} if why else {3: 0.001, 7: 0.001})
    assert missing == ({7: why} if why else {})
    assert whole.tolist() == np.isfinite(vertex).all(axis=(1, 2)).tolist()
    assert laid == []


def test_what_triangles_leave_uncovered_is_told(monkeypatch):
    monkeypatch.setattr(triangles, "_uncovered", lambda part, number, area, chord: 0.031)
    _, _, off, missing = _gathered(None, [SimpleNamespace(number=7)], [mesh_of()], np.array([0, 2]), 0.01)
    assert off == {7: 0.001}
    assert missing == {7: "its triangles leave up to 4 % of it uncovered"}


def test_the_edges_of_a_sliver_stand_for_it_and_those_of_a_face_do_not():
    part = read_part(compound(box(100, 100, 100), shapes.plane((0, 5), (0, 1e-7), origin=(200, 0, 0))))
    line = _edges(part, 7, 0.01)
    assert len(line) >= 4
    assert (line[:, 1] == line[:, 2]).all(), "they have no area"
    assert (line.min(axis=(0, 1)), line.max(axis=(0, 1))) == (pytest.approx([200, 0, 0]), pytest.approx([205, 1e-7, 0]))
    assert all(_edges(part, number, 0.01).shape == (0, 3, 3) for number in range(1, 7))


def test_a_grid_of_too_many_cells_is_not_laid():
    side = int(np.sqrt(_CELLS))
    few, many = np.linspace(0.0, 1.0, side), np.linspace(0.0, 1.0, side + 3)
    u, v = _axes((few, few), [])
    assert (u.tolist(), v.tolist()) == (few.tolist(), few.tolist())
    assert _axes((many, many), []) is None


def test_lines_that_are_moved_enclose_all_that_is_near_them():
    """Out by one distance and along the axis by another: both ends of a line go the same way, away from where it is wider."""
    line = np.array([[1.0, 0.0, 3.0, 4.0], [3.0, 4.0, 1.0, 9.0], [2.0, 0.0, 2.0, 5.0]])
    made = _grown(line, 0.25, 0.5)
    assert made[:3] == pytest.approx(np.array([[1.25, -0.5, 3.25, 3.5], [3.25, 4.5, 1.25, 9.5], [2.25, 0.5, 2.25, 5.5]]))
    assert made[3:] == pytest.approx(np.array([[3.25, 3.5, 3.25, 4.5], [3.25, 3.5, 3.25, 4.5], [2.25, -0.5, 2.25, 0.5]]))
