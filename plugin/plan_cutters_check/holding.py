"""Is the part in the jaws, and on the ledges, of a vise or chuck of which the plan alone says where it stands?"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io import Part
from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives
from plan_cutters_check.fixtures import rotation_of
from plan_cutters_check.question import Grip, Question

#: How far a face may be from a jaw, and the part's lowest point from the ledges, mm; cosine of the angle between both.
_AT, _SQUARE = 0.02, math.cos(math.radians(0.2))
#: Lines of points in a face each way, and how often closer ones are taken where the jaws are.
_LINES, _TIMES = 16, 4


def faults(question: Question) -> Iterator[str]:
    """List what is wrong with where the part is held, a line each."""
    for grip in question.grips:
        points = {f.number: _local(question, grip, f.number) for f in question.part.faces if question.part.trim(f.number)}
        # A round that runs out into what is gripped touches a jaw along a line, which holds nothing.
        held = "plane" if grip.jaws == 2 else "cylinder"
        touched = {n: _touched(grip, *pair) for n, pair in points.items() if question.part.faces[n - 1].shape == held}
        touching = {number for number, jaws in touched.items() if jaws}
        stated = {int(name[1:]) for name in grip.faces if name[1:].isdecimal()}
        where = f"{grip.name} in setup {grip.setup + 1}"
        free = grip.jaws - len(set[int]().union(*touched.values()))
        # A chuck grips a whole cylinder, whichever faces of it are between its jaws.
        other = (
            touching ^ stated if grip.jaws == 2 else (touching - stated) | {n for n in stated if not _on_bore(grip, *points[n])}
        )
        if free:
            yield f"{where}: no face of the part is at {free} of its {grip.jaws} jaws"
        elif other or not stated:
            names = ", ".join(f"F{n}" for n in sorted(touching))
            yield f"{where}: its jaws touch {names}, and the plan says {', '.join(grip.faces) or 'none'}"
        yield from (f"{where}: {words}" for words in _rests(grip, np.concatenate([pair[0] for pair in points.values()])))


def resting(question: Question) -> Question:
    """The question with the faces on which the part rests in a placed vise or chuck held in that setup: no tool comes there."""
    setups = [*question.setups]
    for grip in question.grips:
        rests = {
            face.number for face in question.part.faces if question.part.trim(face.number) and _lies(question, grip, face.number)
        }
        setups[grip.setup] = replace(setups[grip.setup], clamped=setups[grip.setup].clamped | rests)
    return replace(question, setups=tuple(setups))


def _lies(question: Question, grip: Grip, number: int) -> bool:
    """Whether a face lies flat on the ledges."""
    if question.part.faces[number - 1].shape != "plane":
        return False
    point, normal = _local(question, grip, number)
    return bool((np.abs(point[:, 2]) <= _AT).all() and normal[:, 2].min(initial=0.0) <= -_SQUARE)


def _local(question: Question, grip: Grip, number: int) -> tuple[Floats, Floats]:
    """Points (n, 3) of a face and its border, closer together at the jaws, and outer normals there, in the jaws' frame."""
    part: Part = question.part
    trim, rotation = part.trim(number), rotation_of(grip.body)
    assert trim is not None
    pairs: list[tuple[Floats, Floats]] = []

    def at(uv: Floats) -> Floats:
        point, s_u, s_v = np.moveaxis(first_derivatives(part.adaptor(number), *uv.T), 1, 0)
        normal = np.cross(s_u, s_v) * question.sign[number - 1]
        normal = normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        local = (point - np.array(grip.body.placement[:3])) @ rotation
        inside = trim.inside(*uv.T)
        pairs.append((local[inside], normal[inside] @ rotation))
        return np.asarray(local)

    low, high = np.array(trim.box).reshape(2, 2).T
    for _ in range(_TIMES):
        cell = (high - low) / _LINES
        uv = np.stack(np.meshgrid(*(low + cell * (np.arange(_LINES)[:, None] + 0.5)).T), axis=-1)
        local = at(uv.reshape(-1, 2)).reshape(_LINES, _LINES, 3)
        far = 1.5 * max(float(np.abs(np.diff(local, axis=k)).max()) for k in (0, 1))
        near = (local[..., 2] >= -far) & (local[..., 2] <= grip.grip + far)
        near &= (np.abs(local[..., 1]) <= 0.5 * grip.width + far) | (grip.jaws > 2)
        if not near.any() or near.all():
            break
        low, high = uv[near].min(axis=0) - cell, uv[near].max(axis=0) + cell
    border = trim.segments.reshape(-1, 2)
    point = first_derivatives(part.adaptor(number), *border.T)[:, 0]
    pairs.append(((point - np.array(grip.body.placement[:3])) @ rotation, np.zeros((len(point), 3))))
    return np.concatenate([each[0] for each in pairs]), np.concatenate([each[1] for each in pairs])


def _touched(grip: Grip, point: Floats, normal: Floats) -> set[int]:
    """At which jaws a face lies, that looks at them."""
    if grip.jaws == 2:
        there = (point[:, 2] > _AT) & (point[:, 2] < grip.grip - _AT) & (np.abs(point[:, 1]) < 0.5 * grip.width - _AT)
        return {
            k for k, way in enumerate((1.0, -1.0))
            if (there & (np.abs(way * point[:, 0] - 0.5 * grip.apart) <= _AT) & (way * normal[:, 0] >= _SQUARE)).any()
        }  # fmt: skip
    there = _bored(grip, point, normal)
    turn, every = np.arctan2(point[there, 1], point[there, 0]), 2.0 * math.pi / grip.jaws
    nearest = np.rint(turn / every)
    return {int(k) % grip.jaws for k in nearest[np.abs(turn - nearest * every) <= grip.width]}


def _on_bore(grip: Grip, point: Floats, normal: Floats) -> bool:
    return bool(_bored(grip, point, normal).any())


def _bored(grip: Grip, point: Floats, normal: Floats) -> NDArray[np.bool_]:
    """Which points lie on the bore of a chuck's jaws, in their height."""
    away = np.hypot(point[:, 0], point[:, 1])
    outward = (point[:, :2] * normal[:, :2]).sum(axis=1) >= _SQUARE * np.maximum(away, 1e-9)
    return np.asarray(outward & (point[:, 2] > _AT) & (point[:, 2] < grip.grip - _AT) & (np.abs(away - 0.5 * grip.apart) <= _AT))


def _rests(grip: Grip, point: Floats) -> Iterator[str]:
    """Whether the lowest points lie on the ledges, or between the jaws over the body."""
    low = float(point[:, 2].min())
    across = np.abs(point[:, 0]) if grip.jaws == 2 else np.hypot(point[:, 0], point[:, 1])
    if low > _AT:
        yield f"the part hangs {low:.4g} mm over the ledges"
    elif low < -_AT:
        if low < -grip.below - _AT:
            yield f"the part reaches {-low - grip.below:.4g} mm into the body"
        if (across[point[:, 2] < -_AT] > 0.5 * grip.apart - grip.ledge + _AT).any():
            yield "the part reaches into the jaws below the ledges"
    elif not (across[point[:, 2] <= low + _AT] >= 0.5 * grip.apart - grip.ledge - _AT).any():
        yield "no lowest point of the part lies on the ledges"
