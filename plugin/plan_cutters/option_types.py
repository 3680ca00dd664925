"""The options as callers may give them: what type checkers and editors know of each."""

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, TypedDict

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.degrees import Angle
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.host_axes import HostAxis, HostPlane
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.own_process import OwnProcess
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.posture import ROTATIONS, STEP, TILTS, Range
from plan_cutters.library.records import Library

#: Axes of the part by name; `auto`: the setups that the plan proposes.
SetupWord = Literal["x", "+x", "-x", "y", "+y", "-y", "z", "+z", "-z", "X", "+X", "-X", "Y", "+Y", "-Y", "Z", "+Z", "-Z", "auto"]
#: A text is a word: type checkers find those that are none. A setup file is a path.
Setup = SetupWord | HostAxis | Iterable[float] | HostPlane | Placement | os.PathLike[str]
#: Options that are angles, and what each may be in degrees.
ANGLES = {"tilt": TILTS, "rotation": ROTATIONS, "rotation_step": STEP, "index_step": Angle(0.5, 90.0),
          "axis_accuracy": Angle(0.0, 1.0)}  # fmt: skip


#: What calls take beside options: it may be meant where a name is mistyped.
OF_CALLS = ("part", "progress", "cache")
#: Words of options that take no other text.
Operations = Literal["fewest", "fastest", "both"]
Answer = Literal["stick-out", "radius", "mend", "all"]
SharpEdges = Literal["asked", "left"]


class PointOptions(TypedDict, total=False):
    """Options of one point, of a scene and of a plan, as a caller may give them: `Options` says what each means."""

    setup: Setup
    flip: bool
    ignore: Any
    fixtures: Any


class SceneOptions(PointOptions, total=False):
    """Options of a scene and of a plan."""

    tolerance: float


class PlanOptions(SceneOptions, total=False):
    """Options of a plan: the names of `Options`, those of its angles in degrees, and the types that it takes, not keeps."""

    cutters: Cutter | str | Library | Sequence[Cutter | str] | None
    libraries: Library | Sequence[Library] | None
    holder: Holder | str | None
    allowance: float
    holder_clearance: float
    machine: Machine | str | os.PathLike[str] | None
    other_setups: Sequence[Setup]
    faces: Any
    grid: int | None
    spacing: float | None
    tilt: Range | None
    rotation: Range
    rotation_step: float
    tilt_deg: Range | None
    rotation_deg: Range | None
    rotation_step_deg: float | None
    jobs: int | None
    area_budget: int | None
    posture_maps: bool
    map_budget: int | None
    answers: Answer | Sequence[Answer]
    length_over_radius: float
    operations: Operations | None
    feed: float | None
    scallop: float
    stepover: float
    index_step: float | None
    index_step_deg: float | None
    axis_accuracy: float | None
    axis_accuracy_deg: float | None
    index_time: float | None
    change_time: float
    setup_time: float
    overlap: float
    most_operations: int | None
    sharp_edges: SharpEdges
    max_orientations: int
    process: OwnProcess | Mapping[str, Any] | str | os.PathLike[str] | None
    patterns: bool
    units: Literal["mm", "in"] | None
    unit: str | None
    placement: Placement | None
    other_placements: Sequence[Placement | None]
    propose: bool
