"""Modules of the FreeCAD workbench without FreeCAD."""

import importlib
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

import pytest

#: What the modules of the workbench that are read here import of FreeCAD.
HOST = ("FreeCAD", "Part", "Import", "FreeCADGui", "MeshPart", "Mesh")


@contextmanager
def imported(name: str) -> Iterator[ModuleType]:
    """A module of the workbench, under modules of FreeCAD that have nothing; afterwards these and the workbench are gone."""
    with pytest.MonkeyPatch.context() as patch:
        for each in HOST:
            patch.setitem(sys.modules, each, ModuleType(each))
        before = {*sys.modules}
        yield importlib.import_module(name)
        # Of others, as of numba, a part cannot be imported twice.
        for each in {*sys.modules} - before:
            if each.partition(".")[0] == "freecad":
                del sys.modules[each]
