"""What each kernel costs: time per call, and instructions per call where valgrind is at hand.

`python benchmarks/kernels.py` prints a table. Inputs are waves by formula (`tests/support/waves.py`): 7,200 triangles, 400
samples, seed 0, 24 rotations, cutter R6L40. Seconds are processor time, the best of five, compiled before. Instructions are
callgrind's for code compiled for one named processor, so they differ between machines only by the compiler's version.
"""

import os
import pickle
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from plan_cutters import Cutter
from plan_cutters.domain.assembly import assembly
from plan_cutters.kernels import material
from plan_cutters.kernels.area import cover
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.linear import tree
from plan_cutters.kernels.linear import tree as lanes
from plan_cutters.kernels.maps import free_map, free_tilts, passes
from plan_cutters.kernels.rows import Contacts, Frame, VerdictArrays
from plan_cutters.kernels.search import place, search
from plan_cutters.kernels.tool import apart, arcs, hit

sys.path.append(str(Path(__file__).parent.parent))
from tests.support import waves

RADIUS, LENGTH, OUTER, INNER, TURNS = 6.0, 40.0, 0.04, 0.06, 24
TOOL = waves.flat(RADIUS, LENGTH, OUTER)
INNER_TOOL, PIECE = waves.flat(RADIUS, LENGTH, INNER), TOOL.piece[0]
CYLINDER, FLAT = waves.cylinder(RADIUS, LENGTH, OUTER), waves.flat(RADIUS, LENGTH, OUTER)
DUMMY = assembly(Cutter.flat(radius=RADIUS, length=LENGTH), OUTER, OUTER).dummy
RIGHT, UP, NARROWEST = np.pi / 2, np.array([0.0, 0, 1]), np.radians(0.1)
Driver = Callable[[int], object]
#: Calls of a kernel under callgrind, at most: it takes fifty times as long.
COUNTED = 10_000


# Small kernels are called from compiled loops: a call from Python costs more than they do.
@kernel
def many_point_arcs(n, at):
    total = 0.0
    for i in range(n):
        q = at[i % len(at)]
        total += arcs.point_arc(q[2], q[0], q[1], q[3], 6.0, 5.99, 0.01, 39.99)[0]
    return total


@kernel
def many_local_gouges(n, at):
    total = 0.0
    for i in range(n):
        q = at[i % len(at)]
        total += arcs.local_gouge(0.01 * q[0], 0.01 * q[1], q[4], q[5], 6.0, 0.0)[0]
    return total


@kernel
def many_axis_arcs(n, at, out):
    total = 0
    for i in range(n):
        q = at[i % len(at)]
        total += arcs.axis_arcs(q[4], q[5], 0.7, 0.0, 1.5, out)
    return total


@kernel
def many_removals(n, at, intervals):
    count = 1
    for i in range(n):
        if i % 8 == 0:
            intervals[0, 0], intervals[0, 1], count = 0.0, 1.5, 1
        q = at[i % len(at)]
        count = place.remove(intervals, count, q[3], q[3] + 0.05, 1e-4)
    return count


@kernel
def many_boxes(n, box, bodies, piece):
    total = 0
    for i in range(n):
        total += apart.alive(box, i % len(box), bodies[i % len(bodies)], piece, 1, 0.0)
    return total


@kernel
def many_triangles(n, vertex, which, bodies, piece, scratch):
    total = 0
    for i in range(n):
        total += hit.triangle_hit(vertex, which[i % len(which)], bodies[i % len(bodies)], piece, 1, 0.0, scratch)[0]
    return total


@kernel
def many_walks(n, built, bodies, piece, scratch):
    total = 0
    for i in range(n):
        body = bodies[i % len(bodies)]
        total += hit.tree_hit(built, body, piece, 0.0, -1, scratch)[0]
    return total


@kernel
def many_blocks(n, view, interval, tool, margin):
    total = 0.0
    for i in range(n):
        passes._boxes_pass(view, i % len(view), 0.8, 0.6, interval, 1, tool, margin)
        total += margin[0]
    return total


@kernel
def many_leaves(n, leaves, interval, tool, margin):
    total = 0.0
    for i in range(n):
        seen = leaves[i % len(leaves)]
        passes._triangles_pass(seen, 0.8, 0.6, interval, 1, tool, margin)
        total += margin[0]
    return total


