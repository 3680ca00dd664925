"""The part as the plan names it: its file, its size, which side is material, and what is odd about it."""

from pydantic import Field

from plan_cutters.plan_file.fixtures import ReferenceEntry
from plan_cutters.plan_file.frozen import Frozen, Vector


class OrientationInfo(Frozen):
    """How the side out of the material was found, and whether that is more than a guess."""

    method: str
    confident: bool


class SewingInfo(Frozen):
    """Faces that stand in no solid, joined where their edges coincide to find out which side is material."""

    tolerance_mm: float | None = Field(description="the smallest tried that left the least open; null: nothing to join")
    tried_mm: float | None = Field(description="the largest tried")
    open_edges: int = Field(description="edges that still belong to one face alone")
    open_length_mm: float


class PartInfo(Frozen):
    file: str | None
    sha256: str | None
    references: list[ReferenceEntry] = Field(default=[], description="files that the file refers to")
    size_mm: Vector
    solids: int
    faces: int
    orientation: OrientationInfo
    sewing: SewingInfo | None = Field(default=None, description="null where every face belongs to a solid")
    warnings: list[str]
