"""Plan many parts, on this machine or on a cluster."""

import functools
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from plan_cutters.command import terminal
from plan_cutters.command.codes import CODES, FEASIBLE
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.request import PlanningRequest, Reported, takes
from plan_cutters.command.validation import File, Words
from plan_cutters.files.pictures import with_pictures
from plan_cutters.option_table import OPTIONS
from plan_cutters.report.folder import DEFAULT_FORMATS
from plan_cutters_base.terminal_text import clean

if TYPE_CHECKING:
    from plan_cutters_batch.job import Job, Settings
    from plan_cutters_batch.row import PartRow
    from plan_cutters_batch.run import Terms
    from plan_cutters_batch.sources import Source
    from plan_cutters_batch.store import Store

_SELF = "plan-cutters batch"
#: Groups of options that a part of a manifest may have of its own.
_OF_A_PART = {"Cutters", "Machine and setup", "Faces", "Sampling and tolerances", "Postures", "Answers", "Plan of operations"}
_many = heading("Many parts")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class BatchRequest(PlanningRequest, Reported):
    """Plans of many parts on workers: `plan-cutters batch`."""

    sources: tuple[str, ...]
    out: str
    cluster: str | None
    workers: int | None
    timeout_part: float | None
    limit_memory: float | None
    fail_on: str | None
    force: bool
    dry_run: bool


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} parts --out plans --cutters shop.tools", "All parts in a folder, with your tools:"),
        (f"{_SELF} parts.toml --out plans --timeout-part 600", "Parts with options of their own, ten minutes each:"),
        (f"{_SELF} 's3://shop/in/*.step' --out s3://shop/plans", "From a bucket to a bucket:"),
        (f"{_SELF} parts --out plans --cluster tcp://10.0.0.5:8786", "On a running Dask cluster:"),
    ),
    codes=(*((code, what) for code, what in CODES if code != "130"), ("130", "interrupted; parts that are done are stored")),
)
@click.argument("sources", nargs=-1, required=True, metavar="SRC...", type=File("SRC"))
@options(
    *(each.called for each in OPTIONS.values() if each.word not in ("process", "jobs")),
    "assume_stickout",
    "skip_bad",
    "list_cutters",
    "step_schema",
    "quiet",
    out={"required": True, "help": "Folder or URL for the table of all parts, and the folder NAME-plan of each."},
    junit={"help": "Also write what became of each part as JUnit XML; a file on this machine."},
    sarif={},
    formats={
        "help": "As of a single plan; json is always among them, for the table is made of it.  "
        f"[default: {','.join(DEFAULT_FORMATS)}, and png where the extra pictures is installed]"
    },
)
@_many("--cluster", brief="Scheduler of a running Dask cluster, or its scheduler file.", metavar="tcp://HOST:PORT|FILE",
       type=Words("ADDRESS", files=True),
       help="Scheduler of a running Dask cluster, or its scheduler file.  [default: workers of this machine]")  # fmt: skip
@_many("--workers", brief="Workers of this machine, each for one part at a time.", type=click.IntRange(min=1), metavar="N",
       help="Workers of this machine, each for one part at a time.  [default: by its cores and memory]")  # fmt: skip
@_many("--timeout-part", "--timeout", "timeout_part", brief="Seconds for the whole of a part.", type=float, metavar="S",
       help="Seconds for the whole of a part; one that takes longer has failed, with exit code 124.")  # fmt: skip
@_many("--limit-memory", type=float, metavar="GB",
       help="Most memory of a part.  [default: an equal share of 3/4 of this machine's, at least 4]")  # fmt: skip
