"""The comparison as written: one pydantic model is the form of `diff --json`, and its JSON Schema."""

import json
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector

FORMAT_VERSION = 1

#: How much of a face is reached by the cutter that reaches most of it.
Reach = Literal["reached", "undecided", "partly", "not reached", "not judged", "not asked", "inside other bodies", "drilled"]
#: How a face is known again.
FaceMatch = Literal["same file", "place", "carrier", "name", "trim"]
CutterMatch = Literal["id", "name", "cutting part"]
#: Changes of what was asked: as long as one is not named by `--despite`, verdicts are answers to two questions.
REQUESTED = ("unit", "faces", "sampling", "postures", "tolerance", "clearance", "machine", "setup", "fixtures")


class Change(Frozen):
    """Something other than verdicts differs."""

    what: str = Field(description=f"code: {', '.join(REQUESTED)}; part, tools, version, missing; of a cutter its field")
    old: str
    new: str
    hinders: bool = Field(default=False, description="the plans are not comparable for it")


class FaceState(Frozen):
    """How a face was answered in one plan, by all of its cutters."""

    reach: Reach = Field(description="`reached`: one cutter reaches every sample of it that is surface of the finished part; "
                         "`undecided`: of the best cutter undecided or unjudged samples alone are left")  # fmt: skip
    share: float = Field(description="of the face's area that the best cutter reaches, 0 to 1")
    cutters: list[str] = Field(description="ids of those that reach all of it, sorted")
    reason: str | None = Field(description="code of the reason by which the best cutter loses most of it")


class FaceDifference(Frozen):
    """A face whose answer differs, or that only one plan has."""

    old: str | None = Field(default=None, description="its id in the old plan, as F12; null: it is new, or was not known again")
    new: str | None = Field(default=None, description="its id in the new plan; null: it is gone, or was not known again")
    matched_by: FaceMatch | None = None
    name: str
    kind: str
    area_mm2: float | None = Field(description="null where it is not known")
    centre_mm: Vector | None
    radius_mm: tuple[float, float] | None = Field(
        default=None,
        description="of its cylinder, sphere or tube, old and new, where a face of another radius took the place of one",
    )
    was: FaceState | None = None
    now: FaceState | None = None
    lost: bool = Field(description="less of it is reached, or it is new and not reached")
    won: bool = Field(description="more of it is reached; false of a face that is gone")


class CutterState(Frozen):
    """How a cutter was answered in one plan."""

    id: str
    finishes: bool | None = Field(description="every judged sample; null: undecided ones or missing obstacles are left")
    share: float = Field(description="of the area to machine that it reaches, 0 to 1")
    reason: str | None = Field(description="code of the reason by which it loses most of the area")


class CutterDifference(Frozen):
    """A cutter whose answer or form differs, or that only one plan has."""

    name: str
    matched_by: CutterMatch | None
    was: CutterState | None
    now: CutterState | None
    changes: list[Change] = Field(description="of its form: holder, length and the like")
    faces_lost: list[tuple[str, str]] = Field(description="old and new id of faces that it reached whole, and does not any more")
    faces_won: list[tuple[str, str]]
    lost: bool
    won: bool


class PlanDifference(Frozen):
    """Two plans of one name."""

    name: str
    comparable: bool
    why_not: list[str] = Field(description="sentences; empty where they are comparable")
    changes: list[Change]
    selected: tuple[str | None, str | None] = Field(description="ids of the cutters to take, old and new")
    matched: dict[str, int] = Field(description="how many faces were known again, by how")
    faces: list[FaceDifference] = Field(description="first those of which less is reached, by the area; then new ones that are "
                                        "not reached, changed, won, new and gone ones")  # fmt: skip
    cutters: list[CutterDifference] = Field(description="first those that reach less, by the share; then changed ones and those "
                                            "that reach more")  # fmt: skip
    unreachable: list[str] = Field(description="ids of the target faces of the new plan that no cutter reaches whole")
    lost: bool
    won: bool

    @property
    def same(self) -> bool:
        """Nothing differs but what the run itself says."""
        other = self.selected[0] != self.selected[1]
        return not (self.why_not or self.changes or self.faces or self.cutters or other)


class Comparison(Frozen):
    """All plans of two folders, or two plans."""

    format: Literal["plan-cutters-diff"] = "plan-cutters-diff"
    format_version: int = FORMAT_VERSION
    old: str = Field(description="as given")
    new: str
    slack: float = Field(description="shares that differ by no more than this are the same")
    plans: list[PlanDifference]
    unread: list[str] = Field(description="a line for each plan that cannot be read: file, cause, what to try")
    only_old: list[str] = Field(description="names of plans that the new folder has not: lost")
    only_new: list[str] = Field(description="names of plans that the old folder had not: won")
    comparable: bool
    lost: bool
    won: bool


def schema_text() -> str:
    """JSON Schema of a comparison (draft 2020-12), made from the model."""
    made: dict[str, Any] = Comparison.model_json_schema(mode="serialization")
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **made}, indent=2) + "\n"


if __name__ == "__main__":
    (Path(__file__).with_name("diff.schema.json")).write_text(schema_text(), encoding="utf-8")
