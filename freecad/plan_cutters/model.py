"""A job: what of a document is planned, with which tools, on which machine."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field
from typing import Any

import FreeCAD as App

from . import host
from .words import tr


class Refused(Exception):
    """Why something cannot be planned or shown, in one line."""


@dataclass(frozen=True)
class Tools:
    """Tools to judge; without any, the program's default tool set.

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
    cam_job : str
        Name of a CAM job: bits have the numbers and feeds of its tool controllers; empty: they have none.
    """

    specs: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    bits: tuple[str, ...] = ()
    holder: str = ""
    stick_out: float | None = None
    cam_job: str = ""


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
    process : str
        The steps that are judged, JSON as `plan-cutters --process` reads it; empty: all are planned.
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
    process: str = ""


def job_of(entry: dict[str, Any]) -> Job:
    """A job from what `dataclasses.asdict` made of it, in JSON."""
    return Job(**{**_fixed(entry), "tools": Tools(**_fixed(entry["tools"]))})


def _fixed(entry: dict[str, Any]) -> dict[str, Any]:
    """The entry with tuples for lists."""
    return {name: tuple(value) if isinstance(value, list) else value for name, value in entry.items()}


def picked(selection) -> tuple[str, str, tuple[int, ...]]:
    """Names of document and body, and face numbers, of a selection.

    Parameters
    ----------
    selection : list
        Entries of `Gui.Selection.getSelectionEx()`, or of all documents, `getSelectionEx("*")`.

    Raises
    ------
    Refused
        It is not one body or faces of one body.
    """
    documents = {entry.Object.Document.Name for entry in selection}
    if len(documents) > 1:
        raise Refused(tr("the selection lies in {count} documents: select in one of them").format(count=len(documents)))
    if len(selection) == 1 and host.is_job(selection[0].Object):
        thing = planned(body_of(selection[0].Object))
        return thing.Document.Name, thing.Name, ()
    if len(selection) != 1:
        raise Refused(tr("select one body, or faces of one body; selected are {count} objects").format(count=len(selection)))
    thing, names = selection[0].Object, list(selection[0].SubElementNames)
    owners = {name.rpartition(".")[0] for name in names}
    if len(owners) > 1:
        raise Refused(tr("select faces of one body; selected are faces of {count}").format(count=len(owners)))
    owner = owners.pop() if owners else ""
    if owner:
        thing = _within(thing, owner)
    elements = [name.rpartition(".")[2] for name in names if name and not name.endswith(".")]
    faces = sorted({int(name[4:]) for name in elements if name.startswith("Face")})
    if len(faces) < len(set(elements)):
        raise Refused(tr("select faces or the whole body, not edges or points"))
    return thing.Document.Name, planned(thing).Name, tuple(faces)


def body_of(job):
    """The body that a CAM job is about, as it stands in the job.

    Raises
    ------
    Refused
        There is none, or there are several.
    """
    models = list(getattr(job.Model, "Group", ()))
    if len(models) != 1:
        raise Refused(
            tr("{label} has {count} models: select the one that is machined").format(label=job.Label, count=len(models))
        )
    return models[0]


def copied_from(thing) -> list:
    """The bodies of the document that a body is a copy of, as the model of a CAM job is, and that stand where it stands."""
    found = []
    for each in getattr(thing, "Objects", None) or ():
        try:
            mine, other = host.shape_of(thing).BoundBox, host.shape_of(each).BoundBox
        except Exception:  # it has no shape
            continue
        if each.Document is thing.Document and max(map(abs, (a - b for a, b in zip(_ends(mine), _ends(other))))) < 1e-6:
            found.append(each)
    return found


def _ends(box) -> list[float]:
    return [getattr(box, f"{axis}{end}") for axis in "XYZ" for end in ("Min", "Max")]


def _within(thing, path: str):
    """The object that a selection's path within a container ends at."""
    for name in filter(None, path.split(".")):
        if thing.isDerivedFrom("App::Link"):
            raise Refused(
                tr("select the link {label} itself in the tree: its faces belong to another object").format(label=thing.Label)
            )
        thing = thing.Document.getObject(name) or thing
    return thing


