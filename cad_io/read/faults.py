"""List the faults that the kernel's check finds in a loaded file, with the entity of each, and the entities that use it.

The kernel's lists give entities by number and take them by number: its Python binding loses an entity that is handed
back to it. So everything here goes by number, from 1.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from OCP.TopLoc import TopLoc_Location

_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")

_TEXT = "not a quoted String"
#: Entities to pass, one by one, in search of those that made shapes.
_MOST_STEPS = 50_000_000


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault: the number of its entity (0 where none is known), and what the kernel says."""

    number: int
    text: str

    @property
    def parameter(self) -> str:
        """Name of the entity's parameter that is wrong, empty if the fault names none."""
        match = re.search(r"\((?:\w+\.)?(\w+)\)|^Enumeration (\w+)", self.text)
        return (match[1] or match[2]) if match else ""

    @property
    def short(self) -> str:
        """Return the kernel's message without its numbering of parameters."""
        text = re.sub(r"^Parameter n\d+\.\d+ \(([\w.]+)\) ?:? ?", r"\1: ", self.text)
        text = re.sub(r", Ent\.Id\.#-?\d+ Param\.n\d+ \d+ \(Id\.(#\d+)\)", r" to \1", text)
        return text.replace("%d ", "").rstrip(".")


class Model:
    """The entities of a loaded file.

    Parameters
    ----------
    work : XSControl_WorkSession
    """

    def __init__(self, work: Any) -> None:
        self.work = work

    @cached_property
    def entities(self) -> dict[int, Any]:
        """By number. Held here, so that one entity stays one Python object."""
        model = self.work.Model()
        return {i: model.Value(i) for i in range(1, model.NbEntities() + 1)}

    def value(self, number: int) -> Any:
        """One entity."""
        return self.work.Model().Value(number)

    @cached_property
    def _numbers(self) -> dict[int, int]:
        return {id(entity): number for number, entity in self.entities.items()}

    @cached_property
    def _users(self) -> Any:
        return self.work.Graph().SharingTable()

    def number(self, entity: Any) -> int:
        """0 for what is no entity of the file."""
        return self._numbers.get(id(entity), 0)

    def users(self, number: int, stop: Callable[[Any], bool] = lambda entity: False) -> Iterator[int]:
        """The entity and all that use it, directly or not; those that use one at which to stop are left out."""
        seen, waiting = {number}, [number]
        while waiting:
            at = waiting.pop()
            yield at
            if at and not stop(self.entities[at]):
                new = set(self._users.Value(at)) - seen
                seen |= new
                waiting += new

    def faults(self) -> list[Fault]:
        """Return the faults of the model, found before anything is transferred. A missing text does not count as a fault."""
        return [fault for fault in faults_of(self.work.ModelCheckList(True), fails=True) if _TEXT not in fault.text]

    @cached_property
    def process(self) -> Any:
        """The kernel's transfer process: what became of each entity."""
        return self.work.TransferReader().TransientProcess()

    def trouble(self, *, fails: bool) -> list[Fault]:
        """Return the fails of the transfer or, if not `fails`, its warnings: entities that it repaired or doubted."""
        return faults_of(self.process.CheckList(fails), fails=fails)

    def makers(self, shapes: Mapping[int, Any]) -> dict[int, int] | None:
        """Entities from which the transfer made shapes, by the shapes' keys; None where it would take too long."""
        reader = self.work.TransferReader()
        if len(shapes) * self.process.NbMapped() > _MOST_STEPS:
            return None
        numbers = {
            key: self.number(reader.EntityFromShapeResult(shape.Located(TopLoc_Location()), 1)) for key, shape in shapes.items()
        }
        return {key: number for key, number in numbers.items() if number}

    def results(self) -> dict[int, str]:
        """Entities that the transfer gave a shape for, and the kind of shape."""
        process, result = self.process, {}
        for i in range(1, process.NbMapped() + 1):
            binder = process.MapItem(i)
            if binder is not None and binder.HasResult() and (number := self.number(process.Mapped(i))):
                result[number] = str(binder.ResultTypeName())
        return result


def faults_of(checks: Any, *, fails: bool) -> list[Fault]:
    """Fails, or else warnings, of the kernel's list of checks."""
    faults = []
    checks.Start()
    while checks.More():
        check = checks.Value()
        count, text = (check.NbFails(), check.CFail) if fails else (check.NbWarnings(), check.CWarning)
        faults += [Fault(checks.Number(), " ".join(text(i + 1).split())) for i in range(count)]
        checks.Next()
    return faults


def by_number(faults: Iterable[Fault]) -> dict[int, list[Fault]]:
    """Faults of each entity."""
    numbered: dict[int, list[Fault]] = defaultdict(list)
    for fault in faults:
        numbered[fault.number].append(fault)
    return dict(numbered)


def type_of(entity: Any) -> str:
    """A STEP entity's type as files write it: `EDGE_CURVE`."""
    return _WORD.sub("_", type(entity).__name__.split("_", 1)[-1]).upper()
