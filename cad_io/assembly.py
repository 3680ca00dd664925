"""The tree of a file's products: what the annotated model is built up as again."""

from collections.abc import Iterator
from dataclasses import dataclass

from OCP.TopLoc import TopLoc_Location


@dataclass(frozen=True, slots=True)
class Node:
    """An instance of a product: an assembly of other instances, or a leaf with faces.

    Attributes
    ----------
    name : str
        Of the product; empty if it has none.
    instance : str
        Of this use of it; empty for a root.
    place : TopLoc_Location
        In the assembly around it.
    children : tuple of Node
        Of an assembly.
    faces : tuple of int
        Face numbers of a leaf, no number in two leaves.
    """

    name: str
    instance: str
    place: TopLoc_Location
    children: tuple["Node", ...] = ()
    faces: tuple[int, ...] = ()

    def leaves(
        self, path: tuple[str, ...] = (), around: TopLoc_Location | None = None
    ) -> Iterator[tuple["Node", str, TopLoc_Location]]:
        """Every leaf with its path of names (`wheel/rim`) and its location in the part."""
        path = (*path, self.instance or self.name)
        place = around.Multiplied(self.place) if around else self.place
        if not self.children:
            yield self, "/".join(filter(None, path)), place
        for child in self.children:
            yield from child.leaves(path, place)
