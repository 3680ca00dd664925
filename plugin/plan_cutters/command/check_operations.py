"""`--check-operations`: a written plan of operations against the part; nothing is written."""

import hashlib
import json
import math
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plan_cutters.command import terminal
from plan_cutters.command.progress import Display, Teller
from plan_cutters.workers.assignment import is_child

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from cad_io import Part
    from plan_cutters.checker.question import Body, MachineAxes, Question, Setup, ToolSizes
    from plan_cutters.domain.cutter import Cutter
    from plan_cutters.domain.fixture import Fixture
    from plan_cutters.domain.machine import Machine
    from plan_cutters.domain.placement import Placement
    from plan_cutters.options import Options

#: Files that must stand with plan.json, and what they hold.
_FILES = {"operations.npz": "operations of a plan", "samples.npz": "samples of a plan"}
#: How far the chords of a chuck's jaws may be from their bore, mm.
_BORE = 1e-3


def checked(part: str, file: str, options: "Options", *, quiet: bool, read_timeout: float) -> int:
    """Check the operations of a plan.json; 0: all that was checked holds, 1: not all.

    Raises
    ------
    OptionError
        The file is no plan with operations, or one of another part or of other options.
    """
    from cad_io import read_part
    from plan_cutters.checker.check import check
    from plan_cutters.errors import OptionError

    document, arrays, checksums = _read(file)
    display = None if is_child() else Display(quiet, 0, time.monotonic(), itself=True)
    progress = Teller(display)
    progress("check", 0, 1)
    try:
        read = read_part(part, unit=options.unit, timeout=read_timeout)
        question = question_of(read, options, document, arrays)
        question = replace(question, checksums=checksums, asked=options.tolerance)
        answer = check(question, tell=progress.detail)
    except OptionError as error:
        raise OptionError(error.cause, file=file) from None
    except (KeyError, TypeError, ValueError, IndexError, OverflowError, AttributeError) as error:
        raise OptionError(f"the plan of operations cannot be understood ({type(error).__name__}: {error})", file=file) from None
    finally:
        if display is not None:
            display.clear()
    if not quiet:
        terminal.show(*answer.lines)
    return 0 if answer.holds else 1


def question_of(
    part: "Part", options: "Options", document: Mapping[str, Any], arrays: Mapping[str, Mapping[str, "NDArray[Any]"]]
) -> "Question":
    """Put the part, the options and the files of a plan into the form that the checker takes.

    Raises
    ------
    OptionError
        The plan is of another part or of other options, or has no operations.
    """
    from cad_io.part.orient import orient
    from cad_io.part.repeats import repeated_faces
    from plan_cutters.checker.question import Question
    from plan_cutters.errors import OptionError
    from plan_cutters.scene.faces import ignored_faces, ignored_words

    if not isinstance(document.get("operations"), dict):
        raise OptionError("the plan has no operations: make it with --operations")
    cutters, setups = {cutter.id: cutter for cutter in options.judged}, _setups(part, options, document)
    tolerance = _fits(part, options, document, [*cutters], setups)
    ignored = ignored_faces(part, ignored_words(part, options.ignore))
    sign = orient(part, options.setup, options.flip).sign
    return Question(
        part, _axes(options.machine), {name: _sizes(cutter) for name, cutter in cutters.items()}, setups,
        ignored | repeated_faces(part, ignored).keys(), sign, tolerance, document, arrays["operations.npz"],
        arrays["samples.npz"],
    )  # fmt: skip


def _places(options: "Options") -> "tuple[Placement | None, ...]":
    return options.placement, *(options.other_placements or (None,) * len(options.other_setups))


def _where(fixture: "Fixture", setup: int, document: Mapping[str, Any]) -> "Fixture":
    """A vise or chuck that was placed for a setup, where the plan says that it stands."""
    from plan_cutters.domain.fixture import Fixture
    from plan_cutters.errors import OptionError

    if not fixture.to_place:
        return fixture
    for entry in document["fixtures"]:
        if entry["name"] == f"fixture:{fixture.name}" and setup in entry.get("setups", [0]) and entry.get("clamping"):
            return replace(Fixture.parse(entry["clamping"]), name=fixture.name)
    raise OptionError(f"the plan of operations does not fit: it does not say where {fixture} stands; plan again")


