"""Postures of real parts, proved by branch and bound on the exact surface.

No closed form is known here: contacts and axes are drawn, a third is moved to the border by bisection, and each is kept only where the bounds decide it.
`safe` means that no point of the surface can lie deeper than `SAFE` in the tool; `blocked` that a point of it surely lies in the tool.
The clearance of a safe posture leaves out the face in contact and its neighbours, but for shank and holder.
What the bounds do not decide is dropped and counted.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepLProp import BRepLProp_SLProps
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt, gp_Pnt2d
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_IN, TopAbs_OUT, TopAbs_REVERSED, TopAbs_SOLID
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

from conformance.exact.bound import Tree, deepest, least, numbers, tree
from conformance.exact.cells import cells
from conformance.made.part import STEADY_DEG, frame, leaning
from conformance.posture import Postures, Words
from conformance.tool import Floats, Tool

#: The depth (mm) up to which a posture is called safe, and the distance up to which clearances are told.
SAFE, REACH = 4e-3, 5.0
#: How far (mm) the turn of a posture moves the end of a tool at least, where it is asked whether the posture is steady.
SWAY = 0.02
#: Depths beyond this (mm) are only proved to be beyond it.
DEEP = 0.3


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape ready to be asked: its tree, its faces and which of them join, and its solids."""

    tree: Tree
    faces: list[tuple[BRepAdaptor_Surface, BRepTopAdaptor_FClass2d, tuple[float, ...], float]]
    joined: NDArray[np.bool_]
    solids: list[TopoDS_Shape]


def ready(shape: TopoDS_Shape) -> Shape:
    """Return a shape ready to be asked; an UnfitError names a face that no enclosure is made for."""
    listed, walk = [], TopExp_Explorer(shape, TopAbs_FACE)
    while walk.More():
        listed.append(TopoDS.Face_s(walk.Current()))
        walk.Next()
    joined = np.eye(len(listed), dtype=bool)
    edges = TopTools_IndexedDataMapOfShapeListOfShape()
    TopExp.MapShapesAndAncestors_s(shape, TopAbs_EDGE, TopAbs_FACE, edges)
    for i in range(1, edges.Extent() + 1):
        mine = [k for k, face in enumerate(listed) if any(face.IsSame(other) for other in edges.FindFromIndex(i))]
        for a in mine:
            joined[a, mine] = True
    solids, walk = [], TopExp_Explorer(shape, TopAbs_SOLID)
    while walk.More():
        solids.append(walk.Current())
        walk.Next()
    faces = [
        (BRepAdaptor_Surface(f, True), BRepTopAdaptor_FClass2d(f, 1e-9), BRepTools.UVBounds_s(f), -1.0 if f.Orientation() == TopAbs_REVERSED else 1.0)
        for f in listed
    ]
    return Shape(tree(cells(shape)), faces, joined, solids)


