"""The tools of a whole shop: sets that the plans state, against brute force over samples, and what the page says of them."""

import itertools
import json
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters_batch import row as of_shop
from plan_cutters_batch.row import PartRow, PartTools, essential, fewest, row_of
from plan_cutters_batch.summary import write_index

TOOLS = "ABCDE"


def stated(reached, faces):
    """What a plan states of samples (n, m) that m tools reach, by faces; its process is greedy."""
    alone = tuple(TOOLS[k] for k in np.flatnonzero(reached.all(axis=0)))
    open_, process = np.ones(len(reached), bool), []
    while open_.any():
        process.append(int(reached[open_].sum(axis=0).argmax()))
        open_ &= ~reached[:, process[-1]]
    whole = [tuple(TOOLS[k] for k in np.flatnonzero(reached[faces == face].all(axis=0))) for face in np.unique(faces)]
    names = {tool: f"tool {tool}" for tool in TOOLS}
    return PartTools(names=names, finished=True, alone=alone, together=(tuple(TOOLS[k] for k in process),), faces=tuple(whole))


@st.composite
def shops(draw):
    """Parts of some samples on some faces; each sample is reached by some tool."""
    parts = []
    for _ in range(draw(st.integers(1, 4))):
        n = draw(st.integers(1, 6))
        rows = draw(st.lists(st.sets(st.integers(0, len(TOOLS) - 1), min_size=1), min_size=n, max_size=n))
        reached = np.array([[k in row for k in range(len(TOOLS))] for row in rows])
        parts.append((reached, np.array(draw(st.lists(st.integers(1, 3), min_size=n, max_size=n)))))
    return parts


def smallest(accepts):
    """The size of the smallest set of tools that is accepted: all sets are tried."""
    return next(k for k in range(len(TOOLS) + 1) for each in itertools.combinations(TOOLS, k) if accepts(each))


@pytest.mark.slow("plans a folder of parts")
@given(shops())
@settings(max_examples=150, deadline=None)
def test_the_fewest_tools_are_those_of_brute_force(parts):
    tools = [stated(*part) for part in parts]
    result = fewest(tools)
    # Truth: each sample of each part is reached by one of them.
    columns = [TOOLS.index(name) for name in result]
    assert all(reached[:, columns].any(axis=1).all() for reached, _ in parts)
    # Of the sets that the plans state, none is smaller.
    assert len(result) == smallest(lambda each: all(part.finished_by(each) for part in tools))


def test_several_setups_have_no_ways_by_face():
    one = PartTools(names={"A": "", "B": "", "C": ""}, finished=True, together=(("A", "B"),))
    assert fewest([one]) == ("A", "B")
    assert fewest([one, PartTools(names={"B": ""}, finished=True, alone=("B",))]) == ("B", "A")


def test_parts_in_doubt_and_unfinished_ones_count_for_nothing():
    assert fewest([]) == ()
    assert fewest([PartTools(names={"A": "a"}, used=("A",), needs=("a smaller tool",))]) == ()


@given(shops(), st.sampled_from(["none", "wrong"]))
@settings(max_examples=30, deadline=None)
def test_a_search_that_ends_early_leaves_a_set_that_finishes_all(parts, end):
    tools = [stated(*part) for part in parts]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(of_shop, "_least", lambda cost, rows: None if end == "none" else [0.0] * len(cost))
        result = fewest(tools)
    assert all(part.finished_by(result) for part in tools)


@pytest.mark.slow("plans a folder of parts")
@given(shops())
@settings(max_examples=100, deadline=None)
def test_faces_that_follow_from_others_change_nothing(parts):
    """For all sets of tools: what does the faces that stay does all of them."""
    for part in parts:
        every = stated(*part).faces
        few = essential(every)
        assert set(few) <= set(every)
        for size in range(len(TOOLS) + 1):
            for each in map(set, itertools.combinations(TOOLS, size)):
                assert all(each & {*face} for face in few) == all(each & {*face} for face in every)


# Of plans


@pytest.fixture(scope="module")
def judged():
    return plan("samples/v_groove.step", cutters=["R12L60", "R6L80", "R2L30"], grid=9, area_budget=0)


def test_a_plan_states_what_its_samples_say(judged):
    tools = row_of(judged.plan, name="groove", file="groove.step", code=0).tools
    reached = {name: np.isin(reach.verdict, (1, 2)) for name, reach in judged.reaches.items()}
    assert set(tools.names) == set(reached)
    assert set(tools.alone) == {name for name, each in reached.items() if each.all()}
    assert tools.alone
    assert all(np.logical_or.reduce([reached[name] for name in each]).all() for each in tools.together)
    by_face = [judged.samples.face == number for number in np.unique(judged.samples.face)]
    whole = [tuple(c.id for c in judged.plan.cutters if reached[c.id][here].all()) for here in by_face]
    assert set(tools.faces) == set(essential(whole))
    assert set(tools.used) == {step.cutter for step in judged.plan.process.steps}


