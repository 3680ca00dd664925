"""Lines about an axis enclose the body that turns about it, and do not lie farther from it than said."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cad_io import read_part
from cad_io.tessellate.meridian import _grown, meridian
from tests.support.cad_parts import ball, box, compound, cone, cut, ring, rod
from tests.support.distances import surface_points

BODIES = {
    "rod": rod, "cone": cone, "ball": ball, "ring": ring, "box": box, "beside the axis": lambda: rod(at=(3, 1, 0)),
    "ball on a rod": lambda: compound(rod(), ball(7, (0, 0, 30))), "hollow": lambda: cut(cone(), ball(3, (0, 0, 0))),
    "box under a rod": lambda: compound(rod(), box(4, 4, 4, (-2, -2, -6))),
}  # fmt: skip


def reach_at(line, height):
    """How far lines (n, 4) reach from the axis at heights (k,)."""
    q, w, r, h = line.T[..., None]
    # Of a line with hardly any height, a share may be beyond all numbers: it has no more than its ends.
    with np.errstate(over="ignore"):
        share = np.clip(np.where(h > w, (height - w) / np.where(h > w, h - w, 1.0), 0.0), 0.0, 1.0)
    there = np.where(h > w, q + share * (r - q), np.maximum(q, r))
    return np.where((height >= w - 1e-9) & (height <= h + 1e-9), there, -np.inf).max(axis=0)


@pytest.mark.parametrize(
    ("body", "axis"),
    [(body, axis) for body in BODIES for axis in (((0, 0, 0), (0, 0, 1)), ((0, 0, 4), (0, 0, -2)))]
    + [(body, ((2, 1, -3), (1, 2, 2))) for body in ("rod", "box")],
    ids=str,
)
def test_lines_enclose_the_body(body, axis):
    part, chord = read_part(BODIES[body]()), 0.1
    found = meridian(part, *axis, chord)
    base, along = np.array(axis[0], float), np.array(axis[1]) / np.linalg.norm(axis[1])
    rng = np.random.default_rng(0)
    points = np.concatenate([surface_points(part, face.number, 300, rng) for face in part.faces]) - base
    height = points @ along
    radius = np.linalg.norm(points - height[:, None] * along, axis=1)
    assert (radius <= reach_at(found.line, height) + 1e-9).all()
    assert (found.line[:, 1] <= found.line[:, 3]).all()
    assert found.foot <= height.min() + 1e-9
    assert found.off <= 5.0 * chord
    # The farthest place of the body is nearly as far as that of the lines.
    assert found.line[:, [0, 2]].max() <= radius.max() + found.off + 0.5
    if found.exact.all():
        assert found.off == 0.0


finite = st.floats(0.0, 20.0)


@example((0.0, 0.0, 0.0, 1.0), 0.0, 5e-324, 0.0, 0.0, 1.0)
@settings(max_examples=100, deadline=None)
@given(st.tuples(finite, finite, finite, finite), finite, finite, st.floats(0, 1), st.floats(-1, 1), st.floats(0, 1))
def test_grown_lines_enclose_what_is_moved(ends, out, up, share_out, share_up, along):
    q, w, r, h = ends
    line = np.array([[q, min(w, h), r, max(w, h)]])
    grown = _grown(line, out, up)
    place = (1 - along) * line[0, :2] + along * line[0, 2:] + (share_out * out, share_up * up)
    assert reach_at(grown, place[1:])[0] >= place[0] - 1e-6 * (1.0 + place[0])
