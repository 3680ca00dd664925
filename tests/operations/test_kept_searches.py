"""What searches find in problems that are made up, function by function, as it is kept in `kept`: no tool is put down.

Beside what comes out stands what all functions of the room return on the way (`traced`).
"""

import math
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

from cad_io.arrays import FaceGrid, Triangles
from plan_cutters import Machine, PostureRange, operations
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import columns_of
from plan_cutters.operations import canonical, fastest, fewest, moving_axes, passes, symmetry
from plan_cutters.operations import fewest as cover
from plan_cutters.operations import proof as moving_proof
from plan_cutters.operations import task as timing
from plan_cutters.operations.choices import largest_first, with_and_without
from plan_cutters.operations.fastest import Costs, Problem, Reach, Turning, cheap, exchanged, lagrange
from plan_cutters.operations.labels import joined, labelled, pieces, regions_of
from plan_cutters.operations.orientations import (
    Indexing,
    Orientations,
    _multiples,
    apart,
    candidates,
    directions,
    index_times,
    neighbours,
)
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups import solids
from tests.support.located import located
from tests.support.strips import strips_at
from tests.support.tool_kinds import TOOLS
from tests.support.traced import traced

#: Of candidates none of which saves anything it returns any.
UNSURE = "problem.Problem.added"
AROUND = Surroundings.sheet(Obstacles(Triangles(solids.box(np.zeros(3), np.ones(3)), np.ones(12, np.int32), 0.0, ())))


@pytest.fixture
def on_the_way(keeps):
    """Keep what a function finds in each of some problems, and what is found on the way."""

    def kept(name, function, problems):
        told = {}
        for key, problem in problems:
            with traced(operations) as seen:
                result = function(*problem)
            told[str(key)] = {
                "result": result,
                "seen": {each: sums.told() for each, sums in seen.items() if sums.calls and each != UNSURE},
            }
        keeps(name, told)

    return kept


def units(rng, count):
    way = rng.normal(size=(count, 3))
    return way / np.linalg.norm(way, axis=1)[:, None]


def problem_of(seed, n, m, kinds, costs, turning=None):
    """Costs of samples with candidates that serve those near to them, so that each serves some of its neighbours as well."""
    rng = np.random.default_rng(seed)
    near = units(rng, n) @ units(rng, m).T
    cost = np.where(near > 0.2, rng.uniform(0.5, 3.0, (n, m)) * (2.0 - near), np.inf)
    cost = cost[np.isfinite(cost).any(axis=1)]
    if turning:
        place = rng.uniform(0.1, turning, m)
        turning = Turning(lambda chosen: float(place[chosen].max() + 0.1 * place[chosen].sum()), place)
    cutter, setup = rng.integers(0, kinds[0], m).astype(np.int32), rng.integers(0, kinds[1], m).astype(np.int32)
    return Problem(cost, cutter, setup, Costs(*costs), turning or None)


def searched(problem, *, sure):
    """Choices, what they cost, and bounds where rounding shows in none of their steps."""
    chosen, dear = cheap(problem), cheap(problem, np.arange(0, problem.cost.shape[1], 2))
    order = np.unique(problem.cutter).tolist()[::-1]
    choices = [chosen, dear, exchanged(problem, chosen), largest_first(problem, order), *with_and_without(problem, chosen)]
    return {"choices": choices, "bounds": [located(problem, each) for each in choices[:3]] if sure else [],
            "totals": [[problem.total(each), problem.turned(each), problem.cutting(each)] for each in choices]}  # fmt: skip


