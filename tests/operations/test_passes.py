"""What passes take: the centre's path, how far faces go on, and walls above what holds the part."""

import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from plan_cutters import Cutter, plan
from plan_cutters.domain.machine import Machine
from plan_cutters.kernels.linear.sections import sections
from plan_cutters.kernels.linear.strips import centre_paths
from plan_cutters.kernels.rows import Contacts
from plan_cutters.machines import read_machine, to_toml
from plan_cutters.operations.passes import Paths
from tests.support.cad_parts import box
from tests.support.places import DATA

FEED = 1000.0
OPTIONS = {"area_budget": 0, "feed": FEED, "machine": "tilt:0", "setup": "+z", "operations": "fastest"}


def planned(shape, cutter, **more):
    return plan(shape, cutters=cutter, **{**OPTIONS, **more}).plan.operations.plans[0]


def moved(cutter, high, low, tilt, turn, along, turning):
    """How far the centre runs for each mm of the contact, by steps on the surface 2 z = high x^2 + low y^2."""
    offset, radius = cutter.radius - cutter.corner_radius, cutter.corner_radius
    t = np.array([math.cos(along), math.sin(along), 0.0])
    axis = np.array([math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt)])

    def centre(s):
        x, y = s * t[:2]
        normal = np.array([-high * x, -low * y, 1.0])
        normal /= np.linalg.norm(normal)
        own = axis
        if turning:
            # Without a spin about the normal, to first order.
            own = axis + np.cross(np.cross([0.0, 0.0, 1.0], normal), axis)
            own /= np.linalg.norm(own)
        across = normal - (normal @ own) * own
        place = np.array([x, y, 0.5 * (high * x * x + low * y * y)]) + radius * normal + offset * across / np.linalg.norm(across)
        return place - (radius * own if turning and offset else 0.0)

    step = 1e-5
    return np.linalg.norm(centre(step) - centre(-step)) / (2.0 * step)


@given(
    st.sampled_from(["R6L80rc6", "R6L80", "R6L80rc1.5"]), st.floats(-0.1, 0.1), st.floats(0.0, 0.1), st.floats(0.15, 1.3),
    st.floats(0.0, 6.2), st.floats(0.0, 3.1), st.booleans(),
)  # fmt: skip
@settings(deadline=None, max_examples=60)
def test_the_centre_runs_as_far_as_steps_on_the_surface_say(word, high, less, tilt, turn, along, turning):
    cutter, low = Cutter.parse(word), high - less
    axis = np.array([[math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt)]])
    feed = np.array([[math.cos(along), math.sin(along), 0.0]])
    normal, largest = np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]])
    touching, found = (np.array([cutter.radius - cutter.corner_radius]), np.array([cutter.corner_radius])), np.empty(1)
    centre_paths(axis, feed, Contacts(normal, normal, largest, np.array([[high, low]])), *touching, turning, found)
    (found,) = found
    assert found == pytest.approx(moved(cutter, high, low, tilt, turn, along, turning), rel=1e-5, abs=1e-7)


def convex(seed):
    """A convex polygon about the origin, and triangles (t, 3, 3) of it in the plane z = 0, with points inside."""
    rng = np.random.default_rng(seed)
    outline = shapely.convex_hull(shapely.MultiPoint(rng.normal(size=(12, 2)) * (8.0, 3.0)))
    inside = [p for p in rng.normal(size=(40, 2)) * (8.0, 3.0) if outline.contains(shapely.Point(p))]
    points = np.vstack([np.array(outline.exterior.coords)[:-1], *inside])
    corner = points[Delaunay(points).simplices]
    return outline, np.ascontiguousarray(np.dstack([corner, np.zeros(corner.shape[:2])]))


def lengths(point, along, normal, vertex, own=None):
    """What goes on from a point in its face, that with what the face goes on onto, and all of the face."""
    wide = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    unit = wide / np.linalg.norm(wide, axis=1, keepdims=True)
    found = np.empty((3, 1))
    place = np.array([point]), np.array([along]), np.array([normal])
    sections(*place, vertex, unit, len(vertex) if own is None else own, math.cos(math.radians(30.0)), 1e-6, 1e-6, *found)
    return found[:, 0]


