"""Laws of verdicts against one another: moved, made larger, among more or less in the way, in another order."""

import math
import random
from dataclasses import replace

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plan_cutters import Cutter, Holder, Scene, Segment, plan, posture_map
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE
from tests.soak.cases import Mill, Part, Setting, VoidError, fixtures, parts, refused, settings
from tests.soak.exact import told
from tests.soak.register import law
from tests.soak.solids import angles_of, moved


def _contradict(one, other):
    """Samples that one says to be reached, and the other one proves not to be."""
    return np.flatnonzero(one.reached & (other.verdict == INACCESSIBLE))


def _same(one, other, setting):
    for a, b, way in ((one, other, "before"), (other, one, "after")):
        (first,), (second,) = a.reaches.values(), b.reaches.values()
        rows = _contradict(first, second)
        assert not len(rows), told(a.samples, int(rows[0]), f"{len(rows)} samples are reached {way} alone")


@law(
    st.tuples(
        settings(), st.tuples(*[st.integers(-180, 180).map(float)] * 3), st.tuples(*[st.integers(-300, 300).map(float)] * 3)
    )
)
def a_rigid_motion_changes_nothing(case: tuple[Setting, tuple, tuple]):
    """Part, setup and fixtures, moved together: no sample is reached here and proved not to be there."""
    setting, turn, shift = case
    matrix = Rotation.from_euler("xyz", turn, degrees=True).as_matrix()
    here = setting.planned()

    def carried(body):
        return replace(body, turn=angles_of(matrix @ body.matrix), at=tuple((matrix @ body.at + shift).tolist()))

    there = setting.but(fixtures=tuple(carried(each) for each in setting.fixtures))
    place = Placement(tuple(matrix @ setting.setup), tuple(matrix @ setting.frame[0]))
    after = refused(lambda: plan(moved(setting.part.shape, matrix, shift), **{
        **there.options, "setup": place}))  # fmt: skip
    _comparable(here, after, setting.step, matrix, shift)
    _same(here, after, setting)


def _comparable(one, other, step, matrix=None, shift=(0, 0, 0), scale=1.0):
    """Whether samples are the same points, with the same rotations."""
    matrix = np.eye(3) if matrix is None else matrix
    if one.samples.point.shape != other.samples.point.shape:
        raise VoidError("other samples")
    if np.abs(scale * one.samples.point @ matrix.T + shift - other.samples.point).max() > 1e-5 * scale:
        raise VoidError("samples at other places")
    turn = ((one.samples.direction_max @ matrix.T) * other.samples.direction_max).sum(axis=1)
    if 180 % step == 0:
        turn = np.abs(turn)
    if not (np.nan_to_num(turn, nan=1.0) > 1 - 1e-9).all():
        raise VoidError("rotations count from another direction")


@law(st.tuples(settings(), st.sampled_from([0.1, 0.5, 3.0, 25.4])))
def scaling_changes_nothing(case: tuple[Setting, float]):
    """All lengths made larger by one factor: no sample is reached here and proved not to be there."""
    setting, scale = case
    here, cutter = setting.planned(), setting.tool.cutter
    words = [replace(each, sizes=tuple(scale * x for x in each.sizes), at=tuple(scale * x for x in each.at))
             for each in setting.fixtures]  # fmt: skip
    there = setting.but(fixtures=tuple(words), tolerance=scale * setting.tolerance)
    after = refused(lambda: plan(moved(setting.part.shape, scale=scale), **{
        **there.options, "cutters": [scaled(cutter, scale)]}))  # fmt: skip
    _comparable(here, after, setting.step, scale=scale)
    _same(here, after, setting)


def scaled(cutter: Cutter, scale):
    """A cutter all of whose lengths are so many times as large."""

    def one(stage):
        return replace(stage, radius=scale * stage.radius, length=scale * stage.length, upper_radius=scale * stage.upper_radius)

    holder = None if cutter.holder is None else replace(cutter.holder, stages=tuple(one(each) for each in cutter.holder.stages))
    lengths = {word: scale * value for word in ("radius", "length", "corner_radius", "flutes", "shank_radius", "arc_radius",
                                                "arc_height", "allowance", "clearance")
               if (value := getattr(cutter, word)) is not None}  # fmt: skip
    outline = tuple((scale * q, scale * h) for q, h in cutter.outline)
    return replace(cutter, **lengths, neck=tuple(one(each) for each in cutter.necks) or None, holder=holder, outline=outline)


