"""Turns of the tool axis in simultaneous motion, where they are proved."""

from dataclasses import dataclass

from cad_io.arrays import Floats, Ints


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """How the tool axis turns in simultaneous motion, where that is proved.

    Attributes
    ----------
    axis : (n, 3) float
        Unit tool axis of the proposed field at each sample; nan where there is none.
    piece : (n,) int32
        Connected proved piece about each sample, the largest first; -1: nothing is proved there.
    area : tuple of float
        Of each piece that counts, mm2: the largest, until they hold 99 % of what is proved.
    steepest : float
        Largest turn of the axis from one sample to the next in a piece, over their distance, deg/mm.
    low, high : (2,) float, optional
        Least and largest angles of the rotary axes, deg, over the pieces that one solution holds; None where there is none, or
        the machine has no two rotary axes.
    held, both : float
        Shares of what is proved that lie in pieces which one solution of the rotary axes holds from end to end, without a turn
        back; and which both hold.
    singular : float
        Proved area in which the axis is within 2 deg of the first rotary axis, mm2: that one may have to turn fast.
    """

    axis: Floats
    piece: Ints
    area: tuple[float, ...]
    steepest: float
    low: Floats | None
    high: Floats | None
    held: float
    both: float
    singular: float
