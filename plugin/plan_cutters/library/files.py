"""Files that are tool libraries, or should be."""

import os
from typing import ClassVar

from plan_cutters.errors import LibraryError, PlanError
from plan_cutters.files import content
from plan_cutters.files.content import lines_of

__all__ = ["MOST_TOOLS", "Content", "data_of", "lines_of", "too_many"]

#: Tools that a file may list: more take more memory than a planner's computer has.
MOST_TOOLS = 50_000


class Content(content.Content):
    """A file that may be a tool library."""

    noun: ClassVar[str] = "tool library"
    error: ClassVar[type[PlanError]] = LibraryError


def data_of(path: str | os.PathLike[str]) -> bytes:
    """All bytes of a regular file."""
    return content.data_of(path, Content.noun, Content.error)


def too_many(file: str) -> LibraryError:
    return LibraryError(f"lists more than {MOST_TOOLS} tools; split it", file=file)
