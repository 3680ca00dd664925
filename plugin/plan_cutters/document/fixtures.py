"""Fixtures, as the plan file has them."""

from collections.abc import Sequence
from pathlib import Path

from cad_io import Part
from cad_io.read.mesh import Mesh
from plan_cutters.plan_file.part_info import FixtureEntry, ReferenceEntry
from plan_cutters.scene.surroundings import PlacedFixture, Surroundings


def fixture_entries(each: Sequence[Surroundings]) -> list[FixtureEntry]:
    """Fixtures of all setups, those of the first one first; what stands there in the same place is one entry."""
    return [fixture_entry(fixture, setups) for fixture, setups in fixtures_in(each)]


def fixtures_in(each: Sequence[Surroundings]) -> list[tuple[PlacedFixture, list[int]]]:
    """Placed fixtures of all setups, each with the setups in which it stands, in the order of `fixture_entries`."""
    fixtures: list[tuple[PlacedFixture, list[int]]] = []
    known: list[FixtureEntry] = []
    for number, surroundings in enumerate(each):
        for fixture in surroundings.fixtures:
            mine = fixture_entry(fixture)
            if number and mine in known:
                fixtures[known.index(mine)][1].append(number)
            else:
                fixtures.append((fixture, [number]))
                known.append(mine)
    return fixtures


def references(part: Part) -> list[ReferenceEntry]:
    """The files that a part's file refers to."""
    return [ReferenceEntry(file=file, sha256=sha256) for file, sha256 in part.references]


def fixture_entry(placed: PlacedFixture, setups: Sequence[int] = (0,)) -> FixtureEntry:
    """A fixture where it stands, in some setups."""
    fixture, source, triangles = placed.fixture, placed.source, placed.obstacles.triangles
    file = None if source is None else source.file
    x, y, z, rx, ry, rz = fixture.placement
    return FixtureEntry(
        name=placed.name,
        file=None if file is None else Path(file).name,
        sha256=None if source is None else source.sha256,
        references=references(source) if isinstance(source, Part) else [],
        unit=source.unit if isinstance(source, Mesh) else fixture.unit,
        placement=(x, y, z, rx, ry, rz),
        triangles=len(triangles),
        chord_error_mm=triangles.chord_error,
        watertight=placed.body is not None,
        notes=list(placed.notes),
        clamping=fixture.text if fixture.clamping is not None else None,
        grips=[] if placed.hold is None else [f"F{number}" for number in placed.hold.grips],
        unheld=[f"F{number}" for number in placed.unheld],
        hidden_mm2=None if placed.hold is None else placed.hold.hidden,
        setups=list(setups),
    )
