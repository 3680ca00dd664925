"""Which setups are worth planning: directions of the part, ranked by what a machine could hold there over a table, and what holds
the part best in each: a table, a vise or a chuck, by what cutters reach among each.

First a bound that is cheap and sees no obstacle but the table: at which samples does the machine hold any tool axis at which a
cutter touches, whose upper end is above the plane that the part stands on? Then, for the few best, a search on some samples among
the part alone, with tools that are nowhere below that plane. In those that are chosen, the real table is tried, and a vise and a
chuck as well. It promises; the plan of that setup decides.
"""

from collections.abc import Sequence
from contextlib import suppress
from copy import copy
from dataclasses import dataclass, field, fields, replace
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.answers.candidates import SAME, Candidates
from plan_cutters.answers.holding import EVEN, GRIPPED_FOR, Held, best_hold, held_by
from plan_cutters.answers.hole_setups import for_holes
from plan_cutters.answers.least_set import cover
from plan_cutters.answers.serving import bound_of, reached_by, usual_of
from plan_cutters.domain.clamping import CHUCK, GRIP, VISE
from plan_cutters.domain.figures import area
from plan_cutters.domain.fixture import TABLE, Fixture
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.posture import direction_of
from plan_cutters.domain.stock import LONG, USUAL, Stock, deep_in
from plan_cutters.errors import OptionError
from plan_cutters.judging.judge import GroundDigests
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.holes import made_of
from plan_cutters.scene.preparation import Axis, Prepared
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.scene.work import Progress, evenly
from plan_cutters.setups.clamping import NothingToGripError
from plan_cutters.setups.places import LIES
from plan_cutters.setups.requested import MOST_PROPOSED

Rows = NDArray[np.int64]
Table = NDArray[np.bool_]

#: Samples on which directions are compared, at most; directions that are searched, for the first setup and for each more.
COMPARED, _FIRST, _MORE = 400, 10, 6
#: Directions in which one would stand the part are searched, too, at most so many; and another one is taken for this share of the
#: area and more.
_STOOD, _TURNED_FOR = 2, 0.02
#: Where a tool is found below the table, postures that lean so far from the setup axis at most are tried, rad.
_UPRIGHT = float(np.radians(60.0))
#: A setup in which the part does not stand by itself counts so much in a search; one that needs a nest is taken where the others
#: serve less than this share of what it serves, or leave so much of the area to it.
_UNSTEADY, _SOFT, _NEST_FOR = 0.75, 0.5, 0.02
#: Share of the area that a setup has to serve alone: of a few hundred samples one or two may be served by chance.
_CLAMPED_FOR = 0.005
#: Directions at right angles: cosine at most.
_ACROSS = 1e-6


def _untold(done: int, total: int) -> None:
    """Nobody waits for it."""


