"""Make the `meta` object of `docs/review_page_data.md`: all that the page needs beside arrays."""

import math
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.document.build import degrees
from plan_cutters.document.shares import counts
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.outline import Outline, outline, points
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.verdicts import WORDS
from plan_cutters.plan_file.model import CutterEntry
from plan_cutters.plan_file.palette import MEANING, PALETTE, label
from plan_cutters.plan_file.reasons import NO_CONTACT, REASONS
from plan_cutters.plan_file.shares import VERDICTS
from plan_cutters.plan_file.words.cutters import spot as sentence
from plan_cutters.plan_file.words.names import short_names
from plan_cutters.report.page.atlas import Atlas
from plan_cutters.report.page.facts import Spot
from plan_cutters.report.page.operations import operations_of
from plan_cutters.report.page.surface import Surface, fixtures_of
from plan_cutters.report.protocol import Judged

FORMAT = 1
#: Chord of the outlines of tools, mm.
_CHORD = 0.005


def meta_of(result: Judged, surface: Surface, atlas: Atlas, box: tuple[Floats, Floats], spots: list[Spot]) -> dict[str, Any]:
    """All of it but the arrays, and what was left out of them."""
    plan, effective, names = result.plan, result.plan.effective, short_names(result.plan)
    low, high = box
    return {
        "format": FORMAT,
        "part": {**_of(plan.part, "file", "sha256", "size_mm"), "low": low.tolist(), "high": high.tolist()},
        "setup": {"z": effective.setup, "x": effective.placement and effective.placement.x},
        "machine": plan.machine.name,
        "tolerance_mm": effective.tolerance_mm,
        "shown": result.shown,
        "selected": plan.selected,
        "reasons": plan.reasons,
        "verdicts": {str(code): word for code, word in WORDS.items()},
        "words": {word: {"name": label(word), "colour": PALETTE[word]} for word in MEANING},
        "causes": {each.code: _of(each, "name", "sentence", "colour", "pattern") for each in (*REASONS.values(), NO_CONTACT)},
        "rotation_deg": np.degrees(result.postures.rotations).round(6).tolist(),
        "tilt_deg": list(degrees(result.postures.tilt)),
        "tilt_limit_deg": plan.machine.tilt_limit_deg,
        "rotary": plan.machine.rotary is not None,
        "axes": [axis.name for axis in result.conditions.machine.rotary or ()],
        "kinematics": None if result.kinematics is None else _kinematics(result.kinematics),
        "setups": []
        if not result.elsewhere
        else [
            {"z": each.setup.tolist(), "kinematics": each.kinematics and _kinematics(each.kinematics)}
            for each in result.ready.setups
        ],
        "atlas": [atlas.index.shape[1], atlas.index.shape[0]],
        "faces": [_face(entry, surface) for entry in plan.faces],
        "fixtures": [
            {"name": fixture.name, "start": surface.fixtures[i][0], "count": surface.fixtures[i][1], "setups": setups}
            for i, (fixture, setups) in enumerate(fixtures_of(result))
        ],
        "cutters": [
            _cutter(names[entry.id], entry, result.judged(entry.id), counts(result.reaches[entry.id].verdict))
            for entry in plan.cutters
        ],
        "spots": [_spot(each) for each in spots],
        "operations": operations_of(result),
    }


def _kinematics(axes: Kinematics) -> dict[str, Any]:
    """Describe the rotary axes: the page finds with them which tool axes the machine holds; None: no limit that way."""
    ends = [[end if math.isfinite(end) else None for end in pair] for pair in np.degrees(axes.limit).tolist()]
    return {"direction": axes.direction.tolist(), "limit_deg": ends, "tool": axes.tool.tolist()}


def _face(entry: Any, surface: Surface) -> dict[str, Any]:
    number = int(entry.id[1:])
    start, count = surface.faces.get(number, (0, 0))
    words = ("id", "name", "component", "surface", "target", "ignored", "area_mm2")
    return {"number": number, **_of(entry, *words), "start": start, "count": count}


def _of(record: Any, *words: str) -> dict[str, Any]:
    """Attributes of a record by their names."""
    return {word: getattr(record, word) for word in words}


def _cutter(name: str, entry: CutterEntry, cutter: Cutter, data: dict[str, Any]) -> dict[str, Any]:
    return {
        "name": name,
        **_of(entry, "id", "feasible", "radius", "corner_radius", "allowance_mm", "clearance_mm", "touches_deg"),
        "modes": [_mode(mode) for mode in modes(cutter)],
        "outline": _outline(cutter),
        "shares": {word: getattr(entry.area_share, word) for word in VERDICTS},
        "counts": data,
        "by_reason": {name: n for name, n in entry.by_reason.items() if n},
        "undecided_by_reason": {name: n for name, n in entry.undecided_by_reason.items() if n},
    }


def _mode(mode: Any) -> dict[str, float]:
    low, high = degrees((mode.low, mode.high))
    return {**_of(mode, "offset", "radius", "height"), "tilt_low_deg": low, "tilt_high_deg": high}


def _outline(cutter: Cutter) -> list[dict[str, Any]]:
    """The polyline of each part of a tool, from the tip up."""
    whole, rows = outline(cutter), []
    for part in whole.parts:
        segments = whole.of(part)
        line = points(Outline(segments), _CHORD)
        line[0] = segments[0].start
        rows.append({"part": part, "points": line.round(4).tolist()})
    return rows


def _spot(spot: Spot) -> dict[str, Any]:
    w, best = spot.witness, spot.witness.best_posture
    return {
        **_of(spot, "cutter", "sample"),
        **_of(w, "face", "reason", "point", "obstacle_face", "obstacle_point", "depth_mm"),
        "tilt_deg": best and best.tilt,
        "lean_deg": best and best.rotation,
        "axis": best and best.axis,
        "text": sentence(w),
    }
