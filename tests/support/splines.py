"""B-spline faces at random, made with the kernel."""

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal


def array(kind, numbers, width=1):
    if width == 1:
        out = kind(1, len(numbers))
        for i, number in enumerate(numbers, 1):
            out.SetValue(i, number)
        return out
    rows, columns = numbers.shape[:2]
    out = kind(1, rows, 1, columns)
    for i in range(rows):
        for j in range(columns):
            out.SetValue(i + 1, j + 1, gp_Pnt(*numbers[i, j].tolist()) if numbers.ndim == 3 else float(numbers[i, j]))
    return out


def bspline(rng, degrees, spans, rational, periodic=(False, False)):
    """A face of a B-spline surface at random, with knots of any continuity."""
    poles, knots, times = [], [], []
    for degree, count, round_ in zip(degrees, spans, periodic, strict=True):
        knots.append(np.cumsum(rng.uniform(0.2, 2.0, count + 1)) - 3.0)
        inner = rng.integers(1, degree + 1, max(0, count - 1)).tolist()
        ends = int(rng.integers(1, degree + 1)) if round_ else degree + 1
        times.append([ends, *inner, ends])
        poles.append(sum(times[-1][:-1]) if round_ else sum(times[-1]) - degree - 1)
    grid = np.stack(np.meshgrid(*map(np.arange, poles), indexing="ij"), -1)
    points = np.concatenate([grid * 3.0, rng.normal(0, 2, (*poles, 1))], -1) + rng.normal(0, 0.3, (*poles, 3))
    more = [array(TColStd_Array2OfReal, rng.uniform(0.3, 3.0, poles), 2)] if rational else []
    surface = Geom_BSplineSurface(
        array(TColgp_Array2OfPnt, points, 3), *more, *(array(TColStd_Array1OfReal, k.tolist()) for k in knots),
        *(array(TColStd_Array1OfInteger, t) for t in times), *degrees, *periodic,
    )  # fmt: skip
    return BRepBuilderAPI_MakeFace(surface, 1e-6).Face(), knots
