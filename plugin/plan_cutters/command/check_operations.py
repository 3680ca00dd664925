"""`--check-operations`: a written plan of operations against the part; nothing is written."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plan_cutters.command import terminal

if TYPE_CHECKING:
    from plan_cutters.options import Options


def checked(part: str, file: str, options: "Options", given: dict[str, Any]) -> int:
    """Check the operations of a plan.json; 0: all that it says holds, 1: not all.

    Raises
    ------
    OptionError
        The file is no plan with operations, or one of another part or of other options.
    """
    from plan_cutters.errors import OptionError
    from plan_cutters.operations.check import check_operations
    from plan_cutters.pipeline import prepare

    document, arrays = _read(file)
    ready = prepare(part, options, read_timeout=given["read_timeout"])
    try:
        findings = check_operations(ready, document, arrays)
    except OptionError as error:
        raise OptionError(error.cause, file=file) from None
    except (KeyError, TypeError, ValueError, IndexError, OverflowError) as error:
        raise OptionError(
            f"the plan of operations cannot be understood ({type(error).__name__}: {error})", file=file
        ) from None
    if not given["quiet"]:
        terminal.show(*(f"{'holds' if each.holds else 'FAILS'}: {each.words}" for each in findings))
    return 0 if all(each.holds for each in findings) else 1


def _read(file: str) -> tuple[dict[str, Any], dict[str, Any]]:
    from plan_cutters.errors import OptionError
    from plan_cutters.files.arrays import Archive

    try:
        document = json.loads(Path(file).read_text(encoding="utf-8"))
    except OSError as error:
        raise OptionError(f"cannot be read ({error.strerror or error})", file=file) from None
    except (ValueError, RecursionError) as error:
        raise OptionError(f"is no JSON ({error}): give the plan.json of a plan of operations", file=file) from None
    if not isinstance(document, dict) or document.get("format") != "plan-cutters-plan":
        raise OptionError("is no plan.json of plan-cutters", file=file)
    if not (beside := Path(file).parent / "operations.npz").exists():
        raise OptionError("operations.npz must stand beside it: copy both files of the plan", file=file)
    with Archive(beside, "operations of a plan", OptionError) as archive:
        return document, {name: archive.read(name) for name in archive.headers}
