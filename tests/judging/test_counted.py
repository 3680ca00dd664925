"""What is counted: the area that served cells cover of trimmed faces, gaps up to the border, chords up to true borders."""

import math
import sys
from dataclasses import replace

import numpy as np
import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.Geom import Geom_Circle, Geom_Line, Geom_Plane
from OCP.gp import gp_Ax2, gp_Dir, gp_Pln, gp_Pnt, gp_Pnt2d
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_OUT, TopAbs_REVERSED, TopAbs_VERTEX
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Vertex, TopoDS_Wire
from scipy.spatial import cKDTree

from cad_io import read_part
from cad_io.face.curvature import density
from cad_io.face.trim import clipped, inside
from cad_io.kernel import edges_of, first_derivatives
from cad_io.part.bodies import orient
from cad_io.sample import sample
from cad_io.sample.grid_lines import border_probes
from cad_io.tessellate import tessellate
from cad_io.tessellate.planar import folded, upright
from plan_cutters import Cutter, Machine, plan
from plan_cutters.judging.between import between
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from tests.support import shapes
from tests.support.cad_parts import box, compound, cut, mirror, real, ring, rod
from tests.support.contacts import UP, deepest, dense, served
from tests.support.distances import ROUNDING, farthest_from
from tests.support.moulds import MOULDS, put
from tests.support.places import ROOT

sys.path.append(str(ROOT / "benchmarks"))
from chords import violations

WIDE = 60.0


def gentle(bend=300.0):
    """A shallow dome over a square of WIDE mm, from its middle."""
    x, y = np.meshgrid(*[np.linspace(-0.5 * WIDE, 0.5 * WIDE, 7)] * 2, indexing="ij")
    return shapes.Patch(np.stack([x, y, -(x**2 + y**2) / bend], axis=-1)).face()


def wall(x, high=30.0, y=(-40.0, 80.0)):
    """A plate that stands beside the line at x and is no target."""
    return box(1.0, y[1], high, (x, y[0], -20.0))


def trimmed(*tools):
    """The dome without what lies in the tools."""
    shape = gentle()
    for tool in tools:
        shape = cut(shape, tool)
    return shape


#: Trims of the dome, and what stands beside them. Grid lines of the 25 x 25 grid are 2.5 mm apart.
TRIMS = {
    "between lines, a wall beside": lambda: compound(trimmed(box(40, 90, 60, (11.2, -45, -40))), wall(11.25)),
    "oblique line": lambda: trimmed(put(box(90, 90, 80, (0, -45, -40)), 0.4, (0, 0, 1), (9.3, 0, 0))),
    "circles": lambda: trimmed(rod(11.3, 80, (4.1, 3.7, -40)), rod(5.2, 80, (-17.3, -12.9, -40))),
    "thin neck": lambda: trimmed(box(30, 40, 60, (-14.1, 0.9, -40)), box(30, 40, 60, (-14.1, -40.7, -40))),
    "a strip between two lines": lambda: trimmed(box(40, 90, 60, (1.9, -45, -40)), box(40, 90, 60, (-39.6, -45, -40))),
}


def random_points(whole, number, count, rng):
    """Parameters (count, 2) of random points of a face, evenly spread over its area; the kernel says what is inside."""
    u0, u1, v0, v1 = whole.trim(number).box
    kernel = BRepTopAdaptor_FClass2d(whole.face(number), 1e-9)
    most = 1.05 * density(whole, number, rng.uniform((u0, v0), (u1, v1), (4000, 2))).max()
    found = np.zeros((0, 2))
    while len(found) < count:
        uv = rng.uniform((u0, v0), (u1, v1), (2 * count, 2))
        uv = uv[rng.uniform(0, most, len(uv)) < density(whole, number, uv)]
        uv = uv[[kernel.Perform(gp_Pnt2d(*at)) != TopAbs_OUT for at in uv.tolist()]]
        found = np.concatenate([found, uv])
    return found[:count]


def within(cells, uv):
    """Which points lie in one of the cells."""
    low, high = cells.uv - 0.5 * cells.span, cells.uv + 0.5 * cells.span
    found = np.zeros(len(uv), bool)
    for rows in np.array_split(np.arange(len(uv)), 40):
        at = uv[rows, None]
        found[rows] = ((at >= low) & (at <= high)).all(axis=2).any(axis=1)
    return found


