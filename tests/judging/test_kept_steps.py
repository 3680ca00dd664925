"""What single steps of the stages say is kept in `kept`: of cells, nodes, fields of axes, limited work, made records."""

from dataclasses import replace

import numpy as np
import pytest

from cad_io.arrays import FaceGrid
from plan_cutters import Cutter, Machine, PostureRange
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import INACCESSIBLE, INTERFERENCE_FREE, REASONS, Witness, blank
from plan_cutters.errors import OptionError
from plan_cutters.judging import posture_maps as map_budget
from plan_cutters.judging import witness
from plan_cutters.judging.axes import AxisField, angle_between, held_within, margin, roomiest
from plan_cutters.judging.between import between
from plan_cutters.judging.cells import from_neighbours, laid, quartered, steepest, tensors
from plan_cutters.judging.face_cells import FaceCells, Fixed, _poor, best
from plan_cutters.judging.judge import judge
from plan_cutters.judging.limits import travels, within_limits
from plan_cutters.judging.phases import FLAT, access, classify, decompose, regions
from plan_cutters.judging.posture_maps import moved, posture_map_of, posture_maps
from plan_cutters.judging.reasons import may_be_at_edge
from plan_cutters.kernels.codes import NEVER
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.work import Work
from tests.support.kept_parts import ready

UP = (0.0, 0.0, 1.0)
FLAT_END, BALL = Cutter.parse("D3L20"), Cutter.parse("D3L20rc1.5")


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def under(machine="unlimited", like=None, **posture):
    """Conditions of a machine among the obstacles of a part that is ready, or of none."""
    around = (like or ready("bracket", cutters=("D3L20",), grid=4)).conditions.surroundings
    return Conditions(Machine.parse(machine), np.array(UP), PostureRange(**posture), around, 0.01, 1)


def test_classes_and_regions(keeps):
    made = ready("bracket", cutters=("D3L20",), grid=4).samples
    size = 37.0
    # Curvatures on both sides of what counts as none, and just there.
    limits = np.array([0.0, FLAT, 0.999 * FLAT, 1.001 * FLAT, 2.0 * FLAT, -FLAT, -0.999 * FLAT, -1.5 * FLAT, np.nan]) / size
    pairs = np.stack(np.meshgrid(limits, limits), axis=-1).reshape(-1, 2)
    bent = replace(made, curvature=np.resize(pairs, made.curvature.shape))
    found = classify(bent, size)
    keeps("classes", {"class": found[: len(pairs)], "region": regions(made, found), "of part": classify(made, size)})


@pytest.mark.parametrize(("closed_u", "closed_v"), [(False, False), (True, False), (False, True), (True, True)])
def test_nodes_of_a_grid(closed_u, closed_v, keeps):
    rng = np.random.default_rng(3 + 2 * closed_u + closed_v)
    index = np.full((5, 4), -1, np.int32)
    there = np.ones(index.shape, bool)
    there[1, 2] = there[4, 0] = there[0, 3] = there[0, 2] = False
    count = int(there.sum())
    index[there] = rng.permutation(count)
    u, v = np.linspace(0.0, 3.0, 5), np.linspace(0.0, 2.0, 4)
    grid = FaceGrid(1, u, v, index, closed_u, closed_v, (0.0, 3.75 if closed_u else 3.0, 0.0, 2.7 if closed_v else 2.0))
    normal = unit(rng.normal(size=(count, 3)))
    direction = unit(np.cross(normal, rng.normal(size=(count, 3))))
    tensor = tensors(normal, direction, rng.normal(size=(count, 2)))
    point = rng.normal(size=(count, 3))
    keeps(f"nodes_{closed_u:d}{closed_v:d}", {"near": from_neighbours(point, tensor, grid, index), "tensor": tensor,
                                             "steepest": steepest(tensor, rng.uniform(0, 1, count))})  # fmt: skip


