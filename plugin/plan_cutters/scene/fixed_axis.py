"""Tool axes that stay as they are: where each serves, and few of them that serve as much as can be.

A machine that holds its rotary axes while it cuts (3+2) needs just that. Each axis is tested at each sample as a plan tests the
postures that it finds: what is served is proved to the same tolerance.
"""

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.verdicts import ACCESSIBLE, Verdicts, blank
from plan_cutters.scene.conditions import Conditions, contacts_of, rotations_of, tool_of
from plan_cutters.scene.threads import in_chunks

#: Tests that may be spent on axes that are compared, and how many axes these are at least and at most.
_TESTS, _FEWEST, _MOST = 3_000_000, 12, 64
#: Axes that are looked for where those compared serve nothing more.
_MORE = 64
#: Axes this close are one, rad; ends of ranges this close to a posture's are on it.
_SAME, _END = 1e-6, 1e-9
#: Rows of one axis that are tested together, and tests that a thread makes in one go.
_BLOCK, _AT_ONCE = 4096, 20_000


def serves(
    rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples, cutter: Cutter, conditions: Conditions
) -> NDArray[np.bool_]:
    """At which of some samples (m,) a cutter stands free with one axis (3,)."""
    return np.asarray(served_by(rows, np.asarray(axis)[None], samples, cutter, conditions)[0][0])


