"""Triangles in a face's parameter plane to begin with: of our own, and where these fail, of the kernel's mesher.

They begin and end at the face's border curves, sampled, with nodes that these share. Ours are cells of a grid as fine as the
surface bends, and between them and the face's border a constrained Delaunay triangulation. Nothing in it can run for ever.
"""

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.GeomAbs import GeomAbs_C2, GeomAbs_Line
from OCP.TopoDS import TopoDS_Face
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints
from cad_io.face.trim import Trim, continuing
from cad_io.kernel import bounding, interval_ends, may_refuse, points_on
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.tessellate.mesh import BorderCurve, UVMesh, bordered, kernel_start
from cad_io.tessellate.planar import cells, odd, places, triangulated
from plan_cutters_base.forks import TimeLimit

#: Chords of a bent border curve, at least; how often one is halved, at most.
_CHORDS, _HALVINGS = 4, 14
#: A node so near to a chord is on it: a share of the border's extent.
_MET = 1e-12
#: Shares of a chord at which a curve is held against it.
_TRIED = (0.25, 0.5, 0.75)


class Use(NamedTuple):
    """One use of an edge: its curve in the parameter plane, the ends of its parameter, and whether it runs along the curve."""

    curve: BRepAdaptor_Curve2d
    first: float
    last: float
    forward: bool


class Sampled(NamedTuple):
    """A use with places along it: parameters (k,) and where the curve is there (k, 2), in the direction of the use."""

    use: Use
    parameter: Floats
    on_curve: Floats


class Outline(NamedTuple):
    """The border of a face as chords between nodes uv (n, 2); nodes of each use are rows of them (k,).

    Where a use ends beside the start of the one that continues it, both have that start for a node.
    """

    uv: Floats
    nodes: tuple[Ints, ...]
    uses: tuple[Sampled, ...]

    @property
    def chords(self) -> Ints:
        """Nodes (k, 2) of all chords, those without length left out."""
        pairs = np.concatenate([np.stack([each[:-1], each[1:]], axis=1) for each in self.nodes])
        return pairs[pairs[:, 0] != pairs[:, 1]]


class Steps(NamedTuple):
    """How long chords may be.

    bend (2,): of a step (du, dv) the surface bends by at most `(bend * step^2).sum()`, about; mm for a step of 1. chord: how far
    the surface may be from a straight step, mm. scale (2,): mm per unit of u and v. sag: how far a curve may be from it, mm.
    """

    bend: Floats
    chord: float
    scale: Floats
    sag: float

    def pieces(self, step: Floats) -> NDArray[np.int64]:
        """Into how many pieces to cut steps (n, 2)."""
        bent = (self.bend * step * step).sum(axis=-1)
        return np.maximum(1, np.ceil(np.sqrt(bent / (8.0 * self.chord)) - 1e-6)).astype(np.int64)


def uses_of(face: TopoDS_Face) -> list[Use]:
    """The uses of a face's edges, those inside of it left out."""
    forward, edges = bounding(face)
    curves = [(BRepAdaptor_Curve2d(edge, forward), way) for edge, way in edges]
    return [Use(curve, curve.FirstParameter(), curve.LastParameter(), way > 0) for curve, way in curves]


def outline_of(uses: Sequence[Use], steps: Steps, most: int) -> Outline | None:
    """The border as chords; None where there is none, it has no place, or takes more than so many nodes."""
    sampled: list[Sampled] = []
    total = 0
    for use in uses:
        sampled.append(_sampled(use, steps, most))
        total += len(sampled[-1].parameter)
        if total > most or not np.isfinite(sampled[-1].on_curve).all():
            return None
    return joined(sampled, steps.scale) if sampled else None


