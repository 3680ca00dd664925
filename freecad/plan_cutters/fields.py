"""What the panel asks for: part and faces, machine and setup."""

from __future__ import annotations

import shlex
from typing import Any

from . import cam, model, windows
from .picking import Picker
from .remembered import Choices
from .windows import QtGui
from .words import later, length, tr

FACES = [
    (later("Free-form faces and fillets"), "sculptured,blends"),
    (later("Picked faces"), "picked"),
    (later("All faces"), "all"),
]
MACHINES = [
    (later("Any tool axis"), ""),
    (later("3 axes"), "3-axis"),
    (later("4 axes, A"), "4-axis-a"),
    (later("3+2 table, C on A"), "3+2"),
    (later("Trunnion, C on A"), "trunnion-ac"),
    (later("Trunnion, C on B"), "trunnion-bc"),
    (later("Table C, head B"), "head-table-bc"),
    (later("Head C, A"), "head-head-ca"),
    (later("Nutating head B, table C"), "nutating-bc"),
    (later("Within 30° of the setup axis"), "tilt:30"),
    (later("Within 60° of the setup axis"), "tilt:60"),
]
AXES = [f"{sign}{name}" for name in "ZXY" for sign in "+-"]
OPERATIONS = [
    (later("No"), ""),
    (later("The fewest"), "fewest"),
    (later("The fastest"), "fastest"),
    (later("Both plans"), "both"),
]


class PartBox:
    """Which body, and which of its faces are to be machined."""

    def __init__(self, picker: Picker, choices: Choices, changed, job_taken=lambda job: None) -> None:
        self._picker, self._changed, self._job_taken = picker, changed, job_taken
        self.document, self.body = "", ""
        self.faces: tuple[int, ...] = ()
        self.form, layout = windows.box(tr("Part and faces"), "part")
        self._name = windows.words(tr("none: select a body"), "body")
        layout.addRow(
            tr("Body"),
            windows.row(self._name, windows.button(tr("Take"), self.take, tr("Take the body, faces, or CAM job selected now"))),
        )
        self._kind = windows.combo(FACES, choices.faces)
        self._kind.setObjectName("faces")
        layout.addRow(tr("To machine"), self._kind)
        self._list = windows.words("", "picked")
        self.pick = windows.button(tr("Pick"), self._picking, tr("Click faces in the view, more of them with Ctrl"), True)
        self._line = QtGui.QWidget()
        line = windows.row(self._list, self.pick)
        line.setContentsMargins(0, 0, 0, 0)
        self._line.setLayout(line)
        layout.addRow(self._line)
        self._kind.currentIndexChanged.connect(lambda *_: self._chosen())

    def take(self, quiet: bool = False) -> None:
        """Take the body, and the faces, that are selected now."""
        import FreeCADGui as Gui

        selection = Gui.Selection.getSelectionEx("*")
        if not selection and quiet:
            return self._tell()
        job = cam.job_of(selection)
        if job is not None:
            self._job_taken(job)
        try:
            found = model.picked(selection)
        except model.Refused as error:
            if not quiet or job is not None:
                self._name.setText(str(error))
            return self._tell()
        self.document, self.body, self.faces = found
        windows.choose(self._kind, "picked" if self.faces else "sculptured,blends" if self.kind() == "picked" else self.kind())
        self._tell()

    def kind(self) -> str:
        """Which faces: a value of `FACES`."""
        return windows.chosen(self._kind)

    def _chosen(self) -> None:
        if self.kind() == "picked" and not self.faces:
            self.pick.setChecked(True)
        elif self.kind() != "picked":
            self.pick.setChecked(False)
        self._tell()

    def _picking(self, on: bool) -> None:
        if on:
            self._picker.give(self.pick, self._taken, [(self.document, self.body, f"Face{number}") for number in self.faces])
        else:
            self._picker.stop(self.pick)
        self._tell()

    def _taken(self, selection) -> None:
        if not selection:
            self.faces = ()
            return self._tell()
        try:
            self.document, self.body, self.faces = model.picked(selection)
        except model.Refused as error:
            self._list.setText(str(error))
            return None
        return self._tell()

    def _tell(self) -> None:
        if self.body:
            try:
                self._name.setText(model.thing_of(self.document, self.body).Label)
            except model.Refused as error:
                self._name.setText(str(error))
                self.document, self.body, self.faces = "", "", ()
        self._line.setVisible(self.kind() == "picked")
        if self.faces:
            self._list.setText(", ".join(f"Face{number}" for number in self.faces))
        elif self.pick.isChecked():
            self._list.setText(tr("click faces in the view; Ctrl adds more"))
        else:
            self._list.setText(tr("none"))
        self._changed()


