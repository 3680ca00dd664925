"""Which setups are worth planning: directions of the part, ranked by what a machine could hold there over a table, or in a vise
or chuck.

First a bound that is cheap and sees no obstacle but the table: at which samples does the machine hold any tool axis at which a
cutter touches, whose upper end is above the plane that the part stands on? Then, for the few best, a search on some samples among
the real obstacles with the real table, vise or chuck. It promises; the plan of that setup decides.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, SurfaceSamples, Triangles
from plan_cutters.answers.holding import EVEN, Held, best_hold
from plan_cutters.answers.least_set import cover
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.preference import group_of
from plan_cutters.domain.verdicts import blank
from plan_cutters.errors import OptionError
from plan_cutters.scene.conditions import Conditions, Context, contacts_of, search_postures
from plan_cutters.scene.preparation import Axis, Prepared
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.stages.setups import within_limits

Rows = NDArray[np.int64]
Table = NDArray[np.bool_]

#: Families of parallel planes whose normals are tried, and directions spread over the sphere.
_FAMILIES, _SPREAD = 40, 60
#: Directions nearer than this are one: cosine of 0.1 deg.
_ONE = float(np.cos(np.radians(0.1)))
#: Samples on which directions are compared, at most; directions that are searched, for the first setup and for each more.
COMPARED, _FIRST, _MORE = 400, 10, 6
#: Heights over the table are told apart in so many steps; shares nearer than the second are equal.
_HEIGHTS, _EVEN = 12, EVEN
#: A setup that stands on no plane counts so much: it needs more to hold it than a table.
_ON_NO_PLANE = 0.75
#: Share of the area that a setup has to serve alone: of a few hundred samples one or two may be served by chance.
_CLAMPED_FOR = 0.005
#: Setups that are proposed together, at most.
MOST = 3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Candidates(Record):
    """Directions of the part along the spindle that are compared.

    Attributes
    ----------
    axis : (m, 3) float
        Unit directions.
    stands_on : tuple of tuple of int
        For each the numbers of the planar faces that lie on the table.
    lowest : (m,) float
        Height along each of the part's lowest point, mm.
    """

    axis: Floats
    stands_on: tuple[tuple[int, ...], ...]
    lowest: Floats

    @classmethod
    def of(cls, ready: Prepared) -> "Candidates":
        """Directions of a cube's corners, edges and faces, normals of planes both ways, and some all over the sphere."""
        triangles, planar = _of_part(ready)
        axis = distinct(np.concatenate([cube(), _normals(triangles.vertex, triangles.face, planar), fibonacci(_SPREAD)]))
        return cls(axis, *planes_below(ready, axis))


def _of_part(ready: Prepared) -> tuple[Triangles, list[int]]:
    """The triangles of the part alone, and the numbers of its planes."""
    surroundings = ready.conditions.surroundings
    planar = [face.number for face in ready.scene.part.faces if face.shape == "plane"]
    return (surroundings.alone or surroundings).certain.triangles, planar


def planes_below(ready: Prepared, axis: Floats) -> tuple[tuple[tuple[int, ...], ...], Floats]:
    """On which planes a part stands, by their numbers, and the height of its lowest point (m,), along some axes (m, 3)."""
    triangles, planar = _of_part(ready)
    height = triangles.vertex.reshape(-1, 3) @ axis.T
    lowest, flat = height.min(axis=0), triangles.chord_error + 1e-6 * float(np.linalg.norm(ready.scene.part.size))
    face = np.repeat(triangles.face, 3)
    tops = {number: height[face == number].max(axis=0) for number in planar if (face == number).any()}
    stands = [tuple(number for number, top in tops.items() if top[k] <= lowest[k] + flat) for k in range(len(axis))]
    return tuple(stands), lowest


def touching(ready: Prepared, axis: Floats) -> tuple[tuple[int, ...], ...]:
    """Faces with which a part touches the plane below it, by their numbers, along some axes (m, 3)."""
    triangles, _ = _of_part(ready)
    height = triangles.vertex.reshape(-1, 3) @ axis.T
    reach = triangles.chord_error + 1e-6 * float(np.linalg.norm(ready.scene.part.size))
    low, face = height <= height.min(axis=0) + reach, np.repeat(triangles.face, 3)
    return tuple(tuple(int(n) for n in np.unique(face[low[:, k]]) if n > 0) for k in range(len(axis)))


