"""The arrays that cross the CAD boundary: mm, part coordinates, radians; frozen, no kernel here."""

from collections.abc import Collection
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

#: Items of a tuple that are printed one by one.
_LISTED = 4
#: Shapes that are not sculptured, whatever the file calls them.
SIMPLE_KINDS = ("plane", "cylinder", "cone", "sphere", "torus")


def cross(a: Floats, b: Floats) -> Floats:
    """Cross products of vectors (..., 3): those of `numpy.cross`, bit for bit, whose own checks take longest where there are few.

    >>> cross(np.eye(3), np.eye(3)[[1, 2, 0]])
    array([[0., 0., 1.],
           [1., 0., 0.],
           [0., 1., 0.]])
    """
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for k, i, j in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        product[..., k] = a[..., i] * b[..., j] - a[..., j] * b[..., i]
    return product


class Record:
    """Base of frozen records of arrays: equal if all their numbers are (nan to nan), and printed by shape, not in full.

    >>> Orientation(np.ones(3), "a guess", False)
    Orientation(sign=float64 (3,), method='a guess', confident=False, guessed=())
    >>> Orientation(np.ones(3), "a guess", False) == Orientation(np.ones(2), "a guess", False)
    False
    """

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(_same(getattr(self, name), getattr(other, name)) for name in _names(self))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={_brief(getattr(self, name))}' for name in _names(self))})"


def rows_by_face(face: Ints) -> dict[int, NDArray[np.int64]]:
    """Rows (k,) of each face number that occurs in `face` (n,), ascending.

    >>> rows_by_face(np.array([7, 2, 7], np.int32))
    {2: array([1]), 7: array([0, 2])}
    >>> rows_by_face(np.zeros(0, np.int32))
    {}
    """
    numbers, count = np.unique(face, return_counts=True)
    groups = np.split(np.argsort(face, kind="stable"), np.cumsum(count)[:-1])
    return dict(zip(numbers.tolist(), groups, strict=False))


def _names(record: Any) -> list[str]:
    return [field.name for field in fields(record) if field.compare]


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray):
        floating = one.dtype.kind == "f"
        return isinstance(other, np.ndarray) and one.dtype == other.dtype and np.array_equal(one, other, equal_nan=floating)
    if isinstance(one, tuple):
        return isinstance(other, tuple) and len(one) == len(other) and all(map(_same, one, other))
    return bool(one == other)


def _brief(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape}"
    if isinstance(value, tuple) and (len(value) > _LISTED or any(isinstance(each, np.ndarray | tuple) for each in value)):
        return f"{len(value)} {type(value[0]).__name__}" if value else "()"
    return repr(value)


@dataclass(frozen=True, slots=True)
class Carrier:
    """The whole plane, cylinder, cone, sphere or torus that a face is a part of."""

    #: mm; the point of a plane or of a cylinder's axis that is nearest the origin, the apex of a cone, the centre of a sphere or
    #: torus.
    point: tuple[float, float, float]
    #: Unit normal of a plane, or unit direction of an axis. The first of its longest components is positive; of a cone it points
    #: from the apex to the face. None of a sphere.
    direction: tuple[float, float, float] | None = None
    #: mm; of a cylinder or sphere, and of the circle about which a torus lies.
    radius: float | None = None
    #: mm; of the tube of a torus.
    minor_radius: float | None = None
    #: rad; between the axis and the surface of a cone.
    half_angle: float | None = None
    #: +1 where `dS/du x dS/dv` points along a plane's direction, or away from an axis, from a centre or from the middle of a
    #: tube; -1 where it does not; 0 where that is not known.
    side: int = 0


@dataclass(frozen=True, slots=True)
class FaceInfo:
    """One face of a part."""

    #: From 1, in the order of the kernel's map of the read shape; written `F<number>`.
    number: int
    #: Name in the file; empty if it has none.
    name: str
    #: Kind of the stored surface: one of SIMPLE_KINDS, `bezier`, `bspline`, `revolution`, `extrusion`, `offset` or `other`.
    surface: str
    #: What it is in shape: one of SIMPLE_KINDS if it is that within tolerance, else `sculptured`.
    shape: str
    #: mm2.
    area: float
    #: sRGB, 0 to 1, as found in the file.
    colour: tuple[float, float, float] | None = None
    #: Why no surface can be judged here; None for a face that can.
    unjudged: str | None = None
    #: None of a sculptured face, and of one without a border.
    carrier: Carrier | None = None

    @property
    def id(self) -> str:
        return f"F{self.number}"


@dataclass(frozen=True, slots=True)
class LostFace:
    """A face written in a file that is not in the part, or not as written."""

    #: As the file names it: `#123` (STEP), `D45` (IGES); empty where that is not known.
    entity: str
    #: Name in the file; empty if it has none.
    name: str
    #: What became of it, and the cause where it is known.
    why: str
    #: Its number in the part where it is there, but altered: with a hole or an edge missing, for one.
    face: int | None = None
    #: Corners, mm, of the box that its known points span, in part coordinates; the face may reach beyond it.
    box: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None

    def __str__(self) -> str:
        known = " ".join(filter(None, (f"F{self.face}" if self.face else "", self.entity, self.name)))
        return f"{known or 'a face'}: {self.why}"


