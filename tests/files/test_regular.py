"""Regular files alone are read, as far as they are as small as they should be."""

import os
import socket

import pytest

from plan_cutters.errors import PlanError
from plan_cutters.files.content import IrregularError, open_regular, regular_bytes


def pipe(path):
    os.mkfifo(path)


def a_socket(path):
    with socket.socket(socket.AF_UNIX) as opened:
        opened.bind(str(path))


def endless(path):
    path.symlink_to("/dev/zero")


IRREGULAR = {
    "pipe": (pipe, "pipe or a device"),
    "socket": (a_socket, "pipe or a device"),
    "device": (endless, "pipe or a device"),
    "folder": (os.mkdir, "folder"),
}


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # a socket's path is short
    return tmp_path / "entry"


def test_a_file_is_read_to_its_end_and_through_a_link(place):
    place.write_bytes(b"1234")
    link = place.with_name("link")
    link.symlink_to(place)
    assert regular_bytes(place, 4) == regular_bytes(link, 4) == b"1234"
    with open_regular(place) as opened:
        assert opened.read() == b"1234"


def test_a_missing_file_is_none(place):
    place.write_bytes(b"")
    place.with_name("dangling").symlink_to("nowhere")
    missing = place / "below a file", place.with_name("dangling"), place.with_name("missing")
    assert [regular_bytes(each, 4) for each in missing] == [None] * 3
    assert regular_bytes(place, 0) == b""


@pytest.mark.parametrize("kind", IRREGULAR)
def test_what_is_no_regular_file_is_refused_without_waiting(place, kind):
    make, words = IRREGULAR[kind]
    make(place if kind != "socket" else "entry")
    with pytest.raises(PlanError, match=f"^entry: is .*{words}$"):
        regular_bytes(place, 1 << 20)
    with pytest.raises(IrregularError):
        open_regular(place)


def test_what_takes_the_place_of_the_file_is_not_read(place, monkeypatch):
    place.write_bytes(b"1")
    regular = os.stat(place)
    place.unlink()
    os.mkfifo(place)
    monkeypatch.setattr(os, "stat", lambda *_, **__: regular)
    with pytest.raises(PlanError, match="pipe or a device"):
        regular_bytes(place, 9)


def test_a_larger_file_is_refused_before_it_is_read(place):
    with open(place, "wb") as opened:
        opened.truncate(1 << 40)  # takes no room
    with pytest.raises(PlanError, match="larger than 4 bytes"):
        regular_bytes(place, 4)


def test_a_file_that_says_no_length_is_read_no_farther():
    """Files of /proc say 0 and hold more."""
    with pytest.raises(PlanError, match="larger than 4 bytes"):
        regular_bytes("/proc/self/status", 4)


def test_a_name_that_no_file_can_have_is_one_line():
    with pytest.raises(PlanError, match="is no name of a file"):
        regular_bytes("a\0b", 4)