def contacts(shape: Shape, rng: np.random.Generator, count: int) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Return contacts (n, 3), outer normals and face numbers: faces in turn, parameters at random, only where what lies before them is no material."""
    points, normals, numbers_ = [], [], []
    classifiers = [BRepClass3d_SolidClassifier(s) for s in shape.solids]
    order = rng.permutation(len(shape.faces))
    for k in range(6 * count):
        if len(points) == count:
            break
        number = int(order[k % len(order)])
        adaptor, trim, (u0, u1, v0, v1), sign = shape.faces[number]
        u, v = rng.uniform(u0, u1), rng.uniform(v0, v1)
        if trim.Perform(gp_Pnt2d(u, v)) != TopAbs_IN:
            continue
        properties = BRepLProp_SLProps(adaptor, u, v, 1, 1e-9)
        if not properties.IsNormalDefined():
            continue
        p, n = properties.Value(), properties.Normal()
        normal = sign * np.array([n.X(), n.Y(), n.Z()])
        ahead = np.array([p.X(), p.Y(), p.Z()]) + 0.02 * normal
        for classifier in classifiers:
            classifier.Perform(gp_Pnt(*ahead), 1e-7)
        if classifiers and all(c.State() == TopAbs_OUT for c in classifiers):
            points.append(ahead - 0.02 * normal)
            normals.append(normal)
            numbers_.append(number)
    return np.array(points).reshape(-1, 3), np.array(normals).reshape(-1, 3), np.array(numbers_, int)


@dataclass(frozen=True, eq=False)
class Proved:
    """Bounds for postures (n,): of the depth on all faces, and of the clearance from those not in contact."""

    low: Floats
    high: Floats
    clear_low: Floats
    clear_high: Floats


def bounds(shape: Shape, tool: Tool, face: NDArray[np.int64], tip: Floats, axis: Floats, *, sign: bool = False) -> Proved:
    """Return the bounds of postures whose contacts lie on `face (n,)`; `sign` asks for no more than whether they are blocked."""
    rows = numbers(tool)
    out = np.full((4, len(tip)), np.nan)
    for i in range(len(tip)):
        out[:2, i] = least(shape.tree, rows, tip[i], axis[i], enough=SAFE, deep=-SAFE if sign else -DEEP)[:2]
        if not sign and out[0, i] >= -SAFE:
            out[2:, i] = least(shape.tree, rows, tip[i], axis[i], shape.joined[face[i]], enough=REACH)[:2]
    return Proved(*out)


def postures(shape: Shape, name: str, tools: list[Tool], count: int, seed: int, tell: Callable[[str], None] = lambda line: None) -> Postures:
    """Return about `count` proved postures, half of them safe as far as there are both."""
    rng = np.random.default_rng([seed, *name.encode()])
    each = int(np.ceil(count / len(tools)))
    return Postures.joined(_of_tool(shape, name, tool, rng, each, tell) for tool in tools)


def _of_tool(shape: Shape, name: str, tool: Tool, rng: np.random.Generator, count: int, tell: Callable[[str], None]) -> Postures:
    contact, normal, face = contacts(shape, rng, int(1.6 * count))
    one, two = (_drawn(rng, normal) for _ in range(2))
    hit = [_blocked(shape, tool, contact, normal, face, axis) for axis in (one, two)]
    pair = np.flatnonzero(hit[0] != hit[1])[: count // 3]
    swap = hit[0][pair, None]
    border = _border(shape, tool, contact[pair], normal[pair], face[pair], np.where(swap, two[pair], one[pair]), np.where(swap, one[pair], two[pair]), rng)
    rest = count - len(pair)
    both = np.flatnonzero(~hit[0]), np.flatnonzero(hit[0])
    rows = np.concatenate([mine[: max(rest // 2, rest - len(other))] for mine, other in zip(both, both[::-1], strict=True)])
    contact, normal, face = (np.concatenate([x[rows], x[pair]]) for x in (contact, normal, face))
    axis = np.concatenate([one[rows], border])
    tip = tool.stands(contact, normal, axis)
    proved = bounds(shape, tool, face, tip, axis)
    blocked, safe = proved.high < 0, proved.low >= -SAFE
    blocked &= ~safe
    loose = np.flatnonzero(safe)
    proved.clear_low[loose], proved.clear_high[loose] = clearances(
        shape, tool, contact[loose], normal[loose], axis[loose], proved.clear_low[loose], proved.clear_high[loose]
    )
    radius = max(p.deepest for p in tool.pieces)
    low = np.where(blocked, np.maximum(proved.low, -radius), proved.clear_low)
    high = np.where(blocked, proved.high, proved.clear_high)
    high = np.where(np.isfinite(high), high, 1000.0)
    kept = np.flatnonzero(blocked | safe)
    tell(f"{name} {tool.name}: {safe.sum()} safe, {blocked.sum()} blocked, {len(axis) - len(kept)} not decided")
    n = len(kept)
    word = lambda text: np.full(n, text)
    return Postures(
        word(name),
        word(tool.name),
        word("free"),
        contact[kept],
        normal[kept],
        axis[kept],
        tip[kept],
        np.where(blocked[kept], "blocked", "safe"),
        low[kept],
        high[kept],
        np.full(n, np.nan),
        np.where(blocked[kept], reasons(shape, tool, tip[kept], axis[kept]), ""),
        word("bound"),
    )


def clearances(shape: Shape, tool: Tool, contact: Floats, normal: Floats, axis: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return bounds of the clearance of safe postures: `low` and `high` of the faces not in contact, and what shank and holder have of all faces.

    As with closed forms, a hair from entering the surface at its contact the clearance of the rest says nothing: there it is 0 at most.
    """
    low, high = low.copy(), high.copy()
    tip = tool.stands(contact, normal, axis)
    rows, aloof = numbers(tool), np.array([piece.part != "cutter" for piece in tool.pieces])
    if aloof.any():
        for i in range(len(tip)):
            near = least(shape.tree, rows[aloof], tip[i], axis[i], enough=REACH)
            low[i], high[i] = min(low[i], near[0]), min(high[i], near[1])
    turn = np.full(len(axis), max(np.radians(STEADY_DEG), SWAY / tool.length))
    e1, e2 = frame(axis)
    for way in np.arange(4) * 0.5 * np.pi:
        near_axis = leaning(axis, np.cos(way) * e1 + np.sin(way) * e2, turn)
        where = tool.stands(contact, normal, near_axis)
        for i in range(len(tip)):
            if low[i] > 0.0 and least(shape.tree, rows, where[i], near_axis[i], enough=SAFE)[0] < -SAFE:
                low[i] = 0.0
    return low, high


