"""Operations on the review page: its data, its tables, and what a browser shows of them."""

import io
import re
from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.figures import area
from plan_cutters.plan_file.reasons import operation_colour
from plan_cutters.plan_file.words.names import as_fields
from plan_cutters.plan_file.words.operations import in_short, operation_names, stepped
from plan_cutters.plan_file.words.text import story_of
from plan_cutters.report.notebook import text_of
from plan_cutters.report.page import tables, write
from plan_cutters.report.page.steps import colour
from tests.support.browser import SCREENS, opened, place_of, seen
from tests.support.places import ROOT
from tests.support.review_page import Page, picture

pytestmark = pytest.mark.slow("opens a browser")


@pytest.fixture(scope="module")
def planned():
    """A block with a sculptured top, from all sides, by two cutters of which one is held."""
    return plan(
        ROOT / "samples" / "pocket_top.step", faces="all", spacing=6.0, cutters=["R6L80", "R3L40rc3"], holder="R15L40",
        machine="trunnion-ac", operations="both", feed=2000.0, area_budget=0, index_step=np.radians(15.0),
    )  # fmt: skip


@pytest.fixture(scope="module")
def data(planned):
    return write.page(planned, triangles=2000)


@pytest.fixture(scope="module")
def read(data):
    return Page(data)


def each_plan(planned, read):
    return zip(planned.answers.operations.plans, planned.plan.operations.plans, read.meta["operations"]["plans"], strict=True)


def test_every_sample_has_the_operation_of_the_plan(planned, read):
    for found, _, told in each_plan(planned, read):
        assert (read.array(told["array"]).astype(int) - 1).tolist() == found.label.tolist()
        assert (found.label >= 0).any()


def test_operations_are_told_as_they_are_in_the_plan(planned, read):
    for found, entry, told in each_plan(planned, read):
        assert told["name"] == entry.name
        for k, (one, wanted) in enumerate(zip(told["operations"], entry.operations, strict=True)):
            called = stepped(planned.plan, entry, wanted.id)
            assert (one["label"], one["cutter"], one["setup"]) == (called, wanted.cutter, wanted.setup)
            assert one["axis"] == (None if wanted.axis is None else list(wanted.axis))
            place = k if called == wanted.id else int(called.split()[1]) - 1
            assert (one["colour"], one["pattern"]) == (operation_colour(place), "plain")
            assert one["text"].startswith(f"{called}: ")
            # Its tool is shown where it is proved to serve.
            assert found.label[one["sample"]] == k
            assert found.serves[one["sample"], k]


@pytest.mark.parametrize("screen", ["desk", "phone"])
def test_what_to_look_at_before_one_approves_is_on_the_first_screen(at, planned, screen):
    found = at(screen).locator("#process .next", has_text="Before you approve")
    box = found.bounding_box()
    assert 0 <= box["y"] < box["y"] + box["height"] <= SCREENS[screen][1]
    least = min(each.clearance_mm for each in planned.plan.process.steps if each.clearance_mm is not None)
    assert float(re.search(r"holder: ([\d.]+) mm", found.inner_text())[1]) == pytest.approx(least, rel=5e-3)


def test_each_step_has_one_number_everywhere(planned, read):
    """In the table, the picture and the list of operations, with what is gone without it."""
    rows = [(a, text) for tag, a, text in read.elements if tag == "tr" and "data-step" in a]
    more = [text for tag, a, text in read.elements if tag == "tr" and a.get("id", "").startswith("step-")]
    process, fastest = planned.plan.process, planned.plan.operations.plans[1]
    assert (process.plan, fastest.name) == ("fastest", "fastest")
    assert len(rows) == len(more) == len(process.steps) == len(read.meta["process"]["steps"])
    by_step = {step: name for name, step in operation_names(planned.plan).items()}
    number = read.array("step")
    for k, ((attributes, text), said, step, told) in enumerate(
        zip(rows, more, process.steps, read.meta["process"]["steps"], strict=True), 1
    ):
        assert attributes["data-step"] == str(k)
        assert text.startswith(str(k))
        assert area(step.alone_mm2) in said
        assert by_step[str(k)] == step.operation
        rank = [each.id for each in fastest.operations].index(step.operation)
        assert ((number == k) == (planned.answers.operations.plans[1].label == rank)).all()
        assert (told["label"], told["cutter"], told["share"]) == (f"step {k}", step.cutter, step.share)
        assert number[told["sample"]] == k
        listed = read.meta["operations"]["plans"][1]["operations"][rank]
        assert (listed["label"], listed["colour"], listed["pattern"]) == (told["label"], told["colour"], told["pattern"])


