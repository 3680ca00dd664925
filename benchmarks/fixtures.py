"""What fixtures cost: the search of `samples/pocket_top.step` with and without a vise of 50,000 triangles, and other fixtures.

    python benchmarks/fixtures.py [SPACING]

Processor seconds of all threads, the best of five, in turn, machine code loaded before; and how many boxes and triangles the
search tests, counted on 400 samples in sequence without the compiler. A jaw stands on either side of the part, 9 mm below its
top.
"""

import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import trimesh

from plan_cutters import Cutter, Fixture, Options, Scene
from plan_cutters.domain.verdicts import UNJUDGED
from plan_cutters.judging.judge import judge
from plan_cutters.pipeline import prepare
from plan_cutters.scene.preparation import Prepared

ROOT = Path(__file__).parent.parent
sys.path.append(str(ROOT))
from tests.support.counted import counted  # noqa: E402
from tests.support.vises import vise  # noqa: E402

PART, CUTTERS = ROOT / "samples" / "pocket_top.step", ("R3L40", "R6L60", "R3L40F10S3HR15L40", "R6L60rc6")
WANTED, COUNTED, ROUNDS = 50_000, 400, 5


def vise_of(triangles: int) -> Fixture:
    """A vise of about so many triangles around the part, jaws 9 mm below its top."""
    longest = 100.0
    while len(found := vise((60.0, 40.0, 24.5), 15.5, longest=longest)) < triangles:
        longest *= 0.97
    return Fixture(trimesh.Trimesh(found.reshape(-1, 3), np.arange(3 * len(found)).reshape(-1, 3), process=False), name="vise")


def work(ready: Prepared, cutter: Cutter) -> dict[str, int]:
    """Boxes and triangles that the search of some samples in the middle of the face tests."""
    few = np.zeros_like(ready.samples.unjudged)
    few[len(few) // 2 : len(few) // 2 + COUNTED] = -1
    some = replace(ready, samples=replace(ready.samples, unjudged=few))
    with counted() as calls:
        reach = judge(some, cutter)
    assert (reach.verdict != UNJUDGED).any()
    return {"boxes": calls["alive"], "triangles": calls["triangle_hit"]}


def seconds(call: Callable[[], object]) -> float:
    began = time.process_time()
    call()
    return time.process_time() - began


def main() -> None:
    spacing = float(sys.argv[1]) if len(sys.argv) > 1 else 0.5
    options = {"cutters": CUTTERS[:2], "spacing": spacing, "area_budget": 0}
    scene = Scene.of(PART)
    held = vise_of(WANTED)
    began = time.process_time()
    _ = scene.surround().possible.solids
    print(
        f"part alone: {len(scene.surround().possible.triangles)} triangles, "
        f"{time.process_time() - began:.2f} s to tessellate and build"
    )
    cases: dict[str, list[Fixture | str]] = {
        "part alone": [], "vise": [held], "table": ["table:0"], "vise and table": [held, "table:-40"],
    }  # fmt: skip
    ready = {}
    for name, fixtures in cases.items():
        began = time.process_time()
        ready[name] = prepare(scene, Options(**options, fixtures=fixtures))
        took = time.process_time() - began
        count = len(ready[name].conditions.obstacles.triangles)
        print(f"{name}: {count} triangles, {len(ready[name].samples)} samples, {took:.2f} s to prepare")
    print("| cutter | fixtures | search, s | against none | boxes | triangles | lost |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for text in CUTTERS:
        cutter = Cutter.parse(text.split("H")[0])
        if "H" in text:
            cutter = cutter.asked(0.0, 0.0, Options(holder=text.split("H")[1]).holder)
        best = dict.fromkeys(cases, np.inf)
        reach = {name: judge(ready[name], cutter) for name in cases}
        for _ in range(ROUNDS):
            for name in cases:
                best[name] = min(best[name], seconds(lambda name=name, cutter=cutter: judge(ready[name], cutter)))
        counts = {name: work(ready[name], cutter) for name in cases}
        none = counts["part alone"]
        for name in cases:
            more = 100 * (best[name] / best["part alone"] - 1)
            boxes, triangles = (100 * (counts[name][word] / none[word] - 1) for word in ("boxes", "triangles"))
            print(f"| {text} | {name} | {best[name]:.2f} | {more:+.0f} % | {boxes:+.1f} % | "
                  f"{triangles:+.1f} % | {int(reach[name].not_reached.sum())} |", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
