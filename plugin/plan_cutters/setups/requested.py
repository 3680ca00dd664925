"""Setups as a caller gives them: as axes, with what more is known of each as placements, and the fixtures of the first."""

import math
import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from plan_cutters.domain.checks import items, shown
from plan_cutters.domain.clamping import CHUCK
from plan_cutters.domain.fixture import STOCK, TABLE, Fixture
from plan_cutters.domain.placement import Placement, frame_of
from plan_cutters.domain.posture import Direction, along, direction_of, plane_of, unit
from plan_cutters.domain.stock import Stock
from plan_cutters.errors import OptionError

#: The word that asks for setups to be proposed.
AUTO = "auto"
#: Setups that are proposed together, at most.
MOST_PROPOSED = 3
#: A setup axis, and what more is known of the setup.
_Stand = tuple[Direction, Placement | None]


def is_auto(value: Any) -> bool:
    """Whether a setup is the word that asks for a proposal."""
    return isinstance(value, str) and value.strip().lower() == AUTO


def joined_fixtures(fixtures: Sequence[Fixture], more: Sequence[Fixture]) -> tuple[Fixture, ...]:
    """Fixtures and those of others that are not among them, each with a name of its own."""
    return Fixture.each_of([*fixtures, *without(more, fixtures)])


def without(fixtures: Sequence[Fixture], others: Sequence[Fixture]) -> tuple[Fixture, ...]:
    """Those fixtures that are none of the others, whatever they are called."""
    known = [replace(each, name="fixture") for each in others]
    return tuple(each for each in fixtures if replace(each, name="fixture") not in known)


def setups_requested(
    setup: Any, placement: Placement | None, others: Any, other_placements: Any, fixtures: Any, *, propose: bool,
    stock: Stock | None = None, chuck_axis: Direction | None = None,
) -> dict[str, Any]:  # fmt: skip
    """Give the values of the options about setups by their names.

    `setup`, `placement`, `others`, `other_placements`, `fixtures`: as `Options` takes them. `propose`: setups are to be proposed.
    `stock`: what the first setup grips, if its setups are named. `chuck_axis`: as of the machine.
    Raises OptionError: a value has no meaning, or setups are to be proposed beside some that are given.
    """
    common = Fixture.each_of(fixtures)
    if is_auto(setup):
        setup, propose = (0.0, 0.0, 1.0), True
    axis, placed = _setup(setup, placement)
    gripping = tuple(each for each in common if each.to_place)
    common = tuple(each for each in common if each not in gripping or each in _to_place(gripping, placed))
    known_stock = [each for each in (*common, *(placed.fixtures if placed else ())) if each.kind == STOCK]
    if stock is not None and stock.solid and not propose and not known_stock:
        placed = _holding((axis, placed), (Fixture(f"{STOCK}:{stock.text}"),))
    if placed is not None:
        if placed is not placement:
            # What stands in all setups is not this one's own.
            placed = replace(placed, fixtures=without(placed.fixtures, common))
        common = joined_fixtures(common, placed.fixtures)
    listed = items(others, "other setups", "directions")
    places = items(other_placements, "other placements", "placements") or [None] * len(listed)
    if len(places) != len(listed):
        raise OptionError(f"{len(places)} other placements were given for {len(listed)} other setups")
    if any(is_auto(each) for each in listed) or (propose and (listed or placed is not None)):
        raise OptionError("setup auto proposes all setups: leave out the other setups, or auto")
    # What may be proposed with a setup is one word without a place at most.
    if propose and (len(common) > 1 or not all(
        each.to_place or (each.kind == TABLE and not each.sizes and not any(each.placement)) for each in common
    )):  # fmt: skip
        raise OptionError(
            "setup auto tries a table, a vise and a chuck in each setup, or the one that --fixture says: leave out other "
            "fixtures, or name the setup"
        )
    shared = without(common, () if placed is None else placed.fixtures)
    stands = [_setup(each, place) for each, place in zip(listed, places, strict=True)]
    if listed and gripping:
        # What grips the part is placed for each setup: it is that one's own.
        shared = without(shared, gripping)
        placed = _holding((axis, placed), gripping)
        stands = [(each.z, each) for each in (_holding(stand, gripping) for stand in stands)]
    if chuck_axis is not None and not propose:
        common = _on_rotary(common, (axis, placed), chuck_axis)
        (_, placed), *stands = [
            (z, place and replace(place, fixtures=_on_rotary(place.fixtures, (z, place), chuck_axis)))
            for z, place in ((axis, placed), *stands)
        ]
    setups = [_own(stand, shared) for stand in stands]
    known = any(place is not None for _, place in setups)
    return {"setup": axis, "placement": placed, "fixtures": common, "propose": propose,
            "other_setups": tuple(each for each, _ in setups),
            "other_placements": tuple(place for _, place in setups) if known else ()}  # fmt: skip


def _holding(stand: _Stand, gripping: Sequence[Fixture]) -> Placement:
    """A setup that is held by some fixtures of its own, too."""
    axis, place = stand
    if place is None:
        return Placement(axis, fixtures=gripping)
    return replace(place, fixtures=joined_fixtures(place.fixtures, _to_place(gripping, place)))


def _on_rotary(fixtures: Sequence[Fixture], stand: _Stand, direction: Direction) -> tuple[Fixture, ...]:
    """Fixtures of a setup, with chucks that are to be placed along a rotary axis that lies across the spindle."""
    z, place = stand
    x = None if place is None or place.x is None else np.array(place.x)
    up = direction_of(np.array(direction) @ frame_of(np.array(z), x))
    return tuple(replace(each, up=up) if each.to_place and each.kind == CHUCK else each for each in fixtures)


def _to_place(gripping: Sequence[Fixture], place: Placement | None) -> Sequence[Fixture]:
    """Of vises and chucks without a place those of which a setup has none in its place: a setup file says where it is."""
    there = set() if place is None else {each.kind for each in place.fixtures if not each.to_place}
    return [each for each in gripping if each.kind not in there]


def _own(stand: _Stand, shared: Sequence[Fixture]) -> _Stand:
    """A setup without those fixtures that stand in all setups; a table that lies across its own axis is another one."""
    axis, place = stand
    if place is None:
        return stand
    own = tuple(each for each in place.fixtures if each.follows_setup or without((each,), shared))
    return axis, replace(place, fixtures=own)


def _setup(value: Any, placed: Placement | None) -> _Stand:
    """A setup as a caller gives it.

    A word as `+z` is an axis, another text or path a setup file; a host's plane says where the machine's X points, too.
    """
    if isinstance(value, os.PathLike) or (isinstance(value, str) and along(value) is None):
        from plan_cutters.setups.files import read_setup

        if isinstance(value, str) and not value.lower().endswith(".toml") and not os.path.exists(value):
            raise OptionError(f"setup {value!r} is no direction, as +z, -y or (0, 0, 1), a setup file, or auto")
        value = read_setup(value)
    if (plane := plane_of(value)) is not None:
        if placed is not None:
            raise OptionError("a plane and a placement were given for one setup: give one of them")
        value = Placement(*plane)
    if isinstance(value, Placement):
        return value.z, value
    x, y, z = unit(value, "setup axis").tolist()
    if placed is None:
        return (x, y, z), None
    if not isinstance(placed, Placement):
        raise OptionError(f"a placement must be a Placement, not {shown(placed)}")
    if math.dist((x, y, z), placed.z) > 1e-12:
        raise OptionError("the setup axis and the placement disagree: give the placement as the setup")
    return placed.z, placed
