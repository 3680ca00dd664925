"""Machine files for tests, and how a machine moves by rigid motions alone, without the code that is tested."""

import json

import numpy as np
from scipy.spatial.transform import Rotation


def moved(point, direction, angle):
    """A turn (4, 4) about a line."""
    turn = np.eye(4)
    turn[:3, :3] = Rotation.from_rotvec(angle * np.asarray(direction, float)).as_matrix()
    turn[:3, 3] = np.asarray(point) - turn[:3, :3] @ np.asarray(point)
    return turn


def shifted(direction, length):
    """A shift (4, 4)."""
    found = np.eye(4)
    found[:3, 3] = length * np.asarray(direction, float)
    return found


def tool_in_part(machine, at):
    """The place (4, 4) of the tool in the part, of a machine at positions by name (rad, mm); those not named are at 0."""
    found = np.eye(4)
    for axis in machine.axes:
        value = at.get(axis.name, 0.0)
        step = moved(axis.point, axis.direction, value) if axis.kind == "rotary" else shifted(axis.direction, value)
        found = found @ step
    return found


def own(part=(), tool=(), **more):
    """Our own format, as JSON has it."""
    return {
        "format": "plan-cutters-machine", "version": 1, "name": "mill", "units": {"length": "mm", "angle": "deg"},
        "sign": "tool-relative", "part_chain": list(part), "tool_chain": list(tool), **more,
    }  # fmt: skip


def rotary(name, direction, limits=None, **more):
    return {"axis": name, "type": "rotary", "direction": direction, **({"limits": limits} if limits else {}), **more}


def fcm(units="metric", **axes):
    return {"machine": {"name": "mill", "units": units, "axes": axes}, "version": 1}


def fcm_axis(role, direction, low=-90, high=90, parent=None, **more):
    kind = role.partition("_")[2]
    return {"type": kind, "role": role, "parent": parent, "joint": {"origin": [1, 2, 3], "axis": direction},
            "limits": {"min": low, "max": high}, "max_velocity": 600, **more}  # fmt: skip


def mch_axis(name, direction, *inner, kind="rotary", **more):
    where = {"direction": direction} if kind == "linear" else {"axis_of_rotation": {"direction": direction, "point": [1, 2, 3]}}
    return {"id": name, "name": name, "type": kind, "control": "driven", "parts": list(inner), **where, **more}


TABLE = {"id": "table", "type": "table"}
HEAD = {"id": "head", "type": "head", "attach_frame": {"z_direction": [0, 0, 1]}}


def mch(*parts, units=None, **more):
    units = {"length": "mm", "angle": "degrees"} if units is None else units
    return {"kinematics": {"default": {"parts": [{"id": "bed", "type": "static"}, *parts], "units": units}}, **more}


def ini(kinematics, coordinates, *lines, units="mm", limits=(-500, 500)):
    sections = [f"[AXIS_{each}]\nMIN_LIMIT = {limits[0]}\nMAX_LIMIT = {limits[1]}" for each in dict.fromkeys(coordinates)]
    return "\n".join(["[EMC]", "MACHINE = mill", "[KINS]", f"KINEMATICS = {kinematics}", "[TRAJ]", f"COORDINATES = {coordinates}",
                      f"LINEAR_UNITS = {units}", *sections, *lines, ""])  # fmt: skip


def write(folder, name, content):
    """A file of a text, bytes, or what JSON has."""
    path = folder / name
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path
