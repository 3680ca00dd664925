"""The question of the checker, as the options of a command and the files of a plan put it."""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io import Part
from cad_io.part.bodies import orient
from cad_io.part.patterns import repeated_faces
from plan_cutters.document.plan import as_requested
from plan_cutters.domain.clamping import Block, Chuck, Vise
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.operations import INDEX_TIME
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import REASONS, effective_tolerance
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.options import Options
from plan_cutters.plan_file.effective import Effective
from plan_cutters.plan_file.load import plan_of
from plan_cutters.plan_file.reasons import REASONS as WORDS
from plan_cutters.plan_file.words.text import with_text
from plan_cutters.scene.faces import choose, clamped_faces, ignored_faces, ignored_words
from plan_cutters_check.findings import same, short
from plan_cutters_check.question import (
    FREE,
    Body,
    DrillSizes,
    Grip,
    MachineAxes,
    Question,
    Section,
    Setup,
    ToolSizes,
    require_operations,
)

#: How far the chords of a chuck's jaws may be from their bore, mm.
_BORE = 1e-3


def question_of(
    part: Part, options: Options, document: Mapping[str, Any], arrays: Mapping[str, Mapping[str, NDArray[Any]]]
) -> Question:
    """The form that the checker takes, with what plan.json must say by the command, and by the program's words for its numbers.

    Raises OptionError: a plan of another part, of other options, or without operations.
    """
    require_operations(document)
    cutters, (setups, grips) = {cutter.id: cutter for cutter in options.judged}, _setups(part, options, document)
    tolerance = _fits(part, options, document, [*cutters], setups)
    ignored = ignored_faces(part, ignored_words(part, options.ignore))
    obstacles = ignored | repeated_faces(part, ignored).keys()
    stated = {
        "format": "plan-cutters-plan",
        "units": {"length": "mm", "angle": "deg"},
        "reasons": list(REASONS),
        "reason_words": {code: WORDS[code].name for code in REASONS},
        "machine": {"name": options.machine.name, "notes": list(options.machine.notes)},
        "cutters": [
            {"name": cutter.name, "holder": cutter.holder.name if cutter.holder else ""}
            for cutter in (cutters[each["id"]] for each in document["cutters"])
        ],
        "effective": _effective(part, options, document["effective"], obstacles),
    }
    try:
        stated |= _worded(document)
        odd = ""
    except (PlanError, LookupError, ArithmeticError, ValueError, StopIteration) as error:
        # Not every error has words.
        odd = getattr(error, "cause", None) or f"its words cannot be made ({type(error).__name__}: {error})"
    return Question(
        part, machine_axes(options.machine), {name: sizes_of(cutter) for name, cutter in cutters.items()}, setups, obstacles,
        orient(part, options.setup, options.flip).sign, tolerance, document, arrays["operations.npz"], arrays["samples.npz"],
        asked=options.tolerance, grips=grips, stated=stated, odd=odd, drills=_drills(options),
    )  # fmt: skip


def _worded(document: Mapping[str, Any]) -> dict[str, Any]:
    """The words of a plan, made anew of its numbers."""
    made = with_text(plan_of(json.dumps(document), "plan.json")).model_dump(mode="json")
    process = made["process"]
    own = [{} if each["own"] is None else {"own": {"text": each["own"]["text"]}} for each in process["steps"]]
    needs = [{"needs": each["needs"]} for each in process["left"]]
    words = {"next": process["next"], "doubts": process["doubts"], "left": needs, "steps": own}
    return {"text": made["text"], "process": words}


#: Options that are compared in another way, or that follow from the part; those that a command may leave out all the same.
_OTHER = ("cutters", "cutter_source", "fixtures", "setup", "placement", "other_setups", "other_placements", "ignore", "process",
          "spacing_mm", "sampled_by", "tolerance_mm", "local_tolerance", "chord_error_mm", "chord_measured_share",
          "obstacle_triangles", "area_budget", "tilt_deg", "rotation_deg", "rotation_step_deg", "propose",
          "target_faces")  # fmt: skip
_SAFETY = ("tolerance_requested_mm", "axis_accuracy_deg")
_UNFIT = "the plan of operations does not fit:"


