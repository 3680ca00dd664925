"""Plan every CAD file of a folder with one cutter, read the annotated STEP back, and write what became of each.

`python benchmarks/real_files.py FOLDER report.md` runs the command as a user would, one file at a time.
"""

import json
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.GeomAbs import GeomAbs_CN
from OCP.gp import gp_Pnt2d, gp_Vec2d

from cad_io import Part, read_part
from cad_io.face.trim import boundary
from cad_io.kernel import first_derivatives, interval_ends

CUTTER, LIMIT = "R3L40", 300
SUFFIXES = {".step", ".stp", ".iges", ".igs", ".brep"}


def row(file: Path, out: Path) -> list[str]:
    began = time.perf_counter()
    try:
        done = subprocess.run([sys.executable, "-m", "plan_cutters", str(file), "--cutter", CUTTER, "-o", str(out)],
                              capture_output=True, text=True, timeout=LIMIT, check=False)  # fmt: skip
    except subprocess.TimeoutExpired:
        return [file.name, "-", f"> {LIMIT}", "", "", "", "", "", "not finished in time"]
    seconds = f"{time.perf_counter() - began:.1f}"
    if not (out / "plan.json").exists():
        said = done.stderr.strip().splitlines()[-1].removeprefix("plan-cutters: ").replace(f"{file}: ", "")
        return [file.name, str(done.returncode), seconds, "", "", "", "", "", said]
    plan = json.loads((out / "plan.json").read_text())
    faces, entry = plan["faces"], plan["cutters"][0]
    targets = [f for f in faces if f["target"]]
    unjudged = [f for f in targets if not f["samples"]]
    assert len(faces) == plan["part"]["faces"]
    assert all(f["unjudged"] for f in unjudged), "a face was dropped without a word"
    size = " x ".join(f"{s:.4g}" for s in plan["part"]["size_mm"])
    counts = " / ".join(str(entry[k]) for k in ("interference_free", "accessible", "undecided", "inaccessible", "unjudged"))
    notes = [*plan["part"]["warnings"], *(f"{k} {v['rung']}: {v['why']}" for k, v in plan["split"].items() if v["why"])]
    return [
        file.name, str(done.returncode), seconds, size, str(len(faces)), f"{len(targets) - len(unjudged)} + {len(unjudged)}",
        counts, f"{plan['effective']['tolerance_mm']:.3g}", "; ".join(notes)[:240],
    ]  # fmt: skip


def read_back(file: Path, out: Path) -> list[str] | None:
    """How the mixed faces were split, and what another reading of the annotated STEP finds."""
    if not (out / "annotated.step").exists():
        return None
    plan = json.loads((out / "plan.json").read_text())
    rungs = Counter(entry["rung"] for entry in plan["split"].values())
    part, again = read_part(file), read_part(out / "annotated.step")
    contour = [face for face, entry in plan["split"].items() if entry["rung"] == "contour"]
    area: Counter[str] = Counter()
    wrong = 0
    for face in again.faces:
        match = re.match(r"(F\d+)_([a-z_]+)", face.name)
        known = match and match[1] in {f["id"] for f in plan["faces"]}
        wrong += not known or not (match[2] == "check" or _same(face.colour, plan["legend"].get(match[2])))
        if match and match[1] in contour:
            area[match[1]] += exact_area(again.face(face.number))
    off = [abs(area[n] / exact_area(part.face(int(n[1:]))) - 1) for n in contour]
    valid = ["valid" if BRepCheck_Analyzer(p.shape).IsValid() else "invalid" for p in (part, again)]
    return [
        file.name, str(sum(rungs.values())), str(rungs["contour"]), str(rungs["beside"]), str(rungs["whole"]),
        f"{max(off):.1e}" if off else "", " > ".join(valid), f"{part.solids} > {again.solids}",
        f"{len(list(_leaves(part)))} > {len(list(_leaves(again)))}", str(len(again.faces)), str(wrong),
    ]  # fmt: skip


