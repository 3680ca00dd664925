"""Our own format: what is written is read as the same cutters; what is missing or wrong is said by its field."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, Holder, LibraryError, Segment
from plan_cutters.domain.standard_tools import builtin
from plan_cutters.library import read_library, to_toml
from plan_cutters.library.read import listing
from tests.support.tool_files import fusion, write_json
from tests.support.tool_reference import random_cutter

KINDS = ["flat", "bull", "ball", "taper ball", "taper bull", "taper flat", "dovetail", "dovetail bull", "lollipop", "barrel",
         "oval", "lens", "form", "form re-entrant"]  # fmt: skip


def read(tmp_path, text, **more):
    path = tmp_path / "a.toml"
    path.write_text(text, encoding="utf-8")
    return read_library(path, **more)


@given(st.sampled_from(KINDS), st.integers(0, 2**32 - 1), st.text(max_size=20))
@settings(max_examples=150, deadline=None)
def test_what_is_written_is_read_bit_for_bit(tmp_path_factory, kind, seed, name):
    from dataclasses import replace

    cutter = random_cutter(np.random.default_rng(seed), kind)
    (again,) = read(tmp_path_factory.mktemp("toml"), to_toml([replace(cutter, name=name)]))
    assert again.id == cutter.id
    assert replace(again, name="") == replace(cutter, name="")


def test_a_neck_of_several_sections_and_a_lollipop_on_a_shank(tmp_path):
    steps = Cutter.parse("R3L60F12N2.5x4N2.5:4x6S4")
    ball = Cutter.lollipop(
        radius=3, neck_radius=1.5, length=40, neck=(Segment(1.5, 10), Segment(2, 40 - 10 - 3 - math.sqrt(6.75)))
    )
    made = [steps, ball, *builtin()]
    assert list(read(tmp_path, to_toml(made))) == made


@given(st.floats(1e-6, 1.3))
@settings(max_examples=200, deadline=None)
def test_every_angle_survives(tmp_path_factory, taper):
    cutter = Cutter.flat(radius=3, length=20, taper=taper, flutes=10.0, shank_radius=2.0)
    (again,) = read(tmp_path_factory.mktemp("angle"), to_toml([cutter]))
    assert again.taper == taper


def test_a_library_is_converted_with_its_numbers_and_what_was_not_used(tmp_path):
    tools = [fusion(number=1), fusion(number=9, name='a "second" name\\'), fusion("probe", number=3), fusion("drill", number=4)]
    library = read_library(write_json(tmp_path / "a.json", tools))
    text = to_toml(library)
    again = read(tmp_path, text)
    assert list(again) == list(library)
    assert again.numbers(again[0]) == (1, 9)
    assert again.names(again[0]) == ("a tool", 'a "second" name\\')
    assert '# Not used: tool 3 (line' in text  # fmt: skip
    assert library.drills
    assert again.drills == library.drills


TOOL = """
[[tool]]
type = "flat"
DC = 12
LCF = 20
LPR = 80
DMM = 12
holder = "R12:15L20+R15L30"
"""
MM = 'unit = "mm"\n'


def test_a_tool_by_hand(tmp_path):
    assert [cutter.id for cutter in read(tmp_path, MM + TOOL)] == ["R6L80F20S6HR12:15L20+R15L30"]


@pytest.mark.parametrize("unit", ["in", "inch", "inches"])
def test_units_are_of_the_file_or_of_the_tool(tmp_path, unit):
    inch = TOOL.replace("12", "0.5", 2).replace("20", "1", 1).replace("80", "2", 1).replace('"R12', '"R12', 1)  # fmt: skip
    inch = inch.replace("DMM = 12", "DMM = 0.5").replace('[[tool]]', f'[[tool]]\nunit = "{unit}"')  # fmt: skip
    library = read(tmp_path, MM + inch + TOOL)
    assert [cutter.id for cutter in library] == ["R6.35L50.8F25.4S6.35HR12:15L20+R15L30", "R6L80F20S6HR12:15L20+R15L30"]
    assert [entry.unit for entry in library.entries] == ["inch", "mm"]


def test_holders_in_every_form_are_the_same(tmp_path):
    forms = ['"R12:15L20+R15L30"', "[[0, 12], [20, 15], [50, 15]]", "{ points = [[0, 12], [20, 15], [50, 15]] }",
             "{ stages = [[12, 20, 15], [15, 30]] }", '"shop"']  # fmt: skip
    named = '\n[[holder]]\nname = "shop"\npoints = [[0, 12], [20, 15], [50, 15]]\n'
    text = MM + named + "".join(TOOL.replace('"R12:15L20+R15L30"', form) for form in forms)
    library = read(tmp_path, text)
    assert [cutter.id for cutter in library] == ["R6L80F20S6HR12:15L20+R15L30"]
    assert len(library.entries) == 5
    assert library.holders == (Holder((Segment(12, 20, 15), Segment(15, 30)), "shop"),)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("LPR = 80", "", "LPR is missing"),
        ("LPR = 80", "LPR = 0", "LPR is missing"),
        ("LCF = 20", "", "LCF is missing"),
        ("DC = 12", "", "DC is missing"),
        ("DMM = 12", "", "DMM is missing"),
        ('holder = "R12:15L20+R15L30"', "", "holder is missing"),
        ('type = "flat"', 'type = "lollipop"', "the flutes of a lollipop end"),
        ("DMM = 12", "DMM = 12\nLN = 5", "DN is missing"),
    ],
)
def test_what_is_missing_is_asked_for(tmp_path, old, new, said):
    with pytest.raises(LibraryError) as error:
        read(tmp_path, MM + TOOL.replace(old, new))
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("DC = 12", 'DC = "12"', "DC is"),
        ("DC = 12", "DC = true", "DC is"),
        ("DC = 12", "DC = nan", "DC is nan"),
        ("DC = 12", "DC = inf", "DC is inf"),
        ("DC = 12", "DC = -12", "DC is -12"),
        ("DC = 12", "DC = 1e9", "no tool is longer"),
        ("DC = 12", "DC = 12\nDX = 3", "DX is unknown"),
        ("DC = 12", "DC = 12\n-1 = 3", "-1 is unknown"),
        ("DC = 12", "DC = 12\nnumber = 1.5", "number is 1.5"),
        ("DC = 12", 'DC = 12\nnumber = ""', "number is"),
        ("DC = 12", 'DC = 12\nnumber = "3"', "number is 3"),
        ("DC = 12", "DC = 12\nnumber = -1", "number is -1, which is no tool number"),
        ("DC = 12", 'DC = 12\nTA = ""', "TA is"),
        ("DC = 12", "DC = 12\nTA = -5", "TA is -5: a half angle lies between"),
        ("DC = 12", 'DC = 12\nunit = "ell"', "unit is 'ell'"),
        ("LPR = 80", "LPR = 80\nOAL = 60", "LPR 80 is more than OAL 60"),
        ("LCF = 20", "LCF = 90", "shorter than its flutes"),
        ("LCF = 20", "LCF = 20\nRE = 7", "corner radius 7"),
        ("LCF = 20", 'LCF = 20\nTA = "steep"', "TA is steep"),
        ('type = "flat"', 'type = "spoon"', "type is spoon"),
        ('type = "flat"', "", "type is missing"),
        ('"R12:15L20+R15L30"', '"mine"', "neither none"),
        ('"R12:15L20+R15L30"', "[[1, 12], [20, 15]]", "begin at its nose"),
        ('"R12:15L20+R15L30"', "[[0, 12], [20, 15], [10, 15]]", "must rise"),
        ('"R12:15L20+R15L30"', '"R5L30"', "narrower"),
        ('"R12:15L20+R15L30"', "[[0, 12], [nan, 15]]", "holder 2 1 is nan"),
        ('"R12:15L20+R15L30"', "{ points = [[0, 12], [9, true]] }", "holder points 2 2 is True"),
        ('"R12:15L20+R15L30"', "3", "holder is 3"),
        ('"R12:15L20+R15L30"', "{ points = [[0, 12], [9, 12]], stages = [[12, 9]] }", "not both"),
        ("DMM = 12", "DMM = 12\nLN = 5\nDN = 9\nneck = [[4, 5]]", "give one of them"),
    ],
)
def test_what_is_wrong_is_said_by_its_field(tmp_path, old, new, said):
    text = MM + TOOL + TOOL.replace(old, new)
    with pytest.raises(LibraryError) as error:
        read(tmp_path, text)
    found = str(error.value)
    assert said in found.replace("'", "") or said in found
    line = text[: text.rindex("[[tool]]")].count("\n") + 1
    assert f"tool 2 (line {line})" in found
    assert "\n" not in found
    assert len(read(tmp_path, text, skip_bad=True)) == 1


def test_a_unit_is_never_guessed(tmp_path):
    with pytest.raises(LibraryError, match="unit is missing"):
        read(tmp_path, TOOL)


@pytest.mark.parametrize(
    ("text", "said"), [("[tool]\nDC = 3\n", "two brackets"), ("colour = 3\n[[tool]]\n", "'?colour'? is unknown")]
)
def test_tables_that_have_no_place(tmp_path, text, said):
    with pytest.raises(LibraryError, match=said):
        read(tmp_path, text)


def test_a_broken_holder_is_named(tmp_path):
    text = MM + '[[holder]]\nname = "a"\npoints = [[0, -3], [5, 5]]\n' + TOOL
    with pytest.raises(LibraryError, match="holder 1"):
        read(tmp_path, text)
    assert len(read(tmp_path, text, skip_bad=True)) == 1


def test_assumptions(tmp_path):
    bare = MM + TOOL.replace("LPR = 80\n", "OAL = 100\n").replace('holder = "R12:15L20+R15L30"\n', "")
    library = read(tmp_path, bare, assume_stickout=60, holder="R15L30")
    assert [cutter.id for cutter in library] == ["R6L60F20S6HR15L30"]
    assert len(library.entries[0].notes) == 2
    (entry,) = listing(tmp_path / "a.toml", assume_stickout=120, holder="none").entries
    assert "longer than the tool" in entry.unused


@pytest.mark.parametrize(
    ("text", "cutter"),
    [
        ('type = "ball"\nDC = 6\nLCF = 10\nLPR = 40\nDMM = 6', "R3L40rc3F10S3"),
        ('type = "taper"\nDC = 4\nRE = 2\nTA = 5\nLCF = 20\nLPR = 40\nDMM = 8', "R2L40rc2T5F20S4"),
        ('type = "dovetail"\nDC = 12\nTA = 10\nLCF = 8\nLPR = 40\nDMM = 6', "R6L40T-10F8S3"),
        ('type = "flat"\nDC = 12\nLCF = 8\nLPR = 40\nDMM = 12\nDN = 10\nLN = 20', "R6L40F8N5x20S6"),
        ('type = "lollipop"\nDC = 10\nDN = 6\nLPR = 40', "R5L40rc5lollipopS3"),
        ('type = "lollipop"\nDC = 10\nDN = 6\nLN = 11\nDMM = 8\nLPR = 40', "R5L40rc5lollipopN3x11N4x20S3"),
        ('type = "barrel"\nDC = 12\nPRFRAD = 85\nprofile_height = 9\nLCF = 18\nLPR = 60\nDMM = "same"',
         "R6L60barrel85at9F18"),
        ('type = "lens"\nDC = 12\nRE = 1\nPRFRAD = 30\nLCF = 12\nLPR = 60\nDMM = 12', "R6L60rc1lens30F12S6"),
        ('type = "form"\noutline = [[0, 0], [0, 2], [5, 6], [9, 6]]\nLPR = 60\nDMM = 12',
         "R6L60form_0x0_2x0_6x5_6x9S6"),
    ],
)  # fmt: skip
def test_every_shape_by_hand(tmp_path, text, cutter):
    assert [each.id for each in read(tmp_path, f'{MM}[[tool]]\n{text}\nholder = "none"\n')] == [cutter]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('type = "flat"', 'type = "taper"', "TA is missing"),
        ('type = "flat"', 'type = "dovetail"', "TA is missing"),
        ('type = "flat"', 'type = "taper"\nTA = -5', "half angle lies between"),
        ("DMM = 12", "DMM = 12\nDN = 9", "LN is missing"),
        ("DMM = 12", "DMM = 12\nDN = 9\nneck = [[4, 5]]", "neck and DN"),
        ("DC = 12", "DC = 0x" + "f" * 9000, "DC is a number of thousands of digits"),
        ("DC = 12", "DC = 12\nnumber = 0x" + "f" * 9000, "number is a number of thousands of digits"),
        ("DC = 12", "dc = 12", "DC is written so"),
        ("DC = 12", "DC = 12\nSFDM = 12", "'SFDM' is unknown here; DMM says that"),
        ('"R12:15L20+R15L30"', '""', "neither none"),
    ],
)
def test_what_was_silent_is_said(tmp_path, old, new, said):
    assert old in TOOL
    (tmp_path / "a.toml").write_text(MM + TOOL.replace(old, new), encoding="utf-8")
    (entry,) = listing(tmp_path / "a.toml", skip_bad=True).entries
    assert entry.cutter is None
    assert said in entry.unused


def test_two_holders_of_one_name_are_not_chosen_from(tmp_path):
    rows = [f'[[holder]]\nname = "a"\npoints = [[0, {r}], [9, {r}]]\n' for r in (20, 30)]
    path = tmp_path / "a.toml"
    for listed in (rows[:1], rows[:1] * 2):
        path.write_text(MM + TOOL.replace('"R12:15L20+R15L30"', '"a"') + "".join(listed), encoding="utf-8")
        assert read_library(path)[0].holder.id == "R20L9"
    path.write_text(MM + TOOL.replace('"R12:15L20+R15L30"', '"a"') + "".join([*rows, rows[0]]), encoding="utf-8")
    with pytest.raises(LibraryError, match="several different"):
        read_library(path)
    # A tool that does not ask for it does not mind.
    path.write_text(MM + TOOL + "".join(rows), encoding="utf-8")
    again = read(tmp_path, to_toml(read_library(path)))
    assert [holder.id for holder in again.holders] == ["R20L9", "R30L9"]


def test_a_holder_that_is_called_none_is_no_reason_to_judge_without(tmp_path):
    holder = '[[holder]]\nname = "none"\npoints = [[0, 20], [9, 20]]\n'
    with pytest.raises(LibraryError, match="rename it"):
        read(tmp_path, MM + TOOL.replace('"R12:15L20+R15L30"', '"none"') + holder)
    (cutter,) = read(tmp_path, to_toml(read(tmp_path, MM + TOOL + holder)))
    assert cutter.holder.id == "R12:15L20+R15L30"


@pytest.mark.parametrize(
    "change",
    [{}, {"LB": None}, {"DC": 0}, {"LCF": None}, {"SFDM": None}, {"OAL": 30}, {"LB": None, "OAL": 20}, {"RE": 1}, {"RE": 3},
     {"DC": None, "LB": None}, {"LB": -4}, {"kind": "ball"}, {"kind": "ball", "RE": 1}, {"kind": "bull"},
     {"kind": "dovetail"}, {"kind": "lollipop", "LCF": 5}],
)  # fmt: skip
@pytest.mark.parametrize("asked", [{}, {"holder": "none"}, {"holder": "R15L30", "assume_stickout": 25}])
def test_a_tool_is_judged_in_the_words_of_all_formats(tmp_path, change, asked):
    """The same lack, contradiction or note as of a Fusion tool, but for what the file calls its dimensions."""
    kinds = {"flat": "flat end mill", "ball": "ball end mill", "bull": "bull nose end mill", "dovetail": "dovetail mill",
             "lollipop": "lollipop mill"}  # fmt: skip
    kind, dimensions = change.get("kind", "flat"), {"LB": 40, "DC": 6, "LCF": 12, "SFDM": 8, "OAL": 60}
    dimensions |= {key: value for key, value in change.items() if key != "kind"}
    bare = {"shoulder_length": None, "shoulder_diameter": None, "shaft": None, "holder": None}
    tools = write_json(tmp_path / "a.json", [fusion(kinds[kind], **bare, **dimensions)])
    words = {"LB": "LPR", "SFDM": "DMM"}
    own = {words.get(key, key): value for key, value in dimensions.items()}
    if kind == "lollipop":
        own.pop("LCF")
    lines = [f"{key} = {value}" for key, value in own.items() if value is not None]
    (tmp_path / "a.toml").write_text(f'{MM}[[tool]]\ntype = "{kind}"\n' + "\n".join(lines), encoding="utf-8")
    theirs, ours = (listing(path, skip_bad=True, **asked).entries[0] for path in (tools, tmp_path / "a.toml"))

    def said(text):
        for word, own_word in {**words, "shoulder-diameter": "DN", kinds[kind]: kind}.items():
            text = text.replace(word, own_word)
        return text

    assert (ours.unused, ours.broken) == (theirs.unused and said(theirs.unused), theirs.broken)
    assert ours.notes == tuple(said(note) for note in theirs.notes)
