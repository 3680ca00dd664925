"""A part as it stands in a setup: whether it stands by itself, what may be gripped of it, what of its triangles lies where, what
rests on the ledges of jaws, and which bodies they hold.

What a part stands on, seen along the setup axis, has to carry its centre of mass.

All is looked at in a frame of the setup: z along the setup axis, counted from the part's lowest point.
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from cad_io.arrays import FaceInfo, Floats, Ints, Record, Triangles, cross
from cad_io.part.bodies import Body
from cad_io.part.lines import met
from plan_cutters.domain.clamping import Clamping, Vise
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import frame_of

#: Faces that are off the setup axis, or off each other, by a smaller sine are parallel: 0.1 deg.
PARALLEL = float(np.sin(np.radians(0.1)))
#: Faces are in one plane, or on one cylinder, if they are no farther apart than this, mm.
TOGETHER = 0.01
#: Triangles face the jaws of a vise if their normal is that near to the way that these close: cosine of 18 deg.
_FACING = 0.95
#: What stands out of jaws sideways by more than so many times what is between them is held last.
_OUT = 6.0
#: Of the footprint: the least share that the hull of what it stands on has, and how far inside that the centre of mass is, as a
#: share of the side of a square as large.
_LEAST, _MARGIN = 0.1, 0.05
#: A part stands at most so many times as high as what it stands on, or what is gripped of it, is wide.
TALL = 3.0
#: A part is round that fills so much of a circle about it.
_ROUND = 0.9


@dataclass(frozen=True, slots=True)
class Bearing:
    """How a part stands along a setup axis."""

    area: float  #: Of the convex hull of what it stands on, seen along the axis, mm2; 0 where it stands on nothing.
    footprint: float  #: Of the convex hull of the part, seen so, mm2.
    width: float  #: Of the first hull where it is narrowest, mm.
    inside: float  #: How far the centre of mass is inside the first hull, mm; negative outside.
    tall: float  #: How high the part is along the axis, mm.
    round: bool = False  #: Whether the part fills a circle about it, seen so.
    wide: float = math.inf  #: Diameter of that circle, mm.

    @classmethod
    def of(cls, outline: Floats, stood_on: Floats, centre: Floats, tall: float) -> "Bearing":
        """Of corners of the part (n, 2), of what it stands on (m, 2), and its centre of mass (2,), seen along the axis, mm.

        >>> square = np.array([[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]])
        >>> Bearing.of(square, square, np.array([4.0, 4.0]), 30.0).firm
        False
        """
        whole, below = hull(outline), hull(stood_on)
        footprint = 0.0 if whole is None else float(whole.volume)
        middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
        radius = math.sqrt(float(((outline - middle) ** 2).sum(axis=1).max()))
        round_ = footprint >= _ROUND * math.pi * radius**2
        if below is None:
            return cls(0.0, footprint, 0.0, -math.inf, tall, round_, 2.0 * radius)
        normal, off = below.equations[:, :2], below.equations[:, 2]
        height = stood_on[below.vertices] @ normal.T + off
        narrowest, inside = float(-height.min(axis=0).max()), float(-(normal @ centre + off).max())
        return cls(float(below.volume), footprint, narrowest, inside, tall, round_, 2.0 * radius)

    @property
    def broad(self) -> bool:
        """Whether it stands on enough of its footprint."""
        return self.area >= _LEAST * self.footprint > 0.0

    @property
    def firm(self) -> bool:
        """Whether it stands by itself: broad, not too high, and its centre of mass well over what it stands on."""
        return self.broad and self.inside >= _MARGIN * math.sqrt(self.footprint) and self.tall <= TALL * self.width

    @property
    def slender(self) -> float:
        """Its height as a multiple of the side of a square as large as its footprint."""
        return self.tall / math.sqrt(self.footprint) if self.footprint > 0.0 else math.inf


def enclosed(vertex: Floats, normal: Floats) -> tuple[float, Floats]:
    """Find what triangles (n, 3, 3) with outward normals (n, 3) enclose: volume, mm3, and centre of mass (3,), mm.

    Of a surface that is no closed shell the volume is 0, and the centre that of the surface. `normal`: of any length, for it
    tells the side alone.
    """
    turned = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    outward = np.where((turned * normal).sum(axis=1) < 0.0, -1.0, 1.0)
    # From a point within its box: volumes of cones are small there, and of one sign for most.
    low, high = vertex.min(axis=(0, 1)), vertex.max(axis=(0, 1))
    middle = 0.5 * (low + high)
    own = vertex - middle
    volume = outward * (own[:, 0] * turned).sum(axis=1) / 6.0
    whole = float(volume.sum())
    if 0.0 < whole <= 1.001 * float(np.prod(high - low)):
        centre = middle + volume @ own.sum(axis=1) / (4.0 * whole)
        if ((centre >= low) & (centre <= high)).all():
            return whole, np.asarray(centre)
    size = np.linalg.norm(turned, axis=1)
    return 0.0, np.asarray(size @ vertex.mean(axis=1) / max(1e-300, float(size.sum())))


def hull(points: Floats) -> ConvexHull | None:
    """The convex hull of points (n, 2) or (n, 3); None where they have no area or volume."""
    if len(points) < 3:
        return None
    try:
        return ConvexHull(points)
    except QhullError:
        return None


@dataclass(frozen=True, eq=False, repr=False)
class PartMesh(Record):
    """The triangles of a part, with what is the same of them in every setup."""

    vertex: Floats  #: (n, 3, 3) float: corners, mm.
    face: Ints  #: (n,) int: face numbers of them.
    normal: Floats  #: (n, 3) float: outward normals of them, as long as twice their area.

    @classmethod
    def of(cls, vertex: Floats, face: Ints, sign: Floats) -> "PartMesh":
        """Triangles (n, 3, 3) of faces (n,); `sign` (faces,): side of each face that is out of the material."""
        turned = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
        return cls(vertex, face, turned * sign[face - 1][:, None])

    @cached_property
    def outer(self) -> Floats:
        """The corners (k, 3) that are outermost."""
        corner = self.vertex.reshape(-1, 3)
        outer = hull(corner)
        return corner if outer is None else np.asarray(corner[outer.vertices])

    @cached_property
    def enclosed(self) -> tuple[float, Floats]:
        """The volume, mm3, 0 where the faces enclose none, and the centre of mass (3,)."""
        return enclosed(self.vertex, self.normal)

    @cached_property
    def diagonal(self) -> float:
        """Of the box, mm."""
        return float(np.linalg.norm(np.ptp(self.outer, axis=0)))


def rods_of(faces: Sequence[FaceInfo]) -> dict[int, tuple[float, float, float]]:
    """Unit directions of cylindrical faces, as far as they are known, by their numbers."""
    cylinders = ((face.number, face.carrier) for face in faces if face.shape == "cylinder")
    return {number: known.direction for number, known in cylinders if known is not None and known.direction is not None}


@dataclass(frozen=True, eq=False, repr=False)
class Workpiece(Record):
    """A part as it stands in a setup, as far as clamping it matters."""

    mesh: PartMesh
    frame: Floats  #: (3, 3) float: the setup's x, y and z in part coordinates, as rows.
    lowest: float  #: Height of the part's lowest point along z, mm.
    vertex: Floats  #: (n, 3, 3) float: triangles in that frame, z from the lowest point, mm.
    normal: Floats  #: (n, 3) float: outward normals of them, as long as twice their area.
    planes: frozenset[int]  #: Planar faces.
    targets: frozenset[int]  #: Faces to machine.
    flat: float  #: Heights that differ by less are one, mm.
    bodies: tuple[frozenset[int], ...] = ()  #: The faces of each body that is material.
    #: Unit directions (3,) of the cylindrical faces in that frame, by their numbers: triangles do not tell them well enough.
    rods: Mapping[int, Floats] = field(default_factory=dict)

    @classmethod
    def of(
        cls, mesh: PartMesh, planes: Collection[int], targets: Collection[int], setup: Sequence[float],
        bodies: Sequence[frozenset[int]] = (), chord: float = 0.0, rods: Mapping[int, Sequence[float]] = MappingProxyType({}),
    ) -> "Workpiece":  # fmt: skip
        """A part in a setup; without targets, all faces are.

        `chord`: the error of the triangles, mm; the lowest point may be off by it. `rods`: directions of cylinders, in the part.
        """
        frame = frame_of(np.asarray(setup, float))
        local = mesh.vertex @ frame.T
        lowest = float((mesh.outer @ frame[2]).min())
        local[..., 2] -= lowest
        flat = 1e-6 * mesh.diagonal + 1e-6 + chord
        wanted = frozenset(targets) or frozenset(np.unique(mesh.face).tolist())
        return cls(
            mesh, frame, lowest, local, mesh.normal @ frame.T, frozenset(planes), wanted, flat, tuple(bodies),
            {number: frame @ np.array(direction, float) for number, direction in rods.items()},
        )  # fmt: skip

    @property
    def face(self) -> Ints:
        """(n,) int: face numbers of the triangles."""
        return self.mesh.face

    @property
    def area(self) -> float:
        """Of the target faces, mm2."""
        mine = np.isin(self.face, list(self.targets))
        return 0.5 * float(np.linalg.norm(self.normal[mine], axis=1).sum())

    @cached_property
    def middle(self) -> Floats:
        """The middle of its surface, seen from above (3,), with z = 0."""
        size = np.linalg.norm(self.normal, axis=1)
        return np.asarray((size @ self.vertex.mean(axis=1)) / max(1e-300, float(size.sum())) * [1.0, 1.0, 0.0])

    @cached_property
    def outline(self) -> Floats:
        """The corners (k, 3) that are outermost seen from above, with z = 0."""
        corner = self.mesh.outer @ self.frame.T * [1.0, 1.0, 0.0]
        outer = hull(corner[:, :2])
        return corner if outer is None else np.asarray(corner[outer.vertices])

    @cached_property
    def enclosed(self) -> tuple[float, Floats]:
        """Its volume, mm3, 0 where its faces enclose none, and its centre of mass (3,)."""
        volume, centre = self.mesh.enclosed
        return volume, self.frame @ centre - [0.0, 0.0, self.lowest]

    @cached_property
    def tall(self) -> float:
        """Its height along the setup axis, mm."""
        return float((self.mesh.outer @ self.frame[2]).max()) - self.lowest

    @property
    def section(self) -> float:
        """Its mean section across the setup axis, mm2; where it has no volume, what is seen of it from above."""
        volume = self.enclosed[0]
        return volume / self.tall if volume > 0.0 and self.tall > 0.0 else self.bearing(0.0).footprint

    def bearing(self, *heights: float) -> Bearing:
        """How it stands on its planar faces that look down at some heights."""
        level = np.logical_or.reduce([self.level(each) for each in heights])
        below = self.vertex[level].reshape(-1, 3)[:, :2]
        return Bearing.of(self.outline[:, :2], below, self.enclosed[1][:2], self.tall)

    @cached_property
    def lowest_rows(self) -> NDArray[np.int64]:
        """Rows of the triangles that touch its lowest point's height."""
        return np.flatnonzero(self.vertex[..., 2].min(axis=1) <= self.flat)

    def level(self, height: float) -> NDArray[np.bool_]:
        """Its triangles (n,) that look down at a height, of planar faces."""
        level, rows = np.zeros(len(self.face), bool), self._below
        level[rows] = (np.abs(self.vertex[rows, :, 2] - height) <= self.flat).all(axis=1)
        return level

    @cached_property
    def _below(self) -> NDArray[np.int64]:
        """Rows of the triangles of planar faces that look down."""
        return np.flatnonzero((self.normal[:, 2] < 0.0) & np.isin(self.face, list(self.planes)))


