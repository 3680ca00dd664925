"""Tools for holes, and libraries of them."""

from dataclasses import replace

import numpy as np

from plan_cutters import Cutter
from plan_cutters.domain.drill import Drill
from plan_cutters.library.raw_tool import Entry, Library


def library_of(*drills, feed=300.0):
    entries = [Entry(f"tool {i}", drill=each, feed=feed) for i, each in enumerate(drills, 1)]
    return Library("set.toml", "plan-cutters TOML", tuple(entries))


def tap(diameter, pitch, flutes=20.0, shank=None, left=False, **more):
    made = drill(diameter, flutes, point=None, kind="tap", **more)
    body = replace(made.body, shank_radius=0.5 * (diameter if shank is None else shank))
    return replace(made, body=body, pitch=pitch, left=left)


def drill(diameter, flutes=40.0, length=60.0, point=118.0, kind="drill", holder="R16L60"):
    body = Cutter.flat(radius=0.5 * diameter, length=length, flutes=flutes, shank_radius=0.5 * diameter, holder=holder)
    return Drill(kind, body, None if point is None else np.radians(point))
