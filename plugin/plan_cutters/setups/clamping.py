"""Where does a vise or chuck grip a part in a setup? What it may grip is compared by how little of the target faces it hides.

No safety rests on the place (`docs/operations_proof.md`, lemma K1); how deep jaws may stand in the part is lemma K2.
"""

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cad_io.arrays import FaceInfo, Floats
from plan_cutters.domain.clamping import GRIP, VISE, Clamping, Requested, Vise, chuck_for
from plan_cutters.domain.figures import area, listed, mm
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import axis_words, frame_of
from plan_cutters.domain.stock import StockBody, deep_in
from plan_cutters.errors import FixtureError
from plan_cutters.setups.places import chuck_places, ungripped, vise_places
from plan_cutters.setups.solids import box, cylinder
from plan_cutters.setups.workpiece import BENDS, PartMesh, Place, Refused, Workpiece, held_bodies, on_ledges, thin_between


class NothingToGripError(FixtureError):
    """A vise or chuck has nothing to grip in a setup; `why` is the cause alone."""

    why: str = ""


@dataclass(frozen=True, slots=True)
class Hold:
    """A vise or chuck that was placed for a setup."""

    fixture: Fixture  #: In its place, with all its numbers.
    grips: tuple[int, ...]  #: Numbers of the faces that its jaws touch.
    rests_on: tuple[int, ...]  #: Numbers of the planar faces with which the part rests in it.
    hidden: float  #: Area of the faces to machine that its jaws touch, mm2.
    words: str  #: What it is and what it grips, for people.
    soft: str = ""  #: Why it needs soft jaws or a nest; empty where plain jaws hold the part.

    @property
    def faces(self) -> tuple[int, ...]:
        """All faces that it holds, ascending."""
        return tuple(sorted({*self.grips, *self.rests_on}))


#: Shares of the target area that jaws hide are equal if they differ by less; places that are searched for overlaps, at most, and
#: of these on the same faces.
_EVEN, _TRIED, _OF_ONE = 0.05, 12, 4
#: Of what of a bar is below the part jaws grip so much.
_OF_A_BAR = 0.8
#: So much of a part stands above the jaws, mm, or half of its height: a cutter that faces it does not run on them.
_ABOVE = 1.0
Overlaps = Callable[[Fixture, Clamping], bool]


def held(
    fixture: Fixture, part: Workpiece, plainly: Overlaps, overlaps: Overlaps, slack: float = 0.0, deep: float | None = None
) -> Hold:
    """Place a vise or chuck.

    `fixture`: with `to_place`. `plainly`, `overlaps`: whether a fixture in its place, a vise or chuck, stands in the part: where
    that is seen at once, and by a search. `slack`: how far the part's triangles may be off, mm. `deep`: how deep jaws grip unless
    that was requested, mm. Raises NothingToGripError: there is nothing that it can grip, in a line that says why and what to try.
    """
    requested = fixture.grips
    assert requested is not None, "only a vise or chuck is placed"
    usual = requested.sizes is None and requested.grip == GRIP
    most = max(part.tall - _ABOVE, 0.5 * part.tall) if requested.grip == GRIP else math.inf
    requested = replace(requested, grip=min(deep if usual and deep else requested.grip, most))
    lying = fixture.up is not None
    places, refused = vise_places(part, requested) if requested.kind == VISE else chuck_places(part, requested, lying=lying)
    refused += [Refused(each.rank, "its jaws would reach as high as the part") for each in places if each.high > most + part.flat]
    places = [each for each in places if each.high <= most + part.flat]
    least, step = min((each.hidden for each in places), default=0.0), _EVEN * max(1e-300, part.area)
    # Of even ones about the middle of the part, then on the larger faces; a bar that lies is gripped as deep as it can be.
    places.sort(
        key=lambda each: (each.soft != "", each.bored, each.thin, -each.clamping.grip * lying,
                          int((each.hidden - least) / step), -round(each.firm, 6),
                          each.above, round(each.off, 6), -round(each.size, 6), each.apart, each.grips)
    )  # fmt: skip
    searched, bending = Counter[tuple[int, ...]](), list[Place]()
    for place in places:
        if place.soft and bending:
            break
        placed, names = _fixture(fixture, part, place), listed([f"F{n}" for n in place.grips], 4)
        many = searched.total() == _TRIED or searched[place.grips] == _OF_ONE
        if many or plainly(placed, place.clamping):
            refused.append(Refused(place.rank, f"something of the part is in the way of the jaws at {names}"))
            continue
        if len(part.bodies) > 1 and not held_bodies(place.clamping, place.own(part.vertex), part.face, part.bodies, slack):
            refused.append(Refused(place.rank, f"{names} are of bodies with a gap between them"))
            continue
        if not overlaps(placed, place.clamping):
            thick = 0.0 if place.bored else thin_between(part, place)
            if not thick:
                return _hold(requested, placed, part, place)
            bending.append(replace(place, soft=f"jaws {BENDS} {mm(thick)} thick"))
            continue
        refused.append(Refused(place.rank, f"something of the part is in the way of the jaws at {names}"))
        searched[place.grips] += 1
    if bending:
        return _hold(requested, _fixture(fixture, part, bending[0]), part, bending[0])
    raise _nothing(fixture, requested, part.frame[2].tolist(), min(refused, key=lambda each: each.rank).why)


