"""Where a vise may grip a part: on two opposite upright planes near its bottom (`docs/operations_proof.md`, lemma K3)."""

import math
from dataclasses import replace

import numpy as np

from cad_io.arrays import Floats, rows_by_face
from plan_cutters.domain.clamping import VISES, Requested, Vise, vises_for
from plan_cutters.domain.figures import listed, mm
from plan_cutters.setups.gripped import on_ledges
from plan_cutters.setups.workpiece import (
    PARALLEL,
    TOGETHER,
    Place,
    Refused,
    Wall,
    Workpiece,
    area_of,
    clipped,
    merged,
    stands,
    wall_of,
)

#: Walls that are looked at, at most, the largest of them.
_WALLS = 300
#: Of what jaws may touch at a place, this share has to be there, and of the part's length along them this share of a jaw's width.
_TOUCHED, _ALONG = 0.2, 0.5
#: A part stands at most so many times as high over the jaws as what they touch of it is long.
_TALL = 6.0


def vise_places(part: Workpiece, requested: Requested) -> tuple[list[Place], list[Refused]]:
    """Where a vise may grip, and why it may not where two opposite plane faces are no such place."""
    walls = _upright_planes(part, max(each[1] for each in VISES) if requested.sizes is None else requested.sizes[1])
    places, refused = list[Place](), list[Refused]()
    for i, one in enumerate(walls):
        for other in walls[i + 1 :]:
            if one.normal @ other.normal > -math.sqrt(1.0 - PARALLEL * PARALLEL):
                continue
            x = one.normal - other.normal
            x = x / np.linalg.norm(x)
            if float((one.vertex @ x).max() - (other.vertex @ x).min()) > 0.0:
                result, why = _between(part, requested, one, other, x)
                places += result
                if not result:
                    low, size = max(one.low, other.low), min(area_of(one.vertex), area_of(other.vertex))
                    refused.append(Refused((low > 0.5 * requested.grip, -size), why))
    if not places and not refused:
        refused = [Refused((True, 0.0), "no two opposite plane faces stand along it near the bottom")]
    return places, refused


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


def _between(part: Workpiece, requested: Requested, one: Wall, other: Wall, x: Floats) -> tuple[list[Place], str]:
    """Places of a vise on two walls: in the middle of what its jaws can touch, and at both ends of that; or why there is none."""
    places, why = list[Place](), ""
    for above, reach in stands(max(one.low, other.low), requested.grip):
        result, refused = _at(part, requested, (one, other), x, above, reach)
        places, why = places + result, why or refused
    return places, why


def _at(
    part: Workpiece, requested: Requested, walls: tuple[Wall, Wall], x: Floats, above: float, reach: float
) -> tuple[list[Place], str]:
    """The same where the part rests at a height over its lowest point, and the jaws reach so far above that."""
    grip, y = requested.grip, np.array([-x[1], x[0], 0.0])
    names = " and ".join(listed([f"F{n}" for n in wall.faces], 2) for wall in walls)
    apart = f"no two opposite plane faces lie side by side in the {mm(grip)} that the jaws grip"
    strips = [clipped(each.vertex, each.face, np.array([0.0, 0.0, 1.0]), above, above + reach) for each in walls]
    if not all(len(vertex) for vertex, _ in strips):
        return [], apart
    along = [(float((vertex @ y).min()), float((vertex @ y).max())) for vertex, _ in strips]
    start, end = max(low for low, _ in along), min(high for _, high in along)
    right, left = float((strips[0][0] @ x).max()), float((strips[1][0] @ x).min())
    if not end - start > part.flat:
        return [], apart
    vise, widest = _vise(replace(requested, grip=reach), right - left, float(np.ptp(part.outline @ y)), above)
    if vise is None:
        wide = f"{names} are {mm(right - left)} apart, and the vise opens to {mm(widest)}"
        return [], wide if right - left > widest else f"{names} begin too high above its lowest point for the jaws"
    half, size = 0.5 * vise.width, min(area_of(each.vertex) for each in walls)
    tall = float(part.vertex[..., 2].max())
    places, why = list[Place](), apart
    middles = [0.5 * (start + end), *([start + half, end - half] if end - start > vise.width else [])]
    for middle in middles:
        touched = [clipped(vertex, face, y, middle - half, middle + half) for vertex, face in strips]
        least = min(area_of(vertex) for vertex, _ in touched)
        if least < _TOUCHED * reach * min(vise.width, end - start):
            continue
        if tall - above - grip > _TALL * least / grip:
            why = f"the part stands {mm(tall)} high, and jaws touch no more than {mm(least / grip)} of its length"
            continue
        hidden = sum(area_of(vertex[np.isin(face, list(part.targets))]) for vertex, face in touched)
        grips = tuple(sorted({int(n) for _, face in touched for n in face}))
        origin = 0.5 * (left + right) * x + middle * y + np.array([0.0, 0.0, above])
        place = Place(
            vise, x, origin, grips, least, hidden, above, size, float(np.linalg.norm((origin - part.middle)[:2])),
            float(np.abs((part.outline - origin) @ x).max()),
        )  # fmt: skip
        if above > 0.0 or on_ledges(vise, place.own(part.vertex[part.lowest_rows]), part.face[part.lowest_rows], part.flat):
            places.append(place)
        else:
            why = f"nothing of the part lies on the ledges of jaws at {names}"
    return places, why


def _vise(requested: Requested, gap: float, length: float, above: float) -> tuple[Vise | None, float]:
    """The vise that was requested, or the smallest that takes a part so long along its jaws, None where there is none; and how
    far it opens, or the widest of those that are sold, mm."""
    grip, vises = requested.grip, vises_for(gap) if requested.sizes is None else (Vise(*requested.sizes),)
    widest = max(each[2] for each in VISES) if requested.sizes is None else requested.sizes[2]
    vises = tuple(replace(each, grip=grip, gap=gap) for each in vises if each.height > grip and each.opening >= gap)
    # What is below the faces that are gripped hangs between the jaws.
    vises = tuple(each for each in vises if above <= each.height - each.grip)
    wide = [each for each in vises if each.width >= _ALONG * length]
    return next(iter(wide), max(vises, key=lambda each: each.width, default=None)), widest
