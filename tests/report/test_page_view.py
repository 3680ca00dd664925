"""What the picture of the review page shows at a worst spot, and how it says where one is; in a real browser."""

import re

import cadquery as cq
import numpy as np
import pytest
from scipy.spatial import Delaunay

from cad_io.read import read_part
from plan_cutters import plan
from plan_cutters.report.page.write import write_html
from tests.support.browser import chromium, seen
from tests.support.places import ROOT
from tests.support.review_page import picture

pytest.importorskip("playwright.sync_api", reason="playwright is not installed: setup.sh dev")

pytestmark = pytest.mark.slow("opens a browser")
CUTTER, GRID = "R10L12HR22L30", 21
#: The line around what is in the way, as it is drawn.
OUTLINE = np.array([176, 0, 94])


@pytest.fixture(scope="module")
def planned():
    """A block with a sculptured top and a vise jaw beside it, and a short cutter that fails at the jaw."""
    chromium()
    return plan(
        ROOT / "samples" / "pocket_top.step", grid=GRID, cutters=["R10L12"], holder="R22L30", machine="tilt:40",
        fixtures=["box:15,60,40@62,-10,-10"], area_budget=0,
    )  # fmt: skip


def seen_at(page, points):
    """Where points of the part are in the picture, pixels, and the picture's size."""
    found = page.evaluate("points => points.map(each => review.stage.project(each))", np.asarray(points).tolist())
    return np.array(found), np.array(page.evaluate("[review.stage.canvas.clientWidth, review.stage.canvas.clientHeight]"))


def part_is_within(page):
    """Whether all of the part's drawn vertices are in the picture."""
    points = np.array(page.evaluate("Array.from(review.drawn.shownVertices)")).reshape(-1, 3)
    at, size = seen_at(page, points)
    return bool(((at > 0) & (at < size)).all())


def outlined(page):
    """How many pixels of the picture have the colour of the outline."""
    return int((np.abs(picture(page) - OUTLINE).max(axis=2) < 12).sum())


def test_the_part_is_in_the_first_view(page):
    """However large what holds it is."""
    assert part_is_within(page)
    assert page.locator("#inset").is_hidden()


def test_a_worst_spot_shows_all_of_the_tool_and_outlines_what_is_in_the_way(page, planned):
    assert outlined(page) == 0
    page.keyboard.press("n")
    elements = np.array(page.evaluate("Array.from(review.tool.group.matrix.elements)")).reshape(4, 4)
    x, axis, z, tip = elements[:, :3]
    turns = np.radians(np.arange(0, 360, 15))[:, None]
    rings = [
        tip + h * axis + r * (np.cos(turns) * x + np.sin(turns) * z)
        for part in page.evaluate("review.cutter.outline") for r, h in part["points"]
    ]  # fmt: skip
    # The holder is 42 mm above the tip: all of it is there.
    assert max(h for part in page.evaluate("review.cutter.outline") for _, h in part["points"]) == pytest.approx(42.0)
    at, size = seen_at(page, np.concatenate(rings))
    assert ((at > 0) & (at < size)).all()
    place, _ = seen_at(page, [planned.samples.point[page.evaluate("review.sample.row")]])
    assert ((place > 0) & (place < size)).all()

    assert outlined(page) > 200
    obstacle = page.evaluate("review.spot.obstacle_face").rpartition(":")[2]
    assert obstacle in page.inner_html(".marks")
    page.keyboard.press("Escape")
    assert outlined(page) == 0


@pytest.fixture(scope="module")
def slim(tmp_path_factory):
    """A thin part with a pocket in its end that a short cutter in a wide holder cannot finish, and its page."""
    chromium()
    block = cq.Workplane().box(120, 20, 8).cut(cq.Workplane().box(8, 4, 1.5).translate((60, 0, 0)))
    found = plan(read_part(block), cutters=["R1L12"], holder="R16L40", faces="all", grid=5, area_budget=0)
    path = tmp_path_factory.mktemp("slim") / "review.html"
    write_html(found, None, path)
    return path


def test_a_tool_does_not_fill_the_picture_of_a_worst_spot(at, slim):
    """Of what is seen there, the part has a third of the width or height, the tool less than half of the picture."""
    page = at(where=slim)
    for _ in range(3):
        page.keyboard.press("n")
        corners = page.evaluate("[...review.drawn.partPoints()]")
        where, size = seen_at(page, corners)
        inside = np.clip(where, 0, size)
        part = (inside.max(axis=0) - inside.min(axis=0)) / size
        elements = np.array(page.evaluate("Array.from(review.tool.group.matrix.elements)")).reshape(4, 4)
        x, axis, z, tip = elements[:, :3]
        turns = np.radians(np.arange(0, 360, 15))[:, None]
        outline = page.evaluate("review.cutter.outline.flatMap(each => each.points)")
        rings = [tip + h * axis + r * (np.cos(turns) * x + np.sin(turns) * z) for r, h in outline]
        drawn, _ = seen_at(page, np.concatenate(rings))
        places = np.stack(np.meshgrid(*(np.linspace(0, 1, 60) * s for s in size)), axis=-1).reshape(-1, 2)
        tool = (Delaunay(drawn).find_simplex(places) >= 0).mean()
        assert part.max() > 1 / 3
        assert tool < 0.5


