"""What is understood of real tool libraries: the table in docs/tool_libraries.md.

    python benchmarks/tool_files.py [FOLDER]

writes it. The folder (default: shared/data/tools beside the checkout) has a MANIFEST.csv with a column `file`. Libraries with
broken tools are read with --skip-bad, and the table says so.
"""

import csv
import sys
from collections import Counter
from pathlib import Path

from plan_cutters.errors import LibraryError
from plan_cutters.library.read import listing

ROOT = Path(__file__).parent.parent
BEGIN, END = "<!-- table: benchmarks/tool_files.py -->", "<!-- end of table -->"


def row(path: Path) -> list[str]:
    """A file's line of the table."""
    try:
        library = listing(path, skip_bad=True)
    except LibraryError as error:
        return [path.name, "", "", "", "", f"refused: {error.cause}"]
    used = sum(entry.cutter is not None for entry in library.entries)
    reasons = Counter(f"{'broken: ' if entry.broken else ''}{entry.unused}" for entry in library.unused)
    why = "; ".join(f"{count} x {reason}" if count > 1 else reason for reason, count in reasons.items())
    held = len(library.holders)
    listed = f"{len(library.entries)}" if not held else f"{held} holder{'s' if held > 1 else ''}"
    if held and not library.entries:
        why = "holders alone: for --holder"
    return [path.name, library.format, listed, str(used), str(len(library)), why]


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT.parent / "shared" / "data" / "tools"
    with (folder / "MANIFEST.csv").open(newline="", encoding="utf-8") as manifest:
        names = sorted(line["file"] for line in csv.DictReader(manifest))
    head = ["file", "format", "listed", "used", "different", "not used, and why"]
    lines = [head, ["---"] * len(head), *(row(folder / name) for name in names)]
    table = "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
    page = ROOT / "docs" / "tool_libraries.md"
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    page.write_text(f"{before}{BEGIN}\n\n{table}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
