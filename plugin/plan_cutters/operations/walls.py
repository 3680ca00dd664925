"""Walls: where the flutes of a tool lie along a face, so that one pass cuts a strip as high as they are.

A face is a wall of a tool axis where its normal stands on the side of the flutes: across the axis, or by the taper off that. The
line of the face that runs up the flutes is its ruling. A pass stands with the lower end of its strip where the flutes begin to be
straight, and is judged there as every posture is, with all of the tool. A sample is cut by it if it lies on the flutes within the
scallop height (`docs/operations_proof.md`, lemmas W1 and W2). Nothing is concluded from the kind of a surface: a face that bends
away from its ruling ends there. Where something is in the way below, such as the jaw of a vise, the lowest strip begins where the
tool comes free of it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, cross
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns, columns_of
from plan_cutters.kernels.linear.strips import centre_paths
from plan_cutters.kernels.rows import Contacts
from plan_cutters.operations.passes import NOTHING, PLANE, Cut, Paths, flank_of
from plan_cutters.operations.probes import Probes
from plan_cutters.scene.fixed_axis import leaning

Rows = NDArray[np.int64]
#: Share of the scallop height by which the floor may leave a flat tip, or a wall the flutes: rounding stays below it.
_WITHIN = 1.0 - 1e-6
#: Halvings by which it is found where a strip above an obstacle begins.
_HALVINGS = 5
#: In a corner of its own radius the centre stands still: it counts as running by this share of what the contact runs.
_STANDS_STILL = 0.01


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Passes(Record):
    """Passes along walls, of m samples; nan where no pass cuts the sample.

    `strip` (m,) float: height of the strip that the pass cuts, mm: that of the wall over the number of its passes. `path`,
    `links` (m,) float: as of `Cut`, 1/mm and 1/mm2. `point`, `normal` (m, 3) float: contact at which the tool stands, at the
    lower end of its strip, mm, and unit normal there: that of the flutes.
    """

    strip: Floats
    path: Floats
    links: Floats
    point: Floats
    normal: Floats

    @classmethod
    def none(cls, count: int) -> "Passes":
        """No pass at any of some samples."""
        none, places = np.full(count, np.nan), np.full((count, 3), np.nan)
        return cls(none, none.copy(), none.copy(), places, places.copy())

    @property
    def cut(self) -> Cut:
        """Give what cutting takes."""
        return Cut(self.strip, self.path, self.links, np.zeros(len(self.strip), bool), np.ones(len(self.strip)))


class Walls:
    """The passes along walls of a part as it stands in the first setup of some probes.

    `paths`: an axis may be off the ruling by the accuracy of the rotary axes.
    """

    def __init__(self, probes: Probes, paths: Paths) -> None:
        self._probes, self._obstacles = probes, probes.setups[0].obstacles
        self._band = self._obstacles.triangles.chord_error + paths.scallop
        self._paths, self._scallop, self._accuracy = paths, paths.scallop, paths.accuracy
        self._upright: dict[int, NDArray[np.bool_]] = {}
        #: By the key of a column the paces of all samples (n,); -inf: not looked at yet.
        self._known: dict[str, Floats] = {}

    def of_probes(self, probes: Probes) -> "Walls":
        """The same with probes of the same tools at the same samples: what was looked at is known already."""
        same = Walls(probes, self._paths)
        same._upright, same._known = self._upright, self._known
        return same

    def paces(self, columns: Columns, rows: Rows, where: NDArray[np.bool_]) -> Floats:
        """Paces (rows, columns) of passes along walls, mm2/mm; nan where there is none, or `where` is not set."""
        result, samples = np.full(where.shape, np.nan), self._probes.samples
        cosine = samples.normal[rows] @ columns.axis.T
        for c, cutter in enumerate(self._probes.cutters):
            if flank_of(cutter) is None:
                continue
            mine = where & (columns.cutter == c) & self._side(cutter, cosine)
            for k in np.flatnonzero(mine.any(axis=0)).tolist():
                at = np.flatnonzero(mine[:, k])
                passes = self.passes(c, int(columns.setup[k]), columns.axis[k], rows[at])
                result[at, k] = passes.cut.pace(self._paths, cutter)
        return result

    def cached(self, columns: Columns, rows: Rows, where: NDArray[np.bool_]) -> Floats:
        """As `paces`, for columns that are requested again and again."""
        result = np.full(where.shape, np.nan)
        for k, key in enumerate(columns.key.tolist()):
            known = self._known.setdefault(key, np.full(len(self._probes.samples), -np.inf))
            at = rows[where[:, k]]
            new = at[np.isneginf(known[at])]
            if len(new):
                known[new] = self.paces(columns.of(np.array([k])), new, np.ones((len(new), 1), bool))[:, 0]
            result[where[:, k], k] = known[at]
        return result

    def _side(self, cutter: Cutter, cosine: Floats) -> NDArray[np.bool_]:
        """Where normals with these cosines to an axis stand on the side of the flutes."""
        return np.asarray(np.abs(np.arcsin(np.clip(cosine, -1.0, 1.0)) - cutter.taper) <= self._accuracy)

    def passes(self, c: int, s: int, axis: Floats, rows: Rows) -> Passes:
        """The passes of cutter `c` in setup `s` with an axis (3,) at samples (m,)."""
        cutter, samples, result = self._probes.cutters[c], self._probes.samples, Passes.none(len(rows))
        flank, normal = flank_of(cutter), samples.normal[rows]
        able = self._side(cutter, normal @ axis) & self._probes.outside[s][rows] & ~self._turned_away(c, s, axis, rows)
        if flank is None or not able.any() or not self._probes.setups[s].allows(axis[None])[0]:
            return result
        at = np.flatnonzero(able)
        # Of the flutes: unit normals on the face's side, and directions up them.
        radial = normal[at] - (normal[at] @ axis)[:, None] * axis
        radial = radial / np.linalg.norm(radial, axis=1)[:, None]
        square = math.cos(cutter.taper) * radial + math.sin(cutter.taper) * axis
        ruling = math.cos(cutter.taper) * axis - math.sin(cutter.taper) * radial
        low, high = self._ends(rows[at], normal[at], axis)
        begins = flank[0] / math.cos(cutter.taper)
        starts = (0.0, begins) if flank[0] > NOTHING else (0.0,)
        raised, stands = self._lowest(c, s, axis, rows[at], square, ruling, low, starts)
        open_ = np.flatnonzero(np.isfinite(raised))
        ends = low[open_] + raised[open_], high[open_]
        more = self._pass(c, s, axis, rows[at[open_]], square[open_], ruling[open_], ends, flank[1], stands[open_])
        for name in ("strip", "path", "links", "point", "normal"):
            getattr(result, name)[at[open_]] = getattr(more, name)
        return result

    def _lowest(
        self, c: int, s: int, axis: Floats, rows: Rows, square: Floats, ruling: Floats, low: Floats, starts: Sequence[float]
    ) -> tuple[Floats, NDArray[np.bool_]]:
        """How far above the lower end of the wall the lowest strip begins (m,), mm; nan where it would be above the sample; and
        where the tool stands free there without being kept off the wall.

        It begins at the first of the `starts` at which the tool stands free; where something is in the way at all of them, such
        as a jaw, it begins where the tool comes free of that.
        """
        raised, stands = np.full(len(rows), np.nan), np.zeros(len(rows), bool)
        known = np.isfinite(low)
        # Kept off by what the surface may be off, so that a shank as wide as the flutes does not touch the wall above.
        lower, off = self._tangent(rows, ruling), min(_WITHIN * self._scallop, self._probes.setups[s].tolerance) * square

        def free(which: Rows, height: Floats, away: Floats) -> NDArray[np.bool_]:
            point = self._probes.samples.point[rows[which]] + (low[which] + height)[:, None] * lower[which] + away[which]
            return self._free(c, s, axis, rows[which], point, square[which])

        for start in starts:
            for moved in (False, True):
                open_ = np.flatnonzero(known & np.isnan(raised) & (-low >= start - NOTHING))
                open_ = open_[free(open_, np.full(len(open_), start), off if moved else 0.0 * off)]
                raised[open_], stands[open_] = start, not moved
        blocked, free_at = np.full(len(rows), starts[-1]), -low
        open_ = np.flatnonzero(known & np.isnan(raised) & (free_at > blocked + NOTHING))
        open_ = open_[free(open_, free_at[open_], off)]
        for _ in range(_HALVINGS):
            middle = 0.5 * (blocked[open_] + free_at[open_])
            good = free(open_, middle, off)
            free_at[open_[good]], blocked[open_[~good]] = middle[good], middle[~good]
        raised[open_] = free_at[open_]
        return raised, stands

    def _pass(
        self, c: int, s: int, axis: Floats, rows: Rows, square: Floats, ruling: Floats, ends: tuple[Floats, Floats],
        flutes: float, stands: NDArray[np.bool_],
    ) -> Passes:  # fmt: skip
        """The same between ends (m,) of the wall along its ruling from each sample; `stands` (m,): free at the lower one."""
        result, (low, high) = Passes.none(len(rows)), ends
        tangent = self._tangent(rows, ruling)
        # How far the wall stands out towards the flutes, mm for each mm up.
        out = (tangent * square).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            most = np.minimum(flutes, _WITHIN * self._scallop / np.abs(out))
            count = np.maximum(1.0, np.ceil((high - low - NOTHING) / most))
            strip = (high - low) / count
            number = np.clip(np.floor(-low / strip), 0.0, count - 1.0)
        above = -low - number * strip
        # What is no higher than the scallop is the end of a face that bends away.
        good = np.flatnonzero((strip > self._scallop) & (above >= -NOTHING) & (above <= most + NOTHING))
        if not len(good):
            return result
        tangent, jut = tangent[good], strip[good] * out[good]
        # The flutes touch where the wall stands out farthest over the strip.
        point = self._probes.samples.point[rows[good]] - above[good, None] * tangent
        point += np.maximum(0.0, jut)[:, None] * square[good]
        # The lowest strip of a wall that does not stand out higher up was tested where the wall begins.
        free = stands[good] & (number[good] == 0.0) & (jut <= 0.0)
        open_ = np.flatnonzero(~free)
        free[open_] = self._free(c, s, axis, rows[good[open_]], point[open_], square[good[open_]])
        # A shank as wide as the flutes may not touch the wall above them: kept off by what the surface may be off, it does not.
        # What a strip leaves already, for the wall is not quite along the flutes, counts as well.
        met, off = np.flatnonzero(~free), min(_WITHIN * self._scallop, self._probes.setups[s].tolerance)
        point[met] += np.maximum(0.0, off - np.abs(jut[met]))[:, None] * square[good[met]]
        free[met] = self._free(c, s, axis, rows[good[met]], point[met], square[good[met]])
        tangent = tangent[free]
        good, point = good[free], point[free]
        result.strip[good], result.point[good], result.normal[good] = strip[good], point, square[good]
        # A window in a wall is no wall: strips are as high as what there is along them.
        there = self._paths.extents.along(rows[good], tangent)[2]
        there = np.where(np.isfinite(there), np.minimum(there, high[good] - low[good]), high[good] - low[good]) / count[good]
        samples, radius = self._probes.samples, self._probes.cutters[c].radius
        normal, direction, curvature = (each[rows[good]] for each in (samples.normal, samples.direction_max, samples.curvature))
        feed, path = cross(normal, tangent), np.empty(len(good))
        side, axes = (np.full(len(good), radius), np.zeros(len(good))), np.tile(axis, (len(good), 1))
        centre_paths(axes, feed, Contacts(normal, normal, direction, curvature), *side, False, path)
        result.path[good] = np.maximum(path, _STANDS_STILL) / there
        length = self._paths.extents.along(rows[good], feed)[0]
        result.links[good] = np.where(np.isfinite(length), 1.0 / (there * length), 0.0)
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
        from plan_cutters.kernels.linear.sections import OneFace, extents

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
