"""Setups that are proposed: ranked, then judged with a table, vise or chuck each, and kept only if the verdicts hold what was
promised."""

from collections.abc import Callable, Collection
from dataclasses import replace
from functools import partial
from typing import Any, Protocol, TypeVar

import numpy as np
from scipy.spatial import cKDTree

from plan_cutters.answers.candidates import touching
from plan_cutters.answers.holding import Held
from plan_cutters.answers.setup_ranking import Ranking, proposed
from plan_cutters.document.clock import Clock
from plan_cutters.document.notes import noted
from plan_cutters.domain.clamping import CHUCK, VISE
from plan_cutters.domain.figures import count, exact, percent
from plan_cutters.domain.fixture import TABLE
from plan_cutters.domain.placement import Placement, axis_words
from plan_cutters.domain.stock import PART, Stock
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.judged_part import Describe, Described, JudgedPart
from plan_cutters.options import Options
from plan_cutters.plan_file.frozen import Vector, filled, vector
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.part_info import HiddenFaces, ProposedSetup, SetupProposal
from plan_cutters.plan_file.words.headline import stands_in
from plan_cutters.plan_file.words.notes import setup_proposed
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.scene import Scene
from plan_cutters.setups.requested import MOST_PROPOSED

#: Proposals that are planned, at most, and the share of what was promised that a plan must hold.
_TRIES, _ENOUGH = 3, 0.99
#: An axis this near to the spindle is along it: cosine of about 2.5 deg.
_ALONG = 0.999
#: Shares of area that differ by less are equal.
_ROUNDING = 1e-9
Made = TypeVar("Made")
#: Told what makes something of verdicts, as soon as these stand.
Stand = Callable[[Callable[[], Made]], None]


class Stages(Protocol):
    """The stages that are gone through for each proposal: read and sample a part, and let a first look at it stand; judge a
    scene, and tell how its part is made of the verdicts alone.
    """

    @property
    def clock(self) -> Clock: ...
    @property
    def remark(self) -> Describe: ...

    def prepare(self, part: Any, options: Options) -> Prepared: ...

    def looked(self, ready: Prepared, options: Options) -> None: ...

    def judge(self, part: Scene, options: Options, stand: Stand[JudgedPart]) -> JudgedPart: ...


def judged_proposed(
    stages: Stages, part: Any, options: Options, folder: str = "", stand: Stand[Described] = lambda made: None
) -> Described:
    """Propose setups, the fewest of up to three that serve nearly all, and judge them.

    `part` is anything that `plan` takes; `options` have `propose`; `folder` is where the setups will be written, empty where they
    will not be. `stand` is called with what gives such a pair of the verdicts alone, as soon as those of the first proposal
    stand, in its first setup and in all.

    Returns the part in the first proposal that holds what it promised, or, where none of three does, in that which reaches most;
    and what gives a plan of it with its proposal. An OptionError where in no direction anything is within the limits or reached,
    or no proposal can be planned.
    """
    words = _words(options)
    unproposed, stock = replace(options, propose=False, fixtures=(), stock=PART), Stock.of(options.stock)
    ready = stages.prepare(part, unproposed)
    stages.looked(ready, options)
    ready = replace(ready, scene=ready.scene.for_targets(ready.chosen.targets))
    with stages.clock.stage("proposal") as tell:
        ranking, chosen = proposed(ready, MOST_PROPOSED, words, stock if stock.solid else None, tell)
    best: tuple[float, JudgedPart, Describe] | None = None
    failed, why = frozenset[int](), ""
    for tried in range(1, _TRIES + 1):
        if failed:
            with stages.clock.stage("proposal"):
                chosen = ranking.chosen_and_held(MOST_PROPOSED, failed)
        promised = np.logical_or.reduce([ranking.served(k) for k in chosen]) if chosen else np.zeros(0, bool)
        if not promised.any():
            break
        outcome = partial(_proposed, ranking=ranking, chosen=chosen, tried=tried, stages=stages)
        try:
            judged = stages.judge(
                ready.scene.turned_to(_axis(ranking, chosen[0])),
                _options(unproposed, ranking, chosen, folder),
                partial(_stand, stand, outcome) if best is None else lambda made: None,
            )
        except PlanError as error:
            why, failed = error.cause, failed | {chosen[0]}
            continue
        (reached_share, held_share, worst), describe = outcome(judged)
        if held_share >= _ENOUGH:
            return judged, describe
        if best is None or reached_share > best[0]:
            best = reached_share, judged, describe
        failed |= {worst}
    if best is not None:
        return best[1:]
    if why:
        raise OptionError(f"setup auto: no proposal can be planned: {why}")
    if ranking.refused and not any(ranking.held.values()):
        raise OptionError(f"setup auto: nothing holds the part in {len(ranking.held)} directions: {next(iter(ranking.refused))}")
    raise OptionError(
        f"setup auto: {_among(words)}, no cutter reaches any of {len(ranking.rows)} samples in the "
        f"{len(ranking.held)} best directions; name a setup with its fixtures"
    )


