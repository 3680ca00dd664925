"""How deep the exact surface lies in the exact tool, and which tool axes a machine holds, by formulas of their own."""

import math

import numpy as np

from tests.support.tool_reference import Reference

#: Distance of points of the skin, mm; those around which more are looked at, how often, and how many.
_APART, _SEEDS, _ROUNDS, _MORE = 0.6, 8, 5, 150
#: No point of the skin is farther than this from the points that are looked at, mm: what is so far off is not looked at closer.
_FAR = 4.0
#: Points within the tool that are looked for in material.
_WITHIN = 300
#: mm.
ROUNDING = 1e-6
_HAIR = 1e-9


def safe(tolerance):
    """How deep the surface may lie in flutes, and in what stands above them, where a posture is called safe."""
    return tolerance, 0.0


def clear(tolerance):
    """The same where a posture is so free that none may call it blocked: by a share of the tolerance."""
    return 0.3 * tolerance, -0.6 * tolerance


class Truth:
    """The skins of a part and of what stands around it, and the tool.

    `bodies` are `solids.Material`s: the part first.
    """

    def __init__(self, bodies, cutter, seed=0):
        self.bodies = bodies
        self.tool = Reference(cutter)
        self.skins = [each.skin(_APART) if k == 0 else each.skin(2 * _APART, 120) for k, each in enumerate(bodies)]
        self.rng = np.random.default_rng(seed)
        self.allowance, self.clearance = cutter.allowance or 0.0, cutter.clearance or 0.0

    def stands(self, contact, normal, tilt_direction, tilt):
        """Tip and frame of the tool at a posture of a plan; at tilt 0 a short direction puts the contact under the flat."""
        # Where two of its corners touch at once, the one of the smaller tilts is meant.
        towards = tilt - 1e-3 if tilt > 1e-6 else tilt + 1e-3
        tip, frame = self.tool.frame(contact, normal, tilt_direction, tilt, towards)
        return tip, np.stack([*frame[:2] / max(1e-300, np.linalg.norm(tilt_direction)), frame[2]])

    def over(self, points, tip, axis, limits):
        """By how much points (n, 3) are deeper than limits, of the flutes and of what stands above them; negative: that near."""
        away = points - tip
        w = away @ axis
        return self._beyond(np.sqrt(np.maximum(0.0, (away * away).sum(axis=1) - w * w)), w, limits)

    def _beyond(self, q, w, limits):
        flutes, rest = limits
        # What stands above is measured by itself, a hair outside of it.
        return self.tool.over(q, w, flutes - self.allowance, min(rest, -_HAIR) - self.clearance)

    def deepest(self, tip, axis, limits):
        """The largest of these over all skins, refined about the worst points, and over points of the tool within material."""
        worst, tool, spare = -math.inf, self.tool, 1.0 + max(self.allowance, self.clearance) - min(limits)
        for body, skin in zip(self.bodies, self.skins, strict=True):
            away = skin.point - tip
            w = away @ axis
            near = np.flatnonzero((w > -spare) & (w < tool.end + spare))
            near = near[((away[near] ** 2).sum(axis=1) - w[near] ** 2) < (tool.wide + spare) ** 2]
            if len(near):
                worst = max(worst, self._refined(body, skin, near, tip, axis, limits))
        return max(worst, self._sunk(tip, axis, limits))

    def _refined(self, body, skin, near, tip, axis, limits):
        found = self.over(skin.point[near], tip, axis, limits)
        best = float(found.max())
        # Beside a contact that may lie deep in the flutes, what hardly touches the shank or holder is not the worst.
        above = self.over(skin.point[near], tip, axis, (math.inf, limits[1]))
        for row in dict.fromkeys([*self._apart(skin, near, found), *self._apart(skin, near, above)]):
            face, uv, step = int(skin.face[row]), skin.uv[row], 1.5
            sizes = np.array([max(body.faces[face].long, 1e-9), max(body.faces[face].wide, 1e-9)])
            for _ in range(_ROUNDS):
                around = np.clip(uv + step * _APART / sizes * self.rng.uniform(-1, 1, (_MORE, 2)), 0.0, 1.0)
                point, _, kept, _ = body.on(face, *around.T)
                step /= 3
                if not len(point):
                    continue
                deep = self.over(point, tip, axis, limits)
                k = int(deep.argmax())
                if deep[k] >= best - 1.0:
                    uv = kept[k]
                best = max(best, float(deep[k]))
        return best

    def _apart(self, skin, near, found):
        """One seed of each neighbourhood: the worst, and the worst of those that lie apart."""
        order, seeds = near[np.argsort(-found)[:400]], []
        order = order[np.sort(-found)[: len(order)] < _FAR]
        for row in order.tolist():
            if len(seeds) == _SEEDS:
                break
            if all(np.linalg.norm(skin.point[row] - skin.point[other]) > 2 * _APART for other in seeds):
                seeds.append(row)
        return seeds

    def _sunk(self, tip, axis, limits):
        """How much deeper than limits points of the tool are that lie within material; -inf if none does."""
        tool = self.tool
        w = self.rng.uniform(0.0, tool.end, _WITHIN)
        q = np.maximum(0.0, tool.whole.radius(w)) * np.sqrt(self.rng.uniform(0.0, 1.0, _WITHIN))
        count = self._beyond(q, w, limits)
        turn = self.rng.uniform(0.0, 2 * math.pi, _WITHIN)
        u = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        u /= np.linalg.norm(u)
        points = tip + w[:, None] * axis + q[:, None] * (np.cos(turn)[:, None] * u + np.sin(turn)[:, None] * np.cross(axis, u))
        some = count > 1e-3
        within = np.zeros(_WITHIN, bool)
        for body in self.bodies:
            within[some] |= body.within(points[some])
        return float(count[within].max(initial=-math.inf))


