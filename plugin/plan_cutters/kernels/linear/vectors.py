"""Vectors of three numbers, and the frame in which a cutter is tilted."""

import numpy as np

from plan_cutters.kernels.jit import kernel


@kernel
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross(a, b, out):
    """Write a x b."""
    out[0], out[1], out[2] = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def perpendicular(n, out):
    """Write any unit direction across a unit direction."""
    k = 0 if abs(n[0]) < 0.6 else 1
    for i in range(3):
        out[i] = -n[k] * n[i]
    out[k] += 1.0
    size = np.sqrt(dot(out, out))
    for i in range(3):
        out[i] /= size


@kernel
def tilt_frame(e1, e2, cosine, sine, f, t):
    """Write the tilt direction f at a rotation, and t = n x f."""
    for k in range(3):
        f[k] = cosine * e1[k] + sine * e2[k]
        t[k] = cosine * e2[k] - sine * e1[k]
