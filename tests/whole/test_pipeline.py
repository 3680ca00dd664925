"""What is shared and cut up gives the same answer as one plan from the start."""

import inspect
import pickle
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io import read_part
from plan_cutters import Cutter, OptionError, Options, Scene, plan, posture_map
from plan_cutters.domain.preference import handed
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE
from plan_cutters.judging.judge import judge
from plan_cutters.pipeline import prepare
from plan_cutters.scene import scene as scenes
from tests.support.places import SAMPLES

CUTTERS = ("R6L60", "R3L40")
SMALL = {"cutters": CUTTERS, "grid": 33, "area_budget": 0, "rotation_step": 0.35}


def told(result):
    """The plan, but for how long it took."""
    return result.plan.model_dump(exclude={"run"})


@pytest.fixture(scope="module")
def ready():
    return prepare(SAMPLES / "peaks_and_valleys.step", Options.of(SMALL | {"grid": 61}))


@pytest.fixture(scope="module")
def whole(ready):
    small, large = Cutter.parse("R6L80"), Cutter.parse("R12L100")
    first = judge(ready, large)
    known = handed(small, {large: first}, len(ready.samples))
    second = judge(ready, small, known=known)
    verdicts = {v for reach in (first, second) for v in np.unique(reach.verdict).tolist()}
    assert verdicts >= {ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE}
    return {large: (first, None), small: (second, known)}


@pytest.mark.slow("searches long")
@given(st.lists(st.integers(1, 61 * 61 - 1), min_size=1, max_size=6), st.integers(1, 3))
@settings(max_examples=15, deadline=None)
def test_rows_are_judged_alike_however_they_are_cut(ready, whole, ends, jobs):
    alike = replace(ready, conditions=replace(ready.conditions, jobs=jobs))
    pieces = np.split(np.arange(len(ready.samples)), np.unique(ends))
    for cutter, (reach, known) in whole.items():
        for rows in pieces:
            assert judge(alike, cutter, rows, known) == reach.of(rows)
        # Rows that are no neighbours, too.
        assert judge(alike, cutter, np.concatenate(pieces[::2]), known) == reach.of(np.concatenate(pieces[::2]))


def test_a_scene_is_tessellated_once(monkeypatch):
    calls, real = [], scenes.surroundings
    monkeypatch.setattr(scenes, "surroundings", lambda *given, **more: calls.append(1) or real(*given, **more))
    scene = Scene.of(SAMPLES / "v_groove.step", setup=(0, 0, 2), tolerance=0.02)
    result = plan(scene, **SMALL)
    other = plan(scene, **SMALL | {"cutters": "R1L20"})
    point = result.samples.point[400].tolist()
    shared = posture_map(scene, point=point, cutter="R3L40", rotations=[0.0, 1.0])
    assert len(calls) == 1
    assert result.scene is other.scene is scene
    # The same as without a scene.
    alone = plan(SAMPLES / "v_groove.step", setup=(0, 0, 2), tolerance=0.02, **SMALL)
    assert told(alone) == told(result)
    assert alone.reaches == result.reaches
    assert posture_map(SAMPLES / "v_groove.step", point=point, cutter="R3L40", rotations=[0.0, 1.0], tolerance=0.02) == shared


@pytest.mark.parametrize(
    "other", [{"tolerance": 0.05}, {"setup": (0, 1, 0)}, {"flip": True}, {"ignore": "F1"}, {"unit": "in"}], ids=str
)
def test_a_scene_keeps_its_own_options(other):
    scene = Scene.of(SAMPLES / "v_groove.step")
    with pytest.raises(OptionError, match=r"scene was made with|read already"):
        plan(scene, **SMALL, **other)
    if "unit" not in other:
        with pytest.raises(OptionError, match="scene was made with"):
            posture_map(scene, point=(0, 0, 0), cutter="R3L40", rotations=[0.0], **other)


def test_parts_and_results_can_be_kept(tmp_path):
    """Pickled and back, a result writes the same bytes, and its part gives the same plan."""
    result = plan(SAMPLES / "pocket_top.step", spacing=6.0, **{k: SMALL[k] for k in ("cutters", "area_budget", "rotation_step")})
    again = pickle.loads(pickle.dumps(result))
    assert again.reaches == result.reaches
    assert again.samples == result.samples
    assert again.plan == result.plan
    for name, one in (("one", result), ("two", again)):
        one.write(tmp_path / name)
    for file in ("annotated.step", "annotated.glb", "samples.npz"):
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "two" / file).read_bytes()
    part = pickle.loads(pickle.dumps(result.part))
    assert part is not result.part
    assert (part.faces, part.warnings, part.tree[0].name) == (result.part.faces, result.part.warnings, result.part.tree[0].name)
    second = plan(part, spacing=6.0, **{k: SMALL[k] for k in ("cutters", "area_budget", "rotation_step")})
    assert told(second) == told(result)


def test_records_print_their_shapes_and_compare_by_their_numbers():
    result = plan(SAMPLES / "v_groove.step", **SMALL)
    assert "float64 (3267, 3)" in repr(result.samples)
    for record in (result, result.samples, result.reaches["R3L40"], result.scene, result.scene.surround().possible):
        assert len(repr(record)) < 1200
    reach = result.reaches["R3L40"]
    assert reach == pickle.loads(pickle.dumps(reach))
    other = replace(reach, tilt=reach.tilt + 1e-12)
    assert (reach == other, reach != other, reach == 3) == (False, True, False)


def test_an_option_is_declared_once():
    words = [each.name for each in fields(Options)]
    given = list(inspect.signature(plan).parameters)
    own = ["part", "progress", "cache"]
    assert given[: len(own) + len(words)] == [*own, *words]
    degrees = given[len(own) + len(words) :]
    assert all(name.endswith("_deg") and name.removesuffix("_deg") in words for name in degrees)
    with pytest.raises(OptionError, match="no option is called tolerence; did you mean tolerance"):
        plan(SAMPLES / "v_groove.step", tolerence=0.1)
    with pytest.raises(OptionError, match="no option is called x"):
        Options.of({"x": 1})


def test_the_other_side_is_machined_with_flip():
    """A dome is free from above and not reached from below, where the cutters would have to stand in it."""
    part = read_part(SAMPLES / "peaks_and_valleys.step")
    up, down = (plan(part, flip=flip, **SMALL | {"grid": 17}) for flip in (False, True))
    assert down.plan.effective.flip
    assert down.samples.normal == pytest.approx(-up.samples.normal)
    assert down.samples.curvature == pytest.approx(-up.samples.curvature[:, ::-1])
    assert (down.plan.samples.convex, down.plan.samples.concave) == (up.plan.samples.concave, up.plan.samples.convex)
    assert down.reaches["R6L60"] != up.reaches["R6L60"]