@pytest.mark.slow("another trim of the same law", but=("oblique line", "a strip", "thin neck-0"))
@pytest.mark.parametrize("budget", [0, 3000])
@pytest.mark.parametrize("make", TRIMS.values(), ids=TRIMS.keys())
def test_the_share_is_that_of_random_points_in_served_cells(make, budget):
    rng = np.random.default_rng(3)
    cutter = Cutter.flat(radius=4.0, length=60.0)
    found, geometry, whole = served(make(), cutter, budget=budget, grid=25, faces="1", tolerance=0.02)
    count = 4000
    share = within(found.cells, random_points(whole, 1, count, rng)).mean()
    spread = math.sqrt(max(share * (1 - share), 1 / count) / count)
    assert found.share == pytest.approx(share, abs=4 * spread)
    if budget:
        assert deepest(found, geometry, whole, cutter, dense(whole, 0.5), 300, rng) < 0.02


@pytest.mark.slow("draws many surfaces")
def test_the_share_is_that_of_random_points_of_all_faces():
    rng, cutter = np.random.default_rng(6), Cutter.flat(radius=1.0, length=200.0)
    found, geometry, whole = served(MOULDS["mould"](), cutter, budget=4000, spacing=4.0, faces="all", tolerance=0.1)
    area, hit, spread, each = 0.0, 0.0, 0.0, 300
    for face in whole.faces:
        mine = replace(found.cells, **{k: getattr(found.cells, k)[found.cells.face == face.number]
                                       for k in ("face", "uv", "span", "axis")})  # fmt: skip
        share = within(mine, random_points(whole, face.number, each, rng)).mean()
        area, hit = area + face.area, hit + share * face.area
        spread += max(share * (1 - share), 1 / each) / each * face.area**2
    assert len(np.unique(found.cells.face)) > 8
    assert found.share == pytest.approx(hit / area, abs=4 * math.sqrt(spread) / area)
    assert deepest(found, geometry, whole, cutter, dense(whole, 1.0), 300, rng) < 0.1


TURNED = {
    "rod, hole across the seam": (MOULDS["rod with a hole across the seam"], {"grid": 61}),
    "ball, hole at the pole": (MOULDS["ball with a hole at the pole"], {"grid": 41}),
    "ring, hole": (lambda: cut(ring(60, 20), put(rod(8, 200, (0, 0, -100)), 0.5, (0, 1, 0), (76, 4, 0))), {"spacing": 2.5}),
}


@pytest.mark.slow("draws many surfaces", only=("ring",))
@pytest.mark.parametrize(("make", "how"), TURNED.values(), ids=TURNED.keys())
def test_the_share_is_right_across_seams(make, how):
    """Cells on both sides of a seam, with a trim that crosses it, and up to poles."""
    cutter, rng, shape = Cutter.flat(radius=2.0, length=60.0), np.random.default_rng(4), make()
    number = max(read_part(shape).faces, key=lambda face: (face.surface != "plane") * face.area).number
    found, geometry, whole = served(shape, cutter, budget=1500, faces=str(number), tolerance=0.1, **how)
    count = 4000
    share = within(found.cells, random_points(whole, number, count, rng)).mean()
    assert found.share == pytest.approx(share, abs=4 * math.sqrt(max(share * (1 - share), 1 / count) / count))
    assert found.share > 0.04, "too little is served to tell"
    assert deepest(found, geometry, whole, cutter, dense(whole, 1.0), 150, rng) < 0.1