def test_a_part_in_doubt_states_no_set(judged):
    tools = row_of(judged.plan, name="groove", file="groove.step", code=4).tools
    assert (tools.finished, tools.alone, tools.together, tools.faces) == (False, (), (), ())
    assert tools.names
    assert not tools.finished_by(tools.names)


def test_a_tool_that_may_miss_something_between_samples_finishes_nothing_beyond_doubt(judged):
    doubted = [c.model_copy(update={"seen": c.id != "R2L30"}) for c in judged.plan.cutters]
    effective = judged.plan.effective.model_copy(update={"sampled_by": "default"})
    document = judged.plan.model_copy(update={"cutters": doubted, "effective": effective})
    tools = row_of(document, name="groove", file="groove.step", code=0).tools
    named = {*tools.alone, *itertools.chain(*tools.together), *itertools.chain(*tools.faces)}
    assert "R2L30" not in named
    assert "R6L80" in named


def test_a_part_that_nothing_finishes_says_what_it_needs():
    document = plan("samples/v_groove.step", cutters=["R3L8"], grid=9, area_budget=0, holder="R15L30", answers=["mend"]).plan
    assert not document.selected
    row = row_of(document, name="groove", file="groove.step", code=1)
    words = {each.words for each in document.process.next} | {each.needs for each in document.process.left}
    assert row.tools.needs
    assert set(row.tools.needs) <= words
    (entry,) = shop_of([row])["unfinished"]
    assert entry == {"name": "groove", "share": document.process.finished_share, "needs": list(row.tools.needs)}


# In the summary and on the page


def written(rows):
    files = {}
    write_index(rows, files.__setitem__, title="shop", seconds=1.0, cluster={})
    return SimpleNamespace(summary=json.loads(files["summary.json"]), page=files["index.html"].decode())


def shop_of(rows):
    return written(rows).summary["shop"]


def row(name, tools, code=0, status="planned"):
    return PartRow(name=name, file=f"{name}.step", status=status, code=code, tools=tools)


NAMES = {"D6": "ball end D6", "D8": "flat end D8", "D9": "flat end D9"}


def test_the_summary_counts_tools_over_all_parts():
    rows = [
        row("a", PartTools(names=NAMES, finished=True, alone=("D6", "D8"), used=("D8",))),
        row("b", PartTools(names=NAMES, finished=True, alone=("D8",), used=("D8",))),
        row("c", PartTools(names=NAMES, finished=True, together=(("D6", "D8"),), used=("D6", "D8"))),
        row("d", PartTools(names=NAMES, used=("D6",), share=0.5, needs=("a longer tool",)), code=1),
        PartRow(name="e", file="e.step", status="failed", code=3),
        PartRow(name="f", file="f.step", status="kept", code=0),
    ]
    result = written(rows)
    counts = [(each["tool"], each["judged"], each["alone"], each["used"]) for each in result.summary["shop"]["tools"]]
    assert counts == [("flat end D8", 4, 2, 3), ("ball end D6", 4, 1, 2), ("flat end D9", 4, 0, 0)]
    assert result.summary["shop"]["least"] == {
        "tools": ["flat end D8", "ball end D6"], "parts": 3}  # fmt: skip
    assert result.summary["shop"]["never_used"] == ["flat end D9"]
    assert result.summary["shop"]["unfinished"] == [{"name": "d", "share": 0.5, "needs": ["a longer tool"]}]
    assert (result.summary["shop"]["unfinished_count"], result.summary["shop"]["not_known"]) == (1, 2)
    assert "Finishes most parts alone: flat end D8, 2 of 6." in result.page
    assert "Fewest tools for all 3 parts that can be finished beyond doubt, 2: flat end D8, ball end D6." in result.page
    assert "In no plan: flat end D9." in result.page
    assert "a longer tool" in result.page


def test_an_empty_batch_and_failures_alone_claim_nothing():
    for rows in ([], [PartRow(name="e", file="e.step", status="failed", code=3)]):
        result = written(rows)
        assert result.summary["shop"]["least"] is None
        assert result.summary["shop"]["tools"] == []
        assert result.summary["shop"]["not_known"] == len(rows)
        assert "finish" not in result.page.partition("<body>")[2].partition('<ul class="counts"')[0]
        assert 'id="shop"' not in result.page


def test_tools_with_one_name_are_told_apart():
    rows = [row("a", PartTools(names={"D6L40": "finisher"}, used=("D6L40",)), code=1),
            row("b", PartTools(names={"D6L60": "finisher"}), code=1)]  # fmt: skip
    result = shop_of(rows)
    assert [each["tool"] for each in result["tools"]] == ["finisher (D6L40)", "finisher (D6L60)"]
    assert result["never_used"] == ["finisher (D6L60)"]
