"""A plan is told once: nothing is promised that was not judged, codes decide and not words, each code has all its words."""

import re
from types import SimpleNamespace
from typing import get_args

import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.TopoDS import TopoDS_Face

from plan_cutters import plan
from plan_cutters.command.codes import NOT_ALL_JUDGED, code_of
from plan_cutters.command.summary import summary
from plan_cutters.domain.verdicts import REASONS as CODES
from plan_cutters.errors import OptionError
from plan_cutters.hosts.viewer import _posture
from plan_cutters.plan_file.answers import MendEntry, RadiusEntry, StepEntry
from plan_cutters.plan_file.model import WitnessEntry
from plan_cutters.plan_file.part_info import Scope
from plan_cutters.plan_file.reasons import MEANING, NO_CONTACT, PALETTE, REASONS, label
from plan_cutters.plan_file.words import notes
from plan_cutters.plan_file.words.answers import answers, effect
from plan_cutters.plan_file.words.headline import not_judged
from plan_cutters.plan_file.words.notes import NoteCode
from plan_cutters.plan_file.words.text import story_of
from plan_cutters.report.notebook import text_of as notebook_text
from plan_cutters.report.page.arrays import row_of
from plan_cutters.report.page.write import page
from tests.support.cad_parts import box, compound
from tests.support.places import ROOT
from tests.support.plan_files import cutter, face, made, verdicts


@pytest.fixture(scope="module")
def whole():
    """All samples of a part are judged and reached."""
    return plan(ROOT / "samples" / "peaks_and_valleys.step", cutters=["R1L40"], grid=21, area_budget=0, spacing=None)


@pytest.fixture(scope="module")
def bare():
    """A block that is reached all over, and a target face without a surface."""
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face)
    return plan(compound(box(20, 20, 20), face), cutters=["R3L40"], faces="all", grid=5, area_budget=0)


def told(capsys, document, **how):
    summary(document, **how)
    return " ".join("".join(capsys.readouterr()).split())


def without_one(document):
    """The same plan, had one sample not been judged."""
    (face,), (c,) = document.faces, document.cutters
    face = face.model_copy(update={"unjudged": "1 samples: it has no normal there"})
    c = c.model_copy(update={"accessible": c.accessible - 1, "unjudged": 1})
    samples = document.samples.model_copy(update={"unjudged": 1})
    return document.model_copy(update={"faces": [face], "cutters": [c], "samples": samples})


def test_not_every_sample_is_reached_where_one_was_not_judged(whole, capsys):
    assert "It reaches every sample." in told(capsys, whole.plan)
    some = without_one(whole.plan)
    assert code_of(some) == NOT_ALL_JUDGED
    said = told(capsys, some)
    assert "every sample" not in said
    assert "reaches all 440 samples that could be judged. 1 of 441 samples on F1 could not be judged." in said
    assert story_of(some).headline.why in said


def test_a_face_that_could_not_be_sampled_is_in_no_share(bare, capsys):
    assert bare.plan.samples.unjudged == 0
    said, html = told(capsys, bare.plan), page(bare, triangles=500).decode()
    text = re.sub(r"(?s)<(script|style).*?</\1>|<[^>]*>", "", html)
    for each in (said, text):
        assert "100 % of the target area" not in each
        assert "100 % of the area" not in each
        assert not re.search("reaches every sample(?! that could be judged)", each)
        assert "All 150 samples that could be judged are reached" in each
        assert re.search(r"[Nn]ot judged: F7", each)
    assert "not of F7" in text


def test_a_code_decides_which_notes_are_shown(whole, capsys):
    document = whole.plan
    assert len(document.note_codes) == len(document.notes)
    assert set(document.note_codes) <= set(get_args(NoteCode))
    reworded = document.model_copy(update={"notes": [f"Reworded {code}" for code in document.note_codes]})
    said = notebook_text(reworded)
    assert "Reworded samples_apart" not in said
    assert "Reworded no_machine" in said
    assert "Reworded no_machine" not in told(capsys, reworded)
    assert "Reworded samples_apart" in told(capsys, reworded, verbose=True)


def test_what_is_as_it_should_be_is_no_news(whole):
    entry = SimpleNamespace(outside=0, judged=3, unknown=0, worst=[])
    (line,) = notes.travel(whole.plan, SimpleNamespace(id="Z9", travel=entry))
    assert line.minor
    (line,) = notes.travel(whole.plan, SimpleNamespace(id="Z9", travel=SimpleNamespace(outside=0, judged=0, unknown=2)))
    assert not line.minor


def entry(**more):
    return WitnessEntry(**({"sample": 1, "point": (1, 2, 3), "face": "F2", "reason": "holder", "obstacle_face": None,
                            "obstacle_point": None, "best_posture": None, "depth_mm": None} | more))  # fmt: skip


class Samples(SimpleNamespace):
    def __len__(self):
        return len(self.face)


#: Two faces that meet, with a sample of each at one point.
MET = Samples(face=np.array([1, 2, 2]), point=np.array([[1.0, 2, 3], [1, 2, 3], [9, 9, 9]]))


