"""Many parts from Python: `plan_many` gives results as they come."""

import contextlib
import os
import pickle
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, Unpack

from plan_cutters.domain.signatures import spelled_out
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.options import Options, PlanOptions
from plan_cutters_base.user_files import noted
from plan_cutters_batch.job import Job, Settings
from plan_cutters_batch.row import UNREADABLE, PartRow, failed

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import Plan


@dataclass(frozen=True)
class Planned:
    """A result holds what came of one of many parts.

    `row`: its line of the table (`name`, `code`, `cutter`, `share`, `error` ...); `files`: by name, where no output was named.
    """

    row: PartRow
    files: dict[str, bytes] = field(default_factory=dict, repr=False)
    _out: str | None = field(default=None, repr=False)

    @property
    def plan(self) -> "Plan | None":
        """The plan document; None where the part failed: then `row.error` says why."""
        from plan_cutters.files.folder import read
        from plan_cutters.plan_file.load import plan_of

        if self.row.folder is None or self.row.status == "failed":
            return None
        content = self.files.get("plan.json") or read(f"{self._out}/{self.row.folder}/plan.json")
        return plan_of(content, "plan.json")


@spelled_out(PlanOptions, Options)
def plan_many(
    parts: Iterable[Any], client: Any = None, *, out: str | os.PathLike[str] | None = None,
    formats: Sequence[str] = ("json",), force: bool = False, timeout_part: float | None = None,
    limit_memory: float | None = None, **options: Unpack[PlanOptions],
) -> Iterator[Planned]:  # fmt: skip
    """Plan many parts, each in a process of its own; results as they come, a failed part among them.

    Parameters
    ----------
    parts : iterable
        Paths, URLs, or objects as `plan` takes them (CadQuery, build123d, `cad_io.Part`). Of objects, the name is their place:
        `part-1`. A pair (name, part) gives another name. They are requested as they are needed.
    client : distributed.Client, optional
        Of a running cluster; default workers of this machine, as many as its cores and memory allow, for this call.
    out : path or URL, optional
        Folder for the files; a part that is done there with the same key is not planned again. Default: results hold their files.
    formats : sequence of str
        As `Result.write` takes them; `json` is always among them.
    force : bool
        Plan what is done, too.
    timeout_part : float, optional
        Seconds for a part.
    limit_memory : float, optional
        GB for a part.
    **options
        As of `plan`; `jobs` is 1 unless it is given.

    Yields
    ------
    Planned

    Raises
    ------
    PlanError
        An option has no meaning, the output cannot be written, or there is no cluster.

    Notes
    -----
    Workers of this machine are started with `spawn`, as dask does: a script calls this below `if __name__ == "__main__":`.
    """
    from plan_cutters.files.folder import refuse_memory
    from plan_cutters.report.folder import read_formats
    from plan_cutters_batch import run as cluster
    from plan_cutters_batch.run import Terms, outcomes
    from plan_cutters_batch.store import Store

    refuse_memory(os.fspath(out or ""))
    if isinstance(parts, str | os.PathLike):
        raise OptionError("parts is one path: give a list of parts, or use the command `batch` for folders")
    if isinstance(parts, Sequence) and not parts:
        raise OptionError("parts: the list is empty")
    with noted() as files:
        base = Options.of({"jobs": 1, **options})
    settings = Settings(base, read_formats(",".join(formats)), read=tuple(filter(None, files.values())))
    store = None if out is None else Store(os.fspath(out))
    with contextlib.ExitStack() as stack:
        if store:
            store.begin()  # what is wrong with it is said before any worker is started
            stack.callback(store.end)
        memory = None if limit_memory is None else limit_memory * 1e9
        if client is None:
            count, memory = cluster.workers_of(None, memory, settings.options.jobs)
            client = stack.enter_context(cluster.opened(None, count))
        terms = Terms(force, timeout_part, memory)
        for outcome in outcomes(_jobs(parts, settings), client, terms, out=store):
            yield Planned(outcome.row, dict(outcome.files), None if store is None else store.root_url)


def _jobs(parts: Iterable[Any], settings: Settings) -> Iterator[Job | PartRow]:
    """Jobs of parts as they are requested, and rows of those that cannot be planned."""
    from cad_io import read_part

    names: set[str] = set()
    for number, entry in enumerate(parts, 1):
        name, part = entry if isinstance(entry, tuple) and len(entry) == 2 and isinstance(entry[0], str) else (None, entry)
        is_file = isinstance(part, str | PurePath)
        file = str(part) if is_file else f"part {number}"
        name = name or (Path(file).stem if is_file else f"part-{number}")
        try:
            if name.casefold() in names:
                raise OptionError(f"has the name {name!r}, as an earlier part: give pairs (name, part)", file=file)
            if name in ("", ".", "..") or "/" in name or "\\" in name or not name.isprintable():
                raise OptionError(f"the name {name!r} cannot be a folder's", file=file)
            names.add(name.casefold())
            if is_file:
                yield Job(name, file, settings)
            else:
                result = read_part(part, settings.options.unit)
                yield Job(name, file, settings.faced(result), pickle.dumps(result, protocol=5))
        except PlanError as error:
            yield failed(f"{name} ({number})" if name.casefold() in names else name, file, str(error))
        except Exception as error:
            yield failed(name, file, f"{file}: {' '.join(str(error).split()) or type(error).__name__}", UNREADABLE)
