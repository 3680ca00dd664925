"""A folder here and one in memory, which stands for object storage, are one thing."""

import hashlib
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters.errors import PlanError
from plan_cutters.files.folder import Folder

NAMES = st.sampled_from(["a", "b.json", "sub/a", "sub/deep/c", "other/a"])
STEPS = st.lists(st.tuples(st.sampled_from(["put", "remove", "clear"]), NAMES, st.binary(max_size=9)), max_size=12)


@pytest.fixture(scope="module", params=["here", "memory"])
def made(request, tmp_path_factory):
    """Makes folders with nothing in them."""
    if request.param == "here":
        return lambda: Folder(str(tmp_path_factory.mktemp("folder")))
    number = iter(range(1 << 30))
    return lambda: Folder(f"memory://folder{next(number)}")


@given(STEPS)
def test_it_holds_what_was_put_there_last(made, steps):
    folder, known = made(), {}
    for step, name, data in steps:
        if step == "put":
            folder.put(name, data)
            known[name] = data
        elif step == "remove" and name in known:
            folder.remove(name)
            del known[name]
        elif step == "clear":
            folder.clear("sub")
            known = {each: data for each, data in known.items() if not each.startswith("sub/")}
    assert folder.names() == set(known)
    assert folder.names("sub") == {each.removeprefix("sub/") for each in known if each.startswith("sub/")}
    for name in ("a", "b.json", "sub/a", "sub/deep/c", "other/a"):
        assert folder.get(name, 1 << 10) == known.get(name)
        assert folder.checksum(name) == (hashlib.sha256(known[name]).hexdigest() if name in known else None)


def test_another_process_finds_it_by_its_address(made):
    folder = made()
    folder.put("a", b"1")
    assert Folder(folder.root_url).get("a", 9) == b"1"


def test_a_file_larger_than_it_may_be_is_refused_here(tmp_path):
    folder = Folder(str(tmp_path))
    folder.put("a", b"x" * 11)
    with pytest.raises(PlanError, match="is larger than 10 bytes"):
        folder.get("a", 10)


def test_a_folder_here_needs_no_package(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "fsspec.core", None)
    Folder(str(tmp_path)).put("a", b"1")
    with pytest.raises(PlanError, match=r"pip install .\.\[batch\]"):
        Folder("s3://shop")
