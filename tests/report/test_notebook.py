"""A result in a notebook: its card, its page in a fenced frame, its words, and the notebook of the docs as it stands."""

import base64
import json
import re
import tempfile
import webbrowser
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from cad_io import WriteError
from plan_cutters import PlanError, plan
from plan_cutters.plan_file.words.names import typed
from plan_cutters.plan_file.words.text import story_of
from plan_cutters.report.notebook import card as made_card
from plan_cutters.report.page.write import page as review_page
from tests.support.browser import opened
from tests.support.places import ROOT, SAMPLES

HOSTILE = "</iframe><script>alert(1)</script>\x1b[31m\x00"


class Seen(HTMLParser):
    """Elements with their attributes, and the texts between them."""

    def __init__(self, html):
        super().__init__()
        self.elements, self.texts = [], []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_data(self, data):
        self.texts.append(data)

    def of(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture(scope="module")
def result():
    """A groove that is narrower than one of two cutters."""
    return plan(SAMPLES / "v_groove.step", cutters=["R8L20rc7.9", "R3L40"], grid=9, area_budget=0)


@pytest.fixture(autouse=True)
def _full(monkeypatch):
    """Cards are whole here, but where a test is about small ones."""
    monkeypatch.setenv("PLAN_CUTTERS_CARD", "full")


@pytest.fixture(scope="module")
def card(result):
    return made_card(result)


def named(result, name):
    """The same result of cutters that are called otherwise, of a part that is, too."""
    cutters = [each.model_copy(update={"name": name}) for each in result.plan.cutters]
    part = result.plan.part.model_copy(update={"file": name})
    return replace(result, plan=result.plan.model_copy(update={"cutters": cutters, "part": part}))


def test_card_has_verdict_table_picture_and_page(result, card):
    seen, story = Seen(card), story_of(result.plan)
    texts = [" ".join(text.split()) for text in seen.texts]
    assert f"✓ {story.headline.title}" in texts
    for each in story.cutters:
        assert each.shares["accessible"] in texts
        assert any(text.endswith(each.name) for text in texts)
    # What makes the verdicts unsure stands in the card itself, not only in its page.
    unsure = [typed(line) for line in (*story.inside, *story.scope)]
    assert [" ".join(line.split()) for line in unsure] == [text for text in texts if text in unsure]
    assert story.scope
    (picture,) = seen.of("img")
    assert base64.b64decode(picture["src"].removeprefix("data:image/png;base64,")).startswith(b"\x89PNG")
    (frame,) = seen.of("iframe")
    assert frame["srcdoc"] == review_page(result).decode()
    assert set(frame["sandbox"].split()) == {"allow-scripts", "allow-downloads"}


@pytest.mark.parametrize(("good", "sign"), [(True, "✓"), (False, "✗"), (None, "?")])
def test_sign_of_the_verdict(result, good, sign, monkeypatch):
    from plan_cutters.report import notebook

    told = story_of(result.plan)
    told = replace(told, headline=told.headline._replace(good=good))
    html = notebook._rendered(result, told, 100, page="")
    assert f"{sign} {told.headline.title}" in html
    assert sum(html.count(f">{each} ") for each in "✓✗?") == 1


def test_names_of_files_end_no_element(result, monkeypatch):
    hostile = named(result, HOSTILE)
    monkeypatch.setattr("plan_cutters.report.notebook._picture", lambda _: "")
    seen = Seen(hostile._repr_html_())
    assert len(seen.of("iframe")) == 1
    assert not seen.of("script")
    assert any("alert(1)" in text for text in seen.texts)
    for text in (*seen.texts, hostile.summary()):
        assert not re.search("[\x00-\x08\x0b-\x1f]", text)


def test_what_cannot_be_made_is_named(result, monkeypatch):
    def fails(*_):
        raise WriteError("the CAD kernel made no triangle of the part")

    monkeypatch.setattr("plan_cutters.report.drawing.part.write_png", fails)
    seen = Seen(result._repr_html_())
    assert any("picture could not be made" in text and "no triangle" in text for text in seen.texts)
    assert not seen.of("img")
    assert seen.of("table")
    assert seen.of("iframe")


def test_summary_has_a_line_for_each_cutter_and_its_shares(result):
    lines, story = result.summary().splitlines(), story_of(result.plan)
    assert lines[0].startswith(story.headline.title)
    heads = next(line for line in lines if line.startswith("  cutter"))
    first = lines.index(heads) + 1
    for each, line in zip(story.cutters, lines[first:], strict=False):
        assert line[2:].startswith(each.name)
        assert (line[0] == ">") == (each.id == story.taken)
        shares = [float(share) for share in re.findall(r"([\d.]+) %", line)]
        assert len(shares) == 5
        assert sum(shares) == pytest.approx(100, abs=0.3)
    assert len({len(line) for line in lines[first - 1 : first + len(story.cutters)]}) == 1
    assert any(line.startswith("Bull nose") and "does not reach" in line for line in lines)


def test_show_opens_a_browser_with_the_page(result, monkeypatch, tmp_path):
    asked = []
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(webbrowser, "open", lambda url: bool(asked.append(url)) or True)
    path = result.show()
    assert path.is_relative_to(tmp_path)
    assert asked == [path.as_uri()]
    assert path.read_bytes() == review_page(result)


def test_show_without_a_browser_says_where_the_page_is(result, monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    with pytest.raises(PlanError, match="open it yourself") as caught:
        result.show()
    assert Path(caught.value.file).is_file()


@pytest.mark.slow("opens a browser")
def test_page_of_a_card_runs_and_reaches_nothing_of_the_notebook(card, browser, tmp_path):
    path = tmp_path / "notebook.html"
    path.write_text(f"<!doctype html><html data-ready><title>notebook</title><meta charset=utf-8>{card}", "utf-8")
    context = browser.new_context(viewport={"width": 1000, "height": 1200}, reduced_motion="reduce")
    try:
        page = opened(context, path)
        page.click("summary")
        page.frame_locator("iframe").locator("html[data-ready]").wait_for(timeout=60_000)
        frame = page.frames[-1]
        assert frame.evaluate("document.title") != "notebook"
        assert frame.evaluate("() => { try { return parent.document.title } catch (e) { return e.name } }") == "SecurityError"
        assert [line for line in page.said if line.startswith("error")] == []
    finally:
        context.close()


@pytest.fixture(scope="module")
def ran():
    """The notebook of the docs as a notebook's server runs it, in its folder."""
    pytest.importorskip("ipykernel", reason="ipykernel is not installed: setup.sh dev")
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    book = nbformat.read(ROOT / "docs" / "notebook.ipynb", as_version=4)
    nbformat.validate(book)
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("PLAN_CUTTERS_CARD", raising=False)
        nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(ROOT / "docs")}}).execute()
    return [cell for cell in book.cells if cell.cell_type == "code"]


