"""Which of my cutters can finish this surface? Cutter accessibility before any toolpath exists.

Names are handed on lazily: importing the package loads neither the CAD kernel nor the compiler.
"""

__version__ = "0.1.0"

#: The names of each module, behind `plan_cutters`.
_NAMES = {
    ".calls": "plan posture_map",
    ".domain.cutter": "Cutter",
    ".domain.fixture": "Fixture",
    ".domain.holder": "Holder Segment",
    ".domain.machine": "Axis Machine",
    ".domain.placement": "Placement",
    ".domain.posture": "PostureRange",
    ".errors": "CutterError FixtureError LibraryError MachineError OptionError PlanError",
    ".judging.posture_maps": "PostureMap PostureMaps",
    ".options": "Options",
    ".plan_file.model": "Plan",
    ".result": "Result",
    ".scene.scene": "Scene",
    "_batch.run": "plan_many",  # a package of its own
}
_HOME = {name: module for module, names in _NAMES.items() for name in names.split()}
__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'plan_cutters' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"plan_cutters{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """All names, for completion: those that nobody has asked for yet are not in the module."""
    return sorted({*globals(), *__all__})
