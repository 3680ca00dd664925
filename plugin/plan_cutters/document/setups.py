"""The plan file states here how much is reached in each of several setups."""

from pydantic import Field

from plan_cutters.document.frozen import Frozen, Vector
from plan_cutters.document.shares import VerdictCounts


class SetupEntry(Frozen):
    """How much of the target surface some cutter could touch within the axis limits, were this the setup axis."""

    axis: Vector
    within: int = Field(description="samples")
    share: float = Field(description="of the judged samples' area, 0 to 1")
    reached: int | None = Field(
        default=None, description="samples that some cutter reaches in it; null where it was not asked for"
    )
    reached_share: float | None = Field(default=None, description="of the judged samples' area, 0 to 1")


class SetupReach(VerdictCounts):
    """The verdicts of a cutter in one setup are counted in samples."""

    axis: Vector
    serves: int = Field(
        default=0, description="samples whose posture is that of this setup: the first one that reaches them"
    )
