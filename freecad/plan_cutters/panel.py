"""The task panel: asks for a job, runs it in the background, and hands the result to `findings`."""

from __future__ import annotations

import FreeCAD as App
import FreeCADGui as Gui

from . import findings, model, objects, remembered, runner, windows
from .fields import MachineBox, PartBox
from .picking import Picker
from .tools_box import ToolsBox
from .windows import QtCore, QtGui
from .words import several, tr

_PLAN, _CLOSE = QtGui.QDialogButtonBox.Apply, QtGui.QDialogButtonBox.Close


class Panel(windows.Panel):
    """The panel that asks: what is to be machined, with which tools, on which machine."""

    def __init__(self) -> None:
        self._run: runner.Run | None = None
        self._buttons, self._ready = None, False
        choices = remembered.load()
        self.picker = Picker()
        status, layout = windows.box(tr("Plan cutters"), "plan_cutters")
        self.status = windows.words(name="status")
        self.bar = QtGui.QProgressBar()
        self.bar.setVisible(False)
        layout.addRow(self.status)
        layout.addRow(self.bar)
        self.part = PartBox(self.picker, choices, self._changed, self._job_taken)
        self.tools = ToolsBox(App.ActiveDocument, choices, self._changed)
        self.machine = MachineBox(self.picker, choices, self._changed)
        self.form = [status, self.part.form, self.tools.form, self.machine.form]
        self._ready = True
        self.part.take(quiet=True)

    def job(self) -> model.Job:
        """What is requested now."""
        missing = self.tools.missing()
        if not self.part.body:
            raise model.Refused(tr("select the body to machine, or faces of it, and press “Take”"))
        model.thing_of(self.part.document, self.part.body)
        if missing:
            raise model.Refused(missing)
        kind, options = self.part.kind(), self.machine.options()
        if kind == "picked" and not self.part.faces:
            raise model.Refused(tr("no face is picked: click faces in the view"))
        if kind == "all":
            options = ("--faces", "all", *options)
        return model.Job(
            document=self.part.document, body=self.part.body, faces=self.part.faces if kind == "picked" else (),
            tools=self.tools.tools(), machine=self.machine.machine(), setup=self.machine.setup(),
            fixtures=self.machine.fixtures(self.part.document, self.part.body), allowance=self.machine.allowance(),
            options=options,
        )  # fmt: skip

    def _job_taken(self, job) -> None:
        self.tools.take_job(job)
        self.machine.take_job(job)

    def _changed(self) -> None:
        if not self._ready or self._run is not None or self._gone():
            return
        try:
            job = self.job()
        except model.Refused as error:
            self.status.setText(str(error)[:1].upper() + str(error)[1:] + ".")
            self._offer(False)
            return
        count = len(job.faces)
        kinds = {"all": tr("all faces"), "picked": several(count, tr("{count} face"), tr("{count} faces"))}
        what = kinds.get(self.part.kind(), tr("free-form faces and fillets"))
        label = App.getDocument(job.document).getObject(job.body).Label
        self.status.setText(
            tr("{label}: {faces}; {tools}; {machine}; spindle {setup}.").format(
                label=label, faces=what, tools=self.tools.summary(), machine=job.machine or tr("any tool axis"), setup=job.setup
            )
        )
        self._offer(True)

    def _offer(self, ready: bool) -> None:
        if self._buttons is not None:
            plan = self._buttons.button(_PLAN)
            plan.setText(tr("Plan") if self._run is None else tr("Cancel"))
            shown = QtGui.QStyle.SP_DialogApplyButton if self._run is None else QtGui.QStyle.SP_DialogCancelButton
            plan.setIcon(plan.style().standardIcon(shown))
            plan.setEnabled(ready)

    def start(self) -> None:
        """Plan in the background."""
        self.picker.stop()
        for each in (self.part.pick, self.machine.pick_axis, self.machine.pick_fixtures):
            each.setChecked(False)
        Gui.Selection.clearSelection()
        try:
            job = self.job()
            self._remember()
            self._watch(True)
            self._run = runner.Run(job, self._progress, self._done, self._failed)
        except model.Refused as error:
            self._watch(False)
            self.status.setText(str(error))
            return
        self._offer(True)

    def _remember(self) -> None:
        kept = remembered.load()
        remembered.save(remembered.Choices(
            faces=self.part.kind() if self.part.kind() != "picked" else kept.faces, show_tool=kept.show_tool,
            **self.tools.choices(), **self.machine.choices(),
        ))  # fmt: skip

    def _watch(self, running: bool) -> None:
        self.bar.setVisible(running)
        self.bar.setRange(0, 0)
        for each in self.form[1:]:
            each.setEnabled(not running)

    def _gone(self) -> bool:
        """Whether another command closed the panel, which FreeCAD does not tell it; what it does is given up then."""
        if windows.alive(self.status):
            return False
        self._leave()
        return True

    def _progress(self, words: str, fraction: float | None) -> None:
        if self._gone():
            return
        self.status.setText(words[:1].upper() + words[1:])
        self.bar.setRange(0, 0 if fraction is None else 1000)
        if fraction is not None:
            self.bar.setValue(round(1000 * fraction))

    def _end(self) -> None:
        self._run = None
        self._watch(False)
        self._changed()

    def _failed(self, line: str) -> None:
        if self._gone():
            return
        self._end()
        self.status.setText(line[:1].upper() + line[1:])
        App.Console.PrintError(f"plan-cutters: {line}\n")

    def _done(self, result) -> None:
        if self._gone():
            result.discard()
            return
        try:
            group = objects.show(App.getDocument(result.document), result)
        except Exception as error:  # whatever the document has against it: nothing is silent
            result.discard()
            self._failed(str(error) or type(error).__name__)
            return
        self._end()
        # FreeCAD closes one panel before it opens another one, and this is called out of the first.
        QtCore.QTimer.singleShot(0, lambda: self._hand_over(group))

    def _hand_over(self, group) -> None:
        self._leave()
        Gui.Control.closeDialog()
        findings.open_panel(group)

    def _leave(self) -> None:
        self.picker.close()
        if self._run is not None:
            run, self._run = self._run, None
            run.cancel()

    # FreeCAD's side of the panel.

    def getStandardButtons(self) -> int:
        return windows.code(_PLAN | _CLOSE)

    def modifyStandardButtons(self, buttons) -> None:
        self._buttons = buttons
        self._changed()

    def clicked(self, which) -> None:
        if windows.code(which) != windows.code(_PLAN):
            return
        if self._run is None:
            self.start()
        else:
            self._run.cancel()

    def reject(self) -> bool:
        self._leave()
        return True


def open_panel() -> Panel:
    """Show the panel, with what is selected now."""
    if App.ActiveDocument is None:
        raise model.Refused(tr("no document is open"))
    panel = Panel()
    Gui.Control.showDialog(panel)
    return panel
