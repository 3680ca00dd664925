"""Small parts of awkward sizes of which it is kept what the program says, each prepared once a process."""

from functools import cache

import cadquery as cq

from cad_io import read_part
from cad_io.errors import CadIoError
from cad_io.kernel import faces
from plan_cutters import Options
from plan_cutters.errors import PlanError
from plan_cutters.pipeline import prepare
from tests.support.cad_parts import box, compound, cut, holed_patch, patch, rod
from tests.support.grooves import tee
from tests.support.patterns import plate
from tests.support.shapes import plane


def bracket():
    """A block with a pocket, a bore, a slope, a dome and a step."""
    part = cq.Workplane("XY").box(33.7, 27.3, 13.9, centered=False)
    pocket = cq.Workplane("XY").workplane(offset=5.3).moveTo(11.2, 10.4).rect(13.3, 11.9).extrude(20).edges("|Z").fillet(2.3)
    slope = cq.Workplane("XZ").moveTo(33.7, 5.1).lineTo(33.7, 20).lineTo(24.6, 20).lineTo(24.6, 12.2).close().extrude(-40)
    part = part.cut(pocket).cut(slope).cut(cq.Workplane("XY").moveTo(21.3, 21.9).circle(2.7).extrude(30))
    part = part.cut(cq.Workplane("XY").sphere(4.1).translate((0.3, 27.0, 13.7)))
    return part.union(cq.Workplane("XY").sphere(3.3).translate((30.1, 5.2, 7.4)))


def deep():
    """A block with a deep bore and a ledge in it."""
    bore = cut(box(24.3, 22.1, 31.7), rod(5.1, 40, (11.2, 10.4, 6.6)))
    return cut(bore, rod(7.3, 40, (11.2, 10.4, 19.9)))


def drum():
    """A rod with a bore across it, and a round rim."""
    return cq.Workplane("XY").circle(9.3).extrude(14.1).faces(">Z").edges().fillet(2.1).cut(
        cq.Workplane("XZ").moveTo(1.1, 6.2).circle(2.9).extrude(30)
    )  # fmt: skip


def bodies():
    """A block, another one that stands half in it, a third one on it, and a sheet on its side."""
    blocks = box(17.3, 13.9, 8.1), box(6.2, 5.4, 9.3, (4.4, 3.1, 4.9)), box(3.7, 4.4, 5.5, (12.1, 7.2, 8.1))
    return compound(*blocks, plane((2.2, 9.1), (1.3, 6.6), origin=(0, 0, 0), z=(0, -1, 0), x=(1, 0, 0)))


def open_box():
    """A box without its lid and a sheet beside it."""
    sides = sorted(faces(box(13.7, 9.1, 6.3)), key=lambda face: cq.Face(face).Center().z)[:-1]
    return compound(*sides, plane((1.1, 6.2), (0.7, 5.9), origin=(0, 0, 9.3)))


def pocket():
    """A block with two pockets of sharp corners, a square one and one that narrows, a step between them."""
    part = cut(box(41.3, 33.7, 15.2), box(14.3, 17.1, 20.0, (4.1, 6.3, 6.2)))
    wedge = cq.Workplane("XY").workplane(offset=5.1).polyline([(22.2, 5.0), (38.1, 9.3), (35.4, 27.1), (22.2, 21.3)]).close()
    return cut(part, wedge.extrude(20).val().wrapped)


def hollow():
    """A block with a closed void, and a small one in that."""
    block = cut(box(21.3, 17.9, 11.1), box(14.1, 9.7, 6.3, (3.1, 4.2, 2.3)))
    return compound(block, box(3.3, 4.1, 2.7, (6.1, 6.3, 3.9)))


SHAPES = {
    "bracket": bracket,
    "patch": lambda: patch(3, count=7, width=41.0, height=6.0),
    "holed": lambda: holed_patch(2),
    "drum": drum,
    "plate": lambda: plate(3, 1),
    "deep": deep,
    "bodies": bodies,
    "open": open_box,
    "hollow": hollow,
    "pocket": pocket,
    "sunk": lambda: compound(box(19.0, 18.0, 17.0), box(3.1, 2.9, 2.7, (8.1, 7.3, 6.9))),
    "groove": lambda: tee(3.1, 4.4, 19.1, 21.3),
}


@cache
def part(name):
    return read_part(SHAPES[name]())


def ready_of(made, **options):
    """A part that is prepared to be judged at all of its faces, holes too."""
    return prepare(made, Options.of({"faces": "all", "area_budget": 0, "jobs": 2, "drill_below": 0, **options}))


@cache
def _ready(name, options):
    return ready_of(part(name), **dict(options))


def ready(name, **options):
    """The same of one of `SHAPES`, once a process."""
    return _ready(name, tuple(options.items()))


def said_by(call, *given, **more):
    """What a call returns, or the line with which it refuses."""
    try:
        return call(*given, **more)
    except (PlanError, CadIoError, ValueError) as error:
        return f"{type(error).__name__}: {error}"
