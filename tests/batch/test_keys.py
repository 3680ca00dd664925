"""Keys: what changes a result changes the key, and nothing else does."""

import os
import subprocess
import sys
from dataclasses import replace

import pytest

from plan_cutters import Options
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.files.folder import read
from plan_cutters_batch.job import Settings, key_of
from tests.support.places import ROOT


def key(formats=("json",), schema="ap242", timeout=120.0, **options):
    return Settings(Options(**options), formats, schema, timeout).key


PLAIN = key(cutters="R6L80")


@pytest.mark.parametrize(
    "other",
    [
        {"cutters": "R6L81"},
        {"cutters": ["R6L80", "R8L80"]},
        {"cutters": "R6L80", "tolerance": 0.02},
        {"cutters": "R6L80", "machine": "tilt:60"},
        {"cutters": "R6L80", "machine": "trunnion-ac"},
        {"cutters": "R6L80", "fixtures": "box:1,2,3"},
        {"cutters": "R6L80", "setup": "+x"},
        {"cutters": "R6L80", "other_setups": ["+x"]},
        {"cutters": "R6L80", "holder": "R15L30"},
        {"cutters": "R6L80", "faces": "all"},
        {"cutters": "R6L80", "formats": ("json", "png")},
        {"cutters": "R6L80", "schema": "ap214"},
    ],
)
def test_what_changes_a_result_changes_the_key(other):
    assert key(**other) != PLAIN


def test_what_changes_none_does_not():
    assert key(cutters=("R6L80",), jobs=2, timeout=5.0) == PLAIN
    assert key(cutters="R6L80", formats=("json", "glb")) == key(cutters="R6L80", formats=("glb", "json"))


def test_the_content_of_fixtures_and_libraries_counts(tmp_path):
    vise = tmp_path / "vise.stl"
    vise.write_bytes((ROOT / "samples/v_groove.step").read_bytes())
    one = key(fixtures=str(vise))
    assert key(fixtures=str(vise)) == one
    vise.write_bytes(b"other")
    assert key(fixtures=str(vise)) != one
    settings = Settings(Options(cutters="R6L80"))
    assert key(cutters="R6L80") != replace(settings, read=("a",)).key
    vise.unlink()
    with pytest.raises(OptionError, match="No such file"):
        key(fixtures=str(vise))


def test_fixtures_travel_under_names_of_their_own(tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "vise.stl").write_bytes(folder.encode())
    options = Options(fixtures=[str(tmp_path / "a/vise.stl"), f"{tmp_path / 'b/vise.stl'}@0,0,9", "table"])
    there = Settings(options).handed
    assert dict(there.files) == {"vise.stl": b"a", "_vise.stl": b"b"}
    assert options.fixtures[0].source == str(tmp_path / "a/vise.stl")


def test_every_process_makes_the_same_key():
    code = (
        "from plan_cutters import Options\nfrom plan_cutters_batch.job import Settings\n"
        "print(Settings(Options(cutters='R6L80', machine='trunnion-ac', holder='er32')).key)"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "7", "PYTHONPATH": f"{ROOT / 'plugin'}{os.pathsep}{ROOT}"}
    said = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True).stdout
    assert said.strip() == key(cutters="R6L80", machine="trunnion-ac", holder="er32")


def test_a_part_has_the_key_of_its_content():
    assert len({key_of(b"a", PLAIN), key_of(b"b", PLAIN), key_of(b"a", "other")}) == 3


def test_settings_are_frozen():
    settings = Settings(Options(cutters="R6L80"))
    assert replace(settings, formats=("json", "png")) != settings


def test_a_pipe_is_no_part(tmp_path):
    os.mkfifo(tmp_path / "a.step")
    with pytest.raises(PlanError, match="a pipe or a device"):
        read(str(tmp_path / "a.step"))
    with pytest.raises(PlanError, match="is a folder, not a file"):
        read(str(tmp_path))
