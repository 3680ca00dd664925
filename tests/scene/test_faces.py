"""Which faces words select, and what each error says of words that select none."""

import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.TopLoc import TopLoc_Location

from cad_io import read_part
from cad_io.arrays import FaceInfo
from cad_io.kernel.shapes import Node
from plan_cutters.errors import OptionError
from plan_cutters.scene.faces import choose, face_numbers, grammar, ignored_faces, ignored_words, select_faces
from tests.support.cad_parts import box

NOWHERE = TopLoc_Location()
RIM, HUB = Node("ring", "rim", NOWHERE, faces=(1, 2)), Node("hub", "hub", NOWHERE, faces=(3,))
SPARE = Node("wheel", "spare", NOWHERE, children=(Node("ring", "rim", NOWHERE, faces=(4,)),))
CAR = Node("car", "", NOWHERE, children=(Node("wheel", "left", NOWHERE, children=(RIM, HUB)), SPARE))
TREE = (CAR, Node("rim", "", NOWHERE, faces=(5,)))
FACES = tuple(FaceInfo(i, f"n{i}", "plane", "plane", 1.0) for i in range(1, 7))


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("F2", (2,)),
        ("f2-F4", (2, 3, 4)),
        ("2 - 3, F6", (2, 3, 6)),
        ("007", None),
        ("!2-3", (1, 4, 5, 6)),
        ("!F2-F3,6", (1, 4, 5)),
        ("!name:[12]$", (3, 4, 5, 6)),
        ("!sculptured", (1, 2, 3, 4, 5, 6)),
        ("component:car/left/rim", (1, 2)),
        ("component:left/rim", (1, 2)),
        ("component:left", (1, 2, 3)),
        ("component:car", (1, 2, 3, 4)),
        ("component:wheel", (1, 2, 3, 4)),  # the product of both instances
        ("component:ring", (1, 2, 4)),
        ("component:rim", (5,)),  # an exact path counts alone
        ("!component:car", (5, 6)),
    ],
)
def test_the_words_for_faces(text, numbers):
    if numbers is None:
        with pytest.raises(OptionError, match="no face F7"):
            select_faces(FACES, text, tree=TREE)
    else:
        assert select_faces(FACES, text, tree=TREE) == numbers


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("F0", "no face F0"),
        ("5-2", "backwards"),
        ("F7", "F1 to F6"),
        ("3,", "give sculptured"),
        ("F", "give sculptured"),
        ("!", "give sculptured"),
        ("!!3", "give sculptured"),
        ("!all", "selects no face"),
        ("!name:nobody", "selects no face"),  # mistyped, it would be everything
        ("component:", "no component"),
        ("component:im", "car/left/hub, car/left/rim, car/spare/rim, rim"),
        ("component:*", "no component"),
        ("name:(", "regular expression"),
        ("F1\nF2", "F1 F2"),
        ("x" * 5000, "xxx..."),
    ],
)
def test_words_for_faces_that_mean_nothing(text, cause):
    with pytest.raises(OptionError) as error:
        select_faces(FACES, text, tree=TREE)
    assert cause in str(error.value)
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 300


@pytest.mark.parametrize("text", ["1-9999999999", "!1-9999999999", f"F1-F{'9' * 5000}", f"{'9' * 5000}-1"])
def test_no_range_is_built_that_the_part_has_not(text):
    began = time.process_time()
    with pytest.raises(OptionError, match="no face F9"):
        select_faces(FACES, text)
    assert time.process_time() - began < 0.5


def test_components_without_names():
    with pytest.raises(OptionError, match="have no names"):
        select_faces(FACES, "component:hub", tree=(Node("", "", NOWHERE, faces=(1, 2, 3, 4, 5, 6)),))


def test_an_ignored_face_is_no_target():
    assert select_faces(FACES, "all", ignored=(2,)) == (1, 3, 4, 5, 6)
    assert select_faces(FACES, "sculptured", ignored=(2,)) == (1, 3, 4, 5, 6)
    assert select_faces(FACES, "component:left", tree=TREE, ignored=(2,)) == (1, 3)
    with pytest.raises(OptionError, match="F2 is ignored"):
        select_faces(FACES, "1-3", ignored=(2, 5))
    with pytest.raises(OptionError, match="leaves none"):
        select_faces(FACES, "name:n2", ignored=(2,))


KINDS = tuple(replace(each, shape="sculptured") if each.number in (2, 5) else each for each in FACES)


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("sculptured", (2, 5)),
        ("blends", (4,)),
        ("sculptured,blends", (2, 4, 5)),
        (" blends , sculptured ", (2, 4, 5)),
        ("blends,F1", (1, 4)),
        ("F1,sculptured,3-3", (1, 2, 3, 5)),
        ("all,F1", (1, 2, 3, 4, 5, 6)),
        ("!blends", (1, 2, 3, 5, 6)),
        ("! sculptured , 1", (3, 4, 6)),
        ("name:^n[56]$", (5, 6)),
        ("color:#ff8000", (3,)),
        ("colour:#FF8000", (3,)),
    ],
)
def test_kinds_names_and_colours_select_faces(text, numbers):
    faces = tuple(replace(each, colour=(1.0, 0.5, 0.0)) if each.number == 3 else each for each in KINDS)
    assert select_faces(faces, text, blends=(4,)) == numbers


def test_a_colour_counts_to_its_last_digit():
    for k in range(3):
        off = [1.0, 0.5, 0.0]
        off[k] = abs(off[k] - 1 / 255)
        faces = (replace(FACES[0], colour=tuple(off)), *FACES[1:])
        with pytest.raises(OptionError, match="color:#FF8000 selects no face of this part"):
            select_faces(faces, "color:#FF8000")


