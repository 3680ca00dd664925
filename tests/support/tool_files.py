"""Small tool libraries, written by tests in each format from the same tools, and where the real ones are."""

import csv
import io
import json
import zipfile

from tests.support.places import DATA, real_file

REAL = DATA / "tools"


def section(height, lower, upper=None):
    """A section of a holder or a shaft as Fusion has it."""
    return {"height": height, "lower-diameter": lower, "upper-diameter": lower if upper is None else upper}


#: mm; two segments of a holder and a shaft of one cone.
HOLDER = {"type": "holder", "unit": "millimeters", "description": "chuck", "gaugeLength": 30, "segments": [
    section(20, 24, 30), section(10, 40)]}  # fmt: skip
GEOMETRY = {"DC": 6, "LCF": 12, "LB": 40, "OAL": 60, "SFDM": 8, "shoulder-length": 16, "shoulder-diameter": 5.6}
SHAFT = {"segments": [section(4, 5.6, 8)]}
#: What these say.
ID = "R3L40F12N2.8x4N2.8:4x4S4HR12:15L20+R20L10"


def fusion(
    kind="flat end mill", *, number=1, holder=HOLDER, shaft=SHAFT, unit="millimeters", name="a tool", tapered=None, **geometry
):
    """A Fusion tool; a dimension of None is left out. `tapered`: which tip a tapered mill has."""
    numbers = {key.replace("_", "-"): value for key, value in geometry.items()}
    table = {key: value for key, value in {**GEOMETRY, **numbers}.items() if value is not None}
    found = {"type": kind, "unit": unit, "description": name, "geometry": table, "post-process": {"number": number}}
    more = {"holder": holder, "shaft": shaft, "tapered-type": tapered}
    return found | {key: value for key, value in more.items() if value}


def in_inches(tool):
    """The same tool in inches."""

    def turned(value):
        if isinstance(value, dict):
            return {k: ("inches" if k == "unit" else v if k in ("TA", "post-process") else turned(v)) for k, v in value.items()}
        if isinstance(value, list):
            return [turned(each) for each in value]
        return value / 25.4 if isinstance(value, int | float) and not isinstance(value, bool) else value

    return turned(tool)


def write_json(path, tools, **more):
    path.write_text(json.dumps({"data": tools, "version": 36, **more}, indent=1), encoding="utf-8")
    return path


def write_tools(path, tools):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("tools.json", json.dumps({"data": tools}))
    return path


_COLUMNS = {"tool_diameter": "DC", "tool_cornerRadius": "RE", "tool_fluteLength": "LCF", "tool_bodyLength": "LB",
            "tool_overallLength": "OAL", "tool_shaftDiameter": "SFDM", "tool_shoulderLength": "shoulder-length",
            "tool_shoulderDiameter": "shoulder-diameter", "tool_taperAngle": "TA",
            "tool_tipDiameter": "tip-diameter", "tool_maximumCuttingDiameter": "DCX", "tool_threadPitch": "TP"}  # fmt: skip


def write_csv(path, tools, *, delimiter=",", comma=False):
    def said(value):
        return "" if value is None else f"{value:g}".replace(".", "," if comma else ".")

    def segments(item):
        rows = (item or {}).get("segments", [])
        return "; ".join(f"H{said(s['height'])} U{said(s['upper-diameter'])} L{said(s['lower-diameter'])}" for s in rows)

    out = io.StringIO()
    writer = csv.writer(out, delimiter=delimiter, lineterminator="\n")
    names = [
        "tool_type",
        "tool_description",
        "tool_number",
        "tool_unit",
        *_COLUMNS,
        "tool_taperedType",
        "shaft_segments",
        "holder_segments",
    ]
    writer.writerow([*(f"Label ({name})" for name in names), "CSV_TOOLS_VERSION_1"])
    for tool in tools:
        head = [tool["type"], tool["description"], tool["post-process"]["number"], tool["unit"]]
        sizes = [said(tool["geometry"].get(key)) for key in _COLUMNS.values()]
        sizes.append(tool.get("tapered-type", ""))
        writer.writerow([*head, *sizes, segments(tool.get("shaft")), segments(tool.get("holder"))])
    path.write_text(out.getvalue(), encoding="utf-8-sig")
    return path


_BODY = {"diameter": "DC", "corner-radius": "RE", "flute-length": "LCF", "body-length": "LB", "overall-length": "OAL",
         "shaft-diameter": "SFDM", "shoulder-length": "shoulder-length", "shoulder-diameter": "shoulder-diameter",
         "taper-angle": "TA", "tip-diameter": "tip-diameter", "tapered-type": "tapered-type", "thread-pitch": "TP"}  # fmt: skip


def hsmlib(tools, before=""):
    lines = ['<?xml version="1.0" encoding="UTF-16"?>', before, '<tool-library xmlns="http://www.hsmworks.com/xml">']
    for tool in tools:
        lines.append(f'<tool type="{tool["type"]}" unit="{tool["unit"]}"><description>{tool["description"]}</description>')
        lines.append(f'<nc number="{tool["post-process"]["number"]}"/>')
        given = tool["geometry"] | {"tapered-type": tool.get("tapered-type", "")}
        lines.append("<body " + " ".join(f'{word}="{given[key]}"' for word, key in _BODY.items() if key in given) + "/>")
        for tag in ("holder", "shaft"):
            lines.append(f"<{tag}>")
            for each in tool.get(tag, {}).get("segments", []):
                lines.append(f'<section diameter="{each["lower-diameter"]}" length="0"/>')
                lines.append(f'<section diameter="{each["upper-diameter"]}" length="{each["height"]}"/>')
            lines.append(f"</{tag}>")
        lines.append("</tool>")
    return "\n".join([*lines, "</tool-library>"])


def write_hsmlib(path, tools, before=""):
    path.write_bytes(hsmlib(tools, before).encode("utf-16"))
    return path


def write_bit(path, shape="Endmill", **parameters):
    path.parent.mkdir(parents=True, exist_ok=True)
    given = {"Diameter": "6.0000 mm", "CuttingEdgeHeight": "12.0 mm", "Length": "60 mm", "ShankDiameter": "6.0 mm"}
    table = {key: value for key, value in {**given, **parameters}.items() if value is not None}
    path.write_text(json.dumps({"version": 2, "name": path.stem, "shape-type": shape, "parameter": table}), encoding="utf-8")
    return path


def real(name):
    return real_file(f"tools/{name}")
