"""Kernels in plain Python, with their calls counted."""

from collections import Counter
from contextlib import contextmanager
from functools import wraps

import numpy as np

from plan_cutters.kernels import material
from plan_cutters.kernels.linear import tree, vectors
from plan_cutters.kernels.maps import cuts, free_map, passes, planes
from plan_cutters.kernels.search import place, search, sweep
from plan_cutters.kernels.tool import apart, arcs, hit, pieces

MODULES = (apart, arcs, cuts, free_map, hit, material, passes, pieces, place, planes, search, sweep, tree, vectors)


@contextmanager
def counted():
    """Every kernel in plain Python and counted: yields the calls by name."""
    calls = Counter()

    def plain(name, function):
        @wraps(function)
        def call(*arguments):
            calls[name] += 1
            return function(*arguments)

        return call

    # A kernel that another module imports is found there under its name: all of them are exchanged.
    compiled = [(m, name, f) for m in MODULES for name, f in vars(m).items() if hasattr(f, "py_func")]
    try:
        for module, name, function in compiled:
            setattr(module, name, plain(name, function.py_func))
        with np.errstate(all="ignore"):
            yield calls
    finally:
        for module, name, function in compiled:
            setattr(module, name, function)
