"""Two plan files, two plan folders, or two folders of many of them, paired by name."""

from collections.abc import Collection
from pathlib import Path

from plan_cutters.errors import PlanError
from plan_cutters.plan_file.load import PLAN, load_plan
from plan_cutters_ci.model import Comparison
from plan_cutters_ci.plans import SLACK, compare


def plans_in(folder: Path) -> dict[str, Path]:
    """Plan files by name: of a file or plan folder one without a name, of a folder of many theirs by their folders below it.

    Raises
    ------
    PlanError
        There is none.
    """
    if folder.is_file():
        return {"": folder}
    if not folder.exists():
        raise PlanError("no such file or folder", file=str(folder))
    if (folder / PLAN).is_file():
        return {"": folder / PLAN}
    plans = {path.parent.relative_to(folder).as_posix(): path for path in sorted(folder.rglob(PLAN)) if path.is_file()}
    # Beside an output, a run that goes on has a folder of its own whose name begins with a dot.
    plans = {name: path for name, path in plans.items() if not any(part.startswith(".") for part in name.split("/"))}
    if not plans:
        raise PlanError(f"holds no {PLAN}: give a plan, its folder, or a folder of many", file=str(folder))
    return plans


def compare_folders(old: Path, new: Path, *, slack: float = SLACK, despite: Collection[str] = ()) -> Comparison:
    """Compare all plans of two folders, or two plans; a plan that cannot be read makes them not comparable.

    Raises
    ------
    PlanError
        A side holds no plan, or one is a single plan and the other is not.
    """
    mine, theirs = plans_in(old), plans_in(new)
    if ("" in mine) != ("" in theirs):
        many, one = (new, old) if "" in mine else (old, new)
        raise PlanError(f"is a folder of many plans, and {one} is one plan: give two of one kind", file=str(many))
    pairs, unread = [], []
    for name in sorted(set(mine) & set(theirs)):
        try:
            was, now = load_plan(mine[name]), load_plan(theirs[name])
        except PlanError as fault:
            if not name:
                raise
            unread.append(str(fault))
        else:
            pairs.append(compare(was, now, name=name or now.part.file or "part", slack=slack, despite=despite))
    gone, added = sorted(set(mine) - set(theirs)), sorted(set(theirs) - set(mine))
    return Comparison(
        old=str(old), new=str(new), slack=slack, plans=pairs, unread=unread, only_old=gone, only_new=added,
        comparable=bool(pairs) and not unread and all(each.comparable for each in pairs),
        lost=bool(gone) or any(each.lost for each in pairs),
        won=bool(added) or any(each.won for each in pairs),
    )  # fmt: skip
