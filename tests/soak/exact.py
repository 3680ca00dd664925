"""Laws of verdicts against the exact surface: safe is safe, and blocked is blocked."""

import math

import numpy as np
from hypothesis import strategies as st
from OCP.ShapeAnalysis import ShapeAnalysis_ShapeTolerance

from plan_cutters import posture_map
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.posture import tilt_direction
from plan_cutters.domain.verdicts import INACCESSIBLE, INTERFERENCE_FREE, REASONS
from tests.soak.cases import Mill, Setting, VoidError, parts, refused, settings, tools
from tests.soak.register import law
from tests.soak.truth import ROUNDING, clear, holds, safe
from tests.support.contacts import served, wandering

#: Postures that are put down in a case, samples that are searched by trial, and trials at each.
_POSTURES, _SAMPLES, _TRIALS = 40, 4, 60
#: A posture is clearly free if it is so at its tilt and so far beside it, rad.
_BESIDE = math.radians(0.02)
#: Slack of a machine's limits, rad: an axis is one that it holds within 1e-6 in each of two directions.
_HELD = 3e-6
#: Ends of free tilts are looked at so far within, rad: at the end itself another corner of the tool may touch as well.
_INWARD = 1e-6


def _tolerance(result):
    return result.plan.effective.tolerance_mm


def told(samples, row, what):
    return f"{what}: sample {row} at {samples.point[row].tolist()}, normal {samples.normal[row].tolist()}"


@law(settings())
def safe_is_safe(setting: Setting):
    """At no posture that a plan reports is a point of the exact surface deeper in the exact tool than the tolerance."""
    result, truth = setting.planned(), setting.truth()
    samples, tolerance = result.samples, _tolerance(result)
    (reach,) = result.reaches.values()
    rng = np.random.default_rng(0)
    rows = np.flatnonzero(reach.reached)
    for row in rng.permutation(rows)[:_POSTURES].tolist():
        normal, f, tilt = samples.normal[row], reach.tilt_direction[row], float(reach.tilt[row])
        axis = reach.axis[row]
        if reach.verdict[row] == INTERFERENCE_FREE:
            f, tilt, axis = tilt_direction(normal, samples.direction_max[row], rng.uniform(0, 2 * math.pi)), 0.0, normal
        tip, frame = truth.stands(samples.point[row] + np.nan_to_num(reach.shift[row]), normal, f, tilt)
        assert np.abs(frame[2] - axis).max() < 1e-6, told(samples, row, "the axis is not that of the tilt")
        assert holds(setting.mill.machine, setting.frame, axis[None], _HELD)[0], (
            told(samples, row, f"the machine does not hold {axis.tolist()}"))  # fmt: skip
        deep = truth.deepest(tip, axis, safe(tolerance))
        assert deep <= ROUNDING, told(samples, row, f"{deep:.6f} mm too deep at tolerance {tolerance}")


@law(settings())
def samples_lie_on_the_skin(setting: Setting):
    """Samples lie on the exact skin, and their normals point out of the material."""
    result = setting.planned()
    samples = result.samples
    rows = np.flatnonzero(samples.unjudged < 0)
    point, normal = samples.point[rows], samples.normal[rows]
    material = setting.part.material
    if setting.part.sheet:
        size = setting.part.steps[0][1].sizes[0]
        height = setting.part.steps[0][1].patch.at(*np.clip(point[:, :2] / size, 0, 1).T)[:, 2]
        assert np.abs(height - point[:, 2]).max() < 1e-5
        return
    # A face ends within the tolerance of its edges, as far as the CAD kernel found where two faces meet.
    assert np.abs(material.value(point)).max() < max(1e-5, ShapeAnalysis_ShapeTolerance().Tolerance(result.scene.part.shape, 1))
    # On an edge it may lie on both sides, or on none; at a corner it may seem inside out, and its face beside it does not.
    one = np.cross(normal, np.eye(3)[np.abs(normal).argmin(axis=1)])
    one /= np.linalg.norm(one, axis=1)[:, None]
    other, turns = np.cross(normal, one), np.linspace(0.0, 2.0 * math.pi, 64)

    def sides(at):
        return [material.value(at + way * normal) / abs(way) for way in (1e-3, -1e-3)]

    beside = [sides(point + 0.01 * (math.cos(turn) * one + math.sin(turn) * other)) for turn in turns]
    right = np.any([(front > 0.3) & (back < -0.3) for front, back in beside], axis=0)
    front, back = sides(point)
    wrong = rows[(front < -0.3) & (back > 0.3) & ~right]
    assert not len(wrong), told(samples, int(wrong[0]), "inside out")