def test_choices_of_least_time(on_the_way):
    sizes = [
        (61, 17, (3, 2), (1.3, 2.7, 4.1), None), (90, 31, (2, 1), (7.9, 0.7, 0.0), None), (45, 23, (3, 3), (0.3, 5.1, 2.3), None),
        (70, 19, (2, 2), (2.9, 6.1, 3.7), 3.1), (52, 27, (1, 1), (4.3, 0.0, 0.0), 9.7), (33, 40, (6, 4), (1.1, 3.3, 2.2), None),
        (38, 12, (2, 2), (0.0, 0.0, 0.0), 0.9), (5, 4, (2, 1), (30.3, 40.1, 50.7), None), (5, 5, (2, 2), (3.0, 4.0, 5.0), None),
        (25, 9, (3, 2), (1.3, 2.7, 4.1), None),
    ]  # fmt: skip
    on_the_way("choices", partial(searched, sure=False), [(k, [problem_of(k, *each)]) for k, each in enumerate(sizes)])
    sure = (1, 3, 4, 6, 9)
    on_the_way("bounds", partial(searched, sure=True), [(k, [problem_of(k, *sizes[k])]) for k in sure])


def test_steps_of_prices(keeps):
    """The first steps alone: each follows from all before it."""
    found = {}
    for seed, reach in ((1, 0.0), (2, 0.0), (3, 4.3), (4, 2.1)):
        problem = problem_of(seed, 40, 14, (2, 3), (2.3, 2.7, 4.1), reach)
        group = np.sort(problem.cutter)
        least = reach * np.concatenate([np.linspace(0.1, 0.9, (group == g).sum()) for g in np.unique(group)])
        chosen = cheap(problem)
        price = problem.cost.min(axis=1) + 0.1
        ascent = fastest._Ascent(np.ascontiguousarray(problem.cost.T), 2.3 - 0.5 * reach, 0.7 * seed, price, least, group)
        steps = []
        for _ in range(11):
            ascent.step(problem.total(chosen))
            steps.append(
                [ascent.bound, ascent.work, ascent.over, ascent.price.sum(), ascent._length, ascent._waited, len(ascent._cost)]
            )
        found[str(seed)] = steps
    keeps("steps", found)


def test_bounds_by_prices(on_the_way):
    def priced(seed):
        rng, problem = np.random.default_rng(seed), problem_of(seed, 30, 12, (2, 2), (1.7, 2.0, 3.0), 2.3)
        group = np.sort(rng.integers(0, 3, 12))
        least = np.concatenate([np.sort(rng.uniform(0.0, 4.0, (group == g).sum())) for g in range(3)])
        price = rng.normal(2.0, 1.5, len(problem.cost))
        return [lagrange(problem.cost.T, cost, price, reach) for cost in (0.0, 1.7) for reach in (None, Reach.of(least, group))]

    on_the_way("prices", priced, [(seed, [seed]) for seed in range(4)])


def caps(seed, n, m, reach):
    rng = np.random.default_rng(seed)
    return units(rng, n) @ units(rng, m).T > np.cos(reach)


def ends_of_edges(seed, n, m):
    """Edges of a graph, each with its two ends: parts of columns cover them for much less than whole ones."""
    pairs = np.array([np.random.default_rng((seed, k)).choice(m, 2, replace=False) for k in range(n)])
    return (pairs[:, :, None] == np.arange(m)).any(axis=1)


def test_covers(on_the_way):
    def covered(seed, n, m, reach):
        table = caps(seed, n, m, reach) if reach else ends_of_edges(seed, n, m)
        table = table[table.any(axis=1)]
        relaxed = cover.relax(table)
        quick, whole = cover.fewest(table, prove=False), cover.fewest(table)
        known = cover.fewest(table, np.arange(table.shape[1]), relaxed=relaxed, prove=False)
        rng = np.random.default_rng(seed)
        given = cover.whole_weights(table, 3.0 * rng.random(len(table)))
        # of covers of the same size and of weights of the same sum solvers take any
        counts = [[len(each.chosen), each.at_least, each.closed, each.bound, each.relaxed] for each in (quick, whole, known)]
        return counts, [relaxed.value, relaxed.bound, len(relaxed.rows)], given

    on_the_way(
        "covers",
        covered,
        [
            (k, (k, *each))
            for k, each in enumerate(
                [(60, 20, 0.7), (150, 31, 0.6), (40, 50, 0.45), (9, 5, 1.1), (60, 15, 0), (40, 19, 0), (0, 4, 0.7)]
            )
        ],
    )


