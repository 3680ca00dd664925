"""One plan in all that show one: the same sentences, which none of them has made."""

import json
from html.parser import HTMLParser
from types import SimpleNamespace

import pytest

from plan_cutters import plan
from plan_cutters.command.summary import summary
from plan_cutters.plan_file.load import plan_of
from plan_cutters.plan_file.words.cutters import others
from plan_cutters.plan_file.words.names import typed
from plan_cutters.plan_file.words.text import process_lines, story_of, text_of
from plan_cutters.report.notebook import card
from plan_cutters.report.notebook import text_of as notebook_text
from plan_cutters.report.page.write import page
from plan_cutters_agents.plan_answers import planned
from plan_cutters_batch.row import row_of
from tests.support.places import SAMPLES
from tests.support.workbench import imported


class Text(HTMLParser):
    """The words of a page, without its scripts and styles."""

    def __init__(self, html):
        super().__init__()
        self.words, self.skipped = [], 0
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        self.skipped += tag in ("script", "style")

    def handle_endtag(self, tag):
        self.skipped -= tag in ("script", "style")

    def handle_data(self, data):
        if not self.skipped:
            self.words.append(data)


def flat(text):
    return " ".join(text.split())


def words_of(html):
    return flat("".join(Text(html).words))


@pytest.fixture(scope="module")
def result():
    """A groove that is narrower than one of two cutters, which comes first."""
    return plan(SAMPLES / "v_groove.step", cutters=["R8L20rc7.9", "R3L40"], grid=9, area_budget=0)


@pytest.fixture(scope="module")
def first(result):
    """The sentences that come first: which cutter to take, for what and how it is held, and why."""
    assert result.plan.text.headline.startswith("Take flat end D6 x 40: it finishes all ")
    return [result.plan.text.headline, *(flat(each) for each in result.plan.text.lines[:1])]


@pytest.fixture(scope="module")
def lost(result):
    """Sentences on the cutter that fails."""
    found = others(result.plan)
    assert len(found) == 1
    return found[0]


def test_the_plan_has_its_own_text(result):
    assert result.plan.text == text_of(result.plan)
    assert plan_of(result.plan.model_dump_json(), "plan.json").text == result.plan.text


def test_the_terminal_shows_it(result, first, lost, capsys):
    summary(result.plan)
    # A terminal has options as they are typed, all others fields of the same names.
    shown = flat(capsys.readouterr().out)
    as_typed = process_lines(result.plan, story_of(result.plan), typed)
    assert first[0] in shown
    assert all(flat(each) in shown for each in as_typed)
    assert flat(result.summary()).count(lost) == 1


def test_the_page_shows_it(result, first, lost):
    shown = words_of(page(result).decode())
    assert all(each in shown for each in (*first, lost))


def test_the_notebook_shows_it(result, first, lost):
    assert all(each in words_of(card(result)) for each in first)
    assert all(each in flat(notebook_text(result.plan)) for each in (*first, lost))


def test_agents_read_it(result):
    answer = planned(result.plan, 0, {})
    assert answer.told == "\n".join([result.plan.text.headline, *result.plan.text.lines])
    assert {c["id"]: c["text"] for c in answer.cutters} == result.plan.text.cutters


def test_a_row_of_many_parts_begins_it(result):
    row = row_of(result.plan, name="part", file="part.step", code=0)
    assert result.plan.text.headline.startswith(row.verdict)


def test_freecad_shows_it(result):
    with imported("freecad.plan_cutters.results") as results:
        found = results.Result(json.loads(result.plan.model_dump_json()), SimpleNamespace(document="D", body="B"), {})
        assert found.headline() == result.plan.text.headline
        assert found.summary() == [result.plan.text.headline, *result.plan.text.lines]