def _free_by_trial(setting, truth, result, row, rotations, tilts, tolerance):
    """A posture (rotation, tilt) of those that is clearly free at a sample, or None."""
    samples = result.samples
    for rotation, tilt in zip(rotations, tilts, strict=True):
        f = tilt_direction(samples.normal[row], samples.direction_max[row], rotation)
        if _clear(setting, truth, samples.point[row], samples.normal[row], f, tilt, tolerance):
            return float(rotation), float(tilt)
    return None


def _clear(setting, truth, point, normal, f, tilt, tolerance):
    for beside in (0.0, -_BESIDE, _BESIDE):
        tip, frame = truth.stands(point, normal, f, tilt + beside)
        if not holds(setting.mill.machine, setting.frame, frame[2:], -1e-4)[0]:
            return False
        if truth.deepest(tip, frame[2], clear(tolerance)) > 0.0:
            return False
    return True


def _tilts(cutter, low, high, count, rng):
    """Random tilts, rad, at which a cutter touches with what cuts, away from where another part of it begins to touch."""
    spans = [(max(low, a) + 2 * _BESIDE, min(high, b) - 2 * _BESIDE) for _, _, a, b, _ in assembly(cutter, 0.0, 0.0).mode]
    spans = [each for each in spans if each[1] > each[0]]
    if not spans:
        return np.zeros(0)
    # Small and large tilts as often as those between.
    which = rng.integers(len(spans), size=count)
    share = rng.beta(0.6, 0.6, count)
    return np.array([spans[k][0] + s * (spans[k][1] - spans[k][0]) for k, s in zip(which, share, strict=True)])


@law(settings())
def blocked_is_blocked(setting: Setting):
    """Where a sample is called inaccessible, no posture that was searched is clearly free by trial."""
    result, truth = setting.planned(), setting.truth()
    (reach,), rng = result.reaches.values(), np.random.default_rng(0)
    rows = rng.permutation(np.flatnonzero((reach.verdict == INACCESSIBLE) & ~result.inside_bodies))[:_SAMPLES]
    postures, tolerance = result.postures, _tolerance(result)
    for row in rows.tolist():
        tilts = _tilts(setting.tool.cutter, *postures.tilt, _TRIALS, rng)
        turns = rng.choice(postures.rotations, len(tilts))
        free = _free_by_trial(setting, truth, result, row, turns, tilts, tolerance)
        why = f"free at rotation, tilt {free} rad, said to be lost to {REASONS[reach.reason[row]]}"
        assert free is None, told(result.samples, row, why)


@law(settings())
def maps_tell_free_from_forbidden(setting: Setting):
    """In the map of a point, free tilts are safe for the exact surface, and no forbidden one is clearly free."""
    result, truth = setting.planned(), setting.truth()
    samples, rng = result.samples, np.random.default_rng(0)
    whole = np.flatnonzero((samples.unjudged < 0) & ~result.inside_bodies)
    for row in rng.permutation(whole)[:3].tolist():
        turns = rng.choice(result.postures.rotations, 4)
        found = _mapped(setting, result.scene, samples.point[row], turns)
        if np.abs(found.normal - samples.normal[row]).max() > 1e-6:
            continue  # the point lies on an edge: it is that of another face
        contact, tolerance = (found.point, found.normal), found.tolerance
        for k, turn in enumerate(turns.tolist()):
            f = tilt_direction(found.normal, found.direction_max, turn)
            where = told(samples, row, f"rotation {turn}")
            _safe_within(setting, truth, *contact, f, found.free[k], tolerance, rng, where)
            open_ = np.concatenate([found.free[k], found.undecided[k]])
            for tilt in _tilts(setting.tool.cutter, *result.postures.tilt, 12, rng).tolist():
                if not ((open_[:, 0] <= tilt + _BESIDE) & (open_[:, 1] >= tilt - _BESIDE)).any():
                    free = _clear(setting, truth, *contact, f, tilt, tolerance)
                    assert not free, told(samples, row, f"forbidden and free at rotation {turn}, tilt {tilt} rad")