def machine_of(name, rates=None, limits=None):
    machine = Machine.parse(name)
    axes = machine.axes
    if rates:
        axes = tuple(replace(axis, rate=math.radians(rate)) for axis, rate in zip(axes, rates, strict=True))
    if limits:
        axes = tuple(axis if each is None else replace(axis, limits=tuple(np.radians(each).tolist()))
                     for axis, each in zip(axes, limits, strict=True))  # fmt: skip
    return replace(machine, axes=axes)


def orientations(machine, setup=(0.0, 0.0, 1.0)):
    setup = np.array(setup) / np.linalg.norm(setup)
    return Orientations.of(Conditions(machine, setup, PostureRange(), AROUND, 0.01, 1))


MACHINES = {
    "none": (machine_of("unlimited"), (0.0, 0.0, 1.0)),
    "tilt": (machine_of("tilt:41"), (0.0, -1.0, 0.0)),
    "trunnion": (machine_of("trunnion-ac", (31.0, 17.0)), (0.0, 0.0, 1.0)),
    "trunnion that ends": (machine_of("trunnion-ac", (31.0, 17.0), [(-400.0, 250.0), (-20.0, 95.0)]), (0.0, 0.0, 1.0)),
    "trunnion that turns little": (machine_of("trunnion-ac", (31.0, 17.0), [(-97.0, 131.0), (-110.0, 95.0)]), (0.0, 0.0, 1.0)),
    "head and table": (machine_of("head-table-bc", (29.0, 23.0)), (0.2, 0.1, 0.9)),
    "head": (machine_of("head-head-ca", (19.0, 37.0)), (0.0, 0.0, 1.0)),
}


class Caps:
    """Probes of samples that a cutter serves with an axis that is near to a direction of theirs."""

    def __init__(self, seed, count):
        rng = np.random.default_rng(seed)
        self.way, self.made = units(rng, count), 0
        self.way[:, 2] = np.abs(self.way[:, 2])
        self.wide = np.cos(rng.uniform(0.35, 0.9, count))
        self.samples = SimpleNamespace(point=3.0 * self.way)

    def table(self, rows, columns, progress=None):
        self.made += len(rows) * len(columns)
        return self.way[rows] @ columns.axis.T > self.wide[rows, None] + 0.03 * columns.cutter

    def one(self, rows, columns, which):
        return self.table(rows, columns.of(np.array([which])))[:, 0]


def covering(seed, count, name, step):
    """The fewest of columns that are laid finer and finer: what is counted, and what is proved."""
    where, probes = orientations(*MACHINES[name]), Caps(seed, count)
    angle, axis = where.grid(step)
    first = columns_of(axis, angle).and_(columns_of(axis[::3], angle[::3], 1))

    def stored(bare):
        shown, own = where.near(probes.way[bare[::2]])
        return columns_of(own, shown, 1)

    search = fewest.Search(probes, first, np.arange(3, count), stored)
    steps = []
    found = fewest.search_fewest(search, (where,), math.radians(step), math.radians(0.2 * step), lambda *done: steps.append(done))
    search.surround(search.columns.of(found.cover.chosen[:2]), math.radians(0.7 * step), (where,))
    active, table = search.whole
    search.require(np.arange(0, count, 7))
    served = table.sum(axis=0)
    cover = found.cover
    return steps, len(cover.chosen), cover.at_least, cover.bound, cover.relaxed, found.spacing, found.alone, found.samples, [
        len(first), len(search.columns), len(active), len(search.rows), probes.made, int(served.sum())]  # fmt: skip


class Ends(Caps):
    """Probes of edges of a graph: a column, known by its first angle, serves those that have this end."""

    def __init__(self, seed, count, ends):
        super().__init__(seed, count)
        self.ends = ends_of_edges(seed, count, ends)

    def table(self, rows, columns, progress=None):
        self.made += len(rows) * len(columns)
        return self.ends[np.ix_(rows, np.rint(columns.angle[:, 0]).astype(int))]


