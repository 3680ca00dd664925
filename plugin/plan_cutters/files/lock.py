"""One run at a time writes into a folder: a lock beside it says whose it is, and dies with its owner."""

import contextlib
import errno
import json
import os
import re
import shutil
import socket
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from plan_cutters.errors import PlanError

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

#: Errors that say that a file system has no locks of its own.
_NONE = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL}
_LONGEST = 4096


class Lock:
    """The right to write into a folder, until `release` or the end of this process.

    The system's own lock on the file ends with the process that has it, however that ends: what is left behind is taken over.
    What another machine left behind is not, for on some network folders its lock cannot be seen: the file is to be removed by
    hand if nothing runs there. Where the file system has no locks, or on Windows, that holds for what was left behind here, too.

    Parameters
    ----------
    out : Path
        The folder; it need not be there.
    named : callable, optional
        Called with the lock's file before it exists.
    staging : Path, optional
        The folder beside it that its owner is about to make, which goes with it: the one of an owner that was killed is removed.

    Raises
    ------
    PlanError
        Another process has it: the error says which, where and since when.
    OSError
        The file cannot be written.
    """

    def __init__(self, out: Path, named: Callable[[Path], None] = lambda _: None, staging: Path | None = None) -> None:
        self.file, self._handle, self._staging = lock_of(out), -1, staging
        named(self.file)
        while self._handle < 0:
            self._handle = self._taken(out)

    def release(self) -> None:
        """Let others write."""
        if self._handle >= 0:
            handle, self._handle = self._handle, -1
            if fcntl is None:  # Windows removes no open file
                os.close(handle)
                with contextlib.suppress(OSError):
                    self.file.unlink()
                return
            try:
                # While it is ours, so that no other process loses a lock of its own.
                with contextlib.suppress(OSError):
                    if _stands(handle, self.file):
                        self.file.unlink()
            finally:
                os.close(handle)

    def _taken(self, out: Path) -> int:
        """The open file once it is ours, -1 to try again."""
        flags, made = os.O_RDWR | getattr(os, "O_NOFOLLOW", 0), True
        try:
            handle = os.open(self.file, flags | os.O_CREAT | os.O_EXCL, 0o644)
        except FileExistsError:
            made = False
            try:
                handle = os.open(self.file, flags)
            except FileNotFoundError:
                return -1
            except PermissionError:
                raise _busy(out, self.file, alive=False) from None
        try:
            alone = _locked(handle)
            if alone is False or (alone is None and not made):
                raise _busy(out, self.file, alive=alone is False)
            if not _stands(handle, self.file):
                os.close(handle)
                return -1
            before = {} if made else _owner(self.file)
            if before.get("host", socket.gethostname()) != socket.gethostname():
                raise _busy(out, self.file, alive=False)
            _discard(out, before.get("staging"))
            since = datetime.now(UTC).isoformat(timespec="seconds")
            text = {"host": socket.gethostname(), "pid": os.getpid(), "since": since}
            if self._staging is not None:
                text["staging"] = str(self._staging)
            os.ftruncate(handle, 0)
            os.write(handle, (json.dumps(text) + "\n").encode())
        except OSError:
            os.close(handle)
            if made:
                sweep(self.file)
            raise
        except PlanError:
            os.close(handle)
            raise
        return handle


def lock_of(out: Path) -> Path:
    """The lock's file: beside the folder, whatever name it is called by."""
    real = Path(os.path.realpath(out))
    return real.with_name(f".{real.name}.lock")


def sweep(file: Path) -> None:
    """Remove a lock's file that a process which was ended left behind, unless another one has it by now."""
    if fcntl is None:
        with contextlib.suppress(OSError):
            file.unlink()
        return
    with contextlib.suppress(OSError):
        handle = os.open(file, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0))
        try:
            if _locked(handle) is not False and _stands(handle, file):
                file.unlink()
        finally:
            os.close(handle)


def _discard(out: Path, staging: object) -> None:
    """Remove the folder in which the files of a run that was killed grew; nothing but such a folder of this output."""
    if not isinstance(staging, str):
        return
    folder, name = Path(staging), re.compile(rf"\.{re.escape(out.name)}-[0-9a-f]{{8}}")
    if folder.parent == out.absolute().parent and name.fullmatch(folder.name) and not folder.is_symlink():
        shutil.rmtree(folder, ignore_errors=True)


def _locked(handle: int) -> bool | None:
    """Whether the system's lock on an open file is ours now; None where there are none."""
    if fcntl is None:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in _NONE:
            return None
        return False
    return True


def _stands(handle: int, file: Path) -> bool:
    """Whether an open file is still the one of that name: its owner may have removed it since it was opened."""
    try:
        return os.path.samestat(os.fstat(handle), os.stat(file))
    except FileNotFoundError:
        return False


def _owner(file: Path) -> dict[str, object]:
    """Read the entry that the owner of a lock wrote; it is empty where the owner has not written yet."""
    with contextlib.suppress(OSError, ValueError, RecursionError):
        with file.open("rb") as opened:
            owner = json.loads(opened.read(_LONGEST))
        if isinstance(owner, dict):
            return owner
    return {}


def _busy(out: Path, file: Path, *, alive: bool) -> PlanError:
    owner, who = _owner(file), "another run"
    if owner:
        pid, host, since = (ascii(str(owner.get(word, "?")))[1:-1][:60] for word in ("pid", "host", "since"))
        who = f"process {pid} on {host}, since {since}"
    if alive:
        return PlanError(f"is being written by {who}: wait for it, or give another folder with -o", file=str(out))
    return PlanError(f"is locked by {who}: if nothing runs there any more, remove {file}", file=str(out))
