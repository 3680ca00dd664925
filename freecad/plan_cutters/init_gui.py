"""The workbench: its menu, its toolbar and its page of settings. FreeCAD imports this as it starts, so it loads little."""

from __future__ import annotations

import FreeCADGui as Gui

from . import commands, icons, preferences, words
from .words import later, tr

words.load()


class PlanCutters(Gui.Workbench):
    """Which cutters can finish the picked faces."""

    MenuText = tr("Plan cutters")
    ToolTip = tr("Says which cutters can finish the picked faces, before any toolpath exists")
    Icon = icons.path("plan_cutters")

    def Initialize(self) -> None:
        """Called when the workbench is opened for the first time."""
        # FreeCAD translates these itself; what is translated before, it shows without its accents.
        self.appendToolbar(later("Plan cutters"), commands.NAMES)
        self.appendMenu(later("&Plan cutters"), commands.NAMES)

    def ContextMenu(self, recipient: str) -> None:
        """Called where the right button opens a menu, in the view or in the tree."""
        self.appendContextMenu(tr("Plan cutters"), commands.IN_CONTEXT)

    def GetClassName(self) -> str:
        return "Gui::PythonWorkbench"


commands.register()
preferences.register()
Gui.addWorkbench(PlanCutters())
