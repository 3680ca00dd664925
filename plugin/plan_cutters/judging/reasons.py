"""Why a sample is not reached, by what would free it: the first of these without which there is a posture is the reason.

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
from plan_cutters.domain.preference import inside
from plan_cutters.domain.shapes import flute_length
from plan_cutters.domain.verdicts import (
    AXIS_LIMIT,
    FIXTURE,
    INACCESSIBLE,
    INSIDE,
    LOCAL_GOUGE,
    NO_REASON,
    REASONS,
    TOLERANCE,
    UNJUDGED,
    Verdicts,
    blank,
)
from plan_cutters.scene.conditions import Conditions, Context, contacts_of
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.threads import Progress

_PARTS = tuple(REASONS.index(word) for word in ("neck", "shank", "holder"))


@dataclass(frozen=True, slots=True, eq=False)
class Explained:
    """The reach of a cutter with the reasons that can be acted on.

    Attributes
    ----------
    verdicts : Verdicts
        Verdicts and postures as they were.
    besides : (n,) uint8
        Where the reason is the axis limit: what else is in the way within it, index into REASONS; else NO_REASON.
    """

    verdicts: Verdicts
    besides: NDArray[np.uint8]

    @classmethod
    def of_search(cls, verdicts: Verdicts) -> "Explained":
        """With the reasons that the search of postures found: what forbids most tilts."""
        return cls(verdicts, np.full(len(verdicts.verdict), NO_REASON, np.uint8))


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
    machinable : sequence of (n,) bool
        Of each setup, the samples that are neither clamped nor inside material there.
    """

    samples: SurfaceSamples
    conditions: Sequence[Conditions]
    asked: NDArray[np.bool_]
    machinable: Sequence[NDArray[np.bool_]]
    _known: dict[str, dict[Cutter, Verdicts]] = field(default_factory=dict)

    def of(self, cutter: Cutter, verdicts: Verdicts, progress: Progress | None = None) -> Explained:
        """Find the reasons of what a cutter loses.

        Parameters
        ----------
        cutter : Cutter
        verdicts : Verdicts
            What it reaches over all setups, with the reasons that its search found.
        progress : callable, optional
            Called with the number of searches done, and the number of all.
        """
        tell = progress or (lambda done, total: None)
        first, n = self.conditions[0], len(verdicts.verdict)
        before, reason, besides = verdicts.reason, verdicts.reason.copy(), np.full(n, NO_REASON, np.uint8)
        rows = np.flatnonzero(verdicts.not_reached & self.asked & ~np.isin(before, (INSIDE, TOLERANCE)))
        limited, less, alone = first.machine.limited, list(_less(cutter)), first.surroundings.alone
        held = any(each.surroundings.alone is not None for each in self.conditions) or not self._alike
        if not len(rows) or not (limited or less or held):
            return Explained(verdicts, besides)
        # Flutes by themselves, without limits and fixtures: what they do not reach nothing else frees, and is done with.
        bare = replace(first.without_machine(), surroundings=alone or first.surroundings)
        searched = self._search("flutes", less[-1][1] if less else cutter, rows, bare)
        shut = rows[~searched.reached[rows] & np.isin(before[rows], (AXIS_LIMIT, FIXTURE, *_PARTS))]
        reason[shut] = searched.reason[shut]
        rows = rows[searched.reached[rows]]
        tell(1, 3)
        if limited:
            if less or held:
                searched = self._search("unlimited", cutter, rows, first.without_machine())
            free = searched.reached[rows] if self._alike else self._anywhere(cutter, rows, limited=False)
            reason[rows[free]] = AXIS_LIMIT
            # Where the limit leaves nothing by itself, and so does something without it, both take part.
            other = np.where(free, before[rows], searched.reason[rows])
            besides[rows] = np.where((free & (other != AXIS_LIMIT)) | (before[rows] == AXIS_LIMIT) & ~free, other, NO_REASON)
            rows = rows[~free]
        tell(2, 3)
        if less:
            # Where limits and local gouge alone leave nothing, flutes by themselves find nothing.
            rows = rows[~np.isin(before[rows], (AXIS_LIMIT, LOCAL_GOUGE))]
            if limited or held:
                rows = rows[self._anywhere(less[-1][1], rows)]
            self._held(less, rows, reason)
        tell(3, 3)
        return Explained(replace(verdicts, reason=reason), besides)

    def _held(self, less: Sequence[tuple[int, Cutter]], rows: NDArray[np.int64], reason: NDArray[np.uint8]) -> None:
        """Write which of holder, shank and neck has to be away for there to be a posture, from the top down."""
        for part, without in less[:-1]:
            served = self._anywhere(without, rows)
            reason[rows[served]] = part
            rows = rows[~served]
        reason[rows] = less[-1][0]

    @property
    def _alike(self) -> bool:
        """Whether all setups have the same obstacles, and leave the same samples."""
        first, mine = self.conditions[0].surroundings, self.machinable[0]
        return all(each.surroundings is first for each in self.conditions) and not any(
            (mine != each).any() for each in self.machinable
        )

    def _anywhere(self, cutter: Cutter, rows: NDArray[np.int64], *, limited: bool = True) -> NDArray[np.bool_]:
        """Whether a cutter has a posture in some setup that leaves the sample free; or would have, without axis limits."""
        served = np.zeros(len(rows), bool)
        for k, conditions in enumerate(self.conditions):
            open_ = self.machinable[k][rows] & ~served
            verdicts = self._search(
                f"setup {k}" if limited else f"unlimited {k}",
                cutter,
                rows[open_],
                conditions if limited else conditions.without_machine(),
            )
            served |= open_ & verdicts.reached[rows]
        return served

    def _search(self, under: str, cutter: Cutter, rows: NDArray[np.int64], conditions: Conditions) -> Verdicts:
        """Search for postures of some samples, but where what was found for other cutters `under` the same tells."""
        verdicts, known = blank(len(self.asked)), self._known.setdefault(under, {})
        for other, earlier in known.items():
            # As `nesting.handed`, but of the samples that were looked at.
            if cutter == other:
                mine = rows[earlier.verdict[rows] != UNJUDGED]
            elif inside(cutter, other):
                mine = rows[earlier.reached[rows] & (verdicts.verdict[rows] == UNJUDGED)]
            elif inside(other, cutter):
                mine = rows[(earlier.verdict[rows] == INACCESSIBLE) & (verdicts.verdict[rows] == UNJUDGED)]
            else:
                continue
            verdicts.take(mine, earlier)
        open_rows = rows[verdicts.verdict[rows] == UNJUDGED]
        if len(open_rows):
            context = Context.of(cutter, conditions)
            search(contacts_of(self.samples), self.samples.face, open_rows, context, verdicts, fixed=True, brief=True)
        known[cutter] = verdicts.freeze()
        return known[cutter]


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
