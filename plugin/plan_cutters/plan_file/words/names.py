"""How cutters are called where people read: by what they are and their diameter, in the summary, on the page and on pictures."""

import math
import re
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from plan_cutters.domain.cutter import Cutter
    from plan_cutters.plan_file.model import CutterEntry, Plan

#: Options in a text; what else has backquotes is a name that somebody gave.
_QUOTED = re.compile(r"`(--[^`]*)`")


class Line(NamedTuple):
    """A sentence or two.

    Before it stands its kind (`mark`), behind it what a person may type, as it must be typed. `minor`: only for those who ask
    for all.
    """

    text: str
    mark: str = ""
    typed: str = ""
    minor: bool = False


#: Numbers in the tool changer that are named of one cutter.
_PLACES = 3
#: What the drawer's names end in.
_BUILT_IN_MARK = ", built-in"
_END, _BALL, _BULL, _CHAMFER = "flat end", "ball end", "bull nose", "chamfer mill"
#: Flat ends with a taper from this on, deg, are chamfer mills.
_POINTED = 20.0


def kind(cutter: "Cutter | CutterEntry") -> str:
    """Give the kind of a cutter, whatever its size.

    >>> from plan_cutters.domain.cutter import Cutter
    >>> kind(Cutter.parse("D12L80rc6")), kind(Cutter.parse("D12L80"))
    ('ball end', 'flat end')
    """
    if cutter.shape != "end":
        return "form cutter" if cutter.shape == "form" else cutter.shape
    if not cutter.corner_radius:
        return _CHAMFER if _taper(cutter) >= _POINTED else _END
    return _BALL if cutter.corner_radius >= cutter.radius else _BULL


def _taper(cutter: "Cutter | CutterEntry") -> float:
    """Half of the angle of a cutter's cone, deg."""
    # Not before anything is planned: help is shown without numpy.
    from plan_cutters.domain.cutter import Cutter

    return math.degrees(cutter.taper) if isinstance(cutter, Cutter) else cutter.taper_deg


def called(cutter: "Cutter | CutterEntry", *, plainly: bool = False) -> str:
    """A cutter by its description and diameter, mm or inches as it was given: its name where a person or a library gave one.

    `plainly`: as if nobody had given a name.

    >>> from plan_cutters.domain.cutter import Cutter
    >>> called(Cutter.parse("R6L80")), called(Cutter.parse("D12L80rc1")), called(Cutter(3, 40, 3, name="Finisher"))
    ('flat end D12 x 80', 'bull nose D12 rc1 x 80', 'Finisher D6')
    >>> called(Cutter.parse("D0.5inL3inrc1/16in"))
    'bull nose D0.5in rc0.0625in x 3in'
    """
    # Not before anything is planned: help is shown without numpy.
    from plan_cutters.domain.dimensions import is_spec, notation
    from plan_cutters.domain.figures import in_inches

    # As it was typed: a D12 is called so in an inch shop, too. Tools of libraries have only names.
    name = "" if plainly and not is_spec(cutter.name) else cutter.name
    inches = notation(name).inches if not name or is_spec(name) else in_inches()

    def size(length: float, digits: int = 5) -> str:
        return f"{length / 25.4:.{digits}g}in" if inches else f"{length:.{digits}g}"

    across = size(2.0 * cutter.radius)
    name = name.removesuffix(_BUILT_IN_MARK).strip()
    if name and not is_spec(name):
        # Where the name says the diameter itself, it need not be said again.
        match = re.search(rf"(?<![\d.,]){re.escape(across)}(?![\d]|[.,]\d)", name)
        return name if match else f"{name} D{across}"
    what = kind(cutter)
    corner = f" rc{size(cutter.corner_radius, 4)}" if cutter.corner_radius and what not in (_BALL, "lollipop") else ""
    taper = _taper(cutter)
    cone = f" T{taper:.4g}" if taper else ""
    return f"{what} D{across}{corner}{cone} x {size(cutter.length)}"


