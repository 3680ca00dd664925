"""Posture verdicts beside those of collision libraries: how fast, and how often `safe` where the surface is too deep.

`python benchmarks/peers.py [STEM] [SAMPLES] [SEED]` (`peaks_and_valleys`, 6, 1) prints a markdown table, in minutes.
The peers are no dependencies of the project: `pip install python-fcl coal embreex`.

Everyone decides 72 rotations x 90 tilts (0 to 89 deg) with R6L80 at the same random samples of a 201 x 201 grid,
tolerance 0.01 mm, in one run, warm, on one thread. What favours the peers: the poses and the rays' directions are not in
their times, early exits are. What a careful user of theirs must do, and does here:

- shrink the cutter by the tolerance on all sides, for the nominal cutter touches the mesh at the contact itself;
- python-fcl, coal: a cylinder against a BVH (OBBRSS) of the triangles, no contacts asked for, first hit ends it;
- embreex: lines up the wall from rim to top, the chords of the rim between them, half as many diameters of the bottom, and
  the cutter's own axis; a posture that is hit asks no more. 64 lines (161 rays) are the least power of two whose polygon
  is within the tolerance of the circle; 16 lines (41 rays) are what one would try first. trimesh's own `mesh.ray` cannot
  end a ray, so embreex is called as trimesh calls it, with an end.

On meshes alone nobody knows curvature: local gouging shallower than what the cutter was shrunk by stays unseen.

Ours: free tilt intervals (a rotation decides its 90 tilts; the share that is undecided does not count) at the same samples
and at runs of neighbours, single probes of all postures, and the existence search (samples a second).
"""

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from exact import Exact
from numpy.typing import NDArray

from cad_io import SurfaceSamples, Triangles, read_part
from cad_io.arrays import Floats
from cad_io.part.bodies import orient
from cad_io.sample import sample
from cad_io.tessellate import tessellate
from plan_cutters import Cutter
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.posture import PostureRange
from plan_cutters.judging.phases import access
from plan_cutters.kernels.maps.free_map import free_map
from plan_cutters.kernels.maps.free_tilts import local_gouge_range
from plan_cutters.kernels.rows import Ranges
from plan_cutters.kernels.search.search import probe
from plan_cutters.scene.conditions import Conditions, Context, contacts_of, rotary_of, tool_of
from plan_cutters.scene.faces import select_faces
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.scene.work import in_chunks

SAMPLES = Path(__file__).parent.parent / "samples"
CUTTER, GRID, TOLERANCE, COARSE = Cutter.flat(radius=6, length=80), 201, 0.01, 0.1
ROTATIONS, TILTS = np.radians(np.arange(0, 360, 5.0)), np.radians(np.arange(90.0))
#: Ends of intervals are certified to this, rad; free intervals that a rotation may have.
NARROWEST, ROOM = np.radians(0.1), 32
#: Postures checked against the exact surface for each way: called safe next to one that is not, and called safe anywhere.
CHECKED = 500
#: Samples in a row from each of those picked, for maps as they are made: over neighbours.
NEIGHBOURS = 100


@dataclass(frozen=True)
class Postures:
    """All postures at one sample: contact (3,), normal (3,), axis, x_t, lean (72, 90, 3), gouging bound (72,)."""

    point: Floats
    normal: Floats
    axis: Floats
    x_t: Floats
    tilt_direction: Floats
    local: Floats

    @classmethod
    def at(cls, samples: SurfaceSamples, row: int) -> "Postures":
        p, n, e1 = samples.point[row], samples.normal[row], samples.direction_max[row]
        tilt_direction = np.cos(ROTATIONS)[:, None] * e1 + np.sin(ROTATIONS)[:, None] * np.cross(n, e1)
        tilt_direction = np.broadcast_to(tilt_direction[:, None, :], (len(ROTATIONS), len(TILTS), 3))
        c, s = np.cos(TILTS)[None, :, None], np.sin(TILTS)[None, :, None]
        big, small = samples.curvature[row]
        bound = np.array([local_gouge_range(big, small, float(r), CUTTER.radius, 0.0)[0] for r in ROTATIONS])
        return cls(p, n, c * n + s * tilt_direction, c * tilt_direction - s * n, tilt_direction, bound)

    @property
    def frame(self) -> Floats:
        """(6480, 3, 3) columns x_T, y_T, axis."""
        axis, x_t = self.axis.reshape(-1, 3), self.x_t.reshape(-1, 3)
        return np.stack([x_t, np.cross(axis, x_t), axis], axis=2)

    def centre(self, height: float) -> Floats:
        """(6480, 3) points of the axes at a height."""
        return np.asarray(self.point - CUTTER.radius * self.x_t.reshape(-1, 3) + height * self.axis.reshape(-1, 3))

    @property
    def gouging(self) -> NDArray[np.bool_]:
        """(72, 90) where the cutter's edge curves less than the surface."""
        return np.asarray(~(TILTS[None, :] >= self.local[:, None] - 1e-9))


