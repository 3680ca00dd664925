"""What is kept of triangles, profiles about an axis and proxies of faces of many kinds."""

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_OffsetSurface
from OCP.Geom2d import Geom2d_Ellipse, Geom2d_Hyperbola, Geom2d_OffsetCurve, Geom2d_Parabola
from OCP.Geom2dAdaptor import Geom2dAdaptor_Curve
from OCP.gp import gp_Ax22d, gp_Dir2d, gp_Pnt2d

from cad_io import read_part
from cad_io.arrays import LostFace
from cad_io.part.part import NO_AREA, Part
from cad_io.tessellate import tessellate
from cad_io.tessellate.curves import farthest, packed, point, workspace
from cad_io.tessellate.meridian import meridian
from cad_io.tessellate.planar import delaunay
from cad_io.tessellate.proxies import stand_ins
from cad_io.tessellate.start import expected
from tests.support.cad_parts import (
    as_nurbs,
    ball,
    box,
    compound,
    cone,
    cut,
    drilled,
    extruded_arc,
    holed_patch,
    loose,
    patch,
    pocketed,
    revolved_wave,
    ring,
    rod,
    spring,
    triangulated,
)  # fmt: skip
from tests.support.splines import bspline


def _random(seed, degrees, spans, *, rational=True):
    return bspline(np.random.default_rng(seed), degrees, spans, rational)[0]


def offset(distance, base=patch):
    """What the kernel alone evaluates."""
    return BRepBuilderAPI_MakeFace(Geom_OffsetSurface(BRep_Tool.Surface_s(base(5)), distance), 1e-6).Face()


SHAPES = {
    "ball": lambda: ball(9.7), "ring": lambda: ring(19.3, 5.1), "cone": lambda: cone(8.1, 2.3, 10.7),
    "point": lambda: cone(8.1, 0, 10.7), "rod": lambda: cut(rod(5.3, 17.1), rod(2.1, 9.3, (4.1, 0.7, 11.9))),
    "patch": lambda: patch(3), "holed": lambda: holed_patch(2), "pocketed": lambda: pocketed(5.3), "drilled": drilled,
    "ball as B-spline": lambda: as_nurbs(ball(9.7)), "ring as B-spline": lambda: as_nurbs(ring(19.3, 5.1)),
    "cone as B-spline": lambda: as_nurbs(cone(8.1, 0, 10.7)),
    "cut ring": lambda: cut(ring(19.3, 5.1), box(50, 50, 50, (3.1, -7.3, -2.9))),
    "bored ring": lambda: cut(ring(19.3, 5.1), rod(3.3, 60, (18.9, 1.3, -30))), "spring": lambda: spring(2, 10.3, 1.7, 6.1, 33),
    "loose": lambda: loose(pocketed(5.3), 0.013), "sharp": lambda: _random(5, (1, 3), (4, 3)),
    "smooth": lambda: _random(6, (4, 3), (2, 3)), "polynomial": lambda: _random(7, (2, 2), (5, 4), rational=False),
    "extruded": extruded_arc, "revolved": revolved_wave, "offset": lambda: offset(1.5),
    "bored offset": lambda: cut(offset(-2.3), rod(9.1, 200, (7, 5, -100))), "long": lambda: _random(8, (2, 1), (3, 270)),
    "many": lambda: compound(ring(19.3, 5.1), holed_patch(4), extruded_arc(), offset(1.1), cone(8.1, 2.3, 10.7)),
}  # fmt: skip
CHORDS = (0.71, 0.053, 0.011)
#: What takes long is asked for less.
COARSER = {"offset": (0.71, 0.21), "bored offset": (1.9,), "long": (7.1,)}


@pytest.mark.parametrize("name", SHAPES)
def test_triangles_are_those_that_are_kept(keeps, name):
    part = read_part(SHAPES[name]())
    numbers = [face.number for face in part.faces]
    chords = COARSER.get(name, CHORDS)
    made = [tessellate(part, chord) for chord in chords]
    few = [tessellate(part, chords[-1], budget=budget) for budget in (40, 310, 2100)]
    guess = [expected(part, numbers, chord) for chord in chords]
    keeps(f"triangles_{name.replace(' ', '_')}", {"made": made, "few": few, "expected": guess})


AXES = (((0.3, -0.7, 4.1), (0, 0, -2.3)), ((2.1, 1.3, -3.7), (1, 2, 2)), ((0, 0, 0.9), (0, 0, 1.7)))
BODIES = {
    **{name: SHAPES[name] for name in ("ball", "ring", "cone", "rod", "cut ring", "cone as B-spline")},
    "two": lambda: compound(rod(5.3, 17.1), ball(7.1, (0, 0, 29.3))),
    "on a box": lambda: compound(rod(), box(4, 4, 4, (-2, -2, -6))),
}  # fmt: skip


