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
    from cad_io.kernel.side_process import SideProcess
    from plan_cutters.document.clock import Clock
    from plan_cutters.document.model import FileEntry

#: Format -> (file name, module, function).
WRITERS = {
    "html": ("review.html", "page", "write_html"),
    "step": ("annotated.step", "models", "write_step"),
    "glb": ("annotated.glb", "models", "write_glb"),
    "merged": ("merged.glb", "models", "write_merged"),
    "npz": ("samples.npz", "to_npz", "write_npz"),
    "postures": ("postures.npz", "to_npz", "write_postures"),
    "operations": ("operations.npz", "operation_files", "write_operations"),
    "operations_csv": ("operations.csv", "operation_files", "write_operations_csv"),
    "csv": ("axes.csv", "to_csv", "write_csv"),
    "vtk": ("axes.vtp", "to_vtk", "write_vtk"),
    "regions": ("axis_regions.json", "regions", "write_regions"),
    "png": ("review.png", "drawing.part", "write_png"),
}
#: What is shown on faces that are split along the verdicts: the CAD kernel has a part in it.
_MODELS = ("glb", "merged", "png", "step")
#: What follows the plan and the arrays, the easier ones first.
LATER = ("html", "csv", "vtk", "regions", *_MODELS)
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

    Attributes
    ----------
    split : cad_io.split.Split, optional
        The part with its faces split, once that is done.
    """

    def __init__(
        self, result: Judged, folder: Path, schema: str, clock: "Clock", begins: Callable[[str], None]
    ) -> None:
        self.split: Any = None
        self._result, self._folder, self._schema, self._clock, self._begins = result, folder, schema, clock, begins
        self._error: Exception | None = None
        self._several = result.ready is not None and result.ready.options.jobs > 1

    def file(self, name: str, split: Any = None) -> "FileEntry":
        """Make the file of a format."""
        from plan_cutters.document.model import FileEntry

        file, module, function = WRITERS[name]
        write = getattr(import_module(f"plan_cutters.report.{module}"), function)
        write(self._result, split, self._folder / file, **({"schema": self._schema} if name == "step" else {}))
        return FileEntry(name=file, sha256=sha256(self._folder / file))

    def files(self, formats: Sequence[str]) -> Generator[tuple[str, Callable[[], "FileEntry"]]]:
        """Formats, and what to call for the file of each, which raises what its making does.

        The page is made while the faces are split, the GLB while the STEP file is written.
        """
        from cad_io.kernel.side_process import SideProcess

        models = [name for name in formats if name in _MODELS]
        with ExitStack() as copies:

            def begun(make: Callable[[str], "FileEntry"], name: str, beside: bool) -> "SideProcess[FileEntry]":
                worth = beside and name in formats and self._several
                return copies.enter_context(SideProcess(partial(make, name), _COPY, worth=worth))

            page = begun(self.file, "html", bool(models))
            if page.works:
                self._split()
            for name in formats:
                if name not in models:
                    yield name, page.result if name == "html" else partial(self.file, name)
            if models:
                self._split()
            model = begun(self._model, "glb", self._error is None and "step" in models)
            for name in sorted(models, key=lambda name: name == "glb" and model.works):
                yield name, model.result if name == "glb" else partial(self._model, name)

    def _split(self) -> None:
        if self.split is None and self._error is None:
            from plan_cutters.report.models import split_result

            self._begins("split")
            with self._clock.stage("split", shown=False):
                try:
                    self.split = split_result(self._result)
                except Exception as error:
                    self._error = error

    def _model(self, name: str) -> "FileEntry":
        if self._error is not None:
            raise self._error
        return self.file(name, self.split)


def sha256(file: Path) -> str:
    """Checksum of a file."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
