"""The arrays of the review page, each under its name; `docs/review_page_data.md` says what is in them."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.figures import mm
from plan_cutters.domain.travel import tips
from plan_cutters.report.page.atlas import Atlas
from plan_cutters.report.page.encode import COARSE, FINE, Stored, halves, octahedral, placed, turned, unfolded
from plan_cutters.report.page.facts import NO_TILT, shares, tilt_and_direction
from plan_cutters.report.page.surface import Surface
from plan_cutters.report.protocol import Judged

Arrays = dict[str, Stored]
#: Instead of a setup: none serves the sample.
NO_SETUP = 255


def mesh_arrays(surface: Surface, atlas: Atlas, low: Floats, high: Floats) -> Arrays:
    """The mesh, and which sample stands where on it."""
    return {
        "mesh.position": Stored.of(placed(surface.point, low, high)),
        "mesh.normal": Stored.of((octahedral(surface.normal, COARSE) + COARSE).astype(np.uint8)),
        "mesh.triangle": Stored.of(surface.triangle),
        "mesh.texel": Stored.of(surface.place),
        "atlas.index": Stored.of(atlas.index.reshape(-1)),
    }


def sample_arrays(result: Judged, low: Floats, high: Floats) -> Arrays:
    """The samples, and what each cutter reaches of them."""
    samples, normal = result.samples, octahedral(result.samples.normal, FINE)
    number = np.uint16 if samples.face.max(initial=0) < 1 << 16 else np.uint32
    arrays: dict[str, NDArray[Any]] = {
        "sample.point": placed(np.nan_to_num(samples.point), low, high),
        "sample.normal": normal,
        "sample.direction": turned(samples.direction_max, unfolded(normal, FINE)),
        "sample.curvature": halves(samples.curvature),
        "sample.class": result.surface_class,
        "sample.face": samples.face.astype(number),
        "sample.area": halves(samples.area),
    }
    if result.inside_bodies.any():
        arrays["sample.inside"] = result.inside_bodies.astype(np.uint8)
    for name, which in result.served_in.items():
        arrays[f"setup.{name}"] = np.where(which < 0, NO_SETUP, which).astype(np.uint8)
    for name, reach in result.reaches.items():
        arrays |= {f"verdict.{name}": reach.verdict, f"reason.{name}": reach.reason}
    return {name: Stored.of(array) for name, array in arrays.items()}


def posture_arrays(result: Judged, name: str) -> Arrays:
    """The postures found for a cutter."""
    tilt, tilt_direction = tilt_and_direction(result.samples, result.reaches[name])
    arrays = {f"tilt.{name}": Stored.of(tilt), f"lean.{name}": Stored.of(tilt_direction)}
    share = shares(result.reaches[name].tilt_direction)
    if share is not None:
        arrays[f"share.{name}"] = Stored.of(share)
    if result.reaches[name].shift.any():
        arrays[f"shift.{name}"] = Stored.of(halves(_shift(result, name, tilt)))
    return arrays


def _shift(result: Judged, name: str, tilt: NDArray[np.uint16]) -> Floats:
    """Shifts (n, 3) of the postures as the page has them: at rounded tilts another end of a flank may be that which touches."""
    samples, verdicts, cutter = result.samples, result.reaches[name], result.judged(name)
    rounded = np.where(tilt == NO_TILT, np.nan, np.radians(0.01 * tilt))
    stated = replace(verdicts, tilt=rounded, shift=np.zeros_like(verdicts.shift))
    away = tips(cutter, samples.point, samples.normal, verdicts) - tips(cutter, samples.point, samples.normal, stated)
    moved = np.asarray(verdicts.shift.any(axis=1))
    return np.where(moved[:, None], away, 0.0)


def scalar_arrays(result: Judged) -> tuple[Arrays, list[dict[str, Any]]]:
    """Values at samples, and what the page is told of them."""
    curvature, scalars = result.samples.curvature, {}
    legends = [
        _scalar("curvature_max", "largest curvature", "1/mm", curvature[:, 0], array="sample.curvature", column=0),
        _scalar("curvature_min", "smallest curvature", "1/mm", curvature[:, 1], array="sample.curvature", column=1),
    ]
    for each in result.answers.radius_maps:
        key = f"largest_{each.shape}"
        # What is told must not be more than what reaches.
        scalars[f"scalar.{key}"] = Stored.of(halves(each.radius, "down"))
        legends.append(_scalar(key, f"largest {each.shape} end (radius, up to {mm(each.most)} tried)", "mm", each.radius))
    return scalars, legends


def _scalar(
    key: str, label: str, unit: str, values: Floats, *, array: str | None = None, column: int | None = None
) -> dict[str, Any]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (None, None)
    return {"key": key, "label": label, "unit": unit, "low": low, "high": high,
            "array": array or f"scalar.{key}", "column": column}  # fmt: skip
