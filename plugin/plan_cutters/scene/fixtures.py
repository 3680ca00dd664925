"""Fixtures in the scene: read once, placed, joined with what stands around the part, and refused where they stand in it.

The part's own surroundings stay as they are and are kept beside the joined ones: another fixture costs another tree, but no
tessellation. How deep a fixture may stand in the part all the same is `docs/operations_proof.md`, lemma K2.
"""

import math
from collections.abc import Callable, MutableMapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cad_io import Part, read_part
from cad_io.arrays import Floats, Record, Triangles
from cad_io.errors import ReadError
from cad_io.part.bodies import Body
from cad_io.read.mesh import Mesh, is_mesh, read_mesh
from cad_io.read.read import TIMEOUT
from cad_io.tessellate.proxies import StandIn
from plan_cutters.domain.clamping import FORMS, Clamping, Vise
from plan_cutters.domain.figures import mm
from plan_cutters.domain.fixture import CAD, MESH, STOCK, Fixture, no_format
from plan_cutters.domain.placement import axis_words, frame_of
from plan_cutters.domain.posture import Direction
from plan_cutters.domain.stock import StockBody
from plan_cutters.errors import FixtureError, UnjudgeableError
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import PlacedFixture, Surroundings, surroundings
from plan_cutters.scene.triangles import AddedTriangles, divided, pieces
from plan_cutters.setups.clamping import Hold, held_stock
from plan_cutters.setups.solids import box, cylinder, insides, sides_of, triangles_of
from plan_cutters.setups.workpiece import material_bodies, unheld_bodies

#: A table reaches this much farther than the part, mm: as far as a cutter may.
TABLE = 2000.0
#: Of a table, models show this much beyond the part, as a share of its size.
_SHOWN = 0.1

#: What was read of each fixture's source, whatever its place; and its triangles, by the chord error asked for, too.
FixtureCache = MutableMapping[Any, Any]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class _Body(Record):
    """A fixture's triangles in its own frame, with what they enclose: perhaps, and surely."""

    possible: Obstacles
    certain: Obstacles
    missing: tuple[tuple[str, str, StandIn], ...] = ()
    notes: tuple[str, ...] = ()


def read(fixture: Fixture, cache: FixtureCache, *, timeout: float = TIMEOUT) -> Part | Mesh | None:
    """Read the source of a fixture; the result is None where words describe the fixture.

    Raises ReadError: it cannot be read, or holds nothing that could be in the way.
    """
    if fixture.kind:
        return None
    source = fixture.source
    key = (source if isinstance(source, str) else id(source), fixture.unit)
    if key not in cache:
        # An object is kept with it: another one must not come to have its number.
        cache[key] = _read(fixture, timeout), source
    content: Part | Mesh = cache[key][0]
    return content


def packable(fixture: Fixture, cache: FixtureCache) -> Fixture:
    """The same fixture without a kernel's shape, which cannot be pickled: with the part that was made of it."""
    if isinstance(fixture.source, str | Part):
        return fixture
    source = read(fixture, cache)
    return replace(fixture, source=source, unit=None) if isinstance(source, Part) else fixture


def _read(fixture: Fixture, timeout: float) -> Part | Mesh:
    source = fixture.source
    if not isinstance(source, str):
        if is_mesh(source):
            return read_mesh(source, fixture.unit)
        return read_part(source, unit=fixture.unit)
    suffix = Path(source).suffix.lower()
    if suffix in MESH:
        return read_mesh(source, fixture.unit)
    if suffix not in CAD:
        raise ReadError(no_format(source), file=source)
    return read_part(source, unit=fixture.unit, timeout=timeout)


