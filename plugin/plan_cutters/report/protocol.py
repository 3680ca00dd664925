"""All writers take a result, which knows them itself: this is its type, for type checkers alone."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plan_cutters.result import Result as Judged
else:
    # What formats there are is asked before anything heavy is loaded.
    Judged = object
__all__ = ["Judged"]
