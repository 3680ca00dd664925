"""Our own format: TOML with ISO 13399 names and units that are said; `toml_out` writes it."""

import math
import re
import tomllib
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from plan_cutters.domain.checks import radians_said, shown
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.domain.shapes import SAME, flute_length
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.library.files import MOST_TOOLS, Content, too_many
from plan_cutters.library.milling import Ask, cause_of
from plan_cutters.library.raw_tool import FaultError, Found, mm, name_of, unit_of
from plan_cutters.library.records import Entry

_LOOKS = re.compile(
    r"^[ \t]*(\[\[?[ \t]*(tool|holder)s?[ \t]*\]\]?[ \t]*(#.*)?\r?$|unit[ \t]*=)", re.MULTILINE | re.IGNORECASE
)
_TABLE = re.compile(r"^[ \t]*\[\[[ \t]*tool[ \t]*\]\]", re.MULTILINE)
_ENDS = ("flat", "bull", "ball", "taper", "dovetail", "end")

#: A tool's number is no larger, as in all formats.
_LARGEST = 10**9
_MOST = 8 << 20
#: What pydantic puts into the place of an error for a kind that it tried.
_KINDS = ("HolderTable", "str", "float")

Number = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Section = Annotated[list[Number], Field(min_length=2, max_length=3)]
Point = Annotated[list[Number], Field(min_length=2, max_length=2)]


class HolderTable(BaseModel):
    """A holder: points (z, r) of its outline, z counted from its nose up, or stages (radius, length[, upper radius])."""

    model_config = ConfigDict(extra="forbid")
    name: str = ""
    unit: str | None = None
    points: list[Point] | None = None
    stages: list[Section] | None = None


class ToolTable(BaseModel):
    """A tool: ISO 13399 names where there are such."""

    model_config = ConfigDict(extra="forbid")
    number: Annotated[int, Field(strict=True, ge=0, lt=_LARGEST)] | None = None
    name: str = ""
    type: Literal["flat", "bull", "ball", "taper", "dovetail", "end", "lollipop", "barrel", "lens", "form"]
    unit: str | None = None
    DC: Number | None = None
    RE: Number = 0.0
    LCF: Number | Literal["rest"] | None = None
    LPR: Number | None = None
    OAL: Number | None = None
    DMM: Number | Literal["same"] | None = None
    DN: Number | None = None
    LN: Number | None = None
    TA: Number | str | None = None
    PRFRAD: Number = 0.0
    profile_height: Number = 0.0
    neck: list[Section] = []
    outline: list[Point] = []
    holder: str | list[Point] | HolderTable | None = None
    allowance: Number | None = None
    clearance: Number | None = None


class LackError(Exception):
    """A value is missing; the message says which, and how to add it."""


def is_toml(content: Content) -> bool:
    """Tables `[[tool]]` or `[[holder]]`, or a unit; what is called so may have none of them yet."""
    if content.head[:1] in ("{", "<") or content.members is not None:
        return False
    return _LOOKS.search(content.text) is not None or content.path.suffix.lower() == ".toml"


def read_toml(content: Content, ask: Ask) -> Found:
    """Read it."""
    if len(content.data) > _MOST:
        # TOML is read by Python itself, some MB in a second.
        raise LibraryError(f"is larger than {_MOST >> 20} MB: no tool library is; split it", file=content.name)
    if len(_TABLE.findall(content.text)) > MOST_TOOLS:
        raise too_many(content.name)
    try:
        given = tomllib.loads(content.text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError) as error:
        raise LibraryError(f"is no TOML: {_syntax(error)}", file=content.name) from None
    for key in given:
        if key not in ("unit", "tool", "holder"):
            raise LibraryError(
                f"{shown(key)} has no meaning; a library has unit, [[tool]] and [[holder]]", file=content.name
            )
    tools, holders = (given.get(key, []) for key in ("tool", "holder"))
    for key, tables in (("tool", tools), ("holder", holders)):
        if not isinstance(tables, list):
            raise LibraryError(f"{key} is one table: write [[{key}]], with two brackets", file=content.name)
    if len(tools) > MOST_TOOLS or len(holders) > MOST_TOOLS:
        raise too_many(content.name)
    found = Found()
    # None: the name means more than one.
    named: dict[str, Holder | None] = {}
    for i, table in enumerate(holders, 1):
        try:
            model = HolderTable.model_validate(table)
            holder = _outlined(model, _scale(model.unit or given.get("unit"))[1])
        except (ValidationError, FaultError, CutterError) as error:
            found.faulty.append(Entry(f"holder {i}", kind="holder", unused=_why(error), broken=True))
            continue
        found.holders.append(holder)
        if holder.name:
            named[holder.name] = holder if named.get(holder.name, holder) == holder else None
    lines = [content.text.count("\n", 0, match.start()) + 1 for match in _TABLE.finditer(content.text)]
    for i, table in enumerate(tools):
        line = f" (line {lines[i]})" if len(lines) == len(tools) else ""
        found.tools.append(_entry(table, f"tool {i + 1}{line}", given.get("unit"), named, ask))
    return found


