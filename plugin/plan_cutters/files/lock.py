"""One run at a time writes into a folder: a lock beside it says whose it is, and dies with its owner."""

import contextlib
import json
import os
import re
import shutil
import socket
import tempfile
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from plan_cutters.errors import PlanError
from plan_cutters_base.whole import acquired, system_lock


def require_temporary() -> None:
    """See to it that temporary files can be written somewhere. Raises PlanError: no folder for them can be written to."""
    try:
        tempfile.gettempdir()
    except FileNotFoundError:
        raise PlanError("no folder for temporary files can be written to; name one with TMPDIR") from None


_LONGEST = 4096
#: Seconds that a run waits for one which only has models left to write, and how often it looks.
_PATIENCE, _LOOK = 120.0, 0.05


class Lock:
    """The right to write into a folder, until `release` or the end of this process.

    The system's own lock on the file ends with the process that has it, however that ends: what is left behind is taken over.
    What another machine left behind is not, for on some network folders its lock cannot be seen: the file is to be removed by
    hand if nothing runs there. Where the file system has no locks, or on Windows, that holds for what was left behind here, too.
    An owner that has only models left to write is waited for.

    `out`: the folder; it need not be there. `named`: called with the lock's file before it exists. `staging`: the folder beside
    it that its owner is about to make, which goes with it: the one of an owner that was killed is removed. Raises PlanError:
    another process has it: the error says which, where and since when. Raises OSError: the file cannot be written.
    """

    def __init__(self, out: Path, named: Callable[[Path], None] = lambda _: None, staging: Path | None = None) -> None:
        self.file, self._held = lock_of(out), False
        since = datetime.now(UTC).isoformat(timespec="seconds")
        self._entry: dict[str, object] = {"host": socket.gethostname(), "pid": os.getpid(), "since": since}
        if staging is not None:
            self._entry["staging"] = str(staging)
        named(self.file)
        self._patient_until = time.monotonic() + _PATIENCE
        while not self._held:
            self._take(out)

    def ends_soon(self) -> None:
        """Say that models are all that is left to write."""
        self._entry["models"] = True
        with contextlib.suppress(OSError):
            self.file.write_text(json.dumps(self._entry) + "\n", encoding="utf-8")

    def release(self) -> None:
        """Let others write."""
        if self._held:
            self._held = False
            try:
                # While it is ours, so that no other process loses a lock of its own.
                with contextlib.suppress(OSError):
                    if _owner(self.file) == self._entry:
                        self.file.unlink()
            finally:
                self._system.release()

    def _take(self, out: Path) -> None:
        """Take it; it is not held after that where its owner has just removed it."""
        made, self._system = _made(self.file), system_lock(self.file)
        try:
            alone = acquired(self._system)
            if alone is False and not self.file.exists():
                return
            if alone is False and _owner(self.file).get("models") is True and time.monotonic() < self._patient_until:
                time.sleep(_LOOK)
                return
            if alone is False or (alone is None and not made):
                raise _busy(out, self.file, alive=alone is False)
            before = {} if made else _owner(self.file)
            if before.get("host", self._entry["host"]) != self._entry["host"]:
                raise _busy(out, self.file, alive=False)
            _discard(out, before.get("staging"))
            self.file.write_text(json.dumps(self._entry) + "\n", encoding="utf-8")
            self._held = True
        except OSError as error:
            if made:
                self.file.unlink(missing_ok=True)
            elif isinstance(error, PermissionError):
                raise _busy(out, self.file, alive=False) from None
            raise
        finally:
            if not self._held:
                self._system.release()


def lock_of(out: Path) -> Path:
    """The lock's file: beside the folder, whatever name it is called by."""
    real = Path(os.path.realpath(out))
    return real.with_name(f".{real.name}.lock")


def _made(file: Path) -> bool:
    """Make the file of a lock; False where it is there."""
    try:
        os.close(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644))
    except FileExistsError:
        return False
    return True


def _discard(out: Path, staging: object) -> None:
    """Remove the folder in which the files of a run that was killed grew; nothing but such a folder of this output."""
    if not isinstance(staging, str):
        return
    folder, name = Path(staging), re.compile(rf"\.{re.escape(out.name)}-[0-9a-f]{{8}}")
    if folder.parent == out.absolute().parent and name.fullmatch(folder.name) and not folder.is_symlink():
        shutil.rmtree(folder, ignore_errors=True)


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