def test_the_text_of_the_plan_says_each_thing_once(planned):
    text = " ".join(text_of(planned.plan).split())
    assert in_short(planned.plan)
    assert all(text.count(each) == 1 for each in in_short(planned.plan))


def test_each_operation_is_listed(planned, read):
    rows = [text for tag, a, text in read.elements if tag == "tr" and "data-operation" in a and "data-plan" not in a]
    more = [text for tag, a, text in read.elements if tag == "td" and a.get("colspan") == "4"]
    number = {name: int(step) for name, step in operation_names(planned.plan).items()}
    wanted = []
    for _, entry, _ in each_plan(planned, read):
        mine = [(stepped(planned.plan, entry, one.id), one) for one in entry.operations]
        is_process = entry.name == planned.plan.process.plan
        wanted += sorted(mine, key=lambda each: number[each[1].id]) if is_process else mine
    assert len(rows) == len(wanted)
    for (called, one), row in zip(wanted, rows, strict=True):
        cells = row.split("\n")[0]
        assert cells.startswith(called)
        assert all(f"{name} {angle:g}" in cells for name, angle in one.angles_deg.items())
        assert re.search(r"\d (s|min)", cells)
        assert one.faces[0].face in " ".join(more)
    titles = [" ".join(text.split()) for tag, a, text in read.elements if a.get("id", "").startswith("plan-")]
    assert titles == [f"{e.name.capitalize()}: {len(e.operations)} operations" for e in planned.plan.operations.plans]


def test_sentences_are_those_of_the_story(planned, read):
    story = story_of(planned.plan)
    told = story.operations
    assert any("fixed orientation" in line.text for line in told)
    paragraphs = " ".join(read.of("p"))
    assert all(paragraphs.count(as_fields(line.text)) == 1 for line in told)
    # What matters most stands above all else.
    assert all(paragraphs.index(as_fields(text)) < paragraphs.index(as_fields(told[-1].text)) for text in story.in_short)


def test_only_what_no_fixed_axis_reaches_is_said_to_need_simultaneous_motion(planned):
    """Where fewer orientations were requested than all needs, another one may reach what is left."""
    entry = planned.plan.operations
    first = entry.plans[0]
    moved = first.operations[-1].model_copy(update={"mode": "simultaneous", "axis": None, "angles_deg": None})
    left = first.orientations - 1
    changed = first.model_copy(update={"operations": [*first.operations[:-1], moved], "orientations": left})

    def told(found):
        few = entry.fewest.model_copy(update={"found": found})
        operations = entry.model_copy(update={"plans": [changed], "fewest": few})
        return in_short(planned.plan.model_copy(update={"operations": operations}))[0]

    assert told(left).startswith("Only simultaneous motion reaches ")
    assert told(left + 1).startswith("Simultaneous motion finishes ")


def test_looks_differ():
    """Of so many steps as the colours go round four times, each is told from what stays."""
    told = [colour(k) for k in range(1, 33)]
    assert len({(each["colour"], each["pattern"]) for each in told}) == 32
    assert [each["pattern"] for each in told[:16]] == ["plain"] * 8 + ["cross"] * 8
    assert "hatch" not in {each["pattern"] for each in told}


def rgb(text):
    return np.array(list(bytes.fromhex(text[1:]))).astype(int)


def test_labels_take_little(planned, data):
    """The page with operations is at most so much larger as its list and one label a sample are."""
    answers = replace(planned.answers, operations=None)
    without = write.page(replace(planned, answers=answers), triangles=2000)
    assert len(data) <= 1.15 * len(without)


def test_a_page_without_operations_has_none_of_it(planned):
    bare = plan(ROOT / "samples" / "pocket_top.step", faces="all", grid=5, cutters=["R6L80"], area_budget=0)
    read = Page(write.page(bare, triangles=500))
    assert read.meta["operations"] is None
    assert not any(name.startswith("operation") for name in read.meta["arrays"])
    assert not any(a.get("id") == "operations" for _, a, _ in read.elements)
    assert tables.tables(bare.plan, story_of(bare.plan)) is None