def joined(
    surroundings: Surroundings,
    fixtures: Sequence[Fixture],
    chord: float,
    cache: FixtureCache,
    setup: Direction = (0.0, 0.0, 1.0),
    own: Sequence[Fixture] = (),
    own_setup: Direction = (0.0, 0.0, 1.0),
    hold: Callable[[Fixture, Sequence[float]], Hold] | None = None,
    sign: Floats | None = None,
) -> Surroundings:
    """Add the fixtures to the surroundings of a part.

    `surroundings`: of the part alone. `chord`: chord error to ask for, mm. `cache`: fixtures that are known, by their sources:
    they are not read again. `setup`: unit setup axis, across which tables lie. `own`, `own_setup`: more fixtures, whose tables
    lie across another one. `hold`: places a vise or chuck for a unit setup axis. None: there is none to be placed. `sign`
    (faces,) float: side of each face of the part that is out of the material. None: nobody asks which bodies a vise or chuck
    holds. Raises ReadError, UnjudgeableError, FixtureError: a fixture cannot be read, or has no triangles; a vise or chuck has
    nothing to grip.
    """
    placed = [(each, setup) for each in fixtures] + [(each, own_setup) for each in own]
    if not placed:
        return surroundings
    # A chuck may stand across the spindle, and with it the bar that it grips.
    gripping = next((each.stands_along(across) for each, across in placed if each.kind in FORMS), None)
    placed = [(each, gripping if gripping and each.kind in (STOCK, *FORMS) else across) for each, across in placed]
    near = np.array(surroundings.possible.corners)
    placed_fixtures, bodies = [], []
    blank = next((stock_body(each, across, surroundings, chord, cache) for each, across in placed if each.kind == STOCK), None)
    below = 0.0 if blank is None else blank.part_low - float(blank.low[2])
    for number, (requested, across) in enumerate(placed, 1):
        held = None
        if requested.to_place and blank is not None:
            held = held_stock(requested, blank, across, sides_of(blank.radius or 1.0, chord))
        elif requested.to_place and hold is not None:
            held = hold(requested, across)
        fixture = requested if held is None else held.fixture
        bed = _bed(fixture, surroundings, across, near, below) if fixture.kind == "table" else None
        if blank is not None and fixture.kind == STOCK:
            body = _foot(blank, across, chord)
        else:
            body = _body(fixture, chord, cache) if bed is None else _solid(bed(TABLE), 0.0)
        shown = None if bed is None else bed(_SHOWN * float(np.ptp(near, axis=0).max()))
        if (clamping := fixture.clamping) is not None:
            shown, _ = triangles_of(clamping, chord, shown=True)
        in_place = _placed(-number, packable(fixture, cache), body, read(fixture, cache), shown, across)
        if held is not None:
            in_place = replace(in_place, notes=(*in_place.notes, held.words), requested=requested, hold=held)
        # Of stock that is gripped all bodies are made.
        parts = () if sign is None or blank is not None else material_bodies(surroundings.bodies, sign)
        if clamping is not None and len(parts) > 1:
            in_place = replace(in_place, unheld=unheld_bodies(clamping, fixture, surroundings.certain.triangles, parts))
        placed_fixtures.append(in_place)
        bodies.append(body)
    possible = _together(surroundings.possible, placed_fixtures, [body.possible for body in bodies], near)
    certain = possible
    if surroundings.certain is not surroundings.possible or any(body.certain is not body.possible for body in bodies):
        certain = _together(surroundings.certain, placed_fixtures, [body.certain for body in bodies], near)
    return replace(surroundings, possible=possible, certain=certain, fixtures=tuple(placed_fixtures), alone=surroundings)


def _placed(
    number: int, fixture: Fixture, body: _Body, source: Part | Mesh | None, extruded: Floats | None, setup: Sequence[float]
) -> PlacedFixture:
    """A fixture in its place; `extruded`: triangles in its own frame that models show instead of all."""
    vertex = fixture.placed(body.certain.triangles.vertex)
    whole = Obstacles(replace(body.certain.triangles, vertex=vertex), body.certain.weight)
    enclosing = Body((number,), (1,), True, np.zeros((0, 3, 3)))
    notes = list(body.notes)
    if isinstance(source, Mesh) and not fixture.chord_error:
        notes.append("how far it is from what it stands for is not known: it counts as exact")
    shown = whole.triangles.vertex if extruded is None else fixture.placed(extruded)
    if fixture.kind == "table" and fixture.follows_setup and (not fixture.sizes or tuple(setup) != (0.0, 0.0, 1.0)):
        high = float((vertex @ np.asarray(setup, float)).max())
        notes.append(f"its top is {mm(high)} from the part's origin along the setup axis {axis_words(setup)}")
    return PlacedFixture(
        number, fixture, source, whole, enclosing if body.certain.weight.any() else None, body.missing, tuple(notes), shown
    )


