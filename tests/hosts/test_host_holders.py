"""Holders from shapes of a script: never smaller than the shape, exact for cylinders and cones, refused where none turns."""

import math

import build123d as bd
import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io import ReadError
from plan_cutters import CutterError, Holder, OptionError, plan
from plan_cutters.domain.holder import enclosing_segments
from plan_cutters.hosts import holder

CHUCK = "R13:15L2+R15L28+R20L40"


def chuck():
    body = cq.Workplane().circle(15).extrude(30).faces(">Z").workplane().circle(20).extrude(40)
    return body.edges("<Z").chamfer(2)


def section(plane="XZ"):
    return cq.Workplane(plane).polyline([(0, 0), (13, 0), (15, 2), (15, 30), (20, 30), (20, 70), (0, 70)])


def sketch():
    with bd.BuildSketch(bd.Plane.XZ) as made:
        with bd.BuildLine():
            bd.Polyline((0, 0), (13, 0), (15, 2), (15, 30), (20, 30), (20, 70), (0, 70), (0, 0))
        bd.make_face()
    return made.sketch


@pytest.mark.parametrize(
    "how", ["solid", "kernel", "list", "bored", "wire", "face", "sketch", "lifted", "build123d", "upside down"]
)
def test_cylinders_and_cones_stay_as_they_are(how):
    made = {
        "solid": lambda: holder(chuck()),
        "kernel": lambda: holder(chuck().val().wrapped),
        "list": lambda: holder([cq.Workplane().circle(20).extrude(40).translate((0, 0, 30)),
                                cq.Workplane().circle(15).extrude(30).edges("<Z").chamfer(2)]),
        "bored": lambda: holder(chuck().faces("<Z").workplane().hole(16, 40)),
        "wire": lambda: holder(section().close()),
        "face": lambda: holder(cq.Face.makeFromWires(section().close().val())),
        "sketch": lambda: holder(sketch()),
        "lifted": lambda: holder(chuck().translate((5, -3, 100)), axis=((5, -3, 0), (0, 0, 2))),
        "build123d": lambda: holder(bd.Rot(90, 0, 0) * bd.Solid(chuck().val().wrapped), axis="-y"),
        "upside down": lambda: holder(chuck().rotate((0, 0, 0), (1, 0, 0), 180), axis="-z"),
    }[how]()  # fmt: skip
    assert len(made.stages) == 3
    for stage, wanted in zip(made.stages, Holder.parse(CHUCK).stages, strict=True):
        for word in ("radius", "length", "upper_radius"):
            assert getattr(stage, word) == pytest.approx(getattr(wanted, word), abs=1e-9)
    assert made.name == ""


def radius_at(made, height):
    """Radius of a holder's stages at a height over its nose; of two that meet, the larger one."""
    found, low = -math.inf, 0.0
    for stage in made.stages:
        if low - 1e-9 <= height <= low + stage.length + 1e-9:
            found = max(found, stage.radius + stage.slope * (height - low))
        low += stage.length
    return found


def assert_encloses(made, shape, slack, foot=None):
    """No point of the shape's surface lies outside, and at some height the stages are not much larger."""
    points = np.array([p.toTuple() for p in cq.Shape.cast(shape).tessellate(0.05, 0.1)[0]])
    points = np.vstack([points, [v.toTuple() for v in cq.Shape.cast(shape).Vertices()]])
    height = points[:, 2] - (points[:, 2].min() if foot is None else foot)
    out = np.hypot(points[:, 0], points[:, 1])
    room = np.array([radius_at(made, h) for h in height]) - out
    assert room.min() > -1e-7
    assert room.min() < slack
    assert sum(stage.length for stage in made.stages) >= height.max() - 1e-7


def filleted():
    return chuck().edges(">Z").fillet(4).val().wrapped


def ball():
    return cq.Workplane().sphere(20).val().wrapped


