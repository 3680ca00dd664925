"""The globs of package data name just the files that git tracks in the packages: a new template cannot be forgotten."""

import shutil
import subprocess
import tomllib

import pytest

from tests.support.places import ROOT


@pytest.mark.skipif(not (shutil.which("git") and (ROOT / ".git").exists()), reason="this is no checkout of git")
def test_package_data_are_the_files_that_git_tracks():
    globs = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    for package, folder in (("plan_cutters", ROOT / "plugin/plan_cutters"), ("cad_io", ROOT / "cad_io")):
        done = subprocess.run(["git", "ls-files", "-z", "."], cwd=folder, capture_output=True, text=True, check=True)
        tracked = {name for name in done.stdout.split("\0") if name and not name.endswith(".py")}
        matched = {
            path.relative_to(folder).as_posix()
            for glob in globs[package]
            for path in folder.glob(glob)
            if path.is_file()
        }
        assert matched == tracked
        assert tracked
