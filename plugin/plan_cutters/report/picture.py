"""The part with the verdicts of the cutter shown, four views on one sheet: `review.png`.

Drawn without a screen and without OpenGL: triangles with a depth at each pixel (`kernels.linear.raster`), words by matplotlib.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from cad_io.errors import WriteError
from cad_io.kernel import translated
from cad_io.write import meshes_of
from plan_cutters.document.palette import LABELS, label, rgb
from plan_cutters.domain.posture import unit
from plan_cutters.report.protocol import Judged
from plan_cutters.report.sheet import DPI, figure, fitting, printable, save, write
from plan_cutters.report.story.names import short_names
from plan_cutters.report.story.numbers import VERDICTS, part_of
from plan_cutters.report.views import FINER, Body, View, averaged, borders, fitted, frame_towards, view

#: Inches: the sheet, and each view.
_SHEET, _VIEW = (12.0, 9.6), (5.72, 3.72)
#: Where views stand on the sheet, inches from the left and the bottom.
_PLACES = ((0.18, 5.0), (6.1, 5.0), (0.18, 1.16), (6.1, 1.16))
#: Pixels of a view that is only measured.
_SMALL = 240, 160
#: How much of what is behind a fixture shows through it.
_THROUGH = 0.86
_BACKGROUND, _LINE = 1.0, 0.15
#: Faces that are no targets are paler than in the models, and shaded less: who does not see green tells it from their grey.
_BESIDE, _PALE, _SOFT = ("check", "ignored"), np.full(3, 0.87), 0.45
#: The verdicts of the legend, in its order.
_LEGEND = (*VERDICTS, "inside_bodies", "mixed", "check", "fixture")
#: The second channel: what patterns stand for. As matplotlib writes hatches, for the legend.
_HATCHES = {"inaccessible": "///", "undecided": "..", "unjudged": "--", "mixed": "xx", "fixture": "\\\\"}


def write_png(result: Judged, split: Any, path: Path) -> None:
    """Write `review.png`: from above, from two corners, and from where most of what is not reached is seen.

    Colours are those of the models; what is not reached has a pattern besides. Fixtures are drawn so that what is behind them
    shows. The same result gives the same bytes.
    """
    with translated("meshing", error=WriteError, file=str(path)):
        meshes = [(piece, mesh) for piece, mesh in meshes_of(split) if mesh is not None]
    if not meshes:
        raise WriteError("the CAD kernel made no triangle of the part", file=str(path))
    mixed = LABELS.index("mixed")
    verdict = np.array([piece.label if piece.label >= 0 else mixed for piece, _ in meshes], np.int32)
    face = np.array([piece.face for piece, _ in meshes], np.int32)
    own = [result.part.faces[piece.face - 1].colour for piece, _ in meshes]
    pieces = _Pieces(verdict, face, _colours(verdict, own))
    part = Body(
        np.concatenate([mesh.point[mesh.triangle] for _, mesh in meshes]),
        np.concatenate([mesh.normal[mesh.triangle] for _, mesh in meshes]),
        np.repeat(np.arange(len(meshes), dtype=np.int32), [len(mesh.triangle) for _, mesh in meshes]),
    )
    fixtures = _fixtures(result)
    up = unit(result.scene.setup, "setup axis")
    width, height = (round(inches * DPI) for inches in _VIEW)
    sheet = figure(*_SHEET)
    near = _near(part, fixtures)
    for place, (words, viewer) in zip(_PLACES, _viewers(part, pieces, up), strict=True):
        frame = frame_towards(viewer, up)
        if viewer is up and (extent := np.ptp(near @ frame[:2].T, axis=0))[1] > extent[0]:
            # From above a long part lies across the sheet.
            frame = np.array([frame[1], -frame[0], frame[2]])
        scale, middle = fitted(frame, near, width, height)
        drawn = view(frame, [part, *fixtures], scale, middle, width, height)
        image = averaged(_coloured(drawn, pieces))
        _put(sheet, place, image, words, drawn[0])
    _words(sheet, result, set(verdict.tolist()), bool(fixtures))
    save(sheet, path)


@dataclass(frozen=True, slots=True)
class _Pieces:
    """Of each piece its verdict (k,) as an index into LABELS, its face (k,), and its colour (k, 3)."""

    verdict: Ints
    face: Ints
    colour: Floats


def _colours(verdict: Ints, own: list[tuple[float, float, float] | None]) -> Floats:
    """Of the verdicts; faces that are no target keep a pale shade of their own colour."""
    found = np.array([_PALE if LABELS[code] in _BESIDE else rgb(LABELS[code]) for code in verdict.tolist()])
    for k, colour in enumerate(own):
        if colour is not None and LABELS[verdict[k]] in _BESIDE:
            found[k] = 0.75 * _PALE + 0.25 * np.array(colour)
    return found


def _fixtures(result: Judged) -> list[Body]:
    """All fixtures as one body with flat facets, or none."""
    shown = [each.shown for each in result.conditions.around.fixtures if len(each.shown)]
    if not shown:
        return []
    corner = np.concatenate(shown)
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    length = np.linalg.norm(normal, axis=1)
    kept = length > 0.0
    flat = np.repeat((normal[kept] / length[kept, None])[:, None], 3, axis=1)
    return [Body(corner[kept], flat, np.zeros(int(kept.sum()), np.int32))]


def _near(part: Body, fixtures: list[Body]) -> Floats:
    """Give the points (n, 3) that must fill the views: the part, and its fixtures as far as half its size around it."""
    points = part.corner.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    room = 0.5 * float(np.linalg.norm(high - low))
    others = [np.clip(body.corner.reshape(-1, 3), low - room, high + room) for body in fixtures]
    return np.concatenate([points, *others])


def _viewers(part: Body, pieces: _Pieces, up: Floats) -> list[tuple[str, Floats]]:
    """Four directions to look from, with their words: from above along the setup axis, from two opposite corners, and of many the
    one that shows the most of what is not reached, or from below if all is."""
    right, back = _across(up)
    first, second = right - back + 0.9 * up, -right + back + 0.9 * up
    corners = [x * right + y * back + z * up for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    others = [each / np.linalg.norm(each) for each in corners if np.linalg.norm(each) > 0.5]
    taken = [each / np.linalg.norm(each) for each in (up, right - back + up, -right + back + up)]
    others = [each for each in others if max(float(each @ t) for t in taken) < 0.99]
    seen = [_lost_seen(part, pieces, each, up) for each in others]
    # The views that there are already show as much of the rest as can be seen: then look from below.
    front, words = (others[int(np.argmax(seen))], "where most of what is not reached is seen") if max(seen) > 0.0 else (
        right - back - 0.9 * up, "from below, from a corner")  # fmt: skip
    return [
        ("along the setup axis", up),
        ("from a corner", first),
        ("from the opposite corner", second),
        (words, front),
    ]


def _lost_seen(part: Body, pieces: _Pieces, viewer: Floats, up: Floats) -> float:
    """How much of what is not reached a small view shows, mm2 on its sheet."""
    lost = [LABELS.index(word) for word in ("undecided", "inaccessible")]
    if not np.isin(pieces.verdict, lost).any():
        return 0.0
    frame = frame_towards(viewer, up)
    scale, middle = fitted(frame, part.corner.reshape(-1, 3), *_SMALL)
    (drawn,) = view(frame, [part], scale, middle, *_SMALL, finer=1)
    shown = pieces.verdict[drawn.seen[drawn.seen >= 0]]
    return round(float(np.isin(shown, lost).sum()) / scale**2, 6)


def _across(up: Floats) -> tuple[Floats, Floats]:
    """Two unit directions across the setup axis, as near to X and Y as can be."""
    axis = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
    right = axis - (axis @ up) * up
    right = right / np.linalg.norm(right)
    return right, np.cross(up, right)


def _coloured(drawn: list[View], pieces: _Pieces) -> Floats:
    """The part's fine image (h, w, 3), fixtures laid over it."""
    part = drawn[0]
    hit = part.seen >= 0
    piece = np.maximum(part.seen, 0)
    image = np.full((*part.seen.shape, 3), _BACKGROUND)
    verdict = np.where(hit, pieces.verdict[piece], -1)
    beside = np.isin(verdict, [LABELS.index(word) for word in _BESIDE])
    shade = np.where(beside, 1.0 - _SOFT * (1.0 - part.shade), part.shade)
    image[hit] = pieces.colour[piece[hit]] * shade[hit][:, None]
    for word, mark in _marks(*part.seen.shape).items():
        image[mark & (verdict == LABELS.index(word))] *= 0.45
    # Lines between faces, between verdicts, and around the part.
    faces = np.where(hit, pieces.face[piece], -1).astype(np.int32)
    image[borders(faces * len(LABELS) + verdict.astype(np.int32))] = _LINE
    for body in drawn[1:]:
        over = (body.seen >= 0) & (body.depth > part.depth)
        image[over] = _glass(image[over])
        i, j = np.arange(over.shape[0])[:, None] // FINER, np.arange(over.shape[1])[None] // FINER
        image[over & ((i - j) % 12 < 1)] = rgb("fixture")
        image[borders(over.astype(np.int32))] = _LINE
    return image


