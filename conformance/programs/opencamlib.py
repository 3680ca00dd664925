"""opencamlib: a cutter is dropped along the setup's axis onto the mesh of the part. Three axes alone."""

from collections import Counter
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.meshes import Mesh, fixture_meshes, part_mesh
from conformance.programs.protocol import BLOCKED, SAFE, UNDECIDED, Words, beyond_limit
from conformance.suite import Held, Part
from conformance.tool import Tool

#: An axis is that of the setup within this angle, rad.
_SAME = 1e-6


class Program:
    """Blocked where the tip lies below the drop height by more than the tolerance; undecided off the setup's axis."""

    name = "opencamlib"
    libraries: tuple[str, ...] = ("opencamlib", "cadquery-ocp", "numpy")

    def __init__(self, chord: float = 0.005, angle: float = 0.1, tolerance: float = 0.01) -> None:
        self.settings: dict[str, Any] = {"part_chord_error_mm": chord, "part_angle_rad": angle, "tolerance_mm": tolerance, "query": "BatchDropCutter"}
        self.why: Counter[str] = Counter()
        self._parts: dict[str, Mesh] = {}

    def prepare(self, part: Part) -> None:
        """Mesh the part."""
        self._parts[part.name] = part_mesh(part.path, self.settings["part_chord_error_mm"], self.settings["part_angle_rad"])

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return words for postures along the setup's axis, undecided for all others."""
        import opencamlib as ocl

        up = np.array(setup.axis, float) / np.linalg.norm(setup.axis)
        out = np.full(len(postures), UNDECIDED)
        out[beyond_limit(setup, postures.axis)] = BLOCKED
        along = np.flatnonzero((np.linalg.norm(np.cross(postures.axis, up), axis=1) < _SAME) & (postures.axis @ up > 0) & (out == UNDECIDED))
        self.why["the axis is not that of the setup"] += int((out == UNDECIDED).sum()) - len(along)
        cutter = _cutter(tool)
        if not len(along):
            return out
        if cutter is None:
            self.why["its cutters have no such outline"] += len(along)
            return out
        side = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
        side /= np.linalg.norm(side)
        turn = np.array([side, np.cross(up, side), up])
        whole = Mesh.joined([self._parts[part.name], *fixture_meshes(setup)])
        surface = ocl.STLSurf()
        for corners in (whole.vertices @ turn.T)[whole.faces].tolist():
            surface.addTriangle(ocl.Triangle(*(ocl.Point(*corner) for corner in corners)))
        drop = ocl.BatchDropCutter()
        drop.setSTL(surface)
        drop.setCutter(cutter)
        tips = postures.tip[along] @ turn.T
        for x, y, _ in tips.tolist():
            drop.appendPoint(ocl.CLPoint(x, y, -1e4))
        drop.run()
        heights = np.array([point.z for point in drop.getCLPoints()])
        deep = tips[:, 2] < heights - self.settings["tolerance_mm"]
        # A cutter is all that is dropped: a holder stays unseen.
        word = UNDECIDED if tool.holder or tool.cutting is not None else SAFE
        self.why["shank and holder are not dropped"] += 0 if word == SAFE else int((~deep).sum())
        out[along] = np.where(deep, BLOCKED, word)
        return out


def _cutter(tool: Tool) -> Any:
    """Return a flat, ball or bull end as the library has it, or nothing."""
    import opencamlib as ocl

    radius = tool.flat_radius + tool.corner
    top = tool.length if tool.cutting is None else tool.cutting
    if any(v[1] > radius + 1e-9 for v in tool.cutter) or any(abs(v[1] - radius) > 1e-9 for v in tool.cutter[1:] if v[0] <= top):
        return None
    if tool.corner == 0:
        return ocl.CylCutter(2 * radius, tool.length)
    if tool.flat_radius == 0:
        return ocl.BallCutter(2 * radius, tool.length)
    return ocl.BullCutter(2 * radius, tool.corner, tool.length)
