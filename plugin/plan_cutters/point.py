"""The order of the steps for one point: part and point in, posture map out."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cad_io.sample import locate
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.checks import number
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.posture import Heading, PostureRange, complement
from plan_cutters.domain.verdicts import nominal_depth
from plan_cutters.errors import OptionError
from plan_cutters.judging.posture_maps import SETTLED, PostureMap, moved, posture_map_of
from plan_cutters.options import PointOptions
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups.requested import setups_requested

#: Width (rad) below which a range of tilts stays undecided: with a tolerance, and for the nominal answer.
_NARROWEST, _NARROWEST_NOMINAL = 1e-4, 1e-5
#: The nominal answer: first chord error (mm), its share kept at each refinement, rounds.
_FIRST_CHORD, _FINER, _ROUNDS = 2e-3, 0.2, 6
#: More than this are not refined again.
_TRIANGLES = 600_000


def posture_map_at(
    part: Any, place: Sequence[float], cutter: Cutter, turns: Sequence[float], tilt: tuple[float, float], machine: Machine,
    tolerance: float | None, x: Heading | None, scene: PointOptions,
) -> PostureMap:  # fmt: skip
    """`calls.posture_map` of values that were looked at: `place` mm, `turns` and `tilt` rad."""
    low, high = tilt
    scene, x = _placed(part, scene, x)
    wanted = (part.asked if isinstance(part, Scene) else 0.01) if tolerance is None else number(tolerance, "tolerance")
    if not (wanted >= 0 and cutter.large_enough(wanted)):
        raise OptionError(f"tolerance {wanted:g} mm must lie between 0 and a quarter of the cutter's radius and length")
    low, high = max(0.0, low), min(np.pi, high)
    stage = Scene.of(part, **scene, **({"tolerance": wanted} if wanted > 0 else {}))
    contact = locate(stage.part, stage.orientation, place, ignore=stage.ignored)
    across = None
    if x is not None:
        across = np.array(Placement(stage.setup, x).x)
    setup, postures, at_rotations = np.array(stage.setup), PostureRange((low, high)), np.array(turns)

    def among(surroundings: Surroundings, tolerance: float) -> Conditions:
        return Conditions(machine, setup, postures, surroundings, tolerance, 1, across)

    if wanted > 0:
        surroundings = stage.surround()
        context = Context.of(cutter, among(surroundings, surroundings.tolerance(wanted)))
        posture_map = posture_map_of(contact, at_rotations, context, _NARROWEST)
        if context.judges:
            return posture_map
        # So coarse a tolerance says nothing about so small a cutter.
        none = tuple(np.zeros((0, 2)) for _ in turns)
        free = tuple(complement(forbidden, low, high) for forbidden in posture_map.axis_limit)
        return replace(posture_map, free=none, undecided=free, rear_gouge=none, collision=none, buried=none, certified=False)
    chord = min(_FIRST_CHORD, 1e-3 * cutter.radius)
    before: PostureMap | None = None
    for _ in range(_ROUNDS):
        surroundings = stage.surround_closer(chord)
        triangles = surroundings.certain.triangles
        nominal = nominal_depth(triangles.chord_error)
        tool = assembly(cutter, nominal, nominal)
        context = Context(cutter, among(surroundings, 0.0), tool, tool)
        now = posture_map_of(contact, at_rotations, context, _NARROWEST_NOMINAL)
        if before is not None and moved(before, now) < SETTLED:
            return replace(now, settled=True)
        before, chord = now, chord * _FINER
        if len(triangles) > _TRIANGLES:
            break
    assert before is not None
    return before


def _placed(part: Any, scene: PointOptions, x: Any) -> tuple[PointOptions, Any]:
    """The options of a scene with the setup as its axis alone, and the machine's X, with what more the setup says."""
    if "setup" not in scene:
        return scene, x
    own = part.fixtures if isinstance(part, Scene) else ()
    known = setups_requested(scene["setup"], None, (), (), scene.get("fixtures", own), propose=False)
    if known["propose"]:
        raise OptionError("setup auto is for a whole plan: name the setup")
    place = known["placement"]
    options: PointOptions = {**scene, "setup": known["setup"]}
    if place is not None and place.fixtures:
        options["fixtures"] = known["fixtures"]
    return options, place.x if x is None and place is not None else x
