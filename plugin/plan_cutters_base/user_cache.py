"""Where this user's caches lie, folders that nobody else can have written to; entries there are read as they were written."""

import contextlib
import hashlib
import math
import os
import stat
import sys
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from plan_cutters_base.whole import whole

#: Bytes of the checksum at the beginning of an entry.
_CHECKSUM = 32


class CacheWarning(UserWarning):
    """Machine code in the compiler's cache is damaged, or cannot be read or written: compiling it anew takes time alone."""


def roots() -> Iterator[Path]:
    """Folders that may hold ours: as the environment says, or in the user's cache; in the folder for temporary files."""
    configured = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME")
    with contextlib.suppress(RuntimeError):  # this user has no home
        if configured:
            yield Path(configured, "plan-cutters")
        elif sys.platform.startswith("linux"):  # as `platformdirs` says it, which is not loaded for that
            yield Path.home() / ".cache" / "plan-cutters"
        else:
            from platformdirs import user_cache_path

            yield user_cache_path("plan-cutters", appauthor=False)
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


def write_entry(path: Path, pieces: Iterable[bytes | memoryview], most: float = math.inf) -> None:
    """Write an entry whole, for its owner alone, behind a checksum of its name and content; an OSError where it cannot be."""
    with whole(path) as temporary, temporary.open("r+b") as file:
        os.chmod(temporary, 0o600)
        state = hashlib.sha256(path.name.encode())
        file.write(bytes(_CHECKSUM))
        for piece in pieces:
            state.update(piece)
            file.write(piece)
        if file.tell() > most:
            raise OSError("an entry larger than the cache")
        file.seek(0)
        file.write(state.digest())


def read_entry(path: Path) -> bytearray | None:
    """The content of an entry as it was written; None where another user might have written it, or it is damaged.

    By a full disk, a power cut or another name: then it is removed. An OSError where it cannot be read.
    """
    with path.open("rb") as file:
        status = os.fstat(file.fileno())
        if not own(status):
            return None
        checksum, content = file.read(_CHECKSUM), bytearray(max(0, status.st_size - _CHECKSUM))
        file.readinto(content)
    state = hashlib.sha256(path.name.encode())
    state.update(content)
    if state.digest() != checksum:
        path.unlink(missing_ok=True)
        return None
    os.utime(path)
    return content