def _mapped(setting, scene, point, turns):
    more = {name: value for name, value in (("tilt_deg", setting.tilt), ("x", setting.x)) if value is not None}
    question = {"point": tuple(point), "cutter": setting.tool.cutter, "rotations": turns, "machine": setting.mill.machine}
    return refused(lambda: posture_map(scene, **question, **more))


def _safe_within(setting, truth, point, normal, f, free, tolerance, rng, where):
    """Free tilts (m, 2) are safe at their ends and between them, and the machine holds them."""
    for first, last in np.asarray(free).tolist():
        inward = min(_INWARD, 0.5 * (last - first))
        for tilt in (first + inward, last - inward, rng.uniform(first, last)):
            tip, frame = truth.stands(point, normal, f, tilt)
            deep = truth.deepest(tip, frame[2], safe(tolerance))
            assert deep <= ROUNDING, f"{deep:.6f} mm too deep at tilt {tilt} rad, {where}"
            held = holds(setting.mill.machine, setting.frame, frame[2:], _HELD)[0]
            assert held, f"the machine does not hold tilt {tilt} rad, {where}"


@law(settings(mill=st.just(Mill())))
def maps_of_all_samples_are_safe(setting: Setting):
    """What the posture maps of all samples call free is safe for the exact surface, whatever the machine holds."""
    setting = setting.but(mill=Mill())
    result, truth = setting.planned(posture_maps=True), setting.truth()
    maps, samples, rng = result.maps, result.samples, np.random.default_rng(0)
    if maps is None:
        raise VoidError("no maps")
    turns = len(maps.rotations)
    for row in rng.permutation(len(samples))[:8].tolist():
        for k in rng.permutation(turns)[:3].tolist():
            free = maps.free[maps.offset[row * turns + k] : maps.offset[row * turns + k + 1]]
            f = tilt_direction(maps.normal[row], maps.direction_max[row], float(maps.rotations[k]))
            where = told(samples, row, f"rotation {maps.rotations[k]}")
            _safe_within(setting, truth, samples.point[row], maps.normal[row], f, free, maps.tolerance, rng, where)


@law(st.builds(Setting, parts(), tools(loose=st.just(False)), setup=st.just((0.0, 0.0, 1.0)), grid=st.integers(3, 6)))
def between_samples_is_safe(setting: Setting):
    """In cells between samples that are called served, the exact surface is no deeper in the tool than the tolerance."""
    truth, cutter = setting.truth(), setting.tool.cutter
    found, geometry, whole = refused(lambda: served(
        setting.part.shape, cutter, budget=2000, tolerance=setting.tolerance, faces="all", grid=setting.grid,
        rotation_step_deg=setting.step, jobs=1))  # fmt: skip
    if not len(found.cells.face):
        raise VoidError("no cell is served")
    for contact, normal, axis, x_t, _ in wandering(found, geometry, whole, np.zeros((0, 3)), 40, np.random.default_rng(0)):
        tilt = math.atan2(np.linalg.norm(np.cross(normal, axis)), normal @ axis)
        f = math.cos(tilt) * x_t + math.sin(tilt) * axis
        f -= (f @ normal) * normal
        tip, frame = truth.stands(contact, normal, f / np.linalg.norm(f), tilt)
        deep = truth.deepest(tip, frame[2], safe(setting.tolerance))
        assert deep <= ROUNDING, f"{deep:.6f} mm too deep at {contact.tolist()} with {axis.tolist()}"
