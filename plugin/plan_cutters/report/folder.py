"""The output folder: every format of a result, each file whole or not at all, the plan and the arrays before the models."""

import hashlib
import os
import secrets
import shutil
from collections.abc import Callable, Collection, Generator, Iterable, Sequence
from contextlib import ExitStack, closing, suppress
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from cad_io.errors import CadIoError
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.files.lock import Lock
from plan_cutters.files.pictures import NO_PICTURES, draws_pictures
from plan_cutters.report.protocol import Judged

if TYPE_CHECKING:
    from plan_cutters.document.clock import Clock
    from plan_cutters.plan_file.model import FileEntry, Plan
    from plan_cutters_base.forks import SideProcess


class Writer(NamedTuple):
    """The file of a format, the function that writes it, in a module of this room, and what it is given besides.

    `by_name`: it can be requested; others are written where there are steps, setups were to be proposed, or posture maps or
    operations were requested.
    """

    file: str
    module: str
    function: str
    by_name: bool = False
    options: dict[str, Any] | None = None


_FASTEST = {"name": "fastest"}
WRITERS = {
    "html": Writer("review.html", "page.write", "write_html", by_name=True),
    "step": Writer("annotated.step", "models", "write_step", by_name=True),
    "glb": Writer("annotated.glb", "models", "write_glb", by_name=True),
    "merged": Writer("merged.glb", "models", "write_glb", by_name=True, options={"merged": True}),
    "part": Writer("part.glb", "models", "write_glb", by_name=True, options={"merged": True, "fixtures": False}),
    "npz": Writer("samples.npz", "arrays", "write_npz", by_name=True),
    "process": Writer("process.toml", "process_file", "write_process"),
    **{f"setup_{k}": Writer(f"setup-{k}.toml", "process_file", "write_setup", options={"number": k}) for k in (1, 2, 3)},
    "postures": Writer("postures.npz", "arrays", "write_postures"),
    "operations": Writer("operations.npz", "arrays", "write_operations"),
    "operations_csv": Writer("operations.csv", "arrays", "write_operations_csv"),
    "operations_step": Writer("operations.step", "models", "write_operations_step"),
    "operations_glb": Writer("operations.glb", "models", "write_operations_glb"),
    "fastest_step": Writer("operations_fastest.step", "models", "write_operations_step", options=_FASTEST),
    "fastest_glb": Writer("operations_fastest.glb", "models", "write_operations_glb", options=_FASTEST),
    "csv": Writer("axes.csv", "arrays", "write_csv", by_name=True),
    "vtk": Writer("axes.vtp", "arrays", "write_vtk", by_name=True),
    "png": Writer("review.png", "drawing.part", "write_png", by_name=True),
}
_FILES = [writer.file for writer in WRITERS.values()]
#: What is shown on faces that are split, which the CAD kernel has a part in: along the verdicts, or along the operations of the
#: first plan, or of another one by its name. Of each, the first one is made while the others are.
_MODELS = {
    "verdicts": ("glb", "merged", "part", "png", "step"),
    "operations": ("operations_glb", "operations_step"),
    "fastest": ("fastest_glb", "fastest_step"),
}
#: What follows the plan and the arrays, the easier ones first.
LATER = ("html", "csv", "vtk", *(name for models in _MODELS.values() for name in models))
#: Processor time that a copy may take for a file, s: behind it, the file is made here.
_COPY = 300.0


