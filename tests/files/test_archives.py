"""Arrays from strangers: none is unpacked that is not as its header says, and each refusal is one line."""

import io
import os
import struct
import tracemalloc
import zipfile

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from plan_cutters.errors import PlanError
from plan_cutters.files.arrays import Archive


def npy(array):
    out = io.BytesIO()
    np.lib.format.write_array(out, array)
    return out.getvalue()


GOOD = {
    "point.npy": npy(np.arange(12.0).reshape(4, 3)),
    "code.npy": npy(np.arange(4, dtype=np.uint8)),
    "say.npy": npy(np.array("a")),
}


def packed(members):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return out.getvalue()


def opened(data, folder):
    """All arrays of a file, which are as their headers say; None where it is refused in one line that names the file."""
    path, refused = folder / "arrays.npz", ""
    path.write_bytes(data)
    try:
        with Archive(path, "arrays", PlanError) as archive:
            arrays = {name: archive.read(name) for name in archive.headers}
            for name, header in archive.headers.items():
                assert (arrays[name].dtype.str, arrays[name].shape) == (header.dtype, header.shape)
            return arrays
    except PlanError as error:
        refused = str(error)
    assert "\n" not in refused
    assert refused.startswith(path.name)
    return None


def test_a_good_file_comes_back(tmp_path):
    arrays = opened(packed(GOOD), tmp_path)
    assert arrays["point"].tolist() == np.arange(12.0).reshape(4, 3).tolist()


@given(st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 255)), min_size=1, max_size=3), st.booleans())
@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_changed_bytes_are_refused_or_as_the_header_says(tmp_path, changes, inside):
    data = bytearray(GOOD["point.npy"] if inside else packed(GOOD))
    for at, byte in changes:
        data[at % len(data)] = byte
    opened(packed(GOOD | {"point.npy": bytes(data)}) if inside else bytes(data), tmp_path)


def test_a_bomb_is_not_unpacked(tmp_path):
    """A member that says it unpacks to far more than there is, or whose shape does."""
    size, header, tall = 1 << 31, io.BytesIO(), io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (size // 8,)})
    np.lib.format.write_array_header_1_0(tall, {"descr": "<f8", "fortran_order": False, "shape": (1 << 39, 2)})
    data = packed(GOOD | {"point.npy": header.getvalue()})
    place = zipfile.ZipFile(io.BytesIO(data)).getinfo("point.npy").header_offset
    lie, at = struct.pack("<L", len(header.getvalue()) + size), data.rfind(b"PK\x01\x02", 0, data.rfind(b"point.npy"))
    tracemalloc.start()
    try:
        assert opened(data[: place + 22] + lie + data[place + 26 : at + 24] + lie + data[at + 28 :], tmp_path) is None
        assert opened(packed(GOOD | {"point.npy": tall.getvalue()}), tmp_path) is None
        assert tracemalloc.get_traced_memory()[1] < 45e6
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("name", ["pipe.npz", "empty.npz", "one.npy", "none.npz", "."])
def test_other_kinds_of_files(tmp_path, name):
    os.mkfifo(tmp_path / "pipe.npz")
    (tmp_path / "empty.npz").write_bytes(b"")
    np.save(tmp_path / "one.npy", np.arange(3))
    with pytest.raises(PlanError) as caught:
        Archive(tmp_path / name, "arrays", PlanError)
    assert "\n" not in str(caught.value)