def refuse_ungripped(fixture: Fixture, faces: Sequence[FaceInfo], sign: Floats, setup: Sequence[float], reach: float) -> None:
    """Refuse a vise or chuck that no faces of a part are made for, before it has triangles.

    `faces`: all of the part. `sign` (faces,): side of each that is out of the material. `setup`: unit axis.
    `reach`: how far the part is from the origin at most, mm. Raises NothingToGripError. That nothing is raised promises nothing.
    """
    requested = fixture.grips
    assert requested is not None, "only a vise or chuck is placed"
    if why := ungripped(requested, faces, sign, np.asarray(setup, float), reach):
        raise _nothing(fixture, requested, setup, why)


def held_stock(fixture: Fixture, body: StockBody, setup: Sequence[float], sides: int) -> Hold:
    """Place a vise or chuck on stock: all below the part, or across a bar that lies.

    `fixture`: with `to_place`. `body`: in the frame of the setup. `sides`: of a cylinder as triangles. Raises NothingToGripError:
    it cannot grip that.
    """
    requested = fixture.grips
    assert requested is not None, "only a vise or chuck is placed"
    foot = body.part_low - float(body.low[2])
    if requested.grip > foot and not body.lying:
        raise NothingToGripError(
            f"{fixture}: its jaws grip {mm(requested.grip)} high, and the stock reaches {mm(foot)} below the part; give more "
            "with --stock, or grip less"
        )
    across = frame_of(np.asarray(setup, float))
    if body.radius is None:
        vertex, planes = box(body.low, body.high), range(1, 7)
        face = np.tile(np.arange(1, 7, dtype=np.int32), 2)
    else:
        start = 0.5 * (body.low + body.high)
        start[body.along] = body.low[body.along]
        long = float(body.high[body.along] - body.low[body.along])
        vertex = np.roll(cylinder(body.radius, long, sides), body.along + 1, axis=-1) + start
        face, planes = np.repeat(np.array([1, 1, 2, 3], np.int32), sides), range(2, 4)
    rods = {} if body.radius is None else {1: across[body.along].tolist()}
    piece = Workpiece.of(PartMesh.of(vertex @ across, face, np.ones(6)), planes, (), setup, rods=rods)
    # A bar that stands is gripped deep, and some of it stays free below the part.
    deep = None if body.lying else max(GRIP, _OF_A_BAR * foot)
    if body.radius is None:
        deep = deep_in(float(body.high[2]) - body.part_low, foot)
    hold = held(fixture, piece, lambda placed, clamping: False, lambda placed, clamping: False, deep=deep)
    clamping = hold.fixture.clamping
    assert clamping is not None, "what was placed is in its place"
    what, apart = _called(clamping)
    words = f"{what}; it grips the stock, {apart}; the jaws reach {mm(clamping.grip)} above where it rests"
    return Hold(hold.fixture, (), (), 0.0, words, hold.soft)


