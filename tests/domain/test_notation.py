"""Cutters are written in the notation in which they were given, and read back as the same."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters.answers.means import longer
from plan_cutters.answers.steps import spoken
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import is_spec, spelled, typed
from plan_cutters.domain.figures import Notation, across, length
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.standard_tools import USUAL, smaller
from plan_cutters.errors import CutterError, PlanError
from plan_cutters.options import Options
from plan_cutters.plan_file.words import answers as next_steps
from plan_cutters.plan_file.words.names import called, described, short_names
from tests.support.plan_files import cutter, face, made, verdicts

WORDS = ("R6L80", "D12L80", "D12L80rc1F20N11x40S12", "D12L80T3", "D0.5inL3inrc1/16in", "D3L25rc1.5F10S6", "r6l80rc6",
         "D12L80HD30:40L30+D50L20", "R0.25inL2in", "D10L60Her16")  # fmt: skip


@pytest.mark.parametrize("word", WORDS)
def test_a_cutter_is_written_as_it_was_given(word):
    cutter = Cutter.parse(word)
    text = spelled(cutter)
    assert Cutter.parse(text).id == cutter.id
    assert text[0] == word[0].upper()
    assert ("in" in text) == ("in" in word)
    assert cutter.typed == (word if word.upper() != cutter.id.upper() else cutter.id)


@given(st.sampled_from(["R", "D"]), st.booleans(), st.floats(0.01, 500))
def test_a_number_reads_as_itself(by, inches, value):
    how = Notation(by, inches)
    assert length(how.length(value)) == pytest.approx(value, rel=1e-9)
    assert across(by, how.across(value)) == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize(
    ("word", "thin", "stick_out", "size"),
    [
        ("D6L40rc3F15S6", "D5L25rc2.5F13N4.75x10S6", "a stick-out of 45 mm (7.5 D, more than the usual 5 D) instead of 40 mm",
         "a ball end D5 held 25 mm out"),
        ("R3L20rc3F15S3", "R2.5L25rc2.5F13N2.375x10S3", "a stick-out of 45 mm (7.5 D, more than the usual 5 D) instead of 20 mm",
         "a ball end R2.5 held 25 mm out"),
        ("D0.5inL2in", "D0.375inL1.875inF0.875inS0.375in", "a stick-out of 1.77165 in instead of 2 in",
         "a flat end D0.375in held 1.875 in out"),
    ],
)  # fmt: skip
def test_what_is_made_of_a_cutter_is_written_as_the_cutter_was(word, thin, stick_out, size):
    now = Cutter.parse(word)
    made = smaller(now, USUAL)[0]
    assert spelled(replace(made, holder=None)) == thin
    assert Cutter.parse(thin).id == made.id
    assert next_steps.stick_out(45.0, now) == stick_out
    assert next_steps.tool(made) == size


def test_a_holder_of_the_options_is_not_written_again():
    """What stands in brackets is added to a command that has its holder."""
    options = Options(cutters="D6L40rc1F20S6", holder="er16")
    (cutter,) = options.cutters
    held = cutter.asked(0.0, 0.0, options.holder)
    other = longer(held, 55.0)
    assert spoken(other, options) == "D6L55rc1F20S6"
    assert Cutter.parse(spoken(other, options)).asked(0.0, 0.0, options.holder).id == other.id
    slim = replace(other, holder=Holder.parse("D20L60"))
    assert spoken(slim, options) == "D6L55rc1F20S6HD20L60"
    assert spoken(other, Options(cutters="D6L40")) == "D6L55rc1F20S6Her16"
    assert next_steps.holder(slim.holder, held) == "the holder D20L60 instead of ER16"


def test_a_word_with_its_holder_is_a_word():
    assert is_spec("D2L12rc1HD50L30")
    assert not is_spec("D2L12 Hard")
    assert not is_spec("D6L40H")
    assert called(Cutter.parse("D2L12rc1HD50L30")) == "ball end D2 x 12"
    assert typed("R3L40", "Finisher D6") == "R3L40"


@pytest.mark.parametrize(
    ("word", "said"),
    [("D12L80F90", "cutter 'D12L80F90': it is 80 mm long"), ("D12L80HD8L30", "D12L80HD8L30"),
     ("R6L80F90", "cutter 'R6L80F90': it is 80 mm long"), ("D12L80Her16", "(F30S10)"), ("R6L80Her16", "(F30S5)")],
)  # fmt: skip
def test_what_cannot_exist_is_told_in_the_word_that_was_given(word, said):
    with pytest.raises(CutterError) as error:
        Cutter.parse(word)
    assert said in str(error.value)
    assert word[0] == "R" or "R6L80" not in str(error.value)


def test_options_speak_of_the_word_that_was_given():
    with pytest.raises(PlanError, match="too coarse for cutter D1L20"):
        Options(cutters="D1L20", tolerance=0.2)


def test_names_tell_two_of_a_kind_apart_by_their_words():
    faces = [face(1)]
    entries = [cutter(name, {"F1": verdicts(5)}) for name in ("R6L80F20", "R6L80F30")]
    given = [each.model_copy(update={"name": f"D12L80F{n}"}) for each, n in zip(entries, (20, 30), strict=True)]
    assert [*short_names(made(faces, given)).values()] == ["flat end D12 x 80 (D12L80F20)", "flat end D12 x 80 (D12L80F30)"]
    inch = entries[0].model_copy(update={"name": "D0.5inL3in", "radius": 6.35, "length": 76.2})
    assert called(inch) == "flat end D0.5in x 3in"
    assert described(inch, called(inch)) == "D0.5inL3in, judged without a holder, 3 in up from its tip"
