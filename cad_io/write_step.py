"""A split part as STEP: the input's products, every piece a face with its own name, colour and layers.

The same input gives the same bytes. Two instances of one product differ in their verdicts, so each is a product.
"""

import re
import unicodedata
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shell
from OCP.TopTools import TopTools_IndexedMapOfShape
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from cad_io.arrays import Style
from cad_io.aside import aside
from cad_io.assembly import Node
from cad_io.components import compound, flat
from cad_io.errors import WriteError
from cad_io.kernel import explore, silence, translated
from cad_io.split import Piece, Split

#: Of every file: a fixed one, so that the same input gives the same bytes.
TIME_STAMP = "2000-01-01T00:00:00"
ORIGIN = "plan-cutters"


def write_step(
    split: Split,
    path: str | Path,
    style: Callable[[Piece], Style],
    *,
    product: str,
    tree: Sequence[Node] = (),
    layers: Mapping[int, Sequence[str]] | None = None,
    schema: str = "AP242DIS",
) -> None:
    """Write all pieces, coloured and named, in the products that they belong to.

    Parameters
    ----------
    split : Split
        Its pieces `beside` go into a product of their own.
    path : path-like
        Appears whole or not at all.
    style : callable
        Name and colour of a piece. Names become ASCII.
    product : str
        Name of products that have none.
    tree : sequence of Node
        Products of the part, which hold all its faces; default a single one.
    layers : mapping, optional
        Face number -> layers of the face.
    schema : str
        The kernel's name of an application protocol: `AP242DIS`, `AP214IS`, `AP203`.

    Raises
    ------
    WriteError
        The file cannot be written, or the kernel lost a face, name or colour on the way.
    """
    silence()
    file = str(path)
    with aside(path) as temporary, translated("writing STEP", error=WriteError, file=file):
        with _settings(schema, file):
            document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
            _Document(document, style, layers or {}, product, file).fill(split, tree)
            writer = STEPCAFControl_Writer()
            writer.SetColorMode(True)
            writer.SetNameMode(True)
            writer.SetLayerMode(True)
            if not writer.Transfer(document, STEPControl_AsIs):
                raise WriteError("the CAD kernel cannot turn the part into STEP", file=file)
            _head(writer.ChangeWriter().Model(), product)
            if writer.Write(str(temporary)) != IFSelect_RetDone:
                raise WriteError("the CAD kernel cannot write the file (is the disk full?)", file=file)
        # What holds only triangles is written as such, not as an advanced face.
        pieces = [*split.pieces, *(piece for beside in split.beside.values() for piece in beside)]
        _recount(temporary, sum(BRep_Tool.Surface_s(piece.shape) is not None for piece in pieces), file)


