"""Does any operation gouge? Real parts in vises, every sample of every operation judged again by code of its own.

    python benchmarks/rejudge.py FOLDER [CASE ...] [--coarse]

FOLDER holds public CAD files (`DATA.md`). Each tool axis is computed from the written angles by its closed form. The tool is the
outline of `tests/support/tool_reference.py`; part and vises are points that the CAD kernel gives. Depth changes by no more than
the distance, so points are looked at by boxes first; about the deepest ones the surface is evaluated ever finer. What is found
is a true point of the surface: a depth beyond the tolerance is proof of a wrong answer, and the command ends with 1.

`refused`: the same for samples and operations that do not serve them, of which most must be found deep: the check can fail.
"""

import argparse
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Pnt2d, gp_Trsf
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_OUT
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

from cad_io import read_part
from cad_io.arrays import Floats, Ints
from plan_cutters import Cutter, Result, plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement

#: Points of the surface are about so far apart, and boxes of them so wide, mm.
STEP, BOX = 0.5, 5.0
#: Most lines across a face; samples of an operation with the deepest points, and points of each, that are looked at closely.
LINES, CLOSELY, PLACES = 600, 40, 4
ROUNDS, NODES = 6, 9
#: Pairs of samples and operations that do not serve them.
REFUSED = 40
#: Axes nearer to the normal than this stand upright, rad.
UPRIGHT = 1e-4


@dataclass(frozen=True)
class Case:
    """A part with its cutters, a machine, and the setups that it is made in: the axis of each, and the depth of the jaws."""

    file: str
    cutters: tuple[str, ...]
    machine: str
    setups: tuple[tuple[tuple[float, float, float], float], ...]
    more: dict[str, Any] = field(default_factory=dict)


UP, DOWN, ASIDE = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.0, -1.0, 0.0)
HOLDER = "R10:14L20+R16L30+R25L60"
CASES = {
    "featuretype, two vises": Case(
        "trimesh_featuretype.STEP", ("R5L55rc1F20S5", "R3L50rc3F12S4"), "trunnion-ac", ((UP, 8.0), (DOWN, 8.0)),
        {"spacing": 2.0},
    ),
    "control arm, a vise": Case(
        "asitus_control_arm.step", ("R6L60rc6F25S6",), "trunnion-ac", ((UP, 15.0),), {"spacing": 3.5}
    ),
    "ANC101, three cutters, two vises": Case(
        "asitus_ANC101-ill.stp", ("R10L80F40S10", "R6L70rc1F25S6", "R4L60rc4F20S5"), "head-table-bc",
        ((UP, 20.0), (ASIDE, 12.0)), {"spacing": 5.0, "holder_clearance": 0.5},
    ),
}  # fmt: skip
#: The tool axis at two angles, rad, the first axis next to the part, in the frame of the setup.
AXES = {
    "trunnion-ac": lambda c, a: (np.sin(a) * np.sin(c), -np.sin(a) * np.cos(c), np.cos(a)),
    "head-table-bc": lambda c, b: (np.sin(b) * np.cos(c), np.sin(b) * np.sin(c), np.cos(b)),
}


def frame(setup: tuple[float, float, float]) -> Floats:
    """The machine's x, y and z in a setup, as rows: its x is as near to the part's as can be."""
    z = np.array(setup)
    x = np.array([1.0, 0.0, 0.0]) - z[0] * z
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z])


def vise(shape: Any, setup: tuple[float, float, float], depth: float) -> Any:
    """A vise of solids about a part: a bed that it stands on, two jaws along the machine's y, one of them on a round spindle."""
    rows, box = frame(setup), Bnd_Box()
    turn = gp_Trsf()
    turn.SetValues(*rows[0], 0.0, *rows[1], 0.0, *rows[2], 0.0)
    BRepBndLib.AddOptimal_s(BRepBuilderAPI_Transform(shape, turn, True).Shape(), box, False, False)
    x, y, z, x1, y1, _ = box.Get()
    wide, jaw = x1 - x + 20.0, 40.0

    def block(low: tuple[float, float, float], size: tuple[float, float, float]) -> Any:
        return BRepPrimAPI_MakeBox(gp_Pnt(*low), *size).Shape()

    bodies = [
        block((x - 10, y - 3 * jaw, z - 60), (wide, y1 - y + 6 * jaw, 60.0)),
        block((x - 10, y - jaw, z - 1), (wide, jaw, depth + 1)),
        block((x - 10, y1, z - 1), (wide, jaw, depth + 1)),
        BRepPrimAPI_MakeCylinder(
            gp_Ax2(gp_Pnt((x + x1) / 2, y1 + jaw - 1, z), gp_Dir(0, 1, 0)), min(9.0, depth - 1), 2 * jaw
        ).Shape(),
    ]
    whole = bodies[0]
    for body in bodies[1:]:
        whole = BRepAlgoAPI_Fuse(whole, body).Shape()
    return BRepBuilderAPI_Transform(whole, turn.Inverted(), True).Shape()


