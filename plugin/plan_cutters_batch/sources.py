"""Where parts come from: files, folders, globs and lists, here or at a URL. Names are made from paths alone, so they stay."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

from plan_cutters.errors import PlanError
from plan_cutters.files.folder import cause, file_system
from plan_cutters_batch.job import UNREADABLE, USAGE, Fault

#: What files of parts are called.
SUFFIXES = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
MANIFESTS = (".toml", ".csv", ".txt")
_MAGIC = frozenset("*?[")


@dataclass(frozen=True)
class Source:
    """A part as it was requested.

    Attributes
    ----------
    name : str
    file : str
        Path or URL.
    options : dict
        Of this part alone, as the manifest has them.
    place : str
        Where that is said, for errors: `parts.csv:7`.
    """

    name: str
    file: str
    options: dict[str, Any] = field(default_factory=dict)
    place: str = ""


def sources(words: Sequence[str], out: str, manifest: Callable[[str], Sequence[Source | Fault]]) -> list[Source | Fault]:
    """The parts that are meant, in the order of the words and, within each, of the names.

    Parameters
    ----------
    words : sequence of str
        Files, folders, globs, manifests and lists of files, as paths or URLs.
    out : str
        The output: what lies below it is no part.
    manifest : callable
        Reads a manifest.
    """
    jobs: list[Source | Fault] = []
    for word in words:
        try:
            jobs += _of(word, out, manifest)
        except PlanError as error:
            jobs.append(Fault(word, word, str(error), UNREADABLE))
    return _named_once(jobs)


def _of(word: str, out: str, manifest: Callable[[str], Sequence[Source | Fault]]) -> Sequence[Source | Fault]:
    if not word:
        return [Fault("?", word, "SRC: a file has no name")]
    fs, path = file_system(word)
    try:
        if _MAGIC & set(word) and not fs.exists(path):
            base = PurePosixPath(*_plain(path)).as_posix()
            return _listed(
                word,
                base,
                [each for each in sorted(fs.glob(path)) if _is_part(each)],
                fs,
                "no STEP, IGES or BREP file matches it",
            )
        if word.lower().endswith(MANIFESTS):
            return _read(word, manifest)
        if fs.isdir(path):
            base = path.rstrip("/")
            own = _own(fs, out)
            files = [each for each in sorted(fs.find(path)) if _is_part(each) and not _ours(each[len(base) :])]
            files = [each for each in files if own is None or not each.startswith(f"{own}/")]
            return _listed(word, base, files, fs, "the folder holds no STEP, IGES or BREP file")
        if not fs.exists(path):
            raise PlanError(f"no such file{', folder or bucket' if '://' in word else ' or folder'}", file=word)
    except PlanError:
        raise
    except Exception as error:
        raise PlanError(cause(error, "read"), file=word) from None
    return [Source(PurePosixPath(path).stem, word)]


def _read(word: str, manifest: Callable[[str], Sequence[Source | Fault]]) -> Sequence[Source | Fault]:
    """The parts of a manifest or list; one that is wrong is a mistake of the command, not a part that cannot be read."""
    try:
        return manifest(word)
    except PlanError as error:
        return [Fault(word, word, str(error))]


def _listed(word: str, base: str, files: Sequence[str], fs: Any, nothing: str) -> list[Source | Fault]:
    if not files:
        return [Fault(word, word, f"{word}: {nothing}")]
    whole = "://" in word
    return [Source(_stem(file[len(base) :].lstrip("/")), fs.unstrip_protocol(file) if whole else file) for file in files]


def _stem(path: str) -> str:
    return PurePosixPath(path).with_suffix("").as_posix()


def _plain(path: str) -> Iterator[str]:
    """The folders of a glob before the first that is none."""
    for part in PurePosixPath(path).parts[:-1]:
        if _MAGIC & set(part):
            return
        yield part


def _is_part(path: str) -> bool:
    return path.lower().endswith(SUFFIXES)


def _ours(path: str) -> bool:
    """Whether a file lies in the folder of a plan, or in a hidden one."""
    return any(part.startswith(".") or part.endswith("-plan") for part in PurePosixPath(path).parts[:-1])


def _own(fs: Any, out: str) -> str | None:
    there, path = file_system(out)
    return path.rstrip("/") if type(there) is type(fs) else None


def _named_once(sources: Sequence[Source | Fault]) -> list[Source | Fault]:
    """Names that are folders, each once; parts that share one are not planned, for neither has a right to the folder."""
    names: dict[str, list[str]] = {}
    for each in sources:
        if isinstance(each, Source):
            names.setdefault(each.name.casefold(), []).append(each.file)
    taken: set[str] = {each.name for each in sources if isinstance(each, Fault)}
    checked: list[Source | Fault] = []
    for each in sources:
        if isinstance(each, Source) and (why := _unusable(each, names[each.name.casefold()])):
            short = each.name if len(names[each.name.casefold()]) == 1 else PurePosixPath(each.file).name
            tried = (short, each.file, *(f"{each.file} ({n})" for n in range(2, len(sources) + 2)))
            name = next(name for name in tried if name not in taken)
            each = Fault(name, each.file, f"{each.place or each.file}: {why}", USAGE)
            taken.add(name)
        checked.append(each)
    return checked


def _unusable(source: Source, same: Sequence[str]) -> str:
    """Why a name cannot be a folder's; empty where it can."""
    if len(same) > 1:
        others = [file for file in same if file != source.file] or [source.file]
        more = f" and {len(others) - 1} more" if len(others) > 1 else ""
        return (
            f"has the name {source.name!r}, as {others[0]}{more}: none of them is planned; rename one, or give names in "
            "a manifest"
        )
    parts = source.name.split("/")
    if any(part in ("", ".", "..") or part != part.strip() for part in parts) or not source.name.isprintable():
        return f"the name {source.name!r} cannot be a folder's; give another in a manifest"
    if "\\" in source.name or any(part.endswith("-plan") for part in parts[:-1]) or parts[0].startswith("."):
        return f"the name {source.name!r} would lie in the folder of another plan, or in a hidden one; give another"
    return ""
