"""The plan file: its schema, how it is read, the forms of its numbers, the names of reasons, and its words.

A plan can be read and put into words here without the CAD kernel, the compiler, scipy or any picture. Names are handed on lazily:
whoever writes a per cent loads no schema.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plan_cutters.plan_file.load import load_plan as load_plan
    from plan_cutters.plan_file.model import Plan as Plan

__all__ = ["Plan", "load_plan"]


def __getattr__(name: str) -> object:
    from importlib import import_module

    home = {"Plan": "model", "load_plan": "load"}.get(name)
    if home is None:
        raise AttributeError(f"module 'plan_cutters.plan_file' has no attribute {name!r}")
    return getattr(import_module(f"plan_cutters.plan_file.{home}"), name)
