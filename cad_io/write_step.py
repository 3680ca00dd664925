"""A split part as STEP: every piece a face with its own name and colour. The same input gives the same bytes."""

import re
import unicodedata
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopoDS import TopoDS_Shell
from OCP.TopTools import TopTools_IndexedMapOfShape
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from cad_io.arrays import Style
from cad_io.aside import aside
from cad_io.components import compound
from cad_io.errors import WriteError
from cad_io.kernel import explore, shape_map, silence, translated
from cad_io.split import Piece, Split

#: Of every file: a fixed one, so that the same input gives the same bytes.
TIME_STAMP = "2000-01-01T00:00:00"
ORIGIN = "plan-cutters"


def write_step(
    split: Split, path: str | Path, style: Callable[[Piece], Style], *, schema: str = "AP242DIS", product: str
) -> None:
    """Write all pieces, coloured and named, as one product.

    Parameters
    ----------
    split : Split
    path : path-like
        Appears whole or not at all.
    style : callable
        Name and colour of a piece. Names become ASCII.
    schema : str
        The kernel's name of an application protocol: `AP242DIS`, `AP214IS`, `AP203`.
    product : str
        Name of the product in the file.

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
            _fill(document, split, style, product, file)
            writer = STEPCAFControl_Writer()
            writer.SetColorMode(True)
            writer.SetNameMode(True)
            if not writer.Transfer(document, STEPControl_AsIs):
                raise WriteError("the CAD kernel cannot turn the part into STEP", file=file)
            _head(writer.ChangeWriter().Model(), product)
            if writer.Write(str(temporary)) != IFSelect_RetDone:
                raise WriteError("the CAD kernel cannot write the file (is the disk full?)", file=file)
        _recount(temporary, split, file)


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


def _fill(document: Any, split: Split, style: Callable[[Piece], Style], product: str, file: str) -> None:
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    root = shapes.AddShape(_product(split), False)
    TDataStd_Name.Set_s(root, TCollection_ExtendedString(_ascii(product)))
    for piece in split.pieces:
        label = shapes.AddSubShape(root, piece.shape)
        if label.IsNull():
            raise WriteError("the CAD kernel gives this face no label", file=file, face=f"F{piece.face}")
        name, rgb = style(piece)
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(_ascii(name)))
        colours.SetColor(label, Quantity_Color(*rgb, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)


def _product(split: Split) -> Any:
    """A fresh compound without a location: in a located shape, or one that is itself a face, faces get no label.

    Pieces of a face that stands in no shell get a shell of their own, or readers would see them as separate surfaces.
    """
    loose = TopTools_IndexedMapOfShape()
    for face in explore(split.shape, TopAbs_FACE, TopAbs_SHELL):
        loose.Add(face)
    if loose.IsEmpty():
        return compound([split.shape])
    builder = BRep_Builder()
    shells: dict[int, Any] = {}
    for piece in split.pieces:
        if loose.Contains(piece.shape):
            if piece.face not in shells:
                shells[piece.face] = TopoDS_Shell()
                builder.MakeShell(shells[piece.face])
            builder.Add(shells[piece.face], piece.shape)
    solids, others = explore(split.shape, TopAbs_SOLID), explore(split.shape, TopAbs_SHELL, TopAbs_SOLID)
    return compound([*solids, *others, *shells.values()])


def _head(model: Any, product: str) -> None:
    header = APIHeaderSection_MakeHeader(model)
    header.SetName(TCollection_HAsciiString(f"{_ascii(product)}.step"))
    header.SetTimeStamp(TCollection_HAsciiString(TIME_STAMP))
    header.SetAuthorValue(1, TCollection_HAsciiString(ORIGIN))
    header.SetOrganizationValue(1, TCollection_HAsciiString(ORIGIN))
    header.SetOriginatingSystem(TCollection_HAsciiString(ORIGIN))
    header.SetAuthorisation(TCollection_HAsciiString(ORIGIN))


def _recount(path: Path, split: Split, file: str) -> None:
    """Count faces and styles in the written text: the kernel is known to lose some in silence."""
    text = path.read_bytes()
    asked = shape_map(split.shape, TopAbs_FACE).Extent()
    faces = len(re.findall(rb"=\s*ADVANCED_FACE\s*\(", text))
    styles = len(re.findall(rb"=\s*(?:OVER_RIDING_)?STYLED_ITEM\s*\(", text))
    if faces < asked or styles < asked:
        raise WriteError(f"of {asked} faces the CAD kernel wrote {faces}, of them {styles} coloured", file=file)


def _ascii(name: str) -> str:
    """Accents dropped, other foreign characters as `?`: names stay readable in any viewer."""
    bare = "".join(c for c in unicodedata.normalize("NFKD", name) if not unicodedata.combining(c))
    return bare.encode("ascii", "replace").decode()
