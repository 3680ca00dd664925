"""Entries that say where the part stands, which linear travel a cutter needs there, and how much is reached in each setup."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector
from plan_cutters.plan_file.shares import VerdictCounts


class PlacementEntry(Frozen):
    """How the part stands in a setup, where more than the axis was given."""

    file: str | None
    x: Vector | None = Field(description="direction of the part along the machine's X; null: as near to the part's X as can be")
    origin_mm: Vector | None = Field(description="point of the part at the machine's zero; null: not known")
    clamped: list[str] = Field(description="faces that are held, in the words for faces: left for another setup")


class AxisTravel(Frozen):
    """The postures found need this travel of a linear axis."""

    name: str
    limits_mm: tuple[float | None, float | None] = Field(description="null: no limit on that side")
    least_mm: float | None = Field(description="least position needed; null where no sample is reached")
    most_mm: float | None
    outside: int = Field(description="reached samples at which it is beyond its limits")


class BeyondTravel(Frozen):
    """The sample at which an axis is farthest beyond its limits."""

    point: Vector
    face: str
    axis: str
    beyond_mm: float


class TravelEntry(Frozen):
    """Linear travel at the postures found, of the holder's nose: a second check that changes no verdict."""

    judged: int = Field(description="reached samples at which the positions were found")
    unknown: int = Field(description="reached samples at which they were not: there linear axes are in one plane")
    outside: int = Field(description="reached samples at which an axis is beyond its limits")
    axes: list[AxisTravel]
    worst: list[BeyondTravel] = Field(description="one for each axis that is ever beyond its limits, the farthest first")


class SetupEntry(Frozen):
    """How much of the target surface some cutter could touch within the axis limits, were this the setup axis."""

    axis: Vector
    within: int = Field(description="samples")
    share: float = Field(description="of the judged samples' area, 0 to 1")
    reached: int | None = Field(
        default=None, description="samples that some cutter reaches in it; null where it was not requested"
    )
    reached_share: float | None = Field(default=None, description="of the judged samples' area, 0 to 1")


class HiddenFaces(Frozen):
    """Of these faces another proposed setup machines what this one hides."""

    setup: int = Field(description="that setup, counted from 0 for the first")
    faces: list[str]


class ProposedSetup(Frozen):
    """A setup that was proposed, with a table, a vise or a chuck as all that holds the part."""

    axis: Vector
    stands_on: list[str] = Field(
        description="planar faces that lie on the table, or on the ledges of the jaws: no targets in this setup"
    )
    clamping: Literal["table", "vise", "chuck"] = "table"
    grips: list[str] = Field(default=[], description="faces that the jaws touch")
    fixtures: list[str] = Field(default=["table"], description="what holds the part, as --fixture takes it")
    hidden_mm2: float = Field(default=0.0, description="area of the faces to machine that the jaws touch: for another setup")
    how_held: str = Field(default="", description="what the vise or chuck is and what it grips; empty for a table")
    why_held: str = Field(default="", description="why it is held so; empty where nothing else was tried")
    left_for: list[HiddenFaces] = Field(default=[], description="which other setups machine what it stands on and grips")
    promised: float = Field(description="share of the compared samples' area that it serves by itself, 0 to 1")


class SetupProposal(Frozen):
    """Which setups were proposed, what was promised of them, and what their plan found."""

    setups: list[ProposedSetup] = Field(description="those of the plan, in its order")
    directions: int = Field(description="directions of the part that were compared by the limits of the machine")
    searched: int = Field(description="those of them that were searched for postures over a table, or in a vise or chuck")
    samples: int = Field(description="at which they were compared")
    promised: float = Field(description="share of these samples' area that the setups serve together, 0 to 1")
    found: float = Field(description="share of all target area that the plan reaches, faces that are stood on included")
    kept: float = Field(description="of what was promised, the share of area that the plan reaches, 0 to 1")
    held: bool = Field(description="the plan holds what was promised, to 1 %")
    tried: int = Field(description="which proposal this is: those before it did not hold")
    why: str


class SetupReach(VerdictCounts):
    """The verdicts of a cutter in one setup are counted in samples."""

    axis: Vector
    serves: int = Field(default=0, description="samples whose posture is that of this setup: the first one that reaches them")
