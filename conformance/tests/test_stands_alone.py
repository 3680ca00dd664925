"""The benchmark imports no program that it scores, but for that program's own adapter."""

import ast
from pathlib import Path

import pytest

HOME = Path(__file__).parent.parent
SCORED = {"plan_cutters", "cad_io", "fcl", "embreex", "opencamlib"}


@pytest.mark.parametrize("path", sorted(p.relative_to(HOME).as_posix() for p in HOME.rglob("*.py")))
def test_no_scored_program_is_imported(path: str) -> None:
    tree = ast.parse((HOME / path).read_text(encoding="utf-8"))
    names = {a.name for node in ast.walk(tree) if isinstance(node, ast.Import) for a in node.names}
    names |= {node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    tops = {name.partition(".")[0] for name in names}
    scored = {top for top in tops if top in SCORED or top.startswith("plan_cutters_")}
    assert not scored or path.startswith(("programs/", "tests/")), f"{path} imports {scored}"
