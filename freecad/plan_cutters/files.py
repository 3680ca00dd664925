"""What a job is for the program: files of the body, the fixtures and the tools, and the words of its command line."""

from __future__ import annotations

import dataclasses
import json
import math
import os
import re
import shlex
import shutil
from typing import Any

from . import cam, host, model, results
from .words import tr

#: Of the plan, what the workbench shows.
FORMATS = "json,html,npz,step"
#: Options that say how one point is judged, too, and take a word; and those that take none.
OF_A_POINT = ("--fixture", "--ignore", "--unit", "--tolerance", "--holder-clearance", "--tilt", "--rotation")
FLAGS = ("--flip",)


def command() -> list[str]:
    """The program as a list of words: by the settings, the environment, the search path, or where a user's tools are.

    Raises
    ------
    Refused
        It is nowhere; the line says how to get it.
    """
    words = host.settings().GetString("Command") or os.environ.get("PLAN_CUTTERS", "")
    if words:
        try:
            return [words] if os.path.isfile(words) else shlex.split(words)
        except ValueError as error:
            raise model.Refused(tr("the program's path cannot be read: {error}").format(error=error)) from None
    found = shutil.which("plan-cutters") or shutil.which("plan-cutters", path=os.path.expanduser("~/.local/bin"))
    if not found:
        raise model.Refused(
            tr(
                "the program plan-cutters was not found: install it apart from FreeCAD, for example with "
                "`uv tool install` or `pipx install` from its folder, or give its path in the settings "
                "or in the environment variable PLAN_CUTTERS"
            )
        )
    return [found]


def words(job: model.Job, folder: str) -> tuple[list[str], dict[str, str]]:
    """Write what a job needs into a folder.

    Returns
    -------
    words : list of str
        The command with its options, but for where the answer goes.
    fingerprints : dict of str
        Of the body and the fixtures as they were written, by their names.
    """
    thing = model.thing_of(job.document, job.body)
    shape = model.shape_of(thing)
    wrong = [number for number in job.faces if not 1 <= number <= len(shape.Faces)]
    if wrong:
        raise model.Refused(
            tr("{label} has no Face{number}: it has {count} faces").format(
                label=thing.Label, number=wrong[0], count=len(shape.Faces)
            )
        )
    if not (math.isfinite(job.allowance) and job.allowance >= 0.0):
        raise model.Refused(tr("the allowance must be 0 mm or more, not {allowance:g}").format(allowance=job.allowance))
    source, fingerprints = exported(thing, shape, folder), {job.body: model.fingerprint(shape)}
    found = [*command(), *job.options]
    found += _tools(job, folder)
    if job.machine:
        found += ["--machine", job.machine]
    if job.setup:
        found += ["--setup", job.setup]
    if job.allowance:
        found += ["--allowance", repr(job.allowance)]
    for name in job.fixtures:
        fixture = model.thing_of(job.document, name)
        if name == job.body:
            raise model.Refused(tr("{label} is the body itself: it cannot be a fixture, too").format(label=fixture.Label))
        held = model.shape_of(fixture)
        fingerprints[name] = model.fingerprint(held)
        found += ["--fixture", exported(fixture, held, folder)]
    if job.faces:
        found += ["--faces", ",".join(f"F{number}" for number in job.faces)]
    if job.process:
        path = os.path.join(folder, "process.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(job.process)
        found += ["--process", path]
    return [*found, source], fingerprints


def of_one_point(result: results.Result) -> model.Job:
    """The job of a posture map under the conditions of a plan."""
    job, options, words = result.job, [], list(result.job.options)
    while words:
        word = words.pop(0)
        name, joined, _ = word.partition("=")
        if name in FLAGS:
            options.append(word)
        elif name in OF_A_POINT:
            options += [word] if joined or not words else [word, words.pop(0)]
    setup = job.setup
    if setup == "auto":
        setup = ",".join(repr(value) for value in result.plan["effective"]["setup"])
    return dataclasses.replace(job, faces=(), tools=model.Tools(), options=tuple(options), setup=setup, process="")


def library(result: results.Result, cutter: dict[str, Any], folder: str) -> str:
    """Write a tool library with one cutter of a plan, whose id need not be a word that the program reads; its path.

    Raises
    ------
    Refused
        The plan does not hold all of its shape.
    """
    if cutter["shape"] != "end":
        raise model.Refused(
            tr("the plan does not hold the whole shape of {cutter}: ask the program for its posture maps").format(
                cutter=cutter["id"]
            )
        )
    parts: dict[str, list[dict[str, float]]] = {"neck": [], "shank": [], "holder": []}
    for stage in cutter["stages"]:
        parts[stage["part"]].append(stage)
    sizes = ("radius_mm", "length_mm", "upper_radius_mm")
    rows = {word: [[stage[size] for size in sizes] for stage in stages] for word, stages in parts.items()}
    asked = result.plan["effective"]
    own = {
        "allowance": (cutter["allowance_mm"], asked["allowance_mm"]),
        "clearance": (cutter["clearance_mm"], asked["holder_clearance_mm"]),
    }
    corner, taper = cutter["corner_radius"], cutter["taper_deg"]
    if taper:
        kind = "taper" if taper > 0 else "dovetail"
    else:
        kind = "flat" if not corner else "ball" if corner == cutter["radius"] else "bull"
    lines = [
        'unit = "mm"', "[[tool]]", f"name = {json.dumps(cutter['id'])}", f'type = "{kind}"', f"DC = {2.0 * cutter['radius']!r}",
        *([f"RE = {corner!r}"] if corner else []), *([f"TA = {abs(taper)!r}"] if taper else []),
        f"LCF = {cutter['flutes_mm'] or 'rest'!r}", f"LPR = {cutter['length']!r}",
        *([f"neck = {rows['neck']}"] if rows["neck"] else []),
        f"DMM = {2.0 * rows['shank'][0][0] if rows['shank'] else 'same'!r}",
        f"holder = {{ stages = {rows['holder']} }}" if rows["holder"] else 'holder = "none"',
        *(f"{word} = {mine!r}" for word, (mine, all_have) in own.items() if mine != all_have),
    ]  # fmt: skip
    path = os.path.join(folder, "tool.toml")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([*lines, ""]))
    return path


