"""No text tells anybody to install the program from a package index: none has it."""

import re
import tomllib

import pytest

from tests.support.places import ROOT

_TEXTS = {".md", ".ipynb", ".py", ".toml", ".yml", ".yaml", ".xml", ".ts", ".html", ".jinja", ".sh", ".FCMacro", ""}
_ROOMS = ("docs", "plugin", "cad_io", "freecad", "samples", "benchmarks", "page/src", "page/test")
#: Installers and runners that take a name from an index; options and other packages may stand between.
_INDEX = re.compile(
    r"""(?:\b(?:pip[x3]?|uv\ tool|uv\ pip|poetry|conda)\s+(?:install|add|run)|\buv\ add|\buvx)\b
        (?P<words>(?:[ \t]+[^\s`|”“]+)*)""",
    re.VERBOSE,
)
_NAME = re.compile(r"""^["']?plan[-_]cutters(?:\[[\w,]*\])?(?:[=<>~!][^"']*)?["'.,;]?$""")


def hinted(text):
    """Each line that would install the program by its name, where no path of a folder or wheel stands before it."""
    found = []
    for match in _INDEX.finditer(text):
        words = match["words"].split()
        named = next((k for k, word in enumerate(words) if _NAME.match(word)), None)
        if named is not None and not any(word.strip("\"'").startswith(".") for word in words[:named]):
            found.append(match[0].strip())
    return found


def texts():
    rooms = [path for room in _ROOMS for path in (ROOT / room).rglob("*") if path.is_file()]
    for path in sorted([*ROOT.glob("*"), *(ROOT / ".ci").glob("*"), *rooms]):
        if path.is_file() and path.suffix in _TEXTS and "node_modules" not in path.parts and path.stat().st_size < 500_000:
            yield path


def test_no_text_hints_at_an_index():
    found = {}
    for path in texts():
        # A decision records what was considered then.
        if "decisions" not in path.parts and (lines := hinted(path.read_text(encoding="utf-8"))):
            found[path.relative_to(ROOT).as_posix()] = lines
    assert found == {}
    assert len(list(texts())) > 400


FROM_INDEX = ["`uv tool install plan-cutters`", 'pip install "plan-cutters[batch]"', "uvx plan-cutters part.step",
              "pip install plan-cutters jupyterlab", "pipx run plan-cutters part.step",
              "pip install -U plan_cutters==0.1"]  # fmt: skip
FROM_FOLDER = ['pip install ".[batch]" in the folder of plan-cutters', "uvx --from . plan-cutters part.step",
               "pipx run --spec . plan-cutters part.step", "`pip install .` put plan-cutters into"]  # fmt: skip


@pytest.mark.parametrize("text", FROM_INDEX)
def test_what_needs_an_index_is_known(text):
    assert hinted(text)


@pytest.mark.parametrize("text", FROM_FOLDER)
def test_what_takes_a_folder_is_allowed(text):
    assert not hinted(text)


def test_no_address_is_left_open():
    assert not [path for path in texts() if path.suffix == ".md" and "<the repository>" in path.read_text(encoding="utf-8")]


def test_each_extra_that_is_hinted_at_exists():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    every = "\n".join(path.read_text(encoding="utf-8") for path in texts() if path.suffix in (".md", ".py"))
    hinted_at = set(re.findall(r"""["']\.\[(\w+)\]["']""", every)) | set(re.findall(r"extra_hint\(['\"](\w+)['\"]\)", every))
    assert {"batch", "pictures", "mcp"} <= hinted_at <= set(extras)
