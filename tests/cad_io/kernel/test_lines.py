"""What is written down in closed form has the same bits as what it stands for."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.GeomAbs import GeomAbs_Line
from OCP.gp import gp_Pnt2d, gp_Vec2d

from cad_io import read_part
from cad_io.arrays import cross
from cad_io.kernel import along, edges_of, points_on
from tests.support.places import SAMPLES

ROWS = arrays(float, st.tuples(st.integers(0, 5), st.just(3)), elements=st.floats(-1e6, 1e6))


@given(ROWS, st.data())
def test_cross_products_are_those_of_numpy(a, data):
    b = data.draw(arrays(float, a.shape, elements=st.floats(-1e6, 1e6)))
    assert np.array_equal(cross(a, b), np.cross(a, b))


def test_lines_in_parameter_planes_are_those_of_the_kernel():
    part, lines, others = read_part(SAMPLES / "control_arm.step"), 0, 0
    for number in range(1, len(part.faces) + 1):
        face = part.face(number)
        for edge in edges_of(face):
            curve = BRepAdaptor_Curve2d(edge, face)
            t = np.linspace(curve.FirstParameter(), curve.LastParameter(), 7)
            point, tangent, rows = gp_Pnt2d(), gp_Vec2d(), []
            for x in t.tolist():
                curve.D1(x, point, tangent)
                rows.append((point.Coord(), tangent.Coord()))
            assert np.array_equal(along(curve, t), np.array(rows))
            assert np.array_equal(points_on(curve, t), np.array([curve.Value(x).Coord() for x in t.tolist()]))
            lines, others = lines + (curve.GetType() == GeomAbs_Line), others + (curve.GetType() != GeomAbs_Line)
    assert min(lines, others) > 10
