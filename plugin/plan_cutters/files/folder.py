"""A folder of this machine, or of any file system that fsspec knows: what is kept there is read and written whole."""

import contextlib
import hashlib
import os
import shutil
from pathlib import Path
from typing import Any

from plan_cutters.errors import PlanError, extra_hint
from plan_cutters.files.content import regular_bytes
from plan_cutters_base import user_files
from plan_cutters_base.user_files import checksum, open_regular
from plan_cutters_base.whole import whole

_MISSING = f"is not there: {extra_hint('batch')}"


def file_system(url: str) -> tuple[Any, str]:
    """The file system of a path or URL, and the path on it. Raises PlanError: a package is missing, or the URL has no meaning."""
    try:
        from fsspec.core import url_to_fs
    except ImportError:
        raise PlanError(f"the package fsspec {_MISSING}", file=url) from None
    try:
        remote = "://" in url and not url.startswith(("file://", "memory://"))
        fs, path = url_to_fs(url, use_listings_cache=False) if remote else url_to_fs(url)
    except Exception as error:
        raise PlanError(cause(error), file=url) from None
    return fs, path


def refuse_memory(url: str) -> None:
    """Refuse a URL that names the memory of this process, which no worker sees. Raises PlanError."""
    if url.startswith("memory://"):
        raise PlanError(
            "memory:// is the memory of one process, and each part has its own: give a folder, or a URL that all reach", file=url
        )


def read(url: str) -> bytes:
    """The content of a file. Raises PlanError: it cannot be read."""
    fs, path = file_system(url)
    try:
        return user_files.content(path) if _is_local(fs) else bytes(fs.cat_file(path))
    except user_files.IrregularError as error:
        raise PlanError("is a folder, not a file" if os.path.isdir(path) else str(error), file=url) from None
    except Exception as error:
        raise PlanError(cause(error, "read"), file=url) from None


def cause(error: BaseException, doing: str = "reached") -> str:
    """One line on why a file system refused."""
    name, text = type(error).__name__, " ".join(str(error).split())
    if isinstance(error, ImportError):
        return f"{text}: install what reaches it"
    if "Credential" in name or "credential" in text:
        return (
            f"no credentials ({text}): set those of the storage in the environment, as AWS_ACCESS_KEY_ID and "
            "AWS_SECRET_ACCESS_KEY"
        )
    if isinstance(error, FileNotFoundError):
        return "no such file" if doing == "read" else f"cannot be {doing}: there is no such bucket or folder"
    if isinstance(error, IsADirectoryError):
        return "is a folder, not a file"
    if isinstance(error, PermissionError):
        return f"cannot be {doing}: {getattr(error, 'strerror', None) or text or 'permission denied'}"
    if isinstance(error, OSError) and error.strerror:
        return f"cannot be {doing}: {error.strerror}"
    return f"cannot be {doing}: {text or name}"


def _is_local(fs: Any) -> bool:
    return type(fs).__name__ == "LocalFileSystem"


class Folder:
    """A folder whose files have names such as `a/b.json`.

    A method raises what the file system raises; `cause` puts it in words.

    `url`: path or URL. Raises PlanError: there is no such file system.
    """

    def __init__(self, url: str) -> None:
        self.url, root = url, os.path.expanduser(url)
        self._fs: Any = None
        if "://" in url:
            self._fs, root = file_system(url)
        self.local = self._fs is None or _is_local(self._fs)
        self.root = os.path.abspath(root) if self.local else root.rstrip("/")

    @property
    def root_url(self) -> str:
        """The folder, from wherever it is looked at."""
        return self.root if self.local else self.url.rstrip("/")

    def get(self, name: str, most: int) -> bytes | None:
        """The content of a file, of at most so many bytes here; None where there is none."""
        if self.local:
            return regular_bytes(self._at(name), most)
        try:
            return bytes(self._fs.cat_file(self._at(name)))
        except FileNotFoundError:
            return None

    def put(self, name: str, data: bytes) -> None:
        """Write a file, whole or not at all."""
        if not self.local:
            self._fs.pipe_file(self._at(name), data)
            return
        Path(self._at(name)).parent.mkdir(parents=True, exist_ok=True)
        with whole(self._at(name)) as temporary:
            temporary.write_bytes(data)

    def names(self, below: str = "") -> set[str]:
        """Names of the files below a folder, from there."""
        here = f"{self._at(below).rstrip('/')}/"
        if self.local:
            return {path.relative_to(here).as_posix() for path in Path(here).rglob("*") if path.is_file()}
        try:
            return {path[len(here) :] for path in map(str, self._fs.find(here)) if path.startswith(here)}
        except FileNotFoundError:
            return set()

    def remove(self, name: str) -> None:
        """Remove a file."""
        Path(self._at(name)).unlink() if self.local else self._fs.rm_file(self._at(name))

    def clear(self, below: str) -> None:
        """Remove a folder with all that is in it, as far as that can be."""
        if self.local:
            shutil.rmtree(self._at(below), ignore_errors=True)
            return
        with contextlib.suppress(Exception):
            self._fs.rm(self._at(below), recursive=True)

    def checksum(self, name: str) -> str | None:
        """SHA-256 of a whole file; None where it cannot be read."""
        try:
            return checksum_of(Path(self._at(name)) if self.local else bytes(self._fs.cat_file(self._at(name))))
        except (OSError, ValueError):
            return None

    def _at(self, name: str) -> str:
        return f"{self.root}/{name}"


def checksum_of(what: Path | bytes) -> str:
    """SHA-256 of a file or of bytes."""
    if isinstance(what, bytes):
        return checksum(what)
    with open_regular(what) as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
