"""Where the view stands to show a worst spot: from the side of the tool, with nothing of the part in between."""

from __future__ import annotations

import math

import FreeCAD as App
import Part

#: Directions from the spot to the eye, as heights over the surface (degrees); from the side one sees where the tool stands.
_HEIGHTS = (35.0, 60.0, 85.0)
#: Directions around the spot that are tried at each height.
_AROUND = 12


def directions(normal, axis=None, eye=None):
    """Unit directions from a spot to the eye, the best first.

    Parameters
    ----------
    normal : Vector
        Out of the material.
    axis : Vector, optional
        Tool axis; the eye looks at the plane in which the tool is tilted.
    eye : Vector, optional
        From where it is looked now: of two directions that serve the same, the nearer one comes first.
    """
    normal = App.Vector(normal).normalize()
    tilted = App.Vector(axis or normal) - normal * (axis or normal).dot(normal)
    if tilted.Length < 1e-6:
        side = App.Vector(1, 0, 0) if abs(normal.x) < 0.9 else App.Vector(0, 1, 0)
        tilted = side - normal * side.dot(normal)
    tilted.normalize()
    across = normal.cross(tilted)
    if eye is not None and across.dot(eye) < 0:
        across = -across
        tilted = -tilted
    turns = sorted((2 * math.pi * step / _AROUND for step in range(_AROUND)), key=lambda turn: 1 - math.cos(turn))
    found = []
    for height in (math.radians(each) for each in _HEIGHTS):
        for turn in turns:
            level = across * math.cos(turn) + tilted * math.sin(turn)
            found.append(level * math.cos(height) + normal * math.sin(height))
    return found


def clear_of(mesh, point, candidates, skin, covered=lambda direction: False):
    """The first direction along which nothing of a mesh is between a point and the eye, and nothing else covers it.

    Where the rest covers it along all of them, the first one at which nothing of the mesh is; the last one where there is none.

    `skin` (mm): what lies nearer to the point than that is the surface itself.
    """
    free = None
    for each in candidates:
        hits = mesh.foraminate(tuple(point), tuple(each)).values()
        if all((App.Vector(*hit) - point).dot(each) < skin for hit in hits):
            if not covered(each):
                return each
            free = each if free is None else free
    return candidates[-1] if free is None else free


def covers(shape, point, direction, near) -> bool:
    """Whether a shape is between a point and the eye, further away from the point than `near` (mm)."""
    far = near + 2.0 * (shape.BoundBox.DiagonalLength + (shape.BoundBox.Center - point).Length)
    line = Part.makeLine(point + direction * near, point + direction * far)
    return float(line.distToShape(shape)[0]) < 1e-6


def _numbers(*values):
    return " ".join(f"{value:.9g}" for value in values)


def placed(point, towards, up, width, perspective):
    """A camera as the text that a view takes.

    Parameters
    ----------
    point : Vector
        In the middle of the view.
    towards : Vector
        Unit direction from the point to the eye.
    up : Vector
        What is up in the view, if it is not along `towards`.
    width : float
        Height of the view, mm.
    perspective : bool
        Whether the camera has perspective; otherwise it is parallel.
    """
    if towards.cross(up).Length < 1e-3:
        up = App.Vector(0, 1, 0) if abs(towards.y) < 0.9 else App.Vector(1, 0, 0)
    turn = App.Rotation(App.Vector(), up, towards, "ZYX")
    angle = math.radians(45)
    away = width / 2 / math.tan(angle / 2) if perspective else 10 * width
    eye, axis = point + towards * away, turn.Axis
    lines = [
        "#Inventor V2.1 ascii", "", "PerspectiveCamera {" if perspective else "OrthographicCamera {",
        "  viewportMapping ADJUST_CAMERA", f"  position {_numbers(*eye)}",
        f"  orientation {_numbers(axis.x, axis.y, axis.z, turn.Angle)}",
        "  aspectRatio 1", f"  focalDistance {_numbers(away)}",
        f"  heightAngle {_numbers(angle)}" if perspective else f"  height {_numbers(width)}", "}", "",
    ]  # fmt: skip
    return "\n".join(lines)


class Seen:
    """A part, as far as it hides its own spots from the eye; its triangles are made once.

    Parameters
    ----------
    shape : Part.Shape
        Where it stands in the document.
    """

    def __init__(self, shape) -> None:
        import Mesh

        self._shape = shape
        self._size = shape.BoundBox.DiagonalLength
        corners, triangles = shape.tessellate(max(self._size / 500, 1e-3))
        self._mesh = Mesh.Mesh([[tuple(corners[place]) for place in each] for each in triangles])

    def normal(self, spot):
        """Unit normal of the part at a spot, out of the material; that of the tool's axis where the face has none there."""
        number = int(spot.face[1:])
        if 1 <= number <= len(self._shape.Faces):
            face = self._shape.Faces[number - 1]
            try:
                return face.normalAt(*face.Surface.parameter(App.Vector(*spot.point)))
            except Exception:  # a degenerated point of the surface: whatever the kernel calls it
                pass
        return App.Vector(*spot.axis) if spot.axis else App.Vector(0, 0, 1)

    def fly(self, view, spot, radius, length, tool=None) -> bool:
        """Show a spot in a view, with room for a tool of some radius and stick-out (mm) above it.

        Whether the tool (a shape, None where none is shown) covers the spot from there: in a deep pocket the only way out is
        that of the tool.
        """
        point, normal = App.Vector(*spot.point), self.normal(spot)
        axis = App.Vector(*spot.axis) if spot.axis else normal
        width = min(max(12 * radius, self._size / 6, 1.6 * length), 1.5 * self._size)
        candidates = directions(normal, axis, view.getViewDirection() * -1)

        def covered(towards, radii) -> bool:
            return tool is not None and covers(tool, point, towards, radii * radius)

        # Nearer than its own diameter there are the flutes alone, which leave more to see than a holder.
        chosen = clear_of(self._mesh, point, candidates, self._size / 200, lambda towards: covered(towards, 2.0))
        # The tool stands above the spot: so that goes below the middle.
        view.setCamera(placed(point + axis * (width / 4), chosen, axis, width, view.getCameraType() == "Perspective"))
        # A ball end over the spot is passed within 1.15 radii by the lowest of the directions.
        return covered(chosen, 1.2)
