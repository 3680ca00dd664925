"""A file is there as a whole or as it was before, whatever ends its writing."""

import os
import stat

import pytest

from cad_io.errors import WriteError
from plan_cutters_base.whole import whole


def test_it_takes_its_place_at_the_end(tmp_path):
    path, names = tmp_path / "a.step", []
    path.write_text("old")
    with whole(path, named=lambda temporary: names.append((temporary, temporary.exists()))) as temporary:
        assert temporary.parent == path.parent
        assert temporary.suffix == ".step"  # writers choose their format by it
        temporary.write_text("new")
        assert path.read_text() == "old"
    assert names == [(temporary, False)]
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("ends", [KeyboardInterrupt(), ValueError("no"), OSError(28, "No space left on device")])
def test_what_is_not_written_to_its_end_is_gone(tmp_path, ends):
    path = tmp_path / "a"
    path.write_text("old")

    def write():
        with whole(path) as temporary:
            temporary.write_text("ne")
            raise ends

    with pytest.raises(type(ends)):
        write()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_errors_of_the_system_name_the_file(tmp_path):
    with pytest.raises(WriteError, match=r"^.*a: cannot be written: No space left on device$"), whole(tmp_path / "a", WriteError):
        raise OSError(28, "No space left on device")
    with pytest.raises(WriteError, match=r"none.a: cannot be written: No such file"), whole(tmp_path / "none/a", WriteError):
        pass
    (tmp_path / "folder").mkdir()
    with pytest.raises(WriteError, match="cannot be written"), whole(tmp_path / "folder", WriteError):
        pass
    with pytest.raises(ValueError, match="other"), whole(tmp_path / "a", WriteError):
        raise ValueError("other")


def test_it_has_the_rights_of_any_new_file(tmp_path):
    before = os.umask(0o027)
    try:
        with whole(tmp_path / "a") as temporary:
            temporary.write_text("x")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == 0o640


def test_two_writers_at_a_time_do_not_mix(tmp_path):
    with whole(tmp_path / "a") as first, whole(tmp_path / "a") as second:
        first.write_text("1")
        second.write_text("2")
    assert (tmp_path / "a").read_text() == "1"
    assert [each.name for each in tmp_path.iterdir()] == ["a"]
