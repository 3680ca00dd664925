"""How inside radii that are too small for a cutter stand in the plan file."""

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen


class InsideRadiusEntry(Frozen):
    """A face that bends inwards more than the cutter `shown`, which is not reached there for that."""

    face: str
    radius_mm: float = Field(description="inside radius that most of the area that is not reached there has, or a larger one")
    cutter_radius_mm: float = Field(description="radius or corner radius of the cutter, its allowance included")
    area_mm2: float = Field(description="of the face that is not reached for local or rear gouge")
    fits_mm: float | None = Field(description="largest usual diameter whose radius fits; null where none is that small")
