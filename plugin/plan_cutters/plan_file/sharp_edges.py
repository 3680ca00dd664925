"""How sharp inside edges stand in the plan file."""

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen


class SharpEdgeEntry(Frozen):
    """Where two faces meet at an angle below 180 deg without a fillet, and what the cutter `shown` leaves there."""

    faces: tuple[str, str]
    length_mm: float = Field(description="of all edges between the two faces that are sharp")
    angle_deg: float = Field(description="between the faces, through the air; the mean along the edges")
    radius_mm: float = Field(description="of the fillet that the cutter leaves, its allowance included")
    width_mm: float = Field(description="of the strip on each face, as between planes at this angle")
    area_mm2: float = Field(description="that the cutter leaves on both faces, by its samples with the reason `sharp_edge`")