def _setups(part: "Part", options: "Options", document: Mapping[str, Any]) -> "tuple[Setup, ...]":
    from plan_cutters.checker.question import Setup
    from plan_cutters.scene.faces import clamped_faces

    setups = []
    for s, (axis, place) in enumerate(zip((options.setup, *options.other_setups), _places(options), strict=True)):
        x, origin, own = (None, None, ()) if place is None else (place.x, place.origin, place.fixtures)
        fixtures = [_where(each, s, document) for each in (options.fixtures if s == 0 else (*options.shared_fixtures, *own))]
        z = (float(axis[0]), float(axis[1]), float(axis[2]))
        setups.append(Setup(z, x, origin, tuple(body for each in fixtures for body in _bodies(each)), clamped_faces(part, place)))
    return tuple(setups)


def _axes(machine: "Machine") -> "MachineAxes":
    """The rotary axes; a machine without them is set by the azimuth about the setup axis and the tilt from it."""
    import numpy as np

    from plan_cutters.checker.question import MachineAxes

    turning, free = machine.rotary, (-math.inf, math.inf)
    return MachineAxes(
        tuple(axis.name for axis in turning) or ("azimuth", "tilt"),
        np.array([axis.direction for axis in turning] or [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0)], float),
        np.array([axis.limits or free for axis in turning] or [free, free], float),
        np.array(machine.tool_axis, float),
        math.pi if machine.tilt_limit is None else machine.tilt_limit,
        bool(turning) and all(axis.rate is not None for axis in turning),
    )


def _bodies(fixture: "Fixture") -> "tuple[Body, ...]":
    """A fixture as the checker takes it: a vise or chuck by each of its bodies."""
    import numpy as np

    from plan_cutters.checker.question import Body
    from plan_cutters.domain.clamping import Block

    clamping = fixture.clamping
    if clamping is None:
        return (Body(fixture.name, fixture.kind, fixture.sizes, fixture.source, fixture.unit, fixture.placement),)
    bodies = []
    # Among chords so fine, the checker's own distance to a bore is that to the chords.
    for solid in clamping.solids(_BORE):
        if isinstance(solid, Block):
            sizes = (solid.low, solid.high, *(x for point in (*solid.inner, *solid.outer) for x in point))
            bodies.append(Body(fixture.name, "prism", sizes, None, None, fixture.placement))
        else:
            at = fixture.placed(np.array([0.0, 0.0, solid.low]))
            place = (*at.tolist(), *fixture.placement[3:])
            bodies.append(Body(fixture.name, "cylinder", (solid.radius, solid.high - solid.low), None, None, place))
    return tuple(bodies)


def _sizes(cutter: "Cutter") -> "ToolSizes":
    from plan_cutters.checker.question import Section, ToolSizes

    above = tuple(Section(part, low, each.length, each.radius, each.upper_radius) for part, low, each in cutter.stages)
    flutes = above[0].low if above else cutter.length
    return ToolSizes(
        cutter.id, cutter.shape, cutter.radius, cutter.corner_radius, cutter.arc_radius, cutter.arc_height, cutter.outline,
        cutter.taper, flutes, above, cutter.allowance or 0.0, cutter.clearance or 0.0,
    )  # fmt: skip


