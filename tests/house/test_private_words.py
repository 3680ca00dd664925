"""Private words grow fewer: as names, and in texts that users read."""

import ast
from collections import Counter
from pathlib import Path

import pytest

from tests.support import private_words
from tests.support.private_words import INSTEAD, ceiling, count, names, sentence, texts, texts_of_page, words_of

CODE = '''
"""Told in a docstring."""
import json as found_json
LEFT, right = 1, 2
class LostFace:
    kept: int = 0
    def told(self, asked, *, given=None):
        """Told again."""
        self.room = asked
        found = found + 1
        with open("said") as said:
            return [lean for lean in given if lean], "it was told", f"{found} are beside it", "not found"
'''


def test_names_are_counted_where_they_are_defined_and_once_in_a_scope():
    assert Counter(name for name, _ in names(ast.parse(CODE)) if words_of(name)) == Counter(
        ["found_json", "LostFace", "kept", "told", "asked", "given", ".room", "found", "said", "lean"]
    )


def test_left_is_a_side_where_there_is_a_right():
    assert [name for name, _ in names(ast.parse("left, up = 1, 2"))] == ["left", "up"]
    assert [name for name, _ in names(ast.parse("left, right = 1, 2"))] == ["right"]


def test_texts_are_strings_that_are_read_and_no_docstrings():
    assert sorted(text for text, _ in texts(ast.parse(CODE))) == [" are beside it", "it was told", "not found"]
    script = 'f("told", "was told", `asked ${found} now`) // "is lost"'
    assert [text for text, _ in texts_of_page(script, ".ts")] == ["was told", "asked   now"]
    assert [text for text, _ in texts_of_page("<p>It was told</p>{{ told }}<b>now</b>", ".jinja")] == ["It was told"]
    assert sentence("`asked` with --answers mend and told").split() == ["with", "and", "told"]


@pytest.mark.parametrize("word", INSTEAD)
def test_each_word_is_known_in_every_form_of_name(word):
    first, second = ("stand", "in") if word == "standin" else (word, "")
    for name in (f"{first}_{second}", f"_{first.upper()}_{second.upper()}", f"New{first.capitalize()}{second.capitalize()}"):
        assert word in words_of(name), name
    assert words_of(f"un{word}ed") == set()


def test_private_words_grow_fewer():
    most = ceiling()
    more = {key: places for key, places in count().items() if len(places) > most[key]}
    assert not more, "\n".join(
        f"{word!r} in {kind} of {room}: {len(places)}, at most {most[kind, room, word]}. Write {INSTEAD[word]}. It is at:\n  "
        + "\n  ".join(places)
        for (kind, room, word), places in more.items()
    )


def test_the_ceiling_is_not_raised_by_writing_it(tmp_path: Path, monkeypatch):
    monkeypatch.setattr(private_words, "CEILING", tmp_path / "words.toml")
    private_words.write({("names", "here", "told"): ["a", "b"], ("texts", "here", "told"): ["c"]})
    private_words.write({("names", "there", "told"): ["a", "b"]})
    assert private_words.ceiling() == {("names", "there", "told"): 2}
    with pytest.raises(SystemExit, match="told in names"):
        private_words.write({("names", "here", "told"): ["a"], ("names", "there", "told"): ["a", "b"]})
