"""The table of formats: what is read, and what is known well enough to say what to export instead.

What a file holds decides, not how it is called.
"""

import re
from collections.abc import Callable

from plan_cutters.files import formats
from plan_cutters.files.formats import Foreign, Format
from plan_cutters.library import freecad, fusion, toml
from plan_cutters.library.files import Content
from plan_cutters.library.raw_tool import LibraryContent

Reader = Callable[[Content], LibraryContent]
FORMATS: tuple[Format[Reader], ...] = (
    Format("Fusion tools (zip)", (".tools",), fusion.is_zip, fusion.read_zip),
    Format("Fusion JSON", (".json",), fusion.is_json, fusion.read_json),
    Format("Fusion CSV", (".csv",), fusion.is_csv, fusion.read_csv),
    Format("HSMWorks", (".hsmlib",), fusion.is_hsmlib, fusion.read_hsmlib),
    Format("FreeCAD library", (".fctl",), freecad.is_library, freecad.read_library),
    Format("FreeCAD bit", (".fctb",), freecad.is_bit, freecad.read_bit),
    Format("FreeCAD holder", (".fcholder",), freecad.is_holder, freecad.read_holder),
    Format("plan-cutters TOML", (".toml",), toml.is_toml, toml.read_toml),
)

_SQLITE = b"SQLite format 3\0"
_TOOL = re.compile(r"^\s*T\s*[+-]?\d+(?:\s+[A-Z]\s*[+-]?[\d.,]+)*\s*(?:;.*)?$", re.IGNORECASE)
_TOML = "write the tools as TOML (docs/tool_libraries.md)"
_FUSION = "export from a program that writes Fusion .tools, .json or CSV, or HSMWorks .hsmlib, or " + _TOML


def _sqlite(word: bytes, *suffixes: str) -> Callable[[Content], bool]:
    return lambda c: c.data.startswith(_SQLITE) and (word in c.data or c.path.suffix.lower() in suffixes)


def _kirimoto(content: Content) -> bool:
    result = content.json
    if isinstance(result, dict) and isinstance(result.get("tools"), list):
        return any(isinstance(tool, dict) and "shaft_diam" in tool for tool in result["tools"])
    # What it writes otherwise says nothing of itself.
    return content.path.suffix.lower() == ".km"


def _member(word: str) -> Callable[[Content], bool]:
    return lambda c: c.members is not None and any(name.lower().endswith(word) for name in c.members)


def _begins(*words: str) -> Callable[[Content], bool]:
    return lambda c: c.head.startswith(words)


def _page(content: Content) -> bool:
    return content.head.startswith("<") and re.search(r"<(!doctype\s+html|html|head|body)\b", content.head) is not None


def _table(content: Content) -> bool:
    """Whether the first line that is no comment has T and a number, then letters with numbers."""
    lines = (line for line in content.text.splitlines() if line.strip() and not line.lstrip().startswith(";"))
    return _TOOL.match(next(lines, "")) is not None


def _estlcam(content: Content) -> bool:
    return "estlcam" in content.head or (content.path.suffix.lower() == ".tl" and content.head.startswith("<"))


FOREIGN = (
    Foreign("a LinuxCNC tool table", _table, f"it has diameters alone, no flute length, stick-out or holder; {_TOML}"),
    Foreign("a Vectric tool database", _sqlite(b"tool_geometry", ".vtdb"), f"it has no shank, stick-out or holder; {_TOML}"),
    Foreign("a Mastercam tool database", _sqlite(b"TlTool", ".tooldb"), _FUSION),
    Foreign("an SQLite database", _sqlite(_SQLITE), _FUSION),
    Foreign(
        "a DeskProto cutter",
        lambda c: "[deskproto cutter]" in c.text.lower(),
        f"it has no holder, and one cutter a file; {_TOML}",
    ),
    Foreign("a Kiri:Moto tool list", _kirimoto, f"it has no stick-out and no holder; {_TOML}"),
    Foreign("a GTC package (ISO 13399)", lambda c: _member("package_meta_data.xml")(c) or _member(".p21")(c), _FUSION),
    Foreign("a FreeCAD document", _member("document.xml"), "give the bit (.fctb) or the library (.fctl), not its shape"),
    Foreign("a spreadsheet or office document", _member("[content_types].xml"), "save it as CSV in Fusion's columns"),
    Foreign("an ISO 10303-21 file (STEP or ISO 13399)", _begins("iso-10303-21"), _FUSION),
    Foreign("an Estlcam tool list", _estlcam, _TOML),
    Foreign("MTConnect assets", lambda c: c.head.startswith("<") and "mtconnectassets" in c.head, _FUSION),
    Foreign("a web page (HTML)", _page, "download the library itself: perhaps a log-in stands before it"),
    Foreign("a Carbide 3D tool list", _begins("number,vendor,model,"), f"it has no holder; {_TOML}"),
    Foreign(
        "a table (CSV) without Fusion's columns",
        lambda c: c.path.suffix.lower() in (".csv", ".tsv"),
        f"columns as Type (tool_type), Diameter (tool_diameter) and Unit (tool_unit) are read; {_TOML}",
    ),
    Foreign("a CAM machine or setting of FreeCAD", lambda c: c.path.suffix.lower() == ".fcm", "give its tools (.fctl)"),
)


def recognised(content: Content) -> Format[Reader]:
    """The format of a file.

    Raises
    ------
    LibraryError
        It is none that is read; by name, where it is known.
    """
    return formats.recognised(
        content,
        FORMATS,
        FOREIGN,
        xml="no HSMWorks tool library (tool-library); export it anew",
        archive="without tools.json, no Fusion tool library; give what is in it",
        json='neither a Fusion library ({"data": [tools]}) nor of FreeCAD (tools, parameter, profile)',
    )
