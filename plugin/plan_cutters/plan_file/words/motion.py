"""Put into words how few orientations there can be whatever the axes."""

from collections.abc import Iterator

from plan_cutters.plan_file.operations import FewestEntry


def whatever_the_axes(few: FewestEntry) -> Iterator[str]:
    """Say the bound over all axes where it tells something: two at least, and no less than half of what was found."""
    if few.at_least_any < 2 or 2 * few.at_least_any < few.found:
        return
    if few.at_least_any >= few.found:
        yield f"No other axes do with fewer than {few.found} either, candidates or not."
    else:
        yield f"Whatever the axes, no fewer than {few.at_least_any} orientations do."