def _proposed(
    part: JudgedPart, ranking: Ranking, chosen: tuple[int, ...], tried: int, stages: Stages
) -> tuple[tuple[float, float, int], Describe]:
    """What a part in proposed setups reaches, as `_compared`, and what gives its plan with the proposal.

    The first setup is judged first, and may stand alone.
    """
    chosen = chosen[: len(chosen) - len(part.later)]
    reached_share, held_share, worst = _compared(part, ranking, chosen)
    left = _in_other_setups(part, ranking, chosen)
    described = partial(_described, ranking=ranking, chosen=chosen, left=left, shares=(reached_share, held_share, tried))
    return (reached_share, held_share, worst), lambda plan: stages.remark(described(plan))


def _stand(
    stand: Stand[Described], proposed: Callable[[JudgedPart], tuple[object, Describe]], made: Callable[[], JudgedPart]
) -> None:
    """Tell how the verdicts of proposed setups become a part, and how its plan is described."""

    def pair() -> Described:
        part = made()
        return part, proposed(part)[1]

    stand(pair)


def _words(options: Options) -> tuple[str, ...]:
    """What may hold the part in each setup: what was requested, or any of them."""
    if options.fixtures:
        return tuple(each.text for each in options.fixtures)
    if options.machine.chuck_axis is not None:
        return TABLE, CHUCK, VISE
    turning = [each for each in options.machine.rotary if each.carries == "part"]
    # Nobody stands a chuck along the spindle on an axis that leans.
    upright = not turning or any(abs(each.direction[2]) > _ALONG for each in turning)
    return (TABLE, VISE, CHUCK) if upright else (TABLE, VISE)


def _among(words: tuple[str, ...]) -> str:
    return "over a table" if words[0] == TABLE else f"held by {words[0]}"


def _held(ranking: Ranking, k: int) -> Held:
    held = ranking.held[k]
    assert held is not None, "what is chosen is held"
    return held


def _rests_on(ranking: Ranking, k: int) -> tuple[str, ...]:
    """Planar faces on which the part stands in a direction, on the table or in the jaws."""
    return _named({*ranking.candidates.stands_on[k], *_held(ranking, k).rests_on})


def _named(faces: Collection[int]) -> tuple[str, ...]:
    return tuple(f"F{n}" for n in sorted(faces))


def _axis(ranking: Ranking, k: int) -> Vector:
    return vector(ranking.candidates.axis[k])


def _options(options: Options, ranking: Ranking, chosen: tuple[int, ...], folder: str) -> Options:
    """The options of a plan in the chosen setups, with what holds the part in each; the scene has the unit already.

    Each setup knows the file in which it will be: advice names that.
    """
    touched = touching(ranking.ready, ranking.candidates.axis[list(chosen)])
    first, *others = (
        Placement(
            _axis(ranking, k),
            _held(ranking, k).x,
            clamped=() if _held(ranking, k).stock else _rests_on(ranking, k),
            fixtures=tuple(each for each in (_held(ranking, k).stock, _held(ranking, k).fixture) if each is not None),
            stands_on=_named({*_held(ranking, k).faces, *(ranking.candidates.stands_on[k] or below)}),
            file=f"{folder.rstrip('/')}/setup-{number}.toml" if folder else "",
            proposed=True,
        )
        for number, (k, below) in enumerate(zip(chosen, touched, strict=True), 1)
    )
    stock = _held(ranking, chosen[0]).stock
    words = PART if stock is None or stock.stock is None else stock.stock.text
    return replace(options, setup=first.z, placement=first, stock=words, other_setups=tuple(each.z for each in others),
                   other_placements=tuple(others), unit=None)  # fmt: skip


