"""Plans of made parts beside the plan that a machinist works out by hand: clampings, orientations, minutes of cutting.

    python benchmarks/hand_plans.py                       all parts, a row each in Markdown
    python benchmarks/hand_plans.py --only plate --out DIR  keeps the plans, to look at their pages

Each part is made with CadQuery, so small that its plan fits on the back of an envelope. The hand plan is a program of its own,
the path of the tool's centre pass by pass (`centre_paths.py`): it has no formula of the product. Minutes are those of cutting
alone, at 1,000 mm/min; links and entries are apart, 1 s each. Where the contour of a wall goes round sharp outer corners, a
second share has no such arcs. Parts for three axes are planned with the tool along z, all others on a trunnion.
"""

import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path as File
from typing import Any

import cadquery as cq
import click
from centre_paths import FEED, Path, Profile, ball_about, ball_along, circle, floor, rectangle, wall, walls_round
from shapely.geometry import LineString, Polygon, box

SCALLOP = 0.01
#: Diameter and length of flutes of the flat ends, mm, and the words of the tools; radius of the ball.
D16, D12 = (16.0, 32.0), (12.0, 26.0)
FLAT = {D16: "D16L60F32S16", D12: "D12L50F26S12"}
BALL, R5 = "D10L50rc5F22S10", 5.0
#: Machines with two rotary axes, and without.
TRUNNION, UPRIGHT = "trunnion-ac", "tilt:0"


@dataclass(frozen=True)
class Case:
    """A part, the words of the command, and the hand plan: clampings, orientations, and the path of the tool's centre."""

    name: str
    shape: Any
    words: tuple[str, ...]
    setups: int
    turns: int
    path: Path
    machine: str = TRUNNION


def cases() -> Iterator[Case]:
    """Make the parts."""
    yield from blocks()
    yield from leaning()
    yield from narrow()
    yield from pockets()
    yield from curved()


def blocks() -> Iterator[Case]:
    """Parts of floors and walls along the setup axis."""
    # The bottoms of all stand on the table, and are not requested but where the part is turned over.
    steps = block(90, 60, 30).cut(block(30, 60, 10).translate((0, 0, 20))).cut(block(30, 60, 20).translate((30, 0, 10)))
    path = total(
        floor(rectangle(30, 60), D16[0]),
        *(floor(box(0, 0, 30, 60), D16[0], box(-30, 0, 0, 60)) for _ in range(2)),
        *(wall(LineString([(0, 0), (0, 60)]), D16[0], 10, D16[1]) for _ in range(2)),
        wall(rectangle(90, 60), D16[0], 30, D16[1]),
    )
    yield Case("stepped block", steps, (*tools(D16), *but(steps, bottoms)), 1, 1, path)

    cube = block(50, 50, 50).faces(">Z").workplane().rect(24, 24, forConstruction=True).vertices().hole(6.0)
    holes = [circle(3, x, y) for x in (-12, 12) for y in (-12, 12)]
    top = rectangle(50, 50)
    for hole in holes:
        top = top.difference(hole)
    path = total(floor(top, D16[0]), wall(rectangle(50, 50), D16[0], 50, D16[1]))
    left_out = but(cube, lambda f: bottoms(f) or f.geomType() == "CYLINDER")
    yield Case("cube, its holes skipped", cube, (*tools(D16), *left_out), 1, 1, path)

    tube = cq.Workplane().circle(20).circle(15).extrude(50)
    rim = circle(20).difference(circle(15))
    path = total(floor(rim, D16[0]), wall(circle(20), D16[0], 50, D16[1]), wall(circle(15), D16[0], 50, D16[1], inside=True))
    yield Case("tube", tube, (*tools(D16), *but(tube, bottoms)), 1, 1, path)

    # Jaws grip the long walls, and reach 4 mm up; the short walls are free.
    held = block(80, 50, 30)
    along, across = (LineString([(0, 0), (length, 0)]) for length in (80, 50))
    gripped, free = wall(along, D16[0], 30 - 4, D16[1]), wall(across, D16[0], 30, D16[1])
    path = total(floor(rectangle(80, 50), D16[0]), gripped.times(2), free.times(2))
    yield Case("block in a vise", held, (*tools(D16), *but(held, bottoms), "--fixture", "vise:46x30x65:4"), 1, 1, path)

    girth = Polygon([(20 * math.cos(t), 4 * math.sin(t)) for t in (math.tau * k / 180 for k in range(180))])
    blade = block(60, 40, 10).union(cq.Workplane().workplane(offset=10).ellipse(20, 4).extrude(20))
    path = total(
        floor(rectangle(60, 40).difference(girth), D12[0], girth),
        floor(girth, D12[0]),
        wall(girth, D12[0], 20, D12[1]),
        wall(rectangle(60, 40), D12[0], 10, D12[1]),
    )
    yield Case("blade on a root", blade, (*tools(D12), *but(blade, bottoms)), 1, 1, path)


