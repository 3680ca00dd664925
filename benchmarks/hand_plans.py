"""Plans of made parts beside the plan that a machinist works out by hand: clampings, orientations, minutes of cutting.

    python benchmarks/hand_plans.py                       all parts, a row each in Markdown
    python benchmarks/hand_plans.py --only plate --out DIR  keeps the plans, to look at their pages

Each part is made with CadQuery, so small that its plan fits on the back of an envelope. The hand plan has three rules: a flat is
cut in passes of 0.75 (D - 2 rc); a wall along the tool by the side of the flutes, in ceil(height / (F - rc)) passes; a sphere
under a ball in passes of its scallop. Minutes are those of cutting alone, at 1,000 mm/min.
"""

import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

FEED, STEPOVER, SCALLOP = 1000.0 / 60.0, 0.75, 0.01
#: Diameter and length of flutes of the tools, mm; the ball has no flat.
D16, D12, D10 = (16.0, 32.0), (12.0, 26.0), (10.0, 22.0)
FLAT = {D16: "D16L60F32S16", D12: "D12L50F26S12"}
BALL = "D10L50rc5F22S10"


@dataclass(frozen=True)
class Case:
    """A part, the words of the command, and the hand plan: clampings, orientations, seconds of cutting."""

    name: str
    shape: Any
    words: tuple[str, ...]
    setups: int
    turns: int
    seconds: float


def flat(area: float, tool: tuple[float, float]) -> float:
    """Seconds for a plane under the bottom of a flat end."""
    return area / (STEPOVER * tool[0] * FEED)


def wall(length: float, height: float, tool: tuple[float, float]) -> float:
    """Seconds for a wall along the side of the flutes."""
    return length * math.ceil(height / tool[1] - 1e-9) / FEED


def sphere(area: float, radius: float, ball: float) -> float:
    """Seconds for a part of a sphere (radius < 0: hollow) under a ball: passes whose cusps have the scallop's height."""
    near, far = radius + ball, radius + SCALLOP
    half = math.acos((near**2 + far**2 - ball**2) / (2.0 * near * far))
    return area / (2.0 * half * abs(radius) * FEED)


def corners(length: float, width: float, radius: float) -> tuple[float, float]:
    """Area and perimeter of a rectangle with round corners."""
    return length * width - (4.0 - math.pi) * radius**2, 2.0 * (length + width) - (8.0 - 2.0 * math.pi) * radius


def cases() -> Iterator[Case]:
    """Make the parts."""
    import cadquery as cq

    def block(x: float, y: float, z: float) -> Any:
        return cq.Workplane().box(x, y, z, centered=(True, True, False))

    def pocket(bottom: float) -> Any:
        return cq.Workplane().workplane(offset=bottom).rect(60, 40).extrude(10.0).edges("|Z").fillet(7.0)

    _, around = corners(60, 40, 7)
    # The bottoms of all stand on the table, and are not asked but where the part is turned over.
    plate = block(120, 80, 20).cut(pocket(10))
    seconds = flat(120 * 80, D12) + wall(around, 10, D12) + wall(400, 20, D12)
    yield Case("plate with a pocket", plate, (*tools(D12), *but(plate, bottoms)), 1, 1, seconds)

    steps = block(90, 60, 30).cut(block(30, 60, 10).translate((0, 0, 20))).cut(block(30, 60, 20).translate((30, 0, 10)))
    seconds = flat(90 * 60, D16) + wall(60, 10, D16) + wall(60, 20, D16) + wall(60 + 60 + 2 * 90, 30, D16)
    yield Case("stepped block", steps, (*tools(D16), *but(steps, bottoms)), 1, 1, seconds)

    cube = block(50, 50, 50).faces(">Z").workplane().rect(24, 24, forConstruction=True).vertices().hole(6.0)
    seconds = flat(50 * 50 - 4 * math.pi * 9, D16) + wall(200, 50, D16)
    yield Case(
        "cube, its holes skipped",
        cube,
        (*tools(D16), *but(cube, lambda f: bottoms(f) or f.geomType() == "CYLINDER")),
        1,
        1,
        seconds,
    )

    dome = cq.Workplane().sphere(20).intersect(block(60, 60, 30))
    yield Case("hemisphere", dome, ("--cutter", BALL, *but(dome, bottoms)), 1, 1, sphere(2 * math.pi * 20**2, 20, 5))

    blade = block(60, 40, 10).union(cq.Workplane().workplane(offset=10).ellipse(20, 4).extrude(20))
    girth = math.pi * (3 * 24 - math.sqrt((3 * 20 + 4) * (20 + 3 * 4)))
    seconds = flat(60 * 40, D12) + wall(girth, 20, D12) + wall(200, 10, D12)
    yield Case("blade on a root", blade, (*tools(D12), *but(blade, bottoms)), 1, 1, seconds)

    deep, hollow = 8.0, 25.0
    dish = block(80, 60, 30).cut(cq.Workplane().sphere(hollow).translate((0, 0, 30 + hollow - deep)))
    rim = math.pi * (2 * hollow * deep - deep**2)
    seconds = flat(80 * 60 - rim, D16) + wall(280, 30, D16) + sphere(2 * math.pi * hollow * deep, -hollow, 5)
    yield Case("mould half", dish, (*tools(D16), "--cutter", BALL, *but(dish, bottoms)), 1, 1, seconds)

    cover = block(120, 80, 30).cut(pocket(20)).cut(pocket(0))
    seconds = 2 * (flat(120 * 80, D12) + wall(around, 10, D12)) + wall(400, 30, D12)
    yield Case("cover with two sides", cover, (*tools(D12), "--faces", "all", "--setup", "auto"), 2, 2, seconds)

    lean = math.radians(15)
    foot = 20 - 20 * math.tan(lean)
    tail = cq.Workplane("XZ").polyline([(-foot, 0), (foot, 0), (20, 20), (-20, 20)]).close().extrude(60)
    seconds = flat(40 * 60, D16) + 2 * wall(60, 20 / math.cos(lean), D16) + 2 * wall(foot + 20, 20, D16)
    yield Case("dovetail", tail, (*tools(D16), *but(tail, bottoms)), 1, 3, seconds)

    tube = cq.Workplane().circle(20).circle(15).extrude(50)
    seconds = flat(math.pi * (20**2 - 15**2), D16) + wall(2 * math.pi * (20 + 15), 50, D16)
    yield Case("tube", tube, (*tools(D16), *but(tube, bottoms)), 1, 1, seconds)

    slope = block(80, 50, 30).cut(cq.Workplane("XZ").polyline([(40, 30), (20, 30), (40, 10)]).close().extrude(50, both=True))
    seconds = flat(60 * 50 + 50 * 20 * math.sqrt(2.0), D16) + wall(50 + 2 * 80, 30, D16) + wall(50, 10, D16)
    yield Case("block with a slope of 45 deg", slope, (*tools(D16), *but(slope, bottoms)), 1, 2, seconds)


