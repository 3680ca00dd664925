"""A comparison is told here, once: sentences and rows of tables, which the terminal and Markdown lay out."""

from collections import Counter
from collections.abc import Iterator

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


def headline(difference: PlanDifference) -> str:
    """One sentence on two plans."""
    if difference.same:
        return f"{difference.name}: nothing changed."
    if not difference.comparable:
        return f"{difference.name}: not comparable."
    parts = [*_counted(difference, "lost"), *_counted(difference, "won")]
    text = "; ".join(parts) if parts else "nothing lost and nothing won"
    return f"{difference.name}: {text}."


def mark_of(difference: PlanDifference) -> str:
    """A few words for what became of a part."""
    if not difference.comparable:
        return "not comparable"
    return " and ".join(word for word in ("lost", "won") if getattr(difference, word)) or "nothing lost"


def remarks(difference: PlanDifference) -> list[str]:
    """Lines before the tables: which cutter is to be taken, how faces were known again, and what
    else changed. Of plans that are not comparable nothing but the reasons is told.
    """
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
    """A change in a line."""
    return f"{each.what}: {each.old} -> {each.new}"


def face_rows(difference: PlanDifference) -> Iterator[tuple[str, ...]]:
    """A row of FACES for each face whose answer differs; none of plans that are not comparable."""
    if not difference.comparable:
        return
    for f in difference.faces:
        name = f" {f.name}" if f.name else ""
        size = "not known" if f.area_mm2 is None else area(f.area_mm2)
        yield mark(f), f"{called(f.old, f.new)}{name}", f.kind, size, _reach(f.was, "-"), _reach(f.now, "-")


def cutter_rows(difference: PlanDifference) -> Iterator[tuple[str, ...]]:
    """A row of CUTTERS for each cutter whose answer or form differs; none of plans that are not comparable."""
    if not difference.comparable:
        return
    for c in difference.cutters:
        changed = ", ".join(change(each) for each in c.changes)
        yield mark(c), c.name, _state(c.was), _state(c.now), _faces(c.faces_lost), _faces(c.faces_won), changed


def mark(each: FaceDifference | CutterDifference) -> str:
    """A word for what became of a face or cutter."""
    if each.lost and each.won:
        return "lost and won"
    if each.lost or each.won:
        return "lost" if each.lost else "won"
    return "new" if each.was is None else "gone" if each.now is None else "changed"


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
        return f"Not comparable.{_despite(comparison)}"
    if comparison.lost:
        return "Something was lost."
    return "Nothing was lost." if comparison.won else "Nothing was lost or won."


def _despite(comparison: Comparison) -> str:
    """The option that compares nevertheless, where there is one."""
    different = {each.what for plan in comparison.plans for each in plan.changes if each.hinders}
    words = ",".join(word for word in REQUESTED if word in different)
    return f" --despite {words} compares nevertheless." if words else ""


def _counted(difference: PlanDifference, word: str) -> Iterator[str]:
    for what, entries in (("face", difference.faces), ("cutter", difference.cutters)):
        number = sum(getattr(each, word) for each in entries)
        if number:
            yield f"{count(number, what)} {word}"


def _reach(state: FaceState | None, none: str) -> str:
    if state is None:
        return none
    share = f" {percent(state.share)}" if state.reach in ("partly", "undecided") else ""
    return f"{state.reach}{share}{_why(state.reason)}"


def _state(state: CutterState | None) -> str:
    return "-" if state is None else f"{_FINISHES[state.finishes]} {percent(state.share)}{_why(state.reason)}"


def _why(reason: str | None) -> str:
    if reason is None:
        return ""
    return f" ({REASONS[reason].name if reason in REASONS else reason})"


def _faces(pairs: list[tuple[str, str]]) -> str:
    return listed([called(*pair) for pair in pairs], _MOST)
