"""Real pairs of plans: a longer holder, a wall that moved; the command with files, folders, and what is no plan."""

import json

import cadquery as cq
import pytest

from cad_io.read import read_part
from plan_cutters import Cutter, Holder, plan
from plan_cutters.report.to_json import dumps
from plan_cutters_ci.matching import match_faces
from plan_cutters_ci.model import Comparison
from plan_cutters_ci.plans import compare
from tests.support.commands import in_lines
from tests.support.forked import run

ASKED = {"faces": "all", "grid": 4, "area_budget": 0, "jobs": 2}


def pocket(wall=20.0, rib=False):
    """A block with a pocket whose long wall stands at `wall` from the middle."""
    body = cq.Workplane().box(80, 60, 30).cut(cq.Workplane().box(50, wall + 10, 24).translate((0, (wall - 10) / 2, 6)))
    return body.union(cq.Workplane().box(4, 20, 6).translate((0, 0, -3))) if rib else body


def planned(shape, holder="R12L30", length=30):
    tools = [Cutter.flat(radius=r, length=length, holder=Holder.parse(holder)) for r in (3, 8)]
    return plan(read_part(shape), cutters=tools, **ASKED).plan


@pytest.fixture(scope="module")
def before():
    return planned(pocket())


@pytest.fixture(scope="module")
def fat(before):
    return planned(pocket(), "R28L60", 14)


@pytest.mark.slow("plans pairs of parts")
def test_a_shorter_reach_under_a_fatter_holder_loses_the_pocket(before, fat):
    """The holder is the only thing that could be in the way: whatever is lost is lost to it."""
    found = compare(before, fat)
    assert found.comparable
    assert found.lost
    assert not found.won
    assert {c.matched_by for c in found.cutters} == {"cutting part"}
    assert all("stages" in [each.what for each in c.changes] for c in found.cutters)
    lost = [f for f in found.faces if f.lost]
    assert lost
    assert {f.now.reason for f in lost} == {"holder"}
    assert all(f.old == f.new for f in lost)


def test_a_moved_wall_is_new_and_costs_what_the_plans_say(before):
    after = planned(pocket(wall=24.0))
    pairs = match_faces(before, after)
    assert len(pairs) == len(before.faces) - 1 == len(after.faces) - 1
    for a, b, _ in pairs:
        assert a.shape == b.shape
        assert max(abs(x - y) for x, y in zip(a.centre_mm, b.centre_mm, strict=True)) <= 4.0 + 1e-6
    found = compare(before, after)
    assert found.comparable
    # Each cutter reaches as many faces whole as the plans say, and no more.
    for told in found.cutters:
        mine, theirs = (next(c for c in p.cutters if c.id == s.id) for p, s in ((before, told.was), (after, told.now)))
        whole = [sum(v.not_reached == 0 for v in c.faces.values()) for c in (mine, theirs)]
        assert whole[1] - whole[0] == len(told.faces_won) - len(told.faces_lost)


def test_a_rib_shifts_numbers_and_its_faces_are_new(before):
    found = compare(before, planned(pocket(rib=True)))
    assert found.comparable
    assert sum(f.old is None for f in found.faces) >= 3
    assert found.matched.get("place", 0) >= 8


def written(folder, plan):
    folder.mkdir(parents=True)
    (folder / "plan.json").write_text(dumps(plan), encoding="utf-8")
    return folder


def test_the_command_says_it_in_four_forms_and_one_code(tmp_path, before, fat):
    old, new = written(tmp_path / "old", before), written(tmp_path / "new", fat)
    told = run("diff", old, new / "plan.json", cwd=tmp_path)
    assert (told.returncode, told.stderr) == (1, "")
    assert "holder collision" in in_lines(told.stdout)
    assert run("diff", new, old, cwd=tmp_path).returncode == 0
    same = run("diff", old, old, cwd=tmp_path)
    assert (same.returncode, same.stdout) == (0, "part: nothing changed.\nNothing was lost or won.\n")
    made = run("diff", old, new, "--json", cwd=tmp_path)
    found = Comparison.model_validate_json(made.stdout)
    assert (made.returncode, found.format, found.format_version, found.lost) == (1, "plan-cutters-diff", 1, True)
    assert found.plans[0].faces == compare(before, fat).faces
    marked = run("diff", old, new, "--markdown", cwd=tmp_path)
    assert marked.returncode == 1
    assert "| less | " in marked.stdout
    assert run("diff", old, new, "--json", "--markdown", cwd=tmp_path).returncode == 2


def test_folders_of_many_are_paired_by_name(tmp_path, before, fat):
    for name, plan_of in (("a-plan", before), ("sub/b-plan", before), ("gone-plan", before)):
        written(tmp_path / "old" / name, plan_of)
    for name, plan_of in (("a-plan", before), ("sub/b-plan", fat), ("more-plan", before)):
        written(tmp_path / "new" / name, plan_of)
    done = run("diff", "old", "new", cwd=tmp_path)
    assert done.returncode == 1
    for line in (
        "a-plan: nothing changed.",
        "gone-plan: only in old; it counts as lost.",
        "more-plan: only in new; it counts as won.",
    ):
        assert line in done.stdout
    (tmp_path / "new/a-plan/plan.json").write_text('{"format": "plan-cutters-plan", "for')
    broken = run("diff", "old", "new", cwd=tmp_path)
    assert broken.returncode == 2
    assert "new/a-plan/plan.json: is no JSON or is half-written (line 1): plan the part again." in broken.stdout
    assert "only in old" in broken.stdout


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, "no such file or folder"),
        (b"", "is empty"),
        (b'{"format": "plan-cutters-plan", "uni', "half-written"),
        (b"\x81\x82\x83", "is no text"),
        (b"[1, 2]", "no plan of plan-cutters"),
        (b'{"format": "plan-cutters-diff"}', "no plan of plan-cutters"),
        (b'{"format": "plan-cutters-plan", "format_version": 7}', "has format version 7, and this program reads 1"),
        (b'{"format": "plan-cutters-plan", "format_version": 1, "faces": 3}', "plan the part again"),
    ],
)
def test_what_is_no_plan_is_one_line(tmp_path, before, text, said):
    old = written(tmp_path / "old", before)
    if text is not None:
        (tmp_path / "new.json").write_bytes(text)
    done = run("diff", old, "new.json", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith("plan-cutters diff: new.json: ")
    assert said in line


def test_a_plan_and_a_folder_of_many_are_two_kinds(tmp_path, before):
    written(tmp_path / "one", before)
    written(tmp_path / "many/a", before)
    (tmp_path / "none").mkdir()
    for words, said in ((("one", "many"), "give two of one kind"), (("one", "none"), "holds no plan.json"),
                        (("one", "one", "--despite", "weather"), "'weather' is not known"), (("one",), "NEW")):  # fmt: skip
        done = run("diff", *words, cwd=tmp_path)
        assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
        assert said in done.stderr


def test_an_area_that_is_not_known_is_read(tmp_path, before):
    """JSON has no number for it."""
    known = json.loads(dumps(before))
    known["faces"][0]["area_mm2"] = None
    folder = written(tmp_path / "old", before)
    (folder / "plan.json").write_text(json.dumps(known))
    assert run("diff", folder, folder, cwd=tmp_path).returncode == 0
