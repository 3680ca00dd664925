"""Words have lengths in the unit of the planner; numbers in files stay mm."""

import json
import re
from types import SimpleNamespace

import pytest

from plan_cutters import Cutter, OptionError, Options, plan
from plan_cutters.command.summary import summary
from plan_cutters.domain import figures as numbers
from plan_cutters.domain.figures import Notation, in_inches, reported_in
from plan_cutters.library import read_library
from plan_cutters.plan_file.words.names import called
from plan_cutters.plan_file.words.process import roughing
from tests.support.cad_parts import pocketed

HOW = {"faces": "all", "spacing": 6.0, "area_budget": 0, "machine": "tilt:40"}
MM = re.compile(r"\d ?mm²?\b")
INCHES = re.compile(r"\d in²?(?!\w)")


def test_what_is_roughed_has_cubic_inches():
    process = SimpleNamespace(stock=SimpleNamespace(seconds=None, remove_mm3=25.4**3, volume_mm3=2.0 * 25.4**3))
    assert roughing(process) == "Roughing: 16.4 of 32.8 cm³ of stock."
    with reported_in("in"):
        assert roughing(process) == "Roughing: 1 of 2 in³ of stock."


@pytest.mark.parametrize("length", [0.0123, 1.0, 25.4, 6.35, 812.8])
def test_a_length_in_inches_is_the_same_length(length):
    with reported_in("in"):
        assert float(numbers.mm(length).removesuffix(" in")) == pytest.approx(length / 25.4, rel=5e-3)
        assert float(numbers.up(length).removesuffix(" in")) >= length / 25.4 - 1e-9
        assert float(numbers.down(length).removesuffix(" in")) <= length / 25.4 + 1e-9
        assert float(numbers.area(length).removesuffix(" in²")) == pytest.approx(length / 645.16, rel=5e-3)
    assert numbers.mm(25.4) == "25.4 mm"


def test_a_direction_has_no_unit():
    with reported_in("in"):
        assert numbers.direction((0.0, 0.6, -0.8)) == "0, 0.6, -0.8"
        assert numbers.place((25.4, 0.0, -50.8)) == "1, 0, -2"


def test_the_unit_ends_with_the_words_even_by_an_error():
    def told(length):
        with reported_in("in"):
            assert in_inches()
            return 1.0 / length

    with pytest.raises(ZeroDivisionError):
        told(0.0)
    assert not in_inches()


def test_inches_are_told_where_all_tools_are_in_inches(tmp_path):
    assert Options(cutters="D0.5inL3in").reported_unit == "in"
    assert Options(cutters=["D0.5inL3in", "D12L80"]).reported_unit is None
    assert Options(cutters="D0.5inL3in", units="mm").reported_unit == "mm"
    assert Options(cutters="D12L80", units="in").reported_unit == "in"
    assert Options().reported_unit is None
    file = tmp_path / "shop.toml"
    for unit, told in (("inch", "in"), ("mm", None)):
        file.write_text(f'unit = "{unit}"\n[[tool]]\nname = "One"\ntype = "flat"\nDC = 0.5\nLCF = 1\nLPR = 1\nholder = "none"\n')
        assert Options(cutters=read_library(file)).reported_unit == told
    with pytest.raises(OptionError, match="none of mm, in"):
        Options(units="cm")


def test_a_tool_keeps_the_notation_in_which_it_was_typed():
    with reported_in("in"):
        assert called(Cutter.parse("D12L80")) == "flat end D12 x 80"
        assert called(Cutter(3.175, 40, 3.175, name="Finisher")) == "Finisher D0.25in"
        assert Notation("D").mm(76.2) == "3 in"
    with reported_in("mm"):
        assert called(Cutter.parse("D0.5inL3in")) == "flat end D0.5in x 3in"
        assert Notation("D", True).mm(76.2) == "76.2 mm"


@pytest.fixture(scope="module")
def both():
    cutters = [Cutter.parse("D0.5inL1in"), Cutter.parse("D0.125inL0.5in")]
    return {unit: plan(pocketed(), cutters=cutters, units=unit, **HOW) for unit in ("mm", "in")}


def told(result):
    """All that the terminal prints."""
    lines = []
    summary(result.plan, verbose=True, tells=lambda *texts: lines.extend(str(each) for each in texts))
    return "\n".join(line for line in lines if not line.startswith("<rich"))


def test_no_millimetres_are_told_in_inches_and_none_the_other_way(both):
    inches, mm = told(both["in"]), told(both["mm"])
    assert INCHES.search(inches)
    assert not MM.search(inches), MM.search(inches)
    assert MM.search(mm)
    assert not INCHES.search(mm)
    assert " in²" in "\n".join(both["in"].plan.text.lines)


def test_numbers_of_files_stay_the_same(both):
    one, other = (json.loads(each.plan.model_dump_json()) for each in both.values())
    assert one["effective"].pop("units") == "mm"
    assert other["effective"].pop("units") == "in"
    for words in ("text", "notes", "run"):
        one.pop(words), other.pop(words)
    assert without_texts(one) == without_texts(other)


def without_texts(value):
    if isinstance(value, dict):
        return {key: without_texts(each) for key, each in value.items()}
    if isinstance(value, list):
        return [without_texts(each) for each in value]
    return "" if isinstance(value, str) else value
