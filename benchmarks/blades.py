"""What a sample costs where the answer is no, on a drum with bent blades 3 mm apart, and on real files.

    python benchmarks/blades.py [FILE ...] [--cutter R3L40 ...]

prints processor time a sample, one thread, 36 rotations: of those that are reached, of those that are not (what lies within
another body left out), and what the witnesses cost in all. With no file, the drum: eight blades, each lofted through four
closed splines, bent and twisted, every 9 deg on a drum of 56 mm; tips on 96 mm.
"""

import argparse
import math
import time
from pathlib import Path
from typing import Any

import numpy as np

BLADES, PITCH, HUB, TIP, LONG = 8, 9.0, 28.0, 48.0, 44.0
#: Thickness of a blade at hub and tip, turn of its section from end to end of the blade and from hub to tip, rad.
THICK, BEND, TWIST = (1.2, 0.8), 0.55, 0.35


def section(radius: float) -> Any:
    """The closed spline that a blade has at a radius, laid on the cylinder of that radius about z."""
    import cadquery as cq

    share = (radius - HUB) / (TIP - HUB)
    thick = THICK[0] + share * (THICK[1] - THICK[0])
    along = np.concatenate([np.linspace(-1, 1, 9), np.linspace(1, -1, 9)[1:-1]])
    side = np.concatenate([-np.ones(9), np.ones(7)])
    side[[0, 8]] = 0.0
    # Ends are rounded; the middle line bends within the section and turns from hub to tip.
    offset = 0.5 * thick * side * np.sqrt(1 - 0.8 * along**4)
    angle = BEND * along**2 * 0.5 + TWIST * share * along + offset / radius
    height = 0.5 * LONG * along * (1 - 0.1 * share)
    points = [cq.Vector(radius * math.cos(a), radius * math.sin(a), h) for a, h in zip(angle, height, strict=True)]
    return cq.Wire.assembleEdges([cq.Edge.makeSpline(points, periodic=True)])


def drum(blades: int = BLADES) -> Any:
    """Drum and blades as one compound of solids; the roots reach into the drum."""
    import cadquery as cq

    blade = cq.Solid.makeLoft([section(r) for r in np.linspace(HUB - 1.0, TIP, 4)])
    body = cq.Solid.makeCylinder(HUB, LONG + 16.0, cq.Vector(0, 0, -0.5 * LONG - 8.0))
    turned = [blade.rotate(cq.Vector(0, 0, 0), cq.Vector(0, 0, 1), PITCH * k) for k in range(blades)]
    return cq.Compound.makeCompound([body, *turned])


def ready(what: Any, cutter: str) -> Any:
    from plan_cutters.options import Options
    from plan_cutters.pipeline import prepare

    return prepare(what, Options(cutters=cutter, jobs=1, area_budget=0))


def measured(prepared: Any, cutter: Any) -> dict[str, float]:
    """Processor seconds of one cutter, and what they were spent on."""
    from plan_cutters.domain.verdicts import INACCESSIBLE, INSIDE, INTERFERENCE_FREE, UNDECIDED, blank
    from plan_cutters.judging.judge import judge
    from plan_cutters.judging.witness import witnesses
    from plan_cutters.scene.conditions import Context, contacts_of, search_postures

    samples, conditions = prepared.samples, prepared.conditions
    began = time.process_time()
    reach = judge(prepared, cutter)
    judged = time.process_time() - began
    not_reached = (reach.verdict == INACCESSIBLE) & ((reach.reason != INSIDE) | (prepared.inside < 0))
    contacts, seconds = contacts_of(samples), {}
    context = Context.of(cutter, conditions)
    groups = {"no": not_reached, "yes": reach.reached & (reach.verdict != INTERFERENCE_FREE)}
    for name, rows in groups.items():
        again = blank(len(samples))
        began = time.process_time()
        search_postures(contacts, np.flatnonzero(rows), context, again, fixed=True)
        seconds[name] = time.process_time() - began
    began = time.process_time()
    found = witnesses(samples, reach, context, inside=prepared.inside)
    told = time.process_time() - began
    return {
        "samples": len(samples), "triangles": len(conditions.obstacles.triangles),
        "reached": int(reach.reached.sum()), "inaccessible": int(not_reached.sum()),
        "undecided": int((reach.verdict == UNDECIDED).sum()), "buried": int((prepared.inside >= 0).sum()),
        "verdicts s": judged, "us a sample reached": 1e6 * seconds["yes"] / max(1, int(groups["yes"].sum())),
        "us a sample not": 1e6 * seconds["no"] / max(1, int(not_reached.sum())), "witnesses": len(found), "witnesses s": told,
    }  # fmt: skip


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("files", nargs="*")
    words.add_argument("--cutter", nargs="*", default=["R3L40", "R1.5L25"])
    asked = words.parse_args()
    from plan_cutters import Cutter

    for file in asked.files or [None]:
        prepared = ready(file or drum(), asked.cutter)
        name = Path(file).name if file else "drum"
        for k, cutter in enumerate(prepared.cutters):
            assert isinstance(cutter, Cutter)
            row = measured(prepared, cutter)
            if not k:
                print(f"\n| part | cutter | {' | '.join(row)} |\n| --- | --- |{' --- |' * len(row)}")
            cells = (f"{v:d}" if isinstance(v, int) else f"{v:.3g}" for v in row.values())
            print(f"| {name} | {cutter.id} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
