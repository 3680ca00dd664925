"""Fixtures as exact surfaces, whether a point lies within one, and whether those hold the part whose place the plan states."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from cad_io import read_part
from cad_io.arrays import Floats
from cad_io.read.mesh import is_mesh, read_mesh
from plan_cutters_check.question import Body, Grip, Question, Setup, frame_of
from plan_cutters_check.surface import Face, Source, Triangles

#: A table reaches so much farther than the part, mm: as far as any tool.
_TABLE = 2000.0
#: A cylinder of stock lies along a part that is so many times as long across the setup axis as it is high and wide.
_LONG = 2.17
#: Sides of a cylinder; each lies within r (1 - cos(pi / sides)) of it.
_SIDES = 720
#: So many triangles are seen from points at a time.
_AT_ONCE = 100_000
#: How far a face may be from a jaw, and the part's lowest point from the ledges, mm; cosine of the angle between both.
_AT, _SQUARE = 0.02, math.cos(math.radians(0.2))
#: Lines of points in a face each way, and how often closer ones are taken where the jaws are.
_LINES, _TIMES = 16, 4
_MESH = (".stl", ".obj", ".ply", ".glb")
#: Corners of the triangles of a box, counter-clockwise from outside.
_BOX = np.array([
    (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7),
    (1, 7, 5),
])  # fmt: skip


def rotation_of(body: Body) -> Floats:
    """The matrix (3, 3) of a placement: about x, then about y, then about z, all fixed in the part."""
    return np.asarray(Rotation.from_euler("xyz", body.placement[3:], degrees=True).as_matrix())


class PlacedFixture:
    """A fixture where it stands, about a part from `low` to `high`: its `sources`; `known`: whether `holds` knows its inside."""

    def __init__(self, body: Body, setup: Setup, low: Floats, high: Floats) -> None:
        self.name = f"fixture:{body.name}"
        rotation, shift = rotation_of(body), np.array(body.placement[:3], float)
        mesh = body.source.lower().endswith(_MESH) if isinstance(body.source, str) else is_mesh(body.source)
        self.known, self._vertex, self.sources = bool(body.kind or mesh), np.zeros((0, 3, 3)), list[Source]()
        if body.kind == "stock" and not body.sizes:
            # Of stock in a file it is not known where it ends.
            self.known = False
        elif self.known:
            own = _word(body, setup, rotation, shift, low, high) if body.kind else read_mesh(body.source, body.unit).vertex
            self._vertex = own @ rotation.T + shift
            self.sources.append(Triangles(self._vertex, self.name))
        else:
            read = read_part(body.source, unit=body.unit)
            numbers = [face.number for face in read.faces if read.trim(face.number) is not None]
            self.sources += [Face(read, number, self.name, rotation, shift) for number in numbers]

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Which points (n, 3) lie within it, by the solid angle of its triangles; of a CAD file none is known to."""
        inside, corners = np.zeros(len(points)), self._vertex.transpose(1, 0, 2)[:, :, None]
        together = max(1, _AT_ONCE // max(1, len(self._vertex)))
        for start in range(0, len(points), together):
            some = slice(start, start + together)
            p, q, r = corners - points[some]
            u, v, w = (np.linalg.norm(each, axis=2) for each in (p, q, r))
            top = (p * np.cross(q, r)).sum(axis=2)
            under = u * v * w + (p * q).sum(axis=2) * w + (q * r).sum(axis=2) * u + (r * p).sum(axis=2) * v
            inside[some] = 2.0 * np.arctan2(top, under).sum(axis=0)
        return np.asarray(np.abs(inside) > 2.0 * math.pi)


def stock_frame(body: Body, setup: Setup) -> Floats:
    """The frame (3, 3) of stock, as rows: along what grips it, and beside that as near to the part's X as can be."""
    return frame_of(replace(setup, z=body.up or setup.z, x=None))


def foot_of(margins: tuple[float, ...], low: Floats, high: Floats) -> tuple[float, ...]:
    """Find what of stock is below a part that reaches from `low` to `high` (3,) in the frame of a setup: two corners; of a
    cylinder its middle, radius and heights, as far as it surely reaches: to the part's farthest side. One about a part that is
    long across the setup axis lies along it: of that two corners.
    """
    size = high - low
    along = next((k for k in (0, 1) if size[k] > _LONG * np.delete(size, k).max()), 2)
    if len(margins) == 2 and along < 2:
        # A bar lies: the box about what of it is below the part.
        radius, side = 0.5 * float(np.delete(size, along).max()) + margins[0], 1 - along
        half, least, most = math.sqrt(max(0.0, radius**2 - (0.5 * size[2]) ** 2)), low - margins[0], high + margins[0]
        middle = 0.5 * (low + high)[side]
        least[side], most[side], least[2], most[2] = middle - half, middle + half, 0.5 * (low + high)[2] - radius, low[2]
        return (*least.tolist(), *most.tolist())
    if len(margins) == 2:
        middle, wide = 0.5 * (low + high)[:2], 0.5 * float((high - low)[:2].max())
        return (*middle.tolist(), wide + margins[0], float(low[2]) - margins[1], float(low[2]))
    margin = np.array(margins[:2])
    return (*(low[:2] - margin).tolist(), float(low[2]) - margins[-1], *(high[:2] + margin).tolist(), float(low[2]))


def _word(body: Body, setup: Setup, rotation: Floats, shift: Floats, low: Floats, high: Floats) -> Floats:
    """Triangles (n, 3, 3), in its own frame, of a fixture that is described by a word."""
    if body.kind == "box":
        return _box(np.zeros(3), np.array(body.sizes))
    if body.kind == "cylinder":
        radius, height = body.sizes
        # Around the true cylinder, so that nothing of it is left out.
        return _cylinder(radius / math.cos(math.pi / _SIDES), height)
    if body.kind == "stock" and len(body.sizes) == 5:
        x, y, radius, foot, top = body.sizes
        # Within the true one: what is in the way of a tool here is so there.
        return np.asarray((_cylinder(radius, top - foot) + np.array([x, y, foot])) @ stock_frame(body, setup))
    if body.kind == "stock":
        return np.asarray(_box(np.array(body.sizes[:3]), np.array(body.sizes[3:])) @ stock_frame(body, setup))
    if body.kind == "prism":
        return _prism(body.sizes[0], body.sizes[1], np.array(body.sizes[2:]).reshape(2, -1, 2))
    # A table lies across the setup axis or, if it is turned, across its own z; all below its top is in the way.
    frame = np.eye(3) if any(body.placement[3:]) else frame_of(setup)
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    own = (corners - shift) @ rotation @ frame.T
    start, end = own.min(axis=0) - _TABLE, own.max(axis=0) + _TABLE
    end[2] = body.sizes[0]
    start[2] = min(start[2], end[2] - _TABLE)
    return np.asarray(_box(start, end) @ frame)


def _cylinder(radius: float, height: float) -> Floats:
    """Triangles (n, 3, 3) of a prism with its corners on a cylinder about z that stands on the origin."""
    turn = 2.0 * math.pi * np.arange(_SIDES) / _SIDES
    a = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros(_SIDES)])
    b, up, middle = np.roll(a, -1, axis=0), np.array([0.0, 0.0, height]), np.zeros_like(a)
    sides = [(a, b, b + up), (a, b + up, a + up), (b, a, middle), (a + up, b + up, middle + up)]
    return np.concatenate([np.stack(each, axis=1) for each in sides])


