"""Rotary axes of a file that does not say which stands on which: who gives the file says so."""

from plan_cutters.domain.axis import Axis, Carried
from plan_cutters.errors import MachineError
from plan_cutters.machines import chain
from plan_cutters.machines.files import TABLE, Added


def arranged(rotary: list[Axis], added: Added, notes: list[str], who: str) -> list[Axis]:
    """Rotary axes of a file that does not say which stands on which, from the part to the tool."""
    names = [each.name.upper() for each in rotary]
    if added.order and sorted(added.order) != sorted(names):
        raise MachineError(f"#{added.text}: its rotary axes are {', '.join(names) or 'none'}")
    if len(rotary) > 1 and not added.order:
        raise MachineError(
            f"{who} does not say how its rotary axes {', '.join(names)} stand on each other: say it from the part to the "
            f"tool, as FILE#{','.join(names[::-1])}, or FILE#{names[-1]}/{names[0]} where the last carries the tool"
        )
    if rotary and not added.sign:
        notes.append("its angles are taken as those of the tool relative to the part (ISO 841), for the file does not say")
    if rotary and not added.order:
        notes.append(f"{names[0]} is taken to carry the part, which matters to linear travel alone")
    by_name = {each.name.upper(): each for each in rotary}
    part = added.part if added.order else tuple(names)
    sides: list[tuple[Carried, tuple[str, ...]]] = [("part", part), ("tool", added.tool)]
    axes = []
    for side, listed in sides:
        for axis in (by_name[name] for name in listed):
            turned = chain.opposite(axis.direction) if side == "part" and added.sign == TABLE else axis.direction
            axes.append(chain.axis(axis.name, axis.kind, side, turned, limits=axis.limits, point=axis.point, rate=axis.rate))
    return axes
