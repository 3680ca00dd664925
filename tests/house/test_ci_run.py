"""The run of CI fails if one of its checks fails, whichever it is; one script stands for all programs that it calls."""

import os
import shutil
import subprocess

import pytest

from tests.support.places import ROOT

#: The name of each step, and words by which its call is known.
CHECKS = {
    "setup": "setup.sh dev",
    "freecad": "freecad",
    "tests": "python -m pytest",
    "ruff": "ruff check",
    "format": "ruff format --check",
    "walls": "lint-imports",
    "mypy": "mypy",
    "types": "tsc --noEmit",
    "codes": "python page/codes.py --check",
    "page": "node build.mjs --check",
    "docs": "mkdocs build --strict",
    "package": "python .ci/installed.py",
    "image": "docker build",
}
#: Says how it was called; fails where that has the words of FAILS.
CALLED = """#!/bin/sh
called="${0##*/} $*"
echo "called: $called"
[ "${called#*pytest}" = "$called" ] || echo "SKIPPED [3] tests/hosts/test_freecad.py:89: FreeCAD is not installed"
[ -z "$FAILS" ] || [ "${called#*"$FAILS"}" = "$called" ] || exit 3
"""


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A folder with the run, the README, and one script in the place of all programs."""
    folder = tmp_path_factory.mktemp("checkout")
    (folder / ".ci").mkdir()
    shutil.copy(ROOT / ".ci/run", folder / ".ci")
    shutil.copy(ROOT / "README.md", folder)
    programs = [f".venv/bin/{name}" for name in ("python", "ruff", "lint-imports", "mypy", "mkdocs")]
    for name in (*programs, "page/node_modules/.bin/tsc", "bin/node", "bin/docker", "setup.sh", ".ci/freecad"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(CALLED)
        (folder / name).chmod(0o755)
    return folder


def run(checkout, fails=""):
    environment = {**os.environ, "PATH": f"{checkout / 'bin'}{os.pathsep}{os.environ['PATH']}", "FAILS": fails}
    return subprocess.run(["bash", ".ci/run"], cwd=checkout, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", CHECKS)
def test_the_run_fails_if_one_check_fails(checkout, name):
    done = run(checkout, CHECKS[name])
    assert done.returncode == 3
    assert f"\n{name}: did not pass\n" in done.stdout


def test_the_run_passes_if_all_do_and_says_what_was_skipped(checkout):
    done = run(checkout)
    assert done.returncode == 0
    assert "did not pass" not in done.stdout
    end = done.stdout.partition("tests that were skipped\n")[2]
    assert end.startswith("SKIPPED [3] tests/hosts/test_freecad.py:89: FreeCAD is not installed\n")
    for words in CHECKS.values():
        assert f"called: {words}" in done.stdout


def test_without_docker_the_run_says_that_there_is_no_image(checkout):
    done = run(checkout, "docker info")
    assert done.returncode == 0
    assert "\nimage: not built, for docker does not run here\n" in done.stdout
