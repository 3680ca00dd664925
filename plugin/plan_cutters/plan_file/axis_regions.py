"""Tool axis limits by region, as `axis_regions.json` has them: the model is the file's form, its schema and its documentation.

Lengths in mm, angles in degrees, part coordinates.
"""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector

AXIS_REGIONS_VERSION = 1
Span = tuple[float, float]


class RegionFace(Frozen):
    """A region has these samples and this area of a face."""

    face: str
    samples: int
    area_mm2: float


class FreeTilts(Frozen):
    """Tilts that are free at every sample of a region, from the posture maps, and that the machine can hold there."""

    leaning_deg: Span | None = Field(
        description="each sample has a rotation, one of those searched, at which all these tilts are free and within the axis "
        "limits; null: no range is common to all"
    )
    any_rotation_deg: Span | None = Field(
        description="these tilts are free and within the axis limits at every rotation searched, at every sample; null: none are"
    )


class AxisFound(Frozen):
    """The axes that the plan found for a region's samples, one by one."""

    mean: Vector = Field(description="unit mean, by area")
    half_angle_deg: float = Field(description="of the cone about the mean that holds all of them")
    tilt_deg: Span


class Region(Frozen):
    """Connected samples that one fixed tool axis serves."""

    id: int
    axis: int = Field(description="index into `axes`")
    tilt_deg: Span = Field(description="least and largest tilt of that axis from the surface normals")
    clearance_mm: float | None = Field(
        description="least at any sample with that axis, as in axes.csv; null where it is not known"
    )
    samples: int
    area_mm2: float
    low: Vector = Field(description="corner of the bounding box of its samples")
    high: Vector
    faces: list[RegionFace]
    found: AxisFound
    free: FreeTilts | None = Field(description="null without posture maps (--posture-maps)")
    rows: list[tuple[int, int]] = Field(
        description="its samples: first and last of runs of rows of samples.npz and axes.csv, from 0"
    )


class FixedAxis(Frozen):
    """A tool axis that stays as it is, and what it serves of what is left by those before it."""

    axis: Vector
    rotary_deg: dict[str, float] | None = Field(
        description="a position of the machine's rotary axes that holds it, by name; null without such axes; whether the linear "
        "axes can go there is not looked at"
    )
    samples: int
    area_mm2: float
    share: float = Field(description="of the area of all samples, 0 to 1")
    regions: list[int]


class Rest(Frozen):
    """Samples that belong to no region."""

    samples: int
    area_mm2: float
    rows: list[tuple[int, int]]


class AxisRegions(Frozen):
    """Which fixed tool axes serve what a cutter reaches, region by region. All is about samples, at their contacts."""

    format: Literal["plan-cutters-axis-regions"] = "plan-cutters-axis-regions"
    format_version: int = AXIS_REGIONS_VERSION
    part: str | None
    sha256: str | None
    cutter: str
    machine: str
    setup: Vector = Field(description="the first one, where there are several")
    tolerance_mm: float
    axes: list[FixedAxis] = Field(description="the one that serves most of what is left comes next")
    regions: list[Region] = Field(description="the largest area first; every reached sample is in one region or in `rest`")
    rest: Rest = Field(description="reached, each with its own axis of axes.csv, but with none of these")
    not_reached: Rest = Field(description="inaccessible, undecided or unjudged")
