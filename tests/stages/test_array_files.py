"""Arrays from strangers: compiled code sees none that could lead it beyond its arrays."""

import contextlib
import io
import json
import struct
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from plan_cutters.domain.verdicts import ACCESSIBLE, UNDECIDED, WORDS
from plan_cutters.errors import OptionError
from plan_cutters.report.page.stored_maps import stored
from plan_cutters.stages.posture_maps import PostureMaps
from tests.support import array_files as made


class Quiet(dict):
    """Not printed where a test fails."""

    def __repr__(self):
        return "the good file"


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    path = made.written(tmp_path_factory.mktemp("good") / "postures.npz", made.maps())
    return Quiet(made.members(path))


def used(maps):
    """All that is done with maps; the answers, as far as they can be checked."""
    for words in ({}, {"machine": "trunnion-ac"}, {"machine": "tilt:20", "setup": (1, 2, 3)}):
        reach = maps.within(**words)
        assert np.isin(reach.verdict, list(WORDS)).all()
        reached = reach.axis[reach.reached]
        assert np.abs(np.linalg.norm(reached, axis=1) - 1.0).max(initial=0.0) < 1e-4
        assert (reach.rotation[reach.verdict == ACCESSIBLE] < len(maps.rotations)).all()
    with contextlib.suppress(OptionError):
        maps.asked(machine="tilt:40", tolerance=0.01)
    rows = np.arange(len(maps.verdict))
    if len(rows):
        found = stored(maps, rows, rows)
        assert found.count.sum() == len(found.end)


def one_line(line, path):
    assert "\n" not in line
    assert line.startswith(Path(path).name)
    assert len(line) < 300
    return False


def opened(path):
    """Load and use, or a refusal of one line that names the file."""
    try:
        maps = PostureMaps.load(path)
    except OptionError as error:
        return one_line(str(error), path)
    used(maps)
    return True


def check(data, folder):
    path = folder / "postures.npz"
    path.write_bytes(data)
    return opened(path)


def test_a_good_file_comes_back(tmp_path):
    maps = made.maps()
    assert PostureMaps.load(made.written(tmp_path / "postures.npz", maps)) == maps
    used(maps)


def changes(good):
    return made.changed(good).map(Bytes)


class Bytes(bytes):
    def __repr__(self):
        return f"{len(self)} bytes"


@given(st.data())
@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
def test_changed_files_are_refused_or_right(good, tmp_path_factory, data):
    check(data.draw(changes(good)), tmp_path_factory.getbasetemp())


@pytest.mark.slow("changes 20,000 files")
@given(st.data())
@settings(max_examples=20_000, deadline=None, suppress_health_check=list(HealthCheck))
def test_changed_files_are_refused_or_right_for_long(good, tmp_path_factory, data):
    check(data.draw(changes(good)), tmp_path_factory.getbasetemp())


def altered(good, name, change):
    return made.packed([(each, made.npy(change(made.array_of(data).copy())) if each == f"{name}.npy" else data)
                        for each, data in good.items()])  # fmt: skip


def put(row, value):
    def change(array):
        array[row] = value
        return array

    return change


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        ("offset_R1L9", put(5, 10**12), "offset, row 5"),
        ("offset_R1L9", put(0, -4), "offset, row 0"),
        ("offset_R1L9", put(-1, 10**15), "offset, row 24"),
        ("offset_R1L9", lambda a: a[:-1], "array offset_R1L9 is <i8 (24,)"),
        ("offset_R1L9", lambda a: a.astype(float), "array offset_R1L9 is <f8"),
        ("free_R1L9", put((2, 0), np.nan), "free, row 2"),
        ("free_R1L9", put((1, 0), 0.2), "free, row 1"),
        ("free_R1L9", put((3, 1), 7.0), "free, row 3"),
        ("normal", put(1, np.inf), "normal, row 1"),
        ("normal", put(2, 0.0), "normal, row 2"),
        ("direction_max", put(0, [0.6, 0.8, 0.0]), "direction_max, row 0"),
        ("rotation", put(1, 1e9), "rotations, row 1"),
        ("rotation", put(3, 0.0), "rotations, row 3"),
        ("rotation", lambda a: a[:0], "0 rotations"),
        ("undecided_R1L9", put((4, 1), -1.0), "undecided, row 4"),
        ("undecided_R1L9", put((0, 0), np.nan), "undecided, row 0"),
        ("verdict_R1L9", put(0, 77), "verdict, row 0"),
        ("verdict_R1L9", put(0, 255), "sample 0 was not judged"),
        ("reason_R1L9", put(2, 99), "reason, row 2"),
        ("inside", lambda a: a.astype(np.uint8), "array inside"),
    ],
)
def test_what_is_wrong_is_named(good, tmp_path, name, change, said):
    path = tmp_path / "postures.npz"
    path.write_bytes(altered(good, name, change))
    with pytest.raises(OptionError, match=r"postures\.npz") as caught:
        PostureMaps.load(path)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("offset", np.array([0, 9, 4])), ("free", [[0.0, 1.0]]), ("normal", np.zeros((6, 3))), ("rotations", np.zeros(4)),
        ("undecided", np.full((6, 4), np.nan, np.float32)), ("verdict", np.full(6, 9, np.uint8)), ("tilt", (2.0, 1.0)),
        ("tilt", None), ("tolerance", np.nan), ("cutter", 3), ("about", None), ("reason", np.zeros(6)),
        ("inside", np.ones(5, bool)), ("free", np.zeros((8, 2))[:, ::-1]),
    ],
)  # fmt: skip
def test_maps_made_by_hand_are_checked_too(word, value):
    with pytest.raises(OptionError):
        made.maps(**{word: value})
    with pytest.raises(OptionError):
        replace(made.maps(), **{word: value})