def exported(thing, shape, folder: str) -> str:
    """A shape as a file named after its object."""
    base = re.sub(r"[^A-Za-z0-9_-]+", "_", thing.Label).strip("_") or "part"
    path, count = os.path.join(folder, f"{base}.brep"), 2
    while os.path.exists(path):
        path, count = os.path.join(folder, f"{base}_{count}.brep"), count + 1
    shape.exportBrep(path)
    return path


def _bits(job: model.Job, folder: str) -> str:
    """Write the tool bits of a job as a library, with the numbers and feeds of the CAM job that they are taken from; its path."""
    numbered = {}
    if job.tools.cam_job:
        numbered = cam.controllers(model.thing_of(job.document, job.tools.cam_job))
    rows = []
    for place, name in enumerate(job.tools.bits, 1):
        bit = model.thing_of(job.document, name)
        kind = host.bit_shape(bit)
        if not kind:
            raise model.Refused(tr("{bit} is no tool bit").format(bit=bit.Label))
        mine = numbered.get(name, cam.Controller())
        sizes: dict[str, str] = host.lengths(bit)
        try:
            holder = host.holder_of(bit)
        except LookupError as error:
            raise model.Refused(tr("the holder of {bit} cannot be read: {why}").format(bit=bit.Label, why=error)) from None
        if holder is not None:
            sizes["ToolHolder"] = f"bit{place}"
            _written(os.path.join(folder, f"bit{place}.fcholder"), holder)
        _written(os.path.join(folder, f"bit{place}.fctb"), {
            "version": 2, "name": bit.Label, "shape": f"{kind}.fcstd", "parameter": sizes,
            "attribute": {"cutting_feedrate": f"{mine.feed:.9g} mm/min"} if mine.feed else {},
        })  # fmt: skip
        rows.append({"path": f"bit{place}.fctb", **({"nr": mine.number} if mine.number > 0 else {})})
    path = os.path.join(folder, "tool_bits.fctl")
    _written(path, {"version": 1, "tools": rows})
    return path


def _written(path: str, entry: dict[str, Any]) -> None:
    with open(path, "w", encoding="utf-8") as file:
        json.dump(entry, file)


def _tools(job: model.Job, folder: str) -> list[str]:
    tools = job.tools
    if (tools.files or tools.bits) and tools.specs:
        raise model.Refused(tr("give short words of cutters, or libraries and tool bits, not both"))
    found = [word for spec in tools.specs for word in ("--cutter", spec)]
    for path in tools.files:
        found += ["--cutters", path]
    if tools.bits:
        found += ["--cutters", _bits(job, folder)]
    if tools.holder:
        found += ["--holder", tools.holder]
    if tools.stick_out is not None:
        found += ["--assume-stickout", repr(tools.stick_out)]
    return found
