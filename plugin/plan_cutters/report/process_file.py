"""The process and the proposed setups as files that people edit, and that `--process` and `--setup` read."""

import json
from collections import Counter
from pathlib import Path
from typing import Any

from plan_cutters.domain.dimensions import typed
from plan_cutters.domain.figures import area, duration, percent
from plan_cutters.files.content import toml_text
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import ProcessStep
from plan_cutters.plan_file.part_info import ProposedSetup
from plan_cutters.plan_file.words.operations import images_of
from plan_cutters.report.protocol import Judged


def process_toml(plan: Plan) -> str:
    """Write the process of a plan as TOML: a `[[step]]` each, in their order, with what it does as a comment."""
    process, proposed = plan.process, plan.setup_proposal
    files = [f"--setup setup-{number}.toml" for number in range(1, 1 + len(proposed.setups))] if proposed else []
    setups = f"# In place of --setup auto: {' '.join(files)}\n" if files else ""
    names = {each.id: typed(each.id, each.name) for each in plan.cutters}
    often = Counter(names.values())
    words = {each: name if often[name] == 1 else each for each, name in names.items()}
    share = percent(process.finished_share, some=process.finished_share > 0.0, whole=not process.left)
    head = (
        f"# {share} of {area(process.asked_mm2)}. Edit the steps, and judge them again: the same command with --process FILE.\n"
        f"{setups}"
        '# Steps take in this order what they serve of their faces; faces = "left" is all that no step before it finishes.\n'
        '# take = "share": such steps divide their faces by time, as proposed. A step without it comes before them.\n'
        "# To keep a cutter off some faces: [[forbid]] with cutter and faces, as in a step.\n"
        'format = "plan-cutters-process"\nversion = 1\n'
        '# "leave": nothing more is planned behind these steps.\nrest = "plan"\n'
    )
    requested = [] if plan.effective.process is None else plan.effective.process["step"]
    return head + "".join(
        _step(number, each, words, requested[each.own.number - 1] if each.own else None)
        for number, step in enumerate(process.steps, 1)
        for each in _times(plan, step)
    )


def _times(plan: Plan, step: ProcessStep) -> list[ProcessStep]:
    """A step as often as it is done: each time has angles of its own, which the file writes out."""
    images = [] if step.repeat == 1 or plan.operations is None else images_of(plan.operations, plan.process, step)
    return [
        step.model_copy(update={
            "angles_deg": each.angles_deg, "axis": each.axis, "faces": [face.face for face in each.faces],
            "area_mm2": each.area_mm2, "share": each.share, "seconds": each.seconds, "link_seconds": each.link_seconds,
        })
        for each in images
        if each.orbit is not None
    ] or [step]  # fmt: skip


def _step(number: int, step: ProcessStep, words: dict[str, str], own: dict[str, Any] | None) -> str:
    took = f", {duration(step.seconds + step.link_seconds)}" if step.seconds is not None else ""
    turned = "" if step.mode == "fixed" else f'mode = "{step.mode}"\n'
    if step.angles_deg is not None:
        turned = f"angles = {{ {', '.join(f'{toml_key(name)} = {angle!r}' for name, angle in step.angles_deg.items())} }}\n"
    elif step.axis is not None:
        turned = f"axis = {[float(each) for each in step.axis]}\n"
    faces = f"[{', '.join(toml_text(face) for face in step.faces)}]"
    if not step.faces:
        # A step of the planner's own that does nothing stays as it is.
        faces = '"left"' if own is None or own["faces"] == "left" else json.dumps(own["faces"])
    take = 'take = "share"\n' if step.take == "share" else ""
    return (
        f"\n# {number}: {percent(step.share, some=step.area_mm2 > 0.0)}{took}\n[[step]]\nsetup = {step.setup + 1}\n{turned}"
        f"cutter = {toml_text(words.get(step.cutter, step.cutter))}\nfaces = {faces}\n{take}"
    )


def toml_key(name: str) -> str:
    """A name as a key of TOML: bare where it may be."""
    return name if name.isascii() and name.replace("_", "").replace("-", "").isalnum() else toml_text(name)


def write_process(result: Judged, _split: object, path: Path) -> None:
    """Write `process.toml`."""
    path.write_text(process_toml(result.plan), encoding="utf-8")


def setup_toml(setup: ProposedSetup) -> str:
    """Write a proposed setup as TOML: the part stands on a table across its axis, or in a vise or chuck.

    >>> print(setup_toml(ProposedSetup(axis=(0.0, 0.6, 0.8), stands_on=["F2"], promised=1.0)), end="")
    # Proposed by --setup auto: add the vise or the clamps to `fixtures`.
    unit = "mm"
    axis = [0.0, 0.6, 0.8]
    clamped = ["F2"]
    fixtures = ["table"]
    """
    first = "add the vise or the clamps to `fixtures`."
    if setup.clamping != "table":
        first = f"the {setup.clamping} grips {', '.join(setup.grips) or 'the stock'}; put your own into `fixtures`."
    return (
        f'# Proposed by --setup auto: {first}\nunit = "mm"\naxis = {json.dumps(list(setup.axis))}\n'
        f"{'' if setup.x is None else f'x = {json.dumps(list(setup.x))}{chr(10)}'}"
        f"clamped = {json.dumps(setup.stands_on)}\nfixtures = {json.dumps(setup.fixtures)}\n"
    )


def write_setup(result: Judged, _split: object, path: Path, *, number: int) -> None:
    """Write `setup-1.toml` and so on, of the setups that were proposed."""
    proposal = result.plan.setup_proposal
    assert proposal is not None, "written where setups were proposed"
    path.write_text(setup_toml(proposal.setups[number - 1]), encoding="utf-8")
