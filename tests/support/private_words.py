"""Private words of this project, counted as names and in texts that users read; the standard terms are in `docs/glossary.md`.

A name counts once in each scope that defines it: a function, a class, an argument, a variable, an attribute that is set,
a module, a word after `as`. A text is a string with a space in it that is no docstring, or what a template of the review page
shows.

Not counted, because they are standard terms somewhere and a program cannot tell which is meant: reach, gap, turn, turned,
nose, stage, sheet, cover, certain, memory, rows. `left` does not count where the same scope has a `right`. As plain English
verbs, found, given and left do not count in texts: "no posture was found", "no machine was given".

    python -m tests.support.private_words [FOLDER [FOLDER]]     counts by room, of one source tree or of two
    python -m tests.support.private_words --write               store the counts of this tree, which may only fall
"""

import ast
import re
import sys
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

from tests.support.places import ROOT

CEILING = ROOT / "tests" / "house" / "private_words.toml"

#: Private word: what to say instead.
INSTEAD = {
    "told": "reported, text",
    "said": "stated, text",
    "asked": "requested",
    "given": "input, stated",
    "found": "the thing, result",
    "kept": "stored, cached",
    "left": "remaining",
    "lost": "not reached, unread, missing",
    "elsewhere": "other setups",
    "beside": "neighbours",
    "around": "surroundings",
    "ahead": "compiling, next",
    "aside": "excluded, temporary",
    "room": "workspace, margin, permissions",
    "outlook": "cell status",
    "wobble": "variation",
    "site": "face cells",
    "crumb": "minor area",
    "habit": "largest first",
    "lending": "shared cluster",
    "lent": "shared",
    "handing": "job input",
    "onlooker": "progress listener",
    "telling": "summary",
    "lean": "tilt direction",
    "drawn": "swept, extruded, rendered",
    "standing": "placed fixture",
    "standin": "proxy geometry",
    "skin": "shell",
    "mend": "advice",
    "mended": "advice",
    "light": "outer tool",
    "heavy": "inner tool",
    "buried": "inside other bodies",
    "drawer": "default tool set",
    "past": "obstacle cache",
}
#: Fields of the plan file that others rely on: their names stay.
CONTRACT = {"asked_mm2", "left", "left_share"}
#: Plain English in a sentence.
ONLY_NAMES = {"found", "given", "left"}

SOURCES = (("plugin", "*.py"), ("cad_io", "*.py"), ("plugin", "*.jinja"), ("page/src", "*.ts"))

#: Kind ("names" or "texts"), room, word -> places, as `file:line: name`.
Places = dict[tuple[str, str, str], list[str]]


