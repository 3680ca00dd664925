"""What a point on a surface costs: ours against the CAD kernel's, in one run, one thread, processor time.

`python benchmarks/surfaces.py [FILE ...]` prints a row for the first face of each kind of surface in the files (default: the
sample parts), and how many samples a second are taken, curvature included, on `peaks_and_valleys.step`.
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from cad_io import Part, read_part
from cad_io.face.curvature import curvature
from cad_io.kernel import second_derivatives, values
from cad_io.part.bodies import orient
from cad_io.sample import sample

SAMPLES = Path(__file__).parents[1] / "samples"
POINTS, OF_THE_KERNEL, GRID = 200_000, 20_000, 1001


def seconds(work: Callable[[], object]) -> float:
    """Processor seconds, best of three."""
    found = []
    for _ in range(3):
        began = time.process_time()
        work()
        found.append(time.process_time() - began)
    return min(found)


def row(part: Part, number: int) -> str:
    """Microseconds a point of one face."""
    surface, trim = part.surface(number), part.trim(number)
    assert trim is not None
    rng = np.random.default_rng(0)
    u, v = rng.uniform(trim.box[0], trim.box[1], POINTS), rng.uniform(trim.box[2], trim.box[3], POINTS)
    fewer_u, fewer_v = u[:OF_THE_KERNEL], v[:OF_THE_KERNEL]
    derivatives = surface.second(u, v)
    ours = [seconds(lambda: surface.values(u, v)), seconds(lambda: surface.second(u, v)), seconds(lambda: curvature(derivatives))]
    theirs = [
        seconds(lambda: values(surface.adaptor, fewer_u, fewer_v)),
        seconds(lambda: second_derivatives(surface.adaptor, fewer_u, fewer_v)),
    ]
    cells = [f"{1e6 * each / POINTS:.2f}" for each in ours] + [f"{1e6 * each / OF_THE_KERNEL:.2f}" for each in theirs]
    return f"| {part.faces[number - 1].surface} | {' | '.join(cells)} |"


def main() -> None:
    print("| surface | values us | second derivatives us | curvature us | kernel's values us | kernel's second us |")
    print("|---|---|---|---|---|---|")
    seen: set[str] = set()
    for file in sys.argv[1:] or sorted(map(str, SAMPLES.glob("*.step"))):
        part = read_part(file)
        for face in part.faces:
            if face.unjudged is None and face.surface not in seen:
                seen.add(face.surface)
                print(row(part, face.number), flush=True)
    part = read_part(SAMPLES / "peaks_and_valleys.step")
    side = orient(part, towards=(0.0, 0.0, 1.0), flip=False)
    taken = seconds(lambda: sample(part, side, grid=GRID, spacing=None, faces=[1]))
    print(f"\n{GRID * GRID} samples with curvature: {taken:.2f} s, {GRID * GRID / taken:.3g} a second")


if __name__ == "__main__":
    main()
