"""A split part as STEP: the input's products, every piece a face with its own name, colour and layers.

The same input gives the same bytes. The kernel keeps the groups of styles, one a product, in a map by address and writes them
in the map's order (OCCT 7.9), which differs from run to run: here they follow the order of the products, and are numbered anew.
Two instances of one product differ in their verdicts, so each is a product. Solids, shells and sheets are put into products so
that FreeCAD shows their colours, too. Some surfaces of revolution that cross their axis come back from STEP as another part of
it.
"""

import contextlib
import os
import re
import tempfile
import unicodedata
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.BRepGProp import BRepGProp
from OCP.BRepTools import BRepTools_Modifier
from OCP.GeomAbs import GeomAbs_SurfaceOfRevolution, GeomAbs_Torus
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.ShapeCustom import ShapeCustom, ShapeCustom_DirectModification
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Shell
from OCP.TopTools import TopTools_IndexedMapOfShape
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from cad_io.arrays import Floats, Style
from cad_io.errors import WriteError
from cad_io.kernel import edges_of, explore, faces, may_refuse, shape_map, silence, translated
from cad_io.kernel.shapes import Node, children, compound, flat, placed
from cad_io.part import Part
from cad_io.split.pieces import Piece, Split
from plan_cutters_base.forks import ChildDied, TimeLimit, limited
from plan_cutters_base.whole import whole

#: Of every file: a fixed one, so that the same input gives the same bytes.
TIME_STAMP = "2000-01-01T00:00:00"
ORIGIN = "plan-cutters"
#: Processor seconds that writing may take, and more for each piece of a face: a few ms each are usual.
SECONDS, _A_FACE = 60.0, 0.1


class Other(NamedTuple):
    """A body that is none of the part: its name, shape, place (3, 4) in part coordinates (a rotation and a shift, mm), and sRGB
    colour."""

    name: str
    shape: Any
    place: Floats
    rgb: tuple[float, float, float]


def write_step(
    split: Split,
    path: str | Path,
    style: Callable[[Piece], Style],
    *,
    product: str,
    tree: Sequence[Node] = (),
    layers: Mapping[int, Sequence[str]] | None = None,
    schema: str = "AP242DIS",
    others: Sequence[Other] = (),
) -> None:
    """Write all pieces, coloured and named, in the products that they belong to.

    path: appears whole or not at all. style: name and colour of a piece; names become ASCII. product: name of products that have
    none. tree: products of the part, which hold all its faces; default a single one. layers: face number -> layers of the face.
    schema: the kernel's name of an application protocol: `AP242DIS`, `AP214IS`, `AP203`. others: bodies beside the part, a
    product each.

    A copy of the process writes, which is ended where it takes longer than so many faces explain. Raises WriteError where the
    file cannot be written, or the kernel lost a face, name or colour on the way, or does not come to an end.
    """
    silence()
    file = str(path)
    styles = {id(piece): style(piece) for piece in split.pieces}
    with whole(path, WriteError) as temporary:

        def write() -> None:
            with translated("writing STEP", error=WriteError, file=file):
                _write(split, temporary, lambda piece: styles[id(piece)], product, tree, layers or {}, schema, others, file)

        try:
            limited(write, SECONDS + _A_FACE * len(split.pieces), processor=True, passing=(WriteError, OSError))
        except TimeLimit:
            raise WriteError("the CAD kernel does not come to an end of writing STEP", file=file) from None
        except ChildDied as died:
            raise WriteError(f"the CAD kernel fails to write STEP ({died})", file=file) from None


