"""The output of a batch, on any file system that fsspec knows: the files of a part are there whole, or the part is not done.

On this machine the folder of a part is made aside and takes its place by renaming. Object storage has no renaming of folders:
there the marker of a part is removed first and written last, so that a part without one is not done, whatever files lie there.
"""

import contextlib
import hashlib
import json
import os
import secrets
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cad_io import files as user_files
from cad_io.files import checksum, open_regular
from plan_cutters.batch.row import PartRow
from plan_cutters.errors import PlanError
from plan_cutters.files.lock import Lock
from plan_cutters.files.regular import regular_bytes
from plan_cutters.files.seal import seal

#: In the folder of a part that is done: its row, and the checksums of its files.
MARKER = "done.json"
#: Beside the folders of the parts: what is being made.
_STAGING = ".batch"
#: Most bytes of a marker.
_MARKER_BYTES = 16 << 20
_MISSING = 'is not there: pip install "plan-cutters[batch]"'


def file_system(url: str) -> tuple[Any, str]:
    """The file system of a path or URL, and the path on it.

    Raises
    ------
    PlanError
        A package is missing, or the URL has no meaning.
    """
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


def in_memory(url: str) -> bool:
    """Whether a URL names the memory of this process, which no worker sees: its content travels with the task."""
    return url.startswith("memory://")


def read(url: str) -> bytes:
    """The content of a file.

    Raises
    ------
    PlanError
        It cannot be read.
    """
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
        return (f"no credentials ({text}): set those of the storage in the environment, as AWS_ACCESS_KEY_ID and "
                "AWS_SECRET_ACCESS_KEY")  # fmt: skip
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


