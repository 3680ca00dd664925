"""Real parts come by git from a repository on this machine, and only with their checksum."""

import hashlib
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from conformance.real.sources import Source, fetch, sources

pytestmark = pytest.mark.skipif(shutil.which("git") is None, reason="git is not there")


@pytest.fixture
def source(tmp_path: Path) -> Source:
    """A file in a repository `some/parts` under tmp_path, changed by a later commit."""
    home = tmp_path / "some" / "parts.git"
    home.mkdir(parents=True)

    def git(*words: str) -> str:
        who = ["-c", "user.name=test", "-c", "user.email=test@example.org"]
        return subprocess.run(["git", "-C", str(home), *who, *words], check=True, capture_output=True, text=True).stdout.strip()

    git("init", "--quiet")
    git("config", "uploadpack.allowAnySHA1InWant", "true")
    (home / "cad").mkdir()
    (home / "cad" / "a part.step").write_bytes(b"ISO-10303-21;\r\n")
    git("add", "-A")
    git("commit", "--quiet", "-m", "one")
    commit = git("rev-parse", "HEAD")
    (home / "cad" / "a part.step").write_bytes(b"changed")
    git("commit", "--quiet", "-am", "two")
    return Source("a_part", "a_part.step", "some/parts", "cad/a part.step", commit, "CC0", hashlib.sha256(b"ISO-10303-21;\r\n").hexdigest(), 4.0, 10)


def test_the_commit_is_fetched_and_kept(tmp_path: Path, source: Source) -> None:
    out, told = tmp_path / "out", []
    remote = f"file://{tmp_path}/{{repo}}.git"
    assert fetch([source], out, remote, tell=told.append) == []
    assert (out / "a_part.step").read_bytes() == b"ISO-10303-21;\r\n"
    assert fetch([source], out, "file:///nowhere/{repo}", tell=told.append) == []
    assert told == ["a_part.step: fetched", "a_part.step: is there"]


def test_another_file_is_refused_in_one_line(tmp_path: Path, source: Source) -> None:
    remote = f"file://{tmp_path}/{{repo}}.git"
    wrong = replace(source, sha256="0" * 64)
    (line,) = fetch([wrong], tmp_path / "out", remote)
    assert line.startswith("a_part.step: its checksum")
    (line,) = fetch([replace(source, commit="0" * 40)], tmp_path / "out", remote)
    assert line.startswith("a_part.step: ")
    assert list((tmp_path / "out").iterdir()) == []


def test_a_folder_is_looked_through_by_checksum(tmp_path: Path, source: Source) -> None:
    (tmp_path / "files" / "deep").mkdir(parents=True)
    (tmp_path / "files" / "a_part.step").write_bytes(b"another")
    (tmp_path / "files" / "deep" / "a_part.step").write_bytes(b"ISO-10303-21;\r\n")
    assert fetch([source], tmp_path / "out", "file:///nowhere/{repo}", files=tmp_path / "files") == []


def test_the_list_is_complete() -> None:
    listed = sources()
    assert len({s.name for s in listed}) == len(listed)
    for s in listed:
        assert len(s.commit) == 40, s.name
        assert len(s.sha256) == 64, s.name
        assert s.licence, s.name
        assert s.diameter > 0, s.name
