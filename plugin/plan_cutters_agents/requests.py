"""The questions of an agent: their fields are the input schemas of the tools."""

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, WithJsonSchema, model_validator
from pydantic import ValidatorFunctionWrapHandler as Handler
from pydantic.functional_validators import AfterValidator, WrapValidator

from plan_cutters.domain.answer_kinds import ANSWERS, KINDS
from plan_cutters.errors import OptionError
from plan_cutters.machines.process_file import ProcessTable, process_of
from plan_cutters.machines.toml import explained
from plan_cutters.option_table import OPTIONS

#: Words of the command line are short.
Word = Annotated[str, Field(min_length=1, max_length=300)]
Path = Annotated[str, Field(min_length=1, max_length=4000)]
Point = Annotated[tuple[float, float, float], Field(description="x, y, z in part coordinates, mm")]
_NUMBER = r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?"
Axis = Annotated[str, Field(pattern=rf"^([+-]?[xyzXYZ]|auto|{_NUMBER},{_NUMBER},{_NUMBER})$", max_length=200)]
Face = Annotated[str, Field(pattern=r"^F[1-9]\d{0,6}$", description="as `F12`: faces are numbered as the CAD kernel lists them")]


def _answer(word: str) -> str:
    if word not in ANSWERS:
        raise ValueError(f"is none of {', '.join(ANSWERS)}")
    return word


#: A question that a plan may answer beside its verdicts.
Answer = Annotated[str, AfterValidator(_answer), WithJsonSchema({"type": "string", "enum": [*ANSWERS]})]


def _process(value: Any, handler: Handler) -> Any:
    """The planner's own steps; what is wrong with them is said as of a file, with the place."""
    try:
        table = handler(value)
        process_of(table.model_dump(exclude_none=True))
    except ValidationError as error:
        raise ValueError(explained(error)) from None
    except OptionError as error:
        raise ValueError(error.cause) from None
    return table


#: The planner's own steps, as a file has them.
Process = Annotated[ProcessTable, WrapValidator(_process), WithJsonSchema({"type": "object"})]
#: Files that a plan may write.
Format = Literal["json", "step", "glb", "merged", "part", "npz", "html", "png", "csv", "vtk"]


def _plain(word: str) -> Any:
    """The field of an option whose value an agent gives as a command line has it: all of it is in the option's row."""
    row = OPTIONS[word]
    low, high = row.limits[:2] if row.limits else (None, None)
    about = row.brief if isinstance(row.brief, str) else row.help
    return Field(row.default, ge=low, le=high, description=about.partition("  [")[0].rstrip("."))