@contextmanager
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
        self,
        document: Any,
        style: Callable[[Piece], Style],
        layers: Mapping[int, Sequence[str]],
        product: str,
        file: str,
    ) -> None:
        self.shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
        self.colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
        self.layer_tool = XCAFDoc_DocumentTool.LayerTool_s(document.Main())
        self.style, self.layers, self.product, self.file = style, layers, product, file

    def fill(self, split: Split, tree: Sequence[Node]) -> None:
        pieces: dict[int, list[Piece]] = {}
        for piece in split.pieces:
            pieces.setdefault(piece.face, []).append(piece)
        tree = tree or [Node(self.product, "", TopLoc_Location(), faces=tuple(pieces))]
        leaves = [leaf for root in tree for leaf, _, _ in root.leaves()]
        leaf_of = {number: i for i, leaf in enumerate(leaves) for number in leaf.faces}
        owner = TopTools_IndexedMapOfShape()
        number_of = [piece.face for piece in split.pieces if owner.Add(piece.shape) == owner.Extent()]
        parts: dict[int, list[Any]] = {}
        for part in flat(split.shape):
            first = next(explore(part, TopAbs_FACE), None)
            # What has no face (curves, points) goes with the first product.
            at = 0 if first is None else leaf_of[number_of[owner.FindIndex(first) - 1]]
            parts.setdefault(at, []).append(part)
        mine = {
            id(leaf): (parts.get(i, []), [p for n in leaf.faces for p in pieces[n]]) for i, leaf in enumerate(leaves)
        }
        for root in tree:
            self.node(root, root.place, mine)
        for number, beside in split.beside.items():
            self.leaf(f"F{number} regions", [p.shape for p in beside], beside, TopLoc_Location())
        self.shapes.UpdateAssemblies()

    def node(self, node: Node, place: TopLoc_Location, mine: dict[int, tuple[list[Any], list[Piece]]]) -> Any:
        """Label of a product; `place` is where it stands in the part. None if nothing of it is left."""
        if not node.children:
            parts, pieces = mine[id(node)]
            return self.leaf(node.name, parts, pieces, place) if parts else None
        found = [(child, self.node(child, place.Multiplied(child.place), mine)) for child in node.children]
        label = self.shapes.NewShape()
        _name(label, node.name or self.product)
        for child, product in found:
            if product is not None:
                _name(self.shapes.AddComponent(label, product, child.place), child.instance or child.name)
        return label

    def leaf(self, name: str, parts: Sequence[Any], pieces: Sequence[Piece], place: TopLoc_Location) -> Any:
        """Label of a product made of parts that stand at `place` in the part."""
        back = place.Inverted()
        label = self.shapes.AddShape(_whole(parts, pieces, back), False)
        _name(label, name or self.product)
        for piece in pieces:
            sub = self.shapes.AddSubShape(label, piece.shape.Moved(back))
            if sub.IsNull():
                raise WriteError("the CAD kernel gives this face no label", file=self.file, face=f"F{piece.face}")
            title, rgb = self.style(piece)
            _name(sub, title)
            self.colours.SetColor(sub, Quantity_Color(*rgb, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)
            for layer in self.layers.get(piece.face, ()):
                self.layer_tool.SetLayer(sub, TCollection_ExtendedString(_ascii(layer)))
        return label


def _name(label: Any, name: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(_ascii(name)))


def _whole(parts: Sequence[Any], pieces: Sequence[Piece], back: TopLoc_Location) -> Any:
    """A fresh compound without a location: in a located shape, or one that is itself a face, faces get no label.

    Pieces of a face that stands in no shell get a shell of their own, or readers would see them as separate surfaces.
    """
    loose = TopTools_IndexedMapOfShape()
    for part in parts:
        if part.ShapeType() == TopAbs_FACE:
            loose.Add(part)
    builder = BRep_Builder()
    shells: dict[int, Any] = {}
    for piece in pieces:
        if loose.Contains(piece.shape):
            if piece.face not in shells:
                shells[piece.face] = TopoDS_Shell()
                builder.MakeShell(shells[piece.face])
            builder.Add(shells[piece.face], piece.shape.Moved(back))
    return compound([p.Moved(back) for p in parts if p.ShapeType() != TopAbs_FACE] + list(shells.values()))


def _head(model: Any, product: str) -> None:
    header = APIHeaderSection_MakeHeader(model)
    header.SetName(TCollection_HAsciiString(f"{_ascii(product)}.step"))
    header.SetTimeStamp(TCollection_HAsciiString(TIME_STAMP))
    header.SetAuthorValue(1, TCollection_HAsciiString(ORIGIN))
    header.SetOrganizationValue(1, TCollection_HAsciiString(ORIGIN))
    header.SetOriginatingSystem(TCollection_HAsciiString(ORIGIN))
    header.SetAuthorisation(TCollection_HAsciiString(ORIGIN))


def _recount(path: Path, asked: int, file: str) -> None:
    """Count faces and styles in the written text: the kernel is known to lose some in silence."""
    text = path.read_bytes()
    faces = len(re.findall(rb"=\s*ADVANCED_FACE\s*\(", text))
    styles = len(re.findall(rb"=\s*(?:OVER_RIDING_)?STYLED_ITEM\s*\(", text))
    if faces < asked or styles < asked:
        raise WriteError(f"of {asked} faces the CAD kernel wrote {faces}, of them {styles} coloured", file=file)


def _ascii(name: str) -> str:
    """Accents dropped, other foreign characters as `?`: names stay readable in any viewer."""
    bare = "".join(c for c in unicodedata.normalize("NFKD", name) if not unicodedata.combining(c))
    return bare.encode("ascii", "replace").decode()