def _effective(part: Part, options: Options, written: Mapping[str, Any], obstacles: frozenset[int]) -> dict[str, Any]:
    """The options in force as far as the command says them: one that it leaves out, and the plan does not, is not checked."""

    def every(those: Options) -> dict[str, Any]:
        made = {
            "units": those.reported_unit, "holder": None if those.holder is None else those.holder.id,
            "machine": those.machine.name, "faces": those.faces, "tolerance_requested_mm": those.tolerance,
            "axis_accuracy_deg": math.degrees(those.accuracy),
            "index_time_s": INDEX_TIME if those.index_time is None else those.index_time,
            "rotary_rates_deg_s": those.machine.rates_deg,
        }  # fmt: skip
        names = [name for name in Effective.model_fields if name not in _OTHER]
        return json.loads(json.dumps({n: made[n] if n in made else as_requested(those, n) for n in names}, default=str))

    usual, stated = every(Options()), dict[str, Any]()
    for name, value in every(options).items():
        if same(value, written.get(name)):
            stated[name] = written.get(name)
        elif name in _SAFETY and written.get(name) is None:
            continue
        elif name in _SAFETY or not same(value, usual[name]):
            raise OptionError(f"{_UNFIT} {name}: {short(written.get(name))} in the plan, {short(value)} here")
    ignore = ignored_words(part, options.ignore)
    targets = choose(part, written["faces"], obstacles, ignore).targets
    # These were compared already, for the plan fits.
    fits = ("cutters", "setup", "other_setups", "tilt_deg", "rotation_deg", "tolerance_mm")
    stated |= {name: written[name] for name in fits}
    return stated | {"target_faces": [f"F{n}" for n in targets], "ignore": list(ignore)}


def _places(options: Options) -> tuple[Placement | None, ...]:
    return options.placement, *(options.other_placements or (None,) * len(options.other_setups))


def _where(fixture: Fixture, setup: int, document: Mapping[str, Any]) -> tuple[Fixture, tuple[str, ...]]:
    """A vise or chuck that was placed for a setup, where the plan says that it stands, and which faces it says to be gripped."""
    for entry in document["fixtures"]:
        if entry["name"] == f"fixture:{fixture.name}" and setup in entry.get("setups", [0]) and entry.get("clamping"):
            return replace(Fixture.parse(entry["clamping"]), name=fixture.name), tuple(entry.get("grips", []))
    raise OptionError(f"{_UNFIT} it does not say where {fixture} stands; plan again")


def _grip(wanted: Fixture, placed: Fixture, faces: tuple[str, ...], setup: int) -> Grip:
    """A vise or chuck as it was placed, to see whether it holds the part; an OptionError where another one was requested."""
    clamping, sizes = placed.clamping, wanted.grips
    same = placed.kind == wanted.kind and clamping is not None and not placed.to_place
    if not same or clamping is None or (sizes and sizes.sizes and clamping.numbers[: len(sizes.sizes)] != sizes.sizes):
        raise OptionError(f"{_UNFIT} {placed} stands where {wanted} was requested; plan again")
    jaws, width = (2, clamping.width) if isinstance(clamping, Vise) else (0, 0.0)
    if isinstance(clamping, Chuck):
        jaws, width = clamping.jaws, clamping.half_angle
    body, below = replace(bodies_of(placed)[0], placement=placed.placement), clamping.height - clamping.grip
    return Grip(setup, placed.name, body, jaws, width, clamping.grip, below, clamping.numbers[-1], clamping.ledge, faces)


def _setups(part: Part, options: Options, document: Mapping[str, Any]) -> tuple[tuple[Setup, ...], tuple[Grip, ...]]:
    """The setups, and the vises and chucks in them of which the plan alone says where they stand."""
    setups, grips = [], list[Grip]()
    for s, (axis, place) in enumerate(zip((options.setup, *options.other_setups), _places(options), strict=True)):
        x, origin, own = (None, None, ()) if place is None else (place.x, place.origin, place.fixtures)
        along = z = (float(axis[0]), float(axis[1]), float(axis[2]))
        bodies, stock = list[Body](), s == 0 and any(each.stock for each in options.fixtures)
        for wanted in options.fixtures if s == 0 else (*options.shared_fixtures, *own):
            placed, faces = _where(wanted, s, document) if wanted.to_place else (wanted, ())
            bodies += bodies_of(placed)
            along = along if placed.clamping is None else placed.stands_along(z)
            # Jaws below the part, on its stock, are not for its faces.
            grips += [_grip(wanted, placed, faces, s)] if wanted.to_place and not stock else []
        fixtures = tuple(replace(each, up=along) if each.kind == "stock" else each for each in bodies)
        setups.append(Setup(z, x, origin, fixtures, clamped_faces(part, place)))
    return tuple(setups), tuple(grips)


