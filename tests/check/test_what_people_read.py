"""What plan.json says outside its operations, forged: found, or named in the first line of the answer as not checked."""

import json
import math
from collections import defaultdict
from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import Options, plan
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.plan_file.load import plan_of
from plan_cutters.plan_file.words.text import with_text
from plan_cutters_check.asking import question_of
from plan_cutters_check.bench import Bench, Contacts
from plan_cutters_check.check import check
from plan_cutters_check.findings import leaves, pattern
from plan_cutters_check.fixtures import faults
from plan_cutters_check.reckoned import Reckoned
from plan_cutters_check.surface import FREE, MET, Clock
from plan_cutters_check.trials import postures
from tests.support.forging import forged, put
from tests.support.unchecked import listed
from tests.support.written_plan import Written

pytestmark = pytest.mark.slow("forges the entries of a second plan", only=("written",))

#: A block in a vise, of a size that the vise grips at its long sides.
HELD = {"cutters": ["D8L30F16S10"], "holder": "er16", "fixtures": "vise", "faces": "all", "grid": 4, "machine": "trunnion-ac"}
#: One entry in so many is forged, or given one more beside it.
ONE_IN = [30, pytest.param(1, marks=pytest.mark.slow("forges an entry of every kind"))]


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    import cadquery

    path = tmp_path_factory.mktemp("block") / "block.step"
    cut = cadquery.Workplane().box(60, 40, 30, centered=(True, True, False)).faces(">Z").workplane().rect(30, 20).cutBlind(-8)
    cadquery.exporters.export(cut, str(path))
    return str(path)


@pytest.fixture(scope="module")
def held(block, tmp_path_factory):
    out = tmp_path_factory.mktemp("held")
    plan(block, operations="fastest", feed=1000, area_budget=0, **HELD).write(out, ["json", "npz"])
    return Written(out, block, HELD)


@pytest.fixture(scope="module", params=["held", "written"])
def one(request):
    """The block in its vise, and a free-form pocket over a table."""
    return request.getfixturevalue(request.param)


def answered(one, document=None, arrays=None):
    """The answer without a tool put down; None where the plan is refused before."""
    try:
        return one.read(document, arrays)
    except (PlanError, KeyError, TypeError, ValueError, IndexError, OverflowError, AttributeError):
        # As `--check-operations` does, which refuses it then.
        return None


def named(answer, path):
    """Whether the first line names an entry, or what holds it, as not checked."""
    names = answer.first.partition("Not checked: ")[2]
    holds = [each for each in answer.entries.unchecked if path == each or path.startswith((f"{each}.", f"{each}["))]
    parts = [pattern(each).replace("[]", "").partition(".") for each in holds]
    return any(begin in names and rest in names for begin, _, rest in parts)


def test_what_is_written_holds(one):
    answer = one.read()
    assert answer.holds, "\n".join(answer.lines)
    assert not answer.entries.differ
    assert not [path for path in answer.entries.unchecked if not listed(pattern(path))]
    # What people read of a plan is checked, all of it.
    first = {path.split(".")[0].split("[")[0] for path in answer.entries.unchecked}
    assert "text" not in first
    # What is advised rests on judgements of other tools, which are not made again.
    advice = (
        "process.steps",
        "process.setups",
        "process.stock",
        "process.exempt",
        *(f"process.{word}_seconds" for word in ("cutting", "link", "index", "change", "setup")),
        *(
            f"process.left[{k}].{word}"
            for k in range(9)
            for word in ("fits", "points", "helped", "cause", "samples", "faces", "place_mm")
        ),
    )
    assert not [path for path in answer.entries.unchecked if path.startswith("process") and not path.startswith(advice)]


