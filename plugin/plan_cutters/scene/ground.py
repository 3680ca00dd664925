"""The ground on which a cutter is judged: arrays alone, without shapes of the CAD kernel, and whole pieces of it."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from cad_io import SurfaceSamples
from cad_io.arrays import Ints, Record
from plan_cutters.files.digest import digest
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.surroundings import Surroundings

#: Grounds whose checksums are remembered.
_GROUNDS = 8


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Ground(Record):
    """The ground holds all that the verdicts of a cutter in one setup depend on, beside the cutter; it can be pickled.

    Attributes
    ----------
    samples : SurfaceSamples
        Points, normals, directions, curvatures, faces and whether they are judged; nothing else is filled.
    surface_class : (n,) uint8
    inside, shut : (n,) int32
        As `Prepared` has them.
    clamped : (n,) bool
    conditions : Conditions
        With one thread, and obstacles without the files that they came from.
    """

    samples: SurfaceSamples
    surface_class: NDArray[np.uint8]
    inside: Ints
    shut: Ints
    clamped: NDArray[np.bool_]
    conditions: Conditions

    @staticmethod
    def made_of(ready: Prepared) -> tuple[object, ...]:
        """Return the objects that the ground of a part follows from: while these are the same ones, so is the ground."""
        return ready.samples, ready.surface_class, ready.inside, ready.held, ready.conditions

    @staticmethod
    def same(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
        """Whether two grounds are made of the same objects, which no copy of an equal one is."""
        return len(one) == len(other) and all(mine is theirs for mine, theirs in zip(one, other, strict=True))

    @classmethod
    def of(cls, ready: Prepared) -> "Ground":
        """The ground of a part that is ready, in its first setup."""
        samples = replace(
            ready.samples, uv=np.zeros((0, 2)), area=np.zeros(0), neighbours=np.zeros((0, 2), np.int32), reasons=(),
            grids=(), empty=(), face_gaps=(),
        )  # fmt: skip
        conditions = replace(ready.conditions, jobs=1, surroundings=_bare(ready.conditions.surroundings))
        return cls(samples, ready.surface_class, ready.inside, ready.shut, ready.clamped, conditions)

    def block(self, first: int, last: int) -> "Ground":
        """The samples from `first`, which begins a piece (`threads.CHUNK`), to `last`, which ends one or all: views."""
        rows = slice(first, last)
        arrays = ("point", "normal", "direction_max", "curvature", "face", "unjudged")
        samples = replace(self.samples, **{name: getattr(self.samples, name)[rows] for name in arrays})
        return Ground(samples, self.surface_class[rows], self.inside[rows], self.shut[rows], self.clamped[rows], self.conditions)


@dataclass(slots=True)
class GroundDigests:
    """Checksums of grounds, each taken once while the part that it is of is at hand."""

    _known: list[tuple[tuple[object, ...], bytes]] = field(default_factory=list)

    def of(self, ready: Prepared) -> bytes:
        """The checksum of the ground of a part; names change nothing."""
        made = Ground.made_of(ready)
        for other, known in self._known:
            if Ground.same(made, other):
                return known
        ground = Ground.of(ready)
        machine = replace(ground.conditions.machine, name="", notes=())
        result = digest(replace(ground, conditions=replace(ground.conditions, machine=machine)))
        # One part of many setups and of patterns is asked for in turn.
        self._known = [(made, result), *self._known[: _GROUNDS - 1]]
        return result


def _bare(surroundings: Surroundings) -> Surroundings:
    """The same obstacles without what is told of them."""
    alone = None if surroundings.alone is None else _bare(surroundings.alone)
    return replace(surroundings, missing=(), on_bodies=(), lost=(), fixtures=(), alone=alone)
