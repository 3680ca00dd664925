"""Which cutter a question means: by its id, its name, or the beginning of one of them."""

import re

from plan_cutters.domain.figures import listed
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters_agents.limits import CallError

#: A cutter by its radius or diameter, and its length.
_PLAIN = re.compile(r"[rd][\d.]+(l[\d.]+)?")


def cutter_of(plan: Plan, name: str) -> CutterEntry:
    """The cutter of a plan by its id, its name, or the beginning of one of them.

    Raises
    ------
    CallError
        None is meant, or several are.
    """
    mine = chosen(name, [(c.id, c.name) for c in plan.cutters])
    return next(c for c in plan.cutters if c.id == mine)


def chosen(name: str, known: list[tuple[str, str]]) -> str:
    """The one id that is meant, of (id, name); a beginning ends where no number goes on.

    >>> chosen("R6", [("R6L80", ""), ("R60L80", ""), ("R2L40", "finisher")]), chosen("finisher", [("R2L40", "finisher")])
    ('R6L80', 'R2L40')
    >>> chosen("R3", [("R6L80", "")])
    Traceback (most recent call last):
    plan_cutters_agents.limits.CallError: no cutter is called 'R3'; there is R6L80
    """
    text = name.strip().lower()

    def begins(word: str) -> bool:
        rest = word.lower()[len(text) :]
        return word.lower().startswith(text) and not (rest[:1].isdigit() or rest[:1] == ".")

    for test in (
        lambda id, label: id == name,
        lambda id, label: text in (id.lower(), label.lower()),
        lambda id, label: begins(id) or begins(label),
    ):
        matches = [id for id, label in known if test(id, label)]
        if len(matches) > 1 and _PLAIN.fullmatch(text):
            # R6 says no corner radius, as R6L80 does.
            matches = [id for id in matches if "rc" not in id] or matches
        if len(matches) == 1:
            return matches[0]
        if matches:
            raise CallError(f"{len(matches)} cutters may be meant by {name!r}: {', '.join(matches[:8])}; give the whole id")
    raise CallError(f"no cutter is called {name!r}; there is {listed([id for id, _ in known])}")
