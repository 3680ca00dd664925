"""Maps of one machine hold the free tilts that it holds, and no other; and in another setup only what it holds there is known."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import Triangles
from plan_cutters import Machine, PostureRange
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED, blank
from plan_cutters.errors import OptionError
from plan_cutters.scene import solids
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.stages.other_setups import in_setup
from plan_cutters.stages.posture_map import PostureMap
from plan_cutters.stages.posture_maps import PostureMaps

AROUND = Surroundings.sheet(Obstacles(Triangles(solids.box(np.zeros(3), np.ones(3)), np.ones(12, np.int32), 0.0, ())))
TURNS = 12


def conditions(machine, around=AROUND, setup=(0.0, 0.0, 1.0)):
    return Conditions(Machine.parse(machine), np.array(setup), PostureRange(), around, 0.01, 1)


def random_maps(seed, n=5):
    """Maps with none to three intervals of tilts at each rotation."""
    rng = np.random.default_rng(seed)
    normal = rng.normal(size=(n, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    direction = np.cross(normal, rng.normal(size=(n, 3)))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    cells = [np.sort(rng.uniform(0.0, 0.5 * math.pi, 2 * int(rng.integers(0, 4)))).reshape(-1, 2) for _ in range(n * TURNS)]
    offset = np.concatenate([[0], np.cumsum([len(each) for each in cells])]).astype(np.int64)
    verdict = np.full(n, ACCESSIBLE, np.uint8)
    rotations, sure = 2.0 * math.pi * np.arange(TURNS) / TURNS, np.zeros((n, TURNS), np.float32)
    return PostureMaps(
        rotations, offset, np.concatenate(cells), sure, normal, direction, verdict, np.full(n, 255, np.uint8),
        (0.0, math.pi / 2), 0.01, "T", "",
    )  # fmt: skip


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**31), st.sampled_from(["tilt:40", "trunnion-ac", "nutating-bc", "unlimited"]))
def test_a_tilt_is_held_where_it_is_free_and_the_machine_holds_its_axis(seed, machine):
    maps, there = random_maps(seed), conditions(machine)
    held = maps.held(there)
    assert (held is maps) == (machine == "unlimited")
    assert np.array_equal(held.verdict, maps.verdict)
    tilt = np.linspace(0.0, 0.5 * math.pi, 181)
    for row in range(len(maps.normal)):
        across = np.cross(maps.normal[row], maps.direction_max[row])
        for k, turn in enumerate(maps.rotations):
            lean = math.cos(turn) * maps.direction_max[row] + math.sin(turn) * across
            axis = np.cos(tilt)[:, None] * maps.normal[row] + np.sin(tilt)[:, None] * lean

            def inside(some, cell=row * TURNS + k):
                mine = some.free[some.offset[cell] : some.offset[cell + 1]]
                assert (mine[:, 0] <= mine[:, 1]).all()
                away = np.minimum(tilt[:, None] - mine[:, 0], mine[:, 1] - tilt[:, None]).max(axis=1, initial=-9.0)
                return away

            free, kept, may = inside(maps), inside(held), there.allows(axis)
            # Away from the ends of intervals, and from the limits of the machine.
            sure = (np.abs(free) > 1e-6) & (np.abs(kept) > 1e-6)
            assert ((kept > 0.0) == ((free > 0.0) & may))[sure].all()
    assert held.offset[-1] == len(held.free)


def test_in_another_setup_that_alone_is_known_which_the_machine_holds_there_among_the_same_obstacles():
    rng = np.random.default_rng(4)
    found = blank(40)
    axis = rng.normal(size=(40, 3))
    found.axis[:] = axis / np.linalg.norm(axis, axis=1)[:, None]
    found.verdict[:] = np.resize([ACCESSIBLE, INTERFERENCE_FREE, INACCESSIBLE, UNDECIDED, UNJUDGED], 40)
    found.tilt[:] = np.arange(40.0)
    verdicts = found.freeze()

    def known(machine, other=AROUND):
        here, there = conditions(machine), conditions(machine, other, setup=(0.6, 0.0, 0.8))
        asked = []

        def judged(ready, cutter, rows=None, known=None, **more):
            asked.append(known)
            return verdicts

        ready = SimpleNamespace(
            conditions=here, samples=np.zeros(40), there=lambda setup: SimpleNamespace(conditions=there, samples=np.zeros(40))
        )
        assert in_setup(ready, None, 1, verdicts, judged=judged) is verdicts
        return there, asked[0]

    for machine in ("unlimited", "tilt:50", "trunnion-ac"):
        there, some = known(machine)
        wanted = verdicts.reached & there.allows(verdicts.axis)
        assert wanted.any()
        assert np.array_equal(some.verdict == ACCESSIBLE, wanted)
        assert (some.verdict[~wanted] == UNJUDGED).all()
        assert np.array_equal(some.tilt[wanted], verdicts.tilt[wanted])
    # Not where rotations are numbered by axes of that setup, nor among other fixtures.
    others = Surroundings.sheet(Obstacles(AROUND.certain.triangles))
    for machine, around in (("4-axis-a", AROUND), ("3-axis", AROUND), ("unlimited", others)):
        assert (known(machine, around)[1].verdict == UNJUDGED).all()


def test_an_axis_of_a_map_leans_by_a_tilt_in_either_unit_within_half_a_turn():
    one = SimpleNamespace(normal=np.array([0.0, 0.0, 1.0]), direction_max=np.array([1.0, 0.0, 0.0]),
                          rotations=np.array([0.0, 0.5 * math.pi]))  # fmt: skip
    assert PostureMap.axis(one, 0, tilt_deg=30.0) == pytest.approx([0.5, 0.0, math.sqrt(0.75)])
    assert PostureMap.axis(one, 1, math.radians(30.0)) == pytest.approx([0.0, 0.5, math.sqrt(0.75)])
    assert PostureMap.axis(one, 0, tilt_deg=-180.0) == pytest.approx([0.0, 0.0, -1.0], abs=1e-12)
    for wrong in ({"tilt_deg": 180.5}, {"tilt_deg": -180.5}, {}, {"tilt": 1.0, "tilt_deg": 1.0}):
        with pytest.raises(OptionError, match="tilt"):
            PostureMap.axis(one, 0, **wrong)
