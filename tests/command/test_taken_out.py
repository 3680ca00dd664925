"""A word of the command line that is gone is refused in one line, which names what to use instead."""

import pytest

from plan_cutters.command.entry import TAKEN_OUT, commands, instead
from tests.support.commands import assert_one_line
from tests.support.forked import run
from tests.support.places import ROOT


@pytest.mark.parametrize("word", TAKEN_OUT)
def test_a_word_that_is_gone_stands_in_the_migration_note(word):
    assert word.removeprefix("command ") in (ROOT / "docs/migration.md").read_text(encoding="utf-8")
    assert instead(word).startswith(word)
    assert word.removeprefix("command ") not in commands()


WORDS = (
    ("stored", "p.npz"),
    ("p.step", "--postures", "p.npz"),
    ("p.step", "--cutter", "D2L9", "--answers", "mend,stick-out-map"),
    ("p.step", "--answers", "stick-out,Mend-All"),
)


@pytest.mark.parametrize("words", WORDS)
def test_a_command_an_option_and_a_value_are_refused_in_one_line(words, tmp_path):
    assert_one_line(run(*words, cwd=tmp_path), 2, "was taken out: ")