def _syntax(error: Exception) -> str:
    """Why a text is no TOML, and what it mostly is."""
    if isinstance(error, RecursionError):
        return "it is nested too deeply"
    if not isinstance(error, tomllib.TOMLDecodeError):
        return "it has a number of thousands of digits"
    why = " ".join(str(error).split())
    if "Expected newline" in why or "Invalid value" in why:
        why += '; numbers have a decimal point and no unit (12.5), words have quotes ("mm")'
    return why


def _scale(unit: Any) -> tuple[str, float]:
    return unit_of(unit, "unit")


def _why(error: Exception) -> str:
    """One line of what is wrong with a table."""
    if not isinstance(error, ValidationError):
        return cause_of(error) if isinstance(error, CutterError) else str(error)
    # Of kinds that were tried in turn, the one that was understood the farthest.
    first = max(error.errors(include_url=False, include_context=False), key=lambda each: len(each["loc"]))
    words = [str(word + 1) if isinstance(word, int) else word for word in first["loc"]]
    words = [word for word in words if (word.isidentifier() and word not in _KINDS) or word.isdigit()]
    field = " ".join(words) or "it"
    if first["type"] == "extra_forbidden":
        return f"{shown(first['loc'][-1])} has no meaning here{_meant(first['loc'][-1])}"
    if not first["loc"]:
        return f"it is {shown(first['input'])}, not a table"
    if first["type"] == "missing":
        return f"{first['loc'][-1]} is missing"
    return f"{field} is {shown(first['input'])}: {first['msg'][:1].lower()}{first['msg'][1:]}"


def _meant(word: Any) -> str:
    """The key that is written almost so."""
    for key in (*ToolTable.model_fields, *HolderTable.model_fields):
        if key.lower() == str(word).lower():
            return f"; {key} is written so"
    return ""


def _entry(table: Any, place: str, unit: Any, named: dict[str, Holder | None], ask: Ask) -> Entry:
    number = name = None
    if isinstance(table, dict):
        number, name = table.get("number"), table.get("name")
    made: dict[str, Any] = {
        "place": place,
        "number": number
        if isinstance(number, int) and not isinstance(number, bool) and 0 <= number < _LARGEST
        else None,
        "name": name_of(name),
    }
    notes: list[str] = []
    try:
        model = ToolTable.model_validate(table)
        made["kind"] = model.type
        made["unit"], scale = _scale(model.unit or unit)
        return Entry(**made, cutter=_Reading(model, scale, named, ask, notes).cutter(), notes=tuple(notes))
    except LackError as lack:
        return Entry(**made, unused=str(lack), notes=tuple(notes))
    except (ValidationError, FaultError, CutterError) as error:
        return Entry(**made, unused=_why(error), broken=True, notes=tuple(notes))


def _length(value: float, scale: float, field: str) -> float:
    """mm; those given in mm stay as they are."""
    found = mm(value, scale, field)
    return value if scale == 1.0 else found


