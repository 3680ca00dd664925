"""Files that are tool libraries, or should be."""

import os
from typing import ClassVar

from plan_cutters.errors import LibraryError, PlanError
from plan_cutters.files import content
from plan_cutters.files.content import lines_of

__all__ = ["Content", "data_of", "lines_of"]


class Content(content.Content):
    """A file that may be a tool library."""

    noun: ClassVar[str] = "tool library"
    error: ClassVar[type[PlanError]] = LibraryError


def data_of(path: str | os.PathLike[str]) -> bytes:
    """All bytes of a regular file."""
    return content.data_of(path, Content.noun, Content.error)
