"""A comparison is told here, once: sentences and rows of tables, which the terminal, Markdown and test cases lay out.

A test case fails where something is lost, and is an error where plans are not comparable or cannot be read, as the exit code of
`diff` says.
"""

import unicodedata
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from urllib.parse import quote

from plan_cutters.cases.files import Case
from plan_cutters.domain.figures import area, count, listed, percent
from plan_cutters.plan_file.reasons import REASONS
from plan_cutters_ci.model import (
    REQUESTED,
    Change,
    Comparison,
    CutterDifference,
    CutterState,
    FaceDifference,
    FaceState,
    PlanDifference,
)

FACES = ("", "face", "kind", "area", "was", "now")
CUTTERS = ("", "cutter", "was", "now", "faces lost", "faces won", "changed")
_FINISHES = {True: "finishes", False: "fails", None: "not sure"}
#: Names of faces in a cell, at most.
_MOST = 6
#: Rows of a table; a summary of GitHub may have one MiB.
MOST_ROWS = 100
#: What Markdown, or the HTML that it may hold, would take as its own.
_OWN = frozenset("\\`*_{}[]<>()#+!|~&@$")
#: Name of the case that is about two plans as wholes.
COMPARABLE = "comparable"


def headline(difference: PlanDifference) -> str:
    """One sentence on two plans."""
    if difference.same:
        return f"{difference.name}: nothing changed."
    if not difference.comparable:
        return f"{difference.name}: not comparable."
    parts = [
        f"{count(number, what)} {word}"
        for word in ("lost", "less", "won")
        for what, entries in (("face", difference.faces), ("cutter", difference.cutters))
        if (number := sum(each.won if word == "won" else each.lost and fall(each) == word for each in entries))
    ]
    text = "; ".join(parts) if parts else "nothing lost and nothing won"
    return f"{difference.name}: {text}."


def mark_of(difference: PlanDifference) -> str:
    """A few words for what became of a part."""
    if not difference.comparable:
        return "not comparable"
    return " and ".join(word for word in ("lost", "won") if getattr(difference, word)) or "nothing lost"


def remarks(difference: PlanDifference) -> list[str]:
    """Lines before the tables; none of plans that are not comparable, of which nothing but the reasons is told."""
    if not difference.comparable:
        return []
    lines = [choice(difference), known(difference)]
    return [*filter(None, lines), *(change(each) for each in difference.changes if not each.hinders)]


def choice(difference: PlanDifference) -> str:
    """Which cutter is to be taken, where another one was."""
    old, new = difference.selected
    return "" if old == new else f"The cutter to take was {old or 'none'} and is {new or 'none'}."


def known(difference: PlanDifference) -> str:
    """How faces were known again, where numbers did not say, and which may have moved."""
    if difference.same:
        return ""
    how = {name: number for name, number in difference.matched.items() if name != "same file"}
    sides = {"old": [f for f in difference.faces if f.new is None], "new": [f for f in difference.faces if f.old is None]}
    alone = [f"{count(len(faces), 'face')} of the {word} plan alone" for word, faces in sides.items() if faces]
    if not how and not alone:
        return ""
    old, new = (Counter((f.kind, f"{f.area_mm2:.4g}") for f in faces if f.area_mm2) for faces in sides.values())
    if alike := (old & new).total():
        alone.append(f"of these {count(alike, 'face')} with the same kind and area in both: moved or mirrored")
    text = ", ".join(f"{number} by {name}" for name, number in how.items())
    return f"Faces known again: {'; '.join([text or 'all by number', *alone])}."


def change(each: Change) -> str:
    return f"{each.what}: {each.old} -> {each.new}"


def face_rows(difference: PlanDifference) -> Iterator[tuple[str, ...]]:
    """A row of FACES for each face whose answer differs; none of plans that are not comparable."""
    if not difference.comparable:
        return
    for f in difference.faces:
        name = f" {f.name}" if f.name else ""
        size = "not known" if f.area_mm2 is None else area(f.area_mm2)
        yield mark(f), f"{called(f.old, f.new)}{name}", _formed(f), size, _reach(f.was), _reach(f.now)


