"""Tilted planes of fixed orientations, and the words that set a control to them."""

from collections.abc import Mapping

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.control_words import ControlWords, control_words
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.placement import Placement, frame_of
from plan_cutters.scene.conditions import Conditions

Named = Mapping[str, float]


def tilted_plane(
    conditions: Conditions, place: Placement | None, moved: Kinematics, axis: Floats, angle: Floats, own: Named | None,
    other: Named | None,
) -> tuple[Floats, Floats, ControlWords]:  # fmt: skip
    """The plane that a control turns to for a tool axis (3,): its origin (3,), mm, its x (3,), and its words.

    `moved`: the machine with what turns at `angle` (k,), rad. `own`, `other`: the angles by name, deg, and those of the other
    solution, if there is one.
    """
    origin = np.zeros(3) if place is None or place.origin is None else np.array(place.origin, float)
    x = frame_of(axis, moved.carried(conditions.frame[0], angle[None])[0])[0]
    words = control_words(conditions.frame, np.array([x, np.cross(axis, x), axis]), own, other)
    return origin, x, words
