"""Part-21 text whose bytes follow from the part alone.

The kernel keeps the groups of styles, one a product, in a map by address and writes them in the map's order (OCCT 7.9),
which differs from run to run. Here they follow the order of the products, and are numbered anew.
"""

import re
from collections.abc import Iterator

_GROUP = b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
_STRING = rb"'(?:[^']|'')*'"
_ENTITY = re.compile(rb"#(\d+)\s*=\s*((?:" + _STRING + rb"|[^';])*);")
_TOKEN = re.compile(rb"\s*(" + _STRING + rb"|#(\d+)|,|[^',#\s]+)")
_WIDTH = 72


def canonical(text: bytes) -> bytes:
    """The text with its groups of styles in the order of what they style.

    Entities before the first group do not refer to later ones, and their order is that of the shapes written.
    """
    first = re.search(rb"^#(\d+)\s*=\s*" + _GROUP, text, re.MULTILINE)
    if first is None:
        return text
    begin, end = first.start(), text.rindex(b"ENDSEC;")
    entities = {int(m[1]): m[2].strip() for m in _ENTITY.finditer(text, begin, end)}
    below = {number: [r for r in _references(entity) if r in entities] for number, entity in entities.items()}
    inner = {r for references in below.values() for r in references}
    roots = [number for number in entities if number not in inner]
    # Numbers of what was written before are the same in every run.
    groups = sorted(
        (number for number in roots if entities[number].startswith(_GROUP)),
        key=lambda n: [r for e in _walk(n, below) for r in _references(entities[e]) if r not in entities],
    )
    following = iter(groups)
    ordered = [next(following) if entities[n].startswith(_GROUP) else n for n in roots]
    new: dict[int, int] = {}
    for root in ordered:
        for number in _walk(root, below, new):
            new[number] = int(first[1]) + len(new)
    lines = [_wrapped(number, entities[old], new) for old, number in new.items()]
    return text[:begin] + b"".join(lines) + text[end:]


def _references(entity: bytes) -> Iterator[int]:
    return (int(m[2]) for m in _TOKEN.finditer(entity) if m[2])


def _walk(root: int, below: dict[int, list[int]], known: dict[int, int] | None = None) -> Iterator[int]:
    """An entity and all that it refers to, each once, in the kernel's order; what is `known` when its turn comes is left out."""
    seen: set[int] = set()
    stack = [root]
    while stack:
        number = stack.pop()
        if number not in seen and number not in (known or {}):
            seen.add(number)
            yield number
            stack += reversed(below[number])


def _wrapped(number: int, entity: bytes, new: dict[int, int]) -> bytes:
    """The entity on lines as long as the kernel's, with its references renumbered."""
    lines, line = [], b"#%d = " % number
    for match in _TOKEN.finditer(entity):
        token = b"#%d" % new.get(int(match[2]), int(match[2])) if match[2] else match[1]
        if len(line) + len(token) > _WIDTH and token != b",":
            lines.append(line)
            line = b"  "
        line += token
    return b"\n".join([*lines, line]) + b";\n"
