"""Where the commands begin: nothing heavy is imported before an interrupt is one line and not a traceback."""

import os
import signal
import sys
from collections.abc import Sequence
from importlib import import_module

from plan_cutters.command.leaves import leaves, sentence
from plan_cutters.command.taken_out import TAKEN_OUT, instead

TYPE_CHECKING = False  # `typing` itself takes time
if TYPE_CHECKING:
    from typing import Any

_SELF = "plan-cutters"
#: The commands of this package: the module of each, and its sentence in the help. The first is meant where none is named.
OURS = {
    "plan": ("cli", "Find the cutters that finish a part: see below. It is meant where no command is named."),
    "map": ("map", "Draw all postures of one cutter at one point."),
    "tools": ("tools", "List the tools of a library as they are understood."),
    "machines": ("machines", "List the built-in machines, or show how a machine file is understood."),
}


def commands() -> tuple[str, ...]:
    """The names of all commands, those of other packages last."""
    return (*OURS, *(name for name in leaves() if name not in OURS))


def sentences() -> list[tuple[str, str]]:
    """Each command with its sentence in the help."""
    return [(name, OURS[name][1] if name in OURS else sentence(leaves()[name])) for name in commands()]


def plan_cutters() -> None:
    """Begin the subcommand that the first word names; a first word that names none is a part to plan."""
    name, words = _SELF, sys.argv[1:]
    # Whatever an option begins with, no package is looked for.
    if words and (words[0] in OURS or (words[0].isidentifier() and words[0] in leaves())):
        name, words = f"{_SELF} {words[0]}", words[1:]
    elif words and f"command {words[0]}" in TAKEN_OUT and not os.path.exists(words[0]):
        os.write(2, f"{_SELF}: {instead(f'command {words[0]}')}\n".encode())
        os._exit(2)
    begin(name, words)


def tools() -> None:
    begin("plan-cutters-tools")


def machines() -> None:
    begin("plan-cutters-machines")


def point_map() -> None:
    begin("plan-cutters-map")


def subcommand(name: str) -> str:
    """The subcommand of a name, in either form.

    >>> subcommand("plan-cutters map"), subcommand("plan-cutters-map"), subcommand("plan-cutters")
    ('map', 'map', 'plan')
    """
    return name[len(_SELF) + 1 :] or next(iter(OURS))


def module_of(name: str) -> "Any":
    """The module of a command by its name; it has the `command` of click and `main`."""
    word = subcommand(name)
    return import_module(f"plan_cutters.command.{OURS[word][0]}" if word in OURS else leaves()[word])


def begin(name: str, words: Sequence[str] | None = None) -> None:
    """Run a subcommand under the name that it was called by, `plan-cutters map` or `plan-cutters-map`."""
    words = sys.argv[1:] if words is None else words
    try:
        from plan_cutters_base.workers.assignment import follow_parent, is_child

        follow_parent()
        # A child has nothing to say when it is ended.
        if not is_child() and signal.getsignal(signal.SIGTERM) is not signal.SIG_IGN:
            signal.signal(signal.SIGTERM, signal.default_int_handler)
        if f"_{name.replace('-', '_').upper()}_COMPLETE" in os.environ:
            import_module("plan_cutters.command.completion").main(name)
        if subcommand(name) == "plan":
            from plan_cutters_base.workers.child import begin_early

            begin_early(words)
        module_of(name).main(words, name)
    except KeyboardInterrupt:
        os.write(2, f"{name}: interrupted; no file is half-written\n".encode())
        os._exit(130)
