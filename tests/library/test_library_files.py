"""Files that are no tool libraries, or dangerous ones: one line each. Real files are read, or refused by their format's name."""

import csv
import json
import os
import sqlite3
import zipfile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import LibraryError, PlanError
from plan_cutters.domain.holder import Segment
from plan_cutters.domain.standard_tools import builtin
from plan_cutters.library import read_library, to_toml
from plan_cutters.library.read import FORMATS, listing
from tests.support.tool_files import REAL, fusion, hsmlib, write_bit, write_csv, write_hsmlib, write_json, write_tools


def refused(path, said, **more):
    """The one line with which a file is refused."""
    with pytest.raises(LibraryError, match=said) as error:
        read_library(path, **more)
    text = str(error.value)
    assert "\n" not in text
    assert text.startswith(f"{path.name}: ")
    return text


HTML = "<!DOCTYPE html>\n<html><head><title>Sign in</title></head><body></body></html>"


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.json", HTML, r"a web page \(HTML\)"),
        ("a.hsmlib", HTML.lower(), r"a web page \(HTML\)"),
        ("a.tools", HTML, r"a web page \(HTML\)"),
        ("a.json", "", "is empty"),
        ("a.json", " \n\t", "is empty"),
        ("a.json", b"\xff\xfe", "is empty"),
        ("a.json", '{"data": [', "line 1, column"),
        ("a.json", "{'data': []}", "looks like JSON"),
        ("a.json", '{"data": [' + "9" * 5000 + "]}", "thousands of digits"),
        ("a.json", "[" * 200_000, "nested too deeply"),
        ("a.json", '{"data": [{"geometry": {"DC": 6, "DC": 8}}]}', "'DC' is given twice"),
        ("a.hsmlib", "<?xml version='1.0' encoding='martian'?><tool-library/>", "no well-formed XML"),
        ("a.tbl", "; ours\n\nT1  P1 D+6.0 Z+12 ;6 mm\n", "a LinuxCNC tool table, .* no flute length, stick-out"),
        ("a.json", '{"data": {"DC": 6}}', "neither a Fusion library"),
        ("a.json", "[1, 2]", "neither a Fusion library"),
        ("a.json", '{"data": []}', "Fusion JSON: lists no tools"),
        ("a.json", '{"data": [3, null]}', "tool 1: 3 is no tool; 1 more is broken; no other tool can be used"),
        ("a.fctl", '{"tools": [], "version": 1}', "FreeCAD library: lists no tools"),
        ("a.hsmlib", "<tool-library/>", "HSMWorks: lists no tools"),
        ("a.hsmlib", "<tool-library><tool></tool-library>", "no well-formed XML"),
        ("a.hsmlib", "<shop/>", "no HSMWorks tool library"),
        ("a.csv", "Type (tool_type),Diameter (tool_diameter),Unit (tool_unit)\n", "Fusion CSV: lists no tools"),
        ("a.csv", "Type (tool_type),Number (tool_number)\nflat end mill,3\n", r"no column \(tool_diameter\)"),
        ("a.csv", "a,b\n1,2\n", "a table .CSV. without Fusion's columns"),
        ("a.csv", "Type (tool_type),Diameter (tool_diameter),Unit (tool_unit),D2 (tool_diameter)\n", "twice"),
        ("a.toml", '[[tools]]\nunit = "mm"\n', "'tools' is unknown"),
        ("a.toml", "# none yet\n", "plan-cutters TOML: lists no tools"),
        ("a.toml", "[[tool]]\nDC = 12,5\n", "decimal point"),
        ("a.toml", 'unit = "mm"\n', "plan-cutters TOML: lists no tools"),
        ("a.toml", "[[tool]]\nDC = \n", "is no TOML"),
        ("a.tbl", "; nothing\n", "no tool library that is known"),
        ("a.csv", "number,vendor,model,URL,name,type,diameter\n1,a,b,c,d,e,6\n", "a Carbide 3D tool list"),
        ("a.p21", "ISO-10303-21;\nHEADER;\n", "ISO 10303-21"),
        ("a.ctr", "; old\n[DeskProto Cutter]\nVersion = 7\n", "a DeskProto cutter"),
        ("a.xml", "<?xml version='1.0'?><MTConnectAssets></MTConnectAssets>", "MTConnect"),
        ("a.tl", "<?xml version='1.0'?><Tools/>", "an Estlcam"),
        ("a.km", json.dumps({"version": "3", "tools": [{"shaft_diam": 3}]}), "Kiri:Moto"),
        ("a.bin", b"\x00\x01\x02\x03", "no tool library that is known"),
    ],
)  # fmt: skip
def test_what_is_no_library_is_named(tmp_path, name, content, said):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    refused(path, said)


