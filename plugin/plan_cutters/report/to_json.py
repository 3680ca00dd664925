"""The plan as JSON, and its schema."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from plan_cutters.errors import PlanError
from plan_cutters_base.whole import whole

if TYPE_CHECKING:
    # The model takes a second to load: who says why a run was ended has not got that.
    from plan_cutters.plan_file.model import Plan

_Taken = TypeVar("_Taken")
#: Why a file is missing while it is being made: what stays in the plan if the run is ended then.
PENDING = "the run ended before it was written"


def dumps(plan: "Plan") -> str:
    """The plan's text; the same plan gives the same bytes."""
    return plan.model_dump_json(indent=2) + "\n"


def schema() -> dict[str, Any]:
    """JSON Schema of the plan file (draft 2020-12), made from the model."""
    from plan_cutters.plan_file.model import Plan

    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Plan.model_json_schema(mode="serialization")}


def write_plan(plan: "Plan", path: Path) -> None:
    """Write the plan, whole or not at all."""
    _write(dumps(plan), path)


def _write(text: str, path: Path) -> None:
    with whole(path, PlanError) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _read(path: Path, take: Callable[[Any], _Taken], otherwise: _Taken) -> _Taken:
    """What is taken of a plan file of any version; `otherwise` where there is no such file, or it is damaged."""
    try:
        return take(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return otherwise


def listed(path: Path) -> dict[str, str] | None:
    """Names and checksums of the files that a plan file of any version lists; None if it is no such file."""

    def take(plan: Any) -> dict[str, str] | None:
        files = {str(entry["name"]): str(entry["sha256"]) for entry in plan["files"].values()}
        return files if plan["format"] == "plan-cutters-plan" else None

    return _read(path, take, None)


def unfinished(path: Path) -> str:
    """Read what a plan file is without, for its run had not been done; empty where it was, or there is no plan."""

    def take(plan: Any) -> str:
        each = zip(plan["note_codes"], plan["notes"], strict=True)
        return next((str(text) for code, text in each if code == "run_unfinished"), "")

    return _read(path, take, "")


def not_written(path: Path) -> tuple[str, ...]:
    """The formats that a plan file says were not written; none where there is no plan."""
    return _read(path, lambda plan: tuple(plan["not_written"]), ())


def explain(path: Path, cause: str) -> tuple[str, ...]:
    """Say in a plan file why its pending files were never written; their formats."""

    def take(plan: Any) -> tuple[Any, tuple[str, ...]]:
        ours = plan["format"] == "plan-cutters-plan"
        return plan, tuple(name for name, why in plan["not_written"].items() if ours and why == PENDING)

    nothing: tuple[Any, tuple[str, ...]] = None, ()
    plan, pending = _read(path, take, nothing)
    if pending:
        plan["not_written"] |= dict.fromkeys(pending, cause)
        _write(json.dumps(plan, indent=2, ensure_ascii=False) + "\n", path)
    return pending


if __name__ == "__main__":
    (Path(__file__).parent.parent / "plan.schema.json").write_text(json.dumps(schema(), indent=2) + "\n", encoding="utf-8")
