"""The models of a plan of operations: faces split along the borders of operations, in STEP and GLB alike.

What no operation takes keeps the verdict of the cutter shown, as in the annotated models.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Style
from cad_io.split import split_by_turns
from cad_io.write import write_gltf
from cad_io.write.gltf import Other as Drawn
from plan_cutters.document.fixtures import fixture_entry
from plan_cutters.plan_file.operations import OperationEntry, OperationPlanEntry
from plan_cutters.plan_file.palette import LABELS, MEANING, parts, rgb
from plan_cutters.report.models import face_facts, face_labels, fixture_meshes, shown_pieces, verdict_labels, write_styled_step
from plan_cutters.report.protocol import Judged


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


def write_operations_step(result: Judged, split: Any, path: Path, *, number: int = 0, schema: str = "ap242") -> None:
    """Write `operations.step`: as `annotated.step`, but with a face named `F<number>_<operation>` for each piece."""
    write_styled_step(result, split, path, _styles(result, _entry(result, number)), schema)


def write_operations_glb(result: Judged, split: Any, path: Path, *, number: int = 0) -> None:
    """Write `operations.glb`: as `annotated.glb`, with the operation of each piece in `extras`."""
    plan = _entry(result, number)
    entries = {int(face.id[1:]): face for face in result.plan.faces}

    def extras(face: int) -> dict[str, Any]:
        here = [
            {"operation": each.id, "samples": at.samples, "area_mm2": at.area_mm2}
            for each in plan.operations
            for at in each.faces
            if at.face == f"F{face}"
        ]
        return {**face_facts(result, entries[face]), "plan": plan.name, "operations": here}

    def facts(piece: Any) -> dict[str, Any]:
        operation = _operation(piece, plan)
        if operation is None:
            word = _word(piece, plan)
            return {"face": f"F{piece.face}", "plan": plan.name, "operation": None, "verdict": word, "meaning": MEANING[word],
                    "cutter": result.shown}  # fmt: skip
        known = operation.model_dump(mode="json", include={"mode", "cutter", "setup", "axis", "angles_deg", "seconds"})
        return {"face": f"F{piece.face}", "plan": plan.name, "operation": operation.id, **known}

    write_gltf(
        shown_pieces(result, split), path, _styles(result, plan), extras=extras, piece_extras=facts, others=_fixtures(result)
    )


def write_fastest_step(result: Judged, split: Any, path: Path, *, schema: str = "ap242") -> None:
    """Write `operations_fastest.step`: the fastest plan beside another one."""
    write_operations_step(result, split, path, number=_place(result, "fastest"), schema=schema)


def write_fastest_glb(result: Judged, split: Any, path: Path) -> None:
    """Write `operations_fastest.glb`."""
    write_operations_glb(result, split, path, number=_place(result, "fastest"))


def _place(result: Judged, name: str) -> int:
    operations = result.plan.operations
    assert operations is not None, "models of operations are written where these were requested"
    return [str(each.name) for each in operations.plans].index(name)


def _fixtures(result: Judged) -> list[Drawn]:
    """The fixtures, those of each setup below a node of their own where setups differ in them."""
    ready = result.ready
    if ready.alike:
        return fixture_meshes(result)
    fixtures = []
    for k, conditions in enumerate(ready.setups):
        for each in conditions.surroundings.fixtures:
            facts = fixture_entry(each, [k]).model_dump(mode="json")
            fixtures.append(Drawn(each.name, each.shown, rgb("fixture"), facts, f"fixtures of setup {k + 1}"))
    return fixtures


def _entry(result: Judged, number: int) -> OperationPlanEntry:
    operations = result.plan.operations
    assert operations is not None, "models of operations are written where these were requested"
    return operations.plans[number]


def _operation(piece: Any, plan: OperationPlanEntry) -> OperationEntry | None:
    return plan.operations[piece.label] if 0 <= piece.label < len(plan.operations) else None


def _word(piece: Any, plan: OperationPlanEntry) -> str:
    """What a piece is called that no operation takes; also one that could not be split."""
    return LABELS[piece.label - len(plan.operations)] if piece.label >= 0 else "mixed"


def _styles(result: Judged, plan: OperationPlanEntry) -> Callable[[Any], Style]:
    """Name and colour of a piece: those of its operation, else of its verdict; faces that are no target keep their own colour."""
    faces = result.part.faces

    def style(piece: Any) -> Style:
        info, operation = faces[piece.face - 1], _operation(piece, plan)
        if operation is not None:
            return Style(f"F{piece.face}_{operation.id} {info.name}".strip(), parts(operation.colour), operation.id)
        word = _word(piece, plan)
        own = info.colour if word in ("check", "ignored") else None
        return Style(f"F{piece.face}_{word} {info.name}".strip(), own or rgb(word), word)

    return style
