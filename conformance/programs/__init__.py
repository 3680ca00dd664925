"""Programs that can be scored: an adapter each. Only `plan_cutters` and those beside it import the product.

A new program is a module with a class `Program` (`protocol.Program`, or `protocol.Claimer`) and a line in `MODULES`.
"""

from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from conformance.programs.protocol import Unavailable

#: Name of a program: module, class, what it is.
MODULES = {
    "plan-cutters": ("plan_cutters", "PointMaps", "plan-cutters, posture maps of single points"),
    "plan-cutters-maps": ("plan_cutters_claims", "Maps", "plan-cutters, posture maps beside a plan: postures of its own"),
    "plan-cutters-plans": ("plan_cutters_claims", "Plans", "plan-cutters, the posture that a plan names at each sample: postures of its own"),
    "plan-cutters-check": ("plan_cutters_check", "Program", "plan-cutters, the checker of its plans: the exact surfaces, another tool and search"),
    "fcl": ("fcl", "Program", "python-fcl: collision of triangle meshes"),
    "embree": ("embree", "Program", "embreex: rays along the outline of the tool"),
    "trimesh": ("trimesh_", "Program", "trimesh: points of the tool's skin within the part's mesh"),
    "opencamlib": ("opencamlib", "Program", "opencamlib: drop cutter, three axes"),
    "naive": ("naive", "Program", "points of the surface in the tool, on a grid of its parameters"),
    "undecided": ("undecided", "Program", "says undecided everywhere: scores nothing"),
}

#: Module and what to install, of each program that needs a library.
NEEDS = {
    "plan-cutters": [("plan_cutters", "plan-cutters")],
    "plan-cutters-maps": [("plan_cutters", "plan-cutters")],
    "plan-cutters-plans": [("plan_cutters", "plan-cutters")],
    "plan-cutters-check": [("plan_cutters_check", "plan-cutters")],
    "fcl": [("fcl", "python-fcl"), ("OCP", "cadquery-ocp")],
    "embree": [("embreex", "embreex"), ("OCP", "cadquery-ocp")],
    "trimesh": [("trimesh", "trimesh embreex"), ("embreex", "trimesh embreex"), ("OCP", "cadquery-ocp")],
    "opencamlib": [("opencamlib", "opencamlib"), ("OCP", "cadquery-ocp")],
    "naive": [("OCP", "cadquery-ocp")],
}


def program(name: str) -> Any:
    """Return a program by its name.

    Raises
    ------
    ValueError
        No program has that name.
    Unavailable
        A library is not installed.
    """
    if name not in MODULES:
        raise ValueError(f"no program is called {name!r}: choose one of {', '.join(MODULES)}")
    module, made, _ = MODULES[name]
    for library, install in NEEDS.get(name, ()):
        needs(library, install)
    return getattr(import_module(f"conformance.programs.{module}"), made)()


def needs(module: str, install: str) -> Any:
    """Import a library, or say in one line what to install."""
    try:
        return import_module(module)
    except ImportError as error:
        raise Unavailable(f"{module} cannot be imported ({error}): pip install {install}") from None


def versions(libraries: tuple[str, ...]) -> dict[str, str]:
    """Return the versions of installed distributions."""
    out = {}
    for name in libraries:
        try:
            out[name] = version(name)
        except PackageNotFoundError:
            out[name] = "not installed as a package"
    return out