def reasons(shape: Shape, tool: Tool, tip: Floats, axis: Floats) -> Words:
    """Return the part of the tool (n,) that the surface surely reaches deepest: `cutter`, `shank` or `holder`."""
    rows = numbers(tool)
    return np.array([tool.pieces[deepest(shape.tree, rows, t, a, -DEEP)].part for t, a in zip(tip, axis, strict=True)], dtype="U7")


def _drawn(rng: np.random.Generator, normal: Floats) -> Floats:
    """Return axes tilted up to 89 degrees, the smaller tilts more often, as a machinist has them."""
    n = len(normal)
    e1, e2 = frame(normal)
    turn, tilt = rng.uniform(0, 2 * np.pi, n), np.radians(89.0 * rng.uniform(0.0, 1.0, n) ** 1.5 + 0.05)
    return leaning(normal, np.cos(turn)[:, None] * e1 + np.sin(turn)[:, None] * e2, tilt)


def _blocked(shape: Shape, tool: Tool, contact: Floats, normal: Floats, face: NDArray[np.int64], axis: Floats) -> NDArray[np.bool_]:
    return bounds(shape, tool, face, tool.stands(contact, normal, axis), axis, sign=True).low < -SAFE


def _border(shape: Shape, tool: Tool, contact: Floats, normal: Floats, face: NDArray[np.int64], safe: Floats, hit: Floats, rng: np.random.Generator) -> Floats:
    """Return axes near the border between a safe and a blocked one."""
    n = len(contact)
    a, b = np.zeros(n), np.ones(n)

    def between(t: Floats) -> Floats:
        axis = (1 - t)[:, None] * safe + t[:, None] * hit
        return axis / np.linalg.norm(axis, axis=1)[:, None]

    for _ in range(10):
        middle = 0.5 * (a + b)
        bad = _blocked(shape, tool, contact, normal, face, between(middle))
        a, b = np.where(bad, a, middle), np.where(bad, middle, b)
    return between(np.clip(a + rng.choice([-1.0, 1.0], n) * 10 ** rng.uniform(-3.5, -1.2, n), 0.0, 1.0))
