"""Solids whose faces are quadrics and tori cut by one another: seams, poles, oblique trims, tangent cuts."""

from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from tests.support.cad_parts import ball, box, cone, cut, ring, rod


def put(shape, angle=0.0, axis=(1, 0, 0), by=(0, 0, 0)):
    turn, shift = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(*map(float, axis))), float(angle))
    shift.SetTranslation(gp_Vec(*map(float, by)))
    return BRepBuilderAPI_Transform(shape, shift.Multiplied(turn), True).Shape()


def half(angle, axis=(1, 0, 0), by=(0, 0, 0)):
    """A large block above an oblique plane."""
    return put(box(400, 400, 400, (-200, -200, 0)), angle, axis, by)


def common(a, b):
    return BRepAlgoAPI_Common(a, b).Shape()


def fuse(a, b):
    return BRepAlgoAPI_Fuse(a, b).Shape()


def filleted(shape, radius, least=0.0):
    made, seen = BRepFilletAPI_MakeFillet(shape), TopExp_Explorer(shape, TopAbs_EDGE)
    while seen.More():
        made.Add(radius, TopoDS.Edge_s(seen.Current()))
        seen.Next()
    return made.Shape()


def mould():
    """A block with a pocket of a rod, a ball, a cone and a ring, as a die half has."""
    block = box(120, 90, 40, (-60, -45, -40))
    for tool in (
        put(rod(12, 200, (0, 0, -100)), 1.2, (0, 1, 0), (0, 5, 3)),
        ball(20, (20, 0, 8)),
        put(cone(18, 4, 30), 2.6, (1, 0.3, 0), (-30, 10, 5)),
        put(ring(25, 6), 0.2, (1, 1, 0), (0, 0, 2)),
    ):
        block = cut(block, tool)
    return block


MOULDS = {
    "rod, oblique": lambda: cut(rod(5, 40), half(0.9, by=(0, 0, 25))),
    "rod, very oblique": lambda: cut(rod(5, 200), half(1.4, by=(0, 0, 100))),
    "rod, oblique through the seam": lambda: cut(rod(5, 40), half(0.9, (0.2, 1, 0), (0, 0, 25))),
    "cone, oblique": lambda: cut(cone(10, 2, 30), half(0.8, by=(0, 0, 15))),
    "cone, apex, along a generatrix": lambda: cut(cone(10, 0, 30), half(1.2, (0, 1, 0), (3, 0, 10))),
    "cone, parabola": lambda: cut(cone(10, 0, 30), half(1.2490457723982544, (0, 1, 0), (-2, 0, 8))),
    "ball, cap": lambda: cut(ball(10), half(0.7, by=(0, 0, 3))),
    "ball, tiny cap": lambda: common(ball(10), half(0.7, by=(0, -6.43, 7.6))),
    "ball, through the pole": lambda: cut(ball(10), half(1.1, by=(0, 0, 10))),
    "ball with an oblique hole": lambda: cut(ball(10), put(rod(3, 60, (0, 0, -30)), 0.8, (1, 0.3, 0), (4, 0, 0))),
    "ball with a hole at the pole": lambda: cut(ball(10), rod(3, 60, (1, 0, -30))),
    "ring, oblique": lambda: cut(ring(20, 5), half(0.5, (1, 0.2, 0), (0, 0, 1))),
    "ring, Villarceau": lambda: cut(ring(20, 5), half(0.2526802551420787, by=(0, 0, 0))),
    "ring, top off": lambda: cut(ring(20, 5), half(0.0, by=(0, 0, 4.99))),
    "ring with a hole": lambda: cut(ring(20, 5), put(rod(2, 60, (0, 0, -30)), 0.5, (0, 1, 0), (19, 1, 0))),
    "rod with a hole across the seam": lambda: cut(rod(10, 40), put(rod(4, 60, (0, 0, -30)), 1.57, (0, 1, 0), (0, 0, 20))),
    "rod with an oblique hole": lambda: cut(rod(10, 40), put(rod(9.9, 80, (0, 0, -40)), 1.0, (0.1, 1, 0), (0, 0, 20))),
    "rods of one radius": lambda: fuse(rod(5, 40), put(rod(5, 40, (0, 0, -20)), 1.0, (0, 1, 0), (0, 0, 20))),
    "cone and ball": lambda: cut(cone(10, 3, 30), ball(9, (6, 2, 14))),
    "ring and ball": lambda: cut(ring(20, 6), ball(9, (19, 4, 4))),
    "ring and rod": lambda: fuse(ring(20, 6), put(rod(4, 60, (0, 0, -30)), 1.4, (1, 0, 0), (18, 0, 3))),
    "filleted box": lambda: filleted(box(40, 30, 20), 4),
    "filleted drilled rod": lambda: filleted(cut(rod(20, 30), rod(6, 60, (5, 0, -10))), 2),
    "filleted wedge": lambda: filleted(cut(box(40, 40, 40), half(0.6, (1, 0.4, 0), (0, 0, 20))), 2),
    "mould": mould,
}