class Faces:
    """Points of the faces and edges of shapes, each with a step of its own, and the faces themselves for more."""

    def __init__(self, shapes: list[tuple[Any, float]]) -> None:
        self.value, self.inside, self.span = [], [], []
        points, uvs, owner = [], [], []
        for shape, step in shapes:
            for face in (TopoDS.Face_s(each) for each in _parts(shape, TopAbs_FACE)):
                surface, trim = BRepAdaptor_Surface(face), BRepTopAdaptor_FClass2d(face, 1e-7)
                low, high = np.array(BRepTools.UVBounds_s(face)).reshape(2, 2).T
                self.value.append(surface.Value)
                self.inside.append(trim.Perform)
                self.span.append((low, high, (high - low) / (self._lines(surface, low, high, step) - 1)))
                grid = np.stack(np.meshgrid(*(np.arange(a, b + 0.5 * s, s) for a, b, s in zip(*self.span[-1], strict=True)),
                                            indexing="ij"), axis=-1).reshape(-1, 2)  # fmt: skip
                kept = np.array([trim.Perform(gp_Pnt2d(*uv)) != TopAbs_OUT for uv in grid.tolist()], bool)
                uvs.append(grid[kept])
                points.append(self.at(len(self.value) - 1, grid[kept]))
                owner.append(np.full(int(kept.sum()), len(self.value) - 1))
            for edge in (TopoDS.Edge_s(each) for each in _parts(shape, TopAbs_EDGE)):
                curve = BRepAdaptor_Curve(edge)
                first, last = curve.FirstParameter(), curve.LastParameter()
                rough = np.array([curve.Value(t).Coord() for t in np.linspace(first, last, 30)])
                count = int(np.clip(4 * np.linalg.norm(np.diff(rough, axis=0), axis=1).sum() / STEP, 3, 4000))
                points.append(np.array([curve.Value(t).Coord() for t in np.linspace(first, last, count)]))
                uvs.append(np.full((count, 2), np.nan))
                owner.append(np.full(count, -1))
        self.point, self.uv, self.owner = np.concatenate(points), np.concatenate(uvs), np.concatenate(owner)
        # Boxes of points, each with the ball about its middle that holds them.
        key = np.unique(np.floor(self.point / BOX).astype(np.int64), axis=0, return_inverse=True)[1].ravel()
        order = np.argsort(key, kind="stable")
        self.point, self.uv, self.owner, key = self.point[order], self.uv[order], self.owner[order], key[order]
        start = np.flatnonzero(np.r_[True, np.diff(key) > 0])
        self.ends = np.r_[start, len(key)]
        low, high = np.minimum.reduceat(self.point, start), np.maximum.reduceat(self.point, start)
        self.middle = 0.5 * (low + high)
        self.ball = np.sqrt(np.maximum.reduceat(((self.point - self.middle[key]) ** 2).sum(axis=1), start))

    @staticmethod
    def _lines(surface: Any, low: Floats, high: Floats, step: float) -> Ints:
        """Lines across a face each way, by the lengths of three curves."""
        counts = []
        for way in (0, 1):
            length = 0.0
            for share in (0.05, 0.5, 0.95):
                uv = np.tile(low + share * (high - low), (40, 1))
                uv[:, way] = np.linspace(low[way], high[way], 40)
                line = np.array([surface.Value(*each).Coord() for each in uv.tolist()])
                length = max(length, float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()))
            counts.append(int(np.clip(length / step, 3, LINES)) + 1)
        return np.array(counts)

    def at(self, number: int, uv: Floats) -> Floats:
        """Points (n, 3) of a face."""
        value = self.value[number]
        return np.array([value(u, v).Coord() for u, v in uv.tolist()]).reshape(-1, 3)

    def near(self, middles: Ints) -> Ints:
        """The points in boxes."""
        return np.concatenate([np.arange(self.ends[k], self.ends[k + 1]) for k in middles] or [np.zeros(0, int)])


def _parts(shape: Any, kind: Any) -> list[Any]:
    """The faces or the edges of a shape."""
    found, explorer = [], TopExp_Explorer(shape, kind)
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


