"""The bench on which tools are put down: exact surfaces of the part and of each setup's fixtures, tools and machine."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.checker.clash import FREE, MET, Clock, lowest, met, nearest
from plan_cutters.checker.fixtures import PlacedFixture, rotation_of
from plan_cutters.checker.question import Question, frame_of
from plan_cutters.checker.surface import Cells, Face
from plan_cutters.checker.tool import FLAT, Tool, tool_of

Rows = NDArray[np.int64]
#: Shares of the tolerance: what may be missed; what a posture that counts as blocked is at least too deep by, below the flutes'
#: tolerance and, above them, nearer than the clearance. A search may refuse what lies between, for its triangles are not exact.
_GRAIN, _DEEP, _NEAR = 0.05, 0.25, 0.6
#: Sides of a flat bottom that may touch where the axis is the normal.
_SIDES = 36
_END = 1e-9


class Bench:
    """Puts tools down at samples.

    Parameters
    ----------
    question : Question
    tell : callable
        Told what is done.
    """

    def __init__(self, question: Question, tell: Callable[[str], None]) -> None:
        self.question, samples = question, question.samples
        self.point, self.normal = samples["point"], samples["normal"]
        self.tools: dict[str, Tool] = {name: tool_of(sizes) for name, sizes in question.tools.items()}
        effective = question.document["effective"]
        self._tilt = np.radians(effective["tilt_deg"])
        self._rotation = np.radians(effective["rotation_deg"])
        self.cells = Cells()
        part, tell_ = question.part, tell
        tell_("opening the surfaces of the part")
        faces = [
            Face(part, face.number, f"F{face.number}")
            for face in part.faces
            if face.number not in question.ignored and part.trim(face.number) is not None
        ]
        #: Faces that are not among the surfaces: nothing is known of what they are in the way of.
        self.unread = [
            f"F{face.number}" for face in part.faces if face.number not in question.ignored and part.trim(face.number) is None
        ]
        #: Fixtures of which is not known whether a point lies within.
        self.hollow: list[str] = []
        own = self.cells.add(faces)
        low, high = self.cells.point[own] - self.cells.slack[own], self.cells.point[own] + self.cells.slack[own]
        self.standing: list[list[PlacedFixture]] = []
        self.root: list[int] = []
        for setup in question.setups:
            placed = []
            for body in setup.fixtures:
                if body.kind == "table" and not body.sizes:
                    frame = np.eye(3) if any(body.placement[3:]) else frame_of(setup)
                    body = replace(body, sizes=(lowest(self.cells, own, rotation_of(body) @ frame[2], self.grain),))
                placed.append(PlacedFixture(body, setup, low, high))
                self.hollow += [] if placed[-1].known else [placed[-1].name]
            self.standing.append(placed)
            groups = [own, *(self.cells.add(each.sources) for each in placed)]
            self.root.append(self.cells.joined(groups) if len(groups) > 1 else own)

    @property
    def grain(self) -> float:
        """Give the depth beyond what is allowed that may be missed, mm."""
        return _GRAIN * self.question.tolerance

    def stands(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, tilt_direction: Floats, clock: Clock, *, surely: bool = True,
        tell: Callable[[int], None] = lambda done: None,
    ) -> NDArray[np.int8]:  # fmt: skip
        """Whether a tool stands free at samples (m,) with axes and leans (m, 3): `FREE`, `MET` or `OPEN`.

        `surely`: free with nothing deeper than the tolerance; else also what a search may refuse as not proved is `MET`.
        """
        verdicts, _ = self.looked(setup, tool, rows, axis, tilt_direction, clock, surely=surely, tell=tell)
        return verdicts

    def looked(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, tilt_direction: Floats, clock: Clock, *, surely: bool = True,
        tell: Callable[[int], None] = lambda done: None, contact: tuple[Floats, Floats] | None = None,
    ) -> tuple[NDArray[np.int8], list[str]]:  # fmt: skip
        """The same, with words for the first few that are not free; `contact`: points and normals in the place of samples."""
        tolerance, words = self.question.tolerance, list[str]()
        verdict = np.full(len(rows), MET, np.int8)
        point, normal = (self.point[rows], self.normal[rows]) if contact is None else contact
        tip = tool.tips(point, normal, axis, tilt_direction)
        able = np.isfinite(tip).all(axis=1) & self._can_tilt(rows, normal, axis)
        able &= ~np.isin(self.question.samples["face"][rows], [*self.question.setups[setup].clamped])
        for each in self.standing[setup]:
            # What is in the way at no place of its surface may still hold all of the tool.
            able &= ~each.holds(np.where(able[:, None], tip + tool.high * axis, 0.0))
        if len(bad := np.flatnonzero(~able)):
            words.append(
                f"sample {rows[bad[0]]}: the tool cannot touch there at that tilt, the face is clamped, or a fixture is there"
            )
        mine = np.flatnonzero(able)
        flutes, rest = (1.0, 0.0) if surely else (_DEEP, -_NEAR)
        limits = flutes * tolerance - tool.allowance, rest * tolerance - tool.clearance
        hits = met(self.cells, self.root[setup], tool, tip[mine], axis[mine], limits, self.grain, clock, tell)
        verdict[mine] = hits.verdict
        for k in np.flatnonzero(hits.verdict == MET)[:3].tolist():
            solid = tool.solids[hits.solid[k]]
            where = self.cells.sources[self.cells.source[hits.cell[k]]].name
            words.append(f"sample {rows[mine[k]]}: {where} is {hits.depth[k]:.4g} mm deep in the {solid.part}")
        return verdict, words

    def serves(self, setup: int, tool: Tool, rows: Rows, axis: Floats, clock: Clock, *, surely: bool) -> NDArray[np.int8]:
        """The same for a fixed axis at samples (m,), (m, 3): where the axis is the normal, with any side of the bottom."""
        normal = self.normal[rows]
        tilt_direction = self.own_tilt_direction(rows, axis)
        verdict = self.stands(setup, tool, rows, axis, tilt_direction, clock, surely=surely)
        upright = np.linalg.norm(np.cross(normal, axis), axis=1) <= FLAT
        for k in np.flatnonzero(upright & (verdict != FREE)).tolist():
            first = self.question.samples["direction_max"][rows[k]]
            first = first - (first @ axis[k]) * axis[k]
            first = first / max(float(np.linalg.norm(first)), 1e-300)
            turn = 2.0 * math.pi / _SIDES * np.arange(_SIDES)[:, None]
            about = np.cos(turn) * first + np.sin(turn) * np.cross(axis[k], first)
            every = self.stands(
                setup, tool, np.full(_SIDES, rows[k]), np.repeat(axis[k][None], _SIDES, axis=0), about, clock, surely=surely
            )
            verdict[k] = FREE if (every == FREE).any() else max(every)
        return verdict

    def own_tilt_direction(self, rows: Rows, axis: Floats) -> Floats:
        """Unit directions (m, 3) to which axes lean from the normals; that of the larger curvature where they do not."""
        normal = self.normal[rows]
        across = axis - (normal * axis).sum(axis=1)[:, None] * normal
        size = np.linalg.norm(across, axis=1)[:, None]
        return np.where(size > 1e-12, across / np.maximum(size, 1e-300), self.question.samples["direction_max"][rows])

    def clearance(
        self, setup: int, tool: Tool, contact: tuple[Floats, Floats], axis: Floats, tilt_direction: Floats, beyond: float,
        clock: Clock,
    ) -> tuple[float, str] | None:  # fmt: skip
        """The least distance of what does not cut from anything, mm, at contacts, points and normals (m, 3), and which part
        comes nearest.
        """
        tip = tool.tips(*contact, axis, tilt_direction)
        return nearest(self.cells, self.root[setup], tool.above(2.0 * tool.radius), tip, axis, beyond, self.grain, clock)

    def named(self, index: int) -> Tool:
        """The tool of an index into the plan's cutters."""
        cutters: Any = self.question.document["cutters"]
        return self.tools[cutters[index]["id"]]

    def _can_tilt(self, rows: Rows, normal: Floats, axis: Floats) -> NDArray[np.bool_]:
        """Which axes (m, 3) lean from normals (m, 3) by tilts and towards rotations that the plan allows."""
        first = self.question.samples["direction_max"][rows]
        cosine = (normal * axis).sum(axis=1)
        across = axis - cosine[:, None] * normal
        tilt = np.arctan2(np.linalg.norm(across, axis=1), cosine)
        able = (tilt >= self._tilt[0] - _END) & (tilt <= self._tilt[1] + _END)
        low, high = self._rotation
        if high - low < 2.0 * math.pi - _END:
            turn = np.arctan2((across * np.cross(normal, first)).sum(axis=1), (across * first).sum(axis=1))
            able &= (np.remainder(turn - low + _END, 2.0 * math.pi) <= high - low + 2.0 * _END) | (tilt < _END)
        return np.asarray(able)