@dataclass(frozen=True, slots=True, eq=False)
class Wall:
    """Faces of one upright plane or cylinder: their numbers and triangles, and heights between which they lie."""

    faces: tuple[int, ...]
    vertex: Floats
    face: Ints
    normal: Floats
    low: float
    high: float


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A vise or chuck at a place of a setup's frame, and what it grips there."""

    clamping: Clamping
    #: `x`, `origin` (3,) float: its x axis and its origin.
    x: Floats
    origin: Floats
    grips: tuple[int, ...]  #: Numbers of the faces that its jaws touch.
    #: `touched`, `hidden`: area that they touch, of a vise on the side where that is less; and of the targets on all sides, mm2.
    touched: float
    hidden: float
    above: float  #: Height of what it rests on over the part's lowest point, mm.
    size: float  #: Area of what could be gripped if jaws were as large, on the side where that is less, mm2.
    off: float  #: How far its middle is from the middle of the part, seen from above, mm.
    farthest: float  #: How far the part reaches from its middle across the jaws, mm.
    soft: str = ""  #: Why it needs soft jaws or a nest; empty where plain jaws hold the part.

    @property
    def bored(self) -> bool:
        """Whether soft jaws are bored to a cylinder that lies in them."""
        return isinstance(self.clamping, Vise) and self.clamping.bored

    @property
    def high(self) -> float:
        """Height of the upper end of its jaws over the part's lowest point, mm."""
        return self.above + self.clamping.grip

    @property
    def rank(self) -> tuple[bool, float]:
        """Its place among all that could be gripped, the best ones first: those that begin at the bottom, the largest of them."""
        return self.above > 0.0, -self.size

    @property
    def thin(self) -> bool:
        """Whether what it grips is too thin for what stands out of the jaws."""
        return self.farthest - 0.5 * self.apart > _OUT * self.apart

    def own(self, vertex: Floats) -> Floats:
        """Triangles (n, 3, 3) of the setup's frame in that of the vise or chuck."""
        y = np.array([-self.x[1], self.x[0], 0.0])
        return (vertex - self.origin) @ np.stack([self.x, y, [0.0, 0.0, 1.0]], axis=1)

    @property
    def apart(self) -> float:
        """How far the jaws of a vise stand apart, or how wide is what a chuck grips, mm."""
        return self.clamping.numbers[-1]

    @property
    def firm(self) -> float:
        """How well it holds, by what its jaws touch: half as much where something of the part hangs below them."""
        return self.touched if self.above == 0.0 else 0.5 * self.touched


