"""The requests of the commands: frozen records, which `takes` alone makes of the values that click has parsed.

Names and values are those of the command line, angles in degrees; the functions at the end say which options of a plan they are.
Records are neither compared nor printed: to make what that takes would cost time at each start.
"""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import radians
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

from plan_cutters.option_table import OPTIONS

if TYPE_CHECKING:
    from plan_cutters.cases.files import CaseFiles
    from plan_cutters.domain.cutter import Cutter
    from plan_cutters.domain.holder import Holder
    from plan_cutters.library.raw_tool import Library
    from plan_cutters.options import PlanOptions

#: A setup: a direction of the part, a setup file, or `auto`.
Setup = tuple[float, ...] | str
#: Two angles, degrees.
Range = tuple[float, float]

R = TypeVar("R")


def takes(record: type[R]) -> Callable[[Callable[[R], int]], Callable[..., int]]:
    """Make a function of a record one that click can call with a value for each of its fields."""

    def decorated(work: Callable[[R], int]) -> Callable[..., int]:
        @functools.wraps(work)
        def called(**values: Any) -> int:
            return work(record(**values))

        return called

    return decorated


def _with_options(*, of_a_point: bool) -> Callable[[type[R]], type[R]]:
    """Give a record a field for each option of a plan that it does not name itself, for type checkers of what is made here."""

    def widened(record: type[R]) -> type[R]:
        for each in OPTIONS.values():
            if each.of_a_point is of_a_point and each.word != "process":
                kind = Range if each.kind == "range" else tuple[str, ...] if each.several else each.kind
                record.__annotations__.setdefault(each.word, kind | None if each.default is None else kind)
        return record

    return widened


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
@_with_options(of_a_point=True)
class PostureRequest:
    """The common fields of all commands that judge postures: the machine, the obstacles and the search.

    What is not named here is in no command's own work: `posture_options` and `planning_options` hand it on.
    """

    holder: str | None
    machine: str
    tolerance: float
    tilt: Range | None
    rotation: Range
    rotation_step: float
    quiet: bool
    debug: bool


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
@_with_options(of_a_point=False)
class PlanningRequest(PostureRequest):
    """The common fields of all commands that plan parts."""

    cutters: tuple[str, ...]
    libraries: tuple[str, ...]
    assume_stickout: float | None
    skip_bad: bool
    setup: tuple[Setup, ...]
    jobs: int | None
    operations: str | None
    formats: str | None
    step_schema: str
    cache: bool
    read_timeout: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Reported:
    """Files of test cases."""

    junit: str | None
    sarif: str | None

    @property
    def case_files(self) -> "CaseFiles | None":
        """Those that are requested, if any is."""
        if self.junit is None and self.sarif is None:
            return None
        from plan_cutters.cases.files import CaseFiles

        return CaseFiles(self.junit, self.sarif)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PlanRequest(PlanningRequest, Reported):
    """Plans of some parts: `plan-cutters`."""

    parts: tuple[str, ...]
    check_operations: str | None
    process: str | None
    out: str | None
    json_out: str | None
    verbose: bool
    wait: bool
    fail_under: float | None
    timeout: float | None
    memory: float | None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MapRequest(PostureRequest):
    """All postures of one cutter at one point: `plan-cutters map`."""

    part: str
    at: str
    within: float
    cutters: str | None  #: One, of the one library where that is named.
    libraries: str | None
    setup: str
    out: tuple[str, ...]
    json_out: str | None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ToolsRequest:
    """Tool libraries as they are understood: `plan-cutters tools`."""

    files: tuple[str, ...]
    cutters: tuple[str, ...]
    holder: str | None
    assume_stickout: float | None
    skip_bad: bool
    list_holders: bool
    as_json: bool
    to_toml: str | None
    draw: str | None
    debug: bool


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class MachinesRequest:
    """Machines as they are understood: `plan-cutters machines`."""

    machines: tuple[str, ...]
    angles: str | None
    axis: str | None
    as_json: bool
    to_toml: str | None
    debug: bool


def planning_options(request: PlanningRequest) -> "PlanOptions":
    """The options of a plan that a command line requests, as `Options` takes them."""
    tools = read_tools(request.cutters, request.libraries, request.holder, request.assume_stickout, skip_bad=request.skip_bad)
    # The words of choices were looked at where the command line was read.
    words: Any = {**_handed_on(request, of_a_point=False), **posture_options(request), **tools._asdict()}
    words |= {"setup": request.setup[0], "other_setups": request.setup[1:]}
    return cast("PlanOptions", words)


def posture_options(request: PostureRequest) -> "PlanOptions":
    """The options among them that judge a posture, without the tools."""
    from plan_cutters.domain.posture import PostureRange

    postures = PostureRange.degrees(request.tilt or (0.0, 90.0), request.rotation, request.rotation_step)
    words = _handed_on(request, of_a_point=True)
    words |= {"tilt": postures.tilt if request.tilt else None, "rotation": postures.rotation, "rotation_step": postures.step}
    del words["holder"]
    return cast("PlanOptions", words)


def _handed_on(request: PostureRequest, *, of_a_point: bool) -> dict[str, Any]:
    """Values by their options, angles in radians."""
    words = {}
    for each in OPTIONS.values():
        if each.of_a_point is of_a_point:
            value = getattr(request, each.word, None)
            words[each.word] = radians(value) if value is not None and each.unit == "deg" else value
    return words


class Tools(NamedTuple):
    """Cutters of texts, libraries of files, and the holder of the cutters that have none."""

    cutters: "tuple[Cutter, ...]"
    libraries: "tuple[Library, ...]"
    holder: "Holder | None"


def read_tools(
    cutters: Sequence[str], libraries: Sequence[str], holder: str | None, assume_stickout: float | None = None, *,
    skip_bad: bool = False,
) -> Tools:  # fmt: skip
    """Read what the command line says of tools; a PlanError for what has no meaning."""
    from plan_cutters.domain.cutter import Cutter
    from plan_cutters.errors import OptionError

    read: list[Library] = []
    of_all: Holder | str | None = None
    if holder is not None or libraries:
        # Who names neither need not load the readers.
        from plan_cutters.library.read import holder_of, read_library

        of_all = None if holder is None else holder_of(holder)
        read = [read_library(file, assume_stickout=assume_stickout, holder=of_all, skip_bad=skip_bad) for file in libraries]
    if not libraries and (assume_stickout is not None or skip_bad):
        word = "--skip-bad" if skip_bad else "--assume-stickout"
        raise OptionError(f"{word} is about the tools of a library: give it with --cutters")
    parsed = tuple(Cutter.parse(spec) for spec in cutters)
    return Tools(parsed, tuple(read), None if isinstance(of_all, str) else of_all)