def test_simultaneous_operations_and_none_are_shown_too(planned):
    """An operation without an axis; samples that none takes; a plan of nothing."""
    found, entry = planned.answers.operations, planned.plan.operations
    first, told = found.plans[0], entry.plans[0]
    one = replace(first.operations[0], mode="simultaneous", axis=None, angle=None, other_angle=None)
    label = np.where(first.label == 0, 0, -1).astype(np.int32)
    some = replace(first, operations=(one,), label=label)
    none = replace(first, name="fastest", operations=(), label=np.full_like(label, -1))
    plans = [
        told.model_copy(update={"operations": [told.operations[0].model_copy(update={"mode": "simultaneous", "axis": None,
                                                "angles_deg": None, "seconds": None, "cut_length_mm": None})]}),
        told.model_copy(update={"name": "fastest", "operations": []}),
    ]  # fmt: skip
    changed = replace(
        planned,
        answers=replace(planned.answers, operations=replace(found, plans=(some, none))),
        plan=planned.plan.model_copy(update={"operations": entry.model_copy(update={"plans": plans})}),
    )
    read = Page(write.page(changed, triangles=500))
    few, nothing = read.meta["operations"]["plans"]
    assert [o["axis"] for o in few["operations"]] == [None]
    assert read.array(few["array"]).tolist() == (label + 1).tolist()
    assert nothing["operations"] == []
    assert not read.array(nothing["array"]).any()
    row = next(text for tag, a, text in read.elements if tag == "tr" and "data-operation" in a and "data-plan" not in a)
    assert row.startswith("op1simultaneous–")


