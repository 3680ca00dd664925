"""Feeds of presets: read with their unit from each format, never a part of the cutter, and never nonsense."""

import json

import numpy as np
import pytest

from plan_cutters import Cutter, OptionError, Options
from plan_cutters.library import read_library, to_toml
from plan_cutters.library.cutting import feed_of, is_finishing
from plan_cutters.operations.planning import feeds
from tests.support.tool_files import ID, fusion, hsmlib, real, write_csv, write_json, write_tools

PRESETS = [("Roughing", 900), ("Finishing", 1200), ("Last", 800)]


def with_presets(tool, presets, **more):
    return tool | {"start-values": {"presets": [{"name": name, "v_f": feed, **more} for name, feed in presets]}}


def only(library):
    (entry,) = library.entries
    return entry


@pytest.mark.parametrize("writer", [write_json, write_tools])
def test_the_finishing_preset_counts_and_is_said(tmp_path, writer):
    entry = only(read_library(writer(tmp_path / "a.json", [with_presets(fusion(), PRESETS)])))
    assert (entry.feed, entry.preset, entry.cutter.id) == (1200.0, "Finishing", ID)
    assert 'feed of its finishing preset, "Finishing": 1200 mm/min' in entry.notes


def test_without_one_for_finishing_the_first_counts_and_is_said(tmp_path):
    entry = only(read_library(write_json(tmp_path / "a.json", [with_presets(fusion(), [("Steel", 900), ("Brass", 950)])])))
    assert (entry.feed, entry.preset) == (900.0, "Steel")
    assert 'feed of the first of its presets, "Steel": 900 mm/min' in entry.notes


def test_inches_are_turned_into_mm(tmp_path):
    tool = with_presets(fusion(unit="inches", DC=0.25, LCF=0.5, LB=1.5, OAL=2.5, SFDM=0.25, shoulder_length=None,
                               shoulder_diameter=None, shaft=None), [("Finish", 10)])  # fmt: skip
    assert only(read_library(write_json(tmp_path / "a.json", [tool]))).feed == 254.0


@pytest.mark.parametrize("bad", [0, -5, 1e9, "fast", True, float("nan"), float("inf"), [1]])
def test_nonsense_is_ignored_with_a_note(tmp_path, bad):
    library = read_library(write_json(tmp_path / "a.json", [with_presets(fusion(), [("Finish", bad)])]))
    entry = only(library)
    assert (entry.feed, entry.cutter.id) == (None, ID)
    assert any("v_f" in note and "no feed" in note for note in entry.notes)
    other = only(read_library(write_json(tmp_path / "b.json", [with_presets(fusion(), [("Finish", bad), ("All", 700)])])))
    assert other.feed == 700.0


@pytest.mark.parametrize("start", [None, 3, [], {"presets": 7}, {"presets": [4, None]}, {"presets": [{"name": 3}]}])
def test_presets_that_are_none_are_no_feed(tmp_path, start):
    entry = only(read_library(write_json(tmp_path / "a.json", [fusion() | {"start-values": start}])))
    assert (entry.feed, entry.notes, entry.cutter.id) == (None, (), ID)


def test_rows_of_a_csv_are_presets_of_one_cutter(tmp_path):
    path = write_csv(tmp_path / "a.csv", [fusion()] * 3)
    head, *rows = path.read_text(encoding="utf-8-sig").splitlines()
    columns = ",Preset (preset_name),Feed (tool_feedCutting)"
    head = head.replace(",CSV_TOOLS_VERSION_1", columns)
    text = "\n".join([head, *(f"{row},{name},{feed}" for row, (name, feed) in zip(rows, PRESETS, strict=True))])
    path.write_text(text, encoding="utf-8")
    library = read_library(path)
    assert [entry.feed for entry in library.entries] == [900.0, 1200.0, 800.0]
    assert feed_of(library.entries_of(library[0])) == 1200.0
    assert feeds(Options(libraries=library), library.cutters) == {library[0]: 1200.0}