#: Rays across jaws, and heights at which they go; what is behind a wall holds it as a solid does where that is so many times as
#: thick, at this share of the rays.
_RAYS, _LEVELS, _BACKED, _HELD = 9, 24, 3.0, 0.5
#: Walls are thin below this share of how far what holds them is away, the first where walls across hold both their ends; rings
#: below this share of their diameter, where that is farther away than a share of it.
_FRAMED, _THIN, _RING, _CLOSED = 0.1, 0.25, 0.04, 0.25
#: In the words of why a part needs a nest.
BENDS = "would bend walls"


def thin_between(part: Workpiece, place: Place) -> float:
    """How thick the walls are that jaws would bend, mm; 0 where they press on what does not give.

    Walls do where no material goes from jaw to jaw between most of them, nor does it near above or below.
    """
    clamping, vertex, wide, grip = place.clamping, place.own(part.vertex), place.apart, place.clamping.grip
    half, vise = 0.5 * (wide + TOGETHER), isinstance(clamping, Vise)
    across = np.linspace(-0.5, 0.5, _RAYS + 2)[1:-1] * 2.0 * clamping.half_width
    rays = [(0.0, float(y)) for y in across] if vise else [(turn, 0.0) for turn in clamping.turns]

    def at(height: float) -> Floats:
        return vertex[(vertex[..., 2].min(axis=1) <= height) & (vertex[..., 2].max(axis=1) > height)]

    def crossed(near: Floats, turn: float, y: float, height: float) -> Floats:
        """Where a line between the jaws goes through triangles, ascending."""
        cosine, sine = math.cos(turn), math.sin(turn)
        _, x, _ = met(near, np.array([-sine * y, cosine * y, height]), np.array([cosine, sine, 0.0]))
        # On an edge of two triangles it goes through once.
        x = np.unique(np.round(x, 6))
        return np.asarray(x[np.abs(x) <= half])

    def thickness(height: float) -> float:
        """Find what the thinner wall has at a share of the rays at least; infinite where material goes from jaw to jaw there,
        0 where there is none.
        """
        near, each = at(height), list[float]()
        for turn, y in rays:
            x = crossed(near, turn, y, height)
            if not vise:
                # Outwards from the axis: mirrored, so that one wall is told as two are.
                x = np.concatenate([-x[x > 0.0][::-1], x[x > 0.0]])
            if len(x) >= 2 and len(x) % 2 == 0:
                each.append(math.inf if len(x) == 2 else float(min(x[1] - x[0], x[-1] - x[-2])))
        return sorted(each, reverse=True)[math.ceil(_HELD * len(each)) - 1] if each else 0.0

    def framed(height: float) -> bool:
        """Whether material goes from jaw to jaw at both ends of the part."""
        near = at(height)
        ends = float(near[..., 1].min()) + 0.5 * thick, float(near[..., 1].max()) - 0.5 * thick
        return all(len(crossed(near, 0.0, y, height)) == 2 for y in ends)

    thick = thickness(0.5 * grip)
    if not 0.0 < thick < math.inf:
        return 0.0
    low, high = -place.above, part.tall - place.above
    steps = low + (high - low) * (np.arange(_LEVELS) + 0.5) / _LEVELS
    away = min((max(z - grip, -z, 0.0) for z in steps.tolist() if thickness(z) >= _BACKED * thick), default=high - low)
    least = _FRAMED if vise and framed(0.5 * grip) else _THIN
    thin = thick < least * away if vise else thick < _RING * wide and away > _CLOSED * wide
    return thick if thin else 0.0


