"""trimesh: points of the tool's skin, shrunk by the tolerance, and whether the part's mesh contains one."""

from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.meshes import frames, outlines, part_mesh
from conformance.programs.protocol import UNDECIDED, Words, answered, below_table, beyond_limit, within_boxes
from conformance.suite import Held, Part
from conformance.tool import Floats, Tool

#: Points that are asked about together.
_BLOCK = 400_000


class Program:
    """Blocked where the mesh contains a point of the tool's skin, else safe; undecided where the mesh is not closed."""

    name = "trimesh"
    libraries: tuple[str, ...] = ("trimesh", "embreex", "rtree", "cadquery-ocp", "numpy")

    def __init__(self, chord: float = 0.005, angle: float = 0.1, tolerance: float = 0.01, pitch: float = 1.0) -> None:
        self.settings: dict[str, Any] = {
            "part_chord_error_mm": chord,
            "part_angle_rad": angle,
            "tool_shrunk_by_mm": tolerance,
            "pitch_mm": pitch,
            "query": "Trimesh.contains (rays, by embreex)",
            "boxes": "points within",
            "table": "the tool's lowest point",
        }
        self.why: Counter[str] = Counter()
        self._parts: dict[str, Any] = {}

    def prepare(self, part: Part) -> None:
        """Mesh the part."""
        import trimesh

        mesh = part_mesh(part.path, self.settings["part_chord_error_mm"], self.settings["part_angle_rad"])
        self._parts[part.name] = trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return safe or blocked."""
        mesh, tolerance = self._parts[part.name], self.settings["tool_shrunk_by_mm"]
        blocked = beyond_limit(setup, postures.axis) | below_table(tool, setup, postures.axis, postures.tip, tolerance)
        if not mesh.is_watertight:
            self.why["the mesh of the part is not closed"] += int((~blocked).sum())
            return np.where(blocked, answered(blocked), UNDECIDED)
        skin = _skin(tool, tolerance, self.settings["pitch_mm"])
        turns = frames(postures.axis)
        low, high = mesh.bounds
        step = max(1, _BLOCK // len(skin))
        for i in range(0, len(postures), step):
            rows = slice(i, i + step)
            points = np.einsum("nij,kj->nki", turns[rows], skin) + postures.tip[rows, None]
            blocked[rows] |= within_boxes(setup, points, 0.0).any(axis=1)
            near = np.all((points > low) & (points < high), axis=-1) & ~blocked[rows, None]
            inside = np.zeros(near.shape, bool)
            if near.any():
                inside[near] = mesh.contains(points[near])
            blocked[rows] |= inside.any(axis=1)
        return answered(np.asarray(blocked))


def _skin(tool: Tool, shrunk: float, pitch: float) -> Floats:
    """Return points (k, 3) of the skin of each piece in the frame of the tool, about `pitch` (mm) apart."""
    points = []
    for line in outlines(tool, shrunk, 0.005):
        for (h0, r0), (h1, r1) in pairwise(line):
            for t in np.linspace(0.0, 1.0, max(2, int(np.ceil(np.hypot(h1 - h0, r1 - r0) / pitch)) + 1)):
                h, r = h0 + t * (h1 - h0), r0 + t * (r1 - r0)
                turn = np.linspace(0, 2 * np.pi, max(1, int(np.ceil(2 * np.pi * r / pitch))), endpoint=False)
                points.append(np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(len(turn), h)]))
    return np.unique(np.round(np.vstack(points), 6), axis=0)
