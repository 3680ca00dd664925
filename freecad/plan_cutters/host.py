"""All that differs between releases of FreeCAD, and between FreeCAD with a window and without."""

from __future__ import annotations

import importlib
import os
from typing import Any, Callable

import FreeCAD as App

#: Where settings are kept: `Command` is the program, the rest is the panel's.
SETTINGS = "User parameter:BaseApp/Preferences/Mod/PlanCutters"


def settings() -> Any:
    """The parameters that a user's choices are kept in."""
    return App.ParamGet(SETTINGS)


def has_window() -> bool:
    """Whether FreeCAD runs with its window."""
    return bool(App.GuiUp)


def qt(name: str) -> Any:
    """A module of the Qt that FreeCAD was built with, as `QtCore`; FreeCAD's own `PySide` stands for PySide2 and PySide6."""
    for package in ("PySide", "PySide6", "PySide2"):
        try:
            return importlib.import_module(f"{package}.{name}")
        except ImportError:
            continue
    raise ImportError(f"this FreeCAD has no {name}: neither PySide, PySide6 nor PySide2")


def every(milliseconds: int, work: Callable[[], None]) -> Callable[[], None]:
    """Call `work` now and then from the window's own loop; what ends that. Without a window nothing is called."""
    if not has_window():
        return lambda: None
    timer = qt("QtCore").QTimer()
    timer.timeout.connect(work)
    timer.start(milliseconds)
    return timer.stop


def say(text: str) -> None:
    """A line in the report view."""
    App.Console.PrintMessage(f"plan-cutters: {text}\n")


def warn(text: str) -> None:
    """A line in the report view that the user should see."""
    App.Console.PrintWarning(f"plan-cutters: {text}\n")


def environment() -> dict[str, str]:
    """What the program runs in: without what FreeCAD set for its own Python."""
    kept = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONPATH")}
    if "APPDIR" in kept:  # an AppImage puts its own libraries first
        kept.pop("LD_LIBRARY_PATH", None)
    return kept
