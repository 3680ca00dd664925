"""Texts in the user's language, and lengths in the user's units.

FreeCAD translates by the text in English, in a context. `tr` marks a text for the file of translations, which
`freecad/translations.py` writes from these modules: its argument is one literal, with names in braces for what is filled in.
"""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App

#: Of all texts of the workbench.
CONTEXT = "PlanCutters"
#: Where a user puts translations, `plan_cutters_de.qm` for German.
FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "translations")
#: How FreeCAD ends lengths in inches, or feet.
_INCHES = ('"', "in", "'", "ft", "thou", "mil", "yd", "mi")


def tr(text: str) -> str:
    """A text in the user's language; in English where there is no translation, or no window."""
    qt = getattr(App, "Qt", None)
    return str(qt.translate(CONTEXT, text)) if qt is not None else text


def load() -> None:
    """Have FreeCAD read the translations of this add-on, where there are any for the user's language."""
    import FreeCADGui as Gui

    Gui.addLanguagePath(FOLDER)
    Gui.updateLocale()


def later(text: str) -> str:
    """A text that is translated where it is shown, by `tr` of what this answers."""
    return text


def several(count: int, one: str, many: str) -> str:
    """The one of two texts that stands with a number, with `{count}` filled in."""
    return (one if count == 1 else many).format(count=count)


def _quantity(mm: float) -> Any:
    units = App.Units
    return units.Quantity(float(mm), units.Length)


def length(mm: float) -> str:
    """A length in the units, and with the decimals, that the user chose in FreeCAD."""
    return str(_quantity(mm).UserString)


def fine(mm: float) -> str:
    """A short length with three digits, in the unit that the user chose: FreeCAD's decimals may show 0 of it."""
    if not hasattr(App, "Units"):
        return f"{mm:.3g} mm"
    _, factor, name = _quantity(25.4).getUserPreferred()
    return f"{mm / factor:.3g} {name}"


def area_of(mm2: float) -> str:
    """An area in the units that the user chose in FreeCAD."""
    units = App.Units
    return str(units.Quantity(mm2, units.Area).UserString)


def speed(mm_per_minute: float) -> str:
    """A feed as machines have it: mm or inches in a minute."""
    return f"{mm_per_minute / (25.4 if unit() == 'in' else 1.0):.5g} {unit()}/min"


def mm_of(text: str) -> float:
    """A length that a user typed, mm; a number alone is in the unit that FreeCAD shows lengths in.

    Raises
    ------
    ValueError
        It is no length.
    """
    text = text.strip()
    try:
        found = App.Units.Quantity(text)
    except Exception as error:  # FreeCAD's parser raises many kinds
        raise ValueError(f"{text} is no length") from error
    if not text or found.Unit not in (App.Units.Unit(), App.Units.Length):
        raise ValueError(f"{text} is no length")
    # FreeCAD counts in mm.
    return float(found.Value) * (unit_mm() if found.Unit == App.Units.Unit() else 1.0)


def unit_mm() -> float:
    """How many mm the unit has that FreeCAD shows lengths of about an inch in."""
    return float(_quantity(25.4).getUserPreferred()[1])


def unit() -> str:
    """The unit of lengths in texts of the program, `mm` or `in`, that is nearest to what the user chose in FreeCAD."""
    return "in" if str(_quantity(25.4).getUserPreferred()[2]).strip() in _INCHES else "mm"