@st.composite
def _more_in_the_way(draw):
    setting = draw(settings())
    cutter = setting.tool.cutter
    ways = ["clearance"] if setting.part.sheet else ["clearance", "fixture", "table", "vise", "chuck"]
    # Stock left on the surface lifts what stands above the flutes.
    ways += [] if cutter.stages else ["allowance"]
    ways += [] if cutter.holder is None else ["wider", "shorter"]
    return (
        setting,
        draw(st.sampled_from(ways)),
        draw(st.floats(0.1, 0.9).map(lambda x: round(x, 2))),
        draw(fixtures(setting.part)),
    )


@law(_more_in_the_way())
def more_in_the_way_never_gives_more(case: tuple[Setting, str, float, tuple]):
    """Another fixture, a vise, a chuck, a larger holder, stock or clearance: what was proved to be lost stays lost."""
    setting, way, share, around = case
    more = {}
    cutter, harder, tool = setting.tool.cutter, setting, setting.tool.cutter
    if way == "fixture":
        harder = setting.but(fixtures=(*setting.fixtures, *around))
    elif way == "table":
        harder = setting.but(table=True)
    elif way in ("vise", "chuck"):
        # Where it may stand is the program's choice: what it holds by, and whether it fits, is refused in words.
        more = {"fixtures": [*setting.words, way]}
    elif way in ("allowance", "clearance"):
        tool = replace(cutter, **{way: (getattr(cutter, way) or 0.0) + share})
    elif way == "shorter":
        # Under one cylinder, that goes up as far as before: then the tool holds all of what it was.
        low = max([cutter.flutes or 0.0, *(at for part, at, _ in cutter.stages if part != "holder")])
        wide, by = max(max(each.radius, each.upper_radius) for each in cutter.holder.stages), (1 - share) * (cutter.length - low)
        cutter = replace(cutter, holder=Holder((Segment(wide, 30.0),)))
        tool = refused(lambda: replace(cutter, length=cutter.length - by, holder=Holder((Segment(wide, 30.0 + by),))))
    else:
        wider = [replace(each, radius=each.radius + 5 * share, upper_radius=each.upper_radius + 5 * share)
                 for each in cutter.holder.stages]  # fmt: skip
        tool = replace(cutter, holder=replace(cutter.holder, stages=tuple(wider)))
    before = setting.planned(cutters=[cutter])
    after = refused(lambda: plan(setting.part.shape, **{**harder.options, "cutters": [tool], **more}))
    _comparable(before, after, setting.step)
    (a,), (b,) = before.reaches.values(), after.reaches.values()
    rows = _contradict(b, a)
    assert not len(rows), told(before.samples, int(rows[0]), f"{way}: {len(rows)} samples are reached then alone")
    rows = np.flatnonzero(b.interference_free & ~a.reached)
    assert not len(rows), told(before.samples, int(rows[0]), f"{way}: {len(rows)} are interference-free then alone")


@law(st.tuples(settings(mill=st.just(Mill())), st.integers(0, 60), st.integers(0, 60)))
def narrower_limits_never_give_more(case: tuple[Setting, int, int]):
    """Fewer tilts or a limit of the tool axis: what was proved to be lost at the rotations that were searched stays lost."""
    setting, first, second = case
    low, high = 0.0, math.degrees(setting.planned().postures.tilt[1])
    narrow = setting.but(tilt=(low + 0.5 * first, max(low + 0.5 * first, high - second)), mill=Mill(tilt=float(second + 20)))
    before, after = setting.planned(), narrow.planned()
    (a,), (b,) = before.reaches.values(), after.reaches.values()
    rows = _contradict(b, a)
    # What a flat or a flank reaches with axes of its own was not searched before.
    turn = np.degrees(_rotations(before.samples, b)[rows]) / setting.step
    rows = rows[np.abs(turn - np.rint(turn)) < 1e-6]
    assert not len(rows), told(before.samples, int(rows[0]), f"{len(rows)} samples are reached within limits alone")


