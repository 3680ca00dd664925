"""A part: the kernel's shape, its faces by number, and what is known about each; why a face cannot be judged.

Making a part costs next to nothing beside reading it: what is known about a face is worked out when first asked for.
"""

from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.ShapeAnalysis import ShapeAnalysis_ShapeTolerance
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import SIMPLE_KINDS, FaceInfo, Floats, LostFace
from cad_io.errors import ReadError
from cad_io.face.carrier import recognise, sided, stored_carrier
from cad_io.face.measure import Measure, measure
from cad_io.face.trim import Trim, trim_of
from cad_io.kernel import edges_of, explore, faces, is_kernel_error, kind_of, may_refuse, shape_map, translated
from cad_io.kernel.shapes import ENDLESS, Node, endless
from cad_io.part.content import PartContent, packed, unpacked
from cad_io.part.edges import blends
from cad_io.part.sew import Sewn, SewnForm, edge_uses, neighbours, sew
from cad_io.surface import Surface
from cad_io.units import unit_doubt
from plan_cutters_base.forks import SideProcess
from plan_cutters_base.values import digest

#: Reasons that others look at.
NO_AREA = "has no area"
ROUND_TWICE = "its border runs round it more than once"
WRONG_WAY = "its border runs the wrong way round, and its area would be negative"
CROSSES = "crosses itself (its curve of revolution crosses its axis)"
#: Of faces with these neither the area nor what they enclose is to be believed.
UNMEASURED = (ROUND_TWICE, WRONG_WAY, CROSSES)
#: A border that encloses more than its box does by more than this share runs round it more than once.
_ROUNDED = 1e-3
_TURNED = ("SurfaceOfRevolution", "Torus", "Cone")
#: Points along the curve, halvings of the interval in which it meets the axis, and the share of the face's size that is none.
_POINTS, _HALVINGS, _NONE = 129, 50, 1e-6


def why_unjudged(face: TopoDS_Face, surface: Surface, trim: Trim | None, measured: Measure | None, least: float) -> str | None:
    """Why a face cannot be judged; None if it can. Without a trim it has no border; areas up to `least`, mm2, are none."""
    if kind_of(surface.adaptor) == "OtherSurface":
        if BRep_Tool.Triangulation_s(face, TopLoc_Location()) is not None:
            return "holds only triangles, no surface: export exact geometry (B-rep)"
        return "has no surface that can be evaluated"
    if not edges_of(face):
        return ENDLESS if endless(face) else "has no edges"
    if trim is None or measured is None:
        return "its edges have no finite curve on the surface"
    if not np.isfinite(measured.area):
        return "its surface cannot be evaluated everywhere"
    u0, u1, v0, v1 = trim.box
    if trim.closed and trim.uv_area > (1 + _ROUNDED) * ((u1 - u0) * (v1 - v0)):
        return ROUND_TWICE
    if measured.area < -least:
        return WRONG_WAY
    if measured.area <= least:
        return NO_AREA
    return CROSSES if crosses_axis(surface, trim) else None


def crosses_axis(surface: Surface, trim: Trim) -> bool:
    """Whether the curve that makes a surface of revolution leads through the axis, within the border of a face.

    `dS/du` is as long as the distance from the axis, square to the half plane of the curve, and changes its sign with the side of
    the axis. A curve that ends on the axis, or passes it at a distance, does not cross it.
    """
    if kind_of(surface.adaptor) not in _TURNED:
        return False
    u0, u1, low, high = trim.box

    def across(v: Floats) -> Floats:
        return surface.first(np.full(len(v), 0.5 * (u0 + u1)), v)[:, 1]

    v = np.linspace(low, high, _POINTS)
    along = across(v)
    if not np.isfinite(along).all():
        return False
    away = np.linalg.norm(along, axis=1)
    none = _NONE * max(float(away.max()), float(trim.scale[1] * (high - low)))
    side = np.sign(along @ along[int(away.argmax())]) * (away > none)
    known = np.flatnonzero(side)
    return any(side[a] != side[b] and _least(across, along[a], v[a], v[b]) <= none for a, b in pairwise(known.tolist()))


