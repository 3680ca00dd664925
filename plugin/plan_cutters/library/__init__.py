"""Tool libraries: what other programs and people write about tools, read into cutters.

May use: domain. `formats.py` is the table of formats, each of which is one module.
"""

from plan_cutters.library.read import holder_of, read_library
from plan_cutters.library.records import Entry, Library
from plan_cutters.library.toml_out import to_toml

__all__ = ["Entry", "Library", "holder_of", "read_library", "to_toml"]