@pytest.mark.slow("a part of many faces", only=("mould",))
@pytest.mark.parametrize("make", [*TRIMS.values(), MOULDS["mould"], MOULDS["rod with an oblique hole"]])
def test_what_tiles_have_of_a_trim(make):
    """Area, middle and box of what random tiles have of it, against random points; nothing of it is lost."""
    rng = np.random.default_rng(1)
    part = read_part(make())
    for face in part.faces:
        trim = part.trim(face.number)
        u0, u1, v0, v1 = trim.box
        u, v = np.sort([u0, u1, *rng.uniform(u0, u1, 7)]), np.sort([v0, v1, *rng.uniform(v0, v1, 5)])
        clip = clipped(trim, u, v, np.argwhere(np.ones((8, 6), bool)))
        p, q = trim.segments[:, 0], trim.segments[:, 1]
        assert clip.area.sum() == pytest.approx(abs(0.5 * (p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()))
        count = 20_000
        uv = rng.uniform((u0, v0), (u1, v1), (count, 2))
        uv = uv[inside(trim.segments, uv)]
        tile = 6 * (np.searchsorted(u, uv[:, 0]) - 1) + np.searchsorted(v, uv[:, 1]) - 1
        hits = np.bincount(tile, minlength=48)
        assert clip.area / ((u1 - u0) * (v1 - v0)) == pytest.approx(hits / count, abs=5 * 0.5 / math.sqrt(count))
        slack = 1e-9 * np.array([u1 - u0, v1 - v0])
        assert ((uv >= clip.low[tile] - slack) & (uv <= clip.high[tile] + slack)).all()
        full = np.outer(np.diff(u), np.diff(v)).ravel()
        assert clip.area[clip.whole] == pytest.approx(full[clip.whole])
        assert (clip.area[~clip.whole] < full[~clip.whole]).all()
        assert ((clip.middle >= clip.low) & (clip.middle <= clip.high))[clip.area > 0].all()


# --- words that promise too much -------------------------------------------------------------------------------------


def test_target_faces_that_cannot_be_sampled_are_not_served():
    bare = TopoDS_Face()
    BRep_Builder().MakeFace(bare)
    result = plan(compound(box(20, 20, 20), bare), cutters=[Cutter.flat(radius=3, length=40)], faces="all", grid=5)
    area = result.cutters[0].area
    assert area.share == 1
    assert not area.feasible
    assert area.left_out == ["F7"]
    notes = " ".join(result.plan.notes)
    assert "No verdict is about F7" in notes
    assert "The area of F7 is not known" in notes
    assert "R3L40 serves all of the target surface whose area is known" in notes


def test_a_face_without_samples_whose_area_is_known_counts():
    """As if the second of two equal faces had given no sample."""
    part = read_part(shapes.shell(shapes.plane((0, 30), (0, 30)), shapes.plane((40, 70), (0, 30))))
    result = plan(part, cutters=[Cutter.flat(radius=3, length=40)], faces="all", grid=5, area_budget=0)
    both = result.samples
    one = replace(both, **{
        name: getattr(both, name)[both.face == 1]
        for name in ("point", "normal", "direction_max", "curvature", "uv", "face", "area", "unjudged")
    }, grids=both.grids[:1], empty=((2, "no sample lies inside its border"),))  # fmt: skip
    cutter, reach = Cutter.flat(radius=3, length=40), result.reaches["R3L40"]
    conditions = Conditions(
        Machine.parse("unlimited"), UP, result.postures, Surroundings.sheet(Obstacles(tessellate(part, 0.002))), 0.01, 1
    )
    side, context = orient(part, towards=UP, flip=False), Context.of(cutter, conditions)
    assert between(both, reach, context, part, side, budget=0).feasible
    found = between(one, reach, context, part, side, budget=0)
    assert found.share == pytest.approx(0.5)
    assert not found.feasible


@pytest.mark.slow("another spacing of the same law", only=("40.0",))
@pytest.mark.parametrize("make", [*TRIMS.values(), MOULDS["mould"], MOULDS["ball, cap"]])
@pytest.mark.parametrize("spacing", [2.5, 40.0])
def test_the_largest_gap_reaches_the_border(make, spacing):
    part = read_part(make())
    for face in part.faces:
        samples = sample(part, orient(part), spacing=spacing, faces=[face.number])
        near, step = cKDTree(samples.point), 0.0
        pairs = samples.point[samples.neighbours]
        if len(pairs):
            step = float(np.linalg.norm(pairs[:, 0] - pairs[:, 1], axis=1).max())
        border = np.concatenate([edge_points(edge, 400) for edge in edges_of(part.face(face.number))])
        farthest = float(near.query(border)[0].max())
        # Inside, where the border cuts cells, points may be farther still (`test_near.py`).
        assert max(step, farthest) * 0.95 <= samples.max_gap <= spacing * (1 + 1e-9)


def test_one_sample_is_as_far_from_the_border_as_it_is():
    part = read_part(rod(5.0, 20.0))
    disc = next(face.number for face in part.faces if face.surface == "plane")
    height = part.face(disc)
    middle = np.array([[0.0, 0.0, edge_points(edges_of(height)[0], 2)[0, 2]]])
    probes = border_probes(part, disc, 0.0)
    assert probes.distance(middle).max() == pytest.approx(5.0)
    assert probes.distance(middle + np.array([2.0, 0, 0])).max() == pytest.approx(7.0, rel=1e-3)
    assert probes.distance(np.full((1, 3), np.nan)).max() == 0.0


def edge_points(edge, count):
    """Points of an edge's own curve in space, which the program does not read."""
    if BRep_Tool.Degenerated_s(edge):
        vertex = TopoDS.Vertex_s(TopExp_Explorer(edge, TopAbs_VERTEX).Current())
        return np.array([BRep_Tool.Pnt_s(vertex).Coord()])
    curve = BRepAdaptor_Curve(edge)
    return np.array([curve.Value(t).Coord() for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), count)])


