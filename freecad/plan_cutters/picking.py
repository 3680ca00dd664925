"""Clicks in the view go to one row of a panel at a time."""

from __future__ import annotations

from typing import Any, Callable

import FreeCADGui as Gui

from . import windows


class Picker:
    """The row that takes what is selected, if one does.

    A row mirrors FreeCAD's selection: a click is one thing, a click with Ctrl one more. What the row had is selected again when
    it takes over, so that picking can go on later.
    """

    def __init__(self) -> None:
        self._take: Callable[[Any], None] | None = None
        self._button: Any = None
        self._quiet = False
        Gui.Selection.addObserver(self)

    def give(self, button: Any, take: Callable[[Any], None], chosen: list[tuple[str, str, str]]) -> None:
        """Hand clicks to a row, of which `button` is down as long as it has them; the button of the row before comes up.

        `take` is called with the selection; `chosen` are names of document, object and element.
        """
        before, self._button, self._take, self._quiet = self._button, None, None, True
        try:
            if before is not None:
                before.setChecked(False)
            Gui.Selection.clearSelection()
            for document, thing, element in chosen:
                Gui.Selection.addSelection(document, thing, element)
        finally:
            self._quiet = False
        self._button, self._take = button, take

    def stop(self, button: Any = None) -> None:
        """Clicks select as always, if they went to this row."""
        if button is None or button is self._button:
            self._button = self._take = None

    def close(self) -> None:
        """Forget the view."""
        self.stop()
        Gui.Selection.removeObserver(self)

    def _changed(self) -> None:
        if self._button is not None and not windows.alive(self._button):
            self.close()
            return
        if self._take is not None and not self._quiet:
            self._take(Gui.Selection.getSelectionEx("*"))

    def addSelection(self, *_: Any) -> None:
        self._changed()

    def removeSelection(self, *_: Any) -> None:
        self._changed()

    def setSelection(self, *_: Any) -> None:
        self._changed()

    def clearSelection(self, *_: Any) -> None:
        self._changed()
