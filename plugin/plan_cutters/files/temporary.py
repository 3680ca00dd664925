"""The folder for temporary files."""

import tempfile

from plan_cutters.errors import PlanError


def require_temporary() -> None:
    """See to it that temporary files can be written somewhere.

    Raises
    ------
    PlanError
        No folder for them can be written to.
    """
    try:
        tempfile.gettempdir()
    except FileNotFoundError:
        raise PlanError("no folder for temporary files can be written to; name one with TMPDIR") from None
