"""Say where the model has sharp inside edges, and what the cutter leaves there."""

from collections.abc import Iterator, Mapping

from plan_cutters.domain.figures import area, count, reported
from plan_cutters.plan_file.model import Plan

#: Pairs of faces that are named.
_PAIRS = 3


def sharp_edges(plan: Plan, names: Mapping[str, str]) -> Iterator[str]:
    """One sentence on all of them; nothing where the cutter shown leaves nothing at such edges."""
    edges = plan.sharp_edges
    if not edges or plan.shown is None:
        return
    pairs = [f"{one} meets {other}" for one, other in (each.faces for each in edges[:_PAIRS])]
    more = len(edges) - len(pairs)
    others = f" and at {count(more, 'more pair')} of faces" if more else ""
    yield (
        f"The model has sharp inside edges where {', '.join(pairs)}{others}: {names[plan.shown]} leaves a fillet of "
        f"R{reported(edges[0].radius_mm):.4g} there, {area(sum(each.area_mm2 for each in edges))}."
    )