def _prism(low: float, high: float, lines: Floats) -> Floats:
    """Triangles (n, 3, 3) between two polylines (2, m, 2), which need not be convex together: a fan over each piece of both."""
    triangles = []
    (inner, outer), count = lines, lines.shape[1]
    for k in range(count - 1):
        ring = [inner[k], inner[k + 1], outer[k + 1], outer[k]]
        for i, j in ((1, 2), (2, 3)):
            triangles.append([(*ring[0], high), (*ring[i], high), (*ring[j], high)])
            triangles.append([(*ring[0], low), (*ring[j], low), (*ring[i], low)])
    loop = [*inner, *outer[::-1]]
    for p, q in zip(loop, [*loop[1:], loop[0]], strict=True):
        triangles += [[(*p, low), (*q, low), (*q, high)], [(*p, low), (*q, high), (*p, high)]]
    return np.array(triangles, float)


def _box(low: Floats, high: Floats) -> Floats:
    corner = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    return np.asarray((low + corner * (high - low))[_BOX])


def faults(question: Question) -> Iterator[str]:
    """List what is wrong with where the part is held, a line each."""
    for grip in question.grips:
        points = {f.number: _local(question, grip, f.number) for f in question.part.faces if question.part.trim(f.number)}
        stated = {int(name[1:]) for name in grip.faces if name[1:].isdecimal()}
        # A round that runs out into what is gripped touches a jaw along a line, which holds nothing, unless the jaws are bored.
        bored = grip.jaws == 2 and bool(stated) and all(n in points and _lies(grip, points[n][0]) for n in stated)
        held, touched_at = ("cylinder", _across) if bored else ("plane" if grip.jaws == 2 else "cylinder", _touched)
        touched = {n: touched_at(grip, *pair) for n, pair in points.items() if question.part.faces[n - 1].shape == held}
        touching = {number for number, jaws in touched.items() if jaws}
        where = f"{grip.name} in setup {grip.setup + 1}"
        free = grip.jaws - len(set[int]().union(*touched.values()))
        # A chuck grips a whole cylinder, whichever faces of it are between its jaws.
        on_bore = {n for n in stated if grip.jaws > 2 and _bored(grip, *points[n]).any()}
        other = touching ^ stated if grip.jaws == 2 else (touching - stated) | (stated - on_bore)
        if free:
            yield f"{where}: no face of the part is at {free} of its {grip.jaws} jaws"
        elif other or not stated:
            names = ", ".join(f"F{n}" for n in sorted(touching))
            yield f"{where}: its jaws touch {names}, and the plan says {', '.join(grip.faces) or 'none'}"
        yield from (f"{where}: {words}" for words in _rests(grip, np.concatenate([pair[0] for pair in points.values()]), bored))


