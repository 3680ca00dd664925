"""Write the file of translations anew, `python freecad/translations.py`: texts that the workbench marks with `tr` and `later`.

What was translated is kept, where its text in English is still there. `lrelease` (Qt) makes of a file `plan_cutters_de.ts`
beside it the `plan_cutters_de.qm` that FreeCAD reads.
"""

import ast
import xml.etree.ElementTree as ET
from pathlib import Path

FOLDER = Path(__file__).parent / "plan_cutters"
TEMPLATE = FOLDER / "translations" / "plan_cutters.ts"
CONTEXT = "PlanCutters"
MARKS = ("tr", "later")
#: FreeCAD translates the names of menus and toolbars itself, in a context of its own.
BARS, BARS_CONTEXT = ("Plan cutters", "&Plan cutters"), "Workbench"


def texts(folder: Path = FOLDER) -> list[str]:
    """All marked texts, in the order of modules and lines, each once.

    Raises
    ------
    ValueError
        A text is marked that is made while the workbench runs: none can translate it.
    """
    found: dict[str, None] = {}
    for path in sorted(folder.glob("*.py")):
        nodes = [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)]
        for node in sorted(nodes, key=lambda each: (each.lineno, each.col_offset)):
            if not isinstance(node.func, ast.Name) or node.func.id not in MARKS or path.name == "words.py":
                continue
            (given,) = node.args
            if isinstance(given, ast.Constant) and isinstance(given.value, str):
                found[given.value] = None
            elif not isinstance(given, (ast.Name, ast.Attribute)):
                raise ValueError(f"{path.name}:{node.lineno}: only a literal can be translated")
    return list(found)


def written(marked: list[str], before: str = "", language: str = "") -> str:
    """A file of translations with these texts, and what one before it translated."""
    done = {}
    if before:
        for message in ET.fromstring(before).iter("message"):
            answer = message.find("translation")
            if answer is not None and answer.text:
                done[message.findtext("source")] = answer.text
    root = ET.Element("TS", {"version": "2.1", **({"language": language} if language else {})})
    for name, mine in ((CONTEXT, marked), (BARS_CONTEXT, [text for text in BARS if text in marked])):
        context = ET.SubElement(root, "context")
        ET.SubElement(context, "name").text = name
        for text in mine:
            message = ET.SubElement(context, "message")
            ET.SubElement(message, "source").text = text
            answer = ET.SubElement(message, "translation", {} if text in done else {"type": "unfinished"})
            answer.text = done.get(text)
    ET.indent(root, " ")
    return '<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n' + ET.tostring(root, encoding="unicode") + "\n"


def main() -> None:
    """Write the template, and each language beside it."""
    TEMPLATE.parent.mkdir(exist_ok=True)
    for path in {TEMPLATE, *TEMPLATE.parent.glob("plan_cutters_*.ts")}:
        before = path.read_text(encoding="utf-8") if path.exists() else ""
        path.write_text(written(texts(), before, path.stem.removeprefix("plan_cutters").lstrip("_")), encoding="utf-8")


if __name__ == "__main__":
    main()
