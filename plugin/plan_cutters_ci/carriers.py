"""Faces that lie on one plane, or about one axis or centre, in two plans: by their carriers, whatever their borders are."""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.spatial import cKDTree

from plan_cutters.plan_file.model import FaceEntry

#: Carriers are the same where their points, radii and angles (rad) differ by less than this share of the part's diagonal.
SAME_CARRIER = 1e-4
#: Cosine of the angle between the normals, or the axes, of two faces that may be one face, changed.
_AGREE = 0.7


def on_one_carrier(
    old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float, *, radius: bool
) -> Iterator[tuple[FaceEntry, FaceEntry]]:
    """Pairs of faces of one form on the same carrier; with `radius`, its radii agree, too.

    A cone has an angle, which agrees in any case.
    """
    sides = [defaultdict[str, list[FaceEntry]](list) for _ in range(2)]
    for side, faces in zip(sides, (old, new), strict=True):
        for face in faces:
            if face.carrier is not None:
                side[face.shape].append(face)
    within = SAME_CARRIER * size
    for shape, mine in sides[0].items():
        theirs = sides[1].get(shape)
        if not theirs:
            continue
        # A direction and its opposite are the same.
        tree = cKDTree(np.array([row for sign in (1.0, -1.0) for row in (_row(face, size, sign) for face in theirs)]))
        near = tree.query_ball_point(np.array([_row(face, size, 1.0) for face in mine]), within, p=np.inf)
        for a, rows in zip(mine, near, strict=True):
            for j in sorted({row % len(theirs) for row in rows}):
                b = theirs[j]
                if not opposed(a, b) and _angle(a, b) and (not radius or _same_radii(a, b, within)):
                    yield a, b


def opposed(a: FaceEntry, b: FaceEntry) -> bool:
    """Whether the material lies on other sides of two faces of one form, or they point in other directions.

    What one of them does not state opposes nothing.
    """
    if a.carrier is None or b.carrier is None:
        return False
    way, other = a.carrier.direction, b.carrier.direction
    stated = way is not None and other is not None and any(way) and any(other)
    inner = float(np.dot(way, other)) if stated else 1.0  # type: ignore[arg-type]
    known = None not in (a.carrier.outward, b.carrier.outward)
    same = a.carrier.outward == b.carrier.outward
    if a.shape == "plane":
        return (abs(inner) if not (known and stated) else inner if same else -inner) < _AGREE
    return (known and not same) or abs(inner) < _AGREE


def _same_radii(a: FaceEntry, b: FaceEntry, within: float) -> bool:
    """Whether the radii of two faces agree, mm; a face without one has none to differ in."""
    if a.carrier is None or b.carrier is None:
        return True
    pairs = ((a.carrier.radius_mm, b.carrier.radius_mm), (a.carrier.minor_radius_mm, b.carrier.minor_radius_mm))
    return all(one is None or other is None or abs(one - other) <= within for one, other in pairs)


def _angle(a: FaceEntry, b: FaceEntry) -> bool:
    one, other = (0.0 if face.carrier is None else face.carrier.half_angle_deg or 0.0 for face in (a, b))
    return abs(one - other) <= math.degrees(SAME_CARRIER)


def _row(face: FaceEntry, size: float, sign: float) -> tuple[float, ...]:
    """Six lengths, mm, that say where a carrier is."""
    assert face.carrier is not None
    return *face.carrier.point_mm, *(sign * size * x for x in face.carrier.direction or (0.0, 0.0, 0.0))