def leaning() -> Iterator[Case]:
    """Parts of planes that are cut in more than one orientation."""
    tilt = math.radians(15)
    foot = 20 - 20 * math.tan(tilt)
    tail = cq.Workplane("XZ").polyline([(-foot, 0), (foot, 0), (20, 20), (-20, 20)]).close().extrude(60)
    flank, end = LineString([(0, 0), (60, 0)]), LineString([(0, 0), (40, 0)])
    path = total(
        floor(rectangle(40, 60), D16[0]),
        wall(flank, D16[0], 20 / math.cos(tilt), D16[1]).times(2),
        wall(end, D16[0], 20, D16[1]).times(2),
    )
    yield Case("dovetail", tail, (*tools(D16), *but(tail, bottoms)), 1, 3, path)

    slope = block(80, 50, 30).cut(cq.Workplane("XZ").polyline([(40, 30), (20, 30), (40, 10)]).close().extrude(50, both=True))
    path = total(
        floor(rectangle(60, 50), D16[0]),
        floor(rectangle(20 * math.sqrt(2), 50), D16[0]),
        wall(rectangle(80, 50), D16[0], 30, D16[1]),
    )
    yield Case("block with a slope of 45 deg", slope, (*tools(D16), *but(slope, bottoms)), 1, 2, path)

    draft = cq.Workplane("YZ").polyline([(0, 0), (40, 0), (40, 30), (30 * math.tan(math.radians(5)), 30)]).close().extrude(100)
    only = but(draft, lambda f: abs(abs(f.normalAt().y) - math.cos(math.radians(5))) > 1e-6)
    section = Profile.line((30 * math.tan(math.radians(5)), 30), (0, 0))
    path = ball_along(section, 100, R5, SCALLOP)
    yield Case("wall with a draft of 5 deg, three axes", draft, ("--cutter", BALL, *only), 1, 1, path, UPRIGHT)

    edge = LineString([(0, 0), (100, 0)])
    path = wall(edge, D12[0], 30 / math.cos(math.radians(5)), D12[1])
    yield Case("wall with a draft of 5 deg", draft, (*tools(D12), *only, "--fixture", "table"), 1, 1, path)


