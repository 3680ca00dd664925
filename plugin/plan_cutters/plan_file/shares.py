"""How much of a surface has each verdict: by samples, and by the area that they stand for."""

import math
from collections.abc import Iterable, Mapping

from pydantic import Field

from plan_cutters.domain.figures import exact, percent
from plan_cutters.domain.verdicts import DRILLED, WORDS
from plan_cutters.plan_file.frozen import Frozen

#: Verdicts on what mills are asked for, from best to worst.
VERDICTS = tuple(word for code, word in WORDS.items() if code != DRILLED)
_REACHED, _NOT_REACHED = ("interference_free", "accessible"), ("inaccessible", "undecided")


class VerdictCounts(Frozen):
    """How many samples have each verdict."""

    interference_free: int = 0
    accessible: int = 0
    inaccessible: int = 0
    undecided: int = 0
    unjudged: int = 0
    inside_bodies: int = Field(
        default=0,
        description="of the inaccessible: samples inside other bodies of the part, which are no surface of the finished part; "
        "shares and choices are about the others",
    )

    exempt: int = Field(
        default=0,
        description="of the inaccessible: samples at sharp inside edges that no cutter enters, where `sharp_edges` is `left`; "
        "shares and choices are about the others",
    )

    drilled: int = Field(
        default=0,
        exclude_if=lambda samples: not samples,
        description="in holes for drills (`holes`), of no other verdict; shares and choices are about the others; not written "
        "where there are none",
    )

    @property
    def blocked(self) -> int:
        """Inaccessible samples that are required."""
        return self.inaccessible - self.inside_bodies - self.exempt

    @property
    def reached(self) -> int:
        """Samples that are interference-free or accessible."""
        return self.interference_free + self.accessible

    @property
    def not_reached(self) -> int:
        """Samples of the finished part's surface that are not reached."""
        return self.blocked + self.undecided

    def of(self, verdict: str) -> int:
        """Samples of the finished part's surface with a verdict."""
        return self.blocked if verdict == "inaccessible" else int(getattr(self, verdict))


class AreaShare(Frozen):
    """Shares of an area, 0 to 1, by the verdicts of the samples that stand for it; together they are 1."""

    interference_free: float = 0.0
    accessible: float = 0.0
    inaccessible: float = 0.0
    undecided: float = 0.0
    unjudged: float = 0.0
    lost_by: dict[str, float] = Field(
        default={}, description="of inaccessible and undecided together, by reason; reasons that there are"
    )

    @property
    def reached(self) -> float:
        """Share that is interference-free or accessible."""
        return min(1.0, self.interference_free + self.accessible)

    @property
    def not_reached(self) -> float:
        """Share that is not reached."""
        return self.inaccessible + self.undecided


class FaceVerdicts(VerdictCounts):
    """The verdicts of a cutter on a face are counted in samples and in shares of its area."""

    area_share: AreaShare = Field(
        default=AreaShare(), description="of the face's area, without what of it lies inside other bodies; 0 where all does"
    )
    exempt_share: float = Field(default=0.0, description="of the face's area that is exempt")
    drilled_share: float = Field(
        default=0.0, exclude_if=lambda share: not share, description="of the face's area that is in holes for drills"
    )
    inside_share: float = Field(default=0.0, description="of the face's area that lies inside other bodies of the part")


def by_share(shares: Mapping[str, float]) -> list[tuple[str, float]]:
    """Reasons with their shares, the one with the largest share first."""
    return sorted(shares.items(), key=lambda item: (-item[1], item[0]))


def part_of(counts: VerdictCounts, share: AreaShare, words: Iterable[str]) -> str:
    """How much of an area has one of some verdicts, in percent."""
    mine, there = set(words), _there(counts, share)
    return percent(sum(getattr(share, word) for word in mine), some=bool(there & mine), whole=bool(there) and there <= mine)


def reached(counts: VerdictCounts, share: AreaShare) -> str:
    """How much of an area is interference-free or accessible, in percent."""
    return part_of(counts, share, _REACHED)


def unreached(counts: VerdictCounts, share: AreaShare) -> str:
    """How much of an area is inaccessible or undecided, in percent."""
    return part_of(counts, share, _NOT_REACHED)


def reached_share(counts: VerdictCounts, share: AreaShare) -> float | None:
    """Share of an area that is reached: 1 only where all is, 0 only where nothing is; None where it is not known."""
    there, reached = _there(counts, share), sum(getattr(share, word) for word in _REACHED)
    if not there or not math.isfinite(reached):
        return None
    return exact(reached, some=bool(there & set(_REACHED)), whole=there <= set(_REACHED))


def _there(counts: VerdictCounts, share: AreaShare) -> set[str]:
    return {word for word in VERDICTS if counts.of(word) or getattr(share, word) > 0.0}
