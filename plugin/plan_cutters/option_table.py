"""The options of a plan, each declared once: the command line, its requests, checks and defaults are made of this table.

It is read before help is shown: nothing large is imported. The stub `option_types.pyi`, by which type checkers know the options,
is written of it by `python -m tests.support.option_stub`; `plan_file.effective` has the entry in a plan.
"""

import math
from collections.abc import Iterable, Mapping
from typing import Any, Literal, NamedTuple

from cad_io.units import UNITS
from plan_cutters.domain.answer_kinds import KINDS

#: Gouge tolerances that can be requested, mm.
LEAST_TOLERANCE, MOST_TOLERANCE = 1e-4, 10.0
#: How much work each stage after the verdicts may take, in what it may take by itself.
EFFORT: Mapping[str, float] = {"quick": 0.2, "normal": 1.0, "thorough": 5.0}
#: Longest length that can be requested, mm: longer ones are rather a mistake. Most threads.
_LONGEST, _MOST_JOBS = 1e6, 1024
#: Before a setup or a selection of faces that takes the place of those before it.
ONLY = "only:"
_POSITIVE = math.ulp(0.0), _LONGEST, f"must be a positive number of mm, at most {_LONGEST:g}"
_NOT_NEGATIVE = 0.0, _LONGEST, f"must be 0 or a positive number of mm, at most {_LONGEST:g}"
_AT_LEAST_1 = 1, math.inf, "must be at least 1"


def _literal(words: Iterable[str]) -> str:
    return f"Literal{[*words]}".replace("'", '"')


_ANSWER = _literal([*(each.word for each in KINDS), "all"])


class Option(NamedTuple):
    """An option of a plan."""

    word: str  #: The attribute of `Options`.
    kind: type | Literal["range"]
    default: Any  #: As the command line has it: angles in degrees.
    help: str
    #: Its line in the short help, which leaves out options that have none; True: the same as in the whole one.
    brief: str | bool = False
    unit: str = ""  #: Of a number: mm, deg, s and so on.
    #: The least and the largest value, and what is said of one beyond them where more is to be said than both.
    limits: tuple[float, float] | tuple[float, float, str] | None = None
    choices: tuple[str, ...] = ()
    metavar: str | None = None  #: What help calls a value, where it is not the unit.
    typed: str = ""  #: Its word of the command line, where that is another one.
    several: bool = False
    of_a_point: bool = False  #: Whether it is about one posture already, as in a posture map.
    #: Its type as callers give it, and as `Options` keeps it, where they are not those of `kind`, `choices` and `default`.
    takes: str = ""
    keeps: str = ""

    @property
    def called(self) -> str:
        """Its word of the command line, with `_` for `-`."""
        return self.typed or self.word

    @property
    def is_angle(self) -> bool:
        """Whether it may also be given in degrees, by a name that ends in `_deg`."""
        return self.unit == "deg" or self.kind == "range"

    @property
    def types(self) -> tuple[str, str]:
        """Its type as callers give it, and as `Options` keeps it."""
        plain = _literal(self.choices) if self.choices else getattr(self.kind, "__name__", "")
        keeps = self.keeps or plain + (" | None" if self.default is None else "")
        return self.takes or keeps, keeps


_CUTTERS = (
    Option(
        "cutters", str, (), typed="cutter", several=True, brief="D12L80, then rc1, T5, F20, N11x40, S12; repeatable.",
        takes="Cutter | str | Library | Sequence[Cutter | str] | Mapping[str, Cutter | str] | None", keeps="tuple[Cutter, ...]",
        help="D12L80: diameter 12, 80 mm from tip to holder, or R6L80 by radius; then rc1 corner radius (rc6: ball), T5 taper "
        "(half angle, deg), F20 length of flutes, N11x40 neck (diameter x length; more of them upwards), S12 shank; behind R, "
        "N and S are radii, too. Inches: D0.5inL3in. Repeatable.  [default: the built-in tool set]",
    ),
    Option(
        "libraries", str, (), typed="cutters", several=True, brief="Tool library: Fusion, FreeCAD, CSV, TOML; repeatable.",
        takes="Library | Sequence[Library] | None", keeps="tuple[Library, ...]",
        help="Tool library: Fusion .json, .tools or CSV, HSMWorks .hsmlib, FreeCAD .fctl or .fctb, or TOML; "
        "the command `tools` shows how it is understood. Repeatable.",
    ),
    Option(
        "holder", str, None, brief="Holder of cutters without one: er32, D30L30.", of_a_point=True,
        takes="Holder | str | None", keeps="Holder | None",
        help="Holder of the cutters that have none: a collet chuck as er32, hsk63a-er32 or bt40-er16x100 (the command `tools` "
        "lists them with --list-holders); D30L30 or R15L30 (diameter or radius, length); stages from the nose up joined by +, "
        "cones as D24:30L20; a file with a holder (FILE#NAME if it has several); or `none`.",
    ),
)  # fmt: skip

