"""One part: planned, written, summarised; and what is said when its models could not be made to an end."""

import gc
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from plan_cutters.command.codes import UNREADABLE, code_of
from plan_cutters.command.progress import Progress
from plan_cutters.command.summary import not_reached, summary, written
from plan_cutters.command.supervise import INTERRUPTED, Unfinished, report, report_work

if TYPE_CHECKING:
    from plan_cutters.document.model import Plan
    from plan_cutters.options import Options


def one_part(
    part: str, out: Path, options: "Options", given: dict[str, Any], began: float | None = None
) -> tuple[int, str]:
    """Plan one part; exit code and a line about it. `began`: when the command did, for the first part (`time.monotonic`)."""
    from plan_cutters.report import DEFAULT_FORMATS, PLAN, Staging, file_name, read_formats, write_all
    from plan_cutters.report.to_json import dumps, explain

    to_stdout = given["json_out"] == "-"
    # The plan on standard output: files only where they are asked for.
    default = () if to_stdout and given["out"] is None else DEFAULT_FORMATS
    formats = read_formats(given["formats"]) if given["formats"] else default
    report("part", part)
    staging = Staging(out, lambda folder: report("staging", str(folder))) if formats else None
    watch = Onlooker(out, given)
    try:
        ahead = _compiling(options, given["quiet"])
        import plan_cutters.report.models  # noqa: F401  all that takes time to load is loaded in the stage `start`
        from cad_io.kernel.limited import KERNEL_THREADS
        from plan_cutters.document.clock import Clock
        from plan_cutters.pipeline import run

        KERNEL_THREADS.set(options.jobs)
        gc.freeze()
        gc.enable()
        with Progress(given["quiet"]) as tell:
            clock = Clock(tell, began=began)
            result = run(part, options, clock, read_timeout=given["read_timeout"], at=report_work, ahead=ahead)
        document = result.plan
        if not formats:
            watch.summarise(document)
        else:
            with watch:
                document = write_all(result, out, formats, staging, step_schema=given["step_schema"], onlooker=watch,
                                     clock=clock)  # fmt: skip
    except KeyboardInterrupt:
        if watch.plan is None:
            raise
        explain(out / PLAN, "interrupted")
        return INTERRUPTED, f"plan-cutters: interrupted; the plan is in {out}, not all models are"
    finally:
        if staging:
            staging.discard()
    if to_stdout:
        sys.stdout.write(dumps(document))
        sys.stdout.flush()
    if not given["quiet"]:
        for line in (*written(document, out, formats), *not_reached(document)):
            click.echo(line, err=True)
    for name, why in document.not_written.items():
        click.echo(f"plan-cutters: {file_name(name)} was not written: {why}", err=True)
    return code_of(document), ""


def _compiling(options: "Options", quiet: bool) -> Callable[[], None]:
    """Let machine code be made meanwhile where there is none, and say so; what waits for it."""
    from plan_cutters.command.ahead import begin

    wait = begin(options.posture_maps) if options.jobs > 1 else None
    if wait is not None and not quiet:
        click.echo("compiling for this machine, once: the first plan takes about half a minute longer", err=True)
    return wait or (lambda: None)


class Onlooker:
    """Shows what is found as soon as it is safe on disk, and tells the parent how far it is."""

    def __init__(self, out: Path, given: dict[str, Any]) -> None:
        self.out, self.given = out, given
        self.plan: Plan | None = None
        self.progress = Progress(given["quiet"])
        self.tell: Any = None

    def __enter__(self) -> "Onlooker":
        return self

    def __exit__(self, *_: object) -> None:
        self.progress.__exit__()

    def summarise(self, plan: "Plan") -> None:
        if not self.given["quiet"]:
            summary(plan)

    def safe(self, plan: "Plan") -> None:
        self.plan = plan
        report("safe", f"{code_of(plan)} {self.out.absolute()}")
        self.summarise(plan)

    def begins(self, what: str) -> None:
        # Each step has the whole limit of the stage.
        self.tell = self.tell or self.progress.__enter__()
        self.tell("write", 0, 1)

    def failed(self, what: str, error: Exception) -> None:
        if self.given["debug"]:
            traceback.print_exception(error)


def without_models(ended: Unfinished, given: dict[str, Any]) -> int:
    """The plan was safe when the process that made it was ended: say what is missing; its exit code stands."""
    from plan_cutters.report import PLAN, file_name
    from plan_cutters.report.to_json import explain

    path = ended.out / PLAN
    missing = ", ".join(map(file_name, explain(path, str(ended)))) or "a model"
    click.echo(f"plan-cutters: {missing} in {ended.out}: not written: {ended}", err=True)
    if given["json_out"] == "-" and path.is_file():
        click.echo(path.read_text(encoding="utf-8"), nl=False)
    left = given["parts"][ended.parts :]
    if left and ended.code != INTERRUPTED:
        click.echo(f"plan-cutters: not planned: {', '.join(left)}", err=True)
        return max(ended.code, UNREADABLE)
    return ended.code
