"""The project file and `setup.sh`: package data are what git tracks, one version of the kernel, words that are not known."""

import re
import shutil
import subprocess
import tomllib

import pytest

from tests.support.places import PACKAGES, ROOT


@pytest.mark.skipif(not (shutil.which("git") and (ROOT / ".git").exists()), reason="this is no checkout of git")
def test_package_data_are_the_files_that_git_tracks():
    globs = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    for folder in PACKAGES.values():
        done = subprocess.run(["git", "ls-files", "-z", "."], cwd=folder, capture_output=True, text=True, check=True)
        tracked = {name for name in done.stdout.split("\0") if name and not name.endswith(".py")}
        matched = {path.relative_to(folder).as_posix() for glob in globs["*"] for path in folder.glob(glob) if path.is_file()}
        assert matched == tracked
        assert tracked


def test_both_flavours_of_the_kernel_are_one_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needs = [*project["dependencies"], *project["optional-dependencies"]["cadquery"]]
    asked = [each for each in needs if each.startswith("cadquery-ocp")]
    typed = re.findall(r"cadquery-ocp==\S+", (ROOT / "docs" / "install.md").read_text(encoding="utf-8"))
    assert {each.partition("==")[0] for each in asked} == {"cadquery-ocp", "cadquery-ocp-novtk"}
    assert len({each.partition("==")[2] for each in (*asked, *typed)}) == len(typed) == 1


def test_the_command_needs_no_host_to_be_installed():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert not [each for each in project["dependencies"] if re.match(r"cadquery(?!-ocp-novtk)|build123d|vtk|pandas", each)]


def test_setup_refuses_a_word_that_it_does_not_know(tmp_path):
    shutil.copy(ROOT / "setup.sh", tmp_path)
    done = subprocess.run(["sh", "setup.sh", "devv"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout + done.stderr == "setup.sh: unknown words devv: give dev or alone, or nothing\n"
    assert [path.name for path in tmp_path.iterdir()] == ["setup.sh"]
