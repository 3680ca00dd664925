"""Faulty files: what touches no geometry is said, what is lost is a fact of the part, and only what is hopeless is refused."""

import contextlib
import os
import re
import time

import pytest
from OCP.IGESControl import IGESControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer

from cad_io import LostFace, Part, ReadError, read_part
from cad_io.read import read
from cad_io.read.faults import misfit, open_border
from cad_io.tessellate import start, tessellate
from plan_cutters_base.workers.supervise import _Watch
from tests.support.cad_parts import as_nurbs, ball, compound, drilled, rod
from tests.support.fault_files import FINE, LOST, PATTERNS, REFUSED, WARNED, seeds


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    return seeds(tmp_path_factory.mktemp("whole"))


@pytest.fixture(scope="module")
def areas(whole, tmp_path_factory):
    """Areas of the faces of each whole file."""
    found = {}
    for name, text in whole.items():
        file = tmp_path_factory.mktemp(name) / "a.step"
        file.write_text(text)
        part = read_part(file)
        assert (part.lost, part.warnings) == ((), ())
        found[name] = sorted(face.area for face in part.faces)
    return found


@pytest.mark.parametrize("name", PATTERNS)
def test_each_pattern_comes_to_its_end(name, whole, areas, tmp_path):
    pattern = PATTERNS[name]
    (tmp_path / "part.step").write_text(pattern.change(whole[pattern.seed]))
    if pattern.outcome == REFUSED:
        with pytest.raises(ReadError) as caught:
            read_part(tmp_path / "part.step")
        assert "\n" not in str(caught.value)
        assert caught.value.file == str(tmp_path / "part.step")
        return
    part = read_part(tmp_path / "part.step")
    assert len(part.faces) == pattern.faces
    assert {FINE: (False, False), WARNED: (True, False)}.get(pattern.outcome, (bool(part.warnings), True)) == (
        bool(part.warnings),
        bool(part.lost),
    )
    altered = {each.face for each in part.lost} - {None}
    assert len(altered) == pattern.altered
    assert all(each.why for each in part.lost)
    # Whatever is not lost is as in the whole file: here independently of how it was found.
    left = list(areas[pattern.seed])
    for face in part.faces:
        if face.number not in altered:
            nearest = min(left, key=lambda area: abs(area - face.area))
            assert face.area == pytest.approx(nearest, rel=1e-6)
            left.remove(nearest)
    if pattern.outcome != LOST:
        assert left == []


@pytest.mark.parametrize(
    ("name", "entity"),
    [("surface dangling", "ADVANCED_FACE"), ("surface that cannot be", "ADVANCED_FACE"), ("face missing", "CLOSED_SHELL"),
     ("edge loop missing", "ADVANCED_FACE"), ("component in the wrong place", "ITEM_DEFINED_TRANSFORMATION")],
)  # fmt: skip
def test_what_is_lost_is_named_as_in_the_file(name, entity, whole, tmp_path):
    pattern = PATTERNS[name]
    text = pattern.change(whole[pattern.seed])
    (tmp_path / "part.step").write_text(text)
    for lost in read_part(tmp_path / "part.step").lost:
        assert re.search(rf"^{lost.entity} = {entity}\(", text, re.MULTILINE)


def test_entities_are_named_where_numbers_are_not_dense(whole, tmp_path):
    text = re.sub(r"#(\d+)", lambda m: f"#{10 * int(m[1]) + 7}", whole["drilled"])
    text = PATTERNS["surface that cannot be"].change(text)
    (tmp_path / "part.step").write_text(text)
    (lost,) = read_part(tmp_path / "part.step").lost
    surface = re.search(r"#(\d+) = CYLINDRICAL_SURFACE", text)[1]
    assert re.search(rf"{lost.entity} = ADVANCED_FACE\([^;]*#{surface},", text)
    assert f"#{surface} CYLINDRICAL_SURFACE" in lost.why


def test_a_lost_face_has_its_name_and_place(whole, tmp_path):
    text = whole["drilled"]
    face = re.search(r"(#\d+) = ADVANCED_FACE\('',\([^)]*\),#(\d+)", text)
    text = text.replace(f"{face[1]} = ADVANCED_FACE(''", f"{face[1]} = ADVANCED_FACE('lid'")
    text = re.sub(rf"({face[1]} = ADVANCED_FACE\('lid',\([^)]*\),#)\d+", r"\g<1>99999", text)
    (tmp_path / "part.step").write_text(text)
    (lost,) = read_part(tmp_path / "part.step").lost
    assert (lost.entity, lost.name, lost.face) == (face[1], "lid", None)
    # The first face of the 20 x 20 x 10 block is one of its sides.
    low, high = lost.box
    assert sorted(b - a for a, b in zip(low, high, strict=True)) == pytest.approx([0, 10, 20])
    metres = read_part(tmp_path / "part.step", unit="m").lost[0].box
    assert metres[1] == pytest.approx([1000 * x for x in high])


