"""An option that is repeated: lists add up, of others the last value counts; no value is dropped without a word."""

import click
import pytest

from plan_cutters.command import entry
from plan_cutters.command.request import PlanRequest
from plan_cutters.command.validation import Faces, Words, options_of
from plan_cutters.errors import OptionError

#: What each command needs.
NEEDED = {"map": {"--at": "0,0,0", "--cutter": "R6L80"}, "batch": {"--out": "o"}}


def parsed(command, *words):
    with entry.module_of(f"plan-cutters {command}").command.make_context(command, list(words)) as context:
        return context.params


def options():
    for name in entry.commands():
        for each in entry.module_of(f"plan-cutters {name}").command.params:
            if isinstance(each, click.Option) and not each.is_flag and not each.multiple:
                yield pytest.param(name, each, id=f"{name} {each.opts[-1]}")


def two_values(kind):
    if isinstance(kind, click.Choice):
        return kind.choices[:2]
    if isinstance(kind, click.types.IntParamType | click.types.FloatParamType):
        least = int(getattr(kind, "min", None) or 3)
        return str(least + 1), str(least + 2)
    return {"MIN:MAX": ("0:10", "0:20"), "AXIS|FILE": ("+x", "+y"), "SELECT": ("F1", "F2")}.get(kind.name, ("a", "b"))


@pytest.mark.parametrize(("command", "option"), list(options()))
def test_no_value_is_dropped_without_a_word(command, option, capsys):
    word, (one, other) = max(option.opts, key=len), two_values(option.type)
    others = [each for need, value in NEEDED.get(command, {}).items() if need != word for each in (need, value)]
    arguments = ["x.step"] * (2 if command == "diff" else 0 if command == "changed" else 1)
    start = [*arguments, *others] if command != "mcp" else others
    once = parsed(command, *start, word, one)[option.name]
    assert parsed(command, *start, word, one, word, one)[option.name] == once
    if isinstance(option.type, Words) and option.type.listed:
        assert parsed(command, *start, word, one, word, other)[option.name] == f"{one},{other}"
        return
    last = parsed(command, *start, word, other)[option.name]
    capsys.readouterr()
    assert parsed(command, *start, word, one, word, other)[option.name] == last
    assert capsys.readouterr().err == f"{word} {other} behind it takes the place of {one}\n"


def test_all_commands_have_such_options():
    assert {each.values[0] for each in options()} == {*entry.commands()} - {"check"}  # which hands its words on


def test_values_that_are_the_same_in_other_words_agree():
    assert parsed("plan", "x", "--tolerance", "0.01", "--tolerance", "1e-2")["tolerance"] == 0.01
    assert parsed("plan", "x", "--tilt", "0:60", "--tilt", "0.0:6e1")["tilt"] == (0.0, 60.0)


def test_a_short_name_is_the_same_option(capsys):
    assert parsed("plan", "x", "-o", "a", "--out", "b")["out"] == "b"
    assert capsys.readouterr().err == "--out b behind it takes the place of a\n"


def test_of_more_than_two_values_each_that_is_dropped_is_named_once(capsys):
    assert (
        parsed("plan", "x", "--tolerance", "0.1", "--tolerance", "0.2", "--tolerance", "1e-1", "--tolerance", "0.01")["tolerance"]
        == 0.01
    )
    assert capsys.readouterr().err == "--tolerance 0.01 behind it takes the place of 1e-1 and 0.2\n"


Z, Y = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)


@pytest.mark.parametrize(
    ("typed", "setups"),
    [
        (["+z", "0,0,1", "0,1,0"], [Z, Y]),
        (["0,0,5", "0,1,0", "+z"], [(0.0, 0.0, 5.0), Y]),
        (["+z", "only:0,1,0"], [Y]),
        (["only:+y"], [Y]),
        (["only:+y", "+z", "+y"], [Y, Z]),
        (["auto", "only:+y", "+z"], [Y, Z]),
        (["auto", "+y", "+y"], [Y]),
    ],
)
def test_setups_behind_others_are_as_advice_means_them(typed, setups):
    assert [*parsed("plan", "x", *(word for each in typed for word in ("--setup", each)))["setup"]] == setups


@pytest.mark.parametrize("typed", [["auto", "auto"], ["+z", "auto"]])
def test_auto_beside_others_is_a_contradiction(typed):
    params = parsed("plan", "x", "--cutter", "R6L80", *(word for each in typed for word in ("--setup", each)))
    with pytest.raises(OptionError, match="setup auto proposes all setups"):
        options_of(PlanRequest(**params))


@pytest.mark.parametrize("other", ["!2", "name:rim", "component:hub", "color:#ff0000"])
def test_a_selection_of_faces_that_is_no_list_stands_alone(other):
    """`!2,3` are other faces than all but 2, and 3; a name may hold a comma."""
    assert parsed("plan", "x", "--faces", "F1", "--faces", "blends,7-9")["faces"] == "F1,blends,7-9"
    for pair in ((other, "F1"), ("F1", other), ("all", "F1,F3"), ("F1", "all")):
        assert parsed("plan", "x", "--faces", pair[0], "--faces", pair[1])["faces"] == pair[1]
    assert parsed("plan", "x", "--ignore", "F1", "--ignore", other)["ignore"] == ("F1", other)
    assert Faces().added(["", "blends"]) == "blends"
    assert parsed("plan", "x", "--faces", "F1,F2", "--faces", "only:F2")["faces"] == "F2"
    assert parsed("plan", "x", "--faces", "only:F2", "--units", "mm")["faces"] == "F2"


def test_a_shell_that_asks_for_words_is_answered_all_the_same():
    command = entry.module_of("plan-cutters").command
    with command.make_context("plan", ["x", "--holder", "a", "--holder", "b"], resilient_parsing=True) as context:
        assert context.params["holder"] == "b"
