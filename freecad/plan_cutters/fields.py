"""What the panel asks for: part and faces, tools, machine and setup."""

from __future__ import annotations

import os
import shlex
from typing import Any

from . import model, windows
from .picking import Picker
from .remembered import Choices
from .windows import QtCore, QtGui

FACES = [("Free-form faces and fillets", "sculptured,blends"), ("Picked faces", "picked"), ("All faces", "all")]
MACHINES = [
    ("Any tool axis", ""),
    ("3 axes", "3-axis"),
    ("4 axes, A", "4-axis-a"),
    ("3+2 table, C on A", "3+2"),
    ("Trunnion, C on A", "trunnion-ac"),
    ("Trunnion, C on B", "trunnion-bc"),
    ("Table C, head B", "head-table-bc"),
    ("Head C, A", "head-head-ca"),
    ("Nutating head B, table C", "nutating-bc"),
    ("Within 30° of the setup axis", "tilt:30"),
    ("Within 60° of the setup axis", "tilt:60"),
]
AXES = [(f"{sign}{name} of the document", f"{sign}{name}".lower()) for name in "ZXY" for sign in "+-"]
HOLDERS = [
    ("As the tools say", ""),
    ("None at all", "none"),
    ("Collet chuck ER16", "er16"),
    ("Collet chuck ER32", "er32"),
    ("HSK63-A with ER32", "hsk63a-er32"),
    ("BT40 with ER32", "bt40-er32"),
]
OPERATIONS = [("No", ""), ("The fewest", "fewest"), ("The fastest", "fastest"), ("Both plans", "both")]
LIBRARIES = "Tool libraries (*.json *.tools *.csv *.hsmlib *.fctl *.fctb *.toml *.fcholder);;All files (*)"


class PartBox:
    """Which body, and which of its faces are to be machined."""

    def __init__(self, picker: Picker, choices: Choices, changed) -> None:
        self._picker, self._changed = picker, changed
        self.document, self.body = "", ""
        self.faces: tuple[int, ...] = ()
        self.form, layout = windows.box("Part and faces", "part")
        self._name = windows.words("none: select a body", "body")
        layout.addRow("Body", windows.row(self._name, windows.button("Take", self.take, "Take the body, or faces, selected now")))
        self._kind = windows.combo(FACES, choices.faces)
        self._kind.setObjectName("faces")
        layout.addRow("To machine", self._kind)
        self._list = windows.words("", "picked")
        self.pick = windows.button("Pick", self._picking, "Click faces in the view, more of them with Ctrl", True)
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
        try:
            found = model.picked(selection)
        except model.Refused as error:
            if not quiet:
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
            self._list.setText("click faces in the view; Ctrl adds more")
        else:
            self._list.setText("none")
        self._changed()


class ToolsBox:
    """Which tools are judged: what is ticked, or else the program's default tool set."""

    def __init__(self, document, choices: Choices, changed) -> None:
        self._changed = changed
        self.form, layout = windows.box("Tools", "tools")
        self._list = QtGui.QListWidget()
        self._list.setObjectName("tools")
        windows.narrow(self._list).setFixedHeight(74)
        self._list.setToolTip("Tick what is judged. Nothing ticked: the program's own set of usual metric sizes. Del takes away.")
        layout.addRow(self._list)
        self._typed = QtGui.QLineEdit()
        self._typed.setObjectName("typed")
        self._typed.setPlaceholderText("D12L80, R6L80rc6…")
        self._typed.setToolTip("Diameter D or radius R, stick-out L, corner radius rc: R6L80rc6 is a ball end. Enter adds it.")
        self._typed.editingFinished.connect(self._add_typed)
        layout.addRow("Add", windows.narrow(self._typed))
        layout.addRow("", windows.button("Tool library…", self._add_library, "Fusion, HSMWorks, FreeCAD or TOML"))
        self._holder = windows.combo(HOLDERS, choices.holder, editable=True)
        self._holder.setObjectName("holder")
        self._holder.setToolTip("Of the tools that have none: a name as er32, R15L30 (radius, length), or a file")
        layout.addRow("Holder", self._holder)
        self._stick_out = windows.length(choices.stick_out, "as the tools say", "stick_out")
        self._stick_out.setToolTip("From the holder's face to the tip, of library tools that state none")
        layout.addRow("Stick-out", self._stick_out)
        for name, label in model.bits(document) if document else ():
            self._add("bit", name, f"{label} (tool bit of this document)", False)
        for path in choices.libraries:
            self._add("file", path, os.path.basename(path), os.path.exists(path))
        for word in choices.typed:
            self._add("spec", word, word, True)
        self._list.itemChanged.connect(lambda *_: changed())
        remove = QtGui.QShortcut(QtGui.QKeySequence("Del"), self._list)
        remove.setContext(QtCore.Qt.WidgetShortcut)
        remove.activated.connect(self._remove)
        self._holder.currentTextChanged.connect(lambda *_: changed())

    def _add(self, kind: str, value: str, text: str, ticked: bool) -> None:
        item = QtGui.QListWidgetItem(text)
        item.setToolTip(value)
        item.setData(QtCore.Qt.UserRole, (kind, value))
        item.setFlags(item.flags() | QtCore.Qt.ItemIsUserCheckable)
        item.setCheckState(QtCore.Qt.Checked if ticked else QtCore.Qt.Unchecked)
        self._list.addItem(item)

    def _add_typed(self) -> None:
        words = self._typed.text().replace(",", " ").replace(";", " ").split()
        self._typed.clear()
        for word in words:
            if word not in self._entries("spec", False):
                self._add("spec", word, word, True)
        if words:
            self._changed()

    def _add_library(self) -> None:
        for path in QtGui.QFileDialog.getOpenFileNames(self.form, "Tool libraries", "", LIBRARIES)[0]:
            self._add("file", path, os.path.basename(path), True)
        self._changed()

    def _remove(self) -> None:
        self._list.takeItem(self._list.currentRow())
        self._changed()

    def _entries(self, kind: str, ticked: bool = True) -> tuple[str, ...]:
        items = [self._list.item(place) for place in range(self._list.count())]
        return tuple(
            item.data(QtCore.Qt.UserRole)[1] for item in items if item.data(QtCore.Qt.UserRole)[0] == kind
            and (not ticked or item.checkState() == QtCore.Qt.Checked)
        )  # fmt: skip

    def tools(self) -> model.Tools:
        """What is requested."""
        return model.Tools(
            specs=self._entries("spec"), files=self._entries("file"), bits=self._entries("bit"),
            holder=windows.chosen(self._holder), stick_out=self._stick_out.value() or None,
        )  # fmt: skip

    def choices(self) -> dict:
        """What is remembered."""
        return {"libraries": self._entries("file", False), "typed": self._entries("spec", False),
                "holder": windows.chosen(self._holder), "stick_out": self._stick_out.value()}  # fmt: skip

    def summary(self) -> str:
        """In a few words."""
        tools = self.tools()
        count = len(tools.specs) + len(tools.bits)
        parts = [f"{count} tool{'s' * (count != 1)}"] * bool(count)
        parts += [os.path.basename(path) for path in tools.files]
        return ", ".join(parts) or "the default tool set"


