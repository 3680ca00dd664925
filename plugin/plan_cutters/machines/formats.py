"""The table of formats: what is read, and what is known well enough to say what to give instead.

What a file holds decides, not how it is called.
"""

import re
from collections.abc import Callable

from plan_cutters.domain.machine import Machine
from plan_cutters.files import formats
from plan_cutters.files.formats import Foreign, Format
from plan_cutters.machines import freecad, fusion, linuxcnc, toml
from plan_cutters.machines.files import Added, Content

Reader = Callable[[Content, Added], Machine]
FORMATS: tuple[Format[Reader], ...] = (
    Format("plan-cutters TOML", (".toml",), toml.is_toml, toml.read_toml),
    Format("plan-cutters JSON", (".json",), toml.is_json, toml.read_json),
    Format("FreeCAD machine", (".fcm",), freecad.is_fcm, freecad.read_fcm),
    Format("Fusion machine", (".mch",), fusion.is_mch, fusion.read_mch),
    Format("LinuxCNC configuration", (".ini",), linuxcnc.is_ini, linuxcnc.read_ini),
    Format("LinuxCNC configuration", (".ini",), linuxcnc.includes, linuxcnc.read_ini),
    # By its name alone, so that it is said where it is no TOML or what is missing.
    Format("plan-cutters TOML", (".toml",), toml.is_named, toml.read_toml),
)

_TOML = "write the machine as TOML (docs/machines.md)"


def _root(*names: str) -> Callable[[Content], bool]:
    pattern = re.compile(rf"<\s*(?:\w+:)?(?:{'|'.join(names)})\b", re.IGNORECASE)
    return lambda c: c.head.startswith("<") and pattern.search(c.head) is not None


def _suffix(*words: str) -> Callable[[Content], bool]:
    return lambda c: c.path.suffix.lower() in words


def _binary(content: Content) -> bool:
    return re.search(r"[\0-\x08\x0e-\x1f]", content.text[:65536]) is not None


FOREIGN = (
    Foreign("a web page (HTML)", _root("!doctype html", "html", "head", "body"),
            "download the machine itself: perhaps a log-in stands before it"),
    Foreign("a robot (URDF)", _root("robot"), f"no machine tool is known in it; {_TOML}"),
    Foreign("a robot (SDF)", _root("sdf"), f"no machine tool is known in it; {_TOML}"),
    Foreign("MTConnect data", _root("MTConnectDevices", "MTConnectStreams", "MTConnectAssets", "MTConnectError"),
            f"it does not say how the axes stand on each other; {_TOML}, ten lines do"),
    Foreign("a PowerMill machine", _suffix(".mtd"), _TOML),
    Foreign("a LinuxCNC HAL file", _suffix(".hal", ".tcl"), "give the .ini that names it"),
    Foreign("a LinuxCNC tool table", _suffix(".tbl"), "give the .ini as the machine; its tools go with --cutters"),
    Foreign("a Fusion tool library", lambda c: isinstance(c.json, dict) and isinstance(c.json.get("data"), list),
            "give it with --cutters"),
    Foreign("an ISO 10303-21 file (STEP)", lambda c: c.head.startswith("iso-10303-21"), _TOML),
    Foreign("a zip archive", lambda c: c.data.startswith(b"PK\x03\x04"), "give the machine that is in it"),
    Foreign("an SQLite database", lambda c: c.data.startswith(b"SQLite format 3\0"), _TOML),
    Foreign("a binary file", _binary, _TOML),
)  # fmt: skip


def recognised(content: Content) -> Format[Reader]:
    """The format of a file.

    Raises
    ------
    MachineError
        It is none that is read; by name, where it is known.
    """
    return formats.recognised(
        content,
        FORMATS,
        FOREIGN[1:],
        first=FOREIGN[:1],
        xml=f"no machine file that is known; {_TOML}",
        json="no machine of Fusion (kinematics), FreeCAD (machine.axes) or ours (part_chain)",
    )
