"""The first sentence: how much is finished in how many steps and setups, how much stays, mostly why; no sentence is cut."""

import re

import pytest

from plan_cutters.plan_file.operations import ProcessEntry, ProcessStep, RemainingEntry
from plan_cutters.plan_file.part_info import SharpEdgeEntry
from plan_cutters.plan_file.words.answers import needs
from plan_cutters.plan_file.words.names import as_fields
from plan_cutters.plan_file.words.process import wrapped
from plan_cutters.plan_file.words.text import story_of, text_of, with_text
from tests.support.plan_files import cutter, face, made, verdicts


def step(name, faces, share, *, setup=0):
    return ProcessStep(
        setup=setup, mode="any", angles_deg=None, axis=None, cutter=name, faces=faces, area_mm2=100.0 * share, share=share,
        seconds=None, clearance_mm=None,
    )  # fmt: skip


def stays(cause, share, faces=("F1",)):
    return RemainingEntry(
        cause=cause, area_mm2=100.0 * share, share=share, samples=9, faces=list(faces), place_mm=(1.0, 2.0, 3.0)
    )


def planned(left, *, setups=(0, 0), sharp=()):
    finished = 1.0 - sum(each.share for each in left)
    entries = [cutter("R4L40rc1", {"F1": verdicts(300)}, radius=4.0), cutter("R3L40rc3", {"F1": verdicts(400)}, radius=3.0)]
    entries = [each.model_copy(update={"corner_radius": corner}) for each, corner in zip(entries, (1.0, 3.0), strict=True)]
    steps = [step(each.id, ["F1"] if k == 0 else ["F2"], finished / 2, setup=setups[k]) for k, each in enumerate(entries)]
    process = ProcessEntry(
        steps=steps, finished_share=finished, finished_mm2=100.0 * finished, asked_mm2=100.0, left=left, seconds=None
    )
    return made([face(1), face(2)], entries, process=process, sharp_edges=list(sharp), shown="R3L40rc3")


@pytest.mark.parametrize(
    ("left", "setups", "wanted"),
    [
        ([], (0, 0), "2 steps in 1 setup finish all 100 mm²."),
        ([stays("rear_gouge", 0.28)], (0, 1), "2 steps in 2 setups finish 72 % of 100 mm²; 28 % stay: rear gouge."),
        ([stays("rear_gouge", 0.2), stays("holder", 0.08)], (0, 0),
         "2 steps in 1 setup finish 72 % of 100 mm²; 28 % stay, mostly rear gouge."),
        ([stays("rear_gouge", 0.1), stays("holder", 0.09), stays("axis_limit", 0.09)], (0, 0),
         "2 steps in 1 setup finish 72 % of 100 mm²; 28 % stay: rear gouge (10 %) and other causes."),
        ([stays("unjudged", 0.0, ["F7"])], (0, 0), "2 steps in 1 setup finish >99.9 % of 100 mm²; F7 not judged."),
    ],
)  # fmt: skip
def test_the_first_sentence_says_what_stays_and_mostly_why(left, setups, wanted):
    plan = planned(left, setups=setups)
    assert text_of(plan).headline == wanted
    # What it is of stands in the next line, once.
    assert "part.step" not in wanted
    assert story_of(plan).headline.about.startswith("part.step, 100 x 100 x 100 mm.")


def test_a_sharp_edge_has_the_radius_of_the_step_that_comes_there():
    """The cutter shown is a ball of R3; the step on the floor has a corner of R1."""
    edge = SharpEdgeEntry(faces=("F1", "F3"), length_mm=9, angle_deg=90, radius_mm=3.0, width_mm=1, area_mm2=1)
    entry = stays("sharp_edge", 0.1)
    plan = planned([entry], sharp=[edge])
    assert needs(plan, entry) == "the model has no fillet there, and the cutter leaves one of R1"
    other = edge.model_copy(update={"faces": ("F2", "F3")})
    both = planned([stays("sharp_edge", 0.1, ["F1", "F2"])], sharp=[edge, other])
    assert needs(both, both.process.left[0]).endswith("one of R1 to R3")


def test_no_sentence_is_cut():
    long = "It says what holds for all of it, which is not a little, " * 4 + "but never here."
    assert wrapped([f"One. {long} Three."], 1) == ["One."]
    whole = wrapped([long], 1)
    assert " ".join(each.strip() for each in whole) == long
    for sentences in ([long], ["One.", long], ["One.", "Two.", long]):
        text = " ".join(each.strip() for each in wrapped([" ".join(sentences)], 2))
        assert text in (" ".join(sentences[:k]) for k in range(1, len(sentences) + 1))


def test_options_are_typed_in_a_terminal_alone():
    plan = with_text(planned([stays("rear_gouge", 0.28)]))
    text = " ".join(plan.text.lines)
    assert not re.search(r"(^|[\s\[])-{1,2}[a-z]", text)
    assert "[answers = mend]" in text
    story = story_of(plan)
    assert any("--answers mend" in each for each in story.process.next)
    assert all(as_fields(each) in text for each in story.process.next)
