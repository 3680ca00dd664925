"""Tool libraries, as the plan file has them."""

from plan_cutters.document.model import LibraryEntry, SourceEntry, UnusedEntry
from plan_cutters.library.records import Entry, Library


def library_entry(library: Library) -> LibraryEntry:
    """A library, and what of it was not used."""
    return LibraryEntry(
        file=library.file,
        format=library.format,
        tools=len(library.entries),
        cutters=len(library),
        holders=[holder.name or holder.id for holder in library.holders],
        notes=list(library.notes),
        unused=[
            UnusedEntry(place=e.place, number=e.number, name=e.name, kind=e.kind, why=e.unused or "", broken=e.broken)
            for e in library.unused
        ],
    )


def source_entry(library: Library, entry: Entry) -> SourceEntry:
    """One place where a cutter is listed."""
    return SourceEntry(file=library.file, place=entry.place, number=entry.number, name=entry.name, kind=entry.kind,
                       unit=entry.unit, notes=list(entry.notes))  # fmt: skip
