"""A job: what of a document is planned, with which tools, on which machine."""

from __future__ import annotations

from dataclasses import dataclass, field


class Refused(Exception):
    """Why something cannot be planned or shown, in one line."""


@dataclass(frozen=True)
class Tools:
    """Tools to judge; without any the program's default tool set.

    Parameters
    ----------
    specs : tuple of str
        Short words as `R6L80`.
    files : tuple of str
        Paths of tool libraries, in any format that the program reads.
    bits : tuple of str
        Names of tool bits (CAM) of the document.
    holder : str
        Holder of those that have none: `er32`, `R15L30`, a path; empty: none is given.
    stick_out : float, optional
        mm from tip to holder for tools that state none.
    """

    specs: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    bits: tuple[str, ...] = ()
    holder: str = ""
    stick_out: float | None = None


@dataclass(frozen=True)
class Job:
    """A question to the program.

    Parameters
    ----------
    document, body : str
        Names of the document and of the object that is planned.
    faces : tuple of int
        Numbers of the target faces, from 1 as in `Face3`; empty: the program chooses.
    tools : Tools
        What is judged.
    machine : str
        Name, path or `tilt:60`; empty: any tool axis.
    setup : str
        Direction that points along the spindle, `x,y,z` in the document's coordinates, `+z`, `auto` or a path; empty: +Z.
    fixtures : tuple of str
        Names of bodies of the document that are in the way.
    allowance : float
        mm of stock left on the surface.
    options : tuple of str
        More words for the program, as `("--operations", "fewest")`.
    """

    document: str
    body: str
    faces: tuple[int, ...] = ()
    tools: Tools = field(default_factory=Tools)
    machine: str = ""
    setup: str = ""
    fixtures: tuple[str, ...] = ()
    allowance: float = 0.0
    options: tuple[str, ...] = ()


def picked(selection) -> tuple[str, str, tuple[int, ...]]:
    """Names of document and body, and face numbers, of a selection (entries of `Gui.Selection.getSelectionEx()`)."""
    if len(selection) != 1:
        raise Refused(f"select one body, or faces of one body; selected are {len(selection)} objects")
    entry = selection[0]
    faces = sorted(int(name.rpartition(".")[2][4:]) for name in entry.SubElementNames if "Face" in name)
    if entry.SubElementNames and not faces:
        raise Refused("select faces or the whole body, not edges or points")
    return entry.Object.Document.Name, entry.Object.Name, tuple(faces)


def axis(thing, element: str = "") -> str:
    """The setup axis `x,y,z` of a picked face, edge, line or coordinate system."""
    raise Refused(f"{thing.Label} {element} has no axis")


def bits(document) -> list[tuple[str, str]]:
    """Names and labels of the tool bits of a document that the program can be given."""
    return []
