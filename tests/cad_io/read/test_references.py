"""Files that a STEP file refers to are not followed: none is opened, and the file is refused in one line."""

import json
import os

import pytest

from cad_io import ReadError, read_part
from plan_cutters_base.user_files import WITHIN, noted
from tests.support.step_references import BALL, BOX, write_assembly


@pytest.fixture
def whole(tmp_path):
    return write_assembly(tmp_path / "part")


def renamed(whole, *names):
    for old, new in zip((BOX, BALL), names, strict=True):
        whole.write_text(whole.read_text().replace(f"'{old}'", f"'{new}'"))


@pytest.mark.parametrize("there", [True, False])
def test_an_assembly_in_several_files_is_refused_with_what_to_do(whole, there):
    if not there:
        for name in (BOX, BALL):
            whole.with_name(name).unlink()
    with noted() as files, pytest.raises(ReadError, match=f"refers to {BOX}, and other files are not followed: save it as one"):
        read_part(whole)
    assert {os.path.basename(name) for name in files} == {whole.name}


def test_a_document_beside_the_shape_is_no_reference(whole):
    renamed(whole, "drawing.pdf", "notes.TXT")
    with pytest.raises(ReadError, match="holds no shape"):
        read_part(whole)


def test_a_document_outside_of_the_folders_that_may_be_read_is_refused(whole, monkeypatch):
    renamed(whole, "../drawing.pdf", "notes.txt")
    monkeypatch.setenv(WITHIN, json.dumps([str(whole.parent)]))
    with pytest.raises(ReadError, match="outside the folders that may be read"):
        read_part(whole)
