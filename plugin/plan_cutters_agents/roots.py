"""Folders that calls may read from and write to; everything else is refused."""

import os
import stat
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote, urlsplit

from plan_cutters_agents.limits import CallError


@dataclass(frozen=True, slots=True)
class Roots:
    """Folders, resolved; a path counts by where it ends after `..` and links, not by how it is written."""

    folders: tuple[Path, ...]

    @classmethod
    def of(cls, folders: Iterable[str | os.PathLike[str]]) -> "Roots":
        """Resolve folders.

        Raises
        ------
        CallError
            One is no folder.
        """
        roots = []
        for each in folders:
            try:
                path = Path(each).resolve(strict=True)
            except (OSError, ValueError, RuntimeError):
                path = None
            if path is None or not path.is_dir():
                raise CallError("is no folder; give one with --root", file=str(each))
            roots.append(path)
        return cls(tuple(dict.fromkeys(roots)))

    @classmethod
    def of_client(cls, uris: Sequence[str]) -> "Roots":
        """Folders that a client offers, as `file://` addresses; others and those that are not here say nothing."""
        roots = []
        for uri in uris:
            parts = urlsplit(uri)
            if parts.scheme != "file" or parts.netloc not in ("", "localhost"):
                continue
            try:
                path = Path(unquote(parts.path)).resolve(strict=True)
            except (OSError, ValueError, RuntimeError):
                continue
            if path.is_dir():
                roots.append(path)
        return cls(tuple(dict.fromkeys(roots)))

    def __or__(self, other: "Roots") -> "Roots":
        return Roots(tuple(dict.fromkeys((*self.folders, *other.folders))))

    def confined(self, text: str) -> Path:
        """Where a path ends; one that is not absolute begins at the first root in which it exists.

        Raises
        ------
        CallError
            It ends outside all roots, or is no name of a file.
        """
        if not self.folders:
            raise CallError("there is no root: start the server with --root DIR, and files in DIR can be named", file=text)
        try:
            ways = [(root / text).resolve() for root in self.folders]
            inside = [way for way in ways if any(way.is_relative_to(root) for root in self.folders)]
            there = next((way for way in inside if way.exists()), None)
        except (OSError, ValueError, RuntimeError):
            raise CallError("is no name of a file", file=ascii(text)[:200]) from None
        if not inside:
            raise CallError("lies outside the roots; name a file in one of them", file=text)
        return there or inside[0]

    def file(self, text: str, most_mb: float) -> Path:
        """A regular file in a root that is no larger than `most_mb` million bytes.

        Raises
        ------
        CallError
        """
        path = self.confined(text)
        try:
            status = path.stat()
        except OSError as error:
            why = "no such file" if isinstance(error, FileNotFoundError) else error.strerror or "cannot be read"
            raise CallError(why, file=text) from None
        if not stat.S_ISREG(status.st_mode):
            raise CallError("is no file", file=text)
        if status.st_size > most_mb * 1e6:
            size = status.st_size / 1e6
            raise CallError(f"has {size:,.0f} MB, and this server reads at most {most_mb:g} MB (--most-mb)", file=text)
        return path

    def folder(self, text: str) -> Path:
        """A folder in a root to write to, that exists or that can be made in one that does.

        Raises
        ------
        CallError
        """
        path = self.confined(text)
        if path in self.folders:
            raise CallError("is a root itself; name a folder in it", file=text)
        if path.exists() and not path.is_dir():
            raise CallError("is a file; name a folder", file=text)
        return path