def cube() -> Floats:
    """Directions (26, 3) of a cube's faces, edges and corners; the part's own axes come first, +z as the first of all."""
    every = np.array([(x, y, z) for z in (1, 0, -1) for y in (0, 1, -1) for x in (0, 1, -1) if (x, y, z) != (0, 0, 0)], float)
    every = every[np.argsort(np.abs(every).sum(axis=1), kind="stable")]
    return np.asarray(every / np.linalg.norm(every, axis=1)[:, None])


def fibonacci(count: int) -> Floats:
    """So many unit directions (count, 3), evenly spread."""
    step = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * step / count, np.pi * (1.0 + np.sqrt(5.0)) * step
    across = np.sqrt(1.0 - z * z)
    return np.stack([across * np.cos(turn), across * np.sin(turn), z], axis=1)


def distinct(axis: Floats) -> Floats:
    """Directions without those that are nearly one before them."""
    result: list[int] = []
    for k in range(len(axis)):
        if not result or (axis[result] @ axis[k]).max() < _ONE:
            result.append(k)
    return axis[result]


def _normals(vertex: Floats, face: NDArray[np.int32], planar: Sequence[int]) -> Floats:
    """Normals of the families of parallel planes with the most area, both ways: the machine may look at them or away."""
    wide = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    normals: list[tuple[float, Floats]] = []
    for number in planar:
        normal = wide[face == number].sum(axis=0)
        size = float(np.linalg.norm(normal))
        if not size > 0.0:
            continue
        same = next((k for k, (_, known) in enumerate(normals) if abs(known @ normal) >= _ONE * size), None)
        if same is None:
            normals.append((size, normal / size))
        else:
            normals[same] = normals[same][0] + size, normals[same][1]
    normals = sorted(normals, key=lambda each: -each[0])[:_FAMILIES]
    return np.array([way * normal for _, normal in normals for way in (1.0, -1.0)]).reshape(-1, 3)


def holdable(
    samples: SurfaceSamples,
    cutters: Sequence[Cutter],
    conditions: Conditions,
    axis: Floats,
    table: float | None = None,
    rows: Rows | None = None,
) -> NDArray[np.bool_]:
    """Judged samples (n,) at which the machine holds some tool axis at which a cutter touches, were `axis` the setup axis.

    Parameters
    ----------
    samples : SurfaceSamples
    cutters : sequence of Cutter
    conditions : Conditions
        Machine and posture range.
    axis : (3,) float
        Unit direction of the part along the spindle.
    table : float, optional
        Height along `axis` below which nothing of a tool may be, mm: axes are left out at which the upper end of every cutter
        would be there. None: no table.
    rows : (m,) int64, optional
        The samples to look at, all by default.
    """
    setup: Axis = (float(axis[0]), float(axis[1]), float(axis[2]))
    if table is None:
        return within_limits(samples, cutters, conditions, setup, rows)
    height = np.maximum(0.0, samples.point @ axis - table)
    steps = np.linspace(0.0, float(np.nanmax(height, initial=0.0)), _HEIGHTS + 1)[1:]
    level, held = np.minimum(np.searchsorted(steps, height), _HEIGHTS - 1), np.zeros(len(samples), bool)
    rows, machine = np.arange(len(samples)) if rows is None else rows, conditions.machine
    for k, high in enumerate(steps):
        mine = rows[level[rows] == k]
        if not len(mine):
            continue
        # The end of the axis lies the length from the tip, and the tip a diameter from the contact at most.
        tilt = max(min(1.0, (float(high) + 2.0 * cutter.radius) / cutter.length) for cutter in cutters)
        cap = float(np.arccos(-tilt))
        limit = cap if machine.tilt_limit is None else min(cap, machine.tilt_limit)
        over = replace(conditions, machine=replace(machine, tilt_limit=limit))
        held |= within_limits(samples, cutters, over, setup, mine)
    return held