class Making:
    """Files of a result, made in a folder; `begins` is told what is begun: `split`, or a format. `alone`: no file beside
    another one.

    `splits` has the part with its faces split, once that is done: along the verdicts (None), or the operations of a plan.
    """

    def __init__(
        self, result: Judged, folder: Path, schema: str, clock: "Clock", begins: Callable[[str], None], *, alone: bool = False
    ) -> None:
        self.splits: dict[int | None, Any] = {}
        self._result, self._folder, self._schema, self._clock, self._begins = result, folder, schema, clock, begins
        self._errors: dict[int | None, Exception] = {}
        self._several = result.ready.options.jobs > 1 and not alone

    def file(self, name: str, split: Any = None) -> "FileEntry":
        """Make the file of a format."""
        from plan_cutters.plan_file.model import FileEntry

        writer, path = WRITERS[name], self._folder / WRITERS[name].file
        write = getattr(import_module(f"plan_cutters.report.{writer.module}"), writer.function)
        schema = {"schema": self._schema} if path.suffix == ".step" else {}
        write(self._result, split, path, **schema, **(writer.options or {}))
        return FileEntry(name=path.name, sha256=sha256(path), size_bytes=path.stat().st_size)

    def files(self, formats: Sequence[str]) -> Generator[tuple[str, Callable[[], "FileEntry"]]]:
        """Formats, and what to call for the file of each, which raises what its making does.

        The page is made while the faces are split, the GLB while the STEP file is written.
        """
        from plan_cutters_base.forks import SideProcess

        plans = self._result.plan.operations.plans if self._result.plan.operations else []
        # Of a plan of operations its place among them; None where models are about verdicts.
        places = {"verdicts": None, **{str(each.name): k for k, each in enumerate(plans)}, "operations": 0}
        wanted = {about: [name for name in mine if name in formats] for about, mine in _MODELS.items()}
        models = {places[about]: mine for about, mine in wanted.items() if mine}
        each = [name for mine in models.values() for name in mine]
        with ExitStack() as copies:

            def begun(make: Callable[[str], "FileEntry"], name: str, separate: bool) -> "SideProcess[FileEntry]":
                worth = separate and name in formats and self._several
                return copies.enter_context(SideProcess(partial(make, name), _COPY, worth=worth))

            page = begun(self.file, "html", bool(models))
            if page.works:
                self._split(next(iter(models)))
            for name in formats:
                if name not in each:
                    yield name, page.result if name == "html" else partial(self.file, name)
            for which, mine in models.items():
                self._split(which)
                make, first = partial(self._model, which), mine[0]
                model = begun(make, first, which not in self._errors and len(mine) > 1)
                for name in sorted(mine, key=lambda name: name == first and model.works):
                    yield name, model.result if name == first else partial(make, name)

    def _model(self, which: int | None, name: str) -> "FileEntry":
        if which in self._errors:
            raise self._errors[which]
        return self.file(name, self.splits[which])

    def _split(self, which: int | None) -> None:
        if which not in self.splits and which not in self._errors:
            from plan_cutters.report.models import split_operations, split_result

            self._begins("split")
            with self._clock.stage("split" if which is None else "split_operations", shown=False):
                try:
                    self.splits[which] = split_result(self._result) if which is None else split_operations(self._result, which)
                except Exception as error:
                    self._errors[which] = error


def sha256(file: Path) -> str:
    """Checksum of a file."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


PLAN = "plan.json"
_STAYS = "the process.toml there was edited, and stays: give it with --process, or delete it"
FORMATS = ("json", *(name for name, writer in WRITERS.items() if writer.by_name))
#: What is written unless asked otherwise (`docs/decisions/history.md#0017-formats-on-request`).
DEFAULT_FORMATS = ("json", "html", "step", "glb", "npz")


def read_formats(text: str) -> tuple[str, ...]:
    """Read a list such as `json,glb`; OptionError for what is not built in, or needs a package that is not installed."""
    wanted = tuple(dict.fromkeys(w.strip() for w in text.split(",") if w.strip()))
    for word in wanted:
        if word not in FORMATS:
            raise OptionError(f"format {word!r} is not built in; give some of {','.join(FORMATS)}")
    if "png" in wanted and not draws_pictures():
        raise OptionError(f"format png: {NO_PICTURES}")
    if not wanted:
        raise OptionError(f"no format given; give some of {','.join(FORMATS)}")
    return wanted


class Staging:
    """A folder beside the output in which files grow; each appears in the output whole, or not at all.

    As long as it is there, no other run writes into the output. `named` is called with the folder and the lock before they
    exist, so that whoever ends this process at any moment can take them away. A PlanError at the start if the output can surely
    not be written, or another run writes there: before the work, not after it.
    """

    def __init__(self, out: Path, named: Callable[[Path], None] = lambda _: None) -> None:
        self.out = out
        #: Whether a plan of this run is in the output already.
        self.stands = False
        #: What the samples that are in the output already differ by from those of a later stage (`arrays.state`), and their file.
        self.samples: tuple[Any, FileEntry] | None = None
        self.folder = out.absolute().parent / f".{out.name}-{secrets.token_hex(4)}"
        named(self.folder)
        lock: Lock | None = None
        try:
            if out.exists() and not out.is_dir():
                raise PlanError("the output must be a folder, this is a file; give another with -o", file=str(out))
            out.absolute().parent.mkdir(parents=True, exist_ok=True)
            self._lock = lock = Lock(out, named, self.folder)
            self.folder.mkdir(mode=0o700)
        except OSError as error:
            if lock is not None:
                lock.release()
            raise _unwritable(out, error) from None

    def __enter__(self) -> "Staging":
        return self

    def __exit__(self, *_: object) -> None:
        self.discard()

    def publish(self, name: str) -> None:
        """Let a file appear in the output."""
        try:
            self.out.mkdir(exist_ok=True)
            os.replace(self.folder / name, self.out / name)
        except OSError as error:
            raise _unwritable(self.out, error) from None

    def models_follow(self) -> None:
        """Say to other runs that nothing but models is left to write here."""
        self._lock.ends_soon()

    def discard(self) -> None:
        """Forget what has not appeared in the output, and let others write there."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self._lock.release()


