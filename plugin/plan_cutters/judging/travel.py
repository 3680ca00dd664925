"""Where the linear axes stand at the postures found."""

from collections.abc import Mapping

from cad_io import SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.travel import Travel, tips, travel, unjudged
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.options import Options


def travels(options: Options, samples: SurfaceSamples, reaches: Mapping[Cutter, Verdicts]) -> dict[str, Travel]:
    """By the id of a cutter where the linear axes stand; empty where that is not judged."""
    placement = options.placement
    if placement is None or unjudged(options.machine, placement) is not None:
        return {}
    return {
        cutter.id: travel(
            options.machine, placement, tips(cutter, samples.point, samples.normal, reach), reach.axis, cutter.length
        )
        for cutter, reach in reaches.items()
    }
