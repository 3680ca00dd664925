"""How a share is written, the one form for all who write one: it is not rounded up to all, nor down to nothing."""

import math

#: Shares of less than this are what rounding leaves of nothing.
_ROUNDING = 1e-9


def percent(share: float, *, some: bool | None = None, whole: bool | None = None) -> str:
    """Write a share, 0 to 1, in percent: 100 only where it is the whole, and 0 only where there is nothing of it.

    Parameters
    ----------
    share : float
        Of an area or a number; sums of areas may be off by rounding.
    some, whole : bool, optional
        Whether there is anything of it, and whether it is all, where samples were counted; default by the share itself.

    Examples
    --------
    >>> percent(0.00001), percent(0.9996), percent(1.0, whole=False)
    ('<0.1 %', '>99.9 %', '>99.9 %')
    >>> percent(0.5), percent(0.0), percent(1.0), percent(0.0, some=True), percent(float("nan"))
    ('50 %', '0 %', '100 %', '<0.1 %', 'not known')
    """
    if share >= 1.0 if whole is None else whole:
        return "100 %"
    if not math.isfinite(share):
        return "not known"
    if share < _ROUNDING and not (share > 0.0 if some is None else some):
        return "0 %"
    text = f"{100.0 * min(1.0, max(0.0, share)):.1f}"
    return {"0.0": "<0.1 %", "100.0": ">99.9 %"}.get(text, f"{text.removesuffix('.0')} %")


def exact(share: float, *, some: bool, whole: bool) -> float:
    """Give a share that is 1 only where it is the whole, and 0 only where there is nothing of it, as samples were counted.

    Sums of areas are rounded, and samples may stand for no area.

    >>> exact(1.0, some=True, whole=False) < 1.0, exact(0.0, some=True, whole=False) > 0.0, exact(0.999, some=True, whole=True)
    (True, True, 1.0)
    """
    if whole or not some:
        return 1.0 if whole else 0.0
    return min(max(share, math.ulp(0.0)), math.nextafter(1.0, 0.0))


def bound(share: float) -> str:
    """Write a share that is not to be less, in percent: rounded up to a tenth; of a ratio it may be more than all.

    >>> bound(0.98301), bound(0.75), bound(1.246), bound(0.0)
    ('98.4 %', '75 %', '124.6 %', '0 %')
    """
    return f"{math.ceil(1000.0 * share - _ROUNDING) / 10.0:g} %"
