"""Names that scripts may use still mean what they meant."""

import numpy as np

import plan_cutters
from plan_cutters.domain import holder, verdicts
from plan_cutters.domain.answers import RadiusMap
from plan_cutters.domain.stick_out import StickOut


def test_former_names_are_the_new_ones():
    assert plan_cutters.Stage is plan_cutters.Segment is holder.Segment
    assert verdicts.Reach is verdicts.Verdicts
    found = verdicts.blank(2)
    found.tilt_direction[:] = (1, 0, 0)
    assert found.lean is found.tilt_direction
    assert StickOut(1.0, 1.0, 2.0, "floor", tilt_direction=np.ones(3)).lean.tolist() == [1, 1, 1]
    assert isinstance(RadiusMap.lean, property)


def test_a_scene_still_answers_to_its_former_names():
    scene = plan_cutters.Scene.of("samples/v_groove.step", tolerance=0.02)
    assert scene.around is scene.surround()
    assert scene.tolerance == scene.surround().tolerance(0.02) == 0.02
    assert scene.turned == scene.turned_faces()
