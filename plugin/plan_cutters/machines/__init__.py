"""Machine files: what other programs and people write about machines, read into `Machine`.

May use: domain, files. `read.py` has the table of formats, each of which is one module. Names are handed on lazily.
"""

from importlib import import_module
from typing import Any

_HOME = {"machine_of": "read", "plain": "toml", "read_machine": "read", "to_toml": "toml"}
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'plan_cutters.machines' has no attribute {name!r}")
    return getattr(import_module(f"plan_cutters.machines.{_HOME[name]}"), name)