def _least(across: Callable[[Floats], Floats], reference: Floats, low: float, high: float) -> float:
    """Distance from the axis where the curve changes sides between two parameters, by halving: `reference` is `dS/du` at the
    lower one."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(across(np.array([middle]))[0] @ reference) > 0.0 else (low, middle)
    return float(np.linalg.norm(across(np.array([low, high])), axis=1).min())


def box_of(faces: list[TopoDS_Face], excluded: Container[int]) -> tuple[Floats, Floats]:
    """Tight corners of the box around faces.

    The kernel's quick box is padded and its tight one is slow, so the tight one is asked only of faces whose padded
    box still sticks out of what is covered, the farthest first; of faces set aside it is not asked at all.
    """
    loose = np.array([face_box(face, tight=False) for face in faces])
    usable = np.isfinite(loose).all(axis=(1, 2))
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    if not usable.any():
        return low, high
    stick = np.concatenate(
        [loose[:, 0] - np.nanmin(loose[usable, 0], axis=0), np.nanmax(loose[usable, 1], axis=0) - loose[:, 1]], axis=1
    )
    for i in np.argsort(np.where(usable, stick.min(axis=1), np.inf), kind="stable")[: usable.sum()]:
        if (loose[i, 0] < low).any() or (loose[i, 1] > high).any():
            tight = loose[i] if i + 1 in excluded else face_box(faces[i], tight=True)
            tight = tight if np.isfinite(tight).all() else loose[i]
            low, high = np.minimum(low, tight[0]), np.maximum(high, tight[1])
    return low, high


def face_box(face: TopoDS_Face, *, tight: bool) -> Floats:
    """Corners (2, 3) of the box around a face, nan where it has none; not `tight`: quick, and somewhat wider."""
    box = Bnd_Box()
    with may_refuse():
        if tight:
            BRepBndLib.AddOptimal_s(face, box, False, False)
        else:
            BRepBndLib.Add_s(face, box, False)
        if not (box.IsVoid() or box.IsOpen()):
            box.SetGap(0.0)
            return np.array([box.CornerMin().Coord(), box.CornerMax().Coord()])
    return np.full((2, 3), np.nan)


#: Beyond this, mm, a coordinate has too few digits left for any tolerance.
FARTHEST = 1e9
#: Edges that are looser than this share of the part's size are rather a fault of the file.
LOOSEST = 0.1
#: A face smaller than this share of the squared diagonal has no area.
_LEAST_AREA = 1e-12
#: Faces from which on two processes measure them, and the processor time that the other one may take, s.
_MANY_FACES, _MEASURING = 40, 60.0

_KINDS = {
    "Plane": "plane", "Cylinder": "cylinder", "Cone": "cone", "Sphere": "sphere", "Torus": "torus",
    "BezierSurface": "bezier", "BSplineSurface": "bspline", "SurfaceOfRevolution": "revolution",
    "SurfaceOfExtrusion": "extrusion", "OffsetSurface": "offset",
}  # fmt: skip


class Part:
    """A shape whose faces are numbered from 1 in the order of the kernel's map. Not to be changed once made; it can be
    pickled.

    Parameters
    ----------
    shape : TopoDS_Shape
        One shape, located, lengths in mm.
    **content
        What else a reader has found, as `PartContent` has it. All but names and colours are attributes, too.

    Attributes
    ----------
    aside : mapping
        By face number: why nothing more is to be asked of the kernel about this face. It is not judged. See `without`.
    lost : tuple of LostFace
        Where it is not empty, nothing is known of what stood there: no posture may be called safe.
    faces : tuple of FaceInfo
        Entry i is face number i + 1.
    size : tuple of float
        Extent along x, y, z, mm.
    solids : int
        Number of solids.
    closed : bool
        Every edge joins two faces: the shape has an inside.
    sewn : Sewn
        Faces that stand in no solid, joined where they touch.
    blends : frozenset of int
        Numbers of the faces that are fillets and rounds.

    Raises
    ------
    ReadError
        The shape holds no face, or the kernel cannot make sense of it.
    """

    def __init__(self, shape: TopoDS_Shape, **content: Any) -> None:
        self._content = known = PartContent(shape, **content)
        self.shape, self.file, self.sha256, self.unit = shape, known.file, known.sha256, known.unit
        self.layers, self.picked, self.sizes = known.layers, known.picked, known.sizes
        self.unit_readings, self.encoding = known.unit_readings, known.encoding
        self.aside: Mapping[int, str] = {}
        file = self.file
        with translated("looking for faces", error=ReadError, file=file):
            self._faces = faces(shape)
        if not self._faces:
            raise ReadError("holds no surface (no faces): export it as a solid or surface model", file=file)
        self.tree: tuple[Node, ...] = known.tree or (
            Node("", "", TopLoc_Location(), faces=tuple(range(1, len(self._faces) + 1))),
        )
        self._infos: tuple[FaceInfo, ...] = ()
        self._surfaces: dict[int, Surface] = {}
        self._trims: dict[int, Trim | None] = {}
        self._measures: dict[int, Measure | None] = {}
        #: Face number -> triangles of the kernel's mesher, or why there are none; kept by `tessellate`, for it takes seconds.
        self.meshed: dict[int, tuple[Any, str]] = {}
        #: What lies where others lie, and areas that faces come back with from STEP, mm2; kept by `repeats` and `write.back`.
        self.repeats: tuple[Any, ...] | None = None
        self.changed_by_step: Mapping[int, float] | None = None
        self.solids = shape_map(shape, TopAbs_SOLID).Extent()
        with translated("measuring the part", error=ReadError, file=file):
            boxes = np.array([face_box(face, tight=False) for face in self._faces])
            finite = np.isfinite(boxes).all(axis=(1, 2))
            self._centres = boxes.mean(axis=1)
            if not finite.any():
                whole = "no face has a finite size: nothing can be judged"
                raise ReadError(f"F1 {ENDLESS}" if endless(self._faces[0]) else whole, file=file)
            farthest = float(np.abs(boxes[finite]).max())
            if farthest > FARTHEST:
                raise ReadError(
                    f"reaches {farthest:.3g} mm from the origin, where no tolerance can be met: its coordinates are "
                    "damaged, or its unit is wrong; export it again",
                    file=file,
                )
        reported = {each.face for each in known.lost}
        self.lost: tuple[LostFace, ...] = (
            *known.lost,
            *(
                LostFace("", known.names.get(n, ""), f"it {ENDLESS if endless(self._faces[n - 1]) else 'has no finite size'}", n)
                for n in (np.flatnonzero(~finite) + 1).tolist()
                if n not in reported
            ),
        )

    @classmethod
    def of(cls, content: PartContent, excluded: Mapping[int, str] | None = None) -> "Part":
        """Make a part from what a reader has found, with faces set aside."""
        part = cls(**{each.name: getattr(content, each.name) for each in fields(content)})
        part.aside = excluded or {}
        return part

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (packed(self._content), dict(self.aside))

    def __repr__(self) -> str:
        size = " x ".join(f"{length:.4g}" for length in self.size)
        return f"Part({self.file or 'shape'}, {len(self._faces)} faces, {size} mm)"

    @property
    def faces(self) -> tuple[FaceInfo, ...]:
        return self.measured()

    @property
    def key(self) -> tuple[Any, ...]:
        """Return all that makes this part what it is, beside the program that read it; of no file, by its shape's own bytes."""
        if self.sha256 is None:
            return self._shape_sum, dict(self.aside)
        return self.sha256, self.unit, self.picked, dict(self.aside), self.lost, tuple(self._content.warnings)

    @cached_property
    def _shape_sum(self) -> bytes:
        return digest(packed(self._content))

    def measured(self, at: Callable[[int], None] = lambda face: None, *, jobs: int = 1) -> tuple[FaceInfo, ...]:
        """`faces`; where they are yet to be measured, `at` is told which one is. With more `jobs` than one, a copy of the process
        measures every other one of many faces.
        """
        if not self._infos:
            count = len(self._faces)
            far = range(2, count + 1, 2) if jobs > 1 and count >= _MANY_FACES else range(0)
            _ = self.size  # which all of them ask
            with SideProcess(partial(self._described, far), _MEASURING, worth=bool(far)) as side:
                infos = {number: self._describe(number, at) for number in range(1, count + 1) if number not in far}
                if far:
                    described, measures, trims = side.result(partial(self._described, far, at))
                    infos |= described
                    self._measures |= measures
                    self._trims |= self._with_faces(trims)
            self._infos = tuple(infos[number] for number in range(1, count + 1))
        return self._infos

    def _described(
        self, numbers: Sequence[int], at: Callable[[int], None] = lambda face: None
    ) -> tuple[dict[int, FaceInfo], dict[int, Measure | None], dict[int, Trim | None]]:
        """What measuring tells of some faces, without anything of the kernel's."""
        infos = {number: self._describe(number, at) for number in numbers}
        mine = {number: each for number, each in self._measures.items() if number in infos}
        return infos, mine, {number: trim for number, trim in self._without_faces().items() if number in infos}

    def _without_faces(self) -> dict[int, Trim | None]:
        """The borders, but for the kernel's faces in them."""
        return {number: trim and replace(trim, face=None) for number, trim in self._trims.items()}

    def _with_faces(self, trims: Mapping[int, Trim | None]) -> dict[int, Trim | None]:
        """The borders of this part's faces, of what `_without_faces` gave."""
        return {number: trim and replace(trim, face=self.face(number)) for number, trim in trims.items()}

    def without(self, excluded: Mapping[int, str]) -> "Part":
        """The same part with more faces set aside, by number: why."""
        return Part.of(self._content, {**self.aside, **excluded})

    def facts(self, at: Callable[[int], None] = lambda face: None, *, jobs: int = 1) -> dict[str, Any]:
        """Return what measuring tells, for `recall` in another process that reads the same part; arguments as of `measured`."""
        infos = self.measured(at, jobs=jobs)
        return {"_infos": infos, "_measures": self._measures, "_box": self._box, "_trims": self._without_faces()}

    def recall(self, **facts: Any) -> None:
        """Take what another process knows of the same part."""
        if "_trims" in facts:
            facts["_trims"] = self._with_faces(facts["_trims"])
        if isinstance(facts.get("sewn"), SewnForm):
            facts["sewn"] = facts["sewn"].sewn()
        self.__dict__.update(facts)

    @cached_property
    def size(self) -> tuple[float, float, float]:
        return tuple(np.subtract(*self._box[::-1]).tolist())

    @property
    def warnings(self) -> tuple[str, ...]:
        warnings = [*self._content.warnings, *filter(None, [self.unit_doubt])]
        if self.looseness > LOOSEST * max(self.size):
            warnings.append(
                f"edges are known to no better than {self.looseness:.3g} mm in a part {max(self.size):.4g} mm long, and some "
                "may be missing: export it again with a smaller uncertainty"
            )
        stopped = self.sewn.stopped if "sewn" in self.__dict__ else None
        if stopped is not None:
            warnings.append(
                f"sewing was stopped: {stopped}; faces that may belong together stay apart, and their sides are guesses"
            )
        return tuple(warnings)

    def face(self, number: int) -> TopoDS_Face:
        """The kernel's face of a number from 1."""
        return self._faces[self._checked(number) - 1]

    def surface(self, number: int) -> Surface:
        """Evaluator of a face's whole surface (not restricted to the face), in part coordinates."""
        if number not in self._surfaces:
            with translated("opening a surface", file=self.file, face=f"F{number}"):
                self._surfaces[number] = Surface(self.face(number))
        return self._surfaces[number]

    def adaptor(self, number: int) -> BRepAdaptor_Surface:
        """The kernel's own evaluator of the same."""
        return self.surface(number).adaptor

    def trim(self, number: int) -> Trim | None:
        """Border of a face in its parameter plane; None where it has none."""
        if number in self.aside:
            return None
        if number not in self._trims:
            with translated("reading a border", file=self.file, face=f"F{number}"):
                self._trims[number] = trim_of(self.face(number), self.surface(number))
        return self._trims[number]

    def measure(self, number: int) -> Measure | None:
        """Area, vector area and flux about the middle of the part's box; None where the face has no border."""
        if number not in self._measures:
            trim = self.trim(number)
            with translated("measuring a face", file=self.file, face=f"F{number}"):
                self._measures[number] = None if trim is None else measure(self.surface(number), trim, self.middle)
        return self._measures[number]

    @cached_property
    def _box(self) -> tuple[Floats, Floats]:
        with translated("measuring the part", error=ReadError, file=self.file):
            return box_of(self._faces, self.aside)

    def centre(self, number: int) -> tuple[float, float, float] | None:
        """Middle of the kernel's quick box around a face, mm; None where it has no finite size."""
        x, y, z = self._centres[self._checked(number) - 1].tolist()
        return (x, y, z) if np.isfinite((x, y, z)).all() else None

    @cached_property
    def middle(self) -> Floats:
        """Middle (3,) of the part's box, mm."""
        return 0.5 * np.add(*self._box)

    @cached_property
    def looseness(self) -> float:
        """Largest distance, mm, by which faces may miss each other along an edge that they share."""
        return float(ShapeAnalysis_ShapeTolerance().Tolerance(self.shape, 1))

    @cached_property
    def closed(self) -> bool:
        # A seam is used twice by one face; every other edge must be used once by each of two.
        uses = edge_uses(self._faces)
        return bool(uses) and all(len(users) % 2 == 0 for _, users in uses)

    @cached_property
    def unmeasured(self) -> frozenset[int]:
        """Numbers of the faces of which neither the area nor what they enclose is to be believed."""
        return frozenset({*self.aside, *(f.number for f in self.faces if f.unjudged in UNMEASURED)})

    @cached_property
    def sewn(self) -> Sewn:
        with translated("joining faces", file=self.file):
            return sew(self.shape, self._faces, float(np.linalg.norm(self.size)))

    def joined(self, number: int) -> TopoDS_Face:
        """A face with the edges that it shares with faces that it touches, in a solid or sewn."""
        return self.sewn.faces.get(number) or self.face(number)

    @cached_property
    def blends(self) -> frozenset[int]:
        """Numbers of the faces that are fillets and rounds: see `cad_io.part.edges`."""
        with translated("looking for blends", file=self.file):
            return blends(self)

    @cached_property
    def neighbours(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the faces across each face's edges; entry i is of face number i + 1."""
        return neighbours([self.joined(n) for n in range(1, len(self._faces) + 1)])

    def solid_shapes(self) -> Iterator[TopoDS_Shape]:
        """Every solid, as it stands in the shape."""
        return explore(self.shape, TopAbs_SOLID)

    def members(self, shape: TopoDS_Shape) -> list[tuple[int, TopoDS_Face]]:
        """Faces of a solid or a shell of the part, as they stand there, each with its number; 0 for none of the part's."""
        return [(self._numbers.FindIndex(face), TopoDS.Face_s(face)) for face in explore(shape, TopAbs_FACE)]

    @cached_property
    def _numbers(self) -> TopTools_IndexedMapOfShape:
        return shape_map(self.shape, TopAbs_FACE)

    @property
    def unit_doubt(self) -> str:
        """Why the length unit is doubtful, as `warnings` has it; empty where it is not."""
        return unit_doubt(self.size, self.unit_readings)

    def _checked(self, number: int) -> int:
        if not 1 <= number <= len(self._faces):
            raise IndexError(f"face numbers run from 1 to {len(self._faces)}, not {number}")
        return number

    def _describe(self, number: int, at: Callable[[int], None]) -> FaceInfo:
        at(number)
        surface, shape, area, reason, carrier = "other", "sculptured", 0.0, self.aside.get(number), None
        name, colour = self._content.names.get(number, ""), self._content.colours.get(number)
        if reason is not None:
            return FaceInfo(number, name, surface, shape, area, colour, reason)
        try:
            surface = _KINDS.get(kind_of(self.adaptor(number)), "other")
            shape = surface if surface in SIMPLE_KINDS else "sculptured"
            reason, area = self._judgeable(number)
            trim = self.trim(number)
            carrier = stored_carrier(surface, self.adaptor(number))
            if reason is None and shape == "sculptured" and trim:
                shape, carrier = recognise(self.surface(number), trim.box)
            carrier = sided(carrier, self.surface(number), trim.box) if trim else None
        except Exception as thrown:
            if not (is_kernel_error(thrown) or is_kernel_error(thrown.__cause__ or thrown)):
                raise
            reason = reason or f"the CAD kernel cannot work with this face ({thrown})"
        altered = next((each.why for each in self.lost if each.face == number), None)
        if altered is not None and reason is None:
            # What it encloses and how large it is would be those of another face.
            reason, area = f"is not as it was written in the file: {altered}", 0.0
        return FaceInfo(number, name, surface, shape, area, colour, reason, carrier)

    def _judgeable(self, number: int) -> tuple[str | None, float]:
        """Why the face cannot be judged (None if it can), and its area, mm2: 0 where that is not to be believed."""
        readable = bool(edges_of(self.face(number))) and kind_of(self.adaptor(number)) != "OtherSurface"
        trim, measured = (self.trim(number), self.measure(number)) if readable else (None, None)
        least = _LEAST_AREA * float(np.dot(self.size, self.size))
        reason = why_unjudged(self.face(number), self.surface(number), trim, measured, least)
        return reason, max(measured.area, 0.0) if measured is not None and reason in (None, NO_AREA) else 0.0


def _again(content: PartContent, excluded: Mapping[int, str]) -> Part:
    """A part that was pickled."""
    return Part.of(unpacked(content), excluded)