_MACHINE = (
    Option(
        "machine", str, "unlimited", brief="Built-in name, tilt:DEG, or a machine file.", of_a_point=True,
        takes="Machine | str | os.PathLike[str] | None", keeps="Machine",
        help="`unlimited`; `tilt:DEG`, a limit of the tool axis from the setup axis; a built-in machine "
        "(the command `machines` lists them); or a machine file: TOML, JSON, FreeCAD .fcm, LinuxCNC .ini, Fusion .mch.  "
        "[default: unlimited]",
    ),
    Option(
        "setup", str, ("0,0,1",), several=True, brief="Part axis along the spindle: +z, x,y,z; or `auto`.",
        takes="Setup", keeps="tuple[float, float, float]",
        help="Direction of the part along the machine's spindle, +z, -y or x,y,z, or a setup file (TOML) that says where the "
        "part stands. Repeatable: every cutter is judged in each, and the summary says what they reach together. `auto` "
        "proposes the fewest that reach most, in a vise, a chuck or on a table, and plans what it proposes; setups named "
        "behind it take its place.  [default: 0,0,1]",
    ),
    Option(
        "fixtures", str, (), typed="fixture", several=True, brief="Body in the way: a file, table, vise, chuck.", of_a_point=True,
        takes="Any", keeps="tuple[Fixture, ...]",
        help="A body in the way: STEP, IGES, BREP, STL, OBJ, PLY, GLB, or `box:X,Y,Z`, `cylinder:R,H`, placed in part "
        "coordinates (mm, degrees); `table`, all below the part along the setup axis, or `table:H`, all below H. "
        "`vise[:JAW_WIDTHxJAW_HEIGHTxOPENING][:GRIP]` and `chuck[:JAWSxHEIGHT][:GRIP]` are placed for each setup, on what they "
        "can grip there. With --setup auto all three are tried, or the one that is given. Repeatable.",
    ),
    Option(
        "stock", str, None, brief="What the first setup grips: box, cylinder, FILE, part.",
        keeps="str", takes="str | None",
        help="What the part is made of: `box[:X,Y,Z]`, margins on each side and below, mm; `cylinder[:R,Z]` along the setup "
        "axis; a STEP file or mesh; or `part`: it is there but for its last cut. A vise or chuck of the first setup grips the "
        "stock below the part, and hides none of its faces.  "
        "[default: with --setup auto a box, or a bar if the part is round; else part]",
    ),
)  # fmt: skip

_FACES = (
    Option(
        "faces", str, "sculptured,blends", brief="sculptured, blends, all, F3,7-12, name:REGEX.",
        keeps="Any",
        help="`sculptured` (faces that are no plane, cylinder, cone, sphere or torus in shape; all faces where none is), "
        "`blends` (fillets and rounds: they join two faces smoothly), `all`, `F3,7-12`, a list of these, `component:NAME`, "
        "`name:REGEX` or `color:#RRGGBB`, after a `!` all but these; the others are not judged, only obstacles.  "
        "[default: sculptured,blends]",
    ),
    Option(
        "ignore", str, (), several=True, brief="Faces neither machined nor in the way.", of_a_point=True,
        keeps="Any",
        help="Faces that are neither machined nor obstacles, as construction geometry; the same words. Repeatable.",
    ),
    Option("flip", bool, False, "Machine the other side of open shells and loose faces.", of_a_point=True),
    Option(
        "sharp_edges", str, "asked", choices=("asked", "left"),
        help="`left`: the strips along sharp inside edges (two faces meet without a fillet) that no cutter enters are not "
        "required.  [default: all are required]",
    ),
    Option(
        "drill_below", float, 16.0, unit="mm", limits=_NOT_NEGATIVE, brief="Holes narrower than this are for drills; 0: none.",
        help="Holes narrower than this are for drills: no mill has to reach their faces; 0: all are milled.",
    ),
    Option(
        "unit", str, None, choices=tuple(UNITS), of_a_point=True,
        keeps="str | None",
        help="Unit of the lengths in the part's file, if the file states a wrong one.  [default: as stated]",
    ),
)  # fmt: skip

