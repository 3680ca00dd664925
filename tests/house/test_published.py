"""What leaves the checkout: the long description, the action, the image, and the addresses that its owner gives."""

import importlib.util
import re
import subprocess
import sys
import tomllib

import pytest

from plan_cutters_base import user_cache
from tests.support.places import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def long_description():
    spec = importlib.util.spec_from_file_location("setup_of_the_project", ROOT / "setup.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.long_description(ROOT)


def test_the_long_description_leads_nowhere_but_to_addresses():
    """A package index has neither pictures nor pages of the checkout."""
    text, source = long_description(), PROJECT["project"]["urls"]["Source"]
    links = re.findall(r"(!?)\[[^\]]*\]\(([^)\s]+)\)", text)
    assert len(links) > 10
    assert all(re.match(r"[a-z]+:|#", address) for _, address in links)
    for picture, address in links:
        if address.startswith(source):
            way, _, path = address.removeprefix(f"{source}/").partition("/main/")
            assert way == ("raw" if picture else "blob")
            assert (ROOT / path.partition("#")[0]).exists(), path


def test_addresses_of_the_project_stand_in_one_place():
    """Beside it stands FreeCAD's manifest, which takes no other: it says the same."""
    urls = PROJECT["project"]["urls"]
    host = urls["Homepage"].removeprefix("https://")
    done = subprocess.run(["git", "grep", "-l", host], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["package.xml", "pyproject.toml"]
    manifest = (ROOT / "package.xml").read_text(encoding="utf-8")
    said = dict(re.findall(r'<url type="(\w+)"[^>]*>([^<]*)<', manifest))
    asked = {"repository": urls["Source"], "documentation": urls["Documentation"], "bugtracker": urls["Issues"]}
    assert said == {**asked, "readme": f"{urls['Source']}/freecad/README.md"}


def test_what_the_tests_need_is_no_extra_of_what_is_published():
    assert "dev" not in PROJECT["project"]["optional-dependencies"]
    assert any(each.startswith("pytest") for each in PROJECT["dependency-groups"]["dev"])


def test_the_action_names_what_it_uses_by_commit():
    used = re.findall(r"uses: (\S+)", (ROOT / "action.yml").read_text(encoding="utf-8"))
    assert used
    assert [each for each in used if not re.fullmatch(r"[\w/-]+@[0-9a-f]{40}", each)] == []


@pytest.mark.parametrize("file", ["action.yml", "Dockerfile"])
def test_what_plans_in_a_pipeline_can_draw(file):
    """`changed` shows pictures in the summary of a job."""
    (extras,) = re.findall(r"pip install.*\[([\w,]+)\]\"", (ROOT / file).read_text(encoding="utf-8"))
    assert "pictures" in extras.split(",")


@pytest.mark.parametrize("system", ["linux", "darwin", "win32"])
def test_caches_are_where_the_system_keeps_them(system, monkeypatch, tmp_path):
    platformdirs = pytest.importorskip("platformdirs")
    for name in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(sys, "platform", system)
    monkeypatch.setattr(platformdirs, "user_cache_path", lambda name, appauthor: tmp_path / "of the system" / name)
    assert next(user_cache.roots()) == tmp_path / (".cache" if system == "linux" else "of the system") / "plan-cutters"