@given(st.integers(0, 10_000), st.floats(0.0, 3.14))
@settings(deadline=None, max_examples=60)
def test_a_face_goes_as_far_as_its_outline_lets_it(seed, turn):
    outline, vertex = convex(seed)
    x, y = outline.centroid.coords[0]
    way = np.array([math.cos(turn), math.sin(turn), 0.0])
    line = shapely.LineString([(x - 100 * way[0], y - 100 * way[1]), (x + 100 * way[0], y + 100 * way[1])])
    exact = outline.intersection(line).length
    assert lengths((x, y, 0.0), way, (0.0, 0.0, 1.0), vertex) == pytest.approx((exact, exact, exact), rel=1e-6)


@given(st.integers(0, 10_000), st.floats(0.0, 3.14), st.floats(-2.0, 2.0))
@settings(deadline=None, max_examples=60)
def test_a_pass_goes_on_over_a_smooth_border(seed, turn, cut):
    """Triangles of a convex outline are divided among two faces: what goes on through both is the whole, whatever the border."""
    outline, vertex = convex(seed)
    first = vertex[:, :, 0].min(axis=1) < cut
    x, y = (vertex[first] if first.any() else vertex)[0].mean(axis=0)[:2]
    way = np.array([math.cos(turn), math.sin(turn), 0.0])
    line = shapely.LineString([(x - 100 * way[0], y - 100 * way[1]), (x + 100 * way[0], y + 100 * way[1])])
    own = int(first.sum()) or len(vertex)
    connected, beyond, whole = lengths((x, y, 0.0), way, (0.0, 0.0, 1.0), np.concatenate([vertex[first], vertex[~first]]), own)
    assert beyond == pytest.approx(outline.intersection(line).length, rel=1e-6)
    assert connected <= whole + 1e-9 <= beyond + 2e-9


@pytest.mark.parametrize(("lean", "goes_on"), [(29.0, True), (31.0, False)])
def test_a_pass_ends_where_the_surface_turns_away(lean, goes_on):
    up, out = 3.0 * math.sin(math.radians(lean)), 4.0 + 3.0 * math.cos(math.radians(lean))
    own = [[[0.0, 0, 0], [4, 0, 0], [4, 1, 0]], [[0, 0, 0], [4, 1, 0], [0, 1, 0]]]
    bent = [[[4.0, 0, 0], [out, 0, up], [out, 1, up]], [[4, 0, 0], [out, 1, up], [4, 1, 0]]]
    found = lengths((1.0, 0.4, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), np.array(own + bent, float), 2)
    assert found == pytest.approx((4.0, 7.0 if goes_on else 4.0, 4.0))


def test_a_window_ends_what_goes_on_and_is_no_part_of_the_whole():
    """A strip of 10 x 1 mm in two pieces of 4 mm, bent up at a right angle in the second: along the face it stays as long."""
    first = [[[0.0, 0, 0], [4, 0, 0], [4, 1, 0]], [[0, 0, 0], [4, 1, 0], [0, 1, 0]]]
    second = [[[6.0, 0, 0], [8, 0, 0], [8, 1, 0]], [[6, 0, 0], [8, 1, 0], [6, 1, 0]],
              [[8, 0, 0], [8, 0, 2], [8, 1, 2]], [[8, 0, 0], [8, 1, 2], [8, 1, 0]]]  # fmt: skip
    vertex = np.array(first + second, float)
    found = lengths((1.0, 0.4, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), vertex)
    assert found == pytest.approx((4.0, 4.0, 8.0))
    assert np.isnan(lengths((1.0, 0.4, 0.5), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), vertex)[0])


def on(shape, wanted):
    """The words that choose the faces of a shape for which something holds."""
    return ",".join(str(k) for k, face in enumerate(cq.Shape.Faces(shape), 1) if wanted(face))


