"""Find the next steps for a cutter that does not finish the part, and the options that say each exactly.

The effect of each step is judged on all samples. What needs no purchase comes first, where it frees enough.
"""

import math
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from plan_cutters.answers.areas import Finished, Rows, patches
from plan_cutters.answers.means import candidates, joined
from plan_cutters.answers.state import Candidate, Everywhere, Judgements, Scan, State, move_of
from plan_cutters.domain.answer_kinds import WORTH
from plan_cutters.domain.answers import MEANS
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import is_spec, spelled, written
from plan_cutters.domain.figures import ranges
from plan_cutters.domain.standard_tools import USUAL, slenderness
from plan_cutters.errors import PlanError
from plan_cutters.option_table import ONLY
from plan_cutters.options import Options
from plan_cutters.outcome import Advice, Step
from plan_cutters.plan_file.answers import LostAreaEntry, MoveEntry, StepEntry
from plan_cutters.plan_file.words import answers as next_steps
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.faces import select_faces
from plan_cutters.scene.preparation import Axis, Prepared, places
from plan_cutters.scene.work import Budget, Progress


def option(
    ready: Prepared, cutter: Cutter, *, cutters: Sequence[Cutter], setups: Sequence[Axis] | None = None,
    conditions: Conditions | None = None, tolerance: float | None = None, faces: Sequence[int] | None = None,
) -> str | None:  # fmt: skip
    """Write the command-line options that differ from now, so that a plan has these cutters, setups and so on.

    The result is None where no option can say it. It is made to stand behind the options of now: cutters are added to them, and
    setups that they name count once. Cutters that the options name now are not repeated. Those of the default tool set are
    written, because a plan leaves them out as soon as other cutters are given.
    """
    options = ready.options
    words = [] if tuple(cutters) == (cutter,) else _more(ready, cutters)
    if words is None:
        return None
    auto = proposed(ready)
    # Options have to name the proposed setups, and a plan that is given them to find the sides that faces have now.
    if auto and (
        setups is not None or not (_files(ready) or not options.other_setups) or not ready.scene.same_sides(ready.scene.setup)
    ):
        return None
    if setups is not None:
        if options.placement is not None or any(options.other_placements):
            return None
        only = "" if setups[0] == ready.scene.setup else ONLY
        typed = [_typed(axis) for axis in setups]
        words += [word for each in (only + typed[0], *typed[1:]) for word in ("--setup", each)]
    if conditions is not None and conditions.machine != ready.conditions.machine:
        words += ["--machine", conditions.machine.name]
    if conditions is not None and conditions.postures.tilt != ready.conditions.postures.tilt:
        words += ["--tilt", ":".join(f"{round(float(np.degrees(tilt)), 6):g}" for tilt in conditions.postures.tilt)]
    if tolerance is not None:
        words += ["--tolerance", f"{tolerance:.6g}"]
    if auto and (words or faces is not None):
        # Another cutter might make `auto` choose otherwise.
        words += _pinned(ready, ready.chosen.targets if faces is None else faces)
    elif faces is not None:
        words += ["--faces", ONLY + ",".join(f"F{number}" for number in faces)]
    return " ".join(words) or None


def one_more_setup(ready: Prepared, axis: Axis) -> list[str] | None:
    """The words that ask for a further setup behind the command of a plan; None where its setups have no words.

    What is named again counts once; a setup that is named takes the place of one that is there by default.
    """
    if proposed(ready) and not _files(ready):
        return None
    files = [place.file if place else "" for place in places(ready.options)]
    typed = [file or _typed(own) for file, (own, _) in zip(files, ready.axes, strict=True)]
    return [word for each in (*typed, _typed(axis)) for word in ("--setup", each)]


def _typed(axis: Axis) -> str:
    return ",".join(f"{each:.6g}" for each in axis)


def proposed(ready: Prepared) -> bool:
    """Whether its setups were proposed."""
    place = ready.options.placement
    return place is not None and place.proposed


def _files(ready: Prepared) -> list[str]:
    """The files in which its setups will be; empty where they will be in none."""
    each = [place.file if place else "" for place in places(ready.options)]
    return each if all(each) else []


