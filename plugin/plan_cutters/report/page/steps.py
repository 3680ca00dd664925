"""The process as the page shows it: which step finishes each sample, and what is said of steps, setups and of what is left."""

import shlex
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.graphs import connected
from plan_cutters.domain.figures import capital
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import ProcessStep
from plan_cutters.plan_file.reasons import OPERATIONS, operation_colour
from plan_cutters.plan_file.words.names import as_fields
from plan_cutters.plan_file.words.operations import operation_names
from plan_cutters.plan_file.words.process import StepRow, process_story
from plan_cutters.plan_file.words.text import Story
from plan_cutters.report.protocol import Judged

#: Patterns of steps, another one each time that the colours come round.
PATTERNS = ("plain", "cross", "dots", "bars")


def step_of(result: Judged) -> NDArray[np.uint16]:
    """The number of the step that finishes each sample (n,), 0 where none does."""
    plan, samples = result.plan, result.samples
    number = np.zeros(len(samples), np.uint16)
    process, operations = plan.process, result.answers.operations
    mine = None if operations is None else next((each for each in operations.plans if each.name == process.plan), None)
    if mine is not None and plan.operations is not None:
        entry = next(each for each in plan.operations.plans if each.name == process.plan)
        by_id = {each: int(name.partition(".")[0]) for each, name in operation_names(plan).items()}
        table = np.array([0, *(by_id.get(each.id, 0) for each in entry.operations)], np.uint16)
        number = table[mine.label + 1]
    for k, step in enumerate(process.steps, 1):
        if not step.operation:
            number[(number == 0) & _finished(result, step)] = k
    return number


def _finished(result: Judged, step: ProcessStep) -> NDArray[np.bool_]:
    """Samples (n,) that a step without an operation finishes: what its cutter reaches in its setup; of a drill its holes."""
    samples, ready = result.samples, result.ready
    verdicts = result.over_setups.each[step.setup][1]
    if step.cutter in verdicts:
        return np.asarray(verdicts[step.cutter].reached & ready.machinable[step.setup])
    return np.isin(samples.face, [int(face[1:]) for face in step.faces])


def colour(number: int) -> dict[str, str]:
    """Colour and pattern of a step, by its number from 1."""
    return {"colour": operation_colour(number - 1), "pattern": PATTERNS[(number - 1) // len(OPERATIONS) % len(PATTERNS)]}


def process_of(result: Judged, story: Story, number: NDArray[np.uint16]) -> dict[str, Any] | None:
    """Collect what the script needs of the process beside its table; None where it has no step."""
    process = result.plan.process
    if not process.steps:
        return None
    return {
        "plan": process.plan.replace(" ", "_"), "left_share": 1.0 - process.finished_share,
        "setups": [each.text for each in process.setups],
        "steps": [
            {
                **colour(k), "cutter": step.cutter, "setup": step.setup, "axis": step.axis, "share": step.share,
                "label": f"step {k}", "text": step_text(result.plan, story, k, step), "sample": middle(result, number == k),
            }
            for k, step in enumerate(process.steps, 1)
        ],
    }  # fmt: skip


def process_tables(plan: Plan, story: Story) -> dict[str, Any]:
    """Lay out the process for the template: by setup the rows of its steps; what stays, by cause; what to do next.

    `process`: its story with all steps. `setups`: (setup from 0, sentence, rows).
    `remaining`: (entry or None, sentence, share). `next`: (sentence, what one would type).
    """
    entry, whole = plan.process, process_story(plan, story.names, len(plan.process.steps))
    stands, setups = dict(enumerate(whole.stands)), list[tuple[int, str, list[StepRow]]]()
    for row in whole.rows:
        if not setups or setups[-1][0] != row.at:
            setups.append((row.at, stands.pop(row.at, f"Setup {row.at + 1} again:"), []))
        setups[-1][2].append(row)
    setups += [(at, f"{text} No step.", []) for at, text in stands.items()]
    entries = [*entry.left[: len(whole.remaining)], *[None] * len(whole.remaining)]
    remaining = [
        (each, as_fields(capital(stays.text)), stays.share) for each, stays in zip(entries, whole.remaining, strict=False)
    ]
    following = [
        (as_fields(text.removeprefix("Next: ").partition(" [`")[0]), shlex.join(each.argv))
        for text, each in zip(whole.next, entry.next, strict=False)
    ]
    return {"process": whole, "setups": setups, "remaining": remaining, "next": following}


def step_text(plan: Plan, story: Story, number: int, step: ProcessStep) -> str:
    """A step in a sentence, with how the part stands."""
    row = next((each for each in story.process.rows if each.number == str(number)), None)
    what = [story.names.get(step.cutter, step.cutter)] if row is None else [row.turned, row.cutter, row.share, row.took]
    stands = plan.process.setups[step.setup].text if step.setup < len(plan.process.setups) else ""
    return as_fields(" ".join(filter(None, (f"Step {number}: {', '.join(filter(None, what))}.", stands))))


def middle(result: Judged, mine: NDArray[np.bool_]) -> int | None:
    """A sample amid the largest connected region of some (n,), where the tool is shown; None where there is none."""
    samples, rows = result.samples, np.flatnonzero(mine)
    if not len(rows):
        return None
    edge = samples.neighbours
    piece, area = connected(len(mine), edge[mine[edge].all(axis=1)])[rows], np.nan_to_num(samples.area[rows])
    size = np.bincount(piece, area)
    rows = rows[piece == size.argmax()] if size.any() else rows
    return int(rows[np.linalg.norm(samples.point[rows] - samples.point[rows].mean(axis=0), axis=1).argmin()])