def _write(
    split: Split, temporary: Path, style: Callable[[Piece], Style], product: str, tree: Sequence[Node],
    layers: Mapping[int, Sequence[str]], schema: str, others: Sequence[Other], file: str,
) -> None:  # fmt: skip
    """Write the file without a limit; errors name `file`."""
    with _settings(schema, file):
        document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
        filled = _Document(document, style, layers, product, file)
        filled.fill(split, tree)
        if others:
            filled.add(others)
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        writer.SetLayerMode(True)
        if not writer.Transfer(document, STEPControl_AsIs):
            raise WriteError("the CAD kernel cannot turn the part into STEP", file=file)
        header = APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
        header.SetName(TCollection_HAsciiString(f"{_ascii(product)}.step"))
        header.SetTimeStamp(TCollection_HAsciiString(TIME_STAMP))
        header.SetAuthorValue(1, TCollection_HAsciiString(ORIGIN))
        header.SetOrganizationValue(1, TCollection_HAsciiString(ORIGIN))
        header.SetOriginatingSystem(TCollection_HAsciiString(ORIGIN))
        header.SetAuthorisation(TCollection_HAsciiString(ORIGIN))
        if writer.Write(str(temporary)) != IFSelect_RetDone:
            raise WriteError("the CAD kernel cannot write the file (is the disk full?)", file=file)
    text = temporary.read_bytes()
    # Faces, names and styles in the written text are counted: the kernel is known to lose some in silence.
    written = len(re.findall(rb"=\s*ADVANCED_FACE\s*\(", text))
    styles = len(re.findall(rb"=\s*(?:OVER_RIDING_)?STYLED_ITEM\s*\(", text))
    if written < filled.faces or styles < filled.styles:
        raise WriteError(
            f"of {filled.faces} faces the CAD kernel wrote {written}, of {filled.styles} colours {styles}", file=file
        )
    named = len(re.findall(rb"=\s*ADVANCED_FACE\s*\(\s*'[^']", text))
    if named < filled.named:
        raise WriteError(f"of {filled.named} names of faces the CAD kernel wrote {named}", file=file)
    temporary.write_bytes(canonical(text))


@contextlib.contextmanager
def _settings(schema: str, file: str) -> Iterator[None]:
    """The kernel's settings are global: they are put back for the host's own exports."""
    STEPCAFControl_Controller.Init_s()  # before it, settings are ignored
    old_schema = Interface_Static.CVal_s("write.step.schema")
    old_names = Interface_Static.IVal_s("write.stepcaf.subshapes.name")
    try:
        if not Interface_Static.SetCVal_s("write.step.schema", schema):
            raise WriteError(f"no STEP schema is called {schema}", file=file)
        Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", 1)
        yield
    finally:
        Interface_Static.SetCVal_s("write.step.schema", old_schema)
        Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", old_names)


