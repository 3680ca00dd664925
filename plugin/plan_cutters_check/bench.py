"""The bench on which tools are put down: exact surfaces of the part and of each setup's fixtures, tools and machine.

An upright tool may stand wherever a contact lies under the flat of its tip: at places (u, v) across the axis, from the contact. A
point of the surface that is too deep in the tool at one place is so at all places that are as near to it: each forbids a disk. Of
the places that remain one is on the rim of the flat or where the borders of two disks cross.
"""

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
from plan_cutters_check.surface import FREE, MET, OPEN, SIDES, Cells, Clock, Face, lowest, met, nearest
from plan_cutters_check.tool import FLAT, Solid, Tool, tool_of

Rows = NDArray[np.int64]
#: Shares of the tolerance: what may be missed; what a posture that counts as blocked is at least too deep by, below the flutes'
#: tolerance and, above them, nearer than the clearance. A search may refuse what lies between, for its triangles are not exact.
_GRAIN, _DEEP, _NEAR = 0.05, 0.25, 0.6
#: Places of an upright tool that are tried at a contact, and the accuracy of the axes where none is written, deg.
_TRIED, _ACCURACY = 120, 0.05
#: How far from a place in the material the next one is tried, as a share of the flat.
_STEP = 0.1
_END = 1e-9
#: Parts of unit axes that differ by less are nearly one: the tool moves by less than a thousandth of a millimetre.
_ONE_AXIS = 1e-5
#: Places on the rim and within it that are looked at first; by how much disks are widened, rounding, mm; halvings of a radius.
_RIM, _RING, _APART, _ROUNDING, _HALVINGS = 36, 12, 1e-5, 1e-9, 50


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

    def stands(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, tilt_direction: Floats, clock: Clock, *, surely: bool = True
    ) -> NDArray[np.int8]:
        """Whether a tool stands free at samples (m,) with axes and leans (m, 3): `FREE`, `MET` or `OPEN`.

        `surely`: free with nothing deeper than the tolerance; else also what a search may refuse as not proved is `MET`.
        """
        at = Contacts(self.point[rows], self.normal[rows], tilt_direction)
        return self._looked(setup, tool, rows, axis, at, clock, self._limits(tool, surely))[0]

    def _looked(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, at: Contacts, clock: Clock, limits: tuple[float, float]
    ) -> tuple[NDArray[np.int8], list[str]]:
        """The same with contacts of their own, and words for the first few that are not free."""
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

    def _limits(self, tool: Tool, surely: bool) -> tuple[float, float]:
        flutes, rest = (1.0, 0.0) if surely else (_DEEP, -_NEAR)
        return flutes * self.question.tolerance - tool.allowance, rest * self.question.tolerance - tool.clearance

    def put_down(
        self, setup: int, tool: Tool, rows: Rows, axis: Floats, at: Contacts, clock: Clock
    ) -> tuple[NDArray[np.int8], int, list[str]]:
        """Verdicts on a tool at contacts of samples (m,) by the tolerance that was wanted, and words for the first few not free.

        What is free by the tolerance that the plan keeps alone is `OPEN`; how many these are is given as well.
        """
        wanted, (flutes, rest) = self.question.asked, self._limits(tool, surely=True)
        strict = 0.0 < wanted < self.question.tolerance
        limits = (wanted - tool.allowance if strict else flutes), rest
        verdict, words = self._looked(setup, tool, rows, axis, at, clock, limits)
        deep = np.flatnonzero(verdict == MET)
        if not strict or not len(deep):
            return verdict, 0, words
        some = Contacts(*(each[deep] for each in at))
        again, words = self._looked(setup, tool, rows[deep], axis[deep], some, clock, (flutes, rest))
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
        slid = np.flatnonzero(verdict != FREE)
        slid = slid[self._slid(setup, tool, rows[slid], axis[slid])]
        if len(slid):
            moved = rows[slid]
            at = Contacts(
                self.point[moved] + self.question.shift(tool.id)[moved], self.normal[moved],
                self.question.samples[f"lean_{tool.id}"][moved],
            )  # fmt: skip
            own = self.question.samples[f"axis_{tool.id}"][moved]
            verdict[slid] = self._looked(setup, tool, moved, own, at, clock, self._limits(tool, surely))[0]
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

    def _slid(self, setup: int, tool: Tool, rows: Rows, axis: Floats) -> NDArray[np.bool_]:
        """Where (m,) the posture that the verdicts have has nearly this axis in this setup: it may touch beside the sample."""
        samples = self.question.samples
        here = samples.get(f"setup_{tool.id}", np.zeros(len(self.point), np.int64))[rows] == setup
        return np.asarray(here & (np.abs(samples[f"axis_{tool.id}"][rows] - axis).max(axis=1, initial=0.0) <= _ONE_AXIS))

    def _under_flat(self, setup: int, tool: Tool, rows: Rows, axis: Floats, clock: Clock, *, surely: bool) -> NDArray[np.int8]:
        """Whether an upright tool stands free anywhere with a contact under its flat: `FREE`, `MET`, or `OPEN`."""
        limits, places = self._limits(tool, surely), [_Places(tool.flat) for _ in rows]
        # Two unit directions across each axis, the first nearest to that of the larger curvature.
        first = self.question.samples["direction_max"][rows]
        u = [d - (d @ a) * a for a, d in zip(axis, first, strict=True)]
        u = [each / max(float(np.linalg.norm(each)), 1e-300) for each in u]
        uv = np.array([[each, np.cross(a, each)] for a, each in zip(axis, u, strict=True)])
        verdict = np.full(len(rows), OPEN, np.int8)
        for _ in range(_TRIED):
            open_rows = np.flatnonzero(verdict == OPEN)
            if not len(open_rows) or clock.over:
                break
            best = [places[k].best for k in open_rows.tolist()]
            gone = np.array([each is None for each in best])
            verdict[open_rows[gone]] = MET
            some, place = open_rows[~gone], np.array([each for each in best if each is not None]).reshape(-1, 2)
            tilt_direction = -np.einsum("nk,nkx->nx", place, uv[some]) / tool.flat
            # In the middle of the flat no direction is left: a hair beside it.
            tilt_direction[np.linalg.norm(tilt_direction, axis=1) < _END] = _END
            at = Contacts(self.point[rows[some]], self.normal[rows[some]], tilt_direction)
            tip, able = self._tips(setup, tool, rows[some], axis[some], at)
            verdict[some[~able]] = MET
            some, place, tip = some[able], place[able], tip[able]
            hits = met(self.cells, self.root[setup], tool, tip, axis[some], limits, self.grain, clock)
            for i, k in enumerate(some.tolist()):
                if hits.verdict[i] == FREE:
                    held = any(each.holds(tip[i : i + 1] + tool.high * axis[k])[0] for each in self.standing[setup])
                    verdict[k] = MET if held else FREE
                    if not held and self.at_border[rows[k]] and self._in_material(tool, tip[i : i + 1], axis[k : k + 1])[0]:
                        # Another place may be out of the material.
                        verdict[k] = OPEN
                        places[k].forbid(place[i], _STEP * tool.flat)
                elif hits.verdict[i] == MET:
                    solid = tool.solids[hits.solid[i]]
                    limit = limits[0] if solid.part == "flutes" else limits[1]
                    away = self.cells.point[hits.cell[i]] - tip[i]
                    flat = uv[k] @ away
                    radius = _reach_at(solid, float(away @ axis[k]), limit, float(np.linalg.norm(flat)))
                    places[k].forbid(place[i] + flat, radius)
        return verdict

    def own_tilt_direction(self, rows: Rows, axis: Floats) -> Floats:
        """Unit directions (m, 3) to which axes lean from the normals; that of the larger curvature where they do not."""
        normal = self.normal[rows]
        across = axis - (normal * axis).sum(axis=1)[:, None] * normal
        size = np.linalg.norm(across, axis=1)[:, None]
        return np.where(size > 1e-12, across / np.maximum(size, 1e-300), self.question.samples["direction_max"][rows])

    def clearance(
        self, setup: int, tool: Tool, axis: Floats, at: Contacts, beyond: float, clock: Clock
    ) -> tuple[float, str] | None:
        """The least distance of what does not cut from anything, mm, at contacts, and which part comes nearest."""
        tip = tool.tips(at.point, at.normal, axis, at.tilt_direction, self.accuracy, self.question.tolerance)
        return nearest(self.cells, self.root[setup], tool.idle(), tip, axis, beyond, self.grain, clock)