def _compared(part: JudgedPart, ranking: Ranking, chosen: tuple[int, ...]) -> tuple[float, float, int]:
    """Find the share of area that a plan reaches, the part of what was promised that it holds, and the setup that lost most."""
    samples, finished = part.ready.samples, part.ready.finished
    reached = np.logical_or.reduce([each.verdicts.reached for each in part.cutters.values()]) & finished
    whole = float(np.nansum(samples.area[finished]))
    reached_share = float(np.nansum(samples.area[reached])) / max(1e-300, whole)
    # Samples may stand elsewhere, for another tolerance is kept: the nearest one answers.
    near = cKDTree(samples.point).query(ranking.ready.samples.point[ranking.rows])[1]
    held = reached[near]
    served = np.stack([ranking.served(k) for k in chosen], axis=1)
    promised = served.any(axis=1)
    held_share = float(ranking.area[promised & held].sum()) / max(1e-300, float(ranking.area[promised].sum()))
    missed = np.asarray(ranking.area @ (served & ~held[:, None]))
    # Clamped faces are targets of the plan, too: what is clamped in all setups is not reached.
    every = reached_share > 1.0 - _ROUNDING and bool((reached == finished).all())
    return (
        exact(reached_share, some=bool(reached.any()), whole=every),
        exact(held_share, some=bool(held[promised].any()), whole=bool(held[promised].all())),
        chosen[int(missed.argmax())],
    )


def _in_other_setups(part: JudgedPart, ranking: Ranking, chosen: tuple[int, ...]) -> list[list[HiddenFaces]]:
    """Of each setup: in which others samples of the faces are served that it stands on and grips."""
    face, result = part.ready.samples.face, []
    for own, k in enumerate(chosen):
        mine = np.isin(face, [int(name[1:]) for name in (*_rests_on(ranking, k), *_named(_held(ranking, k).grips))])
        others = [other for other in range(len(chosen)) if other != own]
        served = {other: mine & np.logical_or.reduce([each.which == other for each in part.cutters.values()]) for other in others}
        left = {other: _named(np.unique(face[rows]).tolist()) for other, rows in served.items() if rows.any()}
        result.append([HiddenFaces(setup=other, faces=list(faces)) for other, faces in left.items()])
    return result


def _setup(ranking: Ranking, k: int, left: list[HiddenFaces], promised: float) -> ProposedSetup:
    held = _held(ranking, k)
    return filled(
        ProposedSetup, held, axis=_axis(ranking, k), stands_on=[] if held.stock else _rests_on(ranking, k), clamping=held.kind,
        grips=_named(held.grips), how_held=held.words, why_held=held.why, left_for=left, promised=promised,
        fixtures=[each.text for each in (held.stock, held.fixture) if each is not None], holes=ranking.drilling.get(k, 0),
    )  # fmt: skip


def _described(
    plan: Plan, *, ranking: Ranking, chosen: tuple[int, ...], left: list[list[HiddenFaces]], shares: tuple[float, float, int]
) -> Plan:
    served = np.stack([ranking.served(k) for k in chosen], axis=1)
    alone, any_of = ranking.share(served), np.asarray(served.any(axis=1))
    together = exact(float(ranking.share(any_of[:, None])[0]), some=bool(any_of.any()), whole=bool(any_of.all()))
    share, held_share, tried = shares
    setups = [_setup(ranking, k, own, min(1.0, float(each))) for k, own, each in zip(chosen, left, alone, strict=True)]
    held = held_share >= _ENOUGH
    where = [f"{axis_words(each.axis)} ({stands_in(each, 'no plane')})" for each in setups]
    of = f"{len(ranking.held)} of {len(ranking.candidates.axis)} directions searched at {len(ranking.rows)} samples"
    bored = "".join(f" Setup {n} is for {count(each.holes, 'hole')}." for n, each in enumerate(setups, 1) if each.holes)
    why = (
        f"With {of} {_among(ranking.words)}, {'this one serves' if len(setups) == 1 else 'these serve'} {percent(together)} of "
        f"the samples' area.{bored} The plan reaches {percent(share)} of the target area"
        f"{'' if held else f', and holds only {percent(held_share)} of what was promised'}."
    )
    entry = SetupProposal(setups=setups, directions=len(ranking.candidates.axis), searched=len(ranking.held),
                          samples=len(ranking.rows), promised=together, found=share, kept=held_share, held=held, tried=tried,
                          why=why)  # fmt: skip
    # Where it was placed by the search, the plan knows the jaws, and not why they are soft.
    stands = [s.model_copy(update={"soft": each.soft}) for s, each in zip(plan.process.setups, setups, strict=False)]
    process = plan.process.model_copy(update={"setups": stands})
    return noted(plan, setup_proposed(where, why), setup_proposal=entry, process=process)
