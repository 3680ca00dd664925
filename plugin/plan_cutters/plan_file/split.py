"""How models show faces that are split."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen


class SplitEntry(Frozen):
    """How the models show a face of several labels: verdicts, or operations."""

    rung: Literal["contour", "beside", "whole"] = Field(
        description="split in its place; split as a copy of the face beside the part; coloured whole"
    )
    why: str | None = Field(description="why it could not be split in its place")
    joined: int = Field(
        default=0, description="slivers coloured as what is worse and around them, or that hold no sample"
    )
    dropped: int = Field(
        default=0,
        description="samples without a piece of their label, coloured as what is around them: of operations those beyond a "
        "smooth border, by half a cell of the grid at most",
    )
