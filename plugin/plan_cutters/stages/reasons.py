"""Why a sample is lost, by what would free it: the first of these without which there is a posture is the reason.

The axis limit (another setup or machine); the holder, the shank, the neck (a longer stick-out, a slimmer holder); the fixtures.
Where none of them alone frees it, it is what forbids most tilts to the flutes, whatever limits, holders and fixtures there are:
only another cutter helps there. No verdict is changed.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.nesting import inside
from plan_cutters.domain.shapes import flute_length
from plan_cutters.domain.verdicts import (
    AXIS_LIMIT,
    BURIED,
    FIXTURE,
    INACCESSIBLE,
    LOCAL_GOUGE,
    NO_REASON,
    REASONS,
    TOLERANCE,
    UNJUDGED,
    Reach,
    blank,
)
from plan_cutters.scene.conditions import Conditions, contacts_of, search_postures
from plan_cutters.scene.threads import Progress

#: Reasons that something besides cutter and part takes part in.
_REMOVABLE = (AXIS_LIMIT, FIXTURE, *(REASONS.index(word) for word in ("neck", "shank", "holder")))


@dataclass(frozen=True, slots=True, eq=False)
class Explained:
    """The reach of a cutter with the reasons that can be acted on.

    Attributes
    ----------
    reach : Reach
        Verdicts and postures as they were.
    besides : (n,) uint8
        Where the reason is the axis limit: what else is in the way within it, index into REASONS; else NO_REASON.
    """

    reach: Reach
    besides: NDArray[np.uint8]


@dataclass(slots=True)
class Reasons:
    """Finds reasons, cutter after cutter; what was found for one spares another some of the search.

    Attributes
    ----------
    samples : SurfaceSamples
    conditions : sequence of Conditions
        Of each setup.
    asked : (n,) bool
        Samples that have a reason to be looked for.
    """

    samples: SurfaceSamples
    conditions: Sequence[Conditions]
    asked: NDArray[np.bool_]
    _known: dict[str, dict[Cutter, Reach]] = field(default_factory=dict)

    def of(self, cutter: Cutter, reach: Reach, progress: Progress | None = None) -> Explained:
        """Find the reasons of what a cutter loses.

        Parameters
        ----------
        cutter : Cutter
        reach : Reach
            What it reaches over all setups, with the reasons that its search found.
        progress : callable, optional
            Told how many searches are done, of how many.
        """
        tell = progress or (lambda done, total: None)
        first, n = self.conditions[0], len(reach.verdict)
        before, reason, besides = reach.reason, reach.reason.copy(), np.full(n, NO_REASON, np.uint8)
        rows = np.flatnonzero(reach.lost & self.asked & ~np.isin(before, (BURIED, TOLERANCE)))
        limited, less = first.machine.limited, list(_less(cutter))
        if not len(rows) or not (limited or less or first.around.alone is not None):
            return Explained(reach, besides)
        known, free = None, np.zeros(n, bool)
        if limited:
            known = self._search("unlimited", cutter, rows, first.machineless)
            free[rows] = known.reached[rows]
            reason[free] = AXIS_LIMIT
            besides[free & (before != AXIS_LIMIT)] = before[free & (before != AXIS_LIMIT)]
            tell(1, 3)
        left = rows[~free[rows]]
        if less:
            # Where limits and local gouge alone leave nothing, the flutes by themselves find nothing.
            held = left[~np.isin(before[left], (AXIS_LIMIT, LOCAL_GOUGE))]
            self._held(cutter, less, held, reason, free)
            tell(2, 3)
            left = left[~free[left]]
        left = left[before[left] != FIXTURE]
        self._else(cutter, less, left, known, reason, besides)
        tell(3, 3)
        return Explained(replace(reach, reason=reason), besides)

    def _held(
        self, cutter: Cutter, less: Sequence[tuple[int, Cutter]], rows: NDArray[np.int64], reason: NDArray[np.uint8],
        free: NDArray[np.bool_],
    ) -> None:  # fmt: skip
        """Write which of holder, shank and neck has to be away for there to be a posture, from the top down."""
        if not len(rows):
            return
        served = self._anywhere(less[-1][1], rows)
        free[rows[served]], rows = True, rows[served]
        for part, without in less[:-1]:
            served = self._anywhere(without, rows)
            reason[rows[served]], rows = part, rows[~served]
        reason[rows] = less[-1][0]

    def _else(
        self, cutter: Cutter, less: Sequence[tuple[int, Cutter]], rows: NDArray[np.int64], known: Reach | None,
        reason: NDArray[np.uint8], besides: NDArray[np.uint8],
    ) -> None:  # fmt: skip
        """Of samples that nothing alone frees: the reason is what is in the way of flutes without limits, holder and fixtures."""
        rows = rows[np.isin(reason[rows], _REMOVABLE)]
        if known is not None and not less and self.conditions[0].around.alone is None:
            # The search without the limit has told.
            reason[rows] = known.reason[rows]
            return
        if not len(rows):
            return
        around = self.conditions[0].around
        bare = replace(self.conditions[0].machineless, around=around.alone or around)
        found = self._search("else", less[-1][1] if less else cutter, rows, bare)
        shut = rows[~found.reached[rows]]
        reason[shut] = found.reason[shut]
        both = rows[found.reached[rows] & (reason[rows] == AXIS_LIMIT)]
        if known is not None:
            # Lost to the limit and to something else: neither alone frees them.
            besides[both] = known.reason[both]

    def _anywhere(self, cutter: Cutter, rows: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Whether a cutter has a posture in some setup."""
        served = np.zeros(len(rows), bool)
        for k, conditions in enumerate(self.conditions):
            found = self._search(f"setup {k}", cutter, rows[~served], conditions)
            served |= found.reached[rows]
        return served

    def _search(self, under: str, cutter: Cutter, rows: NDArray[np.int64], conditions: Conditions) -> Reach:
        """Search for postures of some samples, but where what was found for other cutters `under` the same tells."""
        found, known = blank(len(self.asked)), self._known.setdefault(under, {})
        for other, earlier in known.items():
            # As `nesting.handed`, but of the samples that were looked at.
            if inside(cutter, other):
                mine = rows[earlier.reached[rows] & (found.verdict[rows] == UNJUDGED)]
            elif inside(other, cutter):
                mine = rows[(earlier.verdict[rows] == INACCESSIBLE) & (found.verdict[rows] == UNJUDGED)]
            else:
                continue
            for name in Reach.__slots__:
                getattr(found, name)[mine] = getattr(earlier, name)[mine]
        left = rows[found.verdict[rows] == UNJUDGED]
        if len(left):
            light, heavy = conditions.light(cutter), conditions.heavy(cutter)
            search_postures(contacts_of(self.samples), left, light, heavy, conditions, found, fixed=True)
        known[cutter] = found
        return found


def _less(cutter: Cutter) -> Iterator[tuple[int, Cutter]]:
    """A cutter without its holder, without its shank as well, and without its neck, too: what there is of them."""
    parts = {part for part, _, _ in cutter.stages}
    if cutter.holder is not None:
        cutter = replace(cutter, holder=None)
        yield REASONS.index("holder"), cutter
    if cutter.shape == "lollipop":
        return  # the neck is what its ball hangs on
    top = flute_length(cutter)
    if "shank" in parts:
        flutes = top if cutter.necks and cutter.shape != "form" else None
        cutter = replace(cutter, length=top + cutter.neck_length, shank_radius=None, flutes=flutes)
        yield REASONS.index("shank"), cutter
    if cutter.necks:
        yield REASONS.index("neck"), replace(cutter, length=top, neck=None, flutes=None)
