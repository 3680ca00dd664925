"""A plan file is read."""

import json
import math
import os
from json import JSONDecodeError
from pathlib import Path

from pydantic import ValidationError

from plan_cutters.errors import PlanError
from plan_cutters.plan_file.model import FORMAT_VERSION, Plan

#: Name of the file in the folder of a plan.
PLAN = "plan.json"


def load_plan(path: str | os.PathLike[str]) -> Plan:
    """Read a plan.json, or the one of a folder: lengths in mm, angles in degrees, part coordinates.

    A PlanError where it is missing, half-written, no plan, or one of another version of the format.
    """
    file = Path(path, PLAN) if os.path.isdir(path) else Path(path)
    try:
        content = file.read_bytes()
    except OSError as error:
        raise PlanError(f"cannot be read ({error.strerror or error})", file=str(file)) from None
    return plan_of(content, str(file))


def plan_of(content: bytes | str, file: str, error: type[PlanError] = PlanError) -> Plan:
    """Make a plan of a plan file's text; `file` names it in an `error`."""
    try:
        data = json.loads(content)
    except JSONDecodeError as fault:
        empty = "is empty" if fault.pos == 0 and not fault.doc.strip() else "is no JSON or is half-written"
        raise error(f"{empty} (line {fault.lineno}): plan the part again", file=file) from None
    except (ValueError, RecursionError):
        raise error("is no text that JSON can be: give the plan.json of a plan", file=file) from None
    version = data.get("format_version") if isinstance(data, dict) else None
    if version is None or data.get("format") != "plan-cutters-plan":
        raise error("is JSON, but no plan of plan-cutters: give a plan.json, or the folder of one", file=file)
    if version != FORMAT_VERSION:
        raise error(
            f"has format version {version}, and this program reads {FORMAT_VERSION}: plan the part again with it", file=file
        )
    for face in data["faces"] if isinstance(data.get("faces"), list) else ():
        # JSON has no number for an area that is not known.
        if isinstance(face, dict) and face.get("area_mm2", 0.0) is None:
            face["area_mm2"] = math.nan
    try:
        plan = Plan.model_validate(data)
    except ValidationError as fault:
        first = fault.errors()[0]
        place = ".".join(str(word) for word in first["loc"]) or "the plan"
        raise error(
            f"{place}: {first['msg'].lower()}; it was damaged, or made by another version: plan the part again", file=file
        ) from None
    if plan.shown not in [cutter.id for cutter in plan.cutters]:
        raise error("cutters: the one shown is none of them; plan the part again", file=file)
    return plan
