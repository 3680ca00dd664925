"""What is understood of real machine files: the table in docs/machines.md.

    python benchmarks/machines.py [FOLDER]

writes it. The folder (default: shared/data/machines beside the checkout) has a MANIFEST.csv with a column `file`. Files that
leave the order of their axes open are read as `ADDED` says, and the table shows it. A file that includes another is read beside a
copy of it in a folder of its own: nothing is written into the folder of the files.
"""

import csv
import shutil
import sys
import tempfile
from pathlib import Path

from plan_cutters.errors import MachineError
from plan_cutters.machines.explain import limits_text, share, share_text
from plan_cutters.machines.read import described

ROOT = Path(__file__).parent.parent
BEGIN, END = "<!-- table: benchmarks/machines.py -->", "<!-- end of table -->"
#: What is said beside a file, as the machine's maker describes it: the B table of a Pocket NC stands on its A axis.
ADDED = {"pocketnc_v1revH.linuxcnc.ini": "B,A", "pocketnc_v2revR.linuxcnc.ini": "B,A"}
#: Files as they are called where they are included.
INCLUDED = {"linuxcnc_max5_base.inc": "max5_base.inc"}


def row(path: Path, added: str = "") -> list[str]:
    """A file's line of the table."""
    name = path.name + (f"#{added}" if added else "")
    try:
        machine, form = described(path, added)
    except MachineError as error:
        return [name, "", "", "", f"refused: {error.cause}"]
    axes = "; ".join(f"{axis.name} ({axis.carries}) {limits_text(axis)}" for axis in machine.rotary) or "none"
    return [name, form, axes, share_text(machine, share(machine).held), "; ".join(machine.notes)]


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT.parent / "shared" / "data" / "machines"
    with (folder / "MANIFEST.csv").open(newline="", encoding="utf-8") as manifest:
        names = sorted(line["file"] for line in csv.DictReader(manifest))
    head = ["file", "format", "rotary axes, from the part to the tool", "directions held", "notes, or why refused"]
    lines = [head, ["---"] * len(head)]
    with tempfile.TemporaryDirectory() as aside:
        for name in names:
            shutil.copyfile(folder / name, Path(aside) / name)
        for name, called in INCLUDED.items():
            shutil.copyfile(folder / name, Path(aside) / called)
        for name in names:
            lines += [row(Path(aside) / name)] + ([row(Path(aside) / name, ADDED[name])] if name in ADDED else [])
    table = "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
    page = ROOT / "docs" / "machines.md"
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, _, after = rest.partition(END)
    page.write_text(f"{before}{BEGIN}\n\n{table}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
