"""Outputs of `--json` of the commands beside `plan`: these models make the schemas that the outputs are checked against.

Lengths in mm, angles in degrees, part coordinates. A version is raised where something changes its meaning or goes; what is added
raises none.
"""

from typing import Any, Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector

FORMAT_VERSION = 1
Intervals = list[tuple[float, float]]


class RotationOutput(Frozen):
    """Tilts at one rotation: what is free, and what each cause forbids by itself."""

    deg: float = Field(description="from `direction_max`, about the normal")
    local_gouge: float | None = Field(description="least tilt that the surface's own curvature allows; null: none")
    free: Intervals
    undecided: Intervals = Field(description="neither called free nor known to be forbidden")
    axis_limit: Intervals
    rear_gouge: Intervals
    collision: Intervals
    neck: Intervals
    shank: Intervals
    holder: Intervals
    buried: Intervals
    no_contact: Intervals = Field(description="the cutter touches nowhere")


class MapOutput(Frozen):
    """All postures of one cutter at one point (`plan-cutters map --json -`)."""

    format: Literal["plan-cutters-map"] = "plan-cutters-map"
    format_version: int = FORMAT_VERSION
    part: str
    face: str
    point: Vector = Field(description="the nearest point of the part")
    off_mm: float = Field(description="from the requested point")
    normal: Vector
    direction_max: Vector
    curvature: tuple[float, float] = Field(description="largest and smallest, 1/mm, concave positive")
    cutter: str
    machine: str
    setup: str
    flank_axis: Vector | None = Field(
        default=None,
        description="tool axis with which it is free, its flank along the surface, where no tilt is free; null: none",
    )
    tilt_deg: tuple[float, float] | None = Field(default=None, description="tilts that were searched")
    under_flat_mm: Vector | None = Field(
        description="null, or the tool stands free upright with the point under the flat of its tip: from its axis to the point"
    )
    tolerance_mm: float = Field(description="0: the nominal answer, which proves nothing")
    certified: bool
    missing: list[str] = Field(description="obstacles that are missing or guessed")
    rotations: list[RotationOutput]


class HeldOutput(Frozen):
    name: str
    id: str


class ToolOutput(Frozen):
    """A cutter of a library; two tools of one geometry are one cutter."""

    id: str
    numbers: list[int] = Field(description="in the tool changer")
    names: list[str]
    shape: str
    radius: float
    corner_radius: float
    length: float = Field(description="stick-out")
    flutes: float
    holder: HeldOutput | None


class ListedOutput(Frozen):
    """A tool as its library lists it."""

    place: str
    number: int | None
    name: str
    type: str
    unit: str | None
    cutter: str | None = Field(description="id of the cutter that it became")
    drill: str | None = Field(default=None, description="id of what it is where it is a tool for holes")
    unused: str | None = Field(description="why it became none")
    broken: bool = Field(description="it contradicts itself or cannot be read")
    notes: list[str]
    given: dict[str, float] = Field(description="by ISO 13399 code")


class LibraryOutput(Frozen):
    file: str
    format: str
    notes: list[str]
    cutters: list[ToolOutput]
    entries: list[ListedOutput]
    holders: list[HeldOutput]


class ToolsOutput(Frozen):
    """Tool libraries as they were understood (`plan-cutters tools --json`)."""

    format: Literal["plan-cutters-tools"] = "plan-cutters-tools"
    format_version: int = FORMAT_VERSION
    libraries: list[LibraryOutput]


class HolderOutput(HeldOutput):
    word: str = Field(description="as `--holder` takes it")
    bore: float = Field(description="largest diameter of a shank")


class HoldersOutput(Frozen):
    """The built-in holders (`plan-cutters tools --list-holders --json`)."""

    format: Literal["plan-cutters-holders"] = "plan-cutters-holders"
    format_version: int = FORMAT_VERSION
    holders: list[HolderOutput]


class PositionOutput(Frozen):
    deg: dict[str, float] = Field(description="by axis")
    taken: bool = Field(description="of several, the one with the smaller turns")


class AnglesOutput(Frozen):
    """Positions of the rotary axes that hold a tool axis."""

    tool_axis: Vector
    solutions: list[PositionOutput]


class ToolAxisOutput(Frozen):
    """The tool axis at a position."""

    deg: dict[str, float]
    tool_axis: Vector
    beyond_limits: list[str] = Field(description="axes")


class MachineOutput(Frozen):
    given: str
    format: str
    machine: dict[str, Any] = Field(description="as our own format has it: docs/machines.md")
    share_of_directions: float | None = Field(description="that it can hold")
    singular_cone_deg: float | None
    singular_share: float | None
    angles: AnglesOutput | None = Field(default=None, description="only where requested (--angles)")
    axis: ToolAxisOutput | None = Field(default=None, description="only where requested (--axis)")


class MachinesOutput(Frozen):
    """Machines as they were understood (`plan-cutters machines --json`)."""

    format: Literal["plan-cutters-machines"] = "plan-cutters-machines"
    format_version: int = FORMAT_VERSION
    machines: list[MachineOutput]


#: By the beginning of the schema's file in the package.
OUTPUTS: dict[str, type[Frozen]] = {"map": MapOutput, "tools": ToolsOutput, "holders": HoldersOutput, "machines": MachinesOutput}