class _Places:
    """Places (n, 2) of one contact that may be free, how far each is from all disks that are forbidden, and these, (k, 3), mm."""

    def __init__(self, most: float) -> None:
        rim, ring = (np.arange(n) * (2.0 * math.pi / n) for n in (_RIM, _RING))
        circles = [-r * np.column_stack([np.cos(turn), np.sin(turn)]) for r, turn in ((most, rim), (0.5 * most, ring))]
        self._most, self._disk = most, np.zeros((0, 3))
        self._open = np.concatenate([*circles, np.zeros((1, 2))])
        self._margin = np.full(len(self._open), np.inf)

    @property
    def best(self) -> Floats | None:
        """The place farthest from all disks; None if all are forbidden."""
        return self._open[int(self._margin.argmax())] if len(self._open) else None

    def forbid(self, centre: Floats, radius: float) -> None:
        """Forbid the places that are nearer to a point (2,) than a radius; the one that was tried last is among them."""
        left = np.arange(len(self._open)) != int(self._margin.argmax())
        new = np.array([[*centre, radius + _APART]])
        crossing = np.concatenate([_crossings(new[0], each) for each in [*self._disk, np.array([0.0, 0.0, self._most])]])
        self._disk = np.concatenate([self._disk, new])
        crossing = crossing[np.linalg.norm(crossing, axis=1) <= self._most + _ROUNDING]
        places = np.concatenate([self._open[left], crossing])
        margin = np.concatenate([np.minimum(self._margin[left], _away(self._open[left], new)), _away(crossing, self._disk)])
        self._open, self._margin = places[margin >= -_ROUNDING], margin[margin >= -_ROUNDING]


