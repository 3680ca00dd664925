"""Entries on what faces are like: sharp inside edges, bends tighter than a cutter, equal faces."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Ints, SurfaceSamples
from cad_io.part.edges import InsideEdge
from cad_io.part.patterns import Pattern
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.standard_tools import largest_fitting, least_radius
from plan_cutters.domain.verdicts import LOCAL_GOUGE, REAR_GOUGE, Verdicts
from plan_cutters.plan_file.frozen import filled, vector
from plan_cutters.plan_file.part_info import InsideRadiusEntry, PatternEntry, SharpEdgeEntry
from plan_cutters.scene.preparation import Prepared


def sharp_edge_entries(
    edges: Sequence[InsideEdge], strips: Ints, samples: SurfaceSamples, cutter: Cutter
) -> list[SharpEdgeEntry]:
    """Sum up the strips beside sharp inside edges by pairs of faces, the largest area first.

    `strips` (n,) int32: place of the edge that loses each sample, -1 for none.
    """
    radius = least_radius(cutter) or 0.0
    pairs: dict[tuple[int, int], list[int]] = {}
    for place in np.unique(strips[strips >= 0]).tolist():
        first, second = sorted(edges[place].faces)
        pairs.setdefault((first, second), []).append(place)
    entries = []
    for (first, second), places in pairs.items():
        angle = float(np.concatenate([edges[place].angle[edges[place].sharp] for place in places]).mean())
        entries.append(SharpEdgeEntry(
            faces=(f"F{first}", f"F{second}"), length_mm=sum(edges[place].length for place in places),
            angle_deg=float(np.degrees(angle)), radius_mm=radius, width_mm=radius / float(np.tan(0.5 * angle)),
            area_mm2=float(np.nansum(samples.area[np.isin(strips, places)])),
        ))  # fmt: skip
    return sorted(entries, key=lambda each: (-each.area_mm2, each.faces))


#: A face of which less is gouged is named only where there is no other, mm2.
_NAMED = 1.0
#: Of the area that is gouged, the share that has the radius that is told, or a larger one: one bad place does not speak for all.
_MOST = 0.9
#: Nearer to its apex than this share of its reach, the border of a cone is there.
_AT_APEX = 1e-6


def inside_radius_entries(ready: Prepared, cutter: Cutter, verdicts: Verdicts) -> list[InsideRadiusEntry]:
    """List the faces on which gouging stops a cutter, and whose inside radius is below its own; the smallest first.

    The point of a cone has no radius, and stands in no entry.
    """
    samples, radius = ready.samples, least_radius(cutter)
    gouged = verdicts.not_reached & np.isin(verdicts.reason, (LOCAL_GOUGE, REAR_GOUGE)) & ready.finished
    if radius is None or not gouged.any():
        return []
    entries = []
    for number, rows in samples.by_face().items():
        mine = rows[gouged[rows]]
        if not len(mine) or ends_in_a_point(ready, number, mine):
            continue
        inside = _inside_radius(ready, mine)
        if 0.0 < inside < radius * (1.0 - 1e-6):
            area, fits = float(np.nansum(samples.area[mine])), largest_fitting(inside, cutter.allowance or 0.0)
            entries.append(InsideRadiusEntry(face=f"F{number}", radius_mm=inside, cutter_radius_mm=radius, area_mm2=area,
                                             fits_mm=fits))  # fmt: skip
    named = [each for each in entries if each.area_mm2 >= _NAMED] or entries
    return sorted(named, key=lambda each: (each.radius_mm, each.face))


def _inside_radius(ready: Prepared, mine: NDArray[np.int64]) -> float:
    """Inside radius that most of the area of some samples (m,) of a face has, or a larger one, mm, by the kernel's curvature.

    Infinite where that does not bend inwards.
    """
    bends = ready.samples.curvature[mine, 0]
    area = np.where(np.isfinite(ready.samples.area[mine]), ready.samples.area[mine], 0.0).clip(min=0.0)
    known = np.isfinite(bends)
    bends, area = bends[known], area[known] if area[known].sum() > 0.0 else np.ones(int(known.sum()))
    if not len(bends):
        return float("inf")
    order = np.argsort(bends, kind="stable")
    share = np.cumsum(area[order])
    # What rounding adds up must not move it past a sample.
    most = float(bends[order[np.searchsorted(share, share[-1] * (_MOST - 1e-12))]])
    return 1.0 / most if most > 0.0 else float("inf")


def ends_in_a_point(ready: Prepared, number: int, rows: NDArray[np.int64]) -> bool:
    """Whether a face is the inside of a cone that goes as far as its apex, as a drill leaves it; `rows` are samples of it."""
    part = ready.scene.part
    info = part.faces[number - 1]
    if info.shape != "cone" or info.carrier is None or not (ready.samples.curvature[rows, 0] > 0.0).any():
        return False
    trim = part.trim(number)
    if trim is None or not len(trim.segments):
        return False
    u, v = trim.segments[:, 0].T
    away = np.linalg.norm(part.surface(number).second(u.copy(), v.copy())[:, 0] - np.array(info.carrier.point), axis=1)
    return bool(away.min() <= _AT_APEX * away.max())


def pattern_entries(patterns: Sequence[Pattern], counts: NDArray[np.int64]) -> list[PatternEntry]:
    """The entries of all patterns of a part.

    `counts` (m, 3) int64, of each motion of the whole part, in their order: samples that were moved, that followed, and that
    were verified.
    """
    entries, motion = list[PatternEntry](), 0
    for each in patterns:
        own = np.zeros(3, np.int64)
        if each.whole:
            own = counts[motion : motion + len(each.motions)].sum(axis=0)
            motion += len(each.motions)
        # A point and the direction of the axis, or of the mirror's normal.
        first = each.motions[0]
        place, direction = (None, None) if each.kind == "shift" or first.axis is None else first.axis
        if each.kind == "mirror":
            values, vectors = np.linalg.eigh(0.5 * (first.linear + first.linear.T))
            place, direction = 0.5 * first.shift, vectors[:, int(values.argmin())]
        entries.append(filled(
            PatternEntry, each, place_mm=None if place is None else vector(place),
            direction=None if direction is None else vector(direction),
            shifts_mm=[vector(m.shift) for m in each.motions] if each.kind == "shift" else [],
            faces=[[f"F{ring[k % len(ring)]}" for ring in each.faces] for k in range(each.order)] if each.faces else [],
            moved=int(own[0]), followed=int(own[1]), verified=int(own[2]),
        ))  # fmt: skip
    return entries
