"""The output of a batch, on any file system that fsspec knows: the files of a part are there whole, or the part is not done.

On this machine the folder of a part is made aside and takes its place by renaming. Object storage has no renaming of folders:
there the marker of a part is removed first and written last, so that a part without one is not done, whatever files lie there.
"""

import contextlib
import functools
import json
import os
import secrets
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from plan_cutters.errors import PlanError
from plan_cutters.files.folder import Folder, cause, checksum_of
from plan_cutters.files.lock import Lock
from plan_cutters_base.user_files import checksum, open_regular
from plan_cutters_batch.row import PartRow

#: In the folder of a part that is done: its row, and the checksums of its files.
MARKER = "done.json"
#: Beside the folders of the parts: what is being made.
_STAGING = ".batch"
#: Most bytes of a marker.
_MARKER_BYTES = 16 << 20


class Store(Folder):
    """The output of a batch, by the path or URL of its folder; a PlanError where there is no such file system."""

    def __init__(self, url: str) -> None:
        super().__init__(url)
        self._token = ""
        self._lock: Lock | None = None

    def begin(self) -> str:
        """Make sure that files can be written, and drop what a run that was killed left unfinished; a token for workers.

        On this machine nobody else can begin there until `end`. Called again, it gives the same token. A PlanError where nothing
        can be written, or another run writes there.
        """
        if not self._token:
            if self.local:
                try:
                    Path(self.root).mkdir(parents=True, exist_ok=True)
                    self._lock = Lock(Path(self.root))
                except OSError as error:
                    raise PlanError(cause(error, "written"), file=self.url) from None
                self.clear(_STAGING)
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
            self.clear(_STAGING)
        if self._lock is not None:
            self._lock.release()
        self._token, self._lock = "", None

    def seen(self, token: str) -> bool:
        """Whether this process sees the folder in which the batch was begun."""
        return self._content(f"{_STAGING}/token") == token.encode()

    def put(self, name: str, data: bytes) -> None:
        """Write a file, whole or not at all; a PlanError where it cannot be written."""
        try:
            super().put(name, data)
        except Exception as error:
            raise PlanError(cause(error, "written"), file=f"{self.url}/{name}") from None

    def row(self, folder: str) -> PartRow | None:
        """The row of a part that is done; None where it is not, a file of it has changed, or another user wrote it."""
        content = self._content(f"{folder}/{MARKER}", mine=True)
        if content is None:
            return None
        try:
            marker = json.loads(content)
            row, files = PartRow(**marker["row"]), dict(marker["sha256"])
            if not files or marker["seal"] != _seal(marker):
                return None
            if all(self.checksum(f"{folder}/{name}") == sha256 for name, sha256 in files.items()):
                return row
        except (ValueError, TypeError, LookupError, AttributeError, RecursionError):
            pass
        return None

    def publish(self, folder: str, files: Mapping[str, Path | bytes], row: PartRow) -> None:
        """Put the files of a part in place of all in its folder, and mark it as done; a PlanError if that cannot be written."""
        try:
            options = {"row": row.model_dump(mode="json"), "sha256": {name: checksum_of(what) for name, what in files.items()}}
            marker = json.dumps(options | {"seal": _seal(options)}, indent=1).encode()
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
            with contextlib.suppress(OSError):  # some shares have no rights of files
                (new / MARKER).chmod(0o644)
            target.parent.mkdir(parents=True, exist_ok=True)
            if target.exists():
                os.rename(target, old)
            os.rename(new, target)
        finally:
            shutil.rmtree(made, ignore_errors=True)

    def _upload(self, folder: str, files: Mapping[str, Path | bytes], marker: bytes) -> None:
        before = self.names(folder)
        if MARKER in before:
            self.remove(f"{folder}/{MARKER}")
        for name, what in files.items():
            super().put(f"{folder}/{name}", what.read_bytes() if isinstance(what, Path) else what)
        for name in before - set(files) - {MARKER}:
            self.remove(f"{folder}/{name}")
        super().put(f"{folder}/{MARKER}", marker)

    def _content(self, name: str, *, mine: bool = False) -> bytes | None:
        try:
            if mine and self.local:
                with open_regular(self._at(name)) as file:
                    if os.fstat(file.fileno()).st_uid != self._user:
                        return None
                    return file.read(_MARKER_BYTES)
            return self.get(name, _MARKER_BYTES)
        except (OSError, ValueError, PlanError):
            return None

    @functools.cached_property
    def _user(self) -> int:
        """The owner of what this process writes there: on a share it may be another one than the user of this process."""
        with contextlib.suppress(OSError), tempfile.TemporaryFile(dir=self.root) as probe:
            return os.fstat(probe.fileno()).st_uid
        return int(getattr(os, "getuid", int)())


def _seal(marker: Mapping[str, Any]) -> str:
    """The checksum of a marker, all but its own entry `seal`."""
    return checksum(json.dumps({name: value for name, value in marker.items() if name != "seal"}, sort_keys=True).encode())
