"""Find the changes for a step, each with the smallest value that gains nearly all that such a change can gain.

Values are those of a shop: whole steps of length and angle, sides of the part, radii that are sold. They are compared on a few of
the samples that are not reached; `steps` judges each step before it is reported.
"""

from dataclasses import replace

from plan_cutters.answers.means_place import axis, tilt_range, tolerance
from plan_cutters.answers.means_tool import corner, holder, other_cutters, radius, stick_out
from plan_cutters.answers.scan import Candidate, Scan, under
from plan_cutters.domain.machine import Machine
from plan_cutters.scene.work import Budget

#: What changes the tool alone.
_TOOLS = (stick_out, other_cutters, corner, radius, holder)
#: Changes of the tool that are looked at together with another axis.
_JOINED = 3


def candidates(scan: Scan, budget: Budget) -> tuple[list[Candidate], int]:
    """Steps that gain something of a few samples, those that may leave least first; and how many kinds were not looked at.

    Once something was found, no others are looked for when the work is spent.
    """
    result, skipped = list[Candidate](), 0
    for each in (tolerance, tilt_range, *_TOOLS, axis):
        if result and not budget.left:
            skipped += 1
        else:
            result += each(scan)
    return sorted(result, key=lambda candidate: candidate.estimate), skipped


def joined(scan: Scan) -> list[Candidate]:
    """Steps of another tool and of axes that the machine does not hold now: neither may gain anything alone."""
    state = scan.state
    conditions = state.ready.conditions
    if not conditions.machine.limited:
        return []
    free = under(state, machine=Machine())
    missed = scan.known.glance(free, scan.few)
    if not len(missed):
        return []
    result: list[Candidate] = []
    tools = [each for tool in _TOOLS for each in tool(replace(scan, state=free, left=missed, few=missed))]
    for first in sorted(tools, key=lambda each: each.estimate)[:_JOINED]:
        held = under(first.state, machine=conditions.machine)
        for second in axis(replace(scan, state=held), plain=True):
            result.append(replace(second, moves=(*first.moves, *second.moves), nested=first.nested and second.nested))
    return sorted(result, key=lambda candidate: candidate.estimate)
