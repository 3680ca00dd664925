"""Which of my cutters can finish this surface? Cutter accessibility before any toolpath exists.

Names are handed on lazily: importing the package loads neither the CAD kernel nor the compiler.
"""

__version__ = "0.1.0"

#: The module of each name, behind `plan_cutters`.
_HOME = {
    "Cutter": ".domain.cutter",
    "Holder": ".domain.holder",
    "Segment": ".domain.holder",
    "Stage": ".domain.holder",  # its former name
    "Machine": ".domain.machine",
    "Axis": ".domain.machine",
    "Placement": ".domain.placement",
    "Fixture": ".domain.fixture",
    "Options": ".options",
    "Scene": ".scene.scene",
    "PostureRange": ".domain.posture",
    "plan": ".calls",
    "plan_many": "_batch.run",  # a package of its own
    "Result": ".result",
    "posture_map": ".calls",
    "PostureMap": ".judging.posture_maps",
    "PostureMaps": ".judging.posture_maps",
    "Plan": ".plan_file.model",
    "PlanError": ".errors",
    "CutterError": ".errors",
    "MachineError": ".errors",
    "FixtureError": ".errors",
    "LibraryError": ".errors",
    "OptionError": ".errors",
}
__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'plan_cutters' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"plan_cutters{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """All names, for completion: those that nobody has asked for yet are not in the module."""
    return sorted({*globals(), *__all__})
