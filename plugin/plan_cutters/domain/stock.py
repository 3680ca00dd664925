"""Stock: what the first setup grips, and what of it is below the part there."""

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.checks import shown
from plan_cutters.domain.figures import text_of
from plan_cutters.errors import OptionError

#: Margins unless they are given: on each side, and below, mm; lengths beyond the second number are rather a mistake.
_SIDES, _BELOW, _FARTHEST = 1.0, 5.0, 1e4
#: Jaws grip stock so deep: this share of its height, and between these, mm; and so far below the part at least.
_DEEP, _LEAST, _MOST, _FREE = 0.1, 3.0, 20.0, 2.0
_FORM = "box[:X,Y,Z], cylinder[:R,Z] (margins in mm), FILE (STEP or a mesh) or part"
PART, BOX, CYLINDER, USUAL = "part", "box", "cylinder", "usual"
_WORD = re.compile(rf"({PART}|{BOX}|{CYLINDER}|{USUAL})(?::(.*))?", re.IGNORECASE | re.DOTALL)
#: A cylinder lies along a part that is so many times as long as it is high and wide; no ratio of round numbers, so that whoever
#: measures the part agrees.
LONG = 2.17
#: A bar, and stock that is proposed where a tool does not come low enough beside less, reaches so far below the part, mm.
_DEEPER = 25.0


def deep_in(tall: float, foot: float = math.inf) -> float:
    """How deep jaws grip stock that stands so high over a part's foot, and reaches so far below that, mm.

    >>> deep_in(20.0), deep_in(80.0), deep_in(80.0, 5.0), deep_in(900.0)
    (3.0, 8.0, 3.0, 20.0)
    """
    return max(_LEAST, min(float(round(_DEEP * tall)), _MOST, foot - _FREE))


@dataclass(frozen=True, slots=True)
class Stock:
    """Stock is what a part is made of.

    >>> Stock.of("box").text, Stock.of("cylinder:2,8").below, Stock.of("part").solid
    ('box:1,1,5', 8.0, False)
    """

    kind: str  #: `box`, `cylinder`, `part`, `file`, or `usual`: it is proposed with the setups.
    margins: tuple[float, ...] = ()  #: Across the setup axis, and below the part, mm; none of a file.
    file: str = ""

    @classmethod
    def of(cls, text: object) -> "Stock":
        """Read the word of an option. Raises OptionError."""
        if not isinstance(text, str) or not text.strip():
            raise OptionError(f"stock {shown(text)} is none: give {_FORM}")
        word = _WORD.fullmatch(text.strip())
        if word is None:
            if not Path(text).suffix:
                raise OptionError(f"stock {text!r} is none: give {_FORM}")
            return cls("file", (), text)
        kind, numbers = word[1].lower(), word[2]
        usual = {BOX: (_SIDES, _SIDES, _BELOW), CYLINDER: (_SIDES, _DEEPER)}.get(kind, ())
        if numbers is None:
            return cls(kind, usual)
        try:
            margins = tuple(float(each) for each in numbers.split(","))
        except ValueError:
            margins = ()
        if len(margins) != len(usual) or not all(0.0 <= each <= _FARTHEST for each in margins) or margins[-1:] == (0.0,):
            raise OptionError(f"stock {text!r}: give {_FORM}, the last one greater than 0")
        return cls(kind, margins)

    @property
    def solid(self) -> bool:
        """Whether there is more than the part."""
        return self.kind != PART

    def choices(self, tall: float, *, round_: bool) -> tuple["Stock", ...]:
        """A setup tries these, the first that serves, about a part that is so high, mm: a bar where it is round, else a box that
        jaws grip deep enough; then more below.
        """
        if self.kind != USUAL:
            return (self,)
        box, more = Stock.of(BOX), deep_in(tall) - _LEAST
        boxes = (replace(box, margins=(*box.margins[:-1], below + more)) for below in (_BELOW, _DEEPER))
        return (*[Stock.of(CYLINDER)] * round_, *boxes)

    @property
    def below(self) -> float:
        """How far it reaches below the part, mm; not a number where a file says it."""
        return self.margins[-1] if self.margins else math.nan

    @property
    def text(self) -> str:
        """As on a command line."""
        if self.kind == "file":
            return self.file
        return self.kind + (":" + ",".join(map(text_of, self.margins)) if self.margins else "")


@dataclass(frozen=True, slots=True, eq=False)
class StockBody:
    """Stock about a part in the frame of a setup, z along its axis from the part's origin, mm."""

    low: Floats  #: (3,) the least corner of its box; z is its foot.
    high: Floats  #: (3,) the other one; there is as much on top of the part as beside it, where that is least.
    part_low: float  #: z of the part's lowest point.
    radius: float | None = None  #: Of a cylinder about the middle of the box.
    along: int = 2  #: Along which of the frame's axes that lies.

    @classmethod
    def about(cls, stock: Stock, part: Floats, body: Floats | None = None) -> "StockBody":
        """About the corners of a part (n, 3) in that frame; `body`: those of a file's stock.

        Raises OptionError: a file's stock does not reach below the part or is narrower than it.
        """
        low, high = part.min(axis=0), part.max(axis=0)
        if body is not None:
            lowest, highest = body.min(axis=0), body.max(axis=0)
            if not lowest[2] < low[2] or (lowest > low + 1e-6)[:2].any() or (highest < high - 1e-6)[:2].any():
                raise OptionError(f"stock {stock.file!r} does not enclose the part and reach below it along the setup axis")
            return cls(lowest, np.array([*highest[:2], max(high[2], highest[2])]), float(low[2]))
        foot = low[2] - stock.below
        if stock.kind == BOX:
            margin = np.array(stock.margins[:2])
            top = high[2] + margin.min()
            return cls(np.array([*(low[:2] - margin), foot]), np.array([*(high[:2] + margin), top]), float(low[2]))
        middle, size = 0.5 * (low + high), high - low
        along = next((k for k in (0, 1) if size[k] > LONG * np.delete(size, k).max()), 2)
        round_ = np.delete(np.arange(3), along)
        radius = float(np.linalg.norm((part - middle)[:, round_], axis=1).max()) + stock.margins[0]
        least, most = low - stock.margins[0], high + stock.margins[0]
        least[round_], most[round_] = middle[round_] - radius, middle[round_] + radius
        if along == 2:
            least[2] = foot
        return cls(least, most, float(low[2]), radius, along)

    @property
    def volume(self) -> float:
        """In mm3."""
        size = self.high - self.low
        return float(size.prod() if self.radius is None else math.pi * self.radius**2 * size[self.along])

    @property
    def lying(self) -> bool:
        """Whether it is a bar that lies across the setup axis."""
        return self.along != 2

    @property
    def foot(self) -> tuple[Floats, Floats]:
        """Corners (3,) of a box about what of it is below the part."""
        low, high = self.low.copy(), np.append(self.high[:2], self.part_low)
        if self.radius is not None and self.lying:
            half = math.sqrt(max(0.0, self.radius**2 - (self.radius - self.part_low + self.low[2]) ** 2))
            middle = 0.5 * (self.low + self.high)[1 - self.along]
            low[1 - self.along], high[1 - self.along] = middle - half, middle + half
        return low, high