def test_fields_of_axes(keeps):
    rng = np.random.default_rng(8)
    u, v = np.array([0.4, 1.5, 2.7, 3.4]), np.array([-0.3, 0.6, 1.7])
    axis = unit(0.3 * rng.normal(size=(4, 3, 3)) + [0.0, 0.0, 1.0])
    axis[3, 2] = np.nan
    uv = np.concatenate([rng.uniform(-0.5, 4.5, (40, 2)), [[1.5, 0.6], [3.4, 1.0], [2.7, 1.7], [4.15, 2.4]]])
    span = np.resize([[0.3, 0.2], [0.9, 0.1], [0.0, 0.0], [1.2, 1.1], [2.5, 0.3]], uv.shape)
    said = {}
    for name, closed in (("open", (False, False)), ("closed", (True, False)), ("torus", (True, True))):
        grid = FaceGrid(1, u, v, np.zeros((4, 3), np.int32), *closed, (0.4, 4.15, -0.3, 2.4))
        field = AxisField.of(grid, axis)
        said[name] = {"lines": [field.u, field.v], "at": field.at(uv), "within": field.within(uv, span)}
    lone = AxisField(u[:1], v[:1], axis[:1, :1])
    said["lone"] = [lone.at(uv[:4]), lone.within(uv[:4], span[:4])]
    # Axes 59.9, 60.3 and 179.8 deg apart: the last two have none between them.
    apart = np.radians([0.0, 59.9, 120.2, 300.0])
    far = np.stack([np.sin(apart), 0.0 * apart, np.cos(apart)], axis=1)[:, None]
    wide = AxisField(np.arange(4.0), np.zeros(1), far)
    said["wide"] = wide.at(np.column_stack([np.linspace(0, 3, 13), np.zeros(13)]))
    away, swing = unit(rng.normal(size=(60, 3)) * [1, 1, 0.6] + [0, 0, 0.7]), rng.uniform(0.0, 0.5, 60)
    away[3], swing[5] = np.nan, np.nan
    said["held"] = {name: held_within(away, swing, under(name)) for name in ("unlimited", "tilt:50", "trunnion-ac", "3-axis")}
    said["between"] = angle_between(axis.reshape(-1, 3)[:-1], axis.reshape(-1, 3)[1:])
    keeps("fields", said)


def test_room_to_the_gouging_bound(keeps):
    rng = np.random.default_rng(21)
    normal = unit(rng.normal(size=(30, 3)))
    direction = unit(np.cross(normal, rng.normal(size=(30, 3))))
    tensor = tensors(normal, direction, 0.15 * rng.normal(size=(30, 2)))
    axis = unit(normal + 0.8 * rng.normal(size=(30, 3)))
    axis[0], axis[7] = normal[0], -normal[7]
    said = {}
    for name, tool, conditions in (("flat", FLAT_END, under()), ("bull", Cutter.parse("D4L20rc0.6"), under("tilt:40")),
                                   ("ball", BALL, under(tilt=(np.radians(20.0), np.radians(50.0))))):  # fmt: skip
        context = Context.of(tool, conditions)
        room = margin(axis, normal, tensor, context)
        said[name] = [room, np.isneginf(room), *roomiest(normal, direction, tensor, axis, context)]
    keeps("room", said)


#: Faces of all kinds, closed and cut, with samples and without.
LAID = {"drum": {"cutters": ("D3L40",), "grid": 7}, "holed": {"cutters": ("D4L50rc1",), "grid": 9, "machine": "tilt:30"},
        "bracket": {"cutters": ("D3L20",), "grid": 4}}  # fmt: skip


@pytest.mark.parametrize("name", LAID)
def test_cells_as_they_are_laid_and_cut(name, keeps):
    made = ready(name, **LAID[name])
    part, side, conditions = made.scene.part, made.scene.orientation, made.conditions
    reach = judge(made, made.cutters[0])
    said = {}
    for grid in made.samples.grids:
        field, mine, bare = laid(part, side, made.samples, grid, reach, conditions)
        both = type(mine).joined(mine, bare)
        quarters = quartered(both, field, 0, conditions)
        finer = quartered(quarters.of(np.arange(0, len(quarters), 5)), field, 1, conditions)
        known = {each: getattr(field, each) for each in ("index", "closed", "point", "tensor", "variation", "radius", "about")}
        said[f"F{grid.face}"] = {"field": known, "mine": mine, "bare": bare, "quarters": quarters, "finer": finer}
    keeps(f"cells_{name}", {face: said[face] for face in [*said][:4]} | {"areas": [
        [float(each["quarters"].area.sum()), float(np.nansum(each["finer"].patch)), len(each["bare"])] for each in said.values()
    ]})  # fmt: skip


def test_cells_beside_the_first_sample_of_all():
    """Cells without a sample begin with the posture of one beside them, the first one of a part as well as any other."""
    made = ready("drum", cutters=("D3L20",), grid=4, faces="F3")
    (grid,) = made.samples.grids
    free = replace(judge(made, made.cutters[0]), verdict=np.full(len(made.samples), INTERFERENCE_FREE, np.uint8))
    _, _, bare = laid(made.scene.part, made.scene.orientation, made.samples, grid, free, made.conditions)
    assert 0 in bare.sample
    assert (bare.flat == (bare.sample >= 0)).all()