@pytest.mark.parametrize("name", BODIES)
def test_profiles_about_an_axis_are_those_that_are_kept(keeps, name):
    part = read_part(BODIES[name]())
    keeps(f"profile_{name.replace(' ', '_')}", [meridian(part, *axis, chord) for axis in AXES for chord in (0.31, 0.023)])


def test_proxies_are_those_that_are_kept(keeps):
    part = read_part(compound(*(make() for name, make in SHAPES.items() if name in ("ball", "cut ring", "holed", "rod"))))
    every = [(face.number, "tried") for face in part.faces]
    areas = [(face.number, NO_AREA) for face in part.faces]
    keeps("proxies", [stand_ins(part, which, chord) for which in (every, areas) for chord in (0.31, 0.023)])


def test_boxes_of_faces_that_are_only_in_the_file_are_those_that_are_kept(keeps):
    """Of such as have a box and no number: the others stand as they are, or nobody knows where they stood."""
    part = Part(
        box(9.1, 7.3, 5.2),
        lost=(
            LostFace("#1", "", "it is gone", box=((1.1, 2.3, 3.9), (4.2, 9.7, 5.3))),
            LostFace("#2", "", "it is gone"),
            LostFace("#3", "", "a hole is gone", 4, ((0.0, 0.0, 0.0), (9.1, 7.3, 0.0))),
            LostFace("#4", "", "it is gone", box=((-3.3, 0.7, -1.1), (2.2, 0.7, 8.8))),
        ),
    )
    keeps("proxies_lost", [stand_ins(part, which, 0.1) for which in ((), ((2, "tried"),))])


@pytest.mark.parametrize("name", ["pocketed", "drilled", "loose", "many", "cut ring"])
def test_proxies_of_faces_of_triangles_are_those_that_are_kept(keeps, name):
    """As they are, and without some of them: caps close what is open."""
    part = read_part(triangulated(SHAPES[name]()))
    every = [(face.number, "tried") for face in part.faces]
    keeps(f"proxies_{name.replace(' ', '_')}", [stand_ins(part, which, 0.1) for which in (every, every[1:], every[::2])])


def flat_curve(name):
    """Curves of a parameter plane that are no lines, conics or splines."""
    axes = gp_Ax22d(gp_Pnt2d(0.3, -0.7), gp_Dir2d(0.8, 0.6))
    if name == "parabola":
        return Geom2d_Parabola(axes, 1.3), (-2.1, 1.7)
    if name == "hyperbola":
        return Geom2d_Hyperbola(axes, 1.9, 1.1), (-0.7, 1.2)
    return Geom2d_OffsetCurve(Geom2d_Ellipse(axes, 4.3, 2.9), 0.7), (0.4, 4.9)


@pytest.mark.parametrize("name", ["parabola", "hyperbola", "offset"])
def test_borders_that_are_replaced_are_where_they_were(keeps, name):
    """They run through points of theirs, and nearly as they do between; what is said of their chords holds."""
    curve, ends = flat_curve(name)
    adaptor = Geom2dAdaptor_Curve(curve)
    made, exact = packed([adaptor], [ends])
    assert not exact
    t = np.linspace(*ends, 400)
    ours = np.array([point(made, 0, each, workspace()) for each in t])
    there = np.array([adaptor.Value(each).Coord() for each in t.tolist()])
    np.testing.assert_allclose(ours, there, atol=1e-7)
    cut_at = np.linspace(*ends, 8)
    most = np.zeros((1, 2))
    farthest(made, np.zeros(7, np.int64), np.stack([cut_at[:-1], cut_at[1:]], axis=1), most)
    keeps(f"border_{name}", [made, most])


def test_flipped_triangles_are_those_that_are_kept(keeps):
    rng = np.random.default_rng(3)
    found = []
    for n in (4, 9, 14):
        x, y = np.meshgrid(np.arange(n, dtype=float), 0.37 * np.arange(n), indexing="ij")
        uv = np.stack([x + 0.31 * rng.random(x.shape), y + 0.12 * rng.random(x.shape)], -1)
        point = np.concatenate([uv, rng.normal(0, 0.2, (n, n, 1))], -1).reshape(-1, 3)
        at = np.arange(n * n).reshape(n, n)
        a, b, c, d = (each.ravel() for each in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
        found.append(delaunay(point, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)))
    keeps("flips", found)
