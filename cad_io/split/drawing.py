"""A face with the boundaries of its labels drawn on it: planned in its parameter plane, with the first fit that works."""

from collections.abc import Callable
from typing import Any

import numpy as np

from cad_io.arrays import FaceLabels
from cad_io.kernel import is_kernel_error
from cad_io.split.arrangement import Arrangement
from cad_io.split.border import Border, CannotSplit
from cad_io.split.contour import Line, curves
from cad_io.split.face_grid import label_grid
from cad_io.split.net import Net
from cad_io.split.regions import Judged, joined, judged, regions_of, slivers
from cad_io.surface import Surface

#: Fits of the drawn curves that are tried, cells of root mean square distance; the first one first.
FITS = (0.1, 0.05, 0.02)


class Drawing:
    """Where one face is to be split.

    Attributes
    ----------
    number : int
    face : TopoDS_Face
    surface : Surface
        The face's own.
    grid, known
        As of `label_grid`.
    lines : list of Line
        Along the boundaries of the labels; to be set before `plan`.
    found : Arrangement
    parts : list of Judged
        One for each piece.
    joined : int
        Slivers that went to the label around them.
    missed : int
        Nodes that have no piece of their label.
    fault : str
        Why the curves tried last are no good.
    """

    def __init__(self, face: Any, surface: Surface, labels: FaceLabels) -> None:
        self.number, self.face, self.surface = labels.face, face, surface
        self.grid, self.known, self._specks = label_grid(face, labels)
        self.lines: list[Line] = []
        self.parts: list[Judged] = []
        self.joined = self.missed = 0
        self._border: Border | None = None
        self.fault = ""
        self._tried = 0

    def plan(self, net: Net, worst: int) -> bool:
        """Plan pieces with the next fit that works; False if there is none, then `fault` says why.

        Parameters
        ----------
        net : Net
            Of the part.
        worst : int
            As in `split`.
        """
        while self._tried < len(FITS):
            self._tried += 1
            try:
                self._border = self._border or Border(self.face, self.surface, self.grid, net.edges, net.vertices)
                self._draw(self._border, FITS[self._tried - 1], net.at_end, worst)
                return True
            except Exception as error:
                self.fault = in_words(error)
                if self._border is None:
                    break  # no curve is to blame
        return False

    def renew(self) -> None:
        """Have `plan` look at the border anew and try the last fit again."""
        self._border, self._tried = None, max(self._tried - 1, 0)

    def places(self) -> list[tuple[int, float]]:
        """Where edges of the part are to be cut: number of the edge, parameter."""
        ends = (self.found.crossings[c] for c in self.found.used())
        return [(self.found.border.sides[c.side].key, c.s) for c in ends if c.end is None]

    def _draw(self, border: Border, fit: float, at_end: Callable[[int, float], int | None], worst: int) -> None:
        self.found = Arrangement(border, curves(self.grid, self.lines, fit), at_end)
        regions = regions_of(self.found)
        self.parts = judged(regions, border.scale, self.grid, self.known)
        # Some lie next to the border, and their boundary runs outside.
        missing = self._specks | ((self.known >= 0) & ~np.isin(self.known, [part.label for part in self.parts]))
        self.missed = int(missing.sum())
        group_kept, group, self.joined = slivers(self.found, self.parts, worst)
        if self.joined:
            self.found.keep(group_kept)
            self.parts = joined(self.parts, group, regions_of(self.found))


def in_words(error: Exception) -> str:
    """Why a face cannot be split; errors that are no such reason are raised again."""
    if isinstance(error, CannotSplit):
        return str(error)
    if is_kernel_error(error) or isinstance(error, ValueError | np.linalg.LinAlgError):
        return f"splitting it fails: {type(error).__name__} {error}".strip()
    raise error