def tools(*flats: tuple[float, float]) -> tuple[str, ...]:
    """The words that give flat ends."""
    return tuple(word for each in flats for word in ("--cutter", FLAT[each]))


def bottoms(face: Any) -> bool:
    """Whether a face lies on the table."""
    return face.geomType() == "PLANE" and face.BoundingBox().zmax < 1e-6


def but(part: Any, left_out: Callable[[Any], bool]) -> tuple[str, ...]:
    """The words that ask for all faces of a part in its first setup, but some."""
    numbers = [str(k) for k, face in enumerate(part.faces().vals(), 1) if left_out(face)]
    return ("--faces", f"!{','.join(numbers)}", "--setup", "+z")


@click.command(help=__doc__)
@click.option("--only", help="Parts whose names have this word.")
@click.option("--out", type=click.Path(file_okay=False, path_type=Path), help="Keep parts and plans in this folder.")
@click.option("--words", default="", help="More words for the command.")
def main(only: str | None, out: Path | None, words: str) -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as made:
        folder = out or Path(made)
        folder.mkdir(exist_ok=True, parents=True)
        print("| part | by hand: setups, orientations, cutting | planned | finished | cutting against the hand plan | run |")
        print("|---|---|---|---|---|---|")
        for case in cases():
            if only is None or only in case.name:
                print(row(case, folder, words.split()), flush=True)


def row(case: Case, folder: Path, words: list[str]) -> str:
    """Plan a part, and put both plans into a row of the table."""
    import cadquery as cq

    file = folder / f"{case.name.replace(' ', '_').replace(',', '')}.step"
    cq.exporters.export(case.shape, str(file))
    began = time.perf_counter()
    out = file.with_suffix("")
    words = [
        *words,
        "--machine",
        "trunnion-ac",
        "--holder",
        "er25",
        "--operations",
        "fastest",
        "--feed",
        f"{60 * FEED:g}",
        "-o",
        str(out),
    ]
    command = [sys.executable, "-m", "plan_cutters", str(file), *case.words, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    took = time.perf_counter() - began
    if done.returncode not in (0, 1, 4):
        return f"| {case.name} | | {done.stderr.strip().splitlines()[-1]} | | | |"
    plan = json.loads((out / "plan.json").read_text(encoding="utf-8"))
    process = plan["process"]
    cutting = sum(step["seconds"] or 0.0 for step in process["steps"])
    turned = [(s["setup"], s["mode"], *(s["angles_deg"] or {}).items()) for s in process["steps"]]
    setups = len({step["setup"] for step in process["steps"]})
    hand = f"{case.setups}, {case.turns}, {case.seconds / 60:.2f} min"
    planned = f"{setups}, {len(set(turned))}, {cutting / 60:.2f} min"
    more = f"{100 * (cutting / case.seconds - 1):+.1f} %"
    return f"| {case.name} | {hand} | {planned} | {100 * process['finished_share']:.2f} % | {more} | {took:.0f} s |"


if __name__ == "__main__":
    main()
