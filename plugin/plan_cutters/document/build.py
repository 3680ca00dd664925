"""How results become the plan file: each entry of the model from the arrays behind it."""

import math
import platform
import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io import FaceInfo, Orientation, Part
from cad_io.arrays import SurfaceSamples
from cad_io.kernel.shapes import component_of
from cad_io.read.mesh import Mesh
from plan_cutters import __version__
from plan_cutters.domain.answers import weights
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import listed
from plan_cutters.domain.preference import group_of
from plan_cutters.domain.shapes import flute_length, modes
from plan_cutters.domain.verdicts import ANOTHER_SETUP, DRILLED, INACCESSIBLE, REASONS, UNDECIDED, WORDS, Verdicts, Witness
from plan_cutters.plan_file import part_info as schema
from plan_cutters.plan_file.frozen import filled, posture, vector
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, MissingEntry, SegmentEntry, WitnessEntry
from plan_cutters.plan_file.shares import VERDICTS, AreaShare, FaceVerdicts
from plan_cutters.scene.covering import coverings, numbers, sheets
from plan_cutters.scene.faces import Chosen
from plan_cutters.scene.inside_material import voids
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.surroundings import PlacedFixture, Surroundings


def fixtures_in(ready: Prepared) -> list[tuple[PlacedFixture, list[int]]]:
    """Placed fixtures of all setups, those of the first one first, each with the setups in which it stands in the same place."""
    fixtures, known = list[tuple[PlacedFixture, list[int]]](), list[schema.FixtureEntry]()
    for number, conditions in enumerate(ready.setups):
        for fixture in conditions.surroundings.fixtures:
            mine = fixture_entry(fixture)
            if number and mine in known:
                fixtures[known.index(mine)][1].append(number)
            else:
                fixtures.append((fixture, [number]))
                known.append(mine)
    return fixtures


def fixture_entry(placed: PlacedFixture, setups: Sequence[int] = (0,)) -> schema.FixtureEntry:
    """A fixture where it stands, in some setups."""
    fixture, source, triangles, hold = placed.fixture, placed.source, placed.obstacles.triangles, placed.hold
    return filled(
        schema.FixtureEntry, placed, file=None if source is None or source.file is None else Path(source.file).name,
        sha256=None if source is None else source.sha256,
        unit=source.unit if isinstance(source, Mesh) else fixture.unit, placement=fixture.placement, triangles=len(triangles),
        chord_error_mm=triangles.chord_error, watertight=placed.body is not None, setups=list(setups),
        clamping=fixture.text if fixture.clamping is not None else None, unheld=[f"F{number}" for number in placed.unheld],
        grips=[f"F{number}" for number in hold.grips] if hold else [], hidden_mm2=hold.hidden if hold else None,
    )  # fmt: skip


def counts(
    verdict: NDArray[np.uint8], inside: NDArray[np.bool_] | None = None, exempt: NDArray[np.bool_] | None = None
) -> dict[str, Any]:
    """How many samples have each verdict; `inside`, `exempt` (n,): those inside other bodies of the part, and not required."""
    others = {"inside_bodies": inside, "exempt": exempt}
    return {
        **{name: int((verdict == code).sum()) for code, name in WORDS.items()},
        **{name: 0 if rows is None else int(rows.sum()) for name, rows in others.items()},
    }


def face_verdicts(
    samples: SurfaceSamples, reach: Verdicts, inside: NDArray[np.bool_] | None = None, exempt: NDArray[np.bool_] | None = None
) -> dict[str, FaceVerdicts]:
    """Sum up the verdicts on each face that has samples, by its id; `inside` and `exempt` as in `counts`."""
    nowhere = np.zeros(len(samples.face), bool)
    inside, exempt = nowhere if inside is None else inside, nowhere if exempt is None else exempt
    entries = {}
    for number, mine in samples.by_face().items():
        area = weights(samples.area[mine])
        within, free, drills = inside[mine], exempt[mine], reach.verdict[mine] == DRILLED
        required = ~within & ~free & ~drills
        seen = mine[required]
        share = _share(reach.verdict[seen], reach.reason[seen], area[required])
        part = min(1.0, float(area[within].sum() / area.sum())) if not within.all() else 1.0
        # What is asked of no mill is all that is left where nothing is asked.
        bored = min(1.0 - part, float(area[drills].sum() / area.sum()))
        bored = bored if (~within & ~drills).any() or not drills.any() else 1.0 - part
        edges = min(1.0 - part - bored, float(area[free].sum() / area.sum())) if len(seen) else 1.0 - part - bored
        entries[f"F{number}"] = FaceVerdicts(
            **counts(reach.verdict[mine], within, free), area_share=share, inside_share=part, exempt_share=edges,
            drilled_share=bored,
        )  # fmt: skip
    return entries


