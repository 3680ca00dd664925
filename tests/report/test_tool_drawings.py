"""Drawings read back: to scale, all dimensions there, no words over others, whatever the names are."""

import json
import math
import re
from itertools import combinations
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, Holder, Segment
from plan_cutters.domain.outline import outline
from plan_cutters.domain.standard_tools import builtin
from plan_cutters.report.drawing.posture_map import printable
from plan_cutters.report.drawing.tool import draw, length
from tests.support.places import DATA
from tests.support.tool_reference import KINDS, Reference, random_cutter

CAT40 = DATA / "tools/autodesk_api_doc_10mm_flat_cat40.fusion.json"
SVG = "{http://www.w3.org/2000/svg}"
SIX = "R19.05:25.019L3.7592+R25.019L21.2344+R19.939L4.4704+R19.939:22.225L2.286+R22.225L10.795+R22.225:23.495L1.27"
TOOLS = {
    "bare": Cutter.parse("R6L80"),
    "bull": Cutter.bull(radius=6, corner_radius=1, length=80, flutes=20, neck=Segment(5.5, 40), shank_radius=6, holder=SIX),
    "small ball": Cutter.ball(radius=0.5, length=20, flutes=3, neck=Segment(0.45, 3, 1.6), shank_radius=1.6, holder="R8L20"),
    "taper ball": Cutter.ball(radius=1, length=60, taper=math.radians(5), flutes=25, shank_radius=4, holder="R12L40"),
    "dovetail": Cutter.flat(radius=8, length=50, taper=math.radians(-15), flutes=8, neck=Segment(5, 6), shank_radius=6),
    "lollipop": Cutter.lollipop(radius=5, neck_radius=2.5, length=60, holder="R12L40"),
    "oval": Cutter.barrel(radius=5, flank_radius=85, tip_radius=2, length=60, flutes=25, shank_radius=5, allowance=0.25),
    "barrel": Cutter.barrel(radius=5, flank_radius=85, height=12, length=60, flutes=25, clearance=0.75),
    "lens": Cutter.lens(radius=5, bottom_radius=20, corner_radius=1, length=50, flutes=15, shank_radius=5),
    "form": Cutter.form([(0, 0), (3, 0), (3, 2.5), (6, 4.5), (6, 6), (2.5, 6), (3.5, 12)], length=50, holder="R12L40"),
    "long": Cutter.flat(radius=40, length=250, flutes=60, shank_radius=20, holder="R60L100+R80L30+R63L60"),
}  # fmt: skip


def read(svg):
    root = ET.fromstring(svg)
    assert root.tag == f"{SVG}svg"
    return root


def words(root):
    return [text.text for text in root.iter(f"{SVG}text")]


def size(root):
    """On paper, mm; the unit of what is drawn is the mm."""
    width, height = (float(root.get(side).removesuffix("mm")) for side in ("width", "height"))
    assert root.get("viewBox").split() == ["0", "0", *(root.get(side).removesuffix("mm") for side in ("width", "height"))]
    return width, height


def check_a4(root):
    width, height = size(root)
    assert width <= 210
    assert height <= 297


def stated(root):
    """mm of tool a mm of paper, as people read it."""
    (said,) = {match[0] for text in words(root) if (match := re.findall(r"^scale (\S+), in mm$", text))}
    paper, tool = map(float, said.split(":"))
    return tool / paper


def silhouettes(root):
    """The corners of the parts' silhouettes on paper, mm: what they are written by, without the bulge of arcs."""
    found = {}
    for path in root.iter(f"{SVG}path"):
        if (path.get("class") or "").startswith("part "):
            pairs = re.findall(r"(-?[\d.e-]+) (-?[\d.e-]+)(?=[MLAZ]|$)", path.get("d"))
            found[path.get("class").removeprefix("part ")] = np.array(pairs, float)
    return found


def boxes(root):
    """Of each text its words and the box they take, by a measure of its own: 0.58 of the height a letter (bold: 0.64)."""
    found = []
    for text in root.iter(f"{SVG}text"):
        x, y, high = (float(text.get(name)) for name in ("x", "y", "font-size"))
        wide = len(text.text) * high * (0.64 if text.get("font-weight") else 0.58)
        left = {"start": 0.0, "middle": -0.5 * wide, "end": -wide}[text.get("text-anchor")]
        if text.get("transform"):
            assert text.get("transform") == f"rotate(-90 {text.get('x')} {text.get('y')})"
            box = (x - 0.75 * high, y - left - wide, x + 0.2 * high, y - left)
        else:
            box = (x + left, y - 0.75 * high, x + left + wide, y + 0.2 * high)
        found.append((text.text, box))
    return found


