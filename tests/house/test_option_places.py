"""An option is said in few places, and each says all of them: `Options`, the types that callers see, the commands, the plan."""

import ast
import inspect
import math
import os
import re
import subprocess
import sys
from dataclasses import fields
from importlib import import_module
from pathlib import Path
from typing import Unpack, get_type_hints

import pytest

import cad_io
import plan_cutters
from plan_cutters import Options, PostureMap, Result, Scene, plan, plan_many, posture_map
from plan_cutters.command import cli, entry
from plan_cutters.command import map as of_a_point
from plan_cutters.command.request import PlanRequest, planning_options
from plan_cutters.option_table import ATTRIBUTES, OPTIONS
from plan_cutters.options import ANGLES, PlanOptions, PointOptions, SceneOptions
from plan_cutters.plan_file.effective import Effective
from tests.support.option_stub import STUB, stub
from tests.support.places import ROOT

WORDS = {each.name for each in fields(Options)}
#: Words for angles may also be given in degrees.
DEGREES = {f"{word}_deg" for word in ANGLES}


def test_type_checkers_see_the_options():
    assert set(PlanOptions.__annotations__) == WORDS | DEGREES
    assert set(ANGLES) == {word for word, each in ATTRIBUTES.items() if each.is_angle}
    assert STUB.read_text() == stub(), "run: python -m tests.support.option_stub"
    for function, words in ((plan, PlanOptions), (Scene.of, SceneOptions), (posture_map, PointOptions), (plan_many, PlanOptions)):
        assert Unpack[words] in get_type_hints(function, localns={"Result": Result, "PostureMap": PostureMap}).values()


def test_people_see_each_option_with_its_default():
    shown = inspect.signature(plan).parameters
    own = ["part", "progress", "cache"]
    assert list(shown) == [*own, *(each.name for each in fields(Options)), *(f"{word}_deg" for word in ANGLES)]
    for name, each in inspect.signature(Options).parameters.items():
        assert shown[name].kind is inspect.Parameter.KEYWORD_ONLY
        assert shown[name].default is each.default
        assert shown[name].annotation == PlanOptions.__annotations__[name].__forward_arg__


@pytest.mark.parametrize("package", [plan_cutters, cad_io], ids=lambda each: each.__name__)
def test_the_stub_has_the_names_that_are_handed_on(package):
    path = Path(package.__file__)
    assert (path.parent / "py.typed").is_file()
    stub = ast.parse(path.with_suffix(".pyi").read_text())
    assert {name.name for each in stub.body if isinstance(each, ast.ImportFrom) for name in each.names} == set(package._HOME)
    for each in stub.body:
        if isinstance(each, ast.ImportFrom):
            for name in each.names:
                assert getattr(import_module(each.module), name.name) is getattr(package, name.name)
    (names,) = [ast.literal_eval(each.value) for each in stub.body if isinstance(each, ast.Assign)]
    assert sorted(names) == sorted(package.__all__)


def test_completion_offers_names_that_nobody_has_asked_for_yet():
    code = "import plan_cutters, cad_io; print(*dir(plan_cutters), '|', *dir(cad_io))"
    done = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": f"{ROOT / 'plugin'}{os.pathsep}{ROOT}"},
                          capture_output=True, text=True, check=True)  # fmt: skip
    ours, theirs = (set(each.split()) for each in done.stdout.split("|"))
    assert set(plan_cutters.__all__) <= ours
    assert set(cad_io.__all__) <= theirs
    # What completion shows beside them is the module's own: no names that it happens to use.
    assert {each for each in ours - set(plan_cutters.__all__) if not each.startswith("_")} == set()


def test_every_option_can_be_given_on_the_command_line():
    given = cli.command.make_context("plan-cutters", ["part.step", "--setup", "+z", "--setup", "-y"]).params
    # Two come with setup files, the last one with the setup `auto`.
    assert set(planning_options(PlanRequest(**given))) == WORDS - {"placement", "other_placements", "propose"}
    assert set(OPTIONS) == WORDS - {"placement", "other_placements", "propose", "other_setups"}


def test_the_commands_declare_an_option_alike():
    """What several commands have is the same option, but for what is said of it and how often it may be given."""
    commands = {name: entry.module_of(f"plan-cutters {name}").command for name in entry.commands()}
    plans = {each.name: each for each in cli.command.params}
    shared = [each for each in of_a_point.command.params if each.name in plans and each.name not in ("part", "out", "json_out")]
    assert len(shared) >= 17
    for each in shared:
        assert each.opts == plans[each.name].opts
        assert getattr(each, "group", "") == getattr(plans[each.name], "group", "")
    for name, command in commands.items():
        assert {"debug"} <= {each.name for each in command.params}, name
        assert {"0", "2", "130"} <= {code for code, _ in command.codes}, name


def test_every_option_is_in_the_plan():
    """As it is, by its name and unit, or as what was made of it."""
    entries = {re.sub("_(mm|deg|s|mm_min|cm3_min)$", "", name) for name in Effective.model_fields}
    # Libraries are an entry of their own; the number of threads changes nothing.
    assert WORDS - entries == {"libraries", "jobs"}
    found = plan(ROOT / "samples/v_groove.step", cutters="R6L80", grid=5, area_budget=0, allowance=0.1, tilt=(0.1, 1.0)).plan
    asked = found.effective
    assert (asked.allowance_mm, asked.grid, asked.rotation_step_deg, asked.flip) == (0.1, 5, pytest.approx(10.0), False)
    assert asked.tilt_deg == pytest.approx((math.degrees(0.1), math.degrees(1.0)))
