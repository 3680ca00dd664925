"""Small things of Qt that several panels use."""

from __future__ import annotations

from typing import Any, Callable

import FreeCAD as App
import FreeCADGui as Gui

from . import host
from . import words as texts
from .words import tr

QtCore, QtGui = host.qt("QtCore"), host.qt("QtGui")
#: How a field looks that has to be filled in; of the widget itself, not of what is in it. Beside a border of one's own Qt draws
#: arrows as blank lines: they are away so long.
_MISSING = (
    "QAbstractSpinBox, QComboBox { border: 2px solid #b34700; border-radius: 3px; padding: 2px }"
    "QAbstractSpinBox::up-button, QAbstractSpinBox::down-button { width: 0px; border: 0px }"
)


class Panel:
    """A task panel beside which one goes on working: FreeCAD shows the widgets of `form` and calls the methods in mixed case."""

    def isAllowedAlterSelection(self) -> bool:
        return True

    def isAllowedAlterView(self) -> bool:
        return True

    def isAllowedAlterDocument(self) -> bool:
        return True


def complain(text: str) -> None:
    """Say in a window, and in the report view, why something was not done."""
    App.Console.PrintError(f"plan-cutters: {text}\n")
    QtGui.QMessageBox.warning(Gui.getMainWindow(), tr("Plan cutters"), text)


def code(buttons: Any) -> int:
    """Standard buttons as a number, which FreeCAD wants: Qt 6 has an enumeration for them."""
    return int(getattr(buttons, "value", buttons))


def words(text: str = "", name: str = "") -> Any:
    """A label that breaks its lines and can be copied."""
    label = QtGui.QLabel(text)
    label.setObjectName(name)
    label.setWordWrap(True)
    label.setTextFormat(QtCore.Qt.PlainText)
    label.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
    # Long words, as ids of cutters, must not make the panel wider.
    label.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Preferred)
    label.setMinimumWidth(60)
    return label


def button(text: str, work: Callable[..., object], hint: str = "", pressed: bool = False) -> Any:
    """A button; `pressed` makes one that stays down."""
    made = QtGui.QPushButton(text)
    made.setToolTip(hint)
    made.setAutoDefault(False)
    made.setStyleSheet("QPushButton { padding: 3px 8px; min-width: 20px }")
    made.setCheckable(pressed)
    if pressed:
        made.toggled.connect(work)
    else:
        made.clicked.connect(lambda *_: work())
    return made


def narrow(widget: Any) -> Any:
    """A widget that is as wide as the panel leaves it: the panel of a small screen is 230 pixels wide."""
    widget.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
    widget.setMinimumWidth(70)
    return widget


def row(*parts: Any) -> Any:
    """Widgets side by side; the first takes the room that is left."""
    line = QtGui.QHBoxLayout()
    for place, each in enumerate(parts):
        line.addWidget(each, 1 if place == 0 else 0)
    return line


def box(title: str, icon: str = "") -> tuple[Any, Any]:
    """A part of a panel that can be folded, and its layout."""
    from . import icons

    widget = QtGui.QWidget()
    widget.setWindowTitle(title)
    if icon:
        widget.setWindowIcon(QtGui.QIcon(icons.path(icon)))
    layout = QtGui.QFormLayout(widget)
    layout.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
    layout.setContentsMargins(6, 6, 6, 6)
    return widget, layout


def combo(entries: list[tuple[str, str]], value: str, editable: bool = False) -> Any:
    """A list to choose from: words and values; an editable one takes any other value."""
    made = QtGui.QComboBox()
    for text, data in entries:
        made.addItem(tr(text), data)
    made.setEditable(editable)
    made.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    choose(made, value)
    if editable:
        # Of a long entry its beginning is read, not its end.
        made.currentIndexChanged.connect(lambda *_: made.lineEdit().setCursorPosition(0))
        made.lineEdit().setCursorPosition(0)
    return narrow(made)


def choose(made: Any, value: str) -> None:
    """Show a value in a list to choose from."""
    place = made.findData(value)
    if place >= 0:
        made.setCurrentIndex(place)
    elif made.isEditable():
        made.setEditText(value)


def chosen(made: Any) -> str:
    """The value of a list to choose from: of the entry, or what was typed."""
    place = made.currentIndex()
    if made.isEditable() and (place < 0 or made.currentText() != made.itemText(place)):
        return str(made.currentText()).strip()
    return str(made.itemData(place) or "")


class Length(QtGui.QDoubleSpinBox):  # type: ignore[name-defined]
    """A field whose value is in mm and whose text is in the units that the user chose in FreeCAD; it takes any unit."""

    def textFromValue(self, value: float) -> str:
        return texts.length(value)

    def valueFromText(self, text: str) -> float:
        # Its own text is rounded to the user's decimals: the value is not.
        if text == self.textFromValue(self.value()):
            return float(self.value())
        try:
            return 0.0 if text == self.specialValueText() else texts.mm_of(text)
        except ValueError:
            return float(self.value())

    def validate(self, text: str, place: int) -> Any:
        try:
            right = text == self.specialValueText() or self.minimum() <= texts.mm_of(text) <= self.maximum()
        except ValueError:
            right = False
        # What is half typed need not be a length yet.
        return (QtGui.QValidator.Acceptable if right else QtGui.QValidator.Intermediate, text, place)


def length(value: float, nothing: str = "", name: str = "") -> Any:
    """A field for a length, mm; at 0 it shows `nothing`."""
    made = Length()
    made.setObjectName(name)
    made.setRange(0.0, 1000.0)
    made.setDecimals(6)
    made.setSingleStep(0.1 if texts.unit() == "mm" else 0.254)
    made.setSpecialValueText(nothing)
    made.setValue(value)
    return narrow(made)


def mark(widget: Any, why: str) -> None:
    """Mark a field that has to be filled in, and say why; an empty text takes the mark away."""
    if widget.property("missing") == why:
        return
    hint = widget.property("hint")
    if hint is None:
        hint = widget.toolTip()
        widget.setProperty("hint", hint)
    widget.setProperty("missing", why)
    widget.setStyleSheet(_MISSING if why else "")
    widget.setToolTip("\n".join(filter(None, (why, hint))))


def alive(widget: Any) -> bool:
    """Whether a widget is still there: where another command closes the panel, FreeCAD takes its widgets without a word."""
    try:
        widget.objectName()
    except RuntimeError:
        return False
    return True


def swatch(colour: tuple[float, float, float]) -> Any:
    """A square in the colour of a verdict."""
    picture = QtGui.QPixmap(14, 14)
    picture.fill(QtGui.QColor.fromRgbF(*colour))
    label = QtGui.QLabel()
    label.setPixmap(picture)
    return label


def show_picture(picture: Any, title: str) -> Any:
    """A window with a picture, which stays until it is closed."""
    window = QtGui.QDialog(Gui.getMainWindow())
    window.setWindowTitle(title)
    window.setAttribute(QtCore.Qt.WA_DeleteOnClose)
    label = QtGui.QLabel()
    label.setPixmap(picture.scaled(900, 700, QtCore.Qt.KeepAspectRatio, QtCore.Qt.SmoothTransformation))
    QtGui.QVBoxLayout(window).addWidget(label)
    window.show()
    return window