@pytest.fixture(scope="module")
def path(data, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "review.html"
    path.write_bytes(data)
    return path


def colours(page, rows):
    """Mean colours of the pixels about samples."""
    box, image = page.locator("#frame").bounding_box(), picture(page)
    at = [[round(a - b) for a, b in zip(place_of(page, r), (box["x"], box["y"]), strict=True)] for r in rows]
    return [image[y - 2 : y + 3, x - 2 : x + 3].reshape(-1, 3).mean(axis=0) for x, y in at]


def alike(found, wanted):
    """Whether a lit colour has the hue of another one."""
    return np.abs(found / found.sum() - wanted / wanted.sum()).max() < 0.1


def shown_rows(page, planned, label, k):
    """Some seen samples of an operation with neighbours of the same one, on the same face, on all four sides."""
    edge, face = planned.samples.neighbours, planned.samples.face
    same = (label[edge] == k).all(axis=1) & (face[edge[:, 0]] == face[edge[:, 1]])
    count = np.bincount(edge[same].reshape(-1), minlength=len(label))
    return seen(page, np.flatnonzero(count >= 4))[:3]


def seen_operations(page, planned, read):
    """The first plan of which two operations are seen as the page opens, shown, and these: which, and some of their samples."""
    for found, _, told in each_plan(planned, read):
        page.evaluate("mode => review.setMode(mode)", mode_of(told))
        rows = [(k, shown_rows(page, planned, found.label, k)) for k in range(len(told["operations"]))]
        both = [(k, some) for k, some in rows if some]
        if len(both) > 1:
            return told, both
    raise AssertionError("no plan has two operations that are seen")


def test_the_surface_is_coloured_by_operation(page, planned, read):
    before = page.locator("#legend").inner_text()
    for (found, _, told), title in zip(each_plan(planned, read), ("Fewest operations", "The process"), strict=True):
        page.get_by_role("button", name=title).click()
        assert page.evaluate("document.querySelector('#colouring').value") == mode_of(told)
        seen_colours = 0
        for k, one in enumerate(told["operations"]):
            rows = shown_rows(page, planned, found.label, k)
            for each in colours(page, rows):
                assert alike(each, rgb(one["colour"])), (title, one["label"], each)
                seen_colours += 1
            assert one["label"] in page.inner_text("#legend")
        assert seen_colours >= 3
    assert page.locator("#legend").inner_text() == before
    assert "Process, by step" in before


def mode_of(told):
    """What colours the picture by a plan: the fastest one is the process."""
    return "process" if told["key"] == "fastest" else f"operation:{told['key']}"


def entry(page, key, k):
    page.evaluate("document.querySelector('#operations details').open = true")
    return page.locator(f'#operations table[data-plan="{key}"] tr[data-operation="{k}"] button')


def test_an_entry_turns_the_part_and_puts_its_tool_there(page, planned, read):
    for _, _, told in each_plan(planned, read):
        for k, one in enumerate(told["operations"][:4]):
            entry(page, told["key"], k).click()
            assert page.evaluate("review.cutter.id") == one["cutter"]
            assert page.evaluate("review.sample.row") == one["sample"]
            assert page.inner_text("#status") == one["text"]
            assert entry(page, told["key"], k).get_attribute("aria-pressed") == "true"
            tool, back = page.evaluate("[review.tool.group.matrix.elements.slice(4, 7), review.stage.table.frame().back]")
            assert np.allclose(tool, one["axis"], atol=1e-3)
            assert np.allclose(back, one["axis"], atol=1e-9)
            assert page.evaluate("[review.judged.state, review.judged.certified, review.tool.group.visible]") == [
                "free", True, True,
            ]  # fmt: skip
            assert one["label"] in page.inner_text("#posture-line")


def test_hovering_or_focusing_an_entry_lights_its_regions(page, planned, read):
    told, ((mine_of, mine), (_, others), *_) = seen_operations(page, planned, read)
    plain = colours(page, [*mine, *others])

    def changed():
        return [np.abs(a - b).max() > 20 for a, b in zip(plain, colours(page, [*mine, *others]), strict=True)]

    lit = [False] * len(mine) + [True] * len(others)
    entry(page, told["key"], mine_of).hover()
    assert changed() == lit
    page.mouse.move(1360, 5)
    assert not any(changed())
    entry(page, told["key"], mine_of).focus()
    assert changed() == lit
    entry(page, told["key"], mine_of).evaluate("button => button.blur()")
    assert not any(changed())


def test_a_step_shows_its_setup_and_its_tool_and_plays(page, planned, read):
    told = read.meta["process"]["steps"][0]
    step = page.locator("#process tr[data-step='1']")
    step.locator("button").click()
    assert page.evaluate("[review.sample.row, review.mode]") == [told["sample"], "process"]
    assert page.inner_text("#status") == told["text"]
    assert step.locator("button").get_attribute("aria-pressed") == "true"
    assert planned.plan.process.setups[0].text in told["text"]
    place = "review.tool.group.matrix.elements.slice(12, 15).join()"
    before = page.evaluate(place)
    page.get_by_role("button", name="Play").click()
    # Whichever of them a slow browser shows next.
    page.locator("#status", has_text=re.compile(r"step 1: place ([3-9]|\d\d+) of")).wait_for()
    assert page.evaluate(place) != before
    # A press in the picture ends it, and the tool is back where it was.
    page.mouse.click(*place_of(page, told["sample"]), button="right")
    assert page.evaluate(place) == before


def test_a_setup_shows_how_the_part_stands(page, planned):
    page.locator("#process tr[data-setup='0'] button").click()
    assert page.inner_text("#status") == planned.plan.process.setups[0].text
    assert page.evaluate("review.sample") is None


def test_the_keyboard_switches_and_the_help_says_so(page, read):
    assert page.evaluate("review.mode") == "process"
    for wanted in ("verdict", "operation:fewest", "process"):
        page.keyboard.press("o")
        assert page.evaluate("review.mode") == wanted
    page.keyboard.press("?")
    assert "the process" in page.inner_text("#help")


def told_plans(read):
    return read.meta["operations"]["plans"]


def test_a_click_shows_the_tool_of_the_operation_there(page, planned, read):
    told, operations = seen_operations(page, planned, read)
    for k, (row, *_) in operations:
        page.mouse.click(*place_of(page, row))
        axis = page.evaluate("review.tool.group.matrix.elements.slice(4, 7)")
        assert np.allclose(axis, told["operations"][k]["axis"], atol=1e-3)
    # Verdicts show the posture found again.
    page.evaluate("document.activeElement.blur()")
    for _ in told_plans(read):
        if page.evaluate("review.mode") != "verdict":
            page.keyboard.press("o")
    assert page.evaluate("review.mode") == "verdict"
    tilt = np.degrees(planned.reaches[page.evaluate("review.cutter.id")].tilt[row])
    assert page.evaluate("review.posture.tilt") == pytest.approx(tilt, abs=0.01)


def test_the_list_is_printed(page):
    from pypdf import PdfReader

    text = " ".join(each.extract_text() for each in PdfReader(io.BytesIO(page.pdf(format="A4"))).pages)
    for words in ("Operations", "op1", "step 1"):
        assert words in text, words


@pytest.mark.parametrize("width", [1366, 700])
def test_axe_finds_nothing(browser, path, width):
    axe = ROOT / "page" / "node_modules" / "axe-core" / "axe.min.js"
    if not axe.exists():
        pytest.skip("axe-core is not installed: npm ci in page/")
    context = browser.new_context(viewport={"width": width, "height": 768}, reduced_motion="reduce")
    page = opened(context, path)
    page.keyboard.press("o")
    entry(page, "fewest", 0).click()
    page.evaluate(axe.read_text())
    found = page.evaluate("axe.run().then(result => result.violations)")
    assert [(each["id"], each["nodes"][0]["html"][:120]) for each in found] == []
    context.close()
