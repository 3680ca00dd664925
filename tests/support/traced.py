"""What the public functions of a room return while something runs: how often each is called, and sums of what comes out.

A plan is hardly changed by a search that goes another way, and a sum of all that was found on the way is.
"""

import importlib
import pkgutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from functools import wraps
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
import pytest

#: Records are looked into so far; weights of places.
DEEP, PLACES = 3, np.cos(1.0 + np.arange(9973))


class Sums:
    """How many numbers there were, how many of them are finite, and sums of these: plain, and by their place."""

    def __init__(self) -> None:
        self.calls, self.count, self.finite, self.size, self.sum, self.by_place = 0, 0, 0, 0.0, 0.0, 0.0

    def add(self, value: np.ndarray) -> None:
        """Add numbers in their order."""
        own = np.asarray(value).astype(float).ravel()
        known = np.isfinite(own)
        # what is no number counts as one of its own: nan and both infinities differ
        own = np.where(known, own, np.where(np.isnan(own), 0.5, np.where(own > 0.0, 0.25, -0.25)))
        place = np.resize(PLACES[self.count % 997 :], len(own))
        self.count, self.finite = self.count + len(own), self.finite + int(known.sum())
        self.size, self.sum, self.by_place = self.size + np.abs(own).sum(), self.sum + own.sum(), self.by_place + own @ place

    def told(self) -> list[object]:
        """The counts, the sum of sizes, and the other sums as shares of that."""
        least = max(1.0, self.size)
        return [self.calls, self.count, self.finite, float(self.size), float(self.sum / least), float(self.by_place / least)]


def _numbers(value: Any, deep: int = 0) -> Iterator[np.ndarray]:
    """All numbers in a value, in order."""
    if isinstance(value, np.ndarray):
        if value.dtype.kind in "biuf":
            yield value
    elif isinstance(value, bool | int | float | np.generic):
        yield np.array([value], float) if not isinstance(value, np.str_) else np.zeros(1)
    elif isinstance(value, str):
        yield np.frombuffer(value.encode(), np.uint8)
    elif isinstance(value, list | tuple):
        for each in value:
            yield from _numbers(each, deep)
    elif isinstance(value, dict):
        for key in value:
            yield from _numbers(value[key], deep)
    elif is_dataclass(value) and deep < DEEP and type(value).__name__ not in ("Task", "Prepared", "SurfaceSamples", "Cutter"):
        for each in fields(value):
            yield from _numbers(getattr(value, each.name), deep + 1)
    elif type(value).__name__ == "Problem":
        yield from _numbers((value.cost, value.cutter, value.setup, value.costs), deep + 1)


def _watched(function: Any, sums: Sums) -> Any:
    @wraps(function)
    def called(*values: Any, **named: Any) -> Any:
        result = function(*values, **named)
        sums.calls += 1
        for each in _numbers(result):
            sums.add(each)
        return result

    return called


def _modules(package: ModuleType) -> list[ModuleType]:
    return [importlib.import_module(f"{package.__name__}.{each.name}") for each in pkgutil.iter_modules(package.__path__)]


@contextmanager
def traced(package: ModuleType) -> Iterator[dict[str, Sums]]:
    """Watch all public functions and methods of the modules of a package, whoever calls them."""
    seen = dict[str, Sums]()
    with pytest.MonkeyPatch.context() as patch:
        users = [each for name, each in [*sys.modules.items()] if name.startswith(package.__name__.partition(".")[0])]
        for module in _modules(package):
            short = module.__name__.rpartition(".")[2]
            for name, value in [*vars(module).items()]:
                if name.startswith("_") or getattr(value, "__module__", "") != module.__name__:
                    continue
                if isinstance(value, FunctionType):
                    sums = seen.setdefault(f"{short}.{name}", Sums())
                    instead = _watched(value, sums)
                    for user in users:
                        if vars(user).get(name) is value:
                            patch.setattr(user, name, instead)
                elif isinstance(value, type):
                    for of, method in [*vars(value).items()]:
                        if isinstance(method, FunctionType) and not of.startswith("_"):
                            patch.setattr(value, of, _watched(method, seen.setdefault(f"{short}.{name}.{of}", Sums())))
        yield seen
