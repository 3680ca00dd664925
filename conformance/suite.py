"""The suite as files: what a program that is scored reads.

`made.json` and `real.json` describe the parts with their tools, setups and answers; `made.parquet` and `real.parquet` hold the postures.
The files of made parts lie in `made/`; those of real parts are fetched (`python -m conformance fetch`).
"""

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from conformance import VERSION
from conformance.posture import Postures
from conformance.tool import Tool

#: Where the suite's own files lie, and where real parts are fetched to.
DATA = Path(__file__).parent / "data"
FETCHED = DATA / "fetched"

Box = tuple[tuple[float, float, float], tuple[float, float, float]]


@dataclass(frozen=True)
class Held:
    """A setup as files have it: lengths mm, angles degrees, part coordinates."""

    axis: tuple[float, float, float]
    limit_deg: float | None
    boxes: tuple[Box, ...]
    table: float | None


@dataclass(frozen=True)
class Part:
    """A part of the suite: its file and what is asked of it."""

    name: str
    family: str
    title: str
    path: Path
    tools: Mapping[str, Tool]
    setups: Mapping[str, Held]
    answers: tuple[Mapping[str, Any], ...]
    twin_of: str | None = None


@dataclass(frozen=True)
class Suite:
    """Parts and postures."""

    parts: Mapping[str, Part]
    postures: Postures

    def groups(self) -> Iterator[tuple[Part, Tool, str, np.ndarray]]:
        """Yield part, tool, name of the setup, and the rows of the table that belong to them."""
        t = self.postures
        keys = np.char.add(np.char.add(np.char.add(np.char.add(t.part, "|"), t.tool), "|"), t.setup)
        order = list(dict.fromkeys(keys.tolist()))
        for key in order:
            part, tool, setup = key.split("|")
            yield self.parts[part], self.parts[part].tools[tool], setup, np.flatnonzero(keys == key)

    def rows(self, each: int, names: set[str] | None = None) -> np.ndarray:
        """Return the rows of at most `each` postures a part, evenly taken, of the parts named (default: all)."""
        rows = [np.zeros(0, int)]
        for name in self.parts:
            if names is None or name in names:
                mine = np.flatnonzero(self.postures.part == name)
                rows.append(mine[np.unique(np.linspace(0, max(0, len(mine) - 1), min(each, len(mine))).astype(int))])
        return np.concatenate(rows)

    def some(self, each: int, names: set[str] | None = None) -> "Suite":
        """Return a suite of at most `each` postures a part."""
        return Suite(self.parts, self.postures[self.rows(each, names)])


def tool_entry(tool: Tool) -> dict[str, Any]:
    """Return a tool as the file has it."""
    entry: dict[str, Any] = {"cutter": [list(v) for v in tool.cutter]}
    if tool.holder:
        entry["holder"] = [list(v) for v in tool.holder]
    if tool.cutting is not None:
        entry["cutting"] = tool.cutting
    return entry


def tool_of(name: str, entry: Mapping[str, Any]) -> Tool:
    """Return the tool of an entry."""
    rows = lambda key: tuple(tuple(float(x) for x in v) for v in entry.get(key, ()))
    return Tool(name, rows("cutter"), rows("holder"), entry.get("cutting"))


def setup_entry(axis: Any, limit_deg: float | None = None, boxes: Any = (), table: float | None = None) -> dict[str, Any]:
    """Return a setup as the file has it."""
    entry: dict[str, Any] = {"axis": [float(x) for x in axis]}
    if limit_deg is not None:
        entry["limit_deg"] = limit_deg
    if boxes:
        entry["boxes"] = [[[float(x) for x in corner] for corner in b] for b in boxes]
    if table is not None:
        entry["table"] = table
    return entry


def read(kind: str, folder: Path = DATA) -> Suite:
    """Read the suite `made` or `real`."""
    document = json.loads((folder / f"{kind}.json").read_text(encoding="utf-8"))
    if document.get("format") != "cutter-accessibility":
        raise ValueError(f"{kind}.json: its format is not cutter-accessibility")
    parts = {}
    for entry in document["parts"]:
        path = folder / "made" / entry["file"] if kind == "made" else FETCHED / entry["file"]
        held = {
            name: Held(tuple(s["axis"]), s.get("limit_deg"), tuple((tuple(a), tuple(b)) for a, b in s.get("boxes", ())), s.get("table"))
            for name, s in entry["setups"].items()
        }
        tools = {name: tool_of(name, tool) for name, tool in entry["tools"].items()}
        parts[entry["name"]] = Part(entry["name"], entry["family"], entry["title"], path, tools, held, tuple(entry.get("answers", ())), entry.get("twin_of"))
    return Suite(parts, Postures.read(folder / f"{kind}.parquet"))


def document(kind: str, parts: list[dict[str, Any]]) -> str:
    """Return the text of `made.json` or `real.json`."""
    head = {"format": "cutter-accessibility", "version": VERSION, "kind": kind, "unit": "mm", "angles": "deg", "parts": parts}
    return json.dumps(head, indent=1, ensure_ascii=False) + "\n"


def sha256(path: Path) -> str:
    """Return the checksum of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