class MachineBox:
    """The machine, how the part stands in it, what holds it, what is left on it."""

    def __init__(self, picker: Picker, choices: Choices, changed) -> None:
        self._picker, self._changed = picker, changed
        self._axis, self._axis_name = "", ""
        self._fixtures: list[tuple[str, str, Any]] = []
        self.form, layout = windows.box(tr("Machine and setup"), "settings")
        self._machine = windows.combo(MACHINES, choices.machine, editable=True)
        self._machine.setObjectName("machine")
        self._machine.setToolTip(tr("A machine that the program knows, tilt:45, or a machine file"))
        layout.addRow(
            tr("Machine"),
            windows.row(self._machine, windows.button(tr("File…"), self._machine_file, tr("TOML, JSON, .fcm, .ini, .mch"))),
        )
        entries = [(tr("{axis} of the document").format(axis=axis), axis.lower()) for axis in AXES]
        entries += [(later("Proposed by the program"), "auto"), (later("Picked face or edge"), "picked")]
        self._setup = windows.combo(entries, choices.setup if choices.setup != "picked" else "+z")
        self._setup.setObjectName("setup")
        self._setup.setToolTip(tr("The direction of the part that points along the spindle when all rotary axes are at zero"))
        self.pick_axis = windows.button(tr("Pick"), self._picking_axis, tr("Click a flat face, a straight edge or an axis"), True)
        layout.addRow(tr("Spindle"), windows.row(self._setup, self.pick_axis))
        self._axis_words = windows.words("", "axis")
        layout.addRow("", self._axis_words)
        self._bodies = windows.words(tr("none"), "fixtures")
        self.pick_fixtures = windows.button(
            tr("Pick"), self._picking_fixtures, tr("Click what holds the part; Ctrl adds more"), True
        )
        layout.addRow(tr("Fixtures"), windows.row(self._bodies, self.pick_fixtures))
        self._table = QtGui.QCheckBox(tr("Table under the part"))
        self._table.setChecked(choices.table)
        # On a line of its own, for beside the words it would make the panel wider than a small screen leaves it.
        layout.addRow(self._table)
        self._allowance = windows.length(choices.allowance, name="allowance")
        self._allowance.setToolTip(tr("Stock that is left on the surface on purpose"))
        layout.addRow(tr("Allowance"), self._allowance)
        self._stock, self._stock_words = 0.0, windows.words("", "stock")
        self._as_allowance = windows.button(
            tr("As allowance"), self._take_stock, tr("Judge with the stock of the job left on the surface")
        )
        self._stock_line = QtGui.QWidget()
        # One below the other: side by side the words would break at each, and the button would lose its ends.
        line = QtGui.QVBoxLayout()
        line.addWidget(self._stock_words)
        line.addWidget(self._as_allowance)
        line.setContentsMargins(0, 0, 0, 0)
        self._stock_line.setLayout(line)
        self._stock_line.setVisible(False)
        layout.addRow(self._stock_line)
        self._operations = windows.combo(OPERATIONS, choices.operations)
        self._operations.setObjectName("operations")
        self._operations.setToolTip(tr("Fixed orientations (3+2) that finish together all that is reached"))
        layout.addRow(tr("Operations"), self._operations)
        self._more = QtGui.QLineEdit(choices.more)
        self._more.setObjectName("more")
        self._more.setCursorPosition(0)
        self._more.setPlaceholderText("--spacing 2 --answers mend")
        self._more.setToolTip(tr("More options of plan-cutters, as in a terminal"))
        layout.addRow(tr("More"), windows.narrow(self._more))
        self._setup.currentIndexChanged.connect(lambda *_: self._setup_chosen())
        self._machine.currentTextChanged.connect(lambda *_: changed())
        self._more.textChanged.connect(lambda *_: changed())
        self._setup_chosen()

    def take_job(self, job) -> None:
        """Take the direction of a CAM job, and offer its stock as the allowance: it counts only if the user says so."""
        windows.choose(self._setup, "+z")
        self._stock = cam.stock_over(job)
        self._stock_words.setText(
            tr("Stock of {job}: {length} over the part at least").format(job=job.Label, length=length(self._stock))
        )
        self._stock_line.setVisible(self._stock > 0.0)

    def _take_stock(self) -> None:
        self._allowance.setValue(self._stock)

    def _machine_file(self) -> None:
        path = QtGui.QFileDialog.getOpenFileName(
            self.form, tr("Machine"), "", tr("Machines") + " (*.toml *.json *.fcm *.ini *.mch);;" + tr("All files") + " (*)"
        )[0]
        if path:
            self._machine.setEditText(path)

    def _setup_chosen(self) -> None:
        picked = windows.chosen(self._setup) == "picked"
        self.pick_axis.setVisible(picked)
        self._axis_words.setVisible(picked)
        self.pick_axis.setChecked(picked and not self._axis)
        self._tell()

    def _picking_axis(self, on: bool) -> None:
        if on:
            self._picker.give(self.pick_axis, self._axis_taken, [])
        else:
            self._picker.stop(self.pick_axis)
        self._tell()

    def _axis_taken(self, selection) -> None:
        if not selection:
            return
        entry = selection[0]
        owner, _, element = (entry.SubElementNames or ("",))[0].rpartition(".")
        try:
            thing = model._within(entry.Object, owner)
            self._axis = model.axis(thing, element)
        except model.Refused as error:
            self._axis_words.setText(str(error))
            return
        self._axis_name = f"{thing.Label} {element}".strip()
        self.pick_axis.setChecked(False)

    def _picking_fixtures(self, on: bool) -> None:
        if on:
            self._picker.give(
                self.pick_fixtures, self._fixtures_taken, [(document, name, "") for document, name, _ in self._fixtures]
            )
        else:
            self._picker.stop(self.pick_fixtures)
        self._tell()

    def _fixtures_taken(self, selection) -> None:
        try:
            names = [model.picked([entry])[:2] for entry in selection]
            self._fixtures = [(*each, model.thing_of(*each).Label) for each in dict.fromkeys(names)]
        except model.Refused as error:
            self._bodies.setText(str(error))
            return
        self._tell()

    def _tell(self) -> None:
        if self.pick_axis.isChecked():
            self._axis_words.setText(tr("click a flat face, a straight edge or an axis"))
        elif self._axis:
            self._axis_words.setText(f"{self._axis_name}: {self._axis}")
        else:
            self._axis_words.setText(tr("nothing is picked yet"))
        names = ", ".join(label for _, _, label in self._fixtures)
        self._bodies.setText(names or (tr("click what holds the part") if self.pick_fixtures.isChecked() else tr("none")))
        self._changed()

    def setup(self) -> str:
        """The setup as the program has it."""
        value = windows.chosen(self._setup)
        if value != "picked":
            return value
        if not self._axis:
            raise model.Refused(tr("no spindle direction is picked: click a flat face, a straight edge or an axis"))
        return self._axis

    def fixtures(self, document: str, body: str) -> tuple[str, ...]:
        """Names of the bodies in the way."""
        for each in self._fixtures:
            if each[0] != document:
                raise model.Refused(tr("the fixture {label} lies in another document than the body").format(label=each[2]))
            if each[1] == body:
                raise model.Refused(tr("the body that is planned is picked as a fixture, too"))
            model.thing_of(*each[:2])
        return tuple(name for _, name, _ in self._fixtures)

    def machine(self) -> str:
        """The machine as the program has it; empty: any tool axis."""
        return windows.chosen(self._machine)

    def allowance(self) -> float:
        """mm."""
        return float(self._allowance.value())

    def options(self) -> tuple[str, ...]:
        """More words for the program."""
        try:
            words = shlex.split(self._more.text())
        except ValueError as error:
            raise model.Refused(tr("“More” cannot be read: {error}").format(error=error)) from None
        if self._table.isChecked():
            words += ["--fixture", "table"]
        kind = windows.chosen(self._operations)
        return (*words, *(("--operations", kind) if kind else ()))

    def choices(self) -> dict:
        """What is remembered."""
        setup = windows.chosen(self._setup)
        return {"machine": self.machine(), "setup": "+z" if setup == "picked" else setup, "allowance": self.allowance(),
                "table": self._table.isChecked(), "operations": windows.chosen(self._operations),
                "more": self._more.text()}  # fmt: skip
