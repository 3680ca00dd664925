"""The closed form of each part against points of its exact surface, in a few postures."""

import pytest

from conformance.made.check import differences
from conformance.made.parts import PARTS

_TWINS = [n for n, p in PARTS.items() if p.twin_of is not None]


@pytest.mark.parametrize("name", [n for n in PARTS if n not in _TWINS] + _TWINS[::3])
def test_form_and_slow_twin_agree(name):
    assert list(differences(PARTS[name], count=4, pitch=1.5)) == []
