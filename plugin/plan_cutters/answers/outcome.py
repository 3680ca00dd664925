"""How a change is told that does not serve."""

from plan_cutters.answers.trial import Left
from plan_cutters.domain.change import Change, Thing, Value


def none(thing: Thing, now: Value, left: int, why: str, looked: int | None = None) -> Change:
    """Nothing serves, or there is nothing to try; `looked`: samples looked at, if not all that are left."""
    return Change(
        thing, now, None, False, left, left if looked is None else looked, 0, None, None, f"does not help: {why}"
    )


def short(thing: Thing, now: Value, tried: Value, left: Left, why: str) -> Change:
    """The best value tried leaves some: proved to be out of reach, or not decided."""
    if left.count and not left.blocked:
        return Change(thing, now, tried, None, left.count, left.looked, 0, None, None, f"is not decided: {why}")
    return none(thing, now, left.count, why, left.looked)
