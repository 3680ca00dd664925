"""What a reader can rely on in every module: its size, and the number of arguments of its functions."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
MODULES = sorted(path.relative_to(ROOT) for folder in ("cad_io", "plugin") for path in (ROOT / folder).rglob("*.py"))
LINES, ARGUMENTS, INNERMOST = 400, 12, 20


@pytest.mark.parametrize("path", MODULES, ids=str)
def test_modules_and_rows_of_arguments_stay_small(path):
    text = (ROOT / path).read_text()
    assert len(text.splitlines()) <= LINES
    tree = ast.parse(text)
    assert ast.get_docstring(tree) or path.name == "__main__.py", "a module opens by saying what it is for"
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            given = function.args
            count = len(given.posonlyargs) + len(given.args) + len(given.kwonlyargs)
            inner = any(isinstance(each, ast.Name) and each.id == "kernel" for each in function.decorator_list)
            assert count <= (INNERMOST if inner else ARGUMENTS), function.name
