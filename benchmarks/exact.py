"""How deep does the exact surface reach into a cutter? Slow, and sharing no code with the search.

A dense grid of points of each face by the CAD kernel's own evaluation, then ever finer grids about the deepest point
of each of the deepest places. What is found is a true point of the surface: a depth beyond the tolerance is proof.
"""

from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_OUT

from cad_io import Part
from cad_io.arrays import Floats

#: Grid lines a face and direction, nodes along the side of a place, places refined, rounds, nodes each way in a round.
LINES, SIDE, PLACES, ROUNDS, NODES = 400, 8, 8, 6, 9


class _Face:
    def __init__(self, shape: Any) -> None:
        self._value = BRepAdaptor_Surface(shape).Value
        self._inside = BRepTopAdaptor_FClass2d(shape, 1e-7).Perform
        self.low, self.high = np.array(BRepTools.UVBounds_s(shape)).reshape(2, 2).T

    def points(self, uv: Floats) -> Floats:
        return np.array([self._value(u, v).Coord() for u, v in uv.tolist()])

    def inside(self, uv: Floats) -> bool:
        return bool(self._inside(gp_Pnt2d(*uv.tolist())) != TopAbs_OUT)


class Exact:
    """Points of a part's faces, dense enough to find every deep place."""

    def __init__(self, part: Part) -> None:
        self._faces = [_Face(part.face(info.number)) for info in part.faces]
        places, points, parameters = [], [], []
        for number, face in enumerate(self._faces):
            i, j = (k.ravel() for k in np.indices((LINES, LINES)))
            uv = face.low + np.column_stack([i, j]) / (LINES - 1) * (face.high - face.low)
            place = (number * LINES + i // SIDE) * LINES + j // SIDE
            order = np.argsort(place, kind="stable")
            order = order[[face.inside(at) for at in uv[order]]]
            points.append(face.points(uv[order]))
            parameters.append(uv[order])
            places.append(place[order])
        self._points, self._uv = np.concatenate(points), np.concatenate(parameters)
        place = np.concatenate(places)
        self._start = np.flatnonzero(np.r_[True, place[1:] != place[:-1]])
        self._face_of = place[self._start] // LINES**2

    def deepest(self, contact: Floats, axis: Floats, x_t: Floats, radius: float, length: float) -> float:
        """Depth (mm) of the deepest point found in the flat end that touches `contact`; negative if none is inside."""
        frame = np.column_stack([axis, x_t, np.cross(axis, x_t)])

        def depth(points: Floats) -> Floats:
            height, across, along = ((points - contact) @ frame).T
            return np.minimum(np.minimum(height, length - height), radius - np.hypot(across + radius, along))

        coarse = depth(self._points)
        by_place = np.maximum.reduceat(coarse, self._start)
        best = float(coarse.max())
        ends = np.r_[self._start[1:], len(coarse)]
        for place in np.argsort(by_place)[-PLACES:].tolist():
            first = self._start[place]
            face = self._faces[self._face_of[place]]
            uv = self._uv[first + int(coarse[first : ends[place]].argmax())]
            step = (face.high - face.low) / (LINES - 1)
            for _ in range(ROUNDS):
                grid = uv + np.stack(np.meshgrid(*[np.linspace(-1, 1, NODES)] * 2), -1).reshape(-1, 2) * step
                grid = np.clip(grid, face.low, face.high)
                found = depth(face.points(grid))
                deepest = next((k for k in np.argsort(-found) if face.inside(grid[k])), None)
                if deepest is None:
                    break
                uv, step = grid[deepest], step / 4
                best = max(best, float(found[deepest]))
        return best
