"""Answers and operations that were asked for together are made side by side, and are those that are made one after the other."""

import json
import os
import time

import pytest

from plan_cutters import pipeline, plan
from plan_cutters.command.progress import work_of
from plan_cutters.outcome import Answers
from plan_cutters_base import forks
from tests.support.places import SAMPLES

WORDS = {"cutters": ["R2L30"], "machine": "trunnion-ac", "fixtures": "table", "holder": "er16", "feed": 1000.0,
         "spacing": 20.0, "answers": ("stick-out", "mend"), "operations": "fastest", "area_budget": 0}  # fmt: skip


def document(folder, **words):
    result = plan(SAMPLES / "blade.step", **{**WORDS, **words})
    result.write(folder, ["json"])
    text = json.loads((folder / "plan.json").read_text())
    for entry in text["cutters"]:
        entry.pop("seconds", None)
    return text.pop("run")["seconds"], text


@pytest.fixture(scope="module")
def in_turn(tmp_path_factory):
    return document(tmp_path_factory.mktemp("turn"), jobs=1)


def test_they_are_those_that_are_made_one_after_the_other(tmp_path, in_turn, monkeypatch):
    copied = pipeline._operations
    here = os.getpid()

    def planned(part, least, clock):
        assert os.getpid() != here, "the copy gave no answer: all was planned twice"
        return copied(part, least, clock)

    monkeypatch.setattr(pipeline, "_operations", planned)
    seconds, beside = document(tmp_path, jobs=2)
    assert beside == in_turn[1]
    assert {"stick-out", "mend", "operations"} <= set(seconds) & set(in_turn[0])


@pytest.mark.slow("plans parts whole")
def test_a_copy_that_dies_is_made_up_for(tmp_path, in_turn, monkeypatch):
    monkeypatch.setattr(
        forks.SideProcess, "result", lambda self, here=None, waiting=None: (self.__exit__(), (here or self._call)())[1]
    )
    assert document(tmp_path, jobs=2)[1] == in_turn[1]


@pytest.mark.slow("plans parts whole")
def test_the_progress_of_the_copy_is_told_while_it_is_waited_for(monkeypatch):
    told = []

    def slow(ready, everywhere, least, stage, searched):
        with stage("operations") as tell:
            for done in (1, 3):
                tell(done, 5)
                time.sleep(1.5)  # who waits for the copy looks once a second

    monkeypatch.setattr("plan_cutters.pipeline.ask", lambda *words, least, **more: Answers(least_set=least))
    monkeypatch.setattr("plan_cutters.operations.planning.plan_operations", slow)
    options = {**WORDS, "jobs": 2, "progress": lambda stage, done, total: told.append((stage, done, total))}
    plan(SAMPLES / "blade.step", **options)
    shares = [done / total for stage, done, total in told if stage == "operations" and 0 < done < total]
    assert {0.2, 0.6} <= set(shares)
    assert shares == sorted(shares)


@pytest.mark.parametrize("stage", ["plan_cutters.pipeline.ask", "plan_cutters.operations.planning.plan_operations"])
def test_what_either_raises_is_raised(stage, monkeypatch):
    def fails(*words, **more):
        raise ZeroDivisionError("one of them")

    monkeypatch.setattr(stage, fails)
    with pytest.raises(ZeroDivisionError, match="one of them"):
        plan(SAMPLES / "blade.step", **{**WORDS, "answers": ("stick-out",), "jobs": 2})


def test_only_cutters_are_told_as_cutters():
    """All other stages have words of their own: "judging ... (2 of 3)" counts cutters."""
    told = set()
    result = plan(SAMPLES / "blade.step", **{**WORDS, "jobs": 1, "progress": lambda stage, done, total: told.add(stage)})
    assert {stage for stage in told if work_of(stage) == work_of("R6L80")} == {cutter.id for cutter in result.cutters}
    assert "patterns" in told
