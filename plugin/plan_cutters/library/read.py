"""A file becomes a library, or one line that says why not."""

import os
from collections import Counter
from pathlib import Path
from typing import Any, Literal

from plan_cutters.domain.holder import Holder, positive
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.library.files import Content, data_of
from plan_cutters.library.formats import FORMATS, recognised
from plan_cutters.library.milling import Ask, entry_of
from plan_cutters.library.raw_tool import Entry, Library
from plan_cutters_base.user_files import is_there

#: How many reasons an error names, of all.
_NAMED = 3
_SUFFIXES = {suffix for form in FORMATS for suffix in form.suffixes}


def read_library(
    path: str | os.PathLike[str],
    *,
    assume_stickout: float | None = None,
    holder: Holder | str | None = None,
    skip_bad: bool = False,
) -> Library:
    """The cutters of a tool library; every tool that becomes none is in `entries`, with the reason.

    Parameters
    ----------
    path : path
        Fusion `.json`, `.tools` or CSV, HSMWorks `.hsmlib`, FreeCAD `.fctl` or `.fctb`, our own TOML. What the
        file holds decides.
    assume_stickout : float, optional
        mm, of tools that state none.
    holder : Holder or str, optional
        Of tools that have none; a text as `R15L30`, or `none`, so that they are judged without.
    skip_bad : bool
        Use the others where some tools contradict themselves or cannot be read.

    Raises
    ------
    LibraryError
        The file is no library that is read, holds a broken tool (unless `skip_bad`), or none that can be used.
    CutterError
        The holder or the stick-out that is assumed cannot exist.

    Examples
    --------
    >>> read_library("none.tools")
    Traceback (most recent call last):
    plan_cutters.errors.LibraryError: none.tools: cannot be read: No such file or directory
    """
    listed = listing(path, assume_stickout=assume_stickout, holder=holder, skip_bad=skip_bad)
    if not listed:
        raise nothing(listed)
    return listed


def listing(path: str | os.PathLike[str], *, assume_stickout: float | None = None, holder: Holder | str | None = None,
            skip_bad: bool = False) -> Library:  # fmt: skip
    """The same, also where no tool can be used."""
    ask = _ask(assume_stickout, holder)
    try:
        file = Path(path)
    except TypeError:
        raise LibraryError(f"a tool library is a file's name, not a value of type {type(path).__name__}") from None
    content = Content(file, data_of(file))
    form = recognised(content)
    raw = form.read(content)
    entries = tuple(each if isinstance(each, Entry) else entry_of(each, ask) for each in raw.tools)
    notes = list(raw.notes)
    if content.members is None and content.encoded[1] == "cp1252":
        notes.append("it is not in UTF-8: its text is read as Windows-1252")
    library = Library(file.name, form.name, (*entries, *raw.faulty), tuple(raw.holders), tuple(notes))
    broken = [entry for entry in library.entries if entry.broken]
    if broken and not skip_bad:
        raise _broken(library, broken)
    return library


def _ask(stickout: float | None, holder: Holder | str | None) -> Ask:
    choice: Holder | Literal["none"] | None
    if isinstance(holder, str) and holder.strip().lower() == "none":
        choice = "none"
    else:
        choice = None if holder is None else Holder.of(holder)
    return Ask(None if stickout is None else positive(stickout, "assumed stick-out"), choice)


def _broken(library: Library, broken: list[Entry]) -> LibraryError:
    first, more = broken[0], len(broken) - 1
    others = f"; {more} more {'are' if more > 1 else 'is'} broken" if more else ""
    use = f"; --skip-bad uses the other {len(library)} cutters" if library else "; no other tool can be used"
    return LibraryError(f"{library.format}, {first.label}: {first.unused}{others}{use}", file=library.file)


def nothing(library: Library) -> LibraryError:
    """Why a library has no cutter."""
    if not library.entries:
        held = len(library.holders)
        what = f"lists {held} holder{'s' if held > 1 else ''} and no tools; give it with --holder" if held else "lists no tools"
        return LibraryError(f"{library.format}: {what}", file=library.file)
    count = len(library.entries)
    reasons = Counter(entry.unused or "" for entry in library.entries)
    first: dict[str, Entry] = {}
    for entry in library.entries:
        first.setdefault(entry.unused or "", entry)
    causes = []
    for why, often in list(reasons.items())[:_NAMED]:
        causes.append(f"{first[why].label}{f' and {often - 1} more' if often > 1 else ''}: {why}")
    if len(reasons) > _NAMED:
        rest = count - sum(list(reasons.values())[:_NAMED])
        causes.append(f"{rest} more for {len(reasons) - _NAMED} other reasons")
    tools = "its only tool cannot" if count == 1 else f"none of its {count} tools can"
    return LibraryError(f"{library.format}: {tools} be used: {'; '.join(causes)}", file=library.file)


def holder_of(value: Any) -> Holder | str:
    """Read a value of `--holder`: `none`, a text as `R15L30`, or a file with a holder; `FILE#NAME` where it has several.

    Raises
    ------
    CutterError, LibraryError
    """
    if not isinstance(value, str) or value.strip().lower() == "none":
        return value.strip().lower() if isinstance(value, str) else Holder.of(value)
    try:
        return Holder.parse(value)
    except CutterError:
        file, mark, name = value.rpartition("#")
        if not mark or not is_there(file):
            file, name = value, ""
        if not is_there(file):
            if Path(file).suffix.lower() in _SUFFIXES:
                raise LibraryError("is no file; give one with a holder, or R15L30", file=file) from None
            raise
    return _holder_in(listing(file, skip_bad=True), name)


def _holder_in(listed: Library, name: str) -> Holder:
    """The holder of a name in a library, or its only one where there is no name."""
    known = {holder.id: holder for holder in listed.holders}
    for entry in listed.entries:
        if entry.cutter is not None and entry.cutter.holder is not None:
            known.setdefault(entry.cutter.holder.id, entry.cutter.holder)
    chosen = [holder for holder in known.values() if not name or holder.name == name]
    if len(chosen) == 1:
        return chosen[0]
    if not known:
        faults = "; ".join(e.unused or "" for e in listed.entries if e.broken and e.kind == "holder")
        raise LibraryError(
            f"{listed.format}: it has no holder{f' that can be read: {faults}' if faults else ''}", file=listed.file
        )
    names = ", ".join(sorted({f'"{holder.name}"' for holder in known.values()}))
    raise LibraryError(
        f"{len(chosen)} of its {len(known)} holders are meant; choose one as {listed.file}#NAME: {names}", file=listed.file
    )