def test_content_decides_not_the_suffix(tmp_path):
    for write, suffix, name in ((write_tools, "json", "Fusion tools (zip)"), (write_json, "tools", "Fusion JSON"),
                                (write_hsmlib, "csv", "HSMWorks"), (write_csv, "txt", "Fusion CSV")):  # fmt: skip
        assert read_library(write(tmp_path / f"a.{suffix}", [fusion()])).format == name


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_text_in_any_unicode(tmp_path, encoding):
    path = tmp_path / "a.json"
    path.write_bytes(json.dumps({"data": [fusion(name="Fräser ø6")]}, ensure_ascii=False).encode(encoding))
    assert read_library(path).entries[0].name == "Fräser ø6"


def test_names_stay_on_one_line(tmp_path):
    path = write_json(tmp_path / "a.json", [fusion(name="two\nlines \x1b[31m red \u202e" + 300 * "x", LB=-3)])
    text = refused(path, "LB is -3")
    assert "\x1b" not in text
    assert "\u202e" not in text
    assert len(text) < 400


def test_a_zip_bomb_is_refused_before_it_goes_off(tmp_path):
    path = tmp_path / "bomb.tools"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("tools.json", "w") as out:
        for _ in range(200):
            out.write(b" " * (1 << 20))
    refused(path, "a zip bomb")


def test_zip_archives_that_are_no_library(tmp_path):
    cases = {
        "office.tools": ("[Content_Types].xml", "office document"),
        "part.tools": ("Document.xml", "FreeCAD document"),
        "gtc.zip": ("package_meta_data.xml", "GTC package"),
        "other.zip": ("readme.txt", "without tools.json"),
    }
    for name, (member, said) in cases.items():
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr(member, "text")
        refused(tmp_path / name, said)
    with zipfile.ZipFile(tmp_path / "many.tools", "w") as archive:
        for i in range(2500):
            archive.writestr(f"{i}.txt", "")
    refused(tmp_path / "many.tools", "2500 files")
    with zipfile.ZipFile(tmp_path / "broken.tools", "w") as archive:
        archive.writestr("tools.json", "{")
    refused(tmp_path / "broken.tools", "its tools.json")
    whole = write_tools(tmp_path / "cut.tools", [fusion()]).read_bytes()
    (tmp_path / "cut.tools").write_bytes(whole[: len(whole) // 2])
    refused(tmp_path / "cut.tools", "zip archive that cannot be read")
    flipped = bytearray(whole)
    flipped[60] ^= 255
    (tmp_path / "flipped.tools").write_bytes(flipped)
    refused(tmp_path / "flipped.tools", "cannot be unpacked|cannot be read")


def test_databases_are_named(tmp_path):
    for name, table, said in (("a.vtdb", "tool_geometry", "a Vectric"), ("a.tooldb", "TlTool", "a Mastercam"),
                              ("a.db", "people", "an SQLite database")):  # fmt: skip
        with sqlite3.connect(tmp_path / name) as base:
            base.execute(f"create table {table} (id integer)")
        base.close()
        refused(tmp_path / name, said)


@pytest.mark.parametrize(
    "before",
    [
        '<!DOCTYPE tool-library [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]>',
        '<!DOCTYPE tool-library SYSTEM "file:///etc/passwd">',
        '<!DOCTYPE tool-library [<!ENTITY % x SYSTEM "http://localhost/x">%x;]>',
    ],
)
def test_entities_are_refused(tmp_path, before):
    refused(write_hsmlib(tmp_path / "a.hsmlib", [fusion()], before), "line 2: it declares a document type or entities")


def test_an_entity_that_nothing_declares_is_no_xml(tmp_path):
    path = tmp_path / "a.hsmlib"
    path.write_bytes(hsmlib([fusion(name="&secret;")]).encode("utf-16"))
    refused(path, "no well-formed XML")


def test_depth_without_end_is_refused(tmp_path):
    path = tmp_path / "a.hsmlib"
    path.write_text("<tool-library>" + "<a>" * 100_000)
    refused(path, "too deep")
    path = tmp_path / "a.toml"
    path.write_text("[[tool]]\nname = " + "[" * 100_000)
    refused(path, "no TOML")


def test_what_is_no_file_is_one_line(tmp_path):
    refused(tmp_path / "none.tools", "No such file")
    (tmp_path / "folder.tools").mkdir()
    refused(tmp_path / "folder.tools", "is a folder")
    os.mkfifo(tmp_path / "pipe.tools")
    refused(tmp_path / "pipe.tools", "a pipe or a device")
    with pytest.raises(LibraryError, match="not a value of type"):
        read_library(3)
    with pytest.raises(LibraryError, match="no name of a file"):
        read_library("a\0b")
    huge = tmp_path / "huge.json"
    with huge.open("wb") as out:
        out.truncate(40 << 20)
    refused(huge, "larger than 32 MB")


@pytest.mark.parametrize("line", ["<tool unit='millimeters' type='flat end mill'/>",
                                  "<tool unit='millimeters' type='flat end mill'><body diameter='6 mm'/></tool>"])  # fmt: skip
def test_a_tool_of_hsmworks_without_or_with_a_wrong_body(tmp_path, line):
    path = tmp_path / "a.hsmlib"
    path.write_text(f"<tool-library>\n{line}\n</tool-library>")
    refused(path, r"tool 1 \(line 2\)")


@given(st.sampled_from(["json", "tools", "csv", "hsmlib", "toml", "fctb"]), st.data())
@settings(max_examples=150, deadline=None)
def test_damaged_files_end_in_one_line(tmp_path_factory, suffix, data):
    """Whatever bytes are lost, doubled or replaced: cutters, or an error of the package."""
    path = tmp_path_factory.mktemp("damaged") / f"a.{suffix}"
    write = {"json": write_json, "tools": write_tools, "csv": write_csv, "hsmlib": write_hsmlib}.get(suffix)
    if write:
        whole = write(path, [fusion(), fusion(number=2, RE=1)]).read_bytes()
    elif suffix == "fctb":
        whole = write_bit(path).read_bytes()
    else:
        whole = to_toml(builtin()[:3]).encode()
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(whole)))
        new = data.draw(st.sampled_from([b"", b"nan", b"-1", b"1e999", b"null", b"[]", b'"x"', b"\xff", b"\0", b"0", b"\n"]))
        whole = whole[:at] + new + whole[at + data.draw(st.integers(0, 30)) :]
    path.write_bytes(whole)
    try:
        library = listing(path, assume_stickout=40, holder="R15L30", skip_bad=True)
    except PlanError as error:
        assert "\n" not in str(error)  # noqa: PT017
    else:
        assert all((entry.cutter is None) == bool(entry.unused) for entry in library.entries)
        to_toml(library)