def machine_axes(machine: Machine) -> MachineAxes:
    """The rotary axes; a machine that names none is set by the azimuth about the setup axis and the tilt from it."""
    turning, free = machine.rotary, (-math.inf, math.inf)
    about, limits = [axis.direction for axis in turning], [axis.limits or free for axis in turning]
    if not machine.turns:
        about, limits = [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0)], [free, free]
    return MachineAxes(
        tuple(axis.name for axis in turning) if machine.turns else FREE,
        np.array(about, float).reshape(-1, 3),
        np.array(limits, float).reshape(-1, 2),
        np.array(machine.tool_axis, float),
        math.pi if machine.tilt_limit is None else machine.tilt_limit,
        machine.turns and all(axis.rate is not None for axis in turning),
    )


def bodies_of(fixture: Fixture) -> tuple[Body, ...]:
    """A fixture as the checker takes it: a vise or chuck by each of its bodies."""
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
            place = (*fixture.placed(np.array([0.0, 0.0, solid.low])).tolist(), *fixture.placement[3:])
            bodies.append(Body(fixture.name, "cylinder", (solid.radius, solid.high - solid.low), None, None, place))
    return tuple(bodies)


def sizes_of(cutter: Cutter) -> ToolSizes:
    """Dimensions of a cutter as the checker takes them."""
    above = tuple(Section(part, low, each.length, each.radius, each.upper_radius) for part, low, each in cutter.stages)
    return ToolSizes(
        cutter.id, cutter.shape, cutter.radius, cutter.corner_radius, cutter.arc_radius, cutter.arc_height, cutter.outline,
        cutter.taper, above[0].low if above else cutter.length, above, cutter.allowance or 0.0, cutter.clearance or 0.0,
    )  # fmt: skip


def _drills(options: Options) -> dict[str, DrillSizes]:
    """The tools for holes of all libraries by their ids, each with the first feed that is stated for it."""
    drills = dict[str, DrillSizes]()
    for entry in (each for library in options.libraries for each in library.entries):
        if (drill := entry.drill) is not None:
            known = drills.get(drill.id)
            sizes = replace(sizes_of(drill.body.asked(0.0, options.holder_clearance, None)), id=drill.id)
            feed = entry.feed if known is None or known.feed is None else known.feed
            name = drill.body.name if known is None else known.name
            drills[drill.id] = DrillSizes(drill.kind, sizes, drill.point, feed, name, drill.pitch, drill.left)
    return drills


def _fits(part: Part, options: Options, document: Mapping[str, Any], cutters: list[str], setups: tuple[Setup, ...]) -> float:
    """Refuse a plan of another part or of other options; the tolerance that it keeps, mm."""
    effective = document["effective"]
    # A plan may keep a tolerance that is coarser than the one asked for, as its triangles allow.
    tolerance, wanted = float(effective["tolerance_mm"]), options.tolerance
    if tolerance > wanted and abs(tolerance - effective_tolerance(0.0, effective["chord_error_mm"])) <= 1e-9 * tolerance:
        wanted = tolerance
    axes = (effective["setup"], *effective["other_setups"])
    places = (effective["placement"], *(effective["other_placements"] or [None] * len(effective["other_setups"])))
    named = [[each["name"] for each in document["fixtures"] if s in each.get("setups", [0])] for s in range(len(setups))]
    pairs: list[tuple[str, Any, Any]] = [
        ("part", document["part"].get("sha256"), part.sha256),
        ("cutters (--cutter, --holder)", sorted(effective["cutters"]), sorted(cutters)),
        ("list of cutters", sorted(each["id"] for each in document["cutters"]), sorted(cutters)),
        ("machine (--machine)", effective["machine"], options.machine.name),
        ("setups (--setup)", _rounded(axes), _rounded(setup.z for setup in setups)),
        # Not their places: where a fixture stands shows in what it serves.
        ("fixtures (--fixture, --setup)", named, [[*dict.fromkeys(f"fixture:{b.name}" for b in one.fixtures)] for one in setups]),
        ("clamped faces (--setup)", [(place or {}).get("clamped", []) for place in places],
         [[] if place is None else list(place.clamped) for place in _places(options)]),
        ("tolerance (--tolerance)", tolerance, wanted),
    ]  # fmt: skip
    for name, angles in (("tilt", options.postures.tilt), ("rotation", options.postures.rotation)):
        degrees = [round(math.degrees(x), 6) for x in angles]
        pairs.append((f"{name}s (--{name})", [round(x, 6) for x in effective[f"{name}_deg"]], degrees))
    for what, was, now in pairs:
        if was != now:
            raise OptionError(f"{_UNFIT} {what}: {short(was)} in the plan, {short(now)} here")
    return tolerance


def _rounded(axes: Iterable[Iterable[float]]) -> list[float]:
    return [round(x, 9) for axis in axes for x in axis]
