"""The plan file states here the options in force, after defaults."""

import re
from dataclasses import replace
from typing import Any

import numpy as np

from plan_cutters.document.build import degrees
from plan_cutters.document.travel import placement_entry
from plan_cutters.domain.operations import INDEX_TIME
from plan_cutters.domain.own_process import cutter_of
from plan_cutters.domain.tolerance import effective_tolerance
from plan_cutters.options import Options
from plan_cutters.plan_file.effective import Effective, LocalTolerance
from plan_cutters.scene.preparation import Prepared


def effective(ready: Prepared) -> Effective:
    """Every option after defaults: as `Options` keeps it where nothing more is said here, angles in degrees."""
    scene, options, choice, surroundings = ready.scene, ready.options, ready.chosen, ready.conditions.surroundings
    made: dict[str, Any] = {
        "cutters": [c.id for c in ready.cutters],
        "units": options.reported_unit,
        "cutter_source": " and ".join(_sources(options)) or "built-in",
        "holder": None if options.holder is None else options.holder.id,
        "fixtures": [each.text for each in scene.fixtures],
        "machine": options.machine.name,
        "setup": scene.setup,
        "placement": placement_entry(options.placement),
        "other_placements": [placement_entry(each) for each in options.other_placements],
        "faces": choice.asked,
        "ignore": list(choice.ignore),
        "target_faces": [f"F{n}" for n in choice.targets],
        "spacing_mm": max(ready.spacing.values()) if isinstance(ready.spacing, dict) else ready.spacing,
        "sampled_by": "grid" if options.grid is not None else "default" if options.spacing is None else "spacing",
        "tolerance_mm": ready.conditions.tolerance,
        "tolerance_requested_mm": scene.asked,
        "local_tolerance": _local(ready),
        "chord_error_mm": surroundings.certain.triangles.chord_error,
        "chord_measured_share": surroundings.certain.triangles.measured_share,
        "obstacle_triangles": len(surroundings.possible.triangles),
        "area_budget": options.contacts_between(len(ready.samples)),
        "process": _process(ready),
        "axis_accuracy_deg": float(np.degrees(options.accuracy)),
        "index_time_s": INDEX_TIME if options.index_time is None else options.index_time,
    }
    return Effective(**{name: as_requested(options, name) for name in Effective.model_fields if name not in made}, **made)


def _local(ready: Prepared) -> list[LocalTolerance]:
    faces, targets = ready.scene.part.faces, set(ready.chosen.targets)
    whole = sum(faces[number - 1].area for number in targets)
    changes = [
        LocalTolerance(
            face=f"F{number}",
            chord_error_mm=error,
            tolerance_mm=effective_tolerance(0.0, error),
            area_mm2=faces[number - 1].area,
            share=faces[number - 1].area / whole if number in targets and whole > 0.0 else 0.0,
        )
        for number, error in ready.conditions.surroundings.loose.items()
    ]
    return sorted(changes, key=lambda each: (-each.chord_error_mm, int(each.face[1:])))


def _process(ready: Prepared) -> dict[str, Any] | None:
    """The planner's own steps, their cutters by id."""
    process = ready.options.process
    if process is None:
        return None

    def called(word: str) -> str:
        return cutter_of(word, ready.cutters, "process").id

    steps = tuple(replace(each, cutter=called(each.cutter)) for each in process.steps)
    forbidden = tuple(replace(each, cutter=called(each.cutter)) for each in process.forbidden)
    return replace(process, steps=steps, forbidden=forbidden).written()


def as_requested(options: Options, name: str) -> Any:
    """The option of an entry's name."""
    value = getattr(options, re.sub("_(mm|deg|s|mm_min)$", "", name))
    if value is None or not name.endswith("_deg"):
        return value
    return degrees(value) if isinstance(value, tuple) else float(np.degrees(value))


def _sources(options: Options) -> list[str]:
    """Where the cutters are from; nothing for the built-in ones."""
    return [*(["given"] if options.cutters else []), *(library.file for library in options.libraries)]