def covering_ends(seed, count, ends, waiting):
    """The fewest of columns some of which wait: weights prove less than there are, and branch and bound the rest."""
    probes, number = Ends(seed, count, ends), np.arange(ends, dtype=float)
    every = columns_of(np.zeros((ends, 3)), np.column_stack([number, 0.0 * number]))
    bare = columns_of(np.zeros((0, 3)), np.zeros((0, 2)))
    rows = np.flatnonzero(probes.ends[:, : ends - waiting].any(axis=1))
    search = fewest.Search(probes, every.of(np.arange(ends - waiting)), rows, lambda _: bare)
    soon = search.solve(prove=False)
    search._add_columns(every.of(np.arange(ends - waiting, ends)))
    found, patched = search.solve(soon.chosen), search._patched()
    return (
        [[len(each.chosen), each.at_least, each.bound, each.relaxed] for each in (soon, found, patched)],
        probes.made,
        len(search.rows),
    )


def test_the_fewest(keeps):
    cases = [(1, 140, "trunnion", 21.0), (2, 90, "none", 31.0), (3, 700, "head", 25.0)]
    of_ends = [(1, 60, 15, 4), (2, 40, 19, 0), (3, 420, 30, 7), (4, 25, 9, 3)]
    keeps("search", {str(case): covering(*case) for case in cases} | {str(case): covering_ends(*case) for case in of_ends})


def test_orientations_of_machines(on_the_way):
    def turned(name):
        where, rng = orientations(*MACHINES[name]), np.random.default_rng(3)
        angle, axis = where.grid(13.0)
        some = rng.uniform(-1.0, 1.0, (9, 2)) * (400.0, 120.0)
        near = where.near(np.concatenate([units(rng, 9), np.eye(3), -np.eye(3), where.kinematics.direction]))
        first = where.kinematics.direction[0]
        return [where.names, angle, axis, where.set_to(some), near, where.others(axis[::9], angle[::9]),
                where.others(near[1], near[0]), [where.along(each) for each in (np.eye(3)[2], -np.eye(3)[2], first, axis[5])],
                where.turned(angle[::7], first, 2.1), where.turned(angle[::7], -first, 4.4),
                where.turned(angle[::7], axis[5], 0.7), where.grid(90.0), where.grid(360.0 / 7.0)]  # fmt: skip

    on_the_way("orientations", turned, [(name, [name]) for name in MACHINES])


def test_times_of_rotary_axes(on_the_way):
    def timed(name, given):
        where, rng = orientations(*MACHINES[name]), np.random.default_rng(11)
        angle, axis = where.near(units(rng, 40))
        columns = columns_of(axis[:9], angle[:9]).and_(columns_of(axis[9:], angle[9:], 1))
        own = Indexing((where,), given)
        few = columns.of(np.arange(min(7, len(columns))))
        return [own.rate, own.constant, own.source, own.together(columns), own.from_zero(columns), own.together(few),
                [own.times(0, [[each] for each in angle[:count]]) for count in (0, 1, 4, 13)]]  # fmt: skip

    on_the_way("indexing", timed, [(name, (name, None)) for name in MACHINES] + [("given", ("trunnion", 3.3))])


def test_orders_of_positions(keeps):
    whole, rate = 2.0 * math.pi, np.array([1.3, 0.7])
    limits = {"first goes round": [[-math.inf, math.inf], [-2.0, 2.0]],
              "both have limits": [[-1.5 * whole, 1.2 * whole], [-2.0, 2.0]],
              "second goes round": [[-3.0, 3.0], [-math.inf, math.inf]], "zero is out": [[0.5, 5.0], [-2.0, -0.3]],
              "a turn meets its limit": [[0.0, whole], [-whole, whole]]}  # fmt: skip
    found = {}
    for name, limit in limits.items():
        rng = np.random.default_rng(7)
        low, high = np.where(np.isfinite(limit), limit, [-3.0, 3.0]).T
        every = [rng.uniform(low, high, (1 + (k == 1), 2)) for k in range(14)]
        found[name] = [index_times(every[:count], np.array(limit), rate) for count in (1, 2, 5, 7, 13, 14)]
    found["at the limits"] = [index_times([np.array([[a, b]])], np.array(limits["a turn meets its limit"]), rate)
                              for a in (0.0, math.pi, whole) for b in (-whole, 0.0, 1.0, whole)]  # fmt: skip
    keeps("orders", found)


