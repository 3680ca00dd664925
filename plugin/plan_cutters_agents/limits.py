"""Limits of a call: whoever starts the server sets them, whoever calls does not."""

from dataclasses import dataclass

from plan_cutters.errors import PlanError


class CallError(PlanError):
    """A call that cannot be answered; `str` is one line about it."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Largest values of a call.

    Attributes
    ----------
    file_mb : float
        Size of a file that is read, millions of bytes.
    samples : int
        Samples of a plan, all target faces together.
    cutters : int
        Cutters of a call, those of a library included.
    seconds : float
        Of a call, by the clock, waiting for its turn included.
    characters : int
        Of an answer, as JSON. Lists are cut until it fits.
    calls : int
        That work at the same time; the others wait.
    memory_gb : float, optional
        Of each process; None: what the command takes by default.
    """

    file_mb: float = 200.0
    samples: int = 200_000
    cutters: int = 50
    seconds: float = 900.0
    characters: int = 40_000
    calls: int = 2
    memory_gb: float | None = None