@_many(
    "--fail-on", brief="Outcomes that give an exit code other than 0.", metavar="WORD[,...]",
    help="What gives an exit code other than 0: unreadable (or crashed), late (--timeout-part), refused (its options), "
    "unfinished, unsure; none: nothing does.  [default: all of them]",
)  # fmt: skip
@_many("--force", brief=True, is_flag=True, help="Plan again what is done already.")
@_many("--dry-run", brief=True, is_flag=True, help="Say what would be planned, and do nothing.")
@options("no_cache", "read_timeout", "debug", jobs={"help": "Threads of each part.  [default: 1]"})
@takes(BatchRequest)
def command(request: BatchRequest) -> int:
    """Plan many parts: files, folders, globs, lists, and manifests (TOML, CSV) with options of each part; here or at URLs.

    Each part is planned in a process of its own on a Dask cluster. What is done is not done again: not after an interrupt, nor
    after parts are added. A part that fails is a row of the table, with its cause.
    """
    from plan_cutters.domain.figures import count as counted
    from plan_cutters.errors import OptionError
    from plan_cutters_batch.row import OUTCOMES, PartRow, code_of, fault, outcome, part_case
    from plan_cutters_batch.run import Terms
    from plan_cutters_batch.store import Store

    if (files := request.case_files) is not None:
        files.check()
    _seen_by_workers(request)
    if request.dry_run and files is not None:
        word = "junit" if request.junit is not None else "sarif"
        raise OptionError(f"--dry-run plans nothing, and --{word} is about what was planned: leave one of them out")
    fail_on = _fail_on(request.fail_on)
    parts = _parts(request)

    def reported(rows: Sequence[PartRow]) -> int:
        """Write the test cases of the parts, where a file for them is named; the largest exit code of what the batch fails on."""
        if files is not None:
            files.write(_SELF, map(part_case, sorted(rows, key=lambda row: row.name)))
        return max((code_of(row) for row in rows if fault(row) in fail_on), default=FEASIBLE)

    faults = [part for part in parts if isinstance(part, PartRow)]
    if len(faults) == len(parts):
        code = reported(faults)
        for row in faults:
            terminal.error(f"{_SELF}: {row.error or ''}")
        return code
    memory = None if request.limit_memory is None else request.limit_memory * 1e9
    for word in ("timeout_part", "limit_memory", "read_timeout"):
        value = getattr(request, word)
        if value is not None and not 0.0 < value < 1e9:
            raise OptionError(f"--{word.replace('_', '-')} must be a positive number")
    if memory is not None and memory < 2e9:
        raise OptionError("--limit-memory must be at least 2 GB")
    if request.cluster is not None and request.workers is not None:
        raise OptionError("--workers is about this machine: leave it out with --cluster")
    out = Store(request.out)
    terms = Terms(request.force, request.timeout_part, memory)
    if request.dry_run:
        return _foreseen(parts, out, terms)
    rows = _planned(parts, out, terms, request)
    code = reported(rows)
    if not request.quiet:
        totals = Counter(map(outcome, rows))
        many = ", ".join(f"{totals[each]} {word}" for each, word in reversed(OUTCOMES.items()) if totals[each])
        terminal.show(f"{counted(totals.total(), 'part')}: {many}.", _where(out))
        terminal.all_shown()
    return code


def _seen_by_workers(request: BatchRequest) -> None:
    """Refuse parts and an output that no worker could reach, before anything is begun."""
    from plan_cutters.command.validation import scheduler, writable
    from plan_cutters.files.folder import refuse_memory

    for word in (*request.sources, request.out):
        refuse_memory(word)
    if request.cluster is not None:
        scheduler(request.cluster)
    if "://" not in request.out and not request.dry_run:
        writable(Path(os.path.expanduser(request.out)))


def _foreseen(parts: "Sequence[Job | PartRow]", out: "Store", terms: "Terms") -> int:
    from plan_cutters_batch.run import foreseen

    code = FEASIBLE
    for row in foreseen(parts, out, terms):
        word = {"planned": "would be planned", "kept": "is done", "failed": "cannot be planned"}[row.status]
        terminal.hand_out(f"{clean(row.name)}: {word}{f': {clean(row.error)}' if row.error else ''}\n")
        code = max(code, row.code if row.status == "failed" else FEASIBLE)
    return code


def _fail_on(words: str | None) -> frozenset[str]:
    """What gives an exit code other than 0."""
    from plan_cutters.errors import OptionError
    from plan_cutters_batch.row import FAIL_ON

    chosen = list(FAIL_ON) if words is None else [word.strip() for word in words.split(",")]
    if chosen == ["none"]:
        return frozenset()
    for word in chosen:
        if word not in FAIL_ON:
            raise OptionError(f"--fail-on takes some of {','.join(FAIL_ON)}, or none, not {word!r}")
    return frozenset(chosen)