class Refused(NamedTuple):
    """Why something is not gripped, with its rank among all that could be (`Place.rank`)."""

    rank: tuple[bool, float]
    why: str


def wall_of(faces: Sequence[int], vertex: Floats, face: Ints, normal: Floats) -> Wall:
    return Wall(tuple(faces), vertex, face, normal, float(vertex[..., 2].min()), float(vertex[..., 2].max()))


def merged(one: Wall, other: Wall) -> Wall:
    vertex, face = np.concatenate([one.vertex, other.vertex]), np.concatenate([one.face, other.face])
    return wall_of(sorted({*one.faces, *other.faces}), vertex, face, one.normal)


def stands(low: float, grip: float) -> tuple[tuple[float, float], ...]:
    """How a part may stand in jaws where what they grip begins at a height over its lowest point.

    Each is how far above its lowest point it rests, and how far the jaws reach above that: where a fillet, a chamfer or more is
    below what they grip, it hangs between them, or it stands on its lowest point in jaws that reach so much higher.
    """
    return ((0.0, grip),) if low <= 0.5 * grip else ((low, grip), (0.0, low + grip))


def area_of(vertex: Floats) -> float:
    return 0.5 * float(np.linalg.norm(np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0]), axis=1).sum())


def clipped(vertex: Floats, face: Ints, direction: Floats, low: float, high: float) -> tuple[Floats, Ints]:
    """Cut triangles (n, 3, 3) of faces (n,) to what lies between two heights along a direction."""
    for way, limit in ((direction, low), (-direction, -high)):
        height = vertex @ way - limit
        count = (height > 0.0).sum(axis=1)
        parts, faces = [vertex[count == 3]], [face[count == 3]]
        for number in (1, 2):
            some, tall = vertex[count == number], height[count == number]
            # The corner that is alone on its side comes first.
            alone = np.argmax(tall > 0.0, axis=1) if number == 1 else np.argmax(tall <= 0.0, axis=1)
            a, b, c = (np.take_along_axis(some, ((alone + k) % 3)[:, None, None], axis=1)[:, 0] for k in range(3))
            p, q, r = (np.take_along_axis(tall, ((alone + k) % 3)[:, None], axis=1) for k in range(3))
            ab, ac = a + (b - a) * (p / (p - q)), a + (c - a) * (p / (p - r))
            corners = [(a, ab, ac)] if number == 1 else [(ab, b, c), (ab, c, ac)]
            pieces = [np.stack(each, axis=1) for each in corners]
            parts += pieces
            faces += [face[count == number]] * len(pieces)
        vertex, face = np.concatenate(parts), np.concatenate(faces)
    return vertex, face


