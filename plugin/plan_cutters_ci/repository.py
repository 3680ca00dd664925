"""Ask git about a repository: which parts changed, their bytes, and a branch for pictures."""

import os
import posixpath
import re
import subprocess
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from cad_io.read import step_text
from plan_cutters.errors import PlanError

#: Suffixes of parts, in lower case.
PARTS = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
_POINTER = b"version https://git-lfs.github.com/spec/"


@dataclass(frozen=True, slots=True)
class Changed:
    """A part that differs between two commits; a path is None where that commit has no such file."""

    old: str | None
    new: str | None

    @property
    def name(self) -> str:
        return self.new or self.old or ""

    @property
    def how(self) -> str:
        if self.old is None or self.new is None:
            return "added" if self.old is None else "deleted"
        return "changed" if self.old == self.new else f"renamed from {self.old}"


def git(*words: str, stdin: bytes | None = None, codes: Collection[int] = (0,)) -> bytes:
    """Standard output of git in the working directory; a PlanError where there is no git, or it refuses.

    `codes`: exit codes that are no refusal.
    """
    try:
        done = subprocess.run(["git", *words], input=stdin, capture_output=True, check=False)
    except OSError as error:
        raise PlanError(f"cannot be run ({error.strerror}): install it", file="git") from None
    if done.returncode not in codes:
        errors = done.stderr.decode(errors="replace").strip().splitlines() or [f"exit code {done.returncode}"]
        word = next(each for each in words if each[0] not in "-u")
        raise PlanError(f"git {word}: {errors[0]}")
    return done.stdout


def commit(name: str) -> str:
    """The commit of a name: a PlanError where there is none, as in a clone that is not deep enough."""
    if name.startswith("-"):
        raise PlanError(f"{name!r} is no commit")
    try:
        return git("rev-parse", "--verify", "--quiet", f"{name}^{{commit}}").decode().strip()
    except PlanError:
        git("rev-parse", "--git-dir")  # says so where there is no repository at all
        raise PlanError(f"commit {name!r} is not in this repository: fetch it (actions/checkout with fetch-depth: 0)") from None


def changed(base: str, head: str | None) -> tuple[str, str, list[Changed]]:
    """Where to look for the parts that differ, by name: the commit that `head` began at on `base`, and that of `head`.

    Without a `head`, what is staged is compared with `base` itself.
    """
    if head is None:
        began, until = commit(base), git("write-tree").decode().strip()
    else:
        first, until = commit(base), commit(head)
        try:
            began = git("merge-base", first, until).decode().strip()
        except PlanError:
            raise PlanError(f"{base} and {head} have no common commit here: fetch all of them (fetch-depth: 0)") from None
    words = git("diff", "--name-status", "-z", "--find-renames", began, until).decode("utf-8", "surrogateescape")
    each, paths = iter(words.split("\0")), []
    for status in each:
        if not status:
            continue
        old = next(each)
        new = next(each) if status[0] in "RC" else old
        pair = Changed(None if status[0] in "AC" else old, None if status[0] == "D" else new)
        if Path(pair.name).suffix.lower() in PARTS:
            paths.append(pair)
    files = {path for part in paths for path in (part.old, part.new) if path is not None}
    paths += [Changed(path, path) for path in _referring(until, files) - files]
    return began, until, sorted(paths, key=lambda part: part.name)


def _referring(at: str, files: Collection[str]) -> set[str]:
    """STEP files of a commit that refer to some files, or to others that do: assemblies."""
    if not files:
        return set()
    words = [part for word in step_text.WORDS for part in ("-e", word.decode())]
    output = git("grep", "-lzaF", "--full-name", *words, at, "--", ":(top,icase)*.step", ":(top,icase)*.stp", codes=(0, 1))
    paths = [each.partition(":")[2] for each in output.decode("utf-8", "surrogateescape").split("\0") if each]
    refers = {
        path: {
            posixpath.normpath(posixpath.join(posixpath.dirname(path), name))
            for name in step_text.names(git("cat-file", "--filters", f"{at}:{path}"))
        }
        for path in paths
    }
    reached = set(files)
    while new := {path for path, names in refers.items() if path not in reached and names & reached}:
        reached |= new
    return {path for path in reached if path in refers}


def content(at: str, path: str) -> bytes:
    """A file's bytes in a commit, as a checkout would have them: a PlanError where it is a pointer of Git LFS."""
    data = git("cat-file", "--filters", f"{at}:{path}")
    if data.startswith(_POINTER):
        raise PlanError("is a pointer of Git LFS, not the part: check it out with lfs: true", file=path)
    return data


def publish(pictures: dict[str, bytes], branch: str, remote: str) -> str:
    """Add files to a branch of the remote, whatever is checked out; the commit that has them.

    A PlanError where the remote refuses, as it does where the token may not write.
    """
    if not re.fullmatch(r"[\w.][\w./-]*", branch):
        raise PlanError(f"{branch!r} is no name of a branch")
    tip = git("ls-remote", remote, f"refs/heads/{branch}").decode().split()
    entries = b""
    if tip:
        git("fetch", "--quiet", "--depth=1", remote, tip[0])
        entries = git("ls-tree", "-z", tip[0])
    there = {entry.split(b"\t", 1)[1] for entry in entries.split(b"\0") if entry}
    for name, data in pictures.items():
        if name.encode() not in there:
            blob = git("hash-object", "-w", "--stdin", stdin=data).decode().strip()
            entries += f"100644 blob {blob}\t{name}\0".encode()
    tree = git("mktree", "-z", stdin=entries).decode().strip()
    by = ["-c", f"user.name={os.environ.get('GITHUB_ACTOR', 'plan-cutters')}", "-c", "user.email=plan-cutters@localhost"]
    made = git(*by, "commit-tree", tree, *(["-p", tip[0]] if tip else []), "-m", "Pictures of plans").decode().strip()
    git("push", "--quiet", remote, f"{made}:refs/heads/{branch}")
    return made
