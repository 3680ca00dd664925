"""The picture of a plan, taken out of the review page beside it: triangles, samples and verdicts as they were drawn there."""

import base64
import hashlib
import json
import re
import zlib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any, NamedTuple

from plan_cutters.plan_file.model import Plan

#: Data that a comparison shows nothing of: postures and their maps, operations, other colours, and the frames of samples.
_OMITTED = re.compile(
    r"(tilt|lean|maps|scalar|operation|operation_lean|setup|reason)\.|sample\.(point|normal|direction|curvature)$"
)
_FORMAT = 1
_AGAIN = "plan the part again with --formats json,html"


class Picture(NamedTuple):
    """Hold what the page draws of a plan: `meta` and the stream of `docs/review_page_data.md`; or why there is none."""

    meta: dict[str, Any] | None
    data: str
    why: str


def picture_of(path: Path, plan: Plan) -> Picture:
    """The picture of a plan.

    Parameters
    ----------
    path : Path
        The plan's file.
    plan : Plan
        What was read of it.
    """
    entry = plan.files.get("html")
    name = entry.name if entry else "review.html"
    page = path.parent / name
    try:
        data = page.read_bytes()
    except OSError:
        return _none(f"there is no {name} in the folder of the plan: {_AGAIN}")
    if entry and hashlib.sha256(data).hexdigest() != entry.sha256:
        return _none(f"{name} is not the one that was written with the plan: {_AGAIN}")
    try:
        picture = _picture(data.decode("utf-8"))
    except (ValueError, LookupError, TypeError, AttributeError, zlib.error):
        return _none(f"{name} cannot be read: {_AGAIN}")
    if picture is None:
        return _none(f"{name} was made by another version of the program: {_AGAIN}")
    if _shows(picture) != (plan.part.sha256, {face.id for face in plan.faces}):
        return _none(f"{name} is of another part: {_AGAIN}")
    return picture


def _shows(picture: Picture) -> tuple[str | None, set[str]]:
    assert picture.meta is not None
    return picture.meta["part"]["sha256"], {each["id"] for each in picture.meta["faces"]}


def _none(why: str) -> Picture:
    return Picture(None, "", why)


def _picture(text: str) -> Picture | None:
    """The picture that a page holds; None where its data have another form."""
    elements = _Elements(text).texts
    meta, stream = json.loads(elements["meta"]), elements["data"]
    if meta["format"] != _FORMAT:
        return None
    whole = {name: entry for name, entry in meta["arrays"].items() if not _OMITTED.match(name)}
    end = max(entry["offset"] + entry["bytes"] for entry in whole.values())
    inflated = zlib.decompressobj(-15).decompress(base64.b64decode(stream, validate=True), end)
    if len(inflated) < end or min(min(entry["offset"], entry["bytes"]) for entry in whole.values()) < 0:
        raise ValueError("the stream ends too soon")
    packed, entries, offset = zlib.compressobj(6, zlib.DEFLATED, -15), {}, 0
    pieces = []
    for name, entry in whole.items():
        entries[name] = {**entry, "offset": offset}
        offset += entry["bytes"]
        pieces.append(packed.compress(inflated[entry["offset"] : entry["offset"] + entry["bytes"]]))
    data = base64.b64encode(b"".join([*pieces, packed.flush()])).decode("ascii")
    cutters = [{"id": each["id"], "name": each["name"]} for each in meta["cutters"]]
    if any(f"verdict.{each['id']}" not in entries for each in cutters):
        raise LookupError("a cutter has no verdicts")
    reduced = {**meta, "cutters": cutters, "spots": [], "scalars": [], "operations": None, "maps": None, "arrays": entries}
    return Picture(reduced, data, "")


class _Elements(HTMLParser):
    """Texts of the script elements of a page, by their ids: what the page draws stands in two of them."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.texts: dict[str, str] = {}
        self._open: str | None = None
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._open = dict(attrs).get("id") if tag == "script" else None

    def handle_data(self, data: str) -> None:
        if self._open:
            self.texts[self._open] = self.texts.get(self._open, "") + data

    def handle_endtag(self, tag: str) -> None:
        self._open = None
