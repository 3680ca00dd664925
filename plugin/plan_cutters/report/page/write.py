"""The page as a file: data, tables and script in one, within its size."""

from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from cad_io.write.render_mesh import render_mesh
from plan_cutters.domain.figures import reporting
from plan_cutters.domain.verdicts import depths
from plan_cutters.files.markup import embedded, policy, template, with_three
from plan_cutters.report.page import arrays, tables
from plan_cutters.report.page.arrays import Arrays, Stored, atlas_of, box_of, joined, spots_of, surface_of
from plan_cutters.report.page.steps import step_of
from plan_cutters.report.page.tables import Drawing, meta_of, operation_arrays
from plan_cutters.report.protocol import Judged

#: Bytes that a page may have.
LARGEST = 2_500_000
#: Triangles that are drawn, about.
TRIANGLES = 60_000
#: The kernel's triangles are up to so many times more than the obstacles' of the same chord error (2.5 times was found). A second
#: mesh takes longer than somewhat fewer triangles do harm.
_SURELY = 3.0
_HERE = Path(__file__).parent


_OTHERS = "Postures are stored for the cutter shown alone, to keep this page small; samples.npz has all."


def write_html(result: Judged, _split: object, path: Path) -> None:
    """Write `review.html`; a CadIoError where the kernel cannot mesh the part."""
    path.write_bytes(page(result))


@reporting(lambda result: result.plan.effective.units)
def page(result: Judged, *, largest: int = LARGEST, triangles: int = TRIANGLES) -> bytes:
    """The page of a plan, UTF-8; the same for the same plan.

    `largest`: bytes that it may have; where it has more, postures of the cutters that are not shown are left out. `triangles`:
    to draw, about.
    """
    effective = result.plan.effective
    # With this chord error, mm, fewer triangles than so many are to be expected, as the obstacles have theirs. Not below half the
    # tolerance: whoever counts with what is drawn allows for both.
    alike = effective.chord_error_mm * effective.obstacle_triangles / triangles
    chord = max(0.5 * effective.tolerance_mm, _SURELY * alike)
    # Of two faces in one place the one that was judged is shown.
    scene = result.scene
    faces = render_mesh(result.part, scene.orientation.sign, most=triangles, deflection=chord, without=scene.doubles)
    atlas = atlas_of(result.samples)
    surface = surface_of(result, faces, atlas)
    box = box_of(surface, result.samples)
    spots, more = spots_of(result)
    scalars, legends = arrays.scalar_arrays(result)
    number = step_of(result)
    base = {
        **arrays.mesh_arrays(surface, atlas, *box),
        **arrays.sample_arrays(result, *box),
        **arrays.posture_arrays(result, result.shown),
        **scalars,
        **operation_arrays(result),
        "step": Stored.of(number.astype(np.uint8 if number.max(initial=0) < 256 else np.uint16)),
    }
    others = Arrays()
    for name in result.reaches:
        others |= arrays.posture_arrays(result, name) if name != result.shown else {}
    _, overlooked = depths(effective.tolerance_mm, faces.deflection)
    meta = {
        **meta_of(result, surface, atlas, box, spots, number),
        "drawn_chord_mm": faces.deflection,
        "overlooked_mm": overlooked,
        "scalars": legends,
    }
    about = Drawing(faces.deflection, faces.missing)

    def made(others: Arrays, omitted: list[str]) -> bytes:
        entries, data = joined({**base, **others})
        for each in meta["cutters"]:
            each["has_posture"] = f"tilt.{each['id']}" in entries
        return _rendered({**meta, "arrays": entries}, data, tables.of(result, spots, more, about, omitted))

    data = made(others, [])
    return made({}, [_OTHERS]) if len(data) > largest and others else data


def _rendered(meta: dict[str, Any], data: str, shown: dict[str, Any]) -> bytes:
    script, style = ((_HERE / name).read_text(encoding="utf-8") for name in ("page.js", "page.css"))
    script = with_three(script)
    return _TEMPLATE.render(
        policy=policy(script, style, "data: blob:"), script=Markup(script), style=Markup(style), meta=Markup(embedded(meta)),
        data=Markup(data), **shown,
    ).encode()  # fmt: skip


_TEMPLATE = template(_HERE / "page.html.jinja")