def holds(machine, frame, axes, slack):
    """Which tool axes (n, 3) of the part a machine holds within its limits and a slack, rad, in a setup of frame (3, 3)."""
    axes = np.asarray(axes) @ np.asarray(frame).T
    if machine.tilt_limit is not None:
        return np.arccos(np.clip(axes[:, 2], -1, 1)) <= machine.tilt_limit + slack
    turning = machine.rotary
    tool = np.array(machine.tool_axis)
    if not turning:
        return np.full(len(axes), not machine.fixed) | (np.linalg.norm(axes - tool, axis=1) <= slack)
    return np.array([_held(turning, tool, axis, slack) for axis in axes], bool)


def _held(turning, tool, axis, slack):
    """Whether turns of these axes bring the tool to a direction: the last angle by trial, ever closer, the first follows."""
    first, last = turning[0], turning[-1]
    low, high = last.limits or (-math.pi, math.pi)
    if high - low > 2 * math.pi:
        low, high = -math.pi, math.pi
    grid, step = np.linspace(low, high, 721), (high - low) / 720
    for _ in range(8):
        swung = _turned(last.direction, grid, tool)
        off = _angle(swung, axis) if len(turning) == 1 else _left(first, swung, axis)
        # The best places may be two solutions: several are kept.
        best = np.argsort(off)[:4]
        if off[best[0]] <= slack:
            return True
        grid = np.unique(np.clip(np.add.outer(grid[best], step * np.linspace(-1, 1, 41)).ravel(), low, high))
        step /= 20
    return False


def _turned(direction, angles, vectors):
    """Vectors (n, 3) or one, turned about a direction by angles (n,)."""
    d, vectors = np.asarray(direction), np.broadcast_to(vectors, (len(angles), 3))
    c, s = np.cos(angles)[:, None], np.sin(angles)[:, None]
    return c * vectors + s * np.cross(d, vectors) + (1 - c) * (vectors @ d)[:, None] * d


def _angle(vectors, axis):
    return 2 * np.arcsin(np.clip(0.5 * np.linalg.norm(vectors - axis, axis=1), 0, 1))


def _left(axis, start, wanted):
    """The least angles (n,), rad, left between directions (n, 3), turned about an axis within its limits, and another one."""
    d = np.array(axis.direction)
    a, b = start - (start @ d)[:, None] * d, wanted - (wanted @ d) * d
    best = np.arctan2(np.cross(a, b) @ d, a @ b)
    low, high = axis.limits or (-math.inf, math.inf)
    found = np.full(len(start), math.inf)
    for turn in range(-2, 3):
        angle = np.clip(best + 2 * math.pi * turn, low, high)
        found = np.minimum(found, _angle(_turned(d, angle, start), wanted))
    return found
