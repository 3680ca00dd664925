"""The part with the verdicts of the cutter shown, four views on one sheet: `review.png`.

Drawn without a screen and without OpenGL: triangles with a depth at each pixel (`kernels.linear.raster`), all else by matplotlib.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from cad_io.errors import WriteError
from cad_io.kernel import translated
from cad_io.write import meshes_of
from plan_cutters.domain.figures import mm
from plan_cutters.domain.posture import unit
from plan_cutters.plan_file.reasons import LABELS, label, rgb
from plan_cutters.plan_file.shares import VERDICTS, part_of
from plan_cutters.plan_file.words.cutters import rendered
from plan_cutters.plan_file.words.names import short_names
from plan_cutters.report.drawing.posture_map import DPI, Look, figure, fitting, legend, printable, save, standard, write
from plan_cutters.report.models import shown_pieces
from plan_cutters.report.protocol import Judged

#: Pixels drawn for each pixel of an image, along either side: they are averaged, so that edges are smooth.
FINER = 2
#: Shares of an image's width and height that stay empty around what is drawn.
_MARGIN = 0.04, 0.08
#: Light from behind the viewer's left shoulder, and how dark a surface can get.
_LIGHT, _DARKEST = np.array([-0.35, 0.45, 1.0]), 0.55


class Body(NamedTuple):
    """Corners (n, 3, 3), mm, and unit normals (n, 3, 3) of triangles, and what each belongs to (n,)."""

    corner: Floats
    normal: Floats
    owner: Ints


class View(NamedTuple):
    """A body is seen so: of each fine pixel (h, w) the owner, -1 for nothing; the brightness, 0 to 1; the nearness, mm."""

    seen: Ints
    shade: Floats
    depth: Floats


def frame_towards(viewer: Floats, up: Floats) -> Floats:
    """The frame (3, 3) of a view from a direction: right, up on the sheet, towards the viewer."""
    towards = viewer / np.linalg.norm(viewer)
    right = np.cross(up, towards)
    if np.linalg.norm(right) < 1e-6:
        # From above or below: the direction that is nearest to X points to the right.
        across = np.eye(3)[int(np.abs(towards).argmin())] if abs(towards[0]) > 0.9 else np.eye(3)[0]
        right = across - (across @ towards) * towards
    right = right / np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def fitted(frame: Floats, points: Floats, width: int, height: int) -> tuple[float, Floats]:
    """Pixels a mm with which points (n, 3) fill an image, and what of the frame is in its middle (2,), mm."""
    flat = points @ frame[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    size = np.maximum(high - low, 1e-9)
    available = (1.0 - 2.0 * np.array(_MARGIN)) * np.array([width, height])
    return float((available / size).min()), 0.5 * (low + high)


def view(frame: Floats, body: Body, scale: float, middle: Floats, width: int, height: int, finer: int = FINER) -> View:
    """Draw a body from one side, in a `frame` (3, 3), with scale and middle as `fitted` gives them.

    The image, `width` by `height` pixels when finished, has finer pixels, `finer` along each side of one.
    """
    from plan_cutters.kernels.linear.raster import draw

    size, fine = np.array([width, height]) * finer, scale * finer
    corner = body.corner @ frame.T
    corner[:, :, :2] = (corner[:, :, :2] - middle) * [fine, -fine] + 0.5 * (size - 1)
    # Open shells are looked at from both sides: a side that is turned away is lit as if it were turned.
    turned = body.normal @ frame.T
    turned = np.where(turned[:, :, 2:] < 0.0, -turned, turned)
    bright = _DARKEST + (1.0 - _DARKEST) * np.clip(turned @ (_LIGHT / np.linalg.norm(_LIGHT)), 0.0, 1.0)
    shape = size[1], size[0]
    result = View(np.full(shape, -1, np.int32), np.zeros(shape), np.full(shape, -np.inf))
    draw(np.ascontiguousarray(corner), np.ascontiguousarray(bright), np.ascontiguousarray(body.owner, np.int32), result.depth,
         result.seen, result.shade)  # fmt: skip
    return result


def borders(codes: Ints) -> NDArray[np.bool_]:
    """Pixels (h, w) whose right or lower neighbour has another code."""
    result = np.zeros(codes.shape, bool)
    result[:, :-1] |= codes[:, :-1] != codes[:, 1:]
    result[:-1] |= codes[:-1] != codes[1:]
    return result


def averaged(image: NDArray[Any]) -> Floats:
    """A fine image (h, w) or (h, w, 3) as the finished one."""
    h, w, *deep = image.shape
    return np.asarray(image.reshape(h // FINER, FINER, w // FINER, FINER, *deep).mean(axis=(1, 3)))


#: Inches: the sheet, and each view.
_SHEET, _VIEW = (12.0, 9.6), (5.72, 3.72)
#: Where views stand on the sheet, inches from the left and the bottom.
_PLACES = ((0.18, 5.0), (6.1, 5.0), (0.18, 1.16), (6.1, 1.16))
#: Pixels of a view, and of one that is only measured.
_PIXELS, _SMALL = (round(_VIEW[0] * DPI), round(_VIEW[1] * DPI)), (240, 160)
_EXTENT = 0, _PIXELS[0], 0, _PIXELS[1]
#: How bright paper is, and lines between faces.
_BACKGROUND, _LINE = 1.0, 0.15
#: How much colour a fixture gives to what is behind it.
_GLASS = 0.14
#: Faces that are no targets are paler than in the models, and shaded less: who does not see green tells it from their grey.
_PLAIN, _PALE, _SOFT = ("check", "ignored"), np.full(3, 0.87), 0.45
#: The verdicts of the legend, in its order.
_LEGEND = (*VERDICTS, "drilled", "inside_bodies", "mixed", "check", "fixture")
#: The second channel: what patterns stand for. As matplotlib writes hatches.
_HATCHES = {"inaccessible": "///", "undecided": "..", "unjudged": "--", "mixed": "xx", "fixture": "\\\\"}


class _Pieces(NamedTuple):
    """Of each piece its verdict (k,) as an index into LABELS, its face (k,), and its colour (k, 3)."""

    verdict: Ints
    face: Ints
    colour: Floats


def write_png(result: Judged, split: Any, path: Path) -> None:
    """Write `review.png`: from above, from two corners, and from where most of what is not reached is seen.

    Colours are those of the models; what is not reached has a pattern besides. Fixtures are drawn so that what is behind them
    shows. The same result gives the same bytes.
    """
    with translated("meshing", error=WriteError, file=str(path)):
        meshes = [(piece, mesh) for piece, mesh in meshes_of(shown_pieces(result, split)) if mesh is not None]
    if not meshes:
        raise WriteError("the CAD kernel made no triangle of the part", file=str(path))
    mixed = LABELS.index("mixed")
    verdict = np.array([piece.label if piece.label >= 0 else mixed for piece, _ in meshes], np.int32)
    face = np.array([piece.face for piece, _ in meshes], np.int32)
    colours = np.array([_PALE if LABELS[code] in _PLAIN else rgb(LABELS[code]) for code in verdict.tolist()])
    for k, (piece, _) in enumerate(meshes):
        # Faces that are no target keep a pale shade of their own colour.
        own = result.part.faces[piece.face - 1].colour
        if own is not None and LABELS[verdict[k]] in _PLAIN:
            colours[k] = 0.75 * _PALE + 0.25 * np.array(own)
    pieces = _Pieces(verdict, face, colours)
    part = Body(
        np.concatenate([mesh.point[mesh.triangle] for _, mesh in meshes]),
        np.concatenate([mesh.normal[mesh.triangle] for _, mesh in meshes]),
        np.repeat(np.arange(len(meshes), dtype=np.int32), [len(mesh.triangle) for _, mesh in meshes]),
    )
    # All fixtures as one body, or none. Glass has no shade: they need no normals.
    shown = [each.shown for each in result.conditions.surroundings.fixtures if len(each.shown)]
    glass = np.concatenate([np.empty((0, 3, 3)), *shown])
    fixtures = [Body(glass, np.zeros_like(glass), np.zeros(len(glass), np.int32))] if shown else []
    up = unit(result.scene.setup, "setup axis")
    sheet = figure(*_SHEET)
    # What must fill the views: the part, and its fixtures as far as half its size around it.
    points = part.corner.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    half = 0.5 * float(np.linalg.norm(high - low))
    near = np.concatenate([points, np.clip(glass.reshape(-1, 3), low - half, high + half)])
    for place, (words, viewer) in zip(_PLACES, _viewers(part, pieces, up), strict=True):
        frame = frame_towards(viewer, up)
        if viewer is up and (extent := np.ptp(near @ frame[:2].T, axis=0))[1] > extent[0]:
            # From above a long part lies across the sheet.
            frame = np.array([frame[1], -frame[0], frame[2]])
        scale, middle = fitted(frame, near, *_PIXELS)
        views = [view(frame, body, scale, middle, *_PIXELS) for body in (part, *fixtures)]
        _put(_window(sheet, place, frame, scale, words), views, pieces)
    _words(sheet, result, set(verdict.tolist()), bool(fixtures))
    save(sheet, path)


def _viewers(part: Body, pieces: _Pieces, up: Floats) -> list[tuple[str, Floats]]:
    """Four directions to look from, with their words: from above along the setup axis, from two opposite corners, and of many the
    one that shows the most of what is not reached, or from below if all is."""
    right, back, _ = frame_towards(up, up)
    first, second = right - back + 0.9 * up, -right + back + 0.9 * up
    corners = [x * right + y * back + z * up for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    others = [each / np.linalg.norm(each) for each in corners if np.linalg.norm(each) > 0.5]
    taken = [each / np.linalg.norm(each) for each in (up, right - back + up, -right + back + up)]
    others = [each for each in others if max(float(each @ t) for t in taken) < 0.99]
    not_reached = [LABELS.index(word) for word in ("undecided", "inaccessible")]

    def seen(viewer: Floats) -> float:
        """How much of what is not reached a small view shows, mm2 on its sheet."""
        frame = frame_towards(viewer, up)
        scale, middle = fitted(frame, part.corner.reshape(-1, 3), *_SMALL)
        small = view(frame, part, scale, middle, *_SMALL, finer=1).seen
        return round(float(np.isin(pieces.verdict[small[small >= 0]], not_reached).sum()) / scale**2, 6)

    areas = [seen(each) for each in others] if np.isin(pieces.verdict, not_reached).any() else [0.0]
    # Where the views that there are already show as much of the rest as can be seen, the last one looks from below.
    front, words = (
        (others[int(np.argmax(areas))], "where most of what is not reached is seen")
        if max(areas) > 0.0
        else (right - back - 0.9 * up, "from below, from a corner")
    )
    return [("along the setup axis", up), ("from a corner", first), ("from the opposite corner", second), (words, front)]


def _put(axes: Any, views: list[View], pieces: _Pieces) -> None:
    part = views[0]
    hit, piece = part.seen >= 0, np.maximum(part.seen, 0)
    verdict = np.where(hit, pieces.verdict[piece], -1)
    shade = np.where(np.isin(verdict, [LABELS.index(word) for word in _PLAIN]), 1.0 - _SOFT * (1.0 - part.shade), part.shade)
    image = np.where(hit[:, :, None], pieces.colour[piece] * shade[:, :, None], _BACKGROUND)
    # Lines between faces, between verdicts, and around the part.
    image[borders(np.where(hit, pieces.face[piece], -1) * len(LABELS) + verdict)] = _LINE
    # One pixel of the image is one of the sheet: nothing is smoothed.
    axes.imshow(np.round(averaged(image) * 255).astype(np.uint8), extent=_EXTENT, interpolation="nearest", aspect="auto")
    for word, hatch in _HATCHES.items():
        _lay(axes, verdict == LABELS.index(word), (0.0, 0.0, 0.0, 0.0), hatch, "#000000AA")
    for body in views[1:]:
        over = (body.seen >= 0) & (body.depth > part.depth)
        _lay(axes, over, (*rgb("fixture"), _GLASS), _HATCHES["fixture"], rgb("fixture"), 0.6)


def _lay(axes: Any, there: NDArray[np.bool_], fill: Any, hatch: str, edge: Any, line: float = 0.0) -> None:
    """Lay a colour and a hatch over fine pixels (h, w), with a line around them, points wide."""
    if there.any():
        laid = axes.contourf(averaged(there), [0.4, 2.0], colors=[fill], hatches=[hatch], origin="upper", extent=_EXTENT)
        laid.set(edgecolor=edge, linewidth=line)


def _window(sheet: Any, place: tuple[float, float], frame: Floats, scale: float, words: str) -> Any:
    """The axes of a view on the sheet, with its words, the part's directions and a scale."""
    x, y, w, h = place[0] / _SHEET[0], place[1] / _SHEET[1], _VIEW[0] / _SHEET[0], _VIEW[1] / _SHEET[1]
    axes = sheet.add_axes((x, y, w, h))
    axes.set_xticks([])
    axes.set_yticks([])
    for line in axes.spines.values():
        line.set(color="#BBBBBB", linewidth=0.6)
    width, height = _PIXELS
    axes.text(8, height - 8, words, va="top", fontsize=8)
    length = standard(0.22 * width / scale)
    end = width - 12
    axes.plot([end - length * scale, end], [14, 14], color="black", linewidth=1.6, solid_capstyle="butt")
    axes.text(end, 20, mm(length), ha="right", va="bottom", fontsize=7)
    origin, long = np.array([34.0, 34.0]), 24.0
    for direction, name, colour in zip(np.eye(3), "XYZ", ("#B00000", "#007000", "#0000B0"), strict=True):
        flat = frame[:2] @ direction
        end_x, end_y = origin + long * flat
        axes.plot([origin[0], end_x], [origin[1], end_y], color=colour, linewidth=1.2)
        if np.linalg.norm(flat) > 0.2:
            axes.text(*(origin + (long + 8) * flat), name, color=colour, fontsize=7, ha="center", va="center")
    axes.set_xlim(0, width)
    axes.set_ylim(0, height)
    return axes