def narrow() -> Iterator[Case]:
    """Parts with faces that are narrower than the tool."""
    ribs = block(200, 100, 10)
    for k in range(10):
        ribs = ribs.union(block(1, 100, 10).translate((20 * k - 90, 0, 10)))
    words = (*tools(D12), *but(ribs, lambda f: f.BoundingBox().zmin < 20 - 1e-6))
    yield Case("ten ribs of 1 x 100, their tops", ribs, words, 1, 1, floor(rectangle(1, 100), D12[0]).times(10))

    places = [(x, y) for x in (-25, 0, 25) for y in (-12.5, 12.5)]
    pins = block(80, 50, 10).union(cq.Workplane().workplane(offset=10).pushPoints(places).circle(2).extrude(10))
    plate, stand = rectangle(80, 50), Polygon()
    for place in places:
        stand = stand.union(circle(2, *place))
    path = total(
        floor(plate.difference(stand), D12[0], stand),
        floor(circle(2), D12[0]).times(6),
        wall(circle(2), D12[0], 10, D12[1]).times(6),
    )
    sides = but(pins, lambda f: f.geomType() == "PLANE" and f.BoundingBox().zmin < 10 - 1e-6)
    yield Case("six pins of radius 2", pins, (*tools(D12), *sides), 1, 1, path)

    walls = but(pins, lambda f: f.geomType() == "PLANE")
    yield Case(
        "six pins of radius 2, their walls", pins, (*tools(D12), *walls), 1, 1, wall(circle(2), D12[0], 10, D12[1]).times(6)
    )

    ledge = block(100, 40, 10).union(block(100, 36, 10).translate((0, 0, 10)))
    path = total(
        floor(box(0, 0, 100, 2), D12[0], box(0, -36, 100, 0)).times(2),
        wall(LineString([(0, 0), (100, 0)]), D12[0], 10, D12[1]).times(2),
    )
    words = (*tools(D12), *but(ledge, lambda f: abs(f.normalAt().x) > 0.5 or f.Center().z in (0, 20) or f.Center().z == 5))
    yield Case("two ledges of 2 mm and the walls above", ledge, words, 1, 1, path)

    channel = block(100, 50, 30).cut(block(100, 16, 10).translate((0, 0, 20)))
    path = total(
        floor(box(0, 0, 100, 16), D12[0], box(0, -17, 100, 0).union(box(0, 16, 100, 33))),
        wall(LineString([(0, 0), (100, 0)]), D12[0], 10, D12[1]).times(2),
    )
    words = (*tools(D12), *but(channel, lambda f: abs(f.Center().y) > 8 + 1e-6 or abs(f.normalAt().x) > 0.5 or bottoms(f)))
    yield Case("channel of 16 mm", channel, words, 1, 1, path)


def pockets() -> Iterator[Case]:
    """Parts with pockets."""
    hollow = rectangle(60, 40, 7)
    inside = total(floor(hollow, D12[0], walls_round(hollow)), wall(hollow, D12[0], 10, D12[1], inside=True))
    top = floor(rectangle(120, 80).difference(hollow), D12[0])

    plate = block(120, 80, 20).cut(pocket(60, 40, 7, 10))
    path = total(top, inside, wall(rectangle(120, 80), D12[0], 20, D12[1]))
    yield Case("plate with a pocket", plate, (*tools(D12), *but(plate, bottoms)), 1, 1, path)

    cover = block(120, 80, 30).cut(pocket(60, 40, 7, 20)).cut(pocket(60, 40, 7, 0))
    path = total(top.times(2), inside.times(2), wall(rectangle(120, 80), D12[0], 30, D12[1]))
    yield Case("cover with two sides", cover, (*tools(D12), "--faces", "all", "--setup", "auto"), 2, 2, path)

    def within(part: Any) -> tuple[str, ...]:
        """Only the faces of a pocket 10 mm deep."""
        return but(part, lambda f: (f.BoundingBox().zmax > 20 - 1e-6 and abs(f.normalAt().z) > 0.5) or outer(f))

    def outer(face: Any) -> bool:
        """Whether it is a side or the bottom of the block, 120 x 80."""
        return bottoms(face) or abs(abs(face.Center().x) - 60) < 1e-6 or abs(abs(face.Center().y) - 40) < 1e-6

    tight = rectangle(60, 40, 6.5)
    part = block(120, 80, 20).cut(pocket(60, 40, 6.5, 10))
    path = total(floor(tight, D12[0], walls_round(tight)), wall(tight, D12[0], 10, D12[1], inside=True))
    yield Case("pocket with corners of 6.5 mm", part, (*tools(D12), *within(part)), 1, 1, path)

    wide, island = rectangle(90, 60, 8), rectangle(24, 16, 4)
    part = block(120, 80, 20).cut(pocket(90, 60, 8, 10)).union(pocket(24, 16, 4, 10))
    path = total(
        floor(wide.difference(island), D12[0], walls_round(wide).union(island)),
        wall(wide, D12[0], 10, D12[1], inside=True),
        wall(island, D12[0], 10, D12[1]),
    )
    yield Case("pocket with an island", part, (*tools(D12), *within(part)), 1, 1, path)