@given(st.lists(st.tuples(st.integers(1, 6), st.integers(0, 5)), min_size=1, max_size=5), st.booleans())
def test_a_list_selects_what_its_ranges_hold(ranges, rest):
    """And `!` all else: the same by sets."""
    ranges = [(first, min(6, first + more)) for first, more in ranges]
    held = {n for first, last in ranges for n in range(first, last + 1)}
    text = ",".join(f"F{first}-{last}" if last > first else f"{first}" for first, last in ranges)
    wanted = {1, 2, 3, 4, 5, 6} - held if rest else held
    if wanted:
        assert select_faces(FACES, "!" * rest + text) == tuple(sorted(wanted))
    else:
        with pytest.raises(OptionError, match="selects no face"):
            select_faces(FACES, "!" * rest + text)


def test_a_part_where_nothing_is_sculptured_is_all_to_finish():
    """What cannot be judged may have been sculptured: alone it hides no other."""
    torn = tuple(replace(each, unjudged="torn") if each.shape == "sculptured" else each for each in KINDS)
    for faces in (FACES, torn):
        assert select_faces(faces, "sculptured", ignored=(6,)) == (1, 2, 3, 4, 5)
        assert select_faces(faces, "sculptured,blends", blends=(4,)) == (1, 2, 3, 4, 5, 6)
        assert select_faces(faces, "blends", blends=(4,)) == (4,)
    # Nor does what is left out.
    assert select_faces(KINDS, "sculptured", ignored=(2, 5)) == (1, 3, 4, 6)
    assert select_faces(KINDS, "sculptured", ignored=(2,)) == (5,)


def test_a_face_that_is_repeated_stands_for_its_twins():
    assert select_faces(FACES, "4-5", ignored=(4,), repeated={4: 1}) == (1, 5)
    assert select_faces(FACES, "F4", ignored=(4,), repeated={4: 1}) == (1,)


#: Words that are no selection, whatever the part, and what is said of each.
SENSELESS = {
    "F0": "there is no face F0; they are numbered from 1",
    "0-3": "there is no face F0; they are numbered from 1",
    "5-2": "5-2 runs backwards",
    "F1,F9-F3": "F9-F3 runs backwards",
    "name:(": "not a regular expression (",
    "color:red": "give sculptured, blends, all, numbers",
    "F1;F2": "give sculptured, blends, all, numbers",
    "": "give sculptured, blends, all, numbers",
}


@pytest.mark.parametrize("text", SENSELESS)
def test_words_are_refused_before_a_part_is_read(text):
    with pytest.raises(OptionError) as error:
        grammar(text, "--ignore")
    assert str(error.value).startswith(f"--ignore {text}: ")
    assert SENSELESS[text] in str(error.value)


@pytest.mark.parametrize(
    "text",
    ["F1", "f7 - 12, 99", "all", "!sculptured,blends", "component:x", "! component:", "name:.*", "!name:[ab]", "color:#012aBf"],
)
def test_words_that_some_part_may_have_are_not(text):
    grammar(text, "--ignore")


def test_a_long_text_is_cut_in_errors_and_a_short_one_is_not():
    for text, shown in (("x" * 60, "x" * 60 + ": "), ("x" * 61, "x" * 60 + "...: "), ("a\n\tb", "a b: ")):
        with pytest.raises(OptionError) as error:
            grammar(text, "--faces")
        assert str(error.value).startswith(f"--faces {shown}give ")


@pytest.fixture(scope="module")
def block():
    return read_part(box())


def test_numbers_and_objects_of_a_part_are_words(block):
    assert ignored_words(block, None) == ()
    assert ignored_words(block, ["F1", "blends"]) == ("F1", "blends")
    assert ignored_words(block, "F1") == ("F1",)
    assert ignored_words(block, (5, 2, np.int64(2))) == ("F2,F5",)
    assert ignored_words(block, 3) == ("F3",)
    assert ignored_faces(block, ("F1-2", "!F2-6")) == {1, 2}
    assert ignored_faces(block, ()) == frozenset()
    for wrong in (True, [True, False], 1.5, b"F1", {1: 2}, [object()], [1, "F2"]):
        with pytest.raises(OptionError, match="--ignore"):
            ignored_words(block, wrong)
    # An error tells which option it is of.
    with pytest.raises(OptionError, match=r"^--ignore F7: there is no face F7; the part has F1 to F6$"):
        ignored_faces(block, ("F7",))


def test_a_name_of_a_face_is_that_face(block):
    named = SimpleNamespace(faces=tuple(replace(f, name="F2" if f.number in (4, 6) else "top") for f in block.faces), encoding="")
    named.tree, named.blends = (), frozenset()
    assert face_numbers(named, "top") == (1, 2, 3, 5)
    assert face_numbers(named, "F2") == (4, 6)
    assert face_numbers(named, "F3") == (3,)
    nameless = SimpleNamespace(faces=block.faces, encoding="", tree=(), blends=frozenset())
    with pytest.raises(OptionError):
        face_numbers(nameless, "")


def test_a_choice_says_what_it_left_out(block):
    """Targets, what is ignored, and whether any of them is sculptured where they were not asked for by number."""
    chosen = choose(block, None, frozenset({2}), ("F2",))
    assert (chosen.targets, chosen.ignored, chosen.ignore) == ((1, 3, 4, 5, 6), (2,), ("F2",))
    assert (chosen.unshaped, chosen.clamped) == (True, ())
    assert chosen.free_form == 0.0
    alone = choose(block, "F4", frozenset(), ())
    assert (alone.targets, alone.asked, alone.unshaped) == ((4,), "F4", False)
