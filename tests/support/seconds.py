"""Where the seconds of a run of tests go: by room, by fixture, and what of them was compiling.

Seconds are added over the processes that share the tests; a fixture's seconds count in its room as well, with the test that asked
for it first.
"""

import time
from collections import defaultdict
from typing import Any

import pytest

from tests.support.places import ROOT

#: Names under which a test hands its figures to the process that prints them.
FIXTURES, COMPILE = "seconds of fixtures", "seconds of compiling"
#: How many fixtures are listed, and the least seconds of one.
LISTED, LEAST = 15, 1.0
#: A run of fewer seconds is told without tables.
SHORT = 60.0


class Seconds:
    """The plugin of the process that prints."""

    def __init__(self) -> None:
        self.rooms: dict[str, dict[str, float]] = defaultdict(lambda: defaultdict(float))
        self.fixtures: dict[str, list[float]] = defaultdict(list)

    def pytest_runtest_logreport(self, report: Any) -> None:
        room = self.rooms[report.nodeid.removeprefix("tests/").partition("/")[0]]
        room[report.when] += report.duration
        if report.when == "call":
            room["tests"] += 1
        if report.when == "teardown":
            figures = dict(report.user_properties)
            room["compile"] += figures.get(COMPILE, 0.0)
            for name, seconds in figures.get(FIXTURES, ()):
                self.fixtures[name].append(seconds)

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        if sum(map(_whole, self.rooms.values())) < SHORT:
            return
        columns = ("tests", "setup", "call", "teardown", "compile")
        terminalreporter.section("seconds by room")
        terminalreporter.line(f"{'room':14}" + "".join(f"{each:>10}" for each in columns) + f"{'seconds':>10}")
        for room, figures in sorted(self.rooms.items(), key=lambda item: -_whole(item[1])):
            row = [figures[each] for each in columns]
            terminalreporter.line(f"{room:14}" + "".join(f"{each:10.0f}" for each in row) + f"{_whole(figures):10.0f}")
        longest = sorted(((sum(each), len(each), name) for name, each in self.fixtures.items()), reverse=True)[:LISTED]
        terminalreporter.section("seconds by fixture")
        for seconds, times, name in longest:
            if seconds >= LEAST:
                terminalreporter.line(f"{seconds:8.1f}  {times:4} times  {name}")


def _whole(figures: dict[str, float]) -> float:
    return figures["setup"] + figures["call"] + figures["teardown"]


class Measures:
    """The plugin of a process that runs tests."""

    def __init__(self) -> None:
        from numba.core import event

        self._compiling = event.TimingListener()
        event.register("numba:compile", self._compiling)
        self._fixtures: list[tuple[str, float]] = []
        self._inner = 0.0

    def _compiled(self) -> float:
        """Seconds that the compiler has taken in this process so far."""
        return self._compiling.duration if self._compiling.done else 0.0

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any, request: Any) -> Any:
        """What a fixture takes, without those that it asks for itself."""
        outer, self._inner = self._inner, 0.0
        began = time.perf_counter()
        try:
            return (yield)
        finally:
            took = time.perf_counter() - began
            if fixturedef.scope != "function":
                base = str(getattr(fixturedef, "baseid", "")).removeprefix(str(ROOT)) or "conftest"
                self._fixtures.append((f"{base}::{fixturedef.argname}", took - self._inner))
            self._inner = outer + took

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Any:
        self._before = self._compiled()
        return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: Any, call: Any) -> Any:
        if call.when == "teardown":
            item.user_properties += [(FIXTURES, self._fixtures), (COMPILE, self._compiled() - self._before)]
            self._fixtures = []
        return (yield)


def register(config: Any) -> None:
    """Measure in each process that runs tests, and print in the one that was asked."""
    worker = hasattr(config, "workerinput")
    if not worker:
        config.pluginmanager.register(Seconds(), "seconds of the run")
    if worker or not getattr(config.option, "numprocesses", None):
        config.pluginmanager.register(Measures(), "seconds of a process")