def whole_share(faces: Mapping[str, FaceVerdicts], samples: SurfaceSamples, part: Part) -> AreaShare:
    """Give the shares of the verdicts in the finished part's surface of all target faces.

    Faces without samples are not judged; those of unknown area do not count. Where the area of none is known, every face counts
    as one.
    """
    targets = [
        (n, each.area_share, 1.0 - each.inside_share - each.exempt_share - each.drilled_share) for n, each in faces.items()
    ]
    targets += [(f"F{number}", AreaShare(unjudged=1.0), 1.0) for number, _ in samples.empty]
    areas = _areas([name for name, _, _ in targets], part)
    seen = np.array([areas[name] * finished for name, _, finished in targets])
    weights = (seen / max(1e-300, seen.sum())).tolist()
    parts = [(weight, share) for weight, (_, share, _) in zip(weights, targets, strict=True)]
    sums = {word: min(1.0, sum(weight * getattr(share, word) for weight, share in parts)) for word in VERDICTS}
    sums_by = {reason: min(1.0, sum(weight * share.lost_by.get(reason, 0.0) for weight, share in parts)) for reason in REASONS}
    return AreaShare(**sums, lost_by={reason: share for reason, share in sums_by.items() if share})


def sample_areas(faces: Mapping[str, FaceVerdicts], samples: SurfaceSamples, part: Part) -> tuple[NDArray[np.float64], float]:
    """Give the area that each sample (n,) stands for, and that of faces without samples, mm2, weighed as in `whole_share`."""
    areas = _areas([*faces, *(f"F{number}" for number, _ in samples.empty)], part)
    result = np.zeros(len(samples))
    for number, mine in samples.by_face().items():
        weight = weights(samples.area[mine])
        result[mine] = areas[f"F{number}"] * weight / weight.sum()
    return result, float(sum(areas[f"F{number}"] for number, _ in samples.empty))


def _areas(names: Sequence[str], part: Part) -> dict[str, float]:
    """Areas of faces by their ids, mm2; 1 each where none is known."""
    areas = weights(np.array([part.faces[int(name[1:]) - 1].area for name in names]))
    return dict(zip(names, areas.tolist(), strict=True))


def _share(verdict: NDArray[np.uint8], reason: NDArray[np.uint8], area: NDArray[np.float64]) -> AreaShare:
    if not len(area):
        return AreaShare()
    area = weights(area)
    area = area / area.sum()
    shares = {name: min(1.0, float(area[verdict == code].sum())) for code, name in WORDS.items() if name in VERDICTS}
    not_reached = (verdict == INACCESSIBLE) | (verdict == UNDECIDED)
    by = {
        name: min(1.0, float(area[not_reached & (reason == i)].sum()))
        for i, name in enumerate(REASONS)
        if (reason[not_reached] == i).any()
    }
    return AreaShare(**shares, lost_by=by)