class ProgressListener(Protocol):
    """An onlooker is called as the writing goes on."""

    def safe(self, plan: "Plan") -> None:
        """The plan and the arrays are in the output; models follow."""

    def begins(self, what: str) -> None:
        """A step of the models begins."""

    def failed(self, what: str, error: Exception) -> None:
        """A format was not written; the plan says so, too."""


def _begins(listener: ProgressListener | None) -> Callable[[str], None]:
    return listener.begins if listener else lambda what: None


def write_all(
    result: Judged, out: Path, formats: Sequence[str], staging: Staging | None = None, *, step_schema: str = "ap242",
    listener: ProgressListener | None = None, clock: "Clock | None" = None, hurried: bool = False,
) -> "Plan":  # fmt: skip
    """Write the formats asked for (of FORMATS) into the folder `out`, each file whole or not at all; the plan as written.

    The arrays and the plan come first; the plan is replaced as each other file is added. What fails or ends the process in one
    of these, as in the models, where the CAD kernel works, costs that file: the plan names it in `not_written`.

    `staging` is one made before the work began, `clock` the one that ran while the plan was made. `hurried`: one file after the
    other, for this may be ended at any moment. An OptionError for an unknown format or schema, a PlanError where the folder
    cannot be written to.
    """
    from plan_cutters.document.clock import Clock

    read_formats(",".join(formats))
    clock = clock or Clock.after(result.plan.run)
    with clock.stage("start", shown=False):
        from plan_cutters.report.models import SCHEMAS
        from plan_cutters.report.to_json import PENDING

    if step_schema not in SCHEMAS:
        raise OptionError(f"STEP schema {step_schema!r} is not built in; give one of {', '.join(SCHEMAS)}")
    later = _later(result.plan, formats)
    with staging or Staging(out) as staging:
        making = Making(result, staging.folder, step_schema, clock, _begins(listener), alone=hurried)
        edited = _edited(result, out)
        stays = {"process": _STAYS} if result.ready.options.process is None and edited else {}
        written = _Written(result.plan, staging, clock, out, dict.fromkeys(later, PENDING) | stays, as_json="json" in formats)
        stands = "npz" in formats and _has_samples(staging, result)
        arrays = [*(["npz"] if "npz" in formats and not stands else []), *_setup_files(result)]
        arrays += ["process"] if result.plan.process.steps and not edited else []
        arrays += [*(["postures"] if result.maps else []), *(["operations", "operations_csv"] if result.plan.operations else [])]
        try:
            for name in arrays:
                with clock.stage(name, shown=False):
                    written.files[name] = making.file(name)
            if stands and staging.samples is not None:
                written.files["npz"] = staging.samples[1]
        except OSError as error:
            raise _unwritable(out, error) from None
        written.put()
        # All is on disk: from here on files only change their names, and no plan stands beside files that are not its own.
        if not staging.stands:
            _clear(out, result)
        written.publish(arrays)
        staging.stands = True
        if listener:
            with clock.stage("show", shown=False):
                listener.safe(written.plan)
        if later:
            staging.models_follow()
        _write_later(making, written, later, listener)
    return written.plan


