"""samples.npz with many cutters: a fraction of what arrays in 64 bits take, and postures that hold all the same."""

import io
import zipfile

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.errors import PlanError
from plan_cutters.files.arrays import Archive
from plan_cutters.report import arrays
from tests.support.places import SAMPLES


@pytest.fixture(scope="module")
def result():
    return plan(
        SAMPLES / "peaks_and_valleys.step", cutters=["R6L80", "R4L60rc4"], machine="trunnion-ac", spacing=0.8, area_budget=0
    )


@pytest.fixture
def packed(result, tmp_path, monkeypatch):
    """The file as many cutters have it."""
    monkeypatch.setattr(arrays, "_LARGE", 0)
    monkeypatch.setattr(arrays, "_MACHINE_CUTTERS", 0)
    arrays.write_npz(result, None, tmp_path / "samples.npz")
    return tmp_path / "samples.npz"


def deflated(array):
    """Bytes of an array as they were written before: all of it, deflated."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("a", np.ascontiguousarray(array).tobytes())
    return len(buffer.getvalue())


def test_a_cutter_that_is_in_no_step_takes_less_than_a_quarter(result, packed):
    other = next(name for name in result.reaches if name != result.shown)
    verdicts, (angles, taken) = result.reaches[other], result.rotary(other)
    before = sum(
        map(deflated, (verdicts.verdict, verdicts.axis, verdicts.tilt_direction, verdicts.reason, np.degrees(angles), taken))
    )
    with zipfile.ZipFile(packed) as archive:
        now = {each.filename: each.compress_size for each in archive.infolist() if each.filename.endswith(f"_{other}.npy")}
    assert sorted(now) == [f"{word}_{other}.npy" for word in ("axis", "lean", "reason", "verdict")]
    assert sum(now.values()) < before / 4


def test_both_names_are_read_by_numpy_and_by_the_archive(result, packed):
    read = np.load(packed)
    with Archive(packed, "samples of a plan", PlanError) as archive:
        assert all(np.array_equal(archive.read(name), read[name], equal_nan=read[name].dtype.kind == "f") for name in read.files)
    assert {f"{word}_{name}" for word in ("axis", "lean") for name in result.reaches} <= {*read.files}
    assert f"rotary_{result.shown}" in read.files


@pytest.mark.parametrize("tolerance", [0.01, 0.001])
def test_rounding_moves_no_point_of_a_tool_by_more_than_a_fiftieth_of_the_tolerance(result, tolerance):
    """The farthest point is 180 mm from the tip, the contact at most 12 mm from the axis; what is unknown stays so."""
    for verdicts in result.reaches.values():
        axis, lean = (arrays.rounded(each, tolerance).astype(float) for each in (verdicts.axis, verdicts.tilt_direction))
        moved = 180.0 * np.linalg.norm(axis - verdicts.axis, axis=1) + 12.0 * np.linalg.norm(
            lean - verdicts.tilt_direction, axis=1
        )
        assert np.nanmax(moved) <= tolerance / 50.0
        assert np.array_equal(np.isnan(axis), np.isnan(verdicts.axis))


def test_the_size_of_each_file_is_in_the_plan(result, tmp_path):
    written = result.write(tmp_path / "out", ["json", "npz"])
    assert {e.name: e.size_bytes for e in written.files.values()} == {
        path.name: path.stat().st_size for path in (tmp_path / "out").iterdir() if path.name != "plan.json"
    }  # fmt: skip