def contacts() -> list[Any]:
    """What `cover` is asked on a face of a sample part; kept in a file, for the kernel of CAD is not run under valgrind."""
    kept_in = os.environ.get("COVER_ASKED")
    if kept_in:
        return list(pickle.loads(Path(kept_in).read_bytes()))
    from cad_io import read_part
    from plan_cutters import Cutter, plan

    asked: list[tuple[Any, ...]] = []
    real = cover.cover
    cover.cover = lambda *arguments: (asked.append(arguments), real(*arguments))[1]
    try:
        part = read_part(Path(__file__).parent.parent / "samples" / "pocket_top.step")
        plan(part, cutters=[Cutter.flat(radius=8, length=90)], spacing=2.0, area_budget=1000, jobs=1)
    finally:
        cover.cover = real
    return list(max(asked, key=lambda arguments: len(arguments[0])))


def drivers() -> dict[str, tuple[str, int, Driver]]:
    """Each kernel's name: what one of its calls is counted by, how many of them to time, and a run of n of them."""
    rng = np.random.default_rng(0)
    (point, normal, first, curvature), loose = waves.samples(20), waves.triangles(61)
    built, n = waves.tree_of(loose), len(point)
    vertex, box = built.vertex, built.box
    angle = rng.uniform(0, 2 * np.pi, 997)
    at = np.stack([*rng.normal(0, 6, (2, 997)), rng.uniform(0, 40, 997), rng.uniform(0, RIGHT, 997), np.cos(angle),
                   np.sin(angle)], 1)  # fmt: skip
    # Postures at random at every sample, and for each a triangle near its contact.
    bodies, tilt_direction, axis = np.empty((n, apart.BODY)), np.empty((n, 3)), np.empty((n, 3))
    centre, near = vertex.mean(1), np.empty(n, np.int64)
    for i in range(n):
        turn, tilt = rng.uniform(0, 2 * np.pi), rng.uniform(0, RIGHT)
        tilt_direction[i] = np.cos(turn) * first[i] + np.sin(turn) * np.cross(normal[i], first[i])
        axis[i] = np.cos(tilt) * normal[i] + np.sin(tilt) * tilt_direction[i]
        left = np.cross(normal[i], tilt_direction[i])
        hit.stand(bodies[i], Frame(point[i], normal[i], tilt_direction[i], left), np.cos(tilt), np.sin(tilt), RADIUS, 0.0)
        near[i] = rng.choice(np.argsort(np.linalg.norm(centre - point[i], axis=1))[:200])
    rotations = 2 * np.pi * np.arange(TURNS) / TURNS
    scratch, cc_points = hit.scratch(), Contacts(point, normal, first, curvature)
    out = VerdictArrays(
        np.empty(n, np.uint8), axis.copy(), tilt_direction.copy(), np.empty(n), np.empty(n, np.int32), np.empty(n, np.uint8)
    )
    solids = material.sheet(built)
    free, triangle, which = np.empty(n, np.bool_), np.empty(n, np.int32), np.empty(n, np.int32)

    def maps_of(count: int) -> None:
        for i in range(count):
            free_tilts.free_tilts(point[i % n], normal[i % n], tilt_direction[i % n], 0.0, RIGHT, TOOL, 0, NARROWEST, built, 2000)

    wide = lanes.WideTree(*lanes.wide_tree(built))
    blocks = wide.blocks
    view, leaves, margin = np.empty((len(blocks), 16, 8)), np.empty((200, 9, 8)), np.empty(8)
    for i in range(len(blocks)):
        lanes._see(view, i, blocks, i, point[0], first[0], np.cross(normal[0], first[0]), normal[0], 100.0)
    for i in range(len(leaves)):
        lanes._see_leaf(leaves[i], vertex, 8 * i, 8 * i + 8, point[0], first[0], np.cross(normal[0], first[0]), normal[0])
    interval = np.array([[0.2, 1.4, np.cos(0.2), np.sin(0.2), np.cos(1.4), np.sin(1.4), 0, 0]])
    part, filled, unsure = np.empty((n, TURNS, 8, 2)), np.empty((n, TURNS), np.int32), np.empty((n, TURNS))
    asked = contacts()

    def all_maps(count: int) -> None:
        k = -(-count // TURNS)
        turned = waves.ranges(rotations)
        free_map.free_map(np.arange(k), cc_points, turned, FLAT, NARROWEST, built, wide, 8, part, filled, unsure)

    return {
        "point_arc": ("point", 200_000, lambda k: many_point_arcs(k, at)),
        "local_gouge": ("rotation", 200_000, lambda k: many_local_gouges(k, at)),
        "axis_arcs": ("rotation", 200_000, lambda k: many_axis_arcs(k, at, np.empty((3, 2)))),
        "remove": ("arc", 200_000, lambda k: many_removals(k, at, np.empty((16, 2)))),
        "alive": ("node", 200_000, lambda k: many_boxes(k, box, bodies, PIECE)),
        "triangle_hit": ("triangle", 100_000, lambda k: many_triangles(k, vertex, near, bodies, PIECE, scratch)),
        "tree_hit": ("posture", 4_000, lambda k: many_walks(k, built, bodies, PIECE, scratch)),
        "build": ("triangle", 7_200, lambda k: k and tree.build(loose[:k])),
        "probe": ("posture", 400, lambda k: search.probe(
            np.arange(k), point, normal, axis, tilt_direction, TOOL, built, triangle, which)),
        "dummy_clear": ("sample", 400, lambda k: search.dummy_clear(
            np.arange(k), cc_points, DUMMY, TOOL, solids, free)),
        "search": ("sample", 400, lambda k: search.search(
            np.arange(k), cc_points, waves.ranges(rotations, 0.7), TOOL, INNER_TOOL, solids, solids, out)),
        "free_tilts": ("rotation", 100, maps_of),
        "wide_tree": ("triangle", 7_200, lambda k: k and lanes.wide_tree(built)),
        "_boxes_pass": ("eight boxes", 100_000, lambda k: many_blocks(k, view, interval, CYLINDER, margin)),
        "_triangles_pass": ("eight triangles", 100_000, lambda k: many_leaves(k, leaves, interval, CYLINDER, margin)),
        "free_map": ("rotation", 400 * TURNS, all_maps),
        "cover": ("contact", len(asked[0]), lambda k: cover.cover(asked[0][:k], *asked[1:])),
    }  # fmt: skip


def seconds(count: int, run: Driver) -> float:
    """Best of five, the work of calling taken off."""
    run(count)
    best = [np.inf, np.inf]
    for _ in range(5):
        for i, n in enumerate((0, count)):
            began = time.process_time_ns()
            run(n)
            best[i] = min(best[i], time.process_time_ns() - began)
    return float(best[1] - best[0]) / 1e9 / count


def marked() -> None:
    """Run every kernel 0 and then a few thousand times, a system call between: there callgrind writes its sums."""
    runs = drivers()
    for _, count, run in runs.values():
        run(min(count, COUNTED))
    for _, count, run in runs.values():
        for n in (0, min(count, COUNTED)):
            os.getppid()
            run(n)
    os.getppid()


def instructions(names: list[str], counts: list[int]) -> dict[str, float]:
    """Instructions per call by callgrind, none without it."""
    # Valgrind shows another processor than there is: name one, so that what is compiled before is found again.
    environment = {**os.environ, "NUMBA_CPU_NAME": "haswell", "NUMBA_CPU_FEATURES": "+avx2,+fma,+bmi,+bmi2,+popcnt"}
    me = [sys.executable, __file__, "--marked"]
    with tempfile.TemporaryDirectory() as folder:
        environment["COVER_ASKED"] = f"{folder}/asked.pickle"
        Path(environment["COVER_ASKED"]).write_bytes(pickle.dumps(contacts()))
        subprocess.run(me, env=environment, check=True)
        tool = ["valgrind", "--tool=callgrind", "--dump-before=getppid", f"--callgrind-out-file={folder}/sums"]
        try:
            subprocess.run([*tool, *me], env=environment, check=True, capture_output=True)
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"no instructions counted: {error}", file=sys.stderr)
            return {}
        # Dump i holds what ran before mark i; the first is the start-up, and each kernel has two.
        sums = []
        for i in range(2, 2 * len(names) + 2):
            found = re.search(r"^(?:totals|summary): (\d+)", Path(folder, f"sums.{i}").read_text(), re.M)
            assert found
            sums.append(int(found[1]))
    return {
        name: (sums[2 * i + 1] - sums[2 * i]) / min(counts[i], COUNTED) for i, name in enumerate(names)
    }  # fmt: skip


def main() -> None:
    runs = drivers()
    counted = instructions(list(runs), [count for _, count, _ in runs.values()])
    print("| kernel | counted by | time | instructions |\n|---|---|---|---|")
    for name, (unit, count, run) in runs.items():
        spent = 1e6 * seconds(count, run)
        shown = f"{1000 * spent:.1f} ns" if spent < 1 else f"{spent:.1f} us"
        print(f"| `{name}` | {unit} | {shown} | {counted[name]:,.0f} |" if counted else f"| `{name}` | {unit} | {shown} | |")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--marked"]:
        marked()
    else:
        main()
