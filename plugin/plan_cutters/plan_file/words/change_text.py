"""Put changes into words: answers and next steps say the same change in the same words."""

from collections.abc import Sequence

from plan_cutters.domain.area import Patch
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import angle, listed, mm
from plan_cutters.domain.figures import area as size
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.spec import notation
from plan_cutters.domain.standard_tools import USUAL, slenderness
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


def holder(requested: Holder, now: Cutter) -> str:
    how = notation(now.name)
    return f"the holder {requested.called(how)} instead of {now.holder.called(how) if now.holder else 'none'}"


def rest(cutter: str) -> str:
    return f"{cutter} for the rest"


def clamped(axis: Sequence[float], degrees: float) -> str:
    """Say how the part is clamped for a setup axis that is so many degrees from the present one."""
    words = axis_words(axis)
    return f"turned over (setup {words})" if degrees > 179.0 else f"clamped with {words} along the spindle"


def more_setup(axis: Sequence[float], degrees: float, number: int) -> str:
    return f"{clamped(axis, degrees)} as a {_ORDER.get(number, 'further')} setup"


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


def samples(count: int) -> str:
    """Give a number of samples as the subject of a sentence and its verb."""
    return "1 sample is" if count == 1 else f"{count:,} samples are"
