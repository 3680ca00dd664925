"""Holders from a script: a body of revolution, or a profile of one, becomes stages that enclose it."""

import math
from collections.abc import Sequence
from typing import Any

from plan_cutters.domain.checks import flag, number, numbers, shown
from plan_cutters.domain.figures import mm
from plan_cutters.domain.holder import Holder, enclosing_segments
from plan_cutters.errors import CutterError

#: Axes by their letters.
_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
#: Stages of a holder: a cutter may have 62 pieces in all, of which a stage takes up to four.
_MOST = 12


def holder(
    source: Any, *, axis: str | Sequence[Sequence[float]] = "z", enclose: bool = False, tolerance: float = 0.02, name: str = ""
) -> Holder:
    """A holder that encloses a body of revolution. It is never smaller than the body; bores and undercuts count as filled.

    Parameters
    ----------
    source
        A kernel shape, a CadQuery or build123d object, or a list of such. A planar face, sketch or wire in a plane through the
        axis is turned about it.
    axis
        `x`, `y` or `z`, or a point and a direction. It points from the nose of the holder, where the cutter sticks out, to the
        spindle; the nose is the lowest point along it. `-z` points the other way.
    enclose
        Take what is no body of revolution, too (flats, keyways, screws), as the body that it sweeps when it turns.
    tolerance
        How far out curved outlines may become stages, mm. Cylinders and cones stay as they are. It is doubled until there are at
        most 12 stages; the name says so.

    Raises
    ------
    OptionError
        The axis or the tolerance has no meaning; CutterError: it is no body of revolution about the axis.
    CadIoError
        It holds no shape, or a profile that lies in no plane through the axis.

    Examples
    --------
    >>> import cadquery
    >>> holder(cadquery.Workplane().circle(15).extrude(30).faces(">Z").circle(20).extrude(40)).id
    'R15L30+R20L40'
    """
    from cad_io.read.objects import turned_part
    from cad_io.tessellate.meridian import meridian

    origin, direction = _axis(axis)
    wanted = number(tolerance, "tolerance")
    if not 1e-4 <= wanted <= 10.0:
        raise CutterError(f"a holder's tolerance must lie between 0.0001 and 10 mm, not {wanted:g}")
    part = turned_part(source, origin, direction)
    outline = meridian(part, origin, direction, 0.5 * wanted)
    if outline.loose and not flag(enclose, "enclose"):
        faces = ", ".join(f"F{n}" for n in outline.loose[:5]) + (" and more" if len(outline.loose) > 5 else "")
        raise CutterError(
            f"the holder is no body of revolution about its axis ({faces}): give its axis, or enclose=True for what it sweeps "
            "when it turns"
        )
    stages, exact = enclosing_segments(outline.line, outline.exact, outline.foot, tolerance=0.5 * wanted, most=_MOST)
    notes = ["what it sweeps when it turns"] if outline.loose else []
    if exact > wanted:
        notes.append(f"in {len(stages)} stages, about {mm(exact + outline.off)} larger than modelled")
    words = " ".join(filter(None, (name, f"({', '.join(notes)})" if notes else "")))
    return Holder(stages, words)


def _axis(axis: Any) -> tuple[list[float], list[float]]:
    if isinstance(axis, str):
        letter = axis.strip().lower()
        sign = -1.0 if letter.startswith("-") else 1.0
        if letter.lstrip("+-") not in _AXES:
            raise CutterError(f"a holder's axis is x, y, z, or a point and a direction, not {shown(axis)}")
        return [0.0, 0.0, 0.0], [sign * each for each in _AXES[letter.lstrip("+-")]]
    try:
        origin, direction = axis
    except (TypeError, ValueError):
        raise CutterError(f"a holder's axis is x, y, z, or a point and a direction, not {shown(axis)}") from None
    base, along = numbers(origin, "a point of the axis", 3), numbers(direction, "a direction of the axis", 3)
    if not (any(along) and all(map(math.isfinite, (*base, *along)))):
        raise CutterError("a holder's axis must be finite numbers, and its direction not 0,0,0")
    return list(base), list(along)