_SAMPLES = (
    Option(
        "effort", str, "normal", choices=tuple(EFFORT),
        help="Work that advice and proofs after the verdicts may take: a fifth of the usual, or five times as much.  "
        "[default: normal]",
    ),
    Option(
        "spacing", float, None, unit="mm", limits=_POSITIVE, brief="Largest distance of neighbouring samples.",
        help="Largest distance of neighbouring samples.  [default: from curvature, the smallest cutter and a budget]",
    ),
    Option(
        "grid", int, None, limits=(2, 5000, "must lie between 2 and 5000 samples a side"),
        help="N x N samples in the parameters of each face, instead of a spacing.",
    ),
    Option(
        "area_budget", int, None, limits=(0, math.inf, "must not be negative"),
        help="Contacts to look at between the samples, for the selected cutter; 0: none.  "
        "[default: 24 a sample, at most 100000]",
    ),
    Option(
        "tolerance", float, 0.01, "Gouge tolerance.", brief=True, unit="mm", limits=(LEAST_TOLERANCE, MOST_TOLERANCE),
        of_a_point=True,
    ),
    Option("allowance", float, 0.0, "Stock left on the surface.", brief=True, unit="mm", limits=_NOT_NEGATIVE, of_a_point=True),
    Option(
        "holder_clearance", float, 0.0, unit="mm", limits=_NOT_NEGATIVE, of_a_point=True,
        brief="Clearance of neck, shank and holder.  [default: 0]", help="Clearance that neck, shank and holder must keep.",
    ),
)  # fmt: skip

_POSTURES = (
    Option(
        "tilt", "range", None, of_a_point=True,
        takes="Range | None", keeps="tuple[float, float]",
        help="Tilts to search, deg from the normal.  [default: 0:90, or as far as cutters touch]",
    ),
    Option(
        "rotation", "range", "0:360", of_a_point=True,
        takes="Range", keeps="tuple[float, float]",
        help="Rotations to search, degrees from the direction of the largest curvature.  [default: 0:360]",
    ),
    Option("rotation_step", float, 10.0, "Step between rotations.", unit="deg", of_a_point=True),
    Option(
        "axis_accuracy", float, None, unit="deg", limits=(0.0, 1.0),
        help="Of the rotary axes: a floor or wall that is off by less is square to the axis or along it, and "
        "orientations that are nearer are one.  [default: the machine's own, else 0.05]",
    ),
    Option(
        "posture_maps", bool, False,
        help="Also write every sample's free tilt intervals at every rotation (postures.npz), for the cutter shown.",
    ),
    Option(
        "map_budget", int, None, limits=(1, math.inf, "must be at least 1 sample"),
        help="Samples to map, at most, evenly spread; the others are undecided there.  [default: as many as some minutes allow]",
    ),
)  # fmt: skip

_OUTPUT = (
    Option(
        "units", str, None, choices=("mm", "in"), brief="Unit of lengths in the summary and on the page.",
        help="Unit of lengths in the summary and on the page; files have mm.  [default: mm; in where all cutters are in inches]",
    ),
)  # fmt: skip

_ANSWERS = (
    Option(
        "answers", str, "", brief="More questions to answer, or all.",
        takes=f"{_ANSWER} | Sequence[{_ANSWER}]", keeps=f"tuple[{_ANSWER}, ...]",
        help=f"More questions to answer: {', '.join(f'{kind.word} ({kind.meaning})' for kind in KINDS)}, or all.",
    ),
    Option(
        "length_over_radius", float, 10.0, limits=(1.0, 1000.0, "must lie between 1 and 1000"),
        help="Length of the ends of --answers radius, in radii.",
    ),
)  # fmt: skip

