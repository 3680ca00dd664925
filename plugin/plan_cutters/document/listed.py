"""Names in a line."""

from collections.abc import Sequence


def listed(names: Sequence[str], most: int = 8) -> str:
    """Names in a line, the first ones where there are many.

    >>> listed(["F1", "F2", "F3"], 2), listed(["F1"])
    ('F1, F2 and 1 more', 'F1')
    """
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")
