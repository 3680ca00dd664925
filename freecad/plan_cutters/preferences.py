"""The page of settings: where the program is."""

from __future__ import annotations

import os
import shutil

import FreeCADGui as Gui

from . import host, icons
from .words import tr


class Page:
    """A page in FreeCAD's preferences."""

    def __init__(self, _parent=None) -> None:
        qt = host.qt("QtGui")
        self.form = qt.QWidget()
        self.form.setWindowTitle(tr("Program"))
        layout = qt.QFormLayout(self.form)
        self._command = qt.QLineEdit()
        self._command.setPlaceholderText(shutil.which("plan-cutters") or tr("plan-cutters is not on the search path"))
        self._command.setToolTip(tr("Path of plan-cutters, or a command with words; empty: as it is found on the search path"))
        find = qt.QPushButton(tr("Find…"))
        find.clicked.connect(lambda *_: self._find())
        line = qt.QHBoxLayout()
        line.addWidget(self._command, 1)
        line.addWidget(find)
        layout.addRow(tr("Command"), line)
        note = qt.QLabel(
            tr(
                "The workbench runs the program plan-cutters as a process of its own, with its own "
                "Python. Install it once, for example with “uv tool install .” or “pipx install .” in its "
                "folder."
            )
        )
        note.setWordWrap(True)
        layout.addRow(note)

    def _find(self) -> None:
        qt = host.qt("QtGui")
        path = qt.QFileDialog.getOpenFileName(self.form, tr("The program plan-cutters"))[0]
        if path:
            self._command.setText(path)

    def loadSettings(self) -> None:
        self._command.setText(host.settings().GetString("Command"))

    def saveSettings(self) -> None:
        host.settings().SetString("Command", self._command.text().strip())


def register() -> None:
    """Add the page to FreeCAD's preferences."""
    # FreeCAD looks there for the picture of the page, `preferences-plan_cutters`.
    Gui.addIconPath(os.path.dirname(icons.path("plan_cutters")))
    Gui.addPreferencePage(Page, tr("Plan cutters"))
