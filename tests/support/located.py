"""A choice of operations with what it costs and what no choice costs less than."""

from dataclasses import dataclass

from plan_cutters.operations.fastest import bounded


@dataclass(frozen=True, eq=False)
class Location:
    chosen: object
    cost: float
    bound: float


def located(problem, chosen):
    return Location(chosen, problem.turned(chosen), bounded(problem, chosen))
