"""A tool library holds entries: each has the cutter that was made of it, or the reason why none was made."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, overload

from plan_cutters.domain.checks import items, shown
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder
from plan_cutters.errors import LibraryError


@dataclass(frozen=True, slots=True)
class Entry:
    """One tool as a file lists it.

    Attributes
    ----------
    place : str
        Where it stands, for people: `tool 3 (line 52)`.
    number : int, optional
        In the machine's tool changer.
    name, kind : str
        As the file words them.
    unit : str
        That its lengths are given in: `mm`, `inch`; empty where the file does not say.
    cutter : Cutter, optional
        What can be judged of it. None: `unused` says why.
    unused : str, optional
        The field concerned, what is wrong with it and what to add.
    broken : bool
        It contradicts itself or cannot be read; else it is not for finishing, or lacks something.
    unheld : bool
        It is not used because it does not fit its holder.
    notes : tuple of str
        How it was understood where that is not plain.
    given : tuple of (str, float)
        Dimensions that were read, mm and degrees, by their ISO 13399 names.
    feed : float, optional
        Of its preset, mm/min. It is none of the cutter's, whose id stays the same.
    preset : str
        The name of the preset that the feed is of.
    """

    place: str
    number: int | None = None
    name: str = ""
    kind: str = ""
    unit: str = ""
    cutter: Cutter | None = None
    unused: str | None = None
    broken: bool = False
    notes: tuple[str, ...] = ()
    given: tuple[tuple[str, float], ...] = ()
    feed: float | None = None
    preset: str = ""
    unheld: bool = False

    @property
    def label(self) -> str:
        """Its place, and its name where it has one."""
        return f'{self.place} "{self.name}"' if self.name else self.place


@dataclass(frozen=True, slots=True)
class Library(Sequence[Cutter]):
    """The cutters of a file, each geometry once, in the file's order: `plan(part, cutters=library)`.

    Attributes
    ----------
    file, format : str
        The file's name without its folder, and the name of its format.
    entries : tuple of Entry
        All that the file lists, used or not.
    holders : tuple of Holder
        Listed by themselves, without a tool.
    notes : tuple of str
        How the file as a whole was understood.

    Examples
    --------
    >>> Library("none.toml", "plan-cutters TOML")[0:]
    ()
    """

    file: str
    format: str
    entries: tuple[Entry, ...] = ()
    holders: tuple[Holder, ...] = ()
    notes: tuple[str, ...] = ()
    cutters: tuple[Cutter, ...] = field(init=False)

    def __post_init__(self) -> None:
        cutters: dict[str, Cutter] = {}
        for entry in self.entries:
            if entry.cutter is not None:
                cutters.setdefault(entry.cutter.id, entry.cutter)
        object.__setattr__(self, "cutters", tuple(cutters.values()))

    def __len__(self) -> int:
        return len(self.cutters)

    def __iter__(self) -> Iterator[Cutter]:
        return iter(self.cutters)

    @overload
    def __getitem__(self, at: int) -> Cutter: ...
    @overload
    def __getitem__(self, at: slice) -> tuple[Cutter, ...]: ...
    def __getitem__(self, at: int | slice) -> Cutter | tuple[Cutter, ...]:
        return self.cutters[at]

    @property
    def unused(self) -> tuple[Entry, ...]:
        """Entries that became no cutter."""
        return tuple(entry for entry in self.entries if entry.cutter is None)

    def entries_of(self, cutter: Cutter | str) -> tuple[Entry, ...]:
        """All entries of one geometry; a cutter that was asked for more (allowance, holder) is not known any longer."""
        wanted = cutter if isinstance(cutter, str) else cutter.id
        return tuple(entry for entry in self.entries if entry.cutter is not None and entry.cutter.id == wanted)

    def numbers(self, cutter: Cutter | str) -> tuple[int, ...]:
        """Each tool number of one geometry once, in the file's order."""
        return tuple(dict.fromkeys(e.number for e in self.entries_of(cutter) if e.number is not None))

    def names(self, cutter: Cutter | str) -> tuple[str, ...]:
        """Each name of one geometry once, in the file's order."""
        return tuple(dict.fromkeys(entry.name for entry in self.entries_of(cutter) if entry.name))


def libraries_of(value: Any) -> tuple[Library, ...]:
    """One library or a list of such; None is an empty list."""
    if value is None:
        return ()
    libraries = [value] if isinstance(value, Library) else items(value, "libraries", "libraries")
    for each in libraries:
        if not isinstance(each, Library):
            raise LibraryError(f"{shown(each)} is no tool library: read_library reads a file")
    return tuple(libraries)