def waisted():
    """A concave throat, a torus, between two cylinders."""
    profile = (
        cq.Workplane("XZ").lineTo(20, 0).lineTo(20, 10).threePointArc((15, 15), (20, 20)).lineTo(20, 40).lineTo(0, 40).close()
    )
    return profile.revolve(360, (0, 0), (0, 1)).val().wrapped


def spun():
    """A surface that the kernel knows only as one of revolution."""
    profile = cq.Workplane("XZ").lineTo(10, 0).spline([(13, 10), (12, 20), (20, 30)], includeCurrent=True).lineTo(0, 30).close()
    return profile.revolve(360, (0, 0), (0, 1)).val().wrapped


@pytest.mark.slow("takes shapes of a CAD library", but=("0.5-spun-0.5",))
@pytest.mark.parametrize(("make", "slack"), [(filleted, 0.01), (ball, 0.1), (waisted, 0.02), (spun, 0.5)])
@pytest.mark.parametrize("tolerance", [0.02, 0.5])
def test_curved_outlines_are_enclosed(make, slack, tolerance):
    shape = make()
    made = holder(bd.Shape.cast(shape), tolerance=tolerance, name="drawn")
    assert len(made.stages) <= 12
    assert_encloses(made, shape, slack + tolerance)
    assert made.name.startswith("drawn")


def keyed():
    return cq.Workplane().circle(15).extrude(30).cut(cq.Workplane().box(4, 4, 200).translate((15, 0, 0))).val().wrapped


def hexagonal():
    return cq.Workplane().polygon(6, 30).extrude(10).union(cq.Workplane().circle(10).extrude(25)).val().wrapped


def tilted():
    return cq.Workplane().circle(5).extrude(20).rotate((0, 0, 0), (1, 0, 0), 10).val().wrapped


@pytest.mark.parametrize("make", [keyed, hexagonal, tilted])
def test_what_does_not_turn_is_refused_or_swept(make):
    shape = bd.Shape.cast(make())
    with pytest.raises(CutterError, match="no body of revolution about its axis"):
        holder(shape)
    made = holder(shape, enclose=True)
    assert "what it sweeps when it turns" in made.name
    assert_encloses(made, shape.wrapped, 0.2)


def upright(shape, degrees):
    return shape.rotate((0, 0, 0), (1, 0, 0), degrees)


@pytest.mark.slow("takes shapes of a CAD library", but=("0",))
@pytest.mark.parametrize("frame", [0, 90, 35])
def test_a_ball_that_is_cut_off_does_not_lift_the_nose(frame):
    """The sphere's own frame may lie across: its full height, of which less is there, says nothing of where the nose is."""
    half = cq.Workplane().box(60, 60, 40, centered=(True, True, False)).translate((0, 0, 5))
    collar = upright(cq.Workplane().sphere(15), frame).translate((0, 0, 10)).intersect(half)
    shape = cq.Workplane().circle(4).extrude(12).union(collar).val().wrapped
    made = holder(shape)
    assert_encloses(made, shape, 0.5, foot=0.0)
    assert radius_at(made, 2.0) < 5.0


@pytest.mark.parametrize("degrees", [5, 20])
def test_a_nose_that_is_sawn_off_askew_stands_where_it_is(degrees):
    """Bounds of parameters are loose around the curved border: the lowest point is in closed form."""
    cone = cq.Workplane().circle(8).workplane(offset=40).circle(14).loft()
    saw = cq.Workplane().box(60, 60, 40, centered=(True, True, False)).translate((0, 0, -40))
    shape = cone.cut(upright(saw, degrees).translate((0, 0, 14))).val().wrapped
    slope = math.tan(math.radians(degrees))
    assert_encloses(holder(shape, enclose=True), shape, 0.2, foot=(14 - 8 * slope) / (1 + 0.15 * slope))


