"""Fixtures, as the plan file has them."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from cad_io import Part
from cad_io.read.mesh import Mesh
from plan_cutters.document.model import FixtureEntry
from plan_cutters.scene.surroundings import Standing


def fixture_entry(standing: Standing) -> FixtureEntry:
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


def fixture_notes(fixtures: Sequence[Standing], *, several: bool = False) -> Iterator[str]:
    """What the plan must say of fixtures; `several`: there is more than one setup."""
    for each in fixtures:
        for note in each.notes:
            yield f"{each.name}: {note}."
    if several:
        for each in fixtures:
            if each.fixture.follows_setup:
                yield f"{each.name}: it lies across the axis of the first setup, and stays there in the others."
    drawn = [each.name for each in fixtures if not isinstance(each.source, Part)]
    if drawn:
        yield f"Only the GLB model, the review page and pictures show what is no CAD body: {', '.join(drawn)}."