def _away(place: Floats, disk: Floats) -> Floats:
    """How far places (n, 2) are from the nearest of some disks (k, 3)."""
    apart = np.linalg.norm(place[:, None] - disk[:, :2], axis=2) - disk[:, 2]
    return np.asarray(apart.min(axis=1, initial=np.inf))


def _crossings(one: Floats, other: Floats) -> Floats:
    """Where two circles (3,) cross: (0 or 2, 2)."""
    to = other[:2] - one[:2]
    d = math.hypot(*to)
    if d == 0.0 or d > one[2] + other[2] or d < abs(one[2] - other[2]):
        return np.zeros((0, 2))
    along = (d * d + one[2] ** 2 - other[2] ** 2) / (2.0 * d)
    across = math.sqrt(max(0.0, one[2] ** 2 - along * along))
    to = to / d
    middle, side = one[:2] + along * to, across * np.array([-to[1], to[0]])
    return np.array([middle - side, middle + side])


def _reach_at(solid: Solid, height: float, deep: float, within: float) -> float:
    """Up to which distance from the axis a point at a height is deeper in a solid than `deep`: `within` is so, or is taken."""
    low, high = within, within + 2.0 * float(np.abs(solid.border).max())
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if solid.depth(np.array([middle]), np.array([height]))[0][0] > deep:
            low = middle
        else:
            high = middle
    return low