def _later(plan: "Plan", formats: Sequence[str]) -> list[str]:
    """What follows the plan and the arrays where some formats are requested; the first plan's models have no name of a plan."""
    plans = [str(each.name) for each in plan.operations.plans] if plan.operations else []
    about = ["operations", *plans[1:]] if plans else []
    wanted = [*formats, *(name for each in about for name in _MODELS[each] if name.rpartition("_")[2] in formats)]
    return [name for name in LATER if name in wanted]


def _write_later(making: Making, written: "_Written", later: Sequence[str], listener: "ProgressListener | None") -> None:
    """Make one file after the other; each appears with a plan that has it, or says why it is not there."""
    split = 0
    with closing(making.files(later)) as each:
        for name, make in each:
            if listener:
                listener.begins(name)
            try:
                with written.clock.stage(name, shown=False):
                    written.files[name] = make()
            except Exception as error:
                written.missing[name] = _cause(error)
                if listener:
                    listener.failed(name, error)
            else:
                written.missing.pop(name, None)
            if len(making.splits) > split:
                from plan_cutters.report.models import with_splits

                split, written.plan = len(making.splits), with_splits(written.plan, making.splits)
            written.put()
            written.publish([name])


def missing_files(plan: "Plan", out: Path, formats: Sequence[str]) -> list[str]:
    """Formats of a plan in a folder, page and models, whose file is not there as the plan lists it."""

    def there(name: str) -> bool:
        entry = plan.files.get(name)
        return entry is not None and (out / entry.name).is_file() and sha256(out / entry.name) == entry.sha256

    return [name for name in _later(plan, formats) if not there(name)]


def write_missing(
    result: Judged, out: Path, names: Sequence[str], staging: Staging, clock: "Clock", listener: ProgressListener | None = None
) -> "Plan":
    """Write page and models of a plan into its folder, which has all else; the plan as written. As `write_all`."""
    making, plan = Making(result, staging.folder, "ap242", clock, _begins(listener)), result.plan
    files = {name: entry for name, entry in plan.files.items() if name not in names}
    written = _Written(plan, staging, clock, out, dict(plan.not_written), files, as_json=True)
    staging.models_follow()
    _write_later(making, written, names, listener)
    return written.plan


def write_unfinished(result: Judged, formats: Sequence[str], staging: Staging, clock: "Clock") -> bool:
    """Let the plan of a run that goes on appear in the output, whole, with its samples and setups; whether it is written at all.

    The plan says of the other formats that the run ended before they were written: that is true whenever it ends. A PlanError
    where the folder cannot be written to.
    """
    from plan_cutters.report.to_json import PENDING

    if "json" not in formats:
        return False
    others = dict.fromkeys((name for name in formats if name in WRITERS), PENDING)
    written = _Written(result.plan, staging, clock, staging.out, others, as_json=True)
    making = Making(result, staging.folder, "", clock, lambda what: None)
    written.files |= {name: making.file(name) for name in _setup_files(result)}
    news = [] if "npz" not in formats or _has_samples(staging, result) else ["npz"]
    if news:
        from plan_cutters.report.arrays import state

        staging.samples = state(result), making.file("npz")
    if staging.samples is not None:
        written.files["npz"] = staging.samples[1]
        del written.missing["npz"]
    written.put()
    if not staging.stands:
        _clear(staging.out, result)
    written.publish([*_setup_files(result), *news])
    staging.stands = True
    return True


def _has_samples(staging: Staging, result: Judged) -> bool:
    """Whether the samples in the output are those of a result, though it is one of a later stage."""
    from plan_cutters.report.arrays import state

    return staging.samples is not None and staging.samples[0] == state(result)


def _setup_files(result: Judged) -> list[str]:
    proposal = result.plan.setup_proposal
    return [f"setup_{number}" for number in range(1, 1 + len(proposal.setups))] if proposal else []


