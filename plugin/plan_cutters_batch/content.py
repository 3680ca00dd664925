"""The content of a part's file, with that of the files that it refers to: what a part is known by, and what travels."""

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from cad_io.read.references import followed
from plan_cutters.errors import PlanError
from plan_cutters.files import folder as files
from plan_cutters_base.user_files import checksum, checksums, fingerprint


@dataclass(frozen=True)
class Content:
    """The bytes of a CAD file, and of the files that it refers to, are one content.

    Attributes
    ----------
    data : bytes
        Of the file itself.
    references : tuple of (str, bytes or None)
        Of each of the others, by its path from the file's folder; None: it is not there.
    """

    data: bytes
    references: tuple[tuple[str, bytes | None], ...] = ()

    @property
    def key(self) -> str:
        """Checksum of all of it."""
        return fingerprint(checksum(self.data), checksums(self.references))

    def write(self, file: Path) -> None:
        """Write the file, and those that it refers to where they lie in or below its folder.

        What lies elsewhere is missing there, or read where it lies if its whole path is given.
        """
        file.write_bytes(self.data)
        for name, data in self.within():
            there = file.parent / name
            there.parent.mkdir(parents=True, exist_ok=True)
            there.write_bytes(data)

    def within(self) -> Iterator[tuple[str, bytes]]:
        """The files in or below its folder that it refers to, and that are there."""
        return ((name, data) for name, data in self.references if data is not None and _is_within(name))

    def outside(self) -> tuple[tuple[str, str | None], ...]:
        """Checksums of the other files that it refers to, by their paths; None: not there."""
        return checksums((name, data) for name, data in self.references if not _is_within(name))


def _is_within(name: str) -> bool:
    return not os.path.isabs(name) and name.split(os.sep)[0] != ".."


def content(file: str, read: Callable[[str], bytes] = files.read) -> Content:
    """Read a file, and all that it refers to.

    Parameters
    ----------
    file : str
        Path or URL.
    read : callable
        Content of a file; a PlanError where it cannot be read. One whose whole path is given lies on this machine.

    Raises
    ------
    PlanError
        The file cannot be read. One that it refers to may be missing.
    """
    folder, slash, _ = file.rpartition("/")

    def other(name: str) -> bytes | None:
        try:
            return files.read(name) if os.path.isabs(name) else read(f"{folder}{slash}{name}")
        except PlanError:
            return None

    data = read(file)
    return Content(data, tuple(followed(data, other)))