def _pinned(ready: Prepared, faces: Sequence[int]) -> list[str]:
    part = ready.scene.part
    words = [word for file in _files(ready) for word in ("--setup", shlex.quote(file))]
    if not words:
        fixtures = [word for each in ready.options.fixtures for word in ("--fixture", each.text)]
        words = ["--setup", ",".join(f"{each:.12g}" for each in ready.scene.setup), *fixtures]
    scene = ready.scene
    selected = select_faces(
        part.faces, ready.chosen.asked, tree=part.tree, ignored=scene.ignored, blends=part.blends, repeated=scene.repeated
    )
    return words if tuple(selected) == tuple(faces) else [*words, "--faces", ONLY + ranges(faces)]


def _more(ready: Prepared, cutters: Sequence[Cutter]) -> list[str] | None:
    """Name the cutters that the options do not name now; None where one has no word."""
    words, options = list[str](), ready.options
    known = {each.id for each in ready.cutters} if options.cutters or options.libraries else set()
    for each in cutters:
        if each.id in known:
            continue
        text = spoken(each, options)
        if text is None and each.id not in options.sources:
            return None
        words += [] if text is None else ["--cutter", text]
    return words


def spoken(cutter: Cutter, options: Options) -> str | None:
    """A cutter in a word that reads as itself in a plan with these options; None if no word does.

    It is in the notation in which the cutter was given, without a holder that the options say.
    """
    bare = replace(cutter, allowance=None, clearance=None)
    head = spelled(replace(bare, holder=None))
    # A holder of the table by its word.
    named = f"{head}H{cutter.holder.name.lower()}" if cutter.holder and is_spec(f"{head}H{cutter.holder.name}") else head
    for text in (head, named, spelled(bare), written(bare)):
        try:
            again = Cutter.parse(text).asked(options.allowance, options.holder_clearance, options.holder)
        except PlanError:
            continue
        if again.id == cutter.id:
            return text
    return None


#: A step, and the samples that it leaves.
Judged = tuple[Candidate, Rows]
#: A change by which it is known.
Named = tuple[str, str]

#: Steps of one change that are judged, at most; of two after each of the best so many of one, and of two at once.
_SINGLES, _PAIRS, _BEST, _JOINED = 5, 1, 2, 2
#: What frees less is no advice, mm2, nor what frees a smaller share than `WORTH`; nor a second change that frees so little more.
WORTH_AREA = 1.0
#: Of what the best step frees, the share with which another one may come before it that asks for less.
_ENOUGH = 0.5
#: Shares that differ by less are alike: what asks least comes first.
_ALIKE = 4
#: From what is there to what is bought: the drawer, time to compute, setups, how a tool is held, another tool, another machine.
NEEDS: Mapping[str, int] = {
    "tolerance": 0, "tilt_range": 0, "cutter": 0, "setup": 1, "second_setup": 1, "stick_out": 2, "holder": 2, "radius": 3,
    "corner_radius": 3, "tilt_limit": 5, "area": 5,
}  # fmt: skip
#: A tool that is held out farther than usual.
_UNUSUAL, _LAST = 4, 6
#: Areas that are told: of a cutter, of a step.
_AREAS, _REMAINS = 20, 3
#: What words of two changes may both end in.
_REST = " for the rest"
#: What of a step is not to be changed by another one.
_APART = {
    "setup": {"second_setup", "tilt_limit"},
    "second_setup": {"setup", "tilt_limit"},
    "tilt_limit": {"setup", "second_setup"},
}