#: Given the postures of a sample, gets them ready, and returns what is timed: True where a posture is called safe.
Peer = Callable[[Postures], Callable[[], Any]]


def fcl_peer(triangles: Triangles, shrink: float) -> Peer:
    """python-fcl: True where nothing collides."""
    import fcl

    corners, index = _mesh(triangles)
    mesh = fcl.BVHModel()
    mesh.beginModel(len(corners), len(index))
    mesh.addSubModel(corners, index)
    mesh.endModel()
    part = fcl.CollisionObject(mesh)
    tool = fcl.CollisionObject(fcl.Cylinder(CUTTER.radius - shrink, CUTTER.length - 2 * shrink))
    request = fcl.CollisionRequest(num_max_contacts=1, enable_contact=False)

    def prepare(postures: Postures) -> Callable[[], list[bool]]:
        poses = [fcl.Transform(r, t) for r, t in zip(postures.frame, postures.centre(CUTTER.length / 2), strict=True)]

        def free(pose: Any) -> bool:
            tool.setTransform(pose)
            return not fcl.collide(part, tool, request, fcl.CollisionResult())

        return lambda: [free(pose) for pose in poses]

    return prepare


def coal_peer(triangles: Triangles, shrink: float) -> Peer:
    """coal: True where nothing collides."""
    import coal

    corners, index = _mesh(triangles)
    mesh = coal.BVHModelOBBRSS()
    mesh.beginModel(len(index), len(corners))
    mesh.addVertices(corners)
    mesh.addTriangles(index)
    mesh.endModel()
    tool, still = coal.Cylinder(CUTTER.radius - shrink, CUTTER.length - 2 * shrink), coal.Transform3s.Identity()
    collide = coal.ComputeCollision(mesh, tool)
    request, result = coal.CollisionRequest(), coal.CollisionResult()
    request.num_max_contacts, request.enable_contact = 1, False

    def prepare(postures: Postures) -> Callable[[], list[bool]]:
        centres = postures.centre(CUTTER.length / 2)
        poses = [coal.Transform3s(r, t) for r, t in zip(postures.frame, centres, strict=True)]

        def free(pose: Any, _kept: Any = (mesh, tool)) -> bool:  # `collide` does not keep them alive
            result.clear()
            return not collide(still, pose, request, result)

        return lambda: [free(pose) for pose in poses]

    return prepare


def embreex_peer(triangles: Triangles, shrink: float, lines: int = 64) -> Peer:
    """embreex: True where no segment of the tool's silhouette is hit."""
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene

    scene = EmbreeScene()
    corners, index = _mesh(triangles)
    mesh = TriangleMesh(scene, corners.astype(np.float32), index.astype(np.int32))
    start, end = _silhouette(CUTTER.radius - shrink, CUTTER.length - 2 * shrink, lines)
    reach = np.linalg.norm(end - start, axis=1)
    towards = (end - start) / reach[:, None]

    def prepare(postures: Postures) -> Callable[[], NDArray[np.bool_]]:
        assert mesh is not None
        frame, bottom = postures.frame.astype(np.float32), postures.centre(shrink).astype(np.float32)
        direction = np.einsum("nij,kj->kni", frame, towards.astype(np.float32))
        origin = bottom + np.einsum("nij,kj->kni", frame, start.astype(np.float32))

        def run() -> NDArray[np.bool_]:
            free = np.arange(len(bottom))
            for k in range(len(reach)):
                far = np.full(len(free), reach[k], np.float32)
                hit = scene.run(origin[k, free], direction[k, free], far, query="OCCLUDED")
                free = free[hit == -1]
                if len(free) == 0:
                    break
            safe = np.zeros(len(bottom), bool)
            safe[free] = True
            return safe

        return run

    return prepare


