"""A file becomes a library, or one line that says why not."""

import os
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder, positive, words
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.files.content import Foreign, Format, called, recognised, rooted
from plan_cutters.library import freecad, fusion, toml
from plan_cutters.library.milling import Ask, entry_of
from plan_cutters.library.raw_tool import Content, Entry, Library, LibraryContent, opened
from plan_cutters_base.user_files import is_there

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


def _table(content: Content) -> bool:
    """Whether the first line that is no comment has T and a number, then letters with numbers."""
    lines = (line for line in content.text.splitlines() if line.strip() and not line.lstrip().startswith(";"))
    return _TOOL.match(next(lines, "")) is not None


FOREIGN = (
    Foreign("a LinuxCNC tool table", _table, f"it has diameters alone, no flute length, stick-out or holder; {_TOML}"),
    Foreign("a Vectric tool database", _sqlite(b"tool_geometry", ".vtdb"), f"it has no shank, stick-out or holder; {_TOML}"),
    Foreign("a Mastercam tool database", _sqlite(b"TlTool", ".tooldb"), _FUSION),
    Foreign("an SQLite database", _sqlite(_SQLITE), _FUSION),
    Foreign("a DeskProto cutter", lambda c: "[deskproto cutter]" in c.text.lower(),
            f"it has no holder, and one cutter a file; {_TOML}"),
    Foreign("a Kiri:Moto tool list", _kirimoto, f"it has no stick-out and no holder; {_TOML}"),
    Foreign("a GTC package (ISO 13399)", lambda c: _member("package_meta_data.xml")(c) or _member(".p21")(c), _FUSION),
    Foreign("a FreeCAD document", _member("document.xml"), "give the bit (.fctb) or the library (.fctl), not its shape"),
    Foreign("a spreadsheet or office document", _member("[content_types].xml"), "save it as CSV in Fusion's columns"),
    Foreign("an ISO 10303-21 file (STEP or ISO 13399)", lambda c: c.head.startswith("iso-10303-21"), _FUSION),
    Foreign("an Estlcam tool list", lambda c: "estlcam" in c.head or (called(".tl")(c) and c.head.startswith("<")), _TOML),
    Foreign("MTConnect assets", rooted("MTConnectAssets"), _FUSION),
    Foreign("a web page (HTML)", rooted("!doctype html", "html", "head", "body"),
            "download the library itself: perhaps a log-in stands before it"),
    Foreign("a Carbide 3D tool list", lambda c: c.head.startswith("number,vendor,model,"), f"it has no holder; {_TOML}"),
    Foreign("a table (CSV) without Fusion's columns", called(".csv", ".tsv"),
            f"columns as Type (tool_type), Diameter (tool_diameter) and Unit (tool_unit) are read; {_TOML}"),
    Foreign("a CAM machine or setting of FreeCAD", called(".fcm"), "give its tools (.fctl)"),
)  # fmt: skip


#: How many reasons an error names, of all.
_NAMED = 3
_SUFFIXES = {suffix for form in FORMATS for suffix in form.suffixes}


def read_library(
    path: str | os.PathLike[str],
    *,
    assume_stickout: float | None = None,
    holder: Holder | str | None = None,
    skip_bad: bool = False,
) -> Library:
    """The cutters of a tool library; every tool that becomes none is in `entries`, with the reason.

    Parameters
    ----------
    path : path
        Fusion `.json`, `.tools` or CSV, HSMWorks `.hsmlib`, FreeCAD `.fctl` or `.fctb`, our own TOML. What the
        file holds decides.
    assume_stickout : float, optional
        mm, of tools that state none.
    holder : Holder or str, optional
        Of tools that have none; a text as `R15L30`, or `none`, so that they are judged without.
    skip_bad : bool
        Use the others where some tools contradict themselves or cannot be read.

    Raises
    ------
    LibraryError
        The file is no library that is read, holds a broken tool (unless `skip_bad`), or none that can be used.
    CutterError
        The holder or the stick-out that is assumed cannot exist.

    Examples
    --------
    >>> read_library("none.tools")
    Traceback (most recent call last):
    plan_cutters.errors.LibraryError: none.tools: cannot be read: No such file or directory
    """
    listed = listing(path, assume_stickout=assume_stickout, holder=holder, skip_bad=skip_bad)
    if not listed and not listed.drills:
        raise nothing(listed)
    return listed


