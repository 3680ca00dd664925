"""The data of the review page: read back by a decoder of its own, and held against the plan that it shows."""

import base64
import hashlib
import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of

from cad_io.arrays import FaceGrid
from cad_io.part import Part
from plan_cutters import plan
from plan_cutters.domain.posture import tilt_direction
from plan_cutters.report.page import write
from plan_cutters.report.page.arrays import COARSE, FILTERS, FINE, Stored, filtered, halves, joined, octahedral, sheet_of
from tests.support.places import ROOT
from tests.support.review_page import Page, decoded, unfold


def page(result, *, triangles=4000, **more):
    """A page of few triangles: they take the time."""
    return write.page(result, triangles=triangles, **more)


DTYPES = {"u1": np.uint8, "u2": np.uint16, "u4": np.uint32, "i2": np.int16, "i4": np.int32, "f2": np.float16}


@st.composite
def tables(draw):
    dtype = DTYPES[draw(st.sampled_from(sorted(DTYPES)))]
    shape = draw(st.one_of(st.tuples(st.integers(0, 30)), st.tuples(st.integers(0, 12), st.integers(1, 4))))
    bits = np.dtype(f"u{np.dtype(dtype).itemsize}")
    return draw(arrays_of.arrays(bits, shape)).view(dtype)


@given(tables(), st.sampled_from(FILTERS))
@settings(deadline=None)
def test_every_filter_gives_back_every_bit(array, name):
    word = next(word for word, kind in DTYPES.items() if kind == array.dtype)
    back = decoded(filtered(array, name), word, array.shape, name)
    assert back.tobytes() == array.tobytes()


@given(st.lists(tables(), min_size=1, max_size=4))
@settings(deadline=None, max_examples=30)
def test_arrays_stand_one_after_the_other_in_one_stream(given):
    import zlib

    stream = {f"a{i}": Stored.of(array) for i, array in enumerate(given)}
    entries, text = joined(stream)
    data = zlib.decompress(base64.b64decode(text), -15)
    assert len(data) == sum(entry["bytes"] for entry in entries.values())
    for i, array in enumerate(given):
        e = entries[f"a{i}"]
        back = decoded(data[e["offset"] : e["offset"] + e["bytes"]], e["dtype"], e["shape"], e["filter"])
        assert back.tobytes() == array.tobytes()


@given(arrays_of.arrays(float, (20, 3), elements=st.floats(-1, 1).map(lambda x: round(x, 6))))
@settings(deadline=None)
def test_normals_come_back(vector):
    vector = vector[np.linalg.norm(vector, axis=1) > 1e-3]
    vector /= np.linalg.norm(vector, axis=1)[:, None]
    for steps, most in ((FINE, 1e-4), (COARSE, 0.02)):
        for n, (x, y) in zip(vector, octahedral(vector, steps).tolist(), strict=True):
            assert np.linalg.norm(unfold(x / steps, y / steps) - n) < most


@given(arrays_of.arrays(float, 30, elements=st.floats(allow_nan=True, allow_infinity=True)))
def test_sixteen_bits_round_to_the_asked_side(values):
    known = np.isfinite(values) & (np.abs(values) < 65504)
    assert (halves(values, "down")[known].astype(float) <= values[known]).all()
    nearest = halves(values)[known].astype(float)
    assert (np.abs(nearest - values[known]) <= np.maximum(2.0**-11 * np.abs(values[known]), 2.0**-25)).all()
    assert np.array_equal(np.isnan(halves(values, "down")), np.isnan(values))


