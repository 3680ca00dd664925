"""How the part stands in each setup, what holds it, and where: seen from its triangles and the fixtures."""

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from cad_io.arrays import Triangles
from plan_cutters.domain.fixture import STOCK, TABLE
from plan_cutters.domain.verdicts import CHORD_REQUESTED
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.operations import ProcessSetup, StockEntry
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.fixtures import stock_body
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.surroundings import PlacedFixture
from plan_cutters.setups.workpiece import Workpiece, faces_in_jaws, on_ledges


def process_setups(ready: Prepared) -> Iterator[ProcessSetup]:
    """Tell of each setup which way is up, what the part stands on, and what grips it where."""
    for number, conditions in enumerate(ready.setups, 1):
        surroundings = conditions.surroundings
        triangles = (surroundings.alone or surroundings).certain.triangles
        part = _workpiece(ready, conditions, triangles)
        gripping = next((each for each in surroundings.fixtures if each.fixture.clamping is not None), None)
        if gripping is not None:
            yield _gripped(number, part, gripping, surroundings.fixtures, triangles)
            continue
        bearing = part.bearing(0.0)
        # A body that the planner gave may hold the part from anywhere.
        body = next((each for each in surroundings.fixtures if each.fixture.kind not in (TABLE, STOCK)), None)
        table = next((each for each in surroundings.fixtures if each.fixture.kind == TABLE), None)
        holding = body or table
        stock = any(each.fixture.stock for each in surroundings.fixtures)
        stands_on: list[str] | Literal["stock"] | None = _named(part.face[part.level(0.0)]) or None
        soft = "" if holding is not table or table is None or bearing.firm else "what it stands on does not carry it"
        yield ProcessSetup(
            number=number, up=vector(conditions.setup), stands_on="stock" if stock else stands_on,
            held=TABLE if holding is table and table is not None else body.fixture.name if body is not None else None,
            clamping=None if holding is None else holding.fixture.text, soft=soft,
        )  # fmt: skip


def stock_entry(ready: Prepared) -> StockEntry | None:
    """Find what the first setup grips, its volume and how much is to be roughed; None where it grips the part."""
    conditions, options = ready.setups[0], ready.options
    surroundings = conditions.surroundings
    blank = next((each.fixture for each in surroundings.fixtures if each.fixture.stock), None)
    if blank is None or blank.stock is None:
        return None
    alone = surroundings.alone or surroundings
    body = stock_body(blank, vector(conditions.setup), alone, CHORD_REQUESTED * ready.scene.asked, {})
    remove = max(0.0, body.volume - _workpiece(ready, conditions, alone.certain.triangles).enclosed[0])
    rate = options.removal_rate
    return StockEntry(
        word=blank.stock.text, size_mm=vector(body.high - body.low), volume_mm3=body.volume, remove_mm3=remove,
        seconds=None if rate is None else 60.0 * remove / (1000.0 * rate),
    )  # fmt: skip


def _gripped(
    number: int, part: Workpiece, gripping: PlacedFixture, fixtures: Sequence[PlacedFixture], triangles: Triangles
) -> ProcessSetup:
    """A setup in a vise or chuck that is in its place."""
    fixture, clamping = gripping.fixture, gripping.fixture.clamping
    assert clamping is not None, "a vise or chuck grips"
    triangles = triangles.take(triangles.face > 0)
    own = (triangles.vertex - fixture.shift) @ fixture.rotation
    grips = faces_in_jaws(clamping, own, triangles.face, triangles.chord_error)
    if any(each.fixture.stock for each in fixtures):
        return ProcessSetup(
            number=number, up=vector(part.frame[2]), stands_on="stock", held=fixture.kind, apart_mm=clamping.numbers[-1],
            grip_mm=clamping.grip, clamping=fixture.text,
        )  # fmt: skip
    level = part.level(float(fixture.shift @ part.frame[2]) - part.lowest)
    rests = on_ledges(clamping, own[level], triangles.face[level], part.flat)
    return ProcessSetup(
        number=number, up=vector(part.frame[2]), stands_on=_named(np.array(sorted(rests), int)) or None,
        held=fixture.kind, grips=_named(np.array(sorted(grips), int)), apart_mm=clamping.numbers[-1], grip_mm=clamping.grip,
        clamping=fixture.text, soft="" if gripping.hold is None else gripping.hold.soft,
    )  # fmt: skip


def _workpiece(ready: Prepared, conditions: Conditions, triangles: Triangles) -> Workpiece:
    planes = [face.number for face in ready.scene.part.faces if face.shape == "plane"]
    mine = triangles.face > 0
    sign, setup = ready.scene.orientation.sign, vector(conditions.setup)
    return Workpiece.of(triangles.vertex[mine], triangles.face[mine], sign, planes, (), setup)


def _named(faces: np.ndarray) -> list[str]:
    return [f"F{number}" for number in np.unique(faces).tolist()]
