"""Results of stages are kept for the next question about a part: in the cache folder of this user, by all that they follow from.

It is the one store of kept work. An entry's name is a checksum of the stage, of what the stage was given, and of this program and
its packages. What is read back has the checksum, over its name too, that it was written with: what a full disk or a power cut
damaged, and what belongs to another name, is made again; what cannot be written costs time alone. Entries are arrays and JSON.
Only what lies in a folder of this user, which nobody else may write to, is read: whoever may write there may give any answer.
"""

import contextlib
import functools
import importlib.util
import os
import time
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any, Self, TypeVar, cast

from plan_cutters_base.fingerprint import PROGRAM
from plan_cutters_base.user_cache import CacheWarning, own, read_entry, roots, writable, write_entry
from plan_cutters_base.values import digest, packed, sources, unpacked

Made = TypeVar("Made")

#: Environment variables: the folder, nothing is kept where it is empty; and the most that is kept, MB. Else so many bytes.
FOLDER, SIZE, MOST = "PLAN_CUTTERS_CACHE", "PLAN_CUTTERS_CACHE_MB", 2 << 30
#: What takes less, s, is made again: reading it would take as long.
_WORTH = 0.15
#: The end of the name of an entry.
_SUFFIX = ".stage"
#: What was begun so long ago, s, and is not done, never will be.
_ABANDONED = 3600.0
#: Packages whose results may differ from version to version.
PACKAGES = ("cadquery-ocp-proxy", "numba", "numpy", "scipy", "shapely")


@dataclass(frozen=True, slots=True)
class StageCache:
    """A folder of results of stages; without one, nothing is kept, and nothing was."""

    folder: Path | None
    #: Bytes that are kept: what was used least lately goes first.
    most: int = MOST

    @classmethod
    def of_user(cls) -> Self | None:
        """The cache of this user; None where nothing is to be kept, or no folder is safe and can be written.

        A folder that was named and is refused is warned of.
        """
        named, size = os.environ.get(FOLDER), os.environ.get(SIZE, "")
        if named == "" or (size and not size.isdecimal()):
            return None
        if not (most := int(size) << 20 if size else MOST):
            return None
        for folder in [Path(named)] if named else [root / "stages" for root in roots()]:
            with contextlib.suppress(OSError):
                folder.mkdir(mode=0o700, parents=True, exist_ok=True)
                if writable(folder) and own(folder.stat()):
                    return cls(folder, most)
        if named:
            why = "it must be yours, and nobody else may write there"
            warnings.warn(f"{FOLDER} {named}: the folder is not used: {why}", CacheWarning, stacklevel=2)
        return None

    def cached(
        self, stage: str, follows_from: object, make: Callable[[], Made], keep: Callable[[Made], bool] | None = None
    ) -> Made:
        """Return what a stage makes: read, where it was made before, or made and written.

        `follows_from`: all that the result depends on, as `digest` takes it. `keep`: whether a result may be kept: not what a
        limit of time ended.
        """
        if (path := self._place(stage, follows_from)) is None:
            return make()
        # Whatever is wrong with an entry, it is made again.
        with contextlib.suppress(Exception):
            if (content := read_entry(path)) is not None:
                return cast(Made, unpacked(content))
        began = time.perf_counter()
        result = make()
        if time.perf_counter() - began >= _WORTH and (keep is None or keep(result)):
            _writer().submit(self._write, path, result)
        return result

    def holds(self, stage: str, follows_from: object) -> bool:
        """Whether there is an entry, be it damaged."""
        path = self._place(stage, follows_from)
        return path is not None and path.exists()

    def _place(self, stage: str, follows_from: object) -> Path | None:
        if self.folder is None:
            return None
        return self.folder / f"{stage}-{digest([stage, follows_from, made_by()]).hex()[:40]}{_SUFFIX}"

    def _write(self, path: Path, result: object) -> None:
        # Whatever keeps it from being written, the work goes on.
        with contextlib.suppress(Exception):
            write_entry(path, packed(result), self.most)
        self._trim()

    def _trim(self) -> None:
        """Take away what was used least lately, and what was never finished."""
        with contextlib.suppress(OSError):
            entries, now = [], time.time()
            for entry in os.scandir(self.folder):
                with contextlib.suppress(OSError):
                    status = entry.stat(follow_symlinks=False)
                    if entry.name.startswith("."):
                        if now - status.st_mtime > _ABANDONED:
                            os.unlink(entry.path)
                    elif entry.name.endswith(_SUFFIX):
                        entries.append((status.st_mtime, status.st_size, entry.path))
            size = sum(each for _, each, _ in entries)
            for _, mine, path in sorted(entries):
                if size <= self.most:
                    break
                with contextlib.suppress(OSError):
                    os.unlink(path)
                size -= mine


#: The cache of those who keep nothing.
NO_CACHE = StageCache(None)


class RunCache:
    """A run keeps what its stages made: a part that is prepared twice, for setups that are proposed and in them, is sampled once.

    `lasting` is asked for what was not made in this run.
    """

    def __init__(self, lasting: StageCache) -> None:
        self._lasting, self._made = lasting, dict[bytes, Any]()

    def holds(self, stage: str, follows_from: object) -> bool:
        """As of a `StageCache`."""
        return digest([stage, follows_from]) in self._made or self._lasting.holds(stage, follows_from)

    def cached(
        self, stage: str, follows_from: object, make: Callable[[], Made], keep: Callable[[Made], bool] | None = None
    ) -> Made:
        """As of a `StageCache`; what was made in this run is the same object."""
        name = digest([stage, follows_from])
        if name not in self._made:
            self._made[name] = self._lasting.cached(stage, follows_from, make, keep)
        return cast(Made, self._made[name])


#: Of these a stage does not know which it has.
Cache = StageCache | RunCache


@functools.cache
def _writer() -> ThreadPoolExecutor:
    """Writes beside the work, one entry at a time; it is done before the process ends."""
    return ThreadPoolExecutor(1, "stage-cache")


# A copy of the process has no threads: it gets a writer of its own.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_writer.cache_clear)


def settle() -> None:
    """Wait until all that is to be kept is written."""
    _writer().submit(lambda: None).result()


@functools.cache
def made_by() -> bytes:
    """A checksum of this program, all files of its packages, and of the packages that results may differ with."""
    # Without files there is nothing to tell one program from another: then nothing is found again.
    specs = [importlib.util.find_spec(name) for name in PROGRAM]
    program = sources(*(Path(str(each.origin)).parent for each in specs if each is not None)) or os.urandom(16)
    return digest([program, [installed(name) for name in PACKAGES]])


def installed(name: str) -> str:
    """The version of a package that is here, or `none`."""
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "none"
