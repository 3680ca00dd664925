"""Samples of the target faces, and how dense they are where nobody said: from the curvature, the smallest cutter and a budget."""

import os
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from cad_io import Orientation, Part, SurfaceSamples
from cad_io.sample import bends, sample
from plan_cutters.domain.cutter import Cutter
from plan_cutters.errors import OptionError, TooManySamplesError
from plan_cutters.options import Options

#: Spacing of samples, mm: one, by face number, or none where they are taken on a grid.
Spacing = float | dict[int, float] | None

#: Samples that a plan may take.
MOST_SAMPLES = 5_000_000
#: Environment variable by which whoever runs a service allows fewer.
MOST = "PLAN_CUTTERS_MOST_SAMPLES"
#: Samples that a default plan may take, in all.
BUDGET = 40_000
#: Share of the smallest radius, and turn of the normal (rad), between neighbouring samples.
_SHARE, _TURN = 0.25, 0.2
#: Curvature makes the spacing finer by no more than this.
_FINEST = 4.0


def default_spacing(
    part: Part, orientation: Orientation, faces: Sequence[int], cutters: Sequence[Cutter]
) -> tuple[dict[int, float], float]:
    """Spacing of each target face, mm, and how many times as coarse as it should be, for the budget.

    A quarter of the smallest cutter's radius, finer (up to four times) where the surface bends within it, coarser for
    all faces alike where the budget binds.
    """
    base = _SHARE * min(c.radius for c in cutters)
    scout = bends(part, orientation, faces, 9)
    spacing: dict[int, float] = {}
    for number in faces:
        here = np.nan_to_num(scout.get(number, np.zeros(0)))
        # A median: a point at an apex or a crease says nothing about the face.
        typical = float(np.median(here)) if len(here) else 0.0
        spacing[number] = min(base, max(base / _FINEST, _TURN / typical if typical else base))
    wanted = sum(part.faces[number - 1].area / spacing[number] ** 2 for number in faces)
    coarser = max(1.0, (wanted / BUDGET) ** 0.5)
    return {number: value * coarser for number, value in spacing.items()}, coarser


class Sampled(NamedTuple):
    """Samples, and what `Prepared` says of their spacing."""

    samples: SurfaceSamples
    spacing: Spacing
    coarser: float


def sampled(
    part: Part,
    orientation: Orientation,
    options: Options,
    faces: Sequence[int],
    cutters: Sequence[Cutter],
    at: Callable[[int], None] = lambda face: None,
) -> Sampled:
    """Sample faces as the options ask; `at` as in `sample`."""
    spacing: Spacing = options.spacing
    coarser = 1.0
    if options.grid is None and options.spacing is None:
        spacing, coarser = default_spacing(part, orientation, faces, cutters)
    return Sampled(sample(part, orientation, grid=options.grid, spacing=spacing, faces=faces, at=at), spacing, coarser)


def spacing_key(options: Options, cutters: Sequence[Cutter]) -> tuple[float | None, ...]:
    """All that samples follow from, beside the part, its faces and their sides."""
    least = min(cutter.radius for cutter in cutters) if options.grid is None and options.spacing is None else None
    return options.grid, options.spacing, least


def _most() -> int:
    """Samples that may be taken here."""
    stated = os.environ.get(MOST, "") or str(MOST_SAMPLES)
    if not stated.isdecimal():
        raise OptionError(f"{MOST} in the environment must be a whole number, not {stated!r}")
    return min(MOST_SAMPLES, int(stated))


def affordable(part: Part, faces: Sequence[int], options: Options) -> None:
    """Refuse to sample more than memory holds, before it is tried."""
    wanted, most = 0.0, _most()
    if options.grid is not None:
        wanted = len(faces) * float(options.grid) ** 2
    elif options.spacing is not None:
        wanted = sum(part.faces[n - 1].area for n in faces) / options.spacing / options.spacing
    if wanted > most:
        raise TooManySamplesError(
            f"that would take about {wanted:.2g} samples, at most {most:.0e} are taken: sample more coarsely, "
            "or choose faces with --faces",
            file=part.file,
        )
