"""Verdicts: the words and arrays that say what a cutter reaches, and why not where it does not.

The tolerance rule says what a gouge tolerance and the chord error of triangles let be called safe, and prove to be blocked. Every
point of the surface has a point of the triangles within their chord error, and the reverse. All that judges takes its depths
from here.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record
from plan_cutters.kernels import codes
from plan_cutters.kernels.codes import (
    ACCESSIBLE,
    AXIS_LIMIT,
    COLLISION,
    FIXTURE,
    INACCESSIBLE,
    INSIDE,
    INTERFERENCE_FREE,
    LOCAL_GOUGE,
    NO_REASON,
    REAR_GOUGE,
    SHARP_EDGE,
    TOLERANCE,
    UNDECIDED,
    UNJUDGED,
)

# The codes of verdicts and reasons are this module's as well.
__all__ = [
    "ACCESSIBLE", "ANOTHER_SETUP", "AXIS_LIMIT", "COLLISION", "CONCAVE", "CONVEX", "DRILLED", "FIXTURE", "INACCESSIBLE", "INSIDE",
    "INTERFERENCE_FREE", "LOCAL_GOUGE", "NO_REASON", "REAR_GOUGE", "REASONS", "SADDLE", "SHARP_EDGE", "TOLERANCE", "UNDECIDED",
    "UNJUDGED", "WORDS", "Bytes", "VerdictBuffer", "Verdicts", "Witness", "blank", "not_reached",
]  # fmt: skip

#: Why a sample is not reached; the last one is about setups that were proposed, which kernels know nothing of.
REASONS = (*codes.REASONS, "another_setup")
ANOTHER_SETUP = len(codes.REASONS)
#: The verdict on samples in holes for drills: no mill is asked for them, and no search writes it.
DRILLED = 4
#: Words of verdicts, from best to worst; the last one is none of a mill.
WORDS = {
    INTERFERENCE_FREE: "interference_free",
    ACCESSIBLE: "accessible",
    UNDECIDED: "undecided",
    INACCESSIBLE: "inaccessible",
    UNJUDGED: "unjudged",
    DRILLED: "drilled",
}
#: Classes of a surface at a sample; there is UNJUDGED, too.
CONVEX, CONCAVE, SADDLE = 0, 1, 2

Bytes = NDArray[np.uint8]
_POSTURE = ("axis", "tilt_direction", "tilt", "rotation", "shift")
_COLUMNS = ("verdict", *_POSTURE, "reason")


def not_reached(verdict: Bytes) -> NDArray[np.bool_]:
    """Which verdicts (n,) are inaccessible or undecided."""
    return np.asarray((verdict == INACCESSIBLE) | (verdict == UNDECIDED))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class _Columns(Record):
    """Verdicts of n samples, finished or not: the columns are those of `Verdicts`."""

    verdict: Bytes
    axis: Floats
    tilt_direction: Floats
    tilt: Floats
    rotation: Ints
    shift: Floats
    reason: Bytes

    def of(self, rows: NDArray[np.int64]) -> "Verdicts":
        """Take the verdicts of some samples."""
        return Verdicts(*(getattr(self, name)[rows] for name in _COLUMNS))

    @property
    def reached(self) -> NDArray[np.bool_]:
        """Samples (n,) at which a posture is known."""
        return self.interference_free | (self.verdict == ACCESSIBLE)

    def contact(self, point: Floats) -> Floats:
        """Where the tools touch (n, 3) as they are put down, from the samples' points (n, 3), mm."""
        return point + self.shift

    @property
    def not_reached(self) -> NDArray[np.bool_]:
        """Samples (n,) that are inaccessible or undecided."""
        return not_reached(self.verdict)

    @property
    def interference_free(self) -> NDArray[np.bool_]:
        """Samples (n,) at which every rotation serves at tilt 0."""
        return np.asarray(self.verdict == INTERFERENCE_FREE)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Verdicts(_Columns):
    """The verdicts of one cutter, sample by sample, with the posture found or the reason. Its arrays are read-only.

    Attributes
    ----------
    verdict : (n,) uint8
        INACCESSIBLE, ACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED or DRILLED.
    axis, tilt_direction : (n, 3) float
        Unit tool axis and tilt direction of the posture found; nan where there is none. At tilt 0 the tilt direction goes from
        the axis to the contact, and is shorter than 1 where the contact lies under the flat of the tip: by the share of the
        flat's radius that it is from the axis.
    tilt : (n,) float
        rad, nan where there is none.
    rotation : (n,) int32
        Index into the posture range's rotations, -1 where there is none.
    shift : (n, 3) float
        From the sample to the contact at which the tool is put down, mm. It is not 0 where a flank lies along the surface, and
        touches it elsewhere than with its lower end, and where the flat of a tip lies on a face that is not quite square to the
        axis (`scene.flats_and_flanks`).
    reason : (n,) uint8
        Index into REASONS where inaccessible or undecided, else NO_REASON.
    """

    def __post_init__(self) -> None:
        for name in _COLUMNS:
            getattr(self, name).setflags(write=False)

    def __reduce__(self) -> tuple[Any, ...]:
        # Unpacked arrays can be written: they are made read-only again.
        return Verdicts, tuple(getattr(self, name) for name in _COLUMNS)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class VerdictBuffer(_Columns):
    """Verdicts that a search or a stage is writing; `freeze` ends that.

    >>> buffer = blank(2)
    >>> buffer.verdict[0] = ACCESSIBLE
    >>> buffer.freeze().reached
    array([ True, False])
    >>> buffer.verdict[1] = ACCESSIBLE
    Traceback (most recent call last):
    ValueError: assignment destination is read-only
    """

    def freeze(self) -> Verdicts:
        """Give what was written as a result, of the same arrays: nothing can be written into this buffer any more."""
        return Verdicts(*(getattr(self, name) for name in _COLUMNS))

    def take(self, rows: Any, other: _Columns, at: Any = None) -> None:
        """Take over all that is known of some samples (an index or a mask), which in `other` stand `at` other places if given."""
        for name in _COLUMNS:
            getattr(self, name)[rows] = getattr(other, name)[rows if at is None else at]

    def take_posture(self, rows: Any, other: _Columns, at: Any = None) -> None:
        """Take over the postures of some samples, which in `other` stand `at` other places if that is given."""
        for name in _POSTURE:
            getattr(self, name)[rows] = getattr(other, name)[rows if at is None else at]

    def stand_upright(self, rows: NDArray[np.bool_], normal: Floats, tilt_direction: Floats) -> None:
        """Call some samples (n,) interference-free, with the normal (n, 3) as tool axis."""
        self.verdict[rows] = INTERFERENCE_FREE
        self.axis[rows], self.tilt_direction[rows] = normal[rows], tilt_direction[rows]
        self.tilt[rows], self.rotation[rows] = 0.0, 0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Witness(Record):
    """A sample that is not reached, and the posture that comes nearest to reaching it."""

    sample: int
    reason: str  #: One of REASONS.
    obstacle_face: int | None = None  #: Face that is in the way at that posture; negative for a fixture (`Surroundings.called`).
    obstacle_point: Floats | None = None  #: (3,) float: point of it that lies in the cutter.
    #: `tilt`, `rotation`: rad; None where the axis limit leaves no posture at all.
    tilt: float | None = None
    rotation: float | None = None
    axis: Floats | None = None  #: (3,) float.
    #: How deep the part reaches into the cutter there, mm, to the resolution of the search; None where it was not searched for.
    depth: float | None = None
    #: How many samples it stands for: those not reached on its face for its reason, and within its body where it lies in one.
    samples: int = 1
    untried: bool = False  #: No posture was looked for, though there may be a depth.