def of_face(made, k, work=None, **more):
    """A face's cells, and the contacts to begin with."""
    cutter = made.cutters[0]
    context = Context.of(cutter, made.conditions)
    field, mine, bare = laid(made.scene.part, made.scene.orientation, made.samples, made.samples.grids[k], judge(made, cutter),
                             made.conditions)  # fmt: skip
    return FaceCells(field, context, work or Work(), **more), type(mine).joined(mine, bare)


def state(cells, *values):
    """What is known of a face's cells."""
    return {
        "served": cells.served, "left": cells.left, "counts": [cells.unseen, cells.short, cells.dropped, cells.seen, cells.spent],
        "levels": cells.levels, "found": [len(each) for each in cells.found], "work": cells.work.looked, "values": values,
        "pools": [[len(each), status, cells.worth(level)] for level, (each, status) in enumerate(cells.pools)],
        "worthy": [cells.worthy(each) for each in (0.0, 1e-3, 0.05, 1.0)],
    }  # fmt: skip


def test_cells_with_limits_of_work_and_budget(keeps):
    made = ready("patch", cutters=("D4L40",), grid=19)
    said, whole = {}, 1706.0
    for name, upto, budget, least in (
        ("all", np.inf, 260, 1e-4),
        ("short", 90_000.0, 900, 1e-4),
        ("none", 9_000.0, 900, 1e-4),
        ("poor", np.inf, 9000, 0.4),
        ("tiny", np.inf, 3, 1e-4),
        ("four", np.inf, 4, 0.0),
    ):
        told = []
        cells, contacts = of_face(made, 0, reported=lambda told=told: told.append(1))
        begun = cells.begin(contacts, upto)
        before = state(cells, begun)
        said[name] = [before, state(cells, cells.refine(budget, least * whole / 1706.0, upto), len(told))]
    # Cells that are cut often, with other postures on the way.
    for name, how in (("holed", {"cutters": ("D6L50rc1.1",), "grid": 9}), ("patch", {"cutters": ("D4L40rc1",), "grid": 9})):
        fine, begin = of_face(ready(name, **how), 0)
        fine.begin(begin, np.inf)
        said[f"fine {name}"] = [state(fine, fine.refine(1500, 1e-6)), [each.axis for each, _ in fine.pools]]
    said["begun twice"] = state(cells, cells.begin(contacts.of(np.arange(5)), cells.work.looked + 1e6))
    worth = np.array([0.3, 0.1, 0.3, 0.7, 0.0, 0.7, 0.2])
    said["best"] = [best(worth, most) for most in (-1, 0, 1, 2, 3, 5, 9)]
    rounds = [(3000, 2.0), (999, 1.0), (1, 0.2), (2000, 0.5), (2001, 0.1)]
    said["poor rounds"] = [[_poor(rounds[:k], least) for least in (1e-4, 2e-4, 5e-4, 0.4 / 4001 * 1.5, 1.0)] for k in range(6)]
    keeps("limits", said)


def test_cells_with_other_outlooks(keeps):
    """What an open cell is worth by how often it must be cut."""
    cells, contacts = of_face(ready("patch", cutters=("D4L40",), grid=19), 0)
    status = np.array([0, 1, 2, 3, 5, 6, 7, 9, NEVER], np.uint8)
    some = contacts.of(np.arange(len(status)))
    cells.pools = [(some, status), (some, status[::-1].copy())]
    keeps("outlooks", [cells.worth(level) for level in range(8)] + [cells.worthy(each) for each in (0.0, 0.01, 0.1)])


@pytest.mark.parametrize("name", ["drum", "bracket"])
def test_cells_with_axes_that_stay(name, keeps):
    made = ready(name, **LAID[name])
    cutter, samples, part, side = made.cutters[0], made.samples, made.scene.part, made.scene.orientation
    context, reach = Context.of(cutter, made.conditions), judge(made, cutter)
    axes = unit(np.array([[0.0, 0.0, 1.0], [0.4, 0.1, 0.9], [-0.3, -0.6, 0.7]]))
    serves = samples.normal @ axes.T > 0.2
    said = {"fixed": between(samples, reach, context, part, side, budget=40, axes=Fixed(axes, serves))}
    fields = {}
    for grid in samples.grids[:5]:
        normal = samples.normal[np.maximum(grid.index, 0)]
        fields[grid.face] = AxisField.of(
            grid, np.where((grid.index >= 0)[..., None], unit(normal + np.array([0.1, 0.2, 0.4])), np.nan)
        )
    said["turning"] = between(samples, reach, context, part, side, budget=60, axes=fields)
    own = np.arange(len(samples) + 1) % 3 > 0
    covered = samples.point[:, 2] > 5.0
    said["some"] = between(samples, reach, context, part, side, budget=25, own=own, covered_samples=covered)
    told, counted = [], Work()
    said["limited"] = between(samples, reach, context, part, side, budget=300, most=60_000.0, work=counted,
                              progress=lambda *each: told.append(each))  # fmt: skip
    keeps(f"between_{name}", {**said, "told": told[-3:], "work": counted.looked})


