"""One result, many writers. A format is a module with one function; this table is all that knows them."""

import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from cad_io.errors import WriteError
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.model import FileEntry, Plan

#: Format -> (file name, module, function); the models first, since they say what the plan must tell of the split.
_WRITERS = {
    "step": ("annotated.step", "models", "write_step"),
    "glb": ("annotated.glb", "models", "write_glb"),
    "merged": ("merged.glb", "models", "write_merged"),
    "npz": ("samples.npz", "to_npz", "write_npz"),
    "postures": ("postures.npz", "to_npz", "write_postures"),
}
FORMATS = ("json", *(f for f in _WRITERS if f != "postures"))
#: What is written unless asked otherwise; `merged` is for parts of thousands of faces.
DEFAULT_FORMATS = tuple(f for f in FORMATS if f != "merged")


def read_formats(text: str) -> tuple[str, ...]:
    """Read a list such as `json,glb`; OptionError for what is not built in."""
    wanted = tuple(dict.fromkeys(w.strip() for w in text.split(",") if w.strip()))
    for word in wanted:
        if word not in FORMATS:
            raise OptionError(f"format {word!r} is not built in; give some of {','.join(FORMATS)}")
    if not wanted:
        raise OptionError(f"no format given; give some of {','.join(FORMATS)}")
    return wanted


class Staging:
    """A folder beside the output in which files grow; they appear in the output whole, or not at all.

    Raises
    ------
    PlanError
        At the start if the output can surely not be written: before the work, not after it.
    """

    def __init__(self, out: Path) -> None:
        self.out = out
        try:
            if out.exists() and not out.is_dir():
                raise PlanError("the output must be a folder, this is a file; give another with -o", file=str(out))
            out.absolute().parent.mkdir(parents=True, exist_ok=True)
            self.folder = Path(tempfile.mkdtemp(prefix=f".{out.name}-", dir=out.absolute().parent))
        except OSError as error:
            raise PlanError(
                f"cannot write there ({error.strerror}); give another folder with -o", file=str(out)
            ) from None

    def __enter__(self) -> Path:
        return self.folder

    def __exit__(self, kind: object, *_: object) -> None:
        try:
            if kind is None:
                self.out.mkdir(exist_ok=True)
                for file in sorted(self.folder.iterdir()):
                    os.replace(file, self.out / file.name)
        except OSError as error:
            raise PlanError(f"cannot write there ({error.strerror}); give another folder with -o",
                            file=str(self.out)) from None  # fmt: skip
        finally:
            self.discard()

    def discard(self) -> None:
        """Forget what has not appeared in the output."""
        shutil.rmtree(self.folder, ignore_errors=True)


def write_all(
    result: Any, out: Path, formats: Sequence[str], staging: Staging | None = None, *, step_schema: str = "ap242"
) -> Plan:
    """Write the formats asked for into the folder `out`.

    Parameters
    ----------
    result : Result
    out : Path
    formats : sequence of str
        Of FORMATS.
    staging : Staging, optional
        One made before the work began.
    step_schema : str
        `ap242`, `ap214` or `ap203`.

    Returns
    -------
    Plan
        The plan as written.
    """
    read_formats(",".join(formats))
    from plan_cutters.report.models import SCHEMAS, rungs, split_result
    from plan_cutters.report.to_json import write_plan

    if step_schema not in SCHEMAS:
        raise OptionError(f"STEP schema {step_schema!r} is not built in; give one of {', '.join(SCHEMAS)}")
    document: Plan = result.plan
    files: dict[str, FileEntry] = {}
    with staging or Staging(out) as folder:
        split = split_result(result) if {"step", "glb", "merged"} & set(formats) else None
        if split is not None:
            document = document.model_copy(update={"split": rungs(split)})
        for name in (*formats, *(("postures",) if result.maps else ())):
            if name == "json":
                continue
            file, module, function = _WRITERS[name]
            write: Callable[..., None] = getattr(import_module(f"plan_cutters.report.{module}"), function)
            more = {"schema": step_schema} if name == "step" else {}
            try:
                write(result, split, folder / file, **more)
            except WriteError as error:
                raise WriteError(f"{file} cannot be written ({error.cause}); leave {name} out of --formats",
                                 file=result.part.file) from error  # fmt: skip
            files[name] = FileEntry(name=file, sha256=hashlib.sha256((folder / file).read_bytes()).hexdigest())
        document = document.model_copy(update={"files": files})
        if "json" in formats:
            write_plan(document, folder / "plan.json")
    return document
