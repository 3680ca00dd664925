"""Work in a forked copy of this process while the process itself goes on with other work: the second core is idle otherwise.

Nothing depends on the copy: where it crashes, raises, hangs or cannot be made, the work is done here, with all the care
that is taken here.
"""

import os
from collections.abc import Callable
from types import TracebackType
from typing import BinaryIO, Generic, TypeVar, cast

from cad_io.forks import answers, begin, ended, tell

Done = TypeVar("Done")


class SideProcess(Generic[Done]):
    """A call that may be under way in a copy of this process.

    The copy ends with the block of `with`, whatever ends that.

    Parameters
    ----------
    call : callable
        Its result is pickled. It must not depend on threads of this process, and repeats all that it does when called again.
    seconds : float
        Of processor time, after which the copy is given up.
    worth : bool
        Whether to make a copy at all: that takes some hundredths of a second.
    """

    def __init__(self, call: Callable[[], Done], seconds: float, *, worth: bool = True) -> None:
        self._call, self._seconds = call, seconds
        self._worth = worth and hasattr(os, "fork")
        self._copy: tuple[int, int] | None = None

    def __enter__(self) -> "SideProcess[Done]":
        if self._worth:
            try:
                self._copy = begin(self._answer, self._seconds)
            except OSError:  # no room for another process
                self._copy = None
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._end()

    @property
    def works(self) -> bool:
        """Whether there is a copy: then this process should do something else before it asks for the result."""
        return self._copy is not None

    def result(self, here: Callable[[], Done] | None = None) -> Done:
        """Return the result of the call.

        Where the copy gives none, this process makes the call itself: `here` in its place, if that is given, which may
        report its progress.
        """
        if self._copy is not None:
            try:
                for answer in answers(*self._copy):
                    return cast(Done, answer)
            except TimeoutError:
                pass
            finally:
                self._end()
        return (here or self._call)()

    def _answer(self, pipe: BinaryIO) -> None:
        tell(pipe, self._call())

    def _end(self) -> None:
        """Leave nothing of the copy."""
        if self._copy is not None:
            (end, child), self._copy = self._copy, None
            os.close(end)
            ended(child)
