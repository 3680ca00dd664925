"""The ground on which a cutter is judged: all that its verdicts in one setup depend on, beside the cutter, and its checksum."""

from dataclasses import dataclass, field, replace

import numpy as np

from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters_base.values import digest

#: Grounds whose checksums are remembered.
_GROUNDS = 8


def made_of(ready: Prepared) -> tuple[object, ...]:
    """Return the objects that the ground of a part follows from: while these are the same ones, so is the ground."""
    return ready.samples, ready.surface_class, ready.inside, ready.held, ready.conditions


def same(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    """Whether two grounds are made of the same objects, which no copy of an equal one is."""
    return len(one) == len(other) and all(mine is theirs for mine, theirs in zip(one, other, strict=True))


@dataclass(slots=True)
class GroundDigests:
    """Checksums of grounds, each taken once while the part that it is of is at hand."""

    _known: list[tuple[tuple[object, ...], bytes]] = field(default_factory=list)

    def of(self, ready: Prepared) -> bytes:
        """The checksum of the ground of a part; names, threads and what is told of obstacles change nothing."""
        made = made_of(ready)
        for other, known in self._known:
            if same(made, other):
                return known
        samples = replace(
            ready.samples, uv=np.zeros((0, 2)), area=np.zeros(0), neighbours=np.zeros((0, 2), np.int32), reasons=(),
            grids=(), empty=(), face_gaps=(),
        )  # fmt: skip
        machine = replace(ready.conditions.machine, name="", notes=())
        conditions = replace(ready.conditions, jobs=1, machine=machine, surroundings=_bare(ready.conditions.surroundings))
        result = digest((samples, ready.surface_class, ready.inside, ready.shut, ready.clamped, conditions))
        # One part of many setups and of patterns is asked for in turn.
        self._known = [(made, result), *self._known[: _GROUNDS - 1]]
        return result


def _bare(surroundings: Surroundings) -> Surroundings:
    """The same obstacles without what is told of them."""
    alone = None if surroundings.alone is None else _bare(surroundings.alone)
    return replace(surroundings, missing=(), on_bodies=(), lost=(), fixtures=(), alone=alone)