_UP = np.array([0.0, 0.0, 1.0])


def at_jaws(
    clamping: Clamping, vertex: Floats, face: Ints, low: float, high: float, inset: float = 0.0
) -> Iterator[tuple[Ints, Floats]]:  # fmt: skip
    """Cut triangles to what lies between the jaws, before each of them and between two heights: their faces, and how far each of
    them reaches towards it.

    Yields `face` (k,) int: of the triangles that lie there at least in part; `reach` (k,) float: how far they are from the middle
    at most: in a vise across the jaws, in a chuck from its axis; mm. Jaws grip at `0.5 * gap` or `0.5 * diameter`.

    `clamping`: in its place. `vertex` (n, 3, 3) float: triangles in its own frame, mm. `face` (n,) int: face numbers of them.
    `low`, `high`: mm. `inset`: by how much a jaw is taken to be narrower on each side, mm.
    """
    vertex, face = clipped(vertex, face, _UP, low, high)
    for turn in clamping.turns:
        towards = np.array([np.cos(turn), np.sin(turn), 0.0])
        along = np.array([-towards[1], towards[0], 0.0])
        piece, mine = clipped(vertex, face, along, inset - clamping.half_width, clamping.half_width - inset)
        piece, mine = clipped(piece, mine, towards, 0.0, 0.5 * clamping.numbers[-1] + TOGETHER)
        away = piece @ towards if isinstance(clamping, Vise) else np.linalg.norm(piece[..., :2], axis=-1)
        yield mine, away.max(axis=1, initial=-np.inf)


