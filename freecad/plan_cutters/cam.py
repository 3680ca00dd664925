"""Tool bits and jobs of FreeCAD's CAM workbench: what they state, and what they leave to be asked."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from . import host, model
from .words import length, tr

#: Words of shapes of bits that mill surfaces; the others, as drills and probes, are not ticked unasked.
MILLS = ("endmill", "ballend", "bullnose", "torus", "vbit", "v-bit", "chamfer")
#: Fields of the panel that fill what a bit does not state.
STICK_OUT, HOLDER = "stick_out", "holder"
#: In the name of the controller that FreeCAD puts into each new job.
DEFAULT = "Default_Tool"
#: The line for both fields where the same bits need them.
BOTH = "both"


@dataclass(frozen=True)
class Bit:
    """What a tool bit states.

    Parameters
    ----------
    name, label : str
        Of its object in the document.
    mill : bool
        Whether its shape is one that mills surfaces.
    flutes : float
        mm; 0: not stated.
    stick_out : float, optional
        mm from tip to holder; None: not stated.
    held : bool
        Whether it names its holder.
    untouched : bool
        Whether FreeCAD put it into a job of itself, and nobody used it.
    """

    name: str
    label: str
    mill: bool
    flutes: float = 0.0
    stick_out: float | None = None
    held: bool = False
    untouched: bool = False


def bits(document) -> list[Bit]:
    """The tool bits of a document, in its order."""
    jobs = [each for each in document.Objects if host.is_job(each)]
    unused = {getattr(held.Tool, "Name", "") for job in jobs for held in getattr(job.Tools, "Group", ()) if _untouched(held, job)}
    return [_bit(each, each.Name in unused) for each in document.Objects if host.bit_shape(each)]


def _bit(thing, untouched: bool = False) -> Bit:
    flutes = next((value for word in ("CuttingEdgeHeight", "CuttingEdgeLength") if (value := getattr(thing, word, None))), 0.0)
    return Bit(thing.Name, thing.Label, host.bit_shape(thing) in MILLS, float(getattr(flutes, "Value", flutes)),
               host.stick_out(thing), bool(getattr(thing, "ToolHolder", "")), untouched)  # fmt: skip


def bit_of_file(path: str) -> Bit | None:
    """What a bit in a file of its own states; None for what is no such file."""
    if not path.lower().endswith(".fctb"):
        return None
    try:
        with open(path, encoding="utf-8") as file:
            entry = json.load(file)
        sizes, name = entry["parameter"], str(entry.get("name") or path)
        stick_out = str(sizes.get("Stickout") or "")
    except (OSError, ValueError, KeyError, AttributeError, TypeError):
        return None  # the program says what is wrong with it
    # How long it is, is the program's to read.
    return Bit(
        path, name, True, 0.0, 1.0 if any(each in "123456789" for each in stick_out) else None, bool(sizes.get("ToolHolder"))
    )


def missing(judged: list[Bit], holder: str, stick_out: float | None) -> dict[str, str]:
    """What has to be filled in before bits can be judged, a line for each field of the panel; nothing where all is stated.

    Parameters
    ----------
    judged : list of Bit
    holder : str
        Of the bits that name none; empty: as the bits say.
    stick_out : float, optional
        mm, of the bits that state none.
    """
    found = {}
    loose = [each.label for each in judged if each.stick_out is None]
    if loose and not stick_out:
        found[STICK_OUT] = tr("fill in “Stick-out”, which {bits} do not state").format(bits=_listed(loose))
    elif stick_out:
        long = [each for each in judged if each.stick_out is None and each.flutes > stick_out + 1e-9]
        if long:
            found[STICK_OUT] = tr("“Stick-out” is shorter than the flutes of {bit}, {length}").format(
                bit=long[0].label, length=length(long[0].flutes)
            )
    bare = [each.label for each in judged if not each.held]
    if bare and not holder:
        found[HOLDER] = tr("choose a “Holder”, or “None at all”, which {bits} do not state").format(bits=_listed(bare))
        if bare == loose and not stick_out:
            found[BOTH] = tr("fill in “Stick-out” and “Holder”, which {bits} do not state").format(bits=_listed(bare))
    return found


def line_of(found: dict[str, str]) -> str:
    """What has to be filled in, in one line."""
    return found.get(BOTH) or "; ".join(found.values())


def _listed(labels: list[str]) -> str:
    more = len(labels) - 3
    return ", ".join(labels[:3]) + (" " + tr("and {count} more").format(count=more) if more > 0 else "")


@dataclass(frozen=True)
class Controller:
    """What a tool controller of a job says of its bit: its number, 0 for none, and its feed, mm/min, 0 for none."""

    number: int = 0
    feed: float = 0.0


def controllers(job) -> dict[str, Controller]:
    """Tool controllers of a job, by the name of the object of the bit; of several with one bit the first that has a feed.

    The one that FreeCAD puts into each new job is none of them, as long as nobody gave it a feed or an operation.
    """
    found: dict[str, Controller] = {}
    for each in getattr(job.Tools, "Group", ()):
        bit = getattr(each, "Tool", None)
        if bit is None or not host.bit_shape(bit) or _untouched(each, job):
            continue
        mine = Controller(int(getattr(each, "ToolNumber", 0)), host.per_minute(getattr(each, "HorizFeed", 0.0)))
        if bit.Name not in found or (mine.feed and not found[bit.Name].feed):
            found[bit.Name] = mine
    return found


def _untouched(controller, job) -> bool:
    """Whether a controller is the one that FreeCAD put into the job, without a feed and without an operation."""
    used = {getattr(getattr(each, "ToolController", None), "Name", "") for each in getattr(job.Operations, "Group", ())}
    feed = host.per_minute(getattr(controller, "HorizFeed", 0.0))
    return DEFAULT in controller.Name and not feed and controller.Name not in used


def job_of(selection) -> Any:
    """The job of CAM that is selected, alone; None where another thing is."""
    things = [entry.Object for entry in selection]
    return things[0] if len(things) == 1 and host.is_job(things[0]) else None


def stock_over(job) -> float:
    """How far the stock of a job stands over its model on the side where that is least, mm; 0 where it does not on each.

    By the boxes around both: what a contour leaves in between is not looked at.
    """
    try:
        stock = host.shape_of(job.Stock).BoundBox
        part = model.shape_of(model.body_of(job)).BoundBox
    except (AttributeError, model.Refused):
        return 0.0
    gaps = [getattr(part, f"{axis}Min") - getattr(stock, f"{axis}Min") for axis in "XYZ"]
    gaps += [getattr(stock, f"{axis}Max") - getattr(part, f"{axis}Max") for axis in "XYZ"]
    least = min(gaps)
    return round(least, 6) if least > 1e-6 else 0.0
