"""A plan with the arrays behind it."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cad_io import Part, SurfaceSamples
from plan_cutters.document.model import CutterEntry, Plan
from plan_cutters.domain.answers import Answers
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import Reach
from plan_cutters.scene.clearance import Clearances, clearances
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.scene import Scene
from plan_cutters.stages.posture_maps import PostureMaps


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """A plan with the arrays behind it.

    Attributes
    ----------
    plan : Plan
        What is written as `plan.json`.
    scene : Scene
        The part, its sides and what is in the way: `posture_map` takes it, and so does another `plan`.
    samples : SurfaceSamples
        Of the target faces.
    surface_class : (n,) uint8
    reaches : dict
        Cutter id -> Reach.
    postures : PostureRange
    kinematics : Kinematics, optional
        The machine's rotary axes in the part's frame; None where any tool axis within a plain limit is possible.
    elsewhere : tuple
        Of each other setup its axis, and what each cutter reaches there: cutter id -> Reach.
    answers : Answers
        What was asked for after the plan: `stick_outs`, `radius_maps`, `mends`.
    maps : PostureMaps, optional
        Every free tilt, for the cutter `shown`, where that was asked for.
    travels : dict
        Cutter id -> Travel: where the linear axes stand; empty where that is not judged.
    tools : dict
        Cutter id -> Cutter, from the most wanted down.
    conditions : Conditions, optional
        What all cutters were judged under.
    """

    plan: Plan
    scene: Scene
    samples: SurfaceSamples
    surface_class: NDArray[np.uint8]
    reaches: dict[str, Reach]
    postures: PostureRange
    kinematics: Kinematics | None = None
    elsewhere: tuple[tuple[tuple[float, float, float], dict[str, Reach]], ...] = ()
    answers: Answers = field(default_factory=Answers)
    maps: PostureMaps | None = None
    travels: dict[str, Travel] = field(default_factory=dict)
    tools: dict[str, Cutter] = field(default_factory=dict)
    conditions: Conditions | None = None

    def __repr__(self) -> str:
        return (
            f"Result({self.part!r}, {len(self.samples)} samples, {len(self.cutters)} cutters, selected {self.selected})"
        )

    @property
    def part(self) -> Part:
        return self.scene.part

    @property
    def cutters(self) -> list[CutterEntry]:
        """One entry a cutter, from the most wanted down."""
        return self.plan.cutters

    @property
    def selected(self) -> str | None:
        """Id of the cutter to take, or None."""
        return self.plan.selected

    @property
    def shown(self) -> str:
        """Id of the cutter that the models show: the selected, else the one that reaches the most samples."""
        return self.selected or max(self.cutters, key=lambda c: c.interference_free + c.accessible).id

    @cached_property
    def clearances(self) -> Clearances:
        """How far the cutter `shown` keeps from everything at the postures found, where it does not cut."""
        if self.conditions is None:
            raise ValueError("this result was made without what its cutters were judged under")
        return clearances(self.samples, self.tools[self.shown], self.reaches[self.shown], self.conditions)

    def to_json(self, path: str | Path) -> None:
        """Write the plan alone."""
        from plan_cutters.report.to_json import write_plan

        write_plan(self.plan, Path(path))

    def write(
        self,
        out: str | Path,
        formats: Sequence[str] = ("json", "html", "step", "glb", "npz"),
        *,
        step_schema: str = "ap242",
    ) -> Plan:
        """Write files into the folder `out`, each whole or not at all, the plan and the samples first.

        What cannot be written behind these is named in the plan's `not_written`; the other files are there. Files that an
        earlier run wrote there are removed if its plan lists them as they are.

        Parameters
        ----------
        out : path-like
        formats : sequence of str
            Of `json`, `html` (the review page), `step`, `glb`, `npz`, `merged` (a GLB of one mesh, for parts of thousands of
            faces), `png` (the part with its verdicts, four views), and `csv`, `vtk` and `regions` (tool axes for CAM:
            `docs/cam_outputs.md`).
        step_schema : str
            Application protocol of the STEP file: `ap242`, `ap214` or `ap203`.

        Returns
        -------
        Plan
            The plan as written, with its `files`, `split` and `not_written`.
        """
        from plan_cutters.report import write_all

        return write_all(self, Path(out), formats, step_schema=step_schema)