def check_words_apart(root):
    width, height = size(root)
    found = boxes(root)
    for said, (a, b, c, d) in found:
        assert min(a, b, width - c, height - d) > 4, f"{said!r} is off the sheet"
    for (one, (a, b, c, d)), (other, (e, f, g, h)) in combinations(found, 2):
        assert c <= e or g <= a or d <= f or h <= b, f"{one!r} lies over {other!r}"


@pytest.mark.parametrize("cutter", [*TOOLS.values(), *builtin()], ids=[*TOOLS, *(c.id for c in builtin())])
def test_what_is_drawn_is_to_scale_on_a4_and_legible(cutter):
    root = read(draw(cutter))
    check_a4(root)
    scale = stated(root)
    drawn, line = silhouettes(root), outline(cutter)
    assert tuple(drawn) == line.parts
    middle = 0.5 * (drawn["flutes"][:, 0].min() + drawn["flutes"][:, 0].max())
    tip = drawn["flutes"][:, 1].max()
    for part in line.parts:
        # Corners of the drawn silhouette are those of the outline, times the scale that is stated.
        ends = np.array([end for s in line.of(part) for end in (s.start, s.end)])
        assert scale * np.ptp(drawn[part][:, 0]) == pytest.approx(2 * ends[:, 0].max(), abs=2e-3 * scale)
        got = np.unique(np.round(scale * (tip - drawn[part][:, 1]), 2))
        assert got == pytest.approx(np.unique(np.round(ends[:, 1], 2)), abs=0.011)
        assert np.abs(np.abs(drawn[part][:, 0] - middle).max() * scale - ends[:, 0].max()) < 2e-3 * scale
    if cutter.shape == "end" and not cutter.taper:
        assert scale * np.ptp(drawn["flutes"][:, 0]) == pytest.approx(2 * cutter.radius, abs=1e-3)
    check_words_apart(root)


@pytest.mark.parametrize("name", TOOLS)
def test_all_dimensions_are_there(name):
    cutter = TOOLS[name]
    root = read(draw(cutter))
    all_words = " ".join(words(root))
    numbers = set(re.findall(r"Ø?R?[\d.]+", all_words))
    assert f"Ø{length(2 * cutter.radius)}" in numbers
    assert length(cutter.length) in numbers
    stages = [stage for _, _, stage in cutter.stages]
    for stage in stages:
        assert {f"Ø{length(2 * stage.radius)}", f"Ø{length(2 * stage.upper_radius)}", length(stage.length)} <= numbers
    if stages:
        assert length(cutter.stages[0][1]) in numbers, "the length of the flutes"
    if cutter.corner_radius:
        assert f"R{length(cutter.corner_radius)}" in numbers
    if cutter.arc_radius:
        assert f"R{length(cutter.arc_radius)}" in numbers
    if cutter.taper:
        assert f"{length(abs(math.degrees(cutter.taper)))}° (half angle)" in all_words
    for r, h in cutter.outline:
        assert f"Ø{length(2 * r)} at {length(h)}" in words(root)
    if cutter.holder:
        assert f"overall {length(Reference(cutter).end)}" in all_words
        assert f"stick-out {length(cutter.length)}" in all_words
        assert "no holder" not in all_words
    else:
        assert "no holder" in all_words
    for asked, value in (("allowance", cutter.allowance), ("clearance", cutter.clearance)):
        assert (f"{asked} {length(value)}" in all_words) if value else (asked not in all_words)


def test_parts_are_told_apart_without_colour_and_named():
    root = read(draw(TOOLS["bull"]))
    paints = [p.get("fill") for p in root.iter(f"{SVG}path") if "part" in (p.get("class") or "")]
    assert len(paints) == len(set(paints)) == 4
    assert {"flutes", "neck", "shank", "holder"} <= {text.split()[0] for text in words(root)}


HOSTILE = (
    '<script>alert("1")</script>',
    "]]>&lt;!--",
    "\x00\x07\x1b[31m\ufffe\ud800 bell",
    "line\nbreak\ttab",
    "\u202egnp.exe\u2066",
    "W" * 500,
    "刀具 直径十二毫米 " * 20,
    "' onload='x()",
)


