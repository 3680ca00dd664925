"""B-spline surfaces, rational or not, of any degree: values, first and second derivatives, and how they bend over cells.

Basis functions and their derivatives by de Boor's triangle (Piegl and Tiller, *The NURBS Book*, A2.2 and A2.3); rational
surfaces as quotients of these with the weight as a fourth coordinate (the same, A4.4).

Bends over the cells of a grid: a derivative that is a polynomial lies in the hull of its control points, so in a ball about
them. Quotients are bounded by sums and products of balls. Interval of a B-spline as Bezier patch: by blossoming (the same, 5.3;
Ramshaw, *Blossoms are polar forms*, 1989).
"""

from typing import Any, NamedTuple

import numpy as np

from cad_io.arrays import Floats
from cad_io.surface.elementary import Bends
from plan_cutters_base.jit import entry, kernel

#: Highest degree that the CAD kernel knows.
DEGREE = 25


@kernel
def span(knot, degree, t):
    """The last interval of positive length that begins at or before t, within the range; the end belongs to the last one."""
    low, high = degree, len(knot) - degree - 1
    while high - low > 1:
        middle = (low + high) // 2
        if t >= knot[middle]:
            low = middle
        else:
            high = middle
    # A knot at the range's end has no interval behind it.
    while low > degree and knot[low] >= knot[low + 1]:
        low -= 1
    return low


@kernel
def basis(knot, degree, span, t, order, left, right, table, out):
    """Write the basis functions that are not zero in a span (degree + 1,), and derivatives up to `order` (2 at most), as rows."""
    table[0, 0] = 1.0
    for j in range(1, degree + 1):
        left[j] = t - knot[span + 1 - j]
        right[j] = knot[span + j] - t
        saved = 0.0
        for r in range(j):
            # Below the diagonal the distances of knots, above it the functions.
            table[j, r] = right[r + 1] + left[j - r]
            term = table[r, j - 1] / table[j, r]
            table[r, j] = saved + right[r + 1] * term
            saved = left[j - r] * term
        table[j, j] = saved
    for r in range(degree + 1):
        out[0, r] = table[r, degree]
        out[1, r], out[2, r] = 0.0, 0.0
    if order > 0 and degree > 0:
        for r in range(degree + 1):
            total = 0.0
            if r > 0:
                total += table[r - 1, degree - 1] / table[degree, r - 1]
            if r < degree:
                total -= table[r, degree - 1] / table[degree, r]
            out[1, r] = degree * total
    if order > 1 and degree > 1:
        for r in range(degree + 1):
            # The first derivative's two functions of one degree less, each derived once more.
            total = 0.0
            for k in range(2):
                i = r - 1 + k
                if i < 0 or i >= degree:
                    continue
                inner = 0.0
                if i > 0:
                    inner += table[i - 1, degree - 2] / table[degree - 1, i - 1]
                if i < degree - 1:
                    inner -= table[i, degree - 2] / table[degree - 1, i]
                inner *= (degree - 1) / table[degree, i]
                total += inner if k == 0 else -inner
            out[2, r] = degree * total


@kernel
def wrapped(t, first, period):
    """A parameter of a periodic surface within its first period, both ends included; of others (period 0) as it is."""
    if period > 0.0 and (t < first or t > first + period):
        t -= period * np.floor((t - first) / period)
    return t


class Net(NamedTuple):
    """A surface: knots with their multiplicities, degrees, periods (0 where there is none), pole (a, b, 4): poles times their
    weights, and the weights, which differ if `rational`. It ranges from `knot[degree]` to `knot[-degree - 1]`."""

    knot_u: Any
    knot_v: Any
    degree_u: int
    degree_v: int
    period_u: float
    period_v: float
    pole: Any
    rational: bool


class _Workspace(NamedTuple):
    """Basis functions along u and v and their tables, rows summed along v, the sums, and the origin."""

    bu: Any
    bv: Any
    left: Any
    right: Any
    table: Any
    across: Any
    found: Any
    origin: Any