def _glass(behind: Floats) -> Floats:
    """Colours (n, 3) seen through a fixture."""
    return np.asarray(_THROUGH * behind + (1.0 - _THROUGH) * np.array(rgb("fixture")))


@cache
def _marks(height: int, width: int) -> dict[str, NDArray[np.bool_]]:
    """Patterns (h, w) of what is not reached, on fine pixels: the second channel beside the colours."""
    i, j = np.arange(height)[:, None] // FINER, np.arange(width)[None] // FINER
    dots = ((i % 7) < 2) & (((j + 4 * ((i // 7) % 2)) % 8) < 2)
    return {
        "inaccessible": ((i + j) % 9) < 2,
        "undecided": dots,
        "unjudged": np.broadcast_to((i % 7) < 1, (height, width)),
        "mixed": (((i + j) % 12) < 1) | (((i - j) % 12) < 1),
    }


def _put(sheet: Any, place: tuple[float, float], image: Floats, words: str, drawn: View) -> None:
    """A view on the sheet, with its words, the part's directions and a scale."""
    x, y, w, h = place[0] / _SHEET[0], place[1] / _SHEET[1], _VIEW[0] / _SHEET[0], _VIEW[1] / _SHEET[1]
    axes = sheet.add_axes((x, y, w, h))
    axes.set_xticks([])
    axes.set_yticks([])
    for line in axes.spines.values():
        line.set(color="#BBBBBB", linewidth=0.6)
    height, width, _ = image.shape
    # One pixel of the image is one of the sheet: nothing is smoothed.
    axes.imshow(
        np.round(image * 255).astype(np.uint8), extent=(0, width, 0, height), interpolation="nearest", aspect="auto"
    )
    axes.text(8, height - 8, words, va="top", fontsize=8)
    length = _round_length(0.22 * width / drawn.scale)
    end = width - 12
    axes.plot([end - length * drawn.scale, end], [14, 14], color="black", linewidth=1.6, solid_capstyle="butt")
    axes.text(end, 20, f"{length:g} mm", ha="right", va="bottom", fontsize=7)
    origin, long = np.array([34.0, 34.0]), 24.0
    for direction, name, colour in zip(np.eye(3), "XYZ", ("#B00000", "#007000", "#0000B0"), strict=True):
        flat = drawn.frame[:2] @ direction
        end_x, end_y = origin + long * flat
        axes.plot([origin[0], end_x], [origin[1], end_y], color=colour, linewidth=1.2)
        if np.linalg.norm(flat) > 0.2:
            axes.text(*(origin + (long + 8) * flat), name, color=colour, fontsize=7, ha="center", va="center")
    axes.set_xlim(0, width)
    axes.set_ylim(0, height)


def _round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is no longer."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(next(k for k in (5, 2, 1) if k * power <= most * (1 + 1e-9)) * power)


def _words(sheet: Any, result: Judged, there: set[int], fixtures: bool) -> None:
    """Title and legend."""
    from matplotlib.patches import Patch

    plan = result.plan
    entry = next(c for c in plan.cutters if c.id == result.shown)
    shares = entry.area_share.model_dump()
    part = Path(plan.part.file).name if plan.part.file else "part"
    name = short_names(plan)[entry.id]
    taken = (
        "is selected"
        if result.selected == result.shown
        else "is shown because it reaches the most samples; none is selected"
    )
    size = " x ".join(f"{x:.4g}" for x in plan.part.size_mm)
    room = _SHEET[0] - 2.0 * 0.18
    head = fitting(f"{printable(part, 60)}: {printable(name, 60)}", 12, room)
    write(sheet, head[:1], (0.18, _SHEET[1] - 0.16), 12)
    setup = ", ".join(f"{x:.4g}" for x in plan.effective.setup)
    machine = printable(plan.effective.machine, 40)
    under = (
        f"This cutter {taken}. Part {size} mm. Machine {machine}, setup axis ({setup}), gouge tolerance "
        f"{plan.effective.tolerance_mm:.3g} mm, {plan.samples.count} samples."
    )
    write(sheet, fitting(under, 8.5, room), (0.18, _SHEET[1] - 0.48), 8.5)
    handles = []
    for word in _LEGEND:
        share = shares.get(word)
        if word == "fixture" and not fixtures:
            continue
        if LABELS.index(word) not in there and not share and word != "fixture":
            continue
        text = label(word)
        legend = text if share is None else f"{text}: {part_of(entry, entry.area_share, [word])} of the target area"
        glass = word == "fixture"
        face = tuple(_glass(np.ones(3))) if glass else tuple(_PALE) if word in _BESIDE else rgb(word)
        handles.append(
            Patch(
                facecolor=face,
                edgecolor=rgb(word) if glass else "#222222",
                hatch=_HATCHES.get(word),
                linewidth=0.5,
                label=legend,
            )
        )
    sheet.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.1 / _SHEET[0], 0.02), ncols=3, frameon=False, fontsize=9,
                 handlelength=2.6, handleheight=1.5, columnspacing=2.0)  # fmt: skip