def top(height):
    return lambda face: face.geomType() == "PLANE" and face.BoundingBox().zmin > height - 1e-6


@settings(deadline=None, max_examples=4)
@given(st.floats(0.5, 3.0), st.floats(30.0, 100.0))
def test_a_rib_takes_a_pass_as_long_as_it_is(width, length):
    """Tops of ribs: one pass each, however wide the tool is; a rib more takes its length over the feed more."""

    def ribs(many):
        made = cq.Workplane().box(100, 100, 5, centered=(True, True, False))
        for k in range(many):
            rib = cq.Workplane().box(length, width, 10, centered=(True, True, False)).translate((0, 8.0 * k - 36.0, 0))
            made = made.union(rib)
        return made.val()

    two, three = (planned(ribs(n), "D12L60F26", faces=on(ribs(n), top(10.0))) for n in (2, 3))
    assert two.cut_length_mm == pytest.approx(2.0 * length, rel=0.02)
    assert three.cutting_seconds - two.cutting_seconds == pytest.approx(length * 60.0 / FEED, rel=0.02)
    assert two.link_seconds == pytest.approx(2 * 2.0, rel=0.1), "one to each piece, and one for the pass of each"


@pytest.mark.parametrize(("radius", "hole"), [(2.0, False), (6.5, True), (20.0, True)])
def test_the_centre_goes_round_a_pin_and_round_a_hole(radius, hole):
    """The path round a pin of radius r is that of r + R, in a hole that of r - R."""
    round_ = cq.Workplane().circle(radius).extrude(12.0)
    shape = (cq.Workplane().box(60, 60, 12, centered=(True, True, False)).cut(round_) if hole else round_).val()
    faces = on(shape, lambda face: face.geomType() == "CYLINDER")
    found = planned(shape, "D12L60F26S11", faces=faces, drill_below=0)
    assert found.operations[0].strategy == "wall"
    assert found.cut_length_mm == pytest.approx(2.0 * math.pi * (radius + (-6.0 if hole else 6.0)), rel=0.01)


def test_a_window_in_a_wall_is_no_wall():
    """A plate of 80 x 20 mm that stands upright, with a window in it: one pass along it, as without the window."""
    solid = box(80.0, 10.0, 20.0)
    opening = cq.Workplane().box(40, 30, 8, centered=False).translate((20, -10, 6))
    window = cq.Workplane(obj=cq.Shape.cast(solid)).cut(opening).val()
    length = [
        planned(shape, "D12L60F26", faces=on(shape, lambda f: f.geomType() == "PLANE" and f.BoundingBox().ymax < 1e-6))
        for shape in (cq.Shape.cast(solid), window)
    ]
    assert length[0].cut_length_mm == pytest.approx(80.0, rel=0.01)
    assert length[1].cut_length_mm == pytest.approx(80.0, rel=0.05)


@pytest.mark.parametrize("jaw", [8.0, 15.0])
def test_a_wall_above_a_jaw_is_cut_along_the_flutes_from_where_the_tool_comes_free(jaw):
    """A jaw as a box beside the wall: one strip from its top to that of the wall, which the whole tool stands free of."""
    shape = box(60.0, 40.0, 30.0)
    side = on(cq.Shape.cast(shape), lambda f: f.BoundingBox().ymax < 1e-6)
    options = {**OPTIONS, "faces": side, "fixtures": f"box:60,30,{jaw:g}@0,-30,0", "grid": 33}
    result = plan(shape, cutters="D12L60F26", **options)
    found, samples = result.answers.operations.plans[0], result.samples
    cut = found.label >= 0
    assert (found.strategy[cut] == 2).all()
    assert samples.point[cut, 2].min() >= jaw
    spacing = 30.0 / 32
    assert samples.point[cut, 2].min() <= jaw + 2.0 * spacing, "from the first samples above the jaw on"
    assert found.strip[cut] == pytest.approx(30.0 - jaw, abs=1.0)
    assert result.plan.operations.plans[0].cut_length_mm == pytest.approx(60.0, rel=0.1)
    assert (found.contact[cut, 2] >= jaw - 0.01).all(), "within the tolerance"


