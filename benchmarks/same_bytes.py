"""Hashes of all that the program answers on the sample parts and on real files: equal ones before and after a change that
is to change nothing.

    python benchmarks/same_bytes.py ../shared/data/cad ../shared/data/cad/hard > after.txt
    (in a worktree of the former commit) python benchmarks/same_bytes.py ../shared/data/cad ../shared/data/cad/hard > before.txt
    diff before.txt after.txt

A line each: part, what, the first 16 digits of its SHA-256. `plan.json` counts without its `run` and without prose: `text`, and
strings that have a blank in them; names, codes and numbers count. Of a second folder all files are planned, with one cutter.
"""

import hashlib
import json
import math
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from cad_io import CadIoError, read_part
from plan_cutters import PlanError, plan, posture_map

SAMPLES = Path(__file__).parents[1] / "samples"
#: Solids, an assembly, IGES surfaces without a solid, a body with bodies inside, faces that fall apart.
REAL = ("asitus_ANC101-ill.stp", "occt_linkrods.step", "bladex_upper.iges", "axom_boxed_sphere.step", "trimesh_featuretype.STEP")
CUTTERS = ("R6L60", "R3L40", "R1.5L25")


def main() -> None:
    real = [Path(sys.argv[1]) / name for name in REAL] if len(sys.argv) > 1 else []
    for path in (*sorted(SAMPLES.glob("*.step")), *real):
        part = read_part(path)
        result = plan(part, cutters=CUTTERS, posture_maps=path.parent == SAMPLES, area_budget=20_000)
        with tempfile.TemporaryDirectory() as folder:
            result.write(folder, ("json", "step", "glb", "npz", "merged"))
            for file in sorted(Path(folder).iterdir()):
                _say(path, file.name, _content(file))
        contact = result.samples.point[len(result.samples) // 2].tolist()
        turns = [0.0, 1.0, math.pi / 2]
        for tolerance in (0.01, 0.0):
            one = posture_map(part, point=contact, cutter="R3L40", rotations=turns, tolerance=tolerance)
            fields = (getattr(one, name) for name in one.__slots__)
            _say(path, f"posture_map {tolerance:g}", b"".join(_bytes(value) for value in fields))
    for path in sorted(Path(sys.argv[2]).iterdir()) if len(sys.argv) > 2 else ():
        with tempfile.TemporaryDirectory() as folder:
            try:
                plan(path, cutters=CUTTERS[1:2], area_budget=0).write(folder, ("json", "step", "glb", "npz"))
            except (PlanError, CadIoError) as error:
                _say(path, "refused", type(error).__name__.encode())
            for file in sorted(Path(folder).iterdir()):
                _say(path, file.name, _content(file))


def _content(file: Path) -> bytes:
    """What must not change of a file."""
    if file.suffix != ".json":
        return file.read_bytes()
    document = json.loads(file.read_text())
    if "run" not in document:
        return file.read_bytes()
    # Checksums of files whose bytes have lines of their own here; texts may be reworded.
    for name in ("run", "text", "files"):
        document.pop(name, None)
    return json.dumps(_without_prose(document), sort_keys=True).encode()


def _without_prose(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_prose(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_without_prose(each) for each in value]
    return "" if isinstance(value, str) and " " in value else value


def _bytes(value: Any) -> bytes:
    if isinstance(value, tuple):
        return b"".join(_bytes(each) for each in value)
    return value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode()


def _say(path: Path, what: str, content: bytes) -> None:
    print(path.name, what, hashlib.sha256(content).hexdigest()[:16], flush=True)


if __name__ == "__main__":
    main()
