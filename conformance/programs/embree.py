"""embreex: rays along the outline of the tool, at many angles about its axis, against the mesh of the part."""

from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.meshes import Mesh, fixture_meshes, frames, outlines, part_mesh
from conformance.programs.protocol import Words, answered, beyond_limit
from conformance.suite import Held, Part
from conformance.tool import Floats, Tool

#: Rays that are cast together.
_BLOCK = 1_000_000


class Program:
    """Blocked where a ray along the outline, shrunk by the tolerance, hits a triangle before its end; else safe."""

    name = "embree"
    libraries: tuple[str, ...] = ("embreex", "cadquery-ocp", "numpy")

    def __init__(self, chord: float = 0.005, angle: float = 0.1, tolerance: float = 0.01, lines: int = 72) -> None:
        self.settings: dict[str, Any] = {
            "part_chord_error_mm": chord,
            "part_angle_rad": angle,
            "tool_chord_error_mm": chord,
            "tool_shrunk_by_mm": tolerance,
            "lines_about_the_axis": lines,
            "rays": "both ways along each side of the outline, and across the bottom",
            "precision": "single",
        }
        self.why: Counter[str] = Counter()
        self._parts: dict[str, Mesh] = {}

    def prepare(self, part: Part) -> None:
        """Mesh the part."""
        self._parts[part.name] = part_mesh(part.path, self.settings["part_chord_error_mm"], self.settings["part_angle_rad"])

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return safe or blocked."""
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        whole = Mesh.joined([self._parts[part.name], *fixture_meshes(setup)])
        # Single precision: the numbers are small about the middle of the part.
        middle = whole.vertices.mean(axis=0)
        scene = EmbreeScene()
        TriangleMesh(scene, (whole.vertices - middle)[whole.faces].astype(np.float32))
        start, end = _rays(tool, self.settings)
        length = np.linalg.norm(end - start, axis=1)
        way = (end - start) / length[:, None]
        blocked = beyond_limit(setup, postures.axis)
        step = max(1, _BLOCK // len(start))
        turns = frames(postures.axis)
        for i in range(0, len(postures), step):
            rows = slice(i, i + step)
            origin = np.einsum("nij,kj->nki", turns[rows], start) + (postures.tip[rows] - middle)[:, None]
            direction = np.einsum("nij,kj->nki", turns[rows], way)
            reach = scene.run(origin.reshape(-1, 3).astype(np.float32), direction.reshape(-1, 3).astype(np.float32), query="DISTANCE")
            blocked[rows] |= np.any(reach.reshape(-1, len(start)) < length, axis=1)
        return answered(np.asarray(blocked))


def _rays(tool: Tool, settings: dict[str, Any]) -> tuple[Floats, Floats]:
    """Return begins and ends (k, 3) of rays in the frame of the tool."""
    turn = 2 * np.pi * np.arange(settings["lines_about_the_axis"]) / settings["lines_about_the_axis"]
    begins, ends = [], []
    for line in outlines(tool, settings["tool_shrunk_by_mm"], settings["tool_chord_error_mm"]):
        for (h0, r0), (h1, r1) in pairwise(line):
            a, b = (np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(len(turn), h)]) for h, r in ((h0, r0), (h1, r1)))
            begins += [a, b]
            ends += [b, a]
    return np.vstack(begins), np.vstack(ends)
