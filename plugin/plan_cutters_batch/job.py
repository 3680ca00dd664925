"""A part of a batch and what travels for it: the content of its files, its settings, and the key of both."""

import contextlib
import copy
import functools
import pickle
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path, PurePath, PureWindowsPath
from typing import TYPE_CHECKING, Any, NamedTuple

import plan_cutters
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.errors import OptionError
from plan_cutters.files.folder import read
from plan_cutters.options import Options
from plan_cutters_base import user_files
from plan_cutters_base.stage_cache import PACKAGES, installed, made_by
from plan_cutters_base.user_files import checksum
from plan_cutters_base.values import digest, sources

if TYPE_CHECKING:
    from plan_cutters.command.request import PlanningRequest


class Handed(NamedTuple):
    """Options, ready to travel."""

    #: Pickled.
    options: bytes
    #: Of fixtures, by the names that these have there.
    files: tuple[tuple[str, bytes], ...]


@dataclass(frozen=True)
class Settings:
    """How parts are planned, resolved on the machine where the batch was begun: no worker reads a library or a machine file."""

    options: Options
    #: Of `report.folder.FORMATS`; `json` is always among them, for the table is made from it.
    formats: tuple[str, ...] = ("json",)
    step_schema: str = "ap242"
    #: Seconds that reading may take.
    read_timeout: float = 120.0
    #: SHA-256 of each file that the options were read from: libraries, machine and setup files, and what these name.
    read: tuple[str, ...] = ()
    #: Keep what stages make of a part in the cache folder of each worker's user.
    cache: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "formats", tuple(dict.fromkeys(("json", *self.formats))))

    @property
    def words(self) -> tuple[str, ...]:
        """Of the command line, for what is no option of the plan."""
        return ("--formats", ",".join(self.formats), "--step-schema", self.step_schema, "--read-timeout", repr(self.read_timeout),
                *([] if self.cache else ["--no-cache"]))  # fmt: skip

    @functools.cached_property
    def handed(self) -> Handed:
        """The options as they travel, with the content of the files that fixtures are read from.

        An OptionError where one cannot be read, or where faces are given as objects, which belong to one process.
        """
        files: dict[str, bytes] = {}
        names: dict[str, str] = {}

        def moved(fixture: Fixture) -> Fixture:
            if fixture.kind or not isinstance(fixture.source, str):
                return fixture
            if fixture.source not in names:
                name = PurePath(PureWindowsPath(fixture.source).name).name
                while name in files:
                    name = f"_{name}"
                files[name] = _read(fixture.source)
                names[fixture.source] = name
            # A copy past the checks: they looked at the same words.
            return _with(fixture, source=names[fixture.source])

        def placed(place: Placement | None) -> Placement | None:
            return None if place is None else _with(place, fixtures=tuple(map(moved, place.fixtures)))

        there = _with(
            self.options,
            fixtures=tuple(map(moved, self.options.fixtures)),
            placement=placed(self.options.placement),
            other_placements=tuple(map(placed, self.options.other_placements)),
        )
        try:
            packed = pickle.dumps(there, protocol=5)
        except Exception as error:
            raise OptionError(
                f"faces and fixtures that are objects of another program cannot travel to a worker ({type(error).__name__}): "
                "give numbers, words or files"
            ) from None
        return Handed(packed, tuple(sorted(files.items())))

    @functools.cached_property
    def key(self) -> str:
        """Checksum of all but the part: effective options with tools, machine and fixtures, every file that was read for them,
        what is written, versions.

        The number of threads and the limits of time change no result and do not count.
        """
        options = {each.name: getattr(self.options, each.name) for each in fields(self.options)}
        del options["jobs"]
        parts = [options, sorted(self.formats), sorted(self.read), self.step_schema, program()]
        return digest([parts, *self.handed.files]).hex()

    def faced(self, part: Any) -> "Settings":
        """The same with faces by their numbers, for a part that is an object: its faces cannot be named in another process."""
        from plan_cutters.scene.faces import face_numbers

        changed: dict[str, Any] = {}
        for word in ("faces", "ignore"):
            value = getattr(self.options, word)
            if value is None or isinstance(value, str) or not value:
                continue
            with contextlib.suppress(TypeError):
                if all(isinstance(each, str | int) for each in value):
                    continue
            changed[word] = ",".join(f"F{n}" for n in face_numbers(part, value))
        return replace(self, options=_with(self.options, **changed)) if changed else self


def settings_of(request: "PlanningRequest", formats: Callable[[], Sequence[str]]) -> Settings:
    """The settings of parts, from the words of a command line: what is wrong with them is said before anything is begun."""
    from plan_cutters.command.validation import look_at, options_of, refuse_unplanned_operations

    refuse_unplanned_operations(request)
    with user_files.noted() as files:
        options = options_of(request)
    look_at(options)
    read = tuple(filter(None, files.values()))
    return Settings(options, tuple(formats()), request.step_schema, request.read_timeout, read, request.cache)


def _read(file: str) -> bytes:
    try:
        return user_files.content(file)
    except OSError as error:
        raise OptionError(f"cannot be read: {error.strerror or error}", file=file) from None


def _with(record: Any, **values: Any) -> Any:
    made = copy.copy(record)
    for name, value in values.items():
        object.__setattr__(made, name, value)
    return made


@dataclass(frozen=True)
class Job:
    """A part to plan."""

    #: Among all parts: its folder below the output is `<name>-plan`.
    name: str
    #: Path or URL.
    file: str
    settings: Settings
    #: The pickled `cad_io.Part`, where it is no file.
    part: bytes | None = None

    def content(self) -> bytes:
        """What is planned; a PlanError where it cannot be read."""
        return self.part or read(self.file)


@functools.cache
def _own() -> bytes | None:
    return sources(Path(__file__).parent)


def program() -> bytes:
    """A checksum of what makes plans, and of this package, which makes rows of them."""
    return digest([made_by(), _own()])


def versions() -> dict[str, str]:
    """The versions that must be the same on all machines of a batch: of this program with its checksum, for an edit counts."""
    return {
        "python": platform.python_version(),
        **{name: installed(name) for name in (*PACKAGES, "dask", "distributed")},
        "plan-cutters": f"{plan_cutters.__version__}+{program().hex()[:12]}",
    }


def key_of(content: bytes, settings: str) -> str:
    """The key of a part, from its file and the key of its settings: two runs that have one give the same files."""
    return checksum(f"{checksum(content)} {settings}".encode())