def _together(own: Obstacles, placed_fixtures: Sequence[PlacedFixture], bodies: Sequence[Obstacles], near: Floats) -> Obstacles:
    """One set of obstacles: what is added to the part has a tree of its own."""
    first = len(own.triangles) if own.first is None else own.first
    shared, more = pieces(own.triangles, first)
    vertex, face, weight = list[Floats](), [own.triangles.face[:first]], [own.weight[:first]]
    boxes, gaps, errors = [own.open_boxes], [own.gap], [own.triangles.chord_error]
    measured = list(own.triangles.measured)
    for each, body in zip(placed_fixtures, bodies, strict=True):
        vertex.append(each.fixture.placed(body.triangles.vertex))
        face.append(np.full(len(body.triangles), each.number, np.int32))
        weight.append(body.weight)
        gaps.append(body.gap)
        errors.append(body.triangles.chord_error)
        measured += [each.number] * bool(body.triangles.measured)
        for low, high in body.open_boxes:
            corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
            placed = each.fixture.placed(corners)
            boxes.append(np.array([[placed.min(axis=0), placed.max(axis=0)]]))
    face, weight = [*face, own.triangles.face[first:]], [*weight, own.weight[first:]]
    triangles = AddedTriangles(
        shared, np.concatenate([*vertex, more]), np.concatenate(face), chord_error=max(errors), missing=own.triangles.missing,
        measured=tuple(measured), loose=own.triangles.loose, errors=own.triangles.errors,
    )  # fmt: skip
    return Obstacles(triangles, np.concatenate(weight), np.concatenate(boxes), max(gaps), near, first).among(own)


def _body(fixture: Fixture, chord: float, cache: FixtureCache) -> _Body:
    """A fixture in its own frame, as close to what it stands for as is asked."""
    source = read(fixture, cache)
    if isinstance(source, Mesh):
        shells, notes = source.shells, list(source.notes)
        if shells.open and shells.closed:
            notes.append(
                f"{shells.open} of its {shells.open + shells.closed} skins are not watertight: of these, only the surface "
                "is in the way, not what may lie within"
            )
        elif shells.open:
            notes.append("is not watertight and encloses nothing: only its surface is in the way, not what may lie within")
        if shells.turned:
            notes.append(f"{shells.turned} of its skins run the wrong way round: what lies within counts as material")
        whole = Obstacles(_triangles(source.vertex, fixture.chord_error), shells.weight)
        return _Body(whole, whole, (), tuple(notes))
    key = (fixture.source if isinstance(fixture.source, str) else id(fixture.source), fixture.unit, chord)
    if key not in cache:
        if source is not None:
            made = _of_part(source, fixture, chord)
        elif fixture.kind == "box":
            made = _solid(box(np.zeros(3), np.array(fixture.sizes)), 0.0)
        elif (clamping := fixture.clamping) is not None:
            made = _solid(*triangles_of(clamping, chord))
        else:
            radius, height = fixture.sizes
            sides = sides_of(radius, chord)
            # The chord of a side is this far from the arc.
            made = _solid(cylinder(radius, height, sides), radius * (1.0 - math.cos(math.pi / sides)))
        cache[key] = made
    body: _Body = cache[key]
    return body


def body_near(clamping: Clamping, fixture: Fixture, chord: float, part: Obstacles) -> Obstacles:
    """A vise or chuck in its place, without those of its bodies that are wholly lower than a part, so none of it is in them.

    What soft jaws fill below a shaft is not there either: they are bored to what lies in them. `chord`: the chord error to ask
    for, mm.
    """
    clamping = replace(clamping, bored=False) if isinstance(clamping, Vise) else clamping
    up = fixture.rotation[:, 2]
    lowest = float(((part.lowest(up) - fixture.shift) @ up).min())
    vertex, error = triangles_of(clamping, chord, above=lowest)
    return _solid(fixture.placed(vertex), error).certain


def _of_part(part: Part, fixture: Fixture, chord: float) -> _Body:
    try:
        boundary = surroundings(part, chord)
    except UnjudgeableError as error:
        raise UnjudgeableError(error.cause, file=f"{fixture}") from None
    missing: list[tuple[str, str, StandIn]] = [(f"F{number}", why, how) for number, why, how in boundary.missing]
    missing += [(str(each.entity or each.name), each.why, "none" if each.box is None else "box") for each in boundary.lost]
    notes = [] if boundary.certain.weight.any() else ["encloses nothing: only its surface is in the way"]
    return _Body(boundary.possible, boundary.certain, tuple(missing), (*part.warnings, *notes))


