"""plan-cutters with postures of its own: those that plans name, and those that its posture maps call free or blocked."""

from collections import Counter
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.plan_cutters import cutter_of, fixtures_of, machine_of
from conformance.programs.protocol import BLOCKED, SAFE, claimed
from conformance.suite import Part
from conformance.tool import Floats, Tool


class _Planner:
    """A plan of one cutter in one setup."""

    name = ""
    libraries: tuple[str, ...] = ("plan-cutters", "cadquery-ocp-novtk", "numba", "numpy")
    _maps = False

    def __init__(self, tolerance: float = 0.01, spacing: float = 4.0, claims: int = 120) -> None:
        self.settings: dict[str, Any] = {
            "tolerance_mm": tolerance,
            "spacing_mm": spacing,
            "claims_a_tool_and_setup": claims,
            "area_budget": 0,
            "posture_maps": self._maps,
        }
        self.why: Counter[str] = Counter()
        self._parts: dict[str, Any] = {}

    def prepare(self, part: Part) -> None:
        """Read the part."""
        from cad_io import read_part

        self._parts[part.name] = read_part(part.path)

    def claims(self, part: Part, tool: Tool, setup: str) -> Postures:
        """Return postures that the program calls safe or blocked."""
        from plan_cutters import plan
        from plan_cutters.errors import CutterError

        rows: dict[str, list[Any]] = {name: [] for name in ("contact", "normal", "axis", "tip", "verdict")}
        try:
            cutter = cutter_of(tool)
        except (CutterError, ValueError) as error:
            self.why[f"no such cutter: {error}"] += 1
            return claimed(part, tool, setup, rows)
        held = part.setups[setup]
        result = plan(
            self._parts[part.name],
            cutters=[cutter],
            setup=held.axis,
            machine=machine_of(held),
            fixtures=fixtures_of(held),
            tolerance=self.settings["tolerance_mm"],
            spacing=self.settings["spacing_mm"],
            area_budget=0,
            posture_maps=self._maps,
        )
        self._gather(result, tool, held, rows)
        count, most = len(rows["verdict"]), self.settings["claims_a_tool_and_setup"]
        pick = np.unique(np.linspace(0, max(0, count - 1), min(most, count)).astype(int)).tolist()
        return claimed(part, tool, setup, {name: [values[i] for i in pick] for name, values in rows.items()})

    def _gather(self, result: Any, tool: Tool, held: Any, rows: dict[str, list[Any]]) -> None:
        """Add the postures of a plan."""
        (verdicts,) = result.here.values()
        _of_verdicts(result.samples, verdicts, tool, rows)
        if not verdicts.reached.all():
            self.why["samples without a posture"] += int((~verdicts.reached).sum())


class Plans(_Planner):
    """The posture that a plan names at each sample that it reaches."""

    name = "plan-cutters-plans"


class Maps(_Planner):
    """Tilts of posture maps: just within the ends of a free interval, and just beyond where nothing is undecided."""

    name = "plan-cutters-maps"
    _maps = True
    #: How far (rad) within and beyond the ends.
    _INSIDE, _BEYOND = 1e-6, 2e-3

    def _gather(self, result: Any, tool: Tool, held: Any, rows: dict[str, list[Any]]) -> None:
        """Add the postures of maps."""
        maps = result.maps
        if maps is None:
            self.why["no maps"] += 1
            return
        if held.limit_deg is not None:
            # Maps are without limit: they claim nothing of this machine.
            self.why["maps claim nothing of a limit"] += 1
            return
        turns, points = len(maps.rotations), result.samples.point
        offset = maps.offset
        some = np.flatnonzero(np.diff(offset) > 0)
        rng = np.random.default_rng(0)
        for k in rng.permutation(some)[: self.settings["claims_a_tool_and_setup"]].tolist():
            i, j = divmod(k, turns)
            normal, across = maps.normal[i], maps.direction_max[i]
            f = np.cos(maps.rotations[j]) * across + np.sin(maps.rotations[j]) * np.cross(normal, across)
            intervals = maps.free[offset[k] : offset[k + 1]]
            for low, high in intervals.tolist():
                if high - low < 1e-4:
                    continue
                _add(rows, tool, points[i], normal, f, low + self._INSIDE, SAFE)
                _add(rows, tool, points[i], normal, f, high - self._INSIDE, SAFE)
            if maps.undecided[i, j] == 0 and len(intervals) == 1 and intervals[0, 1] + self._BEYOND < maps.tilt[1]:
                _add(rows, tool, points[i], normal, f, float(intervals[0, 1]) + self._BEYOND, BLOCKED)


def _of_verdicts(samples: Any, verdicts: Any, tool: Tool, rows: dict[str, list[Any]]) -> None:
    """Add the posture of each sample that is reached."""
    for i in np.flatnonzero(verdicts.reached).tolist():
        contact, normal, axis = samples.point[i], samples.normal[i], verdicts.axis[i]
        if verdicts.tilt[i] < 1e-9:
            # Upright, the direction goes from the axis to the contact; shorter than 1, the contact lies under the flat.
            tip = contact - tool.flat_radius * np.nan_to_num(verdicts.tilt_direction[i])
        else:
            tip = tool.stands(contact[None], normal[None], axis[None])[0]
        _append(rows, contact, normal, axis, tip, SAFE)


def _add(rows: dict[str, list[Any]], tool: Tool, contact: Floats, normal: Floats, f: Floats, tilt: float, word: str) -> None:
    axis = np.cos(tilt) * normal + np.sin(tilt) * f
    _append(rows, contact, normal, axis, tool.stands(contact[None], normal[None], axis[None], f[None])[0], word)


def _append(rows: dict[str, list[Any]], contact: Floats, normal: Floats, axis: Floats, tip: Floats, word: str) -> None:
    for name, value in (("contact", contact), ("normal", normal), ("axis", axis), ("tip", tip), ("verdict", word)):
        rows[name].append(value)