@dataclass(slots=True)
class Ranking:
    """The ranking keeps what is known of each direction; it grows as directions are searched.

    Attributes
    ----------
    ready : Prepared
        In any setup, without fixtures.
    candidates : Candidates
    rows : (r,) int64
        Samples on which directions are compared.
    bound : (r, m) bool
        Where the machine holds an axis over the table at all, the face is not stood on, and a posture was found without table
        and machine: what the part itself is in the way of is not searched again in each direction.
    served : mapping
        By candidate, where a posture was found among what holds the part, (r,).
    held : mapping
        By candidate that was searched and can be held, how.
    words : tuple of str
        What may hold the part: `table`, and the words of vises and chucks.
    refused : mapping
        Why nothing holds it in directions that were searched, the first cause first.
    usual : (r,) bool
        Where cutters that finish surfaces serve without table and machine: there no engraving, chamfer or form cutter makes a
        setup look better than it is.
    """

    ready: Prepared
    candidates: Candidates
    rows: Rows
    bound: Table
    served: dict[int, NDArray[np.bool_]]
    usual: NDArray[np.bool_]
    words: tuple[str, ...] = ("table",)
    held: dict[int, Held] = field(default_factory=dict)
    refused: dict[str, None] = field(default_factory=dict)

    @classmethod
    def of(cls, ready: Prepared, words: tuple[str, ...] = ("table",)) -> "Ranking":
        """Rank the directions of a part by the bound; `words` as the attribute.

        Raises
        ------
        OptionError
            In no direction does the machine hold any axis at which a cutter touches.
        """
        candidates, samples = Candidates.of(ready), ready.samples
        open_ = np.flatnonzero(ready.somewhere)
        rows = open_[np.unique(np.linspace(0, len(open_) - 1, min(COMPARED, len(open_))).astype(np.int64))]
        few = replace(ready.conditions, setup=np.array([0.0, 0.0, 1.0]), x=None)
        bound = np.zeros((len(rows), len(candidates.axis)), bool)
        for k, axis in enumerate(candidates.axis):
            # A vise or chuck stands on a riser: beside it a tool may be lower than the part.
            table = float(candidates.lowest[k]) if words == ("table",) else None
            held = holdable(samples, ready.cutters, few, axis, table, rows)
            bound[:, k] = held[rows] & ~np.isin(samples.face[rows], candidates.stands_on[k])
        if not bound.any():
            low, high = np.degrees(few.postures.tilt)
            raise OptionError(
                f"setup auto: in none of {len(candidates.axis)} directions does machine {few.machine.name} hold an axis "
                f"at which a cutter touches with tilts from {low:g} to {high:g} deg; give other tilts or machine"
            )
        surroundings = few.surroundings.alone or few.surroundings
        bare = replace(few.without_machine(), surroundings=surroundings)
        free = usual = _reached(ready, rows, bare, usual=True)
        if len(_usual(ready.cutters)) < len(ready.cutters):
            free = usual | _reached(ready, rows[~usual[rows]], bare, usual=False)
        return cls(ready, candidates, rows, bound & free[rows, None] if free.any() else bound, {}, usual[rows], words)

    @property
    def area(self) -> Floats:
        """The area that each of the rows stands for, (r,)."""
        return np.nan_to_num(self.ready.samples.area[self.rows])

    def share(self, table: Table) -> Floats:
        """The share of area of some columns (r, k): (k,)."""
        return np.asarray(self.area @ table / max(1e-300, float(self.area.sum())))

    def search(self, open_rows: NDArray[np.bool_], most: int) -> None:
        """Search the directions that may serve most of what is left (r,), at most so many, while they may beat what was found."""
        worth = np.array([1.0 if each else _ON_NO_PLANE for each in self.candidates.stands_on])
        upper = worth * self.share(self.bound & open_rows[:, None])
        order = np.lexsort((np.arange(len(upper)), -np.round(upper / _EVEN)))
        best, tried = 0.0, 0
        for k in order.tolist():
            if tried == most or upper[k] <= best + 0.5 * _EVEN:
                break
            if k not in self.served:
                self.served[k] = self._searched(k)
                tried += 1
            best = max(best, float(worth[k] * self.share((self.served[k] & open_rows)[:, None])[0]))

    def _searched(self, k: int) -> NDArray[np.bool_]:
        """Where any cutter has a posture in what holds the part best, of the rows (r,); nowhere if nothing can hold it."""
        x, y, z = self.candidates.axis[k].tolist()
        reached, held, refused = best_hold(self.ready, (x, y, z), self.words, partial(self._among, k), self.area)
        if held is not None:
            self.held[k] = held
        self.refused.update(dict.fromkeys(refused))
        return reached

    def _among(self, k: int, surroundings: Surroundings) -> NDArray[np.bool_]:
        """Where any cutter has a posture among some obstacles, of the rows (r,)."""
        conditions = replace(self.ready.conditions, setup=self.candidates.axis[k], x=None, surroundings=surroundings)
        reached = np.zeros(len(self.ready.samples), bool)
        for usual in (True, False):
            reached |= _reached(self.ready, self.rows[self.bound[:, k] & (self.usual == usual)], conditions, usual=usual)
        return reached[self.rows]

    def choose(self, most: int, without: frozenset[int] = frozenset()) -> tuple[int, ...]:
        """Choose the fewest directions that serve all that any of those searched serves, or as many as there may be.

        Parameters
        ----------
        most : int
        without : set of int
            Directions that failed.

        Returns
        -------
        tuple of int
            Candidates, that with the most area first; none where none serves anything.
        """
        every = sorted(set(self.held) - without)
        flat = self._chosen([k for k in every if self.candidates.stands_on[k]], most)
        free = self._chosen(every, most)
        return self._worth(flat if self._together(flat) >= _ON_NO_PLANE * self._together(free) else free)

    def _worth(self, chosen: tuple[int, ...]) -> tuple[int, ...]:
        """Leave out, one after the other, the setup that alone serves least, while that is too little to clamp the part again."""
        while len(chosen) > 1:
            table = np.stack([self.served[k] for k in chosen], axis=1)
            alone = self.share(table & (table.sum(axis=1) == 1)[:, None])
            least = int(alone.argmin())
            if alone[least] >= _CLAMPED_FOR:
                break
            chosen = chosen[:least] + chosen[least + 1 :]
        return chosen

    def _together(self, chosen: Sequence[int]) -> float:
        """The share of area that some candidates serve together."""
        whole = np.zeros(len(self.rows), bool)
        for k in chosen:
            whole |= self.served[k]
        return float(self.share(whole[:, None])[0])

    def _chosen(self, every: Sequence[int], most: int) -> tuple[int, ...]:
        """The same among some candidates."""
        if not every:
            return ()
        table = np.stack([self.served[k] for k in every], axis=1)
        share = self.share(table)
        chosen = cover(table, range(len(every)), range(len(every)))[0] if most > 1 else []
        if not chosen or len(chosen) > most:
            chosen, uncovered = [], np.ones(len(table), bool)
            while len(chosen) < most:
                gain = self.share(table & uncovered[:, None])
                k = int(np.round(gain / _EVEN).argmax())
                if not gain[k] > 0.0:
                    break
                chosen.append(k)
                uncovered &= ~table[:, k]
        return tuple(every[k] for k in sorted(chosen, key=lambda k: -round(float(share[k]) / _EVEN)))


