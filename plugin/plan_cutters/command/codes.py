"""Exit codes, and what ends in which."""

import contextlib
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, NoReturn

import click

from plan_cutters.command import terminal
from plan_cutters.command.entry import instead
from plan_cutters_base.workers.child import INTERRUPTED
from plan_cutters_base.workers.supervise import Supervised

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import Plan

FEASIBLE, NONE_FEASIBLE, USAGE, UNREADABLE, NOT_ALL_JUDGED = 0, 1, 2, 3, 4
#: The codes as help lists them.
ENDED = ("130", "interrupted; nothing is half-written, and what stands by then is written")
CODES = (
    ("0", "what was given (cutters, setups, operations) finishes every judged sample together, or what --fail-under asks"),
    ("1", "it does not; the plan says where and why"),
    ("2", "the command line, a library or a machine file is wrong"),
    ("3", "the part or a fixture cannot be read, or holds nothing to judge"),
    (
        "4",
        "it would finish all that could be judged, but something could not, obstacles are missing, or samples are farther "
        "apart than its radius and nobody asked for that",
    ),
    ("124", "a part was not done within --timeout; nothing is half-written, and what stands by then is written"),
    ENDED,
)
#: Standard output was closed by its reader: as a shell counts the signal that ends other programs then.
READER_GONE = 141


def code_of(plan: "Plan", fail_under: float | None = None) -> int:
    """The exit code that a plan asks for; `fail_under`: the percent of what is asked that is enough."""
    # Not before anything is planned: help is shown without what this loads.
    from plan_cutters.plan_file.words.headline import unseen

    process = plan.process
    # What is missing from the obstacles leaves open whether a cutter that nothing else stops is stopped by it.
    unsure = bool(plan.missing) or unseen(plan)
    if fail_under is not None and 100.0 * process.finished_share >= fail_under:
        return NOT_ALL_JUDGED if unsure else FEASIBLE
    if not process.finished:
        return NONE_FEASIBLE
    unjudged = plan.samples.unjudged or any(f.target and f.unjudged for f in plan.faces)
    return NOT_ALL_JUDGED if unsure or unjudged else FEASIBLE


#: Interrupts that came.
_interrupts: list[int] = []


def interrupt(number: int, _: object) -> NoReturn:
    """Raise an interrupt as Python does, and remember it: an import that it ends may raise an error of its own instead."""
    _interrupts.append(number)
    raise KeyboardInterrupt


def raise_interrupts() -> None:
    """Let interrupts, and requests to end, be raised from here on: there is something to tidy. Those that are ignored stay so."""
    with contextlib.suppress(ValueError):  # only the main thread may
        for number in (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, interrupt)


def is_interrupt(error: BaseException) -> bool:
    """Whether an error is an interrupt, or may come of one."""
    return bool(_interrupts) or isinstance(error, KeyboardInterrupt)


@contextlib.contextmanager
def held_interrupts(came: list[int]) -> Iterator[None]:
    """Let the first interrupt wait for the end of the block, for files there become whole; the second one is raised.

    `came` has the interrupts that came by now; that which comes is added.
    """

    def hold(number: int, frame: object) -> None:
        if came:
            interrupt(number, frame)
        came.append(number)

    before = {number: signal.signal(number, hold) for number in (signal.SIGINT, signal.SIGTERM) if caught(number)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def caught(number: int) -> bool:
    """Whether this process catches a signal, in Python."""
    return callable(signal.getsignal(number))


def keep_interrupts() -> None:
    """Take an interrupt again that came where none can be raised, as while the process copies itself for the kernel."""
    before, me = sys.unraisablehook, threading.get_ident()

    def again(what: "sys.UnraisableHookArgs") -> None:
        if issubclass(what.exc_type, KeyboardInterrupt):
            threading.Timer(0.05, signal.pthread_kill, (me, signal.SIGINT)).start()
        else:
            before(what)

    sys.unraisablehook = again


def guarded(work: Callable[[], tuple[int, str]], debug: bool) -> tuple[int, str]:
    """Run; errors that have a cause become an exit code and a line."""
    from cad_io.errors import CadIoError, WriteError
    from plan_cutters.errors import PlanError, UnjudgeableError

    try:
        return work()
    except (Exception, KeyboardInterrupt) as error:
        if debug:
            terminal.emit(traceback.format_exc())
        code, line = UNREADABLE, str(error)
        match error:
            case _ if is_interrupt(error):
                code, line = INTERRUPTED, "interrupted; no file is half-written"
            case terminal.ReaderGone():
                return READER_GONE, ""
            case MemoryError():
                line = "out of memory; sample more coarsely (--spacing), or give --memory"
            case Supervised() | UnjudgeableError():
                pass
            case WriteError() | PlanError():
                code = USAGE
            case click.ClickException():
                code, line = USAGE, error.format_message()
            case _ if not isinstance(error, CadIoError):
                line = f"internal error ({type(error).__name__}: {error}); --debug shows where"
        return code, f"plan-cutters: {line}"


def faults(names: Sequence[str], work: Callable[[str], None], debug: bool) -> list[str]:
    """Work on each of some names; a line, under the command's name, about each at which that fails."""

    def one(name: str) -> tuple[int, str]:
        work(name)
        return FEASIBLE, ""

    codes = [guarded(partial(one, name), debug) for name in names]
    command = click.get_current_context().info_name
    return [line.replace("plan-cutters:", f"{command}:", 1) for code, line in codes if code]


def invoked(command: click.Command, name: str, words: Sequence[str]) -> int:
    """Parse and run a command; its exit code."""
    try:
        with command.make_context(name, list(words)) as context:
            return int(command.invoke(context) or 0)
    except click.exceptions.Exit as done:
        return done.exit_code
    except click.Abort:
        raise KeyboardInterrupt from None


def run(command: click.Command, name: str, words: Sequence[str]) -> NoReturn:
    """Run a command to its end with some words."""
    raise_interrupts()
    ended(name, words, lambda: invoked(command, name, words))


def ended(name: str, words: Sequence[str], work: Callable[[], int]) -> NoReturn:
    """Run a command with its words to its end, whatever becomes of the streams that it writes to."""

    def all_of_it() -> tuple[int, str]:
        try:
            code = work()
            if sys.stdout is not None:
                sys.stdout.flush()
            return code, ""
        except click.UsageError as error:
            if isinstance(error, click.NoSuchOption) and (gone := instead(error.option_name)):
                raise click.UsageError(gone) from None
            meant = [word for word in words if word.startswith("-")] if isinstance(error, click.NoSuchOption) else []
            files = [word for word in (*name.split()[1:], *meant) if os.path.exists(word)]
            hint = f"; for the file, write ./{files[0]}" if files else ""
            raise click.UsageError(f"{error.format_message().rstrip('.')}{hint}") from None

    terminal.keep_streams()
    terminal.warn_in_lines()
    code, line = guarded(lambda: terminal.writing_out(all_of_it), "--debug" in words)
    if line:
        terminal.error(line.replace("plan-cutters:", f"{name}:", 1))
    # All is said: an interrupt has nothing left to end.
    with contextlib.suppress(ValueError):
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
    if code == INTERRUPTED:
        # The interpreter would end itself by the signal where it has seen the interrupt in code that was made from text.
        os._exit(code)
    sys.exit(code)
