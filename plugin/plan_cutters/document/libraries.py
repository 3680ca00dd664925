"""Tool libraries, as the plan file has them."""

from plan_cutters.library.records import Entry, Library
from plan_cutters.plan_file.frozen import filled
from plan_cutters.plan_file.model import LibraryEntry, SourceEntry, UnusedEntry


def library_entry(library: Library) -> LibraryEntry:
    """A library, and what of it was not used."""
    return filled(
        LibraryEntry,
        library,
        tools=len(library.entries),
        cutters=len(library),
        notes=list(library.notes),
        holders=[holder.name or holder.id for holder in library.holders],
        unused=[filled(UnusedEntry, each, why=each.unused or "") for each in library.unused],
    )


def source_entry(library: Library, entry: Entry) -> SourceEntry:
    """One place where a cutter is listed."""
    return filled(SourceEntry, entry, file=library.file, notes=list(entry.notes))
