"""The tree of a file's products: what the annotated model is built up as again."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from OCP.TopLoc import TopLoc_Location


@dataclass(frozen=True, slots=True)
class Node:
    """An instance of a product: an assembly of other instances, or a leaf with faces."""

    #: Of the product; empty if it has none.
    name: str
    #: Of this use of it; empty for a root.
    instance: str
    #: In the assembly around it.
    place: TopLoc_Location
    #: Of an assembly.
    children: tuple["Node", ...] = ()
    #: Face numbers of a leaf, no number in two leaves.
    faces: tuple[int, ...] = ()

    def leaves(
        self, path: tuple[str, ...] = (), location: TopLoc_Location | None = None
    ) -> Iterator[tuple["Node", str, TopLoc_Location]]:
        """Every leaf with its path of names (`wheel/rim`) and its location in the part."""
        path = (*path, self.instance or self.name)
        place = location.Multiplied(self.place) if location else self.place
        if not self.children:
            yield self, "/".join(filter(None, path)), place
        for child in self.children:
            yield from child.leaves(path, place)

    def numbers(self) -> Iterator[int]:
        """Face numbers of all leaves."""
        yield from self.faces
        for child in self.children:
            yield from child.numbers()


def component_of(tree: Sequence[Node]) -> dict[int, str]:
    """Face number -> path of names down to the leaf that the face belongs to."""
    return {number: path for root in tree for leaf, path, _ in root.leaves() for number in leaf.faces}


def faces_of(tree: Sequence[Node], name: str) -> set[int]:
    """Face numbers of every instance called so, with all that is in it.

    An exact path counts alone; where there is none, a trailing part of a path (`wheel/rim`) or a product's name.
    """
    nodes = [(node, path) for root in tree for node, path in _paths(root, "")]
    result = [node for node, path in nodes if path == name] or [
        node for node, path in nodes if path.endswith(f"/{name}") or node.name == name
    ]
    return {number for node in result for number in node.numbers()}


def _paths(node: Node, above: str) -> Iterator[tuple[Node, str]]:
    path = "/".join(filter(None, (above, node.instance or node.name)))
    yield node, path
    for child in node.children:
        yield from _paths(child, path)
