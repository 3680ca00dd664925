"""Random contacts in cells that are called served, and points of the exact surface around them."""

import math

import numpy as np

from cad_io.face.curvature import evaluate
from cad_io.part.bodies import orient
from cad_io.sample import sample
from cad_io.tessellate import tessellate
from plan_cutters import Machine, Options
from plan_cutters.judging.between import between
from plan_cutters.judging.face_cells import Fixed
from plan_cutters.judging.judge import judge
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.fixed_axis import held_at, served_by
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings

UP = np.array([0.0, 0.0, 1.0])


def served(part, cutter, *, budget, tolerance=0.01, chord=None, machine="unlimited", jobs=2, axes=None, **how):
    """What `between` finds after the verdicts, and the geometry that it is asked of; with fixed axes (k, 3) if given."""
    machine = Machine.parse(machine)
    asked = {"cutters": [cutter], "tolerance": tolerance, "area_budget": 0, "machine": machine, **how}
    ready = prepare(part, Options.of(asked))
    whole, samples = ready.scene.part, ready.samples
    side = orient(whole, towards=UP, flip=False)

    def geometry(face, uv):
        point, shape = evaluate(whole, side, face, uv)
        return point, shape.normal, shape.direction_max, shape.curvature

    around = Surroundings.sheet(Obstacles(tessellate(whole, chord or 0.2 * tolerance)))
    context = Context.of(cutter, Conditions(machine, UP, ready.conditions.postures, around, tolerance, jobs))
    verdicts, fixed = judge(ready, cutter), None
    if axes is not None:
        rows = np.arange(len(samples))
        serves = served_by(rows, axes, samples, context)[0].T
        upright = np.where(serves, samples.normal @ axes.T, -2.0)
        verdicts = held_at(axes, np.where(serves.any(axis=1), upright.argmax(axis=1), -1), samples, context)
        fixed = Fixed(axes, serves)
    found = between(samples, verdicts, context, whole, side, budget=budget, axes=fixed)
    return found, geometry, whole


def dense(whole, spacing):
    """Points all over the part's exact surface."""
    return sample(whole, orient(whole, towards=UP, flip=False), spacing=spacing,
                  faces=[f.number for f in whole.faces]).point  # fmt: skip


def wandering(found, geometry, whole, cloud, count, rng):
    """Random contacts in served cells: each with its normal, axis and x_T, and points of the surface all over and very near it,
    where the clearance is smallest."""
    cells = found.cells
    for row in rng.choice(len(cells.face), count):
        face = int(cells.face[row])
        u0, u1, v0, v1 = whole.trim(face).box
        within = ([u0, v0], [u1, v1])  # beyond, the surface goes on, but not the face
        uv = cells.uv[row] + rng.uniform(-0.5, 0.5, 2) * cells.span[row]
        if not whole.trim(face).inside(uv[:1], uv[1:])[0]:
            continue
        contact, normal = (x[0] for x in geometry(face, uv[None])[:2])
        axis = cells.axis[row]
        across = normal - (normal @ axis) * axis
        if np.linalg.norm(across) < 1e-9:  # the axis is the normal: the side is the cell's, or else any will do
            across = -cells.side[row] if np.isfinite(cells.side[row]).all() else rng.standard_normal(3)
            across -= (across @ axis) * axis
        x_t = -across / np.linalg.norm(across)
        offsets = np.concatenate([rng.standard_normal((400, 2)) * size for size in (0.5, 2.0, 8.0)])
        near = geometry(face, np.clip(uv + offsets * cells.span[row], *within))[0]
        yield contact, normal, axis, x_t, np.concatenate([cloud, near])


def deepest(found, geometry, whole, cutter, cloud, count, rng):
    """Largest depth of the surface in the cutter over random contacts in served cells, mm."""
    worst = -math.inf
    for contact, _, axis, x_t, points in wandering(found, geometry, whole, cloud, count, rng):
        away = points - (contact - cutter.radius * x_t)
        height = away @ axis
        # No point lies deeper than it is high.
        away, height = away[height > worst], height[height > worst]
        radial = np.linalg.norm(away - height[:, None] * axis, axis=1)
        depth = np.minimum(np.minimum(height, cutter.length - height), cutter.radius - radial)
        worst = max(worst, float(depth.max(initial=worst)))
    return worst
