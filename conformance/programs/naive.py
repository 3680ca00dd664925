"""A naive sampler: points of the surface on a grid of its parameters, and whether one lies in the tool."""

from collections import Counter
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.protocol import Words, answered, below_table, beyond_limit
from conformance.suite import Held, Part
from conformance.tool import Floats, Tool

#: Points and postures that are looked at together.
_BLOCK = 2_000_000


class Program:
    """Blocked where a point of the grid lies deeper in the tool than the tolerance, else safe."""

    name = "naive"
    libraries: tuple[str, ...] = ("cadquery-ocp", "cadquery-ocp-novtk", "numpy")

    def __init__(self, pitch: float = 1.0, tolerance: float = 0.01) -> None:
        self.settings: dict[str, Any] = {"pitch_mm": pitch, "tolerance_mm": tolerance, "edges": "not sampled", "table": "the tool's lowest point"}
        self.why: Counter[str] = Counter()
        self._points: dict[str, Floats] = {}

    def prepare(self, part: Part) -> None:
        """Sample every face at most `pitch_mm` apart, 400 steps a side at most, kept where the trim has the point."""
        from conformance.exact.slow import faces, read

        self._points[part.name] = np.vstack([face.points for face in faces(read(part.path), self.settings["pitch_mm"])])

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return safe or blocked."""
        tolerance, pitch = self.settings["tolerance_mm"], self.settings["pitch_mm"]
        points = np.vstack([self._points[part.name], *(_box_points(np.array(low, float), np.array(high, float), pitch) for low, high in setup.boxes)])
        blocked = beyond_limit(setup, postures.axis) | below_table(tool, setup, postures.axis, postures.tip, tolerance)
        step = max(1, _BLOCK // len(points))
        for i in range(0, len(postures), step):
            rows = slice(i, i + step)
            signed = tool.signed(points[None], postures.tip[rows, None], postures.axis[rows, None])
            blocked[rows] |= np.min(signed, axis=1) < -tolerance
        return answered(blocked)


def _box_points(low: Floats, high: Floats, pitch: float) -> Floats:
    """Return points of the six sides of a box."""
    lines = [np.linspace(a, b, max(2, int(np.ceil((b - a) / pitch)) + 1)) for a, b in zip(low, high, strict=True)]
    sides = []
    for k in range(3):
        first, second = (i for i in range(3) if i != k)
        a, b = (x.ravel() for x in np.meshgrid(lines[first], lines[second]))
        for level in (low[k], high[k]):
            side = np.empty((len(a), 3))
            side[:, first], side[:, second], side[:, k] = a, b, level
            sides.append(side)
    return np.vstack(sides)