@kernel
def _summed(net, row, column, order, workspace):
    """Sum a patch's poles: S, Su, Sv, Suu, Svv, Suv and their weights into `workspace.found`, from the patch's first pole.

    What is far from the origin would lose digits of its derivatives.
    """
    bu, bv, across, result = workspace.bu, workspace.bv, workspace.across, workspace.found
    origin, pole = workspace.origin, net.pole
    top, first, wide = row - net.degree_u, column - net.degree_v, 4 if net.rational else 3
    for c in range(3):
        origin[c] = pole[top, first, c] / pole[top, first, 3]
    for a in range(net.degree_u + 1):
        for d in range(order + 1):
            x, y, z, w = 0.0, 0.0, 0.0, 0.0
            for b in range(net.degree_v + 1):
                share, weight = bv[d, b], pole[top + a, first + b, 3]
                x += share * (pole[top + a, first + b, 0] - origin[0] * weight)
                y += share * (pole[top + a, first + b, 1] - origin[1] * weight)
                z += share * (pole[top + a, first + b, 2] - origin[2] * weight)
                w += share * weight
            across[d, a, 0], across[d, a, 1], across[d, a, 2], across[d, a, 3] = x, y, z, w
    for k in range(1 if order == 0 else 3 if order == 1 else 6):
        # How often along u and along v.
        du = 1 if k == 1 or k == 5 else 2 if k == 3 else 0
        dv = 1 if k == 2 or k == 5 else 2 if k == 4 else 0
        for c in range(wide):
            total = 0.0
            for a in range(net.degree_u + 1):
                total += bu[du, a] * across[dv, a, c]
            result[k, c] = total


@kernel
def _divided(result, origin, order, out):
    """Write the quotients of a rational surface by its weight, and their derivatives."""
    w = result[0, 3]
    for c in range(3):
        p = result[0, c] / w
        out[0, c] = origin[c] + p
        if order > 0:
            pu, pv = (result[1, c] - result[1, 3] * p) / w, (result[2, c] - result[2, 3] * p) / w
            out[1, c], out[2, c] = pu, pv
            if order > 1:
                out[3, c] = (result[3, c] - 2.0 * result[1, 3] * pu - result[3, 3] * p) / w
                out[4, c] = (result[4, c] - 2.0 * result[2, 3] * pv - result[4, 3] * p) / w
                out[5, c] = (result[5, c] - result[1, 3] * pv - result[2, 3] * pu - result[5, 3] * p) / w


@kernel
def _point(u, v, net, order, workspace, out):
    """Write value and derivatives at one pair of parameters."""
    s = wrapped(u, net.knot_u[net.degree_u], net.period_u)
    t = wrapped(v, net.knot_v[net.degree_v], net.period_v)
    if not (s - s == 0.0 and t - t == 0.0):
        out[:] = np.nan
        return
    row, column = span(net.knot_u, net.degree_u, s), span(net.knot_v, net.degree_v, t)
    basis(net.knot_u, net.degree_u, row, s, order, workspace.left, workspace.right, workspace.table, workspace.bu)
    basis(net.knot_v, net.degree_v, column, t, order, workspace.left, workspace.right, workspace.table, workspace.bv)
    _summed(net, row, column, order, workspace)
    if net.rational:
        _divided(workspace.found, workspace.origin, order, out)
        return
    for k in range(len(out)):
        for c in range(3):
            out[k, c] = workspace.found[k, c] + (workspace.origin[c] if k == 0 else 0.0)


@entry
def evaluate(u, v, net, out):
    """Write values and derivatives of a surface at u, v (n,) into `out` (n, 1, 3 or 6, 3).

    These are S; Su, Sv; Suu, Svv, Suv, as many as there is room for; nan where a parameter is none.
    """
    order = 0 if out.shape[1] == 1 else 1 if out.shape[1] == 3 else 2
    wide = DEGREE + 1
    workspace = _Workspace(
        np.empty((3, wide)), np.empty((3, wide)), np.empty(wide), np.empty(wide), np.empty((wide, wide)),
        np.empty((3, wide, 4)), np.empty((6, 4)), np.empty(3),
    )  # fmt: skip
    for i in range(len(u)):
        _point(u[i], v[i], net, order, workspace, out[i])


@kernel
def _bezier(knot, degree, low, a, b, work, out):
    """Write the shares (degree + 1, degree + 1) that the poles of a span have in its control points over [a, b]."""
    for j in range(degree + 1):
        for i in range(degree + 1):
            for k in range(degree + 1):
                work[i, k] = 1.0 if i == k else 0.0
        for r in range(1, degree + 1):
            t = a if r <= degree - j else b
            for i in range(degree, r - 1, -1):
                first = knot[low - degree + i]
                share = (t - first) / (knot[low + 1 + i - r] - first)
                for k in range(degree + 1):
                    work[i, k] = (1.0 - share) * work[i - 1, k] + share * work[i, k]
        for k in range(degree + 1):
            out[j, k] = work[degree, k]


@kernel
def _interval(knot, degree, period, a, b):
    """The span that a cell lies in, and the cell's ends, moved there by whole periods."""
    middle = 0.5 * (a + b)
    moved = wrapped(middle, knot[degree], period) - middle
    return span(knot, degree, middle + moved), a + moved, b + moved


