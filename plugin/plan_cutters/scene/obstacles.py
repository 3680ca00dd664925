"""Obstacles: triangles in tree order, what they enclose, and how deep one may reach into a cutter."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from itertools import count
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from cad_io.arrays import Floats, Ints, Record, Triangles, rows_by_face
from cad_io.graphs import connected
from cad_io.part.bodies import Body
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.verdicts import depths
from plan_cutters.errors import UnjudgeableError
from plan_cutters.kernels.rows import Tree
from plan_cutters.scene.triangles import divided, pieces
from plan_cutters.scene.work import METER
from plan_cutters.setups.workpiece import hull
from plan_cutters_base.stage_cache import NO_CACHE, Cache

if TYPE_CHECKING:
    from plan_cutters.kernels.linear.tree import WideTree
    from plan_cutters.kernels.material import Solids

#: Boxes that take as long as building a tree, for each triangle.
_BUILT = 15.0
#: Cells along the longest side of the grid that tells what is surely outside.
_CELLS = 64
#: Numbers of what encloses something, each once in a process; 0 is that of nothing.
_KEYS = count(1)
#: A closed body fills its hull but for rounding: by this share of its volume.
_FULL = 1e-9
#: In place of a tree that is made anew; and one of no triangles, with its order.
_NOTHING = Tree(np.zeros((0, 3, 3)), np.zeros((0, 16)), 0)
_NO_TREE = (np.zeros(0, np.int32), _NOTHING.box, 0)
#: Among fixtures, the grid goes this much of the part's longest side beyond it.
_MARGIN = 0.5


@dataclass(frozen=True, eq=False, repr=False)
class Obstacles(Record):
    """Triangles with their bounding tree.

    Raises UnjudgeableError: there are no triangles, or one has a corner that is no point: nothing could be called safe.
    """

    triangles: Triangles  #: As tessellated.
    #: (n,) int8: how often each counts as part of a skin that encloses something; default: nothing is enclosed.
    weight: NDArray[np.int8] = field(default_factory=lambda: np.zeros(0, np.int8))
    #: (k, 2, 3) float: boxes of skins that are not quite closed: nothing in them is surely outside.
    open_boxes: Floats = field(default_factory=lambda: np.zeros((0, 2, 3)))
    gap: float = 0.0  #: Widest gap between triangles of neighbouring faces, mm, that is no way out of a body.
    #: (2, 3) float: box about the part, where fixtures stand around it: there the grid of cells is as fine as without them.
    near: Floats | None = None
    #: So many triangles, the first ones, are in a tree of their own, and all others in a second one. None: one tree holds all.
    first: int | None = None
    _own: ClassVar["Obstacles | None"] = None  #: Those that share the tree of their triangles.

    def __post_init__(self) -> None:
        if not len(self.triangles):
            raise UnjudgeableError("there is nothing that could be in the way: no face has triangles")
        if not (all(np.isfinite(each).all() for each in self._pieces) and np.isfinite(self.triangles.chord_error)):
            raise UnjudgeableError("the part's triangles have corners that are no points: export it again")
        if not len(self.weight):
            object.__setattr__(self, "weight", np.zeros(len(self.triangles), np.int8))

    def __getstate__(self) -> dict[str, Any]:
        # Trees are built again where they are needed.
        return {each.name: getattr(self, each.name) for each in fields(self)}

    @property
    def _pieces(self) -> list[Floats]:
        """Triangles of the first tree, and of the second."""
        return pieces(self.triangles, self.first)

    def among(self, own: "Obstacles") -> "Obstacles":
        """The same, which take the tree of their first triangles from others: those alone, or with more of their own."""
        own = own._own or own
        if own.first is None and self.first == len(own.triangles):
            self.__dict__["_own"] = own
        return self

    @cached_property
    def _built(self) -> tuple[Ints, Floats, int]:
        """Order, boxes and depth of the first tree."""
        return _tree_of(self._pieces[0]) if self._own is None else self._own._built

    @cached_property
    def _more(self) -> tuple[Ints, Floats, int]:
        """The same of the second tree."""
        return _tree_of(self._pieces[1])

    @cached_property
    def _first_vertex(self) -> Floats:
        """Triangles of the first tree in its order."""
        return self._pieces[0].take(self._built[0], axis=0) if self._own is None else self._own._first_vertex

    @cached_property
    def tree(self) -> Tree:
        """The triangles in tree order, and the tree, as the kernels take it."""
        (_, box, depth), (more, more_box, more_depth) = self._built, self._more
        # As much in a budget whether it was made now or kept.
        METER.add(int(_BUILT * len(self.triangles)))
        return Tree(self._first_vertex, box, depth, self._pieces[1].take(more, axis=0), more_box, more_depth)

    @cached_property
    def _moment(self) -> Floats:
        """Moments of the triangles of the first tree."""
        from plan_cutters.kernels.material import MOMENTS, moments

        (order, box, depth), own, weight = self._built, self._own, self.weight[: self.first]
        if not weight.any():
            return np.zeros((len(box), MOMENTS))
        if own is not None and (weight == own.weight).all():
            return own._moment
        return moments(self._first_vertex, np.ascontiguousarray(weight[order]), depth)

    @cached_property
    def solids(self) -> "Solids":
        """The tree and what its triangles enclose, as the searches take it."""
        from plan_cutters.kernels.material import sheet

        return self._filled(self._cells(), self._end) if self.weight.any() else sheet(self.tree)

    def build(self, cache: Cache = NO_CACHE) -> None:
        """Make the tree and `solids`, or take them from a cache: those of the same triangles are the same."""
        if "solids" in self.__dict__:
            return
        if self._own is not None:
            self._own.build(cache)
        triangles = self.triangles
        own = None if self.near is None else triangles.face >= 0
        built, more, solids = cache.cached(
            "tree",
            (triangles.vertex, triangles.chord_error, self.weight, self.open_boxes, self.gap, self.near, own, self.first),
            # The triangles are known, moments soon made, and numbers hold in one process.
            lambda: (
                None if self._own else self._built,
                self._more,
                self.solids._replace(tree=_NOTHING, moment=_NOTHING.box, key=0),
            ),
        )
        if "solids" not in self.__dict__:
            if built is not None:
                self.__dict__["_built"] = built
            self.__dict__["_more"] = more
            key = next(_KEYS) if self.weight.any() else 0
            self.__dict__["solids"] = solids._replace(tree=self.tree, moment=self._moment if key else solids.more_moment, key=key)

    def _filled(self, cells: tuple[NDArray[np.uint8], Floats, float, bool], end: Floats) -> "Solids":
        from plan_cutters.kernels.material import Solids, moments

        tree, weight = self.tree, np.ascontiguousarray(self.weight[self.order])
        grow = np.nan if len(self.open_boxes) else self._extent[2]
        mine, more = np.split(weight, [len(tree.vertex)])
        more_moment = moments(tree.more_vertex, more, tree.more_depth)
        return Solids(tree, mine, self._moment, *cells, end, grow, next(_KEYS), more, more_moment)

    @cached_property
    def corners(self) -> tuple[Floats, Floats]:
        """Least and largest corner (3,) of the box around all triangles."""
        own, vertex = self._own, self._pieces
        each = [] if own is None else [own.corners]
        each += [(some.min(axis=(0, 1)), some.max(axis=(0, 1))) for some in (vertex if own is None else vertex[1:]) if len(some)]
        return np.min([low for low, _ in each], axis=0), np.max([high for _, high in each], axis=0)

    @cached_property
    def convex(self) -> tuple[Floats, ...]:
        """Of each convex body among these, where all are closed and none is hollow, its planes (k, 4): unit normal outwards, and
        the distance of the origin; a point with no number above zero is inside."""
        vertex, weight = self.triangles.vertex, self.weight
        corner, which = np.unique(vertex.reshape(-1, 3), axis=0, return_inverse=True)
        which = which.reshape(-1, 3)
        piece = connected(len(corner), np.concatenate([which[:, :2], which[:, 1:]]))[which[:, 0]]
        bodies = []
        for mine in rows_by_face(piece).values():
            own = vertex[mine] - vertex[mine].mean(axis=(0, 1))
            volume = float(weight[mine] @ np.linalg.det(own)) / 6.0
            if not weight[mine].all() or volume <= 0.0:
                return ()
            outer = hull(vertex[mine].reshape(-1, 3))
            if outer is not None and volume >= (1.0 - _FULL) * outer.volume:
                bodies.append(np.unique(outer.equations, axis=0))
        return tuple(bodies)

    @property
    def _extent(self) -> tuple[Floats, Floats, float]:
        """Corners (3,) of the box around all triangles, and how far skins may be off and open, mm."""
        low, high = self.corners
        return low, high, self.triangles.chord_error + self.gap + 1e-9 * float(np.abs([low, high]).max())

    @property
    def _end(self) -> Floats:
        """Corners (2, 3) of a box around all that may enclose something."""
        low, high, grow = self._extent
        boxes = self.open_boxes.reshape(-1, 2, 3)
        return np.array([np.min([low - grow, *boxes[:, 0]], axis=0), np.max([high + grow, *boxes[:, 1]], axis=0)])

    def _cells(self) -> tuple[NDArray[np.uint8], Floats, float, bool]:
        """Cells (i, j, k), 1 where one is surely outside; the grid's origin (3,), the size of a cell, mm, and whether nothing
        lies beyond the grid."""
        from plan_cutters.kernels.linear.within import mark_shell, mark_small

        low, high, grow = self._extent
        extent = float((high - low).max())
        whole = True
        if self.near is not None:
            extent = float(np.ptp(self.near, axis=0).max())
            first, last = self.near[0] - _MARGIN * extent, self.near[1] + _MARGIN * extent
            whole = bool((low >= first).all() and (high <= last).all())
            low, high = np.maximum(low, first), np.minimum(high, last)
        if not grow < extent / 8:
            # Skins so loose leave no cell that is surely outside, but for what is beyond all of them.
            return np.zeros((1, 1, 1), np.uint8), low - 0.5 * extent, 2.0 * extent + 1e-9, whole and self.near is None
        size = max(extent / _CELLS, 4.0 * grow)
        origin = low - 1.5 * size
        cell = np.zeros(tuple(np.ceil((high - origin) / size + 1.5).astype(int)), np.uint8)
        first, last, longest = low - grow - 2.0 * size, high + grow + 2.0 * size, 8.0 * size
        for vertex in map(np.ascontiguousarray, self._pieces):
            if self.near is None:
                mark_shell(vertex, grow, origin, size, cell)
                continue
            # Of a large one that stands askew, the kernel would look at every cell of the box around it.
            large = np.zeros(len(vertex), bool)
            mark_small(vertex, (first, last), longest, grow, origin, size, cell, large)
            mark_shell(divided(vertex[large], first, last, longest), grow, origin, size, cell)
        # What is connected with the corner, past every skin, is outside.
        region, _ = ndimage.label(cell == 0)
        outside = region == region[0, 0, 0] if whole else self._open_air(region, origin, size)
        for box in self.open_boxes:
            first, last = (np.clip((corner - origin) / size, 0, None).astype(int) for corner in box)
            outside[first[0] : last[0] + 1, first[1] : last[1] + 1, first[2] : last[2] + 1] = False
        return outside.astype(np.uint8), origin, size, whole

    def _open_air(self, region: NDArray[np.int32], origin: Floats, size: float) -> NDArray[np.bool_]:
        """Cells (i, j, k) that are outside, of connected regions of a grid beyond which fixtures reach.

        Where a region leaves the grid the part is all within it, so fixtures alone may enclose it there; and these are closed.
        """
        from plan_cutters.kernels.material import MAYBE_INSIDE, windings

        rim = np.ones(region.shape, bool)
        rim[1:-1, 1:-1, 1:-1] = False
        numbers, first = np.unique(np.where(rim, region, 0), return_index=True)
        point = origin + (np.stack(np.unravel_index(first, region.shape), axis=1) + 0.5) * size
        mine = self.triangles.face < 0
        fixtures = Obstacles(self.triangles.take(mine), self.weight[mine])
        distance = np.zeros(len(point))
        if fixtures.weight.any():
            windings(np.ascontiguousarray(point), fixtures._everywhere, distance)
        return np.isin(region, numbers[(numbers > 0) & (distance < MAYBE_INSIDE)])

    @property
    def _everywhere(self) -> "Solids":
        """The tree and what its triangles enclose, with no cell that is surely outside."""
        unknown = (np.zeros((1, 1, 1), np.uint8), np.zeros(3), 1.0, False)
        return self._filled(unknown, np.array([[-np.inf] * 3, [np.inf] * 3]))

    @cached_property
    def wide_tree(self) -> "WideTree":
        """All triangles in one tree, as posture maps take it, eight boxes at a time."""
        from plan_cutters.kernels.linear.tree import WideTree, build_apart, wide_tree

        if self.first is None:
            return WideTree(*wide_tree(self.tree))
        # Near the part a search looks at its own triangles nearly alone.
        apart = self.near is not None and self.triangles.face < 0
        rows = np.argsort(np.broadcast_to(apart, len(self.triangles)), kind="stable")
        vertex, (low, high) = self.triangles.vertex[rows], self.corners
        order, box, depth = build_apart(vertex, len(rows) - int(np.sum(apart)), 10.0 * float((high - low).max()))
        return WideTree(*wide_tree(Tree(vertex[order], box, depth)))

    @cached_property
    def faces(self) -> Ints:
        """Face numbers (n,) in tree order."""
        return np.ascontiguousarray(self.triangles.face[self.order])

    @property
    def order(self) -> Ints:
        """Rows (n,) of `triangles` in tree order."""
        first, more = self._built[0], self._more[0]
        return np.concatenate([first, len(first) + more]) if len(more) else first

    def face(self, triangle: int) -> int:
        """Face number of a triangle in tree order."""
        return int(self.faces[triangle])

    def depths(self, tolerance: float) -> tuple[float, float]:
        """Depths that are safe and that are blocked among these triangles, mm (`tolerance.depths`)."""
        return depths(tolerance, self.triangles.chord_error)

    def rows_in(self, low: Floats, high: Floats) -> NDArray[np.int64]:
        """Rows of `triangles`, ascending, of those whose boxes meet a box (3,), (3,)."""
        from plan_cutters.kernels.linear.within import Space, in_box

        met = np.zeros(len(self.triangles), bool)
        in_box(self.tree, Space(np.zeros(3), np.eye(3), low, high, np.inf), met)
        return np.sort(self.order[met])

    def lowest(self, direction: Floats) -> Floats:
        """Triangles (k, 3, 3) of which one is the lowest along a direction: no other may be."""
        each = [(some, (some.reshape(-1, 3) @ direction).reshape(-1, 3).min(axis=1)) for some in self._pieces if len(some)]
        most = min(float(height.min()) for _, height in each) + 1e-9 * (1.0 + float(np.abs(self.corners).max()))
        return np.concatenate([some[height <= most] for some, height in each])

    @cached_property
    def skin(self) -> "Obstacles":
        """The same triangles, which enclose nothing."""
        bare = Obstacles(self.triangles, first=self.first)
        bare.__dict__.update(_built=self._built, _more=self._more, _first_vertex=self._first_vertex, tree=self.tree)
        return bare

    def skin_of(self, body: Body) -> "Obstacles":
        """The triangles of one body; their tree is built once."""
        key = (tuple(body.faces), tuple(body.sign))
        if key in self._skins:
            return self._skins[key]
        own = self._own
        if own is not None and not np.isin(self.triangles.face[self.first :], list(body.faces)).any():
            result = own.skin_of(body)
        else:
            mine = self.rows_of(body.faces)
            triangles = self.triangles.take(mine)
            # A fixture is one body whatever it consists of, and its triangles know what they count.
            weight = self.weight[mine] if min(body.faces) < 0 else weights(triangles, [body])
            whole = len(mine) == len(self.triangles) and (weight == self.weight).all()
            result = self if whole else Obstacles(triangles, weight)
        self._skins[key] = result
        return result

    @cached_property
    def _skins(self) -> "dict[tuple[tuple[int, ...], tuple[int, ...]], Obstacles]":
        return {}

    @cached_property
    def _rows(self) -> dict[int, NDArray[np.int64]]:
        return rows_by_face(self.triangles.face)

    def rows_of(self, faces: Iterable[int]) -> NDArray[np.int64]:
        """Rows (k,) of the triangles of some faces, ascending."""
        none = np.zeros(0, np.int64)
        return np.sort(np.concatenate([none, *(self._rows.get(number, none) for number in set(faces))]))

    def holds(
        self, tool: Assembly, contact: Floats, normal: Floats, tilt_direction: Floats, tilt: Floats, *, certain: bool = False
    ) -> NDArray[np.bool_]:
        """Whether cutters that touch no skin lie within a body, or may: (n,).

        `contact`, `normal`, `tilt_direction` (n, 3) float. `tilt` (n,) float: rad. `certain`: only those of which it is sure.
        """
        from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE, windings

        point = tool.on_axis(contact, normal, tilt_direction, tilt)
        out = np.empty(len(point))
        windings(np.ascontiguousarray(point), self.solids, out)
        return np.asarray(out >= SURELY_INSIDE if certain else ~(out < MAYBE_INSIDE))


def _tree_of(vertex: Floats) -> tuple[Ints, Floats, int]:
    """Order, boxes and depth of the tree of triangles."""
    from plan_cutters.kernels.linear.tree import build

    if not len(vertex):
        return _NO_TREE
    order, box, depth = build(np.ascontiguousarray(vertex))
    return order, box, int(depth)


def weights(triangles: Triangles, bodies: Sequence[Body]) -> NDArray[np.int8]:
    """Weights (n,) of triangles from the faces and signs of bodies."""
    by_face = np.zeros(1 + max([int(triangles.face.max(initial=0)), *(max(body.faces) for body in bodies)]), np.int8)
    for body in bodies:
        np.add.at(by_face, list(body.faces), np.array(body.sign, np.int8))
    return by_face[triangles.face]
