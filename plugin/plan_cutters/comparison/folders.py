"""Two plan files, two plan folders, or two folders of many of them, paired by name."""

import json
import math
from collections.abc import Collection
from json import JSONDecodeError
from pathlib import Path

from pydantic import ValidationError

from plan_cutters.comparison.model import Comparison
from plan_cutters.comparison.plans import SLACK, compare
from plan_cutters.document.model import FORMAT_VERSION, Plan
from plan_cutters.errors import PlanError

PLAN = "plan.json"


def read_plan(path: Path) -> Plan:
    """The plan of a file.

    Raises
    ------
    PlanError
        It is missing, half-written, no plan, or one of another version of the format.
    """
    try:
        found = json.loads(path.read_bytes())
    except OSError as error:
        raise PlanError(f"cannot be read ({error.strerror or error})", file=str(path)) from None
    except JSONDecodeError as error:
        empty = "is empty" if error.pos == 0 and not error.doc.strip() else "is no JSON or is half-written"
        raise PlanError(f"{empty} (line {error.lineno}): plan the part again", file=str(path)) from None
    except (ValueError, RecursionError):
        raise PlanError("is no text that JSON can be: give the plan.json of a plan", file=str(path)) from None
    if not isinstance(found, dict) or found.get("format") != "plan-cutters-plan":
        raise PlanError("is JSON, but no plan of plan-cutters: give a plan.json, or the folder of one", file=str(path))
    version = found.get("format_version")
    if version != FORMAT_VERSION:
        raise PlanError(
            f"has format version {version}, and this program reads {FORMAT_VERSION}: plan the part again with it",
            file=str(path),
        )
    for face in found["faces"] if isinstance(found.get("faces"), list) else ():
        # JSON has no number for an area that is not known.
        if isinstance(face, dict) and face.get("area_mm2", 0.0) is None:
            face["area_mm2"] = math.nan
    try:
        return Plan.model_validate(found)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(word) for word in first["loc"]) or "the plan"
        raise PlanError(
            f"{place}: {first['msg'].lower()}; it was damaged, or made by a newer version: plan the part again",
            file=str(path),
        ) from None


def plans_in(given: Path) -> dict[str, Path]:
    """Plan files by name: of a file or plan folder one without a name, of a folder of many theirs by their folders below it.

    Raises
    ------
    PlanError
        There is none.
    """
    if given.is_file():
        return {"": given}
    if not given.exists():
        raise PlanError("no such file or folder", file=str(given))
    if (given / PLAN).is_file():
        return {"": given / PLAN}
    found = {path.parent.relative_to(given).as_posix(): path for path in sorted(given.rglob(PLAN)) if path.is_file()}
    # Beside an output, a run that goes on has a folder of its own whose name begins with a dot.
    found = {name: path for name, path in found.items() if not any(part.startswith(".") for part in name.split("/"))}
    if not found:
        raise PlanError(f"holds no {PLAN}: give a plan, its folder, or a folder of many", file=str(given))
    return found


def compare_folders(old: Path, new: Path, *, slack: float = SLACK, despite: Collection[str] = ()) -> Comparison:
    """Compare all plans of two folders, or two plans; a plan that cannot be read makes them not comparable.

    Raises
    ------
    PlanError
        A side holds no plan, or one is a single plan and the other is not.
    """
    mine, theirs = plans_in(old), plans_in(new)
    if ("" in mine) != ("" in theirs):
        many, one = (new, old) if "" in mine else (old, new)
        raise PlanError(f"is a folder of many plans, and {one} is one plan: give two of one kind", file=str(many))
    found, unread = [], []
    for name in sorted(set(mine) & set(theirs)):
        try:
            was, now = read_plan(mine[name]), read_plan(theirs[name])
        except PlanError as fault:
            if not name:
                raise
            unread.append(str(fault))
        else:
            found.append(compare(was, now, name=name or now.part.file or "part", slack=slack, despite=despite))
    gone, added = sorted(set(mine) - set(theirs)), sorted(set(theirs) - set(mine))
    return Comparison(
        old=str(old), new=str(new), slack=slack, plans=found, unread=unread, only_old=gone, only_new=added,
        comparable=bool(found) and not unread and all(each.comparable for each in found),
        lost=bool(gone) or any(each.lost for each in found),
        won=bool(added) or any(each.won for each in found),
    )  # fmt: skip
