"""A BREP face, or one in memory, that has no edges is all of its surface; where that has no end, it is said."""

import math

import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_ConicalSurface, Geom_CylindricalSurface, Geom_Plane, Geom_SphericalSurface, Geom_ToroidalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face

from cad_io import ReadError, read_part
from cad_io.part.bodies import bodies
from tests.support.cad_parts import box, compound, moved

PLACE = gp_Ax3(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 1))


def bare(surface):
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face, surface, 1e-7)
    return face


WHOLE = {
    "ball": (lambda: bare(Geom_SphericalSurface(PLACE, 5.0)), 100 * math.pi),
    "ring": (lambda: bare(Geom_ToroidalSurface(PLACE, 30.0, 8.0)), 4 * math.pi**2 * 240),
    "moved": (lambda: bare(Geom_SphericalSurface(PLACE, 5.0)).Moved(TopLoc_Location(moved())), 100 * math.pi),
    "reversed": (lambda: bare(Geom_SphericalSurface(PLACE, 5.0)).Reversed(), 100 * math.pi),
}


@pytest.mark.parametrize(("make", "area"), WHOLE.values(), ids=WHOLE)
def test_it_is_all_of_its_surface(tmp_path, make, area):
    file = tmp_path / "bare.brep"
    BRepTools.Write_s(make(), str(file))
    for source in (file, make()):
        part = read_part(source)
        (face,) = part.faces
        assert (face.unjudged, part.lost) == (None, ())
        assert face.area == pytest.approx(area)
        (body,) = bodies(part)
        assert body.closed


@pytest.mark.parametrize(
    "surface",
    [Geom_Plane(PLACE), Geom_CylindricalSurface(PLACE, 4.0), Geom_ConicalSurface(PLACE, 0.4, 4.0)],
    ids=["plane", "cylinder", "cone"],
)
def test_what_has_no_end_is_named(tmp_path, surface):
    file = tmp_path / "bare.brep"
    BRepTools.Write_s(bare(surface), str(file))
    for source in (file, bare(surface)):
        with pytest.raises(ReadError, match="F1 has no edges and no end: bound it"):
            read_part(source)
    BRepTools.Write_s(compound(box(), bare(surface)), str(file))
    for source in (file, compound(box(), bare(surface))):
        part = read_part(source)
        assert part.faces[6].unjudged is not None
        assert "it has no edges and no end: bound it" in [each.why for each in part.lost]


def test_faces_stay_the_ones_that_a_host_knows():
    face = bare(Geom_SphericalSurface(PLACE, 5.0))
    part = read_part(compound(box(), face))
    assert part.face(7).IsSame(face)
