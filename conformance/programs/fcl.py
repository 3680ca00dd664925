"""python-fcl: the mesh of the tool, shrunk by the tolerance, against the mesh of the part."""

from collections import Counter
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.meshes import Mesh, fixture_meshes, frames, outlines, part_mesh, segments, turned
from conformance.programs.protocol import Words, answered, beyond_limit
from conformance.suite import Held, Part
from conformance.tool import Tool


class Program:
    """Blocked where the meshes of tool and part, box or table meet, else safe."""

    name = "fcl"
    libraries: tuple[str, ...] = ("python-fcl", "cadquery-ocp", "numpy")

    def __init__(self, chord: float = 0.005, angle: float = 0.1, tolerance: float = 0.01) -> None:
        self.settings: dict[str, Any] = {
            "part_chord_error_mm": chord,
            "part_angle_rad": angle,
            "tool_chord_error_mm": chord,
            "tool_shrunk_by_mm": tolerance,
            "query": "BVHModel against BVHModel, collide, one contact",
            "table": "a block of 4 m",
        }
        self.why: Counter[str] = Counter()
        self._parts: dict[str, Any] = {}

    def prepare(self, part: Part) -> None:
        """Mesh the part and build its tree."""
        self._parts[part.name] = _model(part_mesh(part.path, self.settings["part_chord_error_mm"], self.settings["part_angle_rad"]))

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return safe or blocked."""
        import fcl

        chord = self.settings["tool_chord_error_mm"]
        sides = segments(tool, chord)
        pieces = [_model(turned(line, sides)) for line in outlines(tool, self.settings["tool_shrunk_by_mm"], chord)]
        obstacles = [fcl.CollisionObject(self._parts[part.name]), *(fcl.CollisionObject(_model(mesh)) for mesh in fixture_meshes(setup))]
        movers = [fcl.CollisionObject(piece) for piece in pieces]
        blocked = beyond_limit(setup, postures.axis)
        request = fcl.CollisionRequest()
        for i, turn in enumerate(frames(postures.axis)):
            place = fcl.Transform(turn, postures.tip[i])
            for mover in movers:
                mover.setTransform(place)
            blocked[i] |= any(fcl.collide(mover, obstacle, request, fcl.CollisionResult()) for mover in movers for obstacle in obstacles)
        return answered(np.asarray(blocked))


def _model(mesh: Mesh) -> Any:
    import fcl

    model = fcl.BVHModel()
    model.beginModel(len(mesh.vertices), len(mesh.faces))
    model.addSubModel(mesh.vertices, mesh.faces)
    model.endModel()
    return model
