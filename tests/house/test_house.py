"""What a reader can rely on in every module: its size, and the number of arguments of its functions."""

import ast

from tests.support.places import ROOT

MODULES = sorted(path.relative_to(ROOT) for folder in ("cad_io", "plugin") for path in (ROOT / folder).rglob("*.py"))
LINES, ARGUMENTS, INNERMOST = 400, 12, 20


def faults(path):
    """What of a module is larger than a reader can rely on."""
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
