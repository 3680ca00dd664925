"""Setups that are axes and planes of build123d and CadQuery are the same setups as their numbers."""

import build123d as bd
import cadquery as cq
import numpy as np
import pytest

from plan_cutters import Axis, Machine, Options, Placement, Scene, posture_map
from plan_cutters.errors import OptionError
from tests.support.cad_parts import box
from tests.support.places import SAMPLES

Z, X = (0.0, 0.6, 0.8), (1.0, 0.0, 0.0)
#: One frame in the words of each host; where its origin lies says nothing of the machine's zero.
PLANES = [bd.Plane(origin=(5, 6, 7), x_dir=X, z_dir=Z), cq.Plane(origin=(5, 6, 7), xDir=X, normal=Z)]
#: A machine whose first axis has limits: it matters where its X points.
NARROW = Machine("narrow", axes=(Axis("C", "rotary", "part", (0, 0, 1), (-0.5, 0.5)),
                                 Axis("A", "rotary", "part", (1, 0, 0), (-1.9, 1.9))))  # fmt: skip


@pytest.mark.parametrize(("given", "axis"), [
    ("Z", (0, 0, 1)), ("-z", (0, 0, -1)), ("+X", (1, 0, 0)),
    (bd.Axis.Z, (0, 0, 1)), (bd.Axis.Y.reverse(), (0, -1, 0)), (bd.Axis((1, 2, 3), Z), Z),
    (bd.Vector(0, 3, 4), Z), (cq.Vector(0, 3, 4), Z), (np.array([0, 3, 4]), Z),
])  # fmt: skip
def test_an_axis_is_its_direction(given, axis):
    made = Options(setup=given, other_setups=[given])
    assert made.setup == pytest.approx(axis, abs=1e-12)
    assert made.other_setups == (made.setup,)
    assert (made.placement, made.other_placements) == (None, ())
    assert Placement(z=given).z == made.setup
    assert Scene.of(box(), setup=given).setup == made.setup


@pytest.mark.parametrize("plane", PLANES, ids=["build123d", "cadquery"])
def test_a_plane_is_its_normal_and_its_x(plane):
    made = Options(setup=plane, other_setups=[plane])
    own = Placement(Z, X)
    for place in (made.placement, *made.other_placements):
        assert place.z == pytest.approx(own.z, abs=1e-12)
        assert place.x == pytest.approx(own.x, abs=1e-12)
        assert place.origin is None
    assert made.setup == pytest.approx(made.placement.z, abs=1e-12)
    with pytest.raises(OptionError, match="a plane and a placement were given for one setup: give one of them"):
        Options(setup=plane, placement=own)
    with pytest.raises(OptionError, match=r"a scene keeps the setup axis alone.*give its z here, and itself to plan"):
        Scene.of(box(), setup=plane)


@pytest.mark.parametrize("given", [
    Axis("B", "rotary", "part", (0, 1, 0)), bd.Axis, bd.Box(1, 1, 1).faces()[0], cq.Workplane(), None, bd.Vector(0, 0, 0),
    bd.Vector(float("nan"), 0, 1), {"direction": (0, 0, 1)},
], ids=["axis of a machine", "class", "face", "workplane", "none", "no direction", "nan", "table"])  # fmt: skip
def test_what_is_no_direction_is_refused(given):
    with pytest.raises(OptionError, match=r"^setup axis "):
        Options(setup=given)


@pytest.mark.slow("takes shapes of a CAD library")
def test_one_point_takes_the_x_of_a_plane_and_all_that_a_placement_says():
    words = {"point": (0, 0, 0), "cutter": "R8L90", "rotations_deg": [0, 40, 90], "machine": NARROW}
    scene = Scene.of(SAMPLES / "v_groove.step", setup=(0, 0.1, 1))
    across = (0.2, 1.0, -0.1)
    asked = posture_map(scene, **words, setup=(0, 0.1, 1), x=across)
    for plane in (bd.Plane((0, 0, 0), x_dir=across, z_dir=(0, 0.1, 1)), cq.Plane((0, 0, 0), across, (0, 0.1, 1))):
        found = posture_map(scene, **words, setup=plane)
        for one, other in zip((*found.free, *found.axis_limit), (*asked.free, *asked.axis_limit), strict=True):
            assert one == pytest.approx(other, abs=1e-9)
    # Another X is another answer: it was not for nothing.
    plain = posture_map(scene, **words)
    assert [each.tolist() for each in plain.axis_limit] != [each.tolist() for each in asked.axis_limit]
    fixed = Placement((0, 0.1, 1), across, fixtures=("box:20,20,20@-10,-10,50",))
    held = posture_map(scene, **words, setup=fixed)
    assert held != asked
    assert held == posture_map(scene.clamped(fixed.fixtures), **words, setup=(0, 0.1, 1), x=across)
    with pytest.raises(OptionError, match="setup auto is for a whole plan: name the setup"):
        posture_map(scene, **words, setup="auto")
