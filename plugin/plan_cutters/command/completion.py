"""Tell the shell which words it may offer: the subcommands for the first word, then the options and values of each."""

import os
from typing import NoReturn

import click
from click.shell_completion import CompletionItem, shell_complete

from plan_cutters.command.codes import ended
from plan_cutters.command.entry import OURS, commands, module_of
from plan_cutters.command.validation import FILE


class Subcommands(click.Group):
    """All subcommands as a shell sees them: words after none of them are those of the first."""

    def __init__(self) -> None:
        # An option may come first, and is one of the first subcommand.
        super().__init__(context_settings={"ignore_unknown_options": True}, add_help_option=False)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command:
        command: click.Command = module_of(f"plan-cutters {cmd_name}").command
        return command

    def resolve_command(self, ctx: click.Context, args: list[str]) -> tuple[str | None, click.Command | None, list[str]]:
        return super().resolve_command(ctx, args if args[0] in commands() else [next(iter(OURS)), *args])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        if incomplete.startswith("-"):
            first = module_of("plan-cutters").command
            items: list[CompletionItem] = first.shell_complete(click.Context(first, resilient_parsing=True), incomplete)
            return items
        return [CompletionItem(name) for name in commands() if name.startswith(incomplete)] or [FILE]


def main(name: str) -> NoReturn:
    """Answer the shell that asks about the program of this name, as the environment says."""
    variable = f"_{name.replace('-', '_').upper()}_COMPLETE"
    main_command = Subcommands() if name == "plan-cutters" else module_of(name).command
    ended(name, [], lambda: shell_complete(main_command, {}, name, variable, os.environ[variable]))