def joined(sampled: Sequence[Sampled], scale: Floats) -> Outline:
    """The outline of sampled uses: nodes at one place are one, and each use ends where the one that continues it starts."""
    start, end = (np.array([each.on_curve[k] for each in sampled]) for k in (0, -1))
    following = continuing(start, end, scale)
    at = np.concatenate(
        [np.concatenate([each.on_curve[:-1], start[next_][None]]) for each, next_ in zip(sampled, following, strict=True)]
    )
    first, row = places(at)
    ends = np.cumsum([len(each.parameter) for each in sampled])
    return Outline(at[first], tuple(np.split(row.astype(np.int32), ends[:-1])), tuple(sampled))


def cut_where_they_meet(outline: Outline) -> Outline:
    """The outline with nodes where its chords meet each other: for a border that crosses or touches itself, or runs along itself.

    A new node lies on the chord, at the parameter that is as far along; the curve may pass beside it.
    """
    ends = np.concatenate([np.stack([each[:-1], each[1:]], axis=1) for each in outline.nodes])
    lines = shapely.linestrings(outline.uv[ends])
    near = _MET * float(np.ptp(outline.uv, axis=0).max())
    met = shapely.get_coordinates(shapely.union_all(lines))
    known = cKDTree(outline.uv)
    met = np.unique(met[known.query(met)[0] > near], axis=0)
    nodes = np.concatenate([outline.uv, met])
    row, chord = shapely.STRtree(lines).query(shapely.points(nodes), predicate="dwithin", distance=near)
    apart = (row != ends[chord, 0]) & (row != ends[chord, 1])
    row, chord = row[apart], chord[apart]
    start, step = nodes[ends[chord, 0]], nodes[ends[chord, 1]] - nodes[ends[chord, 0]]
    share = ((nodes[row] - start) * step).sum(axis=1) / (step * step).sum(axis=1)
    within = (share > 0.0) & (share < 1.0)
    row, chord, share = row[within], chord[within], share[within]
    order = np.lexsort((share, chord))
    row, chord, share = row[order], chord[order], share[order]
    cuts, first = [], 0
    for mine, each in zip(outline.nodes, outline.uses, strict=True):
        here = (chord >= first) & (chord < first + len(mine) - 1)
        at = chord[here] - first
        t = each.parameter
        t = np.insert(t, at + 1, t[at] + share[here] * (t[at + 1] - t[at]))
        on_curve = points_on(each.use.curve, t)
        cuts.append((np.insert(mine, at + 1, row[here]), Sampled(each.use, t, on_curve)))
        first += len(mine) - 1
    return Outline(nodes, tuple(mine for mine, _ in cuts), tuple(each for _, each in cuts))


def _sampled(use: Use, steps: Steps, most: int) -> Sampled:
    t = _straight(use, steps, most) if use.curve.GetType() == GeomAbs_Line else _bent(use, steps, most)
    if not use.forward:
        t = t[::-1]
    return Sampled(use, t, points_on(use.curve, t))


def _straight(use: Use, steps: Steps, most: int) -> Floats:
    ends = np.array([use.curve.Value(t).Coord() for t in (use.first, use.last)])
    if not np.isfinite(ends).all():
        return np.array([use.first, use.last])
    return np.linspace(use.first, use.last, 1 + min(most, int(steps.pieces(ends[1] - ends[0]))))


