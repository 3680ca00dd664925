"""Files that a STEP file refers to: all of it is read, or what is missing is known and nothing is certain."""

import json
import os
import pickle
import shutil

import pytest

from cad_io import ReadError, read_part
from cad_io.read.step_text import followed, in_folder_of, names
from plan_cutters_base.user_files import WITHIN, checksum, checksums, fingerprint, noted
from tests.support.step_references import BALL, BOX, write_assembly


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return write_assembly(tmp_path_factory.mktemp("made"))


@pytest.fixture
def whole(made, tmp_path):
    """The assembly in a folder of its own, which a test may change."""
    shutil.copytree(made.parent, tmp_path / "part")
    return tmp_path / "part" / made.name


def fingerprint_of(whole):
    """Checksum of a file with all that it refers to."""
    data = whole.read_bytes()
    return fingerprint(checksum(data), checksums(followed(data, in_folder_of(whole))))


def renamed(whole, old, new):
    whole.write_text(whole.read_text().replace(f"'{old}'", f"'{new}'"))


def test_all_files_of_an_assembly_are_read_and_known(whole):
    with noted() as files:
        part = read_part(whole)
    assert (len(part.faces), part.lost) == (7, ())
    assert part.size == pytest.approx((29, 14, 14), abs=1e-6)
    assert {name for name, _ in part.references} == {BOX, BALL}
    assert {os.path.basename(name) for name in files} == {whole.name, BOX, BALL}
    assert None not in files.values()
    assert part.fingerprint == fingerprint_of(whole) != part.sha256
    again = pickle.loads(pickle.dumps(part))
    assert (again.references, again.fingerprint) == (part.references, part.fingerprint)
    assert part.without({1: "hangs"}).references == part.references


def test_another_content_of_a_file_that_is_referred_to_is_another_fingerprint(whole):
    before = fingerprint_of(whole)
    other = whole.with_name(BALL)
    other.write_bytes(other.read_bytes() + b" ")
    changed = fingerprint_of(whole)
    other.unlink()
    assert len({before, changed, fingerprint_of(whole)}) == 3


def empty(path):
    path.write_bytes(b"")


def cut_off(path):
    path.write_bytes(path.read_bytes()[:1500])


def no_step(path):
    path.write_bytes(b"solid x\nendsolid x\n")


def without_its_face(path):
    """Its only face cannot be read; OCCT says nothing of it."""
    path.write_text(path.read_text().replace("SPHERICAL_SURFACE('',#", "SPHERICAL_SURFACE('',#9"))


@pytest.mark.parametrize("damage", [os.unlink, empty, cut_off, no_step, without_its_face])
def test_what_is_missing_of_a_file_that_is_referred_to_is_lost_and_told(whole, damage):
    damage(whole.with_name(BALL))
    part = read_part(whole)
    assert part.lost
    assert all(each.face is None and BALL in str(each) for each in part.lost)


def test_files_are_looked_for_beside_the_file_and_not_where_the_process_works(whole, monkeypatch, tmp_path):
    shutil.move(whole.with_name(BALL), tmp_path / BALL)
    monkeypatch.chdir(tmp_path)
    part = read_part(os.path.join("part", whole.name))
    assert (len(part.faces), len(part.lost)) == (6, 1)


@pytest.mark.parametrize("name", ["below/" + BALL, "below\\" + BALL, "../" + BALL])
def test_files_in_other_folders_are_found(whole, name):
    renamed(whole, BALL, name)
    there = whole.parent / name.replace("\\", "/")
    there.parent.mkdir(exist_ok=True)
    shutil.move(whole.with_name(BALL), there)
    part = read_part(whole)
    assert (len(part.faces), part.lost) == (7, ())
    assert (os.path.normpath(name.replace("\\", "/")), None) not in part.references


def test_an_assembly_of_assemblies_counts_each_face_once(whole):
    outer = whole.with_name("outer.stp")
    outer.write_text(whole.read_text().replace(BALL, whole.name))
    part = read_part(outer)
    assert (len(part.faces), part.lost) == (13, ())  # the box is shown twice
    assert {name for name, _ in part.references} == {BOX, BALL, whole.name}


def test_a_file_that_refers_to_itself_is_refused(whole):
    renamed(whole, BALL, whole.name)
    with pytest.raises(ReadError, match="refers to it again"):
        read_part(whole)


def test_a_document_beside_the_shape_costs_nothing(whole):
    renamed(whole, BALL, "drawing.pdf")
    part = read_part(whole)
    assert (len(part.faces), part.lost) == (6, ())


def test_where_no_shape_is_left_the_missing_file_is_named(whole):
    for name in (BOX, BALL):
        whole.with_name(name).unlink()
    with pytest.raises(ReadError, match=f"holds no shape.*{BOX}.*put it into the folder of the file"):
        read_part(whole)


