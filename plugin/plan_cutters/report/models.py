"""The annotated models: faces split along the boundaries of the verdicts, in STEP and GLB alike.

They show one cutter: the selected one or, where none is feasible, the one that reaches the most.
"""

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, FaceLabels, Style
from cad_io.part import Part
from cad_io.split import split
from cad_io.write import write_gltf
from cad_io.write.gltf import Other as Drawn
from cad_io.write.step import Other as Product
from cad_io.write.step import write_step as write_cad
from plan_cutters.document.model import SplitEntry
from plan_cutters.document.palette import LABELS, MEANING, rgb
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED
from plan_cutters.report.protocol import Judged

_LABEL = {
    INTERFERENCE_FREE: LABELS.index("interference_free"),
    ACCESSIBLE: LABELS.index("accessible"),
    UNDECIDED: LABELS.index("undecided"),
    INACCESSIBLE: LABELS.index("inaccessible"),
    UNJUDGED: LABELS.index("unjudged"),
}

#: STEP application protocols that can be asked for, and the kernel's names of them.
SCHEMAS = {"ap242": "AP242DIS", "ap214": "AP214IS", "ap203": "AP203"}


def _grid_labels(grid: FaceGrid, label: NDArray[np.int32]) -> FaceLabels:
    """Labels at a face's grid nodes; a seam, sampled once, is put at both ends."""
    on = np.where(grid.index >= 0, label[grid.index], -1).astype(np.int32)
    u, v = grid.u, grid.v
    if grid.closed_u:
        u, on = np.append(u, u[0] + grid.span[1] - grid.span[0]), np.vstack([on, on[:1]])
    if grid.closed_v:
        v, on = np.append(v, v[0] + grid.span[3] - grid.span[2]), np.hstack([on, on[:, :1]])
    return FaceLabels(grid.face, u, v, on)


def split_result(result: Judged, cutter: str | None = None) -> Any:
    """Split the part's target faces along the verdicts of a cutter, by its id; default the one shown."""
    samples = result.samples
    code = np.full(256, -1, np.int32)
    for verdict, word in _LABEL.items():
        code[verdict] = word
    label = code[result.reaches[cutter or result.shown].verdict]
    covered = LABELS.index("inside_bodies")
    label[result.inside_bodies] = covered
    grids = {g.face: g for g in samples.grids}
    check, ignored = LABELS.index("check"), LABELS.index("ignored")
    labels = []
    for face in result.plan.faces:
        number = int(face.id[1:])
        if not face.target:
            labels.append(_whole(number, ignored if face.ignored else check))
        elif number in grids:
            labels.append(_grid_labels(grids[number], label))
        elif (mine := samples.face == number).any():
            # Sampled without a grid: its worst verdict stands for the face, as far as it is one of the finished part.
            seen = mine & (label != covered)
            labels.append(_whole(number, int(label[seen].max()) if seen.any() else covered))
        else:
            labels.append(_whole(number, LABELS.index("unjudged")))
    # Slivers may join what is worse, but not what is not judged.
    return split(result.part, labels, worst=LABELS.index("inaccessible"))


def _whole(face: int, label: int) -> FaceLabels:
    ends = np.array([0.0, 1.0])
    return FaceLabels(face, ends, ends, np.full((2, 2), label, np.int32))


def verdict_of(piece: Any) -> str:
    """The word for a piece of a split."""
    return LABELS[piece.label] if piece.label >= 0 else "mixed"


def rungs(split: Any) -> dict[str, SplitEntry]:
    """How each face of mixed verdicts is shown."""
    counts = Counter(piece.face for piece in split.pieces)
    shown = {number: SplitEntry(rung="contour", why=None) for number, count in counts.items() if count > 1}
    for number, why in split.whole.items():
        shown[number] = SplitEntry(rung="whole", why=why)
    for number in split.joined.keys() | split.dropped.keys():
        entry = shown.get(number) or SplitEntry(rung="contour", why=None)
        told = {"joined": split.joined.get(number, 0), "dropped": split.dropped.get(number, 0)}
        shown[number] = entry.model_copy(update=told)
    return {f"F{number}": shown[number] for number in sorted(shown)}


def styles(result: Judged) -> Callable[[Any], Style]:
    """Name and colour of a piece: a target face has the colour of its verdict, others keep their own."""
    faces = result.part.faces

    def style(piece: Any) -> Style:
        info, verdict = faces[piece.face - 1], verdict_of(piece)
        own = info.colour if verdict in ("check", "ignored") else None
        return Style(f"F{piece.face}_{verdict} {info.name}".strip(), own or rgb(verdict))

    return style


def write_step(result: Judged, split: Any, path: Path, *, schema: str = "ap242") -> None:
    """Write `annotated.step`: the input's products and layers, each piece a face named `F<number>_<verdict>`."""
    part = result.part
    others = [
        Product(
            each.name, each.source.shape, np.column_stack([each.fixture.rotation, each.fixture.shift]), rgb("fixture")
        )
        for each in result.conditions.around.fixtures
        if isinstance(each.source, Part)
    ]
    write_cad(split, path, styles(result), product=product(result), tree=part.tree, layers=part.layers,
              schema=SCHEMAS[schema], others=others)  # fmt: skip


def write_glb(result: Judged, split: Any, path: Path, *, merged: bool = False) -> None:
    """Write `annotated.glb`: face numbers, verdicts and reasons in `extras`."""
    shown = next(c for c in result.plan.cutters if c.id == result.shown)
    entries = {int(f.id[1:]): f for f in result.plan.faces}

    def extras(face: int) -> dict[str, Any]:
        entry = entries[face]
        counts = shown.faces.get(entry.id)
        reasons = sorted({w.reason for w in shown.witnesses if w.face == entry.id and not w.inside_bodies})
        return {
            "face": entry.id,
            "number": face,
            "name": entry.name,
            "component": entry.component,
            "layers": list(result.part.layers.get(face, ())),
            "surface": entry.surface,
            "kind": entry.kind,
            "target": entry.target,
            "ignored": entry.ignored,
            "cutter": shown.id,
            "verdicts": counts.model_dump() if counts else {},
            "reasons": reasons,
            "unjudged": entry.unjudged,
        }

    write_gltf(
        split,
        path,
        styles(result),
        extras=extras,
        piece_extras=lambda p: {
            "face": f"F{p.face}",
            "verdict": verdict_of(p),
            "meaning": MEANING[verdict_of(p)],
            "cutter": shown.id,
        },
        merged=merged,
        others=[
            Drawn(each.name, each.shown, rgb("fixture"), entry.model_dump(mode="json"))
            for each, entry in zip(result.conditions.around.fixtures, result.plan.fixtures, strict=False)
        ],
    )


def write_merged(result: Judged, split: Any, path: Path) -> None:
    """Write `merged.glb`: one mesh for parts of so many faces that viewers are slow with a node each."""
    write_glb(result, split, path, merged=True)


def product(result: Judged) -> str:
    """Give the name of the part: that of its file, without the suffix, or "part"."""
    return Path(result.part.file).stem if result.part.file else "part"
