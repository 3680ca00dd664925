"""The annotated models: faces split along the boundaries of the verdicts, in STEP and GLB alike.

They show one cutter: the selected one or, where none is feasible, the one that leaves the least area.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceLabels, Style
from cad_io.kernel.shapes import Side, compound, prism, revolved
from cad_io.part import Part
from cad_io.split import split, split_by_turns
from cad_io.write import write_gltf
from cad_io.write.gltf import Other as Drawn
from cad_io.write.step import Other as Product
from cad_io.write.step import write_step as write_cad
from plan_cutters.document.build import fixture_entry
from plan_cutters.domain.clamping import Block, Clamping
from plan_cutters.domain.verdicts import WORDS
from plan_cutters.plan_file.model import FaceEntry, Plan, SplitEntry
from plan_cutters.plan_file.operations import OperationPlanEntry
from plan_cutters.plan_file.reasons import LABELS, MEANING, parts, rgb
from plan_cutters.plan_file.words.headline import shown_cutter
from plan_cutters.plan_file.words.operations import stepped, steps_of
from plan_cutters.report.protocol import Judged


def clamping_shape(clamping: Clamping, chord: float) -> Any:
    """The bodies of a vise or chuck in its own frame, a solid each; of the table below them, what is drawn.

    It is in its place: how far its jaws stand apart is known. `chord`: how far the bore of a jaw may be from its planes, mm.
    """
    shapes = []
    for each in clamping.solids(chord, shown=True):
        if isinstance(each, Block):
            shapes.append(prism((*each.inner, *reversed(each.outer)), each.low, each.high))
        else:
            corners = (each.radius, each.low), (each.radius, each.high), (0.0, each.high), (0.0, each.low)
            shapes.append(revolved((0.0, each.low), [Side(corner) for corner in corners]))
    return compound(shapes)


_Shown = TypeVar("_Shown", Plan, OperationPlanEntry)
#: STEP application protocols that can be requested, and the kernel's names of them.
SCHEMAS = {"ap242": "AP242DIS", "ap214": "AP214IS", "ap203": "AP203"}


def split_result(result: Judged, cutter: str | None = None) -> Any:
    """Split the part's target faces along the verdicts of a cutter, by its id; default the one shown."""
    label = verdict_labels(result, cutter)
    excluded = [LABELS.index(word) for word in ("inside_bodies", "drilled")]

    def worst(rows: NDArray[np.int64]) -> int:
        """Its worst verdict stands for a face, as far as mills have to reach it."""
        seen = label[rows][~np.isin(label[rows], excluded)]
        return int((seen if len(seen) else label[rows]).max())

    # Slivers may join what is worse, but not what is not judged.
    return split(result.part, face_labels(result, label, worst, 0), worst=LABELS.index("inaccessible"))


def verdict_labels(result: Judged, cutter: str | None = None) -> NDArray[np.int32]:
    """The verdict of each sample (n,) as an index into LABELS."""
    code = np.full(256, -1, np.int32)
    for verdict, word in WORDS.items():
        code[verdict] = LABELS.index(word)
    label = code[result.reaches[cutter or result.shown].verdict]
    label[result.inside_bodies] = LABELS.index("inside_bodies")
    return label


def face_labels(
    result: Judged, label: NDArray[np.int32], of_face: Callable[[NDArray[np.int64]], int], first: int
) -> list[FaceLabels]:
    """Labels on the grids of all faces, of samples (n,) from 0; those of LABELS begin at `first`.

    `of_face` gives the label of a face that was sampled without a grid, by the rows (k,) of its samples. A seam, sampled once, is
    put at both ends.
    """
    samples, labels = result.samples, []
    grids = {g.face: g for g in samples.grids}
    sampled = samples.by_face()
    check, ignored, unjudged = (first + LABELS.index(word) for word in ("check", "ignored", "unjudged"))
    ends = np.array([0.0, 1.0])
    for face in result.plan.faces:
        number = int(face.id[1:])
        if face.target and number in grids:
            grid = grids[number]
            on = np.where(grid.index >= 0, label[grid.index], -1).astype(np.int32)
            u, v = grid.u, grid.v
            if grid.closed_u:
                u, on = np.append(u, u[0] + grid.span[1] - grid.span[0]), np.vstack([on, on[:1]])
            if grid.closed_v:
                v, on = np.append(v, v[0] + grid.span[3] - grid.span[2]), np.hstack([on, on[:, :1]])
            labels.append(FaceLabels(number, u, v, on))
            continue
        whole = of_face(sampled[number]) if face.target and number in sampled else unjudged
        if not face.target:
            whole = ignored if face.ignored else check
        labels.append(FaceLabels(number, ends, ends, np.full((2, 2), whole, np.int32)))
    return labels


