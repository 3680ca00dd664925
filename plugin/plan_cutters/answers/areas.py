"""How much of the finished surface samples stand for, and which connected areas of it some of them are."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, SurfaceSamples
from cad_io.graphs import connected
from plan_cutters.domain.answers import weights
from plan_cutters.plan_file.answers import LostAreaEntry
from plan_cutters.plan_file.words.answers import patch
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]

#: Directions along which the extent of an area is measured: of an area that is wider between them it is 3 % short at most.
_WAYS = 200


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Finished(Record):
    """The areas and shares of the finished surface that the samples stand for; one value belongs to each sample."""

    area: Floats  #: (n,) float: mm2 of the finished surface; 0 of samples inside another body.
    #: (n,) float: the same of all target area that is no inside of a body, faces without samples included, as a plan counts it.
    share: Floats
    wanted: NDArray[np.bool_]  #: (n,) bool: samples of the finished surface that are judged.

    @classmethod
    def of(cls, ready: Prepared) -> "Finished":
        """Of the samples of a part: those of a face share its area as they do by their own."""
        samples, faces = ready.samples, ready.scene.part.faces
        judged = sorted({*np.unique(samples.face).tolist(), *(number for number, _ in samples.empty)})
        known = np.zeros(len(faces))
        known[[number - 1 for number in judged]] = weights(np.array([faces[number - 1].area for number in judged]))
        own = np.where(np.isfinite(samples.area), samples.area, 0.0).clip(min=0.0)
        whole = np.bincount(samples.face, own, len(faces) + 1)
        own = np.where(whole[samples.face] > 0.0, own, 1.0)
        whole = np.bincount(samples.face, own, len(faces) + 1)
        area = known[samples.face - 1] * own / whole[samples.face]
        area[ready.not_required] = 0.0
        total = area.sum() + sum(known[number - 1] for number, _ in samples.empty)
        return cls(area, area / max(total, 1e-300), ready.finished)

    @property
    def whole(self) -> float:
        """All of the finished area, mm2."""
        return float(self.area.sum()) / max(1e-300, float(self.share.sum()))

    def of_rows(self, rows: Rows) -> float:
        """The share that some samples stand for."""
        return min(1.0, float(self.share[rows].sum()))


def patches(samples: SurfaceSamples, finished: Finished, rows: Rows) -> list[LostAreaEntry]:
    """Connected areas of some samples (m,), the largest first.

    Neighbours within a face and across smooth joints are connected.
    """
    if not len(rows):
        return []
    at = np.full(len(samples), -1, np.int64)
    at[rows] = np.arange(len(rows))
    one, other = at[samples.neighbours[:, 0]], at[samples.neighbours[:, 1]]
    both = (one >= 0) & (other >= 0)
    group = connected(len(rows), np.column_stack([one[both], other[both]]))
    sequence = np.argsort(group, kind="stable")
    each = np.split(rows[sequence], np.flatnonzero(np.diff(group[sequence])) + 1)
    return sorted((_patch(samples, finished, mine) for mine in each), key=lambda each: (-each.area_mm2, each.point))


def _patch(samples: SurfaceSamples, finished: Finished, rows: Rows) -> LostAreaEntry:
    point, area = samples.point[rows], finished.area[rows]
    weight = weights(area)
    middle = weight @ point / weight.sum()
    x, y, z = point[int(((point - middle) ** 2).sum(axis=1).argmin())].tolist()
    numbers, inverse = np.unique(samples.face[rows], return_inverse=True)
    by_face = np.argsort(-np.bincount(inverse, weight), kind="stable")
    faces, whole, across = [f"F{n}" for n in numbers[by_face].tolist()], float(area.sum()), _across(point)
    return LostAreaEntry(
        area_mm2=whole, share=finished.of_rows(rows), samples=len(rows), faces=faces, point=(x, y, z), across_mm=across,
        why=patch(whole, faces, (x, y, z), across),
    )  # fmt: skip


def _across(point: Floats) -> float:
    """Largest extent of points (n, 3) along many directions, mm."""
    # Evenly over half a sphere, by the golden angle.
    k = np.arange(_WAYS)
    z = (k + 0.5) / _WAYS
    turn = np.pi * (1.0 + 5.0**0.5) * k
    flat = np.sqrt(1.0 - z**2)
    way = np.stack([flat * np.cos(turn), flat * np.sin(turn), z])
    along = point @ way
    ends = np.linalg.norm(point[along.argmax(axis=0)] - point[along.argmin(axis=0)], axis=1)
    return float(ends.max(initial=0.0))