def test_a_close_look_and_back(page):
    page.keyboard.press("n")
    far = page.evaluate("review.stage.table.aim")
    page.keyboard.press("z")
    close = page.evaluate("review.stage.table.aim")
    assert close["half"] < 0.6 * far["half"]
    # A piece of the part is shown: the inset shows all of it, and a click there brings it back.
    page.wait_for_selector("#inset:not([hidden])")
    frame = page.locator("#inset rect.seen").bounding_box()
    assert frame["width"] < page.locator("#inset").bounding_box()["width"]
    page.keyboard.press("z")
    assert page.evaluate("review.stage.table.aim") == far
    page.keyboard.press("z")
    page.locator("#inset").click()
    page.wait_for_selector("#inset", state="hidden")
    assert part_is_within(page)


def test_the_bar_and_the_axes_are_true(page):
    for key in ("7", "1", "+"):
        page.keyboard.press(key)
        page.evaluate("review.stage.draw()")
        length, unit = re.fullmatch(r"([\d.]+) (mm|m|µm)", page.locator("#scale > text").text_content()).groups()
        start, end = map(float, re.match(r"M([\d.]+) .*H([\d.]+)V", page.get_attribute("#scale .bar", "d")).groups())
        right = page.evaluate("review.stage.table.frame().right")
        (one, two), _ = seen_at(page, [[0.0, 0.0, 0.0], right])
        assert unit == "mm"
        assert end - start == pytest.approx(float(length) * (two - one)[0], rel=1e-3)
        drawn = page.evaluate(
            """() => Object.fromEntries([...document.querySelectorAll("#scale [data-side]")].map(side => {
                 const points = side.querySelector("polygon").getAttribute("points").split(" ");
                 return [side.dataset.side, points.map(each => each.split(",").map(Number))]; }))"""
        )
        back = page.evaluate("review.stage.table.frame().back")
        # The sides that face the eye, and each where it lies along its axis, of half the cube's size from its middle.
        faces = {f"{sign}{'XYZ'[k]}": (k, float(f"{sign}1")) for k in range(3) for sign in "+-"}
        assert {*drawn} == {name for name, (k, sign) in faces.items() if sign * back[k] > 1e-3}
        for name, points in drawn.items():
            k, sign = faces[name]
            (origin, tip), _ = seen_at(page, [np.zeros(3), sign * np.eye(3)[k]])
            wanted = (tip - origin) / (two - one)[0]
            assert (np.mean(points, axis=0) - [154, 46]) / 25 == pytest.approx(wanted, abs=1e-3)


def test_borders_of_verdicts_are_rounded_and_samples_keep_their_colour(page, planned):
    """Where one of four samples differs, its cell loses its corner; at the samples themselves nothing changes."""
    verdict = planned.reaches[CUTTER].verdict.reshape(GRID, GRID)
    point = planned.samples.point.reshape(GRID, GRID, 3)
    legend = {0: "inaccessible", 1: "accessible", 2: "interference_free"}
    page.keyboard.press("5")
    page.evaluate("review.setMode('verdict')")
    page.evaluate("review.showTool(false)")
    image = picture(page)

    def hue(place):
        x, y = seen_at(page, [place])[0][0].round().astype(int)
        found = image[y - 1 : y + 2, x - 1 : x + 2].reshape(-1, 3).mean(axis=0)
        colours = {k: np.array(list(bytes.fromhex(planned.plan.legend[name][1:]))) for k, name in legend.items()}
        return min(colours, key=lambda k: np.abs(found / found.sum() - colours[k] / colours[k].sum()).max())

    corners, kept, shown = [], [], set(seen(page, range(GRID * GRID)))
    for i in range(1, GRID - 2):
        for j in range(1, GRID - 2):
            block = verdict[i : i + 2, j : j + 2]
            values, counts = np.unique(block, return_counts=True)
            if counts.tolist() not in ([1, 3], [3, 1]):
                continue
            odd = values[counts.argmin()]
            (a, b), other = np.argwhere(block == odd)[0], values[counts.argmax()]
            if (i + a) * GRID + j + b not in shown:
                continue
            own, across = point[i + a, j + b], point[i + 1 - a, j + 1 - b]
            corners.append(hue(own + 0.46 * (across - own)) == other)
            kept.append(hue(own) == odd)
    assert len(corners) >= 3
    assert np.mean(corners) >= 0.8, corners
    assert all(kept), kept
