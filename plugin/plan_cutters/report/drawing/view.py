"""Views of a part drawn into images: where one looks from, which triangle each pixel shows, and how bright it is."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints

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
    """Draw a body from one side; the image has finer pixels, `finer` along each side of one.

    Parameters
    ----------
    frame : (3, 3) float
    body : Body
    scale, middle
        As `fitted` gives them.
    width, height : int
        Of the finished image, pixels.
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
