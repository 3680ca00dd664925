"""A face that triangles do not follow closely costs its neighbourhood, and never makes a verdict safer."""

from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

import plan_cutters.scene.surroundings as surroundings
from cad_io import read_part
from cad_io.tessellate import tessellate
from plan_cutters import plan
from plan_cutters.domain.verdicts import ACCESSIBLE, CHORD_REQUESTED, CHORD_SHARE, INACCESSIBLE, INTERFERENCE_FREE, UNDECIDED
from tests.support.cad_parts import real
from tests.support.distances import ROUNDING, farthest_from, surface_points

PROPELLER, SPRING = real("hard/autogiro_Prop1045_inverso.step", "hard/occtds_bug22869_Spring.igs")
ASKED = {"cutters": "R3L60rc3F20S3", "spacing": 4, "area_budget": 0}
TOLERANCE = 0.01
CHORD = CHORD_REQUESTED * TOLERANCE
#: So many triangles leave one small face of the propeller loose, F23.
BUDGET, LOOSE = 350_000, 23


@pytest.mark.slow("judges a part again with each tolerance")
@pytest.mark.parametrize("path", [PROPELLER, SPRING], ids=lambda path: path.stem)
def test_these_need_no_larger_tolerance(path):
    """A spline with pieces of a hundred-millionth of its range; a border beside 700 lines of a grid."""
    part = read_part(path)
    triangles = tessellate(part, CHORD, jobs=2)
    assert triangles.chord_error <= CHORD
    assert not triangles.loose
    assert_each_face_is_within_its_error(part, triangles)


@pytest.mark.slow("judges a part again with each tolerance", but=("30000",))
@pytest.mark.parametrize("path", [PROPELLER], ids=lambda path: path.stem)
@pytest.mark.parametrize("budget", [BUDGET, 100_000, 30_000])
def test_each_face_is_within_the_error_that_it_says(path, budget):
    part = read_part(path)
    triangles = tessellate(part, CHORD, budget=budget, jobs=2)
    assert len(triangles) <= budget
    errors = dict(triangles.errors)
    assert set(errors) == {face.number for face in part.faces}
    assert triangles.chord_error == max(error for n, error in errors.items() if n not in dict(triangles.loose))
    assert all(errors[n] == error > triangles.chord_error for n, error in triangles.loose)
    assert_each_face_is_within_its_error(part, triangles)


def assert_each_face_is_within_its_error(part, triangles):
    rng = np.random.default_rng(1)
    for number, error in triangles.errors:
        points = surface_points(part, number, 60, rng)
        assert farthest_from(points, triangles.vertex[triangles.face == number], error + ROUNDING) <= error + ROUNDING


@pytest.fixture(scope="module", params=[PROPELLER], ids=lambda path: path.stem)
def planned(request):
    """The propeller with a budget that does for all of it, and with one that leaves a face loose."""
    found = {}
    for budget in (2_000_000, BUDGET):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(surroundings, "tessellate", lambda *given, _most=budget, **words: tessellate(
                *given, **words | {"budget": _most}))  # fmt: skip
            found[budget] = plan(request.param, **ASKED)
    return found[2_000_000], found[BUDGET]


def verdicts(result):
    return next(iter(result.reaches.values())).verdict


@pytest.mark.slow("judges a part again with each tolerance")
def test_the_tolerance_stays_and_the_face_is_named(planned):
    close, loose = planned
    assert not close.plan.effective.local_tolerance
    [local] = loose.plan.effective.local_tolerance
    assert local.face == f"F{LOOSE}"
    assert local.tolerance_mm == pytest.approx(local.chord_error_mm / CHORD_SHARE)
    assert local.chord_error_mm > CHORD
    for result in planned:
        assert result.plan.effective.tolerance_mm == TOLERANCE
    assert "faces_loose" in loose.plan.note_codes
    assert "faces_loose" not in close.plan.note_codes
    by_id = {face.id: face.chord_error_mm for face in loose.plan.faces}
    assert by_id[local.face] == local.chord_error_mm
    assert max(error for face, error in by_id.items() if face != local.face) <= CHORD


@pytest.mark.slow("judges a part again with each tolerance")
def test_a_looser_face_makes_no_verdict_safer_and_none_surer(planned):
    close, loose = map(verdicts, planned)
    assert len(close) == len(loose)
    # Another mesh may take a sample that lies within a hair of the border to the other side of "undecided", not further.
    safe = np.isin(loose, (ACCESSIBLE, INTERFERENCE_FREE))
    assert not (safe & (close == INACCESSIBLE)).any()
    assert not ((loose == INACCESSIBLE) & np.isin(close, (ACCESSIBLE, INTERFERENCE_FREE))).any()
    assert (loose == UNDECIDED).sum() > (close == UNDECIDED).sum()


@pytest.mark.slow("judges a part again with each tolerance")
def test_only_what_is_near_the_face_is_undecided(planned):
    close, loose = planned
    changed = verdicts(loose) != verdicts(close)
    assert changed.any()
    assert changed.mean() < 0.01
    # The cutter touches nothing farther away than its length and diameter together: here it is much less.
    samples = loose.samples
    own = samples.point[samples.face == LOOSE]
    away = np.linalg.norm(samples.point[changed][:, None] - own[None], axis=2).min(axis=1)
    assert away.max() < 6.0


@pytest.mark.slow("judges a part again with each tolerance")
def test_a_part_without_its_loose_face_decides_no_less_elsewhere(planned):
    _, loose = planned
    without = plan(PROPELLER, **ASKED, ignore=f"F{LOOSE}")
    assert not without.plan.effective.local_tolerance
    decided = dict(zip(map(tuple, without.samples.point.tolist()), verdicts(without).tolist(), strict=True))
    own = loose.samples.face == LOOSE
    pairs = [
        (verdict, decided[point])
        for point, verdict in zip(map(tuple, loose.samples.point[~own].tolist()), verdicts(loose)[~own].tolist(), strict=True)
        if point in decided
    ]
    assert len(pairs) == (~own).sum()
    assert not [pair for pair in pairs if pair[0] != UNDECIDED and pair[1] == UNDECIDED]


def test_a_hole_whose_wall_is_loose_counts_as_no_material(monkeypatch):
    """Without its wall a deep hole in a large block looks like the block's inside: its mouth is smaller than a cell."""
    block = BRepPrimAPI_MakeBox(gp_Pnt(0.0, 0.0, 0.0), 1600.0, 1600.0, 100.0).Shape()
    hole = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(800.0, 800.0, 40.0), gp_Dir(0.0, 0.0, 1.0)), 5.0, 61.0).Shape()
    part = read_part(BRepAlgoAPI_Cut(block, hole).Shape())
    [wall] = [face.number for face in part.faces if face.shape == "cylinder"]
    [floor] = [face.number for face in part.faces if face.shape == "plane" and face.area < 100.0]
    error = 0.02

    def with_loose_wall(*given, **words):
        found = tessellate(*given, **words)
        errors = {**dict(found.errors), wall: error}
        return replace(found, loose=((wall, error),), errors=tuple(sorted(errors.items())))

    monkeypatch.setattr(surroundings, "tessellate", with_loose_wall)
    result = plan(part, cutters="R1L20", faces=f"F{floor}", spacing=2, area_budget=0, drill_below=0)
    assert (verdicts(result) != INACCESSIBLE).all()
    assert np.isin(verdicts(result), (ACCESSIBLE, INTERFERENCE_FREE)).any()
