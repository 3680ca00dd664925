"""Files appear whole or not at all, written under another name, then renamed; and locks of the system on files."""

import contextlib
import errno
import os
import secrets
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from filelock import BaseFileLock

#: Errors that say that a file system has no locks of its own.
_NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL}


def refusal(folder: str | Path) -> str:
    """Say why no file can be made in a folder, or in the nearest one above it that is there; empty where one can.

    Rights alone do not say it: a file without a name is made, which leaves nothing.

    >>> refusal("."), refusal(__file__)
    ('', 'Not a directory')
    """
    import tempfile

    wanted = Path(folder).absolute()
    there = next(each for each in (wanted, *wanted.parents) if each.exists() or each == each.parent)
    try:
        with tempfile.TemporaryFile(dir=there):
            return ""
    except OSError as fault:
        return fault.strerror or str(fault)


@contextlib.contextmanager
def whole(
    path: str | Path, error: Callable[..., Exception] | None = None, named: Callable[[Path], None] = lambda _: None
) -> Iterator[Path]:
    """Give a path in the same folder to write to; it is renamed to `path` when the block ends well, removed when it does not.

    `error`: raised in place of an `OSError`: the folder cannot be written to, or the file cannot be written or take its place.
    `named`: called with the path to write to before it exists, so that whoever ends this process can take it away.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")
    named(temporary)
    try:
        # The kernel writes by name, so the file is made here, with the rights of any new file, and closed again.
        os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        yield temporary
        os.replace(temporary, path)
    except OSError as fault:
        if error is None:
            raise
        raise error(f"cannot be written: {fault.strerror or fault}", file=str(path)) from fault
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


def system_lock(file: Path) -> "BaseFileLock":
    """Make the system's lock on a file, which ends with the process that has it, however that ends; it is not taken yet."""
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
        if error.errno in _NO_LOCKS:
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
