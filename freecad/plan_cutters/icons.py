"""Icons of the workbench."""

from __future__ import annotations

import os


def path(name: str) -> str:
    """The path of an icon."""
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), "icons", name + ".svg")
