"""A reader of review pages that shares no code with their writer: elements by html.parser, arrays as the docs describe them."""

import base64
import io
import json
import zlib
from html.parser import HTMLParser

import numpy as np

#: Elements that have no end.
_VOID = {"meta", "rect", "br", "link", "img", "input"}


class Page(HTMLParser):
    """The elements of a page: (tag, attributes, path of tags, text that it holds itself)."""

    def __init__(self, data):
        super().__init__()
        self.elements, self.open = [], []
        self.feed(data.decode("utf-8"))
        self.close()
        assert not self.open, f"never closed: {[tag for tag, _ in self.open]}"
        (meta,) = (text for tag, a, text in self.elements if tag == "script" and a.get("id") == "meta")
        (stream,) = (text for tag, a, text in self.elements if tag == "script" and a.get("id") == "data")
        self.meta = json.loads(meta)
        self.stream = zlib.decompress(base64.b64decode(stream, validate=True), -15)

    def handle_starttag(self, tag, attributes):
        element = [tag, dict(attributes), ""]
        self.elements.append(element)
        if tag not in _VOID:
            self.open.append((tag, element))

    def handle_startendtag(self, tag, attributes):
        self.elements.append([tag, dict(attributes), ""])

    def handle_endtag(self, tag):
        assert self.open, f"</{tag}> ends nothing"
        assert self.open[-1][0] == tag, f"</{tag}> ends {self.open[-1][0]}"
        self.open.pop()

    def handle_data(self, text):
        # What a reader sees of an element is what all within it say.
        for _, element in self.open:
            element[2] += text

    def of(self, tag, **wanted):
        """Texts of the elements with a tag and attributes."""
        return [" ".join(text.split()) for found, a, text in self.elements if found == tag and wanted.items() <= a.items()]

    def array(self, name):
        entry = self.meta["arrays"][name]
        raw = self.stream[entry["offset"] : entry["offset"] + entry["bytes"]]
        return decoded(raw, entry["dtype"], entry["shape"], entry["filter"])

    def points(self, name):
        low, high = (np.array(self.meta["part"][end]) for end in ("low", "high"))
        return low + self.array(name) / 65535 * (high - low)

    def normals(self):
        return np.array([unfold(x / 32767, y / 32767) for x, y in self.array("sample.normal").tolist()])

    def directions(self):
        """`direction_max` of the samples."""
        found = []
        for n, q in zip(self.normals(), self.array("sample.direction").tolist(), strict=True):
            a = np.zeros(3)
            a[[abs(x) for x in n].index(min(abs(x) for x in n))] = 1
            t1 = np.cross(a, n)
            t1 /= np.linalg.norm(t1)
            angle = q * np.pi / 32767
            found.append(np.cos(angle) * t1 + np.sin(angle) * np.cross(n, t1))
        return np.array(found)

    def axes(self, cutter):
        """Tool axes of the postures found; nan where there is none."""
        tilt = self.array(f"tilt.{cutter}").astype(float)
        tilt[tilt == 65535] = np.nan
        t, w = np.radians(tilt / 100)[:, None], np.radians(self.array(f"lean.{cutter}") / 100)[:, None]
        n, d = self.normals(), self.directions()
        return np.cos(t) * n + np.sin(t) * (np.cos(w) * d + np.sin(w) * np.cross(n, d))


def unfold(x, y):
    """The unit vector of octahedral coordinates."""
    z = 1 - abs(x) - abs(y)
    if z < 0:
        x, y = (1 - abs(y)) * (1 if x >= 0 else -1), (1 - abs(x)) * (1 if y >= 0 else -1)
    return np.array([x, y, z]) / np.sqrt(x * x + y * y + z * z)


def decoded(raw, dtype, shape, filter):
    """An array from its bytes, number by number."""
    size, count = int(dtype[1]), int(np.prod(shape))
    assert len(raw) == size * count
    top = 1 << 8 * size
    planes = [raw[k * count : (k + 1) * count] for k in range(size)]
    numbers = [sum(plane[i] << 8 * k for k, plane in enumerate(planes)) for i in range(count)]
    if filter.endswith("_z"):
        numbers = [(n >> 1) ^ (top - 1 if n & 1 else 0) for n in numbers]
    rows = shape[0]
    columns = [numbers[k : k + rows] for k in range(0, count, rows)] if count else []
    for _ in range({"": 0, "delta": 1, "delta2": 2}[filter.removesuffix("_z")]):
        for column in columns:
            for i in range(1, len(column)):
                column[i] = (column[i] + column[i - 1]) % top
    flat = np.array(columns, dtype=f"<u{size}").reshape(len(columns), rows).T
    return np.ascontiguousarray(flat).view(f"<{dtype}").reshape(shape)


def picture(page):
    """The canvas as it is seen: (height, width, 3) bytes."""
    from PIL import Image

    return np.asarray(Image.open(io.BytesIO(page.locator("#frame").screenshot())).convert("RGB")).astype(int)