@pytest.mark.parametrize("power", [1.0, 2.0, 4.0])
def test_each_line_of_an_uneven_grid_has_a_texel_and_each_texel_the_nearest_line(power):
    u = np.linspace(0.5, 1, 12) ** power
    v = np.linspace(0, 1, 5)
    index = np.arange(60, dtype=np.int32).reshape(12, 5)
    sheet = sheet_of(FaceGrid(1, u, v, index, False, False, (u[0], u[-1], 0.0, 1.0)))
    assert sheet.ends == ((u[0], u[-1]), (0.0, 1.0))
    assert set(sheet.index[:, 0]) == set(index[:, 0])
    at = np.linspace(u[0], u[-1], len(sheet.index))
    for x, row in zip(at, sheet.index[:, 0], strict=True):
        assert np.abs(u[row // 5] - x) == pytest.approx(np.abs(u - x).min(), abs=1e-12)


def test_an_atlas_that_is_too_large_has_coarser_sheets_then_lists(monkeypatch):
    from plan_cutters.report.page import arrays as module
    from tests.support.cad_parts import drilled

    samples = plan(Part(drilled()), cutters=["R2L30"], grid=9, area_budget=0, faces="all").samples
    usual = module.atlas_of(samples)
    assert all(sheet.ends for sheet in usual.sheets.values())
    monkeypatch.setattr(module, "_LONGEST", 14)
    small = module.atlas_of(samples)
    assert small.index.shape[1] <= 14
    assert not all(sheet.ends for sheet in small.sheets.values())
    assert sorted(small.index[small.index >= 0].tolist()) == list(range(len(samples)))


def test_what_is_not_finite_is_null():
    assert write.embedded({"a": [float("nan"), (1.5, float("-inf"))]}) == '{"a":[null,[1.5,null]]}'
    assert write.embedded("</script>&\u2028") == '"\\u003c/script\\u003e\\u0026\\\\u2028"'


@pytest.fixture(scope="module")
def valley():
    result = plan("samples/peaks_and_valleys.step", cutters=["R12L60", "R6L80", "R2L30"], grid=21, area_budget=0,
                  rotation_step=math.radians(30))  # fmt: skip
    return result, Page(page(result))


@pytest.fixture(scope="module")
def rounded():
    """A rod with a hole across: seams, planes, trims; faces small and large."""
    from tests.support.cad_parts import drilled

    result = plan(Part(drilled()), cutters=["R2L30"], holder="R9L20", spacing=1.7, area_budget=0, faces="all",
                  fixtures=["box:5,6,7@40,0,0"], machine="tilt:60")  # fmt: skip
    return result, Page(page(result))


@pytest.mark.parametrize("which", ["valley", "rounded"])
def test_samples_come_back(which, request):
    result, read = request.getfixturevalue(which)
    samples = result.samples
    size = np.subtract(read.meta["part"]["high"], read.meta["part"]["low"])
    assert np.abs(read.points("sample.point") - samples.point).max() <= 0.51 / 65535 * size.max()
    assert np.abs(read.normals() - samples.normal).max() < 1e-4
    assert np.abs(read.directions() - samples.direction_max).max() < 3e-4
    assert read.array("sample.face").tolist() == samples.face.tolist()
    assert np.allclose(read.array("sample.curvature"), samples.curvature, rtol=1e-3, atol=1e-4)
    assert np.allclose(read.array("sample.area"), samples.area, rtol=1e-3)
    for name, reach in result.reaches.items():
        assert read.array(f"verdict.{name}").tolist() == reach.verdict.tolist()
        assert read.array(f"reason.{name}").tolist() == reach.reason.tolist()
        axes = read.axes(name)
        assert np.array_equal(np.isnan(axes[:, 0]), ~reach.reached)
        there = reach.reached
        assert there.any()
        assert np.abs(axes[there] - reach.axis[there]).max() < 5e-4


def test_axes_are_those_of_tilt_and_rotation(valley):
    result, read = valley
    reach, samples = result.reaches["R6L80"], result.samples
    at = np.flatnonzero(reach.reached & (reach.tilt > 0.01))
    f = tilt_direction(samples.normal[at], samples.direction_max[at], np.radians(read.array("lean.R6L80")[at] / 100))
    assert len(at)
    assert np.abs(f - reach.tilt_direction[at]).max() < 2e-4


@pytest.mark.parametrize("which", ["valley", "rounded"])
def test_the_drawn_mesh_is_the_part_seen_from_outside(which, request):
    result, read = request.getfixturevalue(which)
    point, triangle = read.points("mesh.position"), read.array("mesh.triangle")
    normal = np.array([unfold((x - 127) / 127, (y - 127) / 127) for x, y in read.array("mesh.normal").astype(int)])
    facet = np.cross(*(point[triangle[:, k]] - point[triangle[:, 0]] for k in (1, 2)))
    assert ((facet[:, None] * normal[triangle]).sum(-1) > 0).all()
    after = 0
    for face, info in zip(read.meta["faces"], result.part.faces, strict=True):
        mine = slice(face["start"], face["start"] + face["count"])
        assert face["start"] == after
        after += face["count"]
        assert 0.5 * np.linalg.norm(facet[mine], axis=1).sum() == pytest.approx(info.area, rel=0.03)
        assert (face["id"], face["target"]) == (info.id, True)
    for standing, entry in zip(result.scene.surround().fixtures, read.meta["fixtures"], strict=True):
        assert (entry["name"], entry["start"], entry["count"]) == (standing.name, after, len(standing.shown))
        after += entry["count"]
    assert after == len(triangle)


@pytest.mark.parametrize("which", ["valley", "rounded"])
def test_each_place_of_a_face_has_the_colour_of_a_sample_beside_it(which, request):
    result, read = request.getfixturevalue(which)
    width, height = read.meta["atlas"]
    atlas = read.array("atlas.index").reshape(height, width)
    texel, triangle, point = read.array("mesh.texel") / 16, read.array("mesh.triangle"), read.points("mesh.position")
    share = np.random.default_rng(5).dirichlet(np.ones(3), 400)
    for face in read.meta["faces"]:
        pick = face["start"] + np.arange(len(share)) % face["count"]
        where = (share[:, :, None] * texel[triangle[pick]]).sum(1)
        at = (share[:, :, None] * point[triangle[pick]]).sum(1)
        column, row = np.floor(where + 0.5).astype(int).T
        sample = atlas[row, column]
        assert (sample >= 0).all()
        assert (result.samples.face[sample] == face["number"]).all()
        mine = result.samples.point[result.samples.face == face["number"]]
        nearest = np.linalg.norm(at[:, None] - mine, axis=2).min(axis=1)
        away = np.linalg.norm(at - result.samples.point[sample], axis=1)
        assert (away <= nearest + 0.75 * result.samples.max_gap).all()
    beside = triangle[sum(f["count"] for f in read.meta["faces"]) :]
    assert (read.array("mesh.texel")[beside] == 65535).all()


def test_a_face_without_a_grid_has_one_sample_a_triangle(rounded):
    from dataclasses import replace

    result, _ = rounded
    gridless = replace(result, ready=replace(result.ready, samples=replace(result.samples, grids=())))
    read = Page(page(gridless))
    width, height = read.meta["atlas"]
    atlas = read.array("atlas.index").reshape(height, width)
    assert sorted(atlas[atlas >= 0].tolist()) == list(range(len(result.samples)))
    texel, triangle = read.array("mesh.texel"), read.array("mesh.triangle")
    for face in read.meta["faces"]:
        mine = triangle[face["start"] : face["start"] + face["count"]]
        assert (texel[mine] == texel[mine[:, :1]]).all()
        column, row = (texel[mine[:, 0]] // 16).T
        assert (result.samples.face[atlas[row, column]] == face["number"]).all()


def test_spots_name_their_samples(valley):
    result, read = valley
    assert read.meta["spots"]
    assert read.meta["spots"][0]["cutter"] == read.meta["shown"] or not any(
        s["cutter"] == read.meta["shown"] for s in read.meta["spots"]
    )
    for k, spot in enumerate(read.meta["spots"]):
        assert np.allclose(result.samples.point[spot["sample"]], spot["point"])
        verdict = result.reaches[spot["cutter"]].verdict[spot["sample"]]
        assert verdict in (0, 3)
        reason = result.plan.reasons[result.reaches[spot["cutter"]].reason[spot["sample"]]]
        assert reason == spot["reason"]
        (text,) = read.of("li", **{"data-spot": str(k)})
        assert spot["text"] in text
        assert text.startswith(spot["face"])


def test_tools_are_told_as_they_are(rounded):
    _, read = rounded
    (tool,) = read.meta["cutters"]
    parts = {each["part"]: each["points"] for each in tool["outline"]}
    assert parts == {
        "flutes": [[0.0, 0.0], [2.0, 0.0], [2.0, 30.0]],
        "holder": [[2.0, 30.0], [9.0, 30.0], [9.0, 50.0], [0.0, 50.0]],
    }
    assert tool["modes"] == [{"offset": 2.0, "radius": 0.0, "height": 0.0, "tilt_low_deg": 0.0, "tilt_high_deg": 90.0}]
    assert read.meta["tilt_limit_deg"] == 60.0


def test_what_is_left_out_is_said(valley):
    result, whole = valley

    def postures(read):
        return {name for name in read.meta["arrays"] if name[:4] == "tilt"}

    assert "tilt.R12L60" in postures(whole)
    assert not any("to keep" in note for note in whole.of("li"))
    smaller = Page(page(result, largest=len(page(result)) - 1))
    assert postures(smaller) == {f"tilt.{result.shown}"}
    assert [c["has_posture"] for c in smaller.meta["cutters"]] == [c["id"] == result.shown for c in smaller.meta["cutters"]]
    assert any("cutter shown alone" in note for note in smaller.of("li"))


def test_the_same_plan_gives_the_same_page(valley):
    result, _ = valley
    again = plan("samples/peaks_and_valleys.step", cutters=["R12L60", "R6L80", "R2L30"], grid=21, area_budget=0,
                 rotation_step=math.radians(30))  # fmt: skip
    assert page(again) == page(result)


def test_policy_allows_the_page_and_nothing_else(valley):
    _, read = valley
    ((policy),) = [a["content"] for tag, a, _ in read.elements if tag == "meta" and "http-equiv" in a]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == "'none'"
    (code,) = [text for tag, a, text in read.elements if tag == "script" and "type" not in a]
    (style,) = [text for tag, _, text in read.elements if tag == "style"]
    for kind, text in (("script-src", code), ("style-src", style)):
        assert rules[kind] == f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
    assert not any(name.startswith("on") or name == "style" for _, a, _ in read.elements for name in a)
    assert not any(tag in ("a", "img", "iframe", "link") or "src" in a or "href" in a for tag, a, _ in read.elements)


NASTY = (
    "<script>alert(1)</script>", "</script><h1>x", "<!--<script>", "a\u2028b\u2029c", "\" onload='x' &lt;",
    "\x00\x07\ud800\u202e{{ 7 }}",
)  # fmt: skip


def test_names_stay_text():
    from tests.support.cad_parts import pocketed

    names = {i + 1: name for i, name in enumerate(NASTY)}
    part = Part(pocketed(), names=names, file="x/<b>&\u2028.step", warnings=("</script><img src=x>",))
    result = plan(part, cutters=["R2L30"], grid=5, area_budget=0, faces="all", fixtures=["box:5,6,7@40,0,0"])
    data = page(result)
    read = Page(data)
    tags = [tag for tag, _, _ in read.elements]
    assert (tags.count("script"), tags.count("h1"), tags.count("img"), tags.count("b")) == (4, 1, 0, 0)
    # Written out as in a terminal: nothing is a box, and nothing turns what follows.
    told = [
        re.sub("[\x00\x07\ud800\u202e\u2028\u2029]", lambda m: m[0].encode("unicode_escape").decode(), name) for name in NASTY
    ]
    assert [face["name"] for face in read.meta["faces"][: len(NASTY)]] == told
    assert read.meta["part"]["file"] == "<b>&\\u2028.step"
    assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e]", data.decode())
    shown = {a["data-face"]: text for tag, a, text in read.elements if tag == "tr" and "data-face" in a}
    for number, name in enumerate(told, 1):
        assert name in shown[str(number)]
    # No part of a script element may begin a comment or another script: parsers do not agree on its end then.
    scripts = [text for tag, a, text in read.elements if tag == "script" and "type" in a]
    assert not any("<" in text for text in scripts)


def told(read):
    """The rows of the table of cutters: name, feasible, reached, main reason."""
    rows = [
        [" ".join(a.split()) for a in text.split("\n")] for tag, a, text in read.elements if tag == "tr" and "data-cutter" in a
    ]
    return [[cell for cell in row if cell] for row in rows]


def test_the_page_says_first_which_cutter_to_take(valley):
    result, read = valley
    (title,), paragraphs = read.of("h1"), read.of("p")
    doubt, why = (next(each for each in paragraphs if words in each) for words in ("Doubt: ", "It is the largest"))
    assert title.startswith("Take flat end D12 x 80: it finishes all ")
    assert doubt.startswith("Doubt: An open shell: ")
    assert "It is the largest of 3 cutters that reaches every sample." in why
    by_name = {row[0]: row[1:] for row in told(read)}
    assert by_name["flat end D12 x 80"][:3] == ["✓ yes", "100 %", "–"]
    not_reached = result.plan.cutters[0].area_share
    assert by_name["flat end D24 x 60"][:2] == [
        "✕ no",
        f"{100 * (not_reached.interference_free + not_reached.accessible):.1f} %".replace(".0 %", " %"),
    ]


def test_only_all_is_told_as_all():
    from plan_cutters.plan_file.shares import AreaShare, VerdictCounts, reached, unreached

    nearly = AreaShare(accessible=1.0 - 1e-9, inaccessible=1e-9)
    assert (
        reached(VerdictCounts(accessible=10**6, inaccessible=1), nearly),
        unreached(VerdictCounts(inaccessible=1), nearly),
    ) == (">99.9 %", "<0.1 %")
    assert reached(VerdictCounts(accessible=3), AreaShare(accessible=1.0 - 1e-12)) == "100 %"
    # A sample that stands for no area is not reached all the same, and so is a face without samples.
    assert reached(VerdictCounts(accessible=3, inaccessible=1), AreaShare(accessible=1.0)) == ">99.9 %"
    assert reached(VerdictCounts(accessible=3), AreaShare(accessible=0.9, unjudged=0.1)) == "90 %"
    assert (reached(VerdictCounts(), AreaShare()), unreached(VerdictCounts(accessible=1), AreaShare(accessible=1.0))) == (
        "0 %",
        "0 %",
    )


def test_worst_faces_are_those_that_lose_the_most_area(rounded):
    result, read = rounded
    (entry,), reach, samples = result.plan.cutters, result.reaches["R2L30HR9L20"], result.samples
    not_reached = {
        f.id: float(samples.area[(samples.face == int(f.id[1:])) & reach.not_reached].sum()) for f in result.plan.faces
    }
    worst = sorted((name for name in not_reached if not_reached[name] > 0), key=lambda name: -not_reached[name])
    assert worst
    tables = [text for tag, _, text in read.elements if tag == "details" and "fails" in text]
    names = re.findall(r"^(F\d+)", tables[0], re.MULTILINE)
    assert names == worst[:5]
    assert entry.inaccessible


def test_the_reader_in_the_docs_reads_it(valley):
    _, read = valley
    text = (ROOT / "docs" / "review_page_data.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names: dict = {"np": np}
    exec(code, names)
    for name, entry in read.meta["arrays"].items():
        back = names["array"](read.stream, entry)
        assert back.dtype == np.dtype(entry["dtype"])
        assert back.tobytes() == read.array(name).tobytes(), name


def test_a_page_that_cannot_be_made_costs_only_itself(valley, tmp_path, monkeypatch):
    from cad_io.errors import WriteError

    def fails(*_, **__):
        raise WriteError("the CAD kernel made no triangle of the part")

    result, _ = valley
    monkeypatch.setattr(write, "render_mesh", fails)
    document = result.write(tmp_path, ("json", "html", "npz"))
    assert document.not_written == {"html": "the CAD kernel made no triangle of the part"}
    assert sorted(p.name for p in tmp_path.iterdir()) == ["plan.json", "process.toml", "samples.npz"]


def test_the_part_keeps_no_mesh(valley):
    from OCP.BRep import BRep_Tool
    from OCP.TopLoc import TopLoc_Location

    result, _ = valley
    page(result)
    assert all(BRep_Tool.Triangulation_s(result.part.face(f.number), TopLoc_Location()) is None for f in result.part.faces)


def test_fewer_triangles_are_drawn_where_asked(rounded):
    result, read = rounded
    coarse = Page(page(result, triangles=100))
    assert len(coarse.array("mesh.triangle")) < 0.8 * len(read.array("mesh.triangle"))
    assert coarse.meta["drawn_chord_mm"] > read.meta["drawn_chord_mm"]
    assert any("from its surface" in note for note in coarse.of("li"))