def resting(question: Question) -> Question:
    """The question with the faces on which the part rests in a placed vise or chuck held in that setup: no tool comes there."""
    setups = [*question.setups]
    for grip in question.grips:
        rests = set()
        for face in question.part.faces:
            if face.shape == "plane" and question.part.trim(face.number):
                point, normal = _local(question, grip, face.number)
                if (np.abs(point[:, 2]) <= _AT).all() and normal[:, 2].min(initial=0.0) <= -_SQUARE:
                    rests.add(face.number)
        setups[grip.setup] = replace(setups[grip.setup], clamped=setups[grip.setup].clamped | rests)
    return replace(question, setups=tuple(setups))


def _local(question: Question, grip: Grip, number: int) -> tuple[Floats, Floats]:
    """Points (n, 3) of a face and its border, closer together at the jaws, and outer normals there, in the jaws' frame."""
    trim, rotation = question.part.trim(number), rotation_of(grip.body)
    assert trim is not None
    pairs: list[tuple[Floats, Floats]] = []

    def at(uv: Floats) -> Floats:
        point, normal, _ = question.surface(number, uv)
        local = (point - np.array(grip.body.placement[:3])) @ rotation
        inside = trim.inside(*uv.T)
        pairs.append((local[inside], normal[inside] @ rotation))
        return np.asarray(local)

    low, high = np.array(trim.box).reshape(2, 2).T
    for _ in range(_TIMES):
        cell = (high - low) / _LINES
        uv = np.stack(np.meshgrid(*(low + cell * (np.arange(_LINES)[:, None] + 0.5)).T), axis=-1)
        local = at(uv.reshape(-1, 2)).reshape(_LINES, _LINES, 3)
        far = 1.5 * max(float(np.abs(np.diff(local, axis=k)).max()) for k in (0, 1))
        near = (local[..., 2] >= -far) & (local[..., 2] <= grip.grip + far)
        near &= (np.abs(local[..., 1]) <= 0.5 * grip.width + far) | (grip.jaws > 2)
        if not near.any() or near.all():
            break
        low, high = uv[near].min(axis=0) - cell, uv[near].max(axis=0) + cell
    border = trim.segments.reshape(-1, 2)
    point = question.surface(number, border)[0]
    pairs.append(((point - np.array(grip.body.placement[:3])) @ rotation, np.zeros((len(point), 3))))
    return np.concatenate([each[0] for each in pairs]), np.concatenate([each[1] for each in pairs])


