"""Fixtures, as the plan file has them."""

from collections.abc import Sequence
from pathlib import Path

from cad_io import Part
from cad_io.read.mesh import Mesh
from plan_cutters.plan_file.fixtures import FixtureEntry, ReferenceEntry
from plan_cutters.scene.surroundings import PlacedFixture, Surroundings


def fixture_entries(each: Sequence[Surroundings]) -> list[FixtureEntry]:
    """Fixtures of all setups, those of the first one first; what stands there in the same place is one entry."""
    return [fixture_entry(standing).model_copy(update={"setups": setups}) for standing, setups in standing_in(each)]


def standing_in(each: Sequence[Surroundings]) -> list[tuple[PlacedFixture, list[int]]]:
    """Placed fixtures of all setups, each with the setups in which it stands, in the order of `fixture_entries`."""
    found: list[tuple[PlacedFixture, list[int]]] = []
    known: list[FixtureEntry] = []
    for number, around in enumerate(each):
        for standing in around.fixtures:
            mine = fixture_entry(standing)
            if number and mine in known:
                found[known.index(mine)][1].append(number)
            else:
                found.append((standing, [number]))
                known.append(mine)
    return found


def references(part: Part) -> list[ReferenceEntry]:
    """The files that a part's file refers to."""
    return [ReferenceEntry(file=file, sha256=sha256) for file, sha256 in part.references]


def fixture_entry(standing: PlacedFixture) -> FixtureEntry:
    """A fixture where it stands."""
    fixture, source, triangles = standing.fixture, standing.source, standing.obstacles.triangles
    file = None if source is None else source.file
    x, y, z, rx, ry, rz = fixture.placement
    return FixtureEntry(
        name=standing.name,
        file=None if file is None else Path(file).name,
        sha256=None if source is None else source.sha256,
        references=references(source) if isinstance(source, Part) else [],
        unit=source.unit if isinstance(source, Mesh) else fixture.unit,
        placement=(x, y, z, rx, ry, rz),
        triangles=len(triangles),
        chord_error_mm=triangles.chord_error,
        watertight=standing.body is not None,
        notes=list(standing.notes),
    )