def _bent(use: Use, steps: Steps, most: int) -> Floats:
    """Parameters at which a curve is cut so that its chords are near it, and short enough."""
    value = use.curve.Value
    spans = use.curve.NbIntervals(GeomAbs_C2)
    knots = interval_ends(spans, use.curve.Intervals, GeomAbs_C2)
    # Every so many spans together: what is between is seen when chords are tried.
    wanted = np.arange(_CHORDS + 1) / _CHORDS * spans
    t = np.interp(wanted, np.arange(spans + 1), knots)
    t[0], t[-1] = use.first, use.last
    (per_u, per_v), (bend_u, bend_v) = steps.scale.tolist(), steps.bend.tolist()
    limit, sag = 8.0 * steps.chord, steps.sag * steps.sag
    parameters = [float(t[0])]
    here, at = float(t[0]), value(float(t[0])).Coord()
    for last in t[1:].tolist():
        pending = [(last, value(last).Coord(), 0)]
        while pending:
            there, to, halvings = pending[-1]
            du, dv = to[0] - at[0], to[1] - at[1]
            far = halvings < _HALVINGS and len(parameters) <= most
            if far and bend_u * du * du + bend_v * dv * dv <= limit:
                far = False
                for share in _TRIED:
                    u, v = value(here + share * (there - here)).Coord()
                    u, v = (u - at[0]) * per_u, (v - at[1]) * per_v
                    along_u, along_v = du * per_u, dv * per_v
                    length = along_u * along_u + along_v * along_v
                    on = (u * along_u + v * along_v) / length if length > 0.0 else 0.0
                    on = min(1.0, max(0.0, on))
                    if (u - on * along_u) ** 2 + (v - on * along_v) ** 2 > sag:
                        far = True
                        break
            if far:
                middle = 0.5 * (here + there)
                pending[-1] = (there, to, halvings + 1)
                pending.append((middle, value(middle).Coord(), halvings + 1))
                continue
            parameters.append(there)
            here, at = there, to
            pending.pop()
    return np.array(parameters)


#: Places each way where bends are looked at, to lay out a grid.
_LOOKED = 13
#: Nodes of a border, and cells of a grid, at most.
_NODES, _CELLS = 20_000, 100_000
#: Chords of a border that cross are made this much nearer to it, so many times.
_NEARER, _TIMES = 8.0, 5
#: How much of a steps' length one along which the surface is straight counts.
_STRAIGHT = 0.03
#: How far a grid's line may be moved to where an edge ends, in cells; lines more than cells, at most.
_MOVED, _MORE = 0.35, 16
_TURNS = 60  # of a search for a place on a curve


#: What the kernel's mesher is asked for: rad, and that once more, finer, where it makes nothing.
_ANGLE, _FINER = 0.5, 0.02
#: How far chords of a border may be from it, as a share of the triangles' chord error: coarser ones would pass each other on
#: narrow faces when they are bent onto their curves.
_SAG = 1 / 8
#: How much more area than a face's its triangles may have in the parameter plane.
_TOO_LARGE = 1.1
#: Processor time of the kernel's mesher, s: for a face, and for all.
_SECONDS, _TOTAL = 5.0, 20.0

#: Told who is at work, `kernel` or `own`, and at which face (0: all of them): for who watches the time.
At = Callable[[str, int], None]


def starts(
    part: Part, numbers: Sequence[int], chord: float, at: At = lambda who, face: None, *, again: bool = False
) -> tuple[dict[int, UVMesh], dict[int, str]]:
    """Triangles of faces to begin with, whose distance from them is about `chord`, mm; and why a face has none.

    at: told who is at work at which face. again: where the kernel's mesher has been at a face, for whatever chord error, take
    what it made, also if that was nothing.
    """
    meshes: dict[int, UVMesh | None] = {}
    why: dict[int, str] = {}
    remaining = _TOTAL
    for number in numbers:
        at("own", number)
        meshes[number] = own_start(part, number, chord)
        if meshes[number] is not None:
            continue
        if not (again and number in part.meshed):
            at("kernel", number)
            if remaining <= 0.0:
                why[number] = "the kernel's mesher, which it is left to, has spent its time on others"
                continue
            part.meshed[number], spent = _second(part, number, chord, min(remaining, _SECONDS))
            remaining -= spent
        meshes[number], reason = part.meshed[number]
        if reason:
            why[number] = reason
    return {number: mesh for number, mesh in meshes.items() if mesh is not None}, why


def _second(part: Part, number: int, chord: float, seconds: float) -> tuple[tuple[UVMesh | None, str], float]:
    """Mesh a face with the kernel's mesher: the mesh, or None and the reason; and the seconds it took."""
    try:
        mesh, spent = kernel_start(part, number, chord, _ANGLE, seconds)
        if mesh is None or not _fits(mesh, part.trim(number)):
            mesh, more = kernel_start(part, number, _FINER * chord, 0.2 * _ANGLE, seconds)
            spent += more
        if mesh is not None and not _fits(mesh, part.trim(number)):
            mesh = None
    except TimeLimit:
        return (None, "the kernel's mesher, which it is left to, does not end on it"), _SECONDS
    return (mesh, "" if mesh is not None else "the kernel's mesher fails on it"), spent


