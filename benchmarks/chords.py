"""Does the stated chord error hold for every exact surface point of a face? Slow, and sharing no code with the program.

For each face, points of the true border curves, points pulled inwards from them by steps from 1e-6 mm up, points beside
the ends of the curves and points all over the inside; each one's exact distance from the triangles of that face.

    python benchmarks/chords.py [--chord MM] [--points N] [FILE ...]

Without files: solids of planes, quadrics and tori cut by each other, made here.
"""

import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba
import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt2d, gp_Vec2d
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FORWARD, TopAbs_IN, TopAbs_REVERSED
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS
from scipy.spatial import cKDTree

from cad_io import Part, read_part
from cad_io.arrays import Floats, Triangles
from cad_io.tessellate import tessellate

#: Steps inwards from the border, mm, and where along each curve points stand densely.
STEPS = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3)
CLOSE = (1e-5, 1e-4, 1e-3, 1e-2)
NEAR, FINE = 6, 20_000


@numba.njit(cache=False, fastmath=False)
def _square(p, a, b, c):
    """Squared distance of a point from a triangle."""
    ab, ac, ap = b - a, c - a, p - a
    best = np.inf
    for s, e in ((a, b), (b, c), (c, a)):
        along, away = e - s, p - s
        length = (along * along).sum()
        t = 0.0 if length <= 0.0 else min(1.0, max(0.0, (along * away).sum() / length))
        off = away - t * along
        best = min(best, (off * off).sum())
    d00, d01, d11 = (ab * ab).sum(), (ab * ac).sum(), (ac * ac).sum()
    d20, d21 = (ap * ab).sum(), (ap * ac).sum()
    det = d00 * d11 - d01 * d01
    if det > 1e-14 * d00 * d11:
        s, t = (d11 * d20 - d01 * d21) / det, (d00 * d21 - d01 * d20) / det
        if s >= 0.0 and t >= 0.0 and s + t <= 1.0:
            off = ap - s * ab - t * ac
            best = min(best, (off * off).sum())
    return best


@numba.njit(cache=False, nogil=True)
def _farther(points, triangles, middle, radius, near, promise):
    """Distance of each point from a soup; not looked at further once it is within the promise."""
    found = np.empty(len(points))
    for i in range(len(points)):
        p, best = points[i], np.inf
        for k in near[i]:
            best = min(best, _square(p, triangles[k, 0], triangles[k, 1], triangles[k, 2]))
        if best > promise * promise:
            for k in range(len(triangles)):
                reach = np.sqrt(best) + radius[k]
                x, y, z = p[0] - middle[k, 0], p[1] - middle[k, 1], p[2] - middle[k, 2]
                if x * x + y * y + z * z < reach * reach:
                    best = min(best, _square(p, triangles[k, 0], triangles[k, 1], triangles[k, 2]))
                    if best <= promise * promise:
                        break
        found[i] = np.sqrt(best)
    return found


def distances(points: Floats, triangles: Floats, promise: float) -> Floats:
    """Distance of points from a soup of triangles, exact where it is beyond the promise."""
    middle = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - middle[:, None], axis=2).max(axis=1)
    near = cKDTree(middle).query(points, k=min(NEAR, len(triangles)))[1].reshape(len(points), -1)
    order = np.argsort(-radius)  # large ones are likely to be near, whatever their middles say
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    return np.asarray(_farther(points, triangles[order], middle[order], radius[order], back[near], promise))


def border_edges(face: Any) -> list[Any]:
    """Edge uses that bound a face."""
    edges, explorer = [], TopExp_Explorer(face, TopAbs_EDGE)
    while explorer.More():
        edge = TopoDS.Edge_s(explorer.Current())
        if edge.Orientation() in (TopAbs_FORWARD, TopAbs_REVERSED):
            edges.append(edge)
        explorer.Next()
    return edges