def test_a_holder_off_its_axis_is_refused():
    off = bd.Pos(2, 0, 0) * bd.Cylinder(3, 4)
    with pytest.raises(CutterError, match="no body of revolution"):
        holder(off)
    assert holder(off, axis=((2, 0, 7), (0, 0, 1))).id == "R3L4"
    assert_encloses(holder(off, enclose=True), off.wrapped, 0.2)


def test_what_is_no_holder_has_a_line():
    with pytest.raises(ReadError, match="no plane through the axis"):
        holder(bd.Rectangle(3, 4))
    with pytest.raises(CutterError, match="spans no height"):
        holder(cq.Workplane("XZ").moveTo(5, 0).lineTo(8, 0).wire())
    with pytest.raises(ReadError, match="no area"):
        holder(cq.Workplane().circle(5))
    with pytest.raises(ReadError, match="draw its one half"):
        holder(bd.Plane.XZ * bd.Rectangle(10, 40))
    with pytest.raises(CutterError, match="gap between the heights 10 and 15"):
        holder([bd.Cylinder(3, 10, align=(bd.Align.CENTER, bd.Align.CENTER, bd.Align.MIN)),
                bd.Pos(0, 0, 20) * bd.Cylinder(3, 10)])  # fmt: skip
    with pytest.raises(CutterError, match="disk without thickness"):
        holder(cq.Workplane("XZ").moveTo(5, 0).lineTo(5, 10).lineTo(8, 10).wire())
    with pytest.raises(ReadError, match="not joined"):
        holder(cq.Workplane("XZ").moveTo(5, 0).lineTo(5, 10).lineTo(8, 10))
    for axis in ("w", "", 5, ((0, 0, 0), (0, 0, 0)), ((0, 0), (0, 0, 1)), (0, 0, 1),
                 ((0, 0, math.nan), (0, 0, 1))):  # fmt: skip
        with pytest.raises(OptionError, match="axis"):
            holder(chuck(), axis=axis)
    for tolerance in (0.0, -1, math.nan, "thick"):
        with pytest.raises(OptionError, match="tolerance"):
            holder(chuck(), tolerance=tolerance)
    with pytest.raises(ReadError):
        holder("R15L30")


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(st.floats(0.5, 40), st.floats(0.5, 40), st.floats(0.01, 20)), min_size=1, max_size=30),
    st.floats(0.01, 5), st.integers(2, 14), st.booleans(),
)  # fmt: skip
def test_stages_enclose_any_lines(sections, tolerance, most, exact):
    """Stacked sections, and lines within them: no stage is nearer to the axis anywhere."""
    line, low = [], 3.0
    for first, last, length in sections:
        line.append((first, low, last, low + length))
        line.append((0.5 * first, low + 0.3 * length, 0.5 * last, low + 0.6 * length))
        low += length
    rows = np.array(line)
    stages, kept = enclosing_segments(rows, np.full(len(rows), exact), 3.0, tolerance=tolerance, most=most)
    assert len(stages) <= most
    assert kept >= tolerance
    made = Holder(stages)
    for first, bottom, last, top in line:
        for share in (0.0, 0.21, 0.5, 0.83, 1.0):
            height = bottom + share * (top - bottom) - 3.0
            assert radius_at(made, height) >= first + share * (last - first) - 1e-6


def test_a_drawn_holder_is_judged_like_a_written_one():
    groove = cq.Workplane().box(40, 40, 20).faces(">Z").workplane().rect(40, 8).cutBlind(-10)
    asked = {"faces": cq.Workplane(groove.val()).faces(cq.selectors.NearestToPointSelector((0, 0, 0))), "cutters": "R3L8",
             "spacing": 4.0, "tolerance": 0.05, "area_budget": 0}  # fmt: skip
    drawn, written = (plan(groove, holder=each, **asked) for each in (holder(chuck()), CHUCK))
    assert drawn.plan.cutters[0].by_reason == written.plan.cutters[0].by_reason
    assert drawn.plan.cutters[0].by_reason["holder"] > 0