class Posture:
    """A tool at a contact."""

    def __init__(self, tool: Any, rest: float, contact: Floats, normal: Floats, aside: Floats, axis: Floats) -> None:
        across = axis - (normal @ axis) * normal
        length = float(np.linalg.norm(across))
        lean = aside if length <= 1e-12 else across / length
        tilt = float(np.arctan2(length, normal @ axis))
        # A bottom that lies on the plane touches with its rim, a flank that lies along it with its lower end.
        tilt = np.pi / 2 if abs(tilt - np.pi / 2) < 1e-8 else tilt
        self.tool, self.rest = tool, rest
        self.tip, self.rows = tool.frame(contact, normal, lean, tilt, np.pi / 4)

    def depth(self, points: Floats) -> Floats:
        """How deep points lie in what cuts, or nearer to the rest than its clearance, mm; minus the distance outside."""
        x, y, w = ((points - self.tip) @ self.rows.T).T
        return np.asarray(self.tool.over(np.hypot(x, y), w, 0.0, self.rest))

    def deepest(self, faces: Faces) -> tuple[float, Ints]:
        """The largest depth at the points of faces, and the points that lie within a step of the tool or in it."""
        x, y, w = ((faces.middle - self.tip) @ self.rows.T).T
        reach = faces.ball - self.rest + STEP
        close = np.flatnonzero((w > -reach) & (w < self.tool.end + reach) & (np.hypot(x, y) < self.tool.wide + reach))
        close = close[self.depth(faces.middle[close]) > -faces.ball[close] - STEP] if len(close) else close
        points = faces.near(close)
        if not len(points):
            return -np.inf, points
        depth = self.depth(faces.point[points])
        kept = np.flatnonzero(depth > -STEP)
        return float(depth.max()), points[kept[np.argsort(-depth[kept])]]

    def closely(self, faces: Faces, points: Ints) -> float:
        """The largest depth about the deepest points, each of another place, by ever finer grids."""
        best, seen = -np.inf, np.zeros((0, 3))
        for k in points[faces.owner[points] >= 0].tolist():
            if len(seen) >= PLACES:
                break
            if len(seen) and np.linalg.norm(seen - faces.point[k], axis=1).min() < 3 * STEP:
                continue
            seen = np.vstack([seen, faces.point[k]])
            face, uv = int(faces.owner[k]), faces.uv[k]
            low, high, step = faces.span[face]
            for _ in range(ROUNDS):
                grid = uv + np.stack(np.meshgrid(*[np.linspace(-1, 1, NODES)] * 2), -1).reshape(-1, 2) * step
                grid = np.clip(grid, low, high)
                found = self.depth(faces.at(face, grid))
                inside = (i for i in np.argsort(-found) if faces.inside[face](gp_Pnt2d(*grid[i].tolist())) != TopAbs_OUT)
                first = next(inside, None)
                if first is None:
                    break
                uv, step = grid[first], step / 3
                best = max(best, float(found[first]))
        return best


def rejudged(case: Case, folder: Path) -> bool:
    """Plan a case and judge its operations again; print what was found; whether all of it holds."""
    from tests.support.tool_reference import Reference

    part = read_part(folder / case.file)
    vises = [vise(part.shape, axis, depth) for axis, depth in case.setups]
    places = [
        Placement(z=axis, fixtures=(Fixture(body, name=f"vise{k}"),))
        for k, ((axis, _), body) in enumerate(zip(case.setups, vises, strict=True), 1)
    ]
    began = time.process_time()
    result = plan(part, cutters=list(case.cutters), holder=HOLDER, machine=case.machine, setup=places[0],
                  other_setups=places[1:], faces="all", operations="both", feed=2000.0, area_budget=0, **case.more)  # fmt: skip
    tools = {entry.id: result.judged(entry.id) for entry in result.cutters}
    took = time.process_time() - began
    began = time.process_time()
    obstacles = [Faces([(part.shape, STEP), (body, 2 * STEP)]) for body in vises]
    references = {name: Reference(tool) for name, tool in tools.items()}
    tolerance, ok = result.plan.effective.tolerance_mm, True
    known: dict[tuple[Any, ...], tuple[float, Ints, Posture]] = {}
    for entry, made in zip(result.plan.operations.plans, result.answers.operations.plans, strict=True):
        judged, deepest, looked = 0, -np.inf, 0
        for k, operation in enumerate(entry.operations):
            rows = np.flatnonzero(made.label == k)
            axes = _axes(case, result, operation, rows)
            faces, found = obstacles[operation.setup], []
            for row, axis in zip(rows.tolist(), axes, strict=True):
                key = (operation.cutter, operation.setup, tuple(axis), tuple(made.lean[row]), row)
                if key not in known:
                    put = _put(result, references, tools, operation.cutter, row, axis, made.lean[row])
                    known[key] = (*put.deepest(faces), put)
                found.append(known[key])
            worst = sorted(found, key=lambda each: -each[0])[:CLOSELY]
            fine = max((put.closely(faces, points) for _, points, put in worst), default=-np.inf)
            deep = max(fine, max((each[0] for each in found), default=-np.inf))
            judged, deepest, looked = judged + len(rows), max(deepest, deep), looked + len(worst)
            if deep > tolerance:
                ok = False
                print(f"  WRONG: {operation.id} of {entry.name}, {deep:.4f} mm deep", flush=True)
        hit, tried = _refused(case, result, entry, made, (references, tools, obstacles))
        print(f"{case.file:30} {entry.name:14} {len(entry.operations):3} operations  {judged:6} samples  {looked:5} closely  "
              f"deepest {deepest:8.5f} mm of {tolerance:g}  refused: {hit} of {tried} deep", flush=True)  # fmt: skip
    print(f"{'':30} {len(result.samples)} samples, {len(obstacles[0].point)} points; processor s: plan {took:.0f}, "
          f"check {time.process_time() - began:.0f}", flush=True)  # fmt: skip
    return ok