def test_each_file_has_its_own_unit(tmp_path):
    inch, mm = write_assembly(tmp_path / "inch", "INCH"), write_assembly(tmp_path / "mm")
    shutil.copy(inch.with_name(BALL), mm.with_name(BALL))
    part = read_part(mm)
    assert part.lost == ()
    assert part.size == pytest.approx((29, 14, 14), abs=1e-5)
    with pytest.raises(ReadError, match="units of their own"):
        read_part(mm, unit="in")


def test_a_file_outside_of_the_folders_that_may_be_read_is_refused(whole, monkeypatch):
    monkeypatch.setenv(WITHIN, json.dumps([str(whole.parent)]))
    assert len(read_part(whole).faces) == 7
    shutil.move(whole.with_name(BALL), whole.parent.parent / BALL)
    whole.with_name(BALL).symlink_to(whole.parent.parent / BALL)
    with pytest.raises(ReadError, match=f"refers to {BALL}: it lies outside the folders that may be read"):
        read_part(whole)
    outer = whole.with_name("outer.stp")
    outer.write_text(whole.read_text().replace(BALL, whole.name))
    with pytest.raises(ReadError, match="outside"):
        read_part(outer)


def test_names_are_those_of_the_text():
    text = (b"#1=DOCUMENT_FILE('a ''b''.stp','',$,#2,'',$);\n#2 = APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT (\n 'c/d.stp',#3,#4,"
            b"(#1));#5=DOCUMENT_FILE('','',$,#2,'',$);#6=DOCUMENT_FILE('c/d.stp','',$,#2,'',$);")  # fmt: skip
    assert sorted(names(text)) == ["a 'b'.stp", "c/d.stp"]
    assert names(b"#1=PRODUCT('x');") == ()


def test_references_are_followed_from_folder_to_folder_once():
    files = {"sub/a.stp": b"DOCUMENT_FILE('b.stp',", "sub/b.stp": b"DOCUMENT_FILE('../c.stp',DOCUMENT_FILE('a.stp',"}
    found = dict(followed(b"DOCUMENT_FILE('sub/a.stp',", files.get))
    assert found == {**files, "c.stp": None}
    many = b"".join(b"DOCUMENT_FILE('%d'," % k for k in range(10_001))
    with pytest.raises(ReadError, match="more than 10000 files"):
        list(followed(many, files.get))


@pytest.mark.parametrize(("written", "name"), [
    (f"/* the ball */ '{BALL}'", BALL),
    ("'of_\nball.stp'", BALL),
    (r"'\X2\00DC\X0\ball.stp'", "Üball.stp"),
    (r"'\X4\0001D6FC\X0\ball.stp'", "\U0001d6fcball.stp"),
    (r"'\X\DCball.stp'", "Üball.stp"),
    (r"'\S\\ball.stp'", "Üball.stp"),
])  # fmt: skip
def test_a_file_that_the_kernel_opens_is_noted_however_it_is_written(whole, written, name):
    whole.write_text(whole.read_text().replace(f"'{BALL}'", written))
    shutil.move(whole.with_name(BALL), whole.with_name(name))
    with noted() as files:
        part = read_part(whole)
    assert (len(part.faces), part.lost) == (7, ())
    assert {os.path.basename(path) for path, there in files.items() if there} == {whole.name, BOX, name}
    assert {path for path, _ in part.references} == {BOX, name}


def test_short_names_of_entities_are_known(whole):
    text = whole.read_text().replace("DOCUMENT_FILE(", "DCMFL(")
    whole.write_text(text.replace("APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT(", "APEXIA("))
    part = read_part(whole)
    assert ({path for path, _ in part.references}, len(part.faces)) == ({BOX, BALL}, 7)


def test_what_only_the_kernel_would_open_is_refused(whole, monkeypatch, tmp_path):
    """Whatever form of a reference the text is not searched for: the kernel opens no file that nobody noted or permitted."""
    monkeypatch.setattr("cad_io.read.step_text.WORDS", (b"NONE",))
    with pytest.raises(ReadError, match=f"refers to {BOX} in a form that is not known here"):
        read_part(whole)
    for name in (BOX, BALL):
        shutil.move(whole.with_name(name), tmp_path / name)
    renamed(whole, BALL, str(tmp_path / BALL))
    monkeypatch.setenv(WITHIN, json.dumps([str(whole.parent)]))
    with pytest.raises(ReadError, match="in a form that is not known here"):
        read_part(whole)


def test_a_pipe_is_not_waited_for(whole):
    whole.with_name(BALL).unlink()
    os.mkfifo(whole.with_name(BALL))
    with pytest.raises(ReadError, match=f"refers to {BALL}, which is no regular file, but a pipe or a device"):
        read_part(whole)
    whole.with_name(BALL).unlink()
    whole.with_name(BALL).mkdir()
    assert len(read_part(whole).lost) == 1