def grid_of(nx, ny):
    number = np.arange(nx * ny).reshape(nx, ny)
    return np.concatenate(
        [np.stack([number[1:].ravel(), number[:-1].ravel()], 1), np.stack([number[:, 1:].ravel(), number[:, :-1].ravel()], 1)]
    )


def test_labels(on_the_way):
    def divided(seed, nx, ny, k, weight, least):
        rng = np.random.default_rng(seed)
        cost = np.where(rng.random((nx * ny, k)) < 0.7, rng.random((nx * ny, k)), np.inf)
        cost[rng.random(nx * ny) < 0.05] = np.inf
        edge, area = grid_of(nx, ny), rng.uniform(0.5, 1.5, nx * ny)
        label = labelled(cost, edge, weight * rng.random(len(edge)))
        after = joined(label, np.isfinite(cost), edge, area, least)
        return label, pieces(label, edge), after, regions_of(after, edge, area)

    sizes = [(9, 8, 3, 0.3, 2.7), (12, 11, 5, 0.6, 4.1), (5, 5, 2, 1.7, 1.0), (15, 9, 7, 0.15, 3.3), (4, 3, 1, 1.0, 2.0)]
    on_the_way("labels", divided, [(k, (k, *each)) for k, each in enumerate(sizes)])


KINDS = {
    **TOOLS, "flat": Cutter.parse("D9L55rc0F17"), "flared": Cutter.parse("D4L40rc0.9T4F9"), "sharp": Cutter.parse("D12L60rc1F26"),
}  # fmt: skip


def contacts(cutter, count=160):
    """Normals, curvatures that the cutter may meet, directions, and axes that lean by all that is possible, and not at all."""
    rng = np.random.default_rng(13)
    normal = units(rng, count)
    along = np.cross(normal, units(rng, count))
    along /= np.linalg.norm(along, axis=1)[:, None]
    bend = np.sort(rng.uniform(-1.0, 0.9, (count, 2)), axis=1)[:, ::-1] / cutter.radius
    bend[::5] = 0.0
    bend[1::5, 0] = rng.choice([1e-9, 1e-5, 0.5e-4, 2e-4], len(bend[1::5]))
    bend[2::5] *= 0.02
    tilt = rng.choice([0.0, 1e-10, 0.003, 0.2, 0.6, 1.1, 0.5 * math.pi, 1.7, 2.6], count)
    other = np.cross(normal, along)
    turn = rng.uniform(0.0, 2.0 * math.pi, count)
    side = np.cos(turn)[:, None] * along + np.sin(turn)[:, None] * other
    return normal, along, bend, np.cos(tilt)[:, None] * normal + np.sin(tilt)[:, None] * side


def test_strips(keeps):
    found = {}
    for name, cutter in KINDS.items():
        normal, along, bend, axis = contacts(cutter)
        for scallop, stepover in ((0.013, 0.75), (0.7 * cutter.radius, 3.0), (2.1 * cutter.radius, 0.41)):
            own = strips_at(cutter, normal, along, bend, axis, scallop, stepover)
            by_place = [own.width, own.free_width, np.abs((own.feed * axis).sum(axis=1))]
            found[f"{name} {scallop:.3f}"] = by_place
        samples = SimpleNamespace(normal=normal, curvature=bend, direction_max=along)
        for accuracy, scallop in ((math.radians(0.1), 0.013), (0.31, 1.9)):
            # Faces whose extents are not known.
            endless = SimpleNamespace(measured=lambda rows: np.full((3, len(rows), passes.DIRECTIONS), np.nan))
            paths = passes.Paths(scallop, 0.61, {cutter: 870.0}, accuracy, endless)
            cut = passes.cut_by_tip(cutter, samples, np.arange(len(normal)), axis, paths)
            found[f"{name} tip {scallop}"] = [*cut, passes.flat_of(cutter), passes.flank_of(cutter)]
    keeps("strips", found)


