"""Sizes with tolerances and notes on faces, as AP242 has them beside the shape (semantic PMI), from the text of a STEP file.

The kernel's own reading of them takes the sign off a lower deviation, and its Python binding loses a tolerance class.
"""

import math
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from cad_io.arrays import SizeNote

#: Without it a file has none; what leads from sizes to faces and values.
_SIZE = b"DIMENSIONAL_SIZE"
_STATEMENT = re.compile(rb"#(\d+)\s*=\s*((?:[^;'/]|/(?!\*)|'(?:[^']|'')*'|/\*.*?\*/)*);", re.DOTALL)
_KIND = re.compile(r"\(?\s*([A-Z][A-Z_0-9]*)\s*\(")
_REFERENCE = re.compile(r"#(\d+)")
_TEXT = re.compile(r"'((?:[^']|'')*)'")
_VALUE = re.compile(r"(?:LENGTH_MEASURE|MEASURE_WITH_UNIT)\s*\(\s*([-+]?\d+\.?\d*(?:[eE][-+]?\d+)?)\s*[,)]")
_ITEM_NAME = re.compile(r"REPRESENTATION_ITEM\s*\(\s*'((?:[^']|'')*)'")
_SI = re.compile(r"SI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.METRE\.\s*\)")
_PREFIXES = {"": 1e3, "MILLI": 1.0, "CENTI": 10.0, "DECI": 100.0, "MICRO": 1e-3, "KILO": 1e6}
#: Notes that make a size no requirement.
_NO_REQUIREMENT = ("theoretical", "auxiliary")
#: Aspects that are followed from one, and units, at most.
_MOST, _DEEPEST = 1000, 4


def stated(data: bytes) -> list[tuple[SizeNote, tuple[str, ...]]]:
    """Sizes that a file states of faces, each with the names (`#12`) of these; a file without any is not looked through.

    Lengths are in mm by the units that the file has for them.
    """
    return [*_Sizes(data).stated()] if _SIZE in data else []


