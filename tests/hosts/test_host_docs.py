"""The examples of the hosts and the pieces of their page run as they stand."""

import re
import runpy

import pytest

from tests.support.places import ROOT


@pytest.mark.slow("takes shapes of a CAD library")
def test_the_page_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    code = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "hosts.md").read_text(), re.DOTALL)
    assert len(code) == 5
    names = {}
    for piece in code:
        exec(compile(piece, "docs/hosts.md", "exec"), names)
    result, again = names["result"], names["again"]
    assert result.selected == again.selected
    assert [c.inaccessible for c in result.cutters] == [c.inaccessible for c in again.cutters]
    assert names["top"].cutters[0].model_dump() == names["same"].cutters[0].model_dump()
    assert len([f for f in names["slot"].plan.faces if f.target]) == 2
    assert names["chuck"].id == names["drawn"].id == "R8L20+R15L40"
    assert [f.name for f in names["held"].plan.fixtures] == ["fixture:clamp", "fixture:table"]
    assert all(each.least_stick_out for each in names["held"].faces(stick_out=True))
    assert "['targets', 'check faces', 'fixtures']" in capsys.readouterr().out
    assert any(group.name.startswith("tool ") for group in names["at_worst"].children)
    assert [child.label for child in names["labelled"].children] == [g.name for g in names["verdicts"].children]


@pytest.mark.slow("plans whole parts")
def test_the_blade(capsys):
    found = runpy.run_path(str(ROOT / "samples" / "cadquery_blade.py"))
    result, (thick, thin) = found["result"], found["result"].cutters
    assert thick.radius > thin.radius
    assert (result.selected, thick.feasible, thin.feasible) == (thin.id, False, True)
    assert found["chuck"].id == "R10:14L6+R14L24+R22L30"
    assert thick.by_reason["local_gouge"] > 0  # the fillet is smaller than the ball
    assert found["verdicts"].children[-1].name == f"tool {thick.id}"
    held = [face.least_stick_out for face in result.faces(stick_out=True)]
    assert all(0 < each < thin.length for each in held)
    assert f"least stick-out: {held[0]:.1f} mm" in capsys.readouterr().out


def test_the_mould(capsys):
    found = runpy.run_path(str(ROOT / "samples" / "build123d_mould.py"))
    result, targets = found["result"], found["targets"]
    short, long = sorted(result.cutters, key=lambda each: each.length)
    assert (result.selected, short.feasible, long.feasible) == (long.id, False, True)
    assert short.by_reason["holder"] > 0
    assert len(result.faces()) == len(targets) == 17
    assert result.faces(targets) == result.faces()
    assert found["verdicts"].children[-1].label == f"tool {short.id}"
    assert f"take {long.id}" in capsys.readouterr().out