def inside_entry(ready: Prepared, faces: Mapping[str, FaceVerdicts]) -> schema.InsideEntry:
    """Sum up the surface that lies inside other bodies, body by body; `faces`: the verdicts of any one cutter."""
    inside, samples, scene = ready.inside_bodies, ready.samples, ready.scene
    if not inside.any():
        return schema.InsideEntry()
    areas = _areas([*faces, *(f"F{number}" for number, _ in samples.empty)], scene.part)
    area = float(sum(areas[name] * each.inside_share for name, each in faces.items()))
    within, lying = float(samples.area[inside].sum()), sheets(ready)
    certain = ready.conditions.surroundings.certain.triangles
    # All that bodies over samples follow from.
    follows_from = (
        scene.part.key, scene.ignored, certain.vertex, certain.chord_error, ready.conditions.tolerance,
        (ready.inside, inside, samples.point, samples.face, samples.area),
    )  # fmt: skip

    def some(rows: NDArray[np.int64]) -> dict[str, Any]:
        """Faces of some samples, and the area that they stand for, so that all of it comes to that of the faces."""
        mine = area * float(samples.area[rows].sum()) / within if within > 0.0 else 0.0
        return {"faces": [f"F{n}" for n in np.unique(samples.face[rows]).tolist()], "samples": len(rows), "area_mm2": mine}

    bodies = [
        filled(schema.CoveringBody, each, number=1 + each.index, own_faces=numbers(each.faces).split(","),
               option=f"--ignore {shlex.quote(each.selection)}", **some(each.rows))
        for each in ready.cache.cached("coverings", follows_from, lambda: coverings(ready))
    ]  # fmt: skip
    option = f"--ignore {numbers(ready.conditions.surroundings.on_bodies)}"
    return schema.InsideEntry(
        samples=int(inside.sum()), area_mm2=area, share=min(1.0, area / max(1e-300, sum(areas.values()))), bodies=bodies,
        sheets=schema.SheetsEntry(**some(lying), option=option) if len(lying) else None,
    )  # fmt: skip


def void_faces(ready: Prepared) -> list[str]:
    """Ids of the faces whose samples inside material all lie in a closed void: no body that could be absent is around them."""
    bodies = ready.conditions.surroundings.bodies
    hollow, within = np.array([*voids(bodies, ready.scene.orientation), False]), ready.inside >= 0
    in_void = within & hollow[np.minimum(ready.inside, len(bodies))]
    shut, others = np.unique(ready.samples.face[in_void]), np.unique(ready.samples.face[within & ~in_void])
    return [f"F{number}" for number in np.setdiff1d(shut, others).tolist()]


#: Decimals of carriers: behind them there is noise alone.
_DIGITS = 9


def missing_entries(part: Part, surroundings: Surroundings) -> list[MissingEntry]:
    """Faces that are in the way only as a guess, or of which nothing is known but that the file has them."""
    rows: list[tuple[Any, ...]] = [
        *((f"F{number}", None, part.faces[number - 1].name, why, how) for number, why, how in surroundings.missing),
        *((None, e.entity or None, e.name, e.why, "none" if e.box is None else "box") for e in surroundings.lost),
        *((None, None, f"{e.name} {face}".strip(), why, how) for e in surroundings.fixtures for face, why, how in e.missing),
    ]
    return [MissingEntry(**dict(zip(("face", "entity", "name", "why", "stand_in"), row, strict=True))) for row in rows]


def degrees(pair: tuple[float, float]) -> tuple[float, float]:
    """A range of radians in degrees."""
    # Rounded to what a person typed: 90, not 90.00000000000001.
    low, high = (round(float(np.degrees(end)), 9) for end in pair)
    return low, high


