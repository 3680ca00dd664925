"""Every module keeps the promises of CONTRIBUTING.md: its size, the number of arguments of its functions, and its sentences."""

import ast
import re
from pathlib import Path

from tests.support.places import ROOT

MODULES = sorted(path.relative_to(ROOT) for folder in ("cad_io", "plugin") for path in (ROOT / folder).rglob("*.py"))
LINES, ARGUMENTS, INNERMOST = 600, 12, 20
#: Public docstrings whose first sentence begins with "What": a relative clause without a subject. The number may only fall.
#: The three that are left are help texts of commands, which are printed.
HEADLESS = 3


def faults(path):
    """Name the places of a module that are larger than a reader can rely on."""
    text = (ROOT / path).read_text()
    if (lines := len(text.splitlines())) > LINES:
        yield f"{path}: {lines} lines"
    tree = ast.parse(text)
    if not (ast.get_docstring(tree) or path.name == "__main__.py"):
        yield f"{path}: a module opens by saying what it is for"
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            given = function.args
            count = len(given.posonlyargs) + len(given.args) + len(given.kwonlyargs)
            inner = any(isinstance(each, ast.Name) and each.id == "kernel" for each in function.decorator_list)
            if count > (INNERMOST if inner else ARGUMENTS):
                yield f"{path}: {function.name} has {count} arguments"


def test_modules_and_rows_of_arguments_stay_small():
    assert len(MODULES) > 100
    assert [fault for path in MODULES for fault in faults(path)] == []


def headless(path):
    """Name the public docstrings of a module that begin with "What"."""
    for node in ast.walk(ast.parse((ROOT / path).read_text())):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            name = getattr(node, "name", "the module")
            if not name.startswith("_") and (ast.get_docstring(node) or "").startswith("What "):
                yield f"{path}: {name}"


def test_first_sentences_have_a_subject_or_are_imperatives():
    found = [place for path in MODULES for place in headless(path)]
    assert len(found) <= HEADLESS, "\n".join(found)


def test_what_is_waited_for_in_a_browser_is_a_function():
    """The policy of our pages forbids to evaluate a string: playwright may once, and fails if that has to be asked again."""
    waits = [
        (path.name, each)
        for path in sorted({*(ROOT / "tests").rglob("*.py")} - {Path(__file__)})
        for each in re.findall(r"wait_for_function\(\s*(?:[rf]*\"+)?(.*)", path.read_text(encoding="utf-8"))
    ]
    assert len(waits) > 1
    assert [each for each in waits if not re.match(r"\(?[\w\s,]*\)? =>", each[1])] == []


def test_no_test_module_imports_another_one():
    for path in (ROOT / "tests").rglob("test_*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import | ast.ImportFrom):
                named = [getattr(node, "module", None) or "", *(alias.name for alias in node.names)]
                assert not any(part.startswith("test_") for name in named for part in name.split(".")), path
