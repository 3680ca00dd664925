"""What listens to pytest while the tests of a room run: once to note which test reaches what, then to find one that fails."""

import importlib
import os
import signal
import sys
import threading
from collections import defaultdict
from functools import cache
from itertools import chain

import pytest

from tests.support.places import PACKAGES


def seconds():
    """Processor seconds of this process and of those that it has waited for."""
    return sum(os.times()[:4])


class Reach:
    """Notes which lines of the program each test of a file runs, those of compiled functions by what calls them.

    A compiled function counts as run, with all that it calls, where a function that names it is: rather too much than too little.
    What a copy of this process runs counts, too; of a new interpreter it is noted that one was started.
    """

    def __init__(self, root, copies):
        self.root, self.copies = f"{root}{os.sep}", copies
        self.of_program = tuple(f"{self.root}{each}{os.sep}" for each in ("plugin", "cad_io"))
        self.waiting, self.codes, self.entries, self.names, self.tests = {}, [], set(), set(), {}
        self.starts = False

    def audit(self, event, values):
        """Note that a test starts an interpreter, of which nothing is seen here."""
        if event == "subprocess.Popen" and any("python" in str(each) for each in (values[0], *values[1][:1])):
            self.starts = True

    def enter(self, frame, event, _):
        waiting = self.waiting.get(id(frame.f_code))
        if waiting is None:
            code = frame.f_code
            ours = code.co_filename.startswith(self.of_program)
            # Kept with its code, so that no other one has the same place in memory.
            waiting = self.waiting[id(code)] = {line for _, _, line in code.co_lines() if line} if ours else set()
            self.codes.append((code, waiting, {*waiting}))
            if ours:
                self.run(code, code.co_firstlineno)
            if code.co_filename.startswith(self.root):
                self.calls(frame)
        return self.line if waiting else None

    def line(self, frame, event, _):
        """Note a line; a function all of whose lines have run is watched no more."""
        waiting = self.waiting.get(id(frame.f_code), ())
        if frame.f_lineno in waiting:
            self.run(frame.f_code, frame.f_lineno)
        return self.line if waiting else None

    def run(self, code, line):
        self.waiting[id(code)].discard(line)
        if os.getpid() != self.process:
            with open(self.copies, "a") as file:
                file.write(f"{code.co_filename}\t{line}\n")

    def calls(self, frame):
        """Note the compiled functions that a function names, and those in a table that it names."""
        for name in frame.f_code.co_names:
            found = frame.f_globals.get(name)
            table = found.values() if type(found) is dict else found if type(found) in (tuple, list) else ()
            self.entries |= {each for each in (found, *table) if hasattr(each, "py_func")}
            if name not in frame.f_globals:
                self.names.add(name)

    def named(self):
        """Compiled functions of the names that functions used; asked once all that they import is there."""
        found = set()
        for of, module in [*sys.modules.items()]:
            if of.partition(".")[0] in PACKAGES:
                found |= {each for key, each in vars(module).items() if key in self.names and hasattr(each, "py_func")}
        return found

    def taken(self):
        """Lines since the last call, as a number with a bit for each in each module, and the compiled functions called."""
        seen = {(code.co_filename, line) for code, waiting, every in self.codes for line in every - waiting}
        if os.path.exists(self.copies):
            with open(self.copies) as file:
                seen |= {(path, int(line)) for path, line in (row.rstrip("\n").split("\t") for row in file)}
            os.remove(self.copies)
        lines, starts, self.starts = defaultdict(int), self.starts, False
        named = {_name(each): _reached(each) for each in self.entries | self.named()}
        for path, line in chain(seen, *named.values()):
            if path.startswith(self.of_program):
                lines[path.removeprefix(self.root)] |= 1 << line
        for each in (self.waiting, self.entries, self.names, self.codes):
            each.clear()
        return {"lines": {path: f"{each:x}" for path, each in lines.items()}, "entries": sorted(named), "starts": starts}

    def pytest_sessionstart(self):
        self.process = os.getpid()
        sys.addaudithook(self.audit)
        sys.settrace(self.enter)
        threading.settrace(self.enter)

    def pytest_collection_finish(self):
        self.tests[""] = {**self.taken(), "seconds": 0.0}

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        began = seconds()
        try:
            return (yield)
        finally:
            self.tests[item.nodeid] = {"seconds": round(seconds() - began, 3), **self.tests.get(item.nodeid, {}), **self.taken()}

    def pytest_runtest_logreport(self, report):
        if report.failed:
            self.tests.setdefault(report.nodeid, {})["failed"] = True


@cache
def _reached(entry):
    """Lines of a compiled function and of all those that it names."""
    found, waiting = {}, [entry.py_func]
    while waiting:
        function = waiting.pop()
        code = function.__code__
        if code not in found:
            found[code] = {(code.co_filename, line) for _, _, line in code.co_lines() if line}
            named = [function.__globals__.get(name) for name in code.co_names]
            named += [getattr(each, name, None) for each in named for name in code.co_names if hasattr(each, "__spec__")]
            named += [cell.cell_contents for cell in function.__closure__ or ()]
            waiting += [each.py_func for each in named if hasattr(each, "py_func")]
    return frozenset().union(*found.values())


def _name(entry):
    return f"{entry.py_func.__module__}.{entry.py_func.__qualname__}"


class Verdict:
    """Runs tests in an order, up to the first that fails, each for its time at most, and notes which one that was.

    A test that takes longer ends the process by a signal.
    """

    def __init__(self, order, left_out, limits, file, most=float("inf"), only=False):
        self.only = only
        self.ends, self.count = seconds() + most, 0
        self.order = {test: k for k, test in enumerate(order)}
        self.left_out, self.limits, self.file = left_out, limits, file

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items):
        items[:] = [item for item in items if item.nodeid not in self.left_out and (item.nodeid in self.order or not self.only)]
        items.sort(key=lambda item: self.order.get(item.nodeid, len(self.order)))

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item):
        if seconds() > self.ends:
            return True  # as if it had run
        self.count += 1
        self.file.write_text(f"{item.nodeid} ({self.count}.)")
        signal.setitimer(signal.ITIMER_PROF, self.limits.get(item.nodeid, max(self.limits.values(), default=60.0)))
        return None

    def pytest_runtest_logfinish(self):
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def preload():
    """Import what is not ours, once for all processes that begin as copies of this one."""
    for name in ("numba", "OCP.BRepMesh", "pydantic", "scipy.optimize", "scipy.spatial", "shapely", "trimesh"):
        importlib.import_module(name)
