"""Built-in machines: the usual arrangements of rotary axes with usual limits. They are nobody's machines."""

import math

from plan_cutters.domain.machine import Axis, Carried, Machine

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def _rotary(name: str, carries: Carried, direction: tuple[float, float, float], low: float, high: float) -> Axis:
    limits = None if math.isinf(low) else (math.radians(low), math.radians(high))
    return Axis(name, "rotary", carries, direction, limits)


def builtin_machines() -> dict[str, Machine]:
    """By their names; angles of the tool relative to the part, degrees, in the names' order of axes."""
    inf = math.inf
    table: dict[str, tuple[Axis, ...]] = {
        "3-axis": (),
        "3+2": (_rotary("C", "part", Z, -inf, inf), _rotary("A", "part", X, -110.0, 110.0)),
        "trunnion-ac": (_rotary("C", "part", Z, -inf, inf), _rotary("A", "part", X, -30.0, 120.0)),
        "trunnion-bc": (_rotary("C", "part", Z, -inf, inf), _rotary("B", "part", Y, -110.0, 110.0)),
        "head-table-bc": (_rotary("C", "part", Z, -inf, inf), _rotary("B", "tool", Y, -100.0, 100.0)),
        "head-head-ca": (_rotary("C", "tool", Z, -360.0, 360.0), _rotary("A", "tool", X, -110.0, 110.0)),
        "nutating-bc": (_rotary("C", "part", Z, -inf, inf), _rotary("B", "tool", (0.0, 1.0, 1.0), -180.0, 180.0)),
    }
    return {name: Machine(name, axes=axes, fixed=not axes) for name, axes in table.items()}
