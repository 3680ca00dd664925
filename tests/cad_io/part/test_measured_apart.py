"""Faces that two processes measure are what one makes of them; what measuring tells is told again without the kernel."""

import os

import numpy as np
import pytest

from cad_io import Part, read_part
from cad_io.part import part as room
from plan_cutters_base.values import packed, unpacked
from tests.support.places import SAMPLES

PART = SAMPLES / "pocket_top.step"


@pytest.fixture(autouse=True)
def _few_are_many(monkeypatch):
    monkeypatch.setattr(room, "_MANY_FACES", 2)


def same(one: Part, other: Part) -> bool:
    assert repr(one.faces) == repr(other.faces)
    for number in range(1, len(one.faces) + 1):
        mine, its = one.trim(number), other.trim(number)
        assert np.array_equal(mine.segments, its.segments)
        assert (mine.box, mine.tolerance, mine.rectangular) == (its.box, its.tolerance, its.rectangular)
        assert its.face.IsSame(other.face(number))
        assert repr(one.measure(number)) == repr(other.measure(number))
    return True


def test_two_processes_measure_what_one_does():
    alone, both, seen = read_part(PART), read_part(PART), []
    both.measured(seen.append, jobs=2)
    assert seen == list(range(1, len(both.faces) + 1, 2))
    assert same(alone, both)


def test_where_the_other_process_ends_its_faces_are_measured_here(monkeypatch):
    alone, both, here = read_part(PART), read_part(PART), os.getpid()
    describe = Part._describe

    def dies(self, *asked):
        if os.getpid() != here:
            os._exit(1)
        return describe(self, *asked)

    monkeypatch.setattr(Part, "_describe", dies)
    seen = []
    both.measured(seen.append, jobs=2)
    assert sorted(seen) == list(range(1, len(both.faces) + 1))
    assert same(alone, both)


def test_borders_are_recalled(monkeypatch):
    first, second = read_part(PART), read_part(PART)
    kept = b"".join(bytes(piece) for piece in packed(first.facts()))
    monkeypatch.setattr(room, "trim_of", None)
    second.recall(**unpacked(bytearray(kept)))
    assert same(first, second)
