"""How the part stands in each setup, what holds it, and where: seen from its triangles and the fixtures."""

from collections.abc import Collection, Iterable
from typing import Any, Literal

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.clamping import Clamping, Vise
from plan_cutters.domain.fixture import STOCK, TABLE, Fixture
from plan_cutters.domain.verdicts import CHORD_REQUESTED
from plan_cutters.plan_file.frozen import Vector, vector
from plan_cutters.plan_file.operations import ProcessSetup, StockEntry
from plan_cutters.scene.fixtures import stock_body
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.surroundings import PlacedFixture, Surroundings
from plan_cutters.setups.workpiece import TALL, PartMesh, Workpiece, faces_in_jaws, on_ledges

#: Of the height of jaws, faces before them have nearly all.
_NEARLY = 0.9


def setups_and_stock(ready: Prepared) -> tuple[list[ProcessSetup], StockEntry | None]:
    """Tell of each setup which way is up, what the part stands on, and what grips it where; and what the first one grips, if that
    is stock.
    """
    setups, stock = list[ProcessSetup](), None
    planes = [face.number for face in ready.scene.part.faces if face.shape == "plane"]
    for number, conditions in enumerate(ready.setups, 1):
        surroundings = conditions.surroundings
        triangles = (surroundings.alone or surroundings).certain.triangles
        up = vector(conditions.setup)
        blank = next((each.fixture for each in surroundings.fixtures if each.fixture.kind == STOCK), None)
        gripping = next((each for each in surroundings.fixtures if each.fixture.clamping is not None), None)
        along = up if gripping is None else gripping.fixture.stands_along(up)
        part = Workpiece.of(ready.scene.mesh(triangles), planes, (), along, chord=triangles.chord_error)
        on: list[str] | Literal["stock"] | None = "stock"
        if blank is None:
            on = _named(part.face[part.level(0.0)].tolist()) if gripping is None else _rests_on(part, gripping.fixture)
        if gripping is None:
            held = _stood(part, surroundings.fixtures)
        else:
            held = _gripped(gripping, part.mesh, triangles.chord_error, stock=blank is not None, lying=along != up)
        setups.append(ProcessSetup(number=number, up=up, stands_on=on or None, **held))
        if blank is not None and number == 1:
            stock = _stock(ready, surroundings, blank, vector(along), part.enclosed[0])
    return setups, stock


def _stock(ready: Prepared, surroundings: Surroundings, blank: Fixture, along: Vector, volume: float) -> StockEntry:
    """The entry of stock about a part of a volume, mm3, in what stands along a direction."""
    rate, chord = ready.options.removal_rate, CHORD_REQUESTED * ready.scene.asked
    body = stock_body(blank, along, surroundings.alone or surroundings, chord, {})
    remove = max(0.0, body.volume - volume)
    return StockEntry(
        word=blank.stock.text if blank.stock else "", size_mm=vector(body.high - body.low), volume_mm3=body.volume,
        remove_mm3=remove, seconds=None if rate is None else 60.0 * remove / (1000.0 * rate),
    )  # fmt: skip


def _stood(part: Workpiece, fixtures: Collection[PlacedFixture]) -> dict[str, Any]:
    """A setup in which no jaws grip: a body that the planner gave may hold the part from anywhere, a table lies below it."""
    body = next((each.fixture for each in fixtures if each.fixture.kind not in (TABLE, STOCK)), None)
    table = next((each.fixture for each in fixtures if each.fixture.kind == TABLE), None)
    if body is not None:
        return {"held": body.name, "clamping": body.text}
    if table is None:
        return {"held": None}
    return {"held": TABLE, "clamping": table.text,
            "soft": "" if part.bearing(0.0).firm else "what it stands on does not carry it"}  # fmt: skip


def _gripped(gripping: PlacedFixture, mesh: PartMesh, chord: float, *, stock: bool, lying: bool) -> dict[str, Any]:
    """A setup in a vise or chuck that is in its place, or in a chuck that lies; jaws on stock touch no face."""
    fixture, clamping = gripping.fixture, gripping.fixture.clamping
    assert clamping is not None, "a vise or chuck grips"
    own = (mesh.vertex - fixture.shift) @ fixture.rotation
    grips = frozenset[int]() if stock else faces_in_jaws(clamping, own, mesh.face, chord)
    out, wide = float(own[..., 2].max()) - clamping.grip, clamping.numbers[-1]
    return {
        "out_mm": out if lying and out > TALL * wide else None,
        "held": fixture.kind, "grips": _named(grips), "apart_mm": wide, "grip_mm": clamping.grip,
        "contact_mm": _contact(clamping, own[np.isin(mesh.face, list(grips))]),
        "clamping": fixture.text, "soft": "" if gripping.hold is None else gripping.hold.soft,
    }  # fmt: skip


def _contact(clamping: Clamping, vertex: Floats) -> float | None:
    """How high faces (n, 3, 3) in the frame of a vise or chuck stand before its jaws, of a vise on the side where that is less;
    None where that is nearly as high as the jaws reach.
    """
    side = vertex[:, :, 0].mean(axis=1) > 0.0
    sides = [vertex[side], vertex[~side]] if isinstance(clamping, Vise) else [vertex]
    heights = [
        min(clamping.grip, float(z.max())) - max(0.0, float(z.min())) for z in (each[..., 2] for each in sides if len(each))
    ]
    least = min(heights, default=clamping.grip)
    return None if least >= _NEARLY * clamping.grip else max(0.0, least)


def _rests_on(part: Workpiece, fixture: Fixture) -> list[str]:
    """Planar faces with which a part rests on the ledges of a vise or chuck in its place."""
    assert fixture.clamping is not None, "a vise or chuck grips"
    level = part.level(float(fixture.shift @ part.frame[2]) - part.lowest)
    own = (part.mesh.vertex[level] - fixture.shift) @ fixture.rotation
    return _named(on_ledges(fixture.clamping, own, part.face[level], part.flat))


def _named(faces: Iterable[int]) -> list[str]:
    return [f"F{number}" for number in sorted({*faces})]