def verdict_of(piece: Any, first: int = 0) -> str:
    """The word for a piece of a split, whose labels of verdicts begin at `first`; also for one that could not be split."""
    return LABELS[piece.label - first] if piece.label >= 0 else "mixed"


def rungs(split: Any) -> dict[str, SplitEntry]:
    """How each face of mixed verdicts is shown."""
    several = {number for number, count in Counter(piece.face for piece in split.pieces).items() if count > 1}
    return {
        f"F{number}": SplitEntry(
            rung="whole" if number in split.whole else "contour", why=split.whole.get(number),
            joined=split.joined.get(number, 0), dropped=split.dropped.get(number, 0),
        )
        for number in sorted(several | split.whole.keys() | split.joined.keys() | split.dropped.keys())
    }  # fmt: skip


def with_splits(plan: Plan, splits: Mapping[int | None, Any]) -> Plan:
    """The plan with how its models show faces: by plan of operations, None for the verdicts."""

    def shown(of: _Shown, which: int | None) -> _Shown:
        return of.model_copy(update={"split": rungs(splits[which])}) if which in splits else of

    if plan.operations is not None:
        plans = [shown(each, k) for k, each in enumerate(plan.operations.plans)]
        plan = plan.model_copy(update={"operations": plan.operations.model_copy(update={"plans": plans})})
    return shown(plan, None)


def styles(result: Judged, plan: OperationPlanEntry | None = None) -> Callable[[Any], Style]:
    """Name and colour of a piece: of its step or operation, else of its verdict; faces that are no target keep their colour."""
    faces, operations = result.part.faces, plan.operations if plan else []
    # As everywhere, `step3` is the third step of the process; operations of other plans have their ids.
    called = [stepped(result.plan, plan, each.id).replace(" ", "") for each in operations] if plan else []

    def style(piece: Any) -> Style:
        info = faces[piece.face - 1]
        if 0 <= piece.label < len(operations):
            word = called[piece.label]
            return Style(f"F{piece.face}_{word} {info.name}".strip(), parts(operations[piece.label].colour), word)
        word = verdict_of(piece, len(operations))
        own = info.colour if word in ("check", "ignored") else None
        return Style(f"F{piece.face}_{word} {info.name}".strip(), own or rgb(word), word)

    return style


def write_step(result: Judged, split: Any, path: Path, *, schema: str = "ap242", plan: OperationPlanEntry | None = None) -> None:
    """Write `annotated.step`: the input's products and layers, each piece a face named `F<number>_<verdict>`.

    Beside it stand the fixtures that are CAD files, vises and chucks.
    """
    part, others = result.part, []
    for each in result.conditions.surroundings.fixtures:
        shape = each.source.shape if isinstance(each.source, Part) else None
        if shape is None and (clamping := each.fixture.clamping) is not None:
            shape = clamping_shape(clamping, each.obstacles.triangles.chord_error)
        if shape is not None:
            place = np.column_stack([each.fixture.rotation, each.fixture.shift])
            others.append(Product(each.name, shape, place, rgb("fixture")))
    write_cad(
        split, path, styles(result, plan), product=product(result), tree=part.tree, layers=part.layers,
        schema=SCHEMAS[schema], others=others,
    )  # fmt: skip


def face_facts(result: Judged, entry: FaceEntry) -> dict[str, Any]:
    """Give what models say of a face, whatever they show on it."""
    number = int(entry.id[1:])
    return {
        "face": entry.id, "number": number, "name": entry.name, "component": entry.component,
        "layers": list(result.part.layers.get(number, ())), "surface": entry.surface, "kind": entry.kind,
        "target": entry.target, "ignored": entry.ignored,
    }  # fmt: skip


def fixture_meshes(result: Judged) -> list[Drawn]:
    """The fixtures of a result, as triangles with their facts."""
    return [
        Drawn(each.name, each.shown, rgb("fixture"), entry.model_dump(mode="json"))
        for each, entry in zip(result.conditions.surroundings.fixtures, result.plan.fixtures, strict=False)
    ]


def shown_pieces(result: Judged, split: Any) -> Any:
    """A split part without faces in whose place others are shown."""
    doubles = set(result.scene.doubles)
    return replace(split, pieces=tuple(piece for piece in split.pieces if piece.face not in doubles)) if doubles else split


