"""Where this user's caches lie: folders that nobody else can have written to."""

import contextlib
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path


def roots() -> Iterator[Path]:
    """Folders that may hold ours: as the environment says, or in the user's cache; in the folder for temporary files."""
    configured = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME")
    with contextlib.suppress(RuntimeError):  # this user has no home
        yield Path(configured or Path.home() / ".cache", "plan-cutters")
    # Windows has a folder for temporary files for each user. Elsewhere all share one: what another user put there is not run.
    user = os.getuid() if hasattr(os, "getuid") else None
    with contextlib.suppress(OSError):
        shared = Path(tempfile.gettempdir(), f"plan-cutters-{'user' if user is None else user}")
        shared.mkdir(mode=0o700, exist_ok=True)
        if user is None or shared.stat().st_uid == user:
            yield shared


def own(status: os.stat_result) -> bool:
    """Whether only this user can have written what a file or folder holds."""
    return not hasattr(os, "getuid") or (status.st_uid == os.getuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH))


def writable(folder: Path) -> bool:
    """Make a folder if need be; whether files can be written there."""
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        return os.access(folder, os.W_OK)
    return False


class CacheWarning(UserWarning):
    """Machine code in the compiler's cache is damaged, or cannot be read or written: compiling it anew takes time alone."""