def _forgeries(document, one_in):
    """One entry of each kind, or of one kind in so many, by a seed, with other values of its kind."""
    rng, of_kind = np.random.default_rng(0), defaultdict(list)
    for path, value in leaves({name: each for name, each in document.items() if name != "operations"}):
        of_kind[pattern(path)].append((path, value))
    for kind in rng.choice(sorted(of_kind), -(-len(of_kind) // one_in), replace=False).tolist():
        path, value = of_kind[kind][int(rng.integers(len(of_kind[kind])))]
        for other in [each for each in forged(value) if not (isinstance(each, float) and math.isnan(each))]:
            yield path, value, other


@pytest.mark.parametrize("one_in", ONE_IN)
def test_a_forged_entry_is_found_or_named_in_the_first_line(one, one_in):
    passed = []
    for path, value, other in _forgeries(one.document, one_in):
        document, _ = one.copies()
        put(document, path, other)
        answer = answered(one, document)
        if answer is not None and answer.holds and not named(answer, path):
            passed.append((path, value, other))
    assert not passed


@pytest.mark.parametrize("one_in", ONE_IN)
def test_an_entry_that_no_plan_has_fails_everywhere(one, one_in):
    def objects(tree, path=""):
        if isinstance(tree, dict):
            yield path
            for name, each in tree.items():
                yield from objects(each, f"{path}.{name}" if path else name)
        elif isinstance(tree, list) and tree:
            yield from objects(tree[0], f"{path}[0]")

    others = {name: each for name, each in one.document.items() if name != "operations"}
    for path in [*objects(others)][::one_in]:
        document, _ = one.copies()
        new = f"{path}.novel" if path else "novel"
        put(document, new, 3)
        answer = answered(one, document)
        # Objects whose names a plan makes may have any.
        assert answer is None or not answer.holds or named(answer, new), path


def told_anew(document):
    """A plan whose words are made anew of its numbers, as a careful forger makes them."""
    return json.loads(with_text(plan_of(json.dumps(document), "plan.json")).model_dump_json())


def _finished(document):
    process = document["process"]
    process.update(finished_share=1.0, finished_mm2=process["asked_mm2"], left=[])


def _feasible(document):
    cutter = document["cutters"][0]
    cutter.update(feasible=True, accessible=cutter["accessible"] + cutter["inaccessible"], inaccessible=0)
    cutter["area_share"].update(
        accessible=cutter["area_share"]["accessible"] + cutter["area_share"]["inaccessible"], inaccessible=0
    )
    document["selected"] = cutter["id"]


@pytest.mark.parametrize("error", [StopIteration(), ValueError()])
def test_a_plan_whose_words_cannot_be_made_fails(held, monkeypatch, error):
    """A kind of cutter that there is not has no rank among the others, and no error need have words."""

    def none(plan):
        raise error

    monkeypatch.setattr("plan_cutters_check.asking.with_text", none)
    answer = held.read()
    assert not answer.holds
    assert any("its words cannot be made" in line for line in answer.lines[1:])


def _first_step(**new):
    return lambda document: document["process"]["steps"][0].update(new)


@pytest.mark.parametrize(
    "forge",
    [_finished, _feasible, _first_step(angles_deg={"C": 0.0, "A": 45.0}), _first_step(axis=[0.0, 0.6, 0.8]),
     _first_step(strategy="floor", seconds=1.0), _first_step(clearance_mm=50.0), _first_step(alone_mm2=4321.0),
     _first_step(area_mm2=9e4, share=1.0), lambda document: document["process"].update(seconds=60.0),
     lambda document: document["process"]["steps"].pop(), lambda document: document["process"]["steps"].reverse(),
     lambda document: document["cutters"][0].update(name="Finisher D20"),
     lambda document: document["cutters"][0].update(holder="Slim chuck"),
     lambda document: document["effective"].update(target_faces=["F1"])],
    ids=range(14),
)  # fmt: skip
def test_numbers_that_are_forged_together_with_all_words_are_found(one, forge):
    document, _ = one.copies()
    forge(document)
    answer = answered(one, told_anew(document))
    assert answer is None or not answer.holds


def test_verdicts_that_are_all_set_to_reached_are_found(one):
    document, arrays = one.copies()
    for name in arrays["samples.npz"]:
        if name.startswith("verdict_"):
            arrays["samples.npz"][name][:] = 1
    answer = answered(one, document, arrays)
    assert any(each.holds is False and "no tool axis" in each.words for each in answer.findings)


def test_a_verdict_with_an_axis_that_is_blocked_is_found_by_putting_the_tool_down(held):
    """The floor of the vise, said to be reached from above with an axis along its normal."""
    document, arrays = held.copies()
    samples = arrays["samples.npz"]
    name = document["cutters"][0]["id"]
    below = np.flatnonzero(samples["normal"][:, 2] < -0.9)
    samples[f"verdict_{name}"][below] = 1
    samples[f"axis_{name}"][below], samples[f"lean_{name}"][below] = [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]
    question = held.asked(document, arrays)
    found = [*postures(Reckoned(question), Bench(question, str), Clock(math.inf))]
    assert any(each.holds is False for each in found)
    fair = held.asked()
    assert all(each.holds for each in postures(Reckoned(fair), Bench(fair, str), Clock(math.inf)))


def test_a_tool_that_stands_wholly_within_the_material_is_not_free(tmp_path):
    """At the foot of a wall, with its flat end on the floor of the slot and all of it behind that: it meets no surface."""
    import cadquery

    path = str(tmp_path / "slot.step")
    body = cadquery.Workplane().box(60, 40, 30).cut(cadquery.Workplane().box(20, 12, 30).translate((-25, 0, 8)))
    cadquery.exporters.export(body, path)
    words = {"cutters": ["D6L20F12"], "faces": "all", "grid": 3, "machine": "trunnion-ac"}
    plan(path, operations="fastest", feed=1000, area_budget=0, **words).write(tmp_path, ["json", "npz"])
    question = Written(tmp_path, path, words).asked()
    point, normal = question.samples["point"], question.samples["normal"]
    x, _, z = point.T
    rows = np.flatnonzero((np.abs(x + 15.0) < 1e-6) & (np.abs(normal[:, 1]) > 0.9) & (z > 0.0) & (z < 9.0))
    assert len(rows)
    bench, along = Bench(question, str), np.tile([1.0, 0.0, 0.0], (len(rows), 1))
    (tool,) = bench.tools.values()
    for way, verdict in ((along, MET), (-along, FREE)):
        at = Contacts(point[rows], normal[rows], way)
        assert (bench.put_down(0, tool, rows, way, at, Clock(math.inf))[0] == verdict).all()


class TestTheGrip:
    def test_the_vise_that_was_placed_holds_the_part(self, held):
        assert held.asked().grips
        assert not [*faults(held.asked())]

    def test_rounds_that_run_out_into_what_is_gripped_are_not_gripped(self, tmp_path):
        import cadquery

        path, options = str(tmp_path / "round.step"), {**HELD, "grid": 3}
        block = cadquery.Workplane().box(40, 30, 15, centered=(True, True, False)).edges("|Z").fillet(3)
        cadquery.exporters.export(block, path)
        plan(path, operations="fastest", feed=1000, area_budget=0, **options).write(tmp_path, ["json", "npz"])
        assert not [*faults(Written(tmp_path, path, options).asked())]

    @pytest.mark.parametrize("by", [(0.0, 0.0, -300.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.0, 0.5, 0.0), (80.0, 0.0, 0.0)])
    def test_a_vise_that_stands_elsewhere_is_found(self, held, by):
        """The place of a plan is not believed, whatever it says to be gripped."""
        document, _ = held.copies()
        entry = document["fixtures"][0]
        word, _, place = entry["clamping"].partition("@")
        numbers = [float(each) for each in place.split(",")]
        moved = [a + b for a, b in zip(numbers, (*by, 0.0, 0.0, 0.0), strict=False)]
        entry["clamping"], entry["placement"] = f"{word}@{','.join(map(str, moved))}", moved
        assert [*faults(held.asked(document))]

    @pytest.mark.parametrize("grips", [[], ["F1"], ["F1", "F2", "F3", "F4", "F5", "F6"], ["F99", "x"]])
    def test_faces_that_are_not_gripped_are_found(self, held, grips):
        document, _ = held.copies()
        document["fixtures"][0]["grips"] = grips
        answer = check(held.asked(document), seconds=0.0)
        assert any(each.holds is False and "its jaws touch" in each.words for each in answer.findings)

    def test_another_vise_than_the_one_that_was_requested_is_refused(self, held, block):
        """A vise that closes elsewhere, or another kind."""
        document, _ = held.copies()
        options = Options(**{**HELD, "fixtures": "vise:125x40x205"})
        with pytest.raises(OptionError, match="was requested"):
            question_of(held.part, options, document, held.arrays)

    def test_a_chuck_is_seen_to_grip(self, tmp_path):
        import cadquery

        path = str(tmp_path / "turned.step")
        cadquery.exporters.export(cadquery.Workplane().circle(20).extrude(15).faces(">Z").workplane().circle(9).extrude(9), path)
        options = {**HELD, "fixtures": "chuck", "grid": 3}
        plan(path, operations="fastest", feed=1000, area_budget=0, **options).write(tmp_path, ["json", "npz"])
        turned = Written(tmp_path, path, options)
        assert not [*faults(turned.asked())]
        document, _ = turned.copies()
        entry = document["fixtures"][0]
        entry["clamping"] = entry["clamping"].replace("@0,0,", "@0.5,0,")
        assert [*faults(turned.asked(document))]


@pytest.fixture(scope="module")
def lip(tmp_path_factory):
    """A wall under a lip of 0.1 mm, planned with a tolerance of 0.4 mm."""
    import cadquery

    out = tmp_path_factory.mktemp("lip")
    body = cadquery.Workplane().box(30, 30, 10).union(cadquery.Workplane().box(10, 10, 12).translate((0, 0, 11)))
    cadquery.exporters.export(body.union(cadquery.Workplane().box(10.2, 10.2, 3).translate((0, 0, 18))), str(out / "lip.step"))
    words = {"cutters": ["D8L40F20"], "faces": "all", "spacing": 2.5, "machine": "trunnion-ac", "tolerance": 0.4}
    plan(str(out / "lip.step"), operations="fastest", feed=1000, area_budget=0, **words).write(out, ["json", "npz"])
    return Written(out, str(out / "lip.step"), words)


class TestTheToleranceThatIsWanted:
    @pytest.mark.slow("checks whole plans")
    def test_it_holds_by_its_own_tolerance(self, lip):
        answer = check(lip.asked(), seconds=1e6)
        assert answer.holds
        assert not answer.beyond

    def test_postures_that_gouge_more_than_is_wanted_are_not_decided(self, lip):
        """All that a forger may write to have a coarse plan taken for one whose tolerance had to be raised."""
        document, arrays = lip.copies()
        document["effective"].update(chord_error_mm=0.1, tolerance_requested_mm=0.01)
        document["faces"][0]["chord_error_mm"] = 0.1
        wanted = replace(lip.options, tolerance=0.01)
        question = question_of(lip.part, wanted, told_anew(document), arrays)
        answer = check(question, seconds=1e6)
        assert answer.beyond > 20
        assert answer.first.startswith("not decided: ")
        assert "deeper than the 0.01 mm that were wanted" in answer.first

    @pytest.mark.parametrize("name", ["chord_error_mm", "tolerance_requested_mm"])
    def test_either_number_by_itself_is_found(self, lip, name):
        document, _ = lip.copies()
        document["effective"][name] = 0.1
        answer = answered(lip, document)
        assert answer is None or not answer.holds
