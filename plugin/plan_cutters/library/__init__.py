"""Tool libraries: what other programs and people write about tools, read into cutters.

May use: domain. `read.py` has the table of formats, each of which is one module. Names are handed on lazily: who has no
library loads none of them.
"""

from importlib import import_module
from typing import Any

_HOME = {
    "Entry": "raw_tool",
    "Library": "raw_tool",
    "holder_of": "read",
    "listing": "read",
    "read_library": "read",
    "to_toml": "toml",
}
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'plan_cutters.library' has no attribute {name!r}")
    return getattr(import_module(f"plan_cutters.library.{_HOME[name]}"), name)
