"""Fixtures, as the plan file has them."""

from pathlib import Path

from cad_io.read.mesh import Mesh
from plan_cutters.document.model import FixtureEntry
from plan_cutters.scene.surroundings import PlacedFixture


def fixture_entry(standing: PlacedFixture) -> FixtureEntry:
    """A fixture where it stands."""
    fixture, source, triangles = standing.fixture, standing.source, standing.obstacles.triangles
    file = None if source is None else source.file
    x, y, z, rx, ry, rz = fixture.placement
    return FixtureEntry(
        name=standing.name,
        file=None if file is None else Path(file).name,
        sha256=None if source is None else source.sha256,
        unit=source.unit if isinstance(source, Mesh) else fixture.unit,
        placement=(x, y, z, rx, ry, rz),
        triangles=len(triangles),
        chord_error_mm=triangles.chord_error,
        watertight=standing.body is not None,
        notes=list(standing.notes),
    )
