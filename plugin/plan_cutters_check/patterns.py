"""Are the patterns of a plan those of the part, and are repeated operations what they say they are?

Each copy of a pattern is expanded: points of its first faces, moved, must lie on the faces that are named, within their borders,
on their outer side; what is left of a whole part must be carried onto itself.
"""

import math
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from cad_io.arrays import Floats
from plan_cutters_check.findings import Finding
from plan_cutters_check.question import Question
from plan_cutters_check.surface import SIDES

#: Faces are equal within this share of the part's size; areas, cosines of normals, and unit vectors.
_EXACT, _AREA, _NORMAL, _SAME = 2e-6, 2e-4, 1.0 - 1e-4, 1e-6
#: Lines of points in a face, points of its border, places from which its points are looked for, and steps that are taken.
_LINES, _BORDER, _SEEDS, _STEPS = 7, 24, 24, 12
#: Pairs of faces that are compared, at most.
_MOST = 1500

Motion = tuple[Floats, Floats]


class Patterns:
    """The checks of equal faces and of what is repeated."""

    def __init__(self, question: Question) -> None:
        # With draws of its own: those of the other checks stay as they are.
        self.question, self.rng = question, np.random.default_rng(0)
        self._size = float(np.linalg.norm(question.part.size))
        self._sided = any(True for _ in question.part.solid_shapes())
        self._face = cache(self._points_of)
        self._net = cache(self._seeds_of)

    def findings(self) -> Iterator[Finding]:
        """All of them."""
        entries = self.question.document.get("patterns", [])
        if entries and not self.question.document["effective"].get("patterns", True):
            yield Finding(False, "The plan names patterns, and was made without them.")
        for number, entry in enumerate(entries, 1):
            name = f"Pattern {number} ({entry['kind']}, {entry['order']} copies)"
            wrong = _ill_formed(entry, len(self.question.part.faces))
            yield Finding(False, f"{name}: {wrong}.") if wrong else self._expanded(name, entry)
        if entries:
            yield Finding(None, "How many samples of a pattern were moved, followed or verified is not looked at.")
        yield from self._operations()

    def _expanded(self, name: str, entry: dict[str, Any]) -> Finding:
        """Compare each face of each copy with the first one's, and faces that no copy has with themselves."""
        copies = [[int(face[1:]) for face in copy] for copy in entry["faces"]]
        motions = _motions(entry)
        pairs = [
            (one, other, m)
            for copy, m in zip(copies[1:], motions if copies else [], strict=True)
            for one, other in zip(copies[0], copy, strict=True)
        ]
        named = {number for copy in copies for number in copy}
        if entry["whole"]:
            named |= self.question.ignored
            left = [f.number for f in self.question.part.faces if f.unjudged is None and f.number not in named]
            pairs += [(number, number, motions[0]) for number in left]
        chosen = self.rng.permutation(len(pairs))[:_MOST].tolist()
        wrong = [(one, other, why) for one, other, m in map(pairs.__getitem__, chosen) if (why := self._differ(one, other, m))]
        late = f" of {len(pairs)} (taken by seed 0)" if len(pairs) > len(chosen) else ""
        text = f": F{wrong[0][0]}, moved, is not F{wrong[0][1]}: {wrong[0][2]}" if wrong else ""
        return Finding(not wrong, f"{name}: {len(chosen)}{late} pairs of faces were compared; {len(wrong)} differ{text}.")

    def _differ(self, one: int, other: int, motion: Motion) -> str:
        """Why a face, moved, is not another one; empty where no difference is found."""
        faces, (linear, shift) = self.question.part.faces, motion
        mine, theirs = faces[one - 1].area, faces[other - 1].area
        if not abs(mine - theirs) <= _AREA * theirs:
            return f"{mine:.6g} mm2 and {theirs:.6g} mm2"
        point, normal, deflection = self._face(one)
        trim = self.question.part.trim(other)
        if trim is None or not len(point):
            return "its border cannot be read"
        off, uv, there = self._nearest(other, point @ linear.T + shift)
        if not (off <= _EXACT * self._size).all():
            return f"it is {float(np.nanmax(off)):.3g} mm off"
        slack = _EXACT * self._size + 2.0 * (deflection + trim.deflection + trim.tolerance)
        if not self._within(other, uv, slack).all():
            return "it leaves its border"
        known = np.isfinite(normal).all(axis=1) & np.isfinite(there).all(axis=1)
        if self._sided and not (((normal @ linear.T) * there).sum(axis=1)[known] >= _NORMAL).all():
            return "its outer side is another one"
        return ""

    def _points_of(self, number: int) -> tuple[Floats, Floats, float]:
        """Points (n, 3) in a face and on its border, their outer normals, and how far its polygon may be off, mm."""
        trim = self.question.part.trim(number)
        if trim is None:
            return np.zeros((0, 3)), np.zeros((0, 3)), 0.0
        u0, u1, v0, v1 = trim.box
        uv = np.zeros((0, 2))
        for lines in (_LINES, 4 * _LINES):
            share = (np.arange(lines) + 0.5) / lines
            every = np.stack(np.meshgrid(u0 + share * (u1 - u0), v0 + share * (v1 - v0)), axis=-1).reshape(-1, 2)
            uv = every[trim.inside(*every.T)]
            if len(uv) >= _LINES:
                break
        uv = uv[:: max(1, len(uv) // _LINES**2)]
        ends = trim.segments.mean(axis=1)
        uv = np.concatenate([uv, ends[:: max(1, len(ends) // _BORDER)]])
        return *self.question.surface(number, uv)[:2], float(trim.deflection)

    def _seeds_of(self, number: int) -> tuple[Floats, Floats]:
        """Parameters (n, 2) all over a face, and their points."""
        u0, u1, v0, v1 = self.question.part.trim(number).box  # type: ignore[union-attr]
        every = np.stack(np.meshgrid(np.linspace(u0, u1, _SEEDS), np.linspace(v0, v1, _SEEDS)), axis=-1).reshape(-1, 2)
        return every, self.question.surface(number, every)[0]

    def _nearest(self, number: int, point: Floats) -> tuple[Floats, Floats, Floats]:
        """Distances (n,) of points from a face's surface, as found from the nearest seeds, the places there, and normals."""
        seed, places = self._net(number)
        near = np.argsort(((point[:, None] - places) ** 2).sum(axis=2), axis=1)[:, :3]
        box = np.array(self.question.part.trim(number).box).reshape(2, 2)  # type: ignore[union-attr]
        best, uv, normal = np.full(len(point), np.inf), seed[near[:, 0]], np.full((len(point), 3), np.nan)
        for start in near.T:
            at = seed[start].copy()
            for _ in range(_STEPS):
                there, outward, slope = self.question.surface(number, at)
                off = np.linalg.norm(point - there, axis=1)
                better = off < best
                best[better], uv[better], normal[better] = off[better], at[better], outward[better]
                if (best <= 0.1 * _EXACT * self._size).all():
                    return best, uv, normal
                gram = slope @ slope.transpose(0, 2, 1)
                gram += np.eye(2) * (1e-12 * np.trace(gram, axis1=1, axis2=2)[:, None, None] + 1e-300)
                step = np.linalg.solve(gram, slope @ (point - there)[:, :, None])[:, :, 0]
                at = np.clip(at + step, box[:, 0], box[:, 1])
        return best, uv, normal

    def _within(self, number: int, uv: Floats, slack: float) -> NDArray[np.bool_]:
        """Which parameters (n, 2) lie in a face, or are nearer than a slack, mm, to what does."""
        trim = self.question.part.trim(number)
        assert trim is not None
        length = np.linalg.norm(self.question.surface(number, uv)[2], axis=2)
        by = slack / np.maximum(length, 1e-9 * length.max(initial=1e-300))
        inside = np.zeros(len(uv), bool)
        for side in (np.zeros(2), *SIDES):
            left = np.flatnonzero(~inside)
            if len(left):
                inside[left] = trim.inside(*(uv[left] + by[left] * side).T)
        return inside

    def _operations(self) -> Iterator[Finding]:
        """Operations that are images of each other have one cutter, setup and mode."""
        for plan in self.question.document["operations"]["plans"]:
            kinds: dict[int, set[Any]] = {}
            for each in (each for each in plan["operations"] if each.get("orbit") is not None):
                kinds.setdefault(each["orbit"], set()).add((each["cutter"], each["setup"], each["mode"]))
            for orbit in (orbit for orbit, some in kinds.items() if len(some) > 1):
                yield Finding(False, f"The {plan['name']} plan: the operations of orbit {orbit} are no images of each other.")


def _ill_formed(entry: dict[str, Any], faces: int) -> str:
    """What of a pattern contradicts itself; empty for nothing."""
    order, copies = entry["order"], entry["faces"]
    known = {f"F{number}" for number in range(1, faces + 1)}
    if order < 2 or (copies and len(copies) != order) or (entry["kind"] == "mirror" and order != 2):
        return "it has another number of copies"
    if len({len(copy) for copy in copies}) > 1 or not all(face in known for copy in copies for face in copy):
        return "its copies have other faces than the part, or not as many as each other"
    if not copies and not entry["whole"]:
        return "it has no faces"
    if entry["kind"] == "shift":
        right = len(entry["shifts_mm"]) == order - 1
        return (
            "" if right and entry["place_mm"] is None and entry["direction"] is None else "its shifts are not those of its copies"
        )
    place, direction = entry["place_mm"], entry["direction"]
    if place is None or direction is None or abs(np.linalg.norm(direction) - 1.0) > _SAME or entry["shifts_mm"]:
        return "it has no axis or mirror"
    return ""


def _motions(entry: dict[str, Any]) -> list[Motion]:
    """What carries the first copy onto each other one: `linear @ x + shift`."""
    if entry["kind"] == "shift":
        return [(np.eye(3), np.array(shift, float)) for shift in entry["shifts_mm"]]
    place, n = np.array(entry["place_mm"], float), np.array(entry["direction"], float)
    n = n / np.linalg.norm(n)
    linear = [np.eye(3) - 2.0 * np.outer(n, n)]
    if entry["kind"] == "rotation":
        order = entry["order"]
        linear = [Rotation.from_rotvec(2.0 * math.pi * k / order * n).as_matrix() for k in range(1, order)]
    return [(each, place - each @ place) for each in linear]