def _edited(result: Judged, out: Path) -> bool:
    """Whether a person wrote what stands in the place of the process: it was read, or no plan there lists it as it is."""
    from plan_cutters.report.to_json import listed

    own, path = result.ready.options.process, out / file_name("process")
    read = own is not None and bool(own.file) and os.path.abspath(own.file) == os.path.abspath(path)
    return read or (path.is_file() and (listed(out / PLAN) or {}).get(path.name) != sha256(path))


@dataclass
class _Written:
    """The plan in the folder, and the files that are written by now, or not."""

    plan: "Plan"
    staging: Staging
    clock: "Clock"
    out: Path
    missing: dict[str, str]
    files: "dict[str, FileEntry]" = field(default_factory=dict)
    as_json: bool = field(kw_only=True)

    def put(self) -> None:
        """Write the plan, with its files as they are now, beside the output."""
        files = {name: self.files[name] for name in WRITERS if name in self.files}
        self.plan = self.clock.stamp(self.plan, files=files, not_written=dict(self.missing))
        if self.as_json:
            from plan_cutters.report.to_json import write_plan

            with self.clock.stage("json", shown=False):
                try:
                    write_plan(self.plan, self.staging.folder / PLAN)
                except PlanError as error:
                    raise PlanError(error.cause, file=str(self.out / PLAN)) from None

    def publish(self, names: Iterable[str]) -> None:
        """Let files, those that there are, and the plan appear in the output."""
        for name in names:
            if name in self.files:
                self.staging.publish(self.files[name].name)
        if self.as_json:
            self.staging.publish(PLAN)


def file_name(name: str) -> str:
    """Name of the file of a format."""
    return PLAN if name == "json" else WRITERS[name].file


def _cause(error: Exception) -> str:
    """One line on why a file was not written."""
    if isinstance(error, CadIoError | PlanError):
        return ": ".join(part for part in (error.face, error.cause) if part)
    if isinstance(error, MemoryError):
        return "out of memory"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return f"internal error ({type(error).__name__}: {error})"


def _clear(out: Path, result: Judged) -> None:
    """Remove what an earlier run of ours has surely written into the output: the plan there lists it as it is.

    The plan goes first: it must not name files that are gone, or others of the same names. Setup and process files that this
    run has read stay: the same command is to find them again.
    """
    from plan_cutters.report.to_json import listed

    before = listed(out / PLAN)
    if before is None:
        return
    # They may be those of this folder.
    options, ours = result.ready.options, []
    read = {each.file for each in (options.placement, *options.other_placements) if each is not None}
    read |= set() if options.process is None else {Path(options.process.file).name}
    for name, checksum in before.items():
        path = out / name
        if name in _FILES and name not in read and path.is_file() and not path.is_symlink():
            with suppress(OSError):  # it is named instead
                if sha256(path) == checksum:
                    ours.append(path)
    try:
        (out / PLAN).unlink()
    except OSError as error:
        raise _unwritable(out, error) from None
    for path in ours:
        with suppress(OSError):
            path.unlink()


def ended(out: Path, cause: str) -> tuple[str, ...]:
    """Say in the plan of a run that was ended why its pending files were never written; their formats.

    None where another run writes there by now.
    """
    from plan_cutters.report.to_json import explain

    try:
        lock = Lock(out)
    except (OSError, PlanError):
        return ()
    try:
        return explain(out / PLAN, cause)
    finally:
        lock.release()


def stale_files(out: Path, plan: "Plan", formats: Collection[str]) -> list[str]:
    """Files in the output that have names of ours, but are not of this plan: it has neither written nor read them."""
    mine = {entry.name for entry in plan.files.values()} | ({PLAN} if "json" in formats else set())
    mine |= {file_name("process")} if plan.effective.process is not None or "process" in plan.not_written else set()
    mine |= {each.file for each in (plan.effective.placement, *plan.effective.other_placements) if each and each.file}
    return [name for name in (PLAN, *_FILES) if name not in mine and (out / name).is_file()]


def _unwritable(out: Path, error: OSError) -> PlanError:
    return PlanError(f"cannot write there ({error.strerror}); give another folder with -o", file=str(out))
