"""Cubic splines as curves of the kernel."""

import numpy as np
from OCP.Geom import Geom_BSplineCurve
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.gp import gp_Pnt, gp_Pnt2d
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array1OfPnt2d
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

from cad_io.arrays import Floats


def cubic(knots: Floats, poles: Floats) -> Geom_BSplineCurve | Geom2d_BSplineCurve:
    """The curve with clamped knots (m + 4,) and poles (m, 2) in a parameter plane, or (m, 3) in space."""
    flat = poles.shape[1] == 2
    array = (TColgp_Array1OfPnt2d if flat else TColgp_Array1OfPnt)(1, len(poles))
    for i, pole in enumerate(poles.tolist(), 1):
        array.SetValue(i, (gp_Pnt2d if flat else gp_Pnt)(*pole))
    value, count = np.unique(knots, return_counts=True)
    distinct, times = TColStd_Array1OfReal(1, len(value)), TColStd_Array1OfInteger(1, len(value))
    for i, (x, m) in enumerate(zip(value.tolist(), count.tolist(), strict=True), 1):
        distinct.SetValue(i, x)
        times.SetValue(i, m)
    return (Geom2d_BSplineCurve if flat else Geom_BSplineCurve)(array, distinct, times, 3)
