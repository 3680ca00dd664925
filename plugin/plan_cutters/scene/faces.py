"""Which faces are to be machined and which are left out: the words of `--faces` and `--ignore`, and objects of CAD hosts."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Integral
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from cad_io.arrays import FaceInfo
from plan_cutters.domain.checks import choice
from plan_cutters.domain.figures import listed
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.preference import free_form_share
from plan_cutters.errors import OptionError

if TYPE_CHECKING:
    from cad_io import Part
    from cad_io.kernel.shapes import Node

#: The faces that a finisher would finish: what is judged where nobody says more.
DEFAULT = "sculptured,blends"
_WORDS = (
    "sculptured, blends, all, numbers as F3,7-12, a list of these, component:NAME, name:REGEX, color:#RRGGBB, or one of them "
    "after a ! for all others"
)
_KINDS = ("sculptured", "blends", "all")
_RANGE = r"[Ff]?[0-9]+(?:\s*-\s*[Ff]?[0-9]+)?"
_ITEM = rf"(?:{'|'.join(_KINDS)}|{_RANGE})"
_NUMBERS = re.compile(rf"{_RANGE}(?:\s*,\s*{_RANGE})*")
_LIST = re.compile(rf"{_ITEM}(?:\s*,\s*{_ITEM})*")
_COLOUR = re.compile(r"colou?r:#([0-9a-fA-F]{6})")
#: Digits of a number that are looked at: more than any part has faces.
_DIGITS = 12
#: Characters of a selection that an error repeats.
_LONGEST = 60


@dataclass(frozen=True, slots=True)
class Chosen:
    """The choice makes some faces of a part targets and ignores some; those in neither list are other faces."""

    #: `targets`, `ignored`: face numbers, ascending.
    targets: tuple[int, ...]
    ignored: tuple[int, ...]
    asked: str  #: The words for `targets`.
    ignore: tuple[str, ...]  #: The words for `ignored`.
    #: The targets are all faces for which no list was given, and none of them that can be judged is sculptured.
    unshaped: bool = False
    clamped: tuple[int, ...] = ()  #: Targets that are held in all setups.
    blends: frozenset[int] = frozenset()  #: Faces of the part that are fillets and rounds, whether chosen or not.
    free_form: float = 0.0  #: Share of the targets' area that is bent in both directions (`preference.free_form_share`).
    #: Ignored faces that lie where others lie: which face stands for each.
    repeated: Mapping[int, int] = field(default_factory=dict)


def choose(
    part: "Part", faces: Any, ignored: Collection[int], ignore: tuple[str, ...], placed: Placement | None = None,
    others: Sequence[Placement | None] = (), repeated: Mapping[int, int] = MappingProxyType({}),
) -> Chosen:  # fmt: skip
    """Target and ignored faces of a part.

    `faces`: without it those picked on the host's object, else `DEFAULT`. `ignored`: faces to leave out; `ignore`: the words for
    these. `placed`: its clamped faces stay targets: they are left for another setup, and named. `others`: of other setups: only
    what is clamped in all of them, too, is left. `repeated`: faces, ignored too, that lie where others lie: which face stands for
    each. Raises OptionError: a choice has no meaning, a face is requested by its number and ignored, or every target is clamped
    in all setups.
    """
    requested = _word(part, part.picked or DEFAULT if faces is None else faces, "--faces")
    targets = select_faces(part.faces, requested, tree=part.tree, ignored=ignored, blends=part.blends, repeated=repeated)
    unshaped = _finished(requested) and _none_sculptured(part.faces[n - 1] for n in targets)
    held = clamped_faces(part, placed, repeated).intersection(*[clamped_faces(part, each, repeated) for each in others])
    if placed is not None and held and held.issuperset(targets):
        raise OptionError(f"{placed.where} {_brief(', '.join(placed.clamped))} leaves no target face")
    clamped = tuple(n for n in targets if n in held) if placed is not None else ()
    share = free_form_share((part.faces[n - 1].shape, part.faces[n - 1].area) for n in targets)
    return Chosen(targets, tuple(sorted(ignored)), requested, ignore, unshaped, clamped, part.blends, share, dict(repeated))


def repeated_groups(
    part: "Part", repeated: Mapping[int, int]
) -> tuple[list[tuple[int, tuple[int, ...], int, tuple[int, ...]]], frozenset[int]]:
    """List bodies and faces that are no targets because they lie where others of the part lie.

    Returns `bodies` list of (int, tuple of int, int, tuple of int): a body and its faces, and the body that stands for it and its
    faces; `faces`: faces of none of these bodies.
    """
    from cad_io.part.patterns import repeats

    out, groups = set(repeated), []
    for each in repeats(part):
        bodies = [*zip(each.bodies, each.faces, strict=False)]
        these = [(body, faces) for body, faces in bodies if out.issuperset(faces)]
        if not these or len(these) == len(bodies):
            continue
        stays, own = next(one for one in bodies if one not in these)
        groups += [(body, faces, stays, own) for body, faces in these]
        out -= {n for _, faces in these for n in faces}
    return groups, frozenset(out)


def clamped_faces(part: "Part", placed: Placement | None, repeated: Mapping[int, int] = MappingProxyType({})) -> frozenset[int]:
    """Numbers of the faces that are held in a setup; of what is `repeated`, those that stand for it.

    Raises OptionError: a word selects no face of the part.
    """
    if placed is None:
        return frozenset()
    words = (_selected(part.faces, text, part.tree, placed.where, part.blends) for text in placed.clamped)
    return frozenset(repeated.get(n, n) for n in set[int]().union(*words))


def ignored_words(part: "Part", ignore: Any) -> tuple[str, ...]:
    """The choice of faces to leave out as words."""
    if isinstance(ignore, list | tuple) and all(isinstance(each, str) for each in ignore):
        return tuple(ignore)
    return () if ignore is None else (_word(part, ignore, "--ignore"),)


def ignored_faces(part: "Part", words: Sequence[str]) -> frozenset[int]:
    """Numbers of the faces to leave out, from their words (`ignored_words`)."""
    return frozenset().union(*(_selected(part.faces, text, part.tree, "--ignore", part.blends) for text in words))


def face_numbers(part: "Part", value: Any) -> tuple[int, ...]:
    """Numbers of faces, ascending, from a number, a face's name, the words of `--faces`, or objects of a kernel or CAD host.

    Raises OptionError: it selects no face of the part.
    """
    text = _word(part, value, "faces")
    if named := tuple(f.number for f in part.faces if f.name and f.name == text):
        return named
    return tuple(sorted(_selected(part.faces, text, part.tree, "faces", part.blends)))


def select_faces(
    faces: Sequence[FaceInfo], text: str, *, tree: "Sequence[Node]" = (), ignored: Iterable[int] = (),
    blends: Collection[int] = (), repeated: Mapping[int, int] = MappingProxyType({}),
) -> tuple[int, ...]:  # fmt: skip
    """Numbers of the target faces, ascending.

    `text`: `sculptured`, `blends`, `all`, numbers as `F3,7-12`, a list of these, `component:NAME`, `name:REGEX` or
    `color:#RRGGBB`; after a `!` all faces but these. `sculptured`, with or without `blends`, is all faces where none is
    sculptured. `faces`, `tree`: all faces and components of the part. `ignored`: faces that cannot be targets. `blends`: numbers
    of the faces that are fillets and rounds. `repeated`: faces that lie where others lie, and which one is taken for each.
    Raises OptionError: the text is not of that form, selects nothing, or names an ignored face by its number.
    """
    out = frozenset(ignored)
    remaining = [f for f in faces if f.number not in out]
    # What has no surface may have been sculptured: it is requested, but alone it would hide all others.
    if _finished(text) and _none_sculptured(remaining):
        chosen = [f.number for f in remaining]
    else:
        selected = {repeated.get(n, n) for n in _selected(faces, text, tree, "--faces", blends)}
        both = out & selected
        if both and _NUMBERS.fullmatch(text.strip()):
            raise OptionError(f"--faces {_brief(text)}: F{min(both)} is ignored (--ignore): it cannot be a target")
        chosen = sorted(selected - out)
    if not chosen:
        raise OptionError(f"--faces {_brief(text)}: --ignore leaves none of these faces")
    return tuple(chosen)


def _finished(text: str) -> bool:
    """The words ask for what is sculptured in a part, with its blends or without."""
    words = {word.strip() for word in text.split(",")}
    return "sculptured" in words and words <= set(DEFAULT.split(","))


def _none_sculptured(faces: Iterable[FaceInfo]) -> bool:
    """None is of a shape that is known to be sculptured."""
    return all(f.shape != "sculptured" or f.unjudged for f in faces)


def grammar(text: str, option: str) -> None:
    """Whether a text is a selection at all, whatever the part: an OptionError that names the option, if not."""
    where, plain = f"{option} {_brief(text)}", text.strip().removeprefix("!").strip()
    if plain.startswith("component:") or _COLOUR.fullmatch(plain):
        return
    if plain.startswith("name:"):
        try:
            re.compile(plain.removeprefix("name:"))
        except (re.error, RecursionError, OverflowError) as error:
            raise OptionError(f"{where}: not a regular expression ({error})") from None
    elif _LIST.fullmatch(plain):
        _numbered(plain, None, where)
    else:
        raise OptionError(f"{where}: give {_WORDS}")


def _selected(faces: Sequence[FaceInfo], text: str, tree: "Sequence[Node]", option: str, blends: Collection[int]) -> set[int]:
    """Numbers that a text selects: the one grammar of face selections."""
    where = f"{option} {_brief(text)}"
    word = text.strip()
    plain = word.removeprefix("!").strip()
    every = {f.number for f in faces}
    if not _LIST.fullmatch(plain):  # of numbers the part has more to say
        grammar(text, option)
    if plain.startswith("component:"):
        chosen = _of_component(tree, plain.removeprefix("component:"), where)
    elif plain.startswith("name:"):
        pattern = re.compile(plain.removeprefix("name:"))
        chosen = {f.number for f in faces if pattern.search(f.name)}
    elif match := _COLOUR.fullmatch(plain):
        wanted = tuple(bytes.fromhex(match[1]))
        chosen = {f.number for f in faces if f.colour and tuple(round(255 * c) for c in f.colour) == wanted}
    else:
        sculptured = {f.number for f in faces if f.shape == "sculptured"}
        kinds = {"all": every, "blends": set(blends), "sculptured": sculptured}
        words = {each.strip() for each in plain.split(",")} & set(_KINDS)
        chosen = _numbered(plain, len(faces), where).union(*(kinds[each] for each in words))
    # All but what a mistyped name selects would be everything.
    known_word = bool(chosen) or plain in _KINDS or _finished(plain)
    if word != plain:
        chosen = every - chosen
    if not (known_word and chosen):
        raise OptionError(f"{where} selects no face of this part")
    return chosen


def _numbered(word: str, count: int | None, where: str) -> set[int]:
    """Numbers in a list of numbers and ranges, none beyond `count`; without it they are looked at alone, whatever the part."""
    numbers: set[int] = set()
    for item in word.split(","):
        if item.strip() in _KINDS:
            continue
        ends = [end.strip().lstrip("Ff").lstrip("0") or "0" for end in item.split("-")]
        # No more digits than can count: neither a huge number nor a huge range is ever built.
        first, last = int(ends[0][:_DIGITS]), int(ends[-1][:_DIGITS])
        for end, number in ((ends[0], first), (ends[-1], last)):
            if count is not None and not 1 <= number <= count:
                raise OptionError(f"{where}: there is no face F{_brief(end)}; the part has F1 to F{count}")
        if first > last:
            raise OptionError(f"{where}: {_brief(item.strip())} runs backwards")
        if count is not None:
            numbers.update(range(first, last + 1))
        elif not first:
            raise OptionError(f"{where}: there is no face F0; they are numbered from 1")
    return numbers


def _of_component(tree: "Sequence[Node]", name: str, where: str) -> set[int]:
    from cad_io.kernel.shapes import component_of, faces_of

    known = sorted({path for path in component_of(tree).values() if path})
    numbers = faces_of(tree, name.strip("/")) if name.strip("/") else set()
    if not numbers and known:
        raise OptionError(f"{where}: no component has this name; the part has {listed(list(known))}")
    if not numbers:
        raise OptionError(f"{where}: the components of this part have no names")
    return numbers


def _brief(text: str) -> str:
    """A text as errors show it: one line, not too long."""
    line = " ".join(text.split())
    return line if len(line) <= _LONGEST else f"{line[:_LONGEST]}..."


def _word(part: "Part", value: Any, option: str) -> str:
    from cad_io.errors import CadIoError
    from cad_io.read.objects import face_numbers
    from cad_io.read.step_text import typed

    if isinstance(value, str):
        return typed(value, part.encoding) if part.encoding else value
    many = value if isinstance(value, Sequence) and not isinstance(value, bytes) else (value,)
    if many and all(isinstance(each, Integral) and not isinstance(each, bool) for each in many):
        return ",".join(f"F{n}" for n in sorted({int(n) for n in many}))
    choice(value, option)
    try:
        return ",".join(f"F{n}" for n in face_numbers(part, value))
    except CadIoError as error:
        raise OptionError(f"{option}: {error.cause}") from None
