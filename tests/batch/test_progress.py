"""The board of many parts: what it writes on a terminal, and where there is none."""

import contextlib
import io

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters_base.terminal_text import clean
from plan_cutters_batch.progress import EACH, Board, Screen
from plan_cutters_batch.row import PartRow, cause

GOOD = PartRow(name="blade", file="blade.step", status="planned", code=0, verdict="Take flat end D12 x 60")
BAD = PartRow(name="rim\n\x1b[2J", file="rim.step", status="failed", code=3, error="rim.step: not a STEP file")


def board(quiet=False, total=3, *, terminal=False, width=200):
    text = io.StringIO()
    console = Screen(file=text, width=width, force_terminal=terminal, highlight=False, markup=False, emoji=False,
                      _environ={"TERM": "xterm"})  # fmt: skip
    return Board(quiet, total, console=console), text


def lines(text):
    """What is said of each part after the counts and times in front; lines that are wrapped are put together again."""
    return [line.partition("  ")[2].partition("  ")[2] for line in text.getvalue().replace("\n    ", " ").splitlines()]


def test_plain_lines_name_each_part_and_the_cause_of_a_failure():
    with contextlib.closing((found := board())[0]) as one:
        one.row(GOOD)
        one.row(BAD)
        one.row(GOOD.model_copy(update={"status": "kept", "error": "not written: review.png"}))
    assert lines(found[1]) == [
        "blade: finished: Take flat end D12 x 60",
        "rim\\n\\x1b[2J: failed: rim.step: not a STEP file",
        "blade: finished: Take flat end D12 x 60; reused from an earlier run; not written: review.png",
        "parts done, 1 failed",
    ]
    assert [line.partition(" ")[0] for line in found[1].getvalue().replace("\n    ", " ").splitlines()] == [
        "1/3",
        "2/3",
        "3/3",
        "3/3",
    ]


@given(st.text(max_size=200), st.text(max_size=400))
@settings(max_examples=60, deadline=None)
def test_lines_have_at_most_80_columns_but_for_words_and_nothing_is_left_out(verdict, error):
    one, text = board(width=20)
    one.row(GOOD.model_copy(update={"verdict": verdict}))
    one.row(BAD.model_copy(update={"error": error}))
    shown = text.getvalue().splitlines()
    assert all(len(line) <= 80 or len(line.split()) == 1 for line in shown)
    assert "".join("".join(shown).split()).endswith("".join(clean(cause(BAD.model_copy(update={"error": error}))).split()))


def test_a_word_is_never_parted():
    one, text = board(width=20)
    one.say(f"dashboard: http://{'x' * 300}/status")
    assert f"http://{'x' * 300}/status" in text.getvalue()


def test_the_time_left_follows_from_the_parts_that_were_planned():
    one, text = board(total=20)
    one._began -= 60.0
    one.row(GOOD.model_copy(update={"status": "kept", "seconds": 9.0}))
    assert "left" not in text.getvalue()
    for _ in range(3):
        one.row(GOOD.model_copy(update={"seconds": 20.0}))
    # 16 of 20 are left, at 20 s each.
    assert text.getvalue().splitlines()[-1].startswith(" 4/20  60 s, about 5.3 min left  blade: finished")
    for _ in range(16):
        one.row(GOOD.model_copy(update={"seconds": 20.0}))
    assert "left" not in text.getvalue().splitlines()[-1]


def test_quiet_tells_failures_alone_even_after_it_is_closed():
    one, text = board(quiet=True)
    one.say("dashboard: http://127.0.0.1:8787")
    one.progress(1, 2)
    one.row(GOOD)
    one.close()
    assert text.getvalue() == ""
    one.row(BAD)
    assert "not a STEP file" in text.getvalue()


def test_of_many_parts_failures_and_counts_are_told():
    one, text = board(total=EACH + 1)
    for _ in range(EACH):
        one.row(GOOD)
    one.row(BAD)
    one.close()
    assert lines(text) == ["rim\\n\\x1b[2J: failed: rim.step: not a STEP file", "parts done, 1 failed"]


def test_where_the_number_is_not_known_lines_stop_at_the_same_number():
    one, text = board(total=None)
    for _ in range(EACH + 50):
        one.row(GOOD)
    one.close()
    assert len(lines(text)) == EACH + 1
    assert text.getvalue().splitlines()[-1].startswith(f"{EACH + 50}  ")


def test_the_address_is_said_once():
    one, text = board()
    for _ in range(3):
        one.say("dashboard: http://127.0.0.1:8787/status")
    assert text.getvalue() == "dashboard: http://127.0.0.1:8787/status\n"


def test_a_terminal_has_a_bar_and_lines_for_failures():
    one, text = board(terminal=True)
    one.progress(0, 2)
    one.row(GOOD)
    one.row(BAD)
    one.say("dashboard: http://127.0.0.1:8787/status")
    one._bar.refresh()
    drawn = text.getvalue()
    one.close()
    assert "2 of 3 parts done, 2 in work, 1 failed" in drawn
    assert "rim\\n\\x1b[2J: failed: rim.step: not a STEP file" in drawn
    assert "blade" not in drawn
    assert "8787" in drawn
    # The bar is taken away, and the cursor is back.
    assert "\x1b[?25h" not in drawn
    assert "\x1b[?25h" in (before := text.getvalue())
    one.close()
    assert text.getvalue() == before


class Broken(io.StringIO):
    def write(self, text):
        raise BrokenPipeError

    def flush(self):
        raise BrokenPipeError


@pytest.mark.parametrize("terminal", [False, True])
def test_a_stream_that_is_gone_ends_nothing(terminal):
    one = Board(False, 2, console=Screen(file=Broken(), force_terminal=terminal))
    one.say("hello")
    one.row(BAD)
    one.progress(1, 0)
    one.close()
    assert (one.done, one.failed) == (1, 1)


@pytest.mark.parametrize("before", [True, False])
def test_a_part_that_is_told_of_twice_counts_once(before):
    one, text = board(total=3)
    for done in (1, 2, 3):
        steps = [lambda done=done: one.progress(done, 3 - done), lambda: one.row(GOOD)]
        for step in steps if before else steps[::-1]:
            step()
    one.close()
    assert text.getvalue().splitlines()[-1].startswith("3/3  ")
