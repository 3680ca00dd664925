"""Files of users: what was read is noted, whoever reads it, and what lies outside of the folders is not read."""

import json
import os

import numpy as np
import pytest

from cad_io.errors import ReadError
from cad_io.read.mesh import read_mesh
from cad_io.read.sniff import load
from plan_cutters.errors import LibraryError, MachineError, PlanError
from plan_cutters.files.arrays import Archive
from plan_cutters.library import read_library
from plan_cutters.machines import read_machine
from plan_cutters.setups.files import read_setup
from plan_cutters_base.user_files import WITHIN, IrregularError, OutsideError, content, is_there, note, noted
from tests.support.places import SAMPLES, real_file

BIT = {"shape": "endmill.fcstd", "name": "b", "parameter": {"Diameter": "4 mm", "CuttingEdgeHeight": "20 mm", "Length": "50 mm",
                                                            "ShankDiameter": "4 mm"}}  # fmt: skip


@pytest.fixture
def shop(tmp_path):
    """A library, a machine and a setup in a folder, with what they name beside it and below."""
    for folder in ("root/Library", "root/Bit", "outside"):
        (tmp_path / folder).mkdir(parents=True)
    root = tmp_path / "root"
    (root / "Bit/b.fctb").write_text(json.dumps(BIT))
    (root / "Library/l.fctl").write_text(json.dumps({"tools": [{"nr": 1, "path": "b.fctb"}], "version": 1}))
    (root / "base.inc").write_bytes(real_file("machines/linuxcnc_xyzac-trt.ini").read_bytes())
    (root / "m.ini").write_text("[KINS]\nJOINTS = 5\n#INCLUDE base.inc\n")
    (root / "s.toml").write_text('unit = "mm"\nz = "+z"\n')
    return tmp_path


def read_bits(shop):
    return read_library(shop / "root/Library/l.fctl", assume_stickout=20.0, holder="none")


def names(files):
    return {os.path.normpath(name).rpartition("/root/")[2]: value for name, value in files.items()}


def test_every_file_that_an_importer_opens_is_noted(shop):
    with noted() as files:
        read_bits(shop)
    found = names(files)
    # The bit was looked for beside the library first: one that came to lie there would be another tool.
    assert found["Library/b.fctb"] is None
    assert {name for name, there in found.items() if there} == {"Library/l.fctl", "Bit/b.fctb"}
    with noted() as files:
        read_machine(shop / "root/m.ini")
    found = names(files)
    assert {name for name, there in found.items() if there} == {"m.ini", "base.inc"}
    assert found["switchkins_postgui.hal"] is None
    with noted() as files:
        read_setup(shop / "root/s.toml")
        load(str(SAMPLES / "v_groove.step"))
    assert [each is not None for each in files.values()] == [True, True]


def test_notes_are_nested_and_end(tmp_path):
    file = tmp_path / "a"
    file.write_bytes(b"1")
    with noted() as outer:
        with noted() as inner:
            content(file)
        is_there(tmp_path / "b")
    content(file)
    note("c", b"")
    assert list(inner) == [str(file)]
    assert list(outer) == [str(file), str(tmp_path / "b")]


def test_a_bit_outside_is_not_there_and_says_nothing(shop, monkeypatch):
    (shop / "outside/Bit").mkdir()
    (shop / "outside/Bit/b.fctb").write_text(json.dumps(BIT | {"name": "secret bit"}))
    (shop / "root/Bit/b.fctb").unlink()
    (shop / "root/Bit").rmdir()
    (shop / "root/Bit").symlink_to(shop / "outside/Bit")
    assert read_bits(shop)[0].radius == 2.0
    monkeypatch.setenv(WITHIN, json.dumps([str(shop / "root")]))
    with pytest.raises(LibraryError) as error:
        read_bits(shop)
    assert "secret" not in str(error.value)
    assert "its bit is neither" in str(error.value)


def test_an_included_file_outside_says_nothing(shop, monkeypatch):
    (shop / "outside/secret.inc").write_text("[TRAJ]\nLINEAR_UNITS = furlongsecret\n")
    (shop / "root/m.ini").write_text("#INCLUDE ../outside/secret.inc\n[KINS]\nKINEMATICS = xyzac-trt-kins\nJOINTS = 5\n")
    with pytest.raises(MachineError, match="furlongsecret"):
        read_machine(shop / "root/m.ini")
    monkeypatch.setenv(WITHIN, json.dumps([str(shop / "root")]))
    with pytest.raises(MachineError, match=r"secret\.inc.*outside the folders that may be read") as error:
        read_machine(shop / "root/m.ini")
    assert "furlong" not in str(error.value)


@pytest.mark.parametrize("read", [load, read_mesh, content, read_setup, read_library])
def test_no_reader_leaves_the_folders(shop, monkeypatch, read):
    monkeypatch.setenv(WITHIN, json.dumps([str(shop / "root")]))
    outside = shop / "outside/a.stl"
    outside.write_text("secret")
    link = shop / "root/a.stl"
    link.symlink_to(outside)
    for path in (outside, link, shop / "root/../outside/a.stl"):
        with pytest.raises((ReadError, PlanError, OutsideError), match="outside the folders"):
            read(str(path))
    assert not is_there(link)
    monkeypatch.setenv(WITHIN, "[]")
    with pytest.raises((ReadError, PlanError, OutsideError), match="outside the folders"):
        read(str(shop / "root/s.toml" if read is not read_mesh else link))


def test_archives_of_arrays_are_files_of_users(shop, monkeypatch):
    np.savez(shop / "outside/a.npz", a=np.zeros(3))
    (shop / "root/a.npz").symlink_to(shop / "outside/a.npz")
    with Archive(shop / "root/a.npz", "archive", PlanError) as archive:
        assert list(archive.headers) == ["a"]
    monkeypatch.setenv(WITHIN, json.dumps([str(shop / "root")]))
    with pytest.raises(PlanError, match="outside the folders"):
        Archive(shop / "root/a.npz", "archive", PlanError)


def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.stl")
    with pytest.raises(IrregularError, match="a pipe or a device"):
        content(tmp_path / "a.stl")
    for read in (load, read_mesh):
        with pytest.raises(ReadError, match="a pipe or a device"):
            read(str(tmp_path / "a.stl"))
