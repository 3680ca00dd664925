"""Each setup with its own fixtures and clamped faces: what is in the way there, and where nothing can be machined."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement, axis_words
from plan_cutters.domain.verdicts import ANOTHER_SETUP, FIXTURE, Verdicts
from plan_cutters.errors import FixtureError
from plan_cutters.options import Options
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.faces import clamped_faces
from plan_cutters.scene.inside_material import inside_material
from plan_cutters.scene.preparation import OtherSetup, Prepared
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.surroundings import Surroundings


def places(options: Options) -> tuple[Placement | None, ...]:
    """How the part stands in each setup, as far as it is known, the first one first."""
    return options.placement, *(options.other_placements or (None,) * len(options.other_setups))


def fixtures_of(options: Options) -> list[Fixture]:
    """The fixtures of all setups."""
    return [*options.fixtures, *(each for place in places(options) if place is not None for each in place.fixtures)]


def conditions_of(scene: Scene, options: Options) -> list[Conditions]:
    """The conditions of each setup, the first one first: with the obstacles of each, and one tolerance that all of them keep.

    Raises
    ------
    FixtureError
        A fixture stands in the part, or faces of one of another setup could not be read.
    """
    first, shared = scene.surround(), options.shared_fixtures
    axes = (scene.setup, *options.other_setups)
    own = [() if place is None else place.fixtures for place in places(options)]
    each_setup: list[Surroundings] = [first]
    for axis, mine in zip(axes[1:], own[1:], strict=True):
        each_setup.append(scene.surround_in(axis, shared, mine))
        if doubts := [each for each in each_setup[-1].doubts if each not in first.doubts]:
            # What is missing there would have to be told of each setup by itself.
            raise FixtureError(
                f"setup {axis_words(axis)}: {doubts[0]}; give a fixture that can be read whole, or make this setup the first"
            )
    tolerance = max(each.tolerance(scene.asked) for each in each_setup)
    return [
        Conditions(options.machine, np.array(axis), options.postures, each, tolerance, options.jobs, _x(place), options.accuracy)
        for axis, each, place in zip(axes, each_setup, places(options), strict=True)
    ]


def _x(place: Placement | None) -> Floats | None:
    return None if place is None or place.x is None else np.array(place.x)


def with_setups(ready: Prepared, conditions: list[Conditions]) -> Prepared:
    """Add what is held in the first setup, and the other setups with what cannot be machined there."""
    held = [_samples_of(ready, place, each) for place, each in zip(places(ready.options), conditions, strict=True)]
    others = []
    for each, clamped in zip(conditions[1:], held[1:], strict=True):
        inside = ready.inside
        if each.surroundings is not ready.conditions.surroundings:
            inside = inside_material(
                ready.samples, ready.scene.orientation, each.surroundings.enclosing, each.surroundings.certain, each.tolerance,
                each.jobs, inside,
            )  # fmt: skip
        others.append(OtherSetup(each, inside, clamped))
    return replace(ready, held=held[0], others=tuple(others))


def _samples_of(ready: Prepared, place: Placement | None, conditions: Conditions) -> NDArray[np.bool_]:
    """Samples (n,) of the faces that a setup clamps, or with which the part rests in a vise or chuck."""
    rests_on = [number for each in conditions.surroundings.fixtures if each.hold is not None for number in each.hold.rests_on]
    return np.isin(ready.samples.face, sorted({*clamped_faces(ready.scene.part, place, ready.scene.repeated), *rests_on}))


def stood_on(ready: Prepared) -> NDArray[np.bool_]:
    """Samples (n,) that what was proposed may hide: of faces that stand on a proposed table, or that a vise or chuck holds which
    was placed for a setup; of all faces where nothing but such vises and chucks stands anywhere."""
    faces, clamped = set[int](), True
    for place, conditions in zip(places(ready.options), ready.setups, strict=True):
        faces.update(int(name[1:]) for name in (() if place is None else place.stands_on))
        proposed = place is not None and place.proposed
        for each in conditions.surroundings.fixtures:
            faces.update(() if each.hold is None else each.hold.faces)
            clamped &= each.hold is not None or (proposed and each.fixture.clamping is not None)
    return np.isin(ready.samples.face, sorted(faces)) | (clamped and bool(faces))


def for_another_setup(ready: Prepared, verdicts: Verdicts) -> Verdicts:
    """The same verdicts with a reason of its own where fixtures alone are in the way, on faces that what was proposed holds."""
    mine = stood_on(ready) & verdicts.not_reached & (verdicts.reason == FIXTURE)
    if not mine.any():
        return verdicts
    return replace(verdicts, reason=np.where(mine, ANOTHER_SETUP, verdicts.reason).astype(np.uint8))
