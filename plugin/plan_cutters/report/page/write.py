"""The page as a file: data, tables and script in one, within its size."""

import base64
import hashlib
import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from numpy.typing import NDArray

from cad_io.write.drawn import Drawn, drawn
from plan_cutters.report.page import payload, tables
from plan_cutters.report.page.atlas import Atlas, atlas_of
from plan_cutters.report.page.encode import Stream
from plan_cutters.report.page.facts import spots_of
from plan_cutters.report.page.words import spot as spot_text

#: Bytes that a page may have, with posture maps and without.
LARGEST, LARGEST_WITHOUT = 8_000_000, 2_500_000
#: Triangles that are drawn, about.
_TRIANGLES = 60_000
_HERE = Path(__file__).parent


@dataclass(frozen=True, slots=True)
class Left:
    """What was left out of a page to keep its size: every how many-th map is there (0: none), whether postures of the cutters that are
    not shown are."""

    stride: int
    others: bool


def write_html(result: Any, _split: object, path: Path) -> None:
    """Write `review.html`.

    Raises
    ------
    CadIoError
        The kernel cannot mesh the part.
    OSError
        The file cannot be written.
    """
    rows = None if result.maps is None else np.arange(len(result.samples))
    path.write_bytes(page(result, maps=result.maps, rows=rows))


def page(result: Any, *, maps: Any = None, rows: NDArray[np.int64] | None = None) -> bytes:
    """The page of a plan.

    Parameters
    ----------
    result : Result
    maps : PostureMaps, optional
        Of the cutter shown.
    rows : (m,) int, optional
        Samples that the maps are of, ascending; all by default.

    Returns
    -------
    bytes
        UTF-8; the same for the same plan.
    """
    faces = drawn(result.part, result.scene.orientation.sign, most=_TRIANGLES)
    atlas = atlas_of(result.samples)
    if maps is not None and rows is None:
        rows = np.arange(len(result.samples))
    return _made(result, faces, atlas, maps, rows, Left(1 if maps is not None else 0, True))


def _made(
    result: Any, faces: Drawn, atlas: Atlas, maps: Any, rows: NDArray[np.int64] | None, left: Left
) -> bytes:  # fmt: skip
    surface = payload.surface_of(result, faces, atlas)
    box = payload.box_of(surface, result.samples)
    stream = Stream()
    payload.add_surface(stream, surface, *box)
    payload.add_samples(stream, result, atlas, *box)
    scalars = payload.add_scalars(stream, result)
    with_posture = [name for name in result.reaches if left.others or name == result.shown]
    for name in sorted(with_posture, key=lambda name: name != result.shown):
        payload.add_postures(stream, result, name)
    told = None
    if maps is not None and rows is not None:
        of = np.arange(0, len(rows), left.stride) if left.stride else np.zeros(0, np.int64)
        payload.add_maps(stream, maps, rows, of)
        told = {"cutter": maps.cutter, "count": len(of), "of": len(result.samples),
                "step_deg": result.plan.effective.rotation_step_deg, "why": None}  # fmt: skip
    spots, more = spots_of(result)
    meta = payload.facts(
        result, surface, atlas, box, spots, [spot_text(each.witness) for each in spots], faces.deflection
    )
    for each in meta["cutters"]:
        each["has_posture"] = each["id"] in with_posture
    meta |= {"scalars": scalars, "maps": told, "arrays": stream.entries}
    script, style = _asset("page.js"), _asset("page.css")
    policy = (f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(style)}'; img-src data: blob:; "
              "base-uri 'none'; form-action 'none'")  # fmt: skip
    shown = tables.of(result, spots, more)
    text = _TEMPLATE.render(policy=policy, script=script, style=style, meta=embedded(meta), data=stream.text(), **shown)
    return text.encode()


def embedded(value: Any) -> str:
    """JSON that may stand in a page: nothing in it ends the element or begins another one."""
    text = json.dumps(value, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return re.sub("[<>&]", lambda found: f"\\u{ord(found[0]):04x}", text)


def plain(value: Any) -> Any:
    """A text without characters that have no place in a page: controls, halves of pairs; changed to a sign for that."""
    if not isinstance(value, str) or hasattr(value, "__html__"):
        return value
    return re.sub("[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]", "\ufffd", value)


def _asset(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8").replace("\r\n", "\n")


def _hash(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


_TEMPLATE = jinja2.Environment(
    loader=jinja2.FileSystemLoader(_HERE), autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    finalize=plain,
).get_template("page.html.jinja")  # fmt: skip
