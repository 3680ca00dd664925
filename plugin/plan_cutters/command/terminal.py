"""Write texts for people: what was found on standard output, all else on standard error.

They are wrapped, coloured where that helps, and free of terminal control codes.
"""

import contextlib
import errno
import logging
import os
import re
import sys
import warnings
from collections.abc import Callable, Iterator
from io import StringIO, TextIOWrapper
from typing import IO, TYPE_CHECKING, Any, Literal, TypeVar

from plan_cutters.errors import PlanError
from plan_cutters_base.terminal_text import clean
from plan_cutters_base.user_cache import CacheWarning
from plan_cutters_base.workers.child import is_child, report

if TYPE_CHECKING:
    from rich.console import Console
    from rich.text import Text

T = TypeVar("T")

#: The name of a standard stream, in `sys`.
Where = Literal["stdout", "stderr"]
#: Columns that nothing for people is wider than, and that are there where the output is no terminal.
COLUMNS = 80
#: What goes wrong with a stream that is written to.
_OF_STREAMS = frozenset({errno.EPIPE, errno.ENOSPC, errno.EIO, errno.EBADF, errno.EFBIG})


#: Between a number and its unit, where no line may end; it stands for the blank while lines are made.
_NUMBER, _GLUE = re.compile(r"(?<=\d) (?=(?:%|mm[²2]?|deg)(?!\w))"), "\ue000"


class ReaderGone(Exception):
    """Whoever read our standard output has closed it."""


#: Why nothing more can be shown; the work goes on, for its files hold all.
_unshown: list[Exception] = []


def is_terminal(where: Where = "stderr") -> bool:
    """Whether a stream goes to a terminal."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        return bool(getattr(sys, where).isatty())
    return False


def redraws(where: Where = "stderr") -> bool:
    """Whether it can redraw a line, and colour it."""
    return is_terminal(where) and os.environ.get("TERM") != "dumb"


def width(where: Where = "stderr") -> int:
    """Columns to set text in: the terminal's, but no more than COLUMNS."""
    columns = 0
    if is_terminal(where):
        with contextlib.suppress(OSError, ValueError):
            columns = int(os.environ.get("COLUMNS") or os.get_terminal_size(getattr(sys, where).fileno()).columns)
    return min(COLUMNS, columns) if columns > 0 else COLUMNS


def console(text: "IO[str] | None" = None, where: Where = "stderr") -> "Console":
    """Standard error as people see it, or a text that is set as it would be there or on standard output."""
    from rich.console import Console

    return Console(file=text, stderr=text is None, width=width(where), force_terminal=redraws(where) or None,
                   highlight=False, markup=False, emoji=False)  # fmt: skip


def say(*what: Any) -> None:
    """Set paragraphs (str or Text, wrapped, later lines indented) and tables on standard error."""
    emit(_set(what, "stderr"))


def show(*what: Any) -> None:
    """Set them on standard output: it is what was found."""
    give(_set(what, "stdout"))


def _set(what: tuple[Any, ...], where: Where) -> str:
    page = console(text := StringIO(), where)
    for each in what:
        if not each:
            page.print()
        elif isinstance(each, str) or hasattr(each, "plain"):
            for line in wrapped(clean(each) if isinstance(each, str) else each, page):
                page.print(line, no_wrap=True, overflow="ignore", crop=False)
        else:
            page.print(each)
    return "".join(f"{line.rstrip()}\n" for line in text.getvalue().splitlines())


def wrapped(what: "str | Text", page: "Console", indent: int = 2) -> "list[Text]":
    """The lines of a paragraph, all but the first indented; what stands before its first word indents all."""
    from rich.text import Text

    text = Text(what) if isinstance(what, str) else what.copy()
    text.plain = _NUMBER.sub(_GLUE, text.plain)
    before = len(text.plain) - len(text.plain.lstrip(" "))
    rest, lines = text[before:], list["Text"]()
    while rest.plain:
        margin = before + (indent if lines else 0)
        line = rest.wrap(page, max(10, page.width - margin), overflow="fold")[0]
        line.rstrip()
        line.plain = line.plain.replace(_GLUE, " ")
        lines.append(Text(" " * margin).append_text(line))
        rest = rest[len(line.plain) :]
        rest = rest[len(rest.plain) - len(rest.plain.lstrip(" ")) :]
    return lines