def test_dummies_and_searches_of_some_samples(keeps):
    made = ready("bodies", cutters=("D3L18",), grid=4)
    samples, said = made.samples, {}
    rows = np.arange(0, len(samples), 2)
    context, counted = Context.of(made.cutters[0], made.conditions), Work()
    said["free"] = decompose(samples, np.ones(len(samples), bool), context, rows=rows, work=counted)
    said["within"] = free = decompose(samples, samples.normal[:, 2] > -0.5, context, inside=made.inside)
    said["some"] = access(samples, free, context, inside=made.inside, rows=rows, work=counted)
    known = blank(len(samples))
    known.take(rows, said["some"])
    known.verdict[3:200:4] = INACCESSIBLE
    said["known"] = access(samples, free, context, inside=made.inside, known=known.freeze())
    # Of faces that triangles follow within ten tolerances, or hardly.
    around = made.conditions.surroundings
    triangles = replace(around.certain.triangles, loose=((2, 0.1), (3, 0.1000001), (5, 9.0)))
    loose = replace(around, certain=replace(around.certain, triangles=triangles))
    doubtful = Context.of(context.cutter, replace(made.conditions, surroundings=loose))
    said["loose"] = access(samples, free, doubtful, inside=made.inside)
    buried = np.where(samples.face == 5, np.arange(len(samples)) % 2 - 1, made.inside).astype(np.int32)
    said["some loose"] = [access(samples, free, doubtful, inside=each, rows=rows) for each in (made.inside, buried)]
    coarse = replace(Context.of(context.cutter, replace(made.conditions, tolerance=0.5)))
    said["coarse"] = [coarse.judges, access(samples, free, coarse, rows=rows)]
    said["rows"] = judge(made, made.cutters[0], rows=rows[5:90])
    said["edge"] = [may_be_at_edge(said["some"], each) for each in (FLAT_END, BALL, Cutter.parse("D3L20"))]
    walled = ready("bodies", cutters=("D3L18",), grid=4, fixtures=("box:20,20,9@-3,-4,-9",))
    said["fixture"] = access(samples, free, Context.of(walled.cutters[0], walled.conditions))
    keeps("some_samples", {**said, "work": counted.looked})


def test_how_many_samples_are_mapped(keeps, monkeypatch):
    rows = np.arange(7, 400, 3)
    spread = [map_budget.evenly(rows, most) for most in (0, 1, 2, 5, 17, 130, 131, 132)]
    spread.append(map_budget.evenly(rows[:0], 3))
    monkeypatch.setattr(map_budget, "WORK", 5000)
    monkeypatch.setattr(map_budget, "PROBED", 20)
    looked = [map_budget.chosen(rows, most, lambda piece: 31 * len(piece), 1) for most in (None, 3, 400)]
    few = map_budget.chosen(rows[:20], None, lambda piece: 10**9, 1), map_budget.chosen(rows[:21], None, lambda piece: 10**9, 1)
    keeps("map_budget", [spread, looked, few])


MAPS = {
    "flat": ("bracket", FLAT_END, under), "ball": ("deep", Cutter.parse("D4L21F7N3.4x8S7HR8.6L20"), lambda: under("tilt:60")),
    "bull": ("bodies", Cutter.parse("D4L26rc0.7"), lambda: under("3-axis")),
    # What may be in the way is more than what surely is.
    "open": ("bodies", Cutter.parse("D3L9"), under, {"ignore": "F2"}),
}  # fmt: skip