def write_glb(result: Judged, split: Any, path: Path, *, merged: bool = False, fixtures: bool = True) -> None:
    """Write `annotated.glb`: face numbers, verdicts and reasons in `extras`; without `fixtures` the part alone."""
    shown = shown_cutter(result.plan)
    reasons = defaultdict[str, set[str]](set)
    for witness in shown.witnesses:
        if not witness.inside_bodies:
            reasons[witness.face].add(witness.reason)

    def extras(face: int) -> dict[str, Any]:
        entry = result.plan.faces[face - 1]
        counts = shown.faces.get(entry.id)
        return {**face_facts(result, entry), "cutter": shown.id, "verdicts": counts.model_dump() if counts else {},
                "reasons": sorted(reasons[entry.id]), "unjudged": entry.unjudged}  # fmt: skip

    def facts(piece: Any) -> dict[str, Any]:
        word = verdict_of(piece)
        return {"face": f"F{piece.face}", "verdict": word, "meaning": MEANING[word], "cutter": shown.id}

    write_gltf(shown_pieces(result, split), path, styles(result), extras=extras, piece_extras=facts, merged=merged,
               others=fixture_meshes(result) if fixtures else ())  # fmt: skip


def product(result: Judged) -> str:
    """Give the name of the part: that of its file, without the suffix, or "part"."""
    return Path(result.part.file).stem if result.part.file else "part"


def split_operations(result: Judged, number: int) -> Any:
    """Split the part's target faces along the operations of a plan, by its place among the plans.

    Labels of pieces are operations by their place in the plan, and behind these the words of LABELS. Each connected region has a
    piece of its own, also one of a single sample: what is around it may be an operation that does not serve it.
    """
    operations = result.answers.operations
    assert operations is not None, "models of operations are written where these were requested"
    plan = operations.plans[number]
    first = len(plan.operations)
    label = np.where(plan.label >= 0, plan.label, first + verdict_labels(result)).astype(np.int32)

    def of_face(rows: NDArray[np.int64]) -> int:
        """The one label of a face, or that it is of several."""
        labels = np.unique(label[rows])
        return int(labels[0]) if len(labels) == 1 else first + LABELS.index("mixed")

    return split_by_turns(result.part, face_labels(result, label, of_face, first))


def _operations(result: Judged, name: str | None) -> OperationPlanEntry:
    """A plan of operations by its name, or the first one: their models are written where these were requested."""
    plans = result.plan.operations.plans if result.plan.operations else []
    return next(each for each in plans if name in (None, each.name))


def write_operations_step(result: Judged, split: Any, path: Path, *, name: str | None = None, schema: str = "ap242") -> None:
    """Write `operations.step`: as `annotated.step`, but each piece is named `F<number>_step<number>`, or by its operation."""
    write_step(result, split, path, schema=schema, plan=_operations(result, name))


def write_operations_glb(result: Judged, split: Any, path: Path, *, name: str | None = None) -> None:
    """Write `operations.glb`: as `annotated.glb`, with the operation of each piece in `extras`."""
    plan = _operations(result, name)
    step = steps_of(result.plan, plan)

    def extras(face: int) -> dict[str, Any]:
        here = [
            {"operation": each.id, "step": step.get(each.id), "samples": at.samples, "area_mm2": at.area_mm2}
            for each in plan.operations
            for at in each.faces
            if at.face == f"F{face}"
        ]
        return {**face_facts(result, result.plan.faces[face - 1]), "plan": plan.name, "operations": here}

    def facts(piece: Any) -> dict[str, Any]:
        about = {"face": f"F{piece.face}", "plan": plan.name}
        if not 0 <= piece.label < len(plan.operations):
            word = verdict_of(piece, len(plan.operations))
            return {**about, "operation": None, "verdict": word, "meaning": MEANING[word], "cutter": result.shown}
        operation = plan.operations[piece.label]
        known = operation.model_dump(mode="json", include={"mode", "cutter", "setup", "axis", "angles_deg", "seconds"})
        return {**about, "operation": operation.id, "step": step.get(operation.id), **known}

    style, pieces = styles(result, plan), shown_pieces(result, split)
    write_gltf(pieces, path, style, extras=extras, piece_extras=facts, others=_fixtures(result))


def _fixtures(result: Judged) -> list[Drawn]:
    """The fixtures, those of each setup below a node of their own where setups differ in them."""
    if result.ready.alike:
        return fixture_meshes(result)
    return [
        Drawn(
            each.name, each.shown, rgb("fixture"), fixture_entry(each, [k]).model_dump(mode="json"), f"fixtures of setup {k + 1}"
        )
        for k, conditions in enumerate(result.ready.setups)
        for each in conditions.surroundings.fixtures
    ]