@dataclass(frozen=True, slots=True)
class SizeNote:
    """A diameter with its tolerance, or a note on it, as a file states it of faces."""

    #: Numbers of the faces.
    faces: tuple[int, ...]
    #: mm
    nominal: float | None = None
    #: mm; deviations from the nominal value, None where none are stated.
    lower: float | None = None
    upper: float | None = None
    #: Tolerance class, as `H7`; empty where none is stated.
    fit: str = ""
    #: Texts that stand beside it.
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Orientation(Record):
    """Which side of each face is out of the material."""

    #: (faces,); +1 where `dS/du x dS/dv` points out of the material, -1 where it points in.
    sign: Floats
    #: How it was found, for people.
    method: str
    #: False where it is a guess.
    confident: bool
    #: Numbers of the faces of solids whose side is a guess: nothing that is requested turns them.
    guessed: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FaceGrid(Record):
    """The parameter grid of one face and which sample sits at each node."""

    #: Face number.
    face: int
    #: (nu,), (nv,); Grid lines.
    u: Floats
    v: Floats
    #: (nu, nv); Row of the sample in SurfaceSamples, -1 outside the trim.
    index: Ints
    #: The last line's neighbour is the first one (a seam).
    closed_u: bool
    closed_v: bool
    #: Ends of the range that the lines were laid over: u least, u most, v least, v most. A closed range's second end is its
    #: first one, a turn later.
    span: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SurfaceSamples(Record):
    """Sampled points of faces, with the kernel's exact differential geometry.

    Attributes
    ----------
    point, normal : (n, 3) float
        Surface point, mm, and unit normal out of the material.
    direction_max : (n, 3) float
        Unit principal direction of `curvature[:, 0]`; at an umbilic the kernel's u tangent.
    curvature : (n, 2) float
        kappa_max, kappa_min in 1/mm, positive where the material rises around the point (concave).
    uv : (n, 2) float
        Surface parameters.
    face : (n,) int32
        Face number.
    area : (n,) float
        Share of the face's area that the sample stands for, mm2.
    neighbours : (m, 2) int32
        Pairs of samples next to each other, within a face and across smooth joints.
    unjudged : (n,) int32
        -1 where the geometry is good, else an index into `reasons`.
    max_gap : float
        Largest distance, mm, between grid neighbours and from a point of a sampled face, up to its border, to the nearest
        sample of that face, through space. Faces in `empty` have no part in it.
    empty : tuple of (int, str)
        Faces that gave no sample, with the reason.
    face_gaps : tuple of (int, float)
        The same distance of each sampled face alone.
    """

    point: Floats
    normal: Floats
    direction_max: Floats
    curvature: Floats
    uv: Floats
    face: Ints
    area: Floats
    neighbours: Ints
    unjudged: Ints
    reasons: tuple[str, ...]
    grids: tuple[FaceGrid, ...]
    max_gap: float
    empty: tuple[tuple[int, str], ...]
    face_gaps: tuple[tuple[int, float], ...] = ()

    def by_face(self) -> dict[int, NDArray[np.int64]]:
        """Rows of the samples of each face that has some, ascending, by its number."""
        return rows_by_face(self.face)

    def __len__(self) -> int:
        return len(self.point)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Triangles(Record):
    """A part's surface as triangles close to it."""

    #: (t, 3, 3); corners a, b, c, mm, ordered so that `(b - a) x (c - a)` has the side of `dS/du x dS/dv` of the face's surface
    #: (counter-clockwise in the parameter plane). Where that area is zero, either order may be found.
    vertex: Floats
    #: (t,); face number.
    face: Ints
    #: Bound of the distance between a triangle and the surface that it stands for, mm, but on the faces in `loose`. Each point of
    #: the face, up to its true border, has a triangle within it.
    chord_error: float
    #: Faces without triangles, with the reason.
    missing: tuple[tuple[int, str], ...]
    #: Faces whose surface or border only the kernel can evaluate: there the distance is measured, not proved.
    measured: tuple[int, ...] = ()
    #: Faces with a larger bound of their own, mm: one face that is hard to follow leaves the others as close as they were asked.
    loose: tuple[tuple[int, float], ...] = ()
    #: The bound of each face, mm.
    errors: tuple[tuple[int, float], ...] = ()

    def __len__(self) -> int:
        return len(self.vertex)

    def without(self, faces: Collection[int]) -> "Triangles":
        """The same without the triangles of some faces."""
        return self.take(~np.isin(self.face, list(faces))) if faces else self

    def take(self, rows: NDArray[Any]) -> "Triangles":
        """Some of them, by their rows or by a mask (t,)."""
        rest = self.chord_error, self.missing, self.measured, self.loose, self.errors
        return Triangles(self.vertex[rows], self.face[rows], *rest)

    @property
    def measured_share(self) -> float:
        """Share of the triangles whose distance is not proved."""
        return float(np.isin(self.face, self.measured).mean()) if self.measured and len(self) else 0.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FaceLabels(Record):
    """Labels on a face's parameter grid, along whose boundaries it is to be split."""

    face: int
    #: (nu,); strictly increasing grid lines.
    u: Floats
    v: Floats
    #: (nu, nv); 0, 1, 2, ...; -1 where unknown (outside the trim). Labels are ordinal: of the labels that a face has, a middle
    #: one lies between its neighbours, so boundaries never cross.
    label: Ints


class Style(NamedTuple):
    """Name and sRGB colour (0 to 1) that a piece of a face gets in a written file, and the name that all of its kind share."""

    name: str
    rgb: tuple[float, float, float]
    kind: str = ""
