"""A word of the command line that is gone is refused in one line, which names what to use instead."""

import pytest

from plan_cutters.command.entry import commands
from plan_cutters.command.taken_out import TAKEN_OUT, instead
from tests.support.places import ROOT


@pytest.mark.parametrize("word", TAKEN_OUT)
def test_a_word_that_is_gone_stands_in_the_migration_note(word):
    assert word.removeprefix("command ") in (ROOT / "docs/migration.md").read_text(encoding="utf-8")
    assert instead(word).startswith(word)
    assert word.removeprefix("command ") not in commands()
