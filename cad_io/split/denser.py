"""B-spline surfaces with more knots for a while: same shape, same parameters, but the kernel searches them more finely."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_BSplineSurface
from OCP.TopLoc import TopLoc_Location

_EXACT = 1e-12  # knots closer than this are one
_RESTORED = 1e-9  # mm that taking a knot out may move the surface; it is rounding only


@contextmanager
def denser(wanted: Iterable[tuple[Any, int]]) -> Iterator[None]:
    """Inside the block, spans of B-spline surfaces are cut, in place: (face, number of parts).

    The kernel's projection on a surface starts from a few points a span and takes the nearest; on a rough surface that
    may lie on the wrong slope.
    """
    added: list[tuple[Any, list[float], list[float]]] = []
    for face, parts in wanted:
        surface = BRep_Tool.Surface_s(face, TopLoc_Location())  # with the location apart: the stored one, not a copy
        if not isinstance(surface, Geom_BSplineSurface):
            continue
        us = _between([surface.UKnot(i + 1) for i in range(surface.NbUKnots())], parts)
        vs = _between([surface.VKnot(i + 1) for i in range(surface.NbVKnots())], parts)
        for u in us:
            surface.InsertUKnot(u, 1, _EXACT, True)
        for v in vs:
            surface.InsertVKnot(v, 1, _EXACT, True)
        added.append((surface, us, vs))
    try:
        yield
    finally:
        for surface, us, vs in reversed(added):
            for u in us:
                surface.RemoveUKnot(
                    _nearest([surface.UKnot(i + 1) for i in range(surface.NbUKnots())], u), 0, _RESTORED
                )
            for v in vs:
                surface.RemoveVKnot(
                    _nearest([surface.VKnot(i + 1) for i in range(surface.NbVKnots())], v), 0, _RESTORED
                )


def _between(knots: list[float], parts: int) -> list[float]:
    return [a + (b - a) * k / parts for a, b in pairwise(knots) for k in range(1, parts)]


def _nearest(knots: list[float], x: float) -> int:
    return min(range(len(knots)), key=lambda i: abs(knots[i] - x)) + 1
