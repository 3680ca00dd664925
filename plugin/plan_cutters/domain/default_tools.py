"""The built-in drawer: metric end mills of usual sizes in plain holders, for a first look. They are nobody's tools."""

from functools import cache

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder, Segment

#: Radius, stick-out, flutes, corner radius of the bull nose (0: none), nose radius of the holder; mm.
_SIZES = (
    (1, 20, 6, 0, 10.5),
    (1.5, 25, 9, 0, 10.5),
    (2, 30, 12, 0.5, 10.5),
    (2.5, 35, 15, 0.5, 10.5),
    (3, 40, 15, 0.5, 10.5),
    (4, 50, 20, 1, 10.5),
    (5, 60, 25, 1, 12),
    (6, 80, 30, 1, 12),
    (8, 90, 40, 2, 13.5),
    (10, 100, 50, 2, 16.5),
    (12, 120, 60, 2, 22),
)
#: Smaller cutters stand on a shank of this radius, which begins so far below the holder, mm.
_SHANK, _STUB = 3.0, 5.0
#: Length of the holders, mm.
_HOLDER = 60.0


@cache
def builtin() -> tuple[Cutter, ...]:
    """Flat ends, bull noses and ball ends from 2 to 24 mm across, each with flutes, neck or shank, and a plain round holder."""
    cutters = []
    for radius, length, flutes, corner, nose in _SIZES:
        for name, rounding in (("flat end", 0.0), ("bull nose", corner), ("ball end", radius)):
            if name == "bull nose" and not rounding:
                continue
            neck, shank = None, float(radius)
            if radius < _SHANK:
                neck, shank = Segment(0.95 * radius, length - flutes - _STUB), _SHANK
            what = f"{name} D{2 * radius:g}" + (f" rc{rounding:g}" if name == "bull nose" else "")
            cutters.append(
                Cutter(radius, length, rounding, f"{what} x {length:g}, built-in", flutes=flutes, neck=neck, shank_radius=shank,
                       holder=Holder((Segment(nose, _HOLDER),), "plain, built-in"))
            )  # fmt: skip
    return tuple(cutters)