def steps(
    ready: Prepared, advice: Advice, cutter: Cutter, everywhere: Everywhere, *, progress: Progress | None = None,
    budget: Budget | None = None,
) -> Advice:  # fmt: skip
    """Find what to do next, and what it gains.

    Values are compared on a few samples; each of those that may gain most is judged on all samples that are not reached and,
    where it may lose others, on all. Then a second change is looked for after the best ones.

    It has `share`, `steps` and `areas` then.

    `advice`: what was found of the cutter so far. `cutter`: one of those given. `everywhere`: what each of them reaches in each
    setup, the first one first. `budget`: the work that it may take; what promises most is judged in any case. None: as much as
    it takes.
    """
    finished, known = Finished.of(ready), Judgements.of(ready, everywhere)
    state = State.of(ready, cutter)
    open_rows = known.left(state, np.flatnonzero(finished.wanted))
    if not len(open_rows):
        return advice
    count, most = 0, _SINGLES + _PAIRS * _BEST + _JOINED

    def tell() -> None:
        nonlocal count
        count += 1
        if progress:
            progress(min(count, most), most)

    known.tell = tell
    areas = patches(ready.samples, finished, open_rows)
    scan = Scan.of(state, open_rows, finished, known, tuple(each for each in ready.cutters if each in everywhere[0]))
    # What other given cutters reach is known.
    budget = budget or Budget(math.inf)
    listed, uncompared = candidates(scan, budget)
    dear = [each for each in listed if each.moves[0].thing != "cutter"][:_SINGLES]
    chosen = [each for each in listed if each in dear or each.moves[0].thing == "cutter"]
    made = list[Judged]()
    for each in chosen:
        # What given cutters do is known.
        if made and not budget.left and each.moves[0].thing != "cutter":
            uncompared += 1
        else:
            # Judged are those that are not reached or, where the change may lose others, all.
            rows = open_rows if each.nested else np.flatnonzero(finished.wanted)
            made.append((each, known.left(each.state, rows)))
    before = finished.of_rows(open_rows)
    singles = [each for each in made if worth(finished, before - finished.of_rows(each[1]))]
    pairs = _pairs(scan, singles, budget) if budget.left else []
    base = (ready, cutter, state)
    result = [_step(base, finished, open_rows, each, rows) for each, rows in (*singles, *pairs)]
    result = in_order(result, ready.cutters)
    result.append(_excluded(base, finished, open_rows, areas))
    more = {
        "lost_share": before, "steps": [each.entry for each in result], "lost_areas": areas[:_AREAS],
        "more_lost_areas": len(areas[_AREAS:]), "uncompared": uncompared, "unsure": ready.conditions.surroundings.doubtful,
    }  # fmt: skip
    return Advice(advice.entry.model_copy(update=more), tuple(result))


def worth(finished: Finished, gain: float) -> bool:
    """Whether a gain, a share of the finished area, is advice."""
    return gain >= max(WORTH, WORTH_AREA / max(1e-300, finished.whole))


def in_order(steps: Sequence[Step], known: Sequence[Cutter]) -> list[Step]:
    """Steps in the order in which they are advised.

    First those that free at least half of what the best one frees: what is in the drawer, other setups, how a tool is held, a
    purchase, and what is unusual; within each, and of all others, those that leave least.
    """
    enough = _ENOUGH * max((_gain(step) for step in steps), default=0.0)

    def rank(step: Step) -> tuple[float, ...]:
        needs = needed(step, known) if _gain(step) >= enough else _LAST
        return needs, round(step.entry.lost_after, _ALIKE), *effort(step.entry.changes)

    return sorted(steps, key=rank)


def _gain(step: Step) -> float:
    return step.entry.lost_before - step.entry.lost_after


def needed(step: Step, known: Sequence[Cutter]) -> int:
    """How much a step needs, by its costliest change: a place in NEEDS; a tool held out farther than usual is a place, too."""
    usual = max([USUAL, *map(slenderness, known)]) * (1.0 + 1e-9)
    unusual = any(slenderness(each) > usual for each in step.cutters if each not in known)
    return max(_UNUSUAL * unusual, *(NEEDS[move.thing] for move in step.entry.changes), 0)


def effort(moves: Sequence[MoveEntry]) -> tuple[int, int]:
    """How much a step asks of a planner: the number of changes, and their places in MEANS."""
    return len(moves), sum(MEANS.index(move.thing) for move in moves)