def _words(sheet: Any, result: Judged, there: set[int], fixtures: bool) -> None:
    plan = result.plan
    entry = next(c for c in plan.cutters if c.id == result.shown)
    shares = entry.area_share.model_dump()
    part = Path(plan.part.file).name if plan.part.file else "part"
    name = short_names(plan)[entry.id]
    width = _SHEET[0] - 2.0 * 0.18
    head = fitting(f"{printable(part, 60)}: {printable(name, 60)}", 12, width)
    write(sheet, head[:1], (0.18, _SHEET[1] - 0.16), 12)
    under = printable(rendered(plan), 400)
    write(sheet, fitting(under, 8.5, width), (0.18, _SHEET[1] - 0.48), 8.5)
    looks = []
    for word in _LEGEND:
        share, glass = shares.get(word), word == "fixture"
        if not (fixtures if glass else LABELS.index(word) in there or share):
            continue
        text = label(word) if share is None else f"{label(word)}: {part_of(entry, entry.area_share, [word])} of the target area"
        colour = (*rgb(word), _GLASS) if glass else tuple(_PALE) if word in _PLAIN else rgb(word)
        looks.append(Look(text, colour, _HATCHES.get(word, ""), rgb(word) if glass else "#222222"))
    legend(sheet, looks, loc="lower left", bbox_to_anchor=(0.1 / _SHEET[0], 0.02), ncols=3, columnspacing=2.0)
