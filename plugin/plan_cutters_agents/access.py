"""A call may cost, read and write so much: whoever starts the server sets it, whoever calls does not; all else is refused."""

import os
import stat
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

from plan_cutters.errors import PlanError

if TYPE_CHECKING:
    from plan_cutters_agents.requests import Conditions, MapQuestion, PartQuestion


class CallError(PlanError):
    """A call that cannot be answered; `str` is one line about it."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Largest values of a call."""

    #: Size of a file that is read, millions of bytes.
    most_mb: float = 200.0
    #: Samples of a plan, all target faces together.
    most_samples: int = 200_000
    #: Cutters of a call, those of a library included.
    most_cutters: int = 50
    #: Of a call, by the clock, waiting for its turn included.
    timeout: float = 900.0
    #: Of an answer, as JSON. Lists are cut until it fits.
    most_characters: int = 40_000
    #: That work at the same time; the others wait.
    calls: int = 2
    #: Of each process; None: what the command takes by default.
    memory: float | None = None


@dataclass(frozen=True, slots=True)
class Roots:
    """Folders, resolved; a path counts by where it ends after `..` and links, not by how it is written."""

    folders: tuple[Path, ...]

    @classmethod
    def of(cls, folders: Iterable[str | os.PathLike[str]]) -> "Roots":
        """Resolve folders; a CallError where one is no folder."""
        paths = {each: _folder(each) for each in folders}
        for each in (each for each, path in paths.items() if path is None):
            raise CallError("is no folder; give one with --root", file=str(each))
        return cls(tuple(dict.fromkeys(filter(None, paths.values()))))

    @classmethod
    def of_client(cls, uris: Sequence[str]) -> "Roots":
        """Folders that a client offers, as `file://` addresses; others and those that are not here say nothing."""
        parts = [each for each in map(urlsplit, uris) if each.scheme == "file" and each.netloc in ("", "localhost")]
        return cls(tuple(dict.fromkeys(filter(None, (_folder(unquote(each.path)) for each in parts)))))

    def __or__(self, other: "Roots") -> "Roots":
        return Roots(tuple(dict.fromkeys((*self.folders, *other.folders))))

    def confined(self, text: str) -> Path:
        """Where a path ends, from the first root in which it exists; a CallError outside all roots, or for no name of a file."""
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
        """A regular file in a root that is no larger than `most_mb` million bytes; a CallError where it is none."""
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
        """A folder in a root to write to, that exists or that can be made in one that does; else a CallError."""
        path = self.confined(text)
        if path in self.folders:
            raise CallError("is a root itself; name a folder in it", file=text)
        if path.exists() and not path.is_dir():
            raise CallError("is a file; name a folder", file=text)
        return path


def _folder(path: str | os.PathLike[str]) -> Path | None:
    """The folder where a path ends; None where there is none."""
    try:
        there = Path(path).resolve(strict=True)
    except (OSError, ValueError, RuntimeError):
        return None
    return there if there.is_dir() else None


def spelled(**values: Any) -> list[str]:
    """Options as a command line has them: flags, numbers and texts, each of a list; nothing for None and False.

    >>> spelled(flip=True, grid=None, rotation_step=5.0, setup=["+z", "-y"])
    ['--flip', '--rotation-step=5.0', '--setup=+z', '--setup=-y']
    """
    words = []
    for name, value in values.items():
        for each in value if isinstance(value, list) else [] if value is None or value is False else [value]:
            text = "" if each is True else f"={each}"
            words.append(f"--{name.replace('_', '-')}{text}")
    return words


@dataclass(frozen=True)
class Permissions:
    """A call may read and write here, and cost so much: questions become words of the command, with files in roots alone."""

    roots: Roots
    limits: Limits

    def file(self, text: str) -> str:
        """The path of a file that may be read."""
        return str(self.roots.file(text, self.limits.most_mb))

    def conditions(self, question: "Conditions") -> list[str]:
        """Words for what cutters are judged under, without the cutters."""
        return spelled(
            tolerance=question.tolerance_mm,
            allowance=question.allowance_mm,
            holder_clearance=question.holder_clearance_mm,
            machine=self._machine(question.machine),
            cutters=None if question.library is None else self.file(question.library),
            holder=None if question.holder is None else self._holder(question.holder),
            fixture=[self._fixture(each) for each in question.fixtures],
            ignore=question.ignore,
            unit=question.unit,
            flip=question.flip,
        )

    def part(self, question: "PartQuestion") -> list[str]:
        """Words for a part, its cutters and their conditions."""
        if len(question.cutters) > self.limits.most_cutters:
            raise CallError(
                f"cutters: {len(question.cutters)} are given, and this server judges at most {self.limits.most_cutters} in a call"
            )
        # The area between the samples is not looked at.
        words = spelled(area_budget=0, faces=question.faces, grid=question.grid, spacing=question.spacing_mm,
                        cutter=question.cutters, setup=question.setup)  # fmt: skip
        return [self.file(question.part), *self.conditions(question), *words]

    def map(self, question: "MapQuestion") -> list[str]:
        """Words for a posture map."""
        tilt = None if question.tilt_deg is None else "{!r}:{!r}".format(*question.tilt_deg)
        words = spelled(at=",".join(map(repr, question.point)), within=question.within_mm, cutter=question.cutter,
                        setup=question.setup, rotation_step=question.rotation_step_deg, tilt=tilt)  # fmt: skip
        return [self.file(question.part), *self.conditions(question), *words]

    def _machine(self, text: str) -> str:
        from plan_cutters.domain.machine import builtin_machines

        known = text == "unlimited" or text.startswith("tilt:") or text in builtin_machines()
        return text if known else self._marked(text)

    def _holder(self, text: str) -> str:
        from plan_cutters.domain.holder import Holder

        if text.strip().lower() == "none":
            return "none"
        try:
            Holder.parse(text)
        except PlanError as error:
            if not ("/" in text or "\\" in text or "#" in text or Path(text).suffix):
                raise CallError(str(error)) from None
            return self._marked(text)
        # A word that is a holder is read as one, whatever file there is.
        return text

    def _marked(self, text: str) -> str:
        """A file, or `FILE#MORE` where no file has the whole name."""
        file, mark, more = text.rpartition("#")
        if mark and not self.roots.confined(text).exists():
            return f"{self.file(file)}#{more}"
        return self.file(text)

    def _fixture(self, text: str) -> str:
        from plan_cutters.domain.fixture import Fixture

        fixture = Fixture.parse(text)
        if fixture.kind:
            return text
        # Placement and unit are said, so that nothing in the path of a root is taken for them.
        where = ",".join(map(repr, fixture.placement))
        return f"{self.file(fixture.source)}@{where}{f':{fixture.unit}' if fixture.unit else ''}"
