"""The steps of a plan's process, in the words in which an agent edits them and has them judged again."""

from collections.abc import Sequence
from typing import Any

from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.process import OwnStepEntry, ProcessStep, RemainingEntry
from plan_cutters_agents.answers import NearestOrientation, OwnStepAnswer, Remaining, StepAnswer, first


def stepped(plan: Plan, most: int) -> dict[str, Any]:
    """The fields of an answer about steps: they, what they leave, and how much they finish; none where a plan has no process."""
    process = plan.process
    if process is None:
        return {}
    steps, more_steps = first(process.steps, most)
    left, more_left = _areas(process.left, most)
    return {
        "asked_mm2": process.asked_mm2, "finished_share": process.finished_share, "seconds": process.seconds,
        "steps": [_step(each, most) for each in steps], "more_steps": more_steps, "left": left, "more_left": more_left,
    }  # fmt: skip


def _step(step: ProcessStep, most: int) -> StepAnswer:
    faces, more = first(step.faces, most)
    return StepAnswer(
        setup=step.setup + 1, mode=step.mode, angles=step.angles_deg, axis=step.axis if step.angles_deg is None else None,
        cutter=step.cutter, faces=faces, more_faces=more, take=step.take,
        area_mm2=step.area_mm2, share=step.share, alone_mm2=step.alone_mm2,
        seconds=step.seconds, clearance_mm=step.clearance_mm, own=None if step.own is None else _own(step.own, most),
    )  # fmt: skip


def _own(own: OwnStepEntry, most: int) -> OwnStepAnswer:
    leaves, more = _areas(own.leaves, most)
    near = own.nearest
    return OwnStepAnswer(
        number=own.number, text=own.text, asked_mm2=own.asked_mm2, wrong=own.wrong, leaves=leaves, more_leaves=more,
        nearest=None if near is None else NearestOrientation(angles=near.angles_deg, axis=near.axis, area_mm2=near.area_mm2),
    )  # fmt: skip


def _areas(entries: Sequence[RemainingEntry], most: int) -> tuple[list[Remaining], int]:
    listed, more = first([*entries], most)
    return [_area(each, most) for each in listed], more


def _area(entry: RemainingEntry, most: int) -> Remaining:
    faces, more = first(entry.faces, most)
    return Remaining.model_validate(entry).model_copy(update={"faces": faces, "more_faces": more})