def cutter_rows(difference: PlanDifference) -> Iterator[tuple[str, ...]]:
    """A row of CUTTERS for each cutter whose answer or form differs; none of plans that are not comparable."""
    if not difference.comparable:
        return
    for c in difference.cutters:
        changed = ", ".join(change(each) for each in c.changes)
        faces = (listed([called(*pair) for pair in pairs], _MOST) for pairs in (c.faces_lost, c.faces_won))
        yield mark(c), c.name, _state(c.was), _state(c.now), *faces, changed


def mark(each: FaceDifference | CutterDifference) -> str:
    """A word for what became of a face or cutter."""
    if each.lost and each.won:
        return "lost and won"
    if each.lost or each.won:
        return fall(each) if each.lost else "won"
    return "new" if each.was is None else "gone" if each.now is None else "changed"


def fall(each: FaceDifference | CutterDifference) -> str:
    """`lost` of what was reached whole or finished, and of what is new or gone; `less` of what was not, and is less by now."""
    if each.was is None or each.now is None:
        return "lost"
    whole = each.was.reach == "reached" if isinstance(each.was, FaceState) else each.was.finishes
    return "lost" if whole else "less"


def _formed(face: FaceDifference) -> str:
    """The kind of a face, and its radius where that is another one now.

    >>> face = FaceDifference(name="", kind="blend", area_mm2=None, centre_mm=None, lost=True, won=False, radius_mm=(5.0, 2.0))
    >>> _formed(face)
    'blend, R5 to R2'
    """
    if face.radius_mm is None:
        return face.kind
    return f"{face.kind}, {' to '.join(f'R{each:.4g}' for each in face.radius_mm)}"


def called(old: str | None, new: str | None) -> str:
    """Both ids of a face, one where they agree.

    >>> called("F3", "F3"), called("F3", "F4"), called(None, "F4")
    ('F3', 'F3 -> F4', 'F4')
    """
    return (new or old or "") if old is None or new is None or old == new else f"{old} -> {new}"


def apart(comparison: Comparison) -> Iterator[str]:
    """Lines on plans that were not compared."""
    yield from (f"{name}: only in {comparison.old}; it counts as lost." for name in comparison.only_old)
    yield from (f"{name}: only in {comparison.new}; it counts as won." for name in comparison.only_new)
    yield from (f"{line}." for line in comparison.unread)


def verdict(comparison: Comparison) -> str:
    """One sentence on the whole."""
    if not comparison.comparable:
        different = {each.what for plan in comparison.plans for each in plan.changes if each.hinders}
        words = ",".join(word for word in REQUESTED if word in different)
        return "Not comparable." + (f" --despite {words} compares nevertheless." if words else "")
    if comparison.lost:
        return "Something was lost."
    return "Nothing was lost." if comparison.won else "Nothing was lost or won."


def _reach(state: FaceState | None) -> str:
    if state is None:
        return "-"
    share = f" {percent(state.share)}" if state.reach in ("partly", "undecided") else ""
    return f"{state.reach}{share}{_why(state.reason)}"


def _state(state: CutterState | None) -> str:
    return "-" if state is None else f"{_FINISHES[state.finishes]} {percent(state.share)}{_why(state.reason)}"


def _why(reason: str | None) -> str:
    return "" if reason is None else f" ({REASONS[reason].name if reason in REASONS else reason})"


def markdown(comparison: Comparison, pages: Mapping[str, str] = MappingProxyType({})) -> str:
    """The comparison in Markdown: a section for each pair that differs; `pages`: paths by names of pairs, of one pair by none."""
    same = [each for each in comparison.plans if each.same]
    lines = [f"**{verdict(comparison)}**", ""]
    for each in comparison.plans:
        if not each.same:
            page = pages.get(each.name) or pages.get("")
            lines += [*section(each), *(["", page_link(page)] if page else []), ""]
    lines += [f"- {escaped(line)}" for line in apart(comparison)]
    if same:
        lines += ["", f"Nothing changed: {', '.join(escaped(each.name) for each in same)}."]
    return "\n".join(lines).rstrip() + "\n"


