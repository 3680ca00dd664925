"""STEP files that the kernel could not read as they stand: names in older encodings, and solids that no product leads to."""

import re
from typing import NamedTuple

from cad_io.read.encodings import CALLED, decoded, encoding_of, is_plain

#: Comments and strings; what stands between the apostrophes of a comment is no string.
_STRING = re.compile(rb"/\*.*?\*/|'(?:[^']|'')*'", re.DOTALL)
_FOREIGN = re.compile("[^\0-\x7f]+")
_SOLID = re.compile(rb"(#\d+)\s*=\s*(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP|SHELL_BASED_SURFACE_MODEL)\s*\(")
_REPRESENTATION = re.compile(rb"(#\d+)\s*=\s*[A-Z_]*SHAPE_REPRESENTATION\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)")
_UNIT = re.compile(rb"(#\d+)\s*=\s*\(([^;]*\bLENGTH_UNIT\s*\(\s*\)[^;]*)\)\s*;")
_NUMBER = re.compile(rb"#(\d+)\s*=")
#: A product, its definition, and the representation that it is joined to.
_PRODUCT = """#{0}=APPLICATION_CONTEXT('');
#{1}=PRODUCT_CONTEXT('',#{0},'mechanical');
#{2}=PRODUCT('','','',(#{1}));
#{3}=PRODUCT_DEFINITION_FORMATION('','',#{2});
#{4}=PRODUCT_DEFINITION_CONTEXT('part definition',#{0},'design');
#{5}=PRODUCT_DEFINITION('','',#{3},#{4});
#{6}=PRODUCT_DEFINITION_SHAPE('','',#{5});
#{7}=SHAPE_DEFINITION_REPRESENTATION(#{6},{representation});
"""
_OWN = """#{0}=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#{1}=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(({unit}))REPRESENTATION_CONTEXT('',''));
#{2}=SHAPE_REPRESENTATION('',({solids}),#{1});
"""


class Adopted(NamedTuple):
    """A file whose solids got a product: its text, the solids, and what is known of their unit; empty where it is stated."""

    data: bytes
    solids: list[str]
    unit: str


def readable(data: bytes) -> tuple[bytes, str]:
    r"""A file with the names in it as the kernel can read them, and what the encoding that they were in is called.

    The second is empty, and the first as it was, where names are ASCII or UTF-8.

    Examples
    --------
    >>> readable("#1=PRODUCT('齿轮');".encode("gb18030"))
    (b"#1=PRODUCT('\\X2\\9F7F8F6E\\X0\\');", 'GB18030')
    >>> readable(b"#1=PRODUCT('rim');")
    (b"#1=PRODUCT('rim');", '')
    """
    if data.isascii() or is_plain(data):
        return data, ""
    names = {text for text in _STRING.findall(data) if text.startswith(b"'") and not text.isascii()}
    encoding = encoding_of(sorted(names))
    escaped = {name: _FOREIGN.sub(lambda match: _escaped(match[0]), decoded(name, encoding)).encode() for name in names}
    return _STRING.sub(lambda match: escaped.get(match[0], match[0]), data), CALLED.get(encoding, "")


def _escaped(text: str) -> str:
    """Letters as STEP writes those that are not ASCII."""
    if max(text) <= "\uffff":
        return f"\\X2\\{''.join(f'{ord(letter):04X}' for letter in text)}\\X0\\"
    return f"\\X4\\{''.join(f'{ord(letter):08X}' for letter in text)}\\X0\\"


def adopted(data: bytes) -> Adopted | None:
    """A file none of whose shapes belongs to a product, with a product for its solids; None where that is not needed, or not so.

    Solids in a representation keep its unit. For others the only length unit of the file is taken, or else mm.
    """
    if b"SHAPE_DEFINITION_REPRESENTATION" in data or not (solids := _SOLID.findall(data)):
        return None
    number = 1 + max(int(each) for each in _NUMBER.findall(data))
    within = {rep: {item.strip() for item in items.split(b",")} for rep, items in _REPRESENTATION.findall(data)}
    representations = [rep.decode() for rep, items in within.items() if items & set(solids)]
    lone = [each.decode() for each in solids if not any(each in items for items in within.values())]
    text, unit = "", ""
    if lone:
        named = [(each.decode(), b"CONVERSION_BASED_UNIT" in words) for each, words in _UNIT.findall(data)]
        known = [each for each, converted in named if converted] or [each for each, _ in named]
        only = len(known) == 1
        unit = f"no unit is stated for {lone[0]}" + (f", {known[0]} is the only one" if only else "")
        text += _OWN.format(*range(number, number + 3), unit=known[0] if only else f"#{number}", solids=",".join(lone))
        representations.append(f"#{number + 2}")
        number += 3
    for representation in representations:
        text += _PRODUCT.format(*range(number, number + 8), representation=representation)
        number += 8
    end = data.rindex(b"ENDSEC") if b"ENDSEC" in data else len(data)
    return Adopted(data[:end] + text.encode() + data[end:], [each.decode() for each in solids], unit)
