"""Put proposed setups into words: they stand among the first, for all that follows is about them."""

from plan_cutters.domain.figures import listed, percent, some
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.setups import ProposedSetup


def proposal(plan: Plan) -> tuple[str, ...]:
    """Which setups were proposed, and whether their plan holds what was promised; nothing where none was requested."""
    entry = plan.setup_proposal
    if entry is None:
        return ()
    one = len(entry.setups) == 1
    where = [f"{_stands(each)}, with {axis_words(each.axis)}" for each in entry.setups]
    where[0] += " of the part along the spindle"
    text = where[0] if one else "; ".join(f"{k} {each}" for k, each in enumerate(where, 1))
    share = percent(entry.found)
    among = "Over a table and nothing else that holds the part, " + ("it reaches" if one else "they reach")
    if any(each.clamping != "table" for each in entry.setups):
        among = "So held, it reaches" if one else "So held, they reach"
    lines = [f"Proposed {'setup' if one else 'setups'}: {text}. {among} {share} of the area to machine."]
    for k, each in enumerate(entry.setups, 1):
        texts = [each.why_held] * bool(each.why_held)
        texts += [f"what it hides of {listed(left.faces)} is machined in setup {left.setup + 1}" for left in each.left_for]
        if texts:
            lines.append(f"{'Compared' if one else f'Setup {k}'}: {'; '.join(texts)}.")
    if not entry.held:
        lines.append(
            f"The proposal does not hold: the plan reaches {some(entry.kept)} of what the search promised, and no other "
            "proposal did better. Name a setup with its fixtures."
        )
    return tuple(lines)


def _stands(each: ProposedSetup) -> str:
    if each.clamping != "table":
        return f"in a {each.clamping} that grips {', '.join(each.grips)}"
    return f"on {', '.join(each.stands_on)}" if each.stands_on else "on no plane (something must hold it)"