class MachineBox:
    """The machine, how the part stands in it, what holds it, what is left on it."""

    def __init__(self, picker: Picker, choices: Choices, changed) -> None:
        self._picker, self._changed = picker, changed
        self._axis, self._axis_name = "", ""
        self._fixtures: list[tuple[str, str, Any]] = []
        self.form, layout = windows.box("Machine and setup", "settings")
        self._machine = windows.combo(MACHINES, choices.machine, editable=True)
        self._machine.setObjectName("machine")
        self._machine.setToolTip("A machine that the program knows, tilt:45, or a machine file")
        layout.addRow(
            "Machine", windows.row(self._machine, windows.button("File…", self._machine_file, "TOML, JSON, .fcm, .ini, .mch"))
        )
        entries = [*AXES, ("Proposed by the program", "auto"), ("Picked face or edge", "picked")]
        self._setup = windows.combo(entries, choices.setup if choices.setup != "picked" else "+z")
        self._setup.setObjectName("setup")
        self._setup.setToolTip("The direction of the part that points along the spindle when all rotary axes are at zero")
        self.pick_axis = windows.button("Pick", self._picking_axis, "Click a flat face, a straight edge or an axis", True)
        layout.addRow("Spindle", windows.row(self._setup, self.pick_axis))
        self._axis_words = windows.words("", "axis")
        layout.addRow("", self._axis_words)
        self._bodies = windows.words("none", "fixtures")
        self.pick_fixtures = windows.button("Pick", self._picking_fixtures, "Click what holds the part; Ctrl adds more", True)
        layout.addRow("Fixtures", windows.row(self._bodies, self.pick_fixtures))
        self._table = QtGui.QCheckBox("Table under the part")
        self._table.setChecked(choices.table)
        layout.addRow("", self._table)
        self._allowance = windows.length(choices.allowance, name="allowance")
        self._allowance.setToolTip("Stock that is left on the surface on purpose")
        layout.addRow("Allowance", self._allowance)
        self._operations = windows.combo(OPERATIONS, choices.operations)
        self._operations.setObjectName("operations")
        self._operations.setToolTip("Fixed orientations (3+2) that finish together all that is reached")
        layout.addRow("Operations", self._operations)
        self._more = QtGui.QLineEdit(choices.more)
        self._more.setObjectName("more")
        self._more.setCursorPosition(0)
        self._more.setPlaceholderText("--spacing 2 --answers mend")
        self._more.setToolTip("More options of plan-cutters, as in a terminal")
        layout.addRow("More", windows.narrow(self._more))
        self._setup.currentIndexChanged.connect(lambda *_: self._setup_chosen())
        self._machine.currentTextChanged.connect(lambda *_: changed())
        self._more.textChanged.connect(lambda *_: changed())
        self._setup_chosen()

    def _machine_file(self) -> None:
        path = QtGui.QFileDialog.getOpenFileName(self.form, "Machine", "", "Machines (*.toml *.json *.fcm *.ini *.mch);;All (*)")[
            0
        ]
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
            self._axis_words.setText("click a flat face, a straight edge or an axis")
        elif self._axis:
            self._axis_words.setText(f"{self._axis_name}: {self._axis}")
        else:
            self._axis_words.setText("nothing is picked yet")
        names = ", ".join(label for _, _, label in self._fixtures)
        self._bodies.setText(names or ("click what holds the part" if self.pick_fixtures.isChecked() else "none"))
        self._changed()

    def setup(self) -> str:
        """The setup as the program has it."""
        value = windows.chosen(self._setup)
        if value != "picked":
            return value
        if not self._axis:
            raise model.Refused("no spindle direction is picked: click a flat face, a straight edge or an axis")
        return self._axis

    def fixtures(self, document: str, body: str) -> tuple[str, ...]:
        """Names of the bodies in the way."""
        for each in self._fixtures:
            if each[0] != document:
                raise model.Refused(f"the fixture {each[2]} lies in another document than the body")
            if each[1] == body:
                raise model.Refused("the body that is planned is picked as a fixture, too")
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
            raise model.Refused(f"“More” cannot be read: {error}") from None
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
