"""Which faces were judged and which were not: counts and areas."""

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen


class Scope(Frozen):
    """Faces that were judged, and those that were not: these are obstacles, unless they are ignored."""

    judged: int = Field(description="target faces")
    judged_mm2: float = Field(description="their area, as far as it is known")
    not_judged: int = Field(description="faces that are obstacles only")
    not_judged_mm2: float = Field(description="their area, as far as it is known")
    judged_by_kind: dict[str, int] = Field(description="as `faces[].kind`")
    not_judged_by_kind: dict[str, int]
