"""How models show faces that are split."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen


class SplitEntry(Frozen):
    """How the models show a face of several labels: verdicts, or operations."""

    rung: Literal["contour", "beside", "whole"] = Field(
        description="split in its place; split as a separate copy of the face; coloured whole"
    )
    why: str | None = Field(description="why it could not be split in its place")
    joined: int = Field(default=0, description="slivers coloured as the worst of their neighbours, or that hold no sample")
    dropped: int = Field(
        default=0,
        description="samples without a piece of their label, coloured as their neighbours: of operations those beyond a "
        "smooth border, by half a cell of the grid at most",
    )