def section(difference: PlanDifference) -> Iterator[str]:
    """The lines of one pair of plans."""
    yield from (f"### {escaped(headline(difference))}", "")
    yield from (f"- **Not comparable:** {escaped(line)}" for line in difference.why_not)
    yield from (f"- {escaped(line)}" for line in remarks(difference))
    yield from table(FACES, face_rows(difference))
    yield from table(CUTTERS, cutter_rows(difference))


def page_link(path: str, address: str = "") -> str:
    """A link to the page of two plans, or to an address that has it.

    >>> page_link("compared/a b/review.html")
    '[Both plans side by side](compared/a%20b/review.html)'
    """
    within = f": {escaped(path)} there" if address else ""
    return f"[Both plans side by side]({address or quote(path)}){within}"


def table(names: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """A table with a blank line before it; nothing where there is no row."""
    lines = list(rows)
    if not lines:
        return
    yield from ("", f"| {' | '.join(name or ' ' for name in names)} |", f"|{' --- |' * len(names)}")
    yield from (f"| {' | '.join(escaped(cell) or ' ' for cell in row)} |" for row in lines[:MOST_ROWS])
    if len(lines) > MOST_ROWS:
        yield from ("", f"and {len(lines) - MOST_ROWS} more: `--json` has all.")


def escaped(text: str) -> str:
    r"""A text that Markdown shows as it stands; names in files may hold anything.

    >>> escaped("a|b <img>\n*c*")
    'a\\|b \\<img\\>\\\\n\\*c\\*'
    """
    plain = "".join(c.encode("unicode_escape").decode() if unicodedata.category(c)[0] == "C" else c for c in text)
    return "".join(f"\\{c}" if c in _OWN else c for c in plain)


def comparison_cases(comparison: Comparison) -> list[Case]:
    """The cases of all plans of two folders, or of two plans."""
    cases = [case for each in comparison.plans for case in difference_cases(each)]
    # Lines as the terminal has them, these first.
    gone = zip(comparison.only_old, apart(comparison), strict=False)
    cases += [Case(name, COMPARABLE, "failure", "gone", line.removeprefix(f"{name}: ")) for name, line in gone]
    cases += [Case(name, COMPARABLE) for name in comparison.only_new]
    return cases + [Case(line.partition(":")[0], COMPARABLE, "error", "unread", line) for line in comparison.unread]


def difference_cases(difference: PlanDifference) -> Iterator[Case]:
    """The cases of two plans: of those that are not comparable the reasons are all there is."""
    name = difference.name
    if not difference.comparable:
        yield Case(name, COMPARABLE, "error", "not_comparable", "; ".join(difference.why_not) or headline(difference))
        return
    yield Case(name, COMPARABLE)
    for face, (_, what, kind, size, was, now) in zip(difference.faces, face_rows(difference), strict=True):
        text = f"was {was}, now {now}" if face.was is not None else f"is new, and {now}"
        # A face that is gone and another one that is new may have one number.
        case = Case(name, f"{'new ' * (face.was is None)}face {what}")
        yield case._replace(outcome="failure", kind="lost", message=text, details=f"{kind}, {size}") if face.lost else case
    for cutter, (_, what, was, now, faces, _, changed) in zip(difference.cutters, cutter_rows(difference), strict=True):
        more = [f"{CUTTERS[4]}: {faces}"] * bool(faces) + [f"changed: {changed}"] * bool(changed)
        text = f"was {was}, now {now}"
        case = Case(name, f"cutter {what}")
        yield case._replace(outcome="failure", kind="lost", message=text, details="\n".join(more)) if cutter.lost else case
