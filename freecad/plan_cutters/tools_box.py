"""What the panel asks for of tools: which are judged, and what they do not state."""

from __future__ import annotations

import os

import FreeCAD as App

from . import cam, model, windows
from .remembered import Choices
from .windows import QtCore, QtGui
from .words import later, several, speed, tr

HOLDERS = [
    (later("As the tools say"), ""),
    (later("None at all"), "none"),
    (later("Collet chuck ER16"), "er16"),
    (later("Collet chuck ER32"), "er32"),
    (later("HSK63-A with ER32"), "hsk63a-er32"),
    (later("BT40 with ER32"), "bt40-er32"),
]
LIBRARIES = " (*.json *.tools *.csv *.hsmlib *.fctl *.fctb *.toml *.fcholder);;"


class ToolsBox:
    """Which tools are judged: what is ticked, or else the program's default tool set."""

    def __init__(self, document, choices: Choices, changed) -> None:
        self._changed, self._document, self._cam_job = changed, document.Name if document else "", ""
        self.form, layout = windows.box(tr("Tools"), "tools")
        self._list = QtGui.QListWidget()
        self._list.setObjectName("tools")
        windows.narrow(self._list).setFixedHeight(74)
        self._list.setToolTip(
            tr("Tick what is judged. Nothing ticked: the program's own set of usual metric sizes. Del takes away.")
        )
        layout.addRow(self._list)
        self._typed = QtGui.QLineEdit()
        self._typed.setObjectName("typed")
        self._typed.setPlaceholderText("D12L80, R6L80rc6…")
        self._typed.setToolTip(
            tr("Diameter D or radius R, stick-out L, corner radius rc: R6L80rc6 is a ball end. Enter adds it.")
        )
        self._typed.editingFinished.connect(self._add_typed)
        layout.addRow(tr("Add"), windows.narrow(self._typed))
        layout.addRow("", windows.button(tr("Tool library…"), self._add_library, tr("Fusion, HSMWorks, FreeCAD or TOML")))
        self._holder = windows.combo(HOLDERS, choices.holder, editable=True)
        self._holder.setObjectName("holder")
        self._holder.setToolTip(tr("Of the tools that have none: a name as er32, R15L30 (radius, length), or a file"))
        layout.addRow(tr("Holder"), self._holder)
        self._stick_out = windows.length(choices.stick_out, tr("as the tools say"), "stick_out")
        self._stick_out.setToolTip(tr("From the holder's face to the tip, of library tools that state none"))
        layout.addRow(tr("Stick-out"), self._stick_out)
        mills = False
        for each in cam.bits(document) if document else ():
            ticked = each.mill and not each.untouched
            self._add("bit", each.name, tr("{label} (tool bit)").format(label=each.label), ticked)
            mills = mills or ticked
        for path in choices.libraries:
            self._add("file", path, os.path.basename(path), os.path.exists(path))
        for word in choices.typed:
            # The program takes short words without libraries and bits alone.
            self._add("spec", word, word, not mills)
        self._list.itemChanged.connect(lambda *_: changed())
        self._stick_out.valueChanged.connect(lambda *_: changed())
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
        kinds = tr("Tool libraries") + LIBRARIES + tr("All files") + " (*)"
        for path in QtGui.QFileDialog.getOpenFileNames(self.form, tr("Tool libraries"), "", kinds)[0]:
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

    def take_job(self, job) -> None:
        """Tick the tool bits of a CAM job's tool controllers, and nothing else."""
        if job.Document.Name != self._document:
            return
        self._cam_job = job.Name
        held = cam.controllers(job)
        have = self._entries("bit", False)
        for each in cam.bits(job.Document):
            if each.name not in have:
                self._add("bit", each.name, tr("{label} (tool bit)").format(label=each.label), False)
        self._list.blockSignals(True)
        for place in range(self._list.count()):
            item = self._list.item(place)
            kind, value = item.data(QtCore.Qt.UserRole)
            item.setCheckState(QtCore.Qt.Checked if kind == "bit" and value in held else QtCore.Qt.Unchecked)
            if kind == "bit" and value in held:
                number, feed = held[value].number, held[value].feed
                label = model.thing_of(job.Document.Name, value).Label
                item.setText(f"T{number} {label}" + (f", {speed(feed)}" if feed else "") + f" ({job.Label})")
        self._list.blockSignals(False)
        self._changed()

    def tools(self) -> model.Tools:
        """What is requested."""
        bits = self._entries("bit")
        return model.Tools(
            specs=self._entries("spec"), files=self._entries("file"), bits=bits,
            holder=windows.chosen(self._holder), stick_out=self._stick_out.value() or None,
            cam_job=self._cam_job if bits else "",
        )  # fmt: skip

    def missing(self) -> str:
        """Mark the fields that the ticked tools need and that are empty; what is missing, in a line; empty where nothing is."""
        tools = self.tools()
        document = App.listDocuments().get(self._document)
        judged = [each for each in cam.bits(document) if each.name in tools.bits] if document else []
        judged += filter(None, map(cam.bit_of_file, tools.files))
        found = cam.missing(judged, tools.holder, tools.stick_out)
        windows.mark(self._stick_out, found.get(cam.STICK_OUT, ""))
        windows.mark(self._holder, found.get(cam.HOLDER, ""))
        if tools.specs and (tools.files or tools.bits):
            return tr("short words are judged without tool bits and libraries: untick one or the other")
        return cam.line_of(found)

    def choices(self) -> dict:
        """What is remembered."""
        return {"libraries": self._entries("file", False), "typed": self._entries("spec", False),
                "holder": windows.chosen(self._holder), "stick_out": self._stick_out.value()}  # fmt: skip

    def summary(self) -> str:
        """In a few words."""
        tools = self.tools()
        count = len(tools.specs) + len(tools.bits)
        parts = [several(count, tr("{count} tool"), tr("{count} tools"))] * bool(count)
        parts += [os.path.basename(path) for path in tools.files]
        return ", ".join(parts) or tr("the default tool set")