def _usual(cutters: Sequence[Cutter]) -> list[Cutter]:
    """The cutters that finish surfaces: without engraving, chamfer and form cutters, unless there are no others."""
    return [each for each in cutters if group_of(each) != "last"] or list(cutters)


def _reached(ready: Prepared, rows: Rows, conditions: Conditions, *, usual: bool) -> NDArray[np.bool_]:
    """The samples (n,) of some rows at which any of the cutters, or of the usual ones, has a posture under some conditions."""
    reached, open_rows = np.zeros(len(ready.samples), bool), rows
    # The smallest reaches most.
    for cutter in sorted(_usual(ready.cutters) if usual else ready.cutters, key=lambda each: each.radius):
        if len(open_rows) and conditions.judges(cutter):
            verdicts = blank(len(reached))
            search_postures(contacts_of(ready.samples), open_rows, Context.of(cutter, conditions), verdicts, fixed=True)
            reached |= verdicts.reached
            open_rows = open_rows[~verdicts.reached[open_rows]]
    return reached


def ranked(ready: Prepared, most: int, words: tuple[str, ...] = ("table",)) -> Ranking:
    """Rank the setups of a part, and search those that may be the best one, or the best few together.

    Parameters
    ----------
    ready : Prepared
        In any setup, without fixtures.
    most : int
        Setups that may be proposed together.
    words : tuple of str
        What may hold the part: `table`, and words of vises and chucks.

    Raises
    ------
    OptionError
        As for `Ranking.of`.
    """
    ranking = Ranking.of(ready, words)
    ranking.search(np.ones(len(ranking.rows), bool), _FIRST)
    for number in range(1, most):
        chosen = ranking.choose(number)
        done = np.logical_or.reduce([ranking.served[k] for k in chosen]) if chosen else np.zeros(len(ranking.rows), bool)
        if done.all():
            break
        ranking.search(~done, _MORE)
    return ranking
