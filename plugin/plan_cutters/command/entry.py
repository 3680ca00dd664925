"""Where the commands begin: nothing heavy is imported before an interrupt is one line and not a traceback."""

import contextlib
import os
import signal
import sys
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

#: Options by their word, commands as "command WORD", values as "--option VALUE": what to use instead.
TAKEN_OUT: dict[str, str] = {
    "command stored": "plan again with the other machine or setup; stored stages make that short",
    "--postures": "plan again with the other machine or setup; stored stages make that short",
    "--formats regions": "the regions and axes of --operations stand in plan.json",
    "--formats plans": "leave it out; STEP and GLB of both plans are written with --operations both",
    "--answers stick-out-map": "give --answers stick-out; in Python, result.face(F1, stick_out=True) is about a face",
    "--answers mend-all": "give --answers mend, for the three nearest cutters, and plan with another one alone to ask for it",
    "--cluster": "one part is judged here; `plan-cutters batch PART... --out DIR --cluster ADDRESS` plans whole parts on others",
    "--verdicts": "leave it out: verdicts are stored in the user's cache folder, with all else of a part (PLAN_CUTTERS_CACHE)",
    "--pictures-branch": "leave it out: pictures are in the folder of -o, and in the artifact of the job that keeps it",
    "--verdicts-key": "leave it out: what is stored in a folder that others may write to is not read",
}


def instead(word: str) -> str:
    """Say what to use in place of a word that is gone, as an error; "" for a word that never was.

    >>> instead("--never-was")
    ''
    """
    use = TAKEN_OUT.get(word)
    return f"{word} was taken out: {use}" if use else ""


GROUP = "plan_cutters.commands"


@cache
def leaves() -> dict[str, str]:
    """List the modules of the commands that installed packages add, by name; of two of a name, the first on the path.

    The files are read here: `importlib.metadata` alone takes a third of the time that help may take.
    """
    modules: dict[str, str] = {}
    for folder in sys.path:
        for file in sorted(Path(folder or ".").glob("*.dist-info/entry_points.txt")):
            text = ""
            with contextlib.suppress(OSError):  # what nobody may read adds no command
                text = file.read_text(encoding="utf-8", errors="replace")
            group = text.partition(f"[{GROUP}]\n")[2].partition("\n[")[0]
            for line in filter(None, map(str.strip, group.splitlines())):
                name, equals, module = map(str.strip, line.partition("="))
                if equals and name.isidentifier():
                    modules.setdefault(name, module.partition(":")[0])
    return modules


def sentence(module: str) -> str:
    """Read the first line of a module's text, without running it."""
    try:
        spec = find_spec(module)
        code = spec.loader.get_code(module) if spec else None  # type: ignore[union-attr]
    except (ImportError, AttributeError, SyntaxError, ValueError):
        code = None
    text = code.co_consts[0] if code and code.co_consts else None
    return text.strip().splitlines()[0] if isinstance(text, str) and text.strip() else f"It cannot be loaded: {module}."


TYPE_CHECKING = False  # `typing` itself takes time
if TYPE_CHECKING:
    from typing import Any, NoReturn

_SELF = "plan-cutters"
#: The commands of this package: the module of each, and its sentence in the help. The first is meant where none is named.
OURS = {
    "plan": ("cli", "Find the cutters that finish a part: see below. It is meant where no command is named."),
    "map": ("map", "Draw all postures of one cutter at one point."),
    "show": ("show", "Show a folder's plan: print its summary, and make page and models that it lacks."),
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
    """The module of a command by its name; it has the `command` of click, and `main` where more is done than to run that."""
    word = subcommand(name)
    return import_module(f"plan_cutters.command.{OURS[word][0]}" if word in OURS else leaves()[word])


def begin(name: str, words: Sequence[str] | None = None) -> None:
    """Run a subcommand under the name that it was called by, `plan-cutters map` or `plan-cutters-map`."""
    words = sys.argv[1:] if words is None else words

    def at_once(*_: object) -> "NoReturn":
        # Nothing is raised: an import, or a callback of one, may swallow what is raised in it, and the command would go on.
        os.write(2, f"{name}: interrupted; no file is half-written\n".encode())
        os._exit(130)

    try:
        from plan_cutters_base.workers.child import follow_parent, is_child

        follow_parent()
        # A child has nothing to say when it is ended. Who has something to tidy sets a handler that raises, later.
        for number in () if is_child() else (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, at_once)
        if f"_{name.replace('-', '_').upper()}_COMPLETE" in os.environ:
            import_module("plan_cutters.command.validation").complete(name)
        if subcommand(name) == "plan":
            from plan_cutters_base.workers.child import begin_early
            from plan_cutters_base.workers.prompt import at_prompt, copy_and_wait

            if not is_child() and "--wait" not in words and any(map(os.path.isfile, words)) and at_prompt():
                copy_and_wait()
            begin_early(words)
        module = module_of(name)
        if not hasattr(module, "main"):
            import_module("plan_cutters.command.codes").run(module.command, name, words)
        module.main(words, name)
    except KeyboardInterrupt:
        at_once()
