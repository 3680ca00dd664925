"""Let a copy of the process read, so that a crash or a hang of the kernel becomes an error like any other."""

import io
import pickle
from collections.abc import Callable, Iterator
from typing import Any

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.gp import gp_Pnt
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape, TopoDS_Vertex

from cad_io.errors import CadIoError, ReadError
from cad_io.kernel.assembly import Node
from cad_io.kernel.components import children, compound
from cad_io.kernel.limited import ChildDied, TimeLimit, limited

#: What `Part` is made of, by the names of its parameters.
Found = dict[str, Any]


class Crashed(ReadError):
    """The kernel crashed."""


def guarded(find: Callable[[], Found], timeout: float, file: str | None) -> Found:
    """Result of `find()`, which may crash or hang.

    Parameters
    ----------
    find : callable
        Run in a forked copy of this process; where the system cannot fork (Windows), here and without a limit.
    timeout : float
        Seconds that it may take.
    file : str, optional
        Named in errors.

    Raises
    ------
    ReadError
        What `find` raised, or that it did not end in time; `Crashed` if it crashed.
    """
    try:
        answer = pickle.loads(limited(lambda: _answer(find), timeout))
    except TimeLimit:
        raise ReadError(f"not read within {timeout:g} s: it may be damaged; give more time or export it again",
                        file=file) from None  # fmt: skip
    except ChildDied as died:
        raise Crashed(f"the CAD kernel cannot read it ({died}): export it again", file=file) from None
    if "error" in answer:
        cause, where, face = answer["error"]
        raise ReadError(cause, file=where, face=face)
    return _unpacked(answer)


def _answer(find: Callable[[], Found]) -> bytes:
    try:
        return pickle.dumps(_packed(find()))
    except CadIoError as error:
        return pickle.dumps({"error": (error.cause, error.file, error.face)})


def _packed(found: Found) -> Found:
    """Without kernel objects: the shape as bytes, and behind it one vertex for the place of each node of the tree."""
    vertex = TopoDS_Vertex()
    BRep_Builder().MakeVertex(vertex, gp_Pnt(), 1e-7)
    tree = found.get("tree", ())
    stream = io.BytesIO()
    BinTools.Write_s(compound([found["shape"], *(vertex.Located(place) for place in _places(tree))]), stream)
    return found | {"shape": stream.getvalue(), "tree": [_bare(node) for node in tree]}


def _unpacked(packed: Found) -> Found:
    whole = TopoDS_Shape()
    BinTools.Read_s(whole, io.BytesIO(packed["shape"]))
    shape, *vertices = children(whole)
    places = iter([vertex.Location() for vertex in vertices])
    return packed | {"shape": shape, "tree": tuple(_placed(bare, places) for bare in packed["tree"])}


def _places(tree: tuple[Node, ...]) -> Iterator[TopLoc_Location]:
    for node in tree:
        yield node.place
        yield from _places(node.children)


def _bare(node: Node) -> tuple[Any, ...]:
    return node.name, node.instance, [_bare(child) for child in node.children], node.faces


def _placed(bare: tuple[Any, ...], places: Iterator[TopLoc_Location]) -> Node:
    name, instance, inner, numbers = bare
    place = next(places)
    return Node(name, instance, place, tuple(_placed(child, places) for child in inner), numbers)
