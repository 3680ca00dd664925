"""What compiling costs: a first-ever run with an empty cache of kernels, and runs after it.

`python benchmarks/startup.py` prints a table of processor seconds: each entry point on its own in a fresh process, then
`plan` whole. The input is one planar face, so that next to nothing but start-up is left.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

HEAD = "import time; from pathlib import Path; import numpy as np; one = np.zeros((1, 3, 3)); none = np.empty(0, np.int64)\n"
#: A cutter as kernels take it; written out, so that nothing else is loaded.
FLAT = (
    "from plan_cutters.kernels.rows import Tool\n"
    "piece = np.array([[[0.0, 0.01, 8.99, 0.99, 0.0, 0.0, 1.0, 0.01, 8.99, 0.99, 0.0]]])\n"
    "tool = Tool(piece, np.array([[1.0, 0.0, 0.0, 1.5, 0.0]]), 2.0, 4.5, 8.99)\n"
)

#: What each process does; it prints its own seconds.
ENTRIES = {
    "import of the compiler": "import numba",
    "tree.build": "from plan_cutters.kernels.linear.tree import build; build(one)",
    "search, probe, dummy_clear": (
        f"{FLAT}"
        "from plan_cutters.kernels.search import search as s; from plan_cutters.kernels.linear.tree import build\n"
        "from plan_cutters.kernels.rows import Contacts, Ranges, Tree, VerdictArrays\n"
        "_, box, depth = build(one); p, c, n = np.zeros((1, 3)), np.zeros((1, 2)), np.zeros(1)\n"
        "i, b = np.zeros(1, np.int32), np.zeros(1, np.uint8)\n"
        "t, a = Tree(one, box, depth), Contacts(p, p, p, c)\n"
        "from plan_cutters.kernels.material import sheet; w = sheet(t)\n"
        "from plan_cutters.scene.conditions import rotary_of\n"
        "s.dummy_clear(none, a, tool.piece[0], tool, w, np.zeros(1, bool))\n"
        "s.probe(none, p, p, p, p, tool, t, i, i)\n"
        "ranges, found = Ranges(n, n, 0.0, 1.5, np.zeros(3), -2.0, rotary_of(None)), VerdictArrays(b, p, p, n, i, b)\n"
        "s.search(none, a, ranges, tool, tool, w, w, found)"
    ),
    "free_tilts": (
        f"{FLAT}"
        "from plan_cutters.kernels.maps.free_tilts import free_tilts; from plan_cutters.kernels.linear.tree import build\n"
        "from plan_cutters.kernels.rows import Tree; _, box, depth = build(one); z = np.zeros(3)\n"
        "free_tilts(z, z, z, 0.0, 1.5, tool, 0, 0.1, Tree(one, box, depth), 9)"
    ),
    "plan of one plane": (
        "from plan_cutters import Cutter, plan; import build123d as b\n"
        "began = time.process_time()\n"
        "plan(b.Face.make_rect(20, 20), cutters=[Cutter.flat(radius=2, length=30)], grid=3, jobs=1)"
    ),
    "the same with posture maps": (
        "from plan_cutters import Cutter, plan; import build123d as b\n"
        "began = time.process_time()\n"
        "plan(b.Face.make_rect(20, 20), cutters=[Cutter.flat(radius=2, length=30)], grid=3, jobs=1, posture_maps=True)"
    ),
}


def seconds(body: str, cache: Path) -> float:
    """Processor seconds of the body in a fresh process, the interpreter's own start left out."""
    text = f"{HEAD}began = time.process_time()\n{body}\nprint(time.process_time() - began)"
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache)}
    run = subprocess.run([sys.executable, "-c", text], env=environment, check=True, capture_output=True, text=True)
    return float(run.stdout)


def size(folder: Path) -> float:
    return sum(f.stat().st_size for f in folder.rglob("*") if f.is_file()) / 1e6


def main() -> None:
    print("| entry point | first run s | later runs s (best of 3) | cache MB |\n|---|---|---|---|")
    for name, body in ENTRIES.items():
        with tempfile.TemporaryDirectory() as folder:
            cache = Path(folder)
            first = seconds(body, cache)
            later = min(seconds(body, cache) for _ in range(3))
            print(f"| {name} | {first:.1f} | {later:.2f} | {size(cache):.1f} |", flush=True)


if __name__ == "__main__":
    main()
