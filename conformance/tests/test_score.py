"""Laws of the scorer."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from conformance.posture import Postures
from conformance.score import Known, counts, read_answers, scored, write_answers


def table(low: list[float], high: list[float] | None = None, limit: list[float] | None = None) -> Postures:
    """Return postures with these margins (mm) and angles to the limit (degrees)."""
    n = len(low)
    a, b = np.array(low, float), np.array(low if high is None else high, float)

    def word(text: str) -> np.ndarray:
        return np.full(n, text)

    zero, limits = np.zeros((n, 3)), np.full(n, np.nan) if limit is None else np.array(limit, float)
    blocked = (a < 0) | (limits < 0)
    return Postures(word("p"), word("t"), word("s"), zero, zero, zero, zero, np.where(blocked, "blocked", "safe"), a, b, limits, word(""), word("form"))


MIXED = table([-2.0, -0.011, -0.009, 0.0, 0.009, 0.011, 3.0])
SUMS = ("border", "right", "false_safe", "false_blocked", "undecided")


def flipped(words: np.ndarray) -> np.ndarray:
    return np.where(words == "safe", "blocked", "safe")


def test_who_knows_all_is_right_everywhere():
    counted = counts(MIXED, MIXED.verdict)
    assert (counted["right"], counted["border"], counted["score"]) == (4, 3, 1.0)
    assert counted["false_safe"] == counted["false_blocked"] == counted["undecided"] == 0


def test_flipped_answers_are_false_and_the_worst_depth_is_told():
    counted = counts(MIXED, flipped(MIXED.verdict))
    assert (counted["false_safe"], counted["false_blocked"], counted["right"], counted["score"]) == (2, 2, 0, 0.0)
    assert (counted["worst_mm"], counted["worst_false_blocked_mm"]) == (2.0, 3.0)


def test_at_the_border_each_answer_is_right():
    at = MIXED[np.flatnonzero(Known.of(MIXED).border)]
    assert len(at) == 3
    for words in (at.verdict, flipped(at.verdict), np.full(3, "undecided")):
        counted = counts(at, words)
        assert counted["border"] == 3
        assert sum(counted[name] for name in SUMS) == 3
        assert counted["score"] is None


def test_undecided_everywhere_scores_nothing():
    counted = counts(MIXED, np.full(len(MIXED), "undecided"))
    assert (counted["score"], counted["right"], counted["undecided"], counted["undecided_border"]) == (0.0, 0, 4, 3)


def test_every_posture_is_counted_once():
    rng = np.random.default_rng(1)
    many = table(rng.normal(0.0, 0.02, 500).tolist())
    counted = counts(many, rng.choice(["safe", "blocked", "undecided"], 500))
    assert sum(counted[name] for name in SUMS) == 500
    assert min(counted[name] for name in SUMS) > 0


def test_bounds_prove_only_what_they_bound():
    wide = table([-5.0, -5.0, 0.02], [-0.02, 0.5, 9.0])
    known = Known.of(wide)
    assert known.blocked.tolist() == [True, False, False]
    assert known.free.tolist() == [False, False, True]
    # What is proved of the depth is its lower bound.
    assert counts(wide, np.full(3, "safe"))["worst_mm"] == 0.02


def test_the_limit_blocks_and_is_a_border_too():
    near = table([1.0, 1.0, 1.0, 1.0], limit=[-1.0, -0.005, 0.005, 1.0])
    counted = counts(near, np.full(4, "safe"))
    assert (counted["false_safe"], counted["border"], counted["right"]) == (1, 2, 1)
    assert (counted["worst_mm"], counted["worst_deg"]) == (0.0, 1.0)
    assert counts(near, np.full(4, "blocked"))["false_blocked"] == 1


def test_what_nothing_is_known_of_is_a_border():
    assert Known.of(table([np.nan, -np.inf], [np.nan, np.inf])).border.all()


def test_a_coarser_tolerance_makes_more_border():
    assert counts(MIXED, MIXED.verdict, 0.1)["border"] == 5
    assert counts(MIXED, MIXED.verdict, 0.001)["border"] == 1


def test_families_and_parts_sum_up_and_false_answers_can_be_repeated():
    two = replace(MIXED, part=np.array(["a"] * 3 + ["b"] * 4))
    rows = np.arange(100, 107)
    document = scored(two, flipped(two.verdict), {"a": "x", "b": "y"}, rows=rows)
    assert document["parts"] == 2
    for groups in (document["families"], document["by_part"]):
        assert sum(each["false_safe"] for each in groups.values()) == document["false_safe"] == 2
    assert [each["row"] for each in document["false_answers"]] == [100, 101, 106, 105]
    assert document["false_answers"][0]["high"] == -2.0


def test_a_number_of_answers_that_is_not_that_of_postures_is_refused():
    with pytest.raises(ValueError, match="2 answers to 7 postures"):
        scored(MIXED, np.full(2, "safe"), {"p": "x"})


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_answers_are_read_as_they_were_written(tmp_path: Path, suffix: str):
    path, rows, words = tmp_path / f"answers{suffix}", np.array([4, 0, 2]), np.array(["safe", "undecided", "blocked"])
    write_answers(path, rows, words)
    read = read_answers(path, 5)
    assert read[0].tolist() == rows.tolist()
    assert read[1].tolist() == words.tolist()


@pytest.mark.parametrize(("text", "message"), [
    ("id,answer\n0,safe\n7,safe\n", "answer 2: id 7 is no row of the table, which has 0 to 4"),
    ("id,answer\n0,safe\n0,safe\n", "answer 2: id 0 is answered twice"),
    ("id,answer\n0,maybe\n", "answer 1: 'maybe' is none of safe, blocked, undecided"),
    ("id,verdict\n0,safe\n", "no column answer; it has id, verdict"),
    ("id,answer\nx,safe\n", "the column id holds other things than row numbers"),
    ("", "cannot be read"),
])  # fmt: skip
def test_files_that_are_no_answers_are_refused(tmp_path: Path, text: str, message: str):
    path = tmp_path / "answers.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"answers\.csv: ") as caught:
        read_answers(path, 5)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
