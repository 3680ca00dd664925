"""The options in force, after defaults, as the plan file states them."""

from typing import Any, Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector
from plan_cutters.plan_file.part_info import PlacementEntry


class LocalTolerance(Frozen):
    """A face that obstacle triangles do not follow as closely as all others: what only it may forbid is undecided."""

    face: str
    chord_error_mm: float = Field(description="bound of the distance between its triangles and its surface")
    tolerance_mm: float = Field(description="the gouge tolerance for which its triangles would be close enough")
    area_mm2: float
    share: float = Field(description="of the area of the target faces; 0 where it is no target")


class Effective(Frozen):
    """Every option after defaults."""

    cutters: list[str]
    cutter_source: str
    holder: str | None = Field(None, description="of the cutters that were given without one")
    allowance_mm: float = Field(0.0, description="stock left on the surface, unless a cutter says otherwise")
    holder_clearance_mm: float = Field(0.0, description="clearance required of neck, shank and holder, where a cutter says none")
    unit: str | None = Field(None, description="length unit taken instead of the file's")
    fixtures: list[str] = Field([], description="as on a command line: file or word, placement, unit")
    stock: str = Field("part", description="what the first setup grips, as --stock takes it")
    machine: str
    setup: Vector
    placement: PlacementEntry | None = Field(None, description="null where the axis alone was given")
    other_setups: list[Vector] = Field([], description="in which every cutter was judged, too")
    propose: bool = Field(False, description="always false: what was proposed is in `setup_proposal`")
    other_placements: list[PlacementEntry | None] = Field([], description="of these; empty if only axes were given")
    faces: str
    ignore: list[str] = Field([], description="faces that are neither targets nor obstacles, as requested")
    target_faces: list[str]
    grid: int | None = Field(description="samples a side and face; null where sampled by spacing")
    spacing_mm: float | None = Field(description="largest spacing requested; null where sampled by grid")
    sampled_by: Literal["default", "spacing", "grid"] = Field("default", description="the option that set the density")
    tilt_deg: tuple[float, float]
    rotation_deg: tuple[float, float]
    rotation_step_deg: float
    tolerance_mm: float = Field(description="the gouge tolerance that was met, raised where a budget binds")
    tolerance_requested_mm: float | None = Field(None, description="null in older files")
    local_tolerance: list[LocalTolerance] = Field(
        [], description="faces that obstacle triangles follow less closely than all others, the loosest first"
    )
    chord_error_mm: float = Field(
        description="bound of the distance between obstacle triangles and the surface, but on faces in `local_tolerance`"
    )
    chord_measured_share: float = Field(
        0.0,
        description="share of the triangles whose distance is measured at points, not proved: on faces whose surface or border "
        "only the CAD kernel can evaluate",
    )
    obstacle_triangles: int
    flip: bool
    sharp_edges: Literal["asked", "left"] = Field(
        "asked", description="left: strips at sharp inside edges that no cutter enters are not required"
    )
    drill_below_mm: float = Field(0.0, description="holes narrower than this are for drills, and in `holes`; 0 in older files")
    effort: Literal["quick", "normal", "thorough"] = Field(
        "normal", description="how much work advice and proofs after the verdicts may take"
    )
    units: Literal["mm", "in"] | None = Field(
        None, description="of lengths in words: mm or in; null: mm, and tools as they were given; numbers here are mm"
    )
    area_budget: int = Field(description="contacts that may be added between the samples")
    posture_maps: bool
    map_budget: int | None = Field(None, description="samples to map, at most; null: what some minutes allow")
    answers: list[str] = Field([], description="what was requested after the plan")
    length_over_radius: float = Field(10.0, description="of the ends whose largest radius is requested")
    operations: str | None = Field(None, description="plan of operations requested: fewest, fastest or both")
    feed_mm_min: float | None = Field(None, description="of all cutters; null: of the libraries' presets")
    scallop_mm: float = 0.01
    stepover: float = Field(0.75, description="widest distance of passes, in diameters")
    index_step_deg: float | None = Field(None, description="rotary axes lock at whole multiples of it alone")
    axis_accuracy_deg: float = Field(0.05, description="orientations of one setup that are nearer than this are one")
    index_time_s: float = Field(5.0, description="of an orientation, unless rates of the machine's rotary axes say more")
    rotary_rates_deg_s: dict[str, float] = Field(
        {}, description="by the machine's file: what simultaneous motion, and turns without --index-time, are timed with"
    )
    change_time_s: float = 20.0
    setup_time_s: float = 300.0
    removal_rate_cm3_min: float | None = Field(None, description="of roughing; null: its minutes are not known")
    overlap_mm: float = Field(2.0, description="of operations at a common border")
    link_time_s: float = Field(1.0, description="from the end of a pass to the next one")
    border_cost: float = Field(0.05, description="seconds that a mm of border on a free-form face counts in comparisons")
    most_operations: int | None = None
    process: dict[str, Any] | None = Field(
        None, description="the planner's own steps, as a file has them (`process.toml`); null: all steps were planned"
    )
    patterns: bool = Field(True, description="equal faces are judged and planned once")
    max_orientations: int = Field(8, description="of the fastest plan: with more, simultaneous motion is recommended")
