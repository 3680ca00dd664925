"""One part: planned, written, summarised."""

import copy
import gc
import pickle
import signal
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from plan_cutters.command import terminal
from plan_cutters.command.background_compile import begin as background_compile
from plan_cutters.command.codes import UNREADABLE, code_of, held_interrupts, is_interrupt
from plan_cutters.command.partial_plan import remaining_text, verdicts_text
from plan_cutters.command.progress import Display, ModelsListener, Teller
from plan_cutters.command.summary import summary, written
from plan_cutters.plan_file.words.cutters import others
from plan_cutters.plan_file.words.names import called
from plan_cutters_base.workers.child import INTERRUPTED, assignment, is_child, job_input, report, report_work

if TYPE_CHECKING:
    from plan_cutters.command.progress import PartCases
    from plan_cutters.command.request import PlanRequest
    from plan_cutters.options import Options
    from plan_cutters.plan_file.model import Plan
    from plan_cutters.result import Result


def one_part(
    part: str, out: Path | None, options: "Options", request: "PlanRequest", began: float | None,
    omitted: Mapping[int, str] | None, part_cases: "PartCases | None",
) -> tuple[int, str]:  # fmt: skip
    """Plan one part into a folder, None for none; exit code and a line about it.

    `began`: when the command did, for the first part (`time.monotonic`); `omitted`: why faces are not to be worked on, by number;
    `part_cases`: takes the test cases of the plan, as soon as its verdicts stand.
    """
    from plan_cutters.errors import TooManySamplesError
    from plan_cutters.report.folder import DEFAULT_FORMATS, Staging, file_name, read_formats, write_all, write_unfinished
    from plan_cutters.report.to_json import dumps

    formats = DEFAULT_FORMATS if request.formats is None else read_formats(request.formats)
    formats = formats if out else ()
    report("part", part)
    staging = Staging(out, lambda folder: report("staging", str(folder))) if out else None
    watch = ProgressListener(out, options, request, began)
    if part_cases is not None:
        watch.judged = partial(part_cases.planned, part)

    def stands(result: "Result") -> None:
        if staging and write_unfinished(result, formats, staging, clock):
            watch.stands(result.plan)

    interrupts: list[int] = []
    try:
        watch.tell("start", 0, 1)
        compiling = _compiling(options, request.quiet)
        import plan_cutters.report.models  # noqa: F401  all that takes time to load is loaded in the stage `start`
        from plan_cutters.document.clock import Clock
        from plan_cutters.interim import Interim
        from plan_cutters.pipeline import run
        from plan_cutters_base.stage_cache import StageCache, settle

        gc.freeze()
        gc.enable()
        clock = Clock(watch.tell, began=began)
        interim = Interim(clock, stands if staging else None, lambda: report("stands", ""), watch.looked)
        handed = job_input().part
        source = pickle.loads(handed) if handed else part
        # A batch takes the output away: files are named as where they will be, or not at all.
        planned = partial(run, source, clock=clock, read_timeout=request.read_timeout, at=report_work,
                          compiling=compiling, excluded=omitted, interim=interim,
                          folder="" if out is None or assignment().job is not None else str(out),
                          cache=StageCache.of_user() if request.cache else None)  # fmt: skip
        try:
            result = planned(options)
        except TooManySamplesError:
            if assignment().job is None:
                raise
            # One density for all parts of a batch asks too much of this one: its row says so (`batch.work.coarser`).
            from plan_cutters.document.notes import noted_coarser

            result = planned(_default_density(options), remark=partial(noted_coarser, options))
        except (Exception, KeyboardInterrupt) as error:
            if not is_interrupt(error) or (stood := interim.interrupted(watch.tell.work)) is None:
                raise
            result = stood
            interrupts.append(signal.SIGINT)
            watch.judged = lambda plan, code: None  # a report on this part says that it was interrupted
        document = result.plan
        if out is None:
            watch.judged(document, code_of(document, request.fail_under))
            watch.summarise(document)
        else:
            watch.tell("files", 0, 1)
            with held_interrupts(interrupts):
                document = write_all(result, out, formats, staging, step_schema=request.step_schema, listener=watch, clock=clock,
                                     hurried=bool(interrupts))  # fmt: skip
    except KeyboardInterrupt:
        if staging is None or out is None or not staging.stands:
            raise
        staging.discard()
        return _interrupted(out)
    except Exception:
        if staging and out and staging.stands and (what := verdicts_text(out)):
            watch.end()
            terminal.error(f"plan-cutters: {what}")
        raise
    finally:
        watch.end()
        if staging:
            staging.discard()
    if not interrupts:
        settle()  # this process ends without waiting for its threads
    # Of an interrupted run, who watches it tells the rest.
    tells = not (interrupts and out and is_child())
    if request.json_out == "-" and tells:
        terminal.hand_out(dumps(document))
    if not request.quiet and tells:
        _tells(request)(*(others(document) if request.verbose else []), *written(document, out, formats, verbose=request.verbose))
    for name, why in document.not_written.items():
        terminal.error(f"plan-cutters: {file_name(name)} was not written: {why}")
    return _interrupted(out) if interrupts else (code_of(document, request.fail_under), "")


