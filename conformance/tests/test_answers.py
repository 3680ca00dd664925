"""Each answer against branch and bound over the exact surface, just inside and just outside: no points of the surface are asked."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from conformance.exact.slow import read
from conformance.made.answers import doubts
from conformance.made.check import faults, write_step
from conformance.made.confirm import Around
from conformance.made.parts import PARTS
from conformance.tests.daily import DAILY

NAMES = [name for name, part in PARTS.items() if part.twin_of is None]


def around(part, folder):
    """The part as another program reads it, through STEP."""
    write_step(part, Path(folder) / f"{part.name}.step")
    return Around(part, read(Path(folder) / f"{part.name}.step"))


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in DAILY else pytest.mark.slow) for n in NAMES])
def test_bounds_confirm_each_answer(name, tmp_path):
    assert list(doubts(around(PARTS[name], tmp_path))) == []


@pytest.mark.parametrize("kind", ["free_tilts", "orientations"])
def test_a_wrong_answer_is_seen(kind, tmp_path):
    part = PARTS["plate_limit" if kind == "free_tilts" else "three_sides"]
    right = next(a for a in part.answers if a.kind == kind)
    wrong = [[low, high - 0.25] for low, high in right.value] if kind == "free_tilts" else right.value - 1
    (line, *_) = doubts(around(replace(part, answers=(replace(right, value=wrong),)), tmp_path))
    assert line.startswith(f"answer 0, {kind} = {wrong} ({right.formula}): expected")


def test_contacts_lie_on_a_skin_and_look_out_of_it():
    assert [(name, line) for name in NAMES for line in faults(PARTS[name], 25)] == []
    part = PARTS["three_sides"]
    assert any("lie on no material" in line for line in faults(moved(part, lambda p, n: (p + 0.1 * n, n))))
    assert any("points into" in line for line in faults(moved(part, lambda p, n: (p, -n))))
    assert any("not of length 1" in line for line in faults(moved(part, lambda p, n: (p, np.full_like(n, np.nan)))))


def moved(part, move):
    return replace(part, contacts=lambda rng, n: move(*part.contacts(rng, n)))


def test_enough_parts_and_answers():
    assert len(NAMES) >= 40
    assert sum(len(PARTS[name].answers) for name in NAMES) >= 100
