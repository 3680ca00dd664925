"""The bench on which tools are put down: exact surfaces of the part and of each setup's fixtures, tools and machine."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives
from cad_io.kernel.shapes import within
from plan_cutters_check.fixtures import PlacedFixture, foot_of, rotation_of, stock_frame
from plan_cutters_check.question import Question, frame_of
from plan_cutters_check.surface import FREE, MET, OPEN, SIDES, Cells, Clock, Face, lowest, met
from plan_cutters_check.tool import FLAT, Tool, tool_of

Rows = NDArray[np.int64]
#: Share of the tolerance that may be missed, and the accuracy of the axes where none is written, deg.
_GRAIN, _ACCURACY = 0.05, 0.05
_END, _SAME_MM = 1e-9, 1e-5


class Contacts(NamedTuple):
    """Where tools touch: points, unit normals there, and the directions in which the tools lean from these, (m, 3) each."""

    point: Floats
    normal: Floats
    tilt_direction: Floats


class Bench:
    """Puts tools down at samples; `tell` is called with what is done."""

    def __init__(self, question: Question, tell: Callable[[str], None]) -> None:
        self.question, samples, part = question, question.samples, question.part
        self.point, self.normal = samples["point"], samples["normal"]
        self.tools: dict[str, Tool] = {name: tool_of(sizes) for name, sizes in question.tools.items()}
        effective = question.document["effective"]
        self._tilt, self._rotation = np.radians(effective["tilt_deg"]), np.radians(effective["rotation_deg"])
        #: Of the rotary axes, rad: what is off by no more is upright, or along a wall.
        self.accuracy = max(FLAT, math.radians(effective.get("axis_accuracy_deg", _ACCURACY)))
        self._scallop = float(effective.get("scallop_mm") or 0.0)
        self.cells = Cells()
        tell("opening the surfaces of the part")
        names = {face.number: f"F{face.number}" for face in part.faces if face.number not in question.ignored}
        #: Faces that are not among the surfaces: nothing is known of what they are in the way of.
        self.unread = [name for number, name in names.items() if part.trim(number) is None]
        #: Fixtures of which is not known whether a point lies within.
        self.hollow: list[str] = []
        own = self.cells.add([Face(part, number, name) for number, name in names.items() if name not in self.unread])
        low, high = self.cells.point[own] - self.cells.slack[own], self.cells.point[own] + self.cells.slack[own]
        self.standing: list[list[PlacedFixture]] = []
        self.root: list[int] = []
        for setup in question.setups:
            placed = []
            for body in setup.fixtures:
                if body.kind == "table" and not body.sizes:
                    frame = np.eye(3) if any(body.placement[3:]) else frame_of(setup)
                    body = replace(body, sizes=(lowest(self.cells, own, rotation_of(body) @ frame[2], self.grain),))
                elif body.kind == "stock" and body.sizes:
                    ends = [
                        lowest(self.cells, own, way * each, self.grain)
                        for way in (1.0, -1.0)
                        for each in stock_frame(body, setup)
                    ]
                    body = replace(body, sizes=foot_of(body.sizes, np.array(ends[:3]), -np.array(ends[3:])))
                placed.append(PlacedFixture(body, setup, low, high))
                self.hollow += [] if placed[-1].known else [placed[-1].name]
            self.standing.append(placed)
            groups = [own, *(self.cells.add(each.sources) for each in placed)]
            self.root.append(self.cells.joined(groups) if len(groups) > 1 else own)

    @property
    def grain(self) -> float:
        """Give the depth beyond what is allowed that may be missed, mm."""
        wanted, limit = self.question.asked, self.question.tolerance
        return _GRAIN * (min(wanted, limit) if wanted > 0.0 else limit)

    def _looked(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, at: Contacts, clock: Clock, limits: tuple[float, float]
    ) -> tuple[NDArray[np.int8], list[str]]:
        """How a tool stands at contacts of samples (m,): `FREE`, `MET` or `OPEN`; words for the first few that are not free."""
        words, verdict = list[str](), np.full(len(rows), MET, np.int8)
        tip, able = self._tips(setup, tool, rows, axis, at)
        for each in self.standing[setup]:
            # What is in the way at no place of its surface may still hold all of the tool.
            able &= ~each.holds(np.where(able[:, None], tip + tool.high * axis, 0.0))
        if len(bad := np.flatnonzero(~able)):
            words.append(
                f"sample {rows[bad[0]]}: the tool cannot touch there at that tilt, the face is clamped, or a fixture is there"
            )
        mine = np.flatnonzero(able)
        hits = met(self.cells, self.root[setup], tool, tip[mine], axis[mine], limits, self.grain, clock)
        verdict[mine] = hits.verdict
        inside = mine[(hits.verdict == FREE) & self.at_border[rows[mine]]]
        inside = inside[self._in_material(tool, tip[inside], axis[inside])]
        verdict[inside] = MET
        words += [f"sample {rows[k]}: the tool stands wholly within the material" for k in inside[:1].tolist()]
        for k in np.flatnonzero(hits.verdict == MET)[:3].tolist():
            solid = tool.solids[hits.solid[k]]
            where = self.cells.sources[self.cells.source[hits.cell[k]]].name
            words.append(f"sample {rows[mine[k]]}: {where} is {hits.depth[k]:.4g} mm deep in the {solid.part}")
        return verdict, words

    @cached_property
    def at_border(self) -> NDArray[np.bool_]:
        """Samples (n,) at the border of their faces, or off them: only there a tool in the material may meet nothing.

        Elsewhere it touches the outer side of the surface, and lies within only if it crosses that.
        """
        samples, part, close = self.question.samples, self.question.part, np.ones(len(self.point), bool)
        for number in np.unique(samples["face"]).tolist() if "uv" in samples else ():
            mine, trim = np.flatnonzero(samples["face"] == number), part.trim(number)
            if trim is None:
                continue
            uv = samples["uv"][mine]
            d = np.linalg.norm(first_derivatives(part.adaptor(number), *uv.T)[:, 1:], axis=2)
            by = 2.0 * self.question.tolerance / np.maximum(d, 1e-9 * d.max(initial=1e-300))
            close[mine] = ~np.logical_and.reduce([trim.inside(*(uv + by * side).T) for side in SIDES])
        return close

    def _in_material(self, tool: Tool, tip: Floats, axis: Floats) -> NDArray[np.bool_]:
        """Which tools (m,) that meet nothing stand in the material, by a point on their axes in the flutes."""
        if self.question.ignored or not len(tip):
            return np.zeros(len(tip), bool)
        return within(self.question.part.solid_shapes(), tip + 0.5 * tool.solids[0].high * axis)

    def _tips(self, setup: int, tool: Tool, rows: Rows, axis: Floats, at: Contacts) -> tuple[Floats, NDArray[np.bool_]]:
        """Tips (m, 3) of a tool at contacts of samples (m,), and where it can stand there, whatever is in the way."""
        first = self.question.samples["direction_max"][rows]
        tip = tool.tips(at.point, at.normal, axis, at.tilt_direction, self.accuracy, self.question.tolerance)
        cosine = (at.normal * axis).sum(axis=1)
        leaning = axis - cosine[:, None] * at.normal
        tilt = np.arctan2(np.linalg.norm(leaning, axis=1), cosine)
        # Upright and along a wall the surface counts as if it were square to the axis, or held it.
        tilt = np.where(tilt <= self.accuracy, np.minimum(tilt, self._tilt[0]), tilt)
        tilt[tool.stands_along(at.normal, axis, at.tilt_direction, self.accuracy)] = 0.5 * math.pi
        able = np.isfinite(tip).all(axis=1) & (tilt >= self._tilt[0] - _END) & (tilt <= self._tilt[1] + _END)
        low, high = self._rotation
        if high - low < 2.0 * math.pi - _END:
            turn = np.arctan2((leaning * np.cross(at.normal, first)).sum(axis=1), (leaning * first).sum(axis=1))
            able &= (np.remainder(turn - low + _END, 2.0 * math.pi) <= high - low + 2.0 * _END) | (tilt < _END)
        return tip, able & ~np.isin(self.question.samples["face"][rows], [*self.question.setups[setup].clamped])

    def misses(self, tool: Tool, rows: Rows, axis: Floats, at: Contacts) -> NDArray[np.bool_]:
        """Which samples (m,) do not lie on the flutes of a tool put down at contacts, but for the scallop and the allowance."""
        tip = tool.tips(at.point, at.normal, axis, at.tilt_direction, self.accuracy, self.question.tolerance)
        away = self.point[rows] - tip
        height = (away * axis).sum(axis=1)
        wide = np.linalg.norm(away - height[:, None] * axis, axis=1)
        deep = np.max([each.depth(wide, height)[0] for each in tool.solids if each.part == "flutes"], axis=0)
        low = -max(self._scallop, self.question.tolerance) - tool.allowance
        return np.asarray((deep < low - _SAME_MM) | (deep > self.question.tolerance + _SAME_MM))

    def put_down(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, at: Contacts, clock: Clock, clearance: float = 0.0
    ) -> tuple[NDArray[np.int8], int, list[str]]:
        """Verdicts on a tool at contacts of samples (m,) by the tolerance that was wanted, and words for the first few not free.

        `clearance`: what neck, shank and holder must keep from all, where it is more than the tool's own, mm. What is free by the
        tolerance that the plan keeps alone is `OPEN`; how many these are is given as well.
        """
        wanted, keeps = self.question.asked, self.question.tolerance
        strict, rest = 0.0 < wanted < keeps, -max(tool.clearance, clearance - 2.0 * self.grain)
        limits = (wanted if strict else keeps) - tool.allowance, rest
        verdict, words = self._looked(setup, tool, rows, axis, at, clock, limits)
        deep = np.flatnonzero(verdict == MET)
        if not strict or not len(deep):
            return verdict, 0, words
        some = Contacts(*(each[deep] for each in at))
        again, words = self._looked(setup, tool, rows[deep], axis[deep], some, clock, (keeps - tool.allowance, rest))
        verdict[deep] = np.where(again == FREE, OPEN, again)
        return verdict, int((again == FREE).sum()), words

    def own_tilt_direction(self, rows: Rows, axis: Floats) -> Floats:
        """Unit directions (m, 3) to which axes lean from the normals; that of the larger curvature where they do not."""
        normal = self.normal[rows]
        across = axis - (normal * axis).sum(axis=1)[:, None] * normal
        size = np.linalg.norm(across, axis=1)[:, None]
        return np.where(size > 1e-12, across / np.maximum(size, 1e-300), self.question.samples["direction_max"][rows])