def _mesh(triangles: Triangles) -> tuple[Floats, NDArray[np.int64]]:
    return triangles.vertex.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def _silhouette(radius: float, length: float, lines: int) -> tuple[Floats, Floats]:
    """Starts and ends of the segments, from the bottom centre, the wall first."""
    angle = np.arange(lines) * 2 * np.pi / lines
    rim = radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    up, middle = np.array([0.0, 0.0, length]), np.zeros((1, 3))
    # Lines far from each other first: what is hit is hit early.
    wall = rim[np.arange(lines).reshape(-1, 8).T.ravel()]
    start = np.concatenate([wall, rim[: lines // 2], rim, middle])
    end = np.concatenate([wall + up, rim[lines // 2 :], np.roll(rim, -1, axis=0), middle + up])
    return start, end


class Maps(NamedTuple):
    """Free tilts at m samples: intervals (m, 72, ROOM, 2), how many are filled (m, 72), and tilts left undecided (m, 72), rad."""

    part: Floats
    filled: NDArray[np.int32]
    undecided: Floats

    @property
    def decided(self) -> float:
        """Postures of the 90 tilts that are answered, over all samples and rotations."""
        return float((len(TILTS) * (1 - self.undecided / (np.pi / 2))).sum())

    @property
    def safe(self) -> NDArray[np.bool_]:
        """(m, 72, 90) whether a tilt lies in a free interval."""
        real = np.arange(ROOM) < self.filled[..., None]
        inside = (self.part[..., None, :, 0] <= TILTS[:, None]) & (self.part[..., None, :, 1] >= TILTS[:, None])
        return np.asarray((inside & real[..., None, :]).any(axis=-1))


def maps(samples: SurfaceSamples, rows: NDArray[np.int64], obstacles: Obstacles, jobs: int) -> Maps:
    """The free tilts at all rotations."""
    k, n = len(ROTATIONS), len(rows)
    found = Maps(np.zeros((n, k, ROOM, 2)), np.zeros((n, k), np.int32), np.zeros((n, k)))
    safe = TOLERANCE - obstacles.triangles.chord_error
    tool = tool_of(assembly(CUTTER, safe, safe))
    ranges = Ranges(np.cos(ROTATIONS), np.sin(ROTATIONS), 0.0, np.pi / 2, np.array([0.0, 0.0, 1.0]), -2.0, rotary_of(None))

    def work(places: NDArray[np.int64]) -> None:
        piece = slice(places[0], places[-1] + 1)
        free_map(
            rows[piece], contacts_of(samples), ranges, tool, NARROWEST, obstacles.tree, obstacles.wide_tree, ROOM,
            found.part[piece], found.filled[piece], found.undecided[piece],
        )  # fmt: skip

    in_chunks(work, np.arange(n), jobs, chunk=max(1, n // 16))
    return found


def probes(postures: Postures, obstacles: Obstacles) -> NDArray[np.bool_]:
    """Each posture by itself."""
    safe = TOLERANCE - obstacles.triangles.chord_error
    axis, tilt_direction = postures.axis.reshape(-1, 3), np.ascontiguousarray(postures.tilt_direction.reshape(-1, 3))
    n = len(axis)
    triangle = np.full(n, -1, np.int32)
    point, normal = np.tile(postures.point, (n, 1)), np.tile(postures.normal, (n, 1))
    probe(
        np.arange(n),
        point,
        normal,
        axis,
        tilt_direction,
        tool_of(assembly(CUTTER, safe, safe)),
        obstacles.tree,
        triangle,
        triangle.copy(),
    )
    return (triangle < 0) & ~postures.gouging.ravel()


def timed(job: Callable[[], Any], repeats: int, clock: Callable[[], float] = time.process_time) -> tuple[Any, float]:
    """What a job returns, and its best seconds."""
    seconds = []
    for _ in range(repeats):
        began = clock()
        found = job()
        seconds.append(clock() - began)
    return found, min(seconds)


#: One thread is timed by the processor, so that other work on the machine does not count; two by the clock on the wall.
CLOCKS = {1: time.process_time, 2: time.perf_counter}


def threaded(work: Callable[[int], Any], count: int, jobs: int) -> list[Any]:
    """`work(0)` to `work(count - 1)`, shared out as the program does."""
    found: list[Any] = [None] * count

    def piece(rows: NDArray[np.int64]) -> None:
        for i in rows.tolist():
            found[i] = work(i)

    in_chunks(piece, np.arange(count), jobs, chunk=1)
    return found


class Truth:
    """False-safe verdicts, by the exact surface and its curvature; a posture is looked at once."""

    def __init__(self, exact: Exact, where: Sequence[Postures], seed: int) -> None:
        self._exact, self._where, self._seed = exact, where, seed
        self._known: dict[tuple[int, int, int], float] = {}

    def row(self, safe: NDArray[np.bool_]) -> list[str]:
        """Share called safe; of seeded picks how many are too deep, the deepest, and how many gouge locally."""
        other = np.pad(~safe, ((0, 0), (0, 0), (1, 1)))
        # One order for all ways: what they share is looked at once.
        order = np.random.default_rng(self._seed).random(safe.shape)
        picked: set[tuple[int, int, int]] = set()
        for among in (safe & (other[..., 2:] | other[..., :-2]), safe):
            found = np.argwhere(among)
            first = found[np.argsort(order[among])[:CHECKED]]
            picked |= {(int(i), int(j), int(k)) for i, j, k in first}
        depths = np.array([self._depth(*at) for at in sorted(picked)])
        gouging = sum(bool(self._where[i].gouging[j, k]) for i, j, k in picked)
        return [
            f"{100 * safe.mean():.2f}", str(len(picked)),
            str(int((depths > TOLERANCE + 1e-6).sum())), f"{depths.max(initial=-np.inf):.4f}", str(gouging),
        ]  # fmt: skip

    def _depth(self, i: int, j: int, k: int) -> float:
        if (i, j, k) not in self._known:
            at = self._where[i]
            self._known[i, j, k] = self._exact.deepest(at.point, at.axis[j, k], at.x_t[j, k], CUTTER.radius, CUTTER.length)
        return self._known[i, j, k]


PEERS: tuple[tuple[str, str, Callable[[Triangles, float], Peer]], ...] = (
    ("python-fcl", "fcl", fcl_peer),
    ("coal", "coal", coal_peer),
    ("embreex, 161 rays", "embreex", embreex_peer),
    ("embreex, 41 rays", "embreex", partial(embreex_peer, lines=16)),
)
HEAD = ("way", "threads", "mesh mm", "cutter shrunk by mm", "postures/s", "ours is faster by", "safe %",
        "checked", "deeper than 0.01", "deepest mm", "local gouges")  # fmt: skip


def table(rows: Sequence[Sequence[str]]) -> str:
    return "\n".join("| " + " | ".join(cells) + " |" for cells in rows)


def main(stem: str = "peaks_and_valleys", count: str = "6", seed: str = "1") -> None:
    missing = [name for name in ("fcl", "coal", "embreex") if find_spec(name) is None]
    if missing:
        print(f"missing: {', '.join(missing)}; pip install python-fcl coal embreex", file=sys.stderr)
    part = read_part(SAMPLES / f"{stem}.step")
    samples = sample(
        part, orient(part, towards=(0, 0, 1)), grid=GRID, faces=select_faces(part.faces, "sculptured")
    )  # fmt: skip
    rng = np.random.default_rng(int(seed))
    rows = np.sort(rng.choice(np.flatnonzero(samples.unjudged < 0), int(count), replace=False))
    where = [Postures.at(samples, row) for row in rows]
    fine, coarse = tessellate(part, 0.2 * TOLERANCE), tessellate(part, COARSE)
    obstacles, truth = Obstacles(fine), Truth(Exact(part), where, int(seed))
    shape, n = (len(where), len(ROTATIONS), len(TILTS)), len(where)
    print(f"{stem}.step, {CUTTER.id}, {n} of {len(samples)} samples (seed {seed}), {len(fine)} triangles within "
          f"{fine.chord_error:.4f} mm, {len(coarse)} within {coarse.chord_error:.3f} mm\n")  # fmt: skip

    lines: list[list[str]] = [list(HEAD), ["---"] * len(HEAD)]
    maps(samples, rows[:1], obstacles, 1)
    threaded(lambda i: probes(where[i], obstacles), 1, 1)
    certified = [f"{fine.chord_error:.3f}", "certified"]
    ours: dict[int, float] = {}
    for jobs, clock in CLOCKS.items():
        found, seconds = timed(lambda j=jobs: maps(samples, rows, obstacles, j), 5, clock)
        ours[jobs] = found.decided / seconds
        lines.append(["ours, intervals", str(jobs), *certified, f"{ours[jobs]:.3g}", "", *truth.row(found.safe)])
    undecided = 100 * found.undecided.mean() / (np.pi / 2)
    near = np.unique(np.minimum(rows[:, None] + np.arange(NEIGHBOURS), len(samples) - 1))
    near = near[samples.unjudged[near] < 0]
    for jobs, clock in CLOCKS.items():
        found, seconds = timed(lambda j=jobs: maps(samples, near, obstacles, j), 2, clock)
        rate = found.decided / seconds
        cells = [f"{rate:.3g}", f"{ours[jobs] / rate:.3g}", f"{100 * found.safe.mean():.2f}"]
        lines.append([f"ours, intervals, {len(near)} neighbours", str(jobs), *certified, *cells, "", "", "", ""])
    for jobs, clock in CLOCKS.items():
        free, seconds = timed(lambda j=jobs: threaded(lambda i: probes(where[i], obstacles), n, j), 3, clock)
        rate = np.prod(shape) / seconds
        lines.append(["ours, single probes", str(jobs), *certified, f"{rate:.3g}", f"{ours[jobs] / rate:.3g}",
                      *truth.row(np.reshape(free, shape))])  # fmt: skip
    for name, module, make in PEERS:
        if module in missing:
            continue
        for triangles, shrink in ((fine, TOLERANCE), (coarse, TOLERANCE), (fine, 0.0)):
            prepare = make(triangles, shrink)
            free, seconds = [], 0.0
            for at in where:
                run = prepare(at)
                found, took = timed(run, 1)
                free.append(np.reshape(found, shape[1:]))
                seconds += took
            rate = np.prod(shape) / seconds
            lines.append([name, "1", f"{triangles.chord_error:.3f}", f"{shrink:g}", f"{rate:.3g}", f"{ours[1] / rate:.3g}",
                          *truth.row(np.stack(free))])  # fmt: skip
    print(table(lines))
    print(f"\nOurs leaves {undecided:.3f} % of the tilts undecided, ends certified to {np.degrees(NARROWEST):g} deg.")
    print(existence(samples, obstacles))


def existence(samples: SurfaceSamples, obstacles: Obstacles) -> str:
    """Samples a second of the existence search, over all samples."""
    postures = PostureRange(step=np.radians(5))
    none = np.zeros(len(samples), bool)
    found = []
    for jobs, clock in CLOCKS.items():
        conditions = Conditions(Machine(), np.array([0.0, 0.0, 1.0]), postures, Surroundings.sheet(obstacles), TOLERANCE, jobs)
        reach, seconds = timed(lambda given=conditions: access(samples, none, Context.of(CUTTER, given)), 3, clock)
        found.append(f"{len(samples) / seconds:.3g} samples/s on {jobs} thread(s)")
    reached = f"{int(reach.reached.sum())} of {len(samples)} samples reached"
    return f"\nOurs, existence of a posture, 72 rotations: {', '.join(found)}; {reached}."


if __name__ == "__main__":
    main(*sys.argv[1:])
