"""How options, a part and a cluster come to the command in a worker's child: in a file that its parent names, not in words.

Only the `Assignment` names it, for a pickle must come from nobody but ourselves.
"""

import copy
import functools
import pickle
from dataclasses import dataclass
from typing import TYPE_CHECKING

from plan_cutters.workers.assignment import assignment

if TYPE_CHECKING:
    from plan_cutters.options import Options


@dataclass(frozen=True)
class Offer:
    """An offer is what a task of a batch offers to the process that plans its part.

    Attributes
    ----------
    scheduler : str
        Address.
    turn : str
        One part of a worker has it at a time: memory of a worker is not for several large parts.
    said : str
        The file that says to the task that the offer is taken: it gives its place at the worker to another part.
    """

    scheduler: str
    turn: str
    said: str


@dataclass(frozen=True)
class JobInput:
    """The content of the file.

    Attributes
    ----------
    options, part : bytes, optional
        Pickled; None where the words of the command have them. To unpickle a part loads the CAD kernel.
    offer : Offer, optional
        The cluster that is lent to the process.
    key : bytes, optional
        Of kept verdicts.
    """

    options: bytes | None = None
    part: bytes | None = None
    offer: Offer | None = None
    key: bytes | None = None


def job_input() -> JobInput:
    """Return what was handed to this process: nothing where no batch has started it."""
    file = assignment().job
    return JobInput() if file is None else _read(file)


def default_density(options: "Options") -> "Options":
    """The same options with the default density of samples, in place of a spacing or a grid: a copy past the checks."""
    made = copy.copy(options)
    for word in ("spacing", "grid"):
        object.__setattr__(made, word, None)
    return made


@functools.cache
def _read(file: str) -> JobInput:
    with open(file, "rb") as opened:
        result: JobInput = pickle.load(opened)
    return result
