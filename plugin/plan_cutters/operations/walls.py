"""Walls: where the flutes of a tool lie along a face, so that one pass cuts a strip as high as they are.

A face is a wall of a tool axis where its normal stands on the side of the flutes: across the axis, or by the taper off that. The
line of the face that runs up the flutes is its ruling. A pass stands with the lower end of its strip where the flutes begin to be
straight, and is judged there as every posture is, with all of the tool. A sample is cut by it if it lies on the flutes within the
scallop height. Nothing is concluded from the kind of a surface: a face that bends away from its ruling ends there
(`docs/operations_proof.md`, lemmas W1 and W2).
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record
from plan_cutters.domain.columns import Columns, columns_of
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import flute_length
from plan_cutters.operations.probes import Probes
from plan_cutters.scene.fixed_axis import leaning
from plan_cutters.scene.obstacles import Obstacles

Rows = NDArray[np.int64]
#: Lengths that count as nothing, mm.
_NOTHING = 1e-6
#: Curvatures of a plane at most, 1/mm.
PLANE = 1e-9
#: Share of the scallop height by which the floor may leave a flat tip, or a wall the flutes: rounding stays below it.
_WITHIN = 1.0 - 1e-6


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Passes(Record):
    """Passes along walls, of m samples; nan where no pass cuts the sample.

    Attributes
    ----------
    strip : (m,) float
        Height of the strip that the pass cuts, mm: that of the wall over the number of its passes.
    point, normal : (m, 3) float
        Contact at which the tool stands, at the lower end of its strip, mm, and unit normal there: that of the flutes.
    """

    strip: Floats
    point: Floats
    normal: Floats

    @classmethod
    def none(cls, count: int) -> "Passes":
        """No pass at any of some samples."""
        return cls(np.full(count, np.nan), np.full((count, 3), np.nan), np.full((count, 3), np.nan))


def flank_of(cutter: Cutter) -> tuple[float, float] | None:
    """Height over the tip at which the straight side of the flutes begins, and its length, mm; None where there is none.

    >>> flank_of(Cutter.parse("D12L60rc1F26"))
    (1.0, 25.0)
    >>> flank_of(Cutter.lollipop(radius=4, neck_radius=2, length=40)) is None
    True
    """
    if cutter.shape != "end":
        return None
    begins = cutter.corner_radius * (1.0 - math.sin(cutter.taper))
    length = (flute_length(cutter) - begins) / math.cos(cutter.taper)
    return (begins, length) if length > _NOTHING else None


def flat_of(cutter: Cutter) -> float:
    """Diameter of the flat part of the tip, mm; 0 where there is none.

    >>> flat_of(Cutter.parse("D12L60rc1")), flat_of(Cutter.parse("D12L60rc6"))
    (10.0, 0.0)
    """
    return 2.0 * max(0.0, cutter.radius - cutter.corner_radius) if cutter.shape == "end" else 0.0


def on_floor(
    cutter: Cutter, normal: Floats, curvature: Floats, axis: Floats, accuracy: float, scallop: float
) -> NDArray[np.bool_]:
    """At which points (n,) the flat part of the tip lies on the face.

    That is where the face is plane and the axis (n, 3) within the accuracy, rad, of its normal (n, 3), and across the flat part
    the face leaves the tip by no more than the scallop height, mm.
    """
    flat = flat_of(cutter)
    if flat <= 0.0:
        return np.zeros(len(normal), bool)
    sine = np.linalg.norm(np.cross(normal, axis), axis=1)
    plane = (np.abs(curvature) <= PLANE).all(axis=1)
    near = (sine <= math.sin(accuracy) + 1e-12) & ((normal * axis).sum(axis=1) > 0.0)
    return np.asarray(plane & near & (flat * sine <= scallop))


class Walls:
    """The passes along walls.

    Parameters
    ----------
    probes : Probes
    obstacles : Obstacles
        With the triangles of the part.
    scallop : float
        mm.
    accuracy : float
        How far an axis may be off the ruling, rad: the accuracy of the rotary axes.
    """

    def __init__(self, probes: Probes, obstacles: Obstacles, scallop: float, accuracy: float) -> None:
        self._probes, self._obstacles, self._band = probes, obstacles, obstacles.triangles.chord_error + scallop
        self._scallop, self._accuracy = scallop, accuracy
        self._upright: dict[int, NDArray[np.bool_]] = {}
        self._known: dict[str, Floats] = {}
        self._known_rows: Rows = np.zeros(0, np.int64)

    @classmethod
    def of(cls, probes: Probes, scallop: float, accuracy: float) -> "Walls":
        """Those of the part as it stands in the first setup."""
        return cls(probes, probes.setups[0].obstacles, scallop, accuracy)

    def of_probes(self, probes: Probes) -> "Walls":
        """The same with probes of the same tools at the same samples: what is cut along the setup axis is known already."""
        same = Walls(probes, self._obstacles, self._scallop, self._accuracy)
        same._upright = self._upright
        return same

    def strips(self, columns: Columns, rows: Rows, where: NDArray[np.bool_]) -> Floats:
        """Heights of the strips (rows, columns) of passes along walls, mm; nan where there is none, or `where` is not set."""
        result, samples = np.full(where.shape, np.nan), self._probes.samples
        cosine = samples.normal[rows] @ columns.axis.T
        for c, cutter in enumerate(self._probes.cutters):
            if flank_of(cutter) is None:
                continue
            mine = where & (columns.cutter == c) & self._side(cutter, cosine)
            for k in np.flatnonzero(mine.any(axis=0)).tolist():
                at = np.flatnonzero(mine[:, k])
                result[at, k] = self.passes(c, int(columns.setup[k]), columns.axis[k], rows[at]).strip
        return result

    def cached(self, columns: Columns, rows: Rows) -> Floats:
        """As `strips` at all of some samples, (rows, columns), for columns that are requested again and again at these."""
        if not np.array_equal(rows, self._known_rows):
            self._known, self._known_rows = {}, rows
        keys = columns.key.tolist()
        for k, key in enumerate(keys):
            if key not in self._known:
                self._known[key] = self.strips(columns.of(np.array([k])), rows, np.ones((len(rows), 1), bool))[:, 0]
        return np.array([self._known[key] for key in keys]).reshape(len(keys), len(rows)).T

    def _side(self, cutter: Cutter, cosine: Floats) -> NDArray[np.bool_]:
        """Where normals with these cosines to an axis stand on the side of the flutes."""
        return np.asarray(np.abs(np.arcsin(np.clip(cosine, -1.0, 1.0)) - cutter.taper) <= self._accuracy)

    def passes(self, c: int, s: int, axis: Floats, rows: Rows) -> Passes:
        """The passes of cutter `c` in setup `s` with an axis (3,) at samples (m,)."""
        cutter, samples, result = self._probes.cutters[c], self._probes.samples, Passes.none(len(rows))
        flank, normal = flank_of(cutter), samples.normal[rows]
        able = self._side(cutter, normal @ axis) & self._probes.outside[s][rows] & ~self._turned_away(c, s, axis, rows)
        if flank is None or not able.any():
            return result
        at = np.flatnonzero(able)
        square, ruling = _flute_frame(normal[at], axis, cutter.taper)
        low, high = self._ends(rows[at], normal[at], axis)
        for raised in (0.0, flank[0] / math.cos(cutter.taper)) if flank[0] > _NOTHING else (0.0,):
            open_ = np.flatnonzero(np.isnan(result.strip[at]))
            ends = low[open_] + raised, high[open_]
            more = self._pass(c, s, axis, rows[at[open_]], square[open_], ruling[open_], ends, flank[1])
            for name in ("strip", "point", "normal"):
                getattr(result, name)[at[open_]] = getattr(more, name)
        return result

    def _pass(
        self, c: int, s: int, axis: Floats, rows: Rows, square: Floats, ruling: Floats, ends: tuple[Floats, Floats], flutes: float
    ) -> Passes:
        """The same between ends (m,) of the wall along its ruling from each sample."""
        result, (low, high) = Passes.none(len(rows)), ends
        # How far the wall stands out towards the flutes, mm for each mm up.
        out = (self._tangent(rows, ruling) * square).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            most = np.minimum(flutes, _WITHIN * self._scallop / np.abs(out))
            count = np.maximum(1.0, np.ceil((high - low - _NOTHING) / most))
            strip = (high - low) / count
            number = np.clip(np.floor(-low / strip), 0.0, count - 1.0)
        above = -low - number * strip
        # What is no higher than the scallop is the end of a face that bends away.
        good = np.flatnonzero((strip > self._scallop) & (above >= -_NOTHING) & (above <= most + _NOTHING))
        if not len(good):
            return result
        tangent = self._tangent(rows[good], ruling[good])
        point = self._probes.samples.point[rows[good]] - above[good, None] * tangent
        # The flutes touch where the wall stands out farthest over the strip.
        point += np.maximum(0.0, strip[good] * out[good])[:, None] * square[good]
        free = self._free(c, s, axis, rows[good], point, square[good])
        # A shank as wide as the flutes may not touch the wall above them: kept off by what the surface may be off, it does not.
        # What a strip leaves already, for the wall is not quite along the flutes, counts as well.
        met, off = np.flatnonzero(~free), min(_WITHIN * self._scallop, self._probes.setups[s].tolerance)
        keep = np.maximum(0.0, off - strip[good[met]] * np.abs(out[good[met]]))
        point[met] += keep[:, None] * square[good[met]]
        free[met] = self._free(c, s, axis, rows[good[met]], point[met], square[good[met]])
        good, point = good[free], point[free]
        result.strip[good], result.point[good], result.normal[good] = strip[good], point, square[good]
        return result

    def _tangent(self, rows: Rows, ruling: Floats) -> Floats:
        """Unit directions (m, 3) in the face nearest to those of the flutes."""
        normal = self._probes.samples.normal[rows]
        along = ruling - (ruling * normal).sum(axis=1)[:, None] * normal
        return np.asarray(along / np.linalg.norm(along, axis=1)[:, None])

    def _free(self, c: int, s: int, axis: Floats, rows: Rows, point: Floats, normal: Floats) -> NDArray[np.bool_]:
        """At which contacts (m,), in the place of samples, the whole tool stands free."""
        samples = self._probes.samples
        there = replace(
            samples, point=np.ascontiguousarray(point), normal=np.ascontiguousarray(normal),
            direction_max=samples.direction_max[rows], curvature=samples.curvature[rows],
        )  # fmt: skip
        self._probes.made += len(rows)
        return leaning(np.arange(len(rows)), axis, there, self._probes.contexts[c][s])

    def _ends(self, rows: Rows, normal: Floats, axis: Floats) -> tuple[Floats, Floats]:
        """Where the face ends below and above samples (m,), mm along their rulings; nan where it has no triangles."""
        from plan_cutters.kernels.linear.rulings import OneFace, extents

        samples, (low, high) = self._probes.samples, np.full((2, len(rows)), np.nan)
        tangent = axis - (normal @ axis)[:, None] * normal
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        face, obstacles = samples.face[rows], self._obstacles
        for number in np.unique(face).tolist():
            mine, own = np.flatnonzero(face == number), OneFace(obstacles.tree, obstacles.faces, number)
            first, last = np.empty((2, len(mine)))
            extents(samples.point[rows[mine]], tangent[mine], normal[mine], own, self._band, first, last)
            low[mine], high[mine] = first, last
        return low, high

    def _turned_away(self, c: int, s: int, axis: Floats, rows: Rows) -> NDArray[np.bool_]:
        """Samples (m,) that are cut along the setup axis: nobody turns the part to lay the flutes along a face that faces it."""
        setup = self._probes.setups[s].setup
        if float(axis @ setup) >= math.cos(self._accuracy):
            return np.zeros(len(rows), bool)
        if s not in self._upright:
            self._upright[s] = self._cut_upright(s)
        return self._upright[s][rows]

    def _cut_upright(self, s: int) -> NDArray[np.bool_]:
        """Samples (n,) that one of the cutters cuts along the setup axis, on a face across it or by the flutes."""
        probes, samples = self._probes, self._probes.samples
        conditions, served = probes.setups[s], np.zeros(len(samples), bool)
        axis = conditions.setup
        if not conditions.allows(axis[None])[0]:
            return served
        judged, cosine = probes.outside[s] & (samples.unjudged < 0), samples.normal @ axis
        floor = (cosine >= math.cos(self._accuracy)) & (np.abs(samples.curvature) <= PLANE).all(axis=1)
        for c, cutter in enumerate(probes.cutters):
            rows = np.flatnonzero(judged & floor & ~served)
            served[rows] = probes.table(rows, columns_of(axis[None], np.zeros((1, 2)), c, s))[:, 0]
            if flank_of(cutter) is None:
                continue
            wall = self._side(cutter, cosine)
            rows = np.flatnonzero(judged & wall & ~served)
            served[rows] = np.isfinite(self.passes(c, s, axis, rows).strip)
        return served


def _flute_frame(normal: Floats, axis: Floats, taper: float) -> tuple[Floats, Floats]:
    """Of flutes that touch faces with normals (m, 3): unit normals (m, 3) on the face's side, and directions (m, 3) up them."""
    radial = normal - (normal @ axis)[:, None] * axis
    radial = radial / np.linalg.norm(radial, axis=1)[:, None]
    return (math.cos(taper) * radial + math.sin(taper) * axis, math.cos(taper) * axis - math.sin(taper) * radial)
