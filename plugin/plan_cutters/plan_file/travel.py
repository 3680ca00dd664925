"""Entries that say where the part stands, and which linear travel a cutter needs there."""

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector


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