@kernel
def _ball(cell, p, q, times_u, times_v, wide_u, wide_v, work, out):
    """Write middle (4,) and radii (of the point, of the weight) of a derivative of a Bezier patch into `out` (6,)."""
    for i in range(p + 1):
        for j in range(q + 1):
            for c in range(4):
                work[i, j, c] = cell[i, j, c]
    for k in range(times_u):
        for i in range(p - k):
            for j in range(q + 1):
                for c in range(4):
                    work[i, j, c] = (work[i + 1, j, c] - work[i, j, c]) * ((p - k) / wide_u)
    for k in range(times_v):
        for i in range(p + 1 - times_u):
            for j in range(q - k):
                for c in range(4):
                    work[i, j, c] = (work[i, j + 1, c] - work[i, j, c]) * ((q - k) / wide_v)
    rows, columns = p + 1 - times_u, q + 1 - times_v
    out[:] = 0.0
    if rows <= 0 or columns <= 0:
        return
    for c in range(4):
        for i in range(rows):
            for j in range(columns):
                out[c] += work[i, j, c]
        out[c] /= rows * columns
    for i in range(rows):
        for j in range(columns):
            off = 0.0
            for c in range(3):
                off += (work[i, j, c] - out[c]) ** 2
            out[4] = max(out[4], np.sqrt(off))
            out[5] = max(out[5], abs(work[i, j, 3] - out[3]))


@kernel
def _length(a):
    return np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@kernel
def _less(ball, weight, other):
    """Subtract the product of a scalar, middle and radius in `weight` 3 and 5, and a ball, `other`, from a ball."""
    w, spread = weight[3], weight[5]
    size = _length(other)
    for c in range(3):
        ball[c] -= w * other[c]
    ball[4] += abs(w) * other[4] + spread * (size + other[4])


@kernel
def _over(ball, low, high):
    """Divide a ball by a weight between two positive ends."""
    middle, half = 0.5 * (1.0 / low + 1.0 / high), 0.5 * (1.0 / low - 1.0 / high)
    ball[4] = middle * ball[4] + half * (_length(ball) + ball[4])
    for c in range(3):
        ball[c] *= middle


@kernel
def _share(i, j, a, b, p, q):
    """The share of pole (i - a, j - b) of a patch of degrees p, q in pole (i, j) one degree higher; 0 where there is none."""
    if not (0 <= i - a <= p and 0 <= j - b <= q):
        return 0.0
    return (i if a else p + 1 - i) * (j if b else q + 1 - j) / ((p + 1.0) * (q + 1.0))


@kernel
def _less_affine(cell, p, q, slope, raised):
    """Leave in `raised`, one degree higher each way, a rational patch less its weight times an affine map, S about.

    What is left is as small as the patch is flat, so that little is lost when its quotients are bounded term by term. `slope`
    (2, 3) is left the map's derivatives over the whole patch.
    """
    low, high = np.inf, -np.inf
    for i in range(p + 1):
        for j in range(q + 1):
            low, high = min(low, cell[i, j, 3]), max(high, cell[i, j, 3])
    for i in range(p + 2):
        for j in range(q + 2):
            for c in range(4):
                raised[i, j, c] = 0.0
            for a in range(2):
                for b in range(2):
                    share = _share(i, j, a, b, p, q)
                    if share > 0.0:
                        w = share * cell[i - a, j - b, 3]
                        raised[i, j, 3] += w
                        for c in range(3):
                            raised[i, j, c] += share * cell[i - a, j - b, c]
    for c in range(3):
        p00, p01 = cell[0, 0, c] / cell[0, 0, 3], cell[0, q, c] / cell[0, q, 3]
        p10, p11 = cell[p, 0, c] / cell[p, 0, 3], cell[p, q, c] / cell[p, q, 3]
        slope[0, c], slope[1, c] = 0.5 * (p10 - p00 + p11 - p01), 0.5 * (p01 - p00 + p11 - p10)
        origin = 0.25 * (p00 + p01 + p10 + p11) - 0.5 * (slope[0, c] + slope[1, c])
        for i in range(p + 2):
            for j in range(q + 2):
                for a in range(2):
                    for b in range(2):
                        # A share of a corner of the square is the value of 1, s or t there.
                        share = _share(i, j, a, b, p, q)
                        if share > 0.0:
                            raised[i, j, c] -= share * cell[i - a, j - b, 3] * (origin + a * slope[0, c] + b * slope[1, c])
    return low, high


