"""Find the largest flat or ball end that reaches each sample, whatever cutters there are.

Lemmas N3 and N4 of `docs/proofs.md`.
"""

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.answers import RadiusMap, Shape
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.checks import number, shown
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import FIXTURE, INACCESSIBLE, INSIDE, JUDGED_SHARE, UNJUDGED, blank
from plan_cutters.errors import OptionError
from plan_cutters.scene.conditions import Context, contacts_of, require_finite, verdict_arrays_of
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.work import Progress, in_chunks

if TYPE_CHECKING:
    from plan_cutters.kernels.search.search import Ladder

#: Smallest radius that is looked at unless one is requested, mm; of small parts this share of the largest.
_LEAST, _SHARE = 0.1, 0.01
#: Steps and lengths over radius that can be requested.
_STEPS, _RATIOS = (0.001, 1.0), (0.1, 1000.0)
#: Radii that are tried, at most.
_MOST = 5000
_ENDS = {"flat": Cutter.flat, "ball": Cutter.ball}


def largest_radius(
    ready: Prepared, shape: Shape, *, ratio: float = 10.0, step: float = 0.02, least: float | None = None,
    most: float | None = None, progress: Progress | None = None,
) -> RadiusMap:  # fmt: skip
    """Find the largest radius that reaches each sample, under the conditions of a plan.

    Raises OptionError: an argument has no meaning, or the tolerance is too coarse for every radius asked for.

    `ready`: its cutters are not looked at; its stock allowance counts. `shape`: `flat` or `ball`: end mills without neck, shank
    and holder. `ratio`: their length over their radius; a ball's is no less than 1. `step`: by which share each radius that is
    tried is larger than the one before. `least`, `most`: radii to try, from and to, mm. The most is half the longest side of the
    part's box by default; the least is 0.1, or a hundredth of the most if that is less, or what the tolerance lets be judged if
    that is more.
    """
    from plan_cutters.kernels.search.search import largest

    cutters = _cutters(ready, shape, ratio, step, least, most)
    radii = np.array([cutter.radius for cutter in cutters])
    samples, conditions = ready.samples, ready.conditions
    judged, within, held = (samples.unjudged < 0) & ~ready.for_drills, ready.shut >= 0, ready.clamped & (ready.inside < 0)
    level, beyond, reach = np.full(len(samples), -1), np.full(len(samples), UNJUDGED, np.uint8), blank(len(samples))
    contexts = [Context.of(cutter, conditions) for cutter in cutters]
    outer_tool, inner_tool = _ladder([c.outer_tool for c in contexts]), _ladder([c.inner_tool for c in contexts])
    rows, contacts, verdicts = np.flatnonzero(judged & ~within), contacts_of(samples), verdict_arrays_of(reach)
    possible, certain = conditions.surroundings.possible.solids, conditions.surroundings.certain.solids
    require_finite(contacts, rows)

    def work(piece: NDArray[np.int64]) -> None:
        largest(piece, contacts, conditions.ranges, outer_tool, inner_tool, possible, certain, verdicts, level, beyond)

    in_chunks(work, rows, conditions.jobs, progress, fixed=True)
    beyond[judged & within], reach.reason[judged & within] = INACCESSIBLE, INSIDE
    reach.reason[judged & held] = FIXTURE
    radius = np.where(judged, np.where(level >= 0, radii[level], 0.0), np.nan)
    return RadiusMap(shape, float(ratio), float(step), float(radii[0]), float(radii[-1]), radius, beyond, reach.reason,
                     reach.axis, reach.tilt_direction, reach.tilt, reach.rotation)  # fmt: skip


def _cutters(ready: Prepared, shape: Shape, ratio: float, step: float, least: float | None, most: float | None) -> list[Cutter]:
    """The end mills to try, each larger than the one before, of which the tolerance lets something be said."""
    if shape not in _ENDS:
        raise OptionError(f"the shape of an end mill is flat or ball, not {shown(shape)}")
    ratio, step = number(ratio, "length over radius"), number(step, "step of radii")
    lowest = 1.0 if shape == "ball" else _RATIOS[0]
    if not lowest <= ratio <= _RATIOS[1]:
        raise OptionError(f"length over radius {ratio:g} of a {shape} end must lie between {lowest:g} and {_RATIOS[1]:g}")
    if not _STEPS[0] <= step <= _STEPS[1]:
        raise OptionError(f"step of radii {step:g} must lie between {_STEPS[0]:g} and {_STEPS[1]:g}")
    conditions, part = ready.conditions, ready.scene.part
    finest = conditions.tolerance / JUDGED_SHARE / min(1.0, ratio) * (1.0 + 1e-9)
    half = 0.5 * max(part.size) if most is None else number(most, "largest radius")
    first = max(min(_LEAST, _SHARE * half), finest) if least is None else number(least, "least radius")
    last = max(first, half) if most is None else half
    if not 0.0 < first <= last < math.inf:
        raise OptionError(f"radii to try, from {first:g} to {last:g} mm, must be positive and ascend", file=part.file)
    steps = int(math.log(last / first) / math.log1p(step) + 1e-9)
    if steps > _MOST:
        raise OptionError(
            f"{steps:,} radii from {first:g} to {last:g} mm are too many to try, at most {_MOST:,} are: take a larger step",
            file=part.file,
        )
    radii = [first * (1.0 + step) ** k for k in range(steps + 1)]
    made = [_ENDS[shape](radius=r, length=ratio * r).asked(ready.options.allowance, 0.0, None) for r in radii]
    cutters = [cutter for cutter in made if conditions.judges(cutter)]
    if not cutters:
        raise OptionError(
            f"the tolerance that is kept, {conditions.tolerance:g} mm, is too coarse for radii up to "
            f"{last:g} mm: take a finer one, or radii over {finest:g} mm",
            file=part.file,
        )
    return cutters


def _ladder(made: list[Assembly]) -> "Ladder":
    """Tools as the search takes them. They have as many pieces each: a tool with fewer has one of them twice."""
    from plan_cutters.kernels.search.search import Ladder

    count = max(each.piece.shape[1] for each in made)
    piece = [each.piece[:, [min(k, each.piece.shape[1] - 1) for k in range(count)]] for each in made]
    heights = (np.array([getattr(each, name) for each in made]) for name in ("reach", "inner", "end"))
    return Ladder(np.array(piece), np.array([each.mode for each in made]), *heights)
