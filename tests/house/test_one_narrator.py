"""Each fact is put into words in one room: elsewhere no text writes a unit, a percent sign or a reason's code by itself."""

import ast
import re
from collections.abc import Iterator

from plan_cutters.plan_file.reasons import REASONS
from tests.support.places import ROOT

HOUSE = ROOT / "plugin"
#: What follows a number in a text.
UNIT = re.compile(r"\s?(?:mm²|mm2|mm3|mm|%|deg|°)(?![a-z])")
#: Files whose texts have units of their own, and why.
APART = {
    "plan_cutters_check": "it shares nothing with what it checks",
    "plan_cutters/domain/figures.py": "how numbers are written, each form once, and lengths as they are typed",
    "plan_cutters/library/cutting.py": "fields of a tool file, in the file's unit",
    "plan_cutters/report/drawing/tool.py": "dimensions of a drawing, and lengths of SVG",
}
#: Those whose texts may name a code: the tables of codes themselves, and what is written for programs.
CODES = re.compile("|".join(rf"\b{code}\b" for code in REASONS if "_" in code))


def modules() -> Iterator[tuple[str, ast.Module]]:
    for path in sorted(HOUSE.rglob("*.py")):
        name = path.relative_to(HOUSE).as_posix()
        if not name.startswith("plan_cutters/plan_file/") and not any(
            name == each or name.startswith(f"{each}/") for each in APART
        ):
            yield name, ast.parse(path.read_text(encoding="utf-8"))


def refusals(tree: ast.Module) -> set[int]:
    """Nodes within what is raised: the words of an error stand where it is found."""
    return {id(each) for node in ast.walk(tree) if isinstance(node, ast.Raise) for each in ast.walk(node)}


def own_units(tree: ast.Module) -> Iterator[ast.JoinedStr]:
    """Texts that write a unit behind a number."""
    raised = refusals(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr) and id(node) not in raised:
            pairs = zip(node.values, node.values[1:], strict=False)
            if any(
                isinstance(a, ast.FormattedValue) and isinstance(b, ast.Constant) and UNIT.match(str(b.value)) for a, b in pairs
            ):
                yield node


def test_the_search_knows_a_unit():
    for line in ('f"{x:.3g} mm off"', 'f"{x} %"', 'f"{a}° here"'):
        assert list(own_units(ast.parse(line))), line
    for line in ('f"{mm(x)} off"', 'f"{x} degrees"', 'raise E(f"{x:g} mm is long")'):
        assert not list(own_units(ast.parse(line))), line


def test_units_are_written_in_one_room():
    assert [f"{name}:{node.lineno}: {ast.unparse(node)[:90]}" for name, tree in modules() for node in own_units(tree)] == []


def test_texts_name_no_code_of_a_reason():
    """A code is for programs: where one stands in a sentence, a planner would have to know it."""
    found = []
    for name, tree in modules():
        for node in ast.walk(tree):
            if isinstance(node, ast.JoinedStr):
                text = "".join(str(each.value) for each in node.values if isinstance(each, ast.Constant))
                if CODES.search(text) and " " in text.strip():
                    found.append(f"{name}:{node.lineno}: {text[:90]}")
    assert found == []
