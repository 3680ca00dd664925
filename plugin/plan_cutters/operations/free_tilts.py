"""Look-ups in posture maps: whether a posture, given by its tool axis, is free at a sample."""

import math

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.stages.posture_maps import PostureMaps

Rows = NDArray[np.int64]
#: Between rotations of maps that have one alone, rad.
_ALONE = math.radians(10.0)
_ROUNDING = 1e-9
#: Places between rotations nearer to one than this are on it, in steps.
_NODE = 1e-7


def cells_of(maps: PostureMaps) -> Rows:
    """The sample and rotation (m,) of each free interval, as one number: sample times rotations plus rotation."""
    return np.repeat(np.arange(len(maps.offset) - 1), np.diff(maps.offset))


def step_of(maps: PostureMaps) -> float:
    """The angle between rotations, rad."""
    return float(maps.rotations[1] - maps.rotations[0]) if len(maps.rotations) > 1 else _ALONE


def full_turn(maps: PostureMaps) -> bool:
    """Whether the last rotation is next to the first one."""
    k = len(maps.rotations)
    return k > 2 and abs(k * step_of(maps) - 2.0 * math.pi) < 1e-6


def postures_of(maps: PostureMaps, row: Rows, axis: Floats) -> tuple[Floats, Floats]:
    """Tilts and rotations (p,), rad, of tool axes (p, 3) at samples (p,); rotations from the first one of the maps."""
    normal, first = maps.normal[row], maps.direction_max[row]
    x, y = (axis * first).sum(axis=1), (axis * np.cross(normal, first)).sum(axis=1)
    tilt = np.arctan2(np.hypot(x, y), (axis * normal).sum(axis=1))
    return tilt, np.remainder(np.arctan2(y, x) - maps.rotations[0], 2.0 * math.pi)


def holding(maps: PostureMaps, row: Rows, tilt: Floats, rotation: Floats) -> Rows:
    """The free intervals (p, 2) that hold tilts at samples (p,), at the two rotations beside `rotation`; -1 where none does."""
    k = len(maps.rotations)
    place = rotation / step_of(maps)
    # A rotation of the maps has that one on both sides, however it was rounded.
    place = np.where(np.abs(place - np.round(place)) < _NODE, np.round(place), place)
    if full_turn(maps):
        low, high = np.floor(place).astype(np.int64) % k, np.ceil(place).astype(np.int64) % k
        beyond = np.zeros(len(place), bool)
    else:
        # Past its ends a part of a turn says nothing, but for half a step.
        turn = 2.0 * math.pi / step_of(maps)
        place = np.where(place > k - 1.0 + 0.5 * (turn - k + 1.0), place - turn, place)
        beyond = (place < -0.5) | (place > k - 0.5)
        low = np.clip(np.floor(place), 0, k - 1).astype(np.int64)
        high = np.clip(np.ceil(place), 0, k - 1).astype(np.int64)
    result = np.full((len(row), 2), -1, np.int64)
    for side, turned in enumerate((low, high)):
        cell = row * k + turned
        start, count = maps.offset[cell], maps.offset[cell + 1] - maps.offset[cell]
        for i in range(int(count.max(initial=0))):
            there = np.flatnonzero((count > i) & ~beyond)
            at = start[there] + i
            inside = (maps.free[at, 0] <= tilt[there] + _ROUNDING) & (tilt[there] <= maps.free[at, 1] + _ROUNDING)
            result[there[inside], side] = at[inside]
    return result
