"""The sharp inside edges at which a cutter leaves a fillet become entries of the plan file here."""

from collections.abc import Sequence

import numpy as np

from cad_io.arrays import Ints, SurfaceSamples
from cad_io.part.inside_edges import InsideEdge
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fillet import least_radius
from plan_cutters.plan_file.sharp_edges import SharpEdgeEntry


def sharp_edge_entries(
    edges: Sequence[InsideEdge], strips: Ints, samples: SurfaceSamples, cutter: Cutter
) -> list[SharpEdgeEntry]:
    """Sum up the strips beside sharp inside edges by pairs of faces, the largest area first.

    Parameters
    ----------
    edges : sequence of InsideEdge
    strips : (n,) int32
        Place of the edge that loses each sample, -1 for none.
    samples : SurfaceSamples
    cutter : Cutter
    """
    radius = least_radius(cutter) or 0.0
    pairs: dict[tuple[int, int], list[int]] = {}
    for place in np.unique(strips[strips >= 0]).tolist():
        first, second = sorted(edges[place].faces)
        pairs.setdefault((first, second), []).append(place)
    entries = []
    for (first, second), places in pairs.items():
        angle = float(np.concatenate([edges[place].angle[edges[place].sharp] for place in places]).mean())
        entries.append(
            SharpEdgeEntry(
                faces=(f"F{first}", f"F{second}"),
                length_mm=sum(edges[place].length for place in places),
                angle_deg=float(np.degrees(angle)),
                radius_mm=radius,
                width_mm=radius / float(np.tan(0.5 * angle)),
                area_mm2=float(np.nansum(samples.area[np.isin(strips, places)])),
            )
        )
    return sorted(entries, key=lambda each: (-each.area_mm2, each.faces))