def _interrupted(out: Path | None) -> tuple[int, str]:
    """The end of a part that was interrupted once verdicts stood: who watches this process says where its plan is."""
    if out is None:
        return INTERRUPTED, "plan-cutters: interrupted; the plan says what it is without"
    return INTERRUPTED, "" if is_child() else f"plan-cutters: {remaining_text(out, 'interrupted')}"


def _tells(request: "PlanRequest") -> Callable[..., None]:
    """What tells results: where a program reads the plan on standard output, nothing else is written there."""
    return terminal.say if request.json_out == "-" else terminal.show


def _compiling(options: "Options", quiet: bool) -> Callable[[str], None]:
    """Let machine code be made meanwhile where there is none, and say so; what waits for an entry of it."""
    wait = background_compile(options.posture_maps) if options.jobs > 1 else None
    if wait is not None and not quiet:
        terminal.say("Compiling for this machine, once: the first plan takes about half a minute longer.")
    return wait or (lambda entry: None)


def _default_density(options: "Options") -> "Options":
    """The same options with the default density of samples, in place of a spacing or a grid: a copy past the checks."""
    made = copy.copy(options)
    for word in ("spacing", "grid"):
        object.__setattr__(made, word, None)
    return made


class ProgressListener(ModelsListener):
    """Shows what is found as soon as it is safe on disk, and tells how far the work is."""

    def __init__(self, out: Path | None, options: "Options", request: "PlanRequest", began: float | None) -> None:
        self.out, self.request, self.first = out, request, True
        #: Called with the plan and its exit code before any model is written.
        self.judged: Callable[[Plan, int], None] = lambda plan, code: None
        self.display = None
        if not is_child():
            names = {cutter.id: called(cutter) for cutter in options.judged}
            self.display = Display(request.quiet, len(names), began or time.monotonic(), itself=True, names=names)
        super().__init__(Teller(self.display), request.debug)

    def summarise(self, plan: "Plan") -> None:
        self.end()
        if not self.request.quiet:
            summary(plan, verbose=self.request.verbose, tells=_tells(self.request))
        report("summarised", "")

    def looked(self, text: str) -> None:
        """A first look says what to expect, while all samples are judged and setups compared."""
        if not self.request.quiet:
            self.end()
            terminal.say(text)

    def stands(self, plan: "Plan") -> None:
        """A plan is in the output that is without what was requested besides: no exit code of a plan stands for that.

        Its first line is told the first time: advice and operations may take a minute more.
        """
        if self.out is not None:
            report("safe", f"{UNREADABLE} {self.out.absolute()}")
        requested = plan.effective.answers or plan.effective.operations
        if self.first and requested and plan.text and not self.request.quiet:
            self.end()
            terminal.say(f"So far: {plan.text.headline}")
        self.first = False

    def safe(self, plan: "Plan") -> None:
        code = code_of(plan, self.request.fail_under)
        if self.out is not None:
            report("safe", f"{code} {self.out.absolute()}")
        self.judged(plan, code)
        self.summarise(plan)

    def end(self) -> None:
        """Leave the line to others."""
        if self.display is not None:
            self.display.clear()