def _rotations(samples, reach):
    """The rotations (n,), rad, of tilt directions."""
    e1, f = samples.direction_max, reach.tilt_direction
    return np.arctan2((np.cross(samples.normal, e1) * f).sum(axis=1), (e1 * f).sum(axis=1))


@law(st.tuples(settings(), st.sampled_from([1.5, 3.0, 8.0])))
def a_larger_tolerance_never_gives_less(case: tuple[Setting, float]):
    """What is safe to a tolerance is not proved to be blocked to a larger one."""
    setting, times = case
    fine, coarse = setting.planned(), setting.but(tolerance=times * setting.tolerance).planned()
    _comparable(fine, coarse, setting.step)
    (a,), (b,) = fine.reaches.values(), coarse.reaches.values()
    rows = _contradict(a, b)
    assert not len(rows), told(fine.samples, int(rows[0]), f"{len(rows)} samples are reached with the finer one alone")


@law(st.tuples(settings(part=parts(one_way=True)), st.integers(0, 99)))
def the_order_of_features_changes_nothing(case: tuple[Setting, int]):
    """Pockets cut in another order, and so other numbers of faces and other seams: no posture found in one part is proved to be
    blocked in the other.
    """
    setting, number = case
    head, *rest = setting.part.steps
    random.Random(number).shuffle(rest)
    other = setting.but(part=Part((head, *rest), setting.part.sheet))
    before = setting.planned()
    _among(setting, before, other.scene())


@law(st.tuples(settings(), st.sampled_from(["x", "y", "z"])))
def a_mirror_image_has_the_same_postures(case: tuple[Setting, str]):
    """Part and fixtures seen in a mirror: no posture found here has an image there that is proved to be blocked."""
    setting, way = case
    setting = setting.but(fixtures=(), table=False)
    flip = np.diag([-1.0 if each == way else 1.0 for each in "xyz"])
    before = setting.planned()
    shape, up = _mirrored(setting.part.shape, way), tuple(flip @ Placement(setting.setup).z)
    scene = refused(lambda: Scene.of(shape, setup=up, tolerance=setting.tolerance))
    _among(setting, before, scene, flip)


def _mirrored(shape, way):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf

    made = gp_Trsf()
    made.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(*(1.0 if each == way else 0.0 for each in "xyz"))))
    return BRepBuilderAPI_Transform(shape, made, True).Shape()


def _among(setting, before, scene, image=None):
    """Postures of a plan, looked up in maps of the same points of another scene, or of their image."""
    image = np.eye(3) if image is None else image
    samples, (reach,), rng = before.samples, before.reaches.values(), np.random.default_rng(0)
    rows = np.flatnonzero((reach.verdict == ACCESSIBLE) & (np.linalg.norm(reach.shift, axis=1) == 0) & (reach.tilt > 1e-4))
    cutter = setting.tool.cutter
    for row in rng.permutation(rows)[:8].tolist():
        point, normal, f = (image @ each[row] for each in (samples.point, samples.normal, reach.tilt_direction))

        def mapped(turn, point=point):
            return refused(lambda: posture_map(scene, point=tuple(point), cutter=cutter, rotations=[turn]))

        frame = mapped(0.0)
        if np.abs(frame.normal - normal).max() > 1e-6:
            continue  # on an edge, or on the other side of a sheet
        e1 = frame.direction_max
        found = mapped(math.atan2(np.cross(normal, e1) @ f, e1 @ f))
        tilt = float(reach.tilt[row])
        spans = np.concatenate([found.free[0], found.undecided[0]])
        open_ = (spans[:, 0] <= tilt + 1e-6) & (spans[:, 1] >= tilt - 1e-6)
        assert open_.any(), told(samples, row, f"its tilt {tilt} rad towards {f.tolist()} is forbidden there")