def on_ledges(clamping: Clamping, vertex: Floats, face: Ints, flat: float) -> frozenset[int]:
    """Faces of triangles in the frame of a vise or chuck that lie on its ledges: some of their area does, to a height `flat`, mm.

    >>> from plan_cutters.domain.clamping import Vise
    >>> square = np.array([[[15.0, 0, 0], [20, 0, 0], [20, 5, 0]], [[-5, 0, 0], [5, 0, 0], [5, 5, 0]]])
    >>> sorted(on_ledges(Vise(46.0, 25.0, 65.0, gap=40.0), square, np.array([7, 8]), 1e-6))
    [7]
    """
    inner = 0.5 * clamping.numbers[-1] - clamping.ledge + flat
    each = at_jaws(clamping, vertex, face, -flat, flat)
    return frozenset(int(n) for mine, reach in each for n in np.unique(mine[reach > inner]))


def faces_in_jaws(clamping: Clamping, vertex: Floats, face: Ints, slack: float) -> frozenset[int]:
    """Faces that jaws touch, and not only with an edge.

    `clamping`, `vertex`, `face`: as for `at_jaws`. `slack`: how far triangles may be off, mm.
    """
    normal = cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    towards = np.broadcast_to([1.0, 0.0, 0.0], normal.shape)
    if not isinstance(clamping, Vise):
        towards = vertex.mean(axis=1) * [1.0, 1.0, 0.0]
        towards = towards / np.maximum(1e-300, np.linalg.norm(towards, axis=1))[:, None]
    facing = np.abs((normal * towards).sum(axis=1)) >= _FACING * np.linalg.norm(normal, axis=1)
    inner = 0.5 * clamping.numbers[-1] - TOGETHER - slack
    # What ends at the edge of a jaw, or begins there, is not in it.
    each = at_jaws(clamping, vertex[facing], face[facing], TOGETHER, clamping.grip - TOGETHER, inset=TOGETHER)
    return frozenset(int(n) for mine, reach in each for n in np.unique(mine[reach >= inner]))