def blank(n: int) -> VerdictBuffer:
    """Make a buffer for n samples of which nothing is known yet."""
    return VerdictBuffer(
        verdict=np.full(n, UNJUDGED, np.uint8),
        axis=np.full((n, 3), np.nan),
        tilt_direction=np.full((n, 3), np.nan),
        tilt=np.full(n, np.nan),
        rotation=np.full(n, -1, np.int32),
        shift=np.zeros((n, 3)),
        reason=np.full(n, NO_REASON, np.uint8),
    )


#: Share of the tolerance that the obstacles' chord error may take, and what is asked of the tessellation.
CHORD_SHARE, CHORD_REQUESTED = 0.25, 0.2
#: Verdicts say something about a cutter whose radius and flutes' length the tolerance is a smaller share of.
JUDGED_SHARE = 0.25
#: Of a nominal answer, mm.
_HAIR = 1e-9


def depths(tolerance: float, chord_error: float) -> tuple[float, float]:
    """Depths that are safe and that are blocked, mm, for the true surface: negative within that distance.

    If no triangle reaches deeper than the first, no point of the surface is deeper than the tolerance; a point of a triangle that
    is deeper than the second proves one. Of what may not be touched at all the tolerance is 0.

    `tolerance`: depth that is allowed, mm. `chord_error`: of the triangles, mm.

    >>> depths(0.5, 0.125), depths(0.0, 0.125)
    ((0.375, 0.625), (-0.125, 0.125))
    """
    return tolerance - chord_error, tolerance + chord_error


def effective_tolerance(requested: float, chord_error: float) -> float:
    """The gouge tolerance that is kept, mm: the one requested or, where triangles cannot be that close, more.

    >>> effective_tolerance(0.01, 0.0025), effective_tolerance(0.01, 0.01)
    (0.01, 0.04)
    """
    return max(requested, chord_error / CHORD_SHARE)


def nominal_depth(chord_error: float) -> float:
    """Depth up to which nothing counts for the answer without a tolerance, mm.

    Next to the contact, where the true clearance is zero, triangles must not count; local gouging does.
    """
    return 2 * chord_error + _HAIR


def over_setups(each: Sequence[Verdicts]) -> tuple[Verdicts, Ints]:
    """Combine the verdicts of all setups, and name the setup that reaches each sample.

    `each`: in each setup, of the same n samples. Returns verdict and posture of the first setup that reaches a sample. Where none
    does: undecided if it is so in any; the reason is that of the first one in which not the axis limit alone leaves nothing, or
    the fixture if that is so in any. What is for drills is so in all. Returns (n,) int32: the setup that reaches each sample, -1
    for none.
    """
    n = len(each[0].verdict)
    combined, which = blank(n), np.full(n, -1, np.int32)
    combined.verdict[each[0].verdict == DRILLED] = DRILLED
    for k, verdicts in enumerate(each):
        rows = verdicts.reached & (which < 0)
        which[rows] = k
        combined.take(rows, verdicts)
    for verdicts in each:
        rows = (which < 0) & verdicts.not_reached
        first = rows & ~combined.not_reached
        combined.verdict[first], combined.reason[first] = verdicts.verdict[first], verdicts.reason[first]
        unsure = rows & (verdicts.verdict == UNDECIDED) & (combined.verdict == INACCESSIBLE)
        combined.verdict[unsure], combined.reason[unsure] = UNDECIDED, verdicts.reason[unsure]
        more = rows & ~first & (combined.reason == AXIS_LIMIT) & (verdicts.verdict == combined.verdict)
        combined.reason[more] = verdicts.reason[more]
        combined.reason[rows & (verdicts.reason == FIXTURE)] = FIXTURE
    return combined.freeze(), which