def test_hsmworks_has_presets_or_the_tools_own_motion(tmp_path):
    text = hsmlib([fusion()])
    motion = '<motion cutting-feedrate="640" feed-mode="per-minute"/>'
    preset = '<presets><preset name="{}"><parameter key="tool_feedCutting" value="{}"/></preset></presets>'
    for more, feed in ((motion, 640.0), (motion + preset.format("Schlichten", 710), 710.0),
                       (motion.replace("per-minute", "per-revolution"), None)):  # fmt: skip
        path = tmp_path / "a.hsmlib"
        path.write_bytes(text.replace("</tool>", more + "</tool>").encode("utf-16"))
        assert only(read_library(path)).feed == feed


@pytest.mark.parametrize(("given", "feed"), [("500", 500.0), (500, 500.0), ("8 mm/s", 480.0), ("10 in/min", 254.0),
                                            ("0,5 m/min", 500.0),
                                            ("quick", None), ("-3", None)])  # fmt: skip
def test_a_freecad_bit_may_have_one(tmp_path, given, feed):
    parameter = {"Diameter": "6 mm", "CuttingEdgeHeight": "12 mm", "Length": "60 mm", "ShankDiameter": "6 mm"}
    bit = {"version": 2, "name": "a", "shape-type": "Endmill", "parameter": parameter, "attribute": {"cutting_feedrate": given}}
    path = tmp_path / "a.fctb"
    path.write_text(json.dumps(bit), encoding="utf-8")
    entry = only(read_library(path, assume_stickout=40, holder="none"))
    assert entry.feed == feed
    assert entry.cutter is not None


def test_our_own_format_keeps_it(tmp_path):
    text = to_toml(read_library(write_json(tmp_path / "a.json", [with_presets(fusion(), PRESETS)])))
    assert "feed = 1200.0" in text
    (tmp_path / "a.toml").write_text(text, encoding="utf-8")
    entry = only(read_library(tmp_path / "a.toml"))
    assert (entry.feed, entry.cutter.id) == (1200.0, ID)
    (tmp_path / "a.toml").write_text(text.replace("1200.0", "nan"), encoding="utf-8")
    assert only(read_library(tmp_path / "a.toml")).feed is None


@pytest.mark.parametrize("name", ["tools", "fusion.csv", "hsmlib"])
def test_the_18_ball_ends_have_their_feed_in_three_formats(name):
    library = read_library(real(f"makera_ball_endmills.{name}"))
    assert [feed_of(library.entries_of(cutter)) for cutter in library] == [500.0] * 18


def test_names_of_presets():
    assert all(map(is_finishing, ("Finish", "finishing", "3D FINISHING", "Schlichten", "Super-finish")))
    assert not any(map(is_finishing, ("", "Roughing", "Aluminum", "Semi-finishing", "semifinish", "Vorschlichten")))


def test_the_option_goes_first_and_times_without_any_feed_are_refused_at_once(tmp_path):
    library = read_library(write_json(tmp_path / "a.json", [with_presets(fusion(), PRESETS)]))
    others = (Cutter.parse("R6L80"), Cutter.parse("R8L80"))
    cutters = (*others, *library)
    assert feeds(Options(libraries=library, feed=50.0), cutters) == dict.fromkeys(cutters, 50.0)
    assert feeds(Options(libraries=library, operations="fewest"), cutters) is None
    assert Options(libraries=library, operations="fastest", cutters=others).feeds == {library[0]: 1200.0}
    with pytest.raises(OptionError, match="need a feed"):
        Options(cutters=others, operations="fastest")
    bare = read_library(write_json(tmp_path / "b.json", [fusion()]))
    with pytest.raises(OptionError, match="need a feed"):
        Options(libraries=bare, operations="fastest")


def test_what_is_asked_for_the_whole_plan_does_not_lose_the_feed(tmp_path):
    library = read_library(write_json(tmp_path / "a.json", [with_presets(fusion(), PRESETS)]))
    options = Options(libraries=library, allowance=0.3, operations="fastest")
    found = feeds(options, options.judged)
    assert np.array_equal(list(found.values()), [1200.0])
