"""The arrays of the review page, and how they are packed; `docs/review_page_data.md` says what is in them."""

import base64
import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from cad_io.arrays import FaceGrid, Floats, Ints, SurfaceSamples
from cad_io.write.render_mesh import Mesh, RenderMesh
from plan_cutters.document.build import fixtures_in
from plan_cutters.domain.figures import mm
from plan_cutters.domain.travel import tips
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.model import WitnessEntry
from plan_cutters.plan_file.words.cutters import ranked_spots
from plan_cutters.report.protocol import Judged


def row_of(samples: SurfaceSamples, witness: WitnessEntry) -> int:
    """The row of a witness's sample; a ValueError where the samples have none such: the witness is of another plan."""
    point, row = np.array(witness.point), witness.sample
    there = 0 <= row < len(samples) and samples.face[row] == int(witness.face[1:])
    # A point without coordinates is at no distance.
    if not there or not np.linalg.norm(samples.point[row] - point) <= 1e-6 * max(1.0, float(np.abs(point).max())):
        raise ValueError(f"no sample of {witness.face} lies at the point of this witness: it is of another plan")
    return row


#: Spots of the cutter that is shown, and of each other one.
_SPOTS, _OTHER_SPOTS = 20, 6
#: Instead of a tilt: there is none.
NO_TILT = 65535
#: Parts of the radius of a flat in which distances from its axis are told; what is so near to the rim is on it.
SHARES, _RIM = 10000, 1e-6


@dataclass(frozen=True, slots=True)
class Spot:
    """A witness of the plan, and the row of its sample."""

    cutter: str
    sample: int
    witness: WitnessEntry


def spots_of(result: Judged) -> tuple[list[Spot], dict[str, int]]:
    """The worst spots, those of the cutter that is shown first; and by cutter how many more the plan has."""
    spots, more = [], {}
    for entry in sorted(result.plan.cutters, key=lambda c: c.id != result.shown):
        most = _SPOTS if entry.id == result.shown else _OTHER_SPOTS
        ranked = ranked_spots(entry.witnesses)
        spots += [Spot(entry.id, row_of(result.samples, w), w) for w in ranked[:most]]
        if len(ranked) > most:
            more[entry.id] = len(ranked) - most
    return spots, more


def turned_by(samples: Any, tilt_direction: Any) -> NDArray[np.int16]:
    """Angles (n,) from `direction_max` to directions (n, 3) about the normal, in hundredths of degrees; 0 where there is none."""
    known = np.isfinite(tilt_direction).all(axis=1)
    tilt_direction, first, normal = (np.nan_to_num(a) for a in (tilt_direction, samples.direction_max, samples.normal))
    angle = np.degrees(np.arctan2((tilt_direction * np.cross(normal, first)).sum(axis=1), (tilt_direction * first).sum(axis=1)))
    return np.where(known, np.round(100 * angle), 0).astype(np.int16)


def shares(tilt_direction: Any) -> NDArray[np.uint16] | None:
    """How far contacts (n,) are from the tool axis, in parts of `SHARES` of the flat's radius, from tilt directions (n, 3); None
    where all are at its rim.
    """
    length = np.linalg.norm(tilt_direction, axis=1)
    short = length < 1.0 - _RIM
    return np.where(short, np.round(SHARES * np.where(short, length, 1.0)), SHARES).astype(np.uint16) if short.any() else None


def tilt_and_direction(samples: Any, reach: Verdicts) -> tuple[NDArray[np.uint16], NDArray[np.int16]]:
    """Postures found: tilts (n,), NO_TILT where there is none, and angles (n,) from `direction_max` to the lean, in hundredths of
    degrees."""
    known = np.isfinite(reach.tilt) & reach.reached
    tilt = np.where(known, np.round(100 * np.degrees(np.where(known, reach.tilt, 0.0))), NO_TILT).astype(np.uint16)
    return tilt, np.where(known, turned_by(samples, reach.tilt_direction), 0).astype(np.int16)


#: Filters, the simpler ones first: the first of those that come out smallest is taken.
FILTERS = ("", "delta", "delta_z", "delta2_z")
_TYPES = {"u1": np.uint8, "u2": np.uint16, "u4": np.uint32, "i2": np.int16, "i4": np.int32, "f2": np.float16}
_WORD = {np.dtype(kind): word for word, kind in _TYPES.items()}
#: Filters are tried on so many rows.
_TRIED = 4096
_QUICK = 1  # how hard deflate tries then
#: Quantised coordinates run from 0 to this.
MOST = 65535
#: Octahedral coordinates of normals, each from -1 to 1, are counted in these steps.
FINE, COARSE = 32767, 127


