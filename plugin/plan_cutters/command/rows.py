"""Tables of the summary: a row for each cutter, and the worst faces of one; lists where a terminal is too narrow for them."""

from collections.abc import Mapping, Sequence
from io import StringIO
from typing import TYPE_CHECKING, Any

from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from plan_cutters.command.terminal import clean, console
from plan_cutters.document.told import figure, part_of
from plan_cutters.document.told import worst_faces as most_lost

if TYPE_CHECKING:
    from plan_cutters.document.model import CutterEntry, Plan
    from plan_cutters.document.shares import AreaShare, Verdicts
    from plan_cutters.document.told import WorstFace

#: Verdicts, what a column calls them.
WORDS = {
    "interference_free": "free",
    "accessible": "accessible",
    "undecided": "undecided",
    "inaccessible": "inaccessible",
}
#: Rows that are shown unless all are asked for, and faces.
MOST_ROWS, WORST = 40, 5
#: Widest that the name of a cutter is shown beside its numbers.
_NAME = 22
_WORDS = {True: "yes", False: "no", None: "undecided"}
_COLOURS = {True: "green", False: "red", None: "yellow"}


def cell(text: str, style: str = "") -> Text:
    """A text from a file, for a table or a paragraph."""
    return Text(clean(text), style)


def percents(counts: "Verdicts", share: "AreaShare") -> dict[str, str]:
    """Each verdict's share of the area, as it is shown."""
    return {word: part_of(counts, share, [word]) for word in WORDS}


def shown(plan: "Plan") -> "CutterEntry":
    """The cutter that the models show: the selected, else the one that reaches the most samples."""
    best = max(plan.cutters, key=lambda c: c.interference_free + c.accessible)
    return next((c for c in plan.cutters if c.id == plan.selected), best)


def cutter_rows(plan: "Plan", names: Mapping[str, str], *, verbose: bool) -> list[Any]:
    """A row for each cutter, of many the best alone, and how many more there are."""
    taken, rows = take(plan), list(plan.cutters)
    if not verbose and len(rows) > MOST_ROWS:
        rank = sorted(rows, key=lambda c: (c.id != taken, c.area_share.inaccessible + c.area_share.undecided))
        kept = {c.id for c in rank[:MOST_ROWS]}
        rows = [c for c in rows if c.id in kept]
    here = f", over {1 + len(plan.effective.other_setups)} setups" if plan.effective.other_setups else ""
    found: list[Any] = [f"Share of the area to machine, by the verdict of its samples{here}:"]
    short = _distinct([clean(names[c.id]) for c in rows], _NAME)
    table = _table(("  cutter", "feasible"), tuple(WORDS.values()))
    for c, name in zip(rows, short, strict=True):
        mine = percents(c, c.area_share)
        table.add_row(Text(f"{'>' if c.id == taken else ' '} {name}", "bold" if c.id == taken else ""),
                      Text(_WORDS[c.feasible], _COLOURS[c.feasible]), *(mine[word] for word in WORDS))  # fmt: skip
    found += [table] if _fits(table) else [_listed(c, names[c.id], c.id == taken) for c in rows]
    if len(rows) < len(plan.cutters):
        found.append(f"  and {len(plan.cutters) - len(rows)} more cutters that reach less: -v or plan.json.")
    return found


def take(plan: "Plan") -> str | None:
    """Id of the cutter that the first line says to take."""
    return plan.selected or plan.selected_over_setups or plan.selected_for_setup


def _listed(c: "CutterEntry", name: str, taken: bool) -> Text:
    mine = percents(c, c.area_share)
    said = ", ".join(f"{word} {mine[key]}" for key, word in WORDS.items() if mine[key] != "0 %")
    return Text.assemble(cell(f"{'>' if taken else ' '} {name}: ", "bold" if taken else ""),
                         (_WORDS[c.feasible], _COLOURS[c.feasible]), f"; {said}")  # fmt: skip


def worst_faces(plan: "Plan", name: str) -> list[Any]:
    """Where the cutter shown fails: the faces on which it leaves the most area."""
    c = shown(plan)
    worst, count = most_lost(plan, c, WORST)
    if not worst:
        return []
    which = (
        f"the {len(worst)} worst of {count} faces" if count > len(worst) else f"{count} face{'s' if count > 1 else ''}"
    )
    lines: list[Any] = [cell(f"Where {name} {'fails' if c.blocked else 'is not sure'}, {which}:")]
    rows = [_row(figure(each.area), each) for each in worst]
    table = _table(("  face", "mainly", "in the way"), ("mm2 lost", "of the face", "mm too deep"))
    for face, area, share, reason, depth, obstacle in rows:
        table.add_row(f"  {face}", reason, cell(_distinct([obstacle], _NAME)[0]), area, share, depth)
    return [*lines, table] if _fits(table) else [*lines, *(cell(_said(*row)) for row in rows)]


def _table(words: Sequence[str], numbers: Sequence[str]) -> Table:
    """An empty table without lines: columns of words, then of numbers."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for name in (*words, *numbers):
        table.add_column(name, justify="right" if name in numbers else "left", no_wrap=True)
    return table


def _fits(table: Table) -> bool:
    """Whether a terminal has room for all of a table."""
    page = console(StringIO())
    return Measurement.get(page, page.options.update_width(1000), table).maximum <= page.width


def _said(face: str, area: str, share: str, reason: str, depth: str, obstacle: str) -> str:
    """A face in a line."""
    deep = f", {depth} mm too deep" if depth != "-" else ""
    way = f", {obstacle} in the way" if obstacle != "-" else ""
    return f"  {face}: {area} mm2 lost, {share} of the face, mainly {reason}{deep}{way}"


def _row(area: str, found: "WorstFace") -> tuple[str, str, str, str, str, str]:
    """Face, area that is lost, its share of the face, main reason, depth, what is in the way."""
    deepest = found.witness
    depth = "-" if deepest is None or deepest.depth_mm is None else f"{deepest.depth_mm:.3g}"
    way = "-" if deepest is None or deepest.obstacle_face is None else deepest.obstacle_face
    reason = found.reason.replace("_", " ") or "?"
    return found.face.id, area, found.share, f"undecided: {reason}" if found.undecided else reason, depth, way


def _distinct(names: Sequence[str], most: int) -> list[str]:
    """Names no longer than `most`, each still another one's: the middle is left out, or a number tells them apart.

    Examples
    --------
    >>> _distinct(["R6L80", "a long ball nose R3", "a long ball nose R4"], 13)
    ['R6L80', 'a lon...se R3', 'a lon...se R4']
    """
    short = [name if len(name) <= most else f"{name[: (most - 2) // 2]}...{name[-(most - 3) // 2 :]}" for name in names]
    return [
        text if short.count(text) == 1 or names[i] == text else f"{text[: most - len(str(i)) - 2]}#{i + 1}"
        for i, text in enumerate(short)
    ]