def cutter_entry(
    cutter: Cutter, samples: SurfaceSamples, reach: Verdicts, witnesses: Sequence[Witness], march_differs: int, seconds: float,
    *, part: Part, surroundings: Surroundings, slack: float, inside: NDArray[np.bool_], besides: NDArray[np.uint8],
    exempt: NDArray[np.bool_] | None = None,
) -> CutterEntry:  # fmt: skip
    """Make the plan's entry of a cutter: its verdicts in the `surroundings`, and the reasons; `slack` as in `Assembly`.

    `inside`, `exempt` (n,): samples inside other bodies of the part, and at sharp inside edges that are not required.
    `besides` (n,): the reasons that take part in the axis limit.
    """
    mine = counts(reach.verdict, inside, exempt)
    blocked = mine["inaccessible"] - mine["inside_bodies"] - mine["exempt"]
    not_reached, unsure = reach.verdict == INACCESSIBLE, reach.verdict == UNDECIDED
    another = int((not_reached & (reach.reason == ANOTHER_SETUP)).sum())
    # What is missing from the obstacles can only be in the way of more. A proposed table decides nothing of what stands on it.
    open_ = bool(mine["undecided"] or surroundings.doubtful or another)
    feasible = False if blocked > another else None if open_ else True
    faces = face_verdicts(samples, reach, inside, exempt)

    def by_reason(rows: NDArray[np.bool_], reason: NDArray[np.uint8]) -> dict[str, int]:
        return {name: int((rows & (reason == code)).sum()) for code, name in enumerate(REASONS)}

    return filled(
        CutterEntry, cutter, taper_deg=float(np.degrees(cutter.taper)), group=group_of(cutter), flutes_mm=flute_length(cutter),
        holder=cutter.holder.name if cutter.holder else "", slack_mm=slack, feasible=feasible, march_differs=march_differs,
        stages=[filled(SegmentEntry, stage, part=part, low_mm=low) for part, low, stage in cutter.stages],
        touches_deg=[degrees((mode.low, mode.high)) for mode in modes(cutter)], seen=samples.max_gap <= cutter.radius,
        allowance_mm=cutter.allowance or 0.0, clearance_mm=cutter.clearance or 0.0, **mine,
        by_reason=by_reason(not_reached, reach.reason), undecided_by_reason=by_reason(unsure, reach.reason),
        axis_limit_with={name: n for name, n in by_reason(besides < len(REASONS), besides).items() if n},
        faces=faces, area_share=whole_share(faces, samples, part), seconds=seconds,
        witnesses=[_witness_entry(w, samples, surroundings, reach, inside) for w in witnesses],
        witnesses_untried=sum(w.untried for w in witnesses),
    )  # fmt: skip


def _witness_entry(
    witness: Witness, samples: SurfaceSamples, surroundings: Surroundings, reach: Verdicts, inside: NDArray[np.bool_]
) -> WitnessEntry:
    best, row = None, witness.sample
    if witness.tilt is not None and witness.rotation is not None and witness.axis is not None:
        best = posture(witness.tilt, witness.rotation, witness.axis)
    return filled(
        WitnessEntry, witness, point=vector(samples.point[row]), face=f"F{samples.face[row]}", best_posture=best,
        verdict="undecided" if reach.verdict[row] == UNDECIDED else "inaccessible", inside_bodies=bool(inside[row]),
        obstacle_face=None if not witness.obstacle_face else surroundings.called(witness.obstacle_face),
        obstacle_point=None if witness.obstacle_point is None else vector(witness.obstacle_point),
    )  # fmt: skip


def part_info(scene: Scene, surroundings: Surroundings, void_faces: list[str]) -> schema.PartInfo:
    """The part, and what is odd about it."""
    part, orientation, sewn = scene.part, scene.orientation, scene.part.sewn
    warnings = list(part.warnings)
    # Without the faces that are left out on purpose there are openings, too.
    for body in () if set(scene.ignored) - scene.repeated.keys() else (body for body in surroundings.bodies if not body.closed):
        warnings.append(
            f"{listed([f'F{number}' for number in body.faces])} enclose a body with openings: what lies within it is "
            "not known for sure; a face or an edge may be missing"
        )
    on_shell = (
        f"{listed([f'F{number}' for number in surroundings.on_bodies])} lie on faces of solids, as construction geometry does, "
        "and are judged and in the way like all others: `--ignore` leaves them out"
        if surroundings.on_bodies
        else ""
    )
    warnings += [on_shell] if on_shell else []
    # Faces of no closed body that are neither ignored nor set aside. Those of a broken solid are not loose: they are its skin.
    closed = {number for body in surroundings.bodies if body.closed for number in body.faces}
    excluded = {face.number for face in part.faces if face.unjudged} | set(scene.ignored)
    opened = [f.id for f in part.faces if f.number not in closed | excluded]
    of_solids = [name for n in orientation.guessed if n not in excluded and (name := f"F{n}") not in opened]
    return filled(
        schema.PartInfo, part, file=Path(part.file).name if part.file else None,
        faces=len(part.faces), orientation=filled(schema.OrientationInfo, orientation),
        sewing=filled(schema.SewingInfo, sewn) if sewn.faces else None, warnings=warnings,
        loose_faces=[name for name in opened if int(name[1:]) in sewn.faces] if part.solids else [],
        guessed_faces=[] if orientation.confident else [*opened, *of_solids], sheets_doubt=on_shell, void_faces=void_faces,
        unit_readings=[filled(schema.UnitEntry, each) for each in part.unit_readings],
    )  # fmt: skip


