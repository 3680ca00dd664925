"""pyright at its strictest, over the installed package, finds each mistake of `typed_calls.py` and no other one.

At its strictest a type that is not known is a mistake, too.
"""

import json
import shutil
import subprocess
import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path

import pytest

from plan_cutters.option_table import ATTRIBUTES
from tests.support.places import PACKAGES, ROOT

pytestmark = pytest.mark.slow("runs a type checker on the whole")

CALLS = ROOT / "tests/support/typed_calls.py"
#: What people write who made none of these mistakes: axes and planes of their hosts among it.
HOSTS = """
import build123d as bd
import cadquery as cq

from plan_cutters import Options, Placement, plan

Options(setup=bd.Axis.Z, other_setups=[bd.Plane.XZ, cq.Plane.named("YZ"), bd.Vector(0, 1, 0), cq.Vector(0, 1, 0)])
Placement(bd.Axis.Z, x=bd.Axis.X)
plan(bd.Box(1, 2, 3), setup=bd.Plane.XY)
plan(bd.Box(1, 2, 3), setup=bd.Color)  # wrong
plan(bd.Box(1, 2, 3), setup=cq.Workplane())  # wrong
"""
#: What `Options` keeps of each option may be given again.
AGAIN = f"""
from plan_cutters import Options, plan


def again(known: Options) -> None:
    plan("part.step", {", ".join(f"{word}=known.{word}" for word in ATTRIBUTES)})
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """By file, the lines on which pyright finds a mistake, and what it says of them."""
    if find_spec("pyright") is None or shutil.which("node") is None:
        pytest.skip("pyright or the node that it runs on is not installed (sh setup.sh dev)")
    folder = tmp_path_factory.mktemp("types")
    # The packages as they lie where pip puts them: of what is installed, checkers believe annotations alone.
    packages = folder / "env/lib" / f"python{sys.version_info[0]}.{sys.version_info[1]}" / "site-packages"
    packages.mkdir(parents=True)
    for name, folder_ in PACKAGES.items():
        (packages / name).symlink_to(folder_)
    (packages / "others.pth").write_text(sysconfig.get_path("purelib"))
    shutil.copy(CALLS, folder)
    (folder / "hosts.py").write_text(HOSTS)
    (folder / "again.py").write_text(AGAIN)
    settings = {"venvPath": ".", "venv": "env", "pythonVersion": packages.parent.name.removeprefix("python"),
                "typeCheckingMode": "strict", "enableTypeIgnoreComments": False, "include": ["*.py"],
                "reportUnusedExpression": False}  # fmt: skip
    (folder / "pyrightconfig.json").write_text(json.dumps(settings))
    done = subprocess.run([sys.executable, "-m", "pyright", "--outputjson"], cwd=folder, capture_output=True, text=True,
                          check=False, timeout=300)  # fmt: skip
    told = json.loads(done.stdout)
    assert told["summary"]["filesAnalyzed"] == 3, done.stdout + done.stderr
    lines: dict[str, dict[int, str]] = {CALLS.name: {}, "hosts.py": {}, "again.py": {}}
    for each in told["generalDiagnostics"]:
        # What the hosts leave untyped is none of our mistakes.
        if each["file"].endswith(CALLS.name) or not each.get("rule", "").startswith("reportUnknown"):
            lines[Path(each["file"]).name][each["range"]["start"]["line"] + 1] = each["message"]
    return lines


def test_editors_find_the_sources_that_setup_installed():
    paths = Path(sysconfig.get_path("purelib")) / "plan_cutters_sources.pth"
    if not paths.exists():
        pytest.skip("this environment was not made by setup.sh")
    roots = [Path(line) for line in paths.read_text().splitlines()]
    typed = {path.parent for root in roots for path in root.glob("*/py.typed")}
    assert typed == set(PACKAGES.values())


def marked(text, mark):
    return {number for number, line in enumerate(text.splitlines(), 1) if mark in line}


def test_pyright_finds_each_mistake_and_no_other_one(found):
    wrong = marked(CALLS.read_text(), "# type: ignore")
    assert len(wrong) >= 20
    mine = found[CALLS.name]
    assert {line: mine[line] for line in mine.keys() - wrong} == {}
    assert wrong - mine.keys() == set()


def test_what_is_kept_may_be_given_again(found):
    assert found["again.py"] == {}


def test_axes_and_planes_of_cad_hosts_are_directions_for_pyright(found):
    assert set(found["hosts.py"]) == marked(HOSTS, "# wrong"), found["hosts.py"]