#: All numbers of this group count in a plan of operations alone.
_OPERATIONS = (
    Option(
        "operations", str, None, choices=("fewest", "fastest", "both"),
        brief="Plan steps with fixed orientations (3, 3+1, 3+2).",
        help="Plan operations with fixed orientations (3, 3+1 or 3+2 axes) that finish together all that is reached: the fewest, "
        "with a proof that there are no fewer, the fastest, or both. Only finishing is planned.",
    ),
    Option(
        "feed", float, None, unit="mm/min", limits=(0.1, 1e6), brief="Feed of all cutters.",
        help="Feed of all cutters.  [default: the libraries' finishing presets; without them cut lengths are reported, and no "
        "times]",
    ),
    Option("scallop", float, 0.01, "Height of the cusps between passes.", unit="mm", limits=(1e-5, 10.0)),
    Option(
        "stepover", float, 0.75, "Widest distance of passes, in diameters.", unit="diameters", metavar="N", limits=(0.01, 1.0)
    ),
    Option(
        "index_step", float, None, unit="deg", limits=(0.5, 90.0),
        help="Rotary axes lock at whole multiples of this angle alone.  [default: they lock anywhere]",
    ),
    Option(
        "index_time", float, None, unit="s", limits=(0.0, 1e5),
        help="Seconds that another orientation takes.  [default: by the rates of the machine's rotary axes, else 5]",
    ),
    Option("change_time", float, 20.0, "Seconds that another cutter takes.", unit="s", limits=(0.0, 1e5)),
    Option("setup_time", float, 300.0, "Seconds that another setup takes.", unit="s", limits=(0.0, 1e6)),
    Option(
        "removal_rate", float, None, unit="cm3/min", limits=_POSITIVE,
        help="Of roughing, for its minutes.  [default: the volume alone]",
    ),
    Option("overlap", float, 2.0, "Overlap of operations at a common border.", unit="mm", limits=(0.0, 1e3)),
    Option("link_time", float, 1.0, "Seconds from the end of a pass to the next.", unit="s", limits=(0.0, 1e4)),
    Option(
        "border_cost", float, 0.05, unit="s/mm", metavar="S", limits=(0.0, 1e3),
        help="Seconds that a mm of border between operations on a free-form face counts in comparisons.",
    ),
    Option(
        "most_operations", int, None, "Fixed orientations, at most; simultaneous motion finishes the rest.", limits=_AT_LEAST_1
    ),
    Option(
        "max_orientations", int, 8, limits=_AT_LEAST_1,
        help="Where the fastest plan has more fixed orientations, simultaneous motion is recommended for the rest.",
    ),
    Option(
        "process", str, None, brief="Your own steps: an edited process.toml.",
        takes="OwnProcess | Mapping[str, Any] | str | os.PathLike[str] | None", keeps="OwnProcess | None",
        help="Your own steps, a process.toml as it is written with a plan, edited: they are judged as they stand, in their "
        "order, and the rest is planned behind them.",
    ),
)  # fmt: skip

_RUN = (
    Option("patterns", bool, True, "Judge and plan each face by itself, also where faces are equal.", typed="no_patterns"),
    Option(
        "jobs", int, None, "Threads.  [default: all cores]", brief=True,
        takes="int | None", keeps="int",
        limits=(1, _MOST_JOBS, f"must be at least 1 and at most {_MOST_JOBS}"),
    ),
)  # fmt: skip

#: By the heading of help, in its order.
GROUPS = {
    "Cutters": _CUTTERS, "Machine and setup": _MACHINE, "Faces": _FACES, "Sampling and tolerances": _SAMPLES,
    "Postures": _POSTURES, "Output": _OUTPUT, "Answers": _ANSWERS, "Plan of operations": _OPERATIONS, "Run": _RUN,
}  # fmt: skip
#: By its word.
OPTIONS = {each.word: each for group in GROUPS.values() for each in group}
#: With those that no command has: setup files and the setup `auto` make them of its words.
ATTRIBUTES = {
    **OPTIONS,
    "other_setups": Option("other_setups", str, (), "", takes="Sequence[Setup]", keeps="tuple[tuple[float, float, float], ...]"),
    "placement": Option("placement", str, None, "", keeps="Placement | None"),
    "other_placements": Option(
        "other_placements", str, (), "", takes="Sequence[Placement | None]", keeps="tuple[Placement | None, ...]"
    ),
    "propose": Option("propose", bool, False, ""),
}
#: The type of each as callers give it; angles in degrees, too.
TAKES = {word: each.types[0] for word, each in ATTRIBUTES.items()}
TAKES |= {f"{word}_deg": f"{TAKES[word].removesuffix(' | None')} | None" for word, each in ATTRIBUTES.items() if each.is_angle}
#: Those of a scene, which a posture map takes, too.
OF_A_SCENE = ("setup", "flip", "ignore", "fixtures", "tolerance")
#: Options that count in a plan of operations alone: without one they must not be ignored.
OF_OPERATIONS = tuple(each.word for each in _OPERATIONS if each.kind is not str)
