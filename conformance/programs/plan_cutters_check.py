"""The checker of plan-cutters, which shares nothing with its search: whether a tool stands free among the exact surfaces."""

import math
from collections import Counter
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.plan_cutters import cutter_of, fixtures_of
from conformance.programs.protocol import BLOCKED, SAFE, UNDECIDED, Words, beyond_limit
from conformance.suite import Held, Part
from conformance.tool import Tool

#: What may be missed, as a share of the tolerance: that of the checker.
_GRAIN = 0.05


class Program:
    """Safe where no point of the surface is deeper in the tool than the tolerance, by branch and bound over cells of it."""

    name = "plan-cutters-check"
    libraries: tuple[str, ...] = ("plan-cutters", "cadquery-ocp-novtk", "numpy")

    def __init__(self, tolerance: float = 0.01) -> None:
        self.settings: dict[str, Any] = {"tolerance_mm": tolerance, "grain_mm": _GRAIN * tolerance}
        self.why: Counter[str] = Counter()
        self._parts: dict[str, Any] = {}
        self._standing: dict[tuple[str, Held], Any] = {}

    def prepare(self, part: Part) -> None:
        """Read the part."""
        from cad_io import read_part

        self._parts[part.name] = read_part(part.path)

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return words; a tool that no cutter is like leaves all undecided."""
        from plan_cutters.errors import CutterError
        from plan_cutters_check.asking import sizes_of
        from plan_cutters_check.surface import FREE, MET, Clock, met
        from plan_cutters_check.tool import tool_of

        try:
            solids = tool_of(sizes_of(cutter_of(tool)))
        except (CutterError, ValueError) as error:
            self.why[f"no such cutter: {error}"] += len(postures)
            return np.full(len(postures), UNDECIDED)
        cells, root, fixtures = self._surfaces(part, setup)
        limit = self.settings["tolerance_mm"]
        found = met(cells, root, solids, postures.tip, postures.axis, (limit, limit), self.settings["grain_mm"], Clock(math.inf))
        blocked = (found.verdict == MET) | beyond_limit(setup, postures.axis)
        for each in fixtures:
            blocked |= each.holds(postures.tip + solids.high * postures.axis)
        return np.where(blocked, BLOCKED, np.where(found.verdict == FREE, SAFE, UNDECIDED))

    def _surfaces(self, part: Part, setup: Held) -> Any:
        """Return the cells of a part and the fixtures of a setup, the group of all of them, and the fixtures; made once."""
        from plan_cutters_check.asking import bodies_of
        from plan_cutters_check.fixtures import PlacedFixture
        from plan_cutters_check.question import Setup
        from plan_cutters_check.surface import Cells, Face

        if (part.name, setup) not in self._standing:
            read, cells = self._parts[part.name], Cells()
            own = cells.add([Face(read, face.number, f"F{face.number}") for face in read.faces])
            low, high = cells.point[own] - cells.slack[own], cells.point[own] + cells.slack[own]
            bodies = [body for each in fixtures_of(setup) for body in bodies_of(each)]
            placed = [PlacedFixture(body, Setup(setup.axis, None, None, (), frozenset()), low, high) for body in bodies]
            groups = [own, *(cells.add(each.sources) for each in placed)]
            self._standing[part.name, setup] = cells, cells.joined(groups), placed
        return self._standing[part.name, setup]
