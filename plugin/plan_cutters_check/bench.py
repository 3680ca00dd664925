"""The bench on which tools are put down: exact surfaces of the part and of each setup's fixtures, tools and machine."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives
from cad_io.kernel.shapes import within
from plan_cutters_check.clash import FREE, MET, OPEN, Clock, lowest, met, nearest
from plan_cutters_check.fixtures import PlacedFixture, rotation_of
from plan_cutters_check.places import Places, across, reach_at
from plan_cutters_check.question import Question, frame_of
from plan_cutters_check.surface import Cells, Face
from plan_cutters_check.tool import FLAT, Tool, tool_of

Rows = NDArray[np.int64]
#: Shares of the tolerance: what may be missed; what a posture that counts as blocked is at least too deep by, below the flutes'
#: tolerance and, above them, nearer than the clearance. A search may refuse what lies between, for its triangles are not exact.
_GRAIN, _DEEP, _NEAR = 0.05, 0.25, 0.6
#: Places of an upright tool that are tried at a contact, and the accuracy of the axes where none is written, deg.
_TRIED, _ACCURACY = 120, 0.05
#: How far from a place in the material the next one is tried, as a share of the flat.
_STEP = 0.1
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
        #: Of the rotary axes, rad: what is off by no more is upright, or along a wall.
        self.accuracy = max(FLAT, math.radians(effective.get("axis_accuracy_deg", _ACCURACY)))
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
        wanted, limit = self.question.asked, self.question.tolerance
        return _GRAIN * (min(wanted, limit) if wanted > 0.0 else limit)

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
        tolerance: float | None = None,
    ) -> tuple[NDArray[np.int8], list[str]]:  # fmt: skip
        """The same, with words for the first few that are not free; `contact`: points and normals in the place of samples,
        `tolerance`: another one than the plan keeps, mm.
        """
        words = list[str]()
        verdict = np.full(len(rows), MET, np.int8)
        tip, able = self._tips(setup, tool, rows, self._at(rows) if contact is None else contact, axis, tilt_direction)
        for each in self.standing[setup]:
            # What is in the way at no place of its surface may still hold all of the tool.
            able &= ~each.holds(np.where(able[:, None], tip + tool.high * axis, 0.0))
        if len(bad := np.flatnonzero(~able)):
            words.append(
                f"sample {rows[bad[0]]}: the tool cannot touch there at that tilt, the face is clamped, or a fixture is there"
            )
        mine = np.flatnonzero(able)
        limits = self._limits(tool, surely=surely, tolerance=tolerance)
        hits = met(self.cells, self.root[setup], tool, tip[mine], axis[mine], limits, self.grain, clock, tell)
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
            ways = [np.array(way) for way in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1))]
            close[mine] = ~np.logical_and.reduce([trim.inside(*(uv + by * way).T) for way in ways])
        return close

    def _in_material(self, tool: Tool, tip: Floats, axis: Floats) -> NDArray[np.bool_]:
        """Which tools (m,) that meet nothing stand in the material, by a point on their axes in the flutes."""
        if self.question.ignored or not len(tip):
            return np.zeros(len(tip), bool)
        return within(self.question.part.solid_shapes(), tip + 0.5 * tool.solids[0].high * axis)

    def _at(self, rows: Rows) -> tuple[Floats, Floats]:
        return self.point[rows], self.normal[rows]

    def _tips(
        self, setup: int, tool: Tool, rows: Rows, contact: tuple[Floats, Floats], axis: Floats, tilt_direction: Floats
    ) -> tuple[Floats, NDArray[np.bool_]]:
        """Tips (m, 3) of a tool at contacts of samples (m,), and where it can stand there, whatever is in the way."""
        tip = tool.tips(*contact, axis, tilt_direction, self.accuracy, self.question.tolerance)
        able = np.isfinite(tip).all(axis=1) & self._can_tilt(tool, rows, contact[1], axis, tilt_direction)
        return tip, able & ~np.isin(self.question.samples["face"][rows], [*self.question.setups[setup].clamped])

    def _limits(self, tool: Tool, *, surely: bool, tolerance: float | None = None) -> tuple[float, float]:
        flutes, rest = (1.0, 0.0) if surely else (_DEEP, -_NEAR)
        limit = self.question.tolerance if tolerance is None else tolerance
        return flutes * limit - tool.allowance, rest * limit - tool.clearance

    def put_down(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, tilt_direction: Floats, clock: Clock,
        contact: tuple[Floats, Floats] | None = None,
    ) -> tuple[NDArray[np.int8], int, list[str]]:  # fmt: skip
        """Verdicts on a tool at samples (m,) by the tolerance that was wanted, and words for the first few that are not free.

        What is free by the tolerance that the plan keeps alone is `OPEN`; how many these are is told as well.
        """
        wanted, place = self.question.asked, (setup, tool)
        strict = wanted if 0.0 < wanted < self.question.tolerance else None
        verdict, words = self.looked(*place, rows, axis, tilt_direction, clock, contact=contact, tolerance=strict)
        deep = np.flatnonzero(verdict == MET)
        if strict is None or not len(deep):
            return verdict, 0, words
        at = None if contact is None else (contact[0][deep], contact[1][deep])
        again, words = self.looked(*place, rows[deep], axis[deep], tilt_direction[deep], clock, contact=at)
        verdict[deep] = np.where(again == FREE, OPEN, again)
        return verdict, int((again == FREE).sum()), words

    def serves(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, clock: Clock, *, surely: bool, along: bool = True
    ) -> NDArray[np.int8]:
        """The same for a fixed axis at samples (m,), (m, 3): where it is the normal with the contact anywhere under the flat of
        the tip, and, unless not `along`, along a wall at the distance of the tolerance. `OPEN` also where too many places would
        have to be tried.
        """
        verdict = self.stands(setup, tool, rows, axis, self.own_tilt_direction(rows, axis), clock, surely=surely)
        cosine = (self.normal[rows] * axis).sum(axis=1)
        sine = np.linalg.norm(np.cross(self.normal[rows], axis), axis=1)
        if not surely:
            # A search does not put a tool down at a tilt at which it touches with nothing that cuts, though it be free there.
            verdict[~tool.touches(np.arctan2(sine, cosine))] = MET
        low, high = self._rotation
        if high - low < 2.0 * math.pi - _END:
            return verdict
        # A search may refuse flutes that leave the wall by more than its triangles are sure of.
        most = math.sin(self.accuracy) if surely else min(math.sin(self.accuracy), _DEEP * self.question.tolerance / tool.high)
        walls = np.flatnonzero((verdict != FREE) & (np.abs(cosine) <= most))
        if along and len(walls) and (surely or tool.touches(np.array([0.5 * math.pi]))[0]):
            verdict[walls] = self.stands(setup, tool, rows[walls], axis[walls], 2.0 * axis[walls], clock, surely=surely)
        upright = np.flatnonzero((verdict != FREE) & (np.arctan2(sine, cosine) <= self.accuracy))
        if len(upright) and tool.flat > 0.0:
            verdict[upright] = self._under_flat(setup, tool, rows[upright], axis[upright], clock, surely=surely)
        return verdict

    def _under_flat(self, setup: int, tool: Tool, rows: Rows, axis: Floats, clock: Clock, *, surely: bool) -> NDArray[np.int8]:
        """Whether an upright tool stands free anywhere with a contact under its flat: `FREE`, `MET`, or `OPEN`."""
        first, limits = self.question.samples["direction_max"], self._limits(tool, surely=surely)
        uv = np.array([across(a, first[row]) for a, row in zip(axis, rows.tolist(), strict=True)])
        places = [Places(tool.flat) for _ in rows]
        verdict = np.full(len(rows), OPEN, np.int8)
        for _ in range(_TRIED):
            open_rows = np.flatnonzero(verdict == OPEN)
            if not len(open_rows) or clock.over:
                break
            at = [places[k].best for k in open_rows.tolist()]
            gone = np.array([each is None for each in at])
            verdict[open_rows[gone]] = MET
            some, place = open_rows[~gone], np.array([each for each in at if each is not None]).reshape(-1, 2)
            tilt_direction = -np.einsum("nk,nkx->nx", place, uv[some]) / tool.flat
            # In the middle of the flat no direction is left: a hair beside it.
            tilt_direction[np.linalg.norm(tilt_direction, axis=1) < _END] = _END
            tip, able = self._tips(setup, tool, rows[some], self._at(rows[some]), axis[some], tilt_direction)
            verdict[some[~able]] = MET
            some, place, tip = some[able], place[able], tip[able]
            hits = met(self.cells, self.root[setup], tool, tip, axis[some], limits, self.grain, clock)
            for i, k in enumerate(some.tolist()):
                if hits.verdict[i] == FREE:
                    held = any(each.holds(tip[i : i + 1] + tool.high * axis[k])[0] for each in self.standing[setup])
                    verdict[k] = MET if held else FREE
                    if not held and self.at_border[some[i]] and self._in_material(tool, tip[i : i + 1], axis[k : k + 1])[0]:
                        # Another place may be out of the material.
                        verdict[k] = OPEN
                        places[k].forbid(place[i], _STEP * tool.flat)
                elif hits.verdict[i] == MET:
                    solid = tool.solids[hits.solid[i]]
                    limit = limits[0] if solid.part == "flutes" else limits[1]
                    away = self.cells.point[hits.cell[i]] - tip[i]
                    flat = uv[k] @ away
                    radius = reach_at(solid, float(away @ axis[k]), limit, float(np.linalg.norm(flat)))
                    places[k].forbid(place[i] + flat, radius)
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
        tip = tool.tips(*contact, axis, tilt_direction, self.accuracy, self.question.tolerance)
        return nearest(self.cells, self.root[setup], tool.above(2.0 * tool.radius), tip, axis, beyond, self.grain, clock)

    def named(self, index: int) -> Tool:
        """The tool of an index into the plan's cutters."""
        cutters: Any = self.question.document["cutters"]
        return self.tools[cutters[index]["id"]]

    def _can_tilt(self, tool: Tool, rows: Rows, normal: Floats, axis: Floats, tilt_direction: Floats) -> NDArray[np.bool_]:
        """Which axes (m, 3) lean from normals (m, 3) by tilts and towards rotations that the plan allows."""
        first = self.question.samples["direction_max"][rows]
        cosine = (normal * axis).sum(axis=1)
        leaning = axis - cosine[:, None] * normal
        tilt = np.arctan2(np.linalg.norm(leaning, axis=1), cosine)
        # Upright and along a wall the surface counts as if it were square to the axis, or held it.
        tilt = np.where(tilt <= self.accuracy, np.minimum(tilt, self._tilt[0]), tilt)
        tilt[tool.stands_along(normal, axis, tilt_direction, self.accuracy)] = 0.5 * math.pi
        able = (tilt >= self._tilt[0] - _END) & (tilt <= self._tilt[1] + _END)
        low, high = self._rotation
        if high - low < 2.0 * math.pi - _END:
            turn = np.arctan2((leaning * np.cross(normal, first)).sum(axis=1), (leaning * first).sum(axis=1))
            able &= (np.remainder(turn - low + _END, 2.0 * math.pi) <= high - low + 2.0 * _END) | (tilt < _END)
        return np.asarray(able)
