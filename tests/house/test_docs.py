"""The maintainers' page names files that are there, and each of its answers is short."""

import re

import pytest

from tests.support.places import ROOT

PAGE = (ROOT / "docs" / "maintainers.md").read_text(encoding="utf-8").replace("`P/", "`plugin/plan_cutters/")
ROWS = re.findall(r"^\| \[(?:a|an|the) .*?\]\(#(.*?)\) \| (.*?) \|", PAGE, re.MULTILINE)


@pytest.mark.parametrize("path", sorted(set(re.findall(r"`((?:plugin|cad_io|tests|docs)/[\w/.]+)`", PAGE))))
def test_files_for_maintainers_are_there(path):
    assert (ROOT / path).exists()


def test_every_page_stands_in_the_menu_once():
    """`mkdocs build --strict` fails on a page that does not; so does this, sooner."""
    menu = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:\n")[2]
    named = re.findall(r"^ +- (?:.*: )?(\S+\.(?:md|ipynb))$", menu, re.MULTILINE)
    pages = {path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")}
    assert sorted(named) == sorted(pages)


def test_each_question_has_at_most_three_files():
    assert len(ROWS) == 14
    for question, files in ROWS:
        assert 1 <= len(files.split(",")) <= 3, question
        assert f"\n## {question.replace('-', ' ')}\n" in PAGE.lower()


#: Phrases that a reader of other languages does not find in a dictionary, and the plain word.
QUAINT = {
    r"\b(?:is|are|was|were|be) told\b": "reported",
    r"\bthat (?:is|are) none\b": "invalid",
    r"\breckon": "compute",
    r"\bcalled so\b": "has this name",
    r"\bha(?:s|ve) no meaning\b": "unknown, invalid",
    r"\bneither has a right\b": "not",
}


@pytest.mark.parametrize("phrase", QUAINT)
def test_pages_have_plain_words(phrase):
    pages = [ROOT / "README.md", ROOT / "freecad" / "README.md", *(ROOT / "docs").glob("*.md")]
    lines = {path.name: path.read_text(encoding="utf-8").splitlines() for path in pages}
    found = {name: [line for line in each if re.search(phrase, line)] for name, each in lines.items()}
    assert {name: lines for name, lines in found.items() if lines} == {}, f"say: {QUAINT[phrase]}"
