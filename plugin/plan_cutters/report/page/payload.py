"""The data of the review page: facts as JSON, arrays in one stream."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.write.drawn import Drawn
from plan_cutters.document.build import counts, degrees
from plan_cutters.domain.outline import Outline, outline, points
from plan_cutters.domain.shapes import modes
from plan_cutters.report.page.atlas import Atlas, NOWHERE, atlas_of, placed_in
from plan_cutters.report.page.encode import COARSE, FINE, Stream, halves, octahedral, placed, turned, unfolded
from plan_cutters.report.page.facts import WORDS, Spot, shares, tilt_and_lean
from plan_cutters.report.page.stored_maps import stored

FORMAT = 1
#: Chord of the outlines of tools, mm.
_CHORD = 0.02


@dataclass(frozen=True, slots=True)
class Surface:
    """All that is drawn: vertices of faces, then of fixtures.

    Attributes
    ----------
    point, normal : (v, 3) float
    triangle : (m, 3) uint32
    place : (v, 2) uint16
        In the atlas.
    faces, fixtures : dict
        Face number, or place among the fixtures, -> first triangle and number of triangles.
    """

    point: Floats
    normal: Floats
    triangle: NDArray[np.uint32]
    place: NDArray[np.uint16]
    faces: dict[int, tuple[int, int]]
    fixtures: dict[int, tuple[int, int]]


def surface_of(result: Any, drawn: Drawn, atlas: Atlas) -> Surface:
    """Put the meshes of faces and fixtures together."""
    point, normal, triangle, place = [], [], [], []
    vertices = triangles = 0
    ranges: tuple[dict[int, tuple[int, int]], dict[int, tuple[int, int]]] = ({}, {})
    pieces = []
    for number in sorted(drawn.meshes):
        mesh, at = placed_in(atlas, result.samples, number, drawn.meshes[number], drawn.periods[number])
        pieces.append((0, number, mesh.point, mesh.normal, mesh.triangle, at))
    for i, each in enumerate(result.scene.around.fixtures):
        corner = each.shown.reshape(-1, 3)
        flat = np.cross(each.shown[:, 1] - each.shown[:, 0], each.shown[:, 2] - each.shown[:, 0])
        length = np.linalg.norm(flat, axis=1)
        flat = np.repeat(flat / np.where(length > 0, length, 1.0)[:, None], 3, axis=0)
        corners = np.arange(len(corner), dtype=np.uint32).reshape(-1, 3)
        pieces.append((1, i, corner, flat, corners, np.full((len(corner), 2), NOWHERE, np.uint16)))
    for kind, number, points_, normals, corners, at in pieces:
        ranges[kind][number] = (triangles, len(corners))
        point.append(points_)
        normal.append(normals)
        triangle.append(corners + np.uint32(vertices))
        place.append(at)
        vertices, triangles = vertices + len(points_), triangles + len(corners)
    return Surface(*map(np.concatenate, (point, normal, triangle, place)), *ranges)  # type: ignore[arg-type]


def box_of(surface: Surface, samples: Any) -> tuple[Floats, Floats]:
    """Corners of the box around all that is drawn, mm."""
    every = np.vstack([surface.point, samples.point[np.isfinite(samples.point).all(axis=1)]])
    return every.min(axis=0), every.max(axis=0)


def add_surface(stream: Stream, surface: Surface, low: Floats, high: Floats) -> None:
    """The mesh."""
    stream.add("mesh.position", placed(surface.point, low, high))
    stream.add("mesh.normal", (octahedral(surface.normal, COARSE) + COARSE).astype(np.uint8))
    stream.add("mesh.triangle", surface.triangle)
    stream.add("mesh.texel", surface.place)


def add_samples(stream: Stream, result: Any, atlas: Atlas, low: Floats, high: Floats) -> None:
    """The samples, and what each cutter reaches of them."""
    samples = result.samples
    normal = octahedral(samples.normal, FINE)
    stream.add("atlas.index", atlas.index.reshape(-1))
    stream.add("sample.point", placed(np.nan_to_num(samples.point), low, high))
    stream.add("sample.normal", normal)
    stream.add("sample.direction", turned(samples.direction_max, unfolded(normal, FINE)))
    stream.add("sample.curvature", halves(samples.curvature))
    stream.add("sample.class", result.surface_class)
    stream.add("sample.face", samples.face.astype(np.uint16 if samples.face.max(initial=0) < 65536 else np.uint32))
    stream.add("sample.area", halves(samples.area))
    for name, reach in result.reaches.items():
        stream.add(f"verdict.{name}", reach.verdict)
        stream.add(f"reason.{name}", reach.reason)


def add_postures(stream: Stream, result: Any, name: str) -> None:
    """The postures found for a cutter."""
    tilt, lean = tilt_and_lean(result.samples, result.reaches[name])
    stream.add(f"tilt.{name}", tilt)
    stream.add(f"lean.{name}", lean)


def add_scalars(stream: Stream, result: Any) -> list[dict[str, Any]]:
    """Values at samples, and what the page is told of them."""
    found = [
        _scalar(
            "curvature_max", "largest curvature", "1/mm", result.samples.curvature[:, 0], "sample.curvature", column=0
        ),
        _scalar(
            "curvature_min", "smallest curvature", "1/mm", result.samples.curvature[:, 1], "sample.curvature", column=1
        ),
    ]
    for each in result.answers.radius_maps:
        key = f"largest_{each.shape}"
        stream.add(f"scalar.{key}", halves(each.radius))
        found.append(_scalar(key, f"largest {each.shape} end that reaches", "mm radius", each.radius, f"scalar.{key}"))
    for name, each in result.answers.stick_outs.items():
        if each.each is not None:
            key = f"stick_out.{name}"
            stream.add(f"scalar.{key}", halves(each.each))
            found.append(_scalar(key, f"least stick-out of {name}", "mm", each.each, f"scalar.{key}", name))
    return found


def _scalar(
    key: str, label: str, unit: str, values: Floats, array: str, cutter: str | None = None, *, column: int | None = None
) -> dict[str, Any]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (None, None)
    return {"key": key, "label": label, "unit": unit, "cutter": cutter, "low": low, "high": high, "array": array,
            "column": column}  # fmt: skip


def add_maps(stream: Stream, maps: Any, rows: NDArray[np.int64], of: NDArray[np.int64]) -> None:
    """Some posture maps."""
    found = stored(maps, rows, of)
    for word in found._fields:
        stream.add(f"maps.{word}", getattr(found, word))


def facts(
    result: Any,
    surface: Surface,
    atlas: Atlas,
    box: tuple[Floats, Floats],
    spots: list[Spot],
    words: list[str],
    drawn_chord: float,
) -> dict[str, Any]:
    """What the page is told beside arrays; `words`: a text for each spot."""
    plan, effective, fixtures = result.plan, result.plan.effective, result.scene.around.fixtures
    low, high = box
    return {
        "format": FORMAT,
        "part": {
            "file": plan.part.file, "sha256": plan.part.sha256, "size_mm": list(plan.part.size_mm),
            "low": low.tolist(), "high": high.tolist(),
        },
        "setup": {"z": list(effective.setup), "x": effective.placement and effective.placement.x},
        "machine": plan.machine.name,
        "tolerance_mm": effective.tolerance_mm,
        "shown": result.shown,
        "selected": plan.selected,
        "reasons": plan.reasons,
        "verdicts": {str(code): word for code, word in WORDS.items()},
        "colours": plan.legend,
        "rotation_deg": np.degrees(result.postures.rotations).round(6).tolist(),
        "tilt_deg": list(degrees(result.postures.tilt)),
        "tilt_limit_deg": plan.machine.tilt_limit_deg,
        "rotary": plan.machine.rotary is not None,
        "drawn_chord_mm": drawn_chord,
        "atlas": [atlas.index.shape[1], atlas.index.shape[0]],
        "faces": [
            {
                "number": int(f.id[1:]), "id": f.id, "name": f.name, "component": f.component, "surface": f.surface,
                "target": f.target, "ignored": f.ignored, "area_mm2": f.area_mm2,
                "start": surface.faces.get(int(f.id[1:]), (0, 0))[0], "count": surface.faces.get(int(f.id[1:]), (0, 0))[1],
            }
            for f in plan.faces
        ],
        "fixtures": [
            {"name": each.name, "start": surface.fixtures[i][0], "count": surface.fixtures[i][1]}
            for i, each in enumerate(fixtures)
        ],
        "cutters": [_cutter(result, entry) for entry in plan.cutters],
        "spots": [_spot(spot, text) for spot, text in zip(spots, words, strict=True)],
    }  # fmt: skip


def _cutter(result: Any, entry: Any) -> dict[str, Any]:
    cutter, reach = result.tools[entry.id], result.reaches[entry.id]
    return {
        "id": entry.id,
        "name": entry.name or entry.id,
        "feasible": entry.feasible,
        "radius": entry.radius,
        "corner_radius": entry.corner_radius,
        "allowance_mm": entry.allowance_mm,
        "clearance_mm": entry.clearance_mm,
        "touches_deg": [list(each) for each in entry.touches_deg],
        "modes": [
            {"offset": mode.offset, "radius": mode.radius, "height": mode.height,
             "tilt_low_deg": degrees((mode.low, mode.high))[0], "tilt_high_deg": degrees((mode.low, mode.high))[1]}
            for mode in modes(cutter)
        ],
        "outline": _outline(cutter),
        "shares": shares(result, reach),
        "counts": counts(reach.verdict),
        "by_reason": {name: n for name, n in entry.by_reason.items() if n},
        "undecided_by_reason": {name: n for name, n in entry.undecided_by_reason.items() if n},
    }  # fmt: skip


def _outline(cutter: Any) -> list[dict[str, Any]]:
    whole = outline(cutter)
    found = []
    for part in whole.parts:
        segments = whole.of(part)
        line = points(Outline(segments), _CHORD)
        line[0] = segments[0].start
        found.append({"part": part, "points": line.round(4).tolist()})
    return found


def _spot(spot: Spot, text: str) -> dict[str, Any]:
    w, best = spot.witness, spot.witness.best_posture
    return {
        "cutter": spot.cutter,
        "sample": spot.sample,
        "face": w.face,
        "reason": w.reason,
        "point": list(w.point),
        "obstacle_face": w.obstacle_face,
        "obstacle_point": w.obstacle_point and list(w.obstacle_point),
        "depth_mm": w.depth_mm,
        "tilt_deg": best and best.tilt,
        "lean_deg": best and best.rotation,
        "axis": best and list(best.axis),
        "text": text,
    }


def part_name(result: Any) -> str:
    """How the part is called."""
    return Path(result.part.file).name if result.part.file else "part"
