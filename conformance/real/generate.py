"""Write the real half of the suite: `real.json` and `real.parquet`, from the fetched files."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from conformance.exact import slow
from conformance.exact.cells import UnfitError
from conformance.posture import Postures
from conformance.real.prove import postures, ready
from conformance.real.sources import Source, sources
from conformance.suite import DATA, FETCHED, document, setup_entry, tool_entry
from conformance.tool import Tool

#: The seed of what is drawn.
SEED = 0


def tools(diameter: float) -> list[Tool]:
    """Return the tools that ask about a part: a flat end with shank and holder, a bull nose, a ball end with holder."""
    d = diameter
    holder = ((5.5 * d, 1.6 * d), (8.0 * d, 1.6 * d), (9.0 * d, 2.2 * d))
    return [
        Tool.flat(d, 5.5 * d, flutes=3.0 * d, shank=d, holder=holder),
        Tool.flat(0.75 * d, 6.0 * d, corner=0.15 * d),
        Tool.ball(0.5 * d, 5.5 * d, flutes=1.5 * d, shank=0.8 * d, holder=holder),
    ]


def one(source: Source, folder: Path = FETCHED, tell: Callable[[str], None] = lambda line: None) -> Postures:
    """Return the proved postures of one part; an UnfitError says why there are none."""
    return postures(ready(slow.read(folder / source.file)), source.name, tools(source.diameter), source.postures, SEED, tell)


def entry(source: Source) -> dict[str, Any]:
    """Return a part as `real.json` has it."""
    return {
        "name": source.name,
        "family": "real",
        "title": f"{source.repo}: {source.path}",
        "file": source.file,
        "sha256": source.sha256,
        "licence": source.licence,
        "source": {"repo": source.repo, "path": source.path, "commit": source.commit},
        "tools": {t.name: tool_entry(t) for t in tools(source.diameter)},
        "setups": {"free": setup_entry((0.0, 0.0, 1.0))},
        "answers": [],
    }


def generate(folder: Path = DATA, fetched: Path = FETCHED, tell: Callable[[str], None] = lambda line: None) -> None:
    """Write the real half; a part that is not fetched or unfit is told and left out."""
    entries, tables = [], []
    for source in sources():
        try:
            tables.append(one(source, fetched, tell))
            entries.append(entry(source))
        except (UnfitError, ValueError, OSError) as error:
            tell(f"{source.file}: {error}")
    Postures.joined(tables).write(folder / "real.parquet")
    (folder / "real.json").write_text(document("real", entries), encoding="utf-8")


if __name__ == "__main__":
    # One part into a table of its own, for many processes side by side: `python -m conformance.real.generate NAME FETCHED OUT`.
    chosen = next(s for s in sources() if s.name == sys.argv[1])
    one(chosen, Path(sys.argv[2]), tell=lambda line: sys.stderr.write(line + "\n")).write(Path(sys.argv[3]))