def stock_body(
    fixture: Fixture, setup: Sequence[float], surroundings: Surroundings, chord: float, cache: FixtureCache
) -> StockBody:
    """The stock about a part in the frame of a setup. Raises ReadError, OptionError: a file's is none, or does not enclose it."""
    stock, frame = fixture.stock, frame_of(np.asarray(setup, float))
    assert stock is not None, "only stock is made of its word"
    corners, blank = surroundings.certain.triangles.vertex.reshape(-1, 3), None
    if stock.file:
        blank = _body(Fixture(stock.file), chord, cache).possible.triangles.vertex.reshape(-1, 3) @ frame.T
    return StockBody.about(stock, corners @ frame.T, blank)


def _foot(blank: StockBody, setup: Sequence[float], chord: float) -> _Body:
    """What of stock is below the part."""
    frame, (low, high) = frame_of(np.asarray(setup, float)), blank.foot
    if blank.radius is None or blank.lying:
        return _solid(np.ascontiguousarray(box(low, high) @ frame), 0.0)
    sides = sides_of(blank.radius, chord)
    middle = np.append(0.5 * (blank.low + blank.high)[:2], blank.low[2])
    vertex = (cylinder(blank.radius, float(high[2] - blank.low[2]), sides) + middle) @ frame
    return _solid(np.ascontiguousarray(vertex), blank.radius * (1.0 - math.cos(math.pi / sides)))