def curved() -> Iterator[Case]:
    """Parts with curved faces, which a ball cuts."""
    dome = cq.Workplane().sphere(20).intersect(block(60, 60, 30))
    path = ball_about(Profile.arc((0, 0), 20, 0, 90), R5, SCALLOP)
    yield Case("hemisphere", dome, ("--cutter", BALL, *but(dome, bottoms)), 1, 1, path)

    deep, hollow = 8.0, 25.0
    dish = block(80, 60, 30).cut(cq.Workplane().sphere(hollow).translate((0, 0, 30 + hollow - deep)))
    rim = math.sqrt(2 * hollow * deep - deep**2)
    opening = math.degrees(math.asin(rim / hollow))
    bowl = ball_about(Profile.arc((0, hollow), hollow, -90, opening - 90, hollow=True), R5, SCALLOP)
    top = floor(rectangle(80, 60).difference(circle(rim)), D16[0])
    path = total(top, wall(rectangle(80, 60), D16[0], 30, D16[1]), bowl)
    yield Case("mould half", dish, (*tools(D16), "--cutter", BALL, *but(dish, bottoms)), 1, 1, path)
    words = ("--cutter", BALL, *but(dish, lambda f: f.geomType() != "SPHERE"))
    yield Case("dish of a mould half, a ball alone", dish, words, 1, 1, bowl)

    cone = cq.Solid.makeCone(20, 10, 20)
    path = ball_about(Profile.line((10, 20), (20, 0)), R5, SCALLOP)
    words = ("--cutter", BALL, *but(cq.Workplane(cone), lambda f: f.geomType() != "CONE"))
    yield Case("cone, three axes", cq.Workplane(cone), words, 1, 1, path, UPRIGHT)

    run = block(100, 40, 40).cut(block(100, 40, 40).edges("|X and <Y and <Z").fillet(8).translate((0, 15, 15)))
    path = ball_along(Profile.arc((0, 0), 8, 180, 270, hollow=True), 100, R5, SCALLOP)
    words = ("--cutter", BALL, *but(run, lambda f: f.geomType() != "CYLINDER"))
    yield Case("hollow fillet of radius 8, three axes", run, words, 1, 1, path, UPRIGHT)

    boss = cq.Workplane().circle(25).extrude(20).faces(">Z").edges().fillet(4)
    path = ball_about(Profile.arc((21, 16), 4, 0, 90), R5, SCALLOP)
    words = ("--cutter", BALL, *but(boss, lambda f: f.geomType() != "TORUS"))
    yield Case("round edge of a boss, radius 4", boss, words, 1, 1, path)


def block(x: float, y: float, z: float) -> Any:
    """A block that stands on z = 0, about the z axis."""
    return cq.Workplane().box(x, y, z, centered=(True, True, False))


def pocket(x: float, y: float, radius: float, bottom: float) -> Any:
    """The body of a pocket with round corners, 10 mm deep, above its bottom."""
    return cq.Workplane().workplane(offset=bottom).rect(x, y).extrude(10.0).edges("|Z").fillet(radius)


def total(*paths: Path) -> Path:
    """The paths together."""
    return sum(paths, Path())


