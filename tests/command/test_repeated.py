"""An option that is repeated: lists add up, other values must agree; no value is dropped without a word."""

import click
import pytest

from plan_cutters.command import entry
from plan_cutters.command.validation import Faces, Words

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
def test_no_value_is_dropped(command, option):
    word, (one, other) = max(option.opts, key=len), two_values(option.type)
    others = [each for need, value in NEEDED.get(command, {}).items() if need != word for each in (need, value)]
    arguments = ["x.step"] * (2 if command == "diff" else 0 if command == "changed" else 1)
    start = [*arguments, *others] if command != "mcp" else others
    once = parsed(command, *start, word, one)[option.name]
    assert parsed(command, *start, word, one, word, one)[option.name] == once
    if isinstance(option.type, Words) and option.type.listed:
        assert parsed(command, *start, word, one, word, other)[option.name] == f"{one},{other}"
        return
    with pytest.raises(click.UsageError) as caught:
        parsed(command, *start, word, one, word, other)
    said = caught.value.format_message()
    assert said.startswith(word)
    assert f"{one} and {other}" in said
    assert "\n" not in said


def test_all_commands_have_such_options():
    assert {each.values[0] for each in options()} == {*entry.commands()} - {"check"}  # which hands its words on


def test_values_that_are_the_same_in_other_words_agree():
    assert parsed("plan", "x", "--tolerance", "0.01", "--tolerance", "1e-2")["tolerance"] == 0.01
    assert parsed("plan", "x", "--tilt", "0:60", "--tilt", "0.0:6e1")["tilt"] == (0.0, 60.0)


def test_a_short_name_is_the_same_option():
    with pytest.raises(click.UsageError, match="--out has one value, not a and b"):
        parsed("plan", "x", "-o", "a", "--out", "b")


@pytest.mark.parametrize("other", ["!2", "name:rim", "component:hub", "color:#ff0000"])
def test_a_selection_of_faces_that_is_no_list_stands_alone(other):
    """`!2,3` are other faces than all but 2, and 3; a name may hold a comma."""
    assert parsed("plan", "x", "--faces", "F1", "--faces", "blends,7-9")["faces"] == "F1,blends,7-9"
    for pair in ((other, "F1"), ("F1", other)):
        with pytest.raises(click.UsageError, match="--faces has one value"):
            parsed("plan", "x", "--faces", pair[0], "--faces", pair[1])
    assert parsed("plan", "x", "--ignore", "F1", "--ignore", other)["ignore"] == ("F1", other)
    assert Faces().added(["", "all"]) == "all"


def test_a_shell_that_asks_for_words_is_answered_all_the_same():
    command = entry.module_of("plan-cutters").command
    with command.make_context("plan", ["x", "--holder", "a", "--holder", "b"], resilient_parsing=True) as context:
        assert context.params["holder"] == "b"