def exact_points(part: Part, number: int, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Parameters (n, 2) and points (n, 3) of a face: border, beside it, ends, inside."""
    face = TopoDS.Face_s(part.face(number).Oriented(TopAbs_FORWARD))
    surface, classify = BRepAdaptor_Surface(face, False), BRepTopAdaptor_FClass2d(face, 1e-9)
    trim = part.trim(number)
    if trim is None:
        return np.zeros((0, 2)), np.zeros((0, 3))
    edges = border_edges(face)
    kept: list[tuple[float, float]] = []
    asked: list[tuple[float, float]] = []
    each = max(8, count // (2 * len(edges)))
    per_u, per_v = trim.scale
    for edge in edges:
        curve = BRepAdaptor_Curve2d(edge, face)
        low, high = curve.FirstParameter(), curve.LastParameter()
        ends = [share if side else 1 - share for share in CLOSE for side in (0, 1)]
        for k, share in enumerate([*rng.uniform(0, 1, each), *np.linspace(0, 1, 65), *ends]):
            point, along = gp_Pnt2d(), gp_Vec2d()
            curve.D1(low + (high - low) * float(share), point, along)
            (u, v), (du, dv) = point.Coord(), along.Coord()
            kept.append((u, v))
            x, y = du * per_u, dv * per_v
            length = np.hypot(x, y)
            if length > 0:
                for sign in (-1, 1):
                    step = sign * STEPS[k % len(STEPS)]
                    asked.append((u - step * y / length / per_u, v + step * x / length / per_v))
    u0, u1, v0, v1 = trim.box
    asked += list(zip(rng.uniform(u0, u1, count // 2).tolist(), rng.uniform(v0, v1, count // 2).tolist(), strict=True))
    kept += [uv for uv in asked if u0 <= uv[0] <= u1 and v0 <= uv[1] <= v1
             and classify.Perform(gp_Pnt2d(*uv)) == TopAbs_IN]  # fmt: skip
    value = surface.Value
    return np.array(kept), np.array([value(u, v).Coord() for u, v in kept])


def truly_inside(part: Part, number: int, uv: Floats) -> Any:
    """Which points lie on a border curve, or on the face's side of the curve that is nearest to them."""
    face, trim = TopoDS.Face_s(part.face(number).Oriented(TopAbs_FORWARD)), part.trim(number)
    nearest, inner = np.full(len(uv), np.inf), np.zeros(len(uv), bool)
    for edge in border_edges(face) if len(uv) else ():
        curve = BRepAdaptor_Curve2d(edge, face)
        t = np.linspace(curve.FirstParameter(), curve.LastParameter(), FINE + 1)
        line = np.array([curve.Value(x).Coord() for x in t.tolist()]) * trim.scale
        line = line if edge.Orientation() == TopAbs_FORWARD else line[::-1]
        start, along = line[:-1], np.diff(line, axis=0)
        for k, point in enumerate(uv * trim.scale):
            share = np.clip(((point - start) * along).sum(1) / np.maximum((along**2).sum(1), 1e-300), 0, 1)
            away = point - start - share[:, None] * along
            off = np.linalg.norm(away, axis=1)
            i = int(off.argmin())
            if off[i] < nearest[k]:
                nearest[k] = off[i]
                inner[k] = off[i] < 1e-9 or along[i, 0] * away[i, 1] > along[i, 1] * away[i, 0]
    return inner


def violations(part: Part, triangles: Triangles, count: int, seed: int = 0) -> Iterator[tuple[int, int, float, Any]]:
    """Of each face: number, points looked at, largest distance, parameters of that point."""
    rng = np.random.default_rng(seed)
    missing = dict(triangles.missing)
    promise = triangles.chord_error + 1e-9
    for info in part.faces:
        if info.unjudged is not None or info.number in missing:
            continue
        uv, points = exact_points(part, info.number, count, rng)
        good = np.isfinite(points).all(axis=1)
        if good.any():
            mine = np.ascontiguousarray(triangles.vertex[triangles.face == info.number])
            off = distances(points[good], mine, promise)
            # The kernel's classifier is a polygon itself: what is too far is asked of a finer one.
            far = np.flatnonzero(off > promise)
            off[far[~truly_inside(part, info.number, uv[good][far])]] = 0.0
            yield info.number, int(good.sum()), float(off.max()), uv[good][off.argmax()]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--chord", type=float)
    parser.add_argument("--points", type=int, default=3000, help="a face")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    if given.files:
        parts = ((path.name, lambda path=path: read_part(path)) for path in given.files)
    else:
        sys.path.append(str(Path(__file__).resolve().parents[1]))
        from tests.support.moulds import MOULDS

        parts = ((name, lambda make=make: read_part(make())) for name, make in MOULDS.items())
    bad = 0
    for name, make in parts:
        try:
            part = make()
        except Exception as error:
            print(f"{name}: {error}")
            continue
        chord = given.chord or 1e-4 * float(np.linalg.norm(part.size))
        began = time.perf_counter()
        triangles = tessellate(part, chord)
        seconds = time.perf_counter() - began
        looked, worst, lines = 0, 0.0, []
        for number, count, off, uv in violations(part, triangles, given.points, given.seed):
            looked += count
            worst = max(worst, off / max(triangles.chord_error, 1e-9))
            if off > triangles.chord_error + 1e-9:
                lines.append(f"    F{number} {part.faces[number - 1].surface}: {off:.6g} mm at {uv}")
        bad += len(lines)
        print(f"{name}: {len(triangles)} triangles in {seconds:.2f} s, stated {triangles.chord_error:.4g} of {chord:.4g} "
              f"mm; {looked} points, farthest {worst:.3f} times the stated, missing {len(triangles.missing)}")  # fmt: skip
        print("\n".join(lines), end="\n" if lines else "", flush=True)
    print(f"{bad} faces beyond the stated distance")
    return int(bad > 0)


if __name__ == "__main__":
    raise SystemExit(main())
