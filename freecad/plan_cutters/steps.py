"""The steps of a plan as a list that is edited and judged again."""

from __future__ import annotations

import dataclasses
from typing import Any, Callable

from . import model, objects, own_process, results, runner, windows
from .windows import QtCore, QtGui
from .words import area_of, tr

#: Columns: their heads, and the part of a step that is edited in each; none is edited where that is empty.
_COLUMNS = (("Area, mm²", ""), ("Setup", ""), ("Orientation", "turned"), ("Cutter", "cutter"), ("Faces", "faces"))


class StepsBox:
    """The box of the steps: rows that are edited, moved and left out, and judged again in the background.

    Parameters
    ----------
    group : App.DocumentObjectGroup
        That shows the plan.
    result : results.Result
    on_done : callable
        Called with the result of steps that were judged again.
    """

    def __init__(self, group: Any, result: results.Result, on_done: Callable[[results.Result], None]) -> None:
        self._group, self._result, self._on_done = group, result, on_done
        self._run: runner.Run | None = None
        self.steps = own_process.steps_of(result.plan)
        self.form, layout = windows.box(tr("Steps"), "plan_cutters")
        before = (result.plan.get("effective") or {}).get("process") or {}
        # What the steps do together, where they were judged as they stand.
        layout.addRow(windows.words(result.headline() if before else "", "steps_head"))
        self.list = QtGui.QTreeWidget()
        self.list.setObjectName("steps")
        self.list.setHeaderLabels([head for head, _ in _COLUMNS])
        self.list.setRootIsDecorated(False)
        self.list.setIndentation(0)
        self.list.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        self.list.setToolTip(
            tr("Double-click an orientation (C 0 A 90, simultaneous), a cutter or faces (F3 F6, left) to change it")
        )
        windows.narrow(self.list).setFixedHeight(130)
        self.list.itemDoubleClicked.connect(self._edit)
        self.list.itemChanged.connect(self._edited)
        self.list.currentItemChanged.connect(lambda *_: self._tell())
        layout.addRow(self.list)
        self._up = windows.button(tr("Up"), lambda: self._move(-1), tr("This step before the one above"))
        self._down = windows.button(tr("Down"), lambda: self._move(1), tr("This step behind the one below"))
        self._out = windows.button(tr("Leave out"), self._leave_out, tr("The process without this step"))
        layout.addRow(windows.row(self._up, self._down, self._out))
        self.rest = QtGui.QCheckBox(tr("Plan what they leave"))
        self.rest.setChecked(before.get("rest", "plan") == "plan")
        layout.addRow(self.rest)
        self.again = windows.button(tr("Judge again"), self.judge, tr("Judge these steps as they stand, in this order"))
        layout.addRow(self.again)
        self.told = windows.words("", "steps_told")
        layout.addRow(self.told)
        self.bar = QtGui.QProgressBar()
        layout.addRow(self.bar)
        self._fill(0)

    def _fill(self, place: int) -> None:
        """Show the steps, the one at a place as the current one."""
        self.list.blockSignals(True)
        self.list.clear()
        for step in self.steps:
            area = "" if step.area is None else area_of(step.area)
            item = QtGui.QTreeWidgetItem([area, str(step.setup), step.turned, step.cutter, step.faces])
            item.setFlags(item.flags() | QtCore.Qt.ItemIsEditable)
            for column in range(len(_COLUMNS)):
                item.setToolTip(column, step.fault or step.faces)
            self.list.addTopLevelItem(item)
        for column in (0, 1, 2, 3):
            self.list.resizeColumnToContents(column)
        self.list.setCurrentItem(self.list.topLevelItem(min(place, len(self.steps) - 1)))
        self.list.blockSignals(False)
        self._tell()

    @property
    def place(self) -> int:
        """Of the current row; -1 for none."""
        return int(self.list.indexOfTopLevelItem(self.list.currentItem()))

    def _tell(self) -> None:
        """Say what is known of the current step."""
        place = self.place
        self.bar.setVisible(self._run is not None)
        for button in (self._up, self._down, self._out):
            button.setEnabled(place >= 0 and self._run is None)
        if self._run is not None:
            return
        self.again.setEnabled(bool(self.steps))
        if place < 0:
            self.told.setText(tr("There is no step.") if not self.steps else "")
            return
        step = self.steps[place]
        gone = (
            ""
            if step.alone is None
            else tr("{area} are gone if it is left out and nothing is planned there.").format(area=area_of(step.alone))
        )
        # What the plan judged has an area, also where it does not say what is gone without it.
        unknown = tr("Changed: judge again.") if step.area is None else ""
        self.told.setText(" ".join(filter(None, (step.fault, gone))) or unknown)

    def _edit(self, item: Any, column: int) -> None:
        if _COLUMNS[column][1] and self._run is None:
            self.list.editItem(item, column)

    def _edited(self, item: Any, column: int) -> None:
        place, part = self.list.indexOfTopLevelItem(item), _COLUMNS[column][1]
        if part and place >= 0:
            self.steps[place] = own_process.edited(self.steps[place], part, item.text(column))
            # The list is not filled out of its own editor.
            QtCore.QTimer.singleShot(0, lambda: self._fill(place))

    def _move(self, by: int) -> None:
        place = self.place
        self.steps = own_process.moved(self.steps, place, by)
        self._fill(max(0, min(place + by, len(self.steps) - 1)))

    def _leave_out(self) -> None:
        place = self.place
        self.steps = own_process.without(self.steps, place)
        self._fill(max(0, place))

    def judge(self) -> None:
        """Judge the steps again in the background; pressed while that runs, it ends it."""
        if self._run is not None:
            self._run.cancel()
            return
        try:
            if changed := objects.stale(self._group):
                # Numbers of faces may be those of others.
                raise model.Refused(changed)
            process = own_process.process_of(self.steps, self._result.plan, self.rest.isChecked())
            job = dataclasses.replace(self._result.job, process=process)
            self._run = runner.Run(job, self._progress, self._done, self._failed)
        except model.Refused as error:
            self.told.setText(str(error))
            return
        self.again.setText(tr("Cancel"))
        self._tell()

    def _gone(self) -> bool:
        """Whether another command closed the panel: what is being judged is given up then."""
        if windows.alive(self.told):
            return False
        self.leave()
        return True

    def _progress(self, words: str, fraction: float | None) -> None:
        if self._gone():
            return
        self.told.setText(words)
        self.bar.setRange(0, 0 if fraction is None else 1000)
        if fraction is not None:
            self.bar.setValue(round(1000 * fraction))

    def _ended(self) -> None:
        self._run = None
        self.again.setText(tr("Judge again"))
        self._tell()

    def _failed(self, line: str) -> None:
        if self._gone():
            return
        self._ended()
        self.told.setText(line)

    def _done(self, result: results.Result) -> None:
        if self._gone():
            result.discard()
            return
        self._ended()
        try:
            self._on_done(result)
        except Exception as error:  # whatever the document has against it: nothing is silent
            result.discard()
            self.told.setText(str(error) or type(error).__name__)

    def leave(self) -> None:
        """Give up what is being judged."""
        if self._run is not None:
            run, self._run = self._run, None
            run.cancel()
