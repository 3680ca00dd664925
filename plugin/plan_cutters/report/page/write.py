"""The page as a file: data, tables and script in one, within its size."""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from cad_io.write.render_mesh import render_mesh
from plan_cutters.domain.lengths import reporting
from plan_cutters.domain.tolerance import depths
from plan_cutters.files.markup import embedded, policy, template, with_three
from plan_cutters.plan_file.model import Plan
from plan_cutters.report.page import arrays, tables
from plan_cutters.report.page.arrays import Arrays
from plan_cutters.report.page.atlas import atlas_of
from plan_cutters.report.page.encode import joined, size_of
from plan_cutters.report.page.facts import spots_of
from plan_cutters.report.page.meta import meta_of
from plan_cutters.report.page.operations import operation_arrays
from plan_cutters.report.page.surface import box_of, surface_of
from plan_cutters.report.page.tables import Drawing
from plan_cutters.report.protocol import Judged

#: Bytes that a page may have, with the posture maps of all samples, and without.
LARGEST, LARGEST_WITHOUT = 8_000_000, 2_500_000
#: Triangles that are drawn, about.
TRIANGLES = 60_000
#: Maps of fewer than one in so many samples are rather left out.
_WIDEST_STRIDE = 64
#: The kernel's triangles are up to so many times more than the obstacles' of the same chord error (2.5 times was found). A second
#: mesh takes longer than somewhat fewer triangles do harm.
_SURELY = 3.0
_HERE = Path(__file__).parent


class Omitted(NamedTuple):
    """Sentences on what is left out of a page to keep its size: about cutters that are not shown, and about maps."""

    others: str
    maps: str


_SMALLER = ", to keep this page below {:g} MB"
_OTHERS = "Postures are stored for the cutter shown alone, to keep this page small; samples.npz has all."
_NO_MAPS = "Certified posture maps are not stored" + _SMALLER + "; postures.npz has all."


def write_html(result: Judged, _split: object, path: Path) -> None:
    """Write `review.html`.

    Raises
    ------
    CadIoError
        The kernel cannot mesh the part.
    OSError
        The file cannot be written.
    """
    path.write_bytes(page(result, maps=result.maps))


@reporting(lambda result: result.plan.effective.units)
def page(
    result: Judged,
    *,
    maps: Any = None,
    rows: NDArray[np.int64] | None = None,
    largest: int | None = None,
    triangles: int = TRIANGLES,
) -> bytes:
    """The page of a plan.

    Parameters
    ----------
    result : Result
    maps : PostureMaps, optional
        Of the cutter shown.
    rows : (m,) int, optional
        Samples that the maps are of, ascending; all by default.
    largest : int, optional
        Bytes that it may have: where it has more, first postures of the cutters that are not shown are left out, then maps.
        Default: LARGEST where there are maps of all samples, else LARGEST_WITHOUT.
    triangles : int
        To draw, about.

    Returns
    -------
    bytes
        UTF-8; the same for the same plan.
    """
    chord = _chord(result.plan, triangles)
    # Of two faces in one place the one that was judged is shown.
    scene = result.scene
    faces = render_mesh(result.part, scene.orientation.sign, most=triangles, deflection=chord, without=scene.doubles)
    atlas = atlas_of(result.samples)
    surface = surface_of(result, faces, atlas)
    box = box_of(surface, result.samples)
    spots, more = spots_of(result)
    scalars, legends = arrays.scalar_arrays(result)
    base = {
        **arrays.mesh_arrays(surface, atlas, *box),
        **arrays.sample_arrays(result, *box),
        **arrays.posture_arrays(result, result.shown),
        **scalars,
        **operation_arrays(result),
    }
    others = _together(arrays.posture_arrays(result, name) for name in result.reaches if name != result.shown)
    _, overlooked = depths(result.plan.effective.tolerance_mm, faces.deflection)
    meta = {
        **meta_of(result, surface, atlas, box, spots),
        "drawn_chord_mm": faces.deflection,
        "overlooked_mm": overlooked,
        "scalars": legends,
    }
    about = Drawing(faces.deflection, faces.missing)

    where = np.arange(len(result.samples)) if rows is None else rows
    largest = largest or (LARGEST if maps is not None and rows is None else LARGEST_WITHOUT)
    map_data, stride, remaining = _maps(maps, where, 1), 1, Omitted("", "")

    def made() -> bytes:
        entries, data = joined({**base, **others, **map_data})
        for each in meta["cutters"]:
            each["has_posture"] = f"tilt.{each['id']}" in entries
        map_meta = None
        if maps is not None:
            map_meta = {"cutter": maps.cutter, "count": len(where[::stride]) if map_data else 0, "of": len(result.samples),
                    "step_deg": round(result.plan.effective.rotation_step_deg, 9), "why": remaining.maps or None}  # fmt: skip
        shown = tables.of(result, spots, more, about, [why for why in remaining if why])
        return _rendered({**meta, "maps": map_meta, "arrays": entries}, data, shown)

    data = made()
    if len(data) > largest and others:
        others, remaining = {}, remaining._replace(others=_OTHERS)
        data = made()
    while len(data) > largest and map_data:
        available = largest - len(data) + size_of(map_data)
        stride = max(stride + 1, math.ceil(stride * size_of(map_data) / max(available, 1)))
        map_data = _maps(maps, where, stride) if stride <= _WIDEST_STRIDE else {}
        remaining = remaining._replace(maps=_why(stride, largest) if map_data else _NO_MAPS.format(largest / 1e6))
        data = made()
    return data


def _chord(plan: Plan, triangles: int) -> float:
    """The chord error, mm, with which fewer than so many triangles are to be expected, as the obstacles have theirs.

    Not below half the tolerance: whoever counts with what is drawn allows for both.
    """
    effective = plan.effective
    alike = effective.chord_error_mm * effective.obstacle_triangles / triangles
    return max(0.5 * effective.tolerance_mm, _SURELY * alike)


def _maps(maps: Any, where: NDArray[np.int64], stride: int) -> Arrays:
    return {} if maps is None else arrays.map_arrays(maps, where, np.arange(0, len(where), stride))


def _why(stride: int, largest: int) -> str:
    return f"Certified posture maps are stored for one in {stride} samples{_SMALLER.format(largest / 1e6)}; postures.npz has all."


def _together(each: Iterable[Arrays]) -> Arrays:
    return {name: array for one in each for name, array in one.items()}


def _rendered(meta: dict[str, Any], data: str, shown: dict[str, Any]) -> bytes:
    script, style = with_three(_asset("page.js")), _asset("page.css")
    return _TEMPLATE.render(
        policy=policy(script, style, "data: blob:"),
        script=Markup(script),
        style=Markup(style),
        meta=Markup(embedded(meta)),
        data=Markup(data),
        **shown,
    ).encode()


def _asset(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")


_TEMPLATE = template(_HERE / "page.html.jinja")