def words_of(text: str) -> set[str]:
    """The private words in a name or a text, in the singular.

    >>> sorted(words_of("_MOST_SITES")), sorted(words_of("LostFace")), sorted(words_of("stand_ins")), words_of("site_packages")
    (['site'], ['lost'], ['standin'], {'site'})
    >>> words_of("bright_leftover")
    set()
    """
    text = re.sub(r"(?:[Ss]tand[_-]?[Ii]n)(?=s?(?![a-z]))|STAND[_-]?IN(?=S?(?![A-Z]))", "Standin", text)
    parts = [part.lower() for part in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", text)]
    return {part if part in INSTEAD else part.removesuffix("s") for part in parts if part != "besides"} & INSTEAD.keys()


def names(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Defined names with their lines, each once in its scope."""

    def visit(node: ast.AST, scope: dict[str, int]) -> Iterator[tuple[str, int]]:
        for child in ast.iter_child_nodes(node):
            name = _defined(child)
            if name:
                scope.setdefault(name, child.lineno)  # type: ignore[attr-defined]
            if isinstance(child, _SCOPES):
                yield from in_scope(child)
            else:
                yield from visit(child, scope)

    def in_scope(node: ast.AST) -> Iterator[tuple[str, int]]:
        scope: dict[str, int] = {}
        yield from visit(node, scope)
        sides = any("right" in name.lower() for name in scope)
        yield from ((name, line) for name, line in scope.items() if not (sides and words_of(name) == {"left"}))

    yield from in_scope(tree)


_SCOPES = (
    ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Lambda, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp,
)  # fmt: skip


def _defined(node: ast.AST) -> str | None:
    match node:
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            return name
        case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
            return name
        case ast.Attribute(attr=name, ctx=ast.Store()):
            return f".{name}"
        case ast.alias(asname=name) | ast.ExceptHandler(name=name) | ast.MatchAs(name=name) | ast.MatchStar(name=name):
            return name
    return None


def texts(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Strings with a space in them, and their lines, without docstrings and other strings that stand alone."""
    alone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in alone and " " in node.value.strip():
            yield node.value, node.lineno


def texts_of_page(source: str, suffix: str) -> Iterator[tuple[str, int]]:
    """Strings with a space in them in TypeScript, or what a template shows between its tags, and their lines."""
    for match in (_TYPESCRIPT if suffix == ".ts" else _TEMPLATE).finditer(source):
        if " " in (match["text"] or "").strip():
            yield re.sub(r"\$\{[^}]*\}", " ", match["text"]), source.count("\n", 0, match.start()) + 1


#: Comments are passed over, and each string is taken whole: what stands between two strings is none.
_TYPESCRIPT = re.compile(r"""//.*|/\*(?s:.*?)\*/|(?P<quote>["`])(?P<text>(?:[^"`\\\n]|\\.)*)(?P=quote)""")
_TEMPLATE = re.compile(r">(?P<text>[^<>{}]+)")


def sentence(text: str) -> str:
    """A text without what is no word of ours in it: options with their values, and names in backticks."""
    return re.sub(r"`[^`]*`|--[a-z-]+(?:[ =][\w-]+)?", " ", text)


def count(folder: Path = ROOT) -> Places:
    """Count the private words of a source tree."""
    places: Places = defaultdict(list)
    for base, pattern in SOURCES:
        for path in sorted((folder / base).rglob(pattern)):
            within = path.relative_to(folder / base).parts
            room = "page" if base == "page/src" else "/".join([*base.split("/"), *within[:-1]][base == "plugin" :][:2])
            file, source = path.relative_to(folder).as_posix(), path.read_text(encoding="utf-8")
            if pattern == "*.py":
                tree = ast.parse(source)
                inside = ((name, line) for name, line in names(tree) if name not in CONTRACT)
                defined, shown = [(path.stem, 1), *inside], texts(tree)
            else:
                defined, shown = [], texts_of_page(source, path.suffix)
            for name, line in defined:
                for word in words_of(name):
                    places["names", room, word].append(f"{file}:{line}: {name.lstrip('.')}")
            for text, line in shown:
                for word in words_of(sentence(text)) - ONLY_NAMES:
                    places["texts", room, word].append(f"{file}:{line}: {text.strip()[:80]}")
    return places


def ceiling() -> Counter[tuple[str, str, str]]:
    """The most of each word in each room, by kind."""
    stored = tomllib.loads(CEILING.read_text(encoding="utf-8"))
    return Counter(
        {(kind, room, word): most for kind, rooms in stored.items() for room, by in rooms.items() for word, most in by.items()}
    )


def by_word(counts: Counter[tuple[str, str, str]]) -> Counter[tuple[str, str]]:
    """The counts of all rooms together."""
    total: Counter[tuple[str, str]] = Counter()
    for (kind, _, word), number in counts.items():
        total[kind, word] += number
    return total


def write(places: Places) -> None:
    """Store counts as the ceiling; a word may move to another room, but none may be used more often than before."""
    counts = Counter({key: len(each) for key, each in places.items()})
    if CEILING.exists() and (more := by_word(counts) - by_word(ceiling())):
        raise SystemExit("more private words than before: " + ", ".join(f"{word} in {kind}" for kind, word in sorted(more)))
    lines = [
        "# Private words by kind, room and word: they may only fall. `python -m tests.support.private_words --write` stores them."
    ]
    for kind in ("names", "texts"):
        lines += ["", f"[{kind}]"]
        for room in sorted({room for k, room, _ in counts if k == kind}):
            cells = ", ".join(f"{word} = {number}" for (k, r, word), number in sorted(counts.items()) if (k, r) == (kind, room))
            lines.append(f'"{room}" = {{ {cells} }}')
    CEILING.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _table(folders: list[Path]) -> Iterator[str]:
    counted = [Counter({key: len(each) for key, each in count(folder).items()}) for folder in folders]
    yield f"{'room':28}" + "".join(f"{kind:>8}" for kind in ("names", "texts") for _ in folders)
    rooms = sorted({room for counts in counted for _, room, _ in counts})
    for room in [*rooms, ""]:
        cells = [
            sum(number for (k, r, _), number in counts.items() if k == kind and (r == room or not room))
            for kind in ("names", "texts") for counts in counted
        ]  # fmt: skip
        yield f"{room or 'all':28}" + "".join(f"{cell:8}" for cell in cells)


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        write(count())
    else:
        print("\n".join(_table([Path(each) for each in sys.argv[1:]] or [ROOT])))