def face_entries(
    part: Part, samples: SurfaceSamples, choice: Chosen, errors: Mapping[int, float], orientation: Orientation
) -> list[FaceEntry]:
    """Every face of the part, judged or not; `errors`: how far triangles may be from each, mm."""
    empty, gaps = dict(samples.empty), dict(samples.face_gaps)
    chosen, ignored = set(choice.targets), set(choice.ignored)
    component, rows = component_of(part.tree), samples.by_face()
    result = []
    for face in part.faces:
        mine = rows.get(face.number, np.zeros(0, np.int64))
        bad = samples.unjudged[mine]
        bad = bad[bad >= 0]
        reason = face.unjudged or empty.get(face.number)
        again = choice.repeated.get(face.number)
        if reason is None and len(bad):
            reason = f"{len(bad)} samples: " + "; ".join(samples.reasons[i] for i in np.unique(bad))
        result.append(filled(
            FaceEntry, face, kind="blend" if face.number in choice.blends else face.shape, target=face.number in chosen,
            ignored=face.number in ignored, centre_mm=part.centre(face.number), carrier=carrier_entry(face, orientation),
            neighbours=[f"F{number}" for number in part.neighbours[face.number - 1]], component=component[face.number],
            samples=len(mine), gap_mm=gaps.get(face.number), chord_error_mm=errors.get(face.number),
            unjudged=f"is F{again} again" if again else reason if face.number in chosen else face.unjudged,
        ))  # fmt: skip
    return result


def carrier_entry(face: FaceInfo, orientation: Orientation) -> schema.CarrierEntry | None:
    """Describe what a face is a part of; the side of the material only where it is sure."""
    carrier = face.carrier
    if carrier is None:
        return None
    side = carrier.side * orientation.sign[face.number - 1] if orientation.confident else 0
    angle = None if carrier.half_angle is None else math.degrees(carrier.half_angle)
    lengths = {"radius_mm": carrier.radius, "minor_radius_mm": carrier.minor_radius, "half_angle_deg": angle}
    point, direction = (each and vector(np.round(each, _DIGITS) + 0.0) for each in (carrier.point, carrier.direction))
    fields = {name: value and round(value, _DIGITS) for name, value in lengths.items()}
    return filled(
        schema.CarrierEntry, carrier, point_mm=point, direction=direction, outward=bool(side > 0) if side else None, **fields
    )


@cache
def versions() -> dict[str, str]:
    """Versions of what the plan was made with."""
    from importlib.metadata import version

    names = {"cadquery-ocp-proxy": "occt", "numba": "numba", "numpy": "numpy", "scipy": "scipy", "trimesh": "trimesh"}
    made = {label: version(name) for name, label in names.items()}
    return {"plan_cutters": __version__, **made, "python": platform.python_version()}


def scope_of(faces: Sequence[FaceEntry]) -> schema.Scope:
    """Say which of all faces were judged and which were not, with their areas, mm2."""
    fields = dict[str, Any]()
    others = [f for f in faces if not f.target and not f.ignored]
    for name, each in (("judged", [f for f in faces if f.target]), ("not_judged", others)):
        fields |= {name: len(each), f"{name}_mm2": math.fsum(f.area_mm2 for f in each if math.isfinite(f.area_mm2)),
                   f"{name}_by_kind": dict(sorted(Counter(f.kind for f in each).items()))}  # fmt: skip
    return schema.Scope(**fields)
