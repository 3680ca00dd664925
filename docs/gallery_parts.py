"""Draw the parts of the gallery that are its own: `python docs/gallery_parts.py FOLDER` (build123d)."""

import sys
from pathlib import Path
from typing import Any

import build123d as bd


def phone_shell() -> Any:
    """The back shell of a phone: a tray with a rounded rim, walls of 2 mm, three bosses and an opening for the camera."""
    outer = bd.extrude(bd.RectangleRounded(140, 70, 12), 12)
    outer = bd.fillet(outer.faces().sort_by(bd.Axis.Z)[0].edges(), 5)
    inner = bd.Pos(0, 0, 2) * bd.extrude(bd.RectangleRounded(136, 66, 10), 12)
    inner = bd.fillet(inner.faces().sort_by(bd.Axis.Z)[0].edges(), 3)
    bosses = [bd.Pos(x, y, 2) * bd.extrude(bd.Circle(4), 5) for x, y in ((-50, 20), (-50, -20), (45, 0))]
    camera = bd.Pos(50, 20, -1) * bd.extrude(bd.RectangleRounded(20, 12, 5), 6)
    return outer - inner + bosses - camera


def lens_mould() -> Any:
    """An insert that moulds an aspheric lens: a concave face of revolution with a steep rim in a cylinder of 40 mm."""
    # The sag of a conic, vertex radius 14 mm, with one term more.
    sag = [(r, r * r / (14 + (14**2 - 0.6 * r * r) ** 0.5) + 2e-5 * r**4) for r in (0, 2.5, 5, 7.5, 10, 12)]
    depth = sag[-1][1]
    with bd.BuildSketch(bd.Plane.XZ) as half:
        with bd.BuildLine():
            bd.Spline(*[(r, 22 - depth + z) for r, z in sag], tangents=((1, 0), (1, 1.5)))
            bd.Polyline((12, 22), (16, 22), (16, 18), (20, 18), (20, 0), (0, 0), (0, 22 - depth))
        bd.make_face()
    return bd.revolve(half.sketch, bd.Axis.Z)


def flange_nut() -> Any:
    """A hexagonal nut of 30 mm across flats on a flange, with a bore for the thread and a fillet between the two."""
    flange = bd.extrude(bd.Circle(22), 4)
    flange = bd.fillet(flange.faces().sort_by(bd.Axis.Z)[-1].edges(), 1.5)
    nut = flange + bd.Pos(0, 0, 4) * bd.extrude(bd.RegularPolygon(15, 6, major_radius=False), 16)
    foot = [edge for edge in nut.edges() if abs(edge.center().Z - 4) < 1e-6 and edge.length < 20]
    nut = bd.fillet(foot, 2)
    bore = bd.extrude(bd.Circle(8.75), 20)
    crown = bd.Pos(0, 0, 20) * (bd.extrude(bd.Circle(30), -6) - bd.extrude(bd.Circle(15.6), -6, taper=-60))
    return nut - bore - crown


def mould_half() -> Any:
    """The block of `samples/build123d_mould.py`: a deep, drafted cavity whose floor is rounded."""
    block = bd.Pos(0, 0, -20) * bd.Box(80, 60, 40)
    cavity = bd.extrude(bd.RectangleRounded(50, 30, 10), -28, taper=5)
    return block - bd.fillet(cavity.faces().sort_by(bd.Axis.Z)[0].edges(), 4)


PARTS = (phone_shell, lens_mould, flange_nut, mould_half)


def draw(folder: Path) -> None:
    """Write each part as STEP."""
    folder.mkdir(parents=True, exist_ok=True)
    for part in PARTS:
        bd.export_step(part(), str(folder / f"{part.__name__}.step"))


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