def _pairs(scan: Scan, singles: list[Judged], budget: Budget) -> list[Judged]:
    """Two changes, where both are worth it: a second one after each of the best, and two of which neither gains much alone."""
    finished = scan.finished
    alone = {_name(each.moves[0]): finished.of_rows(rows) for each, rows in singles}
    best = sorted(singles, key=lambda each: (round(finished.of_rows(each[1]), _ALIKE), *effort(each[0].moves)))
    if best and not len(best[0][1]):
        return []
    pairs: dict[tuple[Named, ...], Judged] = {}
    tried: set[tuple[Named, ...]] = set()

    def judge(each: Candidate, rows: Rows) -> bool:
        """Keep it if it is worth it; False if it was tried before, or the work is spent."""
        name = tuple(sorted(_name(move) for move in each.moves))
        if name in tried or not budget.left:
            return False
        tried.add(name)
        still = scan.known.left(each.state, rows if each.nested else np.flatnonzero(finished.wanted))
        least = min(alone.get(_name(move), finished.of_rows(scan.left)) for move in each.moves)
        share = finished.of_rows(still)
        if worth(finished, least - share):
            pairs[name] = each, still
        return True

    started: set[str] = set()
    for first, rows in best:
        means = first.moves[0].thing
        if means in started or len(started) == _BEST:
            continue
        started.add(means)
        after = Scan.of(first.state, rows, finished, scan.known, scan.given)
        seconds = [
            replace(second, moves=(*first.moves, *second.moves))
            for second in candidates(after, budget)[0]
            if second.moves[0].thing not in {means, *_APART.get(means, ())}
        ]
        for both in seconds[:_PAIRS]:
            judge(both, rows)
    count = 0
    for both in joined(scan):
        count += judge(both, scan.left)
        if count == _JOINED:
            break
    return list(pairs.values())


def _name(move: MoveEntry) -> Named:
    return move.thing, str(move.asked)


def _step(base: tuple[Prepared, Cutter, State], finished: Finished, open_rows: Rows, candidate: Candidate, rows: Rows) -> Step:
    ready, cutter, state = base
    after = candidate.state
    result = option(
        ready, cutter, cutters=after.cutters, setups=after.axes if after.axes != state.axes else None,
        conditions=after.ready.conditions,
        tolerance=after.ready.scene.asked if after.ready.scene.asked != ready.scene.asked else None,
    )  # fmt: skip
    freed = np.setdiff1d(open_rows, rows, assume_unique=True)
    words = [each.why for each in candidate.moves]
    alike = len(words) > 1 and all(each.endswith(_REST) for each in words)
    why = " and ".join(each.removesuffix(_REST) for each in words) + _REST if alike else ", and ".join(words)
    entry = StepEntry(
        changes=list(candidate.moves), lost_before=finished.of_rows(open_rows), lost_after=finished.of_rows(rows),
        gained=len(freed), left=len(rows), cutters=[each.id for each in after.cutters], setups=list(after.axes), option=result,
        why=why, remains=patches(ready.samples, finished, rows)[:_REMAINS],
    )  # fmt: skip
    return Step(entry, after.cutters, freed)


def _excluded(base: tuple[Prepared, Cutter, State], finished: Finished, open_rows: Rows, areas: list[LostAreaEntry]) -> Step:
    """Nothing changed: what is not reached is left to other means."""
    ready, cutter, state = base
    face = ready.samples.face
    bad = np.unique(face[open_rows])
    rest = np.setdiff1d(ready.chosen.targets, bad)
    # An option leaves out whole faces alone.
    whole = len(rest) and len(open_rows) == int((finished.wanted & np.isin(face, bad)).sum())
    result = option(ready, cutter, cutters=(cutter,), faces=rest.tolist()) if whole else None
    area, share = float(finished.area[open_rows].sum()), finished.of_rows(open_rows)
    move = move_of("area", None, round(area, 6), next_steps.excluded_areas(areas, area))
    entry = StepEntry(
        changes=[move], lost_before=share, lost_after=0.0, gained=0, left=len(open_rows), cutters=[cutter.id],
        setups=list(state.axes), option=result, why=move.why, remains=areas[:_REMAINS],
    )  # fmt: skip
    return Step(entry, (cutter,), np.zeros(0, np.int64))
