"""Find the samples of a part that is ready which motions of the whole part carry onto others.

What follows from it, and within what: `docs/operations_proof.md`, lemma P2.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints, SurfaceSamples
from cad_io.part.equal_faces import Motion
from cad_io.part.patterns import Pattern
from plan_cutters.domain.posture import PostureRange
from plan_cutters.scene.conditions import Conditions, rotations_of
from plan_cutters.scene.preparation import Copies, Prepared, Rows

#: Samples correspond within this share of the part's size, cosines of their normals within this, and rotations within this, rad.
_NEAR, _NORMAL, _ROTATION = 1e-5, 1e-6, 1e-6
#: Directions that a motion leaves as they are, within this.
_STILL = 1e-9
#: Of the copies of a motion on a face, every so many is judged by itself, too.
_VERIFIED = 10
#: A part with a smaller share of copies, or fewer of them, is judged as if it had none.
_WORTH, _LEAST = 0.1, 500


def with_copies(ready: Prepared, patterns: tuple[Pattern, ...]) -> Prepared:
    """A part that is ready with its patterns, and the samples that are copies under those of the whole part."""
    motions = tuple(motion for each in patterns if each.whole for motion in each.motions)
    copies = None
    machine = ready.options.machine
    # Where fewer than two axes turn the tool, rotations are numbered by these: no motion carries them.
    if motions and not (machine.turns and machine.turning < 2):
        copies = _copies(ready, motions, patterns)
    return replace(ready, patterns=patterns, copies=copies)


def _copies(ready: Prepared, motions: tuple[Motion, ...], patterns: tuple[Pattern, ...]) -> Copies | None:
    samples, size = ready.samples, float(np.linalg.norm(ready.scene.part.size))
    n = len(samples)
    judged = np.flatnonzero(samples.unjudged < 0)
    master, number = np.arange(n), np.full(n, -1, np.int32)
    tree = cKDTree(samples.point[judged])
    for k, motion in enumerate(motions):
        off, near = tree.query(motion.points(samples.point[judged]), distance_upper_bound=_NEAR * size)
        is_near = np.isfinite(off)
        one, other = judged[is_near], judged[near[is_near]]
        # Of one sample and several points at one place, on both sides of an edge, the normals tell.
        alike = (motion.directions(samples.normal[one]) * samples.normal[other]).sum(axis=1) >= 1.0 - _NORMAL
        alike &= (ready.shut[one] >= 0) == (ready.shut[other] >= 0)
        one, other = one[alike], other[alike]
        better = one < master[other]
        master[other[better]], number[other[better]] = one[better], k
    # What is itself an image hands nothing on.
    second = number[master] >= 0
    master[second], number[second] = np.flatnonzero(second), -1
    if (number >= 0).sum() < max(_LEAST, _WORTH * len(judged)):
        return None
    unchanged = tuple(tuple(keeps(ready, each, motion, patterns) for motion in motions) for each in ready.setups)
    frames = _same_frames(samples, master, number, motions, ready.options.postures)
    group = np.where(number >= 0, number * (int(samples.face.max()) + 1) + samples.face, -1).astype(np.int64)
    # Of the copies of each group at which frames agree the first one, and every tenth after it.
    rows = np.flatnonzero(frames)
    rows = rows[np.argsort(group[rows], kind="stable")]
    _, first, count = np.unique(group[rows], return_index=True, return_counts=True)
    verified = np.zeros(n, bool)
    verified[rows[(np.arange(len(rows)) - np.repeat(first, count)) % _VERIFIED == 0]] = True
    return Copies(master, number, motions, unchanged, frames, verified, group)


def _same_frames(
    samples: SurfaceSamples, master: Rows, number: Ints, motions: tuple[Motion, ...], postures: PostureRange
) -> NDArray[np.bool_]:
    """Copies (n,) at which the rotations that are searched are the images of those at the master."""
    frames = np.zeros(len(master), bool)
    first, last = postures.rotation
    if last - first <= 2.0 * np.pi - 1e-9:
        return frames
    step = 2.0 * np.pi / len(postures.rotations)
    for k, motion in enumerate(motions):
        rows = np.flatnonzero(number == k)
        direction = motion.directions(samples.direction_max[master[rows]])
        turn = rotations_of(samples.normal[rows], samples.direction_max[rows], direction)
        frames[rows] = np.abs(turn / step - np.rint(turn / step)) * step <= _ROTATION
    return frames


def keeps(ready: Prepared, conditions: Conditions, motion: Motion, patterns: tuple[Pattern, ...]) -> bool:
    """Whether a motion of the part leaves all that verdicts in a setup depend on as it is."""
    surroundings = conditions.surroundings
    if surroundings.missing or surroundings.lost or surroundings.loose or surroundings.doubtful:
        return False
    ignored = set(ready.scene.ignored).difference(ready.scene.doubles)
    if ignored and not any(motion is m and {image[f] for f in ignored if f in image} == ignored
                           for each in patterns for m, image in zip(each.motions, each.images, strict=True)):  # fmt: skip
        return False
    return _keeps_limits(conditions, motion) and _keeps_fixtures(conditions, motion, float(np.linalg.norm(ready.scene.part.size)))


def _keeps_limits(conditions: Conditions, motion: Motion) -> bool:
    """Whether the machine holds the image of each tool axis that it holds."""
    machine, kinematics = conditions.machine, conditions.kinematics
    if not machine.limited or np.abs(motion.linear - np.eye(3)).max() <= _STILL:
        return True
    if machine.tilt_limit is not None and not _still(motion, conditions.setup):
        return False
    if kinematics is None:
        return True
    low, high = kinematics.limit[0]
    # The axis next to the part goes all round: what is held lies between circles about it.
    whole = len(kinematics.direction) == 2 and bool(high - low >= 2.0 * np.pi - _STILL)
    return whole and bool(_still(motion, kinematics.direction[0]))


def _keeps_fixtures(conditions: Conditions, motion: Motion, size: float) -> bool:
    """Whether fixtures are carried onto themselves: only of a table across the setup axis is that known."""
    fixtures = conditions.surroundings.fixtures
    if not all(each.fixture.kind == "table" and each.fixture.follows_setup for each in fixtures):
        return False
    along = abs(float(motion.shift @ conditions.setup))
    return not fixtures or (_still(motion, conditions.setup) and along <= _STILL * size)


def _still(motion: Motion, direction: Floats) -> bool:
    return bool(np.linalg.norm(motion.linear @ direction - direction) <= _STILL)


def some_of(ready: Prepared, rows: Rows) -> Prepared:
    """A part that is ready with some of its samples alone, to be judged: nothing else of these is filled."""
    samples, none = ready.samples, np.zeros((0, 2), np.int32)
    arrays = ("point", "normal", "direction_max", "curvature", "uv", "face", "area", "unjudged")
    some = replace(samples, neighbours=none, grids=(), **{name: getattr(samples, name)[rows] for name in arrays})
    held = None if ready.held is None else ready.held[rows]
    exempt, drilled = (None if each is None else each[rows] for each in (ready.exempt, ready.drilled))
    return replace(
        ready, samples=some, surface_class=ready.surface_class[rows], region=ready.region[rows], inside=ready.inside[rows],
        inside_bodies=ready.inside_bodies[rows], held=held, exempt=exempt, drilled=drilled, others=(), copies=None,
    )  # fmt: skip
