"""The list of tests that wait for the night names tests that there are, and each run keeps some of every kind."""

import ast

import pytest

from tests.support.nightly import LIST, rules
from tests.support.places import ROOT


def names(file):
    """The tests of a file, those of classes with the name of the class."""
    found = []
    for node in ast.parse((ROOT / "tests" / file).read_text()).body:
        if isinstance(node, ast.ClassDef):
            found += [f"{node.name}::{each.name}" for each in node.body if isinstance(each, ast.FunctionDef)]
        elif isinstance(node, ast.FunctionDef):
            found.append(node.name)
    return [each for each in found if each.rpartition("::")[2].startswith("test_")]


@pytest.mark.parametrize("begins", sorted({begins for _, begins in rules(LIST.read_text())}))
def test_what_waits_for_the_night_is_there(begins):
    file, _, test = begins.partition("::")
    name, with_case, _ = test.partition("[")
    there = names(file) if file.endswith(".py") else []
    assert any(each == name if with_case else each.startswith(name) for each in there), begins


def test_what_is_taken_back_would_wait():
    late = rules(LIST.read_text())
    for k, (waits, begins) in enumerate(late):
        if not waits:
            assert any(begins.startswith(other) for other_waits, other in late[:k] if other_waits), begins