def short_names(plan: "Plan") -> dict[str, str]:
    """How cutters are called in a line, by their ids, each otherwise: the shortest of what tells it apart."""
    numbers = _numbers(plan)
    ways: list[list[str]] = []
    for c in plan.cutters:
        name, head = " ".join([*numbers.get(c.id, [])[:_PLACES], called(c)]), _word(c)
        held = [f"{name}, {c.holder}"] if c.holder else []
        ways.append([name, *held, f"{name} ({head})", c.id])
    # A name that is another's id would be taken for it.
    taken = Counter(each for way in ways for each in dict.fromkeys(way))
    return {c.id: next((each for each in way if taken[each] == 1), c.id) for c, way in zip(plan.cutters, ways, strict=True)}


def _numbers(plan: "Plan") -> dict[str, list[str]]:
    """`T3` and so on, by the ids of cutters: only numbers that the libraries give to one tool."""
    mine: dict[int, set[str]] = {}
    for c in plan.cutters:
        for source in c.sources:
            if source.number is not None:
                mine.setdefault(source.number, set()).add(c.id)
    others = {tool.number for library in plan.libraries for tool in library.unused}
    by_name: dict[str, list[str]] = {}
    for c in plan.cutters:
        each = dict.fromkeys(s.number for s in c.sources if s.number is not None)
        by_name[c.id] = [f"T{number}" for number in each if len(mine[number]) == 1 and number not in others]
    return by_name


def described(entry: "CutterEntry", name: str) -> str:
    """Describe a cutter beyond its name: its kind, and how far it stands out of which holder."""
    from plan_cutters.domain.dimensions import notation
    from plan_cutters.domain.figures import INCH, in_inches

    what = called(entry, plainly=True)
    text = f"{'' if what in name else f'{what}, '}{_word(entry)}, "
    length = notation(entry.name).mm(round(entry.length, 6))
    holder = [stage for stage in entry.stages if stage.part == "holder"]
    if not holder:
        return f"{text}judged without a holder, {length} up from its tip"
    widest = 2.0 * max(max(stage.radius_mm, stage.upper_radius_mm) for stage in holder)
    wide = f"D{widest / INCH:.4g}in" if in_inches() else f"D{widest:.4g}"
    return f"{text}{length} out of its holder{f' {entry.holder}' if entry.holder else ''}, up to {wide} wide"


def _word(entry: "CutterEntry") -> str:
    """Name a cutter as it was given, so that it can be given again; else as plan and arrays call it. Its holder stands beside."""
    from plan_cutters.domain.dimensions import parted, typed

    return parted(typed(entry.id, entry.name))[0]


def named(plan: "Plan", text: str) -> str:
    """A text with cutters called as in `short_names`."""
    from plan_cutters.domain.dimensions import renamed

    return renamed(text, short_names(plan))


def typed(text: str) -> str:
    """A text with its options as one types them: in it each stands in backquotes, `--faces all`, as commands do in prose.

    >>> typed("`--faces all` of ra`w.step")
    '--faces all of ra`w.step'
    """
    return _QUOTED.sub(r"\1", text)


def as_fields(text: str) -> str:
    """A text for those who have no shell: options as the fields of the same name, which forms and agents have.

    >>> as_fields("Next: ask what would help [`--answers mend`]"), as_fields("2 fillets were not judged: `--faces all`.")
    ('Next: ask what would help [answers = mend]', '2 fillets were not judged: faces = all.')
    >>> as_fields("left 3 % [`--cutter D3L20 --holder er32`]"), as_fields("A smaller `--tolerance` decides it.")
    ('left 3 % [cutter = D3L20, holder = er32]', 'A smaller tolerance decides it.')
    """

    def fields(options: str) -> str:
        each = (option.partition(" ") for option in options.removeprefix("--").split(" --"))
        return ", ".join(" = ".join(filter(None, (name.replace("-", "_"), value))) for name, _, value in each)

    return _QUOTED.sub(lambda match: fields(match[1]), text)