def _put(
    result: Result, references: Any, tools: dict[str, Cutter], name: str, row: int, axis: Floats, lean: Floats | None = None
) -> Posture:  # fmt: skip
    samples = result.samples
    normal, aside = samples.normal[row], samples.direction_max[row]
    # A cutter that stands upright touches with the side that is written, its bottom across the axis.
    if lean is not None and np.isfinite(lean).all() and normal @ axis > np.cos(UPRIGHT):
        normal, aside = axis, lean
    return Posture(references[name], -(tools[name].clearance or 0.0), samples.point[row], normal, aside, axis)


def _axes(case: Case, result: Result, operation: Any, rows: Ints) -> Floats:
    """The tool axis at samples: by the written angles or, where it is simultaneous, as each was found."""
    if operation.mode != "fixed":
        found = result.over_setups.each[operation.setup][1]
        return np.asarray(found[operation.cutter].axis[rows])
    angles = np.radians(list(operation.angles_deg.values()))
    axis = np.array(AXES[case.machine](*angles)) @ frame(case.setups[operation.setup][0])
    assert np.abs(axis - operation.axis).max() < 1e-12, "the written axis is not that of the written angles"
    return np.broadcast_to(axis, (len(rows), 3))


def _refused(case: Case, result: Result, entry: Any, made: Any, with_what: Any) -> tuple[int, int]:
    """Of samples and operations that do not serve them though they face them, how many are deep, and how many there were."""
    references, tools, obstacles = with_what
    rng, hit, pairs = np.random.default_rng(0), 0, []
    for k, operation in enumerate(entry.operations):
        if operation.mode == "fixed":
            facing = result.samples.normal @ np.array(operation.axis) > 0.02
            pairs += [(k, row) for row in np.flatnonzero(facing & (made.label >= 0) & ~made.serves[:, k])]
    chosen = rng.choice(len(pairs), min(REFUSED, len(pairs)), replace=False) if pairs else []
    for k, row in (pairs[i] for i in chosen):
        operation = entry.operations[k]
        put = _put(result, references, tools, operation.cutter, row, _axes(case, result, operation, np.array([row]))[0])
        depth, points = put.deepest(obstacles[operation.setup])
        hit += max(depth, put.closely(obstacles[operation.setup], points)) > 1e-4
    return hit, len(chosen)


def main() -> int:
    """Judge each case again."""
    words = argparse.ArgumentParser()
    words.add_argument("folder", type=Path)
    words.add_argument("cases", nargs="*", help=f"of {', '.join(CASES)}; a part of a name will do")
    words.add_argument("--coarse", action="store_true", help="samples three times as far apart")
    given = words.parse_args()
    sys.path.insert(0, str(Path(__file__).parents[1]))
    ok = True
    for name, case in CASES.items():
        if given.cases and not any(each in name for each in given.cases):
            continue
        if given.coarse:
            case.more["spacing"] *= 3
        print(f"{name}:", flush=True)
        ok &= rejudged(case, given.folder)
    return 0 if ok else 1


if __name__ == "__main__":
    sys.exit(main())