def _outlined(model: HolderTable, scale: float) -> Holder:
    if (model.points is None) == (model.stages is None):
        raise FaultError("holder needs points [[z, r], ...] or stages [[radius, length], ...], and not both")
    if model.stages is not None:
        stages = _stages(model.stages, scale, "holder stages")
    else:
        stages = []
        points = [[_length(value, scale, "holder points") for value in point] for point in model.points or ()]
        if not points or points[0][0] != 0.0:
            raise FaultError("holder points must begin at its nose, z 0")
        for (z0, r0), (z1, r1) in pairwise(points):
            if z1 < z0:
                raise FaultError(f"holder points fall from z {z0:g} to {z1:g}: they must rise from the nose up")
            if z1 > z0:
                stages.append(Segment(r0, round(z1 - z0, 9), r1))
    return Holder(tuple(stages), model.name)


def _stages(rows: list[Section], scale: float, field: str) -> list[Segment]:
    return [Segment(*(_length(value, scale, field) for value in row)) for row in rows]


class _Reading:
    """One tool being read."""

    def __init__(self, model: ToolTable, scale: float, named: dict[str, Holder | None], ask: Ask,
                 notes: list[str]) -> None:  # fmt: skip
        self.model, self.scale, self.named, self.ask, self.notes = model, scale, named, ask, notes

    def value(self, field: str) -> float:
        """A length, mm; 0 where it is missing."""
        given = getattr(self.model, field)
        return 0.0 if given is None else _length(given, self.scale, field)

    def needed(self, field: str, what: str) -> float:
        found = self.value(field)
        if not found:
            raise LackError(f"{field} is missing: {what}")
        return found

    def stickout(self) -> float:
        own, overall = self.value("LPR"), self.value("OAL")
        if own and overall and own > overall:
            raise FaultError(f"LPR {self.model.LPR:g} is more than OAL {self.model.OAL:g}")
        if own:
            return own
        if self.ask.stickout is None:
            raise LackError("LPR is missing (the stick-out, from the tip to the holder's nose): add it, or give "
                            "--assume-stickout MM")  # fmt: skip
        if overall and self.ask.stickout > overall:
            raise LackError(
                f"the assumed stick-out of {self.ask.stickout:g} mm is longer than the tool, OAL {self.model.OAL:g}"
            )
        self.notes.append(f"no LPR: the assumed stick-out of {self.ask.stickout:g} mm is taken")
        return self.ask.stickout

    def holder(self) -> Holder | None:
        given = self.model.holder
        if isinstance(given, list):
            return _outlined(HolderTable(points=given), self.scale)
        if isinstance(given, HolderTable):
            return _outlined(given, _scale(given.unit)[1] if given.unit else self.scale)
        if given == "none":
            if "none" in self.named:
                raise FaultError(
                    "holder 'none' means that there is none, but a [[holder]] is called so: call that otherwise"
                )
            return None
        if given is not None:
            if given in self.named:
                meant = self.named[given]
                if meant is None:
                    raise FaultError(f"holder {shown(given)}: several different [[holder]] are called so")
                return meant
            try:
                return Holder.parse(given)
            except CutterError:
                raise FaultError(
                    f"holder {shown(given)} is neither none, nor of the form R15L30 (mm), nor one of [[holder]]"
                ) from None
        if self.ask.holder is None:
            raise LackError('holder is missing: add it ("none" if there is none), or give --holder SPEC, as R15L30')
        if self.ask.holder == "none":
            self.notes.append("no holder: it is judged without one, as asked")
            return None
        self.notes.append(f"no holder: the given one is taken, {self.ask.holder.name or self.ask.holder.id}")
        return self.ask.holder

    def taper(self) -> float:
        """Half angle, rad; negative for a dovetail."""
        given, kind = self.model.TA, self.model.type
        if given is None:
            if kind in ("taper", "dovetail"):
                raise LackError("TA is missing: the angle of its flank from the axis, degrees")
            return 0.0
        if isinstance(given, str):
            found = radians_said(given)
            if math.isnan(found):
                raise FaultError(f"TA is {shown(given)}: a half angle in degrees, or as 0.0873 rad")
        else:
            found = math.radians(given)
        if kind in ("taper", "dovetail") and not 0.0 < found < math.pi / 2:
            raise FaultError(
                f"TA is {given}: a half angle lies between 0 and 90 degrees; of a dovetail it is positive, too"
            )
        if found and kind in ("flat", "bull", "ball"):
            self.notes.append(
                f'called "{kind}", but TA is {given}: read as {"tapered" if found > 0.0 else "a dovetail"}'
            )
        return -found if kind == "dovetail" else found

    def necks(self) -> list[Segment]:
        if self.model.neck:
            twice = "LN" if self.model.LN is not None else "DN" if self.model.DN is not None else ""
            if twice and (twice == "LN" or self.model.type != "lollipop"):
                raise FaultError(f"neck and {twice}: give one of them")
            return _stages(self.model.neck, self.scale, "neck")
        if self.model.type == "lollipop":
            return []
        if not self.value("LN"):
            if self.value("DN"):
                raise LackError("LN is missing: the length of its neck of DN")
            return []
        return [Segment(0.5 * self.needed("DN", "the diameter of its neck of LN"), self.value("LN"))]

    def flutes(self, shape: str, necks: list[Segment], length: float) -> float | None:
        if shape in ("lollipop", "form"):
            if self.model.LCF is not None:
                raise FaultError(f"LCF: the flutes of a {shape} end where its outline does; leave it out")
            return None
        return (
            None
            if self.model.LCF == "rest"
            else self.needed("LCF", 'the length of its flutes ("rest": all below the neck)')
        )

    def cutter(self) -> Cutter:
        model = self.model
        shape: Any = "end" if model.type in _ENDS else model.type
        outline = [(_length(r, self.scale, "outline"), _length(z, self.scale, "outline")) for z, r in model.outline]
        if shape == "form":
            radius = max((r for r, _ in outline), default=0.0)
            if not radius:
                raise LackError("outline is missing: points [[z, r], ...] from the tip up")
            if model.DC is not None and abs(self.value("DC") - 2.0 * radius) > 1e-3:
                raise FaultError(f"DC {model.DC:g} is not the largest diameter of its outline")
        else:
            radius = 0.5 * self.needed("DC", "the cutting diameter")
        length, necks = self.stickout(), self.necks()
        corner = self.corner(radius)
        flutes = self.flutes(shape, necks, length)
        shank: float | None = None
        if shape == "lollipop":
            shank = 0.5 * self.needed("DN", "the diameter of its neck")
            necks = self.under(necks, Cutter.lollipop(radius=radius, neck_radius=shank, length=10 * radius), length)
        elif model.DMM != "same":
            top = outline[-1][1] if outline else length if flutes is None and not necks else flutes
            rest = 0.0 if top is None else length - top - math.fsum(stage.length for stage in necks)
            if rest > SAME:
                shank = 0.5 * self.needed("DMM", 'the diameter of its shank ("same": as wide as what is below it)')
        return Cutter(radius, length, corner, name_of(model.name) if model.name != name_of(model.name) else model.name,
                      self.taper(), flutes, tuple(necks) or None, shank, self.holder(), shape, self.value("PRFRAD"),
                      self.value("profile_height"), tuple(outline),
                      None if model.allowance is None else self.value("allowance"),
                      None if model.clearance is None else self.value("clearance"))  # fmt: skip

    def corner(self, radius: float) -> float:
        corner, kind = self.value("RE"), self.model.type
        if kind == "lollipop":
            if corner and abs(corner - radius) > 1e-3:
                raise FaultError(f"RE {self.model.RE:g} is not half of DC {self.model.DC:g}: that of its ball")
            return radius
        if kind == "ball" and not corner:
            self.notes.append("no RE: half of DC")
            return radius
        if kind in ("flat", "bull", "ball"):
            is_ = "flat" if not corner else "ball" if corner == radius else "bull"
            if is_ != kind:
                self.notes.append(f'called "{kind}", but RE is {self.model.RE:g}: read as {is_}')
        return corner

    def under(self, necks: list[Segment], ball: Cutter, length: float) -> list[Segment]:
        """Of a lollipop whose neck ends at LN over the ball, below a shank of DMM."""
        reach = self.value("LN")
        if necks or not reach:
            return necks
        top = flute_length(ball)
        rest = length - top - reach
        if rest <= SAME:
            return [Segment(ball.shank_radius or 0.0, length - top)]
        return [
            Segment(ball.shank_radius or 0.0, reach),
            Segment(0.5 * self.needed("DMM", "the diameter of its shank"), rest),
        ]
