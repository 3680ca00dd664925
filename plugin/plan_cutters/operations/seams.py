"""Borders between operations: how long they are, and where they show as marks, on faces that are bent in both directions."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.domain.preference import is_bent
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Seams:
    """Pairs of neighbouring samples, and the border between the areas of each two.

    Attributes
    ----------
    edge : (e, 2) int
    length : (e,) float
        mm: about the side of the areas of the two.
    shows : (e,) bool
        Both lie on one face that is bent in both directions: two operations leave a mark there.
    """

    edge: Ints
    length: Floats
    shows: NDArray[np.bool_]

    @classmethod
    def of(cls, ready: Prepared) -> "Seams":
        """Those of all samples of a part."""
        samples, edge = ready.samples, ready.samples.neighbours
        face, area = samples.face[edge], np.nan_to_num(samples.area)
        bent = np.isin(face, bent_faces(ready))
        return cls(edge, np.sqrt(0.5 * area[edge].sum(axis=1)), (face[:, 0] == face[:, 1]) & bent.all(axis=1))

    def marks(self, label: Ints) -> float:
        """The length of the borders that show, mm, where samples (n,) go with these operations, -1 for none."""
        one, other = label[self.edge.astype(np.int64)].T
        return float(self.length[self.shows & (one != other) & (one >= 0) & (other >= 0)].sum())

    def among(self, stands_for: Rows) -> "Seams":
        """Those between fewer samples: `stands_for` (n,) has which of these stands for each, -1 for none."""
        one, other = np.sort(stands_for[self.edge.astype(np.int64)], axis=1).T
        apart = (one >= 0) & (one != other)
        every = np.column_stack([one, other, self.shows])[apart]
        pair, which = np.unique(every, axis=0, return_inverse=True)
        length = np.bincount(which.reshape(-1), self.length[apart], len(pair))
        return Seams(pair[:, :2], np.asarray(length, float), pair[:, 2] > 0)


def bent_faces(ready: Prepared) -> Rows:
    """Numbers of the faces of a part with samples that are bent in both directions, ascending."""
    faces = ready.scene.part.faces
    sampled = np.unique(ready.samples.face).tolist()
    return np.array([face for face in sampled if is_bent(faces[face - 1].shape)], np.int64)