def kinked(seed):
    """Samples of a disk with ribs that are turned onto each other, numbers in rows; the last rib is off by some."""
    rng = np.random.default_rng(seed)
    rib = np.column_stack([rng.uniform(6.0, 20.0, 25), rng.uniform(-1.0, 1.0, 25), rng.uniform(0.0, 8.0, 25)])
    across = np.column_stack([rng.uniform(-0.2, 0.2, 25), np.ones(25), rng.uniform(-0.3, 0.3, 25)])
    across /= np.linalg.norm(across, axis=1)[:, None]
    turns = 2.0 * math.pi * np.arange(5) / 5
    frames = np.array([[[math.cos(t), -math.sin(t), 0.0], [math.sin(t), math.cos(t), 0.0], [0.0, 0.0, 1.0]] for t in turns])
    around, high = rng.uniform(0.0, 2.0 * math.pi, 70), rng.uniform(-3.0, 0.0, 70)
    out = np.column_stack([np.cos(around), np.sin(around), np.zeros(70)])
    point = np.concatenate([21.0 * out + high[:, None] * [0.0, 0.0, 1.0], *(rib @ frame.T for frame in frames)])
    normal = np.concatenate([out, *(across @ frame.T for frame in frames)])
    point[-1] += 0.3
    place = np.array([3.1, -4.3, 2.7])
    face = np.repeat(np.arange(1, 7), [70, *[25] * 5]).astype(np.int32)
    area = rng.uniform(0.5, 1.5, len(face))
    return SimpleNamespace(point=point + place, normal=normal, face=face, area=area, max_gap=1.9, unjudged=np.full(len(face), -1))


def test_symmetries(on_the_way):
    def repeated(seed, name, gap, machinable):
        samples = kinked(seed)
        samples.max_gap = gap
        own = symmetry.symmetry_of(samples, (), (orientations(*MACHINES[name]),), np.arange(len(samples.face)) >= machinable)
        if own is None:
            return None
        angle, axis = own.orientations[0].near(units(np.random.default_rng(seed), 12))
        angle, axis = np.concatenate([angle, [[0.0, 0.0]]]), np.concatenate([axis, [[0.0, 0.0, 1.0]]])
        images = own.images(columns_of(axis, angle))
        return own.order, own.exact, own.place, own.direction, images, own.sector(samples.point - own.place)

    cases = [
        (1, "trunnion", 1.9, 0),
        (2, "trunnion", 0.4, 3),
        (3, "trunnion that ends", 1.1, 0),
        (4, "head", 1.9, 0),
        (1, "trunnion", 9.0, 0),
    ]
    on_the_way("symmetries", repeated, [(case, case) for case in cases])


def test_axes_of_normals(keeps):
    rng, found = np.random.default_rng(6), {}
    turn, along = rng.uniform(0.0, 5.0, 40), rng.uniform(-1.0, 1.0, 40)
    out = np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])
    up = np.array([0.0, 0.0, 1.0])
    for name, radius, slope in (("cylinder", 2.0, 0.0), ("cone", 2.0 + 0.5 * along, 0.5), ("waist", 2.0 + along**2, 2.0 * along)):
        normal = out - (slope * np.ones(40))[:, None] * up
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        point = 3.7 * ((radius * np.ones(40))[:, None] * out + along[:, None] * up) + [5.1, -7.3, 2.2]
        found[name] = symmetry._axis_of_normals(point, normal)
        for off in (1e-4, 3e-3):
            found[f"{name} {off}"] = symmetry._axis_of_normals(point, normal + off * units(rng, 40)) is None
        found[f"{name} of few"] = symmetry._axis_of_normals(point[:5], normal[:5])
    helix = np.column_stack([-out[:, 1], out[:, 0], np.full(40, 0.3)])
    for name, normal in (("plane", np.tile(up, (40, 1))), ("sphere", units(rng, 40)), ("any", units(rng, 40)), ("screw", helix)):
        found[name] = symmetry._axis_of_normals(
            2.0 * normal if name == "sphere" else 2.0 * out + turn[:, None] * 0.3 * up, normal
        )
    keeps("axes", found)