def test_a_face_of_a_product_that_stands_twice_is_lost_twice(whole, tmp_path):
    text = re.sub(r"(ADVANCED_FACE\('[^']*',\([^)]*\),#)\d+", r"\g<1>99999", whole["assembly"], count=1)
    (tmp_path / "part.step").write_text(text)
    part = read_part(tmp_path / "part.step")
    assert len(part.faces) == 12
    assert len(part.lost) == 2
    assert len({each.entity for each in part.lost}) == 1
    assert part.lost[0].box != part.lost[1].box


def test_names_and_colours_survive_faults(whole, tmp_path):
    (tmp_path / "whole.step").write_text(whole["assembly"])
    (tmp_path / "part.step").write_text(PATTERNS["style with a wrong enumeration"].change(whole["assembly"]))
    good, faulty = read_part(tmp_path / "whole.step"), read_part(tmp_path / "part.step")
    assert [face.name for face in good.faces] == [face.name for face in faulty.faces]
    assert {face.name for face in good.faces} >= {"side 0", "side 1"}
    assert not any(face.colour for face in good.faces)
    assert [face.number for face in faulty.faces if face.colour == (0, 0, 1)] == [1, 8]  # the rest of the style holds


@pytest.mark.parametrize(
    "pattern",
    [r"(CONTEXT_DEPENDENT_SHAPE_REPRESENTATION\(#)\d+", r"(CONTEXT_DEPENDENT_SHAPE_REPRESENTATION\(#\d+,#)\d+",
     r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\('[^']*','[^']*','[^']*',#)\d+"],
)  # fmt: skip
def test_an_assembly_that_has_lost_an_instance_says_so(pattern, whole, tmp_path):
    (tmp_path / "part.step").write_text(re.sub(pattern, r"\g<1>99999", whole["assembly"], count=1))
    part = read_part(tmp_path / "part.step")
    usage = re.search(r"(#\d+) = NEXT_ASSEMBLY_USAGE_OCCURRENCE", whole["assembly"])[1]
    assert len(part.faces) == 7
    assert [each.entity for each in part.lost] == [usage]


def test_a_hang_of_the_transfer_is_an_error(whole, tmp_path, monkeypatch):
    (tmp_path / "part.step").write_text(PATTERNS["seam with twice the same curve"].change(whole["cylinder"]))
    parent = os.getpid()
    real = read.step.Loaded.transfer

    def hangs(self, **more):
        assert os.getpid() != parent, "a file with faults is transferred in a copy of the process"
        time.sleep(60)
        return real(self, **more)

    monkeypatch.setattr(read.step.Loaded, "transfer", hangs)
    began = time.monotonic()
    with pytest.raises(ReadError, match=r"not read within 0\.5 s"):
        read_part(tmp_path / "part.step", timeout=0.5)
    assert time.monotonic() - began < 10


def test_a_guarded_reading_of_a_faulty_file_gives_the_same(whole, tmp_path):
    (tmp_path / "part.step").write_text(PATTERNS["surface dangling"].change(whole["drilled"]))
    plain, guarded = (read_part(tmp_path / "part.step", guarded=word) for word in (False, True))
    assert plain.lost == guarded.lost != ()
    assert plain.warnings == guarded.warnings
    assert plain.faces == guarded.faces


def test_numbers_beyond_all_bounds_do_not_end_the_process(whole, tmp_path):
    # Half the time the kernel crashes on them.
    text = re.sub(r"(VERTEX_POINT[^;]*;[^(]*\('',\()[^,]*", r"\g<1>1.E400", whole["drilled"], count=1)
    (tmp_path / "part.step").write_text(text)
    with contextlib.suppress(ReadError):
        read_part(tmp_path / "part.step")


def test_good_files_are_read_in_this_process(whole, tmp_path, monkeypatch):
    (tmp_path / "part.step").write_text(whole["assembly"])
    monkeypatch.setattr(read, "in_copy", lambda *_: pytest.fail("a copy costs time"))
    assert len(read_part(tmp_path / "part.step").faces) == 14


def test_a_border_that_fits_its_surface_and_one_that_does_not(whole, tmp_path):
    good = read_part(compound(drilled(), as_nurbs(rod())))
    assert [misfit(good.face(face.number)) for face in good.faces] == [""] * len(good.faces)
    assert not any(open_border(good.face(face.number)) for face in good.faces)
    (tmp_path / "part.step").write_text(PATTERNS["cylinder without a radius"].change(whole["drilled"]))
    reader = STEPControl_Reader()
    reader.ReadFile(str(tmp_path / "part.step"))
    reader.TransferRoots()
    bad = Part(reader.OneShape())
    assert [face.number for face in bad.faces if "3 mm" in misfit(bad.face(face.number))] == [
        face.number for face in bad.faces if face.surface == "cylinder"
    ]


def test_an_uncertainty_beyond_the_part_is_said(tmp_path):
    """With it the kernel takes the seam of a sphere for a point: the edge is gone, the solid open."""
    file = tmp_path / "ball.step"
    writer = STEPControl_Writer()
    writer.Transfer(ball(10), STEPControl_AsIs)
    writer.Write(str(file))
    assert read_part(file).warnings == ()
    file.write_text(re.sub(r"LENGTH_MEASURE\([^)]*", "LENGTH_MEASURE(1.E12", file.read_text()))
    (warning,) = read_part(file).warnings
    assert "some may be missing" in warning


def test_a_face_without_a_size_is_lost():
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.gp import gp_Pln

    part = Part(compound(drilled(), BRepBuilderAPI_MakeFace(gp_Pln()).Face()), lost=(LostFace("#1", "", "gone"),))
    assert [(each.entity, each.face) for each in part.lost] == [("#1", None), ("", 8)]


# --- IGES ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", [0, 1], ids=["surfaces", "solid"])
def test_faces_lost_in_iges_are_named(mode, tmp_path):
    writer = IGESControl_Writer("MM", mode)
    writer.AddShape(drilled())
    writer.ComputeModel()
    writer.Write(str(tmp_path / "whole.igs"))
    assert read_part(tmp_path / "whole.igs").lost == ()
    lines = (tmp_path / "whole.igs").read_text().splitlines(keepends=True)
    kind = "510" if mode else "144"
    at = next(i for i, line in enumerate(lines) if line[72] == "P" and line.startswith(f"{kind},"))
    entity = int(lines[at][64:72])
    # Its border for a surface, which it is none.
    first = lines[at][:64].split(",")
    first[1] = first[4].rstrip(" ;")
    lines[at] = ",".join(first)[:64].ljust(64) + lines[at][64:]
    (tmp_path / "bad.igs").write_text("".join(lines))
    part = read_part(tmp_path / "bad.igs")
    assert [each.entity for each in part.lost] == [f"D{entity}"]
    assert len(part.faces) - (part.lost[0].face is not None) == 6


# --- whose work takes too long ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("told", "line"),
    [
        ("stage tessellate\nwork kernel\nwork own F12\n", r"^part: F12: our own tessellation did not end within 5 s; try"),
        ("stage tessellate\nwork kernel F3\n", r"^part: F3: the CAD kernel did not end its tessellation"),
        ("stage sample\n", r"^part: the CAD kernel did not end its sampling"),
        ("stage tessellate\nwork own F12\nstage write\n", r"^part: the CAD kernel did not end its splitting and writing"),
        ("stage read\n", r"^part: not read within 1 s"),
    ],
)
def test_the_line_says_whose_work_it_was_and_where(told, line):
    here, there = os.pipe()
    watch = _Watch(read_timeout=1.0)
    watch.pipe = here
    os.write(there, told.encode())
    watch.listen(0.0)
    os.close(here)
    os.close(there)
    assert re.search(line, str(watch.ended(*watch.verdict())))
    assert "--read-timeout" in str(watch.ended(*watch.verdict()))


def test_tessellation_tells_where_it_is():
    told = []
    part = read_part(as_nurbs(rod()))
    tessellate(part, 0.05, at=lambda who, face: told.append((who, face)))
    numbers = [face.number for face in part.faces]
    # As they are begun, bounded, counted and laid.
    assert told == [("own", number) for _ in range(4) for number in numbers]


def test_tessellation_tells_of_what_is_left_to_the_kernel(monkeypatch):
    told = []
    monkeypatch.setattr(start, "own_start", lambda *_: None)
    tessellate(read_part(as_nurbs(rod())), 0.1, faces=[2], at=lambda who, face: told.append((who, face)))
    assert ("kernel", 2) in told


def test_our_tessellation_is_named_where_it_takes_too_long():
    here, there = os.pipe()
    watch = _Watch(1e-9)
    watch.pipe = here
    os.write(there, b"part part.step\nstage tessellate\nwork own F3\n")
    watch.listen(1.0)
    os.close(there)
    assert watch.late()
    said = str(watch.ended(*watch.verdict()))
    os.close(here)
    assert said.startswith("part.step: F3: our own tessellation did not end within")
