"""A part: the kernel's shape, its faces by number, and what is known about each.

Making a part costs next to nothing beside reading it: what is known about a face is worked out when first asked for.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_OtherSurface
from OCP.ShapeAnalysis import ShapeAnalysis_ShapeTolerance
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape

from cad_io.arrays import SIMPLE_KINDS, FaceInfo, Floats, LostFace
from cad_io.errors import ReadError
from cad_io.face.carrier import sided, stored_carrier
from cad_io.face.measure import Measure, measure
from cad_io.face.recognise import recognise
from cad_io.face.trim import Trim, trim_of
from cad_io.kernel import edges_of, explore, faces, is_kernel_error, shape_map, translated
from cad_io.kernel.assembly import Node
from cad_io.kernel.natural import ENDLESS, endless
from cad_io.part.blends import Bare, blends
from cad_io.part.boxes import box_of, face_box
from cad_io.part.packing import PartContent, packed, unpacked
from cad_io.part.sew import Sewn, SewnForm, edge_uses, neighbours, sew
from cad_io.part.unjudged import NO_AREA, UNMEASURED, why_unjudged
from cad_io.surface import Surface
from cad_io.units import UnitReading, unit_doubt
from plan_cutters_base.forks import SideProcess
from plan_cutters_base.user_files import fingerprint

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
    file, sha256 : str, optional
        Where it was read from, and the checksum of those bytes.
    unit : str, optional
        The unit that its lengths were taken to be in, where that is not what the source says.
    names, colours : mapping, optional
        By face number: names and sRGB colours (0 to 1) found in the file.
    layers : mapping, optional
        By face number: the layers that it is on in the file.
    tree : tuple of Node, optional
        The products in the file; default one without a name.
    warnings : sequence of str
        What the reader found odd; odd sizes are added here.
    picked : tuple of int, optional
        Numbers of the faces that were picked on the object which the part was made from.
    lost : sequence of LostFace, optional
        Faces written in the file that are not here, or not as written; faces without a finite size are added here.

    Attributes
    ----------
    shape, file, sha256, unit, layers, tree, picked : as given
    references : tuple of (str, str or None)
        Files that the part's file refers to: the path from its folder and the SHA-256; None: it is not there.
    unit_readings : tuple of UnitReading
        What is doubtful of what the file says about its unit.
    encoding : str
        What the encoding of its names is called, where the file has an older one; else empty.
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
    warnings : tuple of str

    Raises
    ------
    ReadError
        The shape holds no face, or the kernel cannot make sense of it.
    """

    def __init__(
        self,
        shape: TopoDS_Shape,
        *,
        file: str | None = None,
        sha256: str | None = None,
        unit: str | None = None,
        names: Mapping[int, str] | None = None,
        colours: Mapping[int, tuple[float, float, float]] | None = None,
        layers: Mapping[int, tuple[str, ...]] | None = None,
        tree: tuple[Node, ...] = (),
        warnings: tuple[str, ...] = (),
        picked: tuple[int, ...] = (),
        lost: tuple[LostFace, ...] = (),
    ) -> None:
        self.shape, self.file, self.sha256, self.picked = shape, file, sha256, picked
        self.references: tuple[tuple[str, str | None], ...] = ()
        self.unit_readings: tuple[UnitReading, ...] = ()
        self.encoding = ""
        self.aside: Mapping[int, str] = {}
        self.unit = unit
        with translated("looking for faces", error=ReadError, file=file):
            self._faces = faces(shape)
        if not self._faces:
            raise ReadError("holds no surface (no faces): export it as a solid or surface model", file=file)
        self.layers = dict(layers or {})
        self.tree = tree or (Node("", "", TopLoc_Location(), faces=tuple(range(1, len(self._faces) + 1))),)
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
        self._names, self._colours, self._said = names or {}, colours or {}, warnings
        reported = {each.face for each in lost}
        self.lost = (
            *lost,
            *(
                LostFace("", self._names.get(n, ""), f"it {ENDLESS if endless(self._faces[n - 1]) else 'has no finite size'}", n)
                for n in (np.flatnonzero(~finite) + 1).tolist()
                if n not in reported
            ),
        )

    @classmethod
    def of(cls, content: PartContent) -> "Part":
        """Make a part from what a reader has found, by the names of the parameters, with its `references`."""
        part = cls(**{name: value for name, value in content.items() if name not in ("references", "unit_readings", "encoding")})
        part.references, part.unit_readings = content.get("references", ()), content.get("unit_readings", ())
        part.encoding = content.get("encoding", "")
        return part

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (packed(self._found()), dict(self.aside))

    def _found(self) -> PartContent:
        """Return the arguments that the part was made from, by the names of its parameters."""
        return {
            "shape": self.shape, "file": self.file, "sha256": self.sha256, "unit": self.unit, "names": self._names,
            "colours": self._colours, "layers": self.layers, "tree": self.tree, "warnings": self._said,
            "picked": self.picked, "lost": self.lost, "references": self.references,
            "unit_readings": self.unit_readings, "encoding": self.encoding,
        }  # fmt: skip

    def __repr__(self) -> str:
        size = " x ".join(f"{length:.4g}" for length in self.size)
        return f"Part({self.file or 'shape'}, {len(self._faces)} faces, {size} mm)"

    @property
    def fingerprint(self) -> str:
        """Checksum of its file with all that this refers to; empty where it is of no file."""
        return "" if self.sha256 is None else fingerprint(self.sha256, self.references)

    @property
    def faces(self) -> tuple[FaceInfo, ...]:
        return self.measured()

    @property
    def key(self) -> tuple[Any, ...] | None:
        """Return all that makes this part what it is, beside the program that read it; None where it is of no file."""
        if self.sha256 is None:
            return None
        return self.fingerprint, self.unit, self.picked, dict(self.aside), self.lost, self._said

    def measured(self, at: Callable[[int], None] = lambda face: None, *, jobs: int = 1) -> tuple[FaceInfo, ...]:
        """`faces`; where they are yet to be measured, `at` is told which one is. With more `jobs` than one, a copy of the process
        measures every other one of many faces.
        """
        if not self._infos:
            count = len(self._faces)
            far = range(2, count + 1, 2) if jobs > 1 and count >= _MANY_FACES else range(0)
            _ = self.size  # which all of them ask
            with SideProcess(partial(self._described, far), _MEASURING, worth=bool(far)) as side:
                infos = {number: self._describe_at(number, at) for number in range(1, count + 1) if number not in far}
                if far:
                    described, measures, trims = side.result(partial(self._described, far, at))
                    infos |= described
                    self._measures |= measures
                    self._trims |= self._with_faces(trims)
            self._infos = tuple(infos[number] for number in range(1, count + 1))
        return self._infos

    def _describe_at(self, number: int, at: Callable[[int], None]) -> FaceInfo:
        at(number)
        return self._describe(number)

    def _described(
        self, numbers: Sequence[int], at: Callable[[int], None] = lambda face: None
    ) -> tuple[dict[int, FaceInfo], dict[int, Measure | None], dict[int, Trim | None]]:
        """What measuring tells of some faces, without anything of the kernel's."""
        infos = {number: self._describe_at(number, at) for number in numbers}
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
        part = Part.of(self._found())
        part.aside = {**self.aside, **excluded}
        return part

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
        low, high = self._box
        return tuple((high - low).tolist())

    @property
    def warnings(self) -> tuple[str, ...]:
        stopped = self.sewn.stopped if "sewn" in self.__dict__ else None
        return (*self._said, *filter(None, [self.unit_doubt]), *self._loose_warnings(), *_sewing_warnings(stopped))

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
        low, high = self._box
        return 0.5 * (low + high)

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

    @cached_property
    def blends(self) -> frozenset[int]:
        """Numbers of the faces that are fillets and rounds: see `cad_io.part.blends`."""
        with translated("looking for blends", file=self.file):
            joined, trim, surface = self.sewn.faces, self.trim, self.surface
            faces = [
                Bare(
                    f,
                    joined.get(f.number) or self.face(f.number),
                    trim(f.number),
                    None if f.number in self.aside else surface(f.number),
                )
                for f in self.faces
            ]
            return blends(faces, float(np.linalg.norm(self.size)))

    @cached_property
    def neighbours(self) -> tuple[tuple[int, ...], ...]:
        """Numbers of the faces across each face's edges; entry i is of face number i + 1."""
        return neighbours([self.sewn.faces.get(i + 1, face) for i, face in enumerate(self._faces)])

    def solid_shapes(self) -> Iterator[TopoDS_Shape]:
        """Every solid, as it stands in the shape."""
        return explore(self.shape, TopAbs_SOLID)

    @property
    def unit_doubt(self) -> str:
        """Why the length unit is doubtful, as `warnings` has it; empty where it is not."""
        return unit_doubt(self.size, self.unit_readings)

    def _loose_warnings(self) -> Iterator[str]:
        if self.looseness > LOOSEST * max(self.size):
            yield (
                f"edges are known to no better than {self.looseness:.3g} mm in a part {max(self.size):.4g} mm long, and some "
                "may be missing: export it again with a smaller uncertainty"
            )

    def _checked(self, number: int) -> int:
        if not 1 <= number <= len(self._faces):
            raise IndexError(f"face numbers run from 1 to {len(self._faces)}, not {number}")
        return number

    def _describe(self, number: int) -> FaceInfo:
        surface, shape, area, reason, carrier = "other", "sculptured", 0.0, self.aside.get(number), None
        name, colour = self._names.get(number, ""), self._colours.get(number)
        if reason is not None:
            return FaceInfo(number, name, surface, shape, area, colour, reason)
        try:
            kind = str(self.adaptor(number).GetType()).rsplit("GeomAbs_", 1)[-1]
            surface = _KINDS.get(kind, "other")
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
        readable = bool(edges_of(self.face(number))) and self.surface(number).adaptor.GetType() != GeomAbs_OtherSurface
        trim, measured = (self.trim(number), self.measure(number)) if readable else (None, None)
        least = _LEAST_AREA * float(np.dot(self.size, self.size))
        reason = why_unjudged(self.face(number), self.surface(number), trim, measured, least)
        return reason, max(measured.area, 0.0) if measured is not None and reason in (None, NO_AREA) else 0.0


def _again(content: PartContent, excluded: Mapping[int, str]) -> Part:
    """A part that was pickled."""
    part = Part.of(unpacked(content))
    part.aside = excluded
    return part


def _sewing_warnings(stopped: str | None) -> Iterator[str]:
    if stopped is not None:
        yield f"sewing was stopped: {stopped}; faces that may belong together stay apart, and their sides are guesses"