def tools(*flats: tuple[float, float]) -> tuple[str, ...]:
    """The words that give flat ends."""
    return tuple(word for each in flats for word in ("--cutter", FLAT[each]))


def bottoms(face: Any) -> bool:
    """Whether a face lies on the table."""
    return face.geomType() == "PLANE" and face.BoundingBox().zmax < 1e-6


def but(part: Any, left_out: Callable[[Any], bool]) -> tuple[str, ...]:
    """The words that request all faces of a part in its first setup, but some."""
    numbers = [str(k) for k, face in enumerate(part.faces().vals(), 1) if left_out(face)]
    return ("--faces", f"!{','.join(numbers)}", "--setup", "+z")


@click.command(help=__doc__)
@click.option("--only", help="Parts whose names have this word.")
@click.option("--out", type=click.Path(file_okay=False, path_type=File), help="Keep parts and plans in this folder.")
@click.option("--words", default="", help="More words for the command.")
def main(only: str | None, out: File | None, words: str) -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as made:
        folder = out or File(made)
        folder.mkdir(exist_ok=True, parents=True)
        print(
            "| part | by hand: setups, orientations, cutting (+ entries and links) | planned | finished "
            "| cutting against the hand plan (without arcs about sharp corners) | run |"
        )
        print("|---|---|---|---|---|---|")
        for case in cases():
            if only is None or only in case.name:
                print(row(case, folder, words.split()), flush=True)


def planned(case: Case, folder: File, words: Sequence[str] = ()) -> dict[str, Any]:
    """The process that a part is planned with; its `error` where there is none."""
    file = folder / f"{case.name.replace(' ', '_').replace(',', '')}.step"
    cq.exporters.export(case.shape, str(file))
    out = file.with_suffix("")
    command = [
        *(sys.executable, "-m", "plan_cutters", str(file), *case.words, "--machine", case.machine, "--holder", "er25"),
        *("--operations", "fastest", "--feed", f"{60 * FEED:g}", "--scallop", f"{SCALLOP:g}", *words, "-o", str(out)),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1, 4):
        return {"error": done.stderr.strip().splitlines()[-1]}
    process: dict[str, Any] = json.loads((out / "plan.json").read_text(encoding="utf-8"))["process"]
    return process


def cut_seconds(process: dict[str, Any]) -> float:
    """Seconds of cutting of a process."""
    return sum(step["seconds"] or 0.0 for step in process["steps"])


def row(case: Case, folder: File, words: list[str]) -> str:
    """Plan a part, and put both plans into a row of the table."""
    began = time.perf_counter()
    process = planned(case, folder, words)
    took = time.perf_counter() - began
    hand = f"{case.setups}, {case.turns}, {minutes(case.path.seconds, case.path.link_seconds)}"
    if "error" in process:
        return f"| {case.name} | {hand} | {process['error']} | | | |"
    steps, cutting = process["steps"], cut_seconds(process)
    links = [step["link_seconds"] or 0.0 for step in steps if "link_seconds" in step]
    turned = [(s["setup"], s["mode"], *(s["angles_deg"] or {}).items()) for s in steps]
    setups = len({step["setup"] for step in steps})
    made = f"{setups}, {len(set(turned))}, {minutes(cutting, sum(links) if links else None)}"
    more = share(cutting, case.path.length)
    if case.path.corners:
        more += f" ({share(cutting, case.path.length - case.path.corners)})"
    return f"| {case.name} | {hand} | {made} | {100 * process['finished_share']:.2f} % | {more} | {took:.0f} s |"


def minutes(cutting: float, links: float | None) -> str:
    """Seconds in minutes, as a cell of the table."""
    return f"{cutting / 60:.2f} min" + ("" if links is None else f" (+ {links / 60:.2f})")


def share(seconds: float, length: float) -> str:
    """How much more seconds are than those of a path, mm."""
    return f"{100 * (seconds * FEED / length - 1):+.1f} %"


if __name__ == "__main__":
    main()