def _fits(mesh: UVMesh, trim: Trim | None) -> bool:
    """Whether triangles have no more area in the parameter plane than the trim: where borders cross themselves, the kernel's
    mesher may cover something else than what they enclose. Whether they have less is asked of the finished triangles."""
    if trim is None:
        return True
    a, b, c = np.moveaxis(mesh.uv[mesh.corner], 1, 0)
    ab, ac = b - a, c - a
    return 0.5 * float(np.abs(ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]).sum()) <= _TOO_LARGE * trim.uv_area


def expected(part: Part, numbers: Sequence[int], chord: float) -> float:
    """How many triangles faces take for a chord error, mm, about: of each at least two."""
    total = 0.0
    for number in numbers:
        trim = part.trim(number)
        with np.errstate(all="ignore"):
            density = None if trim is None else _density(part.surface(number), trim)
        total += 2.0
        if trim is not None and density is not None:
            wide = (trim.box[1] - trim.box[0], trim.box[3] - trim.box[2])
            share = trim.uv_area / (wide[0] * wide[1])
            steps = [_steps(each, width, chord).sum() for each, width in zip(density, wide, strict=True)]
            total += 2.0 * share * float(max(1.0, steps[0]) * max(1.0, steps[1]))
    return total


def own_start(part: Part, number: int, chord: float) -> UVMesh | None:
    """Triangles of our own; None where there are none that cover the face. As in `starts`."""
    with contextlib.suppress(shapely.errors.ShapelyError), may_refuse():
        return _own_start(part, number, chord)
    return None


def _own_start(part: Part, number: int, chord: float) -> UVMesh | None:
    trim = part.trim(number)
    if trim is None or not trim.closed:
        return None
    surface, uses = part.surface(number), uses_of(part.face(number))
    with np.errstate(all="ignore"):
        density = _density(surface, trim)
    if density is None:
        return None
    bend = np.array([each.max() for each in density])
    steps = Steps(bend, 0.5 * chord, trim.scale, _SAG * chord)
    lines = [_lines(each, trim.box[2 * k : 2 * k + 2], chord) for k, each in enumerate(density)]
    if trim.rectangular:
        mesh = _on_grid(surface, trim, uses, (lines[0], lines[1]))
        if mesh is not None:
            return mesh
    for outline in _outlines(uses, steps):
        filled = triangulated(outline.uv, outline.chords, (lines[0], lines[1]), _metric(bend, trim, lines))
        if filled is not None:
            return _finished(outline, *filled, surface)
    return None


def _outlines(uses: Sequence[Use], steps: Steps) -> Iterator[Outline]:
    """The border as chords, nearer and nearer to it, for they may cross where it does not; then cut where they meet."""
    for time in range(_TIMES):
        outline = outline_of(uses, steps._replace(sag=steps.sag / _NEARER**time), _NODES)
        if outline is None:
            break
        yield outline
    if (outline := outline_of(uses, steps, _NODES)) is not None:
        yield cut_where_they_meet(outline)


def _density(surface: Surface, trim: Trim) -> tuple[Floats, Floats] | None:
    """How much a surface bends at each place (k,) along u, and along v, mm for a squared step of 1; None where not known."""
    u0, u1, v0, v1 = trim.box
    share = (np.arange(_LOOKED) + 0.5) / _LOOKED
    u, v = (each.ravel() for each in np.meshgrid(u0 + share * (u1 - u0), v0 + share * (v1 - v0), indexing="ij"))
    density = np.linalg.norm(surface.second(u, v), axis=2).reshape(_LOOKED, _LOOKED, -1)
    if not np.isfinite(density).all():
        return None
    # The twist is shared out in the ratio in which steps of one length stand.
    ratio = trim.scale[0] / trim.scale[1]
    uu, vv, uv = density[:, :, 3], density[:, :, 4], density[:, :, 5]
    return (uu + ratio * uv).max(axis=1), (vv + uv / ratio).max(axis=0)