def _bed(
    fixture: Fixture, surroundings: Surroundings, setup: Sequence[float], near: Floats, below: float
) -> Callable[[float], Floats]:
    """A table in its own frame, as a slab that goes so far beyond the part as is asked, mm, and is as thick.

    It lies across the setup axis; if it is turned by angles, across its own z. Without a height it lies right below the part, or
    below the stock that reaches so far `below` it, mm.
    """
    # Rows: across, across and up, in the table's own frame.
    frame = frame_of(np.asarray(setup, float)) if fixture.follows_setup else np.eye(3)

    def heights(points: Floats) -> Floats:
        return np.asarray((points - fixture.shift) @ fixture.rotation @ frame.T)

    if fixture.sizes:
        (top,) = fixture.sizes
    else:
        # What surely is the part: what only stands for something missing may reach lower than anything does.
        part = surroundings.certain.lowest((fixture.rotation @ frame.T)[:, 2])
        # Its shift comes on top, as for any fixture.
        top = float(heights(part + fixture.shift)[..., 2].min()) - below
    corners = np.array([[near[i, 0], near[j, 1], near[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    own = heights(corners)

    def slab(beyond: float) -> Floats:
        low, high = own.min(axis=0) - beyond, own.max(axis=0) + beyond
        high[2] = top
        return np.ascontiguousarray(box(np.append(low[:2], min(low[2], top - beyond)), high) @ frame)

    return slab


def _solid(vertex: Floats, error: float) -> _Body:
    whole = Obstacles(_triangles(vertex, error), np.ones(len(vertex), np.int8))
    return _Body(whole, whole)


def _triangles(vertex: Floats, error: float) -> Triangles:
    return Triangles(vertex, np.zeros(len(vertex), np.int32), error, ())


#: Points are looked at this share apart of the box that a fixture and the part have in common; and at most about so many.
_APART, _MOST = 1 / 64, 200_000
#: The depth is found to this share of itself, at first of about so many points.
_PRECISION, _FEW = 0.002, 400


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Overlap(Record):
    """Where a fixture and the part are deepest in each other, of the points looked at."""

    depth: float  #: mm; a ball of this radius about `point` is all in the one, and `point` is of the other's surface.
    point: Floats  #: (3,) float.


def refuse_overlaps(surroundings: Surroundings, tolerance: float) -> None:
    """Refuse fixtures that stand in the part.

    Raises FixtureError: it names the fixture, the depth and the place.
    """
    part = (surroundings.alone or surroundings).certain
    for each in surroundings.fixtures:
        clamping, near = each.fixture.clamping, each.obstacles
        if clamping is not None:
            near = body_near(clamping, each.fixture, near.triangles.chord_error, part)
        result = overlap(part, near, tolerance)
        if result is not None:
            x, y, z = (f"{value + 0.0:.4g}" for value in np.round(result.point, 6))
            raise FixtureError(
                f"{each.name} and the part stand {result.depth:.3g} mm deep in each other at {x},{y},{z} mm: check "
                "its placement and its unit"
            )


def overlap(part: Obstacles, fixture: Obstacles, tolerance: float) -> Overlap | None:
    """How deep a fixture stands in a part, or the part in it; None where they touch at most.

    Only what is closed has an inside: two surfaces that enclose nothing are not compared.

    `part`: the part alone, with what it surely encloses. `fixture`: in its place. `tolerance`: depth that is no fault, mm, beside
    the chord errors of both.
    """
    deep, pairs = _compared(part, fixture, tolerance)
    overlaps = [_deepest(points, other, deep) for points, other in pairs]
    return max((each for each in overlaps if each is not None), key=lambda each: each.depth, default=None)


def overlaps(part: Obstacles, fixture: Obstacles, tolerance: float) -> bool:
    """Whether there is an overlap: of many points a few are looked at first, and its depth is not found."""
    deep, pairs = _compared(part, fixture, tolerance)
    each = [(points[:: 1 + len(points) // _FEW], points, other) for points, other in pairs]
    return any(len(_within(few, deep, other)) for few, _, other in each) or any(
        len(_within(points, deep, other)) for _, points, other in each
    )


def entered(part: Obstacles, fixture: Fixture, clamping: Clamping, deep: float) -> bool:
    """Whether some point of a part's faces surely lies deeper in a vise or chuck in its place than a length, mm.

    Corners and middles of triangles are looked at: no does not mean that nothing lies in it.
    """
    from plan_cutters.kernels.linear.within import Space, any_within

    spaces = (Space(fixture.shift, fixture.rotation, *each) for each in insides(clamping, deep))
    return any(any_within(part.tree, part.faces, each) for each in spaces)


def _compared(part: Obstacles, fixture: Obstacles, tolerance: float) -> tuple[float, list[tuple[Floats, Obstacles]]]:
    """Depth that is no fault, mm, and points of each of two with the other in which they are searched; none where these are
    apart."""
    deep = tolerance + part.triangles.chord_error + fixture.triangles.chord_error
    ends = [o.corners for o in (part, fixture)]
    low, high = np.max([a for a, _ in ends], axis=0), np.min([b for _, b in ends], axis=0)
    if (high - low < 0).any():
        return deep, []
    apart = max(_APART * float(np.linalg.norm(high - low)), deep)
    return deep, [(_points(one, low, high, apart), other) for one, other in ((fixture, part), (part, fixture))]


def _points(obstacles: Obstacles, low: Floats, high: Floats, apart: float) -> Floats:
    """Points (n, 3) of triangles within a box, no farther apart than asked, if they are not too many."""
    small = divided(obstacles.triangles.vertex[obstacles.rows_in(low, high)], low, high, apart, _MOST)
    points = np.concatenate([*np.moveaxis(small, 1, 0), small.mean(axis=1)])
    return points[((points >= low) & (points <= high)).all(axis=1)]


def _deepest(points: Floats, solid: Obstacles, least: float) -> Overlap | None:
    """The point (of n, 3) that is deepest in what obstacles enclose; None if none is deeper than a least depth, mm."""
    within = partial(_within, solid=solid)
    remaining, low, point = within(points, least), least, None
    while len(remaining):
        # Of some, the deepest; then only what is deeper.
        few = remaining[:: 1 + len(remaining) // _FEW]
        while len(deeper := within(few, 2.0 * low)):
            few, low = deeper, 2.0 * low
        high = 2.0 * low
        while high - low > _PRECISION * low:
            middle = 0.5 * (low + high)
            deeper = within(few, middle)
            few, low, high = (deeper, middle, high) if len(deeper) else (few, low, middle)
        point = few[0]
        remaining, low = within(remaining, high), high
    return None if point is None else Overlap(low, point)


def _within(points: Floats, clear: float, solid: Obstacles) -> Floats:
    """Those of some points (n, 3) that are deeper in what obstacles enclose than a length, mm."""
    from plan_cutters.kernels.material import far_inside

    points = np.ascontiguousarray(points)
    inside = np.zeros(len(points), bool)
    if len(points) and solid.weight.any():
        far_inside(points, clear, solid.solids, inside)
    return np.ascontiguousarray(points[inside])