def test_nobody_changes_arrays_behind_their_back():
    offset = made.maps().offset.copy()
    maps = made.maps(offset=offset)
    offset[3] = 10**15
    assert maps.offset[3] < 100
    with pytest.raises(ValueError, match="read-only"):
        maps.offset[3] = 10**15


def bomb(good, name, size):
    """A member that says it unpacks to far more than there is."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (size // 8,)})
    data = made.packed([(each, header.getvalue() if each == f"{name}.npy" else old) for each, old in good.items()])
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        member = archive.getinfo(f"{name}.npy")
        real, place = member.file_size, member.header_offset
    lie = struct.pack("<L", min(len(header.getvalue()) + size, 0xFFFFFFFE))
    at = data.rfind(b"PK\x01\x02", 0, data.rfind(f"{name}.npy".encode()))
    assert struct.unpack("<L", data[at + 24 : at + 28])[0] == real
    return data[: place + 22] + lie + data[place + 26 : at + 24] + lie + data[at + 28 :]


def test_a_bomb_is_not_unpacked(good, tmp_path):
    import tracemalloc

    tracemalloc.start()
    try:
        assert not check(bomb(good, "free_R1L9", 1 << 31), tmp_path)
        shape = {"descr": "<f8", "fortran_order": False, "shape": (1 << 39, 2)}
        header = io.BytesIO()
        np.lib.format.write_array_header_1_0(header, shape)
        data = [(each, header.getvalue() if each == "free_R1L9.npy" else old) for each, old in good.items()]
        assert not check(made.packed(data), tmp_path)
        # Zeros without end, of a shape that fits to nothing else: told by the headers.
        zeros = [(each, made.npy(np.zeros((1 << 21, 2))) if each == "free_R1L9.npy" else old) for each, old in good.items()]
        tracemalloc.reset_peak()
        before = tracemalloc.get_traced_memory()[0]
        assert not check(made.packed(zeros), tmp_path)
        assert tracemalloc.get_traced_memory()[1] - before < 45e6  # what packing them took
    finally:
        tracemalloc.stop()


def test_an_old_file_is_refused_as_such(good, tmp_path):
    about = json.loads(str(made.array_of(good["about.npy"]).reshape(-1)[0]))
    about = {word: about[word] for word in about if word != "question"} | {"version": 1}
    path = tmp_path / "postures.npz"
    path.write_bytes(made.packed((good | {"about.npy": made.npy(np.array(json.dumps(about)))}).items()))
    with pytest.raises(OptionError, match="made by an earlier version"):
        PostureMaps.load(path)


def test_other_kinds_of_files(tmp_path):
    import os

    os.mkfifo(tmp_path / "pipe.npz")
    (tmp_path / "empty.npz").write_bytes(b"")
    np.savez(tmp_path / "other.npz", a=np.arange(3))
    np.save(tmp_path / "one.npy", np.arange(3))
    for name in ("pipe.npz", "empty.npz", "other.npz", "one.npy", "none.npz", "."):
        with pytest.raises(OptionError) as caught:
            PostureMaps.load(tmp_path / name)
        assert "\n" not in str(caught.value)


def test_undecided_stays_undecided_as_long_as_the_machine_holds_a_posture():
    maps = made.maps()
    doubtful = maps.verdict == UNDECIDED
    assert doubtful.any()
    assert (maps.within().verdict[doubtful] == UNDECIDED).all()
    assert (maps.within("tilt:170").verdict[doubtful] == UNDECIDED).all()


def test_no_other_reader_of_arrays(tmp_path):
    """Every `.npz` goes through the one door, and `samples.npz` in FreeCAD through a narrower one of its own."""
    for root in ("plugin", "cad_io", "freecad"):
        for path in Path(root).rglob("*"):
            if path.suffix in (".py", ".FCMacro"):
                text = path.read_text(encoding="utf-8")
                for word in ("np.load(", "numpy.load(", "allow_pickle=True"):
                    assert word not in text, path