def held_bodies(clamping: Clamping, vertex: Floats, face: Ints, bodies: Sequence[frozenset[int]], slack: float) -> frozenset[int]:
    """Which bodies jaws hold, as numbers in `bodies`: all jaws touch them.

    Where no body has all jaws on it, those are held that lie one against the other from jaw to jaw; none where there is a gap
    between them.

    `clamping`, `vertex`, `face`: as for `at_jaws`. `bodies`: the faces of each. `slack`: how far triangles may be off, mm.
    """
    owner = {number: k for k, faces in enumerate(bodies) for number in faces}
    inner = 0.5 * clamping.numbers[-1] - TOGETHER - slack
    touched = [
        {owner[n] for n in np.unique(mine[reach >= inner]).tolist() if n in owner}
        for mine, reach in at_jaws(clamping, vertex, face, 0.0, clamping.grip)
    ]
    if every := set.intersection(*touched):
        return frozenset(every)
    if not all(touched) or (isinstance(clamping, Vise) and not _pressed(clamping, vertex, face, owner, slack)):
        return frozenset()
    return frozenset(set.union(*touched))


def unheld_bodies(
    clamping: Clamping, fixture: Fixture, triangles: Triangles, bodies: Sequence[frozenset[int]]
) -> tuple[int, ...]:
    """Bodies of a part that a vise or chuck in its place does not hold, each by its first face."""
    vertex = (triangles.vertex - fixture.shift) @ fixture.rotation
    held = held_bodies(clamping, vertex, triangles.face, bodies, triangles.chord_error)
    return tuple(sorted(min(faces) for k, faces in enumerate(bodies) if k not in held))


def material_bodies(bodies: Sequence[Body], sign: Floats) -> tuple[frozenset[int], ...]:
    """The faces of each body that is material, without the voids in them; bodies that share a face are one.

    `sign` (faces,): side of each face that is out of the material.
    """
    joined = list[frozenset[int]]()
    for body in bodies:
        if float(np.dot(body.sign, sign[np.array(body.faces) - 1])) > 0.0:
            mine = frozenset(body.faces)
            touching = [each for each in joined if each & mine]
            joined = [each for each in joined if each not in touching] + [mine.union(*touching)]
    return tuple(joined)


def _pressed(vise: Vise, vertex: Floats, face: Ints, owner: dict[int, int], slack: float) -> bool:
    """Whether bodies lie one against the other from jaw to jaw, by the intervals across the jaws that they take between these."""
    vertex, face = clipped(vertex, face, _UP, 0.0, vise.grip)
    vertex, face = clipped(vertex, face, np.array([0.0, 1.0, 0.0]), -vise.half_width, vise.half_width)
    body = np.array([owner.get(n, -1) for n in face.tolist()], np.int64)
    of = {k: vertex[body == k][..., 0] for k in set(body.tolist()) - {-1}}
    spans = sorted((float(x.min()), float(x.max())) for x in of.values())
    reached = -0.5 * (vise.gap or 0.0)
    for low, high in spans:
        if low > reached + TOGETHER + slack:
            return False
        reached = max(reached, high)
    return reached >= 0.5 * (vise.gap or 0.0) - TOGETHER - slack