@dataclass(slots=True)
class Ranking:
    """The ranking keeps what is known of each direction; it grows as directions are searched."""

    ready: Prepared  #: In any setup, without fixtures.
    candidates: Candidates
    rows: Rows  #: (r,) int64: samples on which directions are compared.
    #: (r,) bool: where a posture was found without table and machine: what the part itself is in the way of is not searched again
    #: in each direction.
    free: NDArray[np.bool_]
    #: (r, m) bool: those of them where the machine holds an axis over the table at all, and the face is not stood on.
    bound: Table
    #: (r,) bool: where cutters that finish surfaces serve without table and machine: there no engraving, chamfer or form cutter
    #: makes a setup look better than it is.
    usual: NDArray[np.bool_]
    #: What may hold the part: `table`, and the words of vises and chucks. Directions are searched with the first of them.
    words: tuple[str, ...] = (TABLE,)
    held: dict[int, Held | None] = field(default_factory=dict)  #: By candidate that was searched; None where it cannot be held.
    #: Candidates for which all words were tried; of the others over a table it is not known yet where that lies.
    settled: set[int] = field(default_factory=set)
    refused: dict[str, None] = field(default_factory=dict)  #: Why nothing holds it in directions searched, the first cause first.
    stock: Stock | None = None  #: What the first setup grips; None: the part.
    stocked: dict[int, Held | None] = field(default_factory=dict)  #: By candidate whose stock is gripped: how it was searched.
    gripped: dict[int, bool] = field(default_factory=dict)  #: By candidate: a vise or chuck holds it as it is.
    #: By candidate that was chosen for holes alone: how many drills make there, and in none of those before it.
    drilling: dict[int, int] = field(default_factory=dict)
    progress: Progress = _untold

    @classmethod
    def of(cls, ready: Prepared, words: tuple[str, ...] = (TABLE,), stock: Stock | None = None) -> "Ranking":
        """Rank the directions of a part by the bound; `words` and `stock` as the attributes.

        Raises OptionError: in no direction does the machine hold any axis at which a cutter touches.
        """
        candidates = Candidates.of(ready)
        open_ = np.flatnonzero(ready.somewhere)
        rows = evenly(open_, COMPARED)
        few = ready.conditions
        bound = np.zeros((len(rows), len(candidates.axis)), bool)
        for k in range(len(candidates.axis)):
            bound[:, k] = bound_of(ready, candidates, rows, k, words[0])
        if not bound.any():
            low, high = np.degrees(few.postures.tilt)
            raise OptionError(
                f"setup auto: in none of {len(candidates.axis)} directions does machine {few.machine.name} hold an axis "
                f"at which a cutter touches with tilts from {low:g} to {high:g} deg; give other tilts or machine"
            )
        surroundings = few.surroundings.alone or few.surroundings
        bare = replace(few.without_machine(), surroundings=surroundings)
        free = usual = reached_by(ready, rows, bare, usual=True)
        if len(usual_of(ready.cutters)) < len(ready.cutters):
            free = usual | reached_by(ready, rows[~usual[rows]], bare, usual=False)
        every = free[rows] if free.any() else np.ones(len(rows), bool)
        ranking = cls(ready, candidates, rows, every, bound & every[:, None], usual[rows], words, stock=stock)
        for k in range(len(candidates.axis)):
            if ranking.lying(k):
                ranking.bound[:, k] = every
        return ranking

    @property
    def area(self) -> Floats:
        """The area that each of the rows stands for, (r,)."""
        return np.nan_to_num(self.ready.samples.area[self.rows])

    def share(self, table: Table) -> Floats:
        """The share of area of some columns (r, k): (k,)."""
        return np.asarray(self.area @ table / max(1e-300, float(self.area.sum())))

    def search(self, open_rows: NDArray[np.bool_], most: int) -> None:
        """Search the directions that may serve most of what is left (r,), at most so many, while they may beat what was found."""
        firm = [each.firm or bool(self.lying(k)) for k, each in enumerate(self.candidates.bearing)]
        worth = np.where(firm, 1.0, _UNSTEADY)
        upper = worth * self.share(self.bound & open_rows[:, None])
        order = np.lexsort((np.arange(len(upper)), -np.round(upper / EVEN)))
        best, tried = 0.0, 0
        for k in order.tolist():
            if tried == most or upper[k] <= best + 0.5 * EVEN:
                break
            tried += k not in self.held
            best = max(best, float(worth[k] * self.share((self._searched(k) & open_rows)[:, None])[0]))

    def search_stood(self) -> None:
        """Search the directions in which one would stand the part if nothing speaks against it, and turn it over then."""
        flat = [k for k, planes in enumerate(self.candidates.stands_on) if planes and self.bound[:, k].any()]
        for k in self.candidates.preferred(flat)[:_STOOD]:
            for each in (k, self.opposite(k)):
                if each is not None:
                    self._searched(each)

    def opposite(self, k: int) -> int | None:
        """The direction opposite to a candidate; None where it is no candidate, or nothing is served there."""
        cosine = self.candidates.axis @ self.candidates.axis[k]
        other = int(cosine.argmin())
        return other if cosine[other] <= -SAME and self.bound[:, other].any() else None

    def steady(self, k: int) -> bool:
        """Whether something holds the part in a direction that was searched without soft jaws or a nest."""
        held = self.held[k]
        if held is None or not held.soft:
            return held is not None
        if k not in self.gripped:
            self.gripped[k] = False
            for word in self.words[1:] if self.over_table and k not in self.settled else ():
                for fixture, _ in self._fixtures(k, word):
                    with suppress(NothingToGripError):
                        stands = fixture.stands_along(direction_of(self.candidates.axis[k]))
                        self.gripped[k] |= not self.ready.scene.hold(fixture, stands).soft
        return self.gripped[k]

    def _searched(self, k: int) -> NDArray[np.bool_]:
        """Where any cutter has a posture in a direction, of the rows (r,); nowhere if nothing can hold the part."""
        if k not in self.held:
            self.progress(len(self.held), _FIRST + _STOOD + (MOST_PROPOSED - 1) * _MORE)
            try:
                self.held[k] = self._on_plane(k) if self.over_table else self._held_by(k, self.words[0], self.bound[:, k])
            except NothingToGripError as error:
                self.held[k] = None
                self.refused[error.cause] = None
        return self.served(k)

    def served(self, k: int) -> NDArray[np.bool_]:
        """Where a posture was found in a direction that was searched, (r,)."""
        held = self.held[k]
        return np.zeros(len(self.rows), bool) if held is None else held.served

    def settle(self, chosen: Sequence[int]) -> None:
        """Try in directions that were chosen whatever may hold the part, and take what holds it best; in the first one its stock
        is gripped."""
        # In another proposal it may come later: there what is finished is gripped.
        for k in [k for k in self.stocked if (k,) != tuple(chosen[:1])]:
            self._without_stock(k)
        if chosen and self.stock is not None and chosen[0] not in self.stocked:
            self._settle_stock(chosen[0])
        done = np.zeros(len(self.rows), bool)
        for number, k in enumerate(chosen):
            self._settle(k, ~done if number else None)
            done |= self.served(k)

    def _without_stock(self, k: int) -> None:
        """Hold a direction as it was searched, if its stock was gripped."""
        if k in self.stocked:
            self.held[k] = self.stocked.pop(k)
            self.settled.discard(k)

    def _settle(self, k: int, open_rows: NDArray[np.bool_] | None = None) -> None:
        """Try in a direction whatever may hold the part, unless that was done before; `open_rows` as for `_held_by`."""
        # What was searched with a vise or chuck is known with it; a table was only a plane.
        words = self.words if self.over_table else self.words[1:]
        if k in self.settled or not words:
            return
        self.settled.add(k)
        tried, refused = [held for held in [self.held[k]] if held is not None and not self.over_table], {}
        for word in words:
            try:
                bound = self.free & bound_of(self.ready, self.candidates, self.rows, k, word)
                tried.append(self._held_by(k, word, bound, open_rows=open_rows))
            except NothingToGripError as error:
                refused[word] = error.why
        usual = CHUCK if self.candidates.bearing[k].round or self.lying(k) else VISE
        self.held[k] = best_hold(tried, refused, self.area, open_rows, usual) if len(self.words) > 1 else tried[0]

    def _settle_stock(self, k: int) -> None:
        """Grip the stock in a direction, if plain jaws can, and what is below the part keeps tools off little of it; stock that a
        person named, wherever jaws can.
        """
        assert self.stock is not None, "without stock the part is gripped"
        tall, most, best, best_share = self.candidates.tall[k], float(self.share(self.served(k)[:, None])[0]), None, 0.0
        for stock in self.stock.choices(tall, round_=self.candidates.bearing[k].round or bool(self.lying(k))):
            for word in [each for each in self.words if each != TABLE]:
                with suppress(NothingToGripError):
                    # Beside what stands below the part a tool may be lower than it.
                    bound = self.free & bound_of(self.ready, self.candidates, self.rows, k, word)
                    held = self._held_by(k, word, bound, stock)
                    share = float(self.share(held.served[:, None])[0])
                    if not held.soft and share >= best_share + _TURNED_FOR:
                        best, best_share = held, share
            if best_share >= most - _TURNED_FOR:
                break
        if best is not None and (self.stock.kind != USUAL or best_share >= GRIPPED_FOR * most):
            self.stocked[k], self.held[k] = self.held[k], best
            self.settled.add(k)

    def completed(self, chosen: tuple[int, ...], most: int) -> tuple[int, ...]:
        """Chosen directions, held as they are by now, and those that serve more of what these do not."""
        failed, over = frozenset[int](), self.opposite(chosen[0]) if chosen else None
        if over is not None:
            self._searched(over)
            if self._turned(chosen):
                self._settle(over, ~self.served(chosen[0]))
        while 0 < len(chosen) < most:
            open_rows = ~np.logical_or.reduce([self.served(k) for k in chosen])
            others = [k for k in self.candidates.preferred(list(self.held)) if k not in (*chosen, *failed)]
            gain = self.share(np.stack([self.served(k) & open_rows for k in others], axis=1)) if others else np.zeros(0)
            worth = [(k, g) for k, g in zip(others, gain, strict=True) if g >= (_CLAMPED_FOR if self.steady(k) else _NEST_FOR)]
            if not worth:
                break
            more = max(worth, key=lambda each: (self.steady(each[0]), round(each[1] / EVEN), each[0] == over))[0]
            self._settle(more, open_rows)
            if float(self.share((self.served(more) & open_rows)[:, None])[0]) >= _CLAMPED_FOR:
                chosen = (*chosen, more)
            else:
                failed |= {more}
        return chosen

    def _turned(self, chosen: Sequence[int]) -> bool:
        """Whether the first of some directions has its part in a chuck that a rotary axis turns."""
        first = self.held[chosen[0]] if chosen else None
        return first is not None and first.x is not None

    @property
    def over_table(self) -> bool:
        """Whether directions are searched over a table."""
        return self.words[0] == TABLE

    def _on_plane(self, k: int) -> Held:
        """The part over a table that is only a plane: none of the obstacles is made anew."""
        few = self.ready.conditions
        part = replace(few, setup=self.candidates.axis[k], x=None, surroundings=few.surroundings.alone or few.surroundings)
        table = Fixture.each_of(TABLE)[0]
        if lying := self.lying(k):
            # Below it there is no table, and one end is in the chuck.
            reached = self._over(replace(part, x=np.array(lying[0][1])), np.ones(len(self.rows), bool))
            ends = [np.isin(self.ready.samples.face[self.rows], self._ends(fixture)) for fixture, _ in lying]
            return Held(table, max((reached & ~end for end in ends), key=lambda served: float(self.area @ served)))
        limit = _UPRIGHT if part.machine.tilt_limit is None else min(_UPRIGHT, part.machine.tilt_limit)
        leaning, above = replace(part, machine=replace(part.machine, tilt_limit=limit)), float(self.candidates.lowest[k])
        reached = self._over(part, self.bound[:, k], above)
        return Held(table, reached | self._over(leaning, self.bound[:, k] & ~reached, above), soft=self._stands_soft(k))

    def _over(self, conditions: Conditions, open_rows: NDArray[np.bool_], above: float | None = None) -> NDArray[np.bool_]:
        """Where a cutter has a posture under some conditions, of some rows (r,), and nothing of it is below a height, mm."""
        reached = np.zeros(len(self.ready.samples), bool)
        for usual in (True, False):
            reached |= reached_by(self.ready, self.rows[open_rows & (self.usual == usual)], conditions, usual=usual, above=above)
        return reached[self.rows]

    def _ends(self, fixture: Fixture) -> tuple[int, ...]:
        """Planes at the end of the part that a chuck is to hold."""
        along = self.candidates.axis @ np.array(fixture.up)
        return self.candidates.stands_on[int(along.argmax())]

    def _stands_soft(self, k: int) -> str:
        """Why a part that lies on a table in a direction needs a nest; empty where it stands by itself."""
        mine = self.candidates.bearing[k]
        if mine.firm:
            return ""
        on = f"{area(mine.area)} that it stands on" if mine.broad else f"it stands on {area(mine.area)}"
        return f"{on} do not carry it" if mine.broad else on

    def _held_by(
        self, k: int, word: str, bound: NDArray[np.bool_], stock: Stock | None = None, open_rows: NDArray[np.bool_] | None = None
    ) -> Held:
        """Hold the part, or its stock, in a direction by what a word says; of several ways that which serves most of some rows
        (r,), of all by default."""
        ways, wanted = list[Held](), self.area if open_rows is None else self.area * open_rows
        why = f"nothing round lies across the setup axis {axis_words(self.candidates.axis[k])}"
        error = NothingToGripError(f"{word}: {why}")
        error.why = why
        for fixture, turned in self._fixtures(k, word):
            try:
                ways.append(self._held_in(k, fixture, turned, bound if turned is None else self.free, stock))
            except NothingToGripError as refused:
                error = refused
        if not ways:
            raise error
        best = max(ways, key=lambda each: (not each.soft, float(wanted @ each.served)))
        if word in (VISE, CHUCK) and stock is None and open_rows is not None and best.x is None and not best.soft:
            # What an earlier setup has finished is gripped as deep as stock is, a hub half its diameter, if that hides nothing
            # that is left.
            clamping, deep = best.fixture.clamping, deep_in(self.candidates.tall[k])
            hub = min(0.5 * clamping.numbers[-1], LIES) if word == CHUCK and clamping is not None else 0.0
            least = float(wanted @ best.served) - EVEN * float(self.area.sum())
            for grip in sorted({deep, max(deep, hub)} - {GRIP}, reverse=True):
                with suppress(NothingToGripError):
                    deeper = self._held_in(k, Fixture.parse(f"{word}:{grip:g}"), None, bound, None)
                    if not deeper.soft and deeper.grips == best.grips and float(wanted @ deeper.served) >= least:
                        return deeper
        return best

    def _fixtures(self, k: int, word: str) -> list[tuple[Fixture, Axis | None]]:
        """What a word may be in a direction, each with the part's direction along the machine's X; None: any.

        Along a rotary axis across the spindle the part lies in a chuck, one way or the other, where it is round and longest.
        """
        fixture, along = Fixture.parse(word), self.ready.conditions.machine.chuck_axis
        if fixture.kind != CHUCK or along is None:
            return [(fixture, None)]
        axis, tall, requested = self.candidates.axis, self.candidates.tall, len(self.words) == 1
        across = np.flatnonzero(np.abs(axis @ axis[k]) < _ACROSS).tolist()
        # A bar in it may be about a long part that is not round, as a camshaft; who asks for a chuck lays any part in it so.
        bearing, stock = self.candidates.bearing, self.stock is not None
        turned = self.candidates.turned
        long = [j for j in across if bearing[j].round or (stock and (requested or tall[j] >= LONG * bearing[j].wide))]
        across = [j for j in across if j in turned] if turned else long
        least = max(0.0 if requested or turned else tall[k], (1.0 - EVEN) * max(tall[across], default=0.0))
        lying = [(axis[j], along[0] * axis[j] - along[1] * np.cross(axis[k], axis[j])) for j in across if tall[j] >= least]
        return [(replace(fixture, up=direction_of(up)), direction_of(x)) for up, x in lying]

    def lying(self, k: int) -> list[tuple[Fixture, Axis | None]]:
        """The chucks in which the part may lie along a rotary axis, in a direction; none where it would stand in them."""
        if self.ready.conditions.machine.chuck_axis is None:
            return []
        chuck = next((each for each in self.words if Fixture.parse(each).kind == CHUCK), None)
        return [] if chuck is None else self._fixtures(k, chuck)

    def _held_in(self, k: int, fixture: Fixture, turned: Axis | None, bound: NDArray[np.bool_], stock: Stock | None) -> Held:
        axis, x = self.candidates.axis[k], None if turned is None else np.array(turned)

        def among(surroundings: Surroundings) -> NDArray[np.bool_]:
            return self._over(replace(self.ready.conditions, setup=axis, x=x, surroundings=surroundings), bound)

        held = replace(held_by(self.ready, direction_of(axis), fixture, among, stock), x=turned)
        return held if held.kind != TABLE else replace(held, soft=self._stands_soft(k))

    def chosen_and_held(self, most: int, without: frozenset[int] = frozenset()) -> tuple[int, ...]:
        """As `choose`, held by what holds it best, with what this leaves for more setups; none of which others do all."""
        chosen = self.choose(most, without)
        self.settle(chosen)
        if any(self.lying(k) and not self.steady(k) for k in chosen):
            # No chuck grips what was to lie in it.
            chosen = self.choose(most, without)
            self.settle(chosen)
        if self._turned(chosen):
            chosen = chosen[:1]  # what it leaves is served where it is turned round
        chosen = self.completed(chosen, most)
        # Where those that came later leave an earlier one nothing to do, they begin with the stock.
        while len(fewer := self._worth(chosen)) < len(chosen):
            served = self._together(chosen)
            self.settle(fewer)
            if self._together(fewer) < served - _CLAMPED_FOR:
                self.settle(chosen)
                break
            chosen = fewer
        # What a later setup grips and stands on is finished before, if any order of them does that.
        # The part is turned over first: until then the foot of its stock is there.
        over = self.opposite(chosen[0]) if chosen else None
        orders = ((*chosen[:1], *rest) for rest in permutations(chosen[1:]))
        chosen = min(orders, key=lambda order: (self._raw(order), order.index(over) if over in order else 0))
        return self._with_holes(chosen, most, without)

    def _with_holes(self, chosen: tuple[int, ...], most: int, without: frozenset[int]) -> tuple[int, ...]:
        """Chosen directions, and those behind them in which drills make holes that they make in none of these."""
        number = dict[Axis, int]()

        def hold(axis: Axis) -> Conditions | None:
            cosine = self.candidates.axis @ np.array(axis)
            k = number[axis] = int(cosine.argmax())
            if cosine[k] < SAME or k in without or k in chosen:
                return None
            self._searched(k)
            if self.steady(k):
                self._settle(k)
            return self._conditions(k) if self.steady(k) else None

        axes = [direction_of(self.candidates.axis[k]) for k in chosen]
        more = for_holes(self.ready, axes, map(self._conditions, chosen), hold, most - len(chosen))
        self.drilling = {number[axis]: holes for axis, holes in more.items()}
        return (*chosen, *self.drilling)

    def _conditions(self, k: int) -> Conditions | None:
        """The conditions in a direction with what holds the part there."""
        if (held := self.held[k]) is None:
            return None
        axis = self.candidates.axis[k]
        stock = held.stock.stock if held.stock else None
        among = self.ready.scene.surround_held(direction_of(axis), held.fixture, stock)
        return replace(self.ready.conditions, setup=axis, x=held.x and np.array(held.x), surroundings=among)

    def _raw(self, chosen: tuple[int, ...]) -> float:
        """The area, in steps, that later setups hold while it is raw, and that another one serves."""
        raw, served, any_of = 0.0, np.zeros(len(self.rows), bool), np.logical_or.reduce([self.served(k) for k in chosen])
        for number, k in enumerate(chosen):
            held = self.held[k]
            assert held is not None, "what is chosen is held"
            faces = () if number == 0 else (*held.faces, *self.candidates.stands_on[k])
            raw += float(self.share((np.isin(self.ready.samples.face[self.rows], faces) & any_of & ~served)[:, None])[0])
            served |= held.served
        return round(raw / EVEN)

    def choose(self, most: int, without: frozenset[int] = frozenset()) -> tuple[int, ...]:
        """Choose the fewest directions that serve all that any of those searched serves, or as many as there may be.

        Of as many that serve as much, those are taken in which one would rather stand the part, or lay it in a chuck; and such a
        one instead of another, if less than 2 % of the area speaks against it. Before all that comes to turn over a part that
        stands.

        `without`: directions that failed. Returns candidates, that with the most area first; none where none serves anything.
        """
        every = self.candidates.preferred([k for k, held in self.held.items() if held is not None and k not in without])
        if lying := [k for k in every if self.lying(k)]:
            serves = {k: self._together((k,)) for k in every}
            if max(serves[k] for k in lying) >= max(serves.values()) - _TURNED_FOR:
                every.sort(key=lambda k: k not in lying)
        steady = [k for k in every if self.steady(k)]
        firm, free = self._chosen(steady, most), self._chosen(every, most)
        best, among = (firm, steady) if self._together(firm) >= _SOFT * self._together(free) else (free, every)
        chosen, least = list(self._worth(best)), self._together(best) - _TURNED_FOR
        if among is every and firm and self.stock is not None:
            # Nobody stands stock aslant for what he reaches as well when he turns over a part that stands: it stands in the
            # second setup if that reaches as much, for stock asks for no stand; else in the first.
            over = self.opposite(firm[0])
            pairs = [(over, firm[0])] if over is not None and over in every else []
            for first, *others in (*pairs, (firm[0], *(k for k in every if k != firm[0]))):
                self._settle_stock(first)
                pair = max(((first, k) for k in others), key=self._together, default=(first,))
                if self._together(pair) >= least:
                    return pair
                self._without_stock(first)
        for k in among[: 1 + min(map(among.index, chosen))] if len(chosen) > 1 else ():
            over = self.opposite(k)
            # A pair that is chosen may still go over to better stands, one after the other.
            if over is None or over not in among or not self.candidates.bearing[k].firm or {k, over} == {*chosen}:
                continue
            if self._together((k, over)) >= least:
                return max((k, over), (over, k), key=lambda pair: self._together(pair[:1]))
        for i, k in enumerate(chosen):
            for other in among[: among.index(k)]:
                if other not in chosen and self._together([*chosen[:i], other, *chosen[i + 1 :]]) >= least:
                    chosen[i] = other
                    break
        return tuple(chosen)

    def _worth(self, chosen: tuple[int, ...]) -> tuple[int, ...]:
        """Leave out, one after the other, the setup that alone serves least, while that is too little to clamp the part again."""
        while len(chosen) > 1:
            table = np.stack([self.served(k) for k in chosen], axis=1)
            alone = self.share(table & (table.sum(axis=1) == 1)[:, None])
            least = int(alone.argmin())
            if alone[least] >= _CLAMPED_FOR:
                break
            chosen = chosen[:least] + chosen[least + 1 :]
        return chosen

    def _together(self, chosen: Sequence[int]) -> float:
        """The share of area that some candidates serve together."""
        whole = np.zeros(len(self.rows), bool)
        for k in chosen:
            whole |= self.served(k)
        return float(self.share(whole[:, None])[0])

    def _chosen(self, every: Sequence[int], most: int) -> tuple[int, ...]:
        """The same among some candidates."""
        if not every:
            return ()
        table = np.stack([self.served(k) for k in every], axis=1)
        share = self.share(table)
        chosen = cover(table, range(len(every)), range(len(every)))[0] if most > 1 else []
        if not chosen or len(chosen) > most:
            chosen, uncovered = [], np.ones(len(table), bool)
            while len(chosen) < most:
                gain = self.share(table & uncovered[:, None])
                k = int(np.round(gain / EVEN).argmax())
                if not gain[k] > 0.0:
                    break
                chosen.append(k)
                uncovered &= ~table[:, k]
        return tuple(every[k] for k in sorted(chosen, key=lambda k: -round(float(share[k]) / EVEN)))


