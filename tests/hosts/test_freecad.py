"""The add-on for FreeCAD says what it is: package.xml names its files, release and needs; its texts can be translated."""

import ast
import datetime
import re
import shutil
import tomllib
import xml.etree.ElementTree as ET
from types import ModuleType, SimpleNamespace

import pytest

from tests.support.freecad_host import CONSOLE, run
from tests.support.places import ROOT
from tests.support.workbench import imported

ADDON = ROOT / "freecad"


def test_the_addon_says_what_it_is():
    tree = ET.parse(ROOT / "package.xml")
    space = {"p": "https://wiki.freecad.org/Package_Metadata"}
    macros = tree.findall("p:content/p:macro", space)
    files = [ROOT / each.find("p:subdirectory", space).text / each.find("p:file", space).text for each in macros]
    assert sorted(files) == sorted(ADDON.glob("*.FCMacro"))
    for icon in (*tree.findall("p:icon", space), *tree.findall("p:content/p:workbench/p:icon", space)):
        assert (ROOT / icon.text).read_text().startswith("<svg")
    readme = next(url.text for url in tree.findall("p:url", space) if url.get("type") == "readme")
    assert (ADDON / readme.rpartition("/freecad/")[2]).is_file()
    version = re.search(r'^version = "(.*)"', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)[1]
    assert tree.find("p:version", space).text == version
    assert f'__version__ = "{version}"' in (ADDON / "plan_cutters" / "__init__.py").read_text()
    assert all(f'__Version__ = "{version}"' in file.read_text() for file in files)


SPACE = {"p": "https://wiki.freecad.org/Package_Metadata"}


