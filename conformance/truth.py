"""The truth of postures that a program chose itself: closed forms where they hold, else bounds over the exact surface.

The closed forms of a made part describe it wherever a tool reaches from one of its contacts. A claim anywhere else is judged by branch
and bound: it proves a claim false, or that nothing is deeper than the lower bound. How far a safe tool is from all else is not asked.
"""

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from conformance.exact.bound import Tree, least, numbers, tree
from conformance.exact.slow import read
from conformance.made.confirm import cells_of
from conformance.made.part import FAR, held, judge
from conformance.made.parts import PARTS
from conformance.posture import Postures
from conformance.suite import Held
from conformance.tool import Floats, Tool

#: Drawn contacts that show where the closed forms hold: a claim is there within this distance (mm) of one, its normal within this
#: angle (rad).
_DRAWN, _NEAR, _TURN = 4000, 1.0, 0.2


def truth(part: str, tool: Tool, setup: str, postures: Postures, path: Path | None = None) -> tuple[Floats, Floats]:
    """Return bounds (n,) of the margins, mm: `low <= margin <= high`.

    `path` is the part's file, for what no closed form covers.
    """
    n = len(postures)
    low, high = np.full(n, -np.inf), np.full(n, np.inf)
    made = PARTS.get(part)
    known = np.zeros(n, bool)
    if made is not None and n:
        known = _covered(made, postures)
        if known.any():
            rows = np.flatnonzero(known)
            judged = judge(made, tool, made.setup(setup), postures.contact[rows], postures.axis[rows], postures.tip[rows])
            low[rows] = high[rows] = judged.margin
    if path is not None and not known.all():
        shape, rows = _tree(path), numbers(tool)
        for i in np.flatnonzero(~known):
            low[i], high[i], _ = least(shape, rows, postures.tip[i], postures.axis[i], enough=0.0)
            high[i] = FAR if high[i] >= 0.0 else high[i]
    return low, high


@lru_cache(maxsize=1)
def _tree(path: Path) -> Tree:
    return tree(cells_of(read(path)))


def limits(setup: Held, axis: Floats) -> Floats:
    """Return the angle (n,), degrees, from axes to the machine's limit, positive within; nan without one."""
    if setup.limit_deg is None:
        return np.full(len(axis), np.nan)
    up = np.array(setup.axis, float) / np.linalg.norm(setup.axis)
    return np.asarray(setup.limit_deg - np.degrees(np.arctan2(np.linalg.norm(np.cross(axis, up), axis=1), axis @ up)))


def _covered(part: Any, postures: Postures) -> np.ndarray:
    """Whether contacts (n,) lie where those of the part are drawn: on a skin, near one of them, with its normal."""
    from scipy.spatial import cKDTree

    points, normals = part.contacts(np.random.default_rng(0), _DRAWN)
    away, nearest = cKDTree(points).query(postures.contact)
    same = np.einsum("ij,ij->i", normals[nearest], postures.normal) > np.cos(_TURN)
    skin = np.any([held(material, postures.contact) for material in part.materials], axis=0)
    return np.asarray((away < _NEAR) & same & skin)
