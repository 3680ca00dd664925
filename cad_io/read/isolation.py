"""Let a copy of the process read, so that a crash or a hang of the kernel becomes an error like any other."""

import pickle
from collections.abc import Callable

from cad_io.errors import CadIoError, ReadError
from cad_io.kernel import translated
from cad_io.part.packing import PartContent, packed, unpacked
from plan_cutters_base.forks import ChildDied, TimeLimit, limited


class Crashed(ReadError):
    """The kernel crashed."""


def guarded(find: Callable[[], PartContent], timeout: float, file: str | None) -> PartContent:
    """Result of `find()`, which may crash or hang.

    Parameters
    ----------
    find : callable
        Run in a forked copy of this process; where the system cannot fork (Windows), here and without a limit.
    timeout : float
        Seconds that it may take.
    file : str, optional
        Named in errors.

    Raises
    ------
    ReadError
        What `find` raised, or that it did not end in time; `Crashed` if it crashed.
    """
    try:
        answer = pickle.loads(limited(lambda: _answer(find), timeout))
    except TimeLimit:
        raise ReadError(
            f"not read within {timeout:g} s: it may be damaged; give more time or export it again", file=file
        ) from None
    except ChildDied as died:
        raise Crashed(f"the CAD kernel cannot read it ({died}): export it again", file=file) from None
    if "error" in answer:
        cause, where, face = answer["error"]
        raise ReadError(cause, file=where, face=face)
    with translated("taking over what it made of the file", error=ReadError, file=file):
        return unpacked(answer)


def _answer(find: Callable[[], PartContent]) -> bytes:
    try:
        return pickle.dumps(packed(find()))
    except CadIoError as error:
        return pickle.dumps({"error": (error.cause, error.file, error.face)})
