"""All that differs between releases of FreeCAD, and between FreeCAD with a window and without."""

from __future__ import annotations

import importlib
import os
import types
from importlib.machinery import SourceFileLoader
from typing import Any, Callable

import FreeCAD as App
import Part

#: Where settings are kept: `Command` is the program, the rest is the panel's.
SETTINGS = "User parameter:BaseApp/Preferences/Mod/PlanCutters"
#: Containers whose shape is a compound of what they hold.
CONTAINERS = ("App::Part", "App::DocumentObjectGroup", "App::LinkGroup", "Assembly::AssemblyObject")
#: A tool bit of CAM: it names the shape that it was made from in one of these, by release.
BIT_SHAPES = ("ShapeType", "ShapeName", "ShapeID", "BitShape")
#: A job of CAM has all of these.
JOB_PARTS = ("Model", "Operations", "Stock", "Tools")


def settings() -> Any:
    """The parameters that a user's choices are kept in."""
    return App.ParamGet(SETTINGS)


def has_window() -> bool:
    """Whether FreeCAD runs with its window."""
    return bool(App.GuiUp)


def qt(name: str) -> Any:
    """A module of the Qt that FreeCAD was built with, as `QtCore`; FreeCAD's own `PySide` stands for PySide2 and PySide6."""
    for package in ("PySide", "PySide6", "PySide2"):
        try:
            return importlib.import_module(f"{package}.{name}")
        except ImportError:
            continue
    raise ImportError(f"this FreeCAD has no {name}: neither PySide, PySide6 nor PySide2")


def every(milliseconds: int, work: Callable[[], Any]) -> Callable[[], None]:
    """Call `work` now and then from the window's own loop; what ends that. Without a window nothing is called."""
    if not has_window():
        return lambda: None
    timer = qt("QtCore").QTimer()
    timer.timeout.connect(work)
    timer.start(milliseconds)
    return timer.stop


def say(text: str) -> None:
    """A line in the report view."""
    App.Console.PrintMessage(f"plan-cutters: {text}\n")


def warn(text: str) -> None:
    """A line in the report view that the user should see."""
    App.Console.PrintWarning(f"plan-cutters: {text}\n")


def environment() -> dict[str, str]:
    """What the program runs in: without what FreeCAD set for its own Python."""
    kept = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONPATH")}
    if "APPDIR" in kept:  # an AppImage puts its own libraries first
        kept.pop("LD_LIBRARY_PATH", None)
    return kept


def container_placement(thing) -> Any:
    """The placement of all that a document's object stands in; links have no such method in older releases."""
    parent = thing.getParentGeoFeatureGroup()
    if parent is None:
        return App.Placement()
    return container_placement(parent).multiply(parent.Placement)


def plain_shape(thing) -> Any:
    """The shape of an object or link as FreeCAD keeps it. Asked so, FreeCAD gives no matrix with it."""
    return Part.getShape(thing)


def shape_of(thing) -> Any:
    """The shape of an object or link where it stands in the document; its faces keep their numbers."""
    shape = plain_shape(thing).copy(False)
    shape.Placement = container_placement(thing).multiply(shape.Placement)
    return shape


def is_container(thing) -> bool:
    """Whether an object, or what a link stands for, only holds other objects."""
    meant = thing.getLinkedObject(True) if hasattr(thing, "getLinkedObject") else thing
    return any(each is not None and each.isDerivedFrom(kind) for each in (thing, meant) for kind in CONTAINERS)


def bit_shape(thing) -> str:
    """The word of the shape of a tool bit, as `endmill`; empty for what is no tool bit."""
    if not hasattr(thing, "Diameter"):
        return ""
    word = next((str(getattr(thing, name)) for name in BIT_SHAPES if getattr(thing, name, "")), "")
    return os.path.splitext(os.path.basename(word))[0].lower()


def stick_out(bit) -> float | None:
    """From the holder's face to the tip as a tool bit states it, mm: bits of the newest releases may."""
    value = getattr(getattr(bit, "Stickout", None), "Value", 0.0)
    return float(value) if value > 0.0 else None


def holder_of(bit) -> dict[str, Any] | None:
    """The holder that a tool bit names, as a `.fcholder` file has it; None where it names none: only the newest releases do.

    Raises
    ------
    LookupError
        It names one whose outline this FreeCAD does not have.
    """
    word = getattr(bit, "ToolHolder", "")
    if not isinstance(word, str) or not word:
        return None
    try:
        found = bit.Proxy.get_holder()
        entry = None if found is None else found.to_dict()
    except Exception as error:  # also what its file raises
        raise LookupError(f"{word}: {error}") from None
    if not isinstance(entry, dict):
        raise LookupError(word)
    return {"name": word, **entry}


def is_job(thing) -> bool:
    """Whether an object of a document is a job of CAM."""
    return all(name in getattr(thing, "PropertiesList", ()) for name in JOB_PARTS)


def per_minute(speed) -> float:
    """A feed of a tool controller, mm/min; FreeCAD keeps it in mm/s."""
    return float(getattr(speed, "Value", speed) or 0.0) * 60.0


def lengths(thing) -> dict[str, str]:
    """Lengths and angles among the properties of an object, as texts with their unit."""
    units = {"App::PropertyLength": "mm", "App::PropertyDistance": "mm", "App::PropertyAngle": "deg"}
    kinds = {name: thing.getTypeIdOfProperty(name) for name in thing.PropertiesList}
    return {name: f"{getattr(thing, name).Value!r} {units[kind]}" for name, kind in kinds.items() if kind in units}


def paint(thing, colour: tuple[float, float, float], transparency: int = 0) -> None:
    """Give all faces of an object one colour, where there is a window."""
    view = getattr(thing, "ViewObject", None)
    if view is not None and hasattr(view, "ShapeColor"):
        view.ShapeColor = colour
        view.Transparency = transparency


def see_through(thing, on: bool) -> None:
    """Whether one sees through an object, where there is a window."""
    view = getattr(thing, "ViewObject", None)
    if view is not None and hasattr(view, "Transparency"):
        view.Transparency = 70 if on else 0


def paint_faces(thing, colours: list[tuple[float, float, float]]) -> None:
    """Give each face of an object its colour, where there is a window."""
    view = getattr(thing, "ViewObject", None)
    if view is not None and hasattr(view, "DiffuseColor"):
        view.DiffuseColor = colours


def visible(thing, on: bool | None = None) -> bool:
    """Whether an object is seen; changed where `on` is given. Without a window it is a note for the next one."""
    view = getattr(thing, "ViewObject", None)
    holder = thing if view is None else view
    was = bool(getattr(holder, "Visibility", True))
    if on is not None and hasattr(holder, "Visibility"):
        holder.Visibility = on
    return was


def operations_macro() -> Any:
    """The macro of operations as a module: it tells faces of a STEP file by their names, which no importer keeps.

    Raises
    ------
    OSError
        It is not beside this package.
    """
    path = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "PlanOperations.FCMacro")
    loader = SourceFileLoader("plan_operations", path)
    module = types.ModuleType(loader.name)
    exec(compile(loader.get_data(path), path, "exec"), module.__dict__)
    vars(module)["say"] = say
    return module
