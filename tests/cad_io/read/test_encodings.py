"""Names in the encodings of older programs are read as their authors wrote them, in STEP and IGES."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.IGESControl import IGESControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TopLoc import TopLoc_Location

from cad_io import read_part
from cad_io.kernel.shapes import component_of
from cad_io.read.step_text import CALLED, decoded, encoding_of, readable, typed
from plan_cutters import plan
from tests.support.cad_parts import box, compound, moved
from tests.support.places import real_file

NAMES = {
    "gb18030": ("姿态控制舱段", "测试舱段1", "齿轮"),
    "cp932": ("ハウジング", "部品1", "歯車"),
    "big5": ("齒輪", "零件1", "軸承座"),
    "cp949": ("하우징", "부품1", "축"),
    "cp1251": ("Корпус", "Деталь1", "Вал"),
    "cp1252": ("Gehäuse", "Ø20", "pièce"),
}


@pytest.fixture(scope="module")
def assembly(tmp_path_factory):
    """A STEP of two instances of one product each, with places for names: ONE, TWO."""
    path = tmp_path_factory.mktemp("names") / "assembly.step"
    writer = STEPControl_Writer()
    writer.Transfer(compound(box(), box(5, 5, 5).Moved(TopLoc_Location(moved(by=(20, 0, 0))))), STEPControl_AsIs)
    writer.Write(str(path))
    text = re.sub(r"\n\s*", "", path.read_text())
    products = re.findall(r"PRODUCT\('([^']*)','([^']*)'", text)
    assert len(products) == 3
    usages = iter(("ONE", "TWO"))
    text = re.sub(r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\('[^']*',)'[^']*'", lambda m: f"{m[1]}'{next(usages)}'", text)
    names = iter(("whole", "ONE", "TWO"))
    text = re.sub(r"PRODUCT\('[^']*','[^']*'", lambda m: f"PRODUCT('x','{next(names)}'", text)
    return text.replace("ADVANCED_FACE(''", "ADVANCED_FACE('ONE'", 1)


def read(text, path):
    path.write_bytes(text)
    return read_part(path)


@pytest.mark.parametrize("encoding", list(NAMES))
def test_names_of_step_are_read_in_older_encodings(assembly, encoding, tmp_path):
    one, two, _ = NAMES[encoding]
    part = read(assembly.replace("ONE", one).replace("TWO", two).encode(encoding), tmp_path / "part.step")
    assert set(component_of(part.tree).values()) == {f"whole/{one}", f"whole/{two}"}
    assert one in {face.name for face in part.faces}
    assert part.encoding == CALLED[encoding]
    assert part.warnings == ()


@pytest.mark.parametrize("escape", [False, True])
def test_utf_8_and_escapes_stay_and_names_without_a_letter_of_ascii_are_no_numbers(assembly, escape, tmp_path):
    text = assembly.replace("ONE", "姿态").replace("TWO", "é")
    if escape:
        text = re.sub("[^\0-\x7f]", lambda m: f"\\X2\\{ord(m[0]):04X}\\X0\\", text)
    part = read(text.encode(), tmp_path / "part.step")
    assert set(component_of(part.tree).values()) == {"whole/姿态", "whole/é"}
    assert "姿态" in {face.name for face in part.faces}
    assert part.encoding == ""


def test_faces_are_chosen_by_the_name_and_by_the_bytes_of_the_file_and_a_note_names_the_encoding(assembly, tmp_path):
    path = tmp_path / "part.step"
    path.write_bytes(assembly.replace("ONE", "姿态控制").replace("TWO", "测试1").encode("gb18030"))
    raw = "姿态控制".encode("gb18030")
    targets = []
    for name in ("姿态控制", raw.decode("utf-8", "surrogateescape"), raw.decode("latin-1")):
        for word in (f"component:{name}", f"name:{name}"):
            result = plan(path, cutters=["D3L60"], faces=word, grid=3, area_budget=0)
            targets.append((word[:4], result.plan.effective.target_faces))
            assert "\udcd7" not in result.plan.effective.faces
    assert len({str(each) for each in targets}) == 2, "one choice by component, one by name"
    (note,) = [text for code, text in zip(result.plan.note_codes, result.plan.notes, strict=True) if code == "names_decoded"]
    assert "GB18030" in note


@pytest.mark.parametrize("encoding", list(NAMES))
def test_names_of_iges_faces_are_read_in_older_encodings(encoding, tmp_path):
    path = tmp_path / "part.igs"
    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(box())
    writer.ComputeModel()
    writer.Write(str(path))
    name, lines, number = NAMES[encoding][2], path.read_bytes().splitlines(keepends=True), 0
    label = name.encode(encoding)[:8].rjust(8)
    for k, line in enumerate(lines):
        if line[72:73] == b"D":
            number += 1
            if number % 2 == 0 and line[:8].strip() in (b"144", b"143", b"510"):
                lines[k] = line[:56] + label + b" " * 8 + line[72:]
    part = read(b"".join(lines), path)
    assert {face.name for face in part.faces} == {name}
    assert part.encoding == CALLED[encoding]


def test_a_real_file_of_a_program_that_writes_gb18030():
    part = read_part(real_file("trials/occt1523_gb.step"))
    assert set(component_of(part.tree).values()) == {"asm/姿态控制舱段", "asm/测试舱段1"}


@pytest.mark.parametrize("encoding", list(NAMES))
def test_an_encoding_is_found_by_each_of_its_names(encoding):
    for name in NAMES[encoding]:
        assert encoding_of([name.encode(encoding)]) == encoding
        assert typed(name.encode(encoding).decode("latin-1"), CALLED[encoding]) == name


@given(st.lists(st.binary(max_size=12), max_size=4))
@settings(max_examples=100, deadline=None)
def test_no_bytes_are_refused(names):
    encoding = encoding_of(names)
    for name in names:
        assert isinstance(decoded(name, encoding), str)
    data = b"#1=PRODUCT('" + b"','".join(names) + b"');"
    text, called = readable(data)
    assert called or text == data
    if b"'" not in b"".join(names) and called:
        assert text.isascii()


@given(st.text(max_size=12))
@settings(max_examples=100, deadline=None)
def test_ascii_and_utf_8_stay_byte_for_byte(text):
    data = text.encode("utf-8", "ignore")
    assert readable(data) == (data, "")


def test_an_apostrophe_in_a_comment_begins_no_string():
    data = "/* don't */ #1=PRODUCT('齿轮','it''s');".encode("gb18030")
    assert readable(data)[0] == b"/* don't */ #1=PRODUCT('\\X2\\9F7F8F6E\\X0\\','it''s');"