def listing(path: str | os.PathLike[str], *, assume_stickout: float | None = None, holder: Holder | str | None = None,
            skip_bad: bool = False) -> Library:  # fmt: skip
    """The same, also where no tool can be used."""
    choice: Holder | Literal["none"] | None = None
    if isinstance(holder, str) and holder.strip().lower() == "none":
        choice = "none"
    elif holder is not None:
        choice = Holder.of(holder)
    ask = Ask(None if assume_stickout is None else positive(assume_stickout, "assumed stick-out"), choice)
    content = opened(path)
    form = recognised(
        content, FORMATS, FOREIGN, xml="no HSMWorks tool library (tool-library); export it anew",
        archive="without tools.json, no Fusion tool library; give what is in it",
        json='neither a Fusion library ({"data": [tools]}) nor of FreeCAD (tools, parameter, profile)',
    )  # fmt: skip
    raw = form.read(content)
    entries = tuple(each if isinstance(each, Entry) else entry_of(each, ask) for each in raw.tools)
    notes = list(raw.notes)
    if content.members is None and content.encoded[1] == "cp1252":
        notes.append("it is not in UTF-8: its text is read as Windows-1252")
    library = Library(content.name, form.name, (*entries, *raw.faulty), tuple(raw.holders), tuple(notes))
    broken = [entry for entry in library.entries if entry.broken]
    if broken and not skip_bad:
        first, more = broken[0], len(broken) - 1
        others = f"; {more} more {'are' if more > 1 else 'is'} broken" if more else ""
        use = f"; --skip-bad uses the other {len(library)} cutters" if library else "; no other tool can be used"
        raise LibraryError(f"{library.format}, {first.label}: {first.unused}{others}{use}", file=library.file)
    return library


def nothing(library: Library) -> LibraryError:
    """Why a library has no cutter."""
    if not library.entries:
        held = len(library.holders)
        what = f"lists {held} holder{'s' if held > 1 else ''} and no tools; give it with --holder" if held else "lists no tools"
        return LibraryError(f"{library.format}: {what}", file=library.file)
    count = len(library.entries)
    reasons: dict[str, list[str]] = {}
    for entry in library.entries:
        reasons.setdefault(entry.unused or "", []).append(entry.label)
    named, others = list(reasons.items())[:_NAMED], list(reasons.values())[_NAMED:]
    causes = [f"{who[0]}{f' and {len(who) - 1} more' if len(who) > 1 else ''}: {why}" for why, who in named]
    if others:
        causes.append(f"{sum(map(len, others))} more for {len(others)} other reasons")
    tools = "its only tool cannot" if count == 1 else f"none of its {count} tools can"
    return LibraryError(f"{library.format}: {tools} be used: {'; '.join(causes)}", file=library.file)


def holder_of(value: Any) -> Holder | str:
    """Read a value of `--holder`: `none`, a text as `R15L30`, or a file with a holder; `FILE#NAME` where it has several.

    Raises CutterError, LibraryError.
    """
    if not isinstance(value, str) or value.strip().lower() == "none":
        return value.strip().lower() if isinstance(value, str) else Holder.of(value)
    try:
        return Holder.parse(value)
    except CutterError:
        file, mark, name = value.rpartition("#")
        if not mark or not is_there(file):
            file, name = value, ""
        if not is_there(file):
            if Path(file).suffix.lower() in _SUFFIXES:
                raise LibraryError("is no file; give one with a holder, or R15L30", file=file) from None
            raise
    return _holder_in(listing(file, skip_bad=True), name)


def _holder_in(listed: Library, name: str) -> Holder:
    """The holder of a name in a library, or its only one where there is no name."""
    known = {holder.id: holder for holder in listed.holders}
    for entry in listed.entries:
        if entry.cutter is not None and entry.cutter.holder is not None:
            known.setdefault(entry.cutter.holder.id, entry.cutter.holder)
    chosen = [holder for holder in known.values() if not name or holder.name == name]
    if len(chosen) == 1:
        return chosen[0]
    if not known:
        faults = "; ".join(e.unused or "" for e in listed.entries if e.broken and e.kind == "holder")
        raise LibraryError(
            f"{listed.format}: it has no holder{f' that can be read: {faults}' if faults else ''}", file=listed.file
        )
    names = ", ".join(sorted({f'"{holder.name}"' for holder in known.values()}))
    raise LibraryError(
        f"{len(chosen)} of its {len(known)} holders are meant; choose one as {listed.file}#NAME: {names}", file=listed.file
    )


#: How far a gauge pin stands out of a holder that is drawn, mm.
_PIN = 40.0


def of_words(specs: Sequence[str], holder: Holder | None) -> Library:
    """The cutters of texts such as `D12L80`, each in a holder if one is given.

    Raises CutterError: a text is none, or the holder does not take the cutter.
    """
    made = [(spec, Cutter.parse(spec).asked(0.0, 0.0, holder)) for spec in specs]
    return Library("--cutter", "words of the command line", tuple(Entry(spec, cutter=each) for spec, each in made))


def standard() -> dict[str, Holder]:
    """The built-in holders by their words."""
    return {word: Holder.parse(word) for word in words()}


def pinned() -> list[Library]:
    """The built-in holders, each with a pin of the largest shank that it takes; a library for each, for some are alike."""
    pins = []
    for word, holder in standard().items():
        bore = holder.bore or 0.0
        pin = Cutter(bore / 2.0, _PIN, name=f"{holder.name} with a pin D{bore:g}", holder=holder)
        pins.append(Library("--list-holders", "built-in holders", (Entry(word, name=pin.name, cutter=pin),)))
    return pins
