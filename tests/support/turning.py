"""Fields of tool axes over a part: what of it is proved, and random contacts in that with axes of the field and near it."""

import numpy as np

from cad_io.face.curvature import evaluate
from cad_io.part.bodies import orient
from cad_io.tessellate import tessellate
from plan_cutters import Machine, plan
from plan_cutters.judging.axes import AxisField
from plan_cutters.judging.between import between
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from tests.support.contacts import UP


def along(part, cutter, axes, *, budget, tolerance=0.01, machine="unlimited", **how):
    """What `between` proves with a field; `axes` makes unit axes (k, 3) of points, normals and axes found for samples.

    Returns what was found, the geometry of faces, the part, and the fields by face.
    """
    machine = Machine.parse(machine)
    result = plan(part, cutters=[cutter], tolerance=tolerance, area_budget=0, machine=machine, **how)
    whole, samples, found = result.part, result.samples, result.reaches[cutter.id]
    side = orient(whole, towards=UP, flip=False)

    def geometry(face, uv):
        point, shape = evaluate(whole, side, face, uv)
        return point, shape.normal, shape.direction_max, shape.curvature

    around = Surroundings.sheet(Obstacles(tessellate(whole, 0.2 * tolerance)))
    context = Context.of(cutter, Conditions(machine, UP, result.postures, around, tolerance, 2))
    fields = {}
    for grid in samples.grids:
        axis, there = np.full((*grid.index.shape, 3), np.nan), grid.index >= 0
        rows = grid.index[there]
        axis[there] = axes(samples.point[rows], samples.normal[rows], found.axis[rows])
        fields[grid.face] = AxisField.of(grid, axis)
    return between(samples, found, context, whole, side, budget=budget, axes=fields), geometry, whole, fields


def turned_contacts(found, geometry, whole, fields, cloud, count, rng):
    """Random contacts in proved cells: with their normal, the field's axis or another one as far from the cell's, x_T, and points
    of the surface all over and very near.
    """
    cells = found.cells
    for row in rng.choice(len(cells.face), count):
        face = int(cells.face[row])
        u0, u1, v0, v1 = whole.trim(face).box
        uv = cells.uv[row] + rng.uniform(-0.5, 0.5, 2) * cells.span[row]
        if not whole.trim(face).inside(uv[:1], uv[1:])[0]:
            continue
        contact, normal = (x[0] for x in geometry(face, uv[None])[:2])
        axis = fields[face].at(uv[None])[0]
        if rng.random() < 0.5:
            # Any axis as far from the cell's as the field goes is covered, too.
            swing = fields[face].within(cells.uv[row][None], cells.span[row][None])[1][0]
            aside = np.cross(cells.axis[row], rng.standard_normal(3))
            axis = np.cos(swing) * cells.axis[row] + np.sin(swing) * aside / np.linalg.norm(aside)
        across = normal - (normal @ axis) * axis
        offsets = np.concatenate([rng.standard_normal((400, 2)) * size for size in (0.5, 2.0, 8.0)])
        near = geometry(face, np.clip(uv + offsets * cells.span[row], [u0, v0], [u1, v1]))[0]
        yield contact, normal, axis, -across / max(np.linalg.norm(across), 1e-12), np.concatenate([cloud, near])