@settings(deadline=None, max_examples=4)
@given(st.floats(0.5, 2.0))
def test_paths_of_a_part_grow_with_it(size):
    """Lengths of a part and of its cutter times s: paths times s, as many links."""

    def of(s):
        shape = cq.Workplane().box(60 * s, 40 * s, 10 * s).faces(">Z").workplane().rect(30 * s, 20 * s).cutBlind(-4 * s)
        shape = shape.edges("|Z").fillet(7.0 * s).val()
        cutter = Cutter(6.0 * s, 60.0 * s, 0.0)
        return planned(shape, cutter, faces="!1", grid=9, scallop=0.01 * s, overlap=2.0 * s, tolerance=0.01 * s)

    one, other = of(1.0), of(size)
    assert other.cut_length_mm == pytest.approx(size * one.cut_length_mm, rel=0.02)
    assert other.link_seconds == pytest.approx(one.link_seconds, rel=0.05)


def test_a_pass_takes_the_feed_over_the_acceleration_of_the_slowest_axis_beside_its_link(tmp_path):
    """The file of a real machine: 800 mm/s2 along X, Y and Z, read from LinuxCNC and, once written, from our own format."""
    machine = read_machine(DATA / "machines" / "linuxcnc_5axis.ini")
    (tmp_path / "own.toml").write_text(to_toml(machine), encoding="utf-8")
    assert machine.acceleration == read_machine(tmp_path / "own.toml").acceleration == 800.0
    assert Machine().acceleration == math.inf
    cutter = Cutter.parse("D12L60F26")
    paths = Paths(0.01, 0.75, {cutter: 6000.0}, 0.0, None, 1.5, machine.acceleration)
    assert paths.link_of(cutter) == pytest.approx(1.5 + 100.0 / 800.0)
    assert replace(paths, feed=None).link_of(cutter) == 0.0


@settings(deadline=None, max_examples=6)
@given(st.floats(4.0, 36.0), st.booleans())
def test_a_face_that_is_cut_in_two_takes_no_less(cut, ball):
    """The top of a block, whole and in two faces: under a ball passes go on over the border, on a floor they end there."""
    whole = cq.Workplane().box(40, 20, 5, centered=False)
    halves = cq.Workplane().box(cut, 20, 5, centered=False)
    halves = halves.union(cq.Workplane().box(40 - cut, 20, 5, centered=False).translate((cut, 0, 0)), clean=False)
    cutter = "D10L50rc5F20" if ball else "D6L60F26"
    one, two = (planned(each.val(), cutter, faces=on(each.val(), top(5.0))) for each in (whole, halves))
    assert two.cut_length_mm >= (1.0 - 0.01) * one.cut_length_mm
    assert two.link_seconds >= (1.0 - 0.01) * one.link_seconds
    if ball:
        assert two.cut_length_mm == pytest.approx(one.cut_length_mm, rel=0.02)
        assert two.link_seconds == pytest.approx(one.link_seconds, rel=0.05)


@pytest.mark.parametrize("seed", range(3))
def test_no_sample_takes_a_longer_path_than_its_face_goes_on(seed):
    """Faces with slivers at their borders: a sample's area stands for no more than a pass along all of its face."""
    rng = np.random.default_rng(seed)
    corner = [(0, 0), (30, 0), *((30 - 5 * k, 8 + float(rng.uniform(-6, 6))) for k in range(6)), (0, 1e-3)]
    shape = cq.Workplane().polyline(corner).close().extrude(5.0).val()
    result = plan(shape, cutters="D12L60F26", **{**OPTIONS, "faces": on(shape, top(5.0)), "grid": 21})
    made = result.answers.operations.plans[0]
    longest = np.linalg.norm(np.ptp(result.samples.point, axis=0))
    assert np.nanmax(made.length) <= longest
