"""A sliver that would be a step of a fraction of a second is left by name where the part is not finished anyway."""

import json

import cadquery as cq
import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import plan
from plan_cutters.options import Options
from plan_cutters_check.asking import question_of
from plan_cutters_check.check import check

HOW = {
    "cutters": ["D6L40F20"],
    "fixtures": "table",
    "machine": "trunnion-ac",
    "feed": 3000.0,
    "link_time": 0.1,
    "grid": 4,
    "area_budget": 0,
    "operations": "fastest",
}


def slivered():
    """A table top with a chamfer of two hundredths of a millimetre below, which no tool from above cuts."""
    top = cq.Workplane().box(30, 30, 15).edges("<Z and >X").chamfer(0.02)
    return top.union(cq.Workplane().box(20, 20, 20).translate((0, 0, -17.5))).val()


def faces_of(shape):
    """Numbers of the top, of the sliver, and of the bottom."""
    faces = list(enumerate(cq.Workplane(shape).faces().vals(), 1))
    sliver = next(k for k, face in faces if face.Area() < 1.0)
    return max(faces, key=lambda each: each[1].Center().z)[0], sliver, min(faces, key=lambda each: each[1].Center().z)[0]


@pytest.mark.parametrize("short", [True, False])
def test_a_sliver_is_left_where_something_is_left_anyway(short, tmp_path):
    shape = slivered()
    top, number, bottom = faces_of(shape)
    part, asked = read_part(shape), {**HOW, "faces": [top, number, *([bottom] if short else [])]}
    made = plan(part, **asked)
    process, entry = made.plan.process, made.plan.operations.plans[0]
    (mine,) = np.nonzero(made.samples.face == number)
    label = made.answers.operations.plans[0].label
    assert (label[mine] < 0).all() == short
    assert entry.rest.short == (len(mine) if short else 0)
    causes = {each.cause: each for each in process.left}
    assert ("short_step" in causes) == short
    if short:
        assert causes["short_step"].faces == [f"F{number}"]
        assert causes["short_step"].samples == len(mine)
        assert "Left besides, 0.1 %, for other causes." in made.plan.text.lines, "a crumb has no line of its own"
    assert (process.finished_share == 1.0) != short
    assert sum(each.area_mm2 for each in (*process.steps, *process.left)) == pytest.approx(process.asked_mm2)
    # The check reckons the same, and finds what is left beyond that.
    made.write(tmp_path, ["json", "npz"])
    document, arrays = json.loads((tmp_path / "plan.json").read_text()), {}
    for name in ("operations.npz", "samples.npz"):
        with np.load(tmp_path / name) as archive:
            arrays[name] = {each: archive[each] for each in archive.files}
    options = {word: value for word, value in asked.items() if word not in ("operations", "feed", "link_time")}
    options = Options.of({**options, "faces": document["effective"]["faces"]})
    checked = check(question_of(part, options, document, arrays), seconds=10)
    assert checked.holds, checked.lines
