"""The system's lock on a file, which ends with the process that has it, however that ends."""

import contextlib
import errno
import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from filelock import BaseFileLock

#: Errors that say that a file system has no locks of its own.
_NONE = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL}


def system_lock(file: Path) -> "BaseFileLock":
    """Make the lock of a file; it is not taken yet."""
    from filelock import FileLock  # most commands take none

    return FileLock(file, thread_local=False, fallback_to_soft=False)


def acquired(system: "BaseFileLock") -> bool | None:
    """Whether the system's lock on a file is ours now; None where there are none, and on Windows, where nobody could read it."""
    if os.name == "nt":
        return None
    try:
        system.acquire(timeout=0)
    except TimeoutError:
        return False
    except OSError as error:
        if error.errno in _NONE:
            return None
        raise
    return True


def sweep(file: Path) -> None:
    """Remove a lock's file that a process which was ended left behind, unless another one has it by now."""
    with contextlib.suppress(OSError):
        system = system_lock(file)
        if file.exists() and acquired(system) is not False:
            file.unlink()
            system.release()
