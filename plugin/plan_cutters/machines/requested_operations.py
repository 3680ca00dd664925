"""Which operations are planned, from what was requested of them, of the planner's own process, and of the machine."""

from collections.abc import Mapping, Sequence
from typing import Any

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.own_process import OwnProcess, cutter_of
from plan_cutters.errors import OptionError


def process_requested(value: Any) -> OwnProcess | None:
    """The planner's own process as it was requested: a file, a mapping, or None. What reads it is loaded where it is needed."""
    if value is None:
        return None
    from plan_cutters.machines.process_file import process_of

    return process_of(value)


def operations_requested(
    operations: str | None, process: OwnProcess | None, cutters: Sequence[Cutter], feeds: Mapping[Cutter, float],
    machine: Machine, setups: int,
) -> str:  # fmt: skip
    """The operations that are planned: what was requested; behind a process, else, the fastest if all have feeds.

    Parameters
    ----------
    operations : str, optional
        As requested.
    process : OwnProcess, optional
    cutters : sequence of Cutter
        All that are judged.
    feeds : mapping
        Of those that have one, mm/min.
    machine : Machine
    setups : int
        How many there may be.

    Raises
    ------
    OptionError
        The machine turns about one axis, a step is about something that there is not, or a feed is missing where time counts.
    """
    if machine.turns and machine.turning < 2:
        axes, word = "one" if machine.turning else "no", "process" if operations is None else "operations"
        raise OptionError(
            f"on machine {machine.name} {axes} rotary axis turns the tool: a plan of operations chooses the angles of two; "
            f"leave out --{word}, or name a machine that has them"
        )
    unpriced = list[str]()
    if process is not None:
        rotary = machine.rotary
        process.check(cutters, setups, (rotary[0].name, rotary[1].name) if len(rotary) == 2 else ("azimuth", "tilt"))
        named = [cutter_of(each.cutter, cutters, "process") for each in process.steps]
        unpriced = [each.typed for each in named if each not in feeds]
    chosen = operations or ("fewest" if unpriced or not feeds else "fastest")
    if chosen != "fewest" and unpriced:
        raise OptionError(f"process: {unpriced[0]} has no feed: give --feed MM/MIN, or --operations fewest")
    if chosen != "fewest" and not feeds:
        raise OptionError("the fastest operations need a feed: give --feed MM/MIN, or ask for the fewest")
    return chosen
