"""Where a vise may grip a part: on two opposite upright planes near its bottom."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cad_io.arrays import Floats, rows_by_face
from plan_cutters.domain.clamping import VISES, Requested, Vise, vises_for
from plan_cutters.plan_file.numbers import mm
from plan_cutters.scene.workpiece import PARALLEL, TOGETHER, Place, Wall, Workpiece, area_of, clipped, merged, stands, wall_of

#: Walls that are looked at, at most, the largest of them.
_WALLS = 300
#: Of what jaws may touch at a place, this share has to be there, and of the part's length along them this share of a jaw's width.
_TOUCHED, _ALONG = 0.2, 0.5
#: A part stands at most so many times as high over the jaws as what they touch of it is long.
_TALL = 6.0


def vise_places(part: Workpiece, requested: Requested) -> tuple[list[Place], str]:
    """Where a vise may grip, and why it may not if there is no such place."""
    walls = _upright_planes(part, max(each[1] for each in VISES) if requested.sizes is None else requested.sizes[1])
    places: list[Place] = []
    apart: list[float] = []
    tall = float(part.vertex[..., 2].max())
    for i, one in enumerate(walls):
        for other in walls[i + 1 :]:
            if one.normal @ other.normal > -math.sqrt(1.0 - PARALLEL * PARALLEL):
                continue
            x = one.normal - other.normal
            x = x / np.linalg.norm(x)
            gap = float((one.vertex @ x).max() - (other.vertex @ x).min())
            if gap > 0.0:
                apart.append(gap)
                places += _between(part, requested, one, other, x)
    firm = [each for each in places if tall - each.above - requested.grip <= _TALL * each.touched / requested.grip]
    if places and not firm:
        most = max(each.touched for each in places) / requested.grip
        return [], f"the part stands {mm(tall)} high, and jaws touch no more than {mm(most)} of its length"
    places = firm
    widest = max(each[2] for each in VISES) if requested.sizes is None else requested.sizes[2]
    if not apart:
        return places, "no two opposite plane faces stand along it near the bottom"
    if min(apart) > widest:
        return places, f"the nearest parallel faces are {mm(min(apart))} apart, and the vise opens to {mm(widest)}"
    return places, f"no two opposite plane faces lie side by side in the {mm(requested.grip)} that the jaws grip"


def _upright_planes(part: Workpiece, reach: float) -> list[Wall]:
    """Upright planar faces that begin lower than a height, those of one plane together, the largest first."""
    walls: list[Wall] = []
    for number, rows in rows_by_face(part.face).items():
        if number not in part.planes:
            continue
        vertex, normal = part.vertex[rows], part.normal[rows].sum(axis=0)
        size = float(np.linalg.norm(normal))
        if size > 0.0 and abs(normal[2]) <= PARALLEL * size and vertex[..., 2].min() < reach:
            flat = np.array([normal[0], normal[1], 0.0])
            walls.append(wall_of([number], vertex, part.face[rows], flat / np.linalg.norm(flat)))
    walls.sort(key=lambda each: (-area_of(each.vertex), each.faces))
    joined: list[Wall] = []
    for wall in walls[:_WALLS]:
        same = next((k for k, each in enumerate(joined) if _one_plane(each, wall)), None)
        if same is None:
            joined.append(wall)
        else:
            joined[same] = merged(joined[same], wall)
    return joined


def _one_plane(one: Wall, other: Wall) -> bool:
    if one.normal @ other.normal < math.sqrt(1.0 - PARALLEL * PARALLEL):
        return False
    return abs(float((one.vertex @ one.normal).max() - (other.vertex @ one.normal).max())) <= TOGETHER


def _between(part: Workpiece, requested: Requested, one: Wall, other: Wall, x: Floats) -> Iterator[Place]:
    """Places of a vise on two walls: in the middle of what its jaws can touch, and at both ends of that."""
    for above, reach in stands(max(one.low, other.low), requested.grip):
        yield from _at(part, replace(requested, grip=reach), (one, other), x, above)


def _at(part: Workpiece, requested: Requested, walls: tuple[Wall, Wall], x: Floats, above: float) -> Iterator[Place]:
    """The same where the part rests at a height over its lowest point."""
    grip, y = requested.grip, np.array([-x[1], x[0], 0.0])
    strips = [clipped(each.vertex, each.face, np.array([0.0, 0.0, 1.0]), above, above + grip) for each in walls]
    if not all(len(vertex) for vertex, _ in strips):
        return
    along = [(float((vertex @ y).min()), float((vertex @ y).max())) for vertex, _ in strips]
    start, end = max(low for low, _ in along), min(high for _, high in along)
    right, left = float((strips[0][0] @ x).max()), float((strips[1][0] @ x).min())
    vise = _vise(part, requested, right - left, float(np.ptp(part.vertex @ y)), above)
    if vise is None or not end - start > part.flat or not _supported(part, vise, 0.5 * (left + right), x, above):
        return
    half = 0.5 * vise.width
    middles = [0.5 * (start + end), *([start + half, end - half] if end - start > vise.width else [])]
    for middle in middles:
        touched = [clipped(vertex, face, y, middle - half, middle + half) for vertex, face in strips]
        least = min(area_of(vertex) for vertex, _ in touched)
        if least < _TOUCHED * grip * min(vise.width, end - start):
            continue
        hidden = sum(area_of(vertex[np.isin(face, list(part.targets))]) for vertex, face in touched)
        grips = tuple(sorted({int(n) for _, face in touched for n in face}))
        origin = 0.5 * (left + right) * x + middle * y + np.array([0.0, 0.0, above])
        yield Place(vise, x, origin, grips, least, hidden, above)


def _supported(part: Workpiece, vise: Vise, middle: float, x: Floats, above: float) -> bool:
    """Whether something of a part that does not hang between the jaws lies on their ledges."""
    corner = part.vertex.reshape(-1, 3)
    corner = corner[corner[:, 2] <= part.flat]
    return above > 0.0 or bool((np.abs(corner @ x - middle) >= 0.5 * (vise.gap or 0.0) - vise.ledge - part.flat).any())


def _vise(part: Workpiece, requested: Requested, gap: float, length: float, above: float) -> Vise | None:
    """The vise that was requested, or the smallest that takes a part so long along its jaws; None where there is none."""
    grip, vises = requested.grip, vises_for(gap) if requested.sizes is None else (Vise(*requested.sizes),)
    vises = tuple(replace(each, grip=grip, gap=gap) for each in vises if each.height > grip and each.opening >= gap)
    # What is below the faces that are gripped hangs between the jaws.
    vises = tuple(each for each in vises if above <= each.height - each.grip)
    wide = [each for each in vises if each.width >= _ALONG * length]
    return next(iter(wide), max(vises, key=lambda each: each.width, default=None))
