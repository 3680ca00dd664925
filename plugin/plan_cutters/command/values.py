"""Read the values of options without the CAD kernel, and tell the shell which words it may offer for each."""

import os
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import click
from click.shell_completion import CompletionItem

from plan_cutters.command.taken_out import instead

#: Where the context of a command says that setups are named behind `auto`.
_NAMED = "plan_cutters.named_setups"
#: The same as a type of click: completed by the shell itself, which knows about `~` and blanks.
FILE, _FOLDER = CompletionItem("", type="file"), CompletionItem("", type="dir")


class Words(click.ParamType):
    """A text for which a shell offers words, and files where none of them fits.

    Parameters
    ----------
    name : str
        What help calls it.
    offered : callable
        The words; asked only when a shell asks.
    files : bool
        Whether a file may be given, too.
    listed : bool
        Whether it is a list of words, parted by commas.
    """

    def __init__(
        self, name: str, offered: Callable[[], Iterable[str]] = tuple, *, files: bool = False, listed: bool = False
    ) -> None:
        self.name, self.offered, self.files, self.listed = name, offered, files, listed

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        for each in str(value).split(",") if self.listed else ():
            if param is not None and (gone := instead(f"{param.opts[-1]} {each.strip().lower()}")):
                raise click.UsageError(gone, ctx)
        return str(value)

    def added(self, values: Sequence[str]) -> str | None:
        """One value for all of an option that is repeated; None where they do not add up."""
        return ",".join(filter(None, values)) if self.listed else None

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        before, comma, last = incomplete.rpartition(",") if self.listed else ("", "", incomplete)
        words = before.split(",")
        items = [
            CompletionItem(f"{before}{comma}{word}") for word in self.offered() if word.startswith(last) and word not in words
        ]
        return items or ([FILE] if self.files else [])


class Faces(Words):
    """A selection of faces: lists of numbers and kinds add up; a name, a component, a colour or a `!` stands alone."""

    def __init__(self) -> None:
        super().__init__("SELECT", face_words, listed=True)

    def added(self, values: Sequence[str]) -> str | None:
        return None if any(":" in value or "!" in value for value in values) else super().added(values)


class File(Words):
    """A path, completed as a file."""

    def __init__(self, name: str) -> None:
        super().__init__(name, files=True)


class Folder(Words):
    """A path, completed as a folder."""

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        return [_FOLDER]


class Plans(click.Choice[str]):
    """Plans of operations by name; `all` are both, as other options have an `all`."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        return super().convert("both" if value == "all" else value, param, ctx)


class Range(click.ParamType):
    """Two numbers of degrees, MIN:MAX."""

    name = "MIN:MAX"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, float]:
        try:
            low, high = (float(part) for part in value.split(":"))
        except ValueError:
            self.fail(f"{value!r} is not of the form MIN:MAX in degrees, as 0:60", param, ctx)
        return low, high


def named_setups(ctx: click.Context, _: click.Parameter, value: Any) -> Any:
    """Let setups that are named behind `auto` take its place, as an option of advice that is typed behind the command does."""
    if not isinstance(value, tuple) or value[:1] != ("auto",) or len(value) < 2 or "auto" in value[1:]:
        return value
    from plan_cutters_base.workers.assignment import is_child

    named = value[1:]
    ctx.meta[_NAMED] = named
    if "fixture" in ctx.params:
        ctx.params["fixture"] = fixtures_of_setups(ctx, _, ctx.params["fixture"])
    # The command reads its words twice: the child that does the work need not say it again.
    if not (is_child() or ctx.resilient_parsing):
        click.echo(f"--setup auto: {len(named)} named behind it take its place; nothing is proposed", err=True)
    return named


def fixtures_of_setups(ctx: click.Context, _: click.Parameter, value: Any) -> Any:
    """Leave out what proposed setups were to be held by, where others are named behind `auto` that say it themselves.

    They say it by their files, or by a fixture behind the first one: beside `auto` there is one at most.
    """
    named = ctx.meta.get(_NAMED)
    if named is None or not value:
        return value
    from plan_cutters.domain.fixture import TABLE, Fixture
    from plan_cutters.errors import PlanError
    from plan_cutters.setups.files import read_setup
    from plan_cutters_base.workers.assignment import is_child

    try:
        first = Fixture.parse(value[0])
        stated = len(value) > 1 or all(isinstance(each, str) and read_setup(each).fixtures for each in named)
    except PlanError:
        return value
    if not stated or not (first.to_place or value[0].strip().lower() == TABLE):
        return value
    if not (is_child() or ctx.resilient_parsing):
        click.echo(f"--setup auto: the setups behind it say what holds the part; --fixture {value[0]} is left out", err=True)
    return value[1:]


class Setup(click.ParamType):
    """A direction, as +z or x,y,z, or a setup file."""

    name = "AXIS|FILE"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...] | str:
        from plan_cutters.domain.posture import along

        if (named := along(value)) is not None:
            return named
        if value.strip().lower() == "auto" and param is not None and param.multiple:
            return "auto"
        try:
            x, y, z = (float(part) for part in value.split(","))
        except ValueError:
            if value.lower().endswith(".toml") or os.path.isfile(value):
                return str(value)
            self.fail(f"{value!r} is no direction, as +z, -y or 0,0,1 (x,y,z), a setup file, or auto", param, ctx)
        return x, y, z

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        items = [CompletionItem(f"{sign}{axis}") for axis in "xyz" for sign in "+-"] + [CompletionItem("auto")]
        return [each for each in items if each.value.startswith(incomplete)] or [FILE]


def machine_names() -> Sequence[str]:
    from plan_cutters.domain.machine import builtin_machines

    return ["unlimited", "tilt:", *builtin_machines()]


def cutter_ids() -> Sequence[str]:
    from plan_cutters.domain.default_tools import builtin

    return [cutter.id for cutter in builtin()]


def holder_words() -> Sequence[str]:
    from plan_cutters.domain.standard_holders import words

    return [*words(), "none"]


def answers() -> Sequence[str]:
    from plan_cutters.domain.answer_kinds import ANSWERS

    return [*ANSWERS, "all"]


def face_words() -> Sequence[str]:
    return ("sculptured", "blends", "all", "component:", "name:", "color:#")
