"""Values are read as they were written: types, layout of arrays, what is shared; and what is none of ours is not made."""

import json
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from plan_cutters import Cutter
from plan_cutters.domain.verdicts import blank
from plan_cutters.kernels.rows import Tree
from plan_cutters.plan_file.model import AreaEntry
from plan_cutters_base.values import packed, unpacked


def again(value):
    return unpacked(bytearray(b"".join(packed(value))))


PLAIN = st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.binary()
ARRAYS = st.sampled_from("?iufcSU").flatmap(
    lambda kind: arrays.arrays(
        {"?": "?", "i": "<i4", "u": "u1", "f": ">f8", "c": "c16", "S": "S3", "U": "U2"}[kind],
        arrays.array_shapes(min_dims=0, min_side=0, max_side=4),
    )
)
VALUES = st.recursive(
    PLAIN | ARRAYS,
    lambda inner: st.lists(inner) | st.lists(inner).map(tuple) | st.dictionaries(st.integers() | st.text(), inner)
    | st.frozensets(PLAIN) | st.sets(PLAIN),
    max_leaves=12,
)  # fmt: skip


def told(value):
    """A value with its types, so that 1, True and 1.0 are not alike, and nan is itself."""
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, value.tobytes(), value.flags.f_contiguous, value.flags.writeable
    if isinstance(value, set | frozenset):
        return type(value), sorted(map(repr, value))
    if isinstance(value, dict):
        return dict, [(told(key), told(each)) for key, each in value.items()]
    return (type(value), [told(each) for each in value]) if isinstance(value, list | tuple) else repr(value)


@given(VALUES)
def test_a_value_is_read_as_it_was_written(value):
    assert told(again(value)) == told(value)


def test_layout_rights_and_identity_stay():
    for made in (np.asfortranarray(np.arange(6.0).reshape(2, 3)), np.arange(9)[::2], np.float32(2.5), np.zeros((0, 3)).T):
        assert told(again(np.asarray(made))) == told(np.asarray(made).copy("A"))
    assert type(again(np.float32(2.5))) is np.float32
    fixed = np.arange(3.0)
    fixed.flags.writeable = False
    one, other, third = again((fixed, fixed, fixed.copy()))
    assert one is other is not third
    assert (one.flags.writeable, third.flags.writeable) == (False, True)


def test_records_of_ours_are_made_as_they_were():
    cutter = Cutter.parse("R6L80")
    verdicts = blank(4).freeze()
    area = AreaEntry(share=0.5, feasible=False, contacts=1, left=2, short=3, dropped=0, left_out=["F1"])
    tree = Tree(*(np.arange(k + 1.0) for k in range(len(Tree._fields))))
    found = again([cutter, verdicts, area, tree])
    assert [type(each) for each in found] == [Cutter, type(verdicts), AreaEntry, Tree]
    assert found[0] == cutter
    assert found[1] == verdicts
    assert not found[1].axis.flags.writeable
    assert (found[2], found[2].model_fields_set) == (area, area.model_fields_set)
    assert all(map(np.array_equal, found[3], tree))


@dataclass
class Foreign:
    a: int = 1


class Pair(NamedTuple):
    a: int = 1


@pytest.mark.parametrize("value", [Foreign(), Pair(), print, np.array([None]), np.zeros(2, [("a", "f8")]), {1: object()}])
def test_what_is_none_of_ours_is_not_written(value):
    with pytest.raises(TypeError, match=r"(is|are) not stored"):
        b"".join(packed(value))


@pytest.mark.parametrize("form", [
    ["os:system", ["command", "x"]], ["subprocess:Popen", ["args", "x"]], ["plan_cutters.errors:extra_hint", ["extra", "x"]],
    ["plan_cutters.domain.cutter:Cutter", ["name", "x"]], ["plan_cutters.domain.cutter:none"], ["nonsense"], ["same", 7], [],
    ["array", "<f8", [1 << 40], 0, False, True], ["array", "|O", [1], 0, False, True],
])  # fmt: skip
def test_a_form_that_nobody_wrote_makes_nothing(form):
    text = json.dumps(form).encode()
    with pytest.raises((ValueError, TypeError, LookupError, AttributeError, ImportError)):
        unpacked(bytearray(len(text).to_bytes(8, "little") + text + bytes(8)))