def test_multiples(keeps):
    """What is a multiple but for rounding is one."""
    angles = [0.3, 0.7, 0.6, 17.3, -0.3, 89.99999999999999, 90.00000000000001, 44.999, 5.0, 0.1 + 0.2]
    limits = [
        (-math.pi, math.pi),
        (-math.inf, math.inf),
        (-0.3, 2.1),
        (0.0, 2.0 * math.pi),
        (-math.radians(35.0), math.radians(35.0)),
    ]
    keeps("multiples", {str(step): [[canonical._multiples(np.array([each, 0.5 * each]), step) for each in angles],
                                    [_multiples(np.array(each), step) for each in limits]]
                        for step in (90.0, 45.0, 5.0, 0.1, 7.0)})  # fmt: skip


def patches(seed):
    """Samples of a plane, of a cylinder, of a cone and of a bent face, with their areas; some are not judged."""
    rng = np.random.default_rng(seed)
    turn = rng.uniform(0.0, 2.0, 20)
    out = np.column_stack([np.cos(turn), np.zeros(20), np.sin(turn)])
    cone = np.column_stack([np.cos(turn), np.sin(turn), np.full(20, 0.4)]) / math.hypot(1.0, 0.4)
    few = np.repeat([[0.0, 0.28, 0.96]], 3, axis=0)
    normal = np.concatenate([np.repeat([[0.6, 0.0, 0.8]], 15, axis=0), out, cone, units(rng, 20), few, out[:3], out[:4]])
    face = np.repeat(np.arange(1, 8), [15, 20, 20, 20, 3, 3, 4]).astype(np.int32)
    count = len(face)
    area = rng.uniform(0.5, 1.5, count) * (1.0 + face)
    unjudged = np.where(np.arange(count) % 11 == 4, 0, -1)
    return SimpleNamespace(point=units(rng, count) * 20.0, normal=normal, face=face, area=area, unjudged=unjudged)


def test_candidates(on_the_way):
    def laid(name, step, spacing, high):
        where, samples = orientations(*MACHINES[name]), patches(1)
        conditions = replace(where.conditions, postures=PostureRange(tilt=(0.0, high)))
        where = Orientations.of(conditions)
        axis = units(np.random.default_rng(2), 60)
        axis[::7, 2] = np.sign(axis[::7, 2]) * 5.0
        axis /= np.linalg.norm(axis, axis=1)[:, None]
        return [candidates(where, samples, step, spacing), directions(samples, conditions.setup), neighbours(axis[:9], spacing),
                apart(axis, 0.3), apart(axis, 0.3, axis[:3]), apart(axis), candidates(where, samples, step, 0.5)]  # fmt: skip

    on_the_way("candidates", laid, [(case, case) for case in (
        ("trunnion", None, 0.23, 1.1), ("none", None, 0.3, 0.7), ("head", 0.31, 0.2, 2.0),
        ("trunnion that ends", None, 0.41, 3.0))])  # fmt: skip


class Counted(SimpleNamespace):
    """Samples that know how many they are."""

    def __len__(self):
        return len(self.point)


