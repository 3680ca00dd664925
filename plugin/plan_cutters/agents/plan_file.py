"""Answers to agents take these fields from a plan file. The whole model is not loaded here, for it loads the CAD kernel."""

import re

from pydantic import Field, ValidationError

from plan_cutters.agents.answers import Entry, LeastSet, Missing, Samples, Value, Witness
from plan_cutters.agents.limits import CallError
from plan_cutters.domain.spec import renamed, typed
from plan_cutters.plan_file.nearest import nearest

#: A cutter by its radius or diameter, and its length.
_PLAIN = re.compile(r"[rd][\d.]+(l[\d.]+)?")
#: The version of plan files that is understood.
_VERSION = 1


class Share(Entry):
    interference_free: float = 0.0
    accessible: float = 0.0
    inaccessible: float = 0.0
    undecided: float = 0.0
    unjudged: float = 0.0
    lost_by: dict[str, float] = Field(default={})

    @property
    def reached(self) -> float:
        return min(1.0, self.interference_free + self.accessible)

    @property
    def not_reached(self) -> float:
        return min(1.0, self.inaccessible + self.undecided)


class Counts(Entry):
    interference_free: int = 0
    accessible: int = 0
    inaccessible: int = 0
    undecided: int = 0
    unjudged: int = 0
    inside_bodies: int = 0
    area_share: Share = Share()

    @property
    def reached(self) -> int:
        return self.interference_free + self.accessible

    @property
    def not_reached(self) -> int:
        """Samples of the finished part's surface that are not reached."""
        return self.inaccessible - self.inside_bodies + self.undecided


class Move(Entry):
    thing: str


class Step(Entry):
    changes: list[Move] = Field(default=[])
    lost_before: float
    lost_after: float
    gained: int
    left: int
    option: str | None = None
    why: str


class Change(Entry):
    thing: str
    helps: bool | None = None
    asked: Value = None
    why: str
    option: str | None = None
    lost_before: float | None = None
    lost_after: float | None = None
    doubted: bool = False


class Mend(Entry):
    why: str = ""
    changes: list[Change] = Field(default=[])
    steps: list[Step] = Field(default=[])
    unsure: bool = False


class Cutter(Counts):
    id: str
    name: str = ""
    feasible: bool | None
    seen: bool = True
    faces: dict[str, Counts] = Field(default={})
    witnesses: list[Witness] = Field(default=[])
    mend: Mend | None = None


class FaceOf(Entry):
    id: str
    name: str = ""
    target: bool
    samples: int = 0
    unjudged: str | None = None


class File(Entry):
    name: str


class PartOf(Entry):
    file: str
    warnings: list[str] = Field(default=[])


class Asked(Entry):
    answers: list[str] = Field(default=[])


class Selection(Entry):
    rule: str = ""
    why: str = ""


class PlanFile(Entry):
    format: str
    format_version: int
    part: PartOf
    effective: Asked = Asked()
    samples: Samples
    faces: list[FaceOf]
    missing: list[Missing] = Field(default=[])
    reasons: list[str] = Field(default=[])
    cutters: list[Cutter] = Field(min_length=1)
    selected: str | None = None
    selected_over_setups: str | None = None
    selected_for_setup: str | None = None
    selection: Selection = Selection()
    least_set: LeastSet | None = None
    notes: list[str] = Field(default=[])
    note_codes: list[str] = Field(default=[])
    legend: dict[str, str] = Field(default={})
    legend_words: dict[str, str] = Field(default={})
    files: dict[str, File] = Field(default={})
    not_written: dict[str, str] = Field(default={})

    def worded(self, text: str) -> str:
        """A text with cutters in the words by which they were given: each of these may be given again."""
        return renamed(text, {c.id: typed(c.id, c.name) for c in self.cutters})

    @property
    def shown(self) -> str:
        """Id of the cutter that models and pictures show."""
        return self.selected or nearest(self.cutters).id


def plan_of(text: bytes | str, file: str) -> PlanFile:
    """Read a plan file; what a newer version adds is left out.

    Raises
    ------
    CallError
        It is none, or of a version that means other things.
    """
    try:
        found = PlanFile.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        raise CallError(
            f"is no plan of plan-cutters ({place + ': ' if place else ''}{first['msg']})"[:300], file=file
        ) from None
    if found.format != "plan-cutters-plan" or found.format_version != _VERSION:
        raise CallError(f"is {found.format} of version {found.format_version}; version {_VERSION} of plans is read: plan the "
                        "part again", file=file)  # fmt: skip
    return found


def cutter_of(plan: PlanFile, name: str) -> Cutter:
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
    plan_cutters.agents.limits.CallError: no cutter is called 'R3'; there is R6L80
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
        found = [id for id, label in known if test(id, label)]
        if len(found) > 1 and _PLAIN.fullmatch(text):
            # R6 says no corner radius, as R6L80 does.
            found = [id for id in found if "rc" not in id] or found
        if len(found) == 1:
            return found[0]
        if found:
            raise CallError(f"{len(found)} cutters may be meant by {name!r}: {', '.join(found[:8])}; give the whole id")
    there = ", ".join(id for id, _ in known[:8])
    more = f" and {len(known) - 8} more" if len(known) > 8 else ""
    raise CallError(f"no cutter is called {name!r}; there is {there}{more}")
