"""Draw the page `house.md`: the rooms, what each is for, and which may import which, from the import contracts.

python docs/house.py [--check]
"""

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = Path(__file__).with_suffix(".md")
CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
#: Packages that only read what the core makes, then the core, then the boundary.
BASE = "plan_cutters_base"
LEAVES = sorted({path.parent.name for path in ROOT.glob("plugin/plan_cutters_*/__init__.py")} - {BASE})

HEAD = """# The house

`python docs/house.py` draws this page from the import contracts in `pyproject.toml`, which each run of CI keeps. The sentence
about a room is the first one of its own text. [What to touch for which change](maintainers.md) is another page.

A part is read, sampled and tessellated (`cad_io`); each cutter is judged at each sample (`judging` over `scene` and `kernels`);
what follows from the verdicts is worked out (`operations`, `answers`); the plan file is put together (`document`) and written
with pictures and models (`report`). `pipeline` alone knows this order. `command` takes words and gives an exit code.

## Packages

"""
ENTRY = """
The core imports none of the first ones; their commands come by entry points of the group `plan_cutters.commands`, as those of
a stranger's package do."""
BELOW = "A room imports from rooms below it alone; rooms on one floor do not import each other."


def sentence(path: Path) -> str:
    """Read the first sentence of a module or room."""
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return re.split(r"(?<=[.?]) (?=[A-Z])", " ".join(text.split()))[0]


def place(package: str) -> Path:
    """Find the folder of a package."""
    return ROOT / package if package == "cad_io" else ROOT / "plugin" / package


def wall(package: str) -> str:
    """Find the contract that parts a package from others: that about the fewest packages."""
    about = [each for each in CONTRACTS if package in each.get("source_modules", ())]
    return min(about, key=lambda each: len(each["source_modules"]))["name"]


def floors(package: str) -> list[list[str]]:
    """List the rooms of a package, floor by floor, the highest first."""
    (contract,) = (each for each in CONTRACTS if each.get("containers") == [package])
    return [layer.replace(":", "|").replace(" ", "").split("|") for layer in contract["layers"]]


def drawn() -> Iterator[str]:
    """Draw the page, line by line."""
    yield "| package | for | its wall |\n|---|---|---|"
    for name in (*LEAVES, "plan_cutters", "cad_io", BASE):
        yield f"| `{name}` | {sentence(place(name) / '__init__.py')} | {wall(name)} |"
    yield ENTRY
    for package in ("plan_cutters", "cad_io"):
        yield f"\n## Floors of {package}\n\n{BELOW}\n"
        yield "| floor | room | for |\n|---:|---|---|"
        for floor, rooms in zip(range(len(floors(package)), 0, -1), floors(package), strict=True):
            for room in rooms:
                folder = place(package) / room
                path = folder / "__init__.py" if folder.is_dir() else folder.with_suffix(".py")
                yield f"| {floor} | `{room}` | {sentence(path)} |"
    yield "\n## Walls\n"
    for each in CONTRACTS:
        if each["type"] != "layers":
            yield f"- {each['name']}."


def main() -> None:
    text = HEAD + "\n".join(drawn()) + "\n"
    if "--check" in sys.argv[1:]:
        raise SystemExit(
            None if PAGE.read_text(encoding="utf-8") == text else "docs/house.md is an old one: python docs/house.py"
        )
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