def _planned(parts: "Sequence[Job | PartRow]", out: "Store", terms: "Terms", request: BatchRequest) -> "list[PartRow]":
    """Plan them under the eyes of a board."""
    from plan_cutters.domain.figures import count as counted
    from plan_cutters_batch import run as runs
    from plan_cutters_batch.progress import Board

    out.begin()  # what is wrong with it is said before any worker is started
    board = Board(request.quiet, len(parts))
    rows: list[PartRow] = []
    try:
        count, share = runs.workers_of(request.workers, terms.memory, request.jobs or 1)
        if request.cluster is None:
            terms = replace(terms, memory=share)
        with runs.opened(request.cluster, count) as client:
            facts = runs.facts(client)
            board.say(f"{counted(len(parts), 'part')} on {counted(int(str(facts['workers'])), 'worker')} of {facts['address']}")
            board.say(f"Dashboard: {facts['dashboard'] or 'none here; pip install bokeh gives one'}")
            for row in runs.run_batch(parts, client, out, terms, board=board, title=" ".join(request.sources)):
                rows.append(row)
                board.row(row)
    finally:
        board.close()
        out.end()
    return rows


def _where(out: "Store") -> str:
    """Say how to look at the table: no browser opens an address on object storage."""
    from plan_cutters_batch.summary import PAGE

    if out.local:
        return f"Look at them in a browser: {out.root_url}/{PAGE}"
    return f"The table is {out.root_url}/{PAGE}: copy the folder to this machine to open it, or give --out a folder."


def _parts(request: BatchRequest) -> "list[Job | PartRow]":
    """Jobs of all that is meant, with the settings of each."""
    from plan_cutters.command.cli import listed
    from plan_cutters.errors import PlanError
    from plan_cutters_batch.job import Job
    from plan_cutters_batch.row import PartRow, failed
    from plan_cutters_batch.sources import manifest, sources

    own = {p.opts[0][2:]: p for p in command.params if getattr(p, "group", "") in _OF_A_PART and p.expose_value}
    settled = functools.cache(lambda key: _settings(replace(request, **dict(key))))
    settled(())
    jobs: list[Job | PartRow] = []
    for each in sources(listed(request.sources), request.out, lambda file: manifest(file, sorted(own))):
        if isinstance(each, PartRow):
            jobs.append(each)
            continue
        try:
            jobs.append(Job(each.name, each.file, settled(_values(each, own))))
        except (PlanError, click.BadParameter) as error:
            why = error.format_message() if isinstance(error, click.BadParameter) else str(error)
            jobs.append(failed(each.name, each.file, f"{each.place}: {why}"))
    return jobs


def _values(source: "Source", own: Mapping[str, click.Parameter]) -> tuple[tuple[str, Any], ...]:
    """The options of a part as the command line would have them: each takes the place of the one for all parts."""
    from plan_cutters.errors import OptionError

    values = []
    near = os.path.dirname(source.place) if "://" not in source.place else ""
    for word, value in source.options.items():
        option = own[word.replace("_", "-")]
        several = value if isinstance(value, list) else [value]
        if isinstance(option, click.Option) and option.is_flag:
            if str(value).lower() not in ("true", "false", "1", "0", "yes", "no"):
                raise OptionError(f"{word} is true or false, not {value!r}")
            taken: Any = str(value).lower() in ("true", "1", "yes")
        elif not option.multiple and isinstance(value, list):
            raise OptionError(f"{word} takes one value, not a list")
        else:
            files = isinstance(option.type, Words) and option.type.files
            words = [_relative_to(str(each), near) if files or word == "setup" else str(each) for each in several]
            taken = option.type_cast_value(click.Context(command), words if option.multiple else words[0])
        values.append((str(option.name), taken))
    return tuple(values)


def _relative_to(word: str, folder: str) -> str:
    """A file's name as the manifest has it, which is beside the manifest: the same from here."""
    file, at, rest = word.partition("@")
    there = os.path.join(folder, file)
    return f"{there}{at}{rest}" if folder and file and not os.path.isabs(file) and os.path.exists(there) else word


@functools.cache
def _formats() -> tuple[str, ...]:
    return with_pictures(DEFAULT_FORMATS, lambda line: terminal.error(f"{_SELF}: {line}"))


def _settings(request: BatchRequest) -> "Settings":
    from plan_cutters.report.folder import read_formats
    from plan_cutters_batch.job import settings_of

    request = replace(request, jobs=request.jobs or 1)
    return settings_of(request, lambda: _formats() if request.formats is None else read_formats(request.formats))