def planned(thing):
    """The object that is planned where this one was picked: the body of its last step.

    Raises
    ------
    Refused
        It holds no faces, or is a step that others follow.
    """
    if host.is_container(thing):
        raise Refused(tr("{label} is a container: select a body in it").format(label=thing.Label))
    if thing.isDerivedFrom("Mesh::Feature"):
        raise Refused(tr("{label} is a mesh: select a body with CAD faces").format(label=thing.Label))
    parent = thing.getParentGeoFeatureGroup()
    if parent is not None and parent.isDerivedFrom("PartDesign::Body"):
        if parent.Tip is not thing:
            raise Refused(
                tr("{label} is not the last step of {body}: select faces of the body as it is shown").format(
                    label=thing.Label, body=parent.Label
                )
            )
        thing = parent
    shape_of(thing)
    return thing


def shape_of(thing):
    """The shape of an object where it stands in the document."""
    found = host.shape_of(thing)
    if found.isNull() or not found.Faces:
        raise Refused(tr("{label} holds no faces: select a body").format(label=thing.Label))
    return found


def thing_of(document: str, name: str):
    """An object by the names of its document and of itself."""
    if document not in App.listDocuments():
        raise Refused(tr("the document {document} was closed").format(document=document))
    thing = App.getDocument(document).getObject(name)
    if thing is None:
        raise Refused(tr("{name} is no longer in the document {document}").format(name=name, document=document))
    return thing


def fingerprint(found) -> str:
    """A text that differs between shapes that differ: all vertices, and each face's area and centre, to 9 digits.

    Triangles and names are no part of it, because looking at a body or computing it again changes them.
    """
    words = [f"{len(found.Faces)}"]
    for each in (*found.Vertexes, *found.Faces):
        at = each.Point if hasattr(each, "Point") else each.CenterOfMass
        words += [f"{round(value, 6) + 0.0:.9g}" for value in (*at, getattr(each, "Area", 0.0))]
    return hashlib.sha256(" ".join(words).encode()).hexdigest()


def axis(thing, element: str = "", reverse: bool = False) -> str:
    """The setup axis `x,y,z` of a picked face, edge, line or coordinate system, in the document's coordinates.

    A plane face gives its normal out of the material; a round face or an edge its axis, so that its largest component is
    positive; an object alone its Z axis, or the axis of its only edge.
    """
    name = element.rpartition(".")[2]
    if name:
        found = _direction(host.shape_of(thing).getElement(name))
    else:
        try:
            edges = [] if host.is_container(thing) else host.shape_of(thing).Edges
        except (AttributeError, ValueError):
            edges = []
        if len(edges) == 1:
            found = _direction(edges[0])
        elif hasattr(thing, "Placement"):
            turned = host.container_placement(thing).multiply(thing.Placement)
            found = turned.Rotation.multVec(App.Vector(0, 0, 1))
        else:
            found = None
    if found is None or not math.isfinite(found.Length) or found.Length < 1e-9:
        raise Refused(
            tr("{thing} has no axis: pick a plane or round face, a straight or round edge").format(
                thing=f"{thing.Label} {name}".strip()
            )
        )
    found = found.normalize() * (-1.0 if reverse else 1.0)
    return ",".join(f"{round(value, 12) + 0.0:.12g}" for value in found)


def _direction(element):
    """The direction that a face or an edge has, None where it has none."""
    if element.ShapeType == "Face" and element.Surface.TypeId == "Part::GeomPlane":
        low, high, left, right = element.ParameterRange
        return element.normalAt((low + high) / 2, (left + right) / 2)
    form = {"Face": "Surface", "Edge": "Curve"}.get(element.ShapeType)
    form = getattr(element, form) if form else None
    found = getattr(form, "Direction", None) or getattr(form, "Axis", None)
    # Its sense is how it happened to be drawn.
    return found * -1.0 if found is not None and max(found, key=abs) < 0.0 else found


def bits(document) -> list[tuple[str, str]]:
    """Names and labels of the tool bits of a document that the program can be given."""
    return [(each.Name, each.Label) for each in document.Objects if host.bit_shape(each)]
