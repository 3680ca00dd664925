"""Cutters: tool assemblies that can exist, how they are made, and what follows from their dimensions."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Unpack

from cad_io.arrays import Floats
from plan_cutters.domain.checks import Angle, degrees_too, items, spelled_out
from plan_cutters.domain.dimensions import AboveTip, Attributes, Dimensions, Shape, dimensions, parted, points_of, typed, written
from plan_cutters.domain.figures import text_of
from plan_cutters.domain.holder import Holder, Segment, positive
from plan_cutters.domain.shapes import Part, check, flute_length, stages
from plan_cutters.domain.verdicts import JUDGED_SHARE
from plan_cutters.errors import CutterError


@degrees_too({"taper": Angle(-90.0, 90.0)}, error=CutterError)
@dataclass(frozen=True, slots=True)
class Cutter(Dimensions):
    """A cutter that can be judged: a solid of revolution, from its tip to the end of its holder; see `Dimensions`.

    Raises
    ------
    CutterError
        No such cutter can exist.
    """

    if TYPE_CHECKING:

        def __init__(
            self, radius: float, length: float, corner_radius: float = 0.0, name: str = "", *, shape: Shape = "end",
            arc_radius: float = 0.0, arc_height: float = 0.0, outline: Sequence[Sequence[float]] | Floats = (),
            **more: Unpack[AboveTip],
        ) -> None: ...  # fmt: skip

    def __post_init__(self) -> None:
        Dimensions.__post_init__(self)
        check(self, self.typed)

    @classmethod
    @spelled_out(Attributes, Dimensions)
    def flat(
        cls, *, radius: float | None = None, diameter: float | None = None, length: float, **more: Unpack[Attributes]
    ) -> "Cutter":
        """A flat-end cutter by its radius or its diameter, lengths in mm; `more`: any other attribute.

        >>> Cutter.flat(diameter=12, length=80).id, Cutter.flat(radius=6, length=80, taper_deg=3).id
        ('R6L80', 'R6L80T3')
        """
        return cls(_radius(radius, diameter), length, **more)

    @classmethod
    @spelled_out(Attributes, Dimensions)
    def bull(
        cls, *, radius: float | None = None, diameter: float | None = None, corner_radius: float, length: float,
        **more: Unpack[Attributes],
    ) -> "Cutter":  # fmt: skip
        """A bull nose."""
        return cls(_radius(radius, diameter), length, corner_radius, **more)

    @classmethod
    @spelled_out(Attributes, Dimensions)
    def ball(
        cls, *, radius: float | None = None, diameter: float | None = None, length: float, **more: Unpack[Attributes]
    ) -> "Cutter":
        """A ball end."""
        ball = _radius(radius, diameter)
        return cls(ball, length, ball, **more)

    @classmethod
    @spelled_out(Attributes, Dimensions)
    def lollipop(
        cls, *, radius: float | None = None, diameter: float | None = None, neck_radius: float | None = None,
        neck_diameter: float | None = None, length: float, **more: Unpack[Attributes],
    ) -> "Cutter":  # fmt: skip
        """A ball on a neck, which goes on up to its length."""
        ball, neck = _radius(radius, diameter), _radius(neck_radius, neck_diameter, "neck ")
        rest: dict[str, Any] = {**more}
        return cls(ball, length, ball, shape="lollipop", shank_radius=neck, **rest)

    @classmethod
    @spelled_out(Attributes, Dimensions)
    def barrel(
        cls, *, radius: float | None = None, diameter: float | None = None, flank_radius: float, length: float,
        height: float | None = None, tip_radius: float = 0.0, **more: Unpack[Attributes],
    ) -> "Cutter":  # fmt: skip
        """A barrel: its flank is an arc of a large radius, widest (`radius`) at a height over the tip.

        With a tip radius a ball is the tip, to which the flank is tangent: then the height follows.
        """
        widest = _radius(radius, diameter)
        if tip_radius:
            inner, outer = flank_radius - widest, flank_radius - tip_radius
            if not 0 <= inner <= outer:
                raise CutterError(
                    f"a flank of radius {flank_radius:g} is tangent to no tip of radius {tip_radius:g} under a "
                    f"cutter of radius {widest:g}"
                )
            height = tip_radius + math.sqrt(outer**2 - inner**2)
        elif height is None:
            raise CutterError("a barrel needs the height of its widest place, or the radius of its tip")
        return cls(widest, length, tip_radius, shape="barrel", arc_radius=flank_radius, arc_height=height, **more)

    @classmethod
    @spelled_out(Attributes, Dimensions)
    def lens(
        cls, *, radius: float | None = None, diameter: float | None = None, bottom_radius: float, corner_radius: float,
        length: float, **more: Unpack[Attributes],
    ) -> "Cutter":  # fmt: skip
        """A lens: its bottom is an arc of a large radius about the axis, with a corner of a small one."""
        return cls(_radius(radius, diameter), length, corner_radius, shape="lens", arc_radius=bottom_radius, **more)

    @classmethod
    @spelled_out(Attributes, Dimensions)
    def form(cls, outline: Sequence[Sequence[float]] | Floats, *, length: float, **more: Unpack[Attributes]) -> "Cutter":
        """Any revolved outline of points (radius, height), from the tip to the end of the flutes."""
        points = points_of(outline)
        return cls(max((r for r, _ in points), default=0.0), length, shape="form", outline=points, **more)

    @classmethod
    def parse(cls, spec: str) -> "Cutter":
        """Read `R6L80` or `D12L80`: radius or diameter, and length, in mm; `rc1` adds a corner radius, `HR15L30` a holder.

        `spec.dimensions` has the rest, inches too, and `Holder.parse` what may follow the H. A text that is not the id itself
        becomes the name.

        Raises
        ------
        CutterError
            The text is not of that form, or no such cutter can exist.

        Examples
        --------
        >>> Cutter.parse("r6l80").id
        'R6L80'
        >>> Cutter.parse("")
        Traceback (most recent call last):
        plan_cutters.errors.CutterError: cutter '' is not of the form R6L80 (radius 6 mm, length 80 mm) or D12L80 (diameter \
12 mm, length 80 mm); D0.5inL3in is in inches
        >>> Cutter.parse("D0.5inL3in").id
        'R6.35L76.2'
        """
        head, holder = parted(spec) if isinstance(spec, str) else (spec, None)
        sizes, held = dimensions(head), None if holder is None else Holder.parse(holder)
        try:
            made = cls(**sizes, holder=held, name=spec.strip())
        except CutterError as error:
            cause = error.cause.removeprefix("cutter ").removeprefix(f"{spec.strip()}: ")
            raise type(error)(f"cutter {spec.strip()!r}: {cause}") from None
        return replace(made, name="") if made.id.lower() == made.name.lower() else made

    @classmethod
    def of(cls, given: Any) -> "Cutter":
        """A cutter, or what `parse` makes of a text."""
        return given if isinstance(given, cls) else cls.parse(given)

    @classmethod
    def each_of(cls, given: Any) -> tuple["Cutter", ...]:
        """One cutter or text, a list of such, or a mapping of names to such; None is an empty list."""
        if given is None:
            return ()
        if isinstance(given, Mapping):
            return tuple(replace(cls.of(each), name=str(name)) for name, each in given.items())
        if isinstance(given, str | cls):
            return (cls.of(given),)
        return tuple(cls.of(each) for each in items(given, "cutters", "cutters", error=CutterError))

    @property
    def stages(self) -> tuple[tuple[Part, float, Segment], ...]:
        """List the segments above the flutes, upwards: the part, the height over the tip at which it begins, mm, the segment."""
        return stages(self)

    def large_enough(self, tolerance: float) -> bool:
        """Whether verdicts to a tolerance, mm, say anything about this cutter: it is at least four of it thick and long."""
        return tolerance < JUDGED_SHARE * min(self.radius, flute_length(self))

    @property
    def plain(self) -> bool:
        """Whether it is a flat end without stages: a solid cylinder."""
        return self.id == f"R{text_of(self.radius)}L{text_of(self.length)}"

    @property
    def id(self) -> str:
        """`R6L80`: the same dimensions, the same id."""
        return written(self)

    @property
    def typed(self) -> str:
        """The word by which it was given, `D12L80`, or else its id."""
        return typed(self.id, self.name)

    def asked(self, allowance: float, clearance: float, holder: Holder | None) -> "Cutter":
        """The same, with what is asked for the whole plan where it has none of its own."""
        return replace(
            self,
            allowance=allowance if self.allowance is None and allowance else self.allowance,
            clearance=clearance if self.clearance is None and clearance else self.clearance,
            holder=self.holder or holder,
        )


def _radius(radius: float | None, diameter: float | None, of: str = "") -> float:
    if diameter is None:
        if radius is None:
            raise CutterError(f"a cutter needs its {of}radius or its {of}diameter")
        return radius
    if radius is not None:
        raise CutterError(f"{of}radius and {of}diameter of a cutter are one dimension: give one of them")
    return positive(diameter, f"cutter {of}diameter") / 2
