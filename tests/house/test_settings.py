"""The settings of the linters name what there is: a wall around a module that was renamed keeps nobody out."""

import re
import tomllib
from importlib.util import find_spec

import pytest

from tests.support.places import PACKAGES, ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
TOOLS, CONTRACTS = PROJECT["tool"], PROJECT["tool"]["importlinter"]["contracts"]
#: What may import the core; the wall that parts it from the core.
OURS = PACKAGES.keys() - {"cad_io"}
BASE = "plan_cutters_base"
APART = "The core knows none of the packages that read what it makes"
ROOTS = {**{name: folder.parent for name, folder in PACKAGES.items()}, "freecad": ROOT}


def is_there(name):
    """Whether a module of ours, or a package that is installed, has this dotted name; `.*` at its end is what is in it."""
    name = name.rstrip("*").rstrip(".")
    top = name.partition(".")[0]
    if top not in ROOTS:
        return find_spec(top) is not None
    path = ROOTS[top].joinpath(*name.split("."))
    return path.with_suffix(".py").is_file() or (path / "__init__.py").is_file()


def named(contract):
    """The modules that a contract is about."""
    yield from (
        each for field in ("containers", "ancestors", "source_modules", "forbidden_modules") for each in contract.get(field, ())
    )
    yield from (each for line in contract.get("ignore_imports", ()) for each in line.split(" -> "))
    for container in contract.get("containers", ()):
        yield from (f"{container}.{each}" for layer in contract["layers"] for each in re.findall(r"\w+", layer))


@pytest.mark.parametrize("contract", CONTRACTS, ids=lambda contract: contract["name"])
def test_a_wall_names_modules_that_there_are(contract):
    names = list(named(contract))
    assert names
    assert [each for each in names if not is_there(each)] == []


def test_a_name_that_is_not_there_is_found():
    assert is_there("plan_cutters.kernels.jit")
    assert is_there("plan_cutters.hosts.*")
    assert not is_there("plan_cutters.kernel")
    assert not is_there("cad_io.arrays.floats")
    assert not is_there("vkt")


def test_no_wall_lets_pass_what_it_was_not_told_of():
    assert [each["name"] for each in CONTRACTS if "unmatched_ignore_imports_alerting" in each] == []


def test_the_wall_around_the_compiler_names_every_room_of_cad_io():
    (wall,) = (each for each in CONTRACTS if each.get("forbidden_modules") == ["plan_cutters_base.jit"])
    rooms = {f"cad_io.{path.parent.name}" for path in (ROOT / "cad_io").glob("*/__init__.py")}
    assert set(wall["source_modules"]) == {*OURS - {BASE}, *rooms}


def test_a_wall_around_all_that_judges_is_one_around_what_reads_plans_too():
    """A room that becomes a package of its own keeps its walls."""
    around = [set(each.get("source_modules", each.get("ancestors", ()))) for each in CONTRACTS if each["name"] != APART]
    walls = [modules | {BASE} for modules in around if "plan_cutters" in modules]
    assert len(walls) >= 6
    assert all(modules >= OURS for modules in walls)


def test_types_are_checked_of_all_that_is_shipped_and_of_what_ships_it():
    assert {"plugin", "cad_io", "freecad", ".ci"} <= set(TOOLS["mypy"]["files"])
    ours = [name for each in TOOLS["mypy"]["overrides"] for name in each["module"] if name.partition(".")[0] in ROOTS]
    assert [each for each in ours if not (is_there(each) or each == "freecad.*")] == []


def test_what_a_linter_lets_pass_is_there():
    for pattern in TOOLS["ruff"]["lint"]["per-file-ignores"]:
        braces = re.match(r"\{(.*)\}(.*)", pattern)
        for each in [f"{folder}{braces[2]}" for folder in braces[1].split(",")] if braces else [pattern]:
            assert next((ROOT).glob(each if "/" in each else f"**/{each}"), None) is not None, each


def test_a_fault_that_was_mended_is_seen():
    """A test that is expected to fail and passes is an error, and so is a warning."""
    pytest_ = TOOLS["pytest"]["ini_options"]
    assert pytest_["xfail_strict"] is True
    assert pytest_["filterwarnings"][0] == "error"
    assert {"--strict-markers", "--strict-config"} <= set(pytest_["addopts"].split())
