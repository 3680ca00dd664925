"""Files appear whole or not at all: written aside, then renamed."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cad_io.errors import WriteError


@contextmanager
def temporary_file(path: str | Path) -> Iterator[Path]:
    """A path in the same folder to write to; renamed to `path` when the block ends well, removed when it does not.

    Raises
    ------
    WriteError
        The folder cannot be written to, or the file cannot take its place.
    """
    path = Path(path)
    try:
        # The kernel writes by name, so the file is made here (no name is guessed twice) and closed again.
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
        os.close(handle)
    except OSError as error:
        raise WriteError(f"cannot be written: {error.strerror}", file=str(path)) from error
    temporary = Path(name)
    try:
        yield temporary
        # mkstemp keeps others out; a result is to have the rights of any new file.
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        os.replace(temporary, path)
    except OSError as error:
        raise WriteError(f"cannot be written: {error.strerror}", file=str(path)) from error
    finally:
        temporary.unlink(missing_ok=True)
