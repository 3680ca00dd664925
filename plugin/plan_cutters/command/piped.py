"""Read standard input: `-` in place of a part is its file, and in place of the parts of a batch a list of them."""

import contextlib
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

import click

from plan_cutters.errors import OptionError

#: The word for standard input.
PIPE = "-"
#: Names of files by the kind that their content tells.
_SUFFIXES = {"step": ".step", "iges": ".igs", "brep": ".brep", "binary brep": ".brep"}


@contextlib.contextmanager
def spooled(command: click.Command, words: Sequence[str]) -> Iterator[list[str]]:
    """The words of a command, with a file of what comes through the pipe in place of `-`; the file is removed in the end.

    Its name is `stdin`, with the suffix of its kind, so that a plan says where its part came from. The kernel opens a part
    more than once, which a pipe does not allow.

    Raises
    ------
    OptionError
        `-` stands twice, or nothing is piped.
    ReadError
        What comes is no CAD file.
    """
    # Behind an option that takes a value the word is that value, as in `--json -`.
    valued = {each for p in command.params if isinstance(p, click.Option) and not (p.is_flag or p.count) for each in p.opts}
    places = [k for k, word in enumerate(words) if word == PIPE and (k == 0 or words[k - 1] not in valued)]
    if not places:
        yield list(words)
        return
    if len(places) > 1:
        raise OptionError("-: standard input is one part")
    from cad_io.read.sniff import sniff

    data = _piped().read()
    suffix = _SUFFIXES.get(sniff(data, PIPE), "")
    with tempfile.TemporaryDirectory(prefix="plan-cutters-") as folder:
        file = Path(folder) / f"stdin{suffix}"
        file.write_bytes(data)
        yield [str(file) if k in places else word for k, word in enumerate(words)]


def listed(sources: Sequence[str]) -> list[str]:
    """Sources of a batch, with the lines of standard input in place of `-`: empty ones and those that begin with # are none.

    Raises
    ------
    OptionError
        Nothing is piped, what comes is no text, or it has no line.
    """
    if PIPE not in sources:
        return list(sources)
    try:
        lines = [line.strip() for line in _piped().read().decode("utf-8-sig").splitlines()]
    except UnicodeDecodeError:
        raise OptionError("-: a list of parts is text in UTF-8, a part in a line; the command plan takes a part itself") from None
    parts = [line for line in lines if line and not line.startswith("#")]
    if not parts:
        raise OptionError("-: no part is listed on standard input")
    return [each for word in sources for each in (parts if word == PIPE else [word])]


def _piped() -> BinaryIO:
    """Standard input, where something is piped into it."""
    if sys.stdin is None or sys.stdin.isatty():
        raise OptionError("-: nothing is piped to standard input; give a file, or pipe one: plan-cutters - < part.step")
    return sys.stdin.buffer