#: What is kept of a ranking for the next question.
_STORED = tuple(each.name for each in fields(Ranking) if each.name not in ("ready", "progress"))


def proposed(
    ready: Prepared, most: int, words: tuple[str, ...] = (TABLE,), stock: Stock | None = None, progress: Progress = _untold
) -> tuple[Ranking, tuple[int, ...]]:
    """Rank the setups of a part as `ranked` does, and choose some, held as they are; what was compared before is not again."""

    def made() -> tuple[dict[str, Any], tuple[int, ...]]:
        ranking = ranked(ready, most, words, stock, progress)
        chosen = ranking.chosen_and_held(most)
        # Written while the ranking goes on to be asked.
        return {name: copy(getattr(ranking, name)) for name in _STORED}, chosen

    cutters = tuple(replace(each, name="") for each in ready.cutters)
    follows_from = (
        GroundDigests().of(ready), ready.samples.area, ready.scene.targets, ready.scene.part.key, cutters, most, words, stock,
        made_of(ready.options.libraries) if ready.holes else (), len(ready.holes), ready.options.drill_below,
    )  # fmt: skip
    stored, chosen = ready.cache.cached("proposal", follows_from, made)
    return Ranking(ready, **{name: copy(value) for name, value in stored.items()}), chosen


def ranked(
    ready: Prepared, most: int, words: tuple[str, ...] = (TABLE,), stock: Stock | None = None, progress: Progress = _untold
) -> Ranking:
    """Rank the setups of a part, and search those that may be the best one, or the best few together.

    `ready`: in any setup, without fixtures. `most`: setups that may be proposed together. `words`: what may hold the part: as the
    attribute of `Ranking`, as `stock`. Raises OptionError: as for `Ranking.of`.
    """
    ranking = Ranking.of(ready, words, stock)
    ranking.progress = progress
    ranking.search(np.ones(len(ranking.rows), bool), _FIRST)
    ranking.search_stood()
    for number in range(1, most):
        chosen = ranking.choose(number)
        done = np.logical_or.reduce([ranking.served(k) for k in chosen]) if chosen else np.zeros(len(ranking.rows), bool)
        if done.all():
            break
        ranking.search(~done, _MORE)
    return ranking
