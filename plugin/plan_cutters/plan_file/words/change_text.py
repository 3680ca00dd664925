"""Put changes into words: what-if answers and next steps say the same change in the same words."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.area import Patch
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.spec import notation, spelled
from plan_cutters.domain.standard_tools import MOST, USUAL, slenderness
from plan_cutters.domain.verdicts import REASONS
from plan_cutters.plan_file.numbers import angle, listed, mm, percent
from plan_cutters.plan_file.numbers import area as size
from plan_cutters.plan_file.reasons import REASONS as WORDS
from plan_cutters.plan_file.words.names import kind

Range = tuple[float, float]

#: Faces that are named one by one.
_FACES = 5
_ORDER = {2: "second", 3: "third", 4: "fourth"}


def tolerance(requested: float, now: float) -> str:
    return f"a tolerance of {mm(requested)} instead of {mm(now)}"


def tilt_range(wanted: Range, now: Range) -> str:
    return f"tilts from {angle(wanted[0])} to {angle(wanted[1])} in the search instead of {angle(now[0])} to {angle(now[1])}"


def tilt_limit(requested: float, now: float | None, machine: str) -> str:
    """Name a machine that tilts further; `now` is None where rotary axes limit it, not an angle."""
    instead = f"every way instead of {machine}" if now is None else f"instead of {angle(now)}"
    return f"a machine that tilts by {angle(requested)} {instead}"


def stick_out(requested: float, now: Cutter) -> str:
    """Name a stick-out; one of more than the usual diameters says so."""
    how, ratio = notation(now.name), requested / (2.0 * now.radius)
    return f"a stick-out of {how.mm(requested)}{_ratio(ratio)} instead of {how.mm(now.length)}"


def usual(cutter: Cutter) -> str:
    """Name the longest stick-out that is usual at all."""
    return f"{notation(cutter.name).mm(2.0 * cutter.radius * MOST)} ({MOST:g} D, the most that is usual)"


def tool(cutter: Cutter) -> str:
    """Name a cutter that is sold, by kind, size and stick-out.

    >>> tool(Cutter.parse("D4L20rc2")), tool(Cutter.parse("R2L40rc0.5"))
    ('a ball end D4 held 20 mm out', 'a bull nose R2 rc0.5 held 40 mm out (10 D, more than the usual 5 D)')
    """
    how = notation(cutter.name)
    return f"a {kind(cutter)} {typed_size(cutter)} held {how.mm(cutter.length)} out{_ratio(slenderness(cutter))}"


def typed_size(cutter: Cutter) -> str:
    """The size of an end mill as it is typed, with the corner of a bull nose.

    >>> typed_size(Cutter.parse("D4L20rc2")), typed_size(Cutter.parse("R2L40rc0.5"))
    ('D4', 'R2 rc0.5')
    """
    how = notation(cutter.name)
    corner = f" rc{how.length(cutter.corner_radius)}" if kind(cutter) == "bull nose" else ""
    return f"{how.by}{how.across(cutter.radius)}{corner}"


def _ratio(ratio: float) -> str:
    return f" ({ratio:.3g} D, more than the usual {USUAL:g} D)" if ratio > USUAL * (1.0 + 1e-9) else ""


def corner_radius(requested: float, now: Cutter) -> str:
    """Name a corner radius; that of 0 is a flat end, and that of the whole radius a ball end."""
    how, ends = notation(now.name), {now.radius: "a ball end", 0.0: "a flat end"}
    wanted = ends.get(requested, f"a corner radius of {how.mm(requested)}")
    return f"{wanted} instead of {ends.get(now.corner_radius, how.mm(now.corner_radius))}"


def holder(requested: Holder, now: Cutter) -> str:
    how = notation(now.name)
    return f"the holder {requested.called(how)} instead of {now.holder.called(how) if now.holder else 'none'}"


def rest(cutter: str) -> str:
    return f"{cutter} for the rest"


def head(cutter: Cutter) -> str:
    """Name a cutter without its holder, which is that of the present one, in the notation in which that one was given."""
    return spelled(replace(cutter, holder=None))


def clamped(axis: Sequence[float], degrees: float) -> str:
    """Say how the part is clamped for a setup axis that is so many degrees from the present one."""
    words = axis_words(axis)
    return f"turned over (setup {words})" if degrees > 179.0 else f"clamped with {words} along the spindle"


def setup(axis: Sequence[float], degrees: float, flip: bool | None) -> str:
    """Name another setup axis; `flip` is None where that option stays."""
    words = f"the part clamped with {axis_words(axis)} along the spindle, {angle(degrees)} from now"
    return words if flip is None else f"{words}, {'with' if flip else 'without'} --flip"


def more_setup(axis: Sequence[float], degrees: float, number: int) -> str:
    return f"{clamped(axis, degrees)} as a {_ORDER.get(number, 'further')} setup"


def faces(ids: Sequence[str], area: float, share: float) -> str:
    """Name faces to leave out, with their area, mm2, and its share of the target area."""
    some = ", ".join(ids[:_FACES]) + " and others" * (len(ids) > _FACES)
    which = ids[0] if len(ids) == 1 else f"{len(ids)} faces ({some})"
    return f"{which} left out of what is to be finished: {size(area)}, {percent(share)} of the target area"


def patch(area: Patch) -> str:
    """An area that is lost, with its place.

    >>> patch(Patch(57.2, 0.01, 9, ("F31",), (12.0, 3.0, -8.04), 4.13))
    '57.2 mm² of F31, about (12, 3, -8.04), 4.1 mm across'
    """
    wide = f", {mm(float(f'{area.across:.2g}'))} across" if area.across else ""
    where = ", ".join(f"{round(x, 4) + 0.0:.3g}" for x in area.place)
    return f"{size(area.area)} of {listed(area.faces, _FACES)}, about ({where}){wide}"


def excluded_areas(areas: Sequence[Patch], area: float) -> str:
    """Say which connected areas to leave to another process, and how much they are in all, mm2."""
    if len(areas) == 1:
        return f"leave to another process: {patch(areas[0])}"
    return f"leave to another process: {size(area)} in {len(areas):,} places, the largest {patch(areas[0])}"


def reasons(codes: NDArray[np.uint8], of: int | None = None) -> str:
    """Say how many samples, of how many, are not reached, and why."""
    counted = [(int((codes == code).sum()), REASONS[code]) for code in np.unique(codes).tolist()]
    ranked = sorted(counted, key=lambda each: (-each[0], each[1]))
    if len(ranked) == 1:
        return f"{samples(len(codes), of)} lost to {WORDS[ranked[0][1]].noun}"
    whole = ", ".join(f"{count:,} to {WORDS[reason].noun}" for count, reason in ranked)
    return f"{samples(len(codes), of)} lost ({whole})"


def samples(count: int, of: int | None = None) -> str:
    """Give a number of samples, of those looked at if these are not all, as the subject of a sentence and its verb."""
    if of is not None:
        return f"{count:,} of {of:,} samples looked at are"
    return "1 sample is" if count == 1 else f"{count:,} samples are"