class _Document:
    """The kernel's document as it grows."""

    def __init__(
        self, document: Any, style: Callable[[Piece], Style], layers: Mapping[int, Sequence[str]], product: str, file: str
    ) -> None:
        self.shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
        self.colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
        self.layer_tool = XCAFDoc_DocumentTool.LayerTool_s(document.Main())
        self.style, self.layers, self.product, self.file = style, layers, product, file
        self.written = TopTools_IndexedMapOfShape()
        self.faces = self.styles = self.named = 0

    def fill(self, split: Split, tree: Sequence[Node]) -> None:
        tree = tree or [Node(self.product, "", TopLoc_Location(), faces=tuple(dict.fromkeys(p.face for p in split.pieces)))]
        leaves = [leaf for root in tree for leaf, _, _ in root.leaves()]
        leaf_of = {number: i for i, leaf in enumerate(leaves) for number in leaf.faces}
        owner = TopTools_IndexedMapOfShape()
        own_pieces = [piece for piece in split.pieces if owner.Add(piece.shape) == owner.Extent()]
        mine: dict[int, list[_Body]] = {id(leaf): [] for leaf in leaves}
        for shape in flat(split.shape):
            pieces = [own_pieces[owner.FindIndex(face) - 1] for face in faces(shape)]
            # What has no face (curves, points) goes with the first product.
            at = leaf_of[pieces[0].face] if pieces else 0
            mine[id(leaves[at])].append(_Body(shape, pieces))
        for root in tree:
            self.node(root, root.place, mine)
        self.shapes.UpdateAssemblies()

    def add(self, others: Sequence[Other]) -> None:
        """Products beside the part's, each of one colour."""
        for other in others:
            whole = compound([placed(other.shape, other.place)])
            label = self.shapes.AddShape(whole, False)
            _name(label, other.name)
            self.colours.SetColor(label, Quantity_Color(*other.rgb, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)
            self.faces += sum(_exact(face) for face in faces(whole))
        self.shapes.UpdateAssemblies()

    def node(self, node: Node, place: TopLoc_Location, mine: dict[int, list["_Body"]]) -> Any:
        """Label of a product; `place` is where it stands in the part. None if nothing of it is left."""
        if not node.children:
            bodies = mine[id(node)]
            return self.leaf(node.name or self.product, bodies, place) if bodies else None
        children = [(child, self.node(child, place.Multiplied(child.place), mine)) for child in node.children]
        label = self.shapes.NewShape()
        _name(label, node.name or self.product)
        for child, product in children:
            if product is not None:
                _name(self.shapes.AddComponent(label, product, child.place), child.instance or child.name)
        return label

    def leaf(self, name: str, bodies: Sequence["_Body"], place: TopLoc_Location) -> Any:
        """Label of a product made of bodies that stand at `place` in the part; of several solids, each is a product.

        FreeCAD forgets the colours of faces in a product of several solids.
        """
        solids = [body for body in bodies if body.solid]
        if len(solids) < 2:
            return self.simple(name, bodies, place)
        label = self.shapes.NewShape()
        _name(label, name)
        rest = [body for body in bodies if not body.solid]
        for number, group in enumerate([*([body] for body in solids), *([rest] if rest else [])], 1):
            product = self.simple(f"{name} {number}", group, place)
            _name(self.shapes.AddComponent(label, product, TopLoc_Location()), f"{name} {number}")
        return label

    def simple(self, name: str, bodies: Sequence["_Body"], place: TopLoc_Location) -> Any:
        """Label of a product of at most one solid."""
        back = place.Inverted()
        others, shells = _parted(bodies, self.style)
        # A fresh compound without a location: in a located shape, or one that is itself a face, faces get no label.
        whole = compound([s.Moved(back) for s in (*others, *(shell.shape for shell in shells))])
        images: list[Callable[[Any], Any]] = []
        if any(self.written.Contains(face) for face in _unplaced(whole)):
            # An instance of what is written already: its styles would go to those faces.
            copy = BRepBuilderAPI_Copy()
            copy.Perform(whole, False, False)
            whole = copy.Shape()
            images.append(copy.ModifiedShape)
        whole, direct = _right_handed(whole)
        images.append(direct)
        for face in _unplaced(whole):
            self.written.Add(face)
        label = self.shapes.AddShape(whole, False)
        _name(label, name)

        def dress(shape: Any, title: str, rgb: tuple[float, float, float] | None, face: int) -> Any:
            shape = shape.Moved(back)
            for image in images:
                shape = image(shape)
            sub = self.shapes.AddSubShape(label, shape)
            if sub.IsNull():
                raise WriteError("the CAD kernel gives this face no label", file=self.file, face=f"F{face}")
            _name(sub, title)
            if rgb:
                self.colours.SetColor(sub, Quantity_Color(*rgb, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)
                # What holds only triangles is written as such, not as an advanced face, and gets no colour.
                self.styles += _exact(shape)
            return sub

        for shell in shells:
            if shell.title:
                dress(shell.shape, shell.title, shell.rgb, shell.face)
        for piece in _pieces(bodies):
            self.faces += _exact(piece.shape)
            self.named += _exact(piece.shape) and bool(self.style(piece)[0])
            sub = dress(piece.shape, *self.style(piece)[:2], piece.face)
            for layer in self.layers.get(piece.face, ()):
                self.layer_tool.SetLayer(sub, TCollection_ExtendedString(_ascii(layer)))
        return label


class _Body(NamedTuple):
    """A solid, a shell, a loose face or a wire; its pieces."""

    shape: Any
    pieces: list[Piece]

    @property
    def solid(self) -> bool:
        return bool(shape_map(self.shape, TopAbs_SOLID).Extent())


class _Shell(NamedTuple):
    """A shell in no solid; with a title it gets a label of its own."""

    shape: Any
    face: int
    title: str = ""
    rgb: tuple[float, float, float] | None = None


def _parted(bodies: Sequence[_Body], style: Callable[[Piece], Style]) -> tuple[list[Any], list[_Shell]]:
    """Shapes of a product that are no sheets, and its shells.

    Pieces of a face that stands in no shell get a shell of their own, or readers would see them as separate surfaces.
    Where several shells stand without a solid, every piece is a shell with the piece's colour: of other shells FreeCAD
    (0.20) forgets the colours of faces. The kernel writes an edge between two of them twice.
    """
    others = [b.shape for b in bodies if b.shape.ShapeType() not in (TopAbs_SHELL, TopAbs_FACE)]
    whole = [b for b in bodies if b.shape.ShapeType() == TopAbs_SHELL]
    loose: dict[int, list[Piece]] = {}
    for body in bodies:
        if body.shape.ShapeType() == TopAbs_FACE:
            loose.setdefault(body.pieces[0].face, []).extend(body.pieces)
    if len(whole) + len(loose) > 1 and not any(body.solid for body in bodies):
        sheets = [p for b in whole for p in b.pieces] + [p for pieces in loose.values() for p in pieces]
        return others, [_Shell(_shell([p]), p.face, *style(p)[:2]) for p in sheets]
    shells = [_Shell(b.shape, b.pieces[0].face) for b in whole if b.pieces]
    shells += [_Shell(_shell(pieces), n) for n, pieces in loose.items()]
    return others, shells


def _shell(pieces: Sequence[Piece]) -> TopoDS_Shell:
    builder, shell = BRep_Builder(), TopoDS_Shell()
    builder.MakeShell(shell)
    for piece in pieces:
        builder.Add(shell, piece.shape)
    return shell


def _pieces(bodies: Sequence[_Body]) -> list[Piece]:
    """Of a product, each once, also where two bodies share a face."""
    return list({id(p): p for body in bodies for p in body.pieces}.values())


def _exact(shape: Any) -> bool:
    """Whether a face, or any face of a shape, has a surface and a border: others are not written as advanced faces."""
    faces = (TopoDS.Face_s(face) for face in explore(shape, TopAbs_FACE))
    return any(BRep_Tool.Surface_s(face) is not None and edges_of(face) for face in faces)


def _right_handed(whole: Any) -> tuple[Any, Callable[[Any], Any]]:
    """Of a compound without a location: the same without left-handed surfaces, and what gives the image of a shape in it.

    STEP has no such surfaces, which FreeCAD makes: the kernel would replace them, and lose names on the way.
    """
    # The kernel crashes on a face without a surface: members that hold one stay as they are.
    members = [(m, all(BRep_Tool.Surface_s(face) is not None for face in faces(m))) for m in children(whole)]
    exact = compound([m for m, turns in members if turns])
    if ShapeCustom.DirectFaces_s(exact).IsSame(exact):
        return whole, lambda shape: shape
    turned = BRepTools_Modifier(exact)
    turned.Perform(ShapeCustom_DirectModification())
    inside = shape_map(exact, TopAbs_FACE), shape_map(exact, TopAbs_SHELL)

    def image(shape: Any) -> Any:
        return turned.ModifiedShape(shape) if any(shapes.Contains(shape) for shapes in inside) else shape

    return compound([turned.ModifiedShape(m) if turns else m for m, turns in members]), image


def _unplaced(shape: Any) -> Iterator[Any]:
    return (face.Located(TopLoc_Location()) for face in explore(shape, TopAbs_FACE))


def _name(label: Any, name: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(_ascii(name)))


def _ascii(name: str) -> str:
    """Accents dropped, other foreign characters as `?`: names stay readable in any viewer."""
    bare = "".join(c for c in unicodedata.normalize("NFKD", name) if not unicodedata.combining(c))
    return bare.encode("ascii", "replace").decode()


_GROUP = b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
_STRING = rb"'(?:[^']|'')*'"
_ENTITY = re.compile(rb"#(\d+)\s*=\s*((?:" + _STRING + rb"|[^';])*);")
_TOKEN = re.compile(rb"\s*(" + _STRING + rb"|#(\d+)|,|[^',#\s]+)")
_WIDTH = 72


def canonical(text: bytes) -> bytes:
    """The text with its groups of styles in the order of what they style.

    Entities before the first group do not refer to later ones, and their order is that of the shapes written.
    """
    first = re.search(rb"^#(\d+)\s*=\s*" + _GROUP, text, re.MULTILINE)
    if first is None:
        return text
    begin, end = first.start(), text.rindex(b"ENDSEC;")
    entities = {int(m[1]): m[2].strip() for m in _ENTITY.finditer(text, begin, end)}
    below = {number: [r for r in _references(entity) if r in entities] for number, entity in entities.items()}
    inner = {r for references in below.values() for r in references}
    roots = [number for number in entities if number not in inner]
    # Numbers of what was written before are the same in every run.
    groups = sorted(
        (number for number in roots if entities[number].startswith(_GROUP)),
        key=lambda n: [r for e in _walk(n, below) for r in _references(entities[e]) if r not in entities],
    )
    following = iter(groups)
    ordered = [next(following) if entities[n].startswith(_GROUP) else n for n in roots]
    new: dict[int, int] = {}
    for root in ordered:
        for number in _walk(root, below, new):
            new[number] = int(first[1]) + len(new)
    lines = [_wrapped(number, entities[old], new) for old, number in new.items()]
    return text[:begin] + b"".join(lines) + text[end:]


def _references(entity: bytes) -> Iterator[int]:
    return (int(m[2]) for m in _TOKEN.finditer(entity) if m[2])


def _walk(root: int, below: dict[int, list[int]], known: dict[int, int] | None = None) -> Iterator[int]:
    """An entity and all that it refers to, each once, in the kernel's order; what is `known` when its turn comes is left out."""
    seen: set[int] = set()
    stack = [root]
    while stack:
        number = stack.pop()
        if number not in seen and number not in (known or {}):
            seen.add(number)
            yield number
            stack += reversed(below[number])


def _wrapped(number: int, entity: bytes, new: dict[int, int]) -> bytes:
    """The entity on lines as long as the kernel's, with its references renumbered."""
    lines, line = [], b"#%d = " % number
    for match in _TOKEN.finditer(entity):
        token = b"#%d" % new.get(int(match[2]), int(match[2])) if match[2] else match[1]
        if len(line) + len(token) > _WIDTH and token != b",":
            lines.append(line)
            line = b"  "
        line += token
    return b"\n".join([*lines, line]) + b";\n"


#: Processor seconds that it may take, and more for each face.
_BACK, _BACK_A_FACE = 20.0, 0.2
#: Areas that differ by a smaller share are one.
_SAME = 0.01


def changed_by_step(part: Part) -> Mapping[int, float]:
    """Faces whose area is another one once they were written as STEP and read again, with that area, mm2; it is looked for once.

    Only surfaces of revolution and tori are looked at: planes, quadrics and splines come back as they are. A face that does not
    come back at all has the area 0.
    """
    if part.changed_by_step is not None:
        return part.changed_by_step
    numbers = [
        f.number for f in part.faces if f.area > 0.0 and f.surface in ("revolution", "torus") and _doubtful(part, f.number)
    ]
    part.changed_by_step = {}
    if numbers:
        with contextlib.suppress(TimeLimit, ChildDied):
            areas = limited(lambda: _areas(part, numbers), _BACK + _BACK_A_FACE * len(numbers))
            pairs = zip(numbers, areas, strict=True)
            part.changed_by_step = {n: there for n, (here, there) in pairs if abs(there - here) > _SAME * here}
    return part.changed_by_step


def _doubtful(part: Part, number: int) -> bool:
    """Whether the whole surface may cross its axis: a torus does where its tube is wider than the circle about which it lies."""
    adaptor = part.adaptor(number)
    if adaptor.GetType() == GeomAbs_Torus:
        torus = adaptor.Torus()
        return bool(torus.MinorRadius() >= torus.MajorRadius())
    return bool(adaptor.GetType() == GeomAbs_SurfaceOfRevolution)


def _areas(part: Part, numbers: list[int]) -> list[tuple[float, float]]:
    """Areas of faces by the kernel, as they are and as they come back."""
    silence()
    pairs = list[tuple[float, float]]()
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "face.step")
        for number in numbers:
            here, there = _area(part.face(number)), 0.0
            with may_refuse():
                writer, reader = STEPControl_Writer(), STEPControl_Reader()
                writer.Transfer(part.face(number), STEPControl_AsIs)
                if writer.Write(file) == IFSelect_RetDone and reader.ReadFile(file) == IFSelect_RetDone:
                    reader.TransferRoots()
                    there = _area(reader.OneShape())
            pairs.append((here, there))
    return pairs


def _area(shape: object) -> float:
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties)
    return float(properties.Mass())