def spanned(seed, name):
    """Axes of samples of three pieces, connected in rows, and what is told of how the machine turns over them."""
    rng, machine = np.random.default_rng(seed), orientations(*MACHINES[name]).kinematics
    edge = grid_of(8, 6)
    x, y = np.divmod(np.arange(48), 6)
    axis = np.column_stack([0.3 * (x - 3.3), 0.4 * (y - 2.2), np.ones(48)]) + 0.1 * rng.normal(size=(48, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    sample = rng.integers(-1, 48, 160)
    piece = np.where(sample < 0, 0, np.where(sample % 8 < 3, 2, np.where(sample % 8 < 6, 5, 7)))
    area = rng.uniform(0.1, 1.0, 160) * (1.0 + piece)
    samples = Counted(point=np.column_stack([2.0 * x, 3.1 * y, 0.1 * x * y]), neighbours=edge.astype(np.int32))
    between = SimpleNamespace(cells=SimpleNamespace(piece=piece, area=area, sample=sample))
    turning = partial(moving_proof._turning, samples, axis, between)
    return [turning(machine, ("first", "second")), turning(None, ())]


def test_how_axes_turn(keeps):
    cases = [(1, "trunnion"), (2, "head"), (3, "trunnion that ends"), (4, "head and table"), (5, "none")]
    keeps("turning", {str(case): spanned(*case) for case in cases})


def test_axes_are_laid_beside_what_is_known(keeps):
    rng, found = np.random.default_rng(9), {}
    for closed_u in (False, True):
        for closed_v in (False, True):
            index = np.where(rng.random((7, 9)) < 0.3, np.arange(63).reshape(7, 9), -1).astype(np.int32)
            grid = FaceGrid(
                1, np.linspace(0.0, 1.0, 7), np.linspace(0.0, 1.0, 9), index, closed_u, closed_v, (0.0, 1.0, 0.0, 1.0)
            )
            axis = np.where(rng.random(63)[:, None] < 0.8, units(rng, 63), np.nan)
            nodes = np.full((7, 9, 3), np.nan)
            nodes[index >= 0] = axis[index[index >= 0]]
            filled = moving_axes._filled(nodes, grid)
            found[f"{closed_u} {closed_v}"] = (
                [filled[k] for k in range(7)],
                sorted(moving_axes.fields(SimpleNamespace(grids=[grid]), axis)),
            )
    keeps("filled", found)


def test_axes_are_drawn_smooth(keeps):
    """Free where the tilt is below a limit, with room that falls with it."""
    edge, rng = grid_of(7, 6), np.random.default_rng(4)
    axis = units(rng, 42) * 0.5 + np.array([0.0, 0.0, 1.0])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    tests = {
        "free": SimpleNamespace(free=lambda rows, way: np.ones(len(rows), bool), margin=lambda rows, way: np.ones(len(rows)),
                                pace=lambda rows, way: np.ones(len(rows))),
        "limited": SimpleNamespace(free=lambda rows, way: (way[:, 2] >= 0.9) & (rows % 5 != 3),
                                   margin=lambda rows, way: 0.6 * way[:, 2] - 0.45 + 0.01 * (rows % 3),
                                   pace=lambda rows, way: way[:, 2]),
    }  # fmt: skip
    keeps("smooth", {name: list(moving_axes._smoothed(test, np.arange(2, 42), edge[(edge > 1).all(axis=1)], axis.copy(),
                                                      np.full(42, -1.0)))
                     for name, test in tests.items()})  # fmt: skip


def test_areas_that_samples_stand_for(keeps):
    rng = np.random.default_rng(21)
    samples = SimpleNamespace(point=rng.uniform(-9.0, 9.0, (90, 3)), face=rng.integers(1, 4, 90).astype(np.int32),
                              area=np.where(rng.random(90) < 0.1, np.nan, rng.uniform(0.2, 1.3, 90)))  # fmt: skip
    every = np.arange(5, 90)
    keeps("shared", [timing.shared_area(samples, every, every[::step]) for step in (1, 3, 8, 40)]
          + [timing.shared_area(samples, every, every[:0]), timing.shared_area(samples, every[:1], every[:1])]
          + [fewest.spread(every, samples.point, most) for most in (1, 2, 9, 84, 85)])  # fmt: skip
