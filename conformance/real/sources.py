"""The real parts: where each comes from, and how it is fetched. No file of theirs is copied into the benchmark."""

import csv
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from conformance.suite import FETCHED, sha256

#: The list, beside this module, and the repository of a name `owner/name`.
LIST = Path(__file__).with_name("sources.csv")
REMOTE = "https://github.com/{repo}.git"


@dataclass(frozen=True)
class Source:
    """One file of a public repository: `diameter` (mm) is the size of the tools that ask about it, `postures` how many are drawn."""

    name: str
    file: str
    repo: str
    path: str
    commit: str
    licence: str
    sha256: str
    diameter: float
    postures: int


def sources() -> list[Source]:
    """Return the list of real parts."""
    with LIST.open(encoding="utf-8", newline="") as file:
        return [Source(**{**row, "diameter": float(row["diameter"]), "postures": int(row["postures"])}) for row in csv.DictReader(file)]


def fetch(
    listed: list[Source], folder: Path = FETCHED, remote: str = REMOTE, files: Path | None = None, tell: Callable[[str], None] = lambda line: None
) -> list[str]:
    """Bring the files into a folder by git, one commit and no history; return a line for each that failed.

    `remote` is the address of a repository with `{repo}` in it. `files` is a folder (searched with its subfolders) that is looked
    through first, by checksum. A file whose checksum is another one is not kept.
    """
    folder.mkdir(parents=True, exist_ok=True)
    failed = []
    for source in listed:
        target = folder / source.file
        if target.is_file() and sha256(target) == source.sha256:
            tell(f"{source.file}: is there")
            continue
        try:
            with tempfile.TemporaryDirectory() as scratch:
                part = _local(source, files) or _by_git(source, remote.format(repo=source.repo), Path(scratch))
                if sha256(part) != source.sha256:
                    raise ValueError("its checksum is not the one of sources.csv: the file was changed")
                aside = target.with_name(target.name + ".part")
                shutil.copyfile(part, aside)
                aside.replace(target)
            tell(f"{source.file}: fetched")
        except (OSError, ValueError, subprocess.SubprocessError) as error:
            text = error.stderr.strip().splitlines()[-1] if isinstance(error, subprocess.CalledProcessError) and error.stderr.strip() else str(error)
            failed.append(f"{source.file}: {text}")
    return failed


def _local(source: Source, files: Path | None) -> Path | None:
    """Return the file of a folder that has the name and the checksum."""
    if files is None:
        return None
    return next((p for p in sorted(files.rglob(source.file)) if p.is_file() and sha256(p) == source.sha256), None)


def _by_git(source: Source, remote: str, scratch: Path) -> Path:
    """Fetch one commit without its other files, and return the one asked for."""

    def git(*words: str) -> None:
        subprocess.run(["git", "-C", str(scratch), *words], check=True, capture_output=True, text=True, timeout=600)

    git("init", "--quiet")
    git("remote", "add", "origin", remote)
    git("fetch", "--quiet", "--depth", "1", "--filter=blob:none", "origin", source.commit)
    git("-c", "core.autocrlf=false", "checkout", "--quiet", "FETCH_HEAD", "--", source.path)
    return scratch / source.path
