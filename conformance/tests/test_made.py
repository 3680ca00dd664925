"""The closed form of each part against points of its exact surface, in a few postures."""

import pytest

from conformance.made.check import differences
from conformance.made.parts import PARTS

_TWINS = [n for n, p in PARTS.items() if p.twin_of is not None]
#: Compared in every run; the others take minutes.
_DAILY = {"plate_and_wall", "slot", "hemisphere"}
_NAMES = [n for n in PARTS if n not in _TWINS] + _TWINS[::3]


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in _DAILY else pytest.mark.slow) for n in _NAMES])
def test_form_and_slow_twin_agree(name):
    assert list(differences(PARTS[name], count=4, pitch=1.5)) == []