def names():
    """Of the real files, by their manifest."""
    if not (REAL / "MANIFEST.csv").exists():
        return []
    with (REAL / "MANIFEST.csv").open(newline="") as manifest:
        return [row["file"] for row in csv.DictReader(manifest)]


@pytest.mark.parametrize("name", names() or [pytest.param("", marks=pytest.mark.skip(reason="shared/data/tools is not at hand"))])
def test_every_real_file_is_read_or_refused_by_name(name):
    foreign = {".tbl": "LinuxCNC tool table", ".km": "Kiri:Moto", ".vtdb": "Vectric", ".ctr": "DeskProto"}
    path = REAL / name
    if path.suffix in foreign:
        refused(path, f"is a {foreign[path.suffix]}.*, which is not read")
        return
    # Libraries of FreeCAD list bits that are not at hand.
    library = listing(path, skip_bad=path.suffix == ".fctl")
    assert library.format in {form.name for form in FORMATS}
    assert library.entries or library.holders
    for entry in library.entries:
        assert (entry.cutter is None) == bool(entry.unused)
    assert len({cutter.id for cutter in library}) == len(library)
    if path.suffix in (".tools", ".json", ".csv", ".hsmlib"):
        assert all(entry.cutter is not None for entry in library.entries)


def test_the_errors_are_of_the_package():
    assert issubclass(LibraryError, PlanError)


def _cheap(kind):
    many = 50_001
    if kind == "json":
        return "a.json", b'{"data":[' + b"{}," * many + b"{}]}"
    if kind == "fctl":
        return "a.fctl", b'{"tools":[{"path":"a"}' + b",{}" * many + b"]}"
    if kind == "csv":
        return "a.csv", b"(tool_type),(tool_diameter),(tool_unit)\n" + b"x\n" * many
    if kind == "hsmlib":
        return "a.hsmlib", b"<tool-library>" + b"<tool/>" * many + b"</tool-library>"
    return "a.toml", b"[[tool]]\n" * many


@pytest.mark.parametrize("kind", ["json", "fctl", "csv", "hsmlib", "toml"])
def test_more_tools_than_memory_are_refused(tmp_path, kind):
    name, content = _cheap(kind)
    (tmp_path / name).write_bytes(content)
    refused(tmp_path / name, "lists more than 50000 tools")


def test_two_members_of_one_name_are_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.tools", "w") as archive:
        archive.writestr("tools.json", '{"data": []}')
        archive.writestr("twice.json", '{"data": []}')
    data = (tmp_path / "a.tools").read_bytes()
    (tmp_path / "a.tools").write_bytes(data.replace(b"twice.json", b"tools.json"))
    refused(tmp_path / "a.tools", "two files of one name")


def test_sections_are_enclosed_by_a_work_that_grows_slowly(monkeypatch):
    # Each merge looks at its two neighbours alone.
    from plan_cutters.library import milling

    calls, plain = [], milling._enclosing
    monkeypatch.setattr(milling, "_enclosing", lambda stages: calls.append(1) or plain(stages))
    stages = [Segment(15.0 + (i * 7) % 5, 1.0 + 1e-3 * i, 15.5 + (i * 11) % 5) for i in range(200)]
    found, _ = milling.fewer(stages, 12)
    assert len(found) <= 12
    assert len(calls) <= 3 * len(stages)
