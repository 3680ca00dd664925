"""A face's surface as a function of its parameters."""

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.TopoDS import TopoDS_Face

from cad_io.arrays import Floats
from cad_io.kernel import domain, first_derivatives, may_refuse, second_derivatives, values
from cad_io.surface.forms import Evaluator, Form, form_of

#: Where our evaluators are tried, in shares of the ranges; how far they may be off, in shares of what is found; parameters
#: beyond which an endless range is not looked at.
_TRIED = np.array([[0.13, 0.37, 0.61, 0.89, 0.5], [0.71, 0.23, 0.47, 0.93, 0.05]])
_AGREE, _FAR = 1e-8, 1e3


class Surface:
    """Evaluator of a face's whole surface (not restricted to the face), in part coordinates.

    Planes, quadrics and tori are evaluated in closed form, B-spline and Bezier surfaces, also extruded and turned curves of
    these kinds, by compiled code, all others by the kernel.

    Attributes
    ----------
    adaptor : BRepAdaptor_Surface
        The kernel's own evaluator, the reference.
    """

    __slots__ = ("_evaluate", "_form", "adaptor")

    def __init__(self, face: TopoDS_Face) -> None:
        self.adaptor = BRepAdaptor_Surface(face, False)
        self._evaluate: Evaluator | None = None
        self._form: Form | None = None

    @property
    def form(self) -> Form | None:
        """Return the data that evaluate the surface without the kernel; None where only the kernel evaluates it."""
        self._settle()
        return self._form

    def values(self, u: Floats, v: Floats) -> Floats:
        """Points (n, 3), mm, at parameters (n,); nan where there is none."""
        return self._evaluated(u, v, 1)[:, 0]

    def first(self, u: Floats, v: Floats) -> Floats:
        """S, Su, Sv as (n, 3, 3)."""
        return self._evaluated(u, v, 3)

    def second(self, u: Floats, v: Floats) -> Floats:
        """S, Su, Sv, Suu, Svv, Suv as (n, 6, 3)."""
        return self._evaluated(u, v, 6)

    def _evaluated(self, u: Floats, v: Floats, count: int) -> Floats:
        return self._settle()(np.ascontiguousarray(u, float), np.ascontiguousarray(v, float), count)

    def _settle(self) -> Evaluator:
        if self._evaluate is None:
            self._form = _trusted(self.adaptor)
            self._evaluate = self._form.evaluate if self._form else _by_kernel(self.adaptor)
        return self._evaluate


def _trusted(adaptor: BRepAdaptor_Surface) -> Form | None:
    """Our form where it agrees with the kernel's values at some points: triangles stand on it."""
    ours = None
    with may_refuse():
        ends = domain(adaptor)
        ours = form_of(adaptor)
    if ours is None:
        return None
    u0, u1, v0, v1 = np.clip(ends, -_FAR, _FAR)
    u, v = u0 + _TRIED[0] * (u1 - u0), v0 + _TRIED[1] * (v1 - v0)
    with np.errstate(all="ignore"):
        here, there = ours.evaluate(u, v, 3), _by_kernel(adaptor)(u, v, 3)
        scale = np.abs(there).max(axis=(0, 2), keepdims=True)
        agree = bool((np.abs(here - there) <= _AGREE * scale).all())
    return ours if agree else None


def _by_kernel(adaptor: BRepAdaptor_Surface) -> Evaluator:
    def evaluate(u: Floats, v: Floats, count: int) -> Floats:
        if count == 1:
            return values(adaptor, u, v)[:, None]
        return first_derivatives(adaptor, u, v) if count == 3 else second_derivatives(adaptor, u, v)

    return evaluate
