"""B-spline surfaces, rational or not, of any degree: values, first and second derivatives at many parameters.

Basis functions and their derivatives by de Boor's triangle (Piegl and Tiller, *The NURBS Book*, A2.2 and A2.3); rational
surfaces as quotients of these with the weight as a fourth coordinate (the same, A4.4).
"""

from typing import Any, NamedTuple

import numpy as np

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
    """This is a workspace: basis functions along u and v and their tables, rows summed along v, the sums, and the origin."""

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
    bu, bv, across, span, origin, pole = (
        workspace.bu,
        workspace.bv,
        workspace.across,
        workspace.found,
        workspace.origin,
        net.pole,
    )
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
            span[k, c] = total


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
    """Write values and derivatives of a surface.

    Parameters
    ----------
    u, v : (n,) float64
    net : Net
    out : (n, 1, 3, or 6, 3) float64, written
        S; Su, Sv; Suu, Svv, Suv, as many as there is room for. nan where a parameter is none.
    """
    order = 0 if out.shape[1] == 1 else 1 if out.shape[1] == 3 else 2
    wide = DEGREE + 1
    workspace = _Workspace(
        np.empty((3, wide)), np.empty((3, wide)), np.empty(wide), np.empty(wide), np.empty((wide, wide)),
        np.empty((3, wide, 4)), np.empty((6, 4)), np.empty(3),
    )  # fmt: skip
    for i in range(len(u)):
        _point(u[i], v[i], net, order, workspace, out[i])