def _lines(density: Floats, ends: tuple[float, ...], chord: float) -> Floats:
    """Lines from end to end, nearer to each other where the surface bends more."""
    total = np.concatenate([[0.0], np.cumsum(_steps(density, ends[1] - ends[0], chord))])
    count = max(1, int(min(np.ceil(total[-1] - 1e-6), _CELLS)))
    if count == 1 or not total[-1] > 0.0:
        return np.array(ends)
    along = np.linspace(ends[0], ends[1], len(total))
    parameters = np.interp(np.linspace(0.0, total[-1], count + 1), total, along)
    parameters[0], parameters[-1] = ends
    return parameters


def _steps(density: Floats, width: float, chord: float) -> Floats:
    """How many steps it takes through each of the places (k,) at which bends are known."""
    # Both ways together may be off by the chord: each by half of it.
    return np.asarray(np.sqrt(np.maximum(density, 1e-3 * density.max()) / (4.0 * chord)) * (width / len(density)))


def _metric(bend: Floats, trim: Trim, lines: list[Floats]) -> Floats:
    """Return the factors of u and v after which triangles of a good shape have an even chord error both ways."""
    if max(map(len, lines)) == 2:
        return trim.scale
    wide = np.array([trim.box[1] - trim.box[0], trim.box[3] - trim.box[2]])
    steps = np.sqrt(bend) * wide
    return np.asarray(np.maximum(steps, _STRAIGHT * steps.max()) / wide)


def _finished(outline: Outline, uv: Floats, corner: Ints, surface: Surface) -> UVMesh:
    border = tuple(
        BorderCurve(nodes, each.parameter, each.use.curve) for nodes, each in zip(outline.nodes, outline.uses, strict=True)
    )
    return bordered(UVMesh(uv, corner, border), [each.on_curve for each in outline.uses], surface)


def _axes(lines: tuple[Floats, Floats], sides: list[tuple[int, bool, tuple[float, float]]]) -> tuple[Floats, Floats] | None:
    """Lines of a grid along u and v, through the ends of its sides; None where they cannot be laid, or part too many cells."""
    ends = [np.array([t for along, _, span in sides if along == k for t in span]) for k in range(2)]
    u, v = _through(lines[0], ends[0]), _through(lines[1], ends[1])
    return None if u is None or v is None or (len(u) - 1) * (len(v) - 1) > _CELLS else (u, v)


def _on_grid(surface: Surface, trim: Trim, uses: list[Use], lines: tuple[Floats, Floats]) -> UVMesh | None:
    """A whole rectangle of the parameter plane: cells alone; None where its border does not run along its sides."""
    sides = [_side(use, trim) for use in uses]
    if any(side is None for side in sides):
        return None
    known = [side for side in sides if side is not None]
    grid = _axes(lines, known)
    if grid is None:
        return None
    filled, corner = cells(np.ones((len(grid[0]) - 1, len(grid[1]) - 1), bool))
    uv = np.stack([each.ravel() for each in np.meshgrid(*grid, indexing="ij")], axis=1)
    number = np.arange(len(uv), dtype=np.int32).reshape(len(grid[0]), len(grid[1]))
    border, on_curve = [], []
    for use, (along, far, span) in zip(uses, known, strict=True):
        low, high = (int(np.argmin(np.abs(grid[along] - t))) for t in sorted(span))
        way = slice(None, None, 1 if span[0] < span[1] else -1)
        parameter = _parameter_at(use, along, grid[along][low : high + 1][way])
        if parameter is None:
            return None
        row = -1 if far else 0
        nodes = (number[:, row] if along == 0 else number[row])[low : high + 1][way]
        border.append(BorderCurve(nodes, parameter, use.curve))
        on_curve.append(np.array([use.curve.Value(t).Coord() for t in parameter.tolist()]))
    chords = np.concatenate([np.stack([each.nodes[:-1], each.nodes[1:]], axis=1) for each in border])
    outer = [np.stack([line[:-1], line[1:]], axis=1) for line in (number[0], number[-1], number[:, 0], number[:, -1])]
    if len(chords) != len(np.concatenate(outer)) or not np.array_equal(odd(chords), odd(np.concatenate(outer))):
        return None
    return bordered(UVMesh(uv, filled[corner].astype(np.int32), tuple(border)), on_curve, surface)