@pytest.mark.parametrize("name", MAPS)
def test_maps_of_single_contacts(name, keeps):
    of, cutter, asked, *more = MAPS[name]
    made = ready(of, cutters=(cutter,), grid=4, **(more[0] if more else {}))
    conditions = replace(asked(), surroundings=made.conditions.surroundings)
    samples, said = made.samples, []
    rotations = np.radians([0.0, 77.0, 200.0])
    for row in (0, 9, len(samples) // 2, len(samples) - 7):
        arrays = ("point", "normal", "direction_max", "curvature", "uv", "face", "area", "unjudged")
        one = replace(samples, grids=(), neighbours=samples.neighbours[:0],
                      **{each: getattr(samples, each)[row : row + 1] for each in arrays})  # fmt: skip
        made_map = posture_map_of(one, rotations, Context.of(cutter, conditions), 1e-3)
        nominal = posture_map_of(one, rotations, Context.of(cutter, replace(conditions, tolerance=0.0)), 2e-3)
        said.append(
            [made_map, made_map.lies_flat, made_map.lies_along, made_map.axis(1, 0.3), moved(made_map, nominal), nominal.free]
        )
    with pytest.raises(OptionError):
        made_map.axis(1)
    keeps(f"map_{name}", [*said, made_map.axis(2, tilt_deg=31.0)])


def test_maps_within_a_body(keeps):
    """Of a block that lies in another one, as if nothing were known of that: no cutter that touches no skin is free."""
    made = ready("sunk", cutters=("D1L3",), grid=3)
    context, reach = Context.of(made.cutters[0], made.conditions), judge(made, made.cutters[0])
    within = made.inside >= 0
    found = posture_maps(made.samples, context, reach, shut=~within)
    thin = Context.of(Cutter.parse("D1L30"), made.conditions)
    keeps("sunk", [found, posture_maps(made.samples, thin, reach, shut=~within, most=7)])


def test_limits_that_no_cutter_touches_within(keeps):
    made, tools = ready("bracket", cutters=("D3L20",), grid=4), [FLAT_END, BALL, Cutter.parse("D4L20T5")]
    said = []
    for machine in ("unlimited", "tilt:35", "4-axis-a"):
        for tilt in ((0.0, 0.5), (0.7, 1.2), (1.58, 1.7)):
            conditions = under(machine, tilt=tilt)
            said += [within_limits(made.samples, [each], conditions, axis, rows) for each in tools for axis, rows in
                     ((None, None), ((1.0, 0.0, 0.0), np.arange(0, 200, 3)))]  # fmt: skip
    keeps("within_limits", said)


def test_witnesses_of_made_groups(keeps):
    rng = np.random.default_rng(5)
    point = rng.normal(size=(90, 3))
    groups = [witness._Group(1 + k % 4, REASONS.index(word), body, np.arange(k, 90, 7), area)
              for k, (word, body, area) in enumerate([("collision", -1, 4.0), ("rear_gouge", -1, 9.0), ("buried", -1, 99.0),
                                                      ("collision", 2, 50.0), ("holder", -1, 3.0), ("shank", -1, 8.0),
                                                      ("tolerance", -1, 7.0)])]  # fmt: skip
    looked = [Witness(k, "collision", obstacle_face=face, depth=depth) for k, (face, depth) in
              enumerate([(1, 0.3), (2, 0.9), (2, None), (1, 0.9), (3, 0.2), (2, 0.1)])]  # fmt: skip
    far = [witness.far_apart(point, np.arange(first, 90, 4), most) for first, most in ((0, 1), (1, 4), (2, 30))]
    keeps("witnesses", {"measured": witness._measured(groups), "searched": [each.searched for each in groups], "far": far,
                        "selected": [witness._selected(looked[:k], point) for k in (1, 2, 3, 6)]})  # fmt: skip


def test_where_linear_axes_stand(keeps):
    from plan_cutters.domain.machine import Axis

    axes = [Axis("C", "rotary", "part", (0, 0, 1)), Axis("X", "linear", "tool", (1, 0, 0), limits=(-9.0, 9.0)),
            Axis("Y", "linear", "tool", (0, 1, 0)), Axis("Z", "linear", "tool", (0, 0, 1), limits=(0.0, 40.0)),
            Axis("A", "rotary", "tool", (1, 0, 0), limits=(-1.2, 1.2))]  # fmt: skip
    machine = Machine("mine", axes=axes)
    made = ready("bodies", cutters=("D3L18",), grid=4, machine=machine, setup=Placement(UP, origin=(1.0, 2.0, -3.5)))
    reach = {each: judge(made, each) for each in made.cutters}
    nowhere = replace(made.options, placement=None)
    keeps("travels", [travels(made.options, made.samples, reach), travels(nowhere, made.samples, reach)])
