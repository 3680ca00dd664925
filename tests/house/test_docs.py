"""The maintainers' page names files that are there, and each of its answers is short."""

import re

import pytest

from tests.support.places import ROOT

PAGE = (ROOT / "docs" / "maintainers.md").read_text(encoding="utf-8").replace("`P/", "`plugin/plan_cutters/")
ROWS = re.findall(r"^\| \[(?:a|an) .*?\]\(#(.*?)\) \| (.*?) \|", PAGE, re.MULTILINE)


@pytest.mark.parametrize("path", sorted(set(re.findall(r"`((?:plugin|cad_io|tests|docs)/[\w/.]+)`", PAGE))))
def test_files_for_maintainers_are_there(path):
    assert (ROOT / path).exists()


def test_ten_questions_have_at_most_three_files_each():
    assert len(ROWS) == 10
    for question, files in ROWS:
        assert 1 <= len(files.split(",")) <= 3, question
        assert f"\n## {question.replace('-', ' ')}\n" in PAGE.lower()
