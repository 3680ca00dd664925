"""Commands of the workbench: what its menu, toolbar and context menu hold."""

from __future__ import annotations

from typing import Any, Callable

import FreeCAD as App
import FreeCADGui as Gui

from . import icons, windows
from .words import later, tr


def _document_open() -> bool:
    return App.ActiveDocument is not None and not Gui.Control.activeDialog()


def _plan_shown() -> bool:
    from . import objects

    return App.ActiveDocument is not None and bool(objects.plans(App.ActiveDocument))


def _plan() -> None:
    from . import panel

    panel.open_panel()


def _results() -> None:
    from . import findings

    findings.open_panel()


def _review() -> None:
    from . import findings

    findings.open_review(findings.chosen_group())


def _job() -> None:
    from . import findings, operations

    operations.make_job(findings.chosen_group())


def _clear() -> None:
    from . import objects

    objects.clear(App.ActiveDocument)


def _settings() -> None:
    Gui.showPreferences(tr("Plan cutters"), 0)


class Command:
    """A command of FreeCAD."""

    def __init__(self, words: str, hint: str, icon: str, work: Callable[[], None], when: Callable[[], bool]) -> None:
        self._words, self._hint, self._icon, self._work, self._when = words, hint, icon, work, when

    def GetResources(self) -> dict[str, Any]:
        return {"MenuText": tr(self._words), "ToolTip": tr(self._hint), "Pixmap": icons.path(self._icon)}

    def IsActive(self) -> bool:
        return self._when()

    def Activated(self, _index: int = 0) -> None:
        from . import model

        try:
            self._work()
        except model.Refused as error:
            windows.complain(str(error))


COMMANDS = {
    "PlanCutters_Plan": Command(
        later("Plan cutters…"), later("Say which cutters can finish the selected body or faces"), "plan_cutters", _plan,
        _document_open,
    ),
    "PlanCutters_Results": Command(
        later("Results…"), later("Legend, cutters and worst spots of a plan in this document"), "results", _results,
        lambda: _plan_shown() and not Gui.Control.activeDialog(),
    ),
    "PlanCutters_Review": Command(
        later("Review page"), later("Open the plan's review page in a browser"), "review", _review, _plan_shown),
    "PlanCutters_Job": Command(
        later("CAM job of the operations"),
        later("A job with the tool controllers, and work planes, of a plan that has operations"),
        "operations", _job, lambda: _plan_shown() and not Gui.Control.activeDialog(),
    ),
    "PlanCutters_Clear": Command(
        later("Remove results"), later("Take away what plans show in this document; the bodies are shown again"), "clear", _clear,
        lambda: _plan_shown() and not Gui.Control.activeDialog(),
    ),
    "PlanCutters_Settings": Command(later("Settings…"), later("Where the program is, and more"), "settings", _settings,
                                     lambda: True),
}  # fmt: skip
NAMES = list(COMMANDS)
IN_CONTEXT = ["PlanCutters_Plan", "PlanCutters_Results"]


def register() -> None:
    """Make the commands known to FreeCAD."""
    for name, command in COMMANDS.items():
        Gui.addCommand(name, command)