def error(line: str) -> None:
    """One line about what went wrong, never wrapped: scripts look for it."""
    emit(f"{clean(line)}\n")


def emit(text: str) -> None:
    """Write on standard error; the child lets its parent do it, which may be drawing there."""
    if is_child():
        report("say", text)
        return
    # Where no one can read it, the files and the exit code still say all.
    with contextlib.suppress(OSError, ValueError, AttributeError):
        sys.stderr.write(text)
        sys.stderr.flush()


def keep_output() -> None:
    """Leave the output to us: what the kernel prints past Python, as its BREP reader does, goes nowhere.

    So do Python's warnings, of overflows for one, unless asked for with -W: numbers that are not finite are dealt with
    where they arise.
    """
    if not sys.warnoptions:
        warnings.simplefilter("ignore")
    ours, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)
    sys.stdout = os.fdopen(ours, "w", encoding="utf-8")


def warn_in_lines() -> None:
    """Write what is warned of the compiler's cache as lines for people, and all other warnings as Python does.

    That pictures' fonts are not cached, as in a home that cannot be written, is told to no one.
    """
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    warnings.simplefilter("always", CacheWarning)
    before = warnings.showwarning

    def shown(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if issubclass(category, CacheWarning):
            error(f"plan-cutters: {message}")
        else:
            before(message, category, *place, **more)

    warnings.showwarning = shown


def give(text: str) -> None:
    """Write for people on standard output, as far as it goes; the child lets its parent do it.

    What cannot be shown ends no work: `all_shown` says so at its end.
    """
    if is_child():
        report("show", text)
    elif sys.stdout is not None and not _unshown:
        try:
            if isinstance(sys.stdout, TextIOWrapper):
                # Names may have no place in the terminal's encoding.
                sys.stdout.reconfigure(errors="backslashreplace")
            hand_out(text)
        except (ReaderGone, PlanError) as error:
            _unshown.append(error)


def all_shown() -> None:
    """Raise what kept results from being shown; nothing where nobody could read them from the start."""
    if _unshown:
        raise _unshown.pop()


def hand_out(text: str) -> None:
    """Write on standard output, for programs to read; errors as of `handing_out`, and where it is closed."""
    if sys.stdout is None:
        raise PlanError("cannot be written: it is closed", file="standard output")
    writing_out(lambda: (sys.stdout.write(text), sys.stdout.flush()))


class _Paper(StringIO):
    """Text whose tables have frames that standard output can show."""

    @property
    def encoding(self) -> str:  # type: ignore[override]
        return getattr(sys.stdout, "encoding", None) or "utf-8"


@contextlib.contextmanager
def paper(width: int) -> Iterator["Console"]:
    """Give a console whose text goes to standard output at the end, as by `hand_out`; `width` holds where that is no terminal.

    Rich itself would end the process where standard output is closed.
    """
    from rich.console import Console

    if hasattr(sys.stdout, "reconfigure"):
        # Names and frames of tables may have no place in the terminal's encoding.
        sys.stdout.reconfigure(errors="replace")
    seen = sys.stdout is not None and sys.stdout.isatty()
    console = Console(file=(text := _Paper()), highlight=False, markup=False, width=None if seen else width, force_terminal=seen)
    yield console
    hand_out(text.getvalue())


def writing_out(work: Callable[[], T]) -> T:
    """Do what writes on standard output; ReaderGone where its reader closed it, PlanError where it cannot be written."""
    try:
        return work()
    except OSError as error:
        if error.errno not in _OF_STREAMS or error.filename is not None:
            raise  # it was about a file
        # What is left in its buffer must not fail once more at the end.
        with contextlib.suppress(OSError, ValueError, AttributeError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stdout.fileno())
            os.close(nowhere)
        if isinstance(error, BrokenPipeError):
            raise ReaderGone from None
        raise PlanError(f"cannot be written: {error.strerror}", file="standard output") from None


def keep_streams() -> None:
    """Open those of the three standard streams that are closed: what we open must not take their numbers."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            # It takes the lowest number that is free, and is there for the child, too.
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