def test_a_witness_names_its_sample():
    """A sample of another face lies at the same point."""
    assert row_of(MET, entry()) == 1
    assert row_of(MET, entry(sample=0, face="F1")) == 0
    for other in (entry(sample=2), entry(sample=0), entry(sample=7), entry(sample=-1), entry(point=(5, 5, 5)), entry(face="F3")):
        with pytest.raises(ValueError, match="of another plan"):
            row_of(MET, other)


def test_witnesses_of_a_plan_have_the_rows_of_their_samples():
    result = plan(ROOT / "samples" / "v_groove.step", cutters=["R6L40"], machine="tilt:5", grid=5, area_budget=0)
    (c,) = result.cutters
    assert c.witnesses
    for w in c.witnesses:
        assert result.samples.point[w.sample].tolist() == list(w.point)
        assert f"F{result.samples.face[w.sample]}" == w.face
        assert result.reaches[c.id].not_reached[w.sample]
    posed = next(w for w in c.witnesses if w.best_posture)
    _posture(result, result.judged(), posed)
    with pytest.raises(OptionError, match="of another plan"):
        _posture(result, result.judged(), posed.model_copy(update={"point": (1e3, 0, 0)}))


def test_each_reason_has_all_its_words():
    """One row each, of this table alone: the page's script has no words of its own."""
    assert set(REASONS) == set(CODES)
    script = "".join(path.read_text() for path in (ROOT / "page" / "src").glob("*.ts"))
    patterns = set(re.findall(r'"(\w+)"', re.search(r"PATTERNS: Pattern\[\] = \[(.*?)\]", script)[1]))
    for each in (*REASONS.values(), NO_CONTACT):
        assert all(each), each
        assert each.sentence.endswith(".")
        assert not each.hint.endswith(".")
        assert re.fullmatch("#[0-9A-F]{6}", each.colour)
        assert each.pattern in patterns
        assert each.name not in script.replace("fixture", "") or each.name in ("fixture", "tolerance")
    assert len({each.name for each in REASONS.values()}) == len({each.colour for each in REASONS.values()}) == len(REASONS)


def test_each_verdict_has_a_name_and_a_colour():
    assert set(PALETTE) == set(MEANING)
    assert all(label(word) and ":" not in label(word) for word in PALETTE)


def test_where_nothing_was_looked_for_the_cause_is_said():
    mended = cutter("R6L80", {"F1": verdicts(3)})
    inside = MendEntry(lost=3, buried=3, why="3 samples are within another body", steps=[])
    (line,) = answers(made([face(1)], [mended.model_copy(update={"mend": inside})]))
    assert line.text == "Nothing sure would make flat end D12 x 80 finish: 3 samples are within another body."


def test_a_step_that_gains_hardly_anything_says_so():
    step = StepEntry(changes=[], lost_before=0.0071, lost_after=0.0066, gained=5, left=9, cutters=[], setups=[], option=None,
                     why="", remains=[])  # fmt: skip
    assert effect(step) == "lost 0.7 % of the area, hardly less than now (5 more samples)"


def test_the_option_that_asks_for_all_faces_is_named():
    scope = Scope(judged=1, judged_mm2=90.0, not_judged=1, not_judged_mm2=10.0, judged_by_kind={"sculptured": 1},
                  not_judged_by_kind={"plane": 1})  # fmt: skip
    document = made([face(1), face(2, target=False)], [cutter("R6L80", {"F1": verdicts()})]).model_copy(update={"scope": scope})
    asked = document.effective.model_copy(update={"faces": "sculptured"})
    (line,) = not_judged(document.model_copy(update={"effective": asked}))
    assert line.endswith("only an obstacle: `--faces all`.")


@pytest.mark.parametrize(("names", "across", "larger", "half", "least"), [
    (("R6L80", "R3L40"), "radius", "2.95 mm", "12.2 mm", "0.1 mm"),
    (("D12L80", "Finisher"), "diameter", "5.91 mm", "24.4 mm", "0.2 mm"),
    (("D12L80", "R3L40"), "radius", "2.95 mm", "12.2 mm", "0.1 mm"),
])  # fmt: skip
def test_the_largest_tool_is_measured_as_the_cutters_were_given(names, across, larger, half, least):
    cutters = [cutter(f"R{n}L80", {"F1": verdicts()}).model_copy(update={"name": name}) for n, name in enumerate(names, 3)]
    found = RadiusEntry(shape="flat", length_over_radius=10.0, step=0.02, least_mm=0.1, most_mm=80.0, percentiles_mm={"50": 12.2},
                        below=0, no_less=0, bottleneck_mm=2.958, bottleneck_face="F1", bottleneck_point=(1.0, 2.0, 3.0),
                        beyond="inaccessible", reason="rear_gouge")  # fmt: skip
    none = found.model_copy(update={"shape": "ball", "below": 7, "bottleneck_mm": 0.0, "percentiles_mm": {"50": 0.0}})
    first, second = (line.text for line in answers(made([face(1)], cutters, largest_radius=[found, none])))
    assert first.startswith(f"A flat end of {across} {larger} (10 radii long) reaches")
    assert f"half of the area takes {half} or more" in first
    assert second.startswith(f"Not even a ball end of {across} {least} (10 radii long) reaches")
    assert f"misses 7; half of the area takes less than {least}" in second
