"""The add-on for FreeCAD says what it is: package.xml names its files and its release."""

import re
import xml.etree.ElementTree as ET

from tests.support.places import ROOT

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
