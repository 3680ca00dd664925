"""plan-cutters, posture maps of single points: the only module, with `plan_cutters_claims`, that imports it."""

from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.protocol import BLOCKED, SAFE, UNDECIDED, Words
from conformance.suite import Held, Part
from conformance.tool import Floats, Tool

#: A tip (mm) and a tilt (rad) that are the same.
_SAME_MM, _SAME_RAD = 1e-4, 1e-9
#: Half the range of tilts (rad) that is asked for about a posture.
_ABOUT = np.radians(0.25)


class PointMaps:
    """A posture map at the contact, at the posture's rotation.

    Safe where its tilt is free, undecided where the map leaves it so, else blocked.
    """

    name = "plan-cutters"
    libraries: tuple[str, ...] = ("plan-cutters", "cadquery-ocp-novtk", "numba", "numpy")

    def __init__(self, tolerance: float = 0.01) -> None:
        self.settings: dict[str, Any] = {
            "tolerance_mm": tolerance,
            "call": "posture_map(Scene.of(part, setup, tolerance, fixtures), point, cutter, machine, "
            "rotations=[that of the posture], tilt=that of the posture and 0.25 deg about it)",
        }
        self.why: Counter[str] = Counter()
        self._scenes: dict[tuple[str, Any], Any] = {}
        self._parts: dict[str, Any] = {}

    def prepare(self, part: Part) -> None:
        """Read the part and gather what is in the way, without fixtures."""
        from cad_io import read_part

        self._parts[part.name] = read_part(part.path)
        for setup in part.setups.values():
            self._scene(part, setup)

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return words; `why` counts the reasons of those that are undecided."""
        from plan_cutters.errors import CutterError

        out = np.full(len(postures), UNDECIDED)
        try:
            cutter = cutter_of(tool)
        except (CutterError, ValueError) as error:
            self.why[f"no such cutter: {error}"] += len(postures)
            return out
        scene, machine = self._scene(part, setup), machine_of(setup)
        for i in range(len(postures)):
            word, why = self._one(scene, cutter, machine, tool, postures[i : i + 1])
            out[i] = word
            if word == UNDECIDED:
                self.why[why] += 1
        return out

    def _one(self, scene: Any, cutter: Any, machine: Any, tool: Tool, row: Postures) -> tuple[str, str]:
        """Return the word of one posture, and why it is undecided."""
        from cad_io.errors import CadIoError
        from cad_io.sample import locate
        from plan_cutters import posture_map

        point, axis = row.contact[0], row.axis[0]
        try:
            contact = locate(scene.part, scene.orientation, point, ignore=scene.ignored)
        except CadIoError as error:
            return UNDECIDED, f"no point of the part: {type(error).__name__}"
        normal, across = contact.normal[0], contact.direction_max[0]
        if not np.isfinite(normal).all() or not np.isfinite(across).all():
            return UNDECIDED, "no normal or no curvature at the contact"
        tilt, rotation = angles(normal, across, axis, point - row.tip[0])
        stands = tool.stands(point[None], normal[None], axis[None], lean_of(normal, across, rotation)[None])[0]
        if np.linalg.norm(stands - row.tip[0]) > _SAME_MM:
            return UNDECIDED, "the normal at the contact is another one: an edge, or another face"
        low, high = max(0.0, tilt - _ABOUT), min(np.pi, tilt + _ABOUT)
        pm = posture_map(scene, point=point, cutter=cutter, rotations=[rotation], tilt=(low, high), machine=machine, tolerance=self.settings["tolerance_mm"])
        if not pm.certified:
            return UNDECIDED, "the map is not certified: " + "; ".join(pm.missing)
        if _holds(pm.free[0], tilt, _SAME_RAD):
            return SAFE, ""
        if _holds(pm.undecided[0], tilt, 0.0):
            return UNDECIDED, "the map leaves the tilt undecided"
        if _holds(pm.no_contact[0], tilt, 0.0):
            return UNDECIDED, "the cutter does not touch at the tilt"
        return BLOCKED, ""

    def _scene(self, part: Part, setup: Held) -> Any:
        """Return the scene of a part in a setup, made once."""
        from plan_cutters.scene.scene import Scene

        key = (part.name, setup)
        if key not in self._scenes:
            scene = Scene.of(self._parts[part.name], setup=setup.axis, tolerance=self.settings["tolerance_mm"], fixtures=fixtures_of(setup))
            scene.surround()
            self._scenes[key] = scene
        return self._scenes[key]


def fixtures_of(setup: Held) -> list[Any]:
    """Return boxes and table of a setup as fixtures."""
    from plan_cutters.domain.fixture import Fixture

    made = []
    for low, high in setup.boxes:
        size = ",".join(repr(float(b - a)) for a, b in zip(low, high, strict=True))
        made.append(Fixture(f"box:{size}", placement=tuple(float(x) for x in low)))
    if setup.table is not None:
        made.append(Fixture(f"table:{setup.table!r}"))
    return made


def machine_of(setup: Held) -> Any:
    """Return the machine of a setup: a limit about its axis, or none."""
    return None if setup.limit_deg is None else f"tilt:{setup.limit_deg!r}"


def angles(normal: Floats, across: Floats, axis: Floats, towards: Floats) -> tuple[float, float]:
    """Return tilt and rotation, rad, of an axis; where it is the normal, the rotation is that of `towards`, tip to contact."""
    side = axis - (axis @ normal) * normal
    tilt = float(np.arctan2(np.linalg.norm(side), axis @ normal))
    if np.linalg.norm(side) < 1e-9:
        side = towards - (towards @ normal) * normal
    return tilt, float(np.arctan2(side @ np.cross(normal, across), side @ across)) % (2 * np.pi)


def lean_of(normal: Floats, across: Floats, rotation: float) -> Floats:
    """Return the unit vector across the normal at a rotation."""
    return np.asarray(np.cos(rotation) * across + np.sin(rotation) * np.cross(normal, across))


def cutter_of(tool: Tool) -> Any:
    """Return the cutter of an outline, exactly.

    Raises
    ------
    ValueError
        The outline is none that a cutter can have; also a CutterError.
    """
    from plan_cutters.domain.cutter import Cutter
    from plan_cutters.domain.holder import Holder, Segment

    top, corner = float(tool.cutter[-1][0]), tool.corner
    flutes = top if tool.cutting is None else float(tool.cutting)
    body, start = tool.cutter[2 if corner else 1 :], tool.cutter[1 if corner else 0]
    if any(len(v) > 2 for v in body) or (corner and abs(start[1] - tool.flat_radius - corner) > 1e-12):
        raise ValueError("an arc that is no corner under a cylinder")
    line = [(float(start[0]), float(start[1])), *((float(h), float(r)) for h, r in body)]
    if not any(abs(h - flutes) < 1e-9 for h, _ in line):
        raise ValueError("no vertex where the flutes end")
    last = next(i for i, (h, _) in enumerate(line) if abs(h - flutes) < 1e-9)
    cutting, above = line[: last + 1], line[last:]
    stages = [Segment(r0, h1 - h0, r1) for (h0, r0), (h1, r1) in pairwise(above) if h1 - h0 > 1e-9]
    holder, length = None, top
    if tool.holder:
        nose = float(tool.holder[0][0])
        if nose > top + 1e-9 or (nose < top - 1e-9 and (stages or cutting[-1][1] > tool.holder[0][1])):
            raise ValueError("a holder that begins where the cutter does not end")
        length = nose
        holder = Holder(tuple(Segment(float(a[1]), float(b[0] - a[0]), float(b[1])) for a, b in pairwise(tool.holder) if b[0] - a[0] > 1e-9))
    more: dict[str, Any] = {"holder": holder, "name": tool.name}
    if stages:
        more |= {"flutes": flutes, "neck": tuple(stages)}
    radius = cutting[0][1]
    if all(abs(r - radius) < 1e-12 for _, r in cutting):
        return Cutter(radius, length, corner, **more)
    if corner:
        raise ValueError("a round corner under a taper")
    if len(cutting) == 2:
        return Cutter(
            radius, length, taper=float(np.arctan2(cutting[1][1] - radius, flutes)), flutes=flutes, **{k: v for k, v in more.items() if k != "flutes"}
        )
    outline = ((0.0, 0.0), *((r, h) for h, r in cutting if (h, r) != (0.0, 0.0)))
    return Cutter.form(outline, length=length, **{k: v for k, v in more.items() if k != "flutes"})


def _holds(intervals: Floats, tilt: float, reach: float) -> bool:
    """Whether one of the intervals (k, 2) has the tilt by more than `reach` (rad) from its ends, but for 0 and 180 degrees."""
    return any((a + reach <= tilt or a <= 0.0) and (tilt <= b - reach or b >= np.pi) for a, b in intervals.tolist())