def filtered(array: NDArray[Any], name: str) -> bytes:
    """The bytes of an array under a filter: differences by column, columns one after the other, planes of bytes."""
    size = array.dtype.itemsize
    bits: NDArray[Any] = np.ascontiguousarray(array.astype(array.dtype.newbyteorder("<"))).view(f"<u{size}")
    bits = bits.reshape(len(array), math.prod(array.shape[1:]))
    for _ in range({"delta": 1, "delta2": 2}.get(name.removesuffix("_z"), 0)):
        bits = np.concatenate([bits[:1], bits[1:] - bits[:-1]])
    if name.endswith("_z"):
        signed = bits.view(f"<i{size}")
        bits = ((signed << 1) ^ (signed >> (8 * size - 1))).view(f"<u{size}")
    column = np.ascontiguousarray(bits.T).reshape(-1)
    return column.view(np.uint8).reshape(-1, size).T.tobytes()


@dataclass(frozen=True, slots=True)
class Stored:
    """An array as it is put into the stream: how to read it, its bytes, and a piece of deflate stream that ends at a byte."""

    dtype: str
    shape: tuple[int, ...]
    filter: str
    size: int
    piece: bytes

    @classmethod
    def of(cls, array: NDArray[Any]) -> "Stored":
        """An array under the filter with which its beginning comes out smallest."""
        # From the middle: a beginning is often all alike.
        first = max(0, (len(array) - _TRIED) // 2)
        tried = [len(_piece(filtered(array[first : first + _TRIED], each), _QUICK)) for each in FILTERS]
        chosen = FILTERS[int(np.argmin(tried))]
        data = filtered(array, chosen)
        return cls(_WORD[array.dtype], array.shape, chosen, len(data), _piece(data))


def _piece(data: bytes, level: int = 6) -> bytes:
    made = zlib.compressobj(level, zlib.DEFLATED, -15)
    return made.compress(data) + made.flush(zlib.Z_FULL_FLUSH)


def joined(arrays: Mapping[str, Stored]) -> tuple[dict[str, dict[str, Any]], str]:
    """Describe arrays for the page, and join all of them in one raw deflate stream (RFC 1951), as base64."""
    entries, offset = {}, 0
    for name, each in arrays.items():
        entries[name] = {"dtype": each.dtype, "shape": list(each.shape), "filter": each.filter, "offset": offset,
                         "bytes": each.size}  # fmt: skip
        offset += each.size
    end = zlib.compressobj(9, zlib.DEFLATED, -15).flush()
    return entries, base64.b64encode(b"".join(each.piece for each in arrays.values()) + end).decode("ascii")


def placed(point: Floats, low: Floats, high: Floats) -> NDArray[np.uint16]:
    """Points (n, 3) counted in 65535ths of a box."""
    size = np.where(high > low, high - low, 1.0)
    return np.round(np.clip((point - low) / size, 0.0, 1.0) * MOST).astype(np.uint16)


def octahedral(normal: Floats, steps: int) -> NDArray[np.int16]:
    """Unit vectors (n, 3) as two whole numbers from -steps to steps; what is no number as 0, 0."""
    x, y, z = np.nan_to_num(normal).T
    size = np.abs(x) + np.abs(y) + np.abs(z)
    size = np.where(size > 0.0, size, 1.0)
    return np.round(np.stack(_folded(x / size, y / size, z), axis=1) * steps).astype(np.int16)


def _folded(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats]:
    """Where z is negative the corners of the square are folded over its sides, which is its own way back."""
    folded_x, folded_y = (1.0 - np.abs(y)) * np.where(x < 0, -1, 1), (1.0 - np.abs(x)) * np.where(y < 0, -1, 1)
    return np.where(z < 0, folded_x, x), np.where(z < 0, folded_y, y)


def unfolded(stored: NDArray[np.int16], steps: int) -> Floats:
    """Unit vectors (n, 3) of stored ones, in the very steps in which the page finds them: their frames must be the same."""
    x, y = stored[:, 0] / steps, stored[:, 1] / steps
    z = 1.0 - np.abs(x) - np.abs(y)
    x, y = _folded(x, y, z)
    length = np.sqrt(x * x + y * y + z * z)
    return np.stack([x / length, y / length, z / length], axis=1)


def frame(normal: Floats) -> tuple[Floats, Floats]:
    """Two unit tangents (n, 3) to each normal: t1 = a x n, made unit, with `a` the axis of the least component (the first of
    equal ones), and t2 = n x t1."""
    axis = np.eye(3)[np.abs(normal).argmin(axis=1)]
    first = np.cross(axis, normal)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(normal, first)


def turned(direction: Floats, normal: Floats) -> NDArray[np.int16]:
    """Angles (n,) of directions in the frame of stored normals, of which 32767 are half a turn."""
    first, second = frame(normal)
    direction = np.nan_to_num(direction)
    angle = np.arctan2((direction * second).sum(axis=1), (direction * first).sum(axis=1))
    return np.round(angle / np.pi * FINE).astype(np.int16)


def halves(array: Floats, toward: str = "nearest") -> NDArray[np.float16]:
    """16-bit floats, the nearest ones or none that is larger (`down`); what is too large as the largest one."""
    most = np.finfo(np.float16).max
    clipped = np.clip(array, -float(most), float(most)).astype(np.float16)
    if toward == "down":
        return np.where(clipped > array, np.nextafter(clipped, -most), clipped)
    return clipped


#: Largest width and height: a place is counted in 16ths of a texel in 16 bits; the last number says that there is none.
_LONGEST = 4094
STEPS, NOWHERE = 16, 65535
#: Lines this far from equal steps, in steps, count as equal ones.
_EVEN = 0.05
#: Other lines get steps of their least distance, at most so many times more; less where the atlas is too large; 0: no grid.
_FINER = (8, 3, 1, 0)
#: Texels that an atlas may have for a finer grid.
_TEXELS = 4_000_000


@dataclass(frozen=True, slots=True)
class Sheet:
    """The samples of one face as they lie in the atlas (h, w): rows along u, columns along v. Where it has a grid, the ends of u
    and of v."""

    index: Ints
    ends: tuple[tuple[float, float], tuple[float, float]] | None


@dataclass(frozen=True, slots=True)
class Atlas:
    """All sheets, by face number, side by side."""

    index: Ints  #: (height, width): the row of the sample, -1 where no sheet lies.
    corner: Mapping[int, tuple[int, int]]  #: Row and column at which a sheet begins.
    sheets: Mapping[int, Sheet]


def sheet_of(grid: FaceGrid, finer: int = _FINER[0]) -> Sheet:
    """A face's grid with its seams at both ends, at equal steps, at most `finer` times as many, and no node without a sample."""
    known = grid.index >= 0
    _, (i, j) = distance_transform_edt(~known, return_indices=True)
    index, u, v = grid.index[i, j], grid.u, grid.v
    if grid.closed_u:
        u, index = np.append(u, grid.span[1]), np.vstack([index, index[:1]])
    if grid.closed_v:
        v, index = np.append(v, grid.span[3]), np.hstack([index, index[:, :1]])
    rows, columns = _even(u, finer), _even(v, finer)
    ends = ((float(u[0]), float(u[-1])), (float(v[0]), float(v[-1])))
    return Sheet(index[np.ix_(rows, columns)].astype(np.int32), ends)


def _even(line: Floats, finer: int) -> NDArray[np.intp]:
    """The nearest grid line (k,) at each of k equal steps from the first to the last: so many that each line is one."""
    count, span = len(line), line[-1] - line[0]
    if np.abs((line - line[0]) / span * (count - 1) - np.arange(count)).max() < _EVEN:
        return np.arange(count)
    cell = np.diff(np.concatenate([line[:1], 0.5 * (line[1:] + line[:-1]), line[-1:]]))[1:-1].min(initial=span)
    steps = min(int(np.ceil(span / cell)) + 1, finer * count, max(count, _LONGEST - 1))
    return np.searchsorted(0.5 * (line[1:] + line[:-1]), np.linspace(line[0], line[-1], steps))


def atlas_of(samples: SurfaceSamples) -> Atlas:
    """Lay out the sheets of all sampled faces side by side, the highest first, in shelves, with the finest steps that fit."""
    grids = {grid.face: grid for grid in samples.grids}
    rows = samples.by_face()
    for finer in _FINER:
        sheets = {}
        for number, mine in rows.items():
            grid = grids.get(number)
            if grid is not None and finer and max(grid.index.shape) < _LONGEST:
                sheets[number] = sheet_of(grid, finer)
                continue
            # Samples without a grid, in lines.
            wide = max(1, int(np.ceil(np.sqrt(len(mine)))))
            lines = np.full(-(-len(mine) // wide) * wide, -1, np.int32)
            lines[: len(mine)] = mine
            sheets[number] = Sheet(lines.reshape(-1, wide), None)
        size = {number: sheet.index.shape for number, sheet in sheets.items()}
        area = sum(h * w for h, w in size.values())
        width = min(_LONGEST, max(*(w for _, w in size.values()), math.ceil(1.1 * math.sqrt(area)), 1))
        corner, row, column, high = {}, 0, 0, 0
        for number in sorted(sheets, key=lambda n: (-size[n][0], n)):
            h, w = size[number]
            if column + w > width:
                row, column, high = row + high, 0, 0
            corner[number] = (row, column)
            column, high = column + w, max(high, h)
        index = np.full((max(1, row + high), max(1, width)), -1, np.int32)
        if index.shape[0] <= _LONGEST and (finer <= 1 or index.size <= _TEXELS):
            break
    for number, (row, column) in corner.items():
        h, w = size[number]
        index[row : row + h, column : column + w] = sheets[number].index
    return Atlas(index, corner, sheets)


def placed_in(
    atlas: Atlas, samples: SurfaceSamples, number: int, mesh: Mesh, period: tuple[float, float]
) -> tuple[Mesh, NDArray[np.uint16]]:
    """A face's mesh with the places (n, 2) of its vertices: column and row in the atlas, in 16ths of a texel."""
    sheet = atlas.sheets.get(number)
    if sheet is None:
        return mesh, np.full((len(mesh.point), 2), NOWHERE, np.uint16)
    row, column = atlas.corner[number]
    if sheet.ends is not None:
        at = [_share(mesh.uv[:, k], sheet.ends[k], period[k]) * (sheet.index.shape[k] - 1) for k in (1, 0)]
        place = np.stack(at, axis=1) + np.array([column, row])
        return mesh, np.round(STEPS * place).astype(np.uint16)
    rows = np.flatnonzero(samples.face == number)
    corner = mesh.triangle.reshape(-1)
    apart = Mesh(mesh.point[corner], mesh.normal[corner], np.arange(len(corner), dtype=np.uint32).reshape(-1, 3), mesh.uv[corner])
    _, nearest = cKDTree(samples.point[rows]).query(apart.point.reshape(-1, 3, 3).mean(axis=1))
    width = sheet.index.shape[1]
    place = np.stack([column + nearest % width, row + nearest // width], axis=1)
    return apart, np.repeat((STEPS * place).astype(np.uint16), 3, axis=0)


def _share(at: Floats, ends: tuple[float, float], period: float) -> Floats:
    """Where parameters lie between ends, 0 to 1; moved by whole periods to there."""
    low, high = ends
    turns = np.round((at.mean() - 0.5 * (low + high)) / period) * period if period else 0.0
    return np.clip((at - turns - low) / (high - low), 0.0, 1.0)


#: First triangle and number of triangles.
Range = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Surface:
    """Vertices (v, 3), mm, part coordinates, with unit normals out of the material; triangles (m, 3), counter-clockwise from
    outside; places (v, 2) in the atlas. Face number, or place among the fixtures, -> Range.
    """

    point: Floats
    normal: Floats
    triangle: NDArray[np.uint32]
    place: NDArray[np.uint16]
    faces: dict[int, Range]
    fixtures: dict[int, Range]


def surface_of(result: Judged, render_mesh: RenderMesh, atlas: Atlas) -> Surface:
    """Put the meshes of faces and fixtures together."""
    numbers = sorted(render_mesh.meshes)
    placed = [placed_in(atlas, result.samples, n, render_mesh.meshes[n], render_mesh.periods[n]) for n in numbers]
    meshes, places = [mesh for mesh, _ in placed], [place for _, place in placed]
    for fixture, _ in fixtures_in(result.ready):
        # Flat facets.
        normal = np.cross(fixture.shown[:, 1] - fixture.shown[:, 0], fixture.shown[:, 2] - fixture.shown[:, 0])
        length = np.linalg.norm(normal, axis=1)
        flat, unit = fixture.shown[length > 0], normal[length > 0] / length[length > 0][:, None]
        count = 3 * len(flat)
        triangle = np.arange(count, dtype=np.uint32).reshape(-1, 3)
        meshes.append(Mesh(flat.reshape(-1, 3), np.repeat(unit, 3, axis=0), triangle, np.zeros((count, 2))))
        places.append(np.full((count, 2), NOWHERE, np.uint16))
    first, starts = (np.cumsum([0, *map(len, each)])[:-1] for each in ([m.point for m in meshes], [m.triangle for m in meshes]))
    ranges = list(zip(starts.tolist(), [len(m.triangle) for m in meshes], strict=True))
    return Surface(
        np.concatenate([m.point for m in meshes]), np.concatenate([m.normal for m in meshes]),
        np.concatenate([m.triangle + np.uint32(n) for m, n in zip(meshes, first, strict=True)]), np.concatenate(places),
        dict(zip(numbers, ranges, strict=False)), dict(enumerate(ranges[len(numbers) :])),
    )  # fmt: skip


def box_of(surface: Surface, samples: Any) -> tuple[Floats, Floats]:
    """Corners of the box around all that is drawn, mm."""
    every = np.vstack([surface.point, samples.point[np.isfinite(samples.point).all(axis=1)]])
    return every.min(axis=0), every.max(axis=0)


Arrays = dict[str, Stored]
#: Instead of a setup: none serves the sample.
NO_SETUP = 255


def mesh_arrays(surface: Surface, atlas: Atlas, low: Floats, high: Floats) -> Arrays:
    """The mesh, and which sample stands where on it."""
    return {
        "mesh.position": Stored.of(placed(surface.point, low, high)),
        "mesh.normal": Stored.of((octahedral(surface.normal, COARSE) + COARSE).astype(np.uint8)),
        "mesh.triangle": Stored.of(surface.triangle),
        "mesh.texel": Stored.of(surface.place),
        "atlas.index": Stored.of(atlas.index.reshape(-1)),
    }


def sample_arrays(result: Judged, low: Floats, high: Floats) -> Arrays:
    """The samples, and what each cutter reaches of them."""
    samples, normal = result.samples, octahedral(result.samples.normal, FINE)
    number = np.uint16 if samples.face.max(initial=0) < 1 << 16 else np.uint32
    arrays: dict[str, NDArray[Any]] = {
        "sample.point": placed(np.nan_to_num(samples.point), low, high),
        "sample.normal": normal,
        "sample.direction": turned(samples.direction_max, unfolded(normal, FINE)),
        "sample.curvature": halves(samples.curvature),
        "sample.class": result.surface_class,
        "sample.face": samples.face.astype(number),
        "sample.area": halves(samples.area),
    }
    if result.inside_bodies.any():
        arrays["sample.inside"] = result.inside_bodies.astype(np.uint8)
    for name, which in result.served_in.items():
        arrays[f"setup.{name}"] = np.where(which < 0, NO_SETUP, which).astype(np.uint8)
    for name, reach in result.reaches.items():
        arrays |= {f"verdict.{name}": reach.verdict, f"reason.{name}": reach.reason}
    return {name: Stored.of(array) for name, array in arrays.items()}


def posture_arrays(result: Judged, name: str) -> Arrays:
    """The postures found for a cutter."""
    samples, verdicts = result.samples, result.reaches[name]
    tilt, tilt_direction = tilt_and_direction(samples, verdicts)
    arrays: dict[str, NDArray[Any]] = {"tilt": tilt, "lean": tilt_direction}
    if (share := shares(verdicts.tilt_direction)) is not None:
        arrays["share"] = share
    if verdicts.shift.any():
        # As the page has the postures: at rounded tilts another end of a flank may be that which touches.
        rounded = np.where(tilt == NO_TILT, np.nan, np.radians(0.01 * tilt))
        stated = replace(verdicts, tilt=rounded, shift=np.zeros_like(verdicts.shift))
        there, here = (tips(result.judged(name), samples.point, samples.normal, each) for each in (verdicts, stated))
        arrays["shift"] = halves(np.where(verdicts.shift.any(axis=1, keepdims=True), there - here, 0.0))
    return {f"{word}.{name}": Stored.of(array) for word, array in arrays.items()}


def scalar_arrays(result: Judged) -> tuple[Arrays, list[dict[str, Any]]]:
    """Values at samples, and what the page is told of them."""
    curvature, scalars = result.samples.curvature, {}
    legends = [
        _scalar("curvature_max", "largest curvature", "1/mm", curvature[:, 0], array="sample.curvature", column=0),
        _scalar("curvature_min", "smallest curvature", "1/mm", curvature[:, 1], array="sample.curvature", column=1),
    ]
    for each in result.answers.radius_maps:
        key = f"largest_{each.shape}"
        # What is told must not be more than what reaches.
        scalars[f"scalar.{key}"] = Stored.of(halves(each.radius, "down"))
        legends.append(_scalar(key, f"largest {each.shape} end (radius, up to {mm(each.most)} tried)", "mm", each.radius))
    return scalars, legends


def _scalar(
    key: str, label: str, unit: str, values: Floats, *, array: str | None = None, column: int | None = None
) -> dict[str, Any]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (None, None)
    array = array or f"scalar.{key}"
    return {"key": key, "label": label, "unit": unit, "low": low, "high": high, "array": array, "column": column}
