"""Plans by the words of a command line, their next steps, and what a step that is followed leaves."""

import numpy as np

from plan_cutters.answers.areas import Finished
from plan_cutters.command.cli import command
from plan_cutters.command.request import PlanRequest
from plan_cutters.command.validation import options_of
from plan_cutters.document.clock import Clock
from plan_cutters.pipeline import run
from plan_cutters.plan_file.words.answers import answers, is_excluded
from tests.support import shapes

LONG = (-60, 60)


def options(*words):
    """Options of a plan, from the words of a command line."""
    return options_of(PlanRequest(**command.make_context("plan-cutters", ["part", *words]).params))


def asked(part, *words, folder=""):
    """A plan by the words of a command line, with its steps; with a folder, its proposed setups are written there."""
    result = run(part, options(*words, "--answers", "mend", "--area-budget", "0"), Clock(), folder=str(folder))
    if folder:
        result.write(folder, ("json",))
    return result


def followed(part, step, *words):
    """A plan with what a step says, typed behind the command as it is."""
    return run(part, options(*words, *step.option.split(), "--area-budget", "0"), Clock())


def answered(plan):
    return [line.text + line.typed for line in answers(plan)]


def left(result, step):
    """The share of the finished area that the cutters and setups of a step leave in a plan."""
    finished = Finished.of(result.ready)
    not_reached = finished.wanted.copy()
    here = {(0, result.ready.scene.setup): result.reaches}
    here |= {(k, axis): found for k, (axis, found) in enumerate(result.over_setups.each[1:], 1)}
    used = [found for (_, axis), found in here.items() if any(np.allclose(axis, each, atol=1e-5) for each in step.setups)]
    assert len(used) == len(step.setups)
    for found in used:
        for name in step.cutters:
            not_reached &= found[name].not_reached
    return finished.of_rows(np.flatnonzero(not_reached))


def steps_of(result, cutter=None):
    entries = [c for c in result.plan.cutters if c.mend and (cutter is None or c.id == cutter)]
    return [step for step in entries[0].mend.steps if not is_excluded(step)]


def single(result, thing):
    """The steps that change one thing alone."""
    return [step for step in steps_of(result) if [change.thing for change in step.changes] == [thing]]


def strip(low, high):
    return shapes.plane((low, high), (-40, 40), (0, 0, 0))


def wall(x, height, way):
    return shapes.plane((0, height), LONG, (x, 0, 0), (way, 0, 0), (0, 0, 1))
