"""One cutter of each kind but the flat end, for laws of the area between samples."""

import math

from plan_cutters import Cutter

HOLDER = "R10:20L5+R20L55"
TOOLS = {
    "bull": Cutter.bull(radius=2, corner_radius=0.5, length=40),
    "ball": Cutter.ball(radius=2, length=40),
    "taper": Cutter.ball(radius=1.5, length=40, taper=math.radians(4)),
    "tapered bull": Cutter.bull(radius=2, corner_radius=0.5, length=40, taper=math.radians(4)),
    "tapered flat": Cutter.flat(radius=2, length=40, taper=math.radians(3)),
    "lollipop": Cutter.lollipop(radius=2, neck_radius=1, length=40),
    "barrel": Cutter.barrel(radius=2, flank_radius=20, tip_radius=0.7, length=40, flutes=7.0),
    "lens": Cutter.lens(radius=3, bottom_radius=15, corner_radius=0.5, length=40),
    "holder": Cutter.bull(radius=2, corner_radius=1, length=12, flutes=6.0, shank_radius=2.0, holder=HOLDER),
}