def test_the_package_has_the_fields_that_the_addon_manager_asks_for():
    tree = ET.parse(ROOT / "package.xml")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for word in ("name", "version", "date", "description", "maintainer", "license", "icon", "content", "author", "pythonmin"):
        assert tree.find(f"p:{word}", SPACE) is not None, word
    assert [each.text for each in tree.findall("p:author", SPACE)] == [each["name"] for each in project["authors"]]
    # The date is that of the version: of its release, as soon as it has one.
    date = tree.find("p:date", SPACE).text
    assert datetime.date.fromisoformat(date)
    version = tree.find("p:version", SPACE).text
    heading = re.search(rf"^## {re.escape(version)} \((.*)\)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert heading[1] in ("unreleased", date)
    # One address for each thing, in both files.
    urls = {each.get("type"): each.text for each in tree.findall("p:url", SPACE)}
    assert {"repository", "readme", "documentation", "bugtracker"} <= set(urls)
    assert urls["documentation"] == project["urls"]["Documentation"]
    assert urls["repository"] == project["urls"]["Source"]
    assert urls["readme"].startswith(urls["repository"])


def test_the_workbench_is_written_in_the_oldest_python_that_it_asks_for():
    text = ET.parse(ROOT / "package.xml").find("p:pythonmin", SPACE).text
    oldest = tuple(int(each) for each in text.split("."))
    for path in (*(ADDON / "plan_cutters").glob("*.py"), ADDON / "Init.py", *ADDON.glob("*.FCMacro")):
        source = path.read_text(encoding="utf-8")
        tree = ast.parse(source, str(path), feature_version=oldest)
        # Types of newer releases are never looked up then.
        annotated = any(isinstance(node, ast.AnnAssign) or getattr(node, "returns", None) for node in ast.walk(tree))
        assert not annotated or "from __future__ import annotations" in source, path


@pytest.mark.skipif(not CONSOLE, reason="FreeCAD is not installed")
def test_freecad_reads_the_package(tmp_path):
    script = f"""
import json
import FreeCAD as App
package = App.Metadata({str(ROOT / "package.xml")!r})
found = dict(author=package.Author, urls=[each["type"] for each in package.Urls], least=package.FreeCADMin,
             content={{word: [each.Name for each in parts] for word, parts in package.Content.items()}}, version=package.Version)
"""
    found = run([CONSOLE], script, tmp_path)
    assert [each["name"] for each in found["author"]] == ["the plan-cutters developers"]
    assert "documentation" in found["urls"]
    assert found["least"] == "0.20.0"
    assert found["content"] == {"workbench": ["Plan Cutters"], "macro": ["Plan operations"]}


def translations():
    made = {"__file__": str(ADDON / "translations.py"), "__name__": "translations"}
    exec(compile((ADDON / "translations.py").read_text(encoding="utf-8"), "translations.py", "exec"), made)
    return SimpleNamespace(**made)


def test_the_file_of_translations_has_the_texts_of_the_workbench():
    """Where this fails, run `python freecad/translations.py`."""
    ours = translations()
    marked = ours.texts()
    assert ours.TEMPLATE.read_text(encoding="utf-8") == ours.written(marked)
    shown = {each.text for each in ET.parse(ours.TEMPLATE).iter("source")}
    assert {"Plan", "Stick-out", "Picked faces", "Plan cutters…", "{count} tools"} <= shown


def test_what_was_translated_is_kept_as_long_as_its_text_is_there(tmp_path):
    ours = translations()
    first = ours.written(["Plan", "Old & <gone>"]).replace("<source>Plan</source>\n   <translation type=\"unfinished\" />",
                                                          "<source>Plan</source><translation>Planen</translation>")  # fmt: skip
    again = ET.fromstring(ours.written(["Plan", "New"], first, "de"))
    answers = {each.findtext("source"): each.find("translation") for each in again.iter("message")}
    assert again.get("language") == "de"
    assert (answers["Plan"].text, answers["Plan"].get("type")) == ("Planen", None)
    assert (answers["New"].text, answers["New"].get("type")) == (None, "unfinished")
    assert set(answers) == {"Plan", "New"}
    # FreeCAD translates the names of bars in a context of its own, and takes no accents otherwise.
    bars = ET.fromstring(ours.TEMPLATE.read_text(encoding="utf-8")).findall("context")[1]
    assert [each.text for each in bars.iter() if each.tag in ("name", "source")] == ["Workbench", "Plan cutters", "&Plan cutters"]
    (tmp_path / "a.py").write_text('tr(f"{count} faces")')
    with pytest.raises(ValueError, match="only a literal"):
        ours.texts(tmp_path)


def shown_texts(node):
    """Literals that a widget or a refusal would show as they are."""
    if isinstance(node, ast.IfExp):
        return [*shown_texts(node.body), *shown_texts(node.orelse)]
    if isinstance(node, ast.JoinedStr):
        return ["".join(part.value for part in node.values if isinstance(part, ast.Constant))]
    return [node.value] if isinstance(node, ast.Constant) and isinstance(node.value, str) else []


def test_no_text_is_shown_that_cannot_be_translated():
    """What people read goes through `tr`, but for examples of what to type and lines that join what was translated."""
    shows = ("Refused", "setText", "setToolTip", "setWindowTitle", "QCheckBox", "QPushButton", "words", "button", "box", "addRow")
    bare = []
    for path in sorted((ADDON / "plan_cutters").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            name = getattr(node.func, "attr", getattr(node.func, "id", "")) if isinstance(node, ast.Call) else ""
            for given in node.args[:1] if name in shows else ():
                bare += [(path.name, text) for text in shown_texts(given) if re.search("[A-Za-z]{2}", text)]
    assert bare == []


def test_a_text_is_translated_by_freecad_and_a_length_has_the_users_unit():
    """In inches as FreeCAD would, and typed in any unit."""
    with imported("freecad.plan_cutters.words") as words:
        assert words.tr("Plan") == "Plan"
        words.App.Qt = SimpleNamespace(translate=lambda context, text: {"Plan": "Planen"}.get(text, text) + context[:0])
        assert words.tr("Plan") == "Planen"
        assert words.several(1, "{count} tool", "{count} tools") == "1 tool"
        assert words.several(0, "{count} tool", "{count} tools") == "0 tools"
        assert isinstance(words.App, ModuleType)


UNITS = """
import FreeCAD as App
from freecad.plan_cutters import words
found = {}
for name, schema in (("mm", 0), ("in", 3), ("ft and in", 5), ("cm", 4)):
    App.Units.setSchema(schema)
    found[name] = [words.length(12.7), words.fine(0.00127), words.mm_of("2"), words.mm_of("0.5 in"), words.unit()]
    for text in ("wide", "2 kg", ""):
        try:
            words.mm_of(text)
        except ValueError as error:
            found[name].append(str(error))
"""


@pytest.mark.skipif(not CONSOLE, reason="FreeCAD is not installed")
def test_lengths_are_in_the_units_that_the_user_chose(tmp_path):
    shutil.copytree(ADDON, tmp_path / "user" / "Mod" / "Cutters", ignore=shutil.ignore_patterns("__pycache__"))
    found = run([CONSOLE], "import json\n" + UNITS, tmp_path, FREECAD_USER_DATA=str(tmp_path / "user"))
    shown = {name: row[:2] for name, row in found.items()}
    assert shown["mm"] == ["12.70 mm", "0.00127 mm"]
    assert shown["in"] == ["0.50 in", "5e-05 in"]
    assert shown["cm"] == ["1.27 cm", "0.000127 cm"]
    assert {name: row[2] for name, row in found.items()} == pytest.approx({"mm": 2.0, "in": 50.8, "ft and in": 50.8, "cm": 20.0})
    assert all(row[3] == pytest.approx(12.7) for row in found.values())
    assert {name: row[4] for name, row in found.items()} == {"mm": "mm", "in": "in", "ft and in": "in", "cm": "mm"}
    assert all(len(row[5:]) == 3 for row in found.values())