@dataclass(frozen=True)
class _Sizes:
    data: bytes

    @cached_property
    def statements(self) -> dict[str, str]:
        """Return the text behind each number."""
        return {key.decode(): text.decode("utf-8", "replace").strip() for key, text in _STATEMENT.findall(self.data)}

    @cached_property
    def kinds(self) -> dict[str, list[str]]:
        """Numbers of each kind; what is of several kinds at once goes by the first."""
        kinds = defaultdict[str, list[str]](list)
        for key, text in self.statements.items():
            if (match := _KIND.match(text)) is not None:
                kinds[match[1]].append(key)
        return kinds

    def stated(self) -> Iterator[tuple[SizeNote, tuple[str, ...]]]:
        of = self._by_first("DIMENSIONAL_CHARACTERISTIC_REPRESENTATION", "PLUS_MINUS_TOLERANCE")
        for size in self.kinds["DIMENSIONAL_SIZE"]:
            text = self.statements[size]
            name = _TEXT.search(text)
            aspect = _REFERENCE.search(text)
            faces = self._faces(aspect[1]) if aspect else []
            if not faces or name is None or name[1] not in ("diameter", "radius"):
                continue
            twice = 2.0 if name[1] == "radius" else 1.0
            values, notes, lower, upper, fit = dict[str, float](), list[str](), None, None, ""
            for row in of.get(size, ()):
                if row.startswith("DIM"):
                    values, notes = self._characteristic(row)
                else:
                    lower, upper, fit = self._tolerance(row)
            nominal = values.get("nominal value")
            if not {*_NO_REQUIREMENT}.isdisjoint(notes):
                lower = upper = None
            elif nominal is not None and "lower limit" in values and "upper limit" in values:
                lower, upper = values["lower limit"] - nominal, values["upper limit"] - nominal
            elif "lower limit" in values and "upper limit" in values:
                # Limits alone: the middle has no name.
                nominal, lower, upper = values["lower limit"], 0.0, values["upper limit"] - values["lower limit"]
            wide, low, high = (None if each is None else round(twice * each, 9) for each in (nominal, lower, upper))
            texts = tuple(each for each in notes if each not in _NO_REQUIREMENT)
            yield SizeNote((), wide, low, high, fit, texts), tuple(faces)

    def _by_first(self, *kinds: str) -> Mapping[str, list[str]]:
        """Statements of some kinds by the sizes that they are about."""
        rows = defaultdict[str, list[str]](list)
        sizes = {*self.kinds["DIMENSIONAL_SIZE"]}
        for kind in kinds:
            for key in self.kinds[kind]:
                text = self.statements[key]
                for number in sizes.intersection(_REFERENCE.findall(text)):
                    rows[number].append(text)
        return rows

    def _characteristic(self, row: str) -> tuple[dict[str, float], list[str]]:
        """Lengths by their names, and notes, of the representation that belongs to a size."""
        values, notes = dict[str, float](), list[str]()
        for representation in _REFERENCE.findall(row):
            text = self.statements.get(representation, "")
            for item in _REFERENCE.findall(text) if text.startswith("SHAPE_DIMENSION_REPRESENTATION") else ():
                row = self.statements.get(item, "")
                if row.startswith("DESCRIPTIVE_REPRESENTATION_ITEM"):
                    words = _TEXT.findall(row)
                    notes += [_plain(words[1])] if len(words) > 1 else []
                elif (name := _ITEM_NAME.search(row)) is not None and (length := self._length(row)) is not None:
                    values[name[1]] = length
        return values, notes

    def _tolerance(self, row: str) -> tuple[float | None, float | None, str]:
        """Lower and upper deviation, mm, or the class."""
        for key in _REFERENCE.findall(row):
            text = self.statements.get(key, "")
            if text.startswith("LIMITS_AND_FITS"):
                form, _, grade = [_plain(each) for each in _TEXT.findall(text)[:3]] or ("", "", "")
                return None, None, form + grade.removeprefix("IT")
            if text.startswith("TOLERANCE_VALUE"):
                both = [self._length(self.statements.get(each, "")) for each in _REFERENCE.findall(text)]
                if len(both) == 2 and None not in both:
                    # Each has the sign that it is written with; of two that are equal the lower one lost it.
                    lower, upper = both[0] or 0.0, both[1] or 0.0
                    return (-lower, upper, "") if lower == upper > 0.0 else (lower, upper, "")
        return None, None, ""

    def _length(self, text: str) -> float | None:
        """A length with a unit, mm."""
        value, units = _VALUE.search(text), _REFERENCE.findall(text)
        scale = self._unit(units[0]) if value is not None and units else None
        length = float(value[1]) * scale if value is not None and scale is not None else math.nan
        return length if math.isfinite(length) else None

    def _unit(self, key: str, deep: int = 0) -> float | None:
        """Length of a unit, mm; None where it is none."""
        text = self.statements.get(key, "")
        si = _SI.search(text)
        if si is not None:
            return _PREFIXES.get(si[1] or "")
        converted = re.search(r"CONVERSION_BASED_UNIT\s*\([^#]*#(\d+)", text)
        measure = self.statements.get(converted[1], "") if converted and deep < _DEEPEST else ""
        value, inner = _VALUE.search(measure), _REFERENCE.findall(measure)
        scale = self._unit(inner[0], deep + 1) if value is not None and inner else None
        return None if value is None or scale is None else float(value[1]) * scale

    @cached_property
    def _aspects(self) -> tuple[Mapping[str, list[str]], Mapping[str, list[str]]]:
        """Of each aspect the aspects that it is made of, and its items."""
        parts, items = defaultdict[str, list[str]](list), defaultdict[str, list[str]](list)
        for key in (*self.kinds["SHAPE_ASPECT_RELATIONSHIP"], *self.kinds["FEATURE_FOR_DATUM_TARGET_RELATIONSHIP"]):
            both = _REFERENCE.findall(self.statements[key])
            if len(both) == 2:
                parts[both[0]].append(both[1])
        for key in (*self.kinds["GEOMETRIC_ITEM_SPECIFIC_USAGE"], *self.kinds["ITEM_IDENTIFIED_REPRESENTATION_USAGE"]):
            aspect, *used = _REFERENCE.findall(self.statements[key])
            items[aspect] += used[1:]
        return parts, items

    def _faces(self, aspect: str) -> list[str]:
        """The faces of an aspect, and of those that it is made of."""
        parts, items = self._aspects
        seen, waiting = {aspect: None}, [aspect]
        while waiting and len(seen) < _MOST:
            new = [each for each in parts.get(waiting.pop(), ()) if each not in seen]
            seen |= dict.fromkeys(new)
            waiting += new
        every = dict.fromkeys(item for each in seen for item in items.get(each, ()))
        return [f"#{item}" for item in every if "FACE" in self.statements.get(item, "").partition("(")[0]]


def _plain(text: str) -> str:
    return text.replace("''", "'").strip()


def numbered(notes: Sequence[tuple[SizeNote, tuple[str, ...]]], numbers: Mapping[str, Sequence[int]]) -> tuple[SizeNote, ...]:
    """Notes with the numbers of their faces, by what these are called in the file; those without any are left out."""
    rows = [(note, tuple(n for name in names for n in numbers.get(name, ()))) for note, names in notes]
    return tuple(SizeNote(faces, note.nominal, note.lower, note.upper, note.fit, note.notes) for note, faces in rows if faces)
