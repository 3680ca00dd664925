"""Shares of area by verdict: against sums by hand, and against the samples that they come from."""

from types import SimpleNamespace

import numpy as np
import pytest

from cad_io.arrays import SurfaceSamples
from plan_cutters import plan
from plan_cutters.document.build import face_verdicts, whole_share
from plan_cutters.domain.verdicts import REASONS, blank

SAMPLE = "samples/v_groove.step"


def judged(verdict, reason):
    reach = blank(len(verdict))
    reach.verdict[:], reach.reason[:] = verdict, reason
    return reach


def part(*areas):
    return SimpleNamespace(faces=[SimpleNamespace(area=area) for area in areas])


def of(face, area, empty=()):
    made = SimpleNamespace(face=np.array(face, np.int32), area=np.array(area, float), empty=empty)
    made.by_face = lambda: SurfaceSamples.by_face(made)
    return made


def test_shares_follow_area_not_samples():
    samples = of([2, 1, 2, 1], [1.0, 9.0, 3.0, 1.0])
    shank, gouge = REASONS.index("shank"), REASONS.index("rear_gouge")
    faces = face_verdicts(samples, judged([0, 2, 3, 1], [shank, 255, gouge, 255]))
    assert faces["F1"].area_share.interference_free == pytest.approx(0.9)
    assert faces["F1"].area_share.accessible == pytest.approx(0.1)
    assert faces["F2"].area_share.inaccessible == pytest.approx(0.25)
    assert faces["F2"].area_share.lost_by == pytest.approx({"shank": 0.25, "rear_gouge": 0.75})
    whole = whole_share(faces, samples, part(10.0, 4.0))
    assert whole.interference_free == pytest.approx(9 / 14)
    assert whole.lost_by == pytest.approx({"rear_gouge": 3 / 14, "shank": 1 / 14})


def test_faces_without_samples_are_not_judged():
    samples = of([1], [5.0], empty=((2, "has no border"),))
    faces = face_verdicts(samples, judged([1], [255]))
    whole = whole_share(faces, samples, part(5.0, 15.0))
    assert (whole.accessible, whole.unjudged) == pytest.approx((0.25, 0.75))


def test_faces_of_unknown_area():
    samples = of([1, 1, 2], [0.0, 0.0, 3.0])
    faces = face_verdicts(samples, judged([0, 1, 1], [1, 255, 255]))
    assert faces["F1"].area_share.inaccessible == pytest.approx(0.5)
    assert whole_share(faces, samples, part(0.0, 3.0)).accessible == pytest.approx(1.0)
    assert whole_share(faces, samples, part(0.0, 0.0)).inaccessible == pytest.approx(0.25)


def test_shares_of_a_plan_are_those_of_its_samples():
    result = plan(SAMPLE, cutters="R8L90", grid=9, area_budget=0)
    entry, reach = result.cutters[0], result.reaches["R8L90"]
    area = result.samples.area
    for word, code in (("inaccessible", 0), ("accessible", 1), ("interference_free", 2), ("undecided", 3)):
        assert getattr(entry.area_share, word) == pytest.approx(area[reach.verdict == code].sum() / area.sum(), abs=1e-12)
    assert sum(getattr(entry.area_share, word) for word in
               ("inaccessible", "accessible", "interference_free", "undecided", "unjudged")) == pytest.approx(1.0)  # fmt: skip
    assert sum(entry.area_share.lost_by.values()) == pytest.approx(entry.area_share.inaccessible + entry.area_share.undecided)