@pytest.mark.slow("opens a browser")
def test_notebook_of_the_docs_runs(ran):
    outputs = [output for cell in ran for output in cell.outputs]
    assert [output.output_type for output in outputs] == ["execute_result", "stream", *["execute_result"] * 3, "display_data"]
    card, *tables = [output.data["text/html"] for output in outputs if output.output_type == "execute_result"]
    assert [tag for tag, _ in Seen(card).elements if tag in ("table", "img", "iframe")] == ["table", "img"]
    assert len(card.encode()) <= 50_000
    assert all(Seen(table).of("table") for table in tables)
    # `show` displays its page once, and returns nothing that would be shown again.
    shown = Seen(outputs[-1].data["text/html"])
    assert "open" in shown.of("details")[0]
    assert shown.of("iframe")[0]["style"].count("700px") == 1


def test_notebook_is_kept_without_what_it_shows():
    cells = json.loads((ROOT / "docs" / "notebook.ipynb").read_text("utf-8"))["cells"]
    assert all(not cell["outputs"] and cell["execution_count"] is None for cell in cells if cell["cell_type"] == "code")


def test_a_result_that_was_packed_shows_the_same(result, card):
    import pickle

    again = pickle.loads(pickle.dumps(result))
    assert again.summary() == result.summary()
    assert np.array_equal(again.reaches["R3L40"].verdict, result.reaches["R3L40"].verdict)


@pytest.mark.slow("draws the part once more", only=("False",))
@pytest.mark.parametrize("many", [False, True])
def test_a_small_card_has_the_verdict_and_at_most_50_kb(result, card, monkeypatch, many):
    """A notebook in git keeps it in each cell."""
    shown = result
    if many:
        more = [c.model_copy(update={"id": f"{c.id}-{k}"}) for k in range(49) for c in result.plan.cutters]
        cutters = [*result.plan.cutters, *more]
        shown = replace(result, plan=result.plan.model_copy(update={"cutters": cutters}))
    monkeypatch.delenv("PLAN_CUTTERS_CARD")
    small = shown._repr_html_()
    assert len(small.encode()) <= 50_000
    seen = Seen(small)
    story = story_of(shown.plan)
    assert any(story.headline.title in text for text in seen.texts)
    assert seen.of("iframe") == []
    (image,) = seen.of("img")
    data = base64.b64decode(image["src"].partition(",")[2])
    assert data[8:12] == b"WEBP"
    rows = [a for a in seen.of("th") if a.get("scope") == "row"]
    assert len(rows) == (12 if many else len(shown.plan.cutters))
    assert any("88 more cutters" in text for text in seen.texts) == many
    assert len(card.encode()) > 500_000


def test_a_card_of_no_known_size_is_refused(result):
    with pytest.raises(PlanError, match="neither full nor small"):
        result.show(card="tiny")
