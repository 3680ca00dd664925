"""The cutter moved along with its contact: bodies that hold all that it sweeps, and what reaches into them.

The argument is in `docs/between_samples.md`, lemmas B10, B13 and B16.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.area.zone import near_by
from plan_cutters.kernels.codes import ARC, BOTTOM, COLUMNS, CONE, HIGH, KIND, LOW, RADIUS, ROUND, SCALE, SLOPE, TOP, WIDE
from plan_cutters.kernels.halves import half, half_of
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.rows import Scratch
from plan_cutters.kernels.tool import hit
from plan_cutters.kernels.tool.apart import BODY, HALF, P, alive
from plan_cutters.kernels.tool.extrusion import extruded_hit

#: Bodies of a patch: the whole, and pieces of it along the tilt direction, 2, 6 and 18.
BODIES = 27
#: Boxes in whose time a triangle is looked at, about.
_TRIANGLE = 2


class Workspace(NamedTuple):
    """This is a workspace for a contact: tilt direction f and t = n x f, bodies and their pieces, those of a tool whose axis
    turns, bounds of curvature, what counts as near.
    """

    f: Any
    t: Any
    bodies: Any
    pieces: Any
    swung: Any
    near: Any
    seen: Any
    scratch: Scratch


@kernel
def _grow(out, k, radial, axial):
    """Let piece k hold itself moved by no more than `radial` across the axis and `axial` along it."""
    out[k, LOW] -= axial
    out[k, HIGH] += axial
    if out[k, KIND] == ARC:
        both = np.sqrt(radial * radial + axial * axial)
        out[k, ROUND] += both
        out[k, BOTTOM] = max(out[k, LOW], out[k, SLOPE] - out[k, ROUND])
        out[k, TOP] = min(out[k, HIGH], out[k, SLOPE] + out[k, ROUND])
        out[k, WIDE] += both
    else:
        slope = out[k, SLOPE]
        out[k, RADIUS] += radial + (abs(slope) - slope) * axial
        out[k, WIDE] += radial + (abs(slope) + slope) * axial
        out[k, BOTTOM], out[k, TOP] = out[k, LOW], out[k, HIGH]


@kernel
def grown(piece, out, radial, axial):
    """Write pieces that hold these, moved by no more than `radial` across the axis and `axial` along it."""
    for k in range(len(piece)):
        for c in range(COLUMNS):
            out[k, c] = piece[k, c]
        _grow(out, k, radial, axial)


@kernel
def swung(piece, out, swing, sway, offset):
    """Write pieces that hold these, their axis turned by no more than `swing` about the centre of curvature (lemma B16).

    `sway` is how far the side on which the tool stands turns about the axis then, rad.
    """
    for k in range(len(piece)):
        for c in range(COLUMNS):
            out[k, c] = piece[k, c]
        if swing == 0.0:
            continue
        low, far = abs(out[k, BOTTOM]), max(abs(out[k, BOTTOM]), abs(out[k, TOP]))
        wide = max(0.0, max(out[k, RADIUS], out[k, WIDE]))
        across = abs(offset) * (sway + swing) + 0.5 * swing * swing * wide
        along = (abs(offset) + wide) * swing + 0.5 * swing * swing * far
        if out[k, KIND] == ARC:
            _grow(out, k, across + swing * far, along)
            continue
        # What is farther along the axis moves farther: the piece widens.
        out[k, KIND], out[k, SLOPE] = CONE, out[k, SLOPE] + swing
        out[k, SCALE] = 1.0 / np.sqrt(1.0 + out[k, SLOPE] ** 2)
        out[k, RADIUS] += across + swing * low
        out[k, WIDE] += across + swing * (low + out[k, HIGH] - out[k, LOW])
        _grow(out, k, 0.0, along)


@kernel
def extruded(body, piece, frame, h, pose, slides, grow, workspace, finest):
    """Write the bodies of a contact that wanders by no more than h: the whole, then 2, 6 and 18 parts along f.

    Each holds all moved cutters of its part (lemma B10).
    Each holds those that it is cut into. `pose` is (sine, cosine) of the tilt. `slides` says how far the tool
    moves along the tilt direction for a step along it and for a step across it; then the same across that direction; then how
    much farther it may move across it. `grow` is the bound of any other motion. `body` is the body without wandering.
    """
    sine, cosine = pose
    forth, back, slide, across, sideways = slides
    at = 0
    for count in (1, 2, 6, 18):
        if count > finest:
            return
        wide = h / count
        for step in range(count):
            shift = (2 * step + 1 - count) * wide
            for k in range(BODY):
                workspace.bodies[at, k] = body[k]
            for k in range(3):
                workspace.bodies[at, P + k] += shift * (forth * frame.f[k] - slide * frame.t[k])
            workspace.bodies[at, HALF] = h * across + wide * abs(slide) + sideways
            along = wide * abs(forth) + h * back
            grown(piece, workspace.pieces[at], along * abs(cosine) + grow, along * sine + grow)
            at += 1


@kernel
def _reaches(vertex, i, mask, workspace):
    """Whether triangle i, which reaches into the whole, reaches into one of its finest parts."""
    bodies, pieces, scratch = workspace.bodies, workspace.pieces, workspace.scratch
    for one in range(2):
        scratch.looked[0] += _TRIANGLE
        if not extruded_hit(vertex, i, bodies[1 + one], pieces[1 + one], mask, scratch):
            continue
        for sixth in range(3 * one, 3 * one + 3):
            scratch.looked[0] += _TRIANGLE
            if not extruded_hit(vertex, i, bodies[3 + sixth], pieces[3 + sixth], mask, scratch):
                continue
            for last in range(3 * sixth, 3 * sixth + 3):
                scratch.looked[0] += _TRIANGLE
                if extruded_hit(vertex, i, bodies[9 + last], pieces[9 + last], mask, scratch):
                    return True
    return False


@kernel
def _below(vertex, i, frame, near):
    """Whether triangle i is no deeper in flutes than allowed, for it is no higher over the tangent planes of the patch (B13)."""
    p, n, _, _ = frame
    for corner in range(3):
        dx, dy, dz = vertex[i, corner, 0] - p[0], vertex[i, corner, 1] - p[1], vertex[i, corner, 2] - p[2]
        height, away = dx * n[0] + dy * n[1] + dz * n[2], np.sqrt(dx * dx + dy * dy + dz * dz)
        if not height + away * near[6] + near[7] <= near[8]:
            return False
    return True


@kernel
def _blocks(i, mask, nose, flutes, whole, frame, face, vertex, triangle_face, workspace):
    """Whether triangle i reaches into a piece of the moved cutter; into its nose only if it is not near."""
    workspace.scratch.looked[0] += _TRIANGLE
    hit = extruded_hit(vertex, i, workspace.bodies[0], workspace.pieces[0], mask, workspace.scratch)
    if hit & nose and near_by(vertex, triangle_face, i, frame, face, workspace.near):
        hit &= ~nose
    if hit & flutes and _below(vertex, i, frame, workspace.near):
        hit &= ~flutes
    return hit != 0 and (whole or _reaches(vertex, i, hit, workspace))


@kernel
def first_in_the_way(hint, nose, flutes, whole, frame, face, tree, triangle_face, workspace):
    """First triangle found that is in the way of the moved cutter, `hint` (-1: none) before others."""
    stack, masks = workspace.scratch.stack, workspace.scratch.masks
    every = hit.everything(workspace.pieces[0])
    if hint >= 0:
        vertex, row = half_of(tree, hint)
        if _blocks(row, every, nose, flutes, whole, frame, face, vertex, triangle_face[hint - row :], workspace):
            return hint
    for k in range(2):
        vertex, box, depth, begin = half(tree, k)
        count, first, top = len(vertex), (1 << depth) - 1, 1 if len(vertex) else 0
        faces = triangle_face[begin:]
        stack[0], masks[0] = 0, every
        while top > 0:
            top -= 1
            node = stack[top]
            workspace.scratch.looked[0] += 1
            mask = alive(box, node, workspace.bodies[0], workspace.pieces[0], masks[top], 0.0)
            if mask == 0:
                continue
            if node < first:
                stack[top], masks[top] = 2 * node + 2, mask
                stack[top + 1], masks[top + 1] = 2 * node + 1, mask
                top += 2
                continue
            leaf = node - first
            for i in range((count * leaf) >> depth, (count * (leaf + 1)) >> depth):
                if _blocks(i, mask, nose, flutes, whole, frame, face, vertex, faces, workspace):
                    return begin + i
    return -1