@pytest.mark.parametrize("name", HOSTILE)
def test_names_from_files_are_words_and_no_more(name):
    cutter = Cutter.flat(radius=6, length=80, name=name, holder=Holder((Segment(20, 30),), name=name))
    svg = draw(cutter)
    root = read(svg.encode("utf-8"))
    tags = {each.tag.removeprefix(SVG) for each in root.iter()}
    assert tags <= {"svg", "title", "rect", "path", "text"}
    assert not [key for each in root.iter() for key in each.attrib if key.startswith("on") or "href" in key]
    assert not re.search("[\x00-\x09\x0b-\x1f\u202a-\u202e\u2066-\u2069\ufffe]", svg)
    # A lone surrogate is none of a cutter's name any more.
    assert root.find(f"{SVG}title").text == printable(cutter.name, 50)
    check_words_apart(root)


def test_a_name_that_can_be_read_is_kept():
    assert printable("Fräser Ø12 – 刀具") == "Fräser Ø12 – 刀具"
    assert printable("a\x00b\u202ec  d\n") == "a\ufffdb\ufffdc d"


def test_what_does_not_fit_is_reduced_to_the_next_standard_scale():
    def scale(cutter):
        return stated(read(draw(Cutter.parse(cutter))))

    assert [scale(f"R5L{high}") for high in (100, 200, 300, 440, 1000, 2000, 4000)] == [1, 1, 2, 2, 5, 10, 20]
    assert [scale(f"R{wide}L50") for wide in (20, 40, 100, 200)] == [1, 1, 2, 5]


def test_as_many_stages_as_can_be_judged_are_told_apart():
    many = Holder(tuple(Segment(15 + i % 3, 1.5 + 0.01 * i) for i in range(17)))
    root = read(draw(Cutter.flat(radius=5, length=50, flutes=20, holder=many)))
    check_words_apart(root)
    assert sum(text.startswith("holder ") for text in words(root)) >= 17
    assert "holder 17 Ø32 × 1.66" in words(root)


def test_forms_of_many_points_have_a_count_of_the_rest():
    points = [(0, 0), *((3 + math.sin(i), 0.25 * i) for i in range(50))]
    root = read(draw(Cutter.form(points, length=80)))
    check_words_apart(root)
    assert "form of 51 points: Ø at height" in words(root)
    assert "… and 39 more" in words(root)


@pytest.mark.parametrize("path", [CAT40], ids=lambda path: path.name)
def test_a_real_holder(path):
    tool = json.loads(path.read_text())["data"][0]
    segments = tool["holder"]["segments"]
    holder = Holder(tuple(Segment(0.5 * s["lower-diameter"], s["height"], 0.5 * s["upper-diameter"]) for s in segments),
                    tool["holder"]["description"])  # fmt: skip
    geometry = tool["geometry"]
    cutter = Cutter.flat(radius=geometry["DC"] / 2, length=geometry["LB"], flutes=geometry["LCF"], holder=holder)
    root = read(draw(cutter, name=tool["description"]))
    check_words_apart(root)
    assert stated(root) == 1
    assert np.ptp(silhouettes(root)["holder"][:, 0]) == pytest.approx(63.5508, abs=1e-3)
    said = " ".join(words(root))
    for segment in segments:
        assert length(segment["height"]) in said
        assert f"Ø{length(segment['lower-diameter'])}" in said
    assert "Maritool CAT40-ER32-2.35" in said


@settings(deadline=None)
@given(st.sampled_from(KINDS), st.integers(0, 1 << 32))
def test_any_cutter_is_drawn(kind, seed):
    cutter = random_cutter(np.random.default_rng(seed), kind)
    root = read(draw(cutter))
    check_a4(root)
    assert tuple(silhouettes(root)) == outline(cutter).parts
    check_words_apart(root)


@settings(deadline=None)
@given(st.floats(-6, 6), st.floats(-6, 6), st.floats(-6, 6), st.floats(0.0, 1.0))
def test_any_size_is_drawn(radius, high, nose, corner):
    radius = 10.0**radius
    cutter = Cutter(radius, 10.0**high, corner * min(radius, 10.0**high), holder=Holder((Segment(radius + 10.0**nose, 3.0),)))
    root = read(draw(cutter))
    check_a4(root)
    assert not re.search("nan|inf", draw(cutter))
