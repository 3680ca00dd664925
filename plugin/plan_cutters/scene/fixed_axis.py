"""Tool axes that stay as they are: where each serves, and the postures with it.

A machine that holds its rotary axes while it cuts (3+2) needs just that. Each axis is tested at each sample as a plan tests the
postures that it finds: what is served is proved to the same tolerance.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.domain.verdicts import ACCESSIBLE, Verdicts, blank
from plan_cutters.scene.conditions import Conditions, Context, contacts_of, rotations_of
from plan_cutters.scene.threads import Progress, in_chunks

#: Axes this close are one, rad; ends of ranges this close to a posture's are on it.
_SAME, _END = 1e-6, 1e-9
#: Rows of one axis that are tested together, and tests that a thread makes in one go.
_BLOCK, _AT_ONCE = 4096, 20_000


def serves(rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples, context: Context) -> NDArray[np.bool_]:
    """At which of some samples (m,) a cutter stands free with one axis (3,)."""
    return np.asarray(served_by(rows, np.asarray(axis)[None], samples, context)[0][0])


def served_by(
    rows: NDArray[np.int64], axes: Floats, samples: SurfaceSamples, context: Context, progress: Progress | None = None
) -> tuple[NDArray[np.bool_], int]:
    """At which of some samples (m,) a cutter stands free with each of some axes (k, 3).

    Returns
    -------
    free : (k, m) bool
    made : int
        How many times the tool was put down.
    """
    column, made = _tested(rows, axes, samples, context, progress)
    return column >= 0, made


def _tested(
    rows: NDArray[np.int64], axes: Floats, samples: SurfaceSamples, context: Context, progress: Progress | None = None
) -> tuple[NDArray[np.int8], int]:
    """How a cutter stands at samples with axes (k, m), in the numbers of the kernel, and how many times it was put down."""
    from plan_cutters.kernels.search.fixed_axis import DIRECTIONS, served

    conditions, (low, high) = context.conditions, context.conditions.postures.tilt
    column = np.full((len(axes), len(rows)), -1, np.int8)
    held = np.flatnonzero(conditions.allows(axes))
    if not len(held) or not len(rows):
        return column, 0
    tool, solids, contacts = context.outer, conditions.obstacles.solids, contacts_of(samples)
    full_turn = conditions.postures.rotation[1] - conditions.postures.rotation[0] > 2.0 * np.pi - _END
    ways = DIRECTIONS if full_turn else 0

    def tested(piece: NDArray[np.int64]) -> int:
        """Test a piece of a table of axes by blocks of rows."""
        which, block = np.divmod(piece, blocks)
        count = 0
        for k, part in zip(held[which].tolist(), block.tolist(), strict=True):
            ends = slice(part * _BLOCK, (part + 1) * _BLOCK)
            count += served(rows[ends], axes[k], contacts, low - _END, high + _END, tool, solids, ways, column[k, ends])
        return count

    blocks = -(-len(rows) // _BLOCK)
    most = max(1, _AT_ONCE // min(_BLOCK, len(rows)))
    made = in_chunks(tested, np.arange(len(held) * blocks), conditions.jobs, progress, chunk=most)
    if not full_turn:
        for k in held.tolist():
            touched = np.flatnonzero(column[k] >= 0)
            turned = _turned(rows[touched], axes[k], samples, conditions)
            column[k, touched[~turned]] = -1
    return column, made


def _turned(rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples, conditions: Conditions) -> NDArray[np.bool_]:
    """At which samples (m,) an axis leans as the rotations that were requested let it."""
    first, last = conditions.postures.rotation
    turn = rotations_of(samples.normal[rows], samples.direction_max[rows], tilt_direction_of(rows, axis, samples))
    beyond = np.remainder(turn - first + _END, 2.0 * np.pi)
    return np.asarray((beyond <= last - first + 2.0 * _END) | (samples.normal[rows] @ axis > 1.0 - _SAME**2))


def tilt_direction_of(rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples) -> Floats:
    """Return the unit tilt directions (m, 3) of one axis at samples; `direction_max` where it is the normal."""
    normal = samples.normal[rows]
    tilt_direction = axis - (normal @ axis)[:, None] * normal
    length = np.linalg.norm(tilt_direction, axis=1)[:, None]
    return np.asarray(np.where(length > 1e-12, tilt_direction / np.maximum(length, 1e-300), samples.direction_max[rows]))


def held_at(axes: Floats, number: Ints, samples: SurfaceSamples, context: Context) -> Verdicts:
    """Return the postures of samples that go with one of some axes each, as a search would write them.

    Where the axis is the normal, or nearly so (`kernels.search.fixed_axis.FLAT`), and the cutter is free upright alone, with its
    bottom across the axis, the tilt is 0 and the tilt direction is where it leans: about `standing` samples.
    """
    from plan_cutters.kernels.search.fixed_axis import DIRECTIONS

    verdicts = blank(len(number))
    for k, axis in enumerate(axes):
        rows = np.flatnonzero(number == k)
        ways = _tested(rows, axis[None], samples, context)[0][0].astype(np.int64)
        cosine = samples.normal[rows] @ axis
        across = np.linalg.norm(np.cross(samples.normal[rows], axis), axis=1)
        first = samples.direction_max[rows] - (samples.direction_max[rows] @ axis)[:, None] * axis
        first /= np.maximum(np.linalg.norm(first, axis=1), 1e-300)[:, None]
        turn = (2.0 * np.pi / DIRECTIONS) * (ways - 1)[:, None]
        about = np.cos(turn) * first + np.sin(turn) * np.cross(axis, first)
        flat = ways > 0
        verdicts.axis[rows] = axis
        verdicts.tilt_direction[rows] = np.where(flat[:, None], about, tilt_direction_of(rows, axis, samples))
        verdicts.tilt[rows] = np.where(flat, 0.0, np.arctan2(across, cosine))
        verdicts.verdict[rows] = ACCESSIBLE
    return verdicts.freeze()


def at_fixed_axis(samples: SurfaceSamples, held: Verdicts) -> SurfaceSamples:
    """Samples with the axis for their normal where the cutter stands upright."""
    upright = (held.tilt == 0.0)[:, None] & np.isfinite(held.axis)
    return replace(samples, normal=np.where(upright, held.axis, samples.normal))