def served_by(
    rows: NDArray[np.int64], axes: Floats, samples: SurfaceSamples, cutter: Cutter, conditions: Conditions
) -> tuple[NDArray[np.bool_], int]:
    """At which of some samples (m,) a cutter stands free with each of some axes (k, 3).

    Returns
    -------
    free : (k, m) bool
    made : int
        How many times the tool was put down.
    """
    from plan_cutters.kernels.search.fixed_axis import served

    low, high = conditions.postures.tilt
    free = np.zeros((len(axes), len(rows)), bool)
    held = np.flatnonzero(conditions.machine.allows(axes, frame_of(conditions.setup, conditions.x)))
    if not len(held) or not len(rows):
        return free, 0
    tool, solids, contacts = tool_of(conditions.outer_tool(cutter)), conditions.obstacles.solids, contacts_of(samples)

    def tested(piece: NDArray[np.int64]) -> int:
        """Test a piece of a table of axes by blocks of rows."""
        which, block = np.divmod(piece, blocks)
        count = 0
        for k, part in zip(held[which].tolist(), block.tolist(), strict=True):
            ends = slice(part * _BLOCK, (part + 1) * _BLOCK)
            count += served(rows[ends], axes[k], contacts, low - _END, high + _END, tool, solids, free[k, ends])
        return count

    blocks = -(-len(rows) // _BLOCK)
    most = max(1, _AT_ONCE // min(_BLOCK, len(rows)))
    made = in_chunks(tested, np.arange(len(held) * blocks), conditions.jobs, chunk=most)
    if conditions.postures.rotation[1] - conditions.postures.rotation[0] <= 2.0 * np.pi - _END:
        for k in held.tolist():
            found = np.flatnonzero(free[k])
            free[k, found] &= _turned(rows[found], axes[k], samples, conditions)
    return free, made


def _turned(
    rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples, conditions: Conditions
) -> NDArray[np.bool_]:
    """At which samples (m,) an axis leans as the rotations that were asked for let it."""
    first, last = conditions.postures.rotation
    turn = rotations_of(samples.normal[rows], samples.direction_max[rows], lean_of(rows, axis, samples))
    beyond = np.remainder(turn - first + _END, 2.0 * np.pi)
    return np.asarray((beyond <= last - first + 2.0 * _END) | (samples.normal[rows] @ axis > 1.0 - _SAME**2))


def lean_of(rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples) -> Floats:
    """Unit tilt directions (m, 3) of one axis at samples; `direction_max` where it is the normal."""
    normal = samples.normal[rows]
    tilt_direction = axis - (normal @ axis)[:, None] * normal
    length = np.linalg.norm(tilt_direction, axis=1)[:, None]
    return np.asarray(
        np.where(length > 1e-12, tilt_direction / np.maximum(length, 1e-300), samples.direction_max[rows])
    )


def few_axes(
    samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, conditions: Conditions
) -> tuple[Floats, Ints]:
    """Few axes that together serve what a cutter reaches: the one that serves most of what is left comes next.

    Parameters
    ----------
    samples : SurfaceSamples
    cutter : Cutter
    verdicts : Verdicts
        What was found for it.
    conditions : Conditions

    Returns
    -------
    axes : (k, 3) float
        In the order in which they were taken.
    number : (n,) int32
        Of the axis that each sample goes with; -1 where it is not reached, or no axis was found before the search ended.
    """
    number = np.full(len(samples), -1, np.int32)
    rows = np.flatnonzero(verdicts.reached)
    if not len(rows):
        return np.zeros((0, 3)), number
    area = np.maximum(samples.area[rows], 1e-12)
    tried = _candidates(verdicts.axis[rows], area, conditions.setup, int(np.clip(_TESTS // len(rows), _FEWEST, _MOST)))
    table = np.array([serves(rows, axis, samples, cutter, conditions) for axis in tried])
    left = np.ones(len(rows), bool)
    axes: list[Floats] = []
    while left.any():
        gain = (table * (area * left)).sum(axis=1)
        best = int(gain.argmax())
        mine = table[best] & left
        if not mine.any():
            break
        number[rows[mine]] = len(axes)
        axes.append(tried[best])
        left &= ~mine
    for _ in range(_MORE):
        # Where none serves, the postures found do: the axis of the sample in the middle of what is left comes next.
        spare = np.flatnonzero(left)
        if not len(spare):
            break
        mean = (verdicts.axis[rows[spare]] * area[spare, None]).sum(axis=0)
        axis = verdicts.axis[rows[spare[int((verdicts.axis[rows[spare]] @ mean).argmax())]]]
        mine = np.zeros(len(rows), bool)
        mine[spare] = serves(rows[spare], axis, samples, cutter, conditions)
        if not mine.any():
            break
        number[rows[mine]] = len(axes)
        axes.append(axis)
        left &= ~mine
    return np.array(axes).reshape(-1, 3), number


def _candidates(axis: Floats, area: Floats, setup: Floats, most: int) -> Floats:
    """Axes (k, 3) to compare: the setup axis, the part's own, the mean of those found, and some found far from each other."""
    mean = (axis * area[:, None]).sum(axis=0)
    length = float(np.linalg.norm(mean))
    fixed = [setup, *([mean / length] if length > 1e-6 else []), *np.eye(3), *-np.eye(3)]
    kept: list[Floats] = []
    for each in fixed:
        if all(float(np.linalg.norm(each - other)) > _SAME for other in kept):
            kept.append(np.asarray(each, float))
    apart = np.full(len(axis), np.inf)
    for each in kept:
        apart = np.minimum(apart, np.linalg.norm(axis - each, axis=1))
    while len(kept) < most and apart.max() > _SAME:
        kept.append(axis[int(apart.argmax())])
        apart = np.minimum(apart, np.linalg.norm(axis - kept[-1], axis=1))
    return np.array(kept)


def held_at(axes: Floats, number: Ints, samples: SurfaceSamples) -> Verdicts:
    """The postures of samples that go with one of some axes each, as a search would write them."""
    found = blank(len(number))
    for k, axis in enumerate(axes):
        rows = np.flatnonzero(number == k)
        found.axis[rows], found.tilt_direction[rows] = axis, lean_of(rows, axis, samples)
        cosine = samples.normal[rows] @ axis
        across = np.linalg.norm(np.cross(samples.normal[rows], axis), axis=1)
        found.tilt[rows] = np.arctan2(across, cosine)
        found.verdict[rows] = ACCESSIBLE
    return found.freeze()
