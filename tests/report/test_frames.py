"""Tables of pandas: samples against `axes.csv` and closed forms, faces and cutters against the sums of samples."""

import csv
import sys

import numpy as np
import pytest

from plan_cutters import OptionError, PlanError, plan
from plan_cutters.domain.verdicts import WORDS
from plan_cutters.plan_file.shares import VERDICTS
from plan_cutters.report.arrays import write_csv
from tests.support.places import SAMPLES

pandas = pytest.importorskip("pandas", reason="pandas is not installed: setup.sh dev")

OTHER = "R8L20rc8"


@pytest.fixture(scope="module")
def result():
    """A groove on a machine that tilts too little for some of it, and a cutter that is too large."""
    return plan(SAMPLES / "v_groove.step", cutters=[OTHER, "R3L40"], machine="trunnion-ac", grid=9, area_budget=0)


def test_samples_are_those_of_the_file(result, tmp_path):
    found = result.to_dataframe()
    write_csv(result, None, tmp_path / "axes.csv")
    with (tmp_path / "axes.csv").open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert list(found.columns) == head
    assert len(rows) == len(found) == len(result.samples)
    for k, name in enumerate(head):
        told = [row[k] for row in rows]
        if pandas.api.types.is_numeric_dtype(found[name]):
            numbers = np.array([float(text) if text else np.nan for text in told])
            assert np.allclose(found[name], numbers, rtol=0, atol=1e-6, equal_nan=True), name
        else:
            assert found[name].astype(object).where(found[name].notna(), "").tolist() == told, name


def test_samples_of_another_cutter_are_about_it(result):
    assert result.shown != OTHER
    found, verdicts = result.to_dataframe("samples", cutter=OTHER), result.reaches[OTHER]
    assert found.verdict.tolist() == [WORDS[code] for code in verdicts.verdict]
    # The tilt is the angle of the axis against the normal, and the tip lies where a ball that touches there has it.
    normal, axis = (found[[f"{name}_{k}" for k in "xyz"]].to_numpy() for name in ("normal", "axis"))
    reached = found.verdict.isin(["accessible", "interference_free"]).to_numpy()
    assert 0 < reached.sum() < len(found)
    angle = np.degrees(np.arccos(np.clip((normal * axis).sum(axis=1), -1.0, 1.0)))
    assert np.allclose(angle[reached], found.tilt_deg[reached], atol=1e-4)
    assert found[~reached][["axis_x", "tilt_deg", "tip_z_mm"]].isna().all(axis=None)
    points = result.samples.point
    tip = found[[f"tip_{k}_mm" for k in "xyz"]].to_numpy()
    assert np.allclose((tip - (points + 8.0 * normal - 8.0 * axis))[reached], 0.0, atol=1e-6)
    assert (found.reason.notna() == ~reached).all()


@pytest.mark.parametrize("cutter", [None, OTHER])
def test_faces_add_up_to_the_cutter(result, cutter):
    faces = result.to_dataframe("faces", cutter=cutter)
    entry = next(each for each in result.cutters if each.id == (cutter or result.shown))
    assert faces.face.tolist() == [face.id for face in result.plan.faces]
    for word in VERDICTS:
        assert faces[word].sum() == entry.of(word)
        share = (faces[f"{word}_share"] * faces.area_mm2).sum() / faces.area_mm2.sum()
        assert share == pytest.approx(getattr(entry.area_share, word), abs=1e-9)
    lost = faces.inaccessible + faces.undecided > 0
    assert (faces.reason.notna() == lost).all()


def test_faces_that_were_not_sampled_have_no_shares():
    result = plan(SAMPLES / "v_groove.step", cutters=["R3L40"], faces="2", grid=5, area_budget=0)
    faces = result.to_dataframe("faces").set_index("face")
    assert faces.target.tolist() == [False, True, False]
    assert faces.loc[["F1", "F3"], [f"{word}_share" for word in VERDICTS]].isna().all(axis=None)
    assert faces.loc["F2", "samples"] == 25


def test_cutters_are_a_row_each(result):
    found = result.to_dataframe("cutters").set_index("cutter")
    assert found.index.tolist() == [each.id for each in result.cutters]
    assert found.feasible.tolist() == [each.feasible for each in result.cutters]
    assert found.selected.sum() == (result.selected is not None)
    shares = found[[f"{word}_share" for word in VERDICTS]].sum(axis=1)
    assert np.allclose(shares, 1.0)


def test_an_undecided_cutter_is_no_failing_one(result):
    from dataclasses import replace

    entries = [result.cutters[0].model_copy(update={"feasible": None}), *result.cutters[1:]]
    unsure = replace(result, plan=result.plan.model_copy(update={"cutters": entries}))
    assert unsure.to_dataframe("cutters").feasible.isna().tolist() == [True, False]


def test_tables_can_be_changed_without_changing_the_result(result):
    before = result.samples.point.copy()
    found = result.to_dataframe()
    found.loc[:, "point_x_mm"] = 0.0
    assert np.array_equal(result.samples.point, before)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("edges",), "samples, faces, cutters"),
        (("samples", "R99L1"), "none of this plan's"),
        (("cutters", OTHER), "leave out cutter="),
    ],
)
def test_what_there_is_no_table_of(result, words, said):
    with pytest.raises(OptionError, match=said):
        result.to_dataframe(*words)


def test_without_pandas_it_says_what_to_install(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(PlanError, match="pip install pandas"):
        result.to_dataframe()
