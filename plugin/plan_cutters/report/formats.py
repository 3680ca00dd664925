"""How the files of a result are made: one while another is, in copies of the process, where there are cores for it."""

import hashlib
from collections.abc import Callable, Generator, Sequence
from contextlib import ExitStack
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plan_cutters.report.protocol import Judged

if TYPE_CHECKING:
    # What formats there are is asked before anything heavy is loaded.
    from plan_cutters.document.clock import Clock
    from plan_cutters.plan_file.model import FileEntry
    from plan_cutters_base.copies import SideProcess

#: Format -> (file name, module, function).
WRITERS = {
    "html": ("review.html", "page", "write_html"),
    "step": ("annotated.step", "models", "write_step"),
    "glb": ("annotated.glb", "models", "write_glb"),
    "merged": ("merged.glb", "models", "write_merged"),
    "npz": ("samples.npz", "to_npz", "write_npz"),
    "process": ("process.toml", "process_file", "write_process"),
    "setup_1": ("setup-1.toml", "setup_files", "write_first"),
    "setup_2": ("setup-2.toml", "setup_files", "write_second"),
    "setup_3": ("setup-3.toml", "setup_files", "write_third"),
    "postures": ("postures.npz", "to_npz", "write_postures"),
    "operations": ("operations.npz", "operation_files", "write_operations"),
    "operations_csv": ("operations.csv", "operation_files", "write_operations_csv"),
    "operations_step": ("operations.step", "operation_models", "write_operations_step"),
    "operations_glb": ("operations.glb", "operation_models", "write_operations_glb"),
    "fastest_step": ("operations_fastest.step", "operation_models", "write_fastest_step"),
    "fastest_glb": ("operations_fastest.glb", "operation_models", "write_fastest_glb"),
    "csv": ("axes.csv", "to_csv", "write_csv"),
    "vtk": ("axes.vtp", "to_vtk", "write_vtk"),
    "png": ("review.png", "drawing.part", "write_png"),
}
#: What is shown on faces that are split, which the CAD kernel has a part in: along the verdicts, or along the operations of the
#: first plan, or of another one by its name. Of each, the first one is made while the others are.
_MODELS = {
    "verdicts": ("glb", "merged", "png", "step"),
    "operations": ("operations_glb", "operations_step"),
    "fastest": ("fastest_glb", "fastest_step"),
}
#: What follows the plan and the arrays, the easier ones first.
LATER = ("html", "csv", "vtk", *(name for models in _MODELS.values() for name in models))
#: Processor time that a copy may take for a file, s: behind it, the file is made here.
_COPY = 300.0


class Making:
    """Files of a result, made in a folder.

    Parameters
    ----------
    result : Result
    folder : Path
    schema : str
        As in `write_all`.
    clock : Clock
    begins : callable
        Told what is begun: `split`, or a format.
    alone : bool
        Make no file beside another one.

    Attributes
    ----------
    splits : dict
        The part with its faces split, once that is done: along the verdicts (None), or the operations of a plan.
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

        file, module, function = WRITERS[name]
        write = getattr(import_module(f"plan_cutters.report.{module}"), function)
        write(self._result, split, self._folder / file, **({"schema": self._schema} if file.endswith(".step") else {}))
        return FileEntry(name=file, sha256=sha256(self._folder / file))

    def files(self, formats: Sequence[str]) -> Generator[tuple[str, Callable[[], "FileEntry"]]]:
        """Formats, and what to call for the file of each, which raises what its making does.

        The page is made while the faces are split, the GLB while the STEP file is written.
        """
        from plan_cutters_base.copies import SideProcess

        by_model = {about: [name for name in mine if name in formats] for about, mine in _MODELS.items()}
        models = {self._place(about): mine for about, mine in by_model.items() if mine}
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

    def _place(self, about: str) -> int | None:
        """Of a plan of operations its place among them; None where models are about verdicts."""
        plan = self._result.plan.operations
        if about == "verdicts" or plan is None:
            return None
        return 0 if about == "operations" else [str(each.name) for each in plan.plans].index(about)

    def _split(self, which: int | None) -> None:
        if which not in self.splits and which not in self._errors:
            from plan_cutters.report.models import split_result
            from plan_cutters.report.operation_models import split_operations

            self._begins("split")
            with self._clock.stage("split" if which is None else "split_operations", shown=False):
                try:
                    self.splits[which] = split_result(self._result) if which is None else split_operations(self._result, which)
                except Exception as error:
                    self._errors[which] = error

    def _model(self, which: int | None, name: str) -> "FileEntry":
        if which in self._errors:
            raise self._errors[which]
        return self.file(name, self.splits[which])


def with_operations(formats: Sequence[str], plans: Sequence[str]) -> list[str]:
    """Formats, and what they stand for with plans of operations of these names: the first one's models have no name of a plan."""
    about = ["operations", *plans[1:]] if plans else []
    return [*formats, *(name for each in about for name in _MODELS[each] if name.rpartition("_")[2] in formats)]


def sha256(file: Path) -> str:
    """Checksum of a file."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
