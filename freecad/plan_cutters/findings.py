"""The panel of a result: verdict, legend, worst spots that the view flies to."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui

from . import camera, host, model, objects, remembered, runner, steps, windows
from .windows import QtCore, QtGui
from .words import fine, tr

#: Sign and colour of a verdict on a cutter, by its tone.
SIGNS = {"good": ("✔", "#007a58"), "bad": ("✘", "#b34700"), "unsure": ("?", "#6b6400")}
#: Verdicts that the legend has even where nothing has them.
ALWAYS = ("accessible", "undecided", "inaccessible")
#: The panel that is open.
LAST: Findings | None = None
_CLOSE = QtGui.QDialogButtonBox.Close


def chosen_group():
    """The plan that is selected in the active document, else its newest."""
    document = App.ActiveDocument
    groups = objects.plans(document) if document else []
    if document is None or not groups:
        raise model.Refused(tr("no plan is shown in this document: plan first"))
    selected = {each.Name for each in Gui.Selection.getSelection(document.Name)}
    for group in groups:
        if group.Name in selected or selected & {each.Name for each in group.OutListRecursive}:
            return group
    return groups[-1]


def open_review(group) -> None:
    """Open the review page of a plan in the browser."""
    path = objects.result_of(group).review()
    if not path or not os.path.exists(path):
        raise model.Refused(tr("the review page of this plan is not there any more: plan again"))
    QtGui.QDesktopServices.openUrl(QtCore.QUrl.fromLocalFile(path))


class Findings(windows.Panel):
    """The panel that shows a result: verdict, legend, worst spots, the tool at one of them."""

    def __init__(self, group) -> None:
        self.group, self.result = group, objects.result_of(group)
        self._seen: camera.Seen | None = None
        self._spots: list[Any] = []
        self._here: Any = None
        self._drawing: runner.Map | None = None
        self.form = [self._verdict_box(), self._legend_box(), self._spots_box()]
        self.steps: steps.StepsBox | None = None
        if (self.result.plan.get("process") or {}).get("steps"):
            self.steps = steps.StepsBox(group, self.result, self._judged_again)
            self.form.insert(2, self.steps.form)
        windows.choose(self._cutters, group.Cutter)
        self._cutters.currentIndexChanged.connect(lambda *_: self._other_cutter())
        self._fill(group.Cutter)
        Gui.Selection.addObserver(self)
        App.addDocumentObserver(self)

    # The boxes.

    def _verdict_box(self):
        box, layout = windows.box(tr("Result"), "results")
        self._chip = QtGui.QLabel()
        self._chip.setObjectName("chip")
        layout.addRow(self._chip)
        self._headline = windows.words("", "headline")
        layout.addRow(self._headline)
        self._stale = windows.words("", "stale")
        self._stale.setStyleSheet("color: #b34700; font-weight: bold")
        layout.addRow(self._stale)
        entries = []
        for each in self.result.plan["cutters"]:
            sign = SIGNS[self.result.cutter_text(each["id"]).tone][0]
            entries.append((f"{sign} {each['name'] or each['id']}", each["id"]))
        self._cutters = windows.combo(entries, self.result.shown()["id"])
        self._cutters.setObjectName("cutters")
        layout.addRow(tr("Cutter"), self._cutters)
        self._sentence = windows.words("", "sentence")
        layout.addRow(self._sentence)
        return box

    def _legend_box(self):
        box, self._legend = windows.box(tr("Legend: share of the area"), "results")
        return box

    def _spots_box(self):
        box, layout = windows.box(tr("Worst spots"), "map")
        self._list = QtGui.QTreeWidget()
        self._list.setObjectName("spots")
        self._list.setHeaderLabels([tr("Face"), tr("Why"), tr("In the way"), tr("Depth")])
        self._list.setRootIsDecorated(False)
        self._list.setIndentation(0)
        self._list.setToolTip(tr("Depth: how far what is in the way reaches into the tool"))
        windows.narrow(self._list).setFixedHeight(110)
        self._list.currentItemChanged.connect(lambda *_: self._fly())
        self._list.itemClicked.connect(lambda *_: self._fly())
        self._told = windows.words("", "told")
        layout.addRow(self._told)
        layout.addRow(self._list)
        self._tool = QtGui.QCheckBox(tr("Show the tool there"))
        self._tool.setChecked(remembered.load().show_tool)
        self._tool.toggled.connect(self._tool_wanted)
        layout.addRow(self._tool)
        self._map = windows.button(
            tr("Posture map"), self._draw_map, tr("All postures of the cutter at the spot shown, or at the last click")
        )
        self._map.setEnabled(False)
        layout.addRow(windows.row(self._map))
        whole = windows.button(tr("Whole part"), lambda: Gui.SendMsgToActiveView("ViewFit"), tr("Fit all in the view"))
        page = windows.button(tr("Review page"), self._page, tr("Open the plan's page in a browser"))
        away = windows.button(tr("Remove"), self._remove, tr("Take this plan away and show the body again"))
        layout.addRow(windows.row(whole, page))
        layout.addRow(windows.row(away))
        return box

    # What is shown.

    def _fill(self, cutter: str) -> None:
        entry = self.result.shown(cutter)
        text = self.result.cutter_text(entry["id"])
        sign, colour = SIGNS[text.tone]
        selected = "· " + tr("selected") if entry["id"] == self.result.plan["selected"] else ""
        self._chip.setText(" ".join(filter(None, (sign, text.verdict, selected))))
        self._chip.setStyleSheet(f"background: {colour}; color: white; font-weight: bold; padding: 4px; border-radius: 4px")
        self._headline.setText(self.result.headline())
        self._headline.setToolTip("\n".join(self.result.summary()))
        whole = "" if entry is self.result.shown() else tr("Each face has the colour of its worst verdict with this cutter.")
        self._sentence.setText(" ".join(filter(None, (text.sentence, whole))))
        while self._legend.rowCount():
            self._legend.removeRow(0)
        coloured = {getattr(each, "Verdict", "") for each in self.group.Group}
        for code, words, rgb in self.result.legend():
            share = entry["area_share"].get(code)
            if code not in coloured and not share and code not in ALWAYS:
                continue
            line = f"{words}: {text.shares[code]}" if code in text.shares else words
            self._legend.addRow(windows.swatch(rgb), windows.words(line, f"legend_{code}"))
        self._spots = self.result.spots(cutter)
        self._list.blockSignals(True)
        self._list.clear()
        for spot in self._spots:
            depth = fine(spot.depth_mm) if spot.depth_mm is not None else ""
            item = QtGui.QTreeWidgetItem([spot.face, self.result.reason(spot.reason), spot.obstacle, depth])
            for column in range(4):
                item.setToolTip(column, spot.text)
            self._list.addTopLevelItem(item)
        for column in range(4):
            self._list.resizeColumnToContents(column)
        self._list.setCurrentItem(None)
        self._list.blockSignals(False)
        self._told.setText(
            tr("Click a spot: the view flies there. Or click a face: what is known there.")
            if self._spots
            else tr("No sample is lost with this cutter. Click a face: what is known there.")
        )
        self.look_again()

    def look_again(self) -> None:
        """Say whether the body was changed since it was planned."""
        why = objects.stale(self.group)
        self._stale.setText(why)
        self._stale.setVisible(bool(why))

    def _gone(self) -> bool:
        """Whether another command closed the panel, which FreeCAD does not tell it; it follows nothing any more then."""
        if self.form and windows.alive(self._told):
            return False
        self.leave()
        return True

    # FreeCAD tells what happens to documents, before it is done with it.

    def slotRecomputedDocument(self, _document) -> None:
        QtCore.QTimer.singleShot(0, self._follow)

    slotUndoDocument = slotRedoDocument = slotDeletedDocument = slotRecomputedDocument

    def _follow(self) -> None:
        """Follow the document: the plan may be gone, or be about another cutter again."""
        if LAST is not self or self._gone():
            return
        if self.result.document not in App.listDocuments():
            self.leave()
            Gui.Control.closeDialog()
            return
        groups = objects.plans(App.getDocument(self.result.document))
        mine = [each for each in groups if objects.result_of(each).body == self.result.body]
        for each in self.form:
            each.setEnabled(bool(mine))
        if not mine:
            self._told.setText(tr("The plan is no longer in the document."))
            return
        self.group = mine[-1]
        if self.group.Cutter != windows.chosen(self._cutters):
            self._cutters.blockSignals(True)
            windows.choose(self._cutters, self.group.Cutter)
            self._cutters.blockSignals(False)
            self._fill(self.group.Cutter)
        self.look_again()

    def _other_cutter(self) -> None:
        cutter = windows.chosen(self._cutters)
        try:
            self.group = objects.show(self.group.Document, self.result, cutter)
        except model.Refused as error:
            self._told.setText(str(error))
            self._follow()
            return
        self.result = objects.result_of(self.group)
        self._fill(cutter)

    def _fly(self) -> None:
        place = self._list.indexOfTopLevelItem(self._list.currentItem())
        if place < 0:
            return
        spot = self._spots[place]
        self._at(spot, spot.text)
        view = Gui.getDocument(self.group.Document.Name).ActiveView
        if not hasattr(view, "setCamera"):
            return
        try:
            if self._seen is None:
                self._seen = camera.Seen(model.shape_of(objects.body_of(self.group)))
        except model.Refused as error:
            self._told.setText(str(error))
            return
        entry = self.result.shown(spot.cutter)
        shown = objects.tool_of(self.group)
        hidden = self._seen.fly(view, spot, entry["radius"], entry["length"], None if shown is None else shown.Shape)
        if shown is not None:
            host.see_through(shown, hidden)

    def _at(self, spot, words: str) -> None:
        """Say what is known at a spot or sample, and put the tool there."""
        self._here, self._told_words = spot, words
        self._map.setEnabled(self._drawing is None)
        if self._tool.isChecked():
            try:
                if spot.axis is None:
                    objects.hide_tool(self.group)
                    words += " — " + tr("no posture is known here: no tool is shown")
                else:
                    objects.put_tool(self.group, spot)
            except model.Refused as error:
                words += f" — {error}"
        self._told.setText(words)
        self.look_again()

    def addSelection(self, document, thing, _element, point) -> None:
        """A click in the view (FreeCAD calls this): the sample nearest to it."""
        if self._gone():
            return
        shown = {each.Name for each in self.group.Group if getattr(each, "Verdict", "")}
        if document != self.group.Document.Name or thing.rpartition(".")[2] not in shown:
            return
        try:
            sample = objects.nearest(self.group, point)
        except model.Refused as error:
            self._told.setText(str(error))
            return
        self._list.setCurrentItem(None)
        self._at(sample, self.result.sentence(sample))

    def _judged_again(self, result) -> None:
        """Show the plan of steps that were judged again, in a panel of its own."""
        group = objects.show(App.getDocument(result.document), result)
        QtCore.QTimer.singleShot(0, lambda: self._hand_over(group))

    def _hand_over(self, group) -> None:
        self.leave()
        Gui.Control.closeDialog()
        open_panel(group)

    def _draw_map(self) -> None:
        if self._here is None or self._drawing is not None:
            return
        self._map.setEnabled(False)
        self._map.setText(tr("drawing…"))
        self._drawing = runner.Map(
            self.group, self._here.point, self.group.Cutter, lambda *_: None, self._map_drawn, self._map_failed
        )

    def _map_ended(self) -> None:
        self._drawing = None
        self._map.setText(tr("Posture map"))
        self._map.setEnabled(True)

    def _map_drawn(self, found) -> None:
        if self._gone():
            runner.removed(found["folder"])
            return
        self._map_ended()
        picture = QtGui.QPixmap(found["picture"])
        runner.removed(found["folder"])
        windows.show_picture(picture, tr("Postures of {cutter} at {face}").format(cutter=self.group.Cutter, face=self._here.face))

    def _map_failed(self, line: str) -> None:
        if self._gone():
            return
        self._map_ended()
        self._told.setText(line)

    def _tool_wanted(self, on: bool) -> None:
        kept = remembered.load()
        remembered.save(remembered.Choices(**{**kept.__dict__, "show_tool": on}))
        if on:
            self._fly()
        else:
            objects.hide_tool(self.group)

    def _page(self) -> None:
        try:
            open_review(self.group)
        except model.Refused as error:
            windows.complain(str(error))

    def _remove(self) -> None:
        document = self.group.Document
        self.leave()
        QtCore.QTimer.singleShot(0, lambda: (Gui.Control.closeDialog(), objects.clear(document)))

    # FreeCAD's side of the panel.

    def getStandardButtons(self) -> int:
        return windows.code(_CLOSE)

    def reject(self) -> bool:
        self.leave()
        return True

    def leave(self) -> None:
        """Forget the view; a map that is being drawn is given up."""
        global LAST
        if LAST is not self:
            return
        LAST = None
        Gui.Selection.removeObserver(self)
        App.removeDocumentObserver(self)
        if self._drawing is not None:
            self._drawing.cancel()
        if self.steps is not None:
            self.steps.leave()


def open_panel(group=None) -> Findings:
    """Show the panel of a plan, by default of the one that is selected."""
    global LAST
    group = group or chosen_group()
    if LAST is not None:  # another command closed it
        LAST.leave()
    LAST = Findings(group)
    Gui.Control.showDialog(LAST)
    return LAST