# --- chord errors ----------------------------------------------------------------------------------------------------


def sloppy(gap):
    """A half disc whose arc ends so far beside the vertices that it joins."""
    builder, radius = BRep_Builder(), 10.0 + gap
    left, right, made = TopoDS_Vertex(), TopoDS_Vertex(), []
    for vertex, x in ((left, -10.0), (right, 10.0)):
        builder.MakeVertex(vertex, gp_Pnt(x, 0.0, 0.0), 1.5 * gap)
    arc = Geom_Circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), radius)
    line = Geom_Line(gp_Pnt(-10, 0, 0), gp_Dir(1, 0, 0))
    for curve, low, high, ends in ((line, 0.0, 20.0, (left, right)), (arc, 0.0, math.pi, (right, left))):
        edge = TopoDS_Edge()
        builder.MakeEdge(edge, curve, 1e-7)
        builder.Add(edge, ends[0].Oriented(TopAbs_FORWARD))
        builder.Add(edge, ends[1].Oriented(TopAbs_REVERSED))
        builder.Range(edge, low, high)
        made.append(edge)
    wire, face = TopoDS_Wire(), TopoDS_Face()
    builder.MakeWire(wire)
    for edge in made:
        builder.Add(wire, edge)
    builder.MakeFace(face, Geom_Plane(gp_Pln()), 1e-7)
    builder.Add(face, wire)
    return face


@pytest.mark.parametrize("gap", [0.001, 0.01, 0.1])
def test_borders_that_end_beside_their_vertices_are_followed(gap):
    part = read_part(sloppy(gap))
    triangles = tessellate(part, 0.002)
    assert not triangles.missing
    assert triangles.chord_error <= 0.002
    border = np.concatenate([edge_points(edge, 3001) for edge in edges_of(part.face(1))])
    assert farthest_from(border, triangles.vertex, triangles.chord_error + ROUNDING) <= triangles.chord_error + ROUNDING


@pytest.mark.slow("looks at thousands of points of each face")
@pytest.mark.parametrize("make", MOULDS.values(), ids=MOULDS.keys())
def test_every_point_of_cut_quadrics_has_a_triangle_within_the_promise(make):
    part = read_part(make())
    triangles = tessellate(part, 0.005)
    assert not triangles.missing
    for number, looked, off, uv in violations(part, triangles, 2000):
        assert looked > 500
        assert off <= triangles.chord_error + ROUNDING, (number, uv)


@pytest.mark.slow("looks at thousands of points of a large real part")
@pytest.mark.parametrize("path", real("asitus_repatch-hpdc-colored.stp"), ids=lambda p: p.name)
def test_every_point_of_a_repaired_casting_has_a_triangle_within_the_promise(path):
    part = read_part(path)
    triangles = tessellate(part, 0.002)
    for number, _, off, uv in violations(part, triangles, 2000):
        assert off <= triangles.chord_error + ROUNDING, (number, uv)


def test_folded_triangles_are_turned_over():
    uv, corner = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (2.0, 0.0)]), np.array([(0, 1, 2), (0, 2, 1), (0, 1, 3)])
    assert folded(uv[corner]).tolist() == [False, True, False]
    assert upright(uv, corner).tolist() == [[0, 1, 2], [0, 1, 2], [0, 1, 3]]


@pytest.mark.slow("draws many surfaces", only=("<lambda>1", "<lambda>2", "mould"))
@pytest.mark.parametrize("make", [*MOULDS.values(), lambda: shapes.torus(20, 5).Moved(TopLoc_Location(mirror()))])
def test_triangles_have_the_side_of_the_surface(make):
    part = read_part(make())
    triangles = tessellate(part, 0.02)
    a, b, c = (triangles.vertex[:, k] for k in range(3))
    across = np.cross(b - a, c - a)
    for face in part.faces:
        u0, u1, v0, v1 = part.trim(face.number).box
        u, v = (g.ravel() for g in np.meshgrid(np.linspace(u0, u1, 150), np.linspace(v0, v1, 150)))
        d = first_derivatives(part.adaptor(face.number), u, v)
        mine = np.flatnonzero(triangles.face == face.number)
        normal = np.cross(d[:, 1], d[:, 2])[cKDTree(d[:, 0]).query(triangles.vertex[mine].mean(axis=1))[1]]
        # Needles may stand on edge: that takes nothing from the sum.
        side = (across[mine] * normal).sum(axis=1) / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
        assert side[side < 0].sum() > -1e-3 * side.sum()
        assert 0.5 * side.sum() == pytest.approx(face.area, rel=0.02)