@kernel
def _of_cell(cell, p, q, wide_u, wide_v, rational, workspace):
    """Leave the balls of S, Su, Sv, Suu, Svv, Suv over a patch in `room.ball` (6, 6)."""
    ball, low, high = workspace.ball, 1.0, 1.0
    if rational:
        low, high = _less_affine(cell, p, q, workspace.slope, workspace.raised)
        if not low > 0.0:
            ball[:] = np.inf
            return
        cell, p, q = workspace.raised, p + 1, q + 1
    for k in range(0 if rational else 1, 6):
        du = 1 if k == 1 or k == 5 else 2 if k == 3 else 0
        dv = 1 if k == 2 or k == 5 else 2 if k == 4 else 0
        _ball(cell, p, q, du, dv, wide_u, wide_v, workspace.work, ball[k])
    if not rational:
        return
    for k in range(6):
        if k == 3 or k == 4:
            _less(ball[k], ball[k - 2], ball[k - 2])
            _less(ball[k], ball[k - 2], ball[k - 2])
        elif k == 5:
            _less(ball[5], ball[1], ball[2])
            _less(ball[5], ball[2], ball[1])
        if k > 0:
            _less(ball[k], ball[k], ball[0])
        _over(ball[k], low, high)
    for c in range(3):
        ball[1, c] += workspace.slope[0, c] / wide_u
        ball[2, c] += workspace.slope[1, c] / wide_v


@kernel
def _row(net, low, share, rows):
    """Sum the poles of a span along u into rows of control points."""
    p = net.degree_u
    for a in range(p + 1):
        for j in range(net.pole.shape[1]):
            for c in range(4):
                total = 0.0
                for i in range(p + 1):
                    total += share[a, i] * net.pole[low - p + i, j, c]
                rows[a, j, c] = total


@entry
def of_net(net, u, v, bends):
    """Write the bends of a B-spline surface over cells between increasing lines u (a + 1,), v (b + 1,), among which its inner
    knots are.

    They are infinite where a weight may be zero.
    """
    p, q = net.degree_u, net.degree_v
    wide = max(p, q) + 1
    workspace = _BendsWorkspace(
        np.empty((p + 1, net.pole.shape[1], 4)), np.empty((p + 1, q + 1, 4)), np.empty((p + 2, q + 2, 4)),
        np.empty((p + 2, q + 2, 4)), np.empty((wide, wide)), np.empty((wide, wide)), np.empty((6, 6)), np.empty((2, 3)),
        np.empty(len(v) - 1, np.int64), np.empty((len(v) - 1, q + 1, q + 1)),
    )  # fmt: skip
    _fill(net, u, v, bends, workspace)


class _BendsWorkspace(NamedTuple):
    """Room to work in."""

    rows: Any
    cell: Any
    raised: Any
    work: Any
    share: Any
    square: Any
    ball: Any
    slope: Any
    left: Any
    across: Any


@kernel
def _fill(net, u, v, bends, workspace):
    p, q, cell, ball = net.degree_u, net.degree_v, workspace.cell, workspace.ball
    for j in range(len(v) - 1):
        workspace.left[j], a, b = _interval(net.knot_v, q, net.period_v, v[j], v[j + 1])
        _bezier(net.knot_v, q, workspace.left[j], a, b, workspace.square, workspace.across[j])
    for i in range(len(u) - 1):
        top, a, b = _interval(net.knot_u, p, net.period_u, u[i], u[i + 1])
        _bezier(net.knot_u, p, top, a, b, workspace.square, workspace.share)
        _row(net, top, workspace.share, workspace.rows)
        for j in range(len(v) - 1):
            previous, share = workspace.left[j], workspace.across[j]
            for k in range(p + 1):
                for m in range(q + 1):
                    for c in range(4):
                        total = 0.0
                        for n in range(q + 1):
                            total += share[m, n] * workspace.rows[k, previous - q + n, c]
                        cell[k, m, c] = total
            _of_cell(cell, p, q, u[i + 1] - u[i], v[j + 1] - v[j], net.rational, workspace)
            for k in range(3):
                for c in range(3):
                    bends.middle[i, j, k, c] = ball[3 + k, c]
                bends.spread[i, j, k] = ball[3 + k, 4]
            for k in range(2):
                bends.first[i, j, k] = _length(ball[1 + k]) + ball[1 + k, 4]


def net_bends(net: Net, u: Floats, v: Floats) -> Bends:
    """Bends of a B-spline surface over cells between lines (a + 1,), (b + 1,), among which its inner knots must be."""
    bends = Bends.none(u, v)
    of_net(net, u, v, bends)
    return bends
