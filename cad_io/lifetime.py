"""A process that ends with the one that started it, whatever ended that one, and whatever it is doing itself.

Linux kills it at once. Elsewhere a copy of it looks after its parent: a thread could not, for the CAD kernel does not let go
of the interpreter while it works.
"""

import ctypes
import os
import signal
import sys
import time

_SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG
#: Seconds between two looks at a parent, where the system itself does not look.
_LOOK = 0.1


def end_with(parent: int) -> None:
    """Have this process killed as soon as its parent has ended.

    On Linux the end of the thread that started it counts, too: it must be one that waits. Where there is no fork (Windows),
    nothing is done.

    Parameters
    ----------
    parent : int
        Its process number, asked for before this process began: it may have ended meanwhile.
    """
    if not hasattr(os, "fork"):
        return
    if not _killed_by_the_system():
        _looked_after(parent)
    if os.getppid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)


def _killed_by_the_system() -> bool:
    """Ask Linux to kill this process; False where it cannot be asked."""
    if sys.platform != "linux":
        return False
    none = ctypes.c_ulong(0)
    return ctypes.CDLL(None).prctl(_SET_DEATH_SIGNAL, ctypes.c_ulong(signal.SIGKILL), none, none, none) == 0


def _looked_after(parent: int) -> None:
    """Start a copy that kills this process once its parent is gone, and has been waited for where it had a parent itself."""
    me = os.getpid()
    if os.fork():
        return
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        os.closerange(0, 1 << 12)  # who waits for the end of a pipe must not wait for this copy
        while os.getppid() == me:
            try:
                os.kill(parent, 0)
            except ProcessLookupError:
                os.kill(me, signal.SIGKILL)
            except PermissionError:
                pass
            time.sleep(_LOOK)
    finally:
        os._exit(0)
