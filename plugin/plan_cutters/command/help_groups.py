"""Help in groups: options that belong together under one heading, and examples at the end.

Where all of it is long, `--help` has what most people need, a line for each, and `--help-all` has the rest.
"""

import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import click

from plan_cutters import __version__
from plan_cutters.command.values import Words

#: Width of the column of names; what is longer has a line of its own.
_NAMES = 22
#: Widest that help is set.
WIDEST = 100
#: Lines that `--help` has, at most, and its examples where it leaves something out.
MOST_LINES, _EXAMPLES = 90, 3
#: Where a context says that all of the help is wanted.
_ALL = "plan_cutters.help_all"


class Grouped(click.Option):
    """An option under a heading of the help. Lists that are repeated add up; any other option has one value.

    `brief` is its line in a short help, which leaves out options that have none; True: the same as in the whole one.
    """

    def __init__(self, *words: Any, group: str = "", brief: str | bool = False, **more: Any) -> None:
        super().__init__(*words, **more)
        self.group, self.brief = group, brief

    def add_to_parser(self, parser: Any, ctx: click.Context) -> None:
        if self.multiple or self.is_flag or self.count:
            super().add_to_parser(parser, ctx)
        else:
            parser.add_option(obj=self, opts=self.opts, dest=self.name, action="append", nargs=self.nargs)

    def consume_value(self, ctx: click.Context, opts: Mapping[str, Any]) -> Any:
        if not self.multiple and isinstance(values := opts.get(self.name or ""), list):
            opts = {**opts, self.name or "": self._one(values, ctx)}
        return super().consume_value(ctx, opts)

    def _one(self, values: list[str], ctx: click.Context) -> str:
        """The value that repeated ones make; a usage error where they contradict each other."""
        if ctx.resilient_parsing or all(value == values[0] for value in values):
            return values[-1]
        added = self.type.added(values) if isinstance(self.type, Words) else None
        if added is None and len({self.type_cast_value(ctx, value) for value in values}) > 1:
            several = " and ".join(dict.fromkeys(values))
            raise click.UsageError(f"{max(self.opts, key=len)} has one value, not {several}: give one of them", ctx)
        return values[-1] if added is None else added


def heading(title: str) -> Any:
    """Make a decorator that declares options under a heading: `click.option` with a group."""

    def option(*words: str, **more: Any) -> Any:
        return click.option(*words, cls=Grouped, group=title, **more)

    return option


class Command(click.Command):
    """A command whose help has headings in the order in which they are declared, then examples and exit codes.

    Parameters
    ----------
    subcommands : callable
        What help lists first, asked when it is shown: other commands, and what they answer, each as (str, str).
    examples : sequence of (str, str)
        A command line, and what it does.
    codes : sequence of (str, str)
        Exit codes, and what they mean.
    """

    def __init__(
        self,
        *words: Any,
        subcommands: Callable[[], Sequence[tuple[str, str]]] = tuple,
        examples: Sequence[tuple[str, str]] = (),
        codes: Sequence[tuple[str, str]] = (),
        **more: Any,
    ) -> None:
        more["context_settings"] = {"help_option_names": ["-h", "--help"]}
        super().__init__(*words, **more)
        click.version_option(__version__, prog_name="plan-cutters")(self)
        click.option("--help-all", is_flag=True, is_eager=True, expose_value=False, callback=_help_all,
                     help="Show all options, and exit.")(self)  # fmt: skip
        self.subcommands, self.examples, self.codes = subcommands, examples, codes

    def make_context(self, *words: Any, **more: Any) -> click.Context:
        # 80 columns where the output is no terminal.
        settings = {"terminal_width": min(WIDEST, shutil.get_terminal_size().columns) - 1, "color": colour()}
        return super().make_context(*words, **{**settings, **more})

    def get_help(self, ctx: click.Context) -> str:
        wanted = ctx.meta.get(_ALL, False)
        ctx.meta[_ALL] = True
        whole = super().get_help(ctx)
        if wanted or whole.count("\n") < MOST_LINES:
            return whole
        ctx.meta[_ALL] = False
        return super().get_help(ctx)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        groups = {"Commands": [(name.ljust(_NAMES), what) for name, what in listed]} if (listed := self.subcommands()) else {}
        title = "Options"
        for param in self.get_params(ctx):
            record, title = param.get_help_record(ctx), getattr(param, "group", title)
            brief = True if ctx.meta.get(_ALL) else getattr(param, "brief", True)
            if record is not None and brief and not isinstance(param, click.Argument):
                # As wide as all others, so that the text begins in one column throughout.
                groups.setdefault(title, []).append((record[0].ljust(_NAMES), record[1] if brief is True else brief))
        for title, records in groups.items():
            with formatter.section(_bold(title)):
                formatter.write_dl(records, col_max=_NAMES)

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        whole = ctx.meta.get(_ALL)
        if self.examples:
            with formatter.section(_bold("Examples")):
                for line, what in self.examples[: None if whole else _EXAMPLES]:
                    formatter.write_text(what)
                    formatter.write(f"{'':{formatter.current_indent + 2}}{click.style(line, fg='cyan')}\n")
        if not whole:
            formatter.write_paragraph()
            formatter.write_text("--help-all has all options with their defaults, more examples and the exit codes.")
        elif self.codes:
            with formatter.section(_bold("Exit codes")):
                formatter.write_dl(self.codes)


def _help_all(ctx: click.Context, param: click.Parameter, requested: bool) -> None:
    """Print all of the help, and end."""
    if not requested or ctx.resilient_parsing:
        return
    ctx.meta[_ALL] = True
    click.echo(ctx.get_help(), color=ctx.color)
    ctx.exit()


def colour() -> bool | None:
    """Whether output has colours: never where the environment asks for none, else where it goes to a terminal (None)."""
    return False if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb" else None


def _bold(title: str) -> str:
    return click.style(title, bold=True)