def _side(use: Use, trim: Trim) -> tuple[int, bool, tuple[float, float]] | None:
    """The side of the box that a curve runs along: 0 for one along u, whether it is the one with the larger other parameter, and
    from where to where; None for a curve that runs along none."""
    at = np.array([use.curve.Value(t).Coord() for t in np.linspace(use.first, use.last, 5).tolist()])
    low, high = np.array(trim.box[0::2]), np.array(trim.box[1::2])
    for along in range(2):
        other = 1 - along
        for far, place in ((False, low[other]), (True, high[other])):
            if (np.abs(at[:, other] - place) * trim.scale[other] <= trim.tolerance).all():
                step = np.diff(at[:, along])
                if (step > 0).all() or (step < 0).all():
                    return along, far, (float(at[0, along]), float(at[-1, along]))
    return None


def _through(lines: Floats, ends: Floats) -> Floats | None:
    """Lines that go through places where edges end, moved there or added; None where that takes many more."""
    low, high = lines[0], lines[-1]
    near = 1e-9 * (high - low)
    wanted = np.unique(np.clip(ends, low, high))
    wanted = wanted[(wanted > low + near) & (wanted < high - near)]
    if not len(wanted):
        return lines
    wanted = wanted[np.concatenate([[True], np.diff(wanted) > near])]
    if len(wanted) > len(lines) + _MORE:
        return None
    inner = lines[1:-1]
    allowed = _MOVED * np.interp(inner, 0.5 * (lines[1:] + lines[:-1]), np.diff(lines)) if len(inner) else inner
    after = np.clip(np.searchsorted(wanted, inner), 1, len(wanted) - 1) if len(wanted) > 1 else np.zeros(len(inner), int)
    apart = np.minimum(np.abs(inner - wanted[after]), np.abs(inner - wanted[np.maximum(after - 1, 0)]))
    return np.unique(np.concatenate([[low], inner[apart > allowed], wanted, [high]]))


def _parameter_at(use: Use, along: int, at: Floats) -> Floats | None:
    """Parameters (k,) at which a curve passes values of u (0) or v (1), which run with or against it."""

    def off(t: float, wanted: float) -> float:
        point = use.curve.Value(t)
        return float(point.X() if along == 0 else point.Y()) - wanted

    ends = (use.first, use.last)
    start, stop = off(ends[0], 0.0), off(ends[1], 0.0)
    if start == stop:
        return None
    order = 1.0 if stop > start else -1.0
    parameters = []
    for wanted in at.tolist():
        low, high = ends
        t = low + (wanted - start) / (stop - start) * (high - low)
        t = min(max(t, low), high)
        for _ in range(_TURNS):
            here = off(t, wanted)
            if abs(here) <= 1e-14 * max(abs(start), abs(stop)):
                break
            if order * here < 0:
                low = t
            else:
                high = t
            # A step along the whole curve's slope, where it leads between.
            t -= here / (stop - start) * (ends[1] - ends[0])
            if not low < t < high:
                t = 0.5 * (low + high)
        parameters.append(t)
    ordered = np.array(parameters)
    # Its own ends are those of the curve.
    backwards = (at[0] > at[-1]) == (stop > start)
    ordered[0], ordered[-1] = (ends[1], ends[0]) if backwards else ends
    step = np.diff(ordered)
    return ordered if (step > 0).all() or (step < 0).all() else None