def _nothing(fixture: Fixture, requested: Requested, setup: Sequence[float], why: str) -> NothingToGripError:
    # Made here: an error that knows where it was raised, and is known there, would keep the part's triangles for long.
    along, instead = f"with the setup axis {axis_words(setup)}", "another setup"
    if fixture.up is not None:
        along, instead = (
            f"along {axis_words(setup)}, the rotary axis on which it stands",
            "a setup axis across the bar, --setup auto",
        )
    error = NothingToGripError(
        f"{fixture}: nothing to grip {along}: {why}; try {instead}, "
        f"--fixture {'chuck' if requested.kind == VISE else 'vise'} or table, or a file of your own fixture"
    )
    error.why = why
    return error


def _fixture(fixture: Fixture, part: Workpiece, place: Place) -> Fixture:
    """The vise or chuck in its place, exactly as its text says it."""
    x = place.x @ part.frame
    axes = np.stack([x, np.cross(part.frame[2], x), part.frame[2]], axis=1)
    origin = (place.origin + np.array([0.0, 0.0, part.lowest])) @ part.frame
    where = (*np.round(origin, 9).tolist(), *np.round(_angles(axes), 9).tolist())
    written = Fixture(place.clamping.word, tuple(each + 0.0 for each in where)).text
    return replace(Fixture.parse(written), name=fixture.name)


def _angles(axes: Floats) -> Floats:
    """Turns about the fixed x, y and z axis, deg, that bring x, y and z to the columns of a matrix (3, 3)."""
    tilt = math.asin(max(-1.0, min(1.0, -axes[2, 0])))
    if abs(axes[2, 0]) > 1.0 - 1e-12:
        angles = (0.0, tilt, math.atan2(-axes[0, 1], axes[1, 1]))
    else:
        angles = (math.atan2(axes[2, 1], axes[2, 2]), tilt, math.atan2(axes[1, 0], axes[0, 0]))
    return np.degrees(angles)


def _hold(requested: Requested, fixture: Fixture, part: Workpiece, place: Place) -> Hold:
    clamping, names, level = place.clamping, [f"F{n}" for n in place.grips], part.level(place.above)
    # Planar faces with which the part rests on the ledges of the jaws.
    rests = tuple(sorted(on_ledges(clamping, place.own(part.vertex[level]), part.face[level], part.flat)))
    size = "" if requested.sizes is not None else ", the smallest usual size that takes the part"
    above = f", from {mm(place.above)} above its lowest point" if place.above > 0.0 else ""
    on = f"; the part rests on {listed([f'F{n}' for n in rests])}" if rests else ""
    under = [f"{area(place.hidden)} under the jaws"] if place.hidden > 0.0 else []
    under += [f"F{n}" for n in rests if n in part.targets]
    left = f"left for another setup: {' and '.join(under)}" if under else "it holds none of the faces to machine"
    what, across = _called(clamping)
    across += ", in soft jaws bored to it" if place.bored else ""
    words = f"{what}{size}; it grips {listed(names)}, {across}{above}; the jaws reach {mm(clamping.grip)} above where it rests"
    soft = f"; it needs soft jaws or a nest: {place.soft}" if place.soft else ""
    return Hold(fixture, place.grips, rests, place.hidden, f"{words}{on}{soft}; {left}", place.soft)


def _called(clamping: Clamping) -> tuple[str, str]:
    """A vise or chuck in its place for people, and how far apart or wide it is where it grips."""
    if isinstance(clamping, Vise):
        jaws = f"jaws {mm(clamping.width)} wide and {mm(clamping.height)} high, opening {mm(clamping.opening)}"
        return f"a self-centring vise, {jaws}", f"{mm(clamping.gap or 0.0)} apart"
    wide = clamping.diameter or 0.0
    return f"a chuck of {mm(chuck_for(wide))} with {clamping.jaws} jaws {mm(clamping.height)} high", f"{mm(wide)} wide"