def _fits(
    part: "Part", options: "Options", document: Mapping[str, Any], cutters: list[str], setups: "tuple[Setup, ...]"
) -> float:
    """Refuse a plan of another part or of other options; the tolerance that it keeps, mm."""
    from plan_cutters.domain.tolerance import effective_tolerance
    from plan_cutters.errors import OptionError

    effective = document["effective"]
    # A plan may keep a tolerance that is coarser than the one asked for, as its triangles allow.
    tolerance, wanted = float(effective["tolerance_mm"]), options.tolerance
    if tolerance > wanted and abs(tolerance - effective_tolerance(0.0, effective["chord_error_mm"])) <= 1e-9 * tolerance:
        wanted = tolerance
    pairs = [
        *_of_part(part, document),
        ("cutters (--cutter, --holder)", sorted(effective["cutters"]), sorted(cutters)),
        ("list of cutters", sorted(each["id"] for each in document["cutters"]), sorted(cutters)),
        ("machine (--machine)", effective["machine"], options.machine.name),
        *_of_setups(options, document, setups),
        ("tolerance (--tolerance)", tolerance, wanted),
    ]
    for name, angles in (("tilt", options.postures.tilt), ("rotation", options.postures.rotation)):
        degrees = [round(math.degrees(x), 6) for x in angles]
        pairs.append((f"{name}s (--{name})", [round(x, 6) for x in effective[f"{name}_deg"]], degrees))
    for what, was, now in pairs:
        if was != now:
            raise OptionError(f"the plan of operations does not fit: {what}: {_short(was)} in the plan, {_short(now)} here")
    return tolerance


_Pair = tuple[str, Any, Any]


def _of_part(part: "Part", document: Mapping[str, Any]) -> list[_Pair]:
    files = [(each["file"], each["sha256"]) for each in document["part"].get("references", [])]
    return [
        ("part", document["part"].get("sha256"), part.sha256),
        ("files that the part refers to", files, list(part.references)),
    ]


def _of_setups(options: "Options", document: Mapping[str, Any], setups: "tuple[Setup, ...]") -> list[_Pair]:
    effective = document["effective"]
    places = (effective["placement"], *(effective["other_placements"] or [None] * len(effective["other_setups"])))
    named = [[each["name"] for each in document["fixtures"] if s in each.get("setups", [0])] for s in range(len(setups))]
    return [
        (
            "setups (--setup)",
            [round(x, 9) for axis in (effective["setup"], *effective["other_setups"]) for x in axis],
            [round(x, 9) for setup in setups for x in setup.z],
        ),
        # Not their places: where a fixture stands shows in what it serves.
        (
            "fixtures (--fixture, --setup)",
            named,
            [[*dict.fromkeys(f"fixture:{each.name}" for each in one.fixtures)] for one in setups],
        ),
        (
            "clamped faces (--setup)",
            [(place or {}).get("clamped", []) for place in places],
            [[] if place is None else list(place.clamped) for place in _places(options)],
        ),
    ]


def _short(value: Any) -> str:
    text = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _read(file: str) -> tuple[dict[str, Any], dict[str, dict[str, Any]], dict[str, tuple[str, str]]]:
    """plan.json, the arrays beside it, and of each of these files the SHA-256 that is stated and that it has."""
    from plan_cutters.errors import OptionError
    from plan_cutters.files.arrays import Archive

    try:
        document = json.loads(Path(file).read_text(encoding="utf-8"))
    except OSError as error:
        raise OptionError(f"cannot be read ({error.strerror or error})", file=file) from None
    except (ValueError, RecursionError) as error:
        raise OptionError(f"is no JSON ({error}): give the plan.json of a plan of operations", file=file) from None
    if not isinstance(document, dict) or document.get("format") != "plan-cutters-plan":
        raise OptionError("is no plan.json of plan-cutters", file=file)
    stated = {each["name"]: each["sha256"] for each in document.get("files", {}).values() if isinstance(each, dict)}
    arrays, checksums = {}, {}
    for name, noun in _FILES.items():
        path = Path(file).parent / name
        if not path.exists():
            raise OptionError(f"{name} must be in its folder: copy all files of the plan", file=file)
        with Archive(path, noun, OptionError) as archive:
            arrays[name] = {each: archive.read(each) for each in archive.headers}
        if name in stated:
            checksums[name] = stated[name], hashlib.sha256(path.read_bytes()).hexdigest()
    return document, arrays, checksums
