"""A word of the command line that is gone is refused in one line, which names what to use instead."""

import pytest

from plan_cutters.command.entry import SUBCOMMANDS
from plan_cutters.command.taken_out import TAKEN_OUT, instead
from tests.support.commands import assert_one_line
from tests.support.forked import run
from tests.support.places import ROOT


@pytest.mark.parametrize("word", TAKEN_OUT)
def test_a_word_that_is_gone_stands_in_the_migration_note(word):
    assert word.removeprefix("command ") in (ROOT / "docs/migration.md").read_text(encoding="utf-8")
    assert instead(word).startswith(word)
    assert word.removeprefix("command ") not in SUBCOMMANDS


def test_an_answer_that_is_gone_is_refused_in_one_line_that_names_another():
    assert_one_line(
        run("part.step", "--answers", "stick-out,Mend-All"), 2, "--answers mend-all was taken out: give --answers mend"
    )