class Question(BaseModel):
    """A question has these fields and no others: a word that is mistyped must not be lost."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Conditions(Question):
    """Cutters are judged under these conditions."""

    library: Path | None = Field(None, description="a tool library, in a root: its tools are judged in place of `cutters`")
    holder: Word | None = Field(
        None, description="of cutters without one: er32, hsk63a-er32, D30L30, none, or a file with a holder"
    )
    machine: Word = Field("unlimited", description="unlimited, tilt:DEG, a built-in machine, or a machine file in a root")
    fixtures: list[Word] = Field(
        [], max_length=50, description="bodies in the way: FILE@X,Y,Z[,RX,RY,RZ][:UNIT], box:X,Y,Z@..., cylinder:R,H@..., table"
    )
    ignore: list[Word] = Field([], max_length=50, description="faces that are neither machined nor obstacles")
    unit: Literal["um", "mm", "cm", "m", "km", "mil", "in", "ft"] | None = _plain("unit")
    flip: bool = _plain("flip")
    tolerance_mm: float = _plain("tolerance")
    allowance_mm: float = _plain("allowance")
    holder_clearance_mm: float = _plain("holder_clearance")


class Sampling(Question):
    """How densely a surface is looked at: by default from its curvature and the smallest cutter."""

    grid: int | None = _plain("grid")
    spacing_mm: float | None = Field(
        None, gt=0.0, description="largest distance of neighbouring samples: with one value in all calls shares can be compared"
    )

    @model_validator(mode="after")
    def _one(self) -> Self:
        if self.grid is not None and self.spacing_mm is not None:
            raise ValueError("give `grid` or `spacing_mm`, not both")
        return self


class PartQuestion(Conditions, Sampling):
    """A part, its cutters and what they are judged under."""

    part: Path = Field(description="STEP, IGES or BREP, in a root")
    cutters: list[Word] = Field(
        [],
        max_length=200,
        description="D12L80 (diameter, length from tip to holder) or R6L80 (radius); rc1 corner radius (rc6: ball), T5 taper, "
        "F20 flutes, N11x40 neck, S12 shank; without any, the built-in tool set is judged",
    )
    setup: list[Axis] = Field(
        ["0,0,1"],
        min_length=1,
        max_length=12,
        description="directions of the part along the machine's spindle: +z, -y, or x,y,z; every cutter is judged in each",
    )
    faces: Word = Field("sculptured,blends", description="faces to machine: sculptured, blends, all, F3,7-12, name:REGEX")


class PlanQuestion(PartQuestion):
    """Which cutters finish a part?"""

    answers: list[Answer] = Field([], description="; ".join(f"{kind.word}: {kind.meaning}" for kind in KINDS))
    operations: Literal["fewest", "fastest", "both"] | None = Field(
        None, description="plan fixed orientations and simultaneous steps: `steps` has them; fastest and both need a feed"
    )
    feed_mm_min: float | None = _plain("feed")
    process: Process | None = Field(
        None,
        description="your own steps, judged as they stand, in their order: edit `steps` of an answer; the rest is planned behind "
        "them, or left; needs no `operations`",
    )
    out: Path | None = Field(None, description="folder in a root for files; without it, none is written")
    formats: list[Format] = Field(["json"], min_length=1, description="of these files")


class CompareQuestion(PartQuestion):
    """How do some cutters differ on a part?"""

    @model_validator(mode="after")
    def _several(self) -> Self:
        if len(self.cutters) == 1 and self.library is None:
            raise ValueError("one cutter is compared with nothing: give two or more in `cutters`, or a `library`")
        return self


class ExplainQuestion(Conditions, Sampling):
    """Why does a cutter not reach a face or a point, and what would help?"""

    part: Path | None = Field(None, description="STEP, IGES or BREP, in a root: it is judged now")
    plan: Path | None = Field(None, description="or a plan.json in a root: it answers at once")
    cutter: Word = Field(
        description="R6L80 and so on; an id, a name or their beginning (R6) where that is one of the plan or library"
    )
    face: Face | None = None
    point: Point | None = Field(None, description="instead of a face: x, y, z in part coordinates, mm")
    within_mm: float = Field(1.0, gt=0.0, le=1000.0, description="how far the point may be from the surface")
    setup: list[Axis] = Field(["0,0,1"], min_length=1, max_length=12, description="as of `plan_part`")

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        if (self.part is None) == (self.plan is None):
            raise ValueError("give either `part` or `plan`")
        if (self.face is None) == (self.point is None):
            raise ValueError("give either `face` or `point`")
        if self.plan is not None and (others := self.model_fields_set - {"plan", "cutter", "face", "point", "within_mm"}):
            raise ValueError(f"`{min(others)}` is for a part, and a plan has its own: leave it out, or give `part`")
        return self


class MapQuestion(Conditions):
    """Which postures of a cutter are free at a point?"""

    part: Path = Field(description="STEP, IGES or BREP, in a root")
    cutter: Word = Field(description="R6L80 and so on; with `library` the id or the name of a tool there")
    point: Point
    within_mm: float = Field(1.0, gt=0.0, le=1000.0, description="how far the point may be from the surface")
    setup: Axis = Field("0,0,1", description="direction of the part along the spindle")
    tilt_deg: tuple[float, float] | None = Field(None, description="tilts to search, from the normal")
    rotation_step_deg: float = Field(10.0, ge=1.0, le=360.0, description="step between rotations")
    picture: bool = Field(False, description="also draw it: tilt against rotation")


class ShopQuestion(Question):
    """Which tools and machines are there?"""

    library: Path | None = Field(None, description="a tool library, in a root; without it, the built-in set is listed")
    machines: bool = Field(True, description="list the built-in machines, too")


class DifferenceQuestion(Question):
    """How do two plans differ?"""

    old: Path = Field(description="plan.json, in a root")
    new: Path = Field(description="plan.json, in a root")


class RenderQuestion(PartQuestion):
    """How does the part look with the verdicts of a cutter?"""