class Store:
    """The output of a batch.

    Parameters
    ----------
    url : str
        Path or URL of its folder.
    key : bytes, optional
        Seals the markers of parts: one without its seal is none (`files.seal`).

    Raises
    ------
    PlanError
        There is no such file system.
    """

    def __init__(self, url: str, key: bytes | None = None) -> None:
        self.url, self._key = url, key
        self._fs, root = file_system(url)
        self.local = _is_local(self._fs)
        self.root = os.path.abspath(root) if self.local else root.rstrip("/")
        self._token = ""
        self._lock: Lock | None = None

    @property
    def root_url(self) -> str:
        """Its folder, from wherever it is looked at."""
        return self.root if self.local else self.url.rstrip("/")

    def begin(self) -> str:
        """Make sure that files can be written, and drop what a run that was killed left unfinished; a token for workers.

        On this machine nobody else can begin there until `end`. Called again, it gives the same token.

        Raises
        ------
        PlanError
            Nothing can be written there, or another run writes there.
        """
        if not self._token:
            if self.local:
                try:
                    Path(self.root).mkdir(parents=True, exist_ok=True)
                    self._lock = Lock(Path(self.root))
                except OSError as error:
                    raise PlanError(cause(error, "written"), file=self.url) from None
                shutil.rmtree(Path(self.root, _STAGING), ignore_errors=True)
            token = secrets.token_hex(8)
            try:
                self.put(f"{_STAGING}/token", token.encode())
            except PlanError:
                self.end()
                raise
            self._token = token
        return self._token

    def end(self) -> None:
        """Leave nothing but the files of parts and the table, and let others write there."""
        if self._token:
            with contextlib.suppress(Exception):
                self._fs.rm(self._at(_STAGING), recursive=True)
        if self._lock is not None:
            self._lock.release()
        self._token, self._lock = "", None

    def seen(self, token: str) -> bool:
        """Whether this process sees the folder in which the batch was begun."""
        return self._content(f"{_STAGING}/token") == token.encode()

    def put(self, name: str, data: bytes) -> None:
        """Write a file, whole or not at all.

        Raises
        ------
        PlanError
            It cannot be written.
        """
        path = self._at(name)
        try:
            if not self.local:
                self._fs.pipe_file(path, data)
                return
            temporary = Path(path).with_name(f".{Path(path).name}-{secrets.token_hex(4)}")
            try:
                temporary.parent.mkdir(parents=True, exist_ok=True)
                temporary.write_bytes(data)
                os.replace(temporary, path)
            finally:
                temporary.unlink(missing_ok=True)
        except Exception as error:
            raise PlanError(cause(error, "written"), file=f"{self.url}/{name}") from None

    def row(self, folder: str) -> PartRow | None:
        """The row of a part that is done: None where it is not, or where one of its files is no longer there as it was."""
        content = self._content(f"{folder}/{MARKER}")
        if content is None:
            return None
        try:
            marker = json.loads(content)
            row, files = PartRow(**marker["row"]), dict(marker["sha256"])
            if marker["seal"] != seal(marker, self._key) or not files:
                return None
            if all(self._checksum(f"{folder}/{name}") == sha256 for name, sha256 in files.items()):
                return row
        except (ValueError, TypeError, LookupError, AttributeError, RecursionError):
            pass
        return None

    def publish(self, folder: str, files: Mapping[str, Path | bytes], row: PartRow) -> None:
        """Put the files of a part into its folder, in place of all that is there, and mark it as done.

        Raises
        ------
        PlanError
            They cannot be written: the part is not done.
        """
        try:
            options = {
                "row": row.model_dump(mode="json"),
                "sha256": {name: _checksum(what) for name, what in files.items()},
            }
            marker = json.dumps(options | {"seal": seal(options, self._key)}, indent=1).encode()
            if self.local:
                self._rename(folder, files, marker)
            else:
                self._upload(folder, files, marker)
        except Exception as error:
            raise PlanError(cause(error, "written"), file=f"{self.url}/{folder}") from None

    def _rename(self, folder: str, files: Mapping[str, Path | bytes], marker: bytes) -> None:
        made = Path(self.root, _STAGING, secrets.token_hex(8))
        new, old, target = made / "new", made / "old", Path(self.root, folder)
        try:
            new.mkdir(parents=True)
            for name, what in files.items():
                (new / name).parent.mkdir(parents=True, exist_ok=True)
                if isinstance(what, Path):
                    shutil.copyfile(what, new / name)
                else:
                    (new / name).write_bytes(what)
            (new / MARKER).write_bytes(marker)
            target.parent.mkdir(parents=True, exist_ok=True)
            if target.exists():
                os.rename(target, old)
            os.rename(new, target)
        finally:
            shutil.rmtree(made, ignore_errors=True)

    def _upload(self, folder: str, files: Mapping[str, Path | bytes], marker: bytes) -> None:
        before = self._listed(folder)
        if MARKER in before:
            self._fs.rm_file(self._at(f"{folder}/{MARKER}"))
        for name, what in files.items():
            self._fs.pipe_file(self._at(f"{folder}/{name}"), what.read_bytes() if isinstance(what, Path) else what)
        for name in before - set(files) - {MARKER}:
            self._fs.rm_file(self._at(f"{folder}/{name}"))
        self._fs.pipe_file(self._at(f"{folder}/{MARKER}"), marker)

    def _listed(self, folder: str) -> set[str]:
        here = self._at(folder).rstrip("/") + "/"
        try:
            names = self._fs.find(here)
        except FileNotFoundError:
            return set()
        return {path[len(here) :] for path in names if path.startswith(here)}

    def _content(self, name: str) -> bytes | None:
        try:
            if self.local:
                return regular_bytes(self._at(name), _MARKER_BYTES)
            return bytes(self._fs.cat_file(self._at(name)))
        except (OSError, PlanError):
            return None

    def _checksum(self, name: str) -> str | None:
        """SHA-256 of a whole file; None where it cannot be read."""
        try:
            return _checksum(Path(self._at(name)) if self.local else bytes(self._fs.cat_file(self._at(name))))
        except (OSError, ValueError):
            return None

    def _at(self, name: str) -> str:
        return f"{self.root}/{name}"


def _checksum(what: Path | bytes) -> str:
    if isinstance(what, bytes):
        return checksum(what)
    with open_regular(what) as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