def exact_area(face: Any) -> float:
    """Area by Green's theorem: Gauss nodes on the true border curves and, along u, between all knots; mm2."""
    adaptor = BRepAdaptor_Surface(face, False)
    nodes, weights = np.polynomial.legendre.leggauss(6)
    border = []
    for curve, ends, sign in boundary(face):
        ends = np.unique(np.concatenate([np.linspace(a, b, 5) for a, b in pairwise(ends)]))
        t = (0.5 * (ends[1:] + ends[:-1]))[:, None] + 0.5 * np.diff(ends)[:, None] * nodes
        w = np.broadcast_to(0.5 * np.diff(ends)[:, None] * weights, t.shape)
        point, tangent = gp_Pnt2d(), gp_Vec2d()
        for x, share in zip(t.ravel().tolist(), w.ravel().tolist(), strict=True):
            curve.D1(x, point, tangent)
            border.append((point.X(), point.Y(), sign * share * tangent.Y()))
    u, v, dv = np.array(border).T
    knots = np.union1d([u.min(), u.max()], interval_ends(adaptor.NbUIntervals(GeomAbs_CN), adaptor.UIntervals, GeomAbs_CN))
    knots = knots[(knots >= u.min()) & (knots <= u.max())]
    total = 0.0
    for a, b in pairwise(knots.tolist()):
        end = np.clip(u, a, b)
        for x, w in zip(nodes.tolist(), weights.tolist(), strict=True):
            d = first_derivatives(adaptor, a + 0.5 * (x + 1) * (end - a), v)
            total += float((0.5 * w * (end - a) * dv * np.linalg.norm(np.cross(d[:, 1], d[:, 2]), axis=1)).sum())
    return abs(total)


def _leaves(part: Part) -> Iterator[Any]:
    return (leaf for root in part.tree for leaf in root.leaves() if leaf[0].faces)


def _same(colour: tuple[float, ...] | None, legend: str | None) -> bool:
    if colour is None or legend is None:
        return False
    return all(abs(c - b / 255) < 3e-3 for c, b in zip(colour, bytes.fromhex(legend[1:]), strict=True))


def main(folder: str, target: str) -> None:
    files = sorted(f for f in Path(folder).rglob("*") if f.suffix.lower() in SUFFIXES)
    rows, read = [], []
    with tempfile.TemporaryDirectory() as scratch:
        for i, file in enumerate(files):
            rows.append(row(file, Path(scratch) / str(i)))
            print(" | ".join(rows[-1]), flush=True)
            if again := read_back(file, Path(scratch) / str(i)):
                read.append(again)
                print(" | ".join(again), flush=True)
    head = ["file", "exit", "seconds", "size mm", "faces", "targets judged + unjudged",
            "free / accessible / undecided / inaccessible / unjudged samples", "tolerance mm", "said"]  # fmt: skip
    back = ["file", "mixed faces", "contour", "beside", "whole", "largest difference of a split face's area", "BRepCheck",
            "solids", "products", "faces read back", "with wrong name or colour"]  # fmt: skip
    mixed, contour = (sum(int(r[i]) for r in read) for i in (1, 2))
    lines = [
        "# Real files",
        "",
        f"Made by `python benchmarks/real_files.py`: each file planned with `--cutter {CUTTER}` and default spacing.",
        "Exit codes: 0 feasible, 1 not feasible, 3 refused, 4 feasible as far as judged.",
        "",
        *_table(head, rows),
        "",
        "## The annotated STEP, read back",
        "",
        f"{contour} of {mixed} faces of mixed verdicts are split in their place ({100 * contour / max(mixed, 1):.1f} %).",
        "`beside`: split as a copy of the face; `whole`: coloured whole. Areas by our own quadrature, relative;",
        "`>` leads from the file read to the file written.",
        "",
        *_table(back, read),
    ]
    Path(target).write_text("\n".join(lines) + "\n")


def _table(head: list[str], rows: list[list[str]]) -> list[str]:
    return ["| " + " | ".join(cells) + " |" for cells in (head, ["---"] * len(head), *rows)]


if __name__ == "__main__":
    main(*sys.argv[1:3])
