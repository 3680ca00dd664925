"""All that is drawn, as one mesh: the faces of the part by their numbers, then the fixtures."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.write.render_mesh import Mesh, RenderMesh
from plan_cutters.document.fixtures import fixtures_in
from plan_cutters.report.page.atlas import NOWHERE, Atlas, placed_in
from plan_cutters.report.protocol import Judged
from plan_cutters.scene.surroundings import PlacedFixture

#: First triangle and number of triangles.
Range = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Surface:
    """Vertices and triangles."""

    #: (v, 3), mm, part coordinates; unit, out of the material.
    point: Floats
    normal: Floats
    #: (m, 3); counter-clockwise from outside.
    triangle: NDArray[np.uint32]
    #: (v, 2); in the atlas.
    place: NDArray[np.uint16]
    #: Face number, or place among the fixtures, -> Range.
    faces: dict[int, Range]
    fixtures: dict[int, Range]


def surface_of(result: Judged, render_mesh: RenderMesh, atlas: Atlas) -> Surface:
    """Put the meshes of faces and fixtures together."""
    start = 0
    meshes: list[Mesh] = []
    places: list[NDArray[np.uint16]] = []
    faces: dict[int, Range] = {}
    fixtures: dict[int, Range] = {}
    for number in sorted(render_mesh.meshes):
        mesh, place = placed_in(atlas, result.samples, number, render_mesh.meshes[number], render_mesh.periods[number])
        faces[number] = (start, len(mesh.triangle))
        start += len(mesh.triangle)
        meshes.append(mesh)
        places.append(place)
    for i, (fixture, _) in enumerate(fixtures_of(result)):
        mesh = _facets(fixture.shown)
        fixtures[i] = (start, len(mesh.triangle))
        start += len(mesh.triangle)
        meshes.append(mesh)
        places.append(np.full((len(mesh.point), 2), NOWHERE, np.uint16))
    first = np.cumsum([0, *(len(m.point) for m in meshes)])[:-1]
    return Surface(
        np.concatenate([m.point for m in meshes]),
        np.concatenate([m.normal for m in meshes]),
        np.concatenate([m.triangle + np.uint32(n) for m, n in zip(meshes, first, strict=True)]),
        np.concatenate(places),
        faces,
        fixtures,
    )


def fixtures_of(result: Judged) -> list[tuple[PlacedFixture, list[int]]]:
    """The fixtures of all setups, those of the first one first, each with the setups in which it stands."""
    return fixtures_in([each.surroundings for each in result.ready.setups])


def _facets(corner: Floats) -> Mesh:
    """Triangles (n, 3, 3) with flat facets."""
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    length = np.linalg.norm(normal, axis=1)
    corner, normal, length = corner[length > 0], normal[length > 0], length[length > 0]
    count = 3 * len(corner)
    return Mesh(
        corner.reshape(-1, 3),
        np.repeat(normal / length[:, None], 3, axis=0),
        np.arange(count, dtype=np.uint32).reshape(-1, 3),
        np.zeros((count, 2)),
    )


def box_of(surface: Surface, samples: Any) -> tuple[Floats, Floats]:
    """Corners of the box around all that is drawn, mm."""
    every = np.vstack([surface.point, samples.point[np.isfinite(samples.point).all(axis=1)]])
    return every.min(axis=0), every.max(axis=0)