def _touched(grip: Grip, point: Floats, normal: Floats) -> set[int]:
    """At which jaws a face lies, that looks at them."""
    if grip.jaws == 2:
        there = (point[:, 2] > _AT) & (point[:, 2] < grip.grip - _AT) & (np.abs(point[:, 1]) < 0.5 * grip.width - _AT)
        return {
            k for k, way in enumerate((1.0, -1.0))
            if (there & (np.abs(way * point[:, 0] - 0.5 * grip.apart) <= _AT) & (way * normal[:, 0] >= _SQUARE)).any()
        }  # fmt: skip
    there = _bored(grip, point, normal)
    turn, every = np.arctan2(point[there, 1], point[there, 0]), 2.0 * math.pi / grip.jaws
    nearest = np.rint(turn / every)
    return {int(k) % grip.jaws for k in nearest[np.abs(turn - nearest * every) <= grip.width]}


def _bored(grip: Grip, point: Floats, normal: Floats) -> NDArray[np.bool_]:
    """Which points lie on the bore of a chuck's jaws, in their height."""
    away = np.hypot(point[:, 0], point[:, 1])
    outward = (point[:, :2] * normal[:, :2]).sum(axis=1) >= _SQUARE * np.maximum(away, 1e-9)
    return np.asarray(outward & (point[:, 2] > _AT) & (point[:, 2] < grip.grip - _AT) & (np.abs(away - 0.5 * grip.apart) <= _AT))


def _lies(grip: Grip, point: Floats) -> bool:
    """Whether all of a face is on a cylinder across the jaws of a vise, which touches them and what it rests on."""
    return bool((np.abs(np.hypot(point[:, 0], point[:, 2] - 0.5 * grip.apart) - 0.5 * grip.apart) <= _AT).all())


def _across(grip: Grip, point: Floats, normal: Floats) -> set[int]:
    """At which jaws of a vise such a face lies."""
    there = (point[:, 2] < grip.grip) & (np.abs(point[:, 1]) < 0.5 * grip.width - _AT) & _lies(grip, point)
    outward = point[:, 0] * normal[:, 0] > 0.0
    return {k for k, way in enumerate((1.0, -1.0)) if (there & outward & (way * point[:, 0] > 0.45 * grip.apart)).any()}


def _rests(grip: Grip, point: Floats, bored: bool) -> Iterator[str]:
    """Whether the lowest points lie on the ledges, or in jaws that are bored, or between the jaws over the body."""
    low = float(point[:, 2].min())
    across = np.abs(point[:, 0]) if grip.jaws == 2 else np.hypot(point[:, 0], point[:, 1])
    if low > _AT:
        yield f"the part hangs {low:.4g} mm over the ledges"
    elif low < -_AT:
        if low < -grip.below - _AT:
            yield f"the part reaches {-low - grip.below:.4g} mm into the body"
        if (across[point[:, 2] < -_AT] > 0.5 * grip.apart - grip.ledge + _AT).any():
            yield "the part reaches into the jaws below the ledges"
    elif not bored and not (across[point[:, 2] <= low + _AT] >= 0.5 * grip.apart - grip.ledge - _AT).any():
        yield "no lowest point of the part lies on the ledges"
