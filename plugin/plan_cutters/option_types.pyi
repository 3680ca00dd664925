"""Types of options as callers give them and as `Options` keeps them: made by `python -m tests.support.option_stub`."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.own_process import OwnProcess
from plan_cutters.domain.placement import Placement, Setup
from plan_cutters.domain.posture import Range
from plan_cutters.library.raw_tool import Library

class PointOptions(TypedDict, total=False):
    setup: Setup
    flip: bool
    ignore: Any
    fixtures: Any

class SceneOptions(PointOptions, total=False):
    tolerance: float

class PlanOptions(SceneOptions, total=False):
    cutters: Cutter | str | Library | Sequence[Cutter | str] | Mapping[str, Cutter | str] | None
    libraries: Library | Sequence[Library] | None
    holder: Holder | str | None
    machine: Machine | str | os.PathLike[str] | None
    stock: str | None
    faces: Any
    sharp_edges: Literal["asked", "left"]
    drill_below: float
    unit: str | None
    effort: Literal["quick", "normal", "thorough"]
    spacing: float | None
    grid: int | None
    area_budget: int | None
    allowance: float
    holder_clearance: float
    tilt: Range | None
    rotation: Range
    rotation_step: float
    axis_accuracy: float | None
    posture_maps: bool
    map_budget: int | None
    units: Literal["mm", "in"] | None
    answers: Literal["stick-out", "radius", "mend", "all"] | Sequence[Literal["stick-out", "radius", "mend", "all"]]
    length_over_radius: float
    operations: Literal["fewest", "fastest", "both"] | None
    feed: float | None
    scallop: float
    stepover: float
    index_step: float | None
    index_time: float | None
    change_time: float
    setup_time: float
    removal_rate: float | None
    overlap: float
    link_time: float
    border_cost: float
    most_operations: int | None
    max_orientations: int
    process: OwnProcess | Mapping[str, Any] | str | os.PathLike[str] | None
    patterns: bool
    jobs: int | None
    other_setups: Sequence[Setup]
    placement: Placement | None
    other_placements: Sequence[Placement | None]
    propose: bool
    tilt_deg: Range | None
    rotation_deg: Range | None
    rotation_step_deg: float | None
    axis_accuracy_deg: float | None
    index_step_deg: float | None

@dataclass(frozen=True)
class OptionValues:
    cutters: tuple[Cutter, ...]
    libraries: tuple[Library, ...]
    holder: Holder | None
    machine: Machine
    setup: tuple[float, float, float]
    fixtures: tuple[Fixture, ...]
    stock: str
    faces: Any
    ignore: Any
    flip: bool
    sharp_edges: Literal["asked", "left"]
    drill_below: float
    unit: str | None
    effort: Literal["quick", "normal", "thorough"]
    spacing: float | None
    grid: int | None
    area_budget: int | None
    tolerance: float
    allowance: float
    holder_clearance: float
    tilt: tuple[float, float]
    rotation: tuple[float, float]
    rotation_step: float
    axis_accuracy: float | None
    posture_maps: bool
    map_budget: int | None
    units: Literal["mm", "in"] | None
    answers: tuple[Literal["stick-out", "radius", "mend", "all"], ...]
    length_over_radius: float
    operations: Literal["fewest", "fastest", "both"] | None
    feed: float | None
    scallop: float
    stepover: float
    index_step: float | None
    index_time: float | None
    change_time: float
    setup_time: float
    removal_rate: float | None
    overlap: float
    link_time: float
    border_cost: float
    most_operations: int | None
    max_orientations: int
    process: OwnProcess | None
    patterns: bool
    jobs: int
    other_setups: tuple[tuple[float, float, float], ...]
    placement: Placement | None
    other_placements: tuple[Placement | None, ...]
    propose: bool
