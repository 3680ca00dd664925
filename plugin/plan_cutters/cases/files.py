"""The files that test cases are written into, each where one is named."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from plan_cutters.cases import junit as junit_xml
from plan_cutters.cases import sarif as sarif_json
from plan_cutters.cases.case import Case
from plan_cutters.errors import OptionError, PlanError
from plan_cutters_base.whole import refusal, whole


@dataclass(frozen=True, slots=True)
class CaseFiles:
    """Names of files for test cases.

    Parameters
    ----------
    junit, sarif : str, optional
    """

    junit: str | None = None
    sarif: str | None = None

    def check(self) -> None:
        """Look before the work begins whether the files can be written.

        Raises
        ------
        OptionError
            One is no name of a file, a folder, or cannot be written; or both are one file.
        """
        named = [(word, path) for word, path in (("--junit", self.junit), ("--sarif", self.sarif)) if path is not None]
        for word, path in named:
            if path in ("", "-"):
                raise OptionError(f"{word}: give the name of a file; standard output has the summary")
            if Path(path).is_dir():
                raise OptionError(f"{word}: is a folder; give the name of a file", file=path)
            if why := refusal(Path(path).parent):
                raise OptionError(f"{word}: cannot be written: {why}", file=path)
        if len({Path(path).absolute() for _, path in named}) < len(named):
            raise OptionError("--junit and --sarif name one file; give each its own", file=self.junit)

    def write(self, name: str, cases: Iterable[Case]) -> None:
        """Write each file whole or not at all; its folder is made. `name`: of the command.

        Raises
        ------
        PlanError
            One cannot be written.
        """
        cases = list(cases)
        for path, document in ((self.junit, junit_xml.document), (self.sarif, sarif_json.document)):
            if path is not None:
                _write(Path(path), document(name, cases))


def _write(path: Path, data: bytes) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise PlanError(f"cannot be written: {error.strerror}", file=str(path)) from None
    with whole(path, PlanError) as temporary:
        temporary.write_bytes(data)
