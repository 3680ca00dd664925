"""Regular files alone are read: a pipe may be waited for without end, and a device may never end."""

import os
from pathlib import Path

from plan_cutters.errors import PlanError
from plan_cutters_base.user_files import IrregularError, open_regular


def regular_bytes(path: str | os.PathLike[str], most: int) -> bytes | None:
    """Read all bytes of a regular file, or of a link to one; the result is None where there is no such file.

    Parameters
    ----------
    path : path
        Where it should be.
    most : int
        Bytes that it may have.

    Raises
    ------
    PlanError
        It is no regular file, is larger, or cannot be read.

    Examples
    --------
    >>> regular_bytes("not/there", most=10) is None
    True
    """
    name = Path(path).name
    try:
        with open_regular(path) as opened:
            large = os.fstat(opened.fileno()).st_size > most
            data = b"" if large else opened.read(most + 1)
    except (FileNotFoundError, NotADirectoryError):
        return None
    except IrregularError as fault:
        raise PlanError(str(fault), file=name) from None
    except OSError as fault:
        raise PlanError(f"cannot be read: {fault.strerror or fault}", file=name) from None
    except ValueError as fault:
        raise PlanError(f"is no name of a file: {fault}", file=ascii(name)) from None
    if large or len(data) > most:
        raise PlanError(f"is larger than {most} bytes", file=name)
    return data
