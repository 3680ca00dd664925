"""Shapes with known answers, made with the kernel alone."""

import math

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Ax3, gp_Cylinder, gp_Dir, gp_Pln, gp_Pnt, gp_Sphere, gp_Torus
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopoDS import TopoDS_Shell
from scipy.interpolate import BSpline


def shell(*faces):
    result, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(result)
    for face in faces:
        builder.Add(result, face)
    return result


def axes(origin=(0, 0, 0), z=(0, 0, 1), x=(1, 0, 0)):
    return gp_Ax3(gp_Pnt(*map(float, origin)), gp_Dir(*map(float, z)), gp_Dir(*map(float, x)))


def plane(u, v, origin=(0, 0, 0), z=(0, 0, 1), x=(1, 0, 0)):
    """A rectangle u x v of the plane through origin with normal z and first axis x."""
    return BRepBuilderAPI_MakeFace(gp_Pln(axes(origin, z, x)), *map(float, (*u, *v))).Face()


def trough(radius, half_length, span=math.pi):
    """The lower part of a cylinder along Y, bottom line through the origin; material outside (up is free)."""
    face = BRepBuilderAPI_MakeFace(gp_Cylinder(axes((0, -half_length, radius), (0, 1, 0), (0, 0, -1)), radius),
                                   -span / 2, span / 2, 0.0, 2.0 * half_length).Face()  # fmt: skip
    return face.Reversed()


def ridge(radius, half_length):
    """The upper half of a cylinder along Y, top line through the origin; material inside."""
    return BRepBuilderAPI_MakeFace(gp_Cylinder(axes((0, -half_length, -radius), (0, 1, 0), (0, 0, 1)), radius),
                                   -math.pi / 2, math.pi / 2, 0.0, 2.0 * half_length).Face()  # fmt: skip


def bowl(radius):
    """The lower half of a sphere through the origin; material outside."""
    return BRepBuilderAPI_MakeFace(gp_Sphere(axes((0, 0, radius)), radius), 0.0, 2 * math.pi, -math.pi / 2, 0.0).Face().Reversed()


def dome(radius):
    """The upper half of a sphere through the origin; material inside. The pole is put aside, where no test looks."""
    frame = axes((0, 0, -radius), (1, 0, 0), (0, 0, 1))
    return BRepBuilderAPI_MakeFace(gp_Sphere(frame, radius), -math.pi / 2, math.pi / 2, -1.5, 1.5).Face()


def torus(major, minor):
    return BRepBuilderAPI_MakeFace(gp_Torus(axes(), major, minor), 0.0, 2 * math.pi, 0.0, 2 * math.pi).Face()


class Patch:
    """A bicubic B-spline patch on a uniform net, evaluated by scipy: the kernel's independent twin."""

    def __init__(self, net):
        self.net = np.asarray(net, float)
        self.knots = [np.concatenate([[0] * 3, np.linspace(0, 1, n - 2), [1] * 3]) for n in self.net.shape[:2]]

    @classmethod
    def random(cls, rng, size=60.0, height=12.0, n=8):
        x, y = np.meshgrid(np.linspace(0, size, n), np.linspace(0, size, n), indexing="ij")
        return cls(np.stack([x, y, height * rng.standard_normal((n, n))], -1))

    def at(self, u, v):
        """Points at scattered parameters."""
        along_u = BSpline(self.knots[0], self.net, 3)
        rows = along_u(np.clip(u, 0, 1))
        basis = BSpline.design_matrix(np.clip(v, 0, 1), self.knots[1], 3).toarray()
        return np.einsum("nj,njk->nk", basis, rows)

    def grid(self, n):
        """(n, n, 3) points and the parameters of the grid lines."""
        t = np.linspace(0, 1, n)
        rows = BSpline(self.knots[0], self.net, 3)(t)
        return np.moveaxis(BSpline(self.knots[1], np.moveaxis(rows, 1, 0), 3)(t), 1, 0), t

    def face(self):
        nu, nv, _ = self.net.shape
        poles = TColgp_Array2OfPnt(1, nu, 1, nv)
        for i in range(nu):
            for j in range(nv):
                poles.SetValue(i + 1, j + 1, gp_Pnt(*map(float, self.net[i, j])))
        arrays = []
        for t in self.knots:
            values, counts = np.unique(t, return_counts=True)
            knots, multiplicities = TColStd_Array1OfReal(1, len(values)), TColStd_Array1OfInteger(1, len(values))
            for i, (value, count) in enumerate(zip(values, counts, strict=True)):
                knots.SetValue(i + 1, float(value))
                multiplicities.SetValue(i + 1, int(count))
            arrays.append((knots, multiplicities))
        (ku, mu), (kv, mv) = arrays
        return BRepBuilderAPI_MakeFace(Geom_BSplineSurface(poles, ku, kv, mu, mv, 3, 3), 1e-7).Face()
